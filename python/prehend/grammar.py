# SPDX-License-Identifier: Apache-2.0
"""Grammars: compiled, and applied to episodes, arrays and live data."""
import contextlib
import csv
import io
import json
import os
import re
import tempfile
from typing import Optional, Union

import numpy as np
import pandas as pd

from . import _prehend, episodes, events, frames
from .errors import DoubtfulFrames, DoubtfulLabels, Error, FrameError, GrammarError, fail, number, warn, wrong


class Grammar:
    """A grammar, compiled.

    Parameters
    ----------
    name_or_path : str or path
        Of the library ("pick_and_place") or a file ("my/rules.grammar"); several with '+' between
        them are one grammar.
    **parameters
        Other values for its parameters, with units as in its text: ``reach_radius="25 cm"``. Plain
        numbers have none.

    Raises
    ------
    GrammarError
        With file, line, column and remedy.

    Examples
    --------
    >>> Grammar("pick_and_place_from_motion").segment(prehend.open("take1.jsonl"))
    """

    def __init__(self, name_or_path: episodes.Path, **parameters: Union[str, float]):
        values = {}
        for name, value in parameters.items():
            if isinstance(value, bool) or not isinstance(value, (str, int, float, np.number)):
                fail(GrammarError, f"{name}: found {value!r}, wanted a text with a unit, or a number", f"{name}='25 cm'")
            values[name] = value if isinstance(value, str) else repr(float(value))
        if not isinstance(name_or_path, (str, os.PathLike)):
            fail(GrammarError, f"found a {type(name_or_path).__name__}, wanted a name or path", "Grammar('pick_and_place')")
        try:
            self._compiled = _prehend.Grammar(os.fspath(name_or_path), values)
        except Error as error:
            raise GrammarError(error.diagnostics) from None

    name = property(lambda self: self._compiled.name, doc="As in its text; str.")
    parameters = property(lambda self: dict(self._compiled.parameters()), doc="Values of its parameters, dict of str.")

    @property
    def events(self) -> pd.DataFrame:
        """What it recognises: DataFrame by event with roles, their classes, and whether it is a phase of a hand."""
        table = pd.DataFrame(self._compiled.events(), columns=["event", "roles", "classes", "phase"])
        return table.set_index("event")

    def segment(self, frames_, **arrays) -> "events.Events":
        """What happens in an episode.

        Parameters
        ----------
        frames_ : Episode, Episodes, path, dict of arrays or pandas.DataFrame
            Arrays and tables as `prehend.episode` takes them.
        **arrays
            Of arrays and tables: entities, t or rate_hz, grips, touches, as `prehend.episode`.

        Returns
        -------
        Events
            What `prehend episode resegment` prints, tick by tick.

        Warns
        -----
        MissingFacts
            Rules that ask for what the episode does not have: touches, grips, gazes.
        """
        return self._episode(frames_, **arrays).segment(self)

    def _episode(self, one, **arrays):
        if isinstance(one, (dict, pd.DataFrame)):
            if "entities" not in arrays:
                wrong("entities are missing",
                      "segment(frames, rate_hz=60, entities={'cup': ('Cup', (0.08, 0.08, 0.1)), 'right_hand': 'Hand'})")
            return episodes.episode(one, **arrays)
        if isinstance(one, (str, os.PathLike)):
            one = episodes.open(one)
        if not isinstance(one, (episodes.Episode, episodes.Episodes)):
            wrong(f"frames: found a {type(one).__name__}, wanted an episode, a DataFrame or a dict of arrays",
                  "{'cup': array of shape (N, 3), ..}")
        if arrays:
            wrong(f"{', '.join(arrays)}: only of arrays and tables", "frames is an episode already")
        return one

    def monitor(self, entities: dict, **more) -> "Monitor":
        """A `Monitor` for live data, of entities as `prehend.episode` takes them."""
        return Monitor(self, entities, **more)

    def explain(self, frames_, event: str = "", **arrays) -> "events.Explanation":
        """Why an event began and ended, or did not happen: see `Episode.explain`."""
        one = self._episode(frames_, **arrays)
        return one.explain(event, grammar=self)

    def score(self, found, truth, map=None, collar_s: Optional[float] = None) -> pd.DataFrame:  # pylint: disable=redefined-builtin
        """How well events agree with true ones: the figures of `prehend score`.

        Parameters
        ----------
        found : Events, Episode, or list of them
            Of one episode each. Of an episode: what this grammar recognises.
        truth : path, pandas.DataFrame, or list of them
            Labels: .csv, .eaf or .TextGrid; or a table with begin_s, end_s, event or label
            ("grasping(right_hand, cup)", or the event alone), and columns of roles.
        map : path, optional
            What labels of a file mean (docs/labels.md).
        collar_s : float, optional
            For the columns collar_f and collar_error_rate; by default as the map says, or 0.05.

        Returns
        -------
        pandas.DataFrame
            By event, and "all": true, found, f1_10, f1_25, f1_50 (0 to 1), edit, Ward's classes,
            boundary errors in seconds, latency, and more; docs/regression-suite.md says what each
            is; ``.attrs["moments"]``: of labels of a moment, which are in no other figure, how many lie
            in such an event, by event. Events that no label names are not judged; without any label and a map all are.
            `DoubtfulLabels` warns of labels that overlap, or that are found if all are moved.
        """
        found, truth = _many(found), _many(truth)
        collar_s = collar_s if collar_s is None else number(collar_s, "collar_s", 0, 10, "0 to 10 seconds")
        if len(found) != len(truth) or not len(found):
            fail(Error, f"{len(found)} of found, {len(truth)} of truth", "one truth for each episode, in the same order")
        compared = []
        with _Truth(truth, self) as labelled:
            for one, file in zip(found, labelled.files):
                if isinstance(one, pd.DataFrame) and not isinstance(one, events.Events):
                    fail(Error, "found: a table does not say which entities there are",
                         "what segment() returned, monitor.events(told), or an episode")
                one = one if isinstance(one, events.Events) else self.segment(one)
                source = one._checked()._has_source()
                unknown = set(one["event"]) - set(self.events.index)
                if unknown and source.grammar:  # what another grammar recognises besides is not judged
                    one = one[~one["event"].isin(unknown & set(source.grammar.events.index))]
                place = f"found[{len(compared)}]"
                labelled.tables[place] = ("found" if len(found) == 1 else place, one.index)
                compared.append((source.episode, one._tuples(), file, source.end))
            scores, strange = _prehend.score(self._compiled, compared, str(map or ""), collar_s)
        warn(labelled.as_called(strange), DoubtfulLabels)
        scores = json.loads(scores)
        table = pd.json_normalize(scores["events"] + [scores["total"]], sep="_").set_index("event").apply(pd.to_numeric)  # null: NaN
        table.attrs["moments"] = scores["moments"]
        return table

    def margins(self, episodes_, truth, map=None, over=(), within: float = 0.01) -> pd.DataFrame:  # pylint: disable=redefined-builtin
        """How far each parameter may be from its value before the score drops.

        Parameters
        ----------
        episodes_ : Episodes, Episode, path, or list of them
            Recordings and episode files; all episodes of these.
        truth : list, path, pandas.DataFrame, "golden" or "recorded"
            As `score` takes it, one for each episode; or goldens, or what was recorded.
        map : path, optional
            What labels mean.
        over : list of str
            These parameters; default: all.
        within : float
            So much of F1 may be lost.

        Returns
        -------
        pandas.DataFrame
            By parameter: value, f1, from, to, best, best_at, ..; those with the smallest range first.
        """
        opened = [each for one in _many(episodes_) for each in _many(self._episode(one))]
        truth, within = _many(truth), number(within, "within", 0, 1, "0 to 1")
        with tempfile.TemporaryDirectory(prefix="prehend_") as folder, _Truth(truth, self) as labelled:
            files = [one.file or os.path.join(folder, f"{number}.jsonl") for number, one in enumerate(opened)]
            for file, one in zip(files, opened):
                if not one.file:
                    one.write(file)
            text, strange = _prehend.margins(list(dict.fromkeys(files)), self._compiled, labelled.files, str(map or ""),
                                             [over] if isinstance(over, str) else [str(one) for one in over], within)
        warn(labelled.as_called(strange), DoubtfulLabels)
        return pd.read_csv(io.StringIO(text)).set_index("parameter")

    def __repr__(self):
        return f"<prehend.Grammar {self.name!r}>"

    def __str__(self):
        return self._compiled.describe()


