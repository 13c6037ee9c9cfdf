# SPDX-License-Identifier: Apache-2.0
"""Calls that cannot be meant: an exception with a remedy each, and afterwards everything works as before."""
import subprocess
import sys
import threading
import unittest
import warnings

import numpy as np
import pandas as pd

import prehend
import takes

NAN = float("nan")
T, GOOD = takes.carried(2)
N = len(T)


def segment(frames=None, grammar="pick_and_place_from_motion", entities=None, **more):
    more = more if "t" in more or "rate_hz" in more or isinstance(frames, pd.DataFrame) else {"rate_hz": 60, **more}
    return prehend.Grammar(grammar).segment(GOOD if frames is None else frames,
                                            entities=takes.ENTITIES if entities is None else entities, **more)


def cup(array):
    return {**GOOD, "cup": array}


def table(**columns):
    return takes.long_table(T, GOOD).assign(**columns)


def at(array, place, value):
    array = np.array(array, dtype=float)
    array[place] = value
    return array


def updated(*frames, **more):
    monitor = prehend.Grammar("contact").monitor(takes.ENTITIES)
    for t, poses in frames:
        monitor.update(t, poses, **more)
    return monitor


class Truth:
    events = None

    @classmethod
    def score(cls, truth, **more):
        grammar = prehend.Grammar("pick_and_place_from_motion")
        if cls.events is None:
            cls.events = segment()
        return grammar.score(cls.events, truth, **more)


    @classmethod
    def of(cls, name, value, **more):
        """Scores what was found against a table with this in a column."""
        return cls.score(pd.DataFrame({"begin_s": [0, 1], "end_s": [1, 2], "label": ["contact"] * 2, name: value}), **more)

    @classmethod
    def found(cls, **changed):
        """Scores what was found and changed against what was found."""
        events = segment()
        columns = changed.pop("columns", list(events.columns))
        return prehend.Grammar("pick_and_place_from_motion").score(events.assign(**changed)[columns], events)


def margins(episodes, truth="recorded", **more):
    return prehend.Grammar("pick_and_place_from_motion").margins(episodes, truth, **more)


EPISODE = []


def episode():
    if not EPISODE:
        EPISODE.append(prehend.episode(GOOD, rate_hz=60, entities=takes.ENTITIES))
    return EPISODE[0]


