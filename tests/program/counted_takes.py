# SPDX-License-Identifier: Apache-2.0
"""Made sets of takes of which everything is known: shared tables, offsets, rows, moments, own grammars, and trackers that lose
a hand or see it elsewhere for a frame or a few. What `score` counts must be what is counted here, and nothing may be left out without a line.

    python3 tests/program/counted_takes.py build/test/prehend [COUNT] [FIRST_SEED]
"""
import json
import math
import os
import random
import subprocess
import sys
import tempfile

PER_S = 100
LEVELS_M = (0.1, 0.3, 0.5, 0.9)  # of a hand above a thing
GRAMMAR = """grammar %s
param close = %d cm
event near(hand: Hand, thing: Thing) while distance(hand, thing) < close
"""
THINGS = {"cup": 0.0, "can": 0.8}  # where they are
BRIDGE_S = 0.105
MAP = """import: 1
unit: m
axes: z_up
time_unit: s
bridge_s: %g
lost: unknown
outlier: lost
grammar: %s
columns: {time: t, position: ["{}_x", "{}_y", "{}_z"]}
entities:
  cup: {from: cup, size_m: [0.02, 0.02, 0.02]}
  can: {from: can, size_m: [0.02, 0.02, 0.02]}
  hand: {from: hand, hand: true, size_m: [0, 0, 0]}
"""


def motion(rng):
    """Where the hand is at each tick: it stays at least 0.3 s, and goes at most 2.5 m/s."""
    places, ticks = [(0.0, 0.9)], rng.randrange(300, 700)
    while len(places) < ticks:
        at, to = places[-1], (rng.choice(list(THINGS.values())), rng.choice(LEVELS_M))
        steps = max(20, round(60 * math.dist(at, to)))
        for i in range(1, steps + 1):
            part = (i / steps) ** 2 * (3 - 2 * i / steps)
            places.append(tuple(a + part * (b - a) for a, b in zip(at, to)))
        places += [to] * rng.randrange(30, 120)
    return places[:ticks]


def events_in(places, close_m, end):
    """[(begin tick, end tick, thing)]; of places that nobody knows (None) nothing holds."""
    events = []
    for thing, x in THINGS.items():
        begin = None
        for tick, place in enumerate(places + [None]):
            near = place is not None and math.dist(place, (x, 0)) < close_m
            if near and begin is None:
                begin = tick
            if not near and begin is not None:
                events.append((begin, min(tick, end), thing))
                begin = None
    return sorted(events)


def write_recording(path, places, grammar):
    name = os.path.basename(path)[:-6]
    with open(path, "w") as out:
        thing = {"size_m": [0.02, 0.02, 0.02]}
        out.write(json.dumps({"recording": 1, "episode": name, "grammar": grammar, "ticks_per_second": PER_S,
                              "entities": {"cup": thing, "can": thing, "hand": {"hand": True, "size_m": [0, 0, 0]}}}) + "\n")
        for tick, (x, z) in enumerate(places):
            samples = {"hand": {"at_m": [x, 0, z]}}
            if tick == 0:
                samples.update({name: {"at_m": [x, 0, 0]} for name, x in THINGS.items()})
            out.write(json.dumps({"tick": tick, "samples": samples}) + "\n")
        out.write(json.dumps({"end_tick": len(places)}) + "\n")


