# SPDX-License-Identifier: Apache-2.0
"""The five commands of docs/benchmark.md on 30 episodes: from a recipe to a table. Two minutes: `ctest -L long`."""
import csv
import json
import pathlib
import re
import sys
import tarfile
import unittest

import prehend
import takes
from prehend import __main__ as command

CHEATS = ("names", "schedule", "flood")
PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "benchmark.md"
MINE = '''import json, sys
print(json.dumps({"recogniser": 1, "name": "mine", "events": {"grasping": ["hand", "object"]}, "facts": ["poses"]}), flush=True)
entities = json.loads(sys.stdin.readline())["entities"]
assert not any("style" in one or "trigger" in one for one in entities.values())
hand = next(name for name, one in entities.items() if one.get("hand"))
things = [name for name, one in entities.items() if not (one.get("hand") or one.get("fixed") or one.get("person"))]
start, moved, last = {}, {}, {}
for line in map(json.loads, sys.stdin):
    assert "touches" not in line and not any("trigger" in one for one in line.get("hands", {}).values()), "asked for poses alone"
    for name in things:
        at = (line.get("samples", {}).get(name) or {}).get("at_m")
        if at and sum((a - b) ** 2 for a, b in zip(at, start.setdefault(name, at))) > 4e-4:
            moved.setdefault(name, line["tick"])
            last[name] = line["tick"] + 1
for name in moved:
    if last[name] > moved[name] + 48:
        print(json.dumps({"event": "grasping", "roles": {"hand": hand, "object": name}, "begin_tick": moved[name], "end_tick": last[name]}), flush=True)
'''


