# SPDX-License-Identifier: Apache-2.0
"""Episodes that were recorded, and scenarios that are played for it."""
import glob
import os
import pathlib
import shutil
import subprocess
import tempfile
import weakref
from collections.abc import Sequence
from typing import Optional, Union

import numpy as np
import pandas as pd

from . import _prehend, events, frames
from .errors import EpisodeError, fail, warn

Path = Union[str, "os.PathLike[str]"]

_MEASURED = ["x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz"]


def compiled(grammar):
    """The library's grammar of one that may be None, a name, or a Grammar."""
    from .grammar import Grammar

    if grammar is None or isinstance(grammar, Grammar):
        return grammar, grammar and grammar._compiled
    grammar = Grammar(grammar)
    return grammar, grammar._compiled


class Episode:
    """One episode: who took part, how they moved, and what happened.

    Made by `open` and `prehend.episode`. Nothing is read before it is asked for.
    """

    def __init__(self, opened, folder=None):
        self._opened, self._folder = opened, folder  # a folder that lives as long as its episodes

    name = property(lambda self: self._opened.name, doc="'skill/name' of a scenario, or that of a recording; str.")
    file = property(lambda self: self._opened.file, doc="The file that it is in; '' if it was made of arrays.")
    number = property(lambda self: self._opened.number, doc="Its number in an episode file; else None.")
    kind = property(lambda self: "simulated" if self._opened.was_simulated else "recording", doc="'simulated' or 'recording'.")
    grammar = property(lambda self: self._opened.grammar, doc="Name of the grammar that it names for itself.")
    ticks_per_second = property(lambda self: self._opened.ticks_per_second(), doc="How many ticks a second has; int.")
    duration_s = property(lambda self: self._opened.end() / self.ticks_per_second, doc="Its length in seconds.")

    @property
    def entities(self) -> pd.DataFrame:
        """Who takes part: DataFrame by name with class, classes, part_of, size_m, mass_kg (0: not known)."""
        return pd.DataFrame(self._opened.entities()).set_index("name")

    @property
    def events(self) -> "events.Events":
        """`Events` that were recorded with it; without any, those of its own grammar."""
        recorded = self._opened.recorded()
        if recorded is None:
            return self.segment()
        return events.of(recorded, self._opened, None, self._opened.end(), self.number)

    def segment(self, grammar=None) -> "events.Events":
        """What a grammar recognises, as `Grammar.segment` does; without one its own."""
        grammar, own = compiled(grammar)
        timeline, end, missing, failure = self._opened.segment(own)
        warn(missing + failure)
        return events.of(timeline, self._opened, grammar, end, self.number)

    def poses(self) -> pd.DataFrame:
        """How everything moved, a row per frame and entity.

        Returns
        -------
        pandas.DataFrame
            t (s); entity (categorical); x, y, z (m); qw, qx, qy, qz; vx, vy, vz (m/s); wx, wy, wz
            (rad/s); grip (0 open .. 1 closed; NaN: no hand). NaN: not tracked. World axes, z up.
        """
        ticks, poses, velocities, grips, _, _, failure = self._opened.frames()
        warn(failure)
        names = self.entities.index
        count, members = grips.shape
        values = np.concatenate([poses, velocities], axis=2).reshape(count * members, len(_MEASURED))
        table = pd.DataFrame(values, columns=_MEASURED, copy=False)
        table.insert(0, "t", np.repeat(ticks / float(self.ticks_per_second), members))
        table.insert(1, "entity", pd.Categorical.from_codes(np.tile(np.arange(members), count), names))
        table["grip"] = grips.ravel()
        return table

    def touches(self) -> pd.DataFrame:
        """What touched what: DataFrame with t (s), a, b, up_on_a (1: b holds a from below), force_n."""
        ticks, _, _, _, pairs, measured, failure = self._opened.frames()
        warn(failure)
        names = self.entities.index
        return pd.DataFrame({"t": ticks[pairs[:, 0]] / float(self.ticks_per_second),
                             "a": pd.Categorical.from_codes(pairs[:, 1], names),
                             "b": pd.Categorical.from_codes(pairs[:, 2], names),
                             "up_on_a": measured[:, 0], "force_n": measured[:, 1]})

    def signals(self, *names: str, grammar=None) -> pd.DataFrame:
        """Conditions and signals of a grammar over time.

        Parameters
        ----------
        *names : str
            Events, conditions, or what signals begin with ("distance"); without any: all.
        grammar : Grammar or str, optional
            Default: its own.

        Returns
        -------
        pandas.DataFrame
            A row per frame by time in seconds, a column per signal; SI units, in ``.attrs["units"]``.
            What is true or false is 1 or 0; NaN where there is no value.
        """
        ticks, columns = self._opened.signals(compiled(grammar)[1], list(map(str, names)))
        table = pd.DataFrame({name: values for name, _, values in columns},
                             index=pd.Index(ticks / float(self.ticks_per_second), name="t"), copy=False)
        table.attrs["units"] = {name: unit for name, unit, _ in columns}
        return table

    def explain(self, event: str = "", grammar=None) -> "events.Explanation":
        """Why an event began and ended when it did, or why there is none.

        Parameters
        ----------
        event : str
            "sliding", "reaching@1.2s", "sliding right_hand milk @2s"; "": a line for each event.
        grammar : Grammar or str, optional
            Default: its own.

        Returns
        -------
        Explanation
        """
        return events.Explanation(*self._opened.explain(compiled(grammar)[1], str(event)))

    def write(self, file: Path) -> None:
        """Writes its frames as a recording (docs/recording-format.md), NAME.jsonl."""
        if not str(file).endswith(".jsonl"):
            fail(EpisodeError, f"found {str(file)!r}, wanted NAME.jsonl")
        self._opened.write_frames(str(file))

    def __repr__(self):
        return f"<prehend.Episode {self.name!r}, {self.kind}, {self.duration_s:.3f} s>"

    def _repr_html_(self):
        return f"<p><b>{self.name}</b>, {self.kind}, {self.duration_s:.3f} s</p>{self.events._repr_svg_() or ''}"


