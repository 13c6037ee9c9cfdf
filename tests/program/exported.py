# SPDX-License-Identifier: Apache-2.0
"""Exported episodes, read by NumPy, pandas and `import`: poses within 1e-9 m, the same events.

    exported.py PREHEND [SCENARIOS]
"""
import csv
import glob
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
import pandas as pd

prehend, count = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 6
PLAYED = 8  # of these, the files of other formats, too


def said(*words, ok=(0,)):
    run = subprocess.run([prehend, *map(str, words)], capture_output=True, text=True, check=False)
    assert run.returncode in ok, (words, run.returncode, run.stderr)
    return run.stdout


def resegmented(file, *words):
    events = json.loads(said("episode", "resegment", file, "--json", *words, ok=(0, 4)))["events"]
    return [{key: event[key] for key in event if not key.startswith("decided")} for event in events]


def poses_of(lines, names):
    """(ticks, position, quaternion wxyz) of the frames of a recording, by `names`."""
    at, ticks, p, q = {}, [], [], []
    for line in lines[1:]:
        if "end_tick" in line:
            continue
        at.update(line["samples"])
        ticks.append(line["tick"])
        p.append([at[name]["at_m"] if at[name] else [np.nan] * 3 for name in names])
        q.append([at[name]["quat_wxyz"] if at[name] else [np.nan] * 4 for name in names])
    return np.array(ticks), np.array(p), np.array(q)


def lost_in(lines, names):
    """Of each frame of a recording, which of `names` are not tracked in it."""
    at, lost = {}, []
    for line in lines[1:-1]:
        at.update(line["samples"])
        lost.append([name for name in names if at[name] is None])
    return lost


def turned(q, v):
    """v in the axes that q turns to."""
    u = q[..., 1:]
    t = 2 * np.cross(u, v)
    return v + q[..., :1] * t + np.cross(u, t)


def poses_alone(lines, mapped, jointed):
    """What a tracker would know of a recording: bodies of the map as boxes, which are jointed, their poses, nothing else."""
    head, (ticks, p, q) = lines[0], poses_of(lines, mapped)
    first = {"recording": 1, "episode": head["episode"], "grammar": "pick_and_place_from_motion",
             "ticks_per_second": head["ticks_per_second"], "entities": {}}
    for i, name in enumerate(mapped):
        old = head["entities"][name]
        if old.get("hand"):
            first["entities"][name] = {"hand": True, "size_m": old["size_m"]}
        else:
            first["entities"][name] = {"class": old["class"], "fixed": old["fixed"], "size_m": old["size_m"], "jointed": name in jointed}
        p[:, i] += turned(q[:, i], np.array(old["centre_m"]))
    hands = [i for i, name in enumerate(mapped) if head["entities"][name].get("hand")]
    ahead = {}
    for line in lines[1:]:
        for name, hand in line.get("hands", {}).items():
            if name in mapped and name not in ahead:
                back = q[list(ticks).index(line["tick"]), mapped.index(name)] * [1, -1, -1, -1]
                ahead[name] = turned(back, np.array(hand["ahead"]))
    made = [json.dumps(first)]
    for k, tick in enumerate(ticks):
        samples = {name: {"at_m": list(p[k, i]), "quat_wxyz": list(q[k, i])} for i, name in enumerate(mapped)}
        grips = {mapped[i]: {"ahead": list(turned(q[k, i], ahead[mapped[i]]))} for i in hands}
        made.append(json.dumps({"tick": int(tick - ticks[0]), "samples": samples, "hands": grips}))
    made.append(json.dumps({"end_tick": int(ticks[-1] - ticks[0]) + 1}))
    return "\n".join(made) + "\n"


