# SPDX-License-Identifier: Apache-2.0
"""What a grammar means, written from docs/semantics.md and nothing else: Meaning(grammar, recording).events(). Over a whole
episode at once, and slow."""
import json
from fractions import Fraction
from functools import cache
from itertools import permutations, product
from math import ceil

from read_grammar import Parser

ALLEN = {"before": lambda a, b, t: a[1] < b[0] and (t is None or b[0] - a[1] <= t),
         "meets": lambda a, b, t: a[1] == b[0] if t is None else abs(a[1] - b[0]) <= t and a[0] < b[0] and a[1] < b[1],
         "starts": lambda a, b, t: abs(a[0] - b[0]) <= (t or 0) and a[1] < b[1],
         "finishes": lambda a, b, t: abs(a[1] - b[1]) <= (t or 0) and a[0] > b[0],
         "equals": lambda a, b, t: abs(a[0] - b[0]) <= (t or 0) and abs(a[1] - b[1]) <= (t or 0),
         "overlaps": lambda a, b, t: a[0] < b[0] < a[1] < b[1], "inside": lambda a, b, t: b[0] < a[0] and a[1] < b[1]}
for name, other in zip("after met_by started_by finished_by overlapped_by contains".split(),
                       "before meets starts finishes overlaps inside".split()):
    ALLEN[name] = lambda a, b, t, of=ALLEN[other]: of(b, a, t)


