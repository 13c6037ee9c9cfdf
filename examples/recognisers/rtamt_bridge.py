#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A formula of signal temporal logic as a recogniser, with rtamt. UNTESTED: rtamt is in no package of Debian, and was
not there when this was written; its calls are those of its documentation (0.3, discrete time, offline).

python3 rtamt_bridge.py '(distance <= 0.05) and (grip >= 0.2)': while its robustness is positive, the hand grasps. The
formula may name `distance` (m, of the hand to the object), `grip` (0..1) and `height` (m, of the object).
"""
import json
import math
import sys

import rtamt

print(json.dumps({"recogniser": 1, "name": "rtamt", "events": {"grasping": ["hand", "object"]},
                  "facts": ["poses", "trigger"]}), flush=True)
header = json.loads(sys.stdin.readline())
hands = [name for name, one in header["entities"].items() if one.get("hand")]
things = [name for name, one in header["entities"].items() if not (one.get("hand") or one.get("fixed"))]
at, grip, signals, ticks, end = {}, {}, {}, [], 0
for line in map(json.loads, sys.stdin):
    if "end_tick" in line:
        end = line["end_tick"]
        break
    at.update({name: look and look["at_m"] for name, look in line["samples"].items()})
    grip.update({name: hand["trigger"] for name, hand in line["hands"].items()})
    ticks.append(line["tick"])
    for hand in hands:
        for thing in things:
            a, b = at.get(hand), at.get(thing)
            signals.setdefault((hand, thing), []).append(
                (math.dist(a, b) if a and b else 1e9, grip.get(hand, 0), b[2] if b else 0))
for (hand, thing), values in signals.items():
    spec = rtamt.StlDiscreteTimeSpecification()
    for name in ("distance", "grip", "height"):
        spec.declare_var(name, "float")
    spec.spec = sys.argv[1]
    spec.parse()
    distances, grips, heights = map(list, zip(*values))
    robustness = spec.evaluate({"time": ticks, "distance": distances, "grip": grips, "height": heights})
    begin = None
    for tick, value in robustness + [[end, -1]]:
        if value > 0 and begin is None:
            begin = tick
        elif value <= 0 and begin is not None:
            print(json.dumps({"event": "grasping", "roles": {"hand": hand, "object": thing}, "begin_tick": begin,
                              "end_tick": tick}))
            begin = None
