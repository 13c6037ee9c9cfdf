# SPDX-License-Identifier: Apache-2.0
"""Files of arrays and trees, made by plain Python: JSON by paths, arrays of NumPy. The same cup and hand, in each way in
which programs write them, become the same recording; what is wrong with a file or a map is said as it is; damaged
files are refused, and never more.

    import_arrays.py PREHEND
"""
import io
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import warnings
import zipfile

import numpy as np

prehend = sys.argv[1]
folder = pathlib.Path(tempfile.mkdtemp())
RATE, FRAMES, TURN = 60, 301, math.radians(30)
TABLE = "  table: {at_m: [0, 0, 0.7], fixed: true, class: Table, size_m: [2.0, 1.0, 0.04]}\n"
CUP, HAND = "class: Cup, size_m: [0.08, 0.08, 0.1]", "hand: true, size_m: [0, 0, 0]"


def along(t, *points):
    return float(np.interp(t, [p[0] for p in points], [p[1] for p in points]))


def cup_at(t):
    return [along(t, (2, 0), (3, 0.4)), 0.0, 0.77 + along(t, (1.3, 0), (2, 0.215), (3, 0.215), (3.5, 0))]


def hand_at(t):
    x, _, z = cup_at(t)
    away = along(t, (0.2, 0.4), (1, 0), (3.7, 0), (4.3, 0.4))
    return [x - 0.08 - away, 0.0, z + away / 2]


TIMES = [i / RATE for i in range(FRAMES)]
CUPS, HANDS = np.array([cup_at(t) for t in TIMES]), np.array([hand_at(t) for t in TIMES])
XYZW = [0, 0, math.sin(TURN / 2), math.cos(TURN / 2)]  # of the cup, all the time
MATRIX = [[math.cos(TURN), -math.sin(TURN), 0], [math.sin(TURN), math.cos(TURN), 0], [0, 0, 1]]


def run(*words):
    return subprocess.run([prehend, *map(str, words)], capture_output=True, text=True, check=False)


def import_file(name, content, map_text):
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    (folder / "map.yaml").write_text("import: 1\nepisode: take\n" + map_text)
    return run("import", folder / name, "--map", folder / "map.yaml", "-o", folder / "take.jsonl")


def recording():
    lines = [json.loads(line) for line in (folder / "take.jsonl").read_text().splitlines()]
    return [line for line in lines if "samples" in line]


def expect_carried(name, content, map_text, turned=True, table=True):
    """Poses within 1e-6 m, the events of such a take."""
    said = import_file(name, content, map_text)
    assert said.returncode == 0, (name, map_text, said.stderr)
    at = {}
    frames = recording()
    assert len(frames) == FRAMES, len(frames)
    for i, frame in enumerate(frames):
        at.update(frame["samples"])
        for body, true in (("cup", CUPS[i]), ("hand", HANDS[i])):
            off = np.abs(np.array(at[body]["at_m"]) - true).max()
            assert off < 2e-6, (name, body, i, off, map_text)
        if turned:
            w, x, y, z = at["cup"].get("quat_wxyz", [1, 0, 0, 0])
            assert abs(abs(w * XYZW[3] + z * XYZW[2]) - 1) < 1e-6 and abs(x) + abs(y) < 1e-6, (name, at["cup"])
    events = run("episode", "resegment", folder / "take.jsonl").stdout
    assert "transporting" in events and ("putting_down" in events or not table), events
    return said


def expect_refused(name, content, map_text, *why):
    said = import_file(name, content, map_text)
    assert said.returncode == 2, (name, said.returncode, said.stderr)
    for part in why:
        assert part in said.stderr, (part, said.stderr)


def xyz(v, scale=1.0):
    return {"x": v[0] * scale, "y": v[1] * scale, "z": v[2] * scale}


def documented(part):
    """The map of docs/motion-capture.md that has this text."""
    page = (pathlib.Path(__file__).parents[2] / "docs" / "motion-capture.md").read_text(encoding="utf-8")
    begin = page.rindex("```yaml\n", 0, page.index(part)) + len("```yaml\n")
    return page[begin:page.index("```", begin)].replace("import: 1\n", "")


