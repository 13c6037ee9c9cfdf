# SPDX-License-Identifier: Apache-2.0
"""Takes of a kitchen task that nobody recorded: two hands fetch, carry, pour, stir, slide, hand over and put down. Each take
is made twice, from one motion: with all facts, so that the shipped grammars say what is true in it, and as a tracker of
marker clusters would see it. A person is all that differs between people: where the clusters are fixed, how far, how high
the table is, how fast and how high hands move, how a tool turns in the hand. Everything is drawn from a seed.
"""
import math
import random

HZ = 240  # of the motion itself
TICKS_PER_SECOND = 1200


class Person:
    """hand_to_thing_m: between the clusters of a hand and of what it holds. pace: 1 is 0.9 s for a reach."""

    def __init__(self, hand_to_thing_m, table_m, pace, lift_m, wobble_deg, hz, jitter_m, table_error_m,
                 any_axes):
        self.hand_to_thing_m, self.table_m, self.pace, self.lift_m = hand_to_thing_m, table_m, pace, lift_m
        self.wobble_deg, self.hz, self.jitter_m, self.table_error_m = wobble_deg, hz, jitter_m, table_error_m
        self.any_axes = any_axes  # trackers give rigid bodies any axes


# The definitions were worked out on the first. Only totals of the second, of other seeds, were looked at meanwhile.
PEOPLE = {
    "first": Person((0.06, 0.12), 0.74, (0.9, 1.2), (0.12, 0.2), 6, 60, 0.0005, 0.0, False),
    "second": Person((0.10, 0.22), 0.92, (0.6, 1.5), (0.08, 0.3), 10, 53, 0.001, 0.006, True),
}

# size, where the hand takes it: above the middle
THINGS = {
    "bottle": ((0.07, 0.07, 0.24), 0.0),
    "bowl": ((0.22, 0.22, 0.09), 0.03),
    "whisk": ((0.06, 0.06, 0.26), 0.07),
    "cup": ((0.08, 0.08, 0.1), 0.0),
    "box": ((0.12, 0.09, 0.07), 0.0),
}


NOT_TURNED = [1.0, 0.0, 0.0, 0.0]


def add(a, b, k=1.0):
    return [x + k * y for x, y in zip(a, b)]


def length(a):
    return math.sqrt(sum(x * x for x in a))


def multiply(p, q):
    w, x, y, z = p
    a, b, c, d = q
    return [w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c,
            w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a]


def conjugate(q):
    return [q[0], -q[1], -q[2], -q[3]]


def rotate(q, v):
    return multiply(multiply(q, [0.0, *v]), conjugate(q))[1:]


def turn(axis, degrees):
    half = math.radians(degrees) / 2
    return [math.cos(half), *(math.sin(half) * x for x in axis)]


def smooth(share):
    return share ** 3 * (10 - 15 * share + 6 * share ** 2)


class Body:
    def __init__(self, p, q=NOT_TURNED):
        self.p, self.q = list(p), list(q)


class Hand(Body):
    def __init__(self, p, home):
        super().__init__(p, turn([0, 0, 1], 90))  # its x axis is where it reaches
        self.home, self.held, self.touched, self.grip = home, None, None, 0.0
        self.hold = None  # pose of what is held, as seen from the hand
        self.slip = NOT_TURNED  # how it has turned in the hand


