# SPDX-License-Identifier: Apache-2.0
"""Events through Python are the program's, tick by tick."""
import unittest
import warnings

import numpy as np
import pandas as pd

import prehend
import takes


class OfEpisodeFiles(takes.Folder, unittest.TestCase):
    SCENARIOS = ["pick_and_place/milk_carton_wrap", "slide/hop_divides_a_slide", "furniture/drawer_is_opened_with_hook"]

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.file = cls.folder / "three.episodes"
        for name in cls.SCENARIOS:
            takes.program("run", name, "--record", cls.file)
        warnings.simplefilter("ignore", prehend.MissingFacts)

    def compare(self, file, episodes, segment, *words):
        told = takes.printed("episode", "resegment", file, *words)
        self.assertEqual([name for name, _ in told], [one.name for one in episodes])
        for one, (name, events) in zip(episodes, told):
            self.assertEqual(takes.found(segment(one), one.ticks_per_second), events, name)

    def test_recorded(self):
        episodes = prehend.open(self.file)
        self.assertEqual([one.name for one in episodes], self.SCENARIOS)
        self.compare(self.file, episodes, lambda one: one.events)
        self.assertEqual(len(episodes.events), sum(len(one.events) for one in episodes))
        self.assertEqual(list(episodes.events.columns[:3]), ["scenario", "episode", "event"])

    def test_under_another_grammar(self):
        grammar = prehend.Grammar("contact")
        self.compare(self.file, prehend.open(self.file), grammar.segment, "--grammar", "contact")
        grammar = prehend.Grammar("pick_and_place", lift_rise="10 cm")
        self.compare(self.file, prehend.open(self.file), grammar.segment, "--grammar", "pick_and_place", "--set",
                     "lift_rise=10 cm")

    def test_names_numbers_and_globs(self):
        self.assertEqual(prehend.open(self.file)["hop_divides_a_slide"].number, 2)
        self.assertEqual(prehend.open(str(self.folder / "*.episodes"), which="slide/*")[0].name, self.SCENARIOS[1])
        self.assertEqual(len(prehend.open([self.file, self.file])[1:3]), 2)
        self.assertEqual(prehend.open(self.file, "2").kind, "simulated")

    def test_frames_written_are_the_same_recording(self):
        one = prehend.open(self.file)[0]
        one.write(self.folder / "milk.jsonl")
        with self.assertRaisesRegex(prehend.Error, "^which= needs episode files; "):
            prehend.open(self.folder / "milk.jsonl", "2")
        again = prehend.open(self.folder / "milk.jsonl")[0]
        self.assertEqual(takes.found(again.events, again.ticks_per_second), takes.found(one.events, one.ticks_per_second))

    def test_poses_touches_entities(self):
        one = prehend.open(self.file)[0]
        poses = one.poses()
        self.assertEqual(len(poses), poses["entity"].nunique() * poses["t"].nunique())
        self.assertEqual(set(one.entities.index), set(poses["entity"]))
        self.assertEqual(one.entities.loc["right_hand", "class"], "Hand")
        self.assertAlmostEqual(poses[poses["entity"] == "right_hand"]["grip"].max(), 1.0)
        self.assertGreater(one.touches()["up_on_a"].abs().max(), 0.99)


