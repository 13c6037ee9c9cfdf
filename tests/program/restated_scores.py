# SPDX-License-Identifier: Apache-2.0
"""Every figure of `score --json`, computed again from its definition in docs/regression-suite.md, on random timelines.

    python3 tests/program/restated_scores.py build/test/prehend [COUNT]
"""
import json
import math
import os
import random
import statistics
import subprocess
import sys
import tempfile

PER_S = 10000  # ticks; times have whole milliseconds
COLLAR = 0.05 * PER_S
EVENTS = [("reaching", ("right_hand", "cup")), ("grasping", ("right_hand", "cup")), ("grasping", ("right_hand", "can")),
          ("transporting", ("right_hand", "cup")), ("grasping", ("left_hand", "cup")), ("reaching", ("left_hand", "can")),
          ("contact", ("cup", "table")), ("contact", ("can", "table")), ("supported_by", ("cup", "table"))]
NO_FIGURES = {"event", "episode", "person", "set"}  # all else is restated
WITH_HAND = {"reaching", "grasping", "transporting"}


def label_of(event):
    return "%s(%s)" % (event[0], ", ".join(event[1]))


def timeline(rng, like=None):
    """[(begin, end, event)]: events of one label do not overlap. Some of them like those of `like`."""
    events = []
    for event in EVENTS:
        if rng.random() < 0.15:
            continue
        at = rng.randrange(0, 1500)
        for _ in range(rng.randrange(0, 5)):
            begin = at + rng.randrange(0, 900)
            end = begin + rng.randrange(1, 1400)
            events.append((begin, end, event))
            at = end + (0 if rng.random() < 0.2 else rng.randrange(1, 600))
    if like is not None:
        moved = []
        for begin, end, event in like:
            if rng.random() < 0.85:  # in milliseconds
                begin, end = (max(0, t // 10 + rng.choice((0, 0, 20, -30, 45, 60, -140, 300))) for t in (begin, end))
                if rng.random() < 0.15 and end - begin > 40:
                    middle = (begin + end) // 2
                    moved += [(begin, middle, event), (middle + rng.choice((0, 10)), end, event)]
                else:
                    moved.append((begin, end, event))
        events = moved + [one for one in events if rng.random() < 0.15]
    kept = {}
    for begin, end, event in sorted(events, key=lambda e: (e[0], e[1])):
        same = kept.setdefault(event, [])
        if like is not None and same and rng.random() < 0.15:
            same[-1] = (same[-1][0], max(end, same[-1][1]), event)
        elif end > begin and (not same or begin >= same[-1][1]):
            same.append((begin, end, event))
    return sorted((10 * b, 10 * e, event) for same in kept.values() for b, e, event in same)


def ordered(events):
    # As timelines are sorted: by begin, end, name, roles.
    return sorted(events, key=lambda e: (e[0], e[1], e[2][0], e[2][1]))


def overlap(a, b):
    return min(a[1], b[1]) - max(a[0], b[0])


def matching(left, right, fits):
    taken = [-1] * right

    def place(i, tried):
        for j in range(right):
            if tried[j] or not fits(i, j):
                continue
            tried[j] = True
            if taken[j] >= 0 and not place(taken[j], tried):
                continue
            taken[j] = i
            return True
        return False

    size = sum(place(i, [False] * right) for i in range(left))
    partner = [-1] * left
    for j, i in enumerate(taken):
        if i >= 0:
            partner[i] = j
    return size, partner


def hits(truth, found, least):
    free, correct = [True] * len(truth), 0
    for f in found:
        best, most = None, 0
        for i, t in enumerate(truth):
            if t[2] != f[2]:
                continue
            share = overlap(t, f) / (max(t[1], f[1]) - min(t[0], f[0]))
            if best is None or share > most:
                best, most = i, share
        if best is not None and most >= least and free[best]:
            free[best] = False
            correct += 1
    return correct, len(found) - correct, len(truth) - correct


def f1(h):
    correct, extra, missed = h
    return 2 * correct / (2 * correct + extra + missed) if correct + extra + missed else 1


def levenshtein(a, b):
    row = list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        last, row[0] = row[0], i
        for j, y in enumerate(b, 1):
            last, row[j] = row[j], min(last + (x != y), row[j] + 1, row[j - 1] + 1)
    return row[-1]


def tracks(truth, found):
    groups = {}
    for side, events in enumerate((truth, found)):
        for e in events:
            whose = e[2][1][0] if e[2][0] in WITH_HAND else ",".join(e[2][1]) + ","
            groups.setdefault(whose, {}).setdefault(label_of(e[2]), ([], []))[side].append(e)
    result = []
    for labels in groups.values():
        mine = []
        for _, sides in sorted(labels.items()):
            for track in mine:
                if not any(overlap(a, b) > 0 for k in (0, 1) for a in track[k] for b in sides[k]):
                    break
            else:
                track = ([], [])
                mine.append(track)
            for k in (0, 1):
                track[k].extend(sides[k])
        result += mine
    return result


def edits(truth, found):
    scores = []
    for t, f in tracks(truth, found):
        a, b = ([label_of(e[2]) for e in sorted(side)] for side in (t, f))
        scores.append(100 * (1 - levenshtein(a, b) / max(len(a), len(b))))
    return scores


def mean(values, of_nothing):
    values = list(values)
    return sum(values) / len(values) if values else of_nothing


def by_label(truth, found):
    labels = sorted({label_of(e[2]) for e in truth + found})
    return [([e for e in truth if label_of(e[2]) == l], [e for e in found if label_of(e[2]) == l]) for l in labels]


def covered(segments, end):
    """Of each piece between boundaries its length and whether each side has it."""
    truth, found = segments
    cuts = sorted({0, end} | {t for e in truth + found for t in e[:2]})
    for a, b in zip(cuts, cuts[1:]):
        yield b - a, any(e[0] <= a < e[1] for e in truth), any(e[0] <= a < e[1] for e in found)


def frames(labels, end):
    counts = {"both": 0, "truth": 0, "found": 0, "none": 0}
    for segments in labels:
        for length, t, f in covered(segments, end):
            counts["both" if t and f else "truth" if t else "found" if f else "none"] += length
    return counts


def ward(labels):
    names = ("correct", "deleted", "fragmented", "merged", "fragmented_and_merged", "inserted")
    w = dict.fromkeys(names, 0)
    w["found"] = dict.fromkeys(("correct", "fragmenting", "merging", "fragmenting_and_merging"), 0)
    w["missed_s"] = dict.fromkeys(("deletion", "fragmentation", "underfill_begin", "underfill_end"), 0)
    w["false_s"] = dict.fromkeys(("insertion", "merge", "overfill_begin", "overfill_end"), 0)
    for truth, found in labels:
        for own, other, counts, kinds, seconds, why in (
                (truth, found, w, ("deleted", "correct", "fragmented", "merged", "fragmented_and_merged"), w["missed_s"],
                 ("deletion", "fragmentation", "underfill_begin", "underfill_end")),
                (found, truth, w["found"], (None, "correct", "merging", "fragmenting", "fragmenting_and_merging"), w["false_s"],
                 ("insertion", "merge", "overfill_begin", "overfill_end"))):
            for one in own:
                met = [o for o in other if overlap(one, o) > 0]
                shares = any(sum(overlap(o, e) > 0 for e in own) > 1 for o in met)
                kind = 0 if not met else 4 if len(met) > 1 and shares else 2 if len(met) > 1 else 3 if shares else 1
                if kinds[kind] is None:
                    w["inserted"] += 1
                else:
                    counts[kinds[kind]] += 1
                if not met:
                    seconds[why[0]] += (one[1] - one[0]) / PER_S
                    continue
                seconds[why[1]] += sum(max(0, b[0] - a[1]) for a, b in zip(met, met[1:])) / PER_S
                seconds[why[2]] += max(0, met[0][0] - one[0]) / PER_S
                seconds[why[3]] += max(0, one[1] - met[-1][1]) / PER_S
    return w


def partners(truth, found):
    """Of one label: as many pairs as possible, in order; of these the closest in sum."""
    def may(a, b):
        return overlap(a, b) > 0 or max(abs(a[0] - b[0]), abs(a[1] - b[1])) <= int(COLLAR)

    best = [[(0, 0)] * (len(found) + 1) for _ in range(len(truth) + 1)]
    for i in range(len(truth) - 1, -1, -1):
        for j in range(len(found) - 1, -1, -1):
            options = [best[i + 1][j], best[i][j + 1]]
            if may(truth[i], found[j]):
                pairs, distance = best[i + 1][j + 1]
                options.append((pairs + 1, distance - abs(truth[i][0] - found[j][0]) - abs(truth[i][1] - found[j][1])))
            best[i][j] = max(options)
    offsets, i, j = [], 0, 0
    while i < len(truth) and j < len(found):
        a, b = truth[i], found[j]
        pairs, distance = best[i + 1][j + 1]
        if may(a, b) and best[i][j] == (pairs + 1, distance - abs(a[0] - b[0]) - abs(a[1] - b[1])):
            offsets.append(((b[0] - a[0]) / PER_S, (b[1] - a[1]) / PER_S))
            i, j = i + 1, j + 1
        elif best[i][j] == best[i + 1][j]:
            i += 1
        else:
            j += 1
    return offsets


def quantiles(values):
    def nearest(ranked, share):
        return ranked[min(max(math.ceil(share * len(ranked)), 1), len(ranked)) - 1] if ranked else None
    by_size = sorted(values, key=abs)
    return {"median": statistics.median(values) if values else None, "p95": nearest(by_size, 0.95), "max": nearest(by_size, 1)}


def boundaries(segments, end):
    return sorted({t for e in segments for t in e[:2]} - {0, end})


def pieces(segments, end):
    result, at = [], 0
    for b, e, _ in segments:
        if at < b:
            result.append((at, b, ""))
        result.append((b, e, "x"))
        at = e
    return result + ([(at, end, "")] if at < end else [])


def median_distance(of, to):
    distances = sorted(min(abs(a - b) for b in to) for a in of)
    half = len(distances) // 2
    return distances[half] if len(distances) % 2 else (distances[half - 1] + distances[half]) / 2


def further(truth, found, labels, end, counts):
    ap = []
    for t, f in labels:
        if t:
            n, _ = matching(len(t), len(f), lambda i, j: overlap(t[i], f[j]) / (max(t[i][1], f[j][1]) - min(t[i][0], f[j][0])) >= 0.5)
            ap.append(n / len(t) * n / len(f) if n else 0)
    result = {"map_50": mean(ap, 0 if found else 1) if labels else 1}
    hit, extra, missed = 0, 0, 0
    pair_f1, purity, coverage, from_truth, from_found = [], [], [], [], []
    for t, f in labels:
        a, b = boundaries(t, end), boundaries(f, end)
        n, _ = matching(len(a), len(b), lambda i, j: abs(a[i] - b[j]) <= COLLAR)
        hit, extra, missed = hit + n, extra + len(b) - n, missed + len(a) - n
        if a and b:
            from_truth.append(median_distance(a, b) / PER_S)
            from_found.append(median_distance(b, a) / PER_S)
        p, q = pieces(t, end), pieces(f, end)
        both, one, other = {}, {}, {}
        for x in p:
            one[x[2]] = one.get(x[2], 0) + x[1] - x[0]
            for y in q:
                key = (x[2], y[2])
                both[key] = both.get(key, 0) + max(0, overlap(x, y))
        for y in q:
            other[y[2]] = other.get(y[2], 0) + y[1] - y[0]
        pairs = [sum(n * (n - 1) / 2 for n in d.values()) for d in (both, one, other)]
        precision = pairs[0] / pairs[2] if pairs[2] else 1
        recall = pairs[0] / pairs[1] if pairs[1] else 1
        pair_f1.append(2 * precision * recall / (precision + recall) if precision + recall else 0)
        purity.append(sum(max(max(0, overlap(x, y)) for x in p) for y in q) / end)
        coverage.append(sum(max(max(0, overlap(x, y)) for y in q) for x in p) / end)

    def ratio(part, whole, of_nothing):
        return part / whole if whole else of_nothing
    result["boundary_precision"] = ratio(hit, hit + extra, 1 if missed == 0 else 0)
    result["boundary_recall"] = ratio(hit, hit + missed, 1 if extra == 0 else 0)
    result["boundary_f1"] = f1((hit, extra, missed))
    result["boundary_deviation_s"] = {"from_truth": mean(from_truth, None), "from_found": mean(from_found, None)}
    result["pairwise_f1"], result["purity"], result["coverage"] = mean(pair_f1, 1), mean(purity, 1), mean(coverage, 1)
    result["frame_f1"] = ratio(2 * counts["both"], 2 * counts["both"] + counts["truth"] + counts["found"], 1)
    in_truth = counts["both"] + counts["truth"]
    result["detection_error_rate"] = ratio(counts["truth"] + counts["found"], in_truth, 0 if counts["found"] == 0 else 1)

    def share(one, others):
        return sum(max(0, overlap(one, o)) for o in others) / (one[1] - one[0])
    macro, psds = [], []
    for t, f in labels:
        if not t:
            continue
        good = [x for x in f if share(x, t) >= 0.5]
        false = len(f) - len(good)
        n = sum(share(x, good) >= 0.5 for x in t)
        macro.append(2 * n / (2 * n + false + len(t) - n))
        psds.append(n / len(t) * max(0, 1 - false / (end / PER_S / 3600) / 100))
    result["intersection_f1"], result["psds"] = (mean(of, 0 if found else 1) for of in (macro, psds))
    return result


def figures(truth, found, end):
    labels = by_label(truth, found)
    counts = frames(labels, end)
    everything = sum(counts.values())
    h = {p: hits(truth, found, p / 100) for p in (10, 25, 50)}
    near = lambda i, j: abs(truth[i][0] - found[j][0]) <= COLLAR and abs(truth[i][1] - found[j][1]) <= COLLAR
    correct, partner = matching(len(truth), len(found), lambda i, j: truth[i][2] == found[j][2] and near(i, j))
    replaced, matched = set(), set(partner)
    for j in range(len(found)):
        for i in range(len(truth)):
            if j not in matched and partner[i] < 0 and i not in replaced and near(i, j):
                replaced.add(i)
                break
    errors = len(replaced) + (len(truth) - correct - len(replaced)) + (len(found) - correct - len(replaced))
    offsets = [pair for t, f in labels for pair in partners(t, f)]
    a, b = ((counts["both"] + counts[k]) / everything if everything else 0 for k in ("truth", "found"))
    chance = a * b + (1 - a) * (1 - b)
    accuracy = (counts["both"] + counts["none"]) / everything if everything else 1
    scores = edits(truth, found)
    return {"true": len(truth), "found": len(found), "ward": ward(labels),
            "begin_s": quantiles([x for x, _ in offsets]), "end_s": quantiles([x for _, x in offsets]),
            "f1_10": f1(h[10]), "f1_25": f1(h[25]), "f1_50": f1(h[50]), "edit": mean(scores, 100),
            "frame_accuracy": accuracy, "kappa": (accuracy - chance) / (1 - chance) if chance < 1 and everything else 1,
            "collar_f": f1((correct, len(found) - correct, len(truth) - correct)), "collar_s": 0.05,
            "collar_error_rate": errors / len(truth) if truth else 0 if not found else 1,
            "latency_s": {"median": None, "p95": None, "max": None},
            "further": further(truth, found, labels, end, counts)}


def restated(truth, found):
    truth, found = ordered(truth), ordered(found)
    end = max([1] + [e[1] for e in truth + found])
    kinds = sorted({e[2][0] for e in truth + found})
    of = {k: figures([e for e in truth if e[2][0] == k], [e for e in found if e[2][0] == k], end) for k in kinds}
    total = figures(truth, found, end)
    averaged = {key: mean((of[k][key] for k in kinds), 100 if key == "edit" else 1)
                for key in ("f1_10", "f1_25", "f1_50", "edit", "frame_accuracy", "collar_f")}
    keys = ("true", "found", "f1_10", "f1_25", "f1_50", "edit", "frame_accuracy", "collar_f")
    row = {key: total[key] for key in keys}

    def named(h):
        return dict(zip(("correct", "extra", "missed"), h))
    row["hits_50"] = named(hits(truth, found, 0.5))
    row["hits_50_of"] = {k: named(hits([e for e in truth if e[2][0] == k], [e for e in found if e[2][0] == k], 0.5)) for k in kinds}
    return total, of, averaged, row


def compare(said, wanted, where, problems):
    if isinstance(wanted, dict):
        new = set(said or {}) - set(wanted) - NO_FIGURES
        if new:
            problems.append("%s: nobody restates %s" % (where, sorted(new)))
        for key, value in wanted.items():
            compare(said.get(key), value, where + "." + key, problems)
    elif said != wanted and (said is None or wanted is None or abs(said - wanted) > 1e-9):
        problems.append("%s: said %r, restated %r" % (where, said, wanted))


def write(path, events):
    with open(path, "w") as out:
        out.write("begin_s,end_s,label\n")
        for begin, end, event in events:
            out.write('%.3f,%.3f,"%s"\n' % (begin / PER_S, end / PER_S, label_of(event)))


def main():
    program, count = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 50
    problems, figures_compared = [], 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(count):
            rng = random.Random(seed)
            truth = timeline(rng)
            found = timeline(rng, None if seed % 10 == 9 else truth)
            if not truth or not found:
                continue
            paths = [os.path.join(folder, name) for name in ("found.csv", "truth.csv")]
            write(paths[0], found)
            write(paths[1], truth)
            done = subprocess.run([program, "score", paths[0], "--truth", paths[1], "--grammar", "pick_and_place", "--json"],
                                  capture_output=True, text=True)
            if done.returncode != 0:
                problems.append("seed %d: %s" % (seed, done.stderr))
                continue
            score = json.loads(done.stdout)["grammars"][0]
            total, of, averaged, row = restated(truth, found)
            here = []
            compare(score["total"], total, "total", here)
            compare(score["mean_of_events"], averaged, "mean", here)
            compare(score["rows"][0], row, "row", here)
            if [e["event"] for e in score["events"]] != list(of):
                here.append("other events: %s" % [e["event"] for e in score["events"]])
            for event in score["events"]:
                compare(event, of[event["event"]], event["event"], here)
            problems += ["seed %d: %s" % (seed, p) for p in here]
            figures_compared += 1
    print("%d timelines, %d differences" % (figures_compared, len(problems)))
    print("\n".join(problems[:20]))
    return 1 if problems or figures_compared < 0.8 * count else 0


if __name__ == "__main__":
    sys.exit(main())
