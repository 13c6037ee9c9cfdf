# SPDX-License-Identifier: Apache-2.0
"""`grammar tracks --only robustness` on random signals, beside the semantics of RTAMT (discrete time, offline), restated here from its
stl/discrete_time/offline/ast_visitor.py at 5e30b7bc: lists of numbers, least and greatest, and what it takes beyond the ends."""
import json
import math
import random
import re
import unittest

import takes

INF, FRAMES = math.inf, 90


def negated(f):
    return [-x for x in f]


def both(*fs):
    return [min(xs) for xs in zip(*fs)]


def either(*fs):
    return [max(xs) for xs in zip(*fs)]


def rise(f):
    return [min(-p, s) for p, s in zip([-INF, *f[:-1]], f)]


def fall(f):
    return [min(p, -s) for p, s in zip([INF, *f[:-1]], f)]


def strong_next(f):
    return [*f[1:], -INF]


def strong_previous(f):
    return [-INF, *f[:-1]]


def since(left, right):
    out = []
    for a, b in zip(left, right):
        out.append(max(min(a, out[-1] if out else -INF), b))
    return out


def until(left, right):
    return since(left[::-1], right[::-1])[::-1]


def once(f, begin, end):
    return [max([-INF, *f[max(0, k - end):max(0, k - begin + 1)]]) for k in range(len(f))]


def always(f, begin, end):
    return [min([INF, *f[k + begin:k + end + 1]]) for k in range(len(f))]


def eventually(f, begin, end):
    return [max([-INF, *f[k + begin:k + end + 1]]) for k in range(len(f))]


def until_within(left, right, begin, end):
    return [max([-INF, *(min(right[j], *left[k:j]) if j > k else right[j] for j in range(k + begin, min(k + end + 1, len(left))))])
            for k in range(len(left))]


def lasting(f, frames):
    """Spans of so many frames, all of them in the episode."""
    return once(both(always(f, 0, frames - 1), eventually([INF] * len(f), frames - 1, frames - 1)), 0, frames - 1)


# By rule of roles a: A and b: B, of which c is another one. F, G, H: how far a, b, c are above 40, 60, 50 cm.
RULES = {
    "while F and not (G or height(b) < 30 cm)": lambda f, g, h: both(f, negated(either(g, [0.3 - 0.6 - x for x in g]))),
    "while F until G": lambda f, g, h: since(negated(g), both(f, negated(g))),
    "while F lasting 50 ms": lambda f, g, h: lasting(f, 5),
    "while F lasting 30 ms to 60 ms": lambda f, g, h: both(lasting(f, 3), negated(lasting(f, 7))),
    "while F until G lasting 40 ms": lambda f, g, h: lasting(since(negated(g), both(f, negated(g))), 4),
    "from F begins to G begins": lambda f, g, h: since(negated(rise(g)), both(rise(f), negated(rise(g)))),
    "from F ends to G begins": lambda f, g, h: since(negated(rise(g)), both(fall(f), strong_previous([INF] * len(f)), negated(rise(g)))),
    "from F begins to G ends during height(a) > 20 cm": lambda f, g, h: held(rise(f), both(fall(g), strong_previous([INF] * len(g))), [x + 0.2 for x in f])[0],
    "from F begins to G begins during height(a) > 20 cm or drop": lambda f, g, h: both(*held(rise(f), rise(g), [x + 0.2 for x in f])),
    "until G begins since F at most 100 ms back": lambda f, g, h: until_within(f, rise(g), 1, 10),
    "rest of high(a) outside higher(b)": lambda f, g, h: both(f, negated(g)),
    "while F and pair(a, any)": lambda f, g, h: both(f, either([x + y + 0.1 for x, y in zip(f, g)], [x + y for x, y in zip(f, h)])),
    "while at least 2 of pair(a, any)": lambda f, g, h: both([x + y + 0.1 for x, y in zip(f, g)], [x + y for x, y in zip(f, h)]),
}


