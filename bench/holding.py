#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The bench of holding. Does a hand that holds a thing still hold it still, and does it set it down and let go cleanly?

    python3 bench/holding.py PREHEND [--only SUBSTRING] [--every N] [--seconds 60] [--json FILE] [--keep FOLDER]

32 things, each taken with every grasp style that fits it, are held for a minute: on the table, and 15 cm above it; these
are then carried 20 cm, put down and let go. One line per case, then a summary. Of each case:

    gained    mm, on the table: how far the lowest corner is above where it stood, from 0.25 s after the grip has closed
    shifted   mm, on the table: way of its centre along the table in the same time
    invented  events, on the table: everything but one reach, one grasp, one support and their contacts
    turned    degrees, in the air: largest rotation of the thing in the hand after the first second of the hold
    crept     mm, in the air: the same for the way of its centre in the hand
    landed    degrees: tilt of the thing against how it stood, at the first touch with the table
    pushed    mm: way of the corner that touches first, from the landing to the end of the grasp

Tested by itself: it measures. Its table is in docs/physics.md.
"""
import argparse, json, math, os, subprocess, sys, tempfile

# name: (shape, mass_kg, further keys, [(hand, style, from, point_m)]); sizes in metres.
H, G = "human_right", "gripper"


def box(x, y, z):
    return f"box: {{size_m: [{x}, {y}, {z}]}}", (x, y, z)


def can(r, h):
    return f"cylinder: {{radius_m: {r}, length_m: {h}}}", (2 * r, 2 * r, h)


def ball(r):
    return f"sphere: {{radius_m: {r}}}", (2 * r, 2 * r, 2 * r)


def mug(r, h):
    return f"mug: {{radius_m: {r}, height_m: {h}}}", (2 * r, 2 * r, h)


WRAP = [(H, "wrap", "side"), (H, "wrap", "above")]
TIPS = [(H, "pinch", "above"), (H, "tripod", "above")]
THINGS = {
    "carton": (box(0.07, 0.07, 0.20), 0.4, WRAP),
    "full_carton": (box(0.07, 0.07, 0.20), 1.05, WRAP),
    "tall_box": (box(0.06, 0.06, 0.14), 1.0, WRAP),
    "tall_box_light": (box(0.06, 0.06, 0.14), 0.1, WRAP + TIPS),
    "tall_box_1500": (box(0.06, 0.06, 0.14), 1.5, [(H, "wrap", "side")]),
    "tall_box_300": (box(0.06, 0.06, 0.14), 0.3, WRAP + TIPS + [(G, "parallel", "above")]),
    "cube_6": (box(0.06, 0.06, 0.06), 0.3, [(H, "wrap", "above")] + TIPS + [(G, "parallel", "above")]),
    "cube_5": (box(0.05, 0.05, 0.05), 0.15, [(H, "wrap", "above")] + TIPS),
    "block": (box(0.12, 0.05, 0.06), 0.5, [(H, "wrap", "above"), (H, "pinch", "above"), (G, "parallel", "above")]),
    "block_heavy": (box(0.12, 0.05, 0.06), 1.0, [(H, "wrap", "above")]),
    "cereal": (box(0.19, 0.06, 0.28), 0.5, [(H, "wrap", "side")]),
    "brick": (box(0.10, 0.07, 0.20), 3.0, [(H, "wrap", "side")]),
    "two_kilograms": (box(0.07, 0.07, 0.18), 2.0, WRAP),
    "can": (can(0.033, 0.12), 0.35, WRAP + [(G, "parallel", "above")]),
    "full_can": (can(0.037, 0.11), 0.8, WRAP),
    "light_can": (can(0.033, 0.12), 0.05, WRAP),
    "jar": (can(0.038, 0.10), 0.6, WRAP),
    "bottle": (can(0.035, 0.24), 1.1, [(H, "wrap", "side")]),
    "peg": (can(0.021, 0.12), 0.15, TIPS + [(G, "parallel", "above")]),
    "rod": (can(0.02, 0.15), 0.2, TIPS),
    "ball_7": (ball(0.035), 0.2, [(H, "wrap", "above"), (H, "tripod", "above"), (H, "precision_sphere", "above")]),
    "ball_6": (ball(0.031), 0.1, [(H, "wrap", "above"), (H, "precision_sphere", "above")]),
    "heavy_ball": (ball(0.036), 0.7, [(H, "wrap", "above"), (H, "precision_sphere", "above")]),
    "mug": (mug(0.04, 0.10), 0.3, [(H, "wrap", "side")]),
    "full_mug": (mug(0.04, 0.10), 0.6, [(H, "wrap", "side")]),
    "tall_mug": (mug(0.036, 0.13), 0.4, WRAP),
    "book": (box(0.14, 0.03, 0.20), 0.4, [(H, "prismatic_four_finger", "side"), (G, "parallel", "above")]),
    "slab": (box(0.08, 0.012, 0.12), 0.2, [(H, "lateral", "above")]),
    "heavy_slab": (box(0.08, 0.012, 0.12), 0.35, [(H, "lateral", "above")]),
    "notebook": (box(0.10, 0.018, 0.15), 0.25, [(H, "lateral", "above"), (G, "parallel_narrow", "above")]),
    "light_plate": (can(0.12, 0.016), 0.15, [(H, "lateral", "side", [0, -0.11, 0])]),
    "small_plate": (can(0.09, 0.012), 0.1, [(H, "lateral", "side", [0, -0.082, 0])]),
}

X, Y, TABLE_M = 0.2, 0.05, 0.76


def scenario(name, thing, grasp, where, seconds):
    (shape, size), mass, _ = thing
    hand, style, way = grasp[:3]
    at = "[-0.2, -0.1, 1.05]"
    turned = ", rpy_deg: [0, 90, 0]" if hand == G else ""
    plate = len(grasp) > 3
    point = f", point_m: {grasp[3]}" if plate else ""
    if plate:
        at, turned = "[0.2, -0.45, 0.95]", ", rpy_deg: [90, 0, 90]"
    rolls = ", rolling_friction: 0.006" if shape.startswith("sphere") else ""
    lines = [
        f"scenario: {name}", f"shows: a hand holds a thing still", "grammar: pick_and_place",
        "world: {sensing_hz: 60}", "entities:",
        "  table: {class: Table, fixed: true, box: {size_m: [1.2, 1.2, 0.04]}, at_m: [0, 0, 0.74]}"]
    on = "table"
    if plate:
        lines.append(f"  stand: {{class: Stand, fixed: true, cylinder: {{radius_m: 0.03, length_m: 0.12}}, at_m: [{X}, {Y}, 0.82]}}")
        on = "stand"
    lines.append(f"  thing: {{class: Box, {shape}, mass_kg: {mass}, friction: 0.8{rolls}, on: {on}, at_m: [{X}, {Y}]}}")
    lines += ["actors:", f"  right_hand: {{hand: {hand}, at_m: {at}{turned}}}", "script:",
              f"  - right_hand: {{reach: thing, style: {style}, from: {way}{point}, over_s: 1.0}}",
              "  - right_hand: {close_to: 1}"]
    if where == "table":
        lines += [f"  - right_hand: {{wait_s: {seconds}}}"]
    else:
        lines += ["  - right_hand: {lift_by_m: 0.15}", f"  - right_hand: {{wait_s: {seconds}}}"]
        if not plate:
            lines += [f"  - right_hand: {{carry_to_m: [{X}, {Y - 0.2:g}]}}"]
        lines += [f"  - right_hand: {{place_on: {on}, over_s: 1.0}}"]
    lines += ["  - right_hand: {open_to: 0, over_s: 0.4}", "  - right_hand: {retreat_by_m: 0.15}"]
    return "\n".join(lines) + "\n"


def conj(q):
    return (q[0], -q[1], -q[2], -q[3])


def mul(a, b):
    return (a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
            a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
            a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0])


def rotate(q, v):
    w, x, y, z = mul(mul(q, (0, *v)), conj(q))
    return (x, y, z)


def angle_deg(q):
    return math.degrees(2 * math.atan2(math.sqrt(q[1] ** 2 + q[2] ** 2 + q[3] ** 2), abs(q[0])))


def corners(shape, size):
    """Points of the lower and upper rims, in the thing's frame."""
    x, y, z = (s / 2 for s in size)
    if shape.startswith("sphere"):
        return [(0, 0, 0)]
    if shape.startswith("box"):
        return [(i * x, j * y, k * z) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
    turn = [2 * math.pi * i / 64 for i in range(64)]
    return [(x * math.cos(a), x * math.sin(a), k * z) for a in turn for k in (-1, 1)]


class Take:
    """One run: poses of thing and hand by time, the frames in which the thing touches a support, and events."""

    def __init__(self, prehend, path):
        # A run is deterministic, so its events and its frames may come from two calls.
        run = subprocess.run([prehend, "run", path, "--json", "--record", path + ".jsonl", "--memory-limit-mb", "0"],
                             capture_output=True, text=True)
        try:
            self.result = json.loads(run.stdout)
        except ValueError:
            raise SystemExit(f"{path}: {run.stdout[:300]} {run.stderr[:600]}")
        self.times, self.thing, self.hand, self.touch = [], [], [], []
        rate, thing, hand = 480, None, None
        with open(path + ".jsonl") as lines:
            for line in lines:
                # Cheaper than all of the frame's JSON: the hand's surface is most of it.
                head, _, rest = line.partition('"hands":')
                if not head.startswith('{"tick"'):
                    continue
                frame = json.loads(head.rstrip(",") + "}")
                at = frame["samples"]
                thing, hand = at.get("thing", thing), at.get("right_hand", hand)
                touches = line[line.rfind('"touches":'):]
                self.times.append(frame["tick"] / rate)
                self.thing.append((thing["at_m"], thing["quat_wxyz"]))
                self.hand.append((hand["at_m"], hand["quat_wxyz"]))
                self.touch.append('"a":"table","b":"thing"' in touches or '"a":"stand","b":"thing"' in touches)
        os.remove(path + ".jsonl")

    def events(self, name):
        return [e for e in self.result["events"] if e["event"] == name]

    def index(self, t):
        for i, at in enumerate(self.times):
            if at >= t:
                return i
        return len(self.times) - 1


def lowest(points, pose):
    p, q = pose
    return min(rotate(q, c)[2] for c in points) + p[2]


def relative(hand, thing):
    (hp, hq), (tp, tq) = hand, thing
    return rotate(conj(hq), [tp[i] - hp[i] for i in range(3)]), mul(conj(hq), tq)


def measure(take, thing, where, seconds):
    (shape, size), _, _ = thing
    points = corners(shape, size)
    if shape.startswith("sphere"):
        points = [(0, 0, 0)]
    out = {}
    closed = 1.0 + 0.6
    allowed = {"reaching", "fixation", "grasping", "contact", "supported_by", "touching"}
    if where == "table":
        a, b = take.index(closed + 0.25), take.index(closed + seconds)
        stood = lowest(points, take.thing[0])
        out["gained"] = 1000 * max(lowest(points, p) - stood for p in take.thing[a:b:4])
        out["shifted"] = 1000 * max(math.dist(p[0][:2], take.thing[a][0][:2]) for p in take.thing[a:b:4])
        odd = [e["event"] for e in take.result["events"] if e["event"] not in allowed]
        supports = len(take.events("supported_by"))
        out["invented"] = len(odd) + max(supports - 1, 0)
        out["odd"] = sorted(set(odd)) + ([f"{supports} supports"] if supports > 1 else [])
        out["held"] = len(take.events("grasping")) == 1
        return out
    begin = closed + 0.6 + 1.0
    a, b = take.index(begin), take.index(closed + 0.6 + seconds)
    p0, q0 = relative(take.hand[a], take.thing[a])
    turned = crept = 0
    for i in range(a, b, 4):
        p, q = relative(take.hand[i], take.thing[i])
        turned = max(turned, angle_deg(mul(conj(q0), q)))
        crept = max(crept, math.dist(p, p0))
    out["turned"], out["crept"] = turned, 1000 * crept
    drop = next((i for i in range(a, b) if take.touch[i]), None)
    out["dropped"] = drop is not None or any(math.dist(take.thing[i][0], take.hand[i][0]) > 0.4 for i in (a, b))
    if out["dropped"] or shape.startswith("sphere"):
        return out
    land = next((i for i in range(b, len(take.times)) if take.touch[i]), None)
    if land is None:
        out["dropped"] = True
        return out
    up = rotate(take.thing[land][1], (0, 0, 1))
    out["landed"] = math.degrees(math.acos(min(1, up[2])))
    grasps = [e for e in take.events("grasping") if e["begin_s"] < take.times[land]]
    end = take.index(grasps[-1]["end_s"]) if grasps else land
    corner = min(points, key=lambda c: rotate(take.thing[land][1], c)[2])

    def corner_at(i):
        p, q = take.thing[i]
        r = rotate(q, corner)
        return [p[k] + r[k] for k in range(3)]

    out["pushed"] = 1000 * max(math.dist(corner_at(i)[:2], corner_at(land)[:2]) for i in range(land, max(end, land) + 1))
    rest = len(take.times) - 1
    out["stands"] = math.degrees(math.acos(min(1, rotate(take.thing[rest][1], (0, 0, 1))[2]))) < 1
    out["slides"] = len(take.events("sliding"))
    return out


def percentile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))] if values else float("nan")


