# SPDX-License-Identifier: Apache-2.0
"""Sub-tasks written back to HDF5 files as Isaac Lab and MimicGen read them: restated parsers accept them, nothing else of the
files changes, and edges are those of the events.

    /usr/bin/python3 tests/program/labels_back.py build/test/prehend
"""
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy as np

import made_demonstrations as made

PREHEND = os.path.abspath(sys.argv[1])
LABELS = """labels:
  grasp_1: {at: begin, of: grasping, object: cube_1}
  place_1: {at: end, of: grasping, object: cube_1, requires: "supported_by(cube_1, table)"}
text: {grasp_1: grasp the carton, place_1: "put it down, softly", rest: go away}
"""


def said(*words, code=0):
    run = subprocess.run([PREHEND, *words], capture_output=True, text=True, check=False)
    assert run.returncode == code, (words, run.returncode, run.stdout, run.stderr)
    return run.stdout + run.stderr


def datasets(path):
    """Everything in the file by name, as it is stored: type, shape, bytes; attributes, too."""
    found = {}

    def look(name, thing):
        found[name] = [sorted((key, np.asarray(value).tobytes()) for key, value in thing.attrs.items())]
        if isinstance(thing, h5py.Dataset):
            found[name] += [thing.dtype.str, thing.shape, thing[()].tobytes(), thing.compression, thing.chunks]

    with h5py.File(path) as file:
        file.visititems(look)
    return found


def isaac_ends(demo, names, offset=20):
    """isaaclab_mimic.datagen.data_generator: the first change ends a sub-task; ends with offsets do not cross."""
    ends = []
    for name in names:
        signal = demo["obs/datagen_info/subtask_term_signals/" + name][()]
        assert signal.dtype == np.bool_ and signal.shape == (demo["actions"].shape[0],)
        flat = signal.flatten().astype(int)
        ends.append(int(np.flatnonzero(flat[1:] - flat[:-1])[0]) + 1)
    for before, after in zip(ends, ends[1:] + [demo["actions"].shape[0]]):
        assert before < after
    return ends


def mimicgen_ends(demo, names):
    """mimicgen.utils.file_utils.parse_source_dataset: the first change after the end of the one before."""
    ends, last = [], 0
    for name in names:
        signal = demo["datagen_info/subtask_term_signals/" + name][()]
        assert signal.dtype == np.int64 and signal.shape == (demo["actions"].shape[0],)
        ends.append(int(np.flatnonzero((signal[1:] - signal[:-1])[last:])[0]) + last + 1)
        last = ends[-1]
    return ends


def edges_of(episodes, name):
    """(begin of the first grasp, its end on the table) of `resegment`, in frames of 20 Hz; None: there is none."""
    events = json.loads(said("episode", "resegment", episodes, "--episode", name, "--json"))["events"]
    grasps = [event for event in events if event["event"] == "grasping" and event["roles"]["object"] == "cube_1"]
    supports = [event for event in events if event["event"] == "supported_by" and event["roles"]
                == {"object": "cube_1", "support": "table"}]
    if not grasps:
        return None, None
    begin = min(event["begin_s"] for event in grasps)
    ends = [event["end_s"] for event in grasps if not event.get("open_end") and event["end_s"] > begin and any(
        support["begin_s"] <= event["end_s"] + 0.5 and support["end_s"] > event["end_s"] for support in supports)]
    to_frame = lambda t: int(np.ceil(t * made.RATE_HZ - 1e-3))
    return to_frame(begin), to_frame(min(ends)) if ends else None


def check_goldens(folder):
    """Each demonstration of a file has a golden of its own, beside the file."""
    made.isaac(os.path.join(folder, "few.hdf5"), made.demonstrations(PREHEND, 4))
    with open(os.path.join(folder, "few.yaml"), "w", encoding="utf-8") as out:
        out.write(made.MAPS["isaac_raw"])
    file, page = os.path.join(folder, "few.episodes"), ("--report", os.path.join(folder, "page"))
    said("import", os.path.join(folder, "few.hdf5"), "--map", os.path.join(folder, "few.yaml"), "-o", file)
    assert "next: prehend review " + file in said("check", file, *page, code=5)
    waiting = json.loads(said("review", file, "--json", code=5))["pending"]
    assert len(waiting) == 4 and {one["kind"] for one in waiting} == {"new"}, waiting
    assert "demonstration demo_0" in waiting[0]["text"], waiting[0]
    os.environ["CI"] = ""
    said("accept", file, "--reviewed", "0123456789abcdef", "--reason", "seen", code=1)
    said("accept", file, "--reviewed", waiting[2]["fingerprint"], "--reason", "seen")
    assert sorted(os.listdir(os.path.join(folder, "few.timelines"))) == ["demo_2.timeline"]
    said("accept", file, "--reason", "seen")
    assert len(os.listdir(os.path.join(folder, "few.timelines"))) == 4
    said("check", file, *page)
    said("review", file)
    assert "4 passed" in said("report", file, "-o", os.path.join(folder, "page.html"))
    said("check", file, *page, "--set", "hold_moves=9m/s", code=1)