class Take:
    """Moves the bodies, one frame after another."""

    def __init__(self, person, seed):
        self.rng = random.Random(seed)
        self.person = person
        self.table_m = person.table_m
        rng = self.rng
        self.things = {}
        for place, name in enumerate(rng.sample(sorted(THINGS), len(THINGS))):
            size = THINGS[name][0]
            self.things[name] = Body([-0.6 + 0.3 * place, 0.25 + rng.uniform(-0.04, 0.04), self.table_m + size[2] / 2])
        self.hands = {side: Hand(home, home) for side, home in (
            ("left_hand", [-0.3, -0.25, self.table_m + 0.1]), ("right_hand", [0.3, -0.25, self.table_m + 0.1]))}
        self.frames = 0

    # Each step of a hand is a generator: it yields once per frame.
    def pause(self, seconds):
        for _ in range(max(1, round(seconds * HZ))):
            yield

    def seconds(self, way_m):
        return (0.35 + 1.1 * way_m) / self.rng.uniform(*self.person.pace)

    def move(self, hand, to, q=None, seconds=None):
        start, first = list(hand.p), list(hand.q)
        q = q or first
        if sum(a * b for a, b in zip(first, q)) < 0:
            q = [-x for x in q]
        frames = max(2, round((seconds or self.seconds(length(add(to, start, -1)))) * HZ))
        for i in range(1, frames + 1):
            s = smooth(i / frames)
            hand.p = add(start, add(to, start, -1), s)
            hand.q = [a + s * (b - a) for a, b in zip(first, q)]
            norm = length(hand.q)
            hand.q = [x / norm for x in hand.q]
            yield

    def grasp_point(self, name):
        body = self.things[name]
        return add(body.p, rotate(body.q, [0, 0, THINGS[name][1]]))

    def fetch(self, hand, name):
        rng = self.rng
        yield from self.pause(rng.uniform(0.2, 0.8))
        target = self.grasp_point(name)
        q = turn([0, 0, 1], 90 + rng.uniform(-40, 40))
        above = add(target, [rng.uniform(-0.03, 0.03), -0.1, 0.05])
        yield from self.move(hand, above, q)
        yield from self.move(hand, target, q, 0.3 / rng.uniform(*self.person.pace))
        hand.touched = name
        yield from self.pause(rng.uniform(0.08, 0.3))
        hand.grip, hand.held = 1.0, name
        body = self.things[name]
        hand.hold = (rotate(conjugate(hand.q), add(body.p, hand.p, -1)), multiply(conjugate(hand.q), body.q))
        yield from self.pause(rng.uniform(0.05, 0.25))

    def lift(self, hand):
        yield from self.move(hand, add(hand.p, [0, 0, self.rng.uniform(*self.person.lift_m)]),
                             seconds=0.5 / self.rng.uniform(*self.person.pace))

    def release(self, hand):
        rng = self.rng
        yield from self.pause(rng.uniform(0.05, 0.25))
        hand.grip, hand.held = 0.0, None
        hand.slip = NOT_TURNED
        yield from self.pause(rng.uniform(0.05, 0.2))
        hand.touched = None
        yield from self.move(hand, add(hand.p, [0, -0.12, 0.03]), seconds=0.35)
        yield from self.move(hand, add(hand.home, [rng.uniform(-0.03, 0.03) for _ in range(3)]))

    def place(self, hand, x, y):
        """What the hand holds, upright, at this place of the table."""
        name = hand.held
        body = self.things[name]
        size = THINGS[name][0]
        hand_at = add([x, y, self.table_m + size[2] / 2], add(hand.p, body.p, -1))
        yield from self.move(hand, add(hand_at, [0, 0, 0.1]))
        yield from self.move(hand, hand_at, seconds=0.5 / self.rng.uniform(*self.person.pace))
        yield from self.release(hand)

    def carry(self, hand, name, x, y):
        yield from self.fetch(hand, name)
        yield from self.lift(hand)
        yield from self.place(hand, x, y)

    def slide(self, hand, name, way):
        yield from self.fetch(hand, name)
        yield from self.move(hand, add(hand.p, way), seconds=1.0 / self.rng.uniform(*self.person.pace))
        yield from self.release(hand)

    def pour(self, hand, name, into, x, y):
        rng = self.rng
        yield from self.fetch(hand, name)
        yield from self.lift(hand)
        vessel = self.things[into].p
        yield from self.move(hand, add(vessel, [0.08, 0, 0.22 + THINGS[into][0][2] / 2]))
        upright = list(hand.q)
        yield from self.move(hand, hand.p, multiply(turn([0, 1, 0], -rng.uniform(85, 110)), upright), rng.uniform(0.5, 0.9))
        yield from self.pause(rng.uniform(0.6, 1.6))
        yield from self.move(hand, hand.p, upright, rng.uniform(0.5, 0.8))
        yield from self.place(hand, x, y)

    def stir(self, hand, name, vessel, x, y):
        rng = self.rng
        yield from self.fetch(hand, name)
        yield from self.lift(hand)
        bowl = self.things[vessel].p
        body = self.things[name]
        low = add(add(bowl, [0, 0, THINGS[name][0][2] / 2 + 0.01]), add(hand.p, body.p, -1))
        yield from self.move(hand, add(low, [0, 0, 0.15]))
        yield from self.move(hand, add(low, [0.035, 0, 0]))
        turns, rate = rng.uniform(4, 9), rng.uniform(1.1, 1.9)
        frames = round(turns / rate * HZ)
        for i in range(frames):
            angle = 2 * math.pi * rate * i / HZ
            hand.p = add(low, [0.035 * math.cos(angle), 0.035 * math.sin(angle), 0])
            ramp = min(1.0, i / 60, (frames - i) / 60)
            hand.slip = turn([math.cos(angle), math.sin(angle), 0], ramp * self.person.wobble_deg)
            yield
        hand.slip = NOT_TURNED
        yield from self.move(hand, add(hand.p, [0, 0, 0.18]))
        yield from self.place(hand, x, y)

    def wait_for(self, done):
        while not done():
            yield

    def script(self):
        """What the hands do: each a list of steps, at the same time."""
        rng = self.rng
        x = {name: body.p[0] for name, body in self.things.items()}
        left, right = self.hands["left_hand"], self.hands["right_hand"]
        finished = []

        def right_does():
            yield from self.pour(right, "bottle", "bowl", x["bottle"], 0.25)
            yield from self.stir(right, "whisk", "bowl", x["whisk"], 0.22)
            finished.append("right")
            yield from self.slide(right, "box", [rng.choice([-0.05, 0.05]), -rng.uniform(0.08, 0.15), 0])

        def left_does():
            yield from self.pause(rng.uniform(0, 1))
            yield from self.carry(left, "cup", x["cup"], 0.02)
            yield from self.pause(rng.uniform(0.5, 2))
            yield from self.carry(left, "cup", x["cup"], 0.25)
            yield from self.wait_for(lambda: finished)
            yield from self.carry(left, "bowl", x["bowl"], 0.05)

        return [right_does(), left_does(), self.pause(1.0)]

    def play(self):
        """Yields after each frame; poses are in self.things and self.hands."""
        running = self.script()
        while running:
            running = [step for step in running if next(step, StopIteration) is not StopIteration]
            for hand in self.hands.values():
                if hand.held:
                    body = self.things[hand.held]
                    body.p = add(hand.p, rotate(multiply(hand.q, hand.slip), hand.hold[0]))
                    body.q = multiply(multiply(hand.q, hand.slip), hand.hold[1])
            self.frames += 1
            yield