def check_files(folder, name, lines):
    """What NumPy and pandas read."""
    names = list(lines[0]["entities"])
    ticks, p, q = poses_of(lines, names)
    t = ticks / lines[0]["ticks_per_second"]
    arrays = np.load(folder / f"{name}.npz")
    assert [text.decode() for text in arrays["entity"]] == names
    assert np.array_equal(arrays["t_s"], t) and np.array_equal(arrays["position_m"], p, equal_nan=True)
    assert np.array_equal(arrays["quaternion_wxyz"], q, equal_nan=True)
    table = pd.read_csv(folder / f"{name}.csv", float_precision="round_trip")
    assert list(table.entity[:len(names)]) == names and len(table) == len(t) * len(names)
    assert np.array_equal(table[["x", "y", "z"]].to_numpy().reshape(p.shape), p, equal_nan=True)
    assert np.array_equal(table[["qw", "qx", "qy", "qz"]].to_numpy().reshape(q.shape), q, equal_nan=True)
    assert np.abs(table.t.to_numpy() - np.repeat(t, len(names))).max() < 0.5 / lines[0]["ticks_per_second"]
    hands = [one for one in names if lines[0]["entities"][one].get("hand")]
    last = {hand: line["hands"][hand]["trigger"] for line in lines[1:] for hand in line.get("hands", {})}
    for hand in hands:
        assert table.grip[table.entity == hand].iloc[-1] == last[hand] == arrays["grip"][-1, names.index(hand)]
    assert table.grip[~table.entity.isin(hands)].isna().all()
    events = pd.read_csv(folder / f"{name}.events.csv")
    uuids = [text.decode() for text in arrays["event_uuid"]]
    assert list(events.uuid) == uuids and len(set(uuids)) == len(uuids)
    assert list(events.event) == [text.decode() for text in arrays["event"]]
    assert np.abs(events.begin_s - arrays["event_begin_s"]).max() < 1e-3 if len(events) else True
    for roles, (_, row) in zip(arrays["event_roles_json"], events.iterrows()):
        assert all(str(row[role]) == str(value) for role, value in json.loads(roles).items()
                   if isinstance(value, str)), (roles, row)


def check_uuids(folder):
    """Of an episode file they are those of the knowledge base, and stay."""
    kept = folder / "milk.episodes"
    said("run", "milk_carton_wrap", "--record", kept)
    said("episode", "knowledge", kept, "-o", folder / "kb")
    turtle = pathlib.Path(glob.glob(str(folder / "kb/episodes/*.ttl"))[0]).read_text(encoding="utf-8")
    for out in ("a", "b"):
        said("episode", "export", kept, "--to", "csv", "-o", folder / out / "milk.csv")
    first, second = [(folder / out / "milk.events.csv").read_bytes() for out in ("a", "b")]
    assert first == second
    for row in csv.DictReader(first.decode().splitlines()):
        assert f"log:{row['uuid']}" in turtle, row
    said("episode", "export", kept, "--to", "jsonl", "-o", folder / "kept.jsonl")
    said("run", "milk_carton_wrap", "--record", folder / "played.jsonl")
    assert (folder / "kept.jsonl").read_bytes() == (folder / "played.jsonl").read_bytes()
    said("episode", "export", kept, "--grammar", "pick_and_place_from_motion", "--to", "csv", "-o", folder / "m.csv")
    assert (folder / "m.events.csv").read_bytes() != first