def check_kind(folder, kind, ends_in):
    source, map_path = os.path.join(folder, kind + ".hdf5"), os.path.join(folder, kind + ".yaml")
    base = "" if kind == "maniskill" else "data/"
    with open(map_path, "a", encoding="utf-8") as out:
        out.write(LABELS)
    episodes, labelled = os.path.join(folder, kind + ".episodes"), os.path.join(folder, kind + "_labelled.hdf5")
    said("import", source, "--map", map_path, "-o", episodes)
    before, bytes_before = datasets(source), open(source, "rb").read()
    with h5py.File(source) as file:
        names = sorted(file[base or "/"], key=lambda name: int(name[5:]))
    edges = {name: edges_of(episodes, name) for name in names}
    whole = [name for name in names if edges[name][1] is not None]
    told = said("episode", "label", episodes, "--map", map_path, "-o", labelled, code=0 if len(whole) == len(names) else 1)
    assert open(source, "rb").read() == bytes_before
    assert f"{len(whole)} of {len(names)} episodes are labelled" in told, told
    after = datasets(labelled)
    group = "obs/datagen_info" if kind.startswith("isaac") else "datagen_info"
    new = {f"{base}{name}/{group}/subtask_term_signals/{label}" for name in whole for label in ("grasp_1", "place_1")}
    groups = {f"{base}{name}/{part}" for name in whole for part in (group, group + "/subtask_term_signals")}
    assert set(after) - set(before) <= new | groups and new <= set(after)
    assert all(after[name] == before[name] for name in before if name not in new)
    with h5py.File(labelled) as file:
        for name in names:
            if name in whole:
                assert ends_in(file[base + name], ("grasp_1", "place_1")) == list(edges[name]), (kind, name, edges[name])
                for label in ("grasp_1", "place_1"):
                    signal = file[f"{base}{name}/{group}/subtask_term_signals/{label}"][()]
                    assert not signal[0] and np.all(np.diff(signal.astype(int)) >= 0)
            else:
                why = "place_1: no end" if edges[name][0] is not None else "grasp_1: no begin"
                assert f"{name} is left without labels: {why} of grasping cube_1" in told
                assert f"{base}{name}/{group}/subtask_term_signals/place_1" not in after
    again = os.path.join(folder, "again.hdf5")
    said("episode", "label", episodes, "--map", map_path, "-o", again, code=0 if len(whole) == len(names) else 1)
    assert open(again, "rb").read() == open(labelled, "rb").read()
    if shutil.which("h5diff"):
        words = ["h5diff", "-q"] + [word for name in sorted(new) for word in ("--exclude-path", "/" + name)]
        assert subprocess.run(words + [source, labelled], check=False).returncode in (0, 1)
    return episodes, map_path, edges, whole


def check_tables(folder, episodes, map_path, edges, whole):
    table, frames = os.path.join(folder, "tasks.csv"), os.path.join(folder, "frames.csv")
    code = 0 if len(whole) == len(edges) else 1
    said("episode", "label", episodes, "--map", map_path, "--to", "csv", "-o", table, code=code)
    said("episode", "label", episodes, "--map", map_path, "--to", "frames", "-o", frames, code=code)
    tasks = list(csv.DictReader(open(table, encoding="utf-8", newline="")))
    rows = list(csv.DictReader(open(frames, encoding="utf-8", newline="")))
    assert [row["episode"] for row in tasks] == [name for name in whole for _ in range(3)]
    for name in whole:
        own = [row for row in tasks if row["episode"] == name]
        assert [row["subtask"] for row in own] == ["grasp_1", "place_1", "rest"]
        assert [row["text"] for row in own] == ["grasp the carton", "put it down, softly", "go away"]
        assert [int(row["end_frame"]) for row in own[:2]] == list(edges[name])
        labels = [row["subtask"] for row in rows if row["episode"] == name]
        assert labels == [row["subtask"] for row in own for _ in range(int(row["begin_frame"]), int(row["end_frame"]))]
    sarm = os.path.join(folder, "sarm")
    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../examples/subtasks_for_sarm.py")
    subprocess.run([sys.executable, "-B", script, table, sarm], check=True, capture_output=True)
    made_rows = list(csv.DictReader(open(sarm + ".csv", encoding="utf-8", newline="")))
    assert len(made_rows) == len(whole)
    for name, row in zip(whole, made_rows):
        assert row["episode"] == name
        for kind in ("sparse", "dense"):
            assert json.loads(row[kind + "_subtask_end_frames"])[:2] == list(edges[name])
            assert json.loads(row[kind + "_subtask_names"])[0] == "grasp the carton"
    language = [json.loads(line) for line in open(sarm + ".language.json", encoding="utf-8")]
    assert len(language) == len(rows)
    for frame, row in zip(language, rows):
        assert frame["frame_index"] == int(row["frame"]) and frame["timestamp"] == float(np.float32(frame["frame_index"] / made.RATE_HZ))
        begun = [one["content"] for one in frame["language_persistent"] if one["timestamp"] <= frame["timestamp"]]
        assert begun[-1] == row["text"] and frame["language_persistent"][0]["timestamp"] == 0


