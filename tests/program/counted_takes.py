# SPDX-License-Identifier: Apache-2.0
"""Made sets of takes of which everything is known: shared tables, offsets, rows, moments, own grammars. What `score` counts
must be what is counted here, and nothing may be left out without a line.

    python3 tests/program/counted_takes.py build/test/prehend [COUNT] [FIRST_SEED]
"""
import json
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
THINGS = {"cup": 0.0, "can": 5.0}  # where they are


def motion(rng):
    """(thing, level) of each tick, in steps of at least 0.1 s."""
    steps, ticks = [], rng.randrange(300, 700)
    while len(steps) < ticks:
        steps += [(rng.choice(list(THINGS)), rng.choice(LEVELS_M))] * rng.randrange(10, 120)
    return steps[:ticks]


def events_in(steps, close_m):
    """[(begin tick, end tick, thing)]"""
    events = []
    for thing in THINGS:
        begin = None
        for tick, (at, level) in enumerate(steps + [(None, 9)]):
            near = at == thing and level < close_m
            if near and begin is None:
                begin = tick
            if not near and begin is not None:
                events.append((begin, tick, thing))
                begin = None
    return sorted(events)


def write_recording(path, steps, grammar):
    name = os.path.basename(path)[:-6]
    with open(path, "w") as out:
        thing = {"size_m": [0.02, 0.02, 0.02]}
        out.write(json.dumps({"recording": 1, "episode": name, "grammar": grammar, "ticks_per_second": PER_S,
                              "entities": {"cup": thing, "can": thing, "hand": {"hand": True, "size_m": [0, 0, 0]}}}) + "\n")
        for tick, (at, level) in enumerate(steps):
            samples = {"hand": {"at_m": [THINGS[at], 0, level]}}
            if tick == 0:
                samples.update({name: {"at_m": [x, 0, 0]} for name, x in THINGS.items()})
            out.write(json.dumps({"tick": tick, "samples": samples}) + "\n")
        out.write(json.dumps({"end_tick": len(steps)}) + "\n")


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
        truth = [(round(b * PER_S), round(e * PER_S), thing) for b, e, text, thing in take["labels"] if text == "near" and b < e]
        points = [(round(b * PER_S), thing) for b, e, text, thing in take["labels"] if text == "near" and b == e]
        found = list(take["events"])
        explained = set()
        for at, thing in points:
            # Or up to 50 ms before it begins.
            inside = [f for f in found if f[2] == thing and f[0] - 5 <= at < f[1]]
            moments_found += bool(inside)
            explained |= {f for f in inside if not any(t[2] == thing and overlap(t, f) > 0 for t in truth)}
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


def make(rng, folder):
    """The words of a command, and what it must count by grammar."""
    way = rng.choice(("table", "takes", "folder"))
    grammars = {"wide": 60, "middle": 40, "narrow": 20}
    os.mkdir(os.path.join(folder, "grammars"))
    with open(os.path.join(folder, "prehend.yaml"), "w") as out:
        out.write("# a project\n")
    for name, close in grammars.items():
        with open(os.path.join(folder, "grammars", name + ".grammar"), "w") as out:
            out.write(GRAMMAR % (name, close))
    own = rng.choice(list(grammars))
    takes, rows, others = [], [], 0
    for i in range(rng.randrange(1, 5)):
        steps = motion(rng)
        asked = rng.choice(list(grammars)) if way == "takes" and rng.random() < 0.4 else None
        name, key = "take%d" % i, ("take%d" if way == "table" else "P%02d") % i
        write_recording(os.path.join(folder, name + ".jsonl"), steps, own)
        take = {"name": name, "key": key, "asked": asked, "grammar": asked or own,
                "events": events_in(steps, grammars[asked or own] / 100), "offset_s": 0.0}
        take["labels"] = labels_for(rng, take["events"], len(steps))
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
    return words, groups, left_out


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
    words, groups, left_out = make(rng, folder)
    if rng.random() < 0.3:
        words = keep(program, words, folder) if words[3].endswith(".jsonl") else words
    done = subprocess.run([program] + words + ["--json"], capture_output=True, text=True, cwd=folder)
    if done.returncode != 0:
        return ["exit code %d: %s" % (done.returncode, done.stderr)]
    said = json.loads(done.stdout)
    problems = []

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
