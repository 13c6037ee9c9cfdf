# SPDX-License-Identifier: Apache-2.0
"""Files of robot demonstrations as simulators write them, made of simulated episodes of prehend, so that all is known.

    /usr/bin/python3 tests/program/made_demonstrations.py build/test/prehend FOLDER

writes isaac_raw.hdf5, isaac_annotated.hdf5, mimicgen.hdf5, robosuite.hdf5, libero.hdf5 and maniskill.hdf5 with a map each.
A hand and a carton are there as `gripper` and `cube_1`; `cube_2` rests.
"""
import json
import math
import os
import subprocess
import sys

import h5py
import numpy as np

RATE_HZ = 20
SCENARIOS = ("milk_carton_wrap", "grasp/grasp_ends_with_the_release", "grasp/regrasp_after_a_lost_touch_is_a_second_reach",
             "grasp/short_grasp_counts")
OPEN_M = 0.04  # of each finger


def quaternion_product(a, b):
    w, x, y, z = a[..., 0], a[..., 1], a[..., 2], a[..., 3]
    W, X, Y, Z = b[..., 0], b[..., 1], b[..., 2], b[..., 3]
    return np.stack([w * W - x * X - y * Y - z * Z, w * X + x * W + y * Z - z * Y, w * Y - x * Z + y * W + z * X,
                     w * Z + x * Y - y * X + z * W], axis=-1)


def matrices(poses):
    """(N,7), wxyz -> (N,4,4)"""
    w, x, y, z = poses[:, 3:].T / np.linalg.norm(poses[:, 3:], axis=1)
    m = np.zeros((len(poses), 4, 4))
    m[:, 0, :3] = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)], -1)
    m[:, 1, :3] = np.stack([2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)], -1)
    m[:, 2, :3] = np.stack([2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)], -1)
    m[:, :3, 3], m[:, 3, 3] = poses[:, :3], 1
    return m


def axis_angles(poses):
    q = np.where(poses[:, 3:4] < 0, -poses[:, 3:], poses[:, 3:])
    s = np.linalg.norm(q[:, 1:], axis=1, keepdims=True)
    return np.where(s < 1e-12, 2, 2 * np.arctan2(s, q[:, :1]) / np.maximum(s, 1e-12)) * q[:, 1:]


def xyzw(poses):
    return poses[:, [0, 1, 2, 4, 5, 6, 3]]


def recorded(prehend, scenario):
    """The poses of the carton and the hand, and how far the hand is open, at 20 Hz."""
    text = subprocess.run([prehend, "run", scenario, "--record", "-"], capture_output=True, text=True, check=True).stdout
    lines = [json.loads(line) for line in text.splitlines()]
    ticks = lines[0]["ticks_per_second"]
    at, trigger, k, rows = {}, 0, 0, []
    for line in lines[1:]:
        if "tick" not in line:
            break
        while line["tick"] > k * ticks / RATE_HZ + 1e-9 and at:
            rows.append(at["milk"] + at["right_hand"] + [OPEN_M * (1 - trigger)])
            k += 1
        for name, sample in line["samples"].items():
            at[name] = sample["at_m"] + sample.get("quat_wxyz", at.get(name, [0] * 3 + [1, 0, 0, 0])[3:])
        trigger = line.get("hands", {}).get("right_hand", {}).get("trigger", trigger)
    return np.array(rows)


class Demonstration:
    """One more state than actions: `poses` of each body, (N+1,7)."""

    def __init__(self, rows, turn, dx, begin):
        rows = rows[begin:]
        yaw = np.array([math.cos(turn / 2), 0, 0, math.sin(turn / 2)])
        c, s = math.cos(turn), math.sin(turn)
        z = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])

        def moved(poses):
            return np.hstack([poses[:, :3] @ z.T + [dx, 0, 0], quaternion_product(yaw[None], poses[:, 3:])])
        self.poses = {"cube_1": moved(rows[:, :7]), "gripper": moved(rows[:, 7:14])}
        self.poses["cube_2"] = np.tile([dx - 0.3, 0.25, 0.81, 1, 0, 0, 0], (len(rows), 1))
        self.fingers = np.stack([rows[:, 14], -rows[:, 14]], axis=1)
        self.n = len(rows) - 1
        self.success = bool(rows[-1, 14] > 0.02)


def demonstrations(prehend, count=20):
    made = [recorded(prehend, scenario) for scenario in SCENARIOS]
    return [Demonstration(made[i % len(made)], 0.1 * (i % 5), 0.02 * (i % 7), i % 4) for i in range(count)]


def f4(values):
    return np.asarray(values, dtype="f4")