def check_faults(folder, episodes, map_path):
    text = open(map_path, encoding="utf-8").read()
    wrong = os.path.join(folder, "wrong.yaml")
    out = os.path.join(folder, "never.hdf5")
    for old, new, told in (("of: grasping", "of: graspin", "did you mean 'grasping'?"),
                           ("object: cube_1}", "object: cube_9}", "the map has no entity 'cube_9'"),
                           ("supported_by(", "suported_by(", "did you mean 'supported_by'?"),
                           (LABELS[:LABELS.index("text:")], "", "the map has no 'labels'")):
        with open(wrong, "w", encoding="utf-8") as file:
            file.write(text.replace(old, new))
        assert told in said("episode", "label", episodes, "--map", wrong, "-o", out, code=2), told
    with open(wrong, "w", encoding="utf-8") as file:  # true from the first frame on
        file.write(text.replace("at: begin, of: grasping, object: cube_1", "at: begin, of: supported_by, object: cube_2"))
    assert "grasp_1 would be true in the first frame" in said("episode", "label", episodes, "--map", wrong, "-o", out, code=1)
    os.remove(out)
    source = map_path.replace(".yaml", ".hdf5")
    assert "what is read" in said("episode", "label", episodes, "--map", map_path, "-o", source, code=2)
    said("episode", "label", episodes, "--map", map_path, code=2)
    said("episode", "label", episodes, "--map", map_path, "-o", out, "--to", "csv", code=2)
    assert not os.path.exists(out)
    os.rename(source, source + ".away")
    said("episode", "label", episodes, "--map", map_path, "-o", out, code=2)
    os.rename(source + ".away", source)


def check_page(folder):
    """The commands of docs/robot-demonstrations.md, in their order, with the map that the first one proposes."""
    page = os.path.join(folder, "page_commands")
    os.mkdir(page)
    shutil.copy(os.path.join(folder, "isaac_annotated.hdf5"), os.path.join(page, "demos.hdf5"))
    root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
    lines = open(os.path.join(root, "docs/robot-demonstrations.md"), encoding="utf-8").read().splitlines()
    commands = [line for line in lines if line.startswith("prehend ")]
    assert len(commands) == 10, commands
    for command in commands:
        done = subprocess.run(command, shell=True, cwd=page, capture_output=True, text=True, check=False,
                              env=dict(os.environ, PATH=os.path.dirname(PREHEND) + ":" + os.environ["PATH"]))
        assert done.returncode in (0, 1 if " label " in command else 0), (command, done.returncode, done.stderr)
        if "--propose" in command:
            map_path = os.path.join(page, "stack.yaml")
            text = open(map_path, encoding="utf-8").read().replace("grammar: robot_pick_and_place", "grammar: pick_and_place_from_motion")
            with open(map_path, "w", encoding="utf-8") as out:
                out.write(text.replace("[0.05, 0.05, 0.05]", "[0.07, 0.07, 0.2]", 1) + LABELS)
    with h5py.File(os.path.join(page, "labelled.hdf5")) as file:
        assert any("obs/datagen_info/subtask_term_signals/place_1" in demo for demo in file["data"].values())


def main():
    with tempfile.TemporaryDirectory() as folder:
        made.write_all(folder, made.demonstrations(PREHEND))
        check_goldens(folder)
        check_page(folder)
        for kind, ends in (("isaac_raw", isaac_ends), ("isaac_annotated", isaac_ends), ("mimicgen", mimicgen_ends),
                           ("robosuite", mimicgen_ends), ("maniskill", mimicgen_ends)):
            found = check_kind(folder, kind, ends)
            print(f"{kind}: {len(found[3])} of {len(found[2])} demonstrations accepted")
            if kind == "isaac_annotated":
                check_tables(folder, *found)
                check_faults(folder, *found[:2])


main()
