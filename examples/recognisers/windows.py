#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Grasps learned with scikit-learn (Debian: python3-sklearn) from windows of distances; docs/recognisers.md.

python3 windows.py FOLDER: learns from each FOLDER/NAME.jsonl, a recording, with its labels in FOLDER/NAME.csv, as
`prehend episode resegment NAME.jsonl -o NAME.csv` writes them; then finds grasps in the episodes that come. Hand and
object are taken as a pair; what it sees of a pair are distances and speeds in the last half second, and the gripper.
"""
import csv
import json
import math
import os
import pathlib
import re
import sys

WINDOW = (0.0, 0.1, 0.25, 0.5)  # seconds before now
LEAST_S = 0.15  # what is shorter is no grasp, and no gap


class Pairs:
    """The numbers of each pair of hand and thing, frame by frame."""

    def __init__(self, header):
        entities = header["entities"]
        self.per_s = header["ticks_per_second"]
        self.hands = [name for name, one in entities.items() if one.get("hand")]
        self.things = [name for name, one in entities.items()
                       if not (one.get("hand") or one.get("fixed") or one.get("abstract"))]
        self.at, self.grip, self.past = {}, {}, {}

    def take(self, line):
        self.at.update({name: look and look["at_m"] for name, look in line.get("samples", {}).items()})
        self.grip.update({name: hand.get("trigger", 0) for name, hand in line.get("hands", {}).items()})
        rows = {}
        for hand in self.hands:
            for thing in self.things:
                a, b = self.at.get(hand), self.at.get(thing)
                if not a or not b:
                    continue
                past = self.past.setdefault((hand, thing), [])
                past.append((line["tick"], math.dist(a, b), b[2], b))
                while past[0][0] < line["tick"] - WINDOW[-1] * self.per_s and len(past) > 1:
                    past.pop(0)
                row = [self.grip.get(hand, 0)]
                for before in WINDOW:
                    old = next(one for one in past if one[0] >= line["tick"] - before * self.per_s)
                    row += [old[1], b[2] - old[2], math.dist(b, old[3])]
                rows[hand, thing] = row
        return rows


def learn(folder):
    from sklearn.ensemble import RandomForestClassifier
    rows, truths = [], []
    for take in sorted(pathlib.Path(folder).glob("*.jsonl")):
        with open(take.with_suffix(".csv"), encoding="utf-8") as labels:
            grasps = [(float(row["begin_s"]), float(row["end_s"]), *re.findall(r"[\w.]+", row["label"])[1:3])
                      for row in csv.DictReader(labels) if row["label"].startswith("grasping(")]
        lines = map(json.loads, open(take, encoding="utf-8"))
        pairs = Pairs(next(lines))
        for line in lines:
            if "tick" not in line:
                continue
            at_s = line["tick"] / pairs.per_s
            for (hand, thing), row in pairs.take(line).items():
                rows.append(row)
                truths.append(any(begin <= at_s < end and hand == h and thing == t for begin, end, h, t in grasps))
    forest = RandomForestClassifier(40, max_depth=8, random_state=int(os.environ.get("PREHEND_SEED", "1")), n_jobs=1)
    return forest.fit(rows, truths)


def say(line):
    print(json.dumps(line), flush=True)


def watch(forest, lines):
    """One episode: a grasp for each run of frames, without what is too short."""
    pairs, runs, frames = Pairs(json.loads(next(lines))), {}, []
    for line in map(json.loads, lines):
        if "end_tick" in line:
            end = line["end_tick"]
            break
        frames.append((line["tick"], pairs.take(line)))
    keys = [(tick, pair) for tick, rows in frames for pair in rows]
    said = forest.predict([row for _, rows in frames for row in rows.values()]) if keys else []
    least = LEAST_S * pairs.per_s
    for (tick, pair), is_grasp in zip(keys, said):
        mine = runs.setdefault(pair, [])
        if is_grasp and mine and tick - mine[-1][1] <= least:
            mine[-1][1] = tick
        elif is_grasp:
            mine.append([tick, tick])
    for (hand, thing), mine in sorted(runs.items()):
        for begin, last in mine:
            if last - begin >= least:
                say({"event": "grasping", "roles": {"hand": hand, "object": thing}, "begin_tick": begin,
                     "end_tick": min(last + 1, end)})


if __name__ == "__main__":
    say({"recogniser": 1, "name": "windows", "events": {"grasping": ["hand", "object"]}, "facts": ["poses", "trigger"],
         "batch": True})
    forest = learn(sys.argv[1])
    lines = iter(sys.stdin.readline, "")
    for text in lines:
        watch(forest, lines)
        say({"done": json.loads(text)["episode"]})