class Episodes(Sequence):
    """Episodes in their order: ``episodes[0]``, ``episodes["slide/hop_divides_a_slide"]``, ``for one in episodes``.

    What an `Episode` has can be asked of a single one: ``prehend.open("take1.jsonl").poses()``.
    """

    def __init__(self, episodes):
        self._episodes = list(episodes)

    def __len__(self):
        return len(self._episodes)

    def __getitem__(self, which):
        if isinstance(which, slice):
            return Episodes(self._episodes[which])
        if not isinstance(which, str):
            return self._episodes[which]
        found = [one for one in self._episodes if which in (one.name, one.name.rsplit("/", 1)[-1])]
        if len(found) != 1:
            fail(EpisodeError, f"{len(found) or 'no'} episodes are called {which!r}", "names: "
                 + ", ".join(sorted({one.name for one in self._episodes})[:10]) + "; or a number: episodes[0]")
        return found[0]

    @property
    def events(self) -> "events.Events":
        """`Events` of all of them, in one table."""
        return events.together(one.events for one in self)

    def segment(self, grammar=None) -> "events.Events":
        """`Events` that a grammar recognises in all of them, in one table."""
        grammar = compiled(grammar)[0]
        return events.together(one.segment(grammar) for one in self)

    def __getattr__(self, name):
        if name.startswith("_") or not hasattr(Episode, name):
            raise AttributeError(name)
        if len(self) != 1:
            fail(EpisodeError, f"{name} of {len(self)} episodes", "ask one of them: episodes[0], episodes['NAME']")
        return getattr(self[0], name)

    def __repr__(self):
        return f"<prehend.Episodes: {len(self)}, {', '.join(one.name for one in self._episodes[:3])}{', ..' if len(self) > 3 else ''}>"


def program() -> str:
    """Path of the prehend program: $PREHEND_PROGRAM, beside the module, or in PATH."""
    here = pathlib.Path(_prehend.__file__).resolve()
    for path in (os.environ.get("PREHEND_PROGRAM"), here.parents[2] / "prehend", shutil.which("prehend")):
        if path and os.access(path, os.X_OK) and os.path.isfile(path):
            return str(path)
    fail(EpisodeError, "the program 'prehend' was not found, which plays scenarios", "install it, or set PREHEND_PROGRAM")


class _Folder:  # pylint: disable=too-few-public-methods
    """A folder that lives as long as this object."""

    def __init__(self):
        self.path = tempfile.mkdtemp(prefix="prehend_")
        weakref.finalize(self, shutil.rmtree, self.path, ignore_errors=True)


def _play(name):
    """A scenario, played into an episode file."""
    folder = _Folder()
    file = os.path.join(folder.path, "played.episodes")
    done = subprocess.run([program(), "run", name, "--record", file], capture_output=True, text=True, check=False)
    if not os.path.exists(file):
        fail(EpisodeError, f"{name!r} cannot be played:\n{done.stderr.strip()}", file=name)
    warn(done.stderr)
    return [Episode(one, folder) for one in _prehend.open([file], "")]