def summary(rows):
    table, air = [r for r in rows if r["where"] == "table"], [r for r in rows if r["where"] == "air"]
    held = [r for r in air if not r["dropped"]]
    down = [r for r in held if "landed" in r]

    def line(what, values, unit, limit):
        over = sum(v > limit for v in values)
        print(f"{what:34} median {percentile(values, 0.5):7.2f}  90 % {percentile(values, 0.9):7.2f}  "
              f"most {max(values, default=0):7.2f} {unit:4} above {limit:g}: {over} of {len(values)}")

    line("on the table: clearance gained", [r["gained"] for r in table], "mm", 0.05)
    line("on the table: way along it", [r["shifted"] for r in table], "mm", 1)
    print(f"{'on the table: holds with invented events':42} {sum(r['invented'] > 0 for r in table)} of {len(table)}")
    line("in the air: turned in the hand", [r["turned"] for r in held], "deg", 1)
    line("in the air: way in the hand", [r["crept"] for r in held], "mm", 1)
    line("tilt at landing", [r["landed"] for r in down], "deg", 3)
    line("way until the end of the grasp", [r["pushed"] for r in down], "mm", 3)
    print(f"dropped {len(air) - len(held)} of {len(air)}; sliding after {sum(r['slides'] > 0 for r in down)}, "
          f"not upright in the end {sum(not r['stands'] for r in down)} of {len(down)} put-downs")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("prehend")
    parser.add_argument("--only", default="", help="cases whose name contains this; several with commas")
    parser.add_argument("--every", type=int, default=1, help="only every N-th case")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--json", help="write the figures here, too")
    parser.add_argument("--keep", help="write the scenarios here and keep them")
    options = parser.parse_args()
    folder = options.keep or tempfile.mkdtemp()
    os.makedirs(folder, exist_ok=True)
    cases = []
    for name, thing in THINGS.items():
        for grasp in thing[2]:
            for where in ("table", "air"):
                if where == "table" and len(grasp) > 3:
                    continue  # A plate is taken from a stand.
                cases.append((f"{name}_{grasp[1]}_{grasp[2]}_{where}", thing, grasp, where))
    only = [o for o in options.only.split(",") if o]
    cases = [c for c in cases if not only or any(o in c[0] for o in only)][::options.every]
    rows = []
    for name, thing, grasp, where in cases:
        path = os.path.join(folder, name + ".yaml")
        with open(path, "w") as file:
            file.write(scenario(name, thing, grasp, where, options.seconds))
        take = Take(os.path.abspath(options.prehend), path)
        row = {"name": name, "where": where, **measure(take, thing, where, options.seconds)}
        rows.append(row)
        print("  ".join([f"{name:44}"] + [f"{k} {v:.3f}" if isinstance(v, float) else f"{k} {v}"
                                          for k, v in row.items() if k not in ("name", "where")]), flush=True)
        if not options.keep:
            os.remove(path)
    summary(rows)
    if options.json:
        with open(options.json, "w") as file:
            json.dump(rows, file, indent=1)


if __name__ == "__main__":
    main()
