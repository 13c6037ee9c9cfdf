#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How often `prehend import` guesses wrong: prints a table, of which docs/motion-capture.md has the sums.

    python3 tests/program/import_guesses.py build/test/prehend [TAKES] [SEED]

Of TAKES takes whose map is right (tests/program/guessed_takes.py) none may be refused, and each guess may be wrong in 1 % of them.
Of TAKES takes with one fault, drawn alike from all kinds of faults, 95 % must be named. The exit code is 1 otherwise.
"""
import collections
import pathlib
import re
import subprocess
import sys
import tempfile

from guessed_takes import AXES, Take
from made_takes import add, length, rotate

# What names a fault, and says something that is not so where there is none.
SAYS = {
    "unit": r"unit: (m|cm|mm)\b|correct unit|is unit right", "axes": r"looks? up", "tilt": r"plane that is tilted",
    "table": r"what it stands on could be|nothing tracked comes nearer", "trembling": r"tremble",
    "order": r"quaternion_order: ", "handedness": r"handed: left", "fractions": r"fractions of an image",
    "upright": r"away from upright", "time": r"rate_hz: |time_unit|times look like", "zero": r"exactly 0, 0, 0",
    "outlier": r"out and back|jumps \d+ time", "exchange": r"exchanged",
}
# A fault of one kind may be named as what it looks like.
ALSO = {"fractions": ("unit",), "exchange": ("outlier",), "zero": ("outlier",)}


def said_of(prehend, take, folder):
    poses, text = take.files()
    folder = pathlib.Path(folder)
    (folder / "poses.csv").write_text(poses)
    (folder / "map.yaml").write_text(text)
    run = subprocess.run([prehend, "import", folder / "poses.csv", "--map", folder / "map.yaml", "--check"],
                         capture_output=True, text=True)
    return run.returncode, run.stderr


def names(take, fault, said):
    """Whether the words name this fault, with the right remedy where there is one."""
    if fault == "unit":
        return bool(re.search(r"unit: %s\b" % take.unit, said))
    if fault == "axes":
        return bool(re.search(r"axes: %s\b" % take.axes, said))
    if fault == "tilt":
        up = re.search(r"up: \[([-\d.e]+), ([-\d.e]+), ([-\d.e]+)\]", said)
        true = AXES[take.axes](rotate(take.turn, [0, 0, 1]))
        return bool(up) and length(add([float(x) for x in up.groups()], true, -1)) < 0.07  # 4 degrees
    if fault == "order":
        return "quaternion_order: " + take.order in said
    return any(re.search(SAYS[word], said) for word in (fault, *ALSO.get(fault, ())))


def main():
    prehend, takes, seed = sys.argv[1], int((sys.argv[2:] or ["500"])[0]), int((sys.argv[3:] or ["1"])[0])
    tell = len(sys.argv) > 4
    wrong, refused, missed, planted = collections.Counter(), 0, collections.Counter(), collections.Counter()
    with tempfile.TemporaryDirectory() as folder:
        for i in range(takes):
            take = Take(1000000 * seed + i)
            code, said = said_of(prehend, take, folder)
            refused += code != 0
            found = [word for word, says in SAYS.items() if re.search(says, said)]
            wrong.update(found)
            if tell and (found or code):
                print("right", 1000000 * seed + i, take.kind, code, said)
        for i in range(takes):
            fault = Take.FAULTS[i % len(Take.FAULTS)]
            # Nobody sees what is not there: a table or an upright thing needs something that stands, a tilt three things on one
            # level, handedness two hands with names.
            kinds = {"table": ("table", "shelf", "small"), "upright": ("table", "shelf", "box"), "tilt": ("table",),
                     "handedness": ("table", "shelf", "box"), "axes": ("table", "shelf", "box", "small")}.get(fault)
            for draw in range(50):
                take = Take(1000000 * seed + 500000 + 50 * i + draw, fault, kinds and kinds[(i // 13) % len(kinds)])
                things = len(take.scene.bodies) - len(take.scene.hands)
                if (fault != "handedness" or len(take.scene.hands) == 2) and (fault != "tilt" or things >= 3):
                    break
            code, said = said_of(prehend, take, folder)
            planted[fault] += 1
            if not names(take, fault, said):
                missed[fault] += 1
                if tell:
                    print("missed", fault, take.kind, code, said)
    print("| guess | false alarms, of %d | faults not named |\n|---|---|---|" % takes)
    for word in SAYS:
        print("| %s | %d | %d of %d |" % (word, wrong[word], missed[word], planted[word]))
    print("refused though right: %d of %d" % (refused, takes))
    # A small sample tells little: one guess may be wrong, and three faults missed.
    bad = refused or any(n > max(takes / 100, 1) for n in wrong.values()) or sum(missed.values()) > max(takes / 20, 3)
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
