# SPDX-License-Identifier: Apache-2.0
"""Recipes and the table, without playing: what is drawn, what is held out, what is counted."""
import copy
import json
import math
import os
import pathlib
import pickle
import re
import subprocess
import sys
import tempfile
import unittest

import takes
from prehend import EpisodeError, baselines, benchmark, dataset, datasheet, errors, recipe, robustness, scenes

HASHED = recipe.read(recipe.HERE / "tabletop.yaml")


def drawn(count):
    """Episodes that can be written, as the generator draws them."""
    for index in range(count):
        for attempt in range(20):
            try:
                text, words, _ = scenes.written(*HASHED, index, attempt)
            except scenes.Unplayable:
                continue
            yield index, text, words
            break


class Recipe(unittest.TestCase):
    def test_sixty_things_and_each_style_has_some(self):
        things = recipe.things()
        self.assertEqual(len(things), 60)
        for style in set(HASHED[0]["style"]) - recipe.ON_HANDLES:
            self.assertGreaterEqual(sum(recipe.fits(style, one) for one in things.values()), 2, style)

    def test_the_order_of_words_means_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "r.yaml")
            path.write_text("recipe: 1\nhand: {right: 8, left: 2}   # as it is\nname: tabletop\n", encoding="utf-8")
            self.assertEqual(recipe.read(path)[1], HASHED[1])
            path.write_text("recipe: 1\nhand: {right: 7, left: 3}\n", encoding="utf-8")
            self.assertNotEqual(recipe.read(path)[1], HASHED[1])
            for wrong in ("recipe: 2\n", "recipe: 1\nlayuot: {kitchen: 1}\n", "recipe: 1\nlayout: [kitchen]\n", "recipe: 1\npace: {mean: 1}\n", "- 1\n"):
                path.write_text(wrong, encoding="utf-8")
                with self.assertRaises(EpisodeError, msg=wrong):
                    recipe.read(path)
            for word, text in (("mass", "{uniform: [0.1, 0.1]}"), ("pace", "{uniform: [2, 1]}"), ("mass", "{normal: [0.8, -1]}"), ("friction", "[1]"),
                               ("dev", "2"), ("test", "0.9"), ("of_person", "{lift_m: {uniform: [.nan, 1]}}"), ("of_person", "{heigth_m: {normal: [1, 1]}}")):
                path.write_text(f"recipe: 1\n{word}: {text}\n", encoding="utf-8")
                with self.assertRaisesRegex(EpisodeError, r"r\.yaml:2:1: error: .*\n  hint: |friction.*found \[1\]|lift_m.*found"):
                    recipe.read(path)

    def test_numbers_are_those_of_every_machine(self):
        draw = recipe.Draw("a", 1)
        self.assertEqual([round(draw.unit(), 12) for _ in range(2)], [0.959823643934, 0.915954946785])
        self.assertEqual(list(drawn(12)), list(drawn(12)))

    def test_nothing_stands_where_a_hand_puts_down_what_it_was_given(self):
        handed = [text for _, text, words in drawn(400) if words["skill"] == "hand_over" and words["outcome"] == "success"]
        self.assertGreater(len(handed), 5)
        for text in handed:
            place = [float(word) for word in re.search(r"carry_to_m: \[(.*?), (.*?)\]", text).groups()]
            for x, y in re.findall(r"on: table, at_m: \[(.*?), (.*?)\]", text):
                if float(x) != 0.2 or abs(float(y)) != 0.1:  # what is handed over
                    self.assertGreater(math.dist(place, (float(x), float(y))), 0.2, text)

    def test_counts_are_those_of_the_recipe(self):
        rows = [{"words": recipe.words(*HASHED, index)} for index in range(4000)]
        for word, (square, freedom, chance) in datasheet.chi_square(HASHED[0], rows).items():
            self.assertGreater(chance, 0.001, (word, square, freedom))
        self.assertGreater(sum(row["words"]["outcome"] != "success" for row in rows), 1000, "a quarter fails")

    def test_nothing_that_is_held_out_is_trained_on(self):
        seen, held = set(), {axis: set(names) for axis, names in HASHED[0]["held_out"].items()}
        for index, text, words in drawn(300):
            role, asks = recipe.role(*HASHED, index, words)
            seen |= {(role, ask) for ask in asks} | {(role, "")}
            if role == "test":
                continue
            for axis, names in held.items():
                self.assertFalse(names & set(words[axis] if isinstance(words[axis], list) else [words[axis]]), (index, axis))
            for thing in held["thing"]:
                self.assertNotIn(f"  {thing}:", text, index)
        self.assertEqual({ask for role, ask in seen if role == "test"}, {"", *recipe.QUESTIONS})
        self.assertTrue({("train", ""), ("dev", "")} <= seen)