def check_documented_json():
    """Left-handed, y up, millimetres: x is the other way round, and so are turns about y."""
    def point(v):
        return [-1000 * v[0], 1000 * v[2], -1000 * v[1]]
    frames = [{"timestamp": round(t * 1e6), "objects": [{"name": "Cup", "pos": point(CUPS[i]), "rot": [0, -XYZW[2], 0, XYZW[3]]}],
               "hands": [{"type": "right", "palm": {"position": point(HANDS[i])}, "pinch": 0.25}]} for i, t in enumerate(TIMES)]
    map_text = documented("objects[name=Cup].pos")
    expect_carried("leap.json", json.dumps({"frames": frames}), map_text, table=False)
    triggers = [f["hands"]["hand"]["trigger"] for f in recording() if "hands" in f]
    assert abs(triggers[0] - 0.25) < 1e-9, triggers[:3]


def check_json():
    base = "unit: m\naxes: z_up\n"
    # As HoloLens, Quest and Leap log: a list of frames, hands in no fixed order, objects for vectors.
    leap = {"version": 2, "noise": [[1, [2]], {"frames": [3]}], "frames": [
        {"timestamp": 1_000_000 + round(t * 1e6), "tracked": True,
         "hands": ([{"type": "left", "palm": {"position": [9, 9, 9]}}] if i % 3 else []) +
                  [{"type": "right", "palm": {"position": [1000 * v for v in HANDS[i]]}, "pinch": 0.5}],
         "objects": {"my cup": {"p": xyz(CUPS[i], 1000), "q": dict(zip("xyzw", XYZW))}}}
        for i, t in enumerate(TIMES)]}
    leap_map = ("unit: mm\naxes: z_up\nframes: \"$.frames[*]\"\nt: timestamp\ntime_unit: us\nentities:\n" + TABLE +
                f"  cup: {{position: \"objects['my cup'].p\", rotation: \"$.objects['my cup'].q\", {CUP}}}\n"
                f"  hand: {{position: \"hands[type=right].palm.position\", {HAND}}}\n")
    for indent in (None, 1):
        expect_carried("leap.json", json.dumps(leap, indent=indent), leap_map)
    expect_carried("leap.json", json.dumps(leap), leap_map.replace("[type=right]", "[?(@.type == 'right')]"))
    # A list at the top, matrices of 3 x 3 and 4 x 4, in rows and in columns.
    pose = [[[*MATRIX[r], CUPS[i][r]] for r in range(3)] + [[0, 0, 0, 1]] for i in range(FRAMES)]
    for keys, cup in (
            ("position: c, rotation: r", lambda i: {"c": list(CUPS[i]), "r": MATRIX}),
            ("pose: m", lambda i: {"m": pose[i]}),
            ("pose: m", lambda i: {"m": np.array(pose[i]).T.ravel().tolist()}),
            ("pose: m", lambda i: {"m": {f"e{r}{c}": pose[i][r][c] for c in range(4) for r in range(4)}})):
        frames = [{"t": t, "hand": list(HANDS[i]), **cup(i)} for i, t in enumerate(TIMES)]
        expect_carried("list.json", json.dumps(frames), base + "t: t\ntime_unit: s\nentities:\n" + TABLE +
                       f"  cup: {{{keys}, {CUP}}}\n  hand: {{position: hand, {HAND}}}\n")
    # Lines; flat members, vectors as text, angles, ISO times; left-handed and y up, as Unity has them.
    lines = [json.dumps({"time": f"2026-01-31T10:00:{t:09.6f}Z", "x": -CUPS[i][0], "y": CUPS[i][2], "z": CUPS[i][1],
                         "euler": {"x": 0, "y": -30, "z": 0}, "hand": f"({-HANDS[i][0]}, {HANDS[i][2]}, 0.0)"})
             for i, t in enumerate(TIMES)]
    unity = ("unit: m\naxes: y_up\nhanded: left\nt: time\ntime_unit: iso\neuler_order: YXZ\nangle_unit: deg\nentities:\n" +
             TABLE + f"  cup: {{position: \"{{x,y,z}}\", rotation: euler, {CUP}}}\n  hand: {{position: hand, {HAND}}}\n")
    for name in ("unity.jsonl", "unity.ndjson", "unity.json"):
        said = expect_carried(name, "\n".join(lines) + "\n", unity)
        assert "quaternion_order" not in said.stderr, said.stderr
    said = expect_carried("unity.jsonl", "\n".join(lines) + "\n", "quaternion_order: xyzw\n" + unity)
    assert "'quaternion_order' of the map says nothing here: no orientation is four numbers in a row" in said.stderr, said.stderr
    said = expect_carried("unity.jsonl", "\n".join(['{"program": "log 2", "unit": "m"}'] + lines), unity)
    assert "1 of 302 frames have no time, or nothing that the map asks for" in said.stderr, said.stderr
    untimed = [json.dumps(json.loads(lines[100]) | more) for more in ({"time": None}, {})]
    untimed[1] = untimed[1].replace('"time"', '"when"')
    said = expect_carried("unity.jsonl", "\n".join(lines[:100] + untimed + lines[100:]), unity)
    assert "2 of 303 frames have no time, or nothing that the map asks for" in said.stderr, said.stderr
    expect_refused("unity.jsonl", "\n".join(line.replace('"time"', '"when"') for line in lines), unity, "no frame has 'time'", "there is no 'time'")
    # A file of one line is of lines, by its name.
    expect_refused("unity.jsonl", lines[0] + "\n", unity, "'{x,y,z}' has 1 poses in the file")
    expect_refused("unity.json", lines[0] + "\n", unity, "the file is one object")
    # One body a line, one object of columns, a gripper.
    rows = [{"n": n, "t": t, "p": list(at[i])} for i, t in enumerate(TIMES) for n, at in (("cup", CUPS), ("hand", HANDS))]
    by_rows = (base + "t: t\ntime_unit: s\nentities:\n" + TABLE + f"  cup: {{position: \"[n=cup].p\", {CUP}}}\n"
               f"  hand: {{position: \"$[n=hand].p\", {HAND}}}\n")
    text = "\n".join(map(json.dumps, rows))
    assert import_file("rows.jsonl", text, by_rows).returncode == 0
    assert len(recording()) == FRAMES
    columns = {"t": TIMES, "cup": {"p": CUPS.tolist(), "q": [XYZW] * FRAMES}, "hand": HANDS.tolist(),
               "grip": [0.04 if 1 < t < 3.5 else 0.08 for t in TIMES]}
    columns_map = (base + "quaternion_order: xyzw\nt: t\ntime_unit: s\nentities:\n" + TABLE +
                   f"  cup: {{position: cup.p, quaternion: cup.q, {CUP}}}\n"
                   f"  hand: {{position: hand, {HAND}, grip: {{from: grip, open: 0.08, closed: 0}}}}\n")
    expect_carried("columns.json", json.dumps(columns), columns_map)
    assert abs(recording()[100]["hands"]["hand"]["trigger"] - 0.5) < 1e-9
    # Not tracked: null, or not there.
    lost = json.loads(json.dumps(leap))
    lost["frames"][50]["hands"] = []
    lost["frames"][51]["hands"] = None
    lost["frames"][52]["hands"][-1]["palm"]["position"] = None
    said = import_file("leap.json", json.dumps(lost), leap_map)
    assert said.returncode == 0 and " 298 " in said.stdout, (said.stdout, said.stderr)

    # Wrong paths and wrong files.
    text = json.dumps(leap)
    for wrong, right, *why in (
            ("$.frame[*]", "$.frames[*]", "nothing is at '$.frame[*]'", "did you mean 'frames'?"),
            ("t: timestmp", "t: timestamp", "there is no 'timestmp'", "did you mean 'timestamp'?"),
            ("[type=rihgt]", "[type=right]", "there is no 'rihgt'", "did you mean 'right'?"),
            ("palm.positon", "palm.position", "there is no 'positon'", "did you mean 'position'?"),
            ("hands[7].palm", "hands[type=right].palm", "there is no '7'"),
            ("hands[*].palm", "hands[type=right].palm", "is no path into a frame"),
            ("hands[.palm", "hands[type=right].palm", "is no path into a frame"),
            ("hands[type=right].palm", "hands[type=right].palm.position", "expected numbers", "frame 0"),
            ("hands[type=right].pinch", "hands[type=right].palm.position", "expected 3 numbers in a row"),
            ("rotation: \"objects['my cup'].p", "rotation: \"$.objects['my cup'].q", "'objects['my cup'].p' is named twice", "each key has a dataset"),
            ("unit: mm\nlost: 1", "unit: mm", "map.yaml:4"),
            ("", "frames: \"$.frames[*]\"\n", "is one object", "frames[*]"),
            ("", "time_unit: us\n", "time_unit is missing"),
            ("", "t: timestamp\ntime_unit: us\n", "neither t nor rate_hz")):
        expect_refused("leap.json", text, leap_map.replace(right, wrong), *why)
    expect_refused("leap.json", text[:-40], leap_map, "cut off")
    (folder / "leap.json").write_text(text)
    expect_refused("leap.json", text.replace('"x":', '"x" ', 1), leap_map, "leap.json:1:", "no JSON")
    expect_refused("leap.json", "[]", leap_map.replace("frames: \"$.frames[*]\"\n", ""), "no frame")
    expect_refused("leap.json", "[" * 200_000, leap_map, "nested deeper than 100")
    expect_refused("leap.json", '{"frames":' + "[" * 200_000, leap_map, "nested deeper than 100")
    expect_refused("unity.json", "\n".join(lines[:70] + ["{\"time\": 3"] + lines[70:]), unity, "unity.json:71:")
    expect_refused("unity.json", "\n".join(lines).replace("-30", "NaN", 1), unity, "unity.json:1:", "null")
    expect_refused("unity.json", "\n".join(lines[:70] + lines[60:]), unity, "goes back", "(line 71)")
    expect_refused("columns.json", json.dumps(columns), columns_map.replace("quaternion_order: xyzw\n", ""),
                   "quaternion_order is missing")
    columns["hand"].pop()
    expect_refused("columns.json", json.dumps(columns), columns_map, "'hand' has 900 numbers, for 301 times")
    return [("leap.json", text, leap_map), ("unity.jsonl", "\n".join(lines), unity), ("rows.jsonl", "\n".join(map(json.dumps, rows)), by_rows)]


