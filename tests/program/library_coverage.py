#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the suite and made recordings show of the shipped grammars: clauses that decide both ways, thresholds seen from both sides.

    python3 tests/program/library_coverage.py PREHEND [SUITE.episodes]

Without a file it records the suite, which takes a minute. The recordings are those of made_takes.py: as a simulator has all facts,
as a tracker sees them, seen by one that loses hands and things, and of people who are slow, patient, sloppy, or hand things over.
A clause of a file counts once, whichever grammars use it. Prints a line per file, and what lacks; ends with 1 if less than 95 % of the
clauses decide both ways, less than 90 % of the thresholds are seen from both sides, or what lacks is not what
grammar/library/undecided_clauses.tsv lists with its reasons.
"""
import collections
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import made_takes
from made_takes import Person, add, multiply, turn

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = ROOT / "grammar" / "library" / "undecided_clauses.tsv"
FACTS, SEEN = ("kitchen+finger_grasp+hand_actions+handing_over+reached", "my_first", "original_2020"), (
    "pick_and_place_from_motion+hand_actions_from_motion+furniture_from_motion", "handing_over_from_motion")
GRIPPER = "robot_pick_and_place+furniture_from_gripper"


def person(pace=(0.8, 1.2), wobble_deg=6, jitter_m=0.001):
    return Person((0.06, 0.12), 0.74, pace, (0.12, 0.2), wobble_deg, 60, jitter_m, 0.0, False)


class Patient(made_takes.Take):
    """Rests before and after each thing that it does."""

    def pause(self, seconds):
        yield from super().pause(4 * seconds + 0.5)


class HandsOver(made_takes.Take):
    """One hand lifts the cup; the other one comes to it, leaves it alone at first, then takes it."""

    def script(self):
        left, right = self.hands["left_hand"], self.hands["right_hand"]
        x, stays_s, joined = self.things["cup"].p[0], self.rng.choice([0.7, 1.0, 1.5]), []

        def left_does():
            yield from self.fetch(left, "cup")
            yield from self.lift(left)
            joined.append("up")
            yield from self.wait_for(lambda: "right" in joined)
            left.grip, left.held = 0.0, None
            yield from self.pause(0.1)
            left.touched = None
            yield from self.move(left, left.home)

        def right_does():
            yield from self.wait_for(lambda: joined)
            for at_last in (False, True):
                cup = self.things["cup"]
                yield from self.move(right, add(cup.p, [0.15, -0.1, 0.02]))
                yield from self.move(right, add(cup.p, [0.05, 0, 0.02]), seconds=0.4)
                right.touched = "cup"
                yield from self.pause(stays_s)
                if at_last:
                    right.hold = (made_takes.rotate(made_takes.conjugate(right.q), add(cup.p, right.p, -1)),
                                  multiply(made_takes.conjugate(right.q), cup.q))
                    right.grip = 1.0
                    yield from self.pause(0.3)
                    right.held = "cup"
                    joined.append("right")
                    yield from self.pause(0.3)
                    yield from self.move(right, add(right.p, [0.2, 0, 0.05]))
                    yield from self.place(right, x + 0.15, 0.1)
                else:
                    right.touched = None
                    yield from self.move(right, right.home)

        return [left_does(), right_does(), self.pause(1.0)]


class StirsAslant(made_takes.Take):
    """Leans the whisk far over before it stirs, at the edge of the bowl."""

    def stir(self, hand, name, vessel, x, y):
        yield from self.fetch(hand, name)
        yield from self.lift(hand)
        upright, bowl = list(hand.q), self.things[vessel].p
        yield from self.move(hand, add(bowl, [0.0, -0.02, 0.12]), multiply(turn([1, 0, 0], 72), upright), 1.0)
        low = list(hand.p)
        for i in range(round(5.0 * made_takes.HZ)):
            angle = 2 * math.pi * 1.3 * i / made_takes.HZ
            hand.p = add(low, [0.035 * math.cos(angle) - 0.035, 0.035 * math.sin(angle), 0])
            yield
        yield from self.move(hand, add(low, [0, -0.05, 0.2]), upright, 1.0)
        yield from self.place(hand, x, y)


class StirsAtTheEdge(made_takes.Take):
    """Circles that leave the bowl's region, for a moment at first, then for longer."""

    def stir(self, hand, name, vessel, x, y):
        yield from self.fetch(hand, name)
        yield from self.lift(hand)
        bowl = self.things[vessel].p
        yield from self.move(hand, add(bowl, [0.14, 0, 0.2]))
        low = add(self.things[vessel].p, add(hand.p, self.things[name].p, -1))
        for i in range(round(9.0 * made_takes.HZ)):
            angle = 2 * math.pi * 1.3 * i / made_takes.HZ
            hand.p = add(low, [0.105 + 0.0025 * i / made_takes.HZ + 0.035 * math.cos(angle), 0.035 * math.sin(angle), 0.2])
            yield
        yield from self.place(hand, x, y)


