# SPDX-License-Identifier: Apache-2.0
"""Timed events as a table that draws itself, and explanations."""
import difflib
import html
import json
import os

import numpy as np
import pandas as pd

from . import _prehend
from .errors import Error, fail, number

_FIRST = ["scenario", "episode", "event"]
_LAST = ["begin_s", "end_s", "decided_s", "open_end"]


class Source:
    """Where events come from: what else is asked of them needs it."""

    def __init__(self, episode, grammar, end):
        self.episode, self._grammar, self.end = episode, grammar, end

    @property
    def grammar(self):
        """For colours and phases; by default the episode's own, if there is one of its name."""
        from .grammar import Grammar

        if self._grammar is None:
            try:
                self._grammar = Grammar(self.episode.grammar)
            except Error:  # of another project, say
                return None
        return self._grammar


class Events(pd.DataFrame):
    """Timed events, one a row: a pandas DataFrame that draws itself in a notebook.

    Columns
    -------
    scenario, episode : str, int
        Of what the event is; the number in an episode file, 0 of what is in none.
    event : str
        Its name in the grammar.
    hand, object, .. : str
        Who takes part, a column for each role and attribute; "" where an event has no such role.
    begin_s, end_s : float
        Seconds, [begin, end).
    decided_s : float
        When the event became certain: a monitor tells it then.
    open_end : bool
        It had not ended when the episode did.
    force_N, .. : float
        Numbers that events carry, SI units; NaN where an event has none.
    """

    _metadata = ["_source"]
    _source = None

    @property
    def _constructor(self):
        return Events

    def __reduce__(self):
        return _restored, (pd.DataFrame(self), self.attrs)

    @property
    def roles(self) -> list:
        """Names of the columns that say who takes part, list of str."""
        return [name for name in self.columns if name not in _FIRST + _LAST and self[name].dtype == object]

    def _checked(self):
        """Itself; or what was changed is no event any more."""
        for name in ("event", "begin_s", "end_s"):
            if name not in self.columns:
                fail(Error, f"the events have no column {name!r}", "keep event, begin_s, end_s, and the columns of their roles")
        for name in ("begin_s", "end_s", *({"decided_s"} & {*self.columns})):
            for row, value in self[name].items():
                number(value, f"row {row} of the events: {name}")
        for row, begin, end in zip(self.index, self["begin_s"], self["end_s"]):
            if not begin < end:
                fail(Error, f"row {row} of the events: found {begin:g} to {end:g} s, wanted a begin and a later end")
        return self

    def _tuples(self):
        self._checked()
        per_second = self._source.episode.ticks_per_second()
        roles, tick = self.roles, lambda s: int(round(s * per_second))
        return [(row["event"], [(role, row[role]) for role in roles if isinstance(row[role], str) and row[role]], tick(row["begin_s"]),
                 tick(row["end_s"]), tick(row.get("decided_s", row["end_s"]))) for row in self.to_dict("records")]

    def _has_source(self):
        if self._source is None:
            fail(Error, "it is not known any more of which episode these events are",
                 "ask the events of one episode: those that segment() or .events returned, or rows of them")
        return self._source

    def labels(self, per_frame: float = 30, events=None, idle: str = "") -> pd.Series:
        """The label of each frame of a video, for data sets such as LeRobot's.

        Where several events hold, the one that began last counts; of those that began together the
        one that ends first. One hand of two: ``events[events.hand == "left_hand"].labels()``.

        Parameters
        ----------
        per_frame : float
            Frames per second of the video.
        events : str or list of str
            Which ones; by default the phases of hands (``drawn as phase``), or all if there is none.
        idle : str
            The label where no event holds.

        Returns
        -------
        pandas.Series
            Categorical, by time in seconds; ``.cat.codes`` is an index per frame.
        """
        number(per_frame, "per_frame", 1e-6, 1e6, "frames per second, like 30")
        source = self._checked()._has_source()
        t = np.arange(0, source.end / source.episode.ticks_per_second(), 1 / per_frame)
        found = np.full(len(t), idle, dtype=object)
        if events is None and source.grammar:
            events = source.grammar.events.index[source.grammar.events["phase"]]
        events = [events] if isinstance(events, str) else events
        known = {*self["event"], *source.grammar.events.index} if source.grammar else set()
        for name in set(events) - known if known and events is not None else ():
            near = difflib.get_close_matches(str(name), map(str, known), 1)
            fail(Error, f"events: no event of the grammar is called {name!r}",
                 f"did you mean {near[0]!r}?" if near else f"there are: {', '.join(sorted(known))}")
        chosen = self[self["event"].isin(events)] if events is not None and len(events) else self
        for row in chosen.sort_values(["begin_s", "end_s"], ascending=[True, False]).itertuples():
            found[np.searchsorted(t, row.begin_s - 1e-9):np.searchsorted(t, row.end_s - 1e-9)] = row.event
        names = [idle] + sorted(set(chosen["event"]) - {idle})
        return pd.Series(pd.Categorical(found, categories=names), index=pd.Index(t, name="t"), name="label")

    def write(self, file) -> None:
        """Writes the events for people's tools.

        Parameters
        ----------
        file : str or path
            NAME.eaf (ELAN), NAME.TextGrid (Praat), NAME.csv or NAME.json.
        """
        if str(file).endswith(".json"):
            os.makedirs(os.path.dirname(os.path.abspath(file)), exist_ok=True)  # as for the others
            self.to_json(file, orient="records")
            return
        if not str(file).lower().endswith((".csv", ".eaf", ".textgrid")):
            fail(Error, f"found {os.path.basename(str(file))!r}, wanted NAME.csv, .eaf, .TextGrid or .json", "write('take1.eaf')")
        self._has_source().episode.write_labels(self._tuples(), str(file), getattr(self._source.grammar, "_compiled", None))

    def svg(self) -> str:
        """The timeline as SVG, str: a row for each event and hand."""
        source = self._has_source()
        return _prehend.timeline_svg(self._tuples(), source.episode.ticks_per_second(), source.end,
                                     getattr(source.grammar, "_compiled", None))

    def _repr_svg_(self):
        return self.svg() if self._source is not None and len(self) and set(_LAST) <= set(self.columns) else None

    def _repr_html_(self):
        return (self._repr_svg_() or "") + (super()._repr_html_() or "")


