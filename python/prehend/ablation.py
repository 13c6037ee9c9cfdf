# SPDX-License-Identifier: Apache-2.0
"""What each modifier of a grammar is worth: the same episodes, judged without it (docs/benchmark.md)."""
import os
import re

from . import _prehend
from .baselines import episodes_of
from .mutants import mutants


def modifiers(grammar):
    """The grammar as it is, and without each single modifier: what is left out, and the rest."""
    yield "", _prehend.Grammar(grammar, {})
    for one in mutants(grammar, []):
        if found := re.fullmatch(r"(\w+): dropped: (?!or drop$)(.*)", one.what):
            yield f"{os.path.basename(one.file)}:{one.line}, {found[1]}: {found[2]}", _prehend.Grammar(grammar, {}, {one.file: one.text})


def judged(folder, names, labels, grammar, parts):
    """Of each of these grammars what is left out, and rows as `score` prints them, of the episodes of a set."""
    episodes = {name: one for name, one in episodes_of(folder) if name in names}
    truth = {}
    for name, one in episodes.items():
        rate = one.ticks_per_second
        truth[name] = [{"event": row["event"], "roles": {part: row[part] for part in parts if row[part]},
                        "begin_tick": float(row["begin_s"]) * rate, "end_tick": float(row["end_s"]) * rate} for row in labels[name]]
    for what, program in modifiers(grammar):
        rows = []
        for name, one in episodes.items():
            found = [{"event": event, "roles": {role: who for role, who in roles if role in parts}, "begin_tick": begin, "end_tick": end}
                     for event, roles, begin, end, *_ in one._opened.segment(program)[0]]  # pylint: disable=protected-access
            rows.append({"episode": name, "end_tick": one.duration_s * one.ticks_per_second, "edit": float("nan"),
                         "truth_events": {"ticks_per_second": one.ticks_per_second, "events": truth[name]},
                         "found_events": {"ticks_per_second": one.ticks_per_second, "events": found}})
        yield what, rows