class Meaning:
    """An interval is (begin, end, first frame, first frame behind it, tick at which it is complete)."""

    def __init__(self, grammar, recording):
        head, *frames = [json.loads(line) for line in recording.splitlines()]
        self.rules = {rule["name"]: rule for rule in Parser(grammar).rules}
        self.classes = {name: {e.get("class", "Hand"), "Hand" if e.get("hand") else "Thing", "Entity",
                               "Fixed" if e.get("fixed") else "Movable"} for name, e in head["entities"].items()}
        self.tps, self.end = head["ticks_per_second"], frames.pop()["end_tick"]
        self.ticks = [frame["tick"] for frame in frames] + [self.end]
        self.n, looks, self.heights, self.touches = len(frames), dict.fromkeys(self.classes), [], []
        for frame in frames:
            looks = looks | {who: look and Fraction(str(look["at_m"][2])) for who, look in frame.get("samples", {}).items()}
            self.heights.append(looks)
            self.touches.append({frozenset((t["a"], t["b"])) for t in frame.get("touches", [])})
        for method in ("intervals", "truth", "number"):
            setattr(self, method, cache(getattr(self, method)))

    def events(self):
        return [{"event": rule["name"], "roles": {role: who for (role, _), who in zip(rule["roles"], binding)},
                 "begin_tick": one[0], "end_tick": one[1]}
                for rule in self.rules.values() if rule["is"] == "event" for binding in self.bindings(rule["roles"])
                for one in self.intervals(rule["name"], binding)]

    def bindings(self, roles):
        return [who for who in permutations(self.classes, len(roles))
                if all(role[1] in self.classes[one] for role, one in zip(roles, who))]

    # Who a call may be about: each binding of its rule.
    def called(self, call, env):
        roles = [(name, cls) for name, cls in call[2:]]
        wanted = [role[1] for role in self.rules[call[1]]["roles"]]
        return [who for who in self.bindings([("", cls) for cls in wanted])
                if all(dict(env)[name] == one if name != "any" else cls in self.classes[one]
                       for (name, cls), one in zip(roles, who))]

    def inside(self, intervals):
        return [any(b <= tick < e for b, e, *_ in intervals) for tick in self.ticks[:-1]]

    def runs(self, truth):
        begins = [i for i in range(self.n) if truth[i] is True and (i == 0 or truth[i - 1] is not True)]
        return [self.frames(i, next((j for j in range(i, self.n) if truth[j] is not True), self.n)) for i in begins]

    def frames(self, i, j, end=None):
        end = self.ticks[j] if end is None else end
        return self.ticks[i], end, i, j, end

    # Of a call: those of its rule; of anything else, the longest in which it is true.
    def of(self, expr, env, at=None, known=False):
        is_rule = expr[0] == "call" and expr[1] in self.rules and all(name != "any" for name, _ in expr[2:])
        return self.intervals(expr[1], self.called(expr, env)[0]) if is_rule else self.runs(self.truth(expr, env, at, known))

    # By frame: True, False, or None where nobody knows it. `at`: the frame of @begin and @end.
    # `known`: in it, a rule is unknown where there is no sight of it.
    def truth(self, expr, env, at=None, known=False):
        op, args, n = expr[0], expr[1:], range(self.n)
        if op in ("begins", "ends"):
            edges = [one[2] if op == "begins" else one[3] for one in self.of(args[0], env, at, known)]
            return [i in edges for i in n]
        if op == "known":
            return [value is True for value in self.truth(args[0], env, at, True)]
        if op == "at least" or op == "call" and expr[1] in self.rules:
            least, call = args if op == "at least" else (1, expr)
            each = [self.inside(self.intervals(call[1], who)) for who in self.called(call, env)]
            lost = self.lost(call, env) if known else [False] * self.n
            return [sum(holds[i] for holds in each) >= least or (None if lost[i] else False) for i in n]
        if op == "call":
            return [frozenset(dict(env)[name] for name, _ in args[1:]) in self.touches[i] for i in n]
        if op in ("and", "or", "not"):
            order = [False, None, True]
            sides = [[order.index(value) for value in self.truth(arg, env, at, known)] for arg in args]
            least = {"and": min, "or": max, "not": lambda *side: 2 - side[0]}[op]
            return [order[least(values) if op != "not" else least(*values)] for values in zip(*sides)]
        sides = zip(*(self.number(arg, env, at) for arg in args))
        compare = {"<": lambda a, b: a < b, "<=": lambda a, b: a <= b, ">": lambda a, b: a > b, ">=": lambda a, b: a >= b}
        return [None if None in side else compare[op](*side) for side in sides]

    def number(self, expr, env, at):
        if expr[0] == "number":
            return [expr[1]] * self.n
        if expr[0][0] == "@":
            frame = at if isinstance(at, int) else at[expr[0] == "@end"]
            return [self.number(expr[1], env, at)[min(frame, self.n - 1)]] * self.n
        if expr[0] == "call":  # height
            return [looks[dict(env)[expr[2][0]]] for looks in self.heights]
        sign = 1 if expr[0] == "+" else -1
        return [None if None in pair else pair[0] + sign * pair[1] for pair in zip(*(self.number(a, env, at) for a in expr[1:]))]

    # A call as a role of the rules it names sees it: the roles whose poses show whether it holds.
    def seen(self, expr):
        if expr[0] == "call" and expr[1] in self.rules:
            rule = self.rules[expr[1]]
            own = {role for part in self.conditions(rule) for role in self.seen(part)}
            return {name for (name, _), (role, _) in zip(expr[2:], rule["roles"]) if role in own} - {"any"}
        if expr[0] == "call":
            return {expr[2][0]} if expr[1] == "height" else set()
        return {role for part in expr[1:] if isinstance(part, tuple) for role in self.seen(part)}

    # All expressions that stand in a rule.
    def conditions(self, rule):
        walk = [value for key, value in rule.items() if key not in ("roles", "name", "is")]
        while walk:
            part = walk.pop()
            if isinstance(part, tuple) and part and part[0] in ("call", "and", "or", "not", "known", "begins", "ends", "<", "<=", ">", ">="):
                yield part
            elif isinstance(part, (tuple, list)):
                walk += part

    def lost(self, expr, env):
        return [any(looks[dict(env)[role]] is None for role in self.seen(expr)) for looks in self.heights]

    def intervals(self, name, binding):
        rule = self.rules[name]
        env, ticks, n = tuple(zip((role for role, _ in rule["roles"]), binding)), self.ticks, self.n
        form = next(key for key in rule if key not in ("is", "name", "(", "roles", ")", "first"))
        found = [one for one in getattr(self, form.split()[0] + "_")(rule, env)
                 if rule.get("lasting", 0) * self.tps <= one[1] - one[0] <= rule.get("most", Fraction(10**9)) * self.tps]
        if "requires" in rule:
            found = [one for one in found if self.truth(rule["requires"], env, (one[2], one[3]))[min(one[3], n - 1)] is True]
        if "confirmed by" in rule:
            begins = {one[2] for one in self.of(rule["confirmed by"], env)}
            within = self.truth(rule["meanwhile"], env)
            found = [one for one in found if any(k in begins and all(within[one[3]:k + 1]) for k in range(one[3], n))]
        return found

    # For each begin `i` that there is, `until(i)` gives a frame behind its interval and the interval, or None.
    def one_by_one(self, on, until):
        found, i = [], 0
        while i < self.n:
            i, one = until(i) if on[i] is True else (i + 1, None)
            found += [one] if one else []
        return found

    def first(self, frames, holds):
        return next((j for j in frames if holds(j)), self.n)

    def while_(self, rule, env):
        on = self.truth(rule["while"], env)
        off = lambda i: self.truth(rule["until"], env, i) if "until" in rule else [value is not True for value in on]

        def until(i):
            j = self.first(range(i, self.n), lambda j: off(i)[j] is True)
            return j + 1, j > i and self.frames(i, j)

        joined = []
        for one in self.one_by_one(on, until):
            near = joined and one[0] - joined[-1][1] <= rule.get("bridging", -1) * self.tps
            joined[-1:] = [self.frames(joined[-1][2], one[3])] if near else joined[-1:] + [one]
        return joined

    def from_each(self, rule, env):
        on, off = self.truth(rule["from each"], env), self.truth(rule["to"], env)
        holds = self.truth(rule["during"], env) if "during" in rule else [True] * self.n
        waits = [on[i] is True and holds[i] is True and off[i] is not True for i in range(self.n)]

        def until(i):
            j = self.first(range(i + 1, self.n), lambda j: off[j] is True or holds[j] is not True)
            i = self.first(range(i, j), lambda k: waits[k] and self.ticks[j] - self.ticks[k] <= rule["within"] * self.tps)
            return j + 1, i < j and ("or drop" not in rule or j < self.n and off[j] is True) and self.frames(i, j)

        return self.one_by_one(waits, until)

    def from_(self, rule, env):
        if "from each" in rule:
            return self.from_each(rule, env)
        ticks, n, absent = self.ticks, self.n, "without" in rule
        within = rule["within"] * self.tps if "within" in rule else 10**9

        def until(i):
            off = self.truth(rule["without" if absent else "to"], env, i)
            holds = self.truth(rule["during"], env, i) if "during" in rule else [True] * n
            if absent:
                holds = [value is True and not lost for value, lost in zip(holds, self.lost(rule["without"], env))]
            if holds[i] is not True or off[i] is True:
                return i + 1, None
            is_late = lambda j: ticks[j] >= ticks[i] + within if absent else ticks[j] > ticks[i] + within
            late = self.first(range(i + 1, n), is_late)
            j = min(late, self.first(range(i + 1, late), lambda j: off[j] is True or holds[j] is not True))
            if absent:
                deadline = ticks[i] + ceil(within)
                comes = j < late or late < n and ticks[late] <= ticks[i] + within and off[late] is True
                waited = not comes and ticks[late] >= deadline
                return (late, self.frames(i, late, deadline)) if waited else (i + 1, None)
            in_time = j < late or late == n and self.end <= ticks[i] + within
            kept = in_time and ("or drop" not in rule or j < n and off[j] is True)
            return j + (in_time and j < n), kept and self.frames(i, j)

        return self.one_by_one(self.truth(rule["from"], env), until)

    def until_(self, rule, env):
        found, last, back = [], 0, rule["at most"] * self.tps
        for j in (j for j, ends in enumerate(self.truth(rule["until"], env)) if ends is True):
            holds, i = self.truth(rule["since"], env, j), j
            while i > last and holds[i - 1] is True and self.ticks[j] - self.ticks[i - 1] <= back:
                i -= 1
            found, last = found + ([self.frames(i, j)] if i < j else []), j
        return found

    def rest_(self, rule, env):
        others = [self.truth(call, env) for call in rule["outside"]]
        inside = lambda one: [one[2] <= i < one[3] and not any(other[i] for other in others) for i in range(self.n)]
        return [self.frames(part[2], part[3], min(part[1], one[1])) for one in self.of(rule["rest of"][0], env)
                for part in self.runs(inside(one))]

    def compose_(self, rule, env):
        parts = rule["compose"] if "compose" in rule else rule["all of"]
        where = {label: place for place, (label, _) in enumerate(parts)}
        found = []
        for chosen in product(*([one for call in calls for one in self.of(call, env)] for _, calls in parts)):
            hull, begins, ends = "all of" in rule, [one[0] for one in chosen], [one[1] for one in chosen]
            first, last = (min(chosen), max(chosen, key=lambda one: one[1])) if hull else (chosen[0], chosen[-1])
            whole = (first[0], last[1], first[2], last[3], max(one[4] for one in chosen))
            twice = any(self.may_be_one(parts[i], parts[k]) and chosen[i] == chosen[k] for i in range(len(parts)) for k in range(i))
            if whole[0] >= whole[1] or hull and (twice or whole[1] - whole[0] > rule["within"] * self.tps):
                continue
            if all(self.relates(relation, chosen, where, env) for relation in rule.get("where", [])):
                found.append(whole)
        sign = 1 if rule.get("first") else -1
        order = (lambda one: (one[4], -one[0], one[1])) if "all of" in rule else lambda one: (one[4], one[1], sign * one[0])
        return self.taken(sorted(found, key=order))

    all_ = compose_

    # Of two parts: some call of each may be about one interval, as `any` may be whom the other names.
    def may_be_one(self, left, right):
        alike = lambda a, b: a[0] == b[0] or "any" in (a[0], b[0])
        return any(a[1] == b[1] and all(alike(*who) for who in zip(a[2:], b[2:])) for a in left[1] for b in right[1])

    def taken(self, found):
        taken = []
        for one in found:
            taken += [one] if not taken or one[0] >= taken[-1][1] else []
        return taken

    def relates(self, relation, chosen, where, env):
        call, left, *middle, right = relation
        a, b = chosen[where[left]], chosen[where[right]]
        if call is None:
            return any(ALLEN[name](a, b, None if t is None else t * self.tps) for name, t in middle[0])
        lost = self.runs(self.lost(call, env))
        return not any(max(one[0], a[1]) < min(one[1], b[0]) for one in self.of(call, env) + lost)

    def repeat_(self, rule, env):
        every = sorted(one for call in rule["repeat"] for one in self.of(call, env))
        found = []
        if "within" in rule:
            for first in every:
                series = [one for one in every if one[0] >= first[0] and one[1] <= first[0] + rule["within"] * self.tps]
                last = max(series, key=lambda one: one[1], default=first)
                if first in series and len(series) >= rule["at least"]:
                    found.append((first[0], last[1], first[2], last[3], last[1]))
            return self.taken(found)
        series = []
        for one in every:
            if series and one[0] - max(other[1] for other in series[-1]) <= rule[", gap at most"] * self.tps:
                series[-1].append(one)
            else:
                series.append([one])
        return [self.frames(one[0][2], max(other[3] for other in one), max(other[1] for other in one))
                for one in series if len(one) >= rule["at least"]]