def check_gaps(folder):
    """What is not tracked for a while, shorter and longer than `bridge_s`, is segmented as before."""
    def line(tick, x):
        cup = None if 30 <= tick < 36 or 60 <= tick < 90 else {"at_m": [0, 0, 0.77]}
        return json.dumps({"tick": tick, "samples": {"cup": cup, "hand": {"at_m": [x, 0, 0.8]}}})
    take = folder / "gaps.jsonl"
    take.write_text("\n".join(
        [json.dumps({"recording": 1, "episode": "gaps", "grammar": "contact_from_motion", "ticks_per_second": 100,
                     "entities": {"table": {"class": "Table", "fixed": True, "size_m": [1, 1, 0.04]},
                                  "cup": {"class": "Cup", "size_m": [0.08, 0.08, 0.1]},
                                  "hand": {"hand": True, "size_m": [0.09, 0.08, 0.03]}}}),
         json.dumps({"tick": 0, "samples": {"table": {"at_m": [0, 0, 0.7]}}})]
        + [line(tick, 0.3 - tick / 1000) for tick in range(1, 200)] + [json.dumps({"end_tick": 200})]), encoding="utf-8")
    said("episode", "export", take, "--to", "jsonl", "-o", folder / "again.jsonl")
    assert resegmented(take) == resegmented(folder / "again.jsonl")
    said("episode", "export", folder / "again.jsonl", "--to", "jsonl", "-o", folder / "third.jsonl")
    assert (folder / "again.jsonl").read_bytes() == (folder / "third.jsonl").read_bytes()
    assert "bridge_s" not in json.loads((folder / "again.jsonl").read_text(encoding="utf-8").splitlines()[0])
    said("import", take, "-o", folder / "gaps.episodes")
    lost = [["cup"] if tick == 0 or 30 <= tick < 36 or 60 <= tick < 90 else [] for tick in range(200)]  # also what is bridged
    for source in (take, folder / "gaps.episodes"):
        for form in ("jsonl", "csv", "npz", "mcap"):
            made = folder / f"copy.{form}"
            said("episode", "export", source, "--to", form, "-o", made)
            if form == "npz":
                assert (np.isnan(np.load(made)["position_m"][:, 1]).all(1) == [*map(bool, lost)]).all()
            if form != "jsonl":
                assert "\nbridge_s: 0.1\n" in pathlib.Path(f"{made}.map.yaml").read_text(encoding="utf-8")
                said("import", made, "--map", f"{made}.map.yaml", "-o", folder / "back.jsonl")
                made = folder / "back.jsonl"
            assert lost_in([json.loads(row) for row in open(made, encoding="utf-8")], ["cup"]) == lost, (source, form)
            assert resegmented(made) == resegmented(take), (source, form)


