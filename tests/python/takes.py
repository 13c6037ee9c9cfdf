# SPDX-License-Identifier: Apache-2.0
"""What the tests of the Python package look at: a tracker's file, a take by formulas, and the program."""
import csv
import json
import os
import pathlib
import subprocess
import tempfile

import numpy as np
import pandas as pd

import prehend

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENTITIES = {"table": {"class": "Table", "fixed": True, "size_m": (1.2, 0.8, 0.04), "at_m": (0, 0, 0.74)},
            "cup": ("Cup", (0.07, 0.07, 0.2)), "right_hand": "Hand"}


def program(*words, code=0):
    """What the program prints. `code`: its exit code; None: any."""
    done = subprocess.run([prehend.program(), *map(str, words)], capture_output=True, text=True, check=False, cwd=ROOT)
    assert code is None or done.returncode == code, f"{words}: {done.returncode}\n{done.stderr}"
    return done.stdout


def carried(seconds=6.0, rate_hz=60):
    """A hand takes a cup from a table and sets it down 0.3 m away, again and again: (N, 3) arrays by entity."""
    period = 6.0
    t = np.arange(int(round(seconds * rate_hz))) / rate_hz
    there = t // period % 2  # carried there, and back
    s = t % period

    def ramp(begin, end):
        x = np.clip((s - begin) / (end - begin), 0, 1)
        return x * x * (3 - 2 * x)

    side = 0.3 * np.where(there == 0, ramp(2.2, 3.4), 1 - ramp(2.2, 3.4))
    height = 0.15 * (ramp(1.8, 2.3) - ramp(3.3, 3.8))
    cup = np.stack([side, 0 * t, 0.86 + height], axis=1)
    away = 0.4 * (1 - ramp(0.2, 1.2) + ramp(4.4, 5.4))
    hand = cup + np.stack([-0.06 - away, 0 * t, 0.3 * away], axis=1)
    return t, {"cup": cup, "right_hand": hand}


def long_table(t, arrays, columns=("x", "y", "z")):
    """The same as a long table."""
    return pd.concat([pd.DataFrame(array, columns=columns).assign(t=t, entity=name) for name, array in arrays.items()])


def json_lines(episode, frames, ticks, per_second, entities=None, grips=None):
    """A recording, written independently of the package: poses alone, (N, 3) or (N, 7)."""
    file = pathlib.Path(episode)
    members = {"table": {"class": "Table", "fixed": True, "size_m": [1.2, 0.8, 0.04]},
               "cup": {"class": "Cup", "size_m": [0.07, 0.07, 0.2]},
               "right_hand": {"hand": True, "size_m": [0.09, 0.084, 0.025]}} if entities is None else entities
    with file.open("w", encoding="utf-8") as out:
        out.write(json.dumps({"recording": 1, "episode": "take", "grammar": "pick_and_place_from_motion",
                              "ticks_per_second": int(per_second), "entities": members}) + "\n")
        for i, tick in enumerate(ticks):
            samples = {"table": {"at_m": [0, 0, 0.74]}} if i == 0 and "table" in members else {}
            for name, array in frames.items():
                row = array[i].tolist()
                if np.isnan(row[0]):
                    samples[name] = None
                else:
                    samples[name] = {"at_m": row[:3], **({"quat_wxyz": row[3:]} if len(row) == 7 else {})}
            hands = {hand: {"trigger": float(values[i])} for hand, values in (grips or {}).items()}
            out.write(json.dumps({"tick": int(tick), "samples": samples, "hands": hands}) + "\n")
    return file


def printed(*words, code=0):
    """Events as the program prints them in JSON: (event, roles, begin, end, decided), in ticks."""
    told = json.loads(program(*words, "--json", code=code))
    return [as_tuples(one) for one in (told if isinstance(told, list) else [told])]


def as_tuples(told):
    """Of one episode, and its name."""
    said = lambda one: {**one["roles"], **{name: value for name, value in one["attributes"].items() if isinstance(value, str)}}
    return told.get("id", told["scenario"]), sorted(
        (one["event"], tuple(sorted(said(one).items())), one["begin_tick"], one["end_tick"], one["decided_tick"],
         one["open_end"], sorted(value for value in one["attributes"].values() if not isinstance(value, str)))
        for one in told["events"])


def found(events, per_second):
    """The same of a DataFrame."""
    tick = lambda s: round(s * per_second)
    values = list(events.columns[list(events.columns).index("open_end") + 1:])
    return sorted((row["event"], tuple(sorted((role, row[role]) for role in events.roles if row[role])),
                   tick(row["begin_s"]), tick(row["end_s"]), tick(row["decided_s"]), row["open_end"],
                   sorted(row[name] for name in values if not np.isnan(row[name]))) for row in events.to_dict("records"))


class Folder:
    """A folder that is gone after the tests of a class."""

    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls._folder.name)

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()


def tracker():
    """docs/motion_capture/poses.csv as arrays in metres, z up: the arithmetic of its map, without bridging."""
    with open(ROOT / "docs/motion_capture/poses.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    number = lambda row, name: float(row[name]) if row[name] else np.nan
    t = np.array([float(row["time"]) for row in rows])
    arrays = {}
    for name, body in (("cup", "Carton"), ("right_hand", "Glove")):
        x, y, z = (np.array([number(row, f"{body}_{axis}") for row in rows]) / 1000 for axis in "xyz")
        arrays[name] = np.stack([x, -z, y], axis=1)
    arrays["cup"][:, 2] -= 0.13
    return t, arrays


def cpu_seconds():
    """Of this process so far."""
    times = os.times()
    return times.user + times.system