def _many(one):
    return one if isinstance(one, (list, tuple, episodes.Episodes)) else [one]


class _Truth(contextlib.ExitStack):
    """Labels as files, and what is said of them in the words of a call: a table is no file, and there are no options."""

    _WORDS = {"--map labels.yaml": "map='labels.yaml'", "golden: --truth FILE (": "golden: truth=.. (",
              "--skip-bad-labels leaves out what": "leave out what",
              "rows: {COLUMN: NAME} in a file of takes tells them apart": "score the rows of one alone",
              "; or rows: {": ", in the file map=; or truth=table[table[COLUMN] == VALUE]; rows: {"}

    def __init__(self, truth, grammar):
        super().__init__()
        self.files = [self.enter_context(_file_of(one, grammar)) for one in truth]
        self.tables = {file: ("truth" if len(truth) == 1 else f"truth[{number}]", one.index)
                        for number, (file, one) in enumerate(zip(self.files, truth)) if isinstance(one, pd.DataFrame)}

    def as_called(self, text):
        for words in self._WORDS.items():
            text = text.replace(*words)
        for file, (name, index) in self.tables.items():
            def row(at, name=name, index=index):
                return f"{name}, row {index[min(int(at[1]) - 2, len(index) - 1)]}" if int(at[1] or 0) > 1 else name
            text = re.sub(re.escape(file) + r"(?::(\d+)(?::\d+)?)?", row, text)
        return text

    def __exit__(self, kind, error, trace):
        super().__exit__(kind, error, trace)
        if isinstance(error, Error):
            raise type(error)([((self.as_called(f"{file}:{line}"), 0, 0) if file in self.tables else (file, line, column))
                               + tuple(map(self.as_called, texts)) for file, line, column, *texts in error.diagnostics]) from None