def head(file, demos, env_args):
    data = file.create_group("data")
    data.attrs["env_args"] = json.dumps(env_args)
    data.attrs["total"] = sum(d.n for d in demos)
    for i, d in enumerate(demos):
        g = data.create_group("demo_%d" % i)
        g.attrs["num_samples"], g.attrs["success"] = d.n, np.bool_(d.success)
        g["actions"] = f4(np.hstack([np.zeros((d.n, 6)), np.where(d.fingers[1:, :1] > 0.02, 1, -1)]))
        yield g, d


def isaac(path, demos, annotated=False, order=lambda p: p):
    """Isaac Lab 2.0.1: states after the action, obs before it; obs/cube_positions count from the world's origin."""
    with h5py.File(path, "w") as file:
        for i, (g, d) in enumerate(head(file, demos, {"env_name": "Isaac-Stack-Cube-Franka-IK-Rel-v0", "type": 2})):
            origin = np.array([2.5 * (i % 2), -2.5 * (i % 3 == 0), 0])
            hand = order(d.poses["gripper"])
            g["obs/eef_pos"], g["obs/eef_quat"] = f4(hand[:-1, :3]), f4(hand[:-1, 3:])
            g["obs/gripper_pos"] = f4(d.fingers[:-1])
            cubes = [order(d.poses[name]) for name in ("cube_1", "cube_2")]
            g["obs/cube_positions"] = f4(np.hstack([c[:-1, :3] + origin for c in cubes]))
            g["obs/cube_orientations"] = f4(np.hstack([c[:-1, 3:] for c in cubes]))
            for name, c in zip(("cube_1", "cube_2"), cubes):
                g["states/rigid_object/%s/root_pose" % name] = f4(c[1:])
                g["states/rigid_object/%s/root_velocity" % name] = f4(np.zeros((d.n, 6)))
                g["initial_state/rigid_object/%s/root_pose" % name] = f4(c[:1])
            g["states/articulation/robot/joint_position"] = f4(np.hstack([np.zeros((d.n, 7)), d.fingers[1:]]))
            if annotated:
                info = g.create_group("obs/datagen_info")
                info["eef_pose/franka"] = f4(matrices(d.poses["gripper"][:-1]))
                for name in ("cube_1", "cube_2"):
                    info["object_pose/" + name] = f4(matrices(d.poses[name][:-1]))
                info["subtask_term_signals/grasp_1"] = d.fingers[:-1, 0] < 0.02


def mimicgen(path, demos, env_args=None):
    with h5py.File(path, "w") as file:
        args = {"env_name": "Stack_D0", "type": 1, "env_kwargs": {"control_freq": RATE_HZ}} if env_args is None else env_args
        for g, d in head(file, demos, args):
            info = g.create_group("datagen_info")
            info["eef_pose"] = matrices(d.poses["gripper"][:-1])
            for name in ("cube_1", "cube_2"):
                info["object_poses/" + name] = matrices(d.poses[name][:-1])
            info["subtask_term_signals/grasp"] = (d.fingers[:-1, 0] < 0.02).astype("i8")
            info["gripper_action"] = np.where(d.fingers[1:, :1] > 0.02, -1.0, 1.0)
            g["states"] = np.hstack([np.arange(d.n)[:, None] / RATE_HZ, np.zeros((d.n, 40))])
            for name, values in (("robot0_gripper_qpos", d.fingers[:-1]), ("robot0_eef_pos", d.poses["gripper"][:-1, :3])):
                g.create_dataset("obs/" + name, data=values, compression="gzip")


def robosuite(path, demos):
    with h5py.File(path, "w") as file:
        for g, d in head(file, demos, {"env_name": "Stack", "type": 1, "env_kwargs": {"control_freq": RATE_HZ}}):
            hand = xyzw(d.poses["gripper"])[:-1]
            cubes = [xyzw(d.poses[name])[:-1] for name in ("cube_1", "cube_2")]
            for name, values in (("robot0_eef_pos", hand[:, :3]), ("robot0_eef_quat", hand[:, 3:]),
                                 ("robot0_gripper_qpos", d.fingers[:-1]),
                                 ("object", np.hstack([*cubes, cubes[0][:, :3] - hand[:, :3]]))):
                g.create_dataset("obs/" + name, data=values, compression="gzip", shuffle=True)


def libero(path, demos):
    with h5py.File(path, "w") as file:
        for g, d in head(file, demos, {"env_name": "Libero_Kitchen", "type": 1, "env_kwargs": {"control_freq": RATE_HZ}}):
            hand = d.poses["gripper"]
            g["obs/ee_pos"], g["obs/ee_ori"] = hand[1:, :3], axis_angles(hand)[1:]
            g["obs/gripper_states"] = d.fingers[1:]
            for name in ("cube_1", "cube_2"):
                g["obs/%s_pos" % name] = d.poses[name][1:, :3]
                g["obs/%s_quat" % name] = xyzw(d.poses[name])[1:, 3:]
            g.attrs["problem_info"] = json.dumps({"language_instruction": "move the carton"})


