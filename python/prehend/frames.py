# SPDX-License-Identifier: Apache-2.0
"""From arrays and tables to episodes."""
import json

import numpy as np
import pandas as pd

from . import _prehend
from .errors import DoubtfulFrames, FrameError, fail, number, warn, wrong

_FINE = 10_000  # ticks per second, as `prehend import` has them
_POSE = ["x", "y", "z", "qw", "qx", "qy", "qz"]
FAR_M, FAR = 20, "positions are up to {:g} m apart\n  hint: metres are wanted; divide millimetres by 1000"
_PARTS = (("milliseconds", 1000, "1000"), ("microseconds", 1e6, "1e6"), ("nanoseconds", np.inf, "1e9"))  # below these steps
_HAND_SIZE_M = (0.09, 0.084, 0.025)


def _plain(value):
    """For JSON: NumPy's numbers and arrays as Python's."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{type(value).__name__} is no number, text, list or dict")


def by_name(values, what):
    """A dict, empty if there is none."""
    if values is not None and not isinstance(values, dict):
        wrong(f"{what}: found a {type(values).__name__}, wanted a dict")
    return values or {}


def _faulty(value, place=()):
    """The place of the first value in it that is no plain one, that value, and why; None if all are."""
    try:
        json.dumps(value, default=_plain, allow_nan=False)
        return None
    except (TypeError, ValueError) as error:
        parts = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, (list, tuple, np.ndarray)) else ()
        return next((found for key, part in parts if (found := _faulty(part, (*place, key)))), (place, value, error))


def to_json(value):
    """Numbers that are none are null."""
    try:
        return json.dumps(value, default=_plain, allow_nan=False)
    except (TypeError, ValueError):
        (first, *place), part, error = _faulty(value)
    what = {"samples": "poses", "hands": "grips"}.get(first, first) + "".join(f"[{key!r}]" for key in place if key != "trigger")
    return wrong(f"{what}: found {part!r}, wanted a plain value ({error})", "numbers are finite; None: not tracked")


def _entity(name, spec):
    """An entity as in the first line of a recording, and where it stands if nothing says so."""
    if isinstance(spec, str):
        if spec != "Hand" and spec.lower() == "hand":
            wrong(f"entity '{name}': found {spec!r}, wanted 'Hand'", f"{name!r}: 'Hand'")
        if spec != "Hand":
            wrong(f"entity '{name}' has no size", f"{name!r}: ({spec!r}, (x, y, z)) with the edges of its bounding box in metres, "
                  "or a dict as in docs/recording-format.md")
        spec = (spec, _HAND_SIZE_M)
    if isinstance(spec, (tuple, list)):
        if len(spec) != 2 or not isinstance(spec[0], str) or np.shape(spec[1]) != (3,):
            wrong(f"entity '{name}': found {spec!r}, wanted (class, (x, y, z)) in metres")
        spec = {"class": spec[0], "size_m": [float(edge) for edge in spec[1]]}
    if not isinstance(spec, dict):
        wrong(f"entity '{name}': found a {type(spec).__name__}, wanted a class with a size, or a dict",
              f"{name!r}: ('Cup', (0.08, 0.08, 0.1))")
    spec = dict(spec)
    if spec.get("class") == "Hand":
        del spec["class"]
        spec["hand"] = True
    at_m, quat_wxyz = spec.pop("at_m", None), spec.pop("quat_wxyz", (1, 0, 0, 0))
    return spec, None if at_m is None else np.array([[*at_m, *quat_wxyz]], dtype=float)


def first_line(entities, ticks_per_second, name="episode", grammar="pick_and_place_from_motion", **more):
    """The first line of a recording, and the poses of what stands where it is said to."""
    if not isinstance(entities, dict) or not entities:
        wrong("entities: wanted a dict with at least one of them", "{'cup': ('Cup', (0.08, 0.08, 0.1)), 'right_hand': 'Hand'}")
    members, standing = {}, {}
    for entity, spec in entities.items():
        members[entity], at = _entity(entity, spec)
        if at is not None:
            standing[entity] = at
    line = {"recording": 1, "episode": name, "grammar": grammar, "ticks_per_second": int(ticks_per_second),
            "entities": members, **more}
    return to_json(line), standing


def _number_array(values, what, columns=None):
    """As float64; without a copy if it is one. What is masked is NaN; columns that have names are found by these."""
    if isinstance(values, pd.DataFrame) and any(isinstance(name, str) for name in values.columns):
        names = _POSE if len(values.columns) == 7 else _POSE[:3]
        if set(values.columns) != set(names):
            wrong(f"{what}: found the columns {', '.join(map(str, values.columns))}, wanted x, y, z, or these and qw, qx, qy, qz",
                  "to_numpy(), if they are in this order")
        values = values[names]
    array = np.asarray(values)
    if np.ma.is_masked(values) and array.dtype.kind in "fiu":
        array = values.astype(np.float64).filled(np.nan)
    if array.dtype.kind not in "fiu":
        wrong(f"{what}: found an array of {array.dtype}, wanted numbers",
              "array.astype(float)" if array.dtype.kind in "bOUS" else "")
    if columns is None and array.ndim != 1 or columns and (array.ndim != 2 or array.shape[1] not in columns):
        wanted = "(N,)" if columns is None else " or ".join(f"(N, {count})" for count in columns)
        wrong(f"{what}: found the shape {array.shape}, wanted {wanted}",
              "" if columns is None else "x, y, z in metres, then qw, qx, qy, qz; one row per frame")
    return array.astype(np.float64, copy=False)


def _times(t, rate_hz, frames):
    """Ticks, and how many there are in a second: frames at a regular rate lie on whole ticks."""
    if (t is None) == (rate_hz is None):
        wrong("wanted either t or rate_hz", "t=seconds of each frame, or rate_hz=frames per second")
    if rate_hz is not None:
        t = np.arange(frames) / number(rate_hz, "rate_hz", 0.1, _FINE, f"frames per second, 0.1 to {_FINE}", FrameError)
    t = _number_array(t, "t")
    if len(t) != frames:
        wrong(f"t has {len(t)} times, and there are {frames} frames", "one time per frame")
    if frames == 0:
        wrong("there are no frames")
    if not np.isfinite(t).all():
        wrong(f"t[{np.flatnonzero(~np.isfinite(t))[0]}] is no number", "every frame has a time")
    steps = np.diff(t)
    if frames > 1 and steps.min() <= 0:
        row = int(np.argmin(steps > 0)) + 1
        wrong(f"t[{row}] = {t[row]:g} is not after {t[row - 1]:g}", "sort the frames by time; one frame per time")
    usual = float(np.median(steps)) if frames > 1 else 1.0
    if rate_hz is None and frames > 9 and (np.round(steps) == steps).all() and np.mean(steps == 1) > 0.9:
        wrong("t are whole numbers that grow by 1 each: they look like frame numbers", "seconds: t / frames_per_second; or rate_hz")
    if rate_hz is None and usual > 2:
        unit, _, parts = next(one for one in _PARTS if usual < one[1])
        wrong(f"frames are {usual:g} s apart", f"t is in seconds; divide {unit} by {parts}")
    if abs(t[0]) > 1e6:
        wrong(f"t begins at {t[0]:g} s", "count from the beginning: t - t[0]")
    per_second = _FINE
    rate = round(1 / usual)
    if 1 <= rate <= _FINE and np.abs(t * rate - np.round(t * rate)).max() < 0.01:
        per_second = rate * max(1, round(_FINE / rate))
        return np.round(t * rate).astype(np.int64) * (per_second // rate), per_second
    ticks = np.round(t * per_second).astype(np.int64)
    if frames > 1 and np.diff(ticks).min() <= 0:
        wrong(f"frames are less than {1 / per_second} s apart", "are the times seconds?")
    return ticks, per_second


def _of_table(table):
    """A long table as arrays by entity: (t, {entity: (poses, mentioned)}, grips, touches)."""
    missing = [name for name in ("t", "entity", "x", "y", "z") if name not in table.columns]
    if missing:
        wrong(f"the table has no column {missing[0]!r}",
              "one row per frame and entity: t, entity, x, y, z, and optionally qw, qx, qy, qz, grip, touches")
    turned = [name for name in _POSE[3:] if name in table.columns]
    if turned and len(turned) != 4:
        wrong(f"the table has {turned}, wanted all of qw, qx, qy, qz")
    columns = _POSE[:3] + turned
    if (lacking := np.flatnonzero(~np.isfinite(_number_array(table["t"].to_numpy(), "column 't'")))).size:
        wrong(f"row {lacking[0]}: t is no number", "each row has a time")
    t, row = np.unique(_number_array(table["t"].to_numpy(), "column 't'"), return_inverse=True)
    codes, names = pd.factorize(table["entity"], sort=False)
    if (codes < 0).any():
        wrong(f"row {int(np.argmax(codes < 0))}: no entity", "each row names one")
    frames, values = len(t), np.column_stack([_number_array(table[name].to_numpy(), f"column {name!r}") for name in columns])
    poses, grips, touches = {}, {}, {}
    grip = _number_array(table["grip"].to_numpy(), "column 'grip'") if "grip" in table.columns else None
    for code, name in enumerate(names):
        own = codes == code
        if len(np.unique(row[own])) != own.sum():
            wrong(f"'{name}' has two rows at the same time", "one row per frame and entity")
        array, mentioned = np.full((frames, len(columns)), np.nan), np.zeros(frames, dtype=bool)
        array[row[own]], mentioned[row[own]] = values[own], True
        poses[name] = (array, np.zeros(0, dtype=bool) if mentioned.all() else mentioned)
        if grip is not None and not np.isnan(grip[own]).all():
            grips[name] = np.full(frames, np.nan)
            grips[name][row[own]] = grip[own]
    if "touches" in table.columns:
        for at, name, cell in zip(row, table["entity"], table["touches"]):
            if cell is None or isinstance(cell, float):
                continue
            cell = cell.split() if isinstance(cell, str) else cell
            if not isinstance(cell, (dict, list, tuple, set, np.ndarray)):
                wrong(f"column 'touches': found {cell!r} in a row of '{name}', wanted the entities that it touches", "'cup table', or ['cup', 'table']")
            for other in cell:
                if (other, name) in touches and not np.isnan(touches[other, name][at]):
                    continue  # the row of the other one says so, too
                up = cell[other] if isinstance(cell, dict) else 0.0
                touches.setdefault((name, other), np.full(frames, np.nan))[at] = up
    return t, poses, grips, touches


def doubts(entities, poses):
    """What can hardly be meant of positions by entity, arrays (N, 3 or more) in metres: a line for each."""
    sizes = {one: _entity(one, spec)[0] for one, spec in entities.items()}
    is_hand = {one: bool(spec.get("hand")) for one, spec in sizes.items()}
    told = [f"'{one}' is {max(spec['size_m']):g} m long\n  hint: sizes are the edges of the bounding box in metres"
            for one, spec in sizes.items()
            if not spec.get("fixed") and "size_m" in spec and max(spec["size_m"]) > 3]
    seen = {one: at[~np.isnan(at[:, :3]).any(axis=1), :3] for one, at in poses.items()}
    seen = {one: at for one, at in seen.items() if len(at)}
    if seen and (span := np.ptp(np.concatenate(list(seen.values())), axis=0).max()) > FAR_M:
        told.append(FAR.format(span))
    turns = {one: at[~np.isnan(at[:, 3]), 3:] for one, at in poses.items() if at.shape[1] == 7 and not sizes[one].get("fixed")}
    # A thing that stands has w near 1; hands point anywhere.
    turns = [at for one, at in turns.items() if not is_hand[one] and len(at)] or [at for at in turns.values() if len(at)]
    w, _, _, last = np.median(np.abs(np.concatenate(turns)), axis=0) if turns else (1, 0, 0, 0)
    if w <= 0.5 and last >= 0.85:
        told.append(f"the first of four numbers, as w, is {w:.2f} (median, without its sign), the last is {last:.2f}: this looks "
                    "like (x, y, z, w)\n  hint: quaternions are (w, x, y, z): array[:, [0, 1, 2, 6, 3, 4, 5]]")
    for one, at in seen.items():
        if sizes[one].get("fixed") and (way := np.ptp(np.quantile(at, (0.025, 0.975), axis=0), axis=0).max()) > 0.03:
            told.append(f"'{one}' is said to be fixed, and moves by {way:.2f} m\n  hint: fixed is only what never moves")
    if told:
        return "\n".join(told)
    hands = np.array([at[0] for one, at in seen.items() if is_hand[one]]).reshape(-1, 3)
    solid = [one for one in seen if "size_m" in sizes[one] and not is_hand[one]]
    places = np.array([seen[one][0] for one in solid]).reshape(-1, 3)
    edges = np.array([sizes[one]["size_m"] for one in solid], dtype=float).reshape(-1, 3)
    tops, half_ways = places[:, 2] + edges[:, 2] / 2, np.hypot(edges[:, 0], edges[:, 1]) / 2
    for place, one in enumerate(solid):
        if sizes[one].get("fixed") or (np.linalg.norm(hands - places[place], axis=1) < 0.2).any():
            continue  # held, perhaps
        low = places[place][2] - edges[place][2] / 2
        near = np.abs(tops - low) < 0.1
        near[place] = False
        if not (near & (np.abs(places - places[place])[:, :2] < half_ways[:, None]).all(axis=1)).any():
            told.append(f"nothing is below '{one}' at the begin, whose lowest point is {low:.3g} m high\n  hint: name what it "
                        "stands on ({'class': 'Table', 'fixed': True, 'size_m': .., 'at_m': ..}); z is up, in metres")
    return "\n".join(told)


def make(frames, *, entities, t=None, rate_hz=None, grips=None, touches=None, name="episode",
         grammar="pick_and_place_from_motion", bridge_s=0.1):
    """See `prehend.episode`."""
    grips, given = by_name(grips, "grips"), by_name(touches, "touches")
    if isinstance(frames, pd.DataFrame):
        if t is not None or rate_hz is not None:
            wrong("a table has its times in the column 't'", "leave t and rate_hz away")
        t, poses, table_grips, table_touches = _of_table(frames)
        grips, touches = {**table_grips, **grips}, {**table_touches, **given}
        count = len(t)
    elif isinstance(frames, dict):
        nothing = np.zeros(0, dtype=bool)
        poses = {one: (_number_array(array, f"'{one}'", (3, 7)), nothing) for one, array in frames.items()}
        lengths = {one: len(array) for one, (array, _) in poses.items()}
        if len(set(lengths.values())) > 1:
            wrong(f"arrays of different lengths: {lengths}", "one row per frame in each; NaN: not tracked")
        count = next(iter(lengths.values()), 0)
    else:
        wrong(f"frames: found a {type(frames).__name__}, wanted a DataFrame or a dict of arrays by entity",
              "{'cup': array of shape (N, 7), ..}")
    ticks, per_second = _times(t, rate_hz, count)
    line, standing = first_line(entities, per_second, name, grammar, bridge_s=bridge_s)
    names = list(entities)
    for entity in poses:
        if entity not in entities:
            wrong(f"entities: '{entity}' is missing, of which there are poses", f"known: {', '.join(names)}")
    for entity, at in standing.items():
        if entity not in poses:  # mentioned once, and then it stays
            poses[entity] = (np.repeat(at, count, axis=0), np.arange(count) == 0)
    warn(doubts(entities, {one: array for one, (array, _) in poses.items()}), DoubtfulFrames)
    columns = [(names.index(one), array, mentioned) for one, (array, mentioned) in poses.items()]
    held = []
    for hand, values in grips.items():
        if hand not in entities:
            wrong(f"grips: no entity is called '{hand}'", f"known: {', '.join(names)}")
        held.append((names.index(hand), _number_array(values, f"grips of '{hand}'")))
        if len(held[-1][1]) != count:
            wrong(f"grips of '{hand}': {len(held[-1][1])} values for {count} frames", "one per frame")
    rows, ups = [np.zeros((0, 3), dtype=np.int64)], [np.zeros(0)]
    for pair, values in (touches or {}).items():
        if not isinstance(pair, tuple) or len(pair) != 2 or any(one not in entities for one in pair):
            wrong(f"touches: found {pair!r}, wanted a pair of entities", f"known: {', '.join(names)}")
        kind = np.asarray(values).dtype
        up = (np.where(np.ma.filled(values, False), 0.0, np.nan) if kind == bool
              else _number_array(values, f"touches of {pair}"))
        if pair in given and kind != bool and (kind.kind in "iu" or np.isin(up, (0, 1)).all() and 0 in up):
            wrong(f"touches of {pair}: found {kind} of whole numbers: whether they touch, or the normal's upward part?",
                  "array.astype(bool); or floats, NaN where they do not touch")
        if up.shape != (count,):
            wrong(f"touches of {pair}: found the shape {up.shape} for {count} frames", "one value per frame")
        at = np.flatnonzero(~np.isnan(up))
        rows.append(np.column_stack([at, np.full((len(at), 2), [names.index(one) for one in pair])]))
        ups.append(up[at])
    rows, ups = np.concatenate(rows), np.concatenate(ups)
    order = np.argsort(rows[:, 0], kind="stable")
    return _prehend.episode_of(line, ticks, columns, held, rows[order], ups[order], int(ticks[-1]) + 1)