@contextlib.contextmanager
def _file_of(labels, grammar):
    """Labels as a file: a table is written, as long as it is needed."""
    if isinstance(labels, (str, os.PathLike)):
        yield os.fspath(labels)
        return
    if not isinstance(labels, pd.DataFrame):
        fail(Error, f"truth: found a {type(labels).__name__}, wanted a DataFrame or a file of labels")
    if {"begin_s", "end_s"} - set(labels.columns) or not {"event", "label"} & set(labels.columns):
        fail(Error, f"truth: the table has the columns {list(labels.columns)}",
             "wanted begin_s, end_s and label; or event and a column for each role")
    if {"event", "label"} <= set(labels.columns) or labels.columns.has_duplicates:
        fail(Error, f"truth: the table has the columns {list(labels.columns)}: which are meant?", "'label', or 'event' and roles, each once")
    named = [role for role in dict.fromkeys(role for each in grammar.events["roles"] for role in each) if role in labels.columns]
    with tempfile.NamedTemporaryFile("w", suffix=".csv", encoding="utf-8", newline="") as file:
        rows = csv.writer(file)
        own = ["begin_s", "end_s", "event", "label", "decided_s", "open_end", *named]
        others = [name for name in labels.columns if name not in own and (  # they may say whose rows these are
            not isinstance(labels, events.Events) or name in ("scenario", "episode"))]
        rows.writerow([*others, "begin_s", "end_s", "label", *named])
        for at, row in zip(labels.index, labels.to_dict("records")):
            label = row.get("label", row.get("event"))
            times = [row[name] if isinstance(row[name], str) else repr(number(row[name], f"truth, row {at}: {name}"))
                     for name in ("begin_s", "end_s")]
            rows.writerow([*(" ".join(str(row[name]).split()) for name in others), *times, *("" if pd.isna(one) else one for one in (label, *(row[role] for role in named)))])
        file.flush()
        yield file.name


