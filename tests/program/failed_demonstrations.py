# SPDX-License-Identifier: Apache-2.0
"""Demonstrations that fail in known ways, made by formulas: `report` groups them by what went wrong first, with the moment.

    /usr/bin/python3 tests/program/failed_demonstrations.py build/test/prehend
"""
import json
import os
import subprocess
import sys
import tempfile

PREHEND = os.path.abspath(sys.argv[1])
HZ, SIZE = 20, 0.047
REST = SIZE / 2


class Take:
    """Three cubes on a table, and a gripper that is told what to do."""

    def __init__(self, success=None, at=0.0, hand="gripper"):
        self.success, self.hand = success, hand
        self.cubes = {"cube_%d" % (i + 1): [0.2 * i + at, 0.0, REST] for i in range(3)}
        self.p, self.trigger, self.held, self.frames, self.speed = [0.0, 0.3, 0.3], 0.0, None, [], {}
        self.wait(0.3)

    def now(self):
        return len(self.frames) / HZ

    def frame(self):
        if self.held:
            self.cubes[self.held] = [self.p[0], self.p[1], self.p[2]]
        for name, cube in self.cubes.items():
            below = [c[2] + REST for other, c in self.cubes.items() if other != name and c[2] < cube[2] - 0.01
                     and abs(c[0] - cube[0]) < SIZE / 2 and abs(c[1] - cube[1]) < SIZE / 2]
            floor = max(below + [0.0]) + REST
            if name != self.held and cube[2] > floor + 1e-6:  # falls
                self.speed[name] = self.speed.get(name, 0) + 9.81 / HZ
                cube[2] = max(floor, cube[2] - self.speed[name] / HZ)
            else:
                self.speed[name] = 0
        self.frames.append({"g": list(self.p), "t": self.trigger, **{n: list(c) for n, c in self.cubes.items()}})

    def wait(self, s):
        for _ in range(round(s * HZ)):
            self.frame()
        return self

    def go(self, to, s=1.0):
        start, n = list(self.p), round(s * HZ)
        for i in range(1, n + 1):
            self.p = [a + (b - a) * i / n for a, b in zip(start, to)]
            self.frame()
        return self

    def grip(self, to, s=0.3):
        start, n = self.trigger, round(s * HZ)
        for i in range(1, n + 1):
            self.trigger = start + (to - start) * i / n
            if self.held and self.trigger < 0.35:
                self.held = None
            self.frame()
        return self

    def take(self, name, beside=0.0):
        x, y, z = self.cubes[name]
        self.go([x, y + beside, z + 0.15]).go([x, y + beside, z])
        if beside:
            return self.grip(1.0).wait(0.3)
        self.grip(0.41, 0.3)
        self.held = name
        return self.wait(0.3).go([x, y, z + 0.15], 0.6)

    def put(self, on, beside=0.0):
        x, y, z = self.cubes[on]
        self.go([x + beside, y, z + 0.2]).go([x + beside, y, SIZE + z if abs(beside) < SIZE else REST], 0.8).wait(0.2)
        self.grip(0.0).wait(0.3)
        return self.go([x + beside, y, z + 0.25], 0.6)

    def lose(self, trigger):
        """Lets go of what it holds: it opens, or the thing slips out and the fingers meet."""
        self.moment = self.now()
        self.held = None
        return self.grip(trigger, 0.2).wait(0.8)

    def kick(self, name, to):
        """Something moves it, and nobody holds it."""
        self.moment = self.now()
        self.cubes[name] = list(to)
        return self.wait(1.0)

    def lines(self, name):
        entities = {"table": {"fixed": True, "size_m": [2, 2, 0.04]}, self.hand: {"hand": True, "size_m": [0.02, 0.1, 0.06]}}
        entities.update({c: {"size_m": [SIZE] * 3} for c in self.cubes})
        head = {"recording": 1, "episode": name, "grammar": "robot_pick_and_place", "ticks_per_second": HZ, "entities": entities}
        if self.success is not None:
            head["success"] = self.success
        out = [head]
        for i, f in enumerate(self.frames):
            samples = {c: {"at_m": f[c]} for c in self.cubes}
            samples[self.hand] = {"at_m": f["g"]}
            if i == 0:
                samples["table"] = {"at_m": [0, 0, -0.02]}
            out.append({"tick": i, "samples": samples, "hands": {self.hand: {"trigger": f["t"]}}})
        return "\n".join(json.dumps(line) for line in out + [{"end_tick": len(self.frames)}]) + "\n"


def stack(take):
    return take.take("cube_2").put("cube_1").take("cube_3").put("cube_2").wait(0.5)


def missed(success, at, hand="gripper"):
    take = Take(success, at, hand).take("cube_2").put("cube_1").take("cube_3", beside=0.06)
    take.moment = take.now() - 0.3
    return take.grip(0.0).go([0, 0.3, 0.3])


def dropped(success, at):
    return Take(success, at).take("cube_2").lose(0.0).go([0, 0.3, 0.3])


def slipped(success, at):
    return Take(success, at).take("cube_2").lose(1.0).go([0, 0.3, 0.3])


def came_off(success, at):
    return Take(success, at).take("cube_2").put("cube_1").kick("cube_2", [0.1 + at, 0.2, REST]).go([0, 0.3, 0.3])


def wrong_target(success, at):
    take = Take(success, at).take("cube_3")
    take.moment = take.now() - 1.0
    return take.put("cube_1").wait(0.5)