def header(name, take, sizes):
    entities = {"table": {"class": "Table", "fixed": True, "size_m": [2.0, 1.2, 0.04]}}
    for thing, (size, centre) in sizes.items():
        entities[thing] = {"class": thing.capitalize(), "size_m": list(size), "centre_m": centre}
    for hand in take.hands:
        entities[hand] = {"hand": True, "size_m": [0.09, 0.084, 0.025]}
    return {"recording": 1, "episode": name, "grammar": "pick_and_place", "ticks_per_second": TICKS_PER_SECOND,
            "entities": entities}


def sample(p, q):
    return {"at_m": [round(x, 5) for x in p], "quat_wxyz": [round(x, 6) for x in q]}


def table_sample(height_m):
    return {"at_m": [0, 0, height_m - 0.02]}


def touches(take):
    found = []
    for name, body in take.things.items():
        held_by = [h for h in take.hands.values() if h.held == name]
        bottom = body.p[2] - THINGS[name][0][2] / 2
        upright = rotate(body.q, [0, 0, 1])[2] > 0.99
        if upright and abs(bottom - take.table_m) < 0.0008 or not held_by:
            found.append({"a": name, "b": "table", "up_on_a": 1.0, "force_n": 3.0})
    for side, hand in take.hands.items():
        if hand.touched:
            sets = ["fingers", "thumb"] if hand.held else ["fingers"]
            found.append({"a": side, "b": hand.touched, "force_n": 2.0, "sensor_sets": sets})
    return found


def make(name, person, seed):
    """Two lists of lines: all facts, and what a tracker sees."""
    take = Take(person, seed)
    rng = random.Random(seed + 1)
    # A cluster sits on the back of the hand or on the wrist, another one on the thing; together they are as far apart as
    # the person's are. The box of a thing is where it was measured to be from its cluster.
    clusters, sizes, axes = {}, {}, {}
    for thing, (size, _) in THINGS.items():
        clusters[thing] = [rng.uniform(-0.02, 0.02), rng.uniform(-0.02, 0.02), size[2] / 2 + rng.uniform(0.01, 0.03)]
        sizes[thing] = (size, [-x for x in clusters[thing]])
    for hand in take.hands:
        far = rng.uniform(*person.hand_to_thing_m)
        axis = [-1.0, rng.gauss(0, 0.3), rng.gauss(0.3, 0.3)]
        axes[hand] = turn([0, 0, 1], rng.uniform(0, 360) if person.any_axes else 0)
        clusters[hand] = [far * x / length(axis) for x in axis]
    facts = [header(name, take, {thing: (size, [0, 0, 0]) for thing, (size, _) in THINGS.items()})]
    seen = [header(name, take, sizes)]
    due = 0.0
    jitter = lambda p: [x + rng.gauss(0, person.jitter_m) for x in p]
    for _ in take.play():
        tick = round(take.frames * TICKS_PER_SECOND / HZ)
        bodies = {**take.things, **take.hands}
        samples = {n: sample(b.p, b.q) for n, b in bodies.items()}
        hands = {n: {"trigger": h.grip, "collision_spheres_m": [[*(round(x, 5) for x in h.p), 0.03]]}
                 for n, h in take.hands.items()}
        if len(facts) == 1:
            samples["table"] = table_sample(take.table_m)
        facts.append({"tick": tick, "samples": samples, "hands": hands, "touches": touches(take)})
        if tick < due:
            continue
        due += TICKS_PER_SECOND / person.hz
        samples = {n: sample(jitter(add(b.p, rotate(b.q, clusters[n]))), multiply(b.q, axes.get(n, NOT_TURNED)))
                   for n, b in bodies.items()}
        if len(seen) == 1:
            samples["table"] = table_sample(take.table_m + person.table_error_m)
        seen.append({"tick": tick, "samples": samples})
    return facts, seen
