# SPDX-License-Identifier: Apache-2.0
"""python3 -m prehend falsify GRAMMAR --scenario S --against OTHER: the nearest variation in which the two part.

Draws from the ranges of the scenario's `vary`, first evenly (a Halton sequence), then by Nelder and Mead's simplex (SciPy) on the
margin: by how much the difference of the two grammars would have to be larger for the play to show it. Against the oracle, by how
much a parameter of the grammar would have to be another one for its agreement to end."""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile

import numpy as np

from . import _prehend, episodes, shrink
from .errors import EpisodeError, Error, amount, fail

TIMES = (2, 4, 8, 16, 32, 64)
FAR = 1000.0


class Ranges:
    """The items of `vary`, each a number from 0 to 1."""

    def __init__(self, tree, file):
        self.tree, self.items = tree, tree.get("vary", [])
        if not self.items:
            fail(EpisodeError, f"{file}: it has no 'vary'", "say what may differ: docs/scenario-format.md, `vary` and `outcomes`", file)

    def written(self, field):
        value = self.tree
        for key in field.split("."):
            value = value[int(key)] if isinstance(value, list) else value[key]
        return value

    def values(self, point):
        """field -> value of a point."""
        values = {}
        for item, share in zip(self.items, np.clip(point, 0, 1)):
            for field in item["fields"]:
                if "choose" in item:
                    values[field] = item["choose"][min(int(share * len(item["choose"])), len(item["choose"]) - 1)]
                    continue
                kind = next(one for one in ("uniform", "normal", "plus", "times") if one in item)
                low, high = item[kind] if kind != "normal" else (item[kind][0] - 3 * item[kind][1], item[kind][0] + 3 * item[kind][1])
                drawn, now = low + share * (high - low), 0 if kind in ("uniform", "normal") else float(self.written(field))
                drawn = now * drawn if kind == "times" else now + drawn
                values[field] = round(float(drawn), 6)
        return values

    def scenario(self, point):
        """The scenario with these values written in it, and without `vary`."""
        tree = json.loads(json.dumps(self.tree))
        for field, value in self.values(point).items():
            owner, keys = tree, [int(key) if key.isdigit() else key for key in field.split(".")]
            for key in keys[:-1]:
                owner = owner[key] if isinstance(owner, list) else owner.setdefault(key, {})
            owner[keys[-1]] = value
        tree.pop("vary"), tree.pop("outcomes", None)
        return tree


def numbers(grammar):
    return {name: (float(re.match(r"[-\d.e]+", text).group()), re.sub(r"^[-\d.e]+\s*", "", text)) for name, text in
            _prehend.Grammar(grammar, {}).parameters()}


class Margin:
    """How far a play is from showing a difference: 1 or less, it shows one."""

    def __init__(self, grammar, against, band):
        self.grammar, self.against, self.band, self.programs = grammar, against, band, {}
        own = numbers(grammar)
        other = numbers(against) if against else {}
        self.apart = {name: (value[0], other[name][0], value[1]) for name, value in own.items()
                      if name in other and other[name] != value and other[name][1] == value[1]}
        self.own = own

    def program(self, grammar, **parameters):
        key = grammar, tuple(sorted(parameters.items()))
        if key not in self.programs:
            try:
                self.programs[key] = _prehend.Grammar(grammar, dict(parameters))
            except Error:
                self.programs[key] = None
        return self.programs[key]

    def parts(self, opened, times=1.0):
        """Events in which the grammar and the other one part, were their difference so many times as large."""
        program = self.program(self.against)
        if times != 1:
            program = self.program(self.grammar, **{name: f"{a + times * (b - a):.9g} {unit}".strip()
                                                    for name, (a, b, unit) in self.apart.items()})
        if program is None:
            return []
        found, wanted = opened.segment(self.program(self.grammar))[0], opened.segment(program)[0]
        ticks = opened.frames()[0]
        tolerance = max(2 * int(min(ticks[1:] - ticks[:-1])), int(self.band * opened.ticks_per_second()))
        missing, extra = shrink.missing_in(found, wanted, 10 ** 15), shrink.missing_in(wanted, found, 10 ** 15)
        moved = [one for one in shrink.missing_in(found, wanted, tolerance) if one not in missing]
        return [f"{kind} {one}" for kind, some in (("missing", missing), ("extra", extra), ("moved", moved)) for one in some]

    def of(self, opened):
        """(margin, what parts)."""
        if found := self.parts(opened):
            return 1, found
        last = 1
        for times in TIMES if self.apart else ():
            for sign, far in ((1, times), (-1, 1 - times)):
                if not self.parts(opened, far):
                    continue
                low, high = last, times
                for _ in range(4):
                    middle = (low + high) / 2
                    low, high = (low, middle) if self.parts(opened, middle if sign > 0 else 1 - middle) else (middle, high)
                return high, []
            last = times
        return FAR, []


