# SPDX-License-Identifier: Apache-2.0
"""Takes that nobody recorded, each a file of poses and its map: people hand things over, fill shelves and boxes, work at tables
and in mid-air. Either the map is right, or one thing is wrong with it or with the file. Everything is drawn from a seed.
"""
import math
import random

from made_takes import add, conjugate, length, multiply, rotate, smooth, turn

KINDS = ("table", "shelf", "box", "handover", "midair", "small")
UNITS = {"m": 1.0, "cm": 100.0, "mm": 1000.0}
IDENTITY = [1.0, 0.0, 0.0, 0.0]
# Where x, y and z of the recording stand in a file whose axis is up.
AXES = {"x_up": lambda p: [p[2], p[0], p[1]], "y_up": lambda p: [p[0], p[2], -p[1]], "z_up": lambda p: list(p)}


class Scene:
    """Poses of bodies, frame by frame: metres, z up."""

    def __init__(self, rng, kind):
        self.rng, self.kind = rng, kind
        self.hz = rng.choice((25, 30, 50, 60, 100, 120))
        self.bodies, self.sizes, self.hands, self.places, self.frames = {}, {}, [], {}, []
        self.reach_m = rng.uniform(0.05, 0.15)
        getattr(self, kind)()

    def body(self, name, p, size, yaw=0.0):
        self.bodies[name], self.sizes[name] = [list(p), turn([0, 0, 1], yaw)], size

    def hand(self, name, p, yaw=90.0):
        self.body(name, p, (0.1, 0.09, 0.04), yaw)
        self.hands.append(name)

    def surface(self, name, x, y, top, size):
        self.places[name] = ((x, y, top - 0.02), (*size, 0.04))

    def run(self, seconds, moves):
        """moves: by hand (to, yaw, lift); each with what it holds."""
        start = {h: (list(self.bodies[h][0]), list(self.bodies[h][1])) for h in moves}
        held = {}
        for hand, (_, _, _, thing) in moves.items():
            if thing:
                p, q = self.bodies[hand]
                held[hand] = (rotate(conjugate(q), add(self.bodies[thing][0], p, -1)), multiply(conjugate(q), self.bodies[thing][1]))
        frames = max(2, round(seconds * self.hz))
        bend = self.rng.uniform(-0.05, 0.05)
        for i in range(1, frames + 1):
            s = smooth(i / frames)
            for hand, (to, yaw, lift, thing) in moves.items():
                p, q = start[hand]
                at = add(p, add(to, p, -1), s)
                arc = math.sin(math.pi * s)
                self.bodies[hand][0] = add(at, [bend * arc, bend * arc, lift * arc])
                self.bodies[hand][1] = multiply(turn([0, 0, 1], yaw * s), q)
                if thing:
                    body = self.bodies[hand]
                    self.bodies[thing] = [add(body[0], rotate(body[1], held[hand][0])), multiply(body[1], held[hand][1])]
            self.frames.append({n: (list(p), list(q)) for n, (p, q) in self.bodies.items()})

    def pause(self, least=0.2, most=1.0):
        self.run(self.rng.uniform(least, most), {})

    def seconds(self, hand, to):
        return (0.4 + length(add(to, self.bodies[hand][0], -1))) / self.rng.uniform(0.7, 1.4)

    def go(self, hand, to, yaw=0.0, lift=0.0, thing=None):
        self.run(self.seconds(hand, to), {hand: (to, yaw, lift, thing)})

    def place(self, hand, thing, to, lift):
        """Fetches a thing, sets it down with its centre here, and leaves."""
        rng, home = self.rng, list(self.bodies[hand][0])
        grip = [rng.uniform(-0.02, 0.02), -self.reach_m, rng.uniform(0, 0.05)]
        self.go(hand, add(self.bodies[thing][0], grip), rng.uniform(-30, 30))
        self.pause(0.1, 0.3)
        offset = add(self.bodies[hand][0], self.bodies[thing][0], -1)
        yaw = rng.uniform(-70, 70)
        self.go(hand, add(to, rotate(turn([0, 0, 1], yaw), offset)), yaw, lift, thing)
        self.pause(0.1, 0.3)
        self.go(hand, home, -yaw)
        self.pause()

    def stuff(self, count, top, width=0.8, depth=0.25):
        """Things that stand on a level, apart from each other."""
        for i in range(count):
            size = tuple(self.rng.uniform(0.05, 0.12) for _ in range(2)) + (self.rng.uniform(0.06, 0.24),)
            x = self.x + (i + 0.5) / count * width - width / 2
            self.body("thing%d" % i, (x, self.y + self.rng.uniform(-depth, depth), top + size[2] / 2), size,
                      self.rng.uniform(-30, 30))

    def origin(self):
        self.x, self.y = (self.rng.uniform(-4, 4) for _ in range(2))
        self.level = self.rng.choice((0.0, self.rng.uniform(0.65, 0.95)))

    def at_table(self, spare=0.0):
        rng = self.rng
        self.origin()
        self.surface("table", self.x, self.y, self.level, (1.4, 0.9))
        self.stuff(rng.randint(2, 5), self.level)
        self.hand("right_hand", (self.x + 0.25, self.y - 0.5, self.level + 0.1))
        if rng.random() < 0.6:
            self.hand("left_hand", (self.x - 0.25, self.y - 0.5, self.level + 0.1))
        self.pause(0.5, 1.5)

    def free(self, thing, top, x, y):
        """A place for it on this level, near this one."""
        for _ in range(200):
            at = (x + self.rng.uniform(-0.33, 0.33), y + self.rng.uniform(-0.25, 0.25), top + self.sizes[thing][2] / 2)
            if all(n == thing or n in self.hands or length(add(at[:2], p[:2], -1)) > 0.16 for n, (p, _) in self.bodies.items()):
                break
        return at

    def table(self):
        self.at_table()
        things = [n for n in self.bodies if n not in self.hands]
        for _ in range(self.rng.randint(3, 6)):
            thing = self.rng.choice(things)
            self.place(self.rng.choice(self.hands), thing, self.free(thing, self.level, self.x, self.y), self.rng.uniform(0.06, 0.3))

    def shelf(self):
        self.at_table()
        up = self.rng.uniform(0.08, 0.5)
        self.surface("shelf", self.x + 1.1, self.y, self.level + up, (0.7, 0.9))
        things = [n for n in self.bodies if n not in self.hands]
        for thing in things:
            self.place(self.rng.choice(self.hands), thing, self.free(thing, self.level + up, self.x + 1.1, self.y), self.rng.uniform(0.1, 0.25))

    def box(self):
        self.at_table()
        at = (self.x + 0.95, self.y, self.level - 0.1)
        self.body("box", at, (0.45, 0.6, 0.3))
        for frame in self.frames:
            frame["box"] = (list(at), list(IDENTITY))
        self.surface("stool", self.x + 0.95, self.y, self.level - 0.25, (0.5, 0.7))
        for i, thing in enumerate([n for n in self.bodies if n not in self.hands and n != "box"]):
            inside = (at[0] + self.rng.uniform(-0.1, 0.1), at[1] - 0.2 + 0.1 * i, at[2] - 0.14 + self.sizes[thing][2] / 2)
            self.place(self.rng.choice(self.hands), thing, inside, self.rng.uniform(0.35, 0.5))

    def handover(self):
        """From one person to another, who keeps it or gives it back; it may stand on a table first."""
        rng = self.rng
        self.origin()
        high = self.level + rng.uniform(0.2, 0.5) if rng.random() < 0.4 else None
        size = (0.08, 0.08, rng.uniform(0.08, 0.2))
        begin = (self.x, self.y, (self.level + size[2] / 2) if high else 1.1)
        if high:
            self.surface("table", self.x, self.y, self.level, (1.0, 0.8))
        self.body("cup", begin, size, rng.uniform(-40, 40))
        near = [0, -self.reach_m, 0.0]
        self.hand("giver", add(begin, near if not high else [0, -0.4, 0.2]))
        self.hand("taker", (self.x + 1.2, self.y + rng.uniform(-0.2, 0.2), begin[2] + 0.1), 180.0)
        self.pause(0.3, 1.0)
        if high:
            self.go("giver", add(begin, near))
            self.pause(0.1, 0.3)
        for first, second in (("giver", "taker"), ("taker", "giver"))[:rng.choice((1, 1, 2))]:
            meet = add(self.bodies["cup"][0], [0, 0, rng.uniform(-0.03, 0.06)])
            meet[0] = self.x + 0.5 + rng.uniform(-0.1, 0.1)
            meet[1] += rng.choice((-1, 1)) * rng.uniform(0.05, 0.3)
            if high:
                meet[2] = high
            to = add(meet, add(self.bodies[first][0], self.bodies["cup"][0], -1))
            self.go(first, to, rng.uniform(-20, 20), rng.choice((0.0, 0.02)), "cup")
            self.go(second, add(self.bodies["cup"][0], [self.reach_m, 0.0, 0.0]))
            self.pause(0.1, 0.4)
            home = add(self.bodies[first][0], [-0.5 if first == "giver" else 0.5, 0.0, 0.0])
            keep = add(self.bodies[second][0], [rng.uniform(-0.1, 0.4), -rng.uniform(0.1, 0.5) * rng.choice((-1, 1)), rng.uniform(-0.05, 0.05)])
            self.run(1.2, {first: (home, 0.0, 0.0, None), second: (keep, rng.uniform(-60, 60), 0.0, "cup")})
            self.pause()

    def midair(self):
        rng = self.rng
        self.origin()
        self.body("rod", (self.x, self.y, 1.1), (0.3, 0.04, 0.04))
        self.hand("right_hand", (self.x - 0.1, self.y, 1.1), 0.0)
        self.pause(0.5, 1.0)
        for _ in range(rng.randint(2, 4)):
            to = add(self.bodies["right_hand"][0], [rng.uniform(-0.4, 0.4), rng.uniform(-0.3, 0.3), rng.uniform(-0.1, 0.1)])
            self.go("right_hand", to, rng.uniform(-60, 60), 0.0, "rod")
            self.pause(0.5, 2.0)
            if rng.random() < 0.5:
                self.go("right_hand", add(self.bodies["right_hand"][0], rotate(self.bodies["rod"][1], [rng.uniform(-0.05, 0.05), 0, 0])))
                self.pause(0.5, 1.5)

    def small(self):
        """Fine work at a bench: all ways are short."""
        self.origin()
        self.surface("bench", self.x, self.y, self.level, (0.8, 0.6))
        self.stuff(self.rng.randint(2, 3), self.level, 0.4, 0.05)
        self.hand("right_hand", (self.x + 0.1, self.y - 0.2, self.level + 0.08))
        self.pause(0.5, 1.5)
        for _ in range(self.rng.randint(2, 4)):
            thing = "thing%d" % self.rng.randrange(2)
            at = add(self.bodies[thing][0], [self.rng.uniform(-0.06, 0.06), self.rng.uniform(-0.08, 0.08), 0])
            self.place("right_hand", thing, at, self.rng.uniform(0.04, 0.1))