def open(path: Union[Path, Sequence[Path]], which: Union[str, int] = "") -> Episodes:  # pylint: disable=redefined-builtin
    """Opens episodes of any kind.

    Parameters
    ----------
    path : str, path or list of them
        Episode files (``suite.episodes``), recordings (``take1.jsonl``), globs of such
        (``takes/*.jsonl``), and scenarios by name (``"milk_carton_wrap"``), which the program
        plays first: for these it has to be installed.
    which : str or int
        Of episode files: a number, a scenario ("name", "skill/name") or a glob of these.

    Returns
    -------
    Episodes

    Raises
    ------
    EpisodeError
        What cannot be read, with file, line, column and remedy.

    Examples
    --------
    >>> prehend.open("suite.episodes")["slide/hop_divides_a_slide"].events
    """
    if not isinstance(which, (str, int)) or isinstance(which, bool):
        fail(EpisodeError, f"which: found {which!r}, wanted a number, a scenario or a glob", "which='slide/*'")
    which = str(which)
    paths = [path] if isinstance(path, (str, os.PathLike)) or not hasattr(path, "__iter__") else list(path)
    episodes = []
    for one in paths:
        if not isinstance(one, (str, os.PathLike)):
            fail(EpisodeError, f"found a {type(one).__name__}, wanted a path, a glob or a scenario's name",
                 "arrays and tables: prehend.episode(frames, entities=..)")
        one = os.fspath(one)
        files = [one]
        if glob.has_magic(one) and not os.path.exists(one):
            files = sorted(glob.glob(one, recursive=True))
            if not files:
                fail(EpisodeError, f"no file matches {one!r}", "scenarios are named without wildcards", one)
        for file in files:
            is_file = os.path.exists(file) and not file.endswith((".yaml", ".yml"))
            if not is_file and file.endswith((".jsonl", ".episodes")):
                fail(EpisodeError, f"{file}: no such file", f"it is looked for in {os.getcwd()}", file)
            episodes += [Episode(found) for found in _prehend.open([file], which)] if is_file else _play(file)
    if not episodes:
        fail(EpisodeError, "no path is named", "prehend.open('suite.episodes')")
    return Episodes(episodes)


def episode(frames_: Union[dict, pd.DataFrame], *, entities: dict, t=None, rate_hz: Optional[float] = None,
            grips: Optional[dict] = None, touches: Optional[dict] = None, name: str = "episode",
            grammar: str = "pick_and_place_from_motion", bridge_s: float = 0.1) -> Episode:
    """An episode of arrays or of a table: what a tracker, a robot or another simulator says.

    Parameters
    ----------
    frames_ : dict of arrays, or pandas.DataFrame
        By entity an array (N, 3): x, y, z in metres, or (N, 7): also qw, qx, qy, qz; world axes, z
        up. A row of NaN: not tracked. float64 is not copied. Or a long table with the columns t (s),
        entity, x, y, z, and optionally qw, qx, qy, qz, grip (0 open .. 1 closed) and touches (names
        of what the entity touches, with blanks between them; or a dict, name -> upward part of the
        contact normal on the entity: 1 where it is held from below). What a frame does not mention
        stays where it was.
    entities : dict
        By name a class and the edges of the bounding box in metres, ``("Cup", (0.08, 0.08, 0.1))``;
        ``"Hand"``; or a dict with the keys of docs/recording-format.md, and ``at_m`` for what stands
        where no array says: ``{"class": "Table", "fixed": True, "size_m": (1.2, 0.8, 0.04), "at_m":
        (0, 0, 0.74)}``. Order: that of the events' roles where it matters.
    t, rate_hz : array (N,), float
        Seconds of the frames, increasing; or frames per second. A table has its own.
    grips : dict of arrays (N,)
        By hand, 0 open .. 1 closed; NaN: as before.
    touches : dict of arrays (N,)
        By pair ``("cup", "table")``: True while they touch; or the upward part of the contact normal
        on the first, NaN where they do not touch.
    name, grammar : str
        Its name, and the grammar that segments it unless another one is named.
    bridge_s : float
        For so long what is not tracked is as it was seen last.

    Returns
    -------
    Episode

    Raises
    ------
    FrameError
        Shapes, types, units and times that cannot be meant, with a remedy.
    """
    return Episode(frames.make(frames_, entities=entities, t=t, rate_hz=rate_hz, grips=grips, touches=touches,
                               name=name, grammar=grammar, bridge_s=bridge_s))