def held(begins, to, during):
    """From a moment on, and that `to` comes meanwhile."""
    holds = both(negated(to), during)
    return since(holds, both(begins, holds)), strong_next(until(holds, to))


class Robustness(takes.Folder, unittest.TestCase):
    def test_it_is_what_rtamt_computes(self):
        grammar = self.folder / "random.grammar"
        lines = ["grammar random", "condition high(x: Movable) while height(x) > 40 cm", "condition higher(x: Movable) while height(x) > 60 cm",
                 "condition pair(x: A, y: B) while height(x) + height(y) > 90 cm"]
        roles = {}
        for number, rule in enumerate(RULES):
            text = rule.replace("F", "(height(a) > 40 cm)").replace("G", "(height(b) > 60 cm)")
            roles[number] = "a: A, b: B" if re.search(r"\bG\b|\bb\b", rule) else "a: A"
            lines.append(f"event e{number}({roles[number]}) {text}")
        grammar.write_text("\n".join(lines) + "\n", "utf-8")
        compared = 0
        for seed in range(12):
            chance, z = random.Random(seed), {"a": [0.5], "b": [0.5], "c": [0.5]}
            for values in z.values():
                while len(values) < FRAMES:
                    values.append(min(1, max(0, values[-1] + chance.uniform(-0.12, 0.12))))
            file = self.folder / f"take{seed}.jsonl"
            head = {"recording": 1, "episode": "take", "grammar": "random", "ticks_per_second": 1000,
                    "entities": {name: {"class": "A" if name == "a" else "B", "size_m": [0.1, 0.1, 0.1]} for name in z}}
            rows = [{"tick": 10 * k, "samples": {name: {"at_m": [0, 0, values[k]]} for name, values in z.items()}} for k in range(FRAMES)]
            file.write_text("".join(json.dumps(row) + "\n" for row in [head, *rows, {"end_tick": 10 * FRAMES}]), "utf-8")
            out = self.folder / f"tracks{seed}.json"
            takes.program("grammar", "tracks", file, "--grammar", grammar, "--only", "robustness", "-o", out)
            tracks = {one["name"]: one["values"] for one in json.loads(out.read_text("utf-8"))["tracks"]}
            f, g, h = ([x - least for x in z[name]] for name, least in (("a", 0.4), ("b", 0.6), ("c", 0.5)))
            for number, (rule, formula) in enumerate(RULES.items()):
                found = next(values for name, values in tracks.items() if name == f"robustness of e{number}({re.sub(': .', '', roles[number])})")
                for frame, (value, wanted) in enumerate(zip(found, formula(f, g, h), strict=True)):
                    said = f"{rule}, seed {seed}, frame {frame}"
                    if math.isinf(wanted):
                        self.assertIsNone(value, said)
                    else:
                        self.assertAlmostEqual(value, wanted, 9, said)
                        compared += 1
        self.assertGreater(compared, 10_000)

    def test_what_no_formula_over_frames_says_has_none(self):
        grammar = self.folder / "none.grammar"
        rules = ["from (height(a) > 1 m) begins to (height(a) < 1 m) begins within 1 s", "while height(a) > 1 m requires height(a) > 2 m",
                 "while height(a) > 1 m until height(a) > height(a)@begin", "from (height(a) > 1 m) begins without (height(a) > 2 m) begins within 1 s"]
        grammar.write_text("grammar none\n" + "".join(f"event e{i}(a: A) {rule}\n" for i, rule in enumerate(rules)), "utf-8")
        file, out = self.folder / "take.jsonl", self.folder / "tracks.json"
        head = {"recording": 1, "episode": "take", "grammar": "none", "ticks_per_second": 1000, "entities": {"a": {"class": "A", "size_m": [0.1, 0.1, 0.1]}}}
        file.write_text("".join(json.dumps(row) + "\n" for row in [head, {"tick": 0, "samples": {"a": {"at_m": [0, 0, 1]}}}, {"end_tick": 10}]), "utf-8")
        takes.program("grammar", "tracks", file, "--grammar", grammar, "--only", "robustness", "-o", out, code=4)
        self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main()