def track(program, path, places, grammar, rng):
    """The same as a table of a tracker, imported: where the hand must be taken to be, and how often it is an outlier and lost."""
    seen, known, outliers, lost, at = list(places), list(places), 0, 0, 20
    while at + 120 < len(places):
        rests = len(set(places[at - 10:at + 15])) == 1
        length = rng.choice((1, 2, 3)) if rests and rng.random() < 0.5 else rng.choice((1, 4, 9, 12, 30, 80))
        gap, last, found = range(at, at + length), places[at - 1], places[at + length]
        if length <= 3 and rests:
            outliers += 1
        for i in gap:
            seen[i] = (last[0] + 0.3, last[1] + 0.25) if length <= 3 and rests else None
            known[i] = tuple(a + (i + 1 - at) / (length + 1) * (b - a) for a, b in zip(last, found))
            if length + 1 > BRIDGE_S * PER_S:
                known[i] = last if i + 1 - at <= BRIDGE_S * PER_S else None
        lost += length + 1 > BRIDGE_S * PER_S
        at += length + rng.randrange(40, 150)
    with open(path[:-6] + ".csv", "w") as out:
        out.write("t,cup_x,cup_y,cup_z,can_x,can_y,can_z,hand_x,hand_y,hand_z\n")
        for tick, place in enumerate(seen):
            out.write("%.2f,0,0,0,%g,0,0,%s\n" % (tick / PER_S, THINGS["can"], "%.9f,0,%.9f" % place if place else ",,"))
    with open(path[:-6] + ".map", "w") as out:
        out.write(MAP % (BRIDGE_S, grammar))
    done = subprocess.run([program, "import", path[:-6] + ".csv", "--map", path[:-6] + ".map", "-o", path], capture_output=True,
                          text=True, cwd=os.path.dirname(path))
    said = {"goes out and back %d time" % outliers: outliers, "'hand' is not tracked": lost}
    problems = ["import does not say: " + line + ": " + done.stderr for line, there in said.items() if bool(there) != (line in done.stderr)]
    return known, problems if done.returncode == 0 else [done.stderr]


def labels_for(rng, events, ticks):
    """What somebody marks: [(begin_s, end_s, text, thing)], without overlaps of one thing."""
    marked = []
    for begin, end, thing in events:
        if rng.random() < 0.15:
            continue
        begin, end = (t + rng.choice((0, 0, 0, 5, -7, 20, -30)) for t in (begin, end))
        marked.append((max(0, begin), min(ticks, end), thing))
    for _ in range(rng.randrange(0, 3)):
        begin = rng.randrange(0, ticks - 40)
        marked.append((begin, begin + rng.randrange(5, 35), rng.choice(list(THINGS))))
    kept, last = [], {}
    for begin, end, thing in sorted(marked):
        if end > begin and begin >= last.get(thing, 0):
            kept.append((begin / PER_S, end / PER_S, "near", thing))
            last[thing] = end
    for _ in range(rng.randrange(0, 3)):
        at = rng.randrange(0, ticks) / PER_S
        kept.append((at, at, "near", rng.choice(list(THINGS))))
    kept += [(1, 2, "idle", "cup")] * rng.randrange(0, 3) + [(1, 2, "", "cup")] * rng.randrange(0, 2)
    if not any(text for _, _, text, _ in kept):
        kept.append((0.1, 0.3, "near", "cup"))
    return kept


def overlap(a, b):
    return min(a[1], b[1]) - max(a[0], b[0])


def count(takes):
    """Of one group of takes what a table must say."""
    true = found_count = correct = moments = moments_found = 0
    for take in takes:
        truth = [(round(b * PER_S, 4), round(e * PER_S, 4), thing) for b, e, text, thing in take["labels"] if text == "near" and b < e]
        points = [(round(b * PER_S, 4), thing) for b, e, text, thing in take["labels"] if text == "near" and b == e]
        found = list(take["events"])
        explained = set()
        for at, thing in points:
            # Or up to 50 ms before it begins.
            inside = [f for f in found if f[2] == thing and f[0] - 5 <= at < f[1]]
            moments_found += bool(inside)
            # It excuses the nearest one.
            excused = [f for f in inside if f not in explained and not any(t[2] == thing and overlap(t, f) > 0 for t in truth)]
            explained |= {f for f in excused if f == min(excused, key=lambda f: (max(0, f[0] - at), f))}
        found = [f for f in found if f not in explained]
        free = [True] * len(truth)
        for f in found:
            best, most = None, 0
            for i, t in enumerate(truth):
                share = overlap(t, f) / (max(t[1], f[1]) - min(t[0], f[0]))
                if t[2] == f[2] and (best is None or share > most):
                    best, most = i, share
            if best is not None and most >= 0.5 and free[best]:
                free[best] = False
                correct += 1
        true, found_count, moments = true + len(truth), found_count + len(found), moments + len(points)
    both = true + found_count
    return {"true": true, "found": found_count, "f1_50": 2 * correct / both if both else 1, "moments": moments,
            "moments_found": moments_found}


