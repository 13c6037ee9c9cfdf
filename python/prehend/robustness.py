# SPDX-License-Identifier: Apache-2.0
"""Recordings of a split, and the same ones with noise, at a lower rate, turned and mirrored: labels stay what they are."""
import json
import math
import os
import pathlib
import random
import subprocess

from .episodes import program
from .errors import EpisodeError, fail

PLAYED = ["--episode", "status=completed"]  # a draft that failed is in the files, too, and was drawn again
TURN_DEG, NOISE_M, KEEP_HZ = 73, 0.005, 20


def recordings(folder, files, names, out):
    """Each episode as a recording, OUT/NAME.jsonl: what is sensed, and nothing of the scenario."""
    for file in sorted({files[name] for name in names}):
        done = subprocess.run([program(), "episode", "export", str(folder / file), *PLAYED, "--to", "jsonl", "-o", os.path.join(out, file)],
                              capture_output=True, text=True, check=False)
        if done.returncode:
            fail(EpisodeError, done.stderr.strip())
    takes = [pathlib.Path(out, files[name], f"{name}.jsonl") for name in names]
    for take in takes:  # all are judged by the events of one grammar
        head, _, rest = take.read_text(encoding="utf-8").partition("\n")
        if '"grammar":"pick_and_place"' not in head:
            take.write_text(json.dumps({**json.loads(head), "grammar": "pick_and_place"}) + "\n" + rest, encoding="utf-8")
    return [str(take) for take in takes]


def _points(line, point, turn):
    """Every place, direction and turn of a line through these two functions."""
    for look in line.get("samples", {}).values():
        if look:
            look["at_m"] = point(look["at_m"])
            for key in ("v_m_per_s", "w_rad_per_s"):
                if key in look:
                    look[key] = point(look[key]) if key[0] == "v" else turn(look[key])
            if "quat_wxyz" in look:
                look["quat_wxyz"] = turn(look["quat_wxyz"])
    for hand in line.get("hands", {}).values():
        if "ahead" in hand:
            hand["ahead"] = point(hand["ahead"])
        if "collision_spheres_m" in hand:
            hand["collision_spheres_m"] = [[*point(one[:3]), one[3]] for one in hand["collision_spheres_m"]]
    for touch in line.get("touches", []):
        for key in ("at_m", "normal"):
            if key in touch:
                touch[key] = point(touch[key])
    return line


def turned(lines):
    """All of the world by 73 degrees about the vertical."""
    c, s = math.cos(math.radians(TURN_DEG)), math.sin(math.radians(TURN_DEG))
    half_c, half_s = math.cos(math.radians(TURN_DEG / 2)), math.sin(math.radians(TURN_DEG / 2))

    def point(p):
        return [c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]]

    def turn(q):
        if len(q) == 3:
            return point(q)
        w, x, y, z = q
        return [half_c * w - half_s * z, half_c * x - half_s * y, half_c * y + half_s * x, half_c * z + half_s * w]
    yield next(lines)
    for line in lines:
        yield _points(line, point, turn)


def mirrored(lines):
    """The world in a mirror, y for -y: right hands are left ones."""
    point = lambda p: [p[0], -p[1], p[2]]
    turn = lambda q: [q[0], -q[1], q[2], -q[3]] if len(q) == 4 else [-q[0], q[1], -q[2]]
    header = next(lines)
    for one in header["entities"].values():
        if "centre_m" in one:
            one["centre_m"] = point(one["centre_m"])
        for part in one.get("parts", []):
            if "at_m" in part:
                part["at_m"] = point(part["at_m"])
            if "quat_wxyz" in part:
                part["quat_wxyz"] = turn(part["quat_wxyz"])
            if "hull" in part:
                part["hull"]["points_m"] = [point(one) for one in part["hull"]["points_m"]]
    yield header
    for line in lines:
        yield _points(line, point, turn)


def noisy(lines):
    """5 mm more of noise (standard deviation) along each axis of what moves."""
    header = next(lines)
    moves = {name for name, one in header["entities"].items() if not one.get("fixed") and not one.get("abstract")}
    drawn = random.Random(header["episode"])
    yield header
    for line in lines:
        for name, look in line.get("samples", {}).items():
            if look and name in moves:
                look["at_m"] = [x + drawn.gauss(0, NOISE_M) for x in look["at_m"]]
        yield line


def slow(lines):
    """At most 20 frames per second; touches and poses in between are lost."""
    header = next(lines)
    yield header
    next_tick, waiting = 0, {}
    for line in lines:
        if "tick" in line:
            waiting.update(line.get("samples", {}))
            if line["tick"] < next_tick:
                continue
            line["samples"], waiting = waiting, {}
            next_tick = line["tick"] + header["ticks_per_second"] // KEEP_HZ
        yield line


CHANGES = {"noise": noisy, "rate": slow, "turned": turned, "mirrored": mirrored}


def changed(takes, count, scratch):
    """By change the recordings of some of the takes; 'none' are the same takes as they are."""
    if not count:
        return {}
    some = sorted(takes, key=lambda one: random.Random(os.path.basename(one)).random())[:count]
    files = {"none": some}
    for name, change in CHANGES.items():
        os.makedirs(os.path.join(scratch, name))
        files[name] = [os.path.join(scratch, name, os.path.basename(one)) for one in some]
        for source, target in zip(some, files[name]):
            with open(source, encoding="utf-8") as lines:
                pathlib.Path(target).write_text("".join(json.dumps(line) + "\n" for line in change(map(json.loads, lines))), encoding="utf-8")
    return files