class Monitor:
    """Watches frames as they come, and tells each event as soon as it is certain.

    Parameters
    ----------
    grammar : Grammar
    entities : dict
        As `prehend.episode` takes them.
    ticks_per_second : int
        How finely time is counted.
    bridge_s : float
        For so long what is not tracked is as it was seen last.

    Notes
    -----
    Its memory does not grow with time. It may be used by any thread, but by one at a time.

    Examples
    --------
    >>> m = Grammar("pick_and_place").monitor({"cup": ("Cup", (0.08, 0.08, 0.1)), "right_hand": "Hand"})
    >>> m.update(0.02, {"cup": (0, 0, 0.8), "right_hand": (0.1, 0, 0.8)}, grips={"right_hand": 0.5})
    []
    """

    def __init__(self, grammar: Grammar, entities: dict, ticks_per_second: int = 10_000, bridge_s: float = 0.1,
                 name: str = "live"):
        if not isinstance(grammar, Grammar):
            wrong(f"grammar: found a {type(grammar).__name__}, wanted a Grammar", "prehend.Grammar(..).monitor(entities)")
        if number(ticks_per_second, "ticks_per_second", 1, wanted="a whole number", kind=FrameError) % 1:
            wrong(f"ticks_per_second: found {ticks_per_second!r}, wanted a whole number")
        line, self._standing = frames.first_line(entities, ticks_per_second, name, grammar.name, bridge_s=bridge_s)
        self._monitor, self._entities, self._line, self._grammar = _prehend.Monitor(grammar._compiled, line), entities, line, grammar
        self._per_second, self._last, self._t, self._end = int(ticks_per_second), None, None, None
        warn(self._monitor.warnings())

    def update(self, t: float, poses: dict, grips: Optional[dict] = None, touches=()) -> list:
        """A frame.

        Parameters
        ----------
        t : float
            Seconds, more than before. What begins before 0 counts from its first frame, and a warning says so.
        poses : dict
            By entity (x, y, z) or (x, y, z, qw, qx, qy, qz) in metres; None or NaN: not tracked; or a
            dict as a sample of docs/recording-format.md. What is not mentioned stays where it was.
        grips : dict of float
            By hand, 0 open .. 1 closed.
        touches : list
            Pairs ``("cup", "table")``, also with the upward part of the contact normal on the first,
            ``("cup", "table", 1.0)``; or dicts as in docs/recording-format.md. Touches that are not
            listed have ended.

        Returns
        -------
        list of dict
            Events that became certain: event, its roles, begin_s, end_s, decided_s, open_end.
        """
        tick = self._tick(t)
        if isinstance(touches, (str, dict)) or not hasattr(touches, "__iter__"):
            wrong(f"touches: found a {type(touches).__name__}, wanted a list of pairs", "[('cup', 'table')]")
        if not isinstance(poses, dict):
            wrong(f"poses: found a {type(poses).__name__}, wanted a dict by entity", "{'cup': (x, y, z)}")
        samples = {one: self._sample(one, pose) for one, pose in poses.items()}
        if self._last is None:
            for one, at in self._standing.items():
                samples.setdefault(one, self._sample(one, at[0]))
            at = {one: np.array([[*pose["at_m"], *pose.get("quat_wxyz", [])]]) for one, pose in samples.items()
                  if pose and "at_m" in pose and one in self._entities}
            doubts = frames.doubts(self._entities, at)
            warn(doubts, DoubtfulFrames)
            self._near = [] if doubts else None
        line = {"tick": tick, "samples": samples,
                "hands": {hand: grip if isinstance(grip, dict) else {"trigger": grip} for hand, grip in frames.by_name(grips, "grips").items()},
                "touches": [self._touch(one) for one in touches]}
        warned = self._monitor.warnings()
        found = self._monitor.take(frames.to_json(line))
        warn(self._monitor.warnings()[len(warned):])
        self._last, self._t = tick, t
        for at in (pose["at_m"] for pose in samples.values() if pose and "at_m" in pose):
            self._near = list(at) if self._near is None else self._near
            if self._near and (span := max(abs(a - b) for a, b in zip(at, self._near))) > frames.FAR_M:
                warn(frames.FAR.format(span), DoubtfulFrames)
                self._near = []  # it is said
        return self._told(found)

    def finish(self, t: Optional[float] = None) -> list:
        """The episode ends at t seconds, by default with the last frame: events that were open, as `update` tells them."""
        end = (self._last or 0) + 1 if t is None else self._tick(t)
        told = self._told(self._monitor.finish(end))
        self._end = end + self._monitor.moved()
        return told

    def events(self, told: list) -> "events.Events":
        """What `update` and `finish` told, as `Events`: to be scored, drawn, written. They end with the episode, or with the last frame."""
        roles, last = self._grammar.events["roles"], ["begin_s", "end_s", "decided_s", "open_end"]
        for number_, one in enumerate(told if isinstance(told, (list, tuple)) else [told]):
            if missing := [key for key in ("event", *last) if not isinstance(one, dict) or key not in one]:
                fail(Error, f"told: found {'one without ' + missing[0] if isinstance(one, dict) else type(one).__name__} at {number_}, wanted "
                     "dicts", "a list of what update() and finish() told")
        end = self._end or (self._last or 0) + 1 + self._monitor.moved()
        episode = _prehend.episode_of(self._line, np.zeros(1, dtype=np.int64), [], [], np.zeros((0, 3), dtype=np.int64),
                                      np.zeros(0), end)
        if not told:
            return events.of([], episode, self._grammar, end)
        table = events.Events([{"scenario": episode.name, "episode": 0, **one} for one in told])
        named = [one for one in dict.fromkeys(role for row in roles for role in row) if one in table.columns]
        table = table[["scenario", "episode", "event", *named, *last, *(set(table.columns) - {*named, *last, *table.columns[:3]})]]
        table[named] = table[named].fillna("")
        table._source = events.Source(episode, self._grammar, end)
        return table._checked().sort_values(["begin_s", "end_s"], ignore_index=True)

    @staticmethod
    def _touch(one):
        if isinstance(one, dict):
            return one
        if not isinstance(one, (tuple, list)) or len(one) not in (2, 3):
            wrong(f"touches: found {one!r}, wanted a pair", "[('cup', 'table')]")
        return dict(zip(("a", "b", "up_on_a"), one))

    def _tick(self, t):
        number(t, "t", kind=FrameError)
        if abs(t - (self._t or 0)) > 1e6:
            wrong(f"t: found {t:g} s, {'the first frame' if self._t is None else f'after {self._t:g} s'}",
                  "count seconds from the beginning: t - t0")
        tick = int(round(float(t) * self._per_second))
        if self._last is not None and tick <= self._last:
            wrong(f"t = {t:g} s is not after {self._t:g} s by 1/{self._per_second} s", "times increase; leave late frames out")
        return tick

    @staticmethod
    def _sample(entity, pose):
        if pose is None or isinstance(pose, dict):
            return pose
        try:
            values = [float(one) for one in pose]
        except (TypeError, ValueError):
            wrong(f"'{entity}': found {pose!r}, wanted numbers", "(x, y, z) or (x, y, z, qw, qx, qy, qz)")
        if len(values) not in (3, 7):
            wrong(f"'{entity}': found {len(values)} numbers, wanted 3 or 7", "(x, y, z) or (x, y, z, qw, qx, qy, qz)")
        if all(np.isnan(values[:3])):
            return None
        if not np.isfinite(values).all():
            wrong(f"'{entity}': found {tuple(values)}", "numbers, or NaN in all of x, y, z: not tracked")
        return {"at_m": values[:3], **({"quat_wxyz": values[3:]} if len(values) == 7 else {})}

    def _told(self, timeline):
        rate = float(self._per_second)
        return [{"event": event, **dict(roles), "begin_s": begin / rate, "end_s": end / rate, "decided_s": decided / rate,
                 "open_end": open_end, **events.named_values(values)}
                for event, roles, begin, end, decided, open_end, values in timeline]