class Table(unittest.TestCase):
    def test_a_true_event_is_taken_once(self):
        self.assertEqual(benchmark.hits([(0, 1)], [(0, 1), (0, 1)], 0.5), 1)
        self.assertEqual(benchmark.hits([(0, 1), (2, 3)], [(2.1, 3), (0, 0.4)], 0.5), 1)
        self.assertEqual(benchmark.hits([(0, 1)], [(0, 0.4)], 0.25), 1)

    def test_labels_of_another_hash_are_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "labels_test.csv")
            path.write_text("episode,event\n", encoding="utf-8")
            with self.assertRaises(EpisodeError):
                benchmark.read_labels(path, "test", {"sha256": {"held_out/labels_test.csv": "0" * 64}})

    def test_what_is_not_there_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(EpisodeError, "it has no file NAME.episodes"):
                dataset.main(["export", folder, "--to", "csv", "-o", f"{folder}/poses"])
            pathlib.Path(folder, "manifest.json").write_text("{}", encoding="utf-8")
            pathlib.Path(folder, "episodes.csv").write_text("episode,role,asks\n", encoding="utf-8")
            with self.assertRaisesRegex(EpisodeError, "no episode is of the dev split$"):
                benchmark.main([folder, "--split", "dev", "--grammar", "contact", "-o", f"{folder}/result"])

    def test_changes_keep_what_they_say(self):
        lines = [{"episode": "e", "ticks_per_second": 480, "entities": {"cup": {"centre_m": [0, 0.1, 0]}, "hand": {"hand": True}}}]
        lines += [{"tick": tick, "samples": {"cup": {"at_m": [0.1, 0.2, 0.3], "quat_wxyz": [0.5, 0.5, 0.5, 0.5], "w_rad_per_s": [1, 2, 3]}},
                   "hands": {"hand": {"ahead": [1, 0, 0], "collision_spheres_m": [[0, 1, 2, 0.01]]}}, "touches": []} for tick in range(2, 100, 8)]
        lines.append({"end_tick": 100})

        def after(*changes):
            now = iter(copy.deepcopy(lines))
            for change in changes:
                now = change(now)
            return list(now)
        self.assertEqual(after(robustness.mirrored, robustness.mirrored), lines)
        one = after(robustness.turned)[1]["samples"]["cup"]["at_m"]
        self.assertAlmostEqual(one[0] ** 2 + one[1] ** 2, 0.05)
        slow = after(robustness.slow)
        self.assertEqual([line["tick"] for line in slow[1:-1]], [2, 26, 50, 74, 98])
        self.assertEqual(after(robustness.noisy), after(robustness.noisy))
        self.assertNotEqual(after(robustness.noisy)[1], lines[1])
        json.dumps(slow)


