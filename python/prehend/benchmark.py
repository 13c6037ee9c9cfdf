# SPDX-License-Identifier: Apache-2.0
"""Scores recognisers on a data set: one table with intervals, one JSON with every hash (docs/benchmark.md)."""
import argparse
import collections
import csv
import hashlib
import json
import os
import pathlib
import random
import resource
import shlex
import subprocess
import tempfile

import numpy as np

from . import ablation, robustness
from .dataset import PARTS, label, sha256
from .episodes import program
from .errors import EpisodeError, amount, fail, named

ACTIONS = ["reaching", "fixation", "grasping", "sliding", "picking_up", "transporting", "putting_down", "pick_and_place"]
OVERLAPS = (0.10, 0.25, 0.50)
RESAMPLES = 2000


def overlap(a, b):
    """Intersection over union of two (begin, end)."""
    both = min(a[1], b[1]) - max(a[0], b[0])
    return both / (max(a[1], b[1]) - min(a[0], b[0])) if both > 0 else 0.0


def by_label(events, per_s):
    spans = collections.defaultdict(list)
    for one in events:
        spans[one["event"], label(one)].append((one["begin_tick"] / per_s, one["end_tick"] / per_s))
    return spans


def hits(truth, found, least):
    """Of each found one in turn: right if the true one that it overlaps most is so much overlapped and not yet taken (Lea et al. 2017)."""
    taken, right = set(), 0
    for one in found:
        best = max(range(len(truth)), key=lambda i: overlap(truth[i], one), default=None)
        if best is not None and best not in taken and overlap(truth[best], one) >= least:
            taken.add(best)
            right += 1
    return right


class Counts:
    """Of one recogniser: by episode and event how much is right, extra, missed; boundaries; false alarms."""

    def __init__(self, rows, events, episodes):
        place, kind = {name: i for i, name in enumerate(episodes)}, {event: i for i, event in enumerate(events)}
        self.right = np.zeros((len(episodes), len(events), len(OVERLAPS)))
        self.true, self.found = np.zeros((len(episodes), len(events))), np.zeros((len(episodes), len(events)))
        self.alarms, self.seconds, self.edit = np.zeros(len(episodes)), np.zeros(len(episodes)), np.full(len(episodes), np.nan)
        self.begin_ms, self.end_ms = [], []
        for row in rows:
            i, per_s = place[short(row["episode"])], row["truth_events"]["ticks_per_second"]
            self.seconds[i], self.edit[i] = row["end_tick"] / per_s, row["edit"]
            truth, found = by_label(row["truth_events"]["events"], per_s), by_label(row["found_events"]["events"], per_s)
            for event, name in set(truth) | set(found):
                if event not in kind:
                    continue
                k, one, other = kind[event], truth.get((event, name), []), found.get((event, name), [])
                self.true[i, k] += len(one)
                self.found[i, k] += len(other)
                self.right[i, k] += [hits(one, other, least) for least in OVERLAPS]
                for span in other:
                    best = max(one, key=lambda true: overlap(true, span), default=None)
                    if best is None or not overlap(best, span):
                        self.alarms[i] += 1
                    else:
                        self.begin_ms.append(1000 * (span[0] - best[0]))
                        self.end_ms.append(1000 * (span[1] - best[1]))

    def f1(self, weights, which, macro):
        """F1 for each row of weights of the episodes: pooled, or the mean of the events that happen."""
        right, true, found = (np.tensordot(weights, one, 1) for one in (self.right[:, :, which], self.true, self.found))
        if not macro:
            right, true, found = (one.sum(1, keepdims=True) for one in (right, true, found))
        with np.errstate(invalid="ignore", divide="ignore"):
            scores = np.where(true > 0, 2 * right / (true + found), 0)
            return scores.sum(1) / (true > 0).sum(1)


def short(name):
    return name.rsplit("/", 1)[-1]


def interval(values):
    low, high = np.nanpercentile(values, [2.5, 97.5])
    return [round(float(low), 4), round(float(high), 4)]


