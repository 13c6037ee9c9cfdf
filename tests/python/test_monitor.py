# SPDX-License-Identifier: Apache-2.0
"""Live: what `update` tells in a loop is what `segment` finds, and its memory stays."""
import copy
import json
import os
import pathlib
import pickle
import tempfile
import threading
import unittest
import warnings

import numpy as np
import pandas as pd

import prehend
import takes


def resident_mb():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


class Live(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("ignore", prehend.MissingFacts)

    def watch(self, monitor, t, arrays, **more):
        told = []
        for i, time in enumerate(t):
            poses = {name: array[i] for name, array in arrays.items()}
            news = monitor.update(time, poses, **{key: value(i) for key, value in more.items()})
            self.assertTrue(all(one["decided_s"] <= time + 1e-4 for one in news))
            told += news
        return told + monitor.finish()

    def test_values_have_units(self):
        t, arrays = takes.carried(18)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        file = pathlib.Path(folder.name) / "own.grammar"
        file.write_text("grammar own\nevent near(hand: Hand, object: Movable)\n  while distance(hand, object) < 20 cm\n"
                        "  with far = distance(hand, object)@begin\n", "utf-8")
        monitor = prehend.Grammar(file).monitor(takes.ENTITIES)
        told = self.watch(monitor, t, arrays)
        self.assertIn("far_m", told[0])
        self.assertIn("far_m", monitor.events(told).columns)
        found = prehend.Grammar(file).segment(arrays, t=t, entities=takes.ENTITIES)
        self.assertAlmostEqual(found["far_m"][0], told[0]["far_m"])
        for again in (pickle.loads(pickle.dumps(found)), copy.deepcopy(found)):
            self.assertIsInstance(again, type(found))
            pd.testing.assert_frame_equal(pd.DataFrame(again), pd.DataFrame(found))
        with self.assertRaisesRegex(prehend.Error, "of which episode"):
            pickle.loads(pickle.dumps(found)).labels()

    def test_update_is_segment(self):
        t, arrays = takes.carried(18)
        arrays["cup"][100:104] = np.nan
        arrays["cup"][400:430] = np.nan
        grips = np.clip(t - 1, 0, 1)
        grammar = prehend.Grammar("pick_and_place_from_motion")
        found = grammar.segment(arrays, t=t, entities=takes.ENTITIES, grips={"right_hand": grips})
        monitor = grammar.monitor(takes.ENTITIES, ticks_per_second=found._source.episode.ticks_per_second())
        told = self.watch(monitor, t, arrays, grips=lambda i: {"right_hand": grips[i]})
        self.assertGreater(len(told), 20)
        key = lambda one: (one["begin_s"], one["end_s"], one["event"], one.get("object", ""), one.get("b", ""))
        names = [name for name in found.columns if name not in ("scenario", "episode")]
        self.assertEqual([[one.get(name, "") for name in names] for one in sorted(told, key=key)],
                         [[one[name] for name in names] for one in sorted(found.to_dict("records"), key=key)])

    def test_what_begins_before_0_counts_from_its_first_frame_as_segment_has_it(self):
        t, arrays = takes.carried(6)
        grammar = prehend.Grammar("pick_and_place_from_motion")
        found = grammar.segment(arrays, t=t, entities=takes.ENTITIES)
        with self.assertWarnsRegex(prehend.MissingFacts, "begins at -3 s: times count from its first frame\n  hint: .* offset_s: 3 "):
            moved = grammar.segment(arrays, t=t - 3, entities=takes.ENTITIES)
        pd.testing.assert_frame_equal(pd.DataFrame(moved), pd.DataFrame(found))
        monitor = grammar.monitor(takes.ENTITIES, ticks_per_second=found._source.episode.ticks_per_second())
        with self.assertWarnsRegex(prehend.MissingFacts, "'live' begins at -3 s: times count from its first frame"):
            told = monitor.update(-3, {one: at[0] for one, at in arrays.items()})
        with warnings.catch_warnings():
            warnings.simplefilter("error", prehend.MissingFacts)  # it is said once
            for i in range(1, len(t)):
                told += monitor.update(t[i] - 3, {one: at[i] for one, at in arrays.items()})
        told += monitor.finish()
        key = ["begin_s", "end_s", "event", "a", "b"]
        watched = monitor.events(told)
        self.assertEqual(watched._source.end, found._source.end)
        same = ["event", "hand", "object", "begin_s", "end_s", "decided_s", "open_end"]
        self.assertEqual(watched.sort_values(key)[same].values.tolist(), found.sort_values(key)[same].values.tolist())
        with tempfile.TemporaryDirectory() as folder:
            for ending in ("eaf", "TextGrid"):
                texts = []
                for number, one in enumerate((watched, found)):
                    one.write(f"{folder}/{number}/labels.{ending}")
                    with open(f"{folder}/{number}/labels.{ending}", encoding="utf-8") as file:
                        texts.append(sorted(file.read().splitlines()))
                self.assertNotRegex("\n".join(texts[0]), r'(VALUE="|= )-')
            watched.write(f"{folder}/new/labels.json")  # makes its folder, as for the others
        self.assertEqual(monitor._monitor.moved(), 3 * monitor._per_second)

    def test_what_it_told_is_events(self):
        t, arrays = takes.carried(6)
        grammar = prehend.Grammar("pick_and_place_from_motion")
        found = grammar.segment(arrays, t=t, entities=takes.ENTITIES)
        monitor = grammar.monitor(takes.ENTITIES, ticks_per_second=found._source.episode.ticks_per_second())
        told = monitor.events(self.watch(monitor, t, arrays))
        self.assertIn("<svg", told.svg())
        labels = found[["event", "hand", "object", "begin_s", "end_s"]]
        self.assertEqual(grammar.score(told, labels).loc["all", "f1_50"], 1.0)
        with self.assertRaisesRegex(prehend.Error, "a table does not say which entities"):
            grammar.score(pd.DataFrame(labels), labels)

    def test_nothing_told_is_no_events(self):
        monitor = prehend.Grammar("contact").monitor(takes.ENTITIES)
        before = monitor.events([])
        monitor.update(0, {"cup": (0, 0, 0.86)})
        during = monitor.events([])
        for events in (before, during, monitor.events(monitor.finish(2.0))):
            self.assertIsInstance(events, prehend.Events)
            self.assertEqual((len(events), list(events.columns)), (0, ["scenario", "episode", "event", "begin_s", "end_s", "decided_s", "open_end"]))
        scores = prehend.Grammar("contact").score(events, pd.DataFrame({"begin_s": [0.5], "end_s": [1], "label": ["contact"]}))
        self.assertEqual((scores.loc["all", "true"], scores.loc["all", "found"]), (1, 0))

    def test_an_episode_ends_when_it_is_finished(self):
        grammar = prehend.Grammar("contact")
        monitor = grammar.monitor(takes.ENTITIES)
        told = monitor.update(0, {"cup": (0, 0, 0.86)}, touches=[("cup", "table", 1.0)])
        told += monitor.update(1, {})
        told += monitor.update(3, {})
        told += monitor.finish(10.0)
        events = monitor.events(told)
        self.assertEqual(events._source.end, 10 * 10_000)
        labels = pd.DataFrame({"begin_s": [0.0, 5], "end_s": [1.0, 9], "label": ["contact"] * 2})
        scores = grammar.score(events, labels)
        self.assertEqual((scores.loc["contact", "true"], scores.loc["contact", "found"]), (2, 1))
        self.assertAlmostEqual(scores.loc["contact", "frame_accuracy"], 0.6, 4)  # 4 of 10 s are missed
        self.assertAlmostEqual(scores.loc["contact", "ward_missed_s_deletion"], 4.0)
        late = prehend.Error, "the label lies at 11 to 12 s, the recording ends after 10 s"
        with self.assertRaisesRegex(*late):
            grammar.score(events, labels + pd.DataFrame({"begin_s": [0.0, 6], "end_s": [0.0, 3], "label": ["", ""]}))

    def test_touches_and_dicts(self):
        monitor = prehend.Grammar("contact").monitor(takes.ENTITIES)
        poses = {"cup": {"at_m": (0, 0, 0.86)}, "right_hand": (0, 0, 1)}
        told = monitor.update(0, poses, touches=[("cup", "table", 1.0)])
        told += monitor.update(1, {}, touches=[{"a": "cup", "b": "table", "up_on_a": 1, "force_n": 3}])
        told += monitor.update(2, {"cup": None})
        told += monitor.finish(3)
        self.assertEqual([(one["event"], one["begin_s"], one["end_s"]) for one in told],
                         [("contact", 0.0, 2.0), ("supported_by", 0.0, 2.0)])

    def test_a_turn_may_be_longer_than_one_by_rounding(self):
        monitor = prehend.Grammar("pick_and_place_from_motion").monitor(takes.ENTITIES)
        monitor.update(0, {"cup": (0, 0, 0.8, 1.0000001, 0, 0, 0)})
        with self.assertRaisesRegex(prehend.Error, "unit quaternion"):
            monitor.update(0.1, {"cup": (0, 0, 0.8, 1.0, 0.2, 0, 0)})

    def test_a_refused_frame_changes_nothing(self):
        monitor = prehend.Grammar("contact").monitor(takes.ENTITIES)
        monitor.update(0, {"cup": (0, 0, 1)}, touches=[("cup", "table", 1.0)])
        for wrong in ({"cup": (0, 0, 1e9)}, {"cap": (0, 0, 1)}, {"cup": (0, 0, 1, 2, 0, 0, 0)}):
            with self.assertRaises(prehend.FrameError):
                monitor.update(1, wrong)
        monitor.update(1, {"cup": (0, 0, 1)}, touches=[("cup", "table", 1.0)])
        self.assertEqual({one["end_s"] for one in monitor.finish(2)}, {2.0})

    def test_an_hour_keeps_its_memory(self):
        grammar = prehend.Grammar("pick_and_place_from_motion")
        monitor = grammar.monitor(takes.ENTITIES)
        t, arrays = takes.carried(12, 30)
        hour = 3600 if os.environ.get("PREHEND_LONG") else 900
        told, after = 0, []
        for begin in range(0, hour, 12):
            for i, time in enumerate(t):
                told += len(monitor.update(begin + time, {name: array[i] for name, array in arrays.items()}))
            after.append(resident_mb())
        print(f"{hour} s watched, {told} events: {after[len(after) // 4]:.1f} MB after a quarter, {after[-1]:.1f} MB at the end")
        self.assertGreater(told, hour / 6 * 5)
        self.assertLess(after[-1] - after[len(after) // 4], 1.5)

    def test_forked_processes_go_their_own_ways(self):
        monitor = prehend.Grammar("contact").monitor(takes.ENTITIES)
        monitor.update(0, {"cup": (0, 0, 1)}, touches=[("cup", "table", 1.0)])
        read, write = os.pipe()
        if os.fork() == 0:
            os.write(write, json.dumps(monitor.finish(5)).encode())
            os._exit(0)
        os.wait()
        self.assertEqual(json.loads(os.read(read, 10000))[0]["end_s"], 5.0)
        self.assertEqual(monitor.finish(2)[0]["end_s"], 2.0)

    def test_threads_segment_beside_each_other(self):
        t, arrays = takes.carried()
        grammar = prehend.Grammar("pick_and_place_from_motion")
        episode = prehend.episode(arrays, t=t, entities=takes.ENTITIES)
        counts = []
        threads = [threading.Thread(target=lambda: counts.append(len(grammar.segment(episode)))) for _ in range(4)]
        for one in threads:
            one.start()
        for one in threads:
            one.join()
        self.assertEqual(len(counts), 4)
        self.assertEqual(len(set(counts)), 1)


if __name__ == "__main__":
    unittest.main()
