# SPDX-License-Identifier: Apache-2.0
"""python3 -m prehend mutate, on recordings whose survivors are known on paper; shrink, whose smallest is known;
falsify, by a threshold that is ten percent off."""
import contextlib
import io
import json
import os
import re
import subprocess
import sys
import unittest

import prehend
from prehend import __main__ as command
from prehend import EpisodeError, _prehend, falsify, mutants, mutate, shrink, worlds
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
        self.assertRegex(out, r"shelf.grammar:2:13: low: 10 -> 20; dull is nearest, 0.4 m from the threshold")
        self.assertRegex(err, "of the mutants are killed, wanted 90 %")
        self.assertEqual(run("mutate", "none.jsonl", "--grammar", self.shelf())[0], 2)
        self.assertEqual(run("mutate", dull, "--grammar", "no_such_grammar")[0], 2)

    def test_what_is_no_mistake_has_its_reason_beside_the_grammar(self):
        file = self.cup("low", [0.04, 0.5, 0.5, 0.5, 0.07, 0.5, 0.07])
        grammar, beside = self.shelf(), self.folder / "equivalent_mutants.tsv"
        rows = ["# file, line, mistake, reason", "shelf.grammar\tparam low = 10 cm\tlow: 10 -> 20\tno cup is so low",
                "shelf.grammar\tlasting 0.2 s\tlasting: 0.2 -> 0.4\twrong"]
        beside.write_text("\n".join(rows) + "\n", "utf-8")
        words = ["mutate", file, "--grammar", grammar, "--frames", 0, "--jobs", 1]
        code, out, _ = run(*words)
        self.assertEqual(code, 0)
        self.assertRegex(out, r"no mistake: 1\n  .*shelf.grammar:2:13: low: 10 -> 20; no cup is so low\n")
        self.assertRegex(out, r"killed, though said to be no mistake: 1\n  .*lasting: 0.2 -> 0.4; wrong\n")
        result = json.loads(run(*words, "--json")[1])
        self.assertEqual([row["reason"] for row in result["all"] if row["end"] == "equivalent"], ["no cup is so low"])
        beside.write_text("shelf.grammar\tlow\n", "utf-8")
        code, _, err = run(*words)
        self.assertEqual((code, "tsv:1: error: found 2 columns, wanted 4" in err), (2, True))

    def test_what_is_said_of_the_library_is_of_mutants_that_there_are(self):
        texts = mutants.texts("pick_and_place")
        found = {(one.file, texts[one.file].splitlines()[one.line - 1].strip(), one.what) for one in mutants.mutants("pick_and_place", [])}
        said = mutate.reasons(texts)
        self.assertEqual(len(said), 25)
        self.assertEqual(set(said) - found, set())

    def test_clauses_that_nothing_shows_both_ways_are_clauses_of_the_library(self):
        library = takes.ROOT / "grammar/library"
        rows = [line.split("\t") for line in (library / "undecided_clauses.tsv").read_text("utf-8").splitlines() if line[0] != "#"]
        self.assertGreater(len(rows), 20)
        for file, source, clause, reason in rows:
            self.assertIn(source, [line.strip() for line in (library / file).read_text("utf-8").splitlines()])
            self.assertTrue(reason and (clause in source or re.match("bridging|lasting|within|at most", clause)), clause)

    def test_a_mutant_of_no_clause_meets_all_episodes(self):
        self.assertEqual(mutate.order_of(mutants.Mutant("x", 1, 1, "y", ""), [], 3)[0], [0, 1, 2])

    def test_every_mutant_of_the_library_compiles_and_is_another_text(self):
        texts = mutants.texts("pick_and_place")
        self.assertEqual([file.rsplit("/", 1)[1] for file in texts][0], "pick_and_place.grammar")
        found = mutants.mutants("pick_and_place", [])
        self.assertGreater(len(found), 300)
        for one in found:
            self.assertNotEqual(one.text, texts[one.file], one.what)

    def test_what_is_left_is_needed(self):
        asked = []

        def keeps(some):
            asked.append(some)
            return {3, 11} <= set(some)

        self.assertEqual(shrink.fewer(list(range(16)), keeps), [3, 11])
        self.assertLess(len(asked), 40)
        self.assertEqual(shrink.fewer([1, 2, 3], lambda some: True), [])

    def test_one_thing_takes_the_place_of_another(self):
        tree = {"scenario": "x", "entities": {"table": {"fixed": True}, "shelf": {"fixed": True}, "cup": {"on": "shelf"}},
                "script": [{"hand": {"reach": "cup"}}, {"hand": {"carry_to_m": [0, 0]}}, {"hand": {"place_on": "table"}}]}
        left = shrink.merge_two(tree, lambda now: len(now["script"]) == 2 and now["entities"].get("cup", {}).get("on") == "shelf")
        self.assertEqual(list(left["entities"]), ["shelf", "cup"])
        self.assertEqual(left["script"][-1], {"hand": {"place_on": "shelf"}})

    def test_a_thing_falls_onto_another_one_or_is_fixed(self):
        tree = {"scenario": "x", "entities": {"table": {"fixed": True, "at_m": [0, 1, 0.7]},
                                              "cup": {"mass_kg": 0.2, "on": "table", "at_m": [0.3, 0]}},
                "actors": {"hand": {}}, "script": [{"hand": {"reach": "cup"}}]}
        idle = shrink.elsewhere(tree, lambda now: not now["script"])
        self.assertEqual(idle, {"scenario": "x", "script": [], "entities": {
            "table": {"fixed": True, "at_m": [0, 1, 0.7]}, "cup": {"mass_kg": 0.2, "at_m": [0, 1, 0.7 + 0.2]}}})
        fixed = shrink.elsewhere(tree, lambda now: now["script"])
        self.assertEqual(fixed["entities"]["cup"], {"fixed": True, "at_m": [0.3, 0, 0.7 + 0.2]})
        self.assertEqual(shrink.elsewhere(tree, lambda now: False), tree)

    def test_what_can_never_be_is_no_condition(self):
        for text, said in (("", "wanted what has to stay"), ("not ", "wanted what has to stay"), ("missing slidng", "did you mean 'sliding'"),
                           ("verdict good", "there is no verdict 'good'")):
            with self.assertRaisesRegex(EpisodeError, said):
                shrink.Condition(text).check(["pick_and_place"])
        shrink.Condition("missing sliding(right_hand, milk)").check(["pick_and_place"])

    def test_a_scenario_shrinks_to_what_the_condition_needs(self):
        tree = shrink.read(takes.ROOT / "scenarios/put_down/slow_put_down.yaml")
        self.assertEqual(tree["entities"]["milk"]["on"], "table")

        class Player:  # keeps what it must: the carton, the grasp, and a wait of at least 0.15 s
            wrong = ""

            def keeps(self, now):
                steps = [step for stage in now.get("script", []) for step in stage.values()]
                return "milk" in now["entities"] and any("close_to" in one for one in steps) and any(one.get("wait_s", 0) >= 0.15 for one in steps)

        small = shrink.shrink(tree, Player())
        self.assertEqual(list(small["entities"]), ["milk"])
        self.assertEqual(small["script"], [{"right_hand": {"close_to": 1}}, {"right_hand": {"wait_s": 0.15}}])
        self.assertNotIn("tags", small)
        self.assertEqual(shrink.shrink(tree, Player()), small)
        (self.folder / "small.yaml").write_text(shrink.text_of(small), "utf-8")
        self.assertEqual(shrink.read(self.folder / "small.yaml"), small)

    def test_a_played_scenario_shrinks_to_a_file_that_check_takes(self):
        (self.folder / "short_back.grammar").write_text("grammar short_back\nuse pick_and_place with put_back = 1 s\n", "utf-8")
        file = self.folder / "small.yaml"
        words = ["shrink", takes.ROOT / "scenarios/put_down/slow_put_down.yaml", "--grammar", self.folder / "short_back.grammar", "-o", file,
                 "--budget", 9, "--keep"]
        code, _, err = run(*words, "missing putting_down")
        self.assertEqual(code, 0, err)
        self.assertRegex(err, "2 entities, 9 steps -> 2 entities, [5-8] steps, 9 plays")
        verdict = json.loads(takes.program("check", file, "--grammar", self.folder / "short_back.grammar", "--json", "--no-pictures", "--report",
                                           self.folder / "report", code=None))["scenarios"][0]
        self.assertEqual(verdict["errors"], [])
        self.assertRegex(verdict["details"], "ground truth: putting_down.* not recognised")
        code, _, err = run(*words, "extra sliding")
        self.assertEqual((code, "does not show what is to be kept" in err), (2, True))

    def test_a_recording_shrinks_to_a_window_and_its_bodies(self):
        t, arrays = takes.carried()
        file = self.folder / "take.jsonl"
        takes.json_lines(file, {**arrays, "bystander": arrays["cup"] + 0.7}, range(len(t)), 60,
                         {**{name: {"class": "Cup", "size_m": [0.07, 0.07, 0.2]} for name in ("cup", "bystander")},
                          "right_hand": {"hand": True, "size_m": [0.09, 0.084, 0.025]}})
        for name, far in (("near", 0.2), ("far", 0.3)):
            (self.folder / f"{name}.grammar").write_text(
                f"grammar {name}\nevent beside(hand: Hand, cup: Cup) while distance(hand, cup) > {far} m\n", "utf-8")
        code, out, err = run("shrink", file, "--grammar", self.folder / "near.grammar", "--against", self.folder / "far.grammar", "--keep",
                             "moved beside(right_hand, cup)")
        self.assertEqual(code, 0, err)
        lines = [json.loads(line) for line in out.splitlines()]
        self.assertEqual(set(lines[0]["entities"]), {"right_hand", "cup"})
        self.assertLess(len(lines), 60)
        self.assertEqual(run("shrink", file, "--keep", "moved beside")[0], 2)

    def varied(self):
        text = (takes.ROOT / "scenarios/slide/four_centimetres_are_a_slide.yaml").read_text("utf-8")
        text = text.replace("scenario: four_centimetres_are_a_slide", "scenario: varied") + \
            "vary:\n  - {fields: [script.3.right_hand.move_by_m.0], uniform: [0.002, 0.08]}\n"
        (self.folder / "varied.yaml").write_text(text, "utf-8")
        (self.folder / "far.grammar").write_text("grammar far\nuse pick_and_place with slide_distance = 2.2 cm\n", "utf-8")
        return self.folder / "varied.yaml"

    def test_ranges_are_those_of_vary(self):
        tree = {"scenario": "x", "entities": {"cup": {"mass_kg": 0.5, "at_m": [1, 2]}}, "outcomes": {}, "vary": [
            {"fields": ["entities.cup.mass_kg"], "times": [1, 3]}, {"fields": ["entities.cup.at_m.0", "entities.cup.at_m.1"], "plus": [-1, 1]},
            {"fields": ["world.seed"], "choose": [3, 4]}, {"fields": ["settle_s"], "normal": [1, 0.1]}]}
        ranges = falsify.Ranges(tree, "x.yaml")
        self.assertEqual(ranges.values([0.5, 0.25, 0.9, 1]), {"entities.cup.mass_kg": 1.0, "entities.cup.at_m.0": 0.5, "entities.cup.at_m.1": 1.5,
                                                              "world.seed": 4, "settle_s": 1.3})
        self.assertEqual(ranges.scenario([0, 0.5, 0, 0.5]), {"scenario": "x", "entities": {"cup": {"mass_kg": 0.5, "at_m": [1.0, 2.0]}},
                                                             "world": {"seed": 3}, "settle_s": 1.0})
        self.assertEqual(run("falsify", "pick_and_place", "--scenario", takes.ROOT / "scenarios/slide/hop_divides_a_slide.yaml")[0], 2)

    def test_a_threshold_ten_percent_off_is_found_and_written(self):
        words = ["falsify", self.varied().with_name("far.grammar"), "--scenario", self.folder / "varied.yaml", "--against", "pick_and_place"]
        code, out, err = run(*words, "--budget", 40, "-o", self.folder / "found.yaml", "--shrink", 0)
        self.assertEqual(code, 1, out + err)
        self.assertRegex(out, r"play \d+: missing sliding\(right_hand, milk\)")
        found = shrink.read(self.folder / "found.yaml")
        self.assertNotIn("vary", found)
        self.assertTrue(0.015 < found["script"][3]["right_hand"]["move_by_m"][0] < 0.03)
        for grammar, is_found in (("pick_and_place", True), (self.folder / "far.grammar", False)):
            events = json.loads(takes.program("run", self.folder / "found.yaml", "--grammar", grammar, "--json"))["events"]
            self.assertEqual(any(one["event"] == "sliding" for one in events), is_found)

    def test_a_grammar_and_itself_do_not_part(self):
        self.varied()
        code, out, _ = run("falsify", "pick_and_place", "--scenario", self.folder / "varied.yaml", "--against", "pick_and_place", "--budget", 2)
        self.assertEqual((code, out), (0, "nothing in 2 plays\n"))

    def test_the_page_is_typed_as_it_stands(self):
        page = (takes.ROOT / "docs/workbench.md").read_text("utf-8")
        bin_ = self.folder / "bin"
        bin_.mkdir()
        for name, target in (("prehend", os.path.realpath(prehend.program())), ("python3", sys.executable)):
            (bin_ / name).symlink_to(target)
        package = os.path.dirname(os.path.dirname(os.path.abspath(prehend.__file__)))
        surroundings = {**os.environ, "PATH": f"{bin_}:{os.environ['PATH']}", "PYTHONPATH": package}
        surroundings.pop("PREHEND_HOME", None)
        folder, said = self.folder, {}
        for line in "\n".join(re.findall(r"```sh\n(.*?)```", page, re.S)).splitlines():
            if line.startswith("cd "):
                folder = folder / line[3:]
                continue
            done = subprocess.run(["bash", "-c", line], cwd=folder, env=surroundings, capture_output=True, text=True, check=False)
            said[line] = done.stdout + done.stderr
            self.assertIn(done.returncode, (0, 1, 5), f"{line}: {done.stdout}{done.stderr}")
        self.assertEqual(len(said), 15)
        words = lambda of: next(out for line, out in said.items() if of in line)
        self.assertIn("episodes show as much as all", words("coverage suite"))
        self.assertIn("slide_distance: 5 -> 10", words("mutate"))
        self.assertRegex(words("shrink scenarios"), "2 entities, 6 steps -> 2 entities, [1-5] steps")
        self.assertIn("slide_distance", words("explain small.yaml"))
        self.assertRegex(words("shrink take.jsonl"), "3 of 3 bodies|2 of 3 bodies")
        self.assertRegex(words("--against pick_and_place --shrink"), "play [1-9]: missing sliding")
        self.assertRegex(words("--budget 20"), "missing sliding")

    def test_a_random_world_is_the_same_each_time(self):
        files = [self.folder / "a.jsonl", self.folder / "b.jsonl"]
        for file in files:
            worlds.write(file, 7)
        self.assertEqual(files[0].read_bytes(), files[1].read_bytes())
        found = prehend.Grammar("pick_and_place").segment(prehend.open(files[0]))
        self.assertTrue({"grasping", "picking_up", "transporting"} <= set(found["event"]))


if __name__ == "__main__":
    unittest.main()