def of(timeline, episode, grammar, end, number=None):
    """Tuples of the library as Events."""
    rate = float(episode.ticks_per_second())
    rows, roles = [], {}
    for event, members, begin, end_tick, decided, open_end, values in timeline:
        row = {"scenario": episode.name, "episode": number or 0, "event": event, **dict(members),
               "begin_s": begin / rate, "end_s": end_tick / rate, "decided_s": decided / rate, "open_end": open_end}
        roles.update(dict(members))
        row.update(named_values(values))
        rows.append(row)
    order = sorted(roles, key=lambda role: (["hand", "object"] + list(roles)).index(role))
    columns = _FIRST + order + _LAST
    table = Events(rows, columns=columns + sorted({name for row in rows for name in row} - set(columns)))
    table[order] = table[order].fillna("")
    table._source = Source(episode, grammar, end)
    return table


def _restored(table, attrs):
    """What was pickled: of which episode it is, is not known any more."""
    table = Events(table)
    table.attrs = attrs
    return table


def named_values(values):
    """By name and unit: force_N."""
    return {f"{name}_{unit.replace('/', '_per_')}" if unit else name: value for name, value, unit in values}


def together(tables):
    """Events of several episodes as one table."""
    tables = list(tables)
    if len(tables) == 1:
        return tables[0]
    table = pd.concat(tables, ignore_index=True) if tables else of([], None, None, 0)
    roles = [name for one in tables for name in one.roles]
    columns = _FIRST + list(dict.fromkeys(roles)) + _LAST
    table = Events(table[columns + [name for name in table.columns if name not in columns]])
    table[list(dict.fromkeys(roles))] = table[list(dict.fromkeys(roles))].fillna("")
    table._source = None
    return table


class Explanation:
    """Why events are as they are, or why one did not happen.

    ``print(explanation)`` shows it as ``prehend explain`` does; a notebook shows it as a tree.

    Attributes
    ----------
    text : str
    data : dict
        The same for programs: "events" or "missing", each with clauses, times and measured values.
    """

    def __init__(self, text, data):
        self.text, self.data = text, json.loads(data)

    def __str__(self):
        return self.text

    __repr__ = __str__

    def _repr_html_(self):
        def tree(reasons):
            items = "".join(
                f"<li>{'<b>' if one['is'] in ('turned', 'failed') else ''}<code>{html.escape(one['clause'])}</code>"
                f"{'</b>' if one['is'] in ('turned', 'failed') else ''} {html.escape(one['text'])}"
                f"{tree(one.get('because', []))}</li>" for one in reasons)
            return f"<ul>{items}</ul>" if items else ""

        parts = []
        for one in self.data.get("events", []):
            parts.append(f"<p><b>{html.escape(one['event'])}</b> {one['begin_s']:.4f} to {one['end_s']:.4f} s</p>")
            parts += [f"{name}{tree(one[name])}" for name in ("began", "ended", "counts", "waited") if one[name]]
        if missing := self.data.get("missing"):
            parts.append(f"<p><b>{html.escape(missing['event'])}</b> did not happen</p>{tree(missing['reasons'])}")
        return "".join(parts)