class Rests(made_takes.Take):
    """A hand comes to the cup, holds it where it is for seconds, and goes."""

    def script(self):
        def rests():
            for _ in range(3):
                yield from self.fetch(self.hands["left_hand"], "cup")
                yield from self.pause(4.0)
                yield from self.release(self.hands["left_hand"])

        return [rests(), self.pause(1.0)]


def gloves():
    """Hands with sensors at the finger tips alone; a rail, a tray between two palms, a card, a drawer, a gripper: by formulas."""
    hz, entities = 50, {
        "rail": {"class": "Rail", "fixed": True, "size_m": [0.03, 0.4, 0.03]},
        "tray": {"class": "Tray", "size_m": [0.3, 0.3, 0.02], "mass_kg": 0.5},
        "card": {"class": "Card", "size_m": [0.09, 0.05, 0.005], "mass_kg": 0.01},
        "drawer": {"class": "Drawer", "jointed": True, "size_m": [0.4, 0.4, 0.2]},
        **{side: {"hand": True, "size_m": [0.09, 0.084, 0.025], "sensor_sets": ["thumb", "index", "middle", "palm"]}
           for side in ("right_hand", "left_hand")}}
    lines = [{"recording": 1, "episode": "gloves", "grammar": "kitchen", "ticks_per_second": hz, "entities": entities}]

    def drawer(t):  # closes, halts for a tenth of a second, closes; halts for a second, closes
        moved_s = min(t, 1) + min(max(t - 1.1, 0), 0.5) + min(max(t - 2.6, 0), 1)
        return max(0.0, 1 - 0.35 * moved_s)

    places = {"rail": [0, 1, 1], "tray": [0, 0, 1], "card": [0, -1, 1], "drawer": [2, 0, 1], "right_hand": [0.02, 1, 1], "left_hand": [-0.5, 0, 1]}
    for tick in range(12 * hz):
        t = tick / hz
        at = dict(places, right_hand=[0.02, 1, 1] if t < 3 else [0.17, 0, 1] if t < 6 else [0, -1, 1], left_hand=[-0.17, 0, 1])
        facing = {"right_hand": [0.5, -0.5, 0.5, -0.5], "left_hand": [0.5, 0.5, 0.5, 0.5]}
        touches = []
        if 1 < t < 2:  # a rail in the hand, whose strength nobody knows
            touches = [{"a": "right_hand", "b": "rail", "force_n": 20, "sensor_sets": ["thumb", "index"]}]
        elif 3.5 < t < 5.5:  # a tray between two palms, which feel it and have no sensors there, and touch it with a finger later
            sets = {"right_hand": ["index"] if t > 4.2 else [], "left_hand": []}
            touches = [{"a": side, "b": "tray", "force_n": 10, "sensor_sets": sets[side]} for side in sets if t < 4.8 or side == "left_hand"]
        elif 6.5 < t < 7.5 or 7.8 < t < 9:  # a card between two fingers, let slip for a moment and for longer
            touches = [] if 7.0 < t < 7.05 else [{"a": "right_hand", "b": "card", "force_n": 1, "sensor_sets": ["index", "middle"]}]
        samples = {name: {"at_m": place, **({"quat_wxyz": facing[name]} if name in facing else {})} for name, place in at.items()}
        samples["drawer"].update(joint_position=0.3 * drawer(t), joint_fraction=drawer(t))
        grip = 0.6 if t > 0.5 else 0.0
        lines.append({"tick": tick, "samples": samples, "touches": touches,
                      "hands": {"right_hand": {"trigger": grip if t < 9.5 else 0.0}, "left_hand": {"trigger": 0.0}}})
    return [*lines, {"end_tick": 12 * hz}]


