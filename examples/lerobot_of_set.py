# SPDX-License-Identifier: Apache-2.0
"""A data set of `python3 -m prehend dataset make` in the layout of LeRobot 2.1 (docs/benchmark.md).

    lerobot_of_set.py SET OUT

State and action are position, quaternion (w first) and grip of the right hand or gripper and of the left hand, zeros for one that is
not there; the action is the next state. The task is the skill in words. Needs duckdb or pyarrow for Parquet. Not loaded by LeRobot here.
"""
import csv
import importlib.util
import json
import pathlib
import sys

import numpy as np
import pandas as pd

from prehend.baselines import episodes_of

FPS, WIDTH = 20, 8


def state_of(episode):
    """(T, 16) on a grid of FPS, each moment as it was seen last."""
    poses = episode.poses()
    t = np.arange(0, episode.duration_s, 1 / FPS)
    state = np.zeros((len(t), 2 * WIDTH), np.float32)
    for column, names in enumerate((("right_hand", "gripper"), ("left_hand",))):
        one = poses[poses.entity.isin(names)]
        if len(one):
            rows = np.clip(np.searchsorted(one.t, t, side="right") - 1, 0, len(one) - 1)
            state[:, column * WIDTH:(column + 1) * WIDTH] = one[["x", "y", "z", "qw", "qx", "qy", "qz", "grip"]].to_numpy()[rows]
    return t, np.nan_to_num(state)


def write_parquet(table, path):
    try:
        table.to_parquet(path)
    except ImportError:
        import duckdb
        duckdb.from_df(table).write_parquet(str(path))


def main(source, target):
    with open(source / "episodes.csv", encoding="utf-8") as file:
        known = {row["episode"]: row for row in csv.DictReader(file)}
    tasks = sorted({row["skill"].replace("_", " ") for row in known.values()})
    (target / "meta").mkdir(parents=True)
    (target / "data" / "chunk-000").mkdir(parents=True)
    lines, total = [], 0
    for number, (name, episode) in enumerate(episodes_of(source)):
        t, state = state_of(episode)
        task = tasks.index(known[name]["skill"].replace("_", " "))
        table = pd.DataFrame({"observation.state": list(state), "action": list(np.vstack([state[1:], state[-1:]])), "timestamp": t.astype(np.float32),
                              "frame_index": np.arange(len(t)), "episode_index": number, "index": total + np.arange(len(t)), "task_index": task})
        write_parquet(table, target / "data" / "chunk-000" / f"episode_{number:06d}.parquet")
        lines.append({"episode_index": number, "tasks": [tasks[task]], "length": len(t), "name": name, "split": known[name]["role"]})
        total += len(t)
    feature = {"dtype": "float32", "shape": [2 * WIDTH], "names": None}
    one = {"dtype": "int64", "shape": [1], "names": None}
    info = {"codebase_version": "v2.1", "robot_type": "prehend", "fps": FPS, "total_episodes": len(lines), "total_frames": total, "total_tasks": len(tasks),
            "total_videos": 0, "total_chunks": 1, "chunks_size": max(1000, len(lines)), "splits": {"train": f"0:{len(lines)}"},
            "data_path": "data/chunk-{episode_chunk:03d}/episode_{episode_index:06d}.parquet", "video_path": None,
            "features": {"observation.state": feature, "action": feature, "timestamp": {**one, "dtype": "float32"},
                         **{name: one for name in ("frame_index", "episode_index", "index", "task_index")}}}
    (target / "meta" / "info.json").write_text(json.dumps(info, indent=2), encoding="utf-8")
    for name, rows in (("episodes", lines), ("tasks", [{"task_index": i, "task": task} for i, task in enumerate(tasks)])):
        (target / "meta" / f"{name}.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows), encoding="utf-8")
    print(f"{target}: {len(lines)} episodes, {total} frames")


if len(sys.argv) != 3:
    sys.exit("usage: lerobot_of_set.py SET OUT")
if not any(map(importlib.util.find_spec, ("pyarrow", "fastparquet", "duckdb"))):
    sys.exit("lerobot_of_set.py: Parquet needs the Python module 'duckdb' or 'pyarrow': pip install duckdb")
try:
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
except OSError as error:
    sys.exit(f"lerobot_of_set.py: {error.filename}: {error.strerror.lower()}")