def wrong_place(success, at):
    take = Take(success, at).take("cube_2").put("cube_1", beside=-0.15)
    take.moment = take.now() - 1.0
    return take.wait(0.5)


def not_released(success, at):
    take = Take(success, at).take("cube_2").put("cube_1").take("cube_3")
    take.go([take.cubes["cube_2"][0], 0, 3 * SIZE - REST + 0.02]).wait(0.5)
    take.moment = take.now()
    return take


def stopped(success, at):
    take = Take(success, at).take("cube_2").put("cube_1").wait(0.5)
    take.moment = take.now()
    return take


EXPECTED = {missed: "cube_3 missed, gripper closed on nothing", dropped: "cube_2 dropped by gripper",
            slipped: "cube_2 slipped out of gripper", came_off: "cube_2 came off cube_1",
            wrong_target: "cube_3 grasped instead of cube_2", wrong_place: "cube_2 put on table instead of cube_1",
            not_released: "cube_3 not released", stopped: "cube_3 not grasped"}


def report(folder, takes, *options, code=0):
    files = []
    for name, take in takes.items():
        files.append(os.path.join(folder, name + ".jsonl"))
        with open(files[-1], "w", encoding="utf-8") as out:
            out.write(take.lines(name))
    kept = os.path.join(folder, "all.episodes")
    if os.path.exists(kept):
        os.remove(kept)
    for file in files:
        done = subprocess.run([PREHEND, "import", file, "-o", kept], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    page = os.path.join(folder, "page.html")
    run = subprocess.run([PREHEND, "report", kept, "-o", page, *options], capture_output=True, text=True, check=False)
    assert run.returncode == code, run
    return run.stdout, open(page, encoding="utf-8").read(), kept


def causes_of(json_text):
    return {take["episode"]: (group["because"], take["at_s"])
            for group in json.loads(json_text)["demonstrations"]["first_causes"] for take in group["takes"]}


def main():
    with tempfile.TemporaryDirectory() as folder:
        # Where the file says what succeeded, and where it does not; more of one cause than of another.
        for said in (True, False):
            good = {"good_%d" % i: stack(Take(True if said else None, 0.01 * i)) for i in range(3)}
            bad = {"%s_%d" % (make.__name__, i): make(False if said else None, 0.01 * i)
                   for k, make in enumerate(EXPECTED) for i in range(3 if k == 0 else 2 if k == 1 else 1)}
            text, page, kept = report(folder, {**good, **bad}, "--json")
            causes = causes_of(text)
            assert not set(causes) & set(good), causes
            wrong = [(name, causes.get(name), take.moment) for name, take in bad.items() for make in EXPECTED
                     if name.startswith(make.__name__ + "_") and (causes.get(name, ("",))[0] != EXPECTED[make]
                                                                  or abs(causes[name][1] - take.moment) > 0.45)]
            assert not wrong, wrong
            assert json.loads(text)["demonstrations"]["demonstrations"] == 14
            groups = json.loads(text)["demonstrations"]["first_causes"]
            assert [len(group["takes"]) for group in groups][:2] == [3, 2], groups
            for name, (because, at_s) in causes.items():
                assert 'href="#%s@%.4fs"' % (name, at_s) in page, (name, at_s)
            for group in groups:  # each command is one that answers
                answer = subprocess.run(group["takes"][0]["command"].replace("prehend", PREHEND, 1), shell=True,
                                        capture_output=True, text=True, check=False)
                assert answer.returncode == 0, (group, answer.stdout, answer.stderr)
        text = report(folder, {**good, **bad})[0]
        assert "11 of 14 demonstrations failed:\n1. cube_3 missed, gripper closed on nothing: 3\n    missed_0 at " in text, text
        # What is made good is no failure, and not the cause of one.
        again = Take(False).take("cube_2", beside=0.06).grip(0.0).take("cube_2").lose(0.0)
        again = again.take("cube_2").put("cube_1").take("cube_3", beside=0.06).go([0, 0.3, 0.3])
        fine = Take().take("cube_2", beside=0.06).grip(0.0)
        takes = {"good": stack(Take(True)), "again": again, "fine": stack(fine)}
        causes = causes_of(report(folder, takes, "--json")[0])
        assert {name: because for name, (because, _) in causes.items()} == {"again": EXPECTED[missed]}, causes
        # It falls from where the fingers begin to open; what stood before it fell was not dropped.
        def over(high):
            take = Take(False).take("cube_2")
            x, y, z = take.cubes["cube_1"]
            return take.go([x, y, z + 0.2]).go([x, y, z + SIZE + high], 0.8).wait(0.2)

        takes = {"early": over(0.032).lose(0.0), "late": over(0).grip(0.0).wait(0.5).kick("cube_2", [0.1, 0.2, REST])}
        causes = causes_of(report(folder, {**good, **takes}, "--json")[0])
        assert {name: because for name, (because, _) in causes.items()} == {"early": EXPECTED[dropped],
                                                                          "late": EXPECTED[came_off]}, causes
        # Another gripper's name; one failed take alone; nothing is made up where nothing is seen.
        causes = causes_of(report(folder, {"a": missed(False, 0, "left_arm"), "b": stack(Take(False))}, "--json")[0])
        assert causes["a"][0] == "cube_3 missed, left_arm closed on nothing", causes
        assert causes["b"][0] == "no cause was seen", causes
    print("11 planted failures of 8 kinds, with and without 'success': each is named at its moment")


if __name__ == "__main__":
    main()