def npz(compressed=False, **arrays):
    out = io.BytesIO()
    (np.savez_compressed if compressed else np.savez)(out, **arrays)
    return out.getvalue()


def with_second(content, name, array, shape=None):
    """With one more array, whose header may say another shape."""
    one, out = io.BytesIO(), io.BytesIO(content)
    np.save(one, array)
    with zipfile.ZipFile(out, "a") as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that there is one of this name
        was = b"(%d, %d), " % array.shape
        file.writestr(name, one.getvalue().replace(was, shape or was, 1))
    return out.getvalue()


def check_npz():
    base = "unit: m\naxes: z_up\nquaternion_order: xyzw\n"
    arrays = {"t": np.array(TIMES), "cup": np.hstack([CUPS, np.tile(XYZW, (FRAMES, 1))]), "hand": HANDS}
    one = (base + "t: t\ntime_unit: s\nentities:\n" + TABLE + f"  cup: {{pose: cup, {CUP}}}\n"
           f"  hand: {{position: hand, {HAND}}}\n")
    for packed in (False, True):
        expect_carried("a.npz", npz(packed, **arrays), one)
        expect_carried("a.npz", npz(packed, **{k: v.astype(">f8") for k, v in arrays.items()}), one)
    ticks = {**arrays, "t": np.arange(FRAMES, dtype=np.int32)}
    expect_carried("a.npz", npz(**ticks), one.replace("time_unit: s", "time_unit: frame\nrate_hz: 60"))
    several = {"all": np.stack([CUPS, HANDS], axis=1)}
    expect_carried("a.npz", npz(**several), base + "rate_hz: 60\nentities:\n" + TABLE +
                   f"  cup: {{position: \"all[0:3]\", {CUP}}}\n  hand: {{position: \"all[3:6]\", {HAND}}}\n", turned=False)
    # What an export writes comes back, with the map beside it.
    events = [line.split() for line in run("episode", "resegment", folder / "take.jsonl").stdout.splitlines()]
    said = run("episode", "export", folder / "take.jsonl", "--to", "npz", "-o", folder / "b.npz")
    assert said.returncode == 0, said.stderr
    said = run("import", folder / "b.npz", "--map", folder / "b.npz.map.yaml", "-o", folder / "take.jsonl")
    assert said.returncode == 0, said.stderr
    again = [line.split() for line in run("episode", "resegment", folder / "take.jsonl").stdout.splitlines()]
    assert [e[0] for e in events] == [e[0] for e in again] and len(events) > 8, (events, again)
    whole = npz(**arrays)
    for content, map_text, *why in (
            (whole, one.replace("pose: cup", "pose: cub"), "no array is called 'cub'", "did you mean 'cup'?"),
            (whole, one.replace("pose: cup", "position: cup"), "expected 3 numbers in a row", "cup[0:3]"),
            (whole, one.replace("position: hand", "position: \"hand[1:9]\""), "has nothing there"),
            (npz(**{**arrays, "hand": HANDS[:-1]}), one, "has 300 rows, but 't' has 301"),
            (npz(**{**arrays, "hand": np.asfortranarray(HANDS)}), one, "ascontiguousarray"),
            (npz(**{**arrays, "hand": HANDS.astype(str)}), one, "are of the type", "numbers are read"),
            (npz(**{**arrays, "hand": np.where(np.arange(FRAMES)[:, None] == 7, np.nan, HANDS)}), one, "in row 7", "missing: [nan]"),
            (whole[:1000], one, "is cut off"), (b"PK\3\4" + whole[4:].replace(b"PK\1\2", b"PK\1\3", 1), one, "at byte"),
            (with_second(whole, "hand.npy", HANDS[::-1]), one, "at byte", "a second array is called 'hand'"),
            (with_second(npz(t=arrays["t"], cup=arrays["cup"]), "hand.npy", HANDS, b"(-301, 3), "), one, "its shape is (-301, 3)"),
            (whole.replace(b"NUMPY", b"NUMPX", 1), one, "checksum"), (b"", one, "is no .npz file"), (b"PK\5\6", one, "")):
        expect_refused("a.npz", content, map_text, *why)
    # Each array has fewer than the map may ask for, all together have more.
    many, of = np.zeros((2_000_000, 3)), base + "rate_hz: 60\nentities:\n" + TABLE
    bodies = [f"  {k}: {{position: %s, class: Thing, size_m: [0.1, 0.1, 0.1]}}\n" for k in "abc"]
    expect_refused("a.npz", npz(True, a=many, b=many, c=many), of + "".join(b % k for b, k in zip(bodies, "abc")),
                   "'c', at byte", "more than 16000000 numbers, with the arrays before it")
    expect_refused("a.npz", npz(True, a=np.zeros((2_000_000, 7))), of + "".join(b % f'"a[{k}:{k + 3}]"' for k, b in enumerate(bodies)),
                   "'a[2:5]' is too much: the map asks for more than 16000000 numbers")
    return [("a.npz", whole, one), ("a.npz", npz(True, **arrays), one)]