def maniskill(path, demos):
    with h5py.File(path, "w") as file:
        for i, d in enumerate(demos):
            g = file.create_group("traj_%d" % i)
            g["actions"] = f4(np.hstack([np.zeros((d.n, 6)), d.fingers[1:, :1]]))
            for name in ("cube_1", "cube_2"):
                g["env_states/actors/" + name] = f4(np.hstack([d.poses[name], np.zeros((d.n + 1, 6))]))
            g["obs/extra/tcp_pose"] = f4(d.poses["gripper"])
            g["env_states/articulations/panda"] = f4(np.hstack([np.zeros((d.n + 1, 20)), np.abs(d.fingers), np.zeros((d.n + 1, 9))]))
            g["obs/agent/qpos"] = f4(np.hstack([np.zeros((d.n + 1, 7)), np.abs(d.fingers)]))
            g["success"] = np.arange(d.n) >= (d.n - 3 if d.success else d.n)
    with open(path.replace(".h5", ".json").replace(".hdf5", ".json"), "w") as out:
        json.dump({"env_info": {"env_id": "StackCube-v1"}, "episodes": [{"episode_id": i} for i in range(len(demos))]}, out)


MAP = """import: 1
unit: m
axes: z_up
%s
grammar: pick_and_place_from_motion
entities:
  table: {at_m: [0, 0, 0.74], fixed: true, class: Table, size_m: [2.4, 2, 0.04]}
  cube_1: {%s, class: Carton, size_m: [0.07, 0.07, 0.2]}
  cube_2: {%s, class: Cube, size_m: [0.1, 0.1, 0.1]}
  gripper: {%s, hand: true, size_m: [0.09, 0.084, 0.025],
            grip: {from: %s, open: 0.08, closed: 0}}
"""


def map_of(head_lines, cube, gripper, grip):
    """`cube`: what stands for a cube, with its name and its number from 0."""
    return MAP % (head_lines, cube(1), cube(2), gripper, grip)


ISAAC = 'rate_hz: 20\nhdf5: {episodes: "data/*", success: "@success"}'
MAPS = {
    "isaac_raw": map_of(
        ISAAC + "\nquaternion_order: wxyz",
        lambda i: "pose: states/rigid_object/cube_%d/root_pose, first: initial_state/rigid_object/cube_%d/root_pose, shift: 1" % (i, i),
        "position: obs/eef_pos, quaternion: obs/eef_quat", "obs/gripper_pos, sum_abs: true"),
    "isaac_annotated": map_of(ISAAC, lambda i: "pose: obs/datagen_info/object_pose/cube_%d" % i,
                              "pose: obs/datagen_info/eef_pose/franka", "obs/gripper_pos, sum_abs: true"),
    "mimicgen": map_of('hdf5: {success: "@success"}', lambda i: "pose: datagen_info/object_poses/cube_%d" % i,
                       "pose: datagen_info/eef_pose", "obs/robot0_gripper_qpos, sum_abs: true"),
    "robosuite": map_of('hdf5: {success: "@success"}\nquaternion_order: xyzw', lambda i: 'pose: "obs/object[%d:%d]"' % (7 * i - 7, 7 * i),
                        "position: obs/robot0_eef_pos, quaternion: obs/robot0_eef_quat",
                        "obs/robot0_gripper_qpos, sum_abs: true"),
    "libero": map_of('hdf5: {success: "@success", language: "@problem_info"}\nquaternion_order: xyzw',
                     lambda i: "position: obs/cube_%d_pos, quaternion: obs/cube_%d_quat" % (i, i),
                     "position: obs/ee_pos, axis_angle: obs/ee_ori", "obs/gripper_states, sum_abs: true"),
    "maniskill": map_of('rate_hz: 20\nhdf5: {episodes: "traj_*", success: success}\nquaternion_order: wxyz',
                        lambda i: 'pose: "env_states/actors/cube_%d[0:7]"' % i, "pose: obs/extra/tcp_pose",
                        '"obs/agent/qpos[7:9]"'),
}
WRITERS = {"isaac_raw": isaac, "isaac_annotated": lambda path, demos: isaac(path, demos, True), "mimicgen": mimicgen,
           "robosuite": robosuite, "libero": libero, "maniskill": maniskill}


def write_all(folder, demos):
    for name, write in WRITERS.items():
        write(os.path.join(folder, name + ".hdf5"), demos)
        with open(os.path.join(folder, name + ".yaml"), "w") as out:
            out.write(MAPS[name])


if __name__ == "__main__":
    write_all(sys.argv[2], demonstrations(sys.argv[1]))