def slow_gripper():
    """A gripper closes on a block, and opens so slowly that only its place tells when it has let go."""
    lines = [{"recording": 1, "episode": "slow_gripper", "grammar": "robot_pick_and_place", "ticks_per_second": 20, "entities": {
        "table": {"class": "Table", "fixed": True, "size_m": [1, 1, 0.04]}, "block": {"class": "Block", "size_m": [0.04, 0.04, 0.04]},
        "gripper": {"hand": True, "size_m": [0.05, 0.1, 0.1]}}}]
    for tick in range(15 * 20):
        t = tick / 20
        grip = min(0.5, max(0.0, t - 1)) if t < 3 else max(0.0, 0.5 - 0.06 * (t - 3))
        lines.append({"tick": tick, "hands": {"gripper": {"trigger": grip}}, "samples": {
            "table": {"at_m": [0, 0, 0.74]}, "block": {"at_m": [0.2, 0, 0.78]}, "gripper": {"at_m": [0.2, 0, 0.79]}}})
    return lines


def hidden(lines, names, begin_s, end_s):
    """Nobody sees these between two moments."""
    per_second = lines[0]["ticks_per_second"]
    return [lines[0], *({**line, "samples": {**line["samples"], **dict.fromkeys(names)}}
                        if begin_s <= line["tick"] / per_second < end_s else line for line in lines[1:])]


def lost(lines, seed, to_the_end=False):
    """As a tracker has it that loses hands and things for moments and for seconds."""
    rng, until = random.Random(seed), {}
    end_s = lines[-1]["tick"] / made_takes.TICKS_PER_SECOND
    names = [name for name, one in lines[0]["entities"].items() if not one.get("fixed")]
    for line in lines[1:]:
        now_s = line["tick"] / made_takes.TICKS_PER_SECOND
        for name in names:
            if name not in until and rng.random() < 0.008:
                until[name] = now_s + rng.choice((0.05, 0.3, 0.8, 1.5, 2.5))
            if to_the_end and now_s > 0.6 * end_s:
                until.setdefault(rng.choice(names), end_s + 1)
            if until.get(name, end_s) < now_s:
                del until[name]
        line["samples"] = {name: None if name in until else one for name, one in line["samples"].items()}
    return lines


def recordings(folder):
    """Files with all facts, and files of poses alone."""
    def made(name, who, seed, kind=made_takes.Take):
        plain, made_takes.Take = made_takes.Take, kind
        try:
            return made_takes.make(name, who, seed)
        finally:
            made_takes.Take = plain

    facts, seen = {}, {}
    for name, who in made_takes.PEOPLE.items():
        facts[name], seen[name] = made(name, who, 1)
    slow, _ = made("very_slow", person((0.04, 0.042)), 40)
    facts["very_slow"] = [slow[0], *slow[1::20]]
    for seed, pace in enumerate((0.15, 0.3)):
        _, seen[f"slow_{seed}"] = made(f"slow_{seed}", person((pace, pace)), 50 + seed)
    for seed, wobble_deg in enumerate((25, 35, 45)):
        _, seen[f"sloppy_{seed}"] = made(f"sloppy_{seed}", person(wobble_deg=wobble_deg, jitter_m=0.002), 30 + seed)
    for seed, kind in enumerate((Patient, HandsOver, HandsOver, StirsAslant, StirsAtTheEdge, Rests)):
        name = f"{kind.__name__.lower()}_{seed}"
        facts[name], seen[name] = made(name, person(), 60 + seed, kind)
    for name, seed in (("first", 0), ("second", 1), ("patient_0", 2), ("handsover_1", 3)):
        copy = json.loads(json.dumps(seen[name]))
        seen[f"{name}_lost"] = lost(copy, seed)
        seen[f"{name}_lost_at_last"] = lost(json.loads(json.dumps(seen[name])), 7 + seed, True)
    facts["gloves"], facts["slow_gripper"] = gloves(), slow_gripper()
    for number, (begin_s, end_s) in enumerate(((3.5, 4.2), (3.5, 999.0), (2.0, 2.6), (9.0, 9.8))):
        seen[f"rests_hidden_{number}"] = hidden(json.loads(json.dumps(seen["rests_5"])), ["left_hand"], begin_s, end_s)
    files = []
    for kind, takes in (("facts", facts), ("seen", seen)):
        files.append([])
        for name, lines in takes.items():
            lines[0]["episode"] = f"{name}_{kind}"
            files[-1].append(os.path.join(folder, f"{name}_{kind}.jsonl"))
            pathlib.Path(files[-1][-1]).write_text("".join(json.dumps(line) + "\n" for line in lines), "utf-8")
    return files