def axes_turn(axes):
    """From the recording's axes to those of the file, as a quaternion."""
    return {"x_up": [0.5, 0.5, 0.5, 0.5], "y_up": turn([1, 0, 0], -90), "z_up": IDENTITY}[axes]


class Take:
    """What a tracker wrote of a scene, and the map; `fault` is the one thing that is wrong."""

    FAULTS = ("unit", "axes", "tilt", "table", "trembling", "order", "handedness", "fractions", "upright", "time", "zero",
              "outlier", "exchange")

    def __init__(self, seed, fault=None, kind=None):
        self.rng = rng = random.Random(seed)
        self.kind = kind or rng.choice(KINDS)
        self.fault = fault
        self.scene = Scene(rng, self.kind)
        self.unit, self.axes = rng.choice(tuple(UNITS)), rng.choice(tuple(AXES))
        self.said = {"unit": self.unit, "axes": self.axes, "time": rng.choice(("s", "ms"))}
        self.has_q = fault in ("order", "upright") or rng.random() < 0.75
        self.order = rng.choice(("wxyz", "xyzw"))
        self.said["order"] = self.order
        self.any_axes = self.has_q and fault != "order" and (fault == "upright" or rng.random() < 0.4)
        self.noise_m = rng.uniform(0.00005, 0.0004)
        self.places = {n: ([*at], size) for n, (at, size) in self.scene.places.items()}
        for at, _ in self.places.values():
            at[2] += rng.uniform(-0.02, 0.02)
        self.turn = IDENTITY
        if fault:
            getattr(self, "wrong_" + fault)()

    def wrong_unit(self):
        self.said["unit"] = self.rng.choice([u for u in UNITS if u != self.unit])

    def wrong_axes(self):
        self.said["axes"] = self.rng.choice([a for a in AXES if a != self.axes])

    def wrong_tilt(self):
        angle = self.rng.uniform(0, 360)
        self.turn = turn([math.cos(math.radians(angle)), math.sin(math.radians(angle)), 0], self.rng.uniform(8, 30))

    def wrong_table(self):
        if self.rng.random() < 0.5:
            self.places = {}
        else:
            for at, _ in self.places.values():
                at[2] += self.rng.choice((-1, 1)) * self.rng.uniform(0.09, 0.3)

    def wrong_trembling(self):
        self.noise_m = self.rng.uniform(0.0012, 0.004)

    def wrong_order(self):
        self.said["order"] = "xyzw" if self.order == "wxyz" else "wxyz"

    def wrong_handedness(self):
        pass

    wrong_fractions = wrong_upright = wrong_zero = wrong_outlier = wrong_exchange = wrong_handedness

    def wrong_time(self):
        self.wrote_time = self.said["time"]
        self.said["time"] = "ms" if self.wrote_time == "s" else "s"

    def rows(self):
        """By frame: the time, and by body position and quaternion, as the tracker wrote them."""
        rng, scene = self.rng, self.scene
        to_file = axes_turn(self.axes)
        cluster = {n: (multiply(turn([1, 0, 0], rng.uniform(0, 360)), turn([0, 1, 0], rng.uniform(30, 150))) if self.any_axes
                       else to_file) for n in scene.bodies}
        for i, frame in enumerate(scene.frames):
            row = {}
            for name, (p, q) in frame.items():
                p, q = rotate(self.turn, p), multiply(self.turn, q)
                p = add(p, [rng.gauss(0, self.noise_m) for _ in range(3)])
                q = multiply(q, turn([1, 0, 0], rng.gauss(0, 0.05)))
                q = multiply(multiply(to_file, q), conjugate(to_file) if not self.any_axes else cluster[name])
                row[name] = (AXES[self.axes](p), q)
            yield i / scene.hz, row

    def spoiled(self):
        rows = [(t, row) for t, row in self.rows()]
        rng = self.rng
        names = sorted(self.scene.bodies)
        if self.fault == "handedness":
            across = 1 if self.axes == "x_up" else 0
            for _, row in rows:
                for n, (p, q) in row.items():
                    row[n] = ([-x if k == across else x for k, x in enumerate(p)],
                              [q[0]] + [x if k == across else -x for k, x in enumerate(q[1:])])
        if self.fault == "zero":
            name, begin = rng.choice(names), rng.randrange(len(rows) // 2)
            for _, row in rows[begin:begin + rng.randint(2, 20)]:
                row[name] = ([0.0, 0.0, 0.0], row[name][1])
        if self.fault == "outlier":
            name, begin, count = rng.choice(names), rng.randrange(5, len(rows) - 10), rng.randint(1, 3)
            off = [rng.choice((-1, 1)) * rng.uniform(0.1, 0.3) for _ in range(3)]
            flip = turn(rng.choice(([1, 0, 0], [0, 1, 0], [0, 0, 1])), rng.uniform(90, 180))
            turns = self.has_q and rng.random() < 0.5
            for _, row in rows[begin:begin + count]:
                p, q = row[name]
                row[name] = (p, multiply(q, flip)) if turns else (add(p, off), q)
        if self.fault == "exchange":
            a, b = rng.sample(names, 2)
            begin = rng.randrange(5, len(rows) - 30)
            self.exchanged = (a, b)
            for _, row in rows[begin:begin + rng.randint(1, 20)]:
                row[a], row[b] = row[b], row[a]
        if self.fault == "fractions":
            self.has_q, self.any_axes, self.unit = False, False, "m"
            points = [p for _, row in rows for p, _ in row.values()]
            low = [min(p[k] for p in points) for k in range(3)]
            side = 1.2 * max(max(p[k] for p in points) - low[k] for k in range(3))
            up = {"x_up": 0, "y_up": 1, "z_up": 2}[self.axes]
            across = [k for k in range(3) if k != up][rng.randrange(2)]
            for _, row in rows:
                for n, (p, q) in row.items():
                    row[n] = ([0.1 + (p[across] - low[across]) / side, 0.9 - (p[up] - low[up]) / side, 0.0], q)
            self.said["unit"], self.said["axes"] = "m", "y_up"
        return rows

    def files(self):
        """The text of the poses and of the map."""
        rows = self.spoiled()
        names = sorted(self.scene.bodies)
        head = ["t"] + ["%s_%s" % (n, k) for n in names for k in ("x y z q0 q1 q2 q3" if self.has_q else "x y z").split()]
        lines = [",".join(head)]
        written = getattr(self, "wrote_time", self.said["time"])
        for t, row in rows:
            cells = ["%.6f" % (t if written == "s" else t * 1000)]
            for name in names:
                p, q = row[name]
                cells += ["%.6g" % (x * UNITS[self.unit]) for x in p]
                if self.has_q:
                    cells += ["%.7f" % x for x in (q if self.order == "wxyz" else q[1:] + q[:1])]
            lines.append(",".join(cells))
        said = self.said
        text = ["import: 1", "unit: " + said["unit"], "axes: " + said["axes"], "time_unit: " + said["time"]]
        columns = 'columns: {time: t, position: ["{}_x", "{}_y", "{}_z"]'
        if self.has_q:
            text.append("quaternion_order: " + said["order"])
            columns += ', quaternion: ["{}_q0", "{}_q1", "{}_q2", "{}_q3"]'
        text += [columns + "}", "entities:"]
        for name, (at, size) in self.places.items():
            text.append("  %s: {at_m: [%.3f, %.3f, %.3f], fixed: true, class: Table, size_m: [%g, %g, %g]}" % (name, *at, *size))
        for name in names:
            size = self.scene.sizes[name]
            upright = ", upright_at_s: 0" if self.any_axes and self.fault != "upright" else ""
            text.append("  %s: {from: %s%s, size_m: [%.3f, %.3f, %.3f]%s}" %
                        (name, name, ", hand: true" if name in self.scene.hands else "", *size, upright))
        return "\n".join(lines) + "\n", "\n".join(text) + "\n"