def make(program, rng, folder):
    """The words of a command, what it must count by grammar, and what `import` did not say."""
    way = rng.choice(("table", "takes", "folder"))
    grammars = {"wide": 60, "middle": 40, "narrow": 20}
    os.mkdir(os.path.join(folder, "grammars"))
    with open(os.path.join(folder, "prehend.yaml"), "w") as out:
        out.write("# a project\n")
    for name, close in grammars.items():
        with open(os.path.join(folder, "grammars", name + ".grammar"), "w") as out:
            out.write(GRAMMAR % (name, close))
    own = rng.choice(list(grammars))
    tracked, problems = rng.random() < 0.5, []
    takes, rows, others = [], [], 0
    for i in range(rng.randrange(1, 5)):
        places = motion(rng)
        asked = rng.choice(list(grammars)) if way == "takes" and rng.random() < 0.4 else None
        name, key = "take%d" % i, ("take%d" if way == "table" else "P%02d") % i
        path, end = os.path.join(folder, name + ".jsonl"), len(places)
        if tracked:
            places, missing = track(program, path, places, own, rng)
            problems, end = problems + missing, end - 1 + PER_S / 10000  # a tick after the last frame
        else:
            write_recording(path, places, own)
        take = {"name": name, "key": key, "asked": asked, "grammar": asked or own,
                "events": events_in(places, grammars[asked or own] / 100, end), "offset_s": 0.0}
        take["labels"] = labels_for(rng, take["events"], int(end))
        if way == "takes":
            take["offset_s"] = rng.choice((0.0, 0.35, -0.2, 3.0))
        elif way == "table":
            take["offset_s"] = 0.25
        takes.append(take)
        rows += [(key,) + label[:2] + label[2:] + (take["offset_s"],) for label in take["labels"]]
    if way != "folder":
        for i in range(rng.randrange(0, 3)):
            more = [("X%d" % i, 0.5, 1.0, "near", "cup", 0.0)] * rng.randrange(1, 4)
            others += len(more)
            rows += more
        rng.shuffle(rows)
    with open(os.path.join(folder, "map.yaml"), "w") as out:
        out.write("columns: {thing: object%s}\nlabels: {near: {event: near}, idle: ignore}\n" %
                  (", take: video" if way == "table" else ""))
        if way == "table":
            out.write("offset_s: 0.25\n")

    def write_table(path, lines, with_video):
        length = rng.random() < 0.5
        with open(path, "w") as out:
            out.write(("video," if with_video else "") + ("onset,duration" if length else "begin_s,end_s") + ",label,object\n")
            for key, begin, end, text, thing, offset in lines:
                begin, end = begin - offset, end - offset
                out.write(("%s," % key if with_video else "") +
                          "%.4f,%.4f,%s,%s\n" % (begin, end - begin if length else end, text, thing))
    recordings = [os.path.join(folder, t["name"] + ".jsonl") for t in takes]
    words = ["score", "--map", os.path.join(folder, "map.yaml")]
    if way == "folder":
        os.mkdir(os.path.join(folder, "labels"))
        for take in takes:
            write_table(os.path.join(folder, "labels", take["name"] + ".csv"),
                        [r for r in rows if r[0] == take["key"]], False)
        words += recordings + ["--truth", os.path.join(folder, "labels")]
    else:
        write_table(os.path.join(folder, "all.csv"), rows, True)
        words += recordings + ["--truth", os.path.join(folder, "all.csv")]
    if way == "takes":
        with open(os.path.join(folder, "takes.yaml"), "w") as out:
            out.write("labels: all.csv\ntakes:\n")
            for take in takes:
                more = ", grammar: grammars/%s.grammar" % take["asked"] if take["asked"] else ""
                out.write("  - {recording: %s.jsonl, rows: {video: %s}, offset_s: %g%s}\n" %
                          (take["name"], take["key"], take["offset_s"], more))
        words = words[:3] + [os.path.join(folder, "takes.yaml")]
    groups = []
    for take in takes:
        group = next((g for g in groups if g[0]["asked"] == take["asked"]), None)
        groups.append([take]) if group is None else group.append(take)
    texts = [label[2] for take in takes for label in take["labels"]]
    left_out = {"others": others, "ignored": texts.count("idle"), "without_text": texts.count("")}
    return words, groups, left_out, problems