class Drafts(takes.Folder, unittest.TestCase):
    """A draft that failed stays in its batch's file, and in nothing that is made of the set."""

    def test_what_failed_is_not_exported(self):
        text = ("scenario: NAME\nshows: a hand that waits\ngrammar: pick_and_place\nworld: {rate_hz: 480, sensing_hz: 60}\nentities:\n"
                "  table: {class: Table, fixed: true, box: {size_m: [0.8, 0.8, 0.04]}, at_m: [0, 0, 0.7]}\nCUP"
                "actors: {right_hand: {hand: human_right, at_m: [0, 0, 1]}}\nscript:\n  - right_hand: {wait_s: 0.2}\n")
        cup = "  cup: {class: Cup, box: {size_m: [0.1, 0.1, 0.1]}, mass_kg: 1, at_m: [0, 0, -19.8]}\n"  # leaves the world, which has 20 m
        for name, more in (("e00000", ""), ("e00001", cup)):
            (self.folder / f"{name}.yaml").write_text(text.replace("CUP", more).replace("NAME", name), encoding="utf-8")
        takes.program("check", self.folder / "e00000.yaml", self.folder / "e00001.yaml", "--no-pictures", "--report", self.folder / "report",
                      "--record", self.folder / "test_001.episodes", code=3)
        self.assertEqual(len(takes.program("episode", "list", self.folder / "test_001.episodes").splitlines()), 3)
        made = robustness.recordings(self.folder, {"e00000": "test_001.episodes"}, ["e00000"], str(self.folder / "plain"))
        self.assertEqual([pathlib.Path(one).name for one in made], ["e00000.jsonl"])
        self.assertEqual(dataset.main(["export", str(self.folder), "--to", "csv", "-o", str(self.folder / "poses")]), 0)
        self.assertEqual({path.name.split(".")[0] for path in (self.folder / "poses").iterdir()}, {"e00000"})


class OfStrangers(unittest.TestCase):
    """Sets and models that somebody else made name no file outside of their folder, and run nothing."""

    def test_names_leave_no_folder(self):
        about = {"recipe": HASHED[0], "recipe_sha256": HASHED[1], "episodes": 1, "shard": [1, 1], "redrawn": {}}
        for key, name in (("episode", "../evil"), ("episode", "/tmp/evil"), ("episode", "a\nb"), ("episode", "-o"), ("episode", ".."), ("file", "../../x"), ("file", "")):
            with tempfile.TemporaryDirectory() as folder, self.subTest(name):
                shard = pathlib.Path(folder, "shard")
                shard.mkdir()
                (shard / "shard.json").write_text(json.dumps(about), encoding="utf-8")
                row = {"episode": "e00000", "file": "train_001.episodes", "role": "train", "scenario": "x", "labels": [], "extra": [], "claims": []} | {key: name}
                (shard / "rows.jsonl").write_text(json.dumps(row) + "\n", encoding="utf-8")
                with self.assertRaisesRegex(EpisodeError, "found the name"):
                    dataset.join_into(pathlib.Path(folder, "set"), [shard])
                self.assertEqual(sorted(path.name for path in pathlib.Path(folder).rglob("*")), ["rows.jsonl", "set", "shard", "shard.json"])

    def test_a_table_runs_nothing(self):
        for text, shown in (("=cmd|' /C calc'!A0", True), ("+1+cmd", True), ("-2+3", True), ("@SUM(1)", True), ("-0.5", False), ("+1e-07", False), ("reach", False)):
            self.assertEqual(errors.cell(text), "'" + text if shown else text)
        self.assertEqual(errors.cell(-0.5), -0.5)

    def test_a_model_calls_nothing(self):
        class Evil:
            def __init__(self, call):
                self.call = call

            def __reduce__(self):
                return self.call

        with tempfile.TemporaryDirectory() as folder:
            trace = pathlib.Path(folder, "ran")
            for call in ((os.system, (f"touch {trace}",)), (eval, (f"open({str(trace)!r}, 'w')",)), (subprocess.check_output, (["touch", str(trace)],))):
                pathlib.Path(folder, "memory.pickle").write_bytes(pickle.dumps({"schedule": Evil(call)}))
                with self.assertRaisesRegex(EpisodeError, "wanted a model"):
                    baselines.main(["schedule", folder])
            self.assertFalse(trace.exists())

    def test_control_characters_are_shown(self):
        said = subprocess.run([sys.executable, "-m", "prehend", "push", "\x1b[31mx\u202e.episodes", "postgresql://nobody@127.0.0.1:1/x"], capture_output=True, check=False)
        self.assertEqual(said.returncode, 2)
        self.assertIn(b"\\u001b[31mx\\u202e.episodes: no such file", said.stderr)


if __name__ == "__main__":
    unittest.main()
