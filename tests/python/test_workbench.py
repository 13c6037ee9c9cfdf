# SPDX-License-Identifier: Apache-2.0
"""python3 -m prehend mutate, on recordings whose survivors are known on paper."""
import contextlib
import io
import json
import unittest

import prehend
from prehend import __main__ as command
from prehend import _prehend, mutants, worlds
import takes

SHELF = """grammar shelf
param low = 10 cm
event shelved(a: Movable)
  while height(a) > low and not height(a) > 1 m
  bridging 50 ms
  lasting 0.2 s
"""


def run(*words):
    """(exit code, standard output, standard error) of `python3 -m prehend`."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = command.main([str(word) for word in words])
    return code, out.getvalue(), err.getvalue()


class Workbench(takes.Folder, unittest.TestCase):
    def cup(self, name, heights_m):
        """A cup at these heights, a tenth of a second each."""
        head = {"recording": 1, "episode": name, "grammar": "shelf", "ticks_per_second": 1000, "bridge_s": 0,
                "entities": {"cup": {"class": "Cup", "size_m": [0.1, 0.1, 0.1]}}}
        lines = [head, *({"tick": 100 * i, "samples": {"cup": {"at_m": [0, 0, one]}}} for i, one in enumerate(heights_m)),
                 {"end_tick": 100 * len(heights_m)}]
        (self.folder / f"{name}.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines), "utf-8")
        return self.folder / f"{name}.jsonl"

    def shelf(self):
        (self.folder / "shelf.grammar").write_text(SHELF, "utf-8")
        return self.folder / "shelf.grammar"

    def test_a_syntax_tree_has_places(self):
        _, ((name, place, words, _),) = _prehend.syntax("x", "grammar x\nevent e(a: Hand) while (known a or b) and c lasting 2 s")
        self.assertEqual((name, place, [word for word, _ in words]), ("e", (2, 7), ["while", "lasting"]))
        kind, text, at, begin, end, (both, last) = words[0][1]
        self.assertEqual((kind, text, at, begin, end), ("chain", "and", (2, 39), (2, 24), (2, 44)))
        self.assertEqual((both[:2], both[3:5], last[:2]), (("chain", "or"), ((2, 24), (2, 38)), ("name", "c")))
        with self.assertRaisesRegex(prehend.Error, "x:1:1"):
            _prehend.syntax("x", "event")

    def test_mutants_are_killed_by_what_they_change(self):
        files = [self.cup("low", [0.04, 0.5, 0.5, 0.5, 0.07, 0.5, 0.07]), self.cup("high", [0.5, 0.5, 0.5, 1.5, 1.5, 1.5, 1.5, 0.04])]
        code, out, _ = run("mutate", *files, "--grammar", self.shelf(), "--json", "--frames", 2500, "--jobs", 2)
        self.assertEqual(code, 0)
        result = json.loads(out)
        ends = {row["what"]: row["end"] for row in result["all"]}
        self.assertEqual({one: ends[one] for one in ends if one.startswith("low")},
                         {"low: 10 -> 5": "killed", "low: 10 -> 8": "survived", "low: 10 -> 12.5": "survived", "low: 10 -> 20": "survived"})
        for killed in ("dropped: not", "dropped: height(a) > low", "dropped: not height(a) > 1 m", "lasting: 0.2 -> 0.1",
                       "shelved: dropped: lasting 0.2 s", "while: 1 -> 2"):
            self.assertEqual(ends[killed], "killed", killed)
        for left in ("bridging: 50 -> 62.5", "shelved: dropped: bridging 50 ms", "while: 1 -> 1.25"):
            self.assertIn(ends[left], ("survived", "equivalent"), left)
        bridged = next(row for row in result["all"] if row["what"] == "bridging: 50 -> 100")
        self.assertEqual((bridged["end"], bridged["episode"], bridged["shift_s"]), ("survived", "low", 0.2))  # two frames
        low = next(row for row in result["all"] if row["what"] == "low: 10 -> 12.5")
        self.assertEqual((low["line"], low["column"], low["episode"]), (2, 13, "low"))
        self.assertAlmostEqual(low["nearest"], 0.03)
        self.assertEqual(result["mutants"], sum(result[end] for end in ("killed", "survived", "not reached", "equivalent")))

    def test_a_share_that_is_too_small_fails_and_says_where(self):
        dull = self.cup("dull", [0.5, 0.5, 0.5, 0.5])
        code, out, err = run("mutate", dull, "--grammar", self.shelf(), "--fail-below", 90, "--frames", 0, "--jobs", 1)
        self.assertEqual(code, 1)
        self.assertRegex(out, r"shelf.grammar:2:13: low: 10 -> 20; dull is nearest, 0.4 m away")
        self.assertRegex(err, "of the mutants are killed, wanted 90 %")
        self.assertEqual(run("mutate", "none.jsonl", "--grammar", self.shelf())[0], 2)
        self.assertEqual(run("mutate", dull, "--grammar", "no_such_grammar")[0], 2)

    def test_every_mutant_of_the_library_compiles_and_is_another_text(self):
        texts = mutants.texts("pick_and_place")
        self.assertEqual([file.rsplit("/", 1)[1] for file in texts][0], "pick_and_place.grammar")
        found = mutants.mutants("pick_and_place", [])
        self.assertGreater(len(found), 300)
        for one in found:
            self.assertNotEqual(one.text, texts[one.file], one.what)

    def test_a_random_world_is_the_same_each_time(self):
        files = [self.folder / "a.jsonl", self.folder / "b.jsonl"]
        for file in files:
            worlds.write(file, 7)
        self.assertEqual(files[0].read_bytes(), files[1].read_bytes())
        found = prehend.Grammar("pick_and_place").segment(prehend.open(files[0]))
        self.assertTrue({"grasping", "picking_up", "transporting"} <= set(found["event"]))


if __name__ == "__main__":
    unittest.main()