def keep(program, words, folder):
    """The recordings as episode files, which keep the grammar that they were recorded with; it is gone then."""
    kept = []
    for word in words:
        if word.endswith(".jsonl"):
            file = word[:-6] + ".episodes"
            subprocess.run([program, "import", word, "-o", file], check=True, capture_output=True, cwd=folder)
            word = file
        kept.append(word)
    for name in os.listdir(os.path.join(folder, "grammars")):
        os.remove(os.path.join(folder, "grammars", name))
    return kept


def check(program, seed, folder):
    rng = random.Random(seed)
    words, groups, left_out, problems = make(program, rng, folder)
    if rng.random() < 0.3:
        words = keep(program, words, folder) if words[3].endswith(".jsonl") else words
    done = subprocess.run([program] + words + ["--json"], capture_output=True, text=True, cwd=folder)
    if done.returncode != 0:
        return ["exit code %d: %s" % (done.returncode, done.stderr)]
    said = json.loads(done.stdout)

    def expect(what, is_said, wanted):
        if abs(is_said - wanted) > 1e-9:
            problems.append("%s: %r, counted %r" % (what, is_said, wanted))
    expect("tables", len(said["grammars"]), len(groups))
    for score, takes in zip(said["grammars"], groups):
        if os.path.basename(score["grammar"]).split(".")[0] != takes[0]["grammar"]:
            problems.append("judged by %s, recorded with %s" % (score["grammar"], takes[0]["grammar"]))
        wanted = count(takes)
        for key in ("true", "found", "f1_50"):
            expect(key, score["total"][key], wanted[key])
        expect("moments", sum(m["true"] for m in score["moments"].values()), wanted["moments"])
        expect("moments found", sum(m["found"] for m in score["moments"].values()), wanted["moments_found"])
        expect("rows", len(score["rows"]), len(takes))
    counted = said["counted"]
    expect("takes", counted["takes"], sum(len(g) for g in groups))
    expect("others", sum(counted["left_out"]["of_other_takes"].values()), left_out["others"])
    expect("ignored", sum(counted["left_out"]["ignored"].values()), left_out["ignored"])
    expect("without text", counted["left_out"]["without_text"], left_out["without_text"])
    labels = sum(len(t["labels"]) for g in groups for t in g) + left_out["others"]
    expect("all rows", counted["labels"] + counted["of_a_moment"] + sum(left_out.values()), labels)
    return problems


def main():
    os.environ.pop("PREHEND_HOME", None)
    program, number = os.path.abspath(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 12
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 0
    faults = 0
    for seed in range(first, first + number):
        with tempfile.TemporaryDirectory() as folder:
            problems = check(program, seed, folder)
        faults += bool(problems)
        for problem in problems:
            print("seed %d: %s" % (seed, problem))
    print("%d sets of takes, %d of them counted otherwise" % (number, faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
