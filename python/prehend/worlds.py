# SPDX-License-Identifier: Apache-2.0
"""Random worlds, as recordings: two hands take, push, carry, drop and miss things, none of it by physics. What a grammar makes of
them is a wide look at it, not at what people do."""
import json
import random

FRAMES = 2500  # of one world
_TICKS, _STEP = 480, 8  # per second; from frame to frame
_TABLE_M, _HALF_M = 0.76, 0.05


class _Hand:
    def __init__(self, chance):
        self.at = [chance.uniform(-0.4, 0.4), chance.uniform(-0.4, 0.4), chance.uniform(0.8, 1.2)]
        self.grip, self.held, self.goal, self.speed, self.wait, self.sets, self.left = 0.0, None, None, 0.2, 0, 0, 0

    def step(self, chance, things):
        if self.wait > 0:
            self.wait -= 1
        elif self.goal is None:
            self.decide(chance, things)
        else:
            way = [goal - at for goal, at in zip(self.goal, self.at)]
            far, far_now = sum(one * one for one in way) ** 0.5, self.speed * _STEP / _TICKS
            self.left -= 1
            if far <= far_now or self.left < 0:
                self.goal = None
                self.wait = chance.choice((0, 0, 1, 3, 10, 40))
            else:
                self.at = [at + one * far_now / far for at, one in zip(self.at, way)]
        if self.held is not None:
            things[self.held] = [at + chance.gauss(0, 0.0003) for at in self.at]

    def decide(self, chance, things):
        self.speed, what = chance.choice((0.005, 0.02, 0.1, 0.2, 0.3, 0.6, 0.6, 1.2)), chance.random()
        near = [name for name, at in things.items() if sum((a - b) ** 2 for a, b in zip(at, self.at)) < 0.06 ** 2]
        aside = [at + chance.choice((0.01, 0.04, 0.15)) * chance.gauss(0, 1) for at in self.at]
        if self.held is not None:
            if what < 0.3:
                self.goal = [self.at[0], self.at[1], self.at[2] + chance.choice((0.002, 0.02, 0.05, 0.15, 0.3))]
            elif what < 0.5:
                self.goal = [aside[0], aside[1], chance.choice((0, self.at[2]))]  # on the table, or as high as it is
            elif what < 0.75:
                self.goal = [self.at[0], self.at[1], 0]
            elif what < 0.85:
                self.goal = aside
            else:
                self.grip, self.held, self.sets = chance.choice((0.0, 0.2, 0.29)), None, 0
        elif near and what < 0.6:
            self.grip, self.held, self.sets = chance.choice((0.31, 0.6, 1.0)), near[0], chance.choice((1, 2, 2, 3))
        elif what < 0.85:
            self.goal = list(chance.choice(list(things.values())))
            self.goal[2] += chance.choice((0, 0, 0.1))
        else:
            self.goal, self.grip = aside, chance.choice((0.0, 0.2, self.grip))
        if self.goal:
            self.left = chance.choice((20, 60, 120))
            self.goal[2] = max(self.goal[2], _TABLE_M + _HALF_M)


def write(file, seed):
    """Writes world number `seed`; the same file for the same number."""
    chance = random.Random(seed)
    hands = {"left_hand": _Hand(chance), "right_hand": _Hand(chance)}
    things = {name: [chance.uniform(-0.4, 0.4), chance.uniform(-0.4, 0.4), _TABLE_M + _HALF_M] for name in ("cup", "box", "jar")}
    size = [2 * _HALF_M] * 3
    entities = {"table": {"class": "Table", "fixed": True, "size_m": [1.2, 1.2, 0.04]},
                "cup": {"class": "Cup", "kinds": ["Container"], "size_m": size, "mass_kg": 0.3},
                "box": {"class": "Box", "size_m": size, "mass_kg": 40}, "jar": {"class": "Jar", "size_m": size},
                "drawer": {"class": "Drawer", "jointed": True, "size_m": size},
                "area": {"class": "Area", "abstract": "Region", "size_m": [0.3, 0.3, 0.6]},
                "anna": {"class": "Person", "person": True, "size_m": [0.4, 0.4, 1.8]},
                **{name: {"hand": True, "size_m": [0.09, 0.084, 0.025], "part_of": "anna", "strength_n": 200} for name in hands}}
    standing = {"table": [0, 0, _TABLE_M - 0.02], "area": [0.2, 0, _TABLE_M + 0.3], "anna": [0, -0.8, 0.9], "drawer": [0.5, 0, 0.9]}
    opened, sky = 0.0, {name: 0.0 for name in things}
    with open(file, "w", encoding="utf-8") as lines:
        print(json.dumps({"recording": 1, "episode": f"world_{seed}", "ticks_per_second": _TICKS, "entities": entities}), file=lines)
        for frame in range(FRAMES):
            for hand in hands.values():
                hand.step(chance, things)
            held = {hand.held for hand in hands.values()}
            touches = []
            for name, at in things.items():
                floor = _TABLE_M + _HALF_M
                if name not in held:
                    sky[name] = min(1.5, sky[name] + 9.81 * _STEP / _TICKS)
                    at[2] = max(floor, at[2] - sky[name] * _STEP / _TICKS)
                else:
                    sky[name] = 0.0
                if at[2] - floor < 0.002 and chance.random() > 0.01:
                    touches.append({"a": name, "b": "table", "up_on_a": chance.choice((1, 1, 1, 0.7, 0.4)), "force_n": 3,
                                    "vertical_speed_m_per_s": chance.choice((0, 0, 0, 0.01, 0.03))})
                for hand, one in hands.items():
                    is_near = sum((a - b) ** 2 for a, b in zip(at, one.at)) < 0.055 ** 2
                    if (one.held == name or is_near) and chance.random() > 0.02:
                        touches.append({"a": hand, "b": name, "up_on_b": chance.choice((0, 0, 0.6)), "force_n": chance.choice((1, 8, 25)),
                                        "sensor_sets": ["fingers", "thumb", "palm"][:one.sets if one.held == name else 1]})
            opened = min(1, max(0, opened + chance.choice((0, 0, -0.01, 0.02))))
            samples = {name: {"at_m": at} for name, at in [*things.items(), *((name, hand.at) for name, hand in hands.items())]}
            if frame == 0:
                samples.update({name: {"at_m": at} for name, at in standing.items()})
            samples["drawer"] = {"at_m": [0.5, opened * 0.3, 0.9], "joint_fraction": opened, "joint_position": opened * 0.3}
            samples["anna"] = {"at_m": standing["anna"], "gazes_at": list(things)[frame // 90 % 3]}
            print(json.dumps({"tick": frame * _STEP, "samples": samples, "touches": touches,
                              "hands": {name: {"trigger": hand.grip} for name, hand in hands.items()}}), file=lines)
        print(json.dumps({"end_tick": FRAMES * _STEP}), file=lines)