F, G, E, ANY = prehend.FrameError, prehend.GrammarError, prehend.EpisodeError, prehend.Error
# What is called, the exception, and what it says: what was found, and a remedy.
CALLS = {
    # shapes and types
    "two columns": (lambda: segment(cup(np.zeros((N, 2)))), F, r"'cup'.*\(120, 2\).*\(N, 3\) or \(N, 7\)"),
    "one dimension": (lambda: segment(cup(np.zeros(3 * N))), F, r"'cup'.*\(360,\)"),
    "transposed": (lambda: segment(cup(GOOD["cup"].T)), F, r"\(3, 120\).*one row per frame"),
    "texts": (lambda: segment(cup(GOOD["cup"].astype(str))), F, r"<U\d+.*astype\(float\)"),
    "objects": (lambda: segment(cup(GOOD["cup"].astype(object))), F, r"object.*astype\(float\)"),
    "complex numbers": (lambda: segment(cup(GOOD["cup"] + 1j)), F, "complex128"),
    "lengths that differ": (lambda: segment(cup(GOOD["cup"][:-1])), F, "different lengths.*119"),
    "no frames": (lambda: segment({name: array[:0] for name, array in GOOD.items()}), F, "no frames"),
    "a list": (lambda: segment([1, 2]), ANY, "found"),
    "nothing": (lambda: prehend.Grammar("contact").segment(None), F, "NoneType.*DataFrame"),
    "no entities": (lambda: prehend.Grammar("contact").segment(GOOD, rate_hz=60), F, "entities are missing.*'cup'"),
    "an entity without a class": (lambda: segment(entities={"cup": ("Cup", (.1, .1, .1))}), F, "'right_hand' is missing"),
    "an entity without a size": (lambda: segment(entities={"cup": "Cup", "right_hand": "Hand"}), F, "'cup' has no size.*edges"),
    "a size of two numbers": (lambda: segment(entities={"cup": ("Cup", (1, 2)), "right_hand": "Hand"}), F, "metres"),
    "a misspelt key": (lambda: segment(entities={"cup": {"class": "Cup", "size": (1, 1, 1)}, "right_hand": "Hand"}), F,
                       "size_m"),
    "a name that is none": (lambda: segment(entities={**takes.ENTITIES, "my cup": ("Cup", (1, 1, 1))}), F, "my cup"),
    "an entity that is a number": (lambda: segment(entities={"cup": 3, "right_hand": "Hand"}), F, "'cup': found a int"),
    # values
    "half a position": (lambda: segment(cup(at(GOOD["cup"], (5, 1), NAN))), F, r"at 0\.083.*'cup'.*all three NaN"),
    "an infinite position": (lambda: segment(cup(at(GOOD["cup"], 5, np.inf))), F, "'cup'.*metres"),
    "millimetres, and far away": (lambda: segment(cup(GOOD["cup"] * 1e6)), F, "positions are metres"),
    "a quaternion of length 0": (lambda: segment(cup(np.hstack([GOOD["cup"], np.zeros((N, 4))]))), F, "length 1"),
    "a quaternion of length 2": (lambda: segment(cup(np.hstack([GOOD["cup"], np.ones((N, 4))]))), F, r"\(w, x, y, z\)"),
    "a grip in percent": (lambda: segment(grips={"right_hand": np.full(N, 100.0)}), F, "grip of 'right_hand' is 100.*scale"),
    "a grip of a cup": (lambda: segment(grips={"cup": np.zeros(N)}), F, "'cup' is not a hand"),
    "a grip of nobody": (lambda: segment(grips={"left_hand": np.zeros(N)}), F, "'left_hand'.*known: table, cup"),
    "too few grips": (lambda: segment(grips={"right_hand": np.zeros(3)}), F, "3 values for 120 frames"),
    "grips in a list": (lambda: segment(grips=[0.5] * N), F, "grips: found a list, wanted a dict"),
    "touches in a list": (lambda: segment(touches=[("cup", "table")]), F, "touches: found a list, wanted a dict"),
    "frames faster than ticks": (lambda: segment(rate_hz=20000), F, "rate_hz.*10000"),
    "a touch of one": (lambda: segment(touches={"cup": np.ones(N)}), F, "pair of entities"),
    "a touch of itself": (lambda: segment(touches={("cup", "cup"): np.ones(N)}), F, "cannot touch itself"),
    "touches as 0 and 1": (lambda: segment(touches={("cup", "table"): (T < 1).astype(np.uint8)}), F,
                           r"touches of .*: found uint8 of whole numbers.*astype\(bool\)"),
    "touches as 0.0 and 1.0": (lambda: segment(touches={("cup", "table"): (T < 1).astype(float)}), F, "float64 of whole numbers"),
    "no touches as 0.0": (lambda: segment(touches={("cup", "table"): np.zeros(N)}), F, "NaN where they do not touch"),
    "columns of other names": (lambda: segment(cup(pd.DataFrame(GOOD["cup"], columns=["a", "b", "c"]))), F,
                               r"'cup': found the columns a, b, c, wanted x, y, z.*to_numpy\(\)"),
    "a column twice": (lambda: segment(cup(pd.DataFrame(GOOD["cup"], columns=["x", "y", "y"]))), F, "columns x, y, y, wanted"),
    "a normal of length 2": (lambda: segment(touches={("cup", "table"): np.full(N, 2.0)}), F, "-1 to 1"),
    # times
    "no times": (lambda: prehend.episode(GOOD, entities=takes.ENTITIES), F, "either t or rate_hz"),
    "two kinds of times": (lambda: segment(t=T, rate_hz=60), F, "either t or rate_hz"),
    "ticks backwards": (lambda: segment(t=at(T, 7, 0.01)), F, r"t\[7\] = 0\.01 is not after.*sort"),
    "a time twice": (lambda: segment(t=at(T, 7, T[6])), F, "is not after"),
    "no number for a time": (lambda: segment(t=at(T, 7, NAN)), F, r"t\[7\] is no number"),
    "times that are too few": (lambda: segment(t=T[:5]), F, "5 times.*120 frames"),
    "frame numbers": (lambda: segment(t=np.arange(N)), F, r"t are whole numbers that grow by 1.*frame numbers.*rate_hz"),
    "frame numbers, and a gap": (lambda: segment(t=np.arange(N) + 3.0 * (np.arange(N) > 60)), F, "frame numbers"),
    "a masked time": (lambda: segment(t=np.ma.masked_array(T, T == T[5])), F, r"t\[5\] is no number"),
    "milliseconds": (lambda: segment(t=T * 1000), F, "16.6667 s apart.*divide milliseconds by 1000"),
    "seconds since 1970": (lambda: segment(t=T + 1.7e9), F, r"t - t\[0\]"),
    "a rate of zero": (lambda: segment(rate_hz=0), F, "rate_hz: found 0"),
    "a rate that is a text": (lambda: segment(rate_hz="60"), F, "rate_hz: found '60'"),
    # tables
    "a table without times": (lambda: segment(table().drop(columns="t")), F, "no column 't'"),
    "a table with three of a quaternion": (lambda: segment(table(qw=1.0, qx=0.0, qy=0.0)), F, "all of qw, qx, qy, qz"),
    "a table with rows twice": (lambda: segment(pd.concat([table(), table()])), F, "two rows at the same time"),
    "a table without one time": (lambda: segment(table(t=at(np.tile(T, len(GOOD)), len(T) + 7, NAN))), F, rf"row {len(T) + 7}: t is no number"),
    "a table with texts": (lambda: segment(table(x="1.0")), F, "column 'x'.*object"),
    # grammars
    "an unknown grammar": (lambda: prehend.Grammar("pick_and_plaice"), G, "did you mean 'pick_and_place'"),
    "an unknown parameter": (lambda: prehend.Grammar("contact", contct_for="1 s"), G, "contct_for"),
    "a wrong unit": (lambda: prehend.Grammar("pick_and_place", lift_rise="10 s"), G, "lift_rise"),
    "a length without a unit": (lambda: prehend.Grammar("pick_and_place", lift_rise=0.1), G, "lift_rise"),
    "a list as a parameter": (lambda: prehend.Grammar("contact", reach_radius=[1]), G, "text with a unit"),
    "a grammar that is a number": (lambda: prehend.Grammar(3), G, "found a int"),
    # live
    "an update backwards": (lambda: updated((1, {}), (0.5, {})), F, "is not after 1 s.*leave late frames out"),
    "an update of nobody": (lambda: updated((1, {"cap": (0, 0, 1)})), F, "did you mean 'cup'"),
    "an update with two numbers": (lambda: updated((1, {"cup": (0, 1)})), F, "found 2 numbers, wanted 3 or 7"),
    "an update with texts": (lambda: updated((1, {"cup": "here"})), F, "'cup': found 'here'"),
    "an update at no time": (lambda: updated((NAN, {})), F, "wanted seconds"),
    "an update with no grip": (lambda: updated((0, {}), grips={"right_hand": NAN}), F, r"^grips\['right_hand'\]: found nan"),
    "an update with no contact": (lambda: updated((0, {}), touches=[("cup", "table", NAN)]), F, r"^touches\[0\]\['up_on_a'\]: found nan"),
    "an update with no speed": (lambda: updated((0, {"cup": {"at_m": [0, 0, 1], "v_m_per_s": [0, NAN, 0]}})), F,
                                r"^poses\['cup'\]\['v_m_per_s'\]\[1\]: found nan"),
    "an edge that is none": (lambda: segment(entities={**takes.ENTITIES, "cup": ("Cup", (.1, NAN, .1))}), F,
                             r"^entities\['cup'\]\['size_m'\]\[1\]: found nan"),
    "a bridge that is none": (lambda: prehend.Grammar("contact").monitor(takes.ENTITIES, bridge_s=NAN), F, "^bridge_s: found nan"),
    "an update with half a position": (lambda: updated((1, {"cup": (0, NAN, 1)})), F, "NaN in all"),
    "an update with an array of poses": (lambda: updated((1, np.zeros(3))), F, "wanted a dict by entity"),
    "an update with a grip of all": (lambda: updated((1, {}), grips=0.5), F, "grips: found a float, wanted a dict"),
    "an update with touches as a dict": (lambda: updated((1, {}), touches={("cup", "table"): 1.0}), F, "touches: found a dict, wanted a list"),
    "an update without touches": (lambda: updated((1, {}), touches=None), F, "touches: found a NoneType, wanted a list"),
    "a monitor of a name": (lambda: prehend.Monitor("contact", takes.ENTITIES), F, "grammar: found a str"),
    "a touch of nobody": (lambda: updated((1, {}), touches=[("cup", "tabel")]), F, "did you mean 'table'"),
    "told by nobody": (lambda: updated((1, {})).events(None), ANY, "told: found NoneType at 0, wanted dicts"),
    "told without an end": (lambda: updated((1, {})).events([{"event": "contact", "begin_s": 0}]), ANY, "told: found one without end_s at 0"),
    "told without when": (lambda: updated((1, {})).events([{"event": "contact", "begin_s": 0, "end_s": 1}]), ANY, "without decided_s"),
    "told as a text": (lambda: updated((1, {})).events(["contact"]), ANY, "told: found str at 0"),
    "told backwards": (lambda: updated((3, {})).events([{"event": "contact", "a": "cup", "b": "table", "begin_s": 2, "end_s": 1, "decided_s": 2, "open_end": False}]),
                       ANY, "row 0 of the events: found 2 to 1 s, wanted a begin and a later end"),
    "ticks that are a text": (lambda: prehend.Grammar("contact").monitor(takes.ENTITIES, ticks_per_second="x"), F, "ticks_per_second: found 'x'"),
    "an update after the end": (lambda: updated((1, {})).finish() or updated((1, {})).finish(0.2), F, "is not after|before its last"),
    # episodes
    "a file that is not there": (lambda: prehend.open("takes/nowhere.jsonl"), E, "no such file"),
    "poses of a tracker": (lambda: prehend.open(takes.ROOT / "docs/motion_capture/poses.csv"), E,
                           "neither a recording nor a scenario; .*'prehend import .*poses.csv -o NAME.jsonl'"),
    "a glob without files": (lambda: prehend.open("nowhere/*.jsonl"), E, "no file matches"),
    "an unknown scenario": (lambda: prehend.open("milk_carton_warp"), E, "did you mean 'milk_carton_wrap'"),
    "an array": (lambda: prehend.open([np.zeros(3)]), E, r"ndarray.*prehend\.episode"),
    "nothing to open": (lambda: prehend.open([]), E, "no path is named"),
    "an unknown signal": (lambda: episode().signals("distence"), ANY, "did you mean 'distance'"),
    "an unknown event": (lambda: episode().explain("graspin"), ANY, "did you mean 'grasping'"),
    "labels of another kind": (lambda: episode().events.write("/tmp/x.xml"), ANY, r"'x.xml', wanted NAME\.csv, \.eaf, \.TextGrid or \.json"),
    "labels of an event of nobody": (lambda: segment().labels(events=["contact", "graspin"]), ANY,
                                     "no event of the grammar is called 'graspin'.*did you mean 'grasping'"),
    "labels zero times a second": (lambda: segment().labels(per_frame=0), ANY, "frames per second"),
    "a truth without times": (lambda: Truth.score(pd.DataFrame({"event": ["grasping"]})), ANY, "begin_s, end_s and label"),
    "a truth of nobody": (lambda: Truth.score(pd.DataFrame({"begin_s": [0], "end_s": [1], "label": ["graspng"]})), ANY,
                          "grasping"),
    "a truth that ends before it begins": (lambda: Truth.score(pd.DataFrame({"begin_s": [1], "end_s": [0],
                                                                             "label": ["grasping"]})), ANY, "before it begins"),
    "a truth that is a number": (lambda: Truth.score(3), ANY, "found a int"),
    "a truth of two videos": (lambda: Truth.of("video", ["a", "b"]), E, "^truth: error: the column 'video' has several values.*truth=table"),
    "a truth of two episodes": (lambda: Truth.of("episode", [0, 1]), E, "the column 'episode' has several values"),
    "an event and a label": (lambda: Truth.of("event", "reaching"), ANY, r"'label', 'event'\]: which are meant"),
    "truths by Timedelta": (lambda: Truth.of("end_s", pd.to_timedelta([1, 2], unit="s")), ANY, r"truth, row 0: end_s: found Timedelta.*total_seconds"),
    "truths at no time": (lambda: Truth.of("end_s", pd.array([1, None], dtype="Int64")), ANY, "truth, row 1: end_s: found <NA>, wanted seconds"),
    "truths by text": (lambda: Truth.of("begin_s", ["0", "x"]), ANY, "truth, row 1: error: begin_s: found 'x', wanted a number or a time"),
    "a collar below zero": (lambda: Truth.of("begin_s", [0, 1], collar_s=-1), ANY, "collar_s: found -1, wanted 0 to 10"),
    "a collar that is none": (lambda: Truth.of("begin_s", [0, 1], collar_s=NAN), ANY, "collar_s: found nan"),
    "a collar that is a text": (lambda: Truth.of("begin_s", [0, 1], collar_s="x"), ANY, "collar_s: found 'x'"),
    "found backwards": (lambda: Truth.found(begin_s=5.0), ANY, "row 0 of the events: found 5 to .* a later end"),
    "found at no time": (lambda: Truth.found(begin_s=NAN), ANY, "row 0 of the events: begin_s: found nan, wanted seconds"),
    "found by text": (lambda: Truth.found(end_s="1"), ANY, "row 0 of the events: end_s: found '1'"),
    "found before the begin": (lambda: Truth.found(begin_s=-5.0), E, "^found, row 0: error: the label lies at -5 to"),
    "found after the end": (lambda: Truth.found(end_s=50.0), E, "^found, row 0: error: the label lies at .* to 50 s, the recording ends after 1.98343 s"),
    "found of nobody": (lambda: Truth.found(**dict.fromkeys(segment().roles, "cap")), E, "has no entity 'cap'.*did you mean 'cup'"),
    "found of no grammar": (lambda: Truth.found(event="graspin"), E, "found, row 0: error: found the label 'graspin'.*like grasping"),
    "found without roles": (lambda: Truth.found(columns=["event", "begin_s", "end_s"]), E, "found, row 0: error: '.*' says no .*, and what is true does"),
    "found without begins": (lambda: Truth.found(columns=["event", "end_s"]), ANY, "the events have no column 'begin_s'"),
    "margins of a number": (lambda: margins(3), F, "found a int"),
    "margins below zero": (lambda: margins(episode(), within=-1), ANY, "within: found -1, wanted 0 to 1"),
    "margins over a parameter of nobody": (lambda: margins(episode(), "recorded", over=["nix"]), ANY, "^over: error: the grammar has no parameter 'nix'"),
    "margins against what is nowhere": (lambda: margins(episode(), "golden", over=["hold_way"]), ANY, r"^0: 0 was not simulated.*labels by people, or its golden: truth=\.\. \("),
    "margins of nothing": (lambda: margins([], []), ANY, "^no file is named"),
    "a number to open": (lambda: prehend.open(3), E, "found a int, wanted a path"),
    "a recording of another kind": (lambda: episode().write("/tmp/x.csv"), E, r"'/tmp/x.csv', wanted NAME\.jsonl"),
    "a signal that is a number": (lambda: episode().signals(3), E, "^no event, condition or signal of the grammar is called '3'"),
    "an event after the end": (lambda: episode().explain("grasping@99s"), E, "found 99 s, the episode ends after 1.98343 s"),
    "two truths of one": (lambda: Truth.score([None, None]), ANY, "one truth for each"),
}