def check_proposed():
    """A first map of JSON and arrays: once sizes and hands are filled in, it says what a person's says."""
    def proposed(name, content, *wanted):
        data = content.encode() if isinstance(content, str) else content
        (folder / name).write_bytes(data)
        said = run("import", folder / name, "--propose")
        assert said.returncode == 0, said.stderr
        for text in wanted:
            assert text in said.stdout, (text, said.stdout)
        lines = said.stdout.split("\n")
        sizes = [line.replace("size_m: unknown", "size_m: [0, 0, 0]" if "hand: true" in line else "size_m: [0.08, 0.08, 0.1]")
                 for line in lines if not line.startswith(("import:", "  table:"))]
        text = "\n".join(sizes).replace("entities:\n", "entities:\n" + TABLE)
        return import_file(name, data, text), said.stdout

    leap = {"device": {"id": 3}, "frames": [
        {"timestamp": 1_000_000 + round(t * 1e6), "id": i,
         "hands": [{"type": "right", "palm": {"position": [1000 * v for v in HANDS[i]], "normal": [0, 0, -1], "velocity": [0, 0, 0]},
                    "digits": [{"bones": [{"tip": [1, 2, 3]}]}], "pinch": 0.5}] if i > 3 else [],
         "objects": [{"name": "Cup", "pos": [1000 * v for v in CUPS[i]], "rot": XYZW}]} for i, t in enumerate(TIMES)]}
    said, text = proposed("leap.json", json.dumps(leap), 'frames: "$.frames[*]"', 't: "timestamp"', "time_unit: us", "quaternion_order: xyzw",
                       'cup: {position: "objects[name=Cup].pos", rotation: "objects[name=Cup].rot", class: Cup',
                       'right_hand: {position: "hands[type=right].palm.position", hand: true', "unit: mm")
    assert said.returncode == 0 and "right_hand " in said.stdout, said.stderr
    # Only vectors that are texts look like those of Unity, whose axes are left-handed.
    assert "handed" not in text, text
    for vector, wanted in ((lambda p: "(%f, %f, %f)" % tuple(p), True), (list, False)):
        _, text = proposed("vectors.json", json.dumps([{"t": t, "cup": vector(CUPS[i]), "hand": vector(HANDS[i])} for i, t in enumerate(TIMES)]))
        assert ("# doubt: vectors are texts, as Unity writes them: its axes are left-handed, handed: left\n" in text) == wanted, text
    rows = "\n".join(json.dumps({"name": n, "t": t, "px": at[i][0], "py": at[i][1], "pz": at[i][2]})
                     for i, t in enumerate(TIMES) for n, at in (("cup", CUPS), ("lhand", HANDS)))
    said, text = proposed("rows.jsonl", rows, 'cup: {position: "[name=cup].p{x,y,z}"', 'left_hand: {position: "[name=lhand].p{x,y,z}", hand: true',
                          "time_unit: s")
    assert said.returncode == 0 and "frames:" not in text, said.stderr
    # Angles are no place of something else, and a name ends before "pos".
    angles = "\n".join(json.dumps({"name": n, "t": t, **{"pos_" + a: at[i][k] for k, a in enumerate("xyz")}, "rpy": [0, 0, 90]})
                       for i, t in enumerate(TIMES) for n, at in (("cup", CUPS), ("hand", HANDS)))
    said, text = proposed("angles.ndjson", angles, '  cup: {position: "[name=cup].pos_{x,y,z}", class: Cup,', '  hand: {position: "[name=hand].pos_{x,y,z}", hand: true',
                          "unit: m ", "# also in the file: [name=cup].rpy, [name=hand].rpy\n")
    assert said.returncode == 0 and "_rpy" not in text and "is a hand by its name" not in text, (said.stderr, text)
    quest = "\n".join(json.dumps({"time": f"2026-01-31T10:00:{t:09.6f}Z", "LeftHand": {"pos": xyz(HANDS[i]), "rot": dict(zip("xyzw", XYZW))},
                                  "Cup": {"transform": np.vstack([np.c_[MATRIX, CUPS[i]], [0, 0, 0, 1]]).tolist()}}) for i, t in enumerate(TIMES))
    said, text = proposed("quest.jsonl", quest, 'cup: {pose: "Cup.transform"', 'left_hand: {position: "LeftHand.pos", rotation: "LeftHand.rot"', "time_unit: iso")
    assert said.returncode == 0 and "quaternion_order" not in text, said.stderr
    said, _ = proposed("take.npz", npz(t=TIMES, cup_pos=CUPS, cup_quat=np.tile(XYZW, (FRAMES, 1)), right_hand=HANDS),
                       'cup: {position: "cup_pos", rotation: "cup_quat"', 'right_hand: {position: "right_hand", hand: true', 't: "t"')
    assert said.returncode == 0, said.stderr
    said, text = proposed("take.npz", npz(position_m=np.stack([CUPS, HANDS], 1)), '"position_m[0:3]"', '"position_m[3:6]"', "rate_hz: 30")
    for name, content in (("none.json", '{"frames": [{"a": 1}, {"a": 2}]}'), ("broken.json", "[1, 2"), ("deep.json", "[" * 100_000), ("none.npz", npz(t=TIMES))):
        (folder / name).write_bytes(content.encode() if isinstance(content, str) else content)
        said = run("import", folder / name, "--propose")
        assert said.returncode == 2 and "nothing in it is called as" in said.stderr, (name, said.stderr)


