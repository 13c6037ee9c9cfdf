#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No Prolog outlives the `prehend episode ask` that started it, at whatever moment that is killed.

    python3 tests/knowledge/killed_asks.py PREHEND KILLS

A query without an end is asked KILLS times and killed by SIGKILL up to a second later. Within five seconds no process may be left that
has the folder's name in its command line; the exit code is 1 otherwise.
"""
import pathlib
import random
import subprocess
import sys
import tempfile
import time


def those_with(word):
    found = []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            line = (process / "cmdline").read_bytes()
        except OSError:
            continue
        if word.encode() in line:
            found.append(line.split(b"\0")[0].decode())
    return found


def main():
    prehend, kills = sys.argv[1], int(sys.argv[2])
    moments, ran, left = random.Random(3), 0, []
    with tempfile.TemporaryDirectory(prefix="killed_asks_") as folder:
        (pathlib.Path(folder) / "prehend.ttl").write_text("# nothing is known\n")
        for _ in range(kills):
            asked = subprocess.Popen([prehend, "episode", "ask", folder, "between(1, inf, X), X < 0", "--time-limit-s", "60"],
                                     stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(moments.random())
            ran += any("swipl" in name for name in those_with(folder))
            asked.kill()
            asked.wait()
            end = time.monotonic() + 5
            while (left := those_with(folder)) and time.monotonic() < end:
                time.sleep(0.01)
            if left:
                sys.exit(f"after a kill there are still: {left}")
    print(f"{kills} kills, Prolog ran at {ran} of them, none is left")
    if ran == 0:
        sys.exit("Prolog ran at none of them")


if __name__ == "__main__":
    main()
