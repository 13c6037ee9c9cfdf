#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plays the library's one-hand scenarios, keeps nothing of them but poses at 60 Hz with 1 mm of jitter, and compares what
pick_and_place_from_motion makes of these with what pick_and_place makes of all facts. Prints the table of
docs/facts-from-motion.md. Takes minutes; not a test of ctest.

    python3 tests/program/facts_from_motion.py build/test/prehend [NAME..]
"""
import collections
import json
import pathlib
import random
import subprocess
import sys
import tempfile

KINDS = {"reaching", "grasping", "sliding", "picking_up", "transporting", "putting_down"}
HZ = 60
JITTER_M = 0.001


def strip(lines):
    """Poses of what can move, HZ times a second; where fixed things are is known."""
    rng = random.Random(1)
    fixed, poses, due, shown = set(), {}, 0.0, False
    for line in lines:
        record = json.loads(line)
        if "recording" in record:
            step = record["ticks_per_second"] / HZ
            fixed = {n for n, e in record["entities"].items() if e.get("fixed") or e.get("abstract")}
            yield record
            continue
        if "tick" not in record:
            yield record
            continue
        for name, sample in record.get("samples", {}).items():
            pose = {k: sample[k] for k in ("at_m", "quat_wxyz") if k in sample}
            poses.setdefault(name, {}).update(pose)
        if record["tick"] < due:
            continue
        due += step
        samples = {}
        for name, pose in poses.items():
            if name in fixed:
                if not shown:
                    samples[name] = pose
                continue
            samples[name] = dict(pose, at_m=[round(x + rng.gauss(0, JITTER_M), 5) for x in pose["at_m"]])
        shown = True
        yield {"tick": record["tick"], "samples": samples}


def events(prehend, file, grammar):
    said = subprocess.run([prehend, "resegment", file, "--grammar", grammar, "--json"],
                          capture_output=True, text=True, check=True)
    found = [e for e in json.loads(said.stdout)["events"] if e["event"] in KINDS]
    return sorted(found, key=lambda e: (e["event"], e["begin_s"]))


def name_of(event):
    return (event["event"], tuple(event["roles"].values()))


def main():
    prehend, wanted = sys.argv[1], sys.argv[2:]
    listed = json.loads(subprocess.run([prehend, "list", "--json"], capture_output=True, text=True, check=True).stdout)
    same, differ, errors = 0, [], collections.defaultdict(list)
    with tempfile.TemporaryDirectory() as folder:
        whole, poses = (str(pathlib.Path(folder) / n) for n in ("whole.jsonl", "poses.jsonl"))
        for scenario in wanted or [s["scenario"] for s in listed["scenarios"]]:
            if subprocess.run([prehend, "run", scenario, "--record", whole], capture_output=True).returncode not in (0, 3):
                continue
            with open(whole, encoding="utf-8") as lines:
                header = json.loads(lines.readline())
                hands = [e for e in header["entities"].values() if e.get("hand")]
                if len(hands) != 1 or header.get("grammar") != "pick_and_place":
                    continue
                lines.seek(0)
                with open(poses, "w", encoding="utf-8") as out:
                    out.writelines(json.dumps(record) + "\n" for record in strip(lines))
            true = events(prehend, whole, "pick_and_place")
            found = events(prehend, poses, "pick_and_place_from_motion")
            if [name_of(e) for e in true] != [name_of(e) for e in found]:
                differ.append(scenario)
                continue
            same += 1
            for a, b in zip(true, found):
                for edge in ("begin", "end"):
                    errors[a["event"], edge].append((1000 * (b[edge + "_s"] - a[edge + "_s"]), scenario))
    print(f"{same} of {same + len(differ)} scenarios have the same events; different: {', '.join(differ)}\n")
    print("| boundary | how many | median, ms | 95 % within, ms | worst, ms | of |\n|---|---|---|---|---|---|")
    for (event, edge), all_of in sorted(errors.items()):
        by_size = sorted(all_of, key=lambda e: abs(e[0]))
        middle = sorted(e for e, _ in all_of)[len(all_of) // 2]
        within = abs(by_size[int(0.95 * (len(by_size) - 1))][0])
        worst, where = by_size[-1]
        print(f"| {event} {edge}s | {len(all_of)} | {middle:+.0f} | {within:.0f} | {worst:+.0f} | {where} |")


if __name__ == "__main__":
    main()
