# SPDX-License-Identifier: Apache-2.0
"""What goes wrong: exceptions with a place and a remedy, and warnings of what is missing or looks wrong."""
import argparse
import io
import math
import numbers
import os
import re
import sys
import warnings


_SHOWN = {code: f"\\u{code:04x}" for code in (*range(9), *range(11, 32), *range(127, 160), 0x061c, 0x200e, 0x200f, *range(0x2028, 0x202f), *range(0x2066, 0x206a))}


class Visible(io.TextIOWrapper):
    """A stream for texts of files and servers: control characters, and those that turn the direction of writing, show as JSON writes them."""

    def write(self, text):
        return super().write(text.translate(_SHOWN))


class Error(ValueError):
    """Wrong input: what was found, what was wanted, and what to do.

    Attributes
    ----------
    file : str
        Where: a grammar, a recording, "frames" for arrays; "" if it is none of these.
    line, column : int
        From 1; 0 means the file as a whole.
    message, remedy : str
        Of the first thing that is wrong. ``str(error)`` has all of them, with the line and a caret.
    diagnostics : list of tuple
        All of them: (file, line, column, message, remedy, text).
    """

    def __init__(self, diagnostics):
        if isinstance(diagnostics, str):
            diagnostics = [("", 0, 0, diagnostics, "", diagnostics)]
        self.diagnostics = list(diagnostics)
        self.file, self.line, self.column, self.message, self.remedy, _ = self.diagnostics[0]
        super().__init__("".join(one[5] for one in self.diagnostics).rstrip("\n"))


class GrammarError(Error):
    """A grammar that does not compile, or a parameter that it does not have."""


class FrameError(Error):
    """Arrays, tables or poses that are no frames: shapes, types, numbers, times."""


class EpisodeError(Error):
    """A file or scenario that cannot be opened, or an event that cannot be asked for."""


class MissingFacts(UserWarning):
    """Rules that ask for what an episode does not have: they never recognise anything."""


class DoubtfulFrames(UserWarning):
    """Poses or sizes that can hardly be meant: another unit, no table, z not up."""


class DoubtfulLabels(UserWarning):
    """Labels that can hardly be meant: they overlap, have no text, or fit once they are moved."""


def named(name):
    """A name from somebody's file that becomes a name of ours: it leaves no folder."""
    if not re.fullmatch(r"[A-Za-z0-9_][\w.-]*", str(name), re.ASCII):
        fail(EpisodeError, f"found the name {str(name)[:60]!r}, wanted letters, digits, '-', '_' and '.'", "ask who made the set")
    return str(name)


def amount(kind, least, most=math.inf):
    """The type of an argument: an int or a float in this range."""
    def read(text):
        try:
            if least <= (value := kind(text)) <= most:
                return value
        except ValueError:
            pass
        wanted = f"from {least:g}" + (f" to {most:g}" if most < math.inf else "")
        raise argparse.ArgumentTypeError(f"found {text!r}, wanted a {'whole ' if kind is int else ''}number {wanted}")
    return read


def cell(value):
    """A cell of CSV that no spreadsheet runs."""
    return re.sub(r"^(?=[=+@\t\r-])(?![+-]?[\d.]+(e[+-]?\d+)?$)", "'", value) if isinstance(value, str) else value


def of(diagnostics):
    """The exception for these diagnostics."""
    kind = EpisodeError
    if diagnostics and diagnostics[0][0] == "frames":
        kind = FrameError
    elif diagnostics and ".grammar" in diagnostics[0][0]:
        kind = GrammarError
    # Options are arguments here, and where there is no place, none is told.
    return kind([(file.removeprefix("--"), line, column, *(re.sub(r"^(--(?=[a-z_]+:)|: error: )", "", text).replace("--episode needs", "which= needs")
                                                           for text in texts)) for file, line, column, *texts in diagnostics])


def fail(kind, message, remedy="", file=""):
    """Raises it."""
    text = f"{message}\n  hint: {remedy}" if remedy else message
    raise kind([(file, 0, 0, message, remedy, text)])


def wrong(message, remedy=""):
    """The same of arrays, tables and poses."""
    fail(FrameError, message, remedy, "frames")


def number(value, what, least=-1e300, most=1e300, wanted="seconds", kind=Error):
    """As a float: a finite number in this range, and no bool, text, Timedelta or NA."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real) or not least <= value <= most:
        remedy = "seconds are .total_seconds() of it" if hasattr(value, "total_seconds") else ""
        fail(kind, f"{what}: found {value!r}, wanted {wanted}", remedy, "frames" if kind is FrameError else "")
    return float(value)


def warn(text, kind=MissingFacts):
    """A Python warning for each of the program's, at the caller's line."""
    frame, depth = sys._getframe(), 1
    while frame.f_back and os.path.dirname(frame.f_code.co_filename) == os.path.dirname(__file__):
        frame, depth = frame.f_back, depth + 1
    for one in re.split(r"\n(?=\S)", text.rstrip("\n")):
        if one:
            warnings.warn(one, kind, stacklevel=depth)
