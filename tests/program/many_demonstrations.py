# SPDX-License-Identifier: Apache-2.0
"""What many robot demonstrations cost: an HDF5 file of them is imported, judged, labelled and reported. Prints processor seconds,
also of `report` as a multiple of judging. Import, judging and labels of 1,000 of 220 frames and 5 entities may take 60.

    /usr/bin/python3 tests/program/many_demonstrations.py build/test/prehend [COUNT] [FOLDER]
"""
import os
import resource
import subprocess
import sys
import tempfile

import h5py
import numpy as np

PREHEND, COUNT = os.path.abspath(sys.argv[1]), int((sys.argv[2:] or ["1000"])[0])
FRAMES, SIZE, LIMIT_S = 220, 0.047, 60.0
MAP = """import: 1
unit: m
axes: z_up
rate_hz: 20
quaternion_order: wxyz
hdf5: {episodes: "data/*", success: "@success"}
grammar: robot_pick_and_place
entities:
  table: {at_m: [0, 0, -0.02], fixed: true, class: Table, size_m: [2, 2, 0.04]}
%s  gripper: {position: obs/eef_pos, quaternion: obs/eef_quat, hand: true, ahead: [0, 0, 1], size_m: [0.02, 0.1, 0.06],
            grip: {from: obs/gripper_pos, sum_abs: true, open: 0.08, closed: 0}}
labels:
  grasp_1: {at: begin, of: grasping, object: cube_2}
  stack_1: {at: end, of: grasping, object: cube_2, requires: "supported_by(cube_2, cube_1)"}
  grasp_2: {at: begin, of: grasping, object: cube_3}
""" % "".join("  cube_%d: {pose: states/rigid_object/cube_%d/root_pose, class: Cube, size_m: [%g, %g, %g]}\n"
              % (i, i, SIZE, SIZE, SIZE) for i in (1, 2, 3))


def demonstration(rng):
    """Two cubes are stacked on the first one: poses of the gripper and the cubes, the way of a finger."""
    base = np.array([[0.3 * i + rng.uniform(-0.03, 0.03), rng.uniform(-0.05, 0.05), SIZE / 2] for i in range(3)])
    cubes, finger = np.tile(base, (FRAMES, 1, 1)), np.full(FRAMES, 0.04)
    hand, at, k = np.tile([0.0, 0.3, 0.3], (FRAMES, 1)), np.array([0.0, 0.3, 0.3]), 5

    def go(to, frames, held=None, close=None):
        nonlocal at, k
        for i in range(1, frames + 1):
            hand[k:] = at + (to - at) * i / frames
            if held is not None:
                cubes[k:, held] = hand[k]
            if close is not None:
                finger[k:] = finger[k - 1] + (close - finger[k - 1]) * i / frames
            k += 1
        at = np.array(to)

    up = np.array([0, 0, 0.12])
    for which, below in ((1, 0), (2, 1)):
        here, there = cubes[k, which], cubes[k, below] + [0, 0, SIZE]
        go(here + up, 20), go(here, 18), go(here, 6, close=SIZE / 2), go(here + up, 15, which)
        go(there + up, 20, which), go(there, 15, which), go(there, 6, close=0.04), go(there + up, 6)
    noise = lambda a: a + rng.normal(0, 0.0002, a.shape)
    return noise(hand), noise(cubes), finger


def write(path):
    rng = np.random.default_rng(1)
    kinds = [demonstration(rng) for _ in range(20)]
    with h5py.File(path, "w") as file:
        for n in range(COUNT):
            hand, cubes, finger = kinds[n % len(kinds)]
            moved = rng.uniform(-0.1, 0.1, 3) * [1, 1, 0]
            g = file.create_group("data/demo_%d" % n)
            g.attrs["success"] = np.bool_(True)
            g["actions"] = np.zeros((FRAMES, 7), "f4")
            g["obs/eef_pos"] = (hand + moved).astype("f4")
            g["obs/eef_quat"] = np.tile(np.array([1, 0, 0, 0], "f4"), (FRAMES, 1))
            g["obs/gripper_pos"] = np.stack([finger, -finger], 1).astype("f4")
            for i in range(3):
                q = np.tile([1.0, 0, 0, 0], (FRAMES, 1))
                g["states/rigid_object/cube_%d/root_pose" % (i + 1)] = np.hstack([cubes[:, i] + moved, q]).astype("f4")


def cpu_s(*words):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = subprocess.run([PREHEND, *words], capture_output=True, text=True, check=False)
    assert run.returncode == 0, (words, run.returncode, run.stdout[-500:], run.stderr[-500:])
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    with tempfile.TemporaryDirectory() as made:
        folder = (sys.argv[3:] or [made])[0]
        path = lambda name: os.path.join(folder, name)
        write(path("many.hdf5"))
        with open(path("many.yaml"), "w", encoding="utf-8") as out:
            out.write(MAP)
        if os.path.exists(path("many.episodes")):
            os.remove(path("many.episodes"))
        spent = {"import": cpu_s("import", path("many.hdf5"), "--map", path("many.yaml"), "-o", path("many.episodes")),
                 "judge": cpu_s("episode", "resegment", path("many.episodes"), "--json"),
                 "label": cpu_s("episode", "label", path("many.episodes"), "--map", path("many.yaml"), "-o", path("out.hdf5")),
                 "report": cpu_s("report", path("many.episodes"), "-o", path("many.html"))}
        print(", ".join("%s %.2f s" % one for one in spent.items()) +
              "; report is %.1f times judging" % (spent["report"] / spent["judge"]))
        total = spent["import"] + spent["judge"] + spent["label"]
        assert total <= LIMIT_S * max(1, COUNT / 1000), total


if __name__ == "__main__":
    main()