def check_not_tracked(folder):
    """What is lost, seen late, or vanishes, beside a drawer: the same events from every format, by the same grammar."""
    def take(name, unseen, grammar="pick_and_place_from_motion", moves=True):
        table, kinds = {"class": "Table", "fixed": True, "size_m": [2, 2, 0.04]}, []
        lines = [{"recording": 1, "episode": name, "grammar": grammar, "ticks_per_second": 1000, "entities": {
            "table": table, "cup": {"class": "Cup", "size_m": [0.08, 0.08, 0.1]},
            "drawer": {"class": "Drawer", "jointed": True, "size_m": [0.3, 0.3, 0.1]},
            "right_hand": {"hand": True, "size_m": [0.09, 0.08, 0.03]}}}]
        for k in range(240):
            t = k / 40
            along = 0.5 * (1 - np.cos(np.pi * np.clip((t - 2) / 2, 0, 1))) if moves else 0
            cup = [0.4 * along, 0, 0.77 + 0.15 * np.sin(np.pi * along)]
            off = 0.3 * (1 - np.clip(t - 0.5, 0, 1) + np.clip(t - 4.5, 0, 1)) if moves else 0.3
            pulled = 0.2 * np.clip(t - 4, 0, 1) if moves else 0
            at = {"table": {"at_m": [0, 0, 0.7]}, "cup": {"at_m": cup}, "right_hand": {"at_m": [cup[0] - off - 0.06, 0, cup[2]]},
                  "drawer": {"at_m": [0.6 - pulled, 0.5, 0.77], "joint_position": pulled, "joint_fraction": pulled / 0.25}}
            for entity, (begin, end) in unseen.items():
                if begin <= t < end:
                    at[entity] = None
            lines.append({"tick": 25 * k, "samples": at, "hands": {"right_hand": {"trigger": float(off < 0.01)}}})
        file = folder / f"{name}.jsonl"
        file.write_text("\n".join(json.dumps(line) for line in lines + [{"end_tick": 5976}]), encoding="utf-8")
        return file, grammar
    events = 0
    for file, grammar in (take("seen", {}), take("lost", {"cup": (2.6, 3.4)}), take("late", {"cup": (0, 1.5)}), take("gone", {"cup": (5, 9)}),
                          take("hand", {"right_hand": (2.5, 3.5)}), take("drawer", {"drawer": (4.2, 4.9)}),
                          take("all", {"cup": (0, 0.5), "right_hand": (4.6, 9), "drawer": (0, 3)}, "contact_from_motion"),
                          take("still", {"cup": (1, 2), "right_hand": (3, 9)}, moves=False)):
        truth = resegmented(file)
        events += len(truth)
        for form in ("jsonl", "csv", "npz", "mcap"):
            made = folder / f"{file.stem}_out.{form}"
            said("episode", "export", file, "--to", form, "-o", made)
            if form != "jsonl":
                text = pathlib.Path(f"{made}.map.yaml").read_text(encoding="utf-8")
                assert re.findall(r"^  (.*?): {.*joint: ", text, re.M) == ['"drawer"'] and f"\ngrammar: {grammar}\n" in text, text
                back = folder / "back.jsonl"
                run = subprocess.run([prehend, "import", made, "--map", f"{made}.map.yaml", "-o", back], capture_output=True, text=True, check=False)
                assert run.returncode == 0 and "does not mention" not in run.stderr, (file, form, run.stderr)
                made = back
            assert resegmented(made) == truth, (file, form, truth, resegmented(made))
    assert events > 40, events
    # Rare frames: what they do not mention is as it was, also to the end.
    rare = folder / "rare.jsonl"
    lines = take("rare", {"cup": (1, 2)}, moves=False)[0].read_text(encoding="utf-8").splitlines()
    rare.write_text("\n".join(line for k, line in enumerate(lines) if k < 20 or k in (50, 90, 91, 92, 170, 241)), encoding="utf-8")
    for form in ("csv", "npz", "mcap"):
        said("episode", "export", rare, "--to", form, "-o", folder / f"rare.{form}")
        said("import", folder / f"rare.{form}", "--map", folder / f"rare.{form}.map.yaml", "-o", folder / "back.jsonl")
        assert resegmented(folder / "back.jsonl") == resegmented(rare), form
    # There is a row for each frame and none in a pause, also where things are lost, all at once or one in a single frame; the end is kept.
    pause = folder / "pause.jsonl"
    gone = {"cup": (2.6, 3.4), "right_hand": (2.6, 3), "drawer": (2.6, 3), "table": (2.6, 3)}
    for unseen, end in (({"cup": (0, 0.9)}, 5976), ({}, 5990), ({"cup": (2.6, 3.4)}, 5999), (gone, 6100), ({"right_hand": (3.5, 3.51)}, 9000)):
        lines = take("seen", unseen)[0].read_text(encoding="utf-8").splitlines()
        lines[0], lines[-1] = json.dumps({**json.loads(lines[0]), "bridge_s": 0}), json.dumps({"end_tick": end})
        pause.write_text("\n".join(line for k, line in enumerate(lines) if not (90 <= k < 93 or 95 <= k < 110)), encoding="utf-8")
        for form in ("csv", "npz", "mcap"):
            told = said("episode", "export", pause, "--to", form, "-o", folder / f"pause.{form}")
            assert "222 frames" in told, told
            said("import", folder / f"pause.{form}", "--map", folder / f"pause.{form}.map.yaml", "-o", folder / "back.jsonl")
            there, back = [[json.loads(line) for line in open(file, encoding="utf-8")] for file in (pause, folder / "back.jsonl")]
            assert np.allclose(*[[line.get("tick", line.get("end_tick")) / lines[0]["ticks_per_second"] for line in lines[1:]] for lines in (there, back)], atol=1e-9)
            assert lost_in(there, gone) == lost_in(back, gone), (form, unseen)
            assert resegmented(folder / "back.jsonl") == resegmented(pause), form
    # One frame; and what is seen in one only.
    once = take("once", {"cup": (0.02, 9)})[0]
    one = folder / "one.jsonl"
    lines = once.read_text(encoding="utf-8").splitlines()
    one.write_text("\n".join([*lines[:2], json.dumps({"end_tick": 20})]), encoding="utf-8")
    for file in (one, once):
        for form in ("csv", "npz", "mcap"):
            said("episode", "export", file, "--to", form, "-o", folder / f"one.{form}")
            said("import", folder / f"one.{form}", "--map", folder / f"one.{form}.map.yaml", "-o", folder / "back.jsonl")
            back = [json.loads(line) for line in open(folder / "back.jsonl", encoding="utf-8")]
            assert [len(back), list(back[0]["entities"])] == [3 if file == one else 242, list(json.loads(lines[0])["entities"])], (form, back[0])
            assert resegmented(folder / "back.jsonl") == resegmented(file), form
    # A pause may be longer than a map bridges.
    lines = take("seen", {})[0].read_text(encoding="utf-8").splitlines()
    long = folder / "long.jsonl"
    moved = [json.loads(line) for line in lines]
    for line in moved[120:]:
        line.update({key: line[key] + 90_000 for key in ("tick", "end_tick") if key in line})
    long.write_text("\n".join(map(json.dumps, moved)), encoding="utf-8")
    said("episode", "export", long, "--to", "csv", "-o", folder / "long.csv")
    said("import", folder / "long.csv", "--map", folder / "long.csv.map.yaml", "-o", folder / "back.jsonl")
    assert resegmented(folder / "back.jsonl") == resegmented(long)
    # What is lost in an episode file is lost as long in what is written of it.
    lost = take("lost", {"cup": (2.6, 3.4)})[0]
    said("episode", "export", lost, "--to", "csv", "-o", folder / "l.csv")
    said("import", folder / "l.csv", "--map", folder / "l.csv.map.yaml", "-o", folder / "l.episodes")
    for form in ("jsonl", "csv", "npz", "mcap"):
        made = folder / f"l2.{form}"
        said("episode", "export", folder / "l.episodes", "--to", form, "-o", made)
        if form != "jsonl":
            said("import", made, "--map", f"{made}.map.yaml", "-o", folder / "l3.jsonl")
            made = folder / "l3.jsonl"
        assert resegmented(made) == resegmented(lost), form
    # A part stays one.
    whole = json.loads(lines[0])
    whole["entities"]["lid"] = {"class": "Lid", "part_of": "cup", "attached": True, "size_m": [0.05, 0.05, 0.01]}
    frames = [json.loads(line) for line in lines[1:]]
    for frame in frames[:-1]:
        frame["samples"]["lid"] = {"at_m": [*frame["samples"]["cup"]["at_m"][:2], frame["samples"]["cup"]["at_m"][2] + 0.05]}
    part = folder / "part.jsonl"
    part.write_text("\n".join(json.dumps(line) for line in [whole, *frames]), encoding="utf-8")
    for form in ("csv", "npz", "mcap"):
        said("episode", "export", part, "--to", form, "-o", folder / f"part.{form}")
        said("import", folder / f"part.{form}", "--map", folder / f"part.{form}.map.yaml", "-o", folder / "back.jsonl")
        assert json.loads(open(folder / "back.jsonl", encoding="utf-8").readline())["entities"]["lid"]["part_of"] == "cup", form
    # What the map cannot say is a comment.
    (folder / "own.grammar").write_text("grammar own\nuse contact from motion\n", encoding="utf-8")
    said("episode", "export", rare, "--to", "csv", "-o", folder / "r.csv", "--grammar", folder / "own.grammar")
    text = (folder / "r.csv.map.yaml").read_text(encoding="utf-8")
    assert f"\n# not said here: its events are those of {folder}/own.grammar\n" in text and "\ngrammar:" not in text, text