def commands():
    """The five of the page, as words."""
    block = re.search(r"```sh\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S)[1]
    return [line.split(" -m prehend ")[1] for line in block.splitlines()]


class Benchmark(takes.Folder, unittest.TestCase):
    def run_words(self, words, code=0):
        self.assertEqual(command.main([str(word) for word in words]), code, words)

    def test_from_recipe_to_table(self):
        import shlex
        five = [shlex.split(line) for line in commands()]
        self.assertEqual(len(five), 5)
        folder, mine = self.folder, self.folder / "mine.py"
        mine.write_text(MINE, encoding="utf-8")
        recipe = folder / "tabletop.yaml"
        recipe.write_text("recipe: 1\nseed: 3\nheld_out: {layout: [], style: [], thing: [timer, orange]}\n", encoding="utf-8")
        for words in five:
            here = {"tabletop.yaml": recipe, "tabletop": folder / "tabletop", "poses": folder / "poses", "learned": folder / "learned",
                    "chosen": folder / "chosen", "result": folder / "result", "1000": "30",
                    "python3 mine.py": f"{sys.executable} {mine}"}
            words = [here.get(word, word) for word in words]
            if "--robustness" in words:
                words[words.index("--robustness") + 1] = "2"
                more = ["--found", self.found_by_the_grammar()]
                for kind in ("rules", "trees", *CHEATS):
                    more += ["--recogniser", f"{sys.executable} -m prehend baseline {kind} {folder / 'learned'}"]
                words[4:4] = [*more, "--ablate", "2"]  # behind --grammar pick_and_place
            self.run_words(words)
        self.assertIn("these are no results", (folder / "chosen" / "benchmark.md").read_text(encoding="utf-8"))
        result = json.loads((folder / "result" / "benchmark.json").read_text(encoding="utf-8"))
        self.table(result["rows"])
        self.ablation(result["ablations"])
        self.archive()
        self.shards(recipe)
        self.replays()

    def found_by_the_grammar(self):
        """What `resegment` writes of each test episode, as somebody else's files."""
        out = self.folder / "found"
        out.mkdir()
        for row in self.rows("test"):
            takes.program("episode", "resegment", self.folder / "tabletop" / self.files()[row["episode"]], "--episode", row["episode"],
                          "--grammar", "pick_and_place", "-o", out / f"{row['episode']}.csv")
        return out

    def ablation(self, table):
        """The whole grammar is the best; some modifier costs something, and all are there."""
        whole, *others = table["rows"]
        self.assertEqual((whole["without"], whole["episodes_changed"], whole["f1_50_macro_minus_whole"]), ("", 0, [0, 0]))
        self.assertGreater(len(others), 20)
        self.assertTrue(any(one["episodes_changed"] for one in others))
        self.assertGreater(whole["f1_50_macro"], 0.9)

    def archive(self):
        """The table of a second run, and the archive of it, have the same bytes."""
        made = []
        for name in ("one", "two"):
            self.run_words(["benchmark", self.folder / "tabletop", "--grammar", "pick_and_place", "-o", self.folder / name / "result"])
            self.run_words(["dataset", "archive", self.folder / "tabletop", self.folder / name / "result", "--date", "2026-11-26",
                            "-o", self.folder / f"{name}.tar"])
            made.append((self.folder / f"{name}.tar").read_bytes())
        self.assertEqual(*made)
        with tarfile.open(self.folder / "one.tar") as tar:
            names = {one.name.split("/", 1)[1] for one in tar}
        self.assertLess({"LICENSE", "DATASHEET.md", "classes.csv", "classes.png", "CITATION.cff", "SHA256SUMS", "held_out/labels_test.csv",
                         "results/result/benchmark.json"}, names)

    def rows(self, role):
        with open(self.folder / "tabletop" / "episodes.csv", encoding="utf-8") as file:
            return [row for row in csv.DictReader(file) if row["role"] == role]

    def files(self):
        return json.loads((self.folder / "tabletop" / "files.json").read_text(encoding="utf-8"))

    def table(self, rows):
        by = {row["recogniser"].split(" baseline ")[-1].split()[0]: row for row in rows}
        grammar, foreign = by["pick_and_place"], next(row for row in rows if row["recogniser"].endswith("found"))
        for key in ("f1_50_macro", "f1_50_micro", "f1_10_macro", "edit", "f1_50_of", "false_alarms_per_min"):
            self.assertEqual(grammar[key], foreign[key], key)
        self.assertGreater(grammar["f1_50_macro"], 0.9)
        for change in ("turned", "mirrored"):
            self.assertAlmostEqual(grammar["robustness"][change], grammar["robustness"]["none"], delta=0.05, msg=change)
        cheats = max(by[kind]["f1_50_macro"] for kind in CHEATS)
        self.assertLess(cheats, 0.15)
        self.assertGreater(by["trees"]["f1_50_macro"], 2 * cheats)
        self.assertGreater(by["rules"]["f1_50_macro"], cheats)
        self.assertGreater(by["trees"]["f1_50_macro_interval"][0], max(by[kind]["f1_50_macro_interval"][1] for kind in CHEATS))
        self.assertLess(by["rules"]["f1_50_macro_minus_first"][1], 0)

    def shards(self, recipe):
        for part in range(1, 8):
            self.run_words(["dataset", "make", recipe, "--episodes", "30", "--shard", f"{part}/7", "-o", self.folder / f"part{part}"])
        again = self.folder / "again"
        self.run_words(["dataset", "join", *(self.folder / f"part{part}" for part in (3, 1, 2, 5, 7, 6, 4)), "-o", again])
        compared = [path.relative_to(again) for path in again.rglob("*") if path.is_file() and path.suffix != ".episodes" and path.name != "files.json"]
        self.assertGreater(len(compared), 40)
        for path in compared:
            self.assertEqual((again / path).read_bytes(), (self.folder / "tabletop" / path).read_bytes(), path)

    def replays(self):
        files = sorted((self.folder / "tabletop").glob("*.episodes"))
        takes.program("episode", "verify", *files)
        hashes = {row["episode"]: row["state_hash"] for role in ("train", "dev", "test") for row in self.rows(role)}
        self.assertEqual(len(hashes), 30)
        scenario = self.folder / "tabletop" / "scenarios" / f"{self.rows('train')[0]['episode']}.yaml"
        played = json.loads(takes.program("run", scenario, "--json"))
        self.assertEqual(played["state_hash"], hashes[scenario.stem])
        self.assertGreaterEqual(len(prehend.open([str(file) for file in files])), 30)


if __name__ == "__main__":
    unittest.main()
