# SPDX-License-Identifier: Apache-2.0
"""Bodies made of markers, in tables as trackers export them and in C3D files of all storages: poses within 1e-6 m of the
motion that was made, one marker's gap bridged, what is off its shape named. C3D is read by this page, too, and compared.

    import_markers.py PREHEND
"""
import io
import json
import math
import pathlib
import random
import struct
import sys

import numpy as np

from import_arrays import (CUP, CUPS, FRAMES, HAND, HANDS, RATE, TABLE, TIMES, check_damage, documented, expect_refused, folder,
                           import_file, recording, run)

SHAPE = np.array([[0.05, 0.02, 0.03], [-0.04, 0.03, 0.01], [0.0, -0.05, 0.02], [0.01, 0.02, -0.05]])  # of the cup, about its markers' mean
SHAPE = SHAPE - SHAPE.mean(axis=0)
HAND_SHAPE = np.array([[0.04, 0.0, 0.0], [-0.02, 0.03, 0.0], [-0.02, -0.03, 0.0]])
NAMES = ["cup_a", "cup_b", "cup_c", "cup_d", "h1", "h2", "h3"]


def turn_at(t):
    """About up, from 0, and a little tilt on the way."""
    yaw, tilt = 0.6 * np.interp(t, [2, 3], [0, 1]), 0.2 * math.sin(math.pi * np.interp(t, [2, 3], [0, 1]))
    rz = np.array([[math.cos(yaw), -math.sin(yaw), 0], [math.sin(yaw), math.cos(yaw), 0], [0, 0, 1]])
    rx = np.array([[1, 0, 0], [0, math.cos(tilt), -math.sin(tilt)], [0, math.sin(tilt), math.cos(tilt)]])
    return rz @ rx


TURNS = [turn_at(t) for t in TIMES]
POINTS = np.array([np.vstack([CUPS[i] + SHAPE @ TURNS[i].T, HANDS[i] + HAND_SHAPE]) for i in range(FRAMES)])  # (T, 7, 3)


def entities(names=NAMES, more=""):
    def listed(some):
        return "[" + ", ".join(json.dumps(n) for n in some) + "]"
    return (f"entities:\n{TABLE}  cup: {{markers: {listed(names[:4])}{more}, {CUP}}}\n"
            f"  hand: {{markers: {listed(names[4:])}, {HAND}}}\n")