def check_damage(seeds, count):
    """Cut off, bytes changed, parts doubled: read or refused, never more."""
    random.seed(44)
    refused = 0
    for _ in range(count):
        name, content, map_text = random.choice(seeds)
        data = bytearray(content if isinstance(content, bytes) else content.encode())
        for _ in range(random.randint(1, 4)):
            at = random.choice((random.randrange(len(data)), random.randrange(min(len(data), 600)),
                                len(data) - 1 - random.randrange(min(len(data), 300))))
            kind = random.randrange(4)
            if kind == 0:
                data[at] = random.choice((0, 1, 127, 128, 255, random.randrange(256)))
            elif kind == 1:
                del data[at:at + random.randint(1, 50)]
            elif kind == 2:
                data[at:at] = data[at // 2:at // 2 + random.randint(1, 60)]
            elif at > 100:
                del data[at:]
            data = data or bytearray(b"x")
        said = import_file(name, bytes(data), map_text)
        assert said.returncode in (0, 2), (name, said.returncode, said.stderr[-300:])
        assert said.returncode == 0 or "error" in said.stderr, said.stderr
        refused += said.returncode == 2
    return refused


if __name__ == "__main__":
    check_documented_json()
    check_proposed()
    made = check_json() + check_npz()
    print(f"{check_damage(made, 120)} of 120 damaged files refused, the others read")