def cover(program, files, grammar):
    words = [program, "grammar", "coverage", *files, "--grammar", grammar, "--json"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(words)}: {done.stderr}")
    return json.loads(done.stdout)["clauses"]


def united(all_clauses):
    """By file, line, column and text: sides on which a clause decided, in any grammar that uses it."""
    found = {}
    for clause in all_clauses:
        path = pathlib.Path(clause["file"])
        key = path.name, clause["line"], clause["column"], clause["part"] if clause["is_threshold"] and clause["unit"] == "s" else "", clause["text"]
        one = found.setdefault(key, {**clause, "sides": [0, 0]})
        one["sides"] = [a + b for a, b in zip(one["sides"], clause["all"]["decided"])]
    return found


def listed():
    """Rows of the table: (file, source line, clause)."""
    rows = [line.split("\t") for line in TABLE.read_text("utf-8").splitlines() if line and not line.startswith("#")]
    return {tuple(row[:3]): row[3] for row in rows}


def main():
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="prehend_") as folder:
        suite = sys.argv[2:] or [os.path.join(folder, "suite.episodes")]
        if not sys.argv[2:]:
            subprocess.run([program, "check", "--record", suite[0], "--no-pictures", "--report", os.path.join(folder, "report")],
                           cwd=ROOT, capture_output=True, check=False)
        facts, seen = recordings(folder)
        clauses = [one for grammar in FACTS for one in cover(program, suite + facts, grammar)]
        clauses += [one for grammar in SEEN for one in cover(program, suite + seen, grammar)]
        clauses += cover(program, suite + facts, GRIPPER)
    files, lacking = collections.defaultdict(lambda: [0, 0, 0, 0]), {}
    for (name, line, _, part, text), one in united(clauses).items():
        both = min(one["sides"]) > 0
        source = pathlib.Path(one["file"]).read_text("utf-8").splitlines()[line - 1].strip()
        files[name] = [a + b for a, b in zip(files[name], (both, 1, both and one["is_threshold"], one["is_threshold"]))]
        if not both:
            lacking[name, source, " ".join(f"{part} {text}".split())] = one["sides"]
    for name, (both, count, sides, thresholds) in sorted(files.items()):
        print(f"{name}: {both} of {count} clauses, {sides} of {thresholds} thresholds")
    both, count, sides, thresholds = (sum(one[i] for one in files.values()) for i in range(4))
    print(f"all: {both} of {count} clauses ({100 * both / count:.1f} %), {sides} of {thresholds} thresholds ({100 * sides / thresholds:.1f} %)")
    known = listed() if TABLE.exists() else {}
    for row in sorted(set(lacking) - set(known)):
        print("not listed: " + "\t".join(row) + f"\t{lacking[row]}")
    for row in sorted(set(known) - set(lacking)):
        print("listed, and decides both ways: " + "\t".join(row))
    return int(both < 0.95 * count or sides < 0.9 * thresholds or set(known) != set(lacking))


if __name__ == "__main__":
    sys.exit(main())