def matrix(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def worst_off(skip=()):
    """Of the recording's poses from those that were made: metres, and 0.1 times radians."""
    at, worst = {}, 0.0
    for i, frame in enumerate(recording()):
        at.update(frame["samples"])
        if i in skip:
            continue
        worst = max(worst, np.abs(np.array(at["cup"]["at_m"]) - CUPS[i]).max(), np.abs(np.array(at["hand"]["at_m"]) - HANDS[i]).max(),
                    0.1 * np.abs(matrix(at["cup"].get("quat_wxyz", [1, 0, 0, 0])) - TURNS[i]).max())
    return worst


def expect_made(name, content, map_text, within=2e-6, skip=()):
    said = import_file(name, content, map_text)
    assert said.returncode == 0, (name, said.stderr)
    assert len(recording()) == FRAMES
    off = worst_off(skip)
    assert off < within, (name, off, said.stderr)
    assert "transporting" in run("episode", "resegment", folder / "take.jsonl").stdout
    return said


def expect_quiet(name, content, map_text):
    said = expect_made(name, content, map_text)
    assert "the head" not in said.stderr, said.stderr


# ------------------------------------------------------------------------------------------------ tables

def plain_csv(points):
    rows = [",".join(["t"] + [f"{n}_{a}" for n in NAMES for a in "xyz"])]
    for i, t in enumerate(TIMES):
        rows.append(",".join([repr(t)] + ["" if np.isnan(v) else repr(float(v)) for v in points[i].ravel()]))
    return "\n".join(rows) + "\n"


PLAIN = 'unit: m\naxes: z_up\ntime_unit: s\ncolumns: {time: t, position: ["{}_x", "{}_y", "{}_z"]}\n'


def rows_of(points, scale, separator, lead, missing=""):
    return "\n".join(separator.join([lead(i)] + [missing if np.isnan(v) else f"{v * scale:.7f}" for v in points[i].ravel()])
                     for i in range(FRAMES)) + "\n"


def trc(points):
    return ("PathFileType\t4\t(X/Y/Z)\ttake.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\n"
            f"{RATE}\t{RATE}\t{FRAMES}\t7\tmm\t{RATE}\nFrame#\tTime\t" + "\t\t\t".join(NAMES) + "\t\t\n\t\t" +
            "\t".join(f"{a}{k + 1}" for k in range(7) for a in "XYZ") + "\n\n" +
            rows_of(points, 1000, "\t", lambda i: f"{i + 1}\t{TIMES[i]:.7f}"))


def qualisys(points):
    return (f"NO_OF_FRAMES\t{FRAMES}\nNO_OF_CAMERAS\t8\nNO_OF_MARKERS\t7\nFREQUENCY\t{RATE}\nNO_OF_ANALOG\t0\nDESCRIPTION\t--\n"
            "DATA_INCLUDED\t3D\nMARKER_NAMES\t" + "\t".join(NAMES) + "\n" +
            rows_of(points, 1000, "\t", lambda i: f"{i + 1}\t{TIMES[i]:.5f}", "0"))


def nexus(points):
    names = ["s:" + n for n in NAMES]
    return (f"Trajectories\n{RATE}\n,," + ",,,".join(names) + ",,\nFrame,Sub Frame" + ",X,Y,Z" * 7 + "\n,," + ",".join(["mm"] * 21) + "\n" +
            rows_of(points, 1000, ",", lambda i: f"{i + 1},0"))


def motive(points):
    head = ("Format Version,1.23,Take Name,T,Capture Frame Rate,60.000000,Export Frame Rate,60.000000,Rotation Type,Quaternion,"
            "Length Units,Meters,Coordinate Space,Global\n\n")
    names = ["set:" + n for n in NAMES]
    return (head + ",," + ",".join(["Marker"] * 21) + "\n,," + ",".join(n for n in names for _ in "xyz") + "\n,," +
            ",".join(["1"] * 21) + "\n,," + ",".join(["Position"] * 21) + "\nFrame,Time (Seconds)" + ",X,Y,Z" * 7 + "\n" +
            rows_of(points, 1, ",", lambda i: f"{i},{TIMES[i]:.6f}"))


def check_tables():
    expect_made("take.csv", plain_csv(POINTS), PLAIN + entities())
    expect_made("take.trc", trc(POINTS), "axes: z_up\n" + entities())
    expect_made("take.tsv", qualisys(POINTS), "axes: z_up\n" + entities())
    expect_made("take.csv", nexus(POINTS), "axes: z_up\n" + entities(["s:" + n for n in NAMES]))
    expect_made("take.csv", motive(POINTS), "axes: z_up\n" + entities(["set:" + n for n in NAMES]))
    long = "t,n,x,y,z\n" + "".join(f"{t},{n},{','.join(map(repr, map(float, POINTS[i][k])))}\n"
                                   for i, t in enumerate(TIMES) for k, n in enumerate(NAMES))
    expect_made("take.csv", long, 'unit: m\naxes: z_up\ntime_unit: s\ncolumns: {time: t, body: "n", position: [x, "y", z]}\n' + entities())
    # The order of markers, and a turn of the room, change nothing; nor does y up.
    expect_made("take.csv", plain_csv(POINTS), PLAIN + entities(["cup_c", "cup_a", "cup_d", "cup_b", "h3", "h1", "h2"]))
    y_up = POINTS[:, :, [0, 2, 1]] * [1, 1, -1]
    expect_made("take.csv", plain_csv(y_up), PLAIN.replace("z_up", "y_up") + entities())
    mirrored = y_up * [-1, 1, 1]
    expect_made("take.csv", plain_csv(mirrored), PLAIN.replace("z_up", "y_up\nhanded: left") + entities())
    # One of four is lost for long: three tell all. One of three for 5 frames: it is bridged.
    lost = POINTS.copy()
    lost[100:200, 1] = np.nan
    lost[150:155, 5] = np.nan
    said = expect_made("take.csv", plain_csv(lost), PLAIN + entities())
    assert "hand: 3 markers" in said.stdout and "bridged in 5 poses" in said.stdout, said.stdout
    # Two of four, and three of four on one line: it is bridged, too.
    two = POINTS.copy()
    two[150:155, [0, 2]] = np.nan
    said = expect_made("take.csv", plain_csv(two), PLAIN + entities(), within=1e-3)
    assert "cup: 4 markers" in said.stdout and "two seen, bridged in 5 poses" in said.stdout, said.stdout
    one = two.copy()
    one[152, 1] = np.nan
    said = import_file("take.csv", plain_csv(one), PLAIN + entities())
    assert said.returncode == 0 and "two seen, bridged in 4 poses" in said.stdout, said.stdout
    two[150:175, [0, 2]] = np.nan
    said = import_file("take.csv", plain_csv(two), PLAIN + entities())
    assert said.returncode == 2 and "'cup_a + cup_b + cup_c + cup_d' is not tracked for 0.43" in said.stderr, said.stderr
    lost[150:175, 5] = np.nan
    said = import_file("take.csv", plain_csv(lost), PLAIN + entities())
    assert said.returncode == 2 and "'h1 + h2 + h3' is not tracked for 0.43" in said.stderr and "lost: unknown" in said.stderr, said.stderr
    # Noise of half a millimetre.
    noise = np.random.default_rng(3).normal(0, 0.0005, POINTS.shape)
    expect_made("take.csv", plain_csv(POINTS + noise), PLAIN + entities(), within=0.003)
    # Two markers exchanged for three frames: left out, and named by the worst row.
    swapped = POINTS.copy()
    swapped[120:123, [0, 1]] = swapped[120:123, [1, 0]]
    said = expect_made("take.csv", plain_csv(swapped), PLAIN + entities(), within=0.002, skip=range(120, 123))
    assert "in 3 of 301 frames" in said.stderr and "residual_m" in said.stderr and "take.csv:12" in said.stderr, said.stderr
    # axes_quat_wxyz of one take holds for another: it is printed for upright_at_s.
    said = expect_made("take.csv", plain_csv(POINTS), PLAIN + entities(more=", upright_at_s: 0"))
    axes = said.stdout[said.stdout.index("axes_quat_wxyz"):].splitlines()[0]
    late = POINTS[:, :, :].copy()
    late[:20, 0] = np.nan
    expect_made("take.csv", plain_csv(late), PLAIN + entities(more=", " + axes), within=2e-4)
    for content, map_text, *why in (
            (plain_csv(POINTS), PLAIN + entities(["cup_a", "cup_b", "cup_e"] + NAMES[3:]), "no body is called 'cup_e'", "did you mean"),
            (plain_csv(POINTS), PLAIN + entities(["cup_a", "cup_b", "h1", "cup_d"] + NAMES[4:]), "one rigid body", "residual_m"),
            (plain_csv(np.where(np.arange(7)[:, None] == 2, np.nan, POINTS)), PLAIN + entities(), "'cup_c' is never seen"),
            (plain_csv(POINTS * [1, 1e-3, 1] * 0 + POINTS[:, :1]), PLAIN + entities(), "on one line, or at one place"),
            (plain_csv(POINTS), PLAIN + entities(more=", residual_m: 50"), "residual_m"),
            (plain_csv(POINTS), PLAIN + entities(NAMES).replace('"h2", ', ""), "markers")):
        expect_refused("take.csv", content, map_text, *why)


def check_mean_marker_error():
    """Motive's own error of a rigid body is a quality, too."""
    rows = []
    for i, t in enumerate(TIMES):
        rows.append(f"{i},{t:.6f},0,0,0,1,{CUPS[i][0]:.7f},{CUPS[i][1]:.7f},{CUPS[i][2]:.7f},{0.031 if i in (130, 131) else 0.0002:.6f}," +
                    f"0,0,0,1,{HANDS[i][0]:.7f},{HANDS[i][1]:.7f},{HANDS[i][2]:.7f},0.0002")
    each = ["Rotation"] * 4 + ["Position"] * 3 + ["Mean Marker Error"]
    content = ("Format Version,1.23,Take Name,T,Capture Frame Rate,60.000000,Export Frame Rate,60.000000,Rotation Type,Quaternion,"
               "Length Units,Meters,Coordinate Space,Global\n\n,," + ",".join(["Rigid Body"] * 16) + "\n,," +
               ",".join(["Cup"] * 8 + ["Hand"] * 8) + "\n,," + ",".join(["1"] * 16) + "\n,," + ",".join(each * 2) +
               "\nFrame,Time (Seconds)" + ",X,Y,Z,W,X,Y,Z," * 2 + "\n" + "\n".join(rows) + "\n")
    map_text = f"axes: z_up\nentities:\n{TABLE}  cup: {{from: Cup, {CUP}}}\n  hand: {{from: Hand, {HAND}}}\n"
    said = import_file("take.csv", content, map_text)
    assert said.returncode == 0 and "in 2 of 301 frames its markers, by 'Mean Marker Error', are" in said.stderr and "take.csv:138" in said.stderr, said.stderr
    said = import_file("take.csv", content, map_text.replace("from: Cup,", "from: Cup, residual_m: 0.05,"))
    assert said.returncode == 0 and "Mean Marker Error" not in said.stderr, said.stderr


# ------------------------------------------------------------------------------------------------ C3D

def dec_real(value):
    """Of VAX: the words of four times the number, exchanged."""
    bits = struct.pack("<f", value * 4)
    return bits[2:] + bits[:2]


class C3d:
    """Writes points by the page of c3d.org alone."""

    def __init__(self, processor, real, scale=0.05, units="mm", split=255, analogs=0, events=False):
        self.order = ">" if processor == 86 else "<"
        self.processor, self.real, self.scale, self.units, self.split = processor, real, scale, units, split
        self.analogs, self.events = analogs, events

    def word(self, value):
        return struct.pack(self.order + "H", value & 0xFFFF)

    def number(self, value):
        return dec_real(value) if self.processor == 85 else struct.pack(self.order + "f", value)

    def parameter(self, group, name, kind, dims, data, last=False):
        body = struct.pack("bB", kind, len(dims)) + bytes(dims) + data + b"\0"
        return struct.pack("bb", len(name), group) + name.encode() + self.word(0 if last else 2 + len(body)) + body

    def group(self, number, name):
        return struct.pack("bb", len(name), -number) + name.encode() + self.word(3) + b"\0"

    def write(self, points, names, scale=1000.0, last=None, said=None, rate=RATE, long=True):
        """`last`: frame of the head; `said`: POINT:FRAMES, 0 for none; `long`: with TRIAL's fields."""
        frames, count = points.shape[:2]
        last, said = last or 6 + frames, frames if said is None else said
        text = b""
        for k in range(0, count, self.split):
            some = names[k:k + self.split]
            width = max(map(len, some)) + 2
            text += self.parameter(1, "LABELS" + (str(k // self.split + 1) if k else ""), -1, [width, len(some)],
                                   "".join(n.ljust(width) for n in some).encode())
        sign = -1 if self.real else 1
        parameters = (self.group(1, "POINT") + self.parameter(1, "USED", 2, [], self.word(count)) +
                      self.parameter(1, "SCALE", 4, [], self.number(sign * self.scale)) +
                      self.parameter(1, "RATE", 4, [1], self.number(rate)) +
                      (self.parameter(1, "FRAMES", 2, [], self.word(said)) if said else b"") +
                      self.parameter(1, "UNITS", -1, [2], self.units.encode()) + text)
        if long:
            parameters += (self.group(2, "TRIAL") + self.parameter(2, "ACTUAL_START_FIELD", 2, [2], self.word(7) + self.word(0)) +
                           self.parameter(2, "ACTUAL_END_FIELD", 2, [2], self.word(6 + frames) + self.word(0), last=True))
        blocks = (4 + len(parameters) + 511) // 512
        parameters = (b"\1\x50" + bytes([blocks, self.processor]) + parameters).ljust(512 * blocks, b"\0")
        head = (b"\2\x50" + self.word(count) + self.word(self.analogs) + self.word(7) + self.word(last) + self.word(10) +
                self.number(sign * self.scale) + self.word(2 + blocks) + self.word(1) + self.number(RATE)).ljust(298, b"\0")
        head = (head + self.word(12345 if self.events else 0)).ljust(512, b"\0")
        data = io.BytesIO()
        for frame in points:
            for p in frame:
                seen = not np.isnan(p[0])
                values = [float(v) * scale if seen else 0.0 for v in p]
                if self.real:
                    data.write(b"".join(map(self.number, values + [0.5 if seen else -1.0])))
                else:
                    data.write(b"".join(self.word(round(v / self.scale)) for v in values) + self.word(0x0302 if seen else -1))
            data.write((b"\0" * 4 if self.real else b"\0" * 2) * self.analogs)
        return head + parameters + data.getvalue()


def read_c3d(content):
    """Positions (T, N, 3) and labels, by a reader of its own: struct, and nothing of the writer's."""
    start = (content[0] - 1) * 512
    order = {84: "<", 85: "<", 86: ">"}[content[start + 3]]
    dec = content[start + 3] == 85

    def real(at):
        four = content[at:at + 4]
        if dec:
            four = four[2:] + four[:2]
        return struct.unpack(order + "f", four)[0] / (4 if dec else 1)
    used, analogs, first, last = struct.unpack(order + "4H", content[2:10])
    scale, data = real(12), (struct.unpack(order + "H", content[16:18])[0] - 1) * 512
    size = 4 if scale < 0 else 2
    step = (used * 4 + analogs) * size
    points = np.full((last - first + 1, used, 3), np.nan)
    for i in range(len(points)):
        for k in range(used):
            at = data + i * step + k * 4 * size
            if scale < 0:
                x, y, z, w = (real(at + 4 * j) for j in range(4))
            else:
                x, y, z, w = (v * (scale if j < 3 else 1) for j, v in enumerate(struct.unpack(order + "4h", content[at:at + 8])))
            if w >= 0:
                points[i, k] = x, y, z
    return points


def check_c3d():
    seeds = []
    for processor in (84, 85, 86):
        for real in (True, False):
            for more in ({}, {"analogs": 3, "events": True}):
                content = C3d(processor, real, **more).write(POINTS, NAMES)
                again = read_c3d(content) / 1000
                assert np.nanmax(np.abs(again - POINTS)) < 3e-5
                said = expect_made("take.c3d", content, "axes: z_up\n" + entities(), within=1e-6 if real else 2e-3)
                assert ("events are not read" in said.stderr) == bool(more) and ("analog values" in said.stderr) == bool(more)
                # Single markers, as they stand in the file: within 1e-6 m of the reader above.
                said = import_file("take.c3d", content, f"axes: z_up\nentities:\n{TABLE}  cup: {{from: cup_b, {CUP}}}\n  hand: {{from: h2, {HAND}}}\n")
                assert said.returncode == 0, said.stderr
                at, worst = {}, 0.0
                for i, frame in enumerate(recording()):
                    at.update(frame["samples"])
                    worst = max(worst, np.abs(np.array(at["cup"]["at_m"]) - again[i, 1]).max(), np.abs(np.array(at["hand"]["at_m"]) - again[i, 5]).max())
                assert worst < 1e-6, worst
                seeds.append(("take.c3d", content, "axes: z_up\n" + entities()))
    # Metres, labels in several parameters, 300 points, gaps, a rate that the map contradicts.
    expect_made("take.c3d", C3d(84, True, units="m ").write(POINTS, NAMES, scale=1), "axes: z_up\n" + entities())
    expect_made("take.c3d", C3d(84, True, split=3).write(POINTS, NAMES), "axes: z_up\n" + entities())
    many = np.concatenate([np.tile(POINTS[:, :1] + [3, 0, 0], (1, 300, 1)), POINTS], axis=1)
    expect_made("take.c3d", C3d(86, True).write(many, [f"x{k}" for k in range(300)] + NAMES), "axes: z_up\n" + entities())
    lost = POINTS.copy()
    lost[100:200, 1] = np.nan
    lost[150:155, 5] = np.nan
    for real in (True, False):
        expect_made("take.c3d", C3d(85, real).write(lost, NAMES), "axes: z_up\n" + entities(), within=2e-6 if real else 2e-3)
    lost = [f"s:{n}" for n in ("cup_1", "cup_2", "cup_3", "x", "RHand", "y", "z")]
    said = import_file("take.c3d", C3d(84, True).write(POINTS, lost), documented('"s:cup_1"'))
    assert said.returncode == 0 and "cup: 3 markers" in said.stdout and "in the file" not in said.stderr, said.stderr
    # Heads that contradict what is there: all of it is read.
    for more, text in (({"last": 256, "long": False}, "the head says 250 and 301 frames, 301 are there\n"), ({"last": 256}, "250 and 301 frames"),
                       ({"last": 256, "said": 0, "long": False}, "the head says 250 frames, 301 are there\n"),
                       ({"rate": 30}, "the head says 30 and 60 frames a second: the first counts\n")):
        for real in (True, False):
            said = import_file("take.c3d", C3d(84, real).write(POINTS, NAMES, **more), "axes: z_up\n" + entities())
            assert said.returncode == 0 and text in said.stderr and len(recording()) == FRAMES, (more, said.stderr)
    padded = C3d(84, True).write(POINTS, NAMES)
    expect_quiet("take.c3d", padded + b"\0" * (-len(padded) % 512), "axes: z_up\n" + entities())
    long = np.concatenate([POINTS] * 233)
    said = import_file("take.c3d", C3d(84, False).write(long, NAMES, last=65535, said=65535, long=False), "axes: z_up\nsure: [time, axes]\n" + entities())
    assert said.returncode == 0 and "the head says 65529 frames, 70133 are there" in said.stderr and len(recording()) == 70133, said.stderr
    whole = C3d(84, True).write(POINTS, NAMES)
    (folder / "take.c3d").write_bytes(whole)
    said = run("import", folder / "take.c3d", "--propose")
    assert said.returncode == 0 and "a C3D file" in said.stdout and all(f'from: "{n}"' in said.stdout for n in NAMES), (said.stdout, said.stderr)
    assert "unit:" not in said.stdout and "rate_hz" not in said.stdout, said.stdout
    (folder / "first.yaml").write_text(said.stdout)
    assert run("import", folder / "take.c3d", "--map", folder / "first.yaml", "--check").returncode == 0
    for content, map_text, *why in (
            (whole, "axes: z_up\nrate_hz: 100\n" + entities(), "'rate_hz' contradicts the file"),
            (whole, "axes: z_up\nunit: m\n" + entities(), "'unit' contradicts the file"),
            (whole, "axes: z_up\n" + entities(["cup_x"] + NAMES[1:]), "no point is called 'cup_x'", "did you mean"),
            (C3d(84, True).write(POINTS, ["cup_a"] * 7), "axes: z_up\n" + entities(), "several points are called 'cup_a'"),
            (whole[:-1], "axes: z_up\n" + entities(), "at byte", "cut off"), (whole[:700], "axes: z_up\n" + entities(), "at byte"),
            (b"x" * 2000, "axes: z_up\n" + entities(), "no C3D file"), (b"", "axes: z_up\n" + entities(), "no C3D file"),
            (whole[:515] + b"\x21" + whole[516:], "axes: z_up\n" + entities(), "of the processor 33")):
        expect_refused("take.c3d", content, map_text, *why)
    return seeds


def check_public(paths):
    """Files of other programs, where they are at hand: each is read as the reader above reads it, or refused with a reason."""
    for path in paths:
        said = import_file("take.c3d", path.read_bytes(), "axes: z_up\nlost: unknown\n" + entities())
        print(path.name, said.returncode, said.stderr.splitlines()[:2])


if __name__ == "__main__":
    random.seed(7)
    check_tables()
    check_mean_marker_error()
    made = check_c3d()
    check_public([pathlib.Path(p) for p in sys.argv[2:]])
    print(f"{check_damage(made, 100)} of 100 damaged C3D files refused, the others read")
