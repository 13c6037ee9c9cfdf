#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Grasps by distance and gripper, in plain Python: what the least recogniser looks like (docs/recognisers.md)."""
import json
import math
import sys

NEAR_M, ON, OFF = 0.12, 0.2, 0.1


def say(line):
    print(json.dumps(line), flush=True)


say({"recogniser": 1, "name": "distance", "events": {"grasping": ["hand", "object"]}, "facts": ["poses", "trigger"]})
entities = json.loads(sys.stdin.readline())["entities"]
hands = [name for name, one in entities.items() if one.get("hand")]
things = [name for name, one in entities.items() if not (one.get("hand") or one.get("fixed") or one.get("abstract"))]
at, grip, held = {}, {}, {}  # held: of a hand, the object and the tick since when
for line in map(json.loads, sys.stdin):
    at.update({name: look and look["at_m"] for name, look in line.get("samples", {}).items()})
    grip.update({name: hand["trigger"] for name, hand in line.get("hands", {}).items()})
    tick = line.get("tick", line.get("end_tick"))
    for hand in hands:
        near = [(math.dist(at[hand], at[one]), one) for one in things if at.get(hand) and at.get(one)]
        distance, nearest = min(near, default=(math.inf, None))
        if hand not in held and grip.get(hand, 0) >= ON and distance < NEAR_M and "tick" in line:
            held[hand] = nearest, tick
        elif hand in held and (grip.get(hand, 0) < OFF or "end_tick" in line):
            thing, begin = held.pop(hand)
            say({"event": "grasping", "roles": {"hand": hand, "object": thing}, "begin_tick": begin, "end_tick": tick})
    if "tick" in line:
        say({"ready": tick})
