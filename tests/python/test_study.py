# SPDX-License-Identifier: Apache-2.0
"""Scores, margins, explanations, signals, labels per frame, and what a notebook shows."""
import json
import unittest
import warnings
import xml.etree.ElementTree

import numpy as np
import pandas as pd

import prehend
import takes


class Study(takes.Folder, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        warnings.simplefilter("ignore", prehend.MissingFacts)
        takes.program("import", "docs/motion_capture/poses.csv", "--map", "docs/motion_capture/bodies.yaml", "-o",
                      cls.folder / "milk.jsonl")
        cls.grammar = prehend.Grammar("pick_and_place_from_motion")
        cls.milk = prehend.open(cls.folder / "milk.jsonl")[0]
        cls.labels, cls.map = takes.ROOT / "docs/motion_capture/labels.csv", takes.ROOT / "docs/motion_capture/labels.yaml"

    def test_score_is_the_programs(self):
        mine = self.grammar.score(self.milk, self.labels, map=self.map)
        told = json.loads(takes.program("score", self.folder / "milk.jsonl", "--truth", self.labels, "--map", self.map,
                                        "--json"))["grammars"][0]
        self.assertEqual([*mine.index[:-1]], [one["event"] for one in told["events"]])
        for one in told["events"] + [told["total"]]:
            for name in ("true", "found", "f1_10", "f1_50", "edit", "collar_f"):
                self.assertEqual(mine.loc[one["event"], name], one[name], (one["event"], name))
            median = one["begin_s"]["median"]  # null of what is never matched
            np.testing.assert_equal(mine.loc[one["event"], "begin_s_median"], np.nan if median is None else median)

    def test_score_against_tables(self):
        found = self.grammar.segment(self.milk)
        self.assertEqual(self.grammar.score(found, found).loc["all", "f1_50"], 1.0)
        some = found[found["event"].isin(["grasping", "transporting"])].copy()
        some["begin_s"] += 0.2
        scores = self.grammar.score(self.milk, some)
        self.assertEqual(list(scores.index), ["grasping", "transporting", "all"])
        self.assertAlmostEqual(scores.loc["grasping", "begin_s_median"], -0.2, 4)
        by_name = pd.DataFrame({"begin_s": [1.5], "end_s": [4.1], "label": ["grasping"]})
        self.assertEqual(self.grammar.score(found, by_name).loc["grasping", "f1_50"], 1.0)
        two = self.grammar.score([self.milk, found], [by_name, by_name])
        self.assertEqual(two.loc["all", "true"], 2)

    def test_labels_are_counted_as_the_program_does(self):
        head, *rows = self.labels.read_text().splitlines()
        few = [head, rows[0], rows[4]]
        cases = {"no label": ([head], self.map), "no label and no map": (["begin_s,end_s,label"], None),
                 "few labels": (few, self.map), "a row twice": ([*few, rows[4]], self.map),
                 "rows that overlap": ([*few, "3.35,3.6,put down,right"], self.map),
                 "a moment": ([head, "2,2,carry,right", rows[1]], self.map),
                 "a moment alone": ([head, "2,2,carry,right"], self.map)}
        collars = self.folder / "collars.yaml"
        collars.write_text(self.map.read_text() + "collar_ms: {reaching: 400}\njoin_s: 5\n")
        cases["collars, and labels that are joined"] = ([head, *rows, "4.5,4.7,put down,right"], collars)
        for name, (lines, meaning) in cases.items():
            with self.subTest(name), warnings.catch_warnings():
                warnings.simplefilter("ignore", prehend.DoubtfulLabels)
                file = self.folder / "some.csv"
                file.write_text("\n".join(lines) + "\n")
                told = json.loads(takes.program("score", self.folder / "milk.jsonl", "--truth", file, "--json",
                                                *(["--map", meaning] if meaning else [])))["grammars"][0]
                want = pd.json_normalize(told["events"] + [told["total"]], sep="_").set_index("event").apply(pd.to_numeric)
                pd.testing.assert_frame_equal(self.grammar.score(self.milk, file, map=meaning), want)
        empty = pd.DataFrame({"begin_s": [], "end_s": [], "label": []})
        total = self.grammar.score(self.milk, empty).loc["all"]
        self.assertEqual((total["true"], total["found"]), (0, len(self.milk.events)))
        self.assertEqual(total["ward_inserted"], total["found"], "all that is found is too much")
        scores = self.grammar.score(self.milk, empty)
        self.assertEqual({str(scores[name].dtype) for name in scores if name.startswith("begin_s")}, {"float64"})
        self.assertTrue(scores["begin_s_median"].isna().all(), "nothing is matched")
        self.assertEqual((total["further_psds"], total["further_intersection_f1"]), (0, 0))

    def test_columns_of_roles_are_roles(self):
        rows = {"begin_s": [1.5], "end_s": [4.1], "label": ["grasping"], "hand": ["right_hand"], "object": ["milk"]}
        right = self.grammar.score(self.milk, pd.DataFrame(rows)).loc["grasping"]
        self.assertEqual((right["found"], right["f1_50"]), (1, 1.0))
        with self.assertRaisesRegex(prehend.Error, "truth, row 0: error: the recording has no entity 'mlik'\n.*\n.*\n  hint: did you mean 'milk'"):
            self.grammar.score(self.milk, pd.DataFrame({**rows, "object": ["mlik"]}))
        with self.assertWarnsRegex(prehend.DoubtfulLabels, "columns that are not read: tool"):
            self.grammar.score(self.milk, pd.DataFrame({**rows, "tool": ["knife"]}))
        with self.assertWarnsRegex(prehend.DoubtfulLabels, "the column 'objct' is not read"):
            self.grammar.score(self.milk, pd.DataFrame({**rows, "objct": ["knife"]}))

    def test_labels_of_a_moment_are_counted(self):
        found = self.grammar.segment(self.milk)
        moments = pd.DataFrame({"begin_s": [2.0, 4.9], "end_s": [2.0, 4.9], "label": ["grasping"] * 2})
        scores = self.grammar.score(found, moments)
        self.assertEqual(scores.attrs["moments"], {"grasping": {"true": 2, "found": 1}})

    def test_labels_without_text_are_left_out_whatever_they_are(self):
        for nothing in (None, np.nan, pd.NA, ""):
            labels = pd.DataFrame({"begin_s": [1.5, 4.5], "end_s": [4.1, 4.6], "label": ["grasping", nothing]})
            with self.assertWarnsRegex(prehend.DoubtfulLabels, "truth, row 1: warning: a label is without text, and left out"):
                self.assertEqual(self.grammar.score(self.milk, labels).loc["all", "true"], 1)

    def test_what_another_grammar_recognises_besides_is_not_judged(self):
        found = self.milk.segment("hand_actions_from_motion")
        self.assertTrue(set(found["event"]) - set(self.grammar.events.index))
        labels = pd.DataFrame({"begin_s": [1.5], "end_s": [4.1], "label": ["grasping"]})
        self.assertEqual(self.grammar.score(found, labels).loc["grasping", "f1_50"], 1.0)

    def test_rows_that_overlap_are_said(self):
        once = pd.DataFrame({"begin_s": [1.5], "end_s": [4.1], "label": ["grasping"]})
        with self.assertWarnsRegex(prehend.DoubtfulLabels, "a label overlaps another one of the same event") as told:
            scores = self.grammar.score(self.milk, pd.concat([once, once]))
        self.assertEqual(told.filename, __file__)
        self.assertEqual(scores.loc["all", "true"], 1)
        with self.assertWarnsRegex(prehend.DoubtfulLabels, "a label overlaps"):
            self.grammar.margins(self.milk, pd.concat([once, once]), over=["hold_way"])
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.grammar.score(self.milk, once)

    def test_margins_are_the_programs(self):
        mine = self.grammar.margins(self.milk, str(self.labels), map=self.map, over=["hold_way", "hold_slip"])
        file = self.folder / "margins.csv"
        takes.program("grammar", "margins", self.folder / "milk.jsonl", "--truth", self.labels, "--map", self.map, "--over",
                      "hold_way", "--over", "hold_slip", "-o", file)
        pd.testing.assert_frame_equal(mine, pd.read_csv(file).set_index("parameter"))
        t, arrays = takes.carried()
        made = prehend.episode(arrays, t=t, entities=takes.ENTITIES)
        again = self.grammar.margins(made, made.events, over="hold_way")
        self.assertEqual(again.loc["hold_way", "f1"], 1.0)
        made.events.write(self.folder / "made.eaf")
        kept = self.grammar.margins(made, self.folder / "made.eaf", over=["hold_way"])
        self.assertEqual(kept.loc["hold_way", "f1"], 1.0)

    def test_explain(self):
        why = self.milk.explain("transporting")
        self.assertEqual(str(why), takes.program("explain", self.folder / "milk.jsonl", "--event", "transporting"))
        self.assertIn("<ul><li>", why._repr_html_())
        for grammar in (None, "hand_actions_from_motion"):
            events = self.milk.segment(grammar)
            self.assertEqual(sorted(one["decided_tick"] for one in self.milk.explain(grammar=grammar).data["events"]),
                             sorted((events["decided_s"] * self.milk.ticks_per_second).round()), "it is told then")
        why_not = self.grammar.explain(self.milk, "sliding@2s")
        self.assertTrue(str(why_not).startswith("sliding"))
        self.assertIn("did not happen", why_not._repr_html_())
        self.assertFalse(why_not.data["missing"]["happened"])
        self.assertEqual(len(str(self.milk.explain()).splitlines()), len(self.milk.events) + 1)

    def test_signals_are_the_programs_tracks(self):
        mine = self.milk.signals("distance", "grasping")
        file = self.folder / "tracks.csv"
        takes.program("grammar", "tracks", self.folder / "milk.jsonl", "--only", "distance", "--only", "grasping", "-o", file)
        told = pd.read_csv(file)
        self.assertEqual(mine.shape, (len(told), len(told.columns) - 2))
        for name, column in zip(mine.columns, told.columns[2:]):
            self.assertTrue(column.startswith(name))
            np.testing.assert_allclose(mine[name], told[column], rtol=1e-4, atol=1e-4, err_msg=name)

    def test_labels_per_frame(self):
        labels = self.milk.events.labels(per_frame=30)
        self.assertEqual(len(labels), 155)
        self.assertEqual(labels.iloc[int(2.0 * 30)], "transporting")
        self.assertEqual(labels.iloc[-1], "")
        self.assertTrue(set(labels.cat.categories) < {"", "reaching", "fixation", "sliding", "grasping", "picking_up",
                                                      "transporting", "putting_down"})
        self.assertEqual(self.milk.events.labels(10, events=["contact"]).iloc[0], "contact")

    def test_label_files(self):
        events = self.milk.events
        for ending in ("eaf", "TextGrid", "csv"):
            events.write(self.folder / f"milk.{ending}")
            takes.program("episode", "resegment", self.folder / "milk.jsonl", "-o", self.folder / f"same.{ending}")
            self.assertEqual((self.folder / f"milk.{ending}").read_text(), (self.folder / f"same.{ending}").read_text())
            self.assertEqual(self.grammar.score(events, self.folder / f"milk.{ending}").loc["all", "f1_50"], 1.0)
        events.write(self.folder / "milk.json")
        self.assertEqual(len(json.loads((self.folder / "milk.json").read_text())), len(events))

    def test_what_a_notebook_shows(self):
        events = self.milk.events
        picture = xml.etree.ElementTree.fromstring(events._repr_svg_())
        self.assertTrue(picture.tag.endswith("svg"))
        self.assertIn("transporting", events.svg())
        self.assertIn("<table", events._repr_html_())
        self.assertIn("<svg", events[events["event"] == "grasping"]._repr_html_())
        self.assertNotIn("<svg", events[["event"]]._repr_html_())
        self.assertIn("<svg", self.milk._repr_html_())

    def test_help_reads(self):
        import pydoc

        text = pydoc.render_doc(prehend, renderer=pydoc.plaintext)
        for words in ("class Grammar", "Parameters\n", "Raises\n", "open(path", "FrameError", "metres"):
            self.assertIn(words, text)
        for name in prehend.__all__:
            self.assertTrue(getattr(prehend, name).__doc__, name)


if __name__ == "__main__":
    unittest.main()
