# SPDX-License-Identifier: Apache-2.0
"""Activity grammars over poses: what hands do with things, as timed events.

A grammar is a text of rules: reach, grasp, slide, pick up, transport, put down, and events of your
own. It is applied to recordings of trackers and robots, to arrays, and to what prehend simulates.

>>> import prehend
>>> grammar = prehend.Grammar("pick_and_place_from_motion", hold_way="4 mm")
>>> events = grammar.segment({"cup": cup, "right_hand": hand}, rate_hz=60,       # arrays (N, 3) or (N, 7)
...                          entities={"cup": ("Cup", (0.08, 0.08, 0.1)), "right_hand": "Hand"})
>>> events[events.event == "grasping"]                # a pandas DataFrame, with begin_s and end_s
>>> grammar.score(events, "labels.csv")               # F1, boundary errors, .. against labels by people
>>> grammar.explain(prehend.open("take1.jsonl"), "sliding@2s")

`open` reads recordings and episode files, `episode` makes an episode of arrays or of a table,
`Grammar.monitor` watches live data. Metres, seconds, radians, newtons; z is up; quaternions are
(w, x, y, z). Errors are `Error`, a ValueError, with file, line, column and remedy. Every rule that
asks for what the data do not have is a warning, `MissingFacts`; data that look wrong (millimetres, no
table, z not up) are a warning, `DoubtfulFrames`; labels that do, `DoubtfulLabels`. `Events`, a
DataFrame, has its own help.

docs/python.md has it on a page; the grammars are described in docs/events.md.
"""
from ._prehend import __version__
from .episodes import Episode, Episodes, episode, open, program  # pylint: disable=redefined-builtin
from .errors import DoubtfulFrames, DoubtfulLabels, EpisodeError, Error, FrameError, GrammarError, MissingFacts
from .events import Events, Explanation
from .grammar import Grammar, Monitor

__all__ = ["open", "episode", "Episode", "Episodes", "Explanation", "Grammar", "Monitor", "program", "Error",
           "EpisodeError", "FrameError", "GrammarError", "MissingFacts", "DoubtfulFrames", "DoubtfulLabels"]  # Events: 19,000 lines of pandas