def openings_of(lines):
    """(tick, grip of each hand, position and fraction of each joint), where they are not 0 all the time."""
    hands, joints, rows = {}, {}, []
    for line in lines[1:]:
        if "end_tick" in line:
            continue
        hands.update({name: hand["trigger"] for name, hand in line.get("hands", {}).items() if "trigger" in hand})
        for name, sample in line["samples"].items():
            if sample:
                joints[name] = (sample.get("joint_position", 0), sample.get("joint_fraction", 0))
        rows.append((dict(hands), {name: joint for name, joint in joints.items() if joint != (0, 0)}))
    return rows


def check_openings(folder):
    """Grips and joints, by the map beside a table."""
    seen = {}
    for scenario in ("milk_carton_wrap", *sorted(glob.glob("scenarios/furniture/*.yaml"))[:3]):
        kept = folder / "o.jsonl"
        said("run", scenario, "--record", kept, ok=(0, 1))
        there = [json.loads(line) for line in open(kept, encoding="utf-8")]
        for form in ("csv", "mcap", "npz"):
            name = folder / f"o.{form}"
            said("episode", "export", kept, "--to", form, "-o", name)
            said("import", name, "--map", f"{name}.map.yaml", "-o", folder / "back.jsonl")
            back = [json.loads(line) for line in open(folder / "back.jsonl", encoding="utf-8")]
            known = set(back[0]["entities"])
            for (hands, joints), (hands2, joints2) in zip(openings_of(there), openings_of(back), strict=True):
                for hand, grip in hands.items():
                    assert abs(grip - hands2.get(hand, 0)) < 1e-9, (scenario, form, hand, grip, hands2)
                for thing, joint in joints.items():
                    if thing in known:
                        assert np.abs(np.subtract(joint, joints2.get(thing, (0, 0)))).max() < 1e-9, (scenario, form, thing, joint, joints2)
                        seen[form] = seen.get(form, 0) + 1
    assert len(seen) == 3 and min(seen.values()) > 100, seen