def read_labels(path, role, manifest):
    """Rows of a table of labels by episode, if it is the one whose hash the manifest has."""
    names = {name: digest for name, digest in manifest["sha256"].items() if name.endswith(f"labels_{role}.csv")}
    digest = sha256(path)
    if digest not in names.values():
        fail(EpisodeError, f"{path}: these are not the labels of the {role} split: found {digest[:16]}.., the manifest has "
             + ", ".join(value[:16] for value in names.values()), "make the set again, or ask who made it")
    of = collections.defaultdict(list)
    with open(path, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            of[row["episode"]] += [row] if row["event"] else []
    return of, digest


def write_truth(folder, labels, names, events):
    """A file of labels for each episode."""
    os.makedirs(folder)
    for name in names:
        lines = [f"{one['begin_s']},{one['end_s']},\"{one['label']}\"" for one in labels[name] if one["event"] in events]
        pathlib.Path(folder, f"{name}.csv").write_text("\n".join(["begin_s,end_s,label", *lines]) + "\n", encoding="utf-8")


def as_files(files, name, values, events):
    """What a grammar finds, as somebody else's files: for one that has not all of the events."""
    done = subprocess.run([program(), "episode", "resegment", *files, "--grammar", name, *values, "--json"], capture_output=True, text=True, check=False)
    if not done.stdout.startswith(("[", "{")):
        fail(EpisodeError, f"'{name}' was not scored:\n{done.stderr.strip()[-2000:]}")
    told = json.loads(done.stdout)
    folder = os.path.join(os.path.dirname(os.path.dirname(files[0])), f"found_by_{name}")
    os.makedirs(folder, exist_ok=True)
    for file, one in zip(files, told if isinstance(told, list) else [told], strict=True):
        lines = [event for event in one["events"] if event["event"] in events]
        pathlib.Path(folder, pathlib.Path(file).stem + ".jsonl").write_text(
            "".join(json.dumps(line) + "\n" for line in [{"recogniser": 1}, *lines]), encoding="utf-8")
    return folder


def score(files, truth, source, options, events):
    """The program's own scores of one source, and the processor time that they took."""
    kind, what = source
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    name, *values = what.split() if kind == "grammar" else [what]
    values = [word for value in values for word in ("--set", value)]
    online = ["--pace", "online"] if options.online and kind == "recogniser" else []

    def scored(*whose):
        return subprocess.run([program(), "score", *files, "--truth", truth, *whose, "--json", "--verbose"], capture_output=True, text=True, check=False)
    done = scored(f"--{kind}", name, *values, *online)
    if kind == "grammar" and "wanted an event of the grammar" in done.stderr:
        done = scored("--found", as_files(files, name, values, events))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if not done.stdout.startswith("{"):
        fail(EpisodeError, f"'{what}' was not scored:\n{done.stderr.strip()[-2000:]}")
    result = json.loads(done.stdout)["grammars"][0]
    if result["failed"]:
        fail(EpisodeError, f"'{what}' failed in {len(result['failed'])} episodes:\n{done.stderr.strip()[-2000:]}",
             "a row has all episodes or is no row: prehend grammar recogniser CMD EPISODE")
    return result, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def hash_of(source):
    """Of what a source is made of: its text, and the files that its command names."""
    digest = hashlib.sha256(source[1].encode())
    for word in shlex.split(source[1]):
        path = pathlib.Path(word)
        for file in sorted(path.rglob("*")) if path.is_dir() else [path]:
            if file.is_file():
                digest.update(sha256(file).encode())
    return digest.hexdigest()


def summary(counts, result, cpu_s, resamples, first, asks):
    """One row of the table."""
    once = np.ones((1, len(counts.seconds)))
    row = {f"f1_{int(100 * least)}_{kind}": round(float(counts.f1(once, i, kind == "macro")[0]), 4)
           for i, least in enumerate(OVERLAPS) for kind in ("micro", "macro")}
    row["edit"] = round(float(np.nanmean(counts.edit)), 2)
    for kind in ("micro", "macro"):
        drawn = counts.f1(resamples, 2, kind == "macro")
        row[f"f1_50_{kind}_interval"] = interval(drawn)
        row[f"f1_50_{kind}_minus_first"] = interval(drawn - first.f1(resamples, 2, kind == "macro"))
    minutes = counts.seconds.sum() / 60
    row["false_alarms_per_min"] = round(float(counts.alarms.sum() / minutes), 3)
    for side, errors in (("begin", counts.begin_ms), ("end", counts.end_ms)):
        row[f"{side}_ms"] = [round(float(np.percentile(np.abs(errors), q)), 1) for q in (50, 95)] if errors else None
    late = result["total"]["latency_s"]
    row["late_ms"] = None if late["median"] is None else round(1000 * late["median"], 1)
    row["cpu_s_per_s"] = round(cpu_s / (60 * minutes), 4)
    row["asks"] = {}
    for question in sorted({one for some in asks for one in some}):
        mask = np.array([[float(question in some) for some in asks]])
        row["asks"][question] = round(float(counts.f1(mask, 2, True)[0]), 4)
    row["f1_50_of"] = {event: round(float(value), 4) for event, value in result["of"].items()}
    return row


def compare(options):
    folder = pathlib.Path(options.set)
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    with open(folder / "episodes.csv", encoding="utf-8") as file:
        known = [row for row in csv.DictReader(file) if row["role"] == options.split]
    if options.asks:
        known = [row for row in known if options.asks in row["asks"].split()]
    names = [named(row["episode"]) for row in known]
    if not names:
        fail(EpisodeError, f"{folder}: no episode is of the {options.split} split" + (f" and asks '{options.asks}'" if options.asks else ""))
    path = options.labels or folder / ("held_out" if options.split == "test" else "") / f"labels_{options.split}.csv"
    labels, digest = read_labels(path, options.split, manifest)
    events = ACTIONS if options.events == "actions" else sorted({one["event"] for some in labels.values() for one in some})
    files = {name: named(file) for name, file in json.loads((folder / "files.json").read_text(encoding="utf-8")).items()}
    rows, everything = [], {}
    resamples = draws_of(len(names))
    with tempfile.TemporaryDirectory(prefix="prehend_") as scratch:
        truth = os.path.join(scratch, "truth")
        write_truth(truth, labels, names, events)
        takes = robustness.recordings(folder, files, names, os.path.join(scratch, "plain"))
        changed = robustness.changed(takes, options.robustness, scratch)
        first = None
        for source in options.sources:
            result, cpu_s = score(takes, truth, source, options, events)
            counts = Counts(result["rows"], events, names)
            first = first or counts
            per_event = counts.right[:, :, 2].sum(0) * 2 / np.maximum(1, (counts.true + counts.found).sum(0))
            result["of"] = {event: value for event, value, true in zip(events, per_event, counts.true.sum(0)) if true}
            row = {"recogniser": source[1], "sha256": hash_of(source)}
            row |= summary(counts, result, cpu_s, resamples, first, [one["asks"].split() for one in known])
            row["robustness"] = {}
            for change, some in changed.items():
                of = [short(pathlib.Path(one).stem) for one in some]
                again = Counts(score(some, truth, source, options, events)[0]["rows"], events, of)
                row["robustness"][change] = round(float(again.f1(np.ones((1, len(of))), 2, True)[0]), 4)
            rows.append(row)
            everything[source[1]] = [{"episode": name, "true": int(counts.true[i].sum()), "found": int(counts.found[i].sum()),
                                      "right_50": int(counts.right[i, :, 2].sum())} for i, name in enumerate(names)]
    spent = spend(folder, options, rows)
    return {"set": manifest["set"], "manifest_sha256": sha256(folder / "manifest.json"), "labels_sha256": digest, "split": options.split,
            "asks": options.asks, "events": events, "episodes": len(names), "program": manifest["program"], "program_sha256": sha256(program()),
            "resamples": RESAMPLES, "times_scored": spent, "rows": rows, "rows_of_episodes": everything,
            "ablations": ablations(options, names, labels, events) if options.ablate else None}


def ablations(options, names, labels, events):
    """For the first grammar one row for each modifier that is left out, the dearest first; '' is the grammar as it is."""
    grammar = next(what for kind, what in options.sources if kind == "grammar")
    some = sorted(names, key=lambda one: random.Random(one + ".jsonl").random())[:options.ablate]
    draws, rows, whole = draws_of(len(some)), [], None
    for what, of in ablation.judged(options.set, some, labels, grammar, PARTS):
        counts, found = Counts(of, events, some), [row["found_events"] for row in of]
        whole = whole or (counts, found)
        row = {"without": what, "episodes_changed": sum(a != b for a, b in zip(found, whole[1]))}
        for kind in ("macro", "micro"):
            row[f"f1_50_{kind}"] = round(float(counts.f1(np.ones((1, len(some))), 2, kind == "macro")[0]), 4)
            row[f"f1_50_{kind}_minus_whole"] = interval(counts.f1(draws, 2, kind == "macro") - whole[0].f1(draws, 2, kind == "macro"))
        rows.append(row)
    return {"grammar": grammar, "episodes": len(some), "rows": rows[:1] + sorted(rows[1:], key=lambda row: row["f1_50_macro"])}


def draws_of(count):
    chooser = np.random.Generator(np.random.PCG64(1))
    return chooser.multinomial(count, np.full(count, 1 / count), RESAMPLES).astype(float)


def spend(folder, options, rows):
    """How often this set's split was scored so far: whoever looks often chooses on it."""
    path = folder / f"scored_{options.split}.json"
    so_far = json.loads(path.read_text(encoding="utf-8")) if path.exists() else []
    so_far += [{"recogniser": row["recogniser"], "sha256": row["sha256"]} for row in rows]
    path.write_text(json.dumps(so_far, indent=0) + "\n", encoding="utf-8")
    return len({one["sha256"] for one in so_far})


def page(result):
    """The table as Markdown."""
    percent = lambda x: "-" if x is None else f"{100 * x:.1f}"
    span = lambda pair: f"{100 * pair[0]:.1f} .. {100 * pair[1]:.1f}"
    lines = [f"# {result['set']}, {result['split']} split: {result['episodes']} episodes", ""]
    if result["split"] != "test":
        lines += [f"**Parameters may be chosen on {result['split']}: these are no results.**", ""]
    header = ["recogniser", "F1@10 macro", "F1@25", "F1@50", "95 %", "F1@50 micro", "95 %", "minus first, macro 95 %", "edit", "false alarms / min",
              "begin ms 50/95 %", "end ms", "late ms"]
    lines += ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    for row in result["rows"]:
        cells = [f"`{row['recogniser']}`", *(percent(row[f"f1_{k}_macro"]) for k in (10, 25, 50)), span(row["f1_50_macro_interval"]),
                 percent(row["f1_50_micro"]), span(row["f1_50_micro_interval"]), span(row["f1_50_macro_minus_first"]), f"{row['edit']:.1f}",
                 f"{row['false_alarms_per_min']:.2f}", *("/".join(map(str, row[f"{side}_ms"])) if row[f"{side}_ms"] else "-" for side in ("begin", "end")),
                 "-" if row["late_ms"] is None else f"{row['late_ms']:.0f}"]
        lines.append("| " + " | ".join(cells) + " |")
    for title, key in (("F1@50 (macro) by what the test asks", "asks"), ("F1@50 (macro) after a change", "robustness"), ("F1@50 by event", "f1_50_of")):
        columns = sorted({name for row in result["rows"] for name in row[key]})
        if columns:
            lines += ["", f"## {title}", "", "| recogniser | " + " | ".join(columns) + " |", "|" + "---|" * (len(columns) + 1)]
            lines += ["| " + " | ".join([f"`{row['recogniser']}`", *(percent(row[key].get(name)) for name in columns)]) + " |" for row in result["rows"]]
    if left_out := result["ablations"]:
        lines += ["", f"## {left_out['grammar']} without a modifier: {left_out['episodes']} episodes", "",
                  "| without | episodes changed | F1@50 macro | minus whole, 95 % | F1@50 micro | minus whole, 95 % |", "|" + "---|" * 6]
        lines += [f"| `{row['without'] or '(nothing)'}` | {row['episodes_changed']} | " + " | ".join(
            f"{percent(row[f'f1_50_{kind}'])} | {span(row[f'f1_50_{kind}_minus_whole'])}" for kind in ("macro", "micro")) + " |" for row in left_out["rows"]]
    lines += ["", f"Labels {result['labels_sha256'][:16]}, manifest {result['manifest_sha256'][:16]}, {result['program']}. Intervals: paired bootstrap over "
              f"episodes, {result['resamples']} resamples. Recognisers that were scored on this split so far: {result['times_scored']}.", ""]
    return "\n".join(lines)


def picture(result, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axis = pyplot.subplots(figsize=(8, 1 + 0.4 * len(result["rows"])), constrained_layout=True)
    for i, row in enumerate(reversed(result["rows"])):
        low, high = row["f1_50_macro_interval"]
        axis.plot([100 * low, 100 * high], [i, i], color="C0")
        axis.plot(100 * row["f1_50_macro"], i, "o", color="C0")
    axis.set_yticks(range(len(result["rows"])), [row["recogniser"][-40:] for row in reversed(result["rows"])])
    axis.set_xlim(0, 100)
    axis.set_xlabel("F1@50, mean of events, with 95 % intervals")
    figure.savefig(path, metadata={"Software": None})
    pyplot.close(figure)


class _Source(argparse.Action):
    def __call__(self, parser, namespace, value, option_string=None):
        namespace.sources = (namespace.sources or []) + [(option_string[2:], value)]


def main(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m prehend benchmark", description=__doc__)
    parser.add_argument("set", help="the folder of 'dataset make'")
    parser.add_argument("--grammar", action=_Source, dest="sources", metavar="'NAME|FILE [P=V ..]'",
                        help="score a grammar, with these values of parameters; may be repeated")
    parser.add_argument("--recogniser", action=_Source, dest="sources", metavar="CMD", help="score a program (docs/recognisers.md)")
    parser.add_argument("--found", action=_Source, dest="sources", metavar="FILE|FOLDER", help="score files of events")
    parser.add_argument("--split", choices=["test", "dev", "train"], default="test")
    parser.add_argument("--asks", help="of the test split only what asks this: same, thing, layout, person, style, noise")
    parser.add_argument("--labels", help="of the test split, if they are not in the set")
    parser.add_argument("--events", choices=["actions", "all"], default="actions", help="what hands do (default), or contacts and supports, too")
    parser.add_argument("--robustness", type=amount(int, 0), default=0, metavar="N", help="also score N episodes with noise, at a lower rate, turned, mirrored")
    parser.add_argument("--ablate", type=amount(int, 0), default=0, metavar="N", help="also judge N episodes by the first grammar without each of its modifiers")
    parser.add_argument("--online", action="store_true", help="programs get a frame when they have answered the last one: how late are they?")
    parser.add_argument("-o", "--output", required=True, metavar="DIR", help="benchmark.md, .json, .png and cpu.json go there")
    options = parser.parse_args(arguments)
    if not options.sources:
        parser.error("nothing to score: --grammar, --recogniser or --found")
    result = compare(options)
    output = pathlib.Path(options.output)
    output.mkdir(parents=True, exist_ok=True)
    cost = {row["recogniser"]: row.pop("cpu_s_per_s") for row in result["rows"]}  # apart, because the rest is the same in every run
    (output / "cpu.json").write_text(json.dumps(cost, indent=1) + "\n", encoding="utf-8")
    (output / "benchmark.json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    (output / "benchmark.md").write_text(page(result), encoding="utf-8")
    picture(result, output / "benchmark.png")
    print(page(result) + "\n".join(f"{spent:.3f} CPU-s per s: {name}" for name, spent in cost.items()))
    return 0
