#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How right the facts from motion are; prints what docs/facts-from-motion.md sums up. Takes minutes; not a test of ctest.

    python3 tests/program/facts_from_motion.py build/test/prehend [NAME..]

The library's one-hand scenarios, of which nothing is kept but poses at 60 Hz with 1 mm of jitter: what
pick_and_place_from_motion makes of these, compared with what pick_and_place makes of all facts.

    python3 tests/program/facts_from_motion.py build/test/prehend --people [TAKES]

Takes of two people (tests/program/made_takes.py), seen by a tracker of marker clusters: F1@50 against what the shipped
grammars make of all facts.

    python3 tests/program/facts_from_motion.py build/test/prehend --trackers [TAKES]

The same takes, seen by trackers of other rates and jitter, and beside tables that stand at another height than was measured.
"""
import collections
import copy
import json
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

import made_takes

KINDS = {"reaching", "grasping", "sliding", "picking_up", "transporting", "putting_down"}
OF_PEOPLE = KINDS | {"pouring", "stirring"}
GRAMMARS_OF_PEOPLE = {
    "facts": "grammar facts\nuse pick_and_place\nuse pouring\nuse stirring\n",
    "seen": "grammar seen\nuse contact from motion\nuse stirring from motion\nuse pouring from motion\n"
            "use pick_and_place_from_motion\n"}
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


def events(prehend, file, grammar, kinds=KINDS):
    said = subprocess.run([prehend, "episode", "resegment", str(file), "--grammar", str(grammar), "--json"],
                          capture_output=True, text=True, check=True)
    found = [e for e in json.loads(said.stdout)["events"] if e["event"] in kinds]
    return sorted(found, key=lambda e: (e["event"], e["begin_s"]))


def name_of(event):
    return (event["event"], tuple(event["roles"].values()))


def print_boundaries(errors):
    print("| boundary | how many | median, ms | 95 % within, ms | worst, ms | of |\n|---|---|---|---|---|---|")
    for (event, edge), all_of in sorted(errors.items()):
        by_size = sorted(all_of, key=lambda e: abs(e[0]))
        middle = statistics.median(e for e, _ in all_of)
        within = abs(by_size[int(0.95 * (len(by_size) - 1))][0])
        worst, where = by_size[-1]
        print(f"| {event} {edge}s | {len(all_of)} | {middle:+.0f} | {within:.0f} | {worst:+.0f} | {where} |")


def compare(true, found, scenario, errors):
    """Adds the boundary errors if both have the same events; says whether they have."""
    if [name_of(e) for e in true] != [name_of(e) for e in found]:
        return False
    for a, b in zip(true, found):
        for edge in ("begin", "end"):
            errors[a["event"], edge].append((1000 * (b[edge + "_s"] - a[edge + "_s"]), scenario))
    return True


def library(prehend, wanted):
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
            if compare(true, found, scenario, errors):
                same += 1
            else:
                differ.append(scenario)
    print(f"{same} of {same + len(differ)} scenarios have the same events; different: {', '.join(differ)}\n")
    print_boundaries(errors)


def overlap(a, b):
    """Intersection over union of two intervals."""
    return (min(a[1], b[1]) - max(a[0], b[0])) / (max(a[1], b[1]) - min(a[0], b[0]))


def count(true, found, counts):
    """Adds found, missed and extra events: of the same name, and half of both in common."""
    by_name = collections.defaultdict(lambda: ([], []))
    for which, some in enumerate((true, found)):
        for event in some:
            by_name[name_of(event)][which].append((event["begin_s"], event["end_s"]))
    for (event, _), (wanted, free) in by_name.items():
        for interval in wanted:
            best = max(free, key=lambda other: overlap(interval, other), default=None)
            if best is not None and overlap(interval, best) >= 0.5:
                free.remove(best)
                counts[event][0] += 1
            else:
                counts[event][1] += 1
        counts[event][2] += len(free)


def f1(found, missed, extra):
    return 100 * 2 * found / max(1, 2 * found + missed + extra)


def count_takes(prehend, number, person, takes):
    """Found, missed and extra events of a person's takes, by name, and of "all"."""
    counts = collections.defaultdict(lambda: [0, 0, 0])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for which, text in GRAMMARS_OF_PEOPLE.items():
            (folder / f"{which}.grammar").write_text(text)
        for take in range(takes):
            results = []
            for lines, which in zip(made_takes.make(f"take_{take}", person, 10000 * number + take), GRAMMARS_OF_PEOPLE):
                file = folder / f"{which}.jsonl"
                file.write_text("".join(json.dumps(line) + "\n" for line in lines))
                results.append(events(prehend, file, folder / f"{which}.grammar", OF_PEOPLE))
            count(*results, counts)
    counts["all"] = [sum(of[i] for of in counts.values()) for i in range(3)]
    return counts


def people(prehend, takes):
    for number, (who, person) in enumerate(made_takes.PEOPLE.items()):
        counts = count_takes(prehend, number, person, takes)
        print(f"{who} person, {takes} takes\n\n| event | found | missed | extra | F1@50 |\n|---|---|---|---|---|")
        for event, of in sorted(counts.items()):
            print(f"| {event} | {of[0]} | {of[1]} | {of[2]} | {f1(*of):.1f} |")
        print()


def trackers(prehend, takes):
    seen_by = [(hz, 1, 0) for hz in (15, 25, 30, 60, 120, 240)] + [(60, jitter_mm, 0) for jitter_mm in (0.3, 2)] \
        + [(60, 1, error_cm) for error_cm in (-5, -3, 3, 5)]
    print("| Hz | jitter, mm | table too high by, cm | first person, F1@50 | second person |\n|---|---|---|---|---|")
    for hz, jitter_mm, error_cm in seen_by:
        scores = []
        for number, person in enumerate(made_takes.PEOPLE.values()):
            other = copy.copy(person)
            other.hz, other.jitter_m, other.table_error_m = hz, jitter_mm / 1000, error_cm / 100
            scores.append(f1(*count_takes(prehend, number, other, takes)["all"]))
        print(f"| {hz} | {jitter_mm} | {error_cm} | {scores[0]:.1f} | {scores[1]:.1f} |", flush=True)


def main():
    prehend, rest = sys.argv[1], sys.argv[2:]
    if rest[:1] in (["--people"], ["--trackers"]):
        of = people if rest[0] == "--people" else trackers
        of(prehend, int(rest[1]) if len(rest) > 1 else 12)
    else:
        library(prehend, rest)


if __name__ == "__main__":
    main()