class Search:
    """Plays points of the ranges, and asks for the margin."""

    def __init__(self, file, ranges, margin, budget, folder):
        self.file, self.ranges, self.margin, self.budget, self.folder = file, ranges, margin, budget, folder
        self.plays, self.best, self.found, self.failed = 0, (np.inf, None), None, 0

    def __call__(self, point):
        if self.plays >= self.budget or self.found:
            raise StopIteration
        self.plays += 1
        outside = float(np.sum(np.abs(point - np.clip(point, 0, 1))))
        sets = [word for field, value in self.ranges.values(point).items()
                for word in ("--set", f"{field}={json.dumps(value) if isinstance(value, bool) else value}")]
        value, parts = self.oracle(sets) if not self.margin.against else self.grammars(sets)
        if value <= 1 and parts:
            self.found = np.clip(point, 0, 1), parts
        if value < self.best[0]:
            self.best = value, np.array(point)
        return value + outside

    def grammars(self, sets):
        kept = os.path.join(self.folder, "kept.episodes")
        if os.path.exists(kept):
            os.unlink(kept)
        subprocess.run([episodes.program(), "run", self.file, "--record", kept, "--grammar", self.margin.grammar,
                        "--time-limit-s", "86400", *sets],
                       capture_output=True, check=False)
        if not os.path.exists(kept):
            self.failed += 1
            return FAR, []
        return self.margin.of(_prehend.open([kept], "")[0])

    def oracle(self, sets):
        """What `check` says of the ground truth; the largest shift in it is what the search goes by."""
        words = [episodes.program(), "check", self.file, "--grammar", self.margin.grammar, "--no-pictures", "--json", "--replay", "none",
                 "--jobs", "1", "--time-limit-s", "86400", "--report", os.path.join(self.folder, "report"), *sets]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        verdict = json.loads(done.stdout)["scenarios"][0] if done.stdout.startswith("{") else {"errors": ["it"], "details": ""}
        if verdict["errors"]:
            self.failed += 1
            return FAR, []
        parts = re.findall(r"ground truth: (no )?(\w+\([^)]*\)) (.*)", verdict["details"])
        said = ["missing " + event if says.endswith("not recognised") else ("extra " if no else "moved ") + event for no, event, says in parts]
        far_s = [float(one) / 1000 for one in re.findall(r"([\d.]+) ms (?:earlier|later)", verdict["details"])]
        is_part = any(not one.startswith("moved") for one in said) or any(one > self.margin.band for one in far_s)
        return (1 if is_part else max(1.001, self.margin.band / (max(far_s, default=0) + 1e-3))), said if is_part else []

    def run(self):
        """Evenly at first, a third of the budget; then downhill from the best, again and again."""
        from scipy.optimize import minimize  # pylint: disable=import-outside-toplevel
        from scipy.stats import qmc  # pylint: disable=import-outside-toplevel

        dimensions = len(self.ranges.items)
        even = qmc.Halton(dimensions, scramble=False)
        even.fast_forward(1)
        try:
            while True:
                for point in even.random(max(2, self.budget // 3)):
                    self(point)
                start, size = self.best[1], 0.15
                simplex = [start, *(start + (size if start[i] < 0.5 else -size) * np.eye(dimensions)[i] for i in range(dimensions))]
                minimize(self, start, method="Nelder-Mead", options={"initial_simplex": np.array(simplex), "maxfev": self.budget // 3,
                                                                     "xatol": 1e-4, "fatol": 1e-6})
        except StopIteration:
            return self.found


def main(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m prehend falsify", description=__doc__)
    parser.add_argument("GRAMMAR", help="a name of the library or a file")
    parser.add_argument("--scenario", required=True, metavar="FILE", help="with the ranges of 'vary'")
    parser.add_argument("--against", default="", metavar="NAME|FILE", help="another grammar; default: the physical oracle")
    parser.add_argument("--budget", type=amount(int, 1), default=100, metavar="N", help="plays; default: %(default)s")
    parser.add_argument("--band-ms", type=amount(float, 0), default=50, metavar="MS", help="boundaries may be so far apart; default: %(default)s")
    parser.add_argument("-o", "--output", metavar="FILE", help="the scenario that shows it, shrunk")
    parser.add_argument("--shrink", type=amount(int, 0), default=shrink.LEAST_PLAYS, metavar="N", help="plays to shrink it; 0: as it is")
    asked = parser.parse_args(arguments)
    tree = shrink.read(asked.scenario)
    with tempfile.TemporaryDirectory(prefix="prehend_") as folder:
        search = Search(asked.scenario, Ranges(tree, asked.scenario), Margin(asked.GRAMMAR, asked.against, asked.band_ms / 1000),
                        asked.budget, folder)
        found = search.run()
    failed = f", {search.failed} of them failed" if search.failed else ""
    if not found:
        nearest = "" if search.best[0] >= FAR else f"; the nearest play shows {search.best[0]:.3g} times the difference" if asked.against else \
            f"; boundaries are at most {max(0, asked.band_ms / search.best[0] - 1):.3g} ms apart"
        print(f"nothing in {search.plays} plays{failed}{nearest}")
        return 0
    print(f"play {search.plays}{failed}: {'; '.join(found[1])}")
    for field, value in search.ranges.values(found[0]).items():
        print(f"  {field} = {value}")
    if asked.output:
        one = search.ranges.scenario(found[0])
        one["scenario"] = os.path.splitext(os.path.basename(asked.output))[0]
        condition = shrink.Condition(found[1][0], asked.GRAMMAR, asked.against)
        if asked.shrink:
            player = shrink.Player(condition, os.path.dirname(os.path.abspath(asked.scenario)), asked.shrink)
            one.pop("expects", None)
            one = shrink.shrink(one, player)
            one["shows"] = f"{condition.text}, beside {asked.against or 'the oracle'}: a variation of {tree['scenario']}"
        shrink.write(asked.output, shrink.text_of(one))
        print(f"{asked.output}: {len(one['entities'])} entities, {len(one.get('script', []))} steps")
    return 1