class OfScenarios(unittest.TestCase):
    def test_played_by_name(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            episodes = prehend.open("milk_carton_wrap")
        told = takes.printed("run", "milk_carton_wrap")[0][1]
        self.assertEqual(takes.found(episodes.events, episodes.ticks_per_second), told)


class OfArrays(takes.Folder, unittest.TestCase):
    """What the program makes of the same recording, written independently."""

    def segment(self, frames, **more):
        episode = prehend.episode(frames, entities=takes.ENTITIES, **more)
        return takes.found(episode.segment("pick_and_place_from_motion"), episode.ticks_per_second)

    def printed(self, frames, ticks, per_second, **more):
        file = takes.json_lines(self.folder / "take.jsonl", frames, ticks, per_second, **more)
        return takes.printed("episode", "resegment", file, "--grammar", "pick_and_place_from_motion")[0][1]

    def setUp(self):
        warnings.simplefilter("ignore", prehend.MissingFacts)
        self.t, self.arrays = takes.carried()

    def test_positions(self):
        told = self.printed(self.arrays, np.arange(len(self.t)) * 167, 60 * 167)
        self.assertIn("transporting", [event for event, *_ in told])
        self.assertEqual(self.segment(self.arrays, rate_hz=60), told)
        self.assertEqual(self.segment(self.arrays, t=self.t), told)
        self.assertEqual(self.segment(takes.long_table(self.t, self.arrays)), told)
        shuffled = takes.long_table(self.t, self.arrays).sample(frac=1, random_state=1)
        self.assertEqual(self.segment(shuffled), told)

    def test_orders_of_memory_and_types(self):
        told = self.segment(self.arrays, rate_hz=60)
        wide = np.concatenate([self.arrays["cup"], self.arrays["right_hand"]], axis=1)
        views = {"cup": wide[:, :3], "right_hand": wide[:, 3:]}
        self.assertEqual(self.segment(views, rate_hz=60), told)
        turned = {name: np.asfortranarray(array) for name, array in self.arrays.items()}
        self.assertEqual(self.segment(turned, rate_hz=60), told)
        backwards = {name: array[::-1].copy()[::-1] for name, array in self.arrays.items()}
        self.assertEqual(self.segment(backwards, rate_hz=60), told)

    def test_orientations_grips_and_gaps(self):
        turn = np.stack([np.cos(self.t / 9), 0 * self.t, 0 * self.t, np.sin(self.t / 9)], axis=1)
        frames = {name: np.hstack([array, turn]) for name, array in self.arrays.items()}
        frames["cup"][50:53] = np.nan  # bridged
        frames["cup"][200:260] = np.nan
        grips = {"right_hand": np.clip(self.t - 1, 0, 1)}
        told = self.printed(frames, np.arange(len(self.t)) * 167, 60 * 167, grips=grips)
        self.assertEqual(self.segment(frames, rate_hz=60, grips=grips), told)
        table = takes.long_table(self.t, frames, ("x", "y", "z", "qw", "qx", "qy", "qz"))
        table["grip"] = np.where(table["entity"] == "right_hand", np.clip(table["t"] - 1, 0, 1), np.nan)
        self.assertEqual(self.segment(table), told)

    def test_columns_have_names_and_masks_count(self):
        told = self.segment(self.arrays, rate_hz=60)
        named = {name: pd.DataFrame(array[:, ::-1], columns=["z", "y", "x"]) for name, array in self.arrays.items()}
        self.assertEqual(self.segment(named, rate_hz=60), told)
        numbered = {name: pd.DataFrame(array) for name, array in self.arrays.items()}
        self.assertEqual(self.segment(numbered, rate_hz=60), told, "columns without names are in their order")
        lost = np.zeros((len(self.t), 3), dtype=bool)
        lost[200:260] = True
        masked = {**self.arrays, "cup": np.ma.masked_array(self.arrays["cup"], lost)}
        gone = {**self.arrays, "cup": np.where(lost, np.nan, self.arrays["cup"])}
        self.assertEqual(self.segment(masked, rate_hz=60), self.segment(gone, rate_hz=60))
        self.assertNotEqual(self.segment(masked, rate_hz=60), told)

    def test_masked_touches_are_none(self):
        touching = np.ma.masked_array(np.ones(len(self.t), dtype=bool), self.t < 2)
        touches = {("cup", "right_hand"): touching}
        events = prehend.Grammar("contact").segment(self.arrays, rate_hz=60, entities=takes.ENTITIES, touches=touches)
        self.assertEqual(events["begin_s"].tolist(), [2.0])
        from_below = np.ma.masked_array((self.t > 2).astype(float), self.t < 2)
        events = prehend.Grammar("contact").segment(self.arrays, rate_hz=60, entities=takes.ENTITIES,
                                                    touches={("cup", "table"): from_below + (self.t == 2)})
        self.assertEqual(sorted(events["event"]), ["contact", "supported_by"])
        self.assertEqual(events["begin_s"].min(), 2.0)

    def test_irregular_times(self):
        t, arrays = takes.tracker()
        self.assertEqual(self.segment(arrays, t=t), self.printed(arrays, np.round(t * 10000).astype(int), 10000))

    def test_touches_make_contacts(self):
        touching = (self.t > 1) & (self.t < 4)
        standing = np.where(touching, np.nan, 1.0)
        grammar = prehend.Grammar("contact")
        events = grammar.segment(self.arrays, rate_hz=60, entities=takes.ENTITIES,
                                 touches={("cup", "right_hand"): touching, ("cup", "table"): standing})
        self.assertEqual(sorted(events["event"]), ["contact"] * 3 + ["supported_by"] * 2)
        table = takes.long_table(self.t, self.arrays)
        table["touches"] = [({"table": 1.0} if up == 1 else "right_hand") if name == "cup" else None
                            for name, up in zip(table["entity"], np.tile(standing, 2))]
        again = grammar.segment(table, entities=takes.ENTITIES)
        self.assertEqual(again["begin_s"].tolist(), events["begin_s"].tolist())

    def test_what_is_missing_names_the_rule(self):
        with self.assertWarnsRegex(prehend.MissingFacts, r"contact\.grammar:\d+:\d+: warning: this recording has no touches"):
            prehend.Grammar("pick_and_place").segment(self.arrays, rate_hz=60, entities=takes.ENTITIES)


if __name__ == "__main__":
    unittest.main()