def main():
    every = [file for file in sorted(glob.glob("scenarios/*/*.yaml"))
             if "\nscenario:" in "\n" + pathlib.Path(file).read_text(encoding="utf-8")]
    chosen = [file for file in every if file.split("/")[1] in ("pick_and_place", "slide", "grasp", "reach", "put_down",
                                                               "support", "transport", "pick_up", "bimanual", "styles",
                                                               "rates", "tracking", "stirring")]
    chosen = chosen[:: max(1, len(chosen) // count)][:count]
    assert len(chosen) == count
    with tempfile.TemporaryDirectory() as where:
        folder = pathlib.Path(where)
        check_uuids(folder)
        check_gaps(folder)
        check_not_tracked(folder)
        check_openings(folder)
        events = 0
        for file in chosen:
            name = pathlib.Path(file).stem
            kept = folder / f"{name}.episodes"
            run = json.loads(said("run", file, "--json", "--record", kept, ok=(0, 1)))["events"]
            for form in ("jsonl", "csv", "mcap") + (("npz",) if chosen.index(file) < PLAYED else ()):
                said("episode", "export", kept, "--to", form, "-o", folder / name / f"{name}.{form}")
            lines = [json.loads(line) for line in open(folder / name / f"{name}.jsonl", encoding="utf-8")]
            if chosen.index(file) < PLAYED:
                check_files(folder / name, name, lines)
                again = json.loads(said("episode", "resegment", folder / name / f"{name}.jsonl", "--json"))["events"]
                assert run == again, name
            for form in ("csv", "mcap"):
                text = (folder / name / f"{name}.{form}.map.yaml").read_text(encoding="utf-8")
                mapped = [json.loads(one) for one in re.findall(r'^  (".*?"): {', text, re.M)]
                jointed = [json.loads(one) for one in re.findall(r'^  (".*?"): {.* joint: ', text, re.M)]
                wanted = folder / name / f"wanted_{form}.jsonl"
                wanted.write_text(poses_alone(lines, mapped, jointed), encoding="utf-8")
                truth = resegmented(wanted)
                events += len(truth) if form == "csv" else 0
                take = folder / name / f"{form}.jsonl"
                said("import", folder / name / f"{name}.{form}", "--map", folder / name / f"{name}.{form}.map.yaml", "-o", take)
                read = poses_of([json.loads(line) for line in open(take, encoding="utf-8")], mapped)
                want = poses_of([{}] + [json.loads(line) for line in open(wanted, encoding="utf-8")][1:], mapped)
                assert np.array_equal(read[0], want[0]), (name, form)
                assert np.nanmax(np.abs(read[1] - want[1])) < 1e-9, (name, form)
                assert resegmented(take) == truth, (name, form)
        print(f"{count} scenarios, {events} events by each of csv and mcap: the same")


main()