class WrongCalls(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("ignore")

    def test_each_is_refused_with_a_remedy(self):
        self.assertGreaterEqual(len(CALLS), 50)
        for name, (call, kind, says) in CALLS.items():
            with self.subTest(name):
                with self.assertRaises(kind) as raised:
                    call()
                text = str(raised.exception).replace("\n", " ")
                self.assertRegex(text, says)
                self.assertIsInstance(raised.exception, ValueError)
                self.assertTrue(raised.exception.message)
        self.assertEqual(len(segment()), len(segment(t=T)))

    def test_errors_have_places(self):
        with self.assertRaises(prehend.GrammarError) as raised:
            prehend.Grammar(takes.ROOT / "tests/python/wrong.grammar")
        error = raised.exception
        self.assertTrue(error.file.endswith("wrong.grammar"))
        self.assertEqual((error.line, error.column), (4, 9))
        self.assertIn("did you mean 'distance'?", error.remedy)
        self.assertIn("^", str(error))

    def test_rows_of_a_table_are_named_by_the_argument(self):
        labels = pd.DataFrame({"begin_s": [0, 1.0], "end_s": [1, 0.5], "label": ["contact", "graspin"]}, index=[7, 9])
        for truth, of in ((labels, "truth, row 9"), ([labels, labels], "truth[0], row 9")):
            with self.assertRaises(prehend.Error) as raised:
                prehend.Grammar("pick_and_place_from_motion").score([segment()] * (len(truth) if of[5] == "[" else 1), truth)
            error = raised.exception
            self.assertEqual((error.file, error.line, error.column), (of, 0, 0))
            self.assertTrue(str(error).startswith(of + ": error: 'graspin' ends before it begins: 1 s to 0.5 s"), error)
            self.assertTrue(str(error).endswith("hint: leave out what ends before it begins"), error)
            self.assertNotIn("/tmp", str(error.diagnostics))
        with self.assertRaises(prehend.Error) as raised:
            Truth.score(labels.assign(end_s=2))
        self.assertIn("truth, row 9: error: found the label 'graspin'", str(raised.exception))
        self.assertTrue(raised.exception.remedy.endswith(": map='labels.yaml'"), raised.exception)
        twice = pd.DataFrame({"begin_s": [0, 0.5], "end_s": [1, 2], "label": ["reaching"] * 2})
        of_arrays = prehend.episode(GOOD, rate_hz=60, entities=takes.ENTITIES)
        for call in (Truth.score, lambda truth: prehend.Grammar("pick_and_place_from_motion").margins(
                of_arrays, truth, over=["reach_radius"])):
            with warnings.catch_warnings(record=True) as told:
                warnings.simplefilter("always", prehend.DoubtfulLabels)
                call(twice)
            told = [str(one.message) for one in told if "overlaps" in str(one.message)]
            self.assertEqual(len(told), 1)
            self.assertTrue(told[0].startswith("truth, row 1: warning: a label overlaps"), told)
            self.assertTrue(told[0].endswith("did two people mark them? score the rows of one alone"), told)

    def test_times_in_another_unit(self):
        for factor, unit in ((1e3, "milliseconds by 1000"), (1e6, "microseconds by 1e6"), (1e9, "nanoseconds by 1e9")):
            with self.assertRaises(prehend.FrameError) as raised:
                segment(t=(T * factor).astype(np.int64))
            self.assertEqual(raised.exception.remedy, f"t is in seconds; divide {unit}")

    def test_a_monitor_is_of_one_thread_at_a_time(self):
        monitor = prehend.Grammar("pick_and_place_from_motion").monitor(takes.ENTITIES)
        refused, other = [], []

        def watch(mine):
            for i in range(3000):
                try:
                    monitor._monitor.take('{"tick": %d}' % (len(refused) + i * 2 + mine))
                except prehend.FrameError as error:
                    (refused if "another thread" in str(error) else other).append(str(error))

        threads = [threading.Thread(target=watch, args=[mine]) for mine in (0, 1)]
        for one in threads:
            one.start()
        for one in threads:
            one.join()
        monitor._monitor.take('{"tick": 1000000}')  # it still works
        self.assertTrue(all("hint: a monitor for each thread" in one for one in refused))


class Doubtful(unittest.TestCase):
    """Data that can hardly be meant are said, at the caller's line; what is right is not."""

    def told(self, frames=GOOD, entities=takes.ENTITIES):
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            segment(frames, entities=entities)
        doubts = [one for one in told if one.category is prehend.DoubtfulFrames]
        for one in doubts:
            self.assertEqual(one.filename, __file__)
            self.assertIn("hint: ", str(one.message))
        return "\n".join(str(one.message) for one in doubts)

    def test_what_is_right_is_not(self):
        self.assertEqual(self.told(), "")
        held = {"cup": GOOD["cup"] + (0, 0, 1), "right_hand": GOOD["cup"] + (0, 0, 1.1)}
        self.assertEqual(self.told(held), "", "a hand may hold it")
        turned = {**takes.ENTITIES, "table": {**takes.ENTITIES["table"], "quat_wxyz": (0.924, 0, 0, 0.383)}}
        self.assertEqual(self.told(entities=turned), "")

    def test_units(self):
        for factor in (100, 1000):
            self.assertIn("m apart", self.told({one: at * factor for one, at in GOOD.items()}))
        self.assertIn("m apart", self.told(cup(GOOD["cup"] * 1000)))
        self.assertIn("'cup' is 200 m long", self.told(entities={**takes.ENTITIES, "cup": ("Cup", (70, 70, 200))}))

    def test_nothing_below(self):
        no_table = {one: spec for one, spec in takes.ENTITIES.items() if one != "table"}
        self.assertIn("nothing is below 'cup'", self.told(entities=no_table))
        self.assertIn("nothing is below 'cup'", self.told({one: at[:, [0, 2, 1]] for one, at in GOOD.items()}), "y is up")

    def test_fixed(self):
        fixed = {**takes.ENTITIES, "cup": {"class": "Cup", "size_m": (0.07, 0.07, 0.2), "fixed": True}}
        moved = GOOD["cup"] + np.outer(np.arange(N) > N / 2, (0.5, 0, 0))
        self.assertEqual(self.told({**GOOD, "cup": moved}, fixed), "'cup' is said to be fixed, and moves by 0.50 m\n"
                         "  hint: fixed is only what never moves")
        still = np.repeat(GOOD["cup"][:1], len(GOOD["cup"]), axis=0)
        still[7] += (0.5, 0, 0)  # an error of the tracker
        self.assertEqual(self.told({**GOOD, "cup": still}, fixed), "")

    def test_a_quaternion_with_w_last(self):
        turn = np.tile([0.3827, 0, 0, 0.9239], (N, 1))  # by 45 degrees, w last
        for order, says in ((turn, "this looks like (x, y, z, w)"), (turn[:, [3, 0, 1, 2]], "")):
            said = self.told({one: np.hstack([at, order]) for one, at in GOOD.items()})
            self.assertEqual(said != "", says != "", said)
            self.assertIn(says, said)

        w_last = {"cup": [0, 0, 0.2, 0.98], "right_hand": [0.7, 0, 0.14, 0.7], "left_hand": [0.6, 0.6, 0.36, 0.38]}
        entities = {**takes.ENTITIES, "left_hand": "Hand"}
        frames = {one: np.hstack([GOOD[one if one in GOOD else "right_hand"], np.tile(order, (N, 1))])
                  for one, order in w_last.items()}
        self.assertIn("the last is 0.98", self.told(frames, entities), "hands point anywhere")
        self.assertEqual(self.told({one: at[:, [0, 1, 2, 6, 3, 4, 5]] for one, at in frames.items()}, entities), "")
        del frames["cup"]
        self.assertEqual(self.told(frames, entities), "")

    def test_live_and_later(self):
        monitor = prehend.Grammar("contact").monitor(takes.ENTITIES)
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            for frame, z in enumerate((0.86, 0.9, 100, 1000, 0.9)):
                monitor.update(frame / 10, {"cup": (0, 0, z)})
        doubts = [str(one.message) for one in told if one.category is prehend.DoubtfulFrames]
        self.assertEqual(len(doubts), 1, "it is said once")
        self.assertIn("positions are up to 99.14 m apart", doubts[0])

    def test_live(self):
        with self.assertWarns(prehend.DoubtfulFrames):
            updated((0, {"cup": (0, 0, 860), "right_hand": (300, 0, 900)}))
        for wrong, hint in ((1.7e9, "t - t0"), (5e9, "t - t0")):
            with self.assertRaisesRegex(prehend.FrameError, "t: found") as caught:
                updated((wrong, {}))
            self.assertIn(hint, caught.exception.remedy)
        with self.assertRaisesRegex(prehend.FrameError, r"'cup': found \(nan, 0.0, 1.0\)"):
            updated((0, {"cup": (NAN, 0, 1)}))
        with self.assertRaisesRegex(prehend.FrameError, "touches: found 'cup', wanted a pair"):
            updated((0, {}), touches=["cup"])


class Folders(unittest.TestCase):
    def test_one_that_is_not_there(self):
        for words in (["benchmark", "nothere", "--grammar", "pick_and_place", "-o", "/nowhere/else"],
                      ["baseline", "train", "nothere"], ["dataset", "join", "nothere", "-o", "/nowhere/else"]):
            done = subprocess.run([sys.executable, "-m", "prehend", *words], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2, (words, done.stderr))
            self.assertRegex(done.stderr, "nothere")
            self.assertNotIn("Traceback", done.stderr)


if __name__ == "__main__":
    unittest.main()
