#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tests/program/watch_map_latency.py PREHEND [SECONDS] [fast] [open]: how long after the frame that decided it an event is printed, of
lines of a table with 2 hands and 18 things at 240 Hz, by a map. `fast`: as fast as they are taken, for memory and processor
time alone; `open`: with --open. Prints percentiles, processor time per frame, and memory after a tenth and at the end."""
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import threading
import time

RATE, THINGS, CYCLE_S = 240, 18, 10


def smooth(t, a, b):
    s = min(max((t - a) / (b - a), 0), 1)
    return s * s * (3 - 2 * s)


def rows_of_cycle():
    """Each hand takes a thing, lifts it, carries it out and back, and puts it down."""
    rows = []
    for i in range(RATE * CYCLE_S):
        t = i / RATE
        cells = []
        for hand, side in enumerate((-1, 1)):
            out = smooth(t, 3, 4.5) - smooth(t, 5, 6.5)
            lift = 0.25 * (smooth(t, 2, 2.8) - smooth(t, 7, 7.8))
            away = 0.4 * (1 - smooth(t, 0.5, 1.5) + smooth(t, 8.2, 9.2))
            thing = (side * 0.3 + side * 0.2 * out, 0.1 * out, 0.77 + lift)
            cells.append(((thing[0] + side * (0.08 + away), thing[1], thing[2] + away / 2), thing))
        poses = [cells[0][0], cells[1][0], cells[0][1], cells[1][1]]
        poses += [(-0.8 + 0.1 * k, 0.5, 0.77) for k in range(THINGS - 2)]
        rows.append("," + ",".join(f"{v:.5f}" for p in poses for v in p) + "\n")
    return rows


def rss_kib(pid):
    with open(f"/proc/{pid}/status", encoding="utf8") as file:
        return int(next(line for line in file if line.startswith("VmRSS")).split()[1])


def main():
    program, seconds = sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 30
    fast, also_open = "fast" in sys.argv, "open" in sys.argv
    names = ["left", "right"] + [f"thing{k}" for k in range(THINGS)]
    entities = "".join(f"  {n}: {{from: {n}, {'hand: true' if k < 2 else 'class: Cup'}, size_m: [0.08, 0.08, 0.1]}}\n"
                       for k, n in enumerate(names))
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "map.yaml")
        with open(path, "w", encoding="utf8") as file:
            file.write("import: 1\nunit: m\naxes: z_up\ntime_unit: s\ncolumns: {time: t, position: ['{}_x', '{}_y', '{}_z']}\n"
                       "entities:\n  table: {at_m: [0, 0.2, 0.7], fixed: true, class: Table, size_m: [3, 2, 0.04]}\n" + entities)
        watch = subprocess.Popen([program, "grammar", "watch", "-", "--map", path, "--json"] + ["--open"] * also_open,
                                 stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0)
        sent, memory, rows, frames = {}, [], rows_of_cycle(), int(seconds * RATE)

        def produce():
            watch.stdin.write(("t," + ",".join(f"{n}_{a}" for n in names for a in "xyz") + "\n").encode())
            begin = time.monotonic() + 0.5
            for i in range(frames):
                line = (f"{i / RATE:.5f}" + rows[i % len(rows)]).encode()
                if not fast and i > 1:
                    wait = begin + i / RATE - time.monotonic()
                    if wait > 0:
                        time.sleep(wait)
                sent[round(i / RATE * 10000)] = time.monotonic()
                if fast and len(sent) > RATE * 60:
                    sent.clear()
                watch.stdin.write(line)
                if i in (frames // 10, frames - 1):
                    memory.append(rss_kib(watch.pid))
            watch.stdin.close()

        producer = threading.Thread(target=produce)
        producer.start()
        lags, events = [], 0
        for line in watch.stdout:
            now, event = time.monotonic(), json.loads(line)
            if "certain" in event:
                continue
            events += 1
            if event["decided_tick"] in sent:
                lags.append((now - sent[event["decided_tick"]]) * 1e3)
        producer.join()
        watch.wait()
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
    lags.sort()
    print(f"{frames} frames, {events} events; {(used.ru_utime + used.ru_stime) / frames * 1e6:.0f} us of processor time a frame; "
          f"memory {memory[0]} KiB after a tenth, {memory[-1]} KiB at the end")
    if lags and not fast:
        print(f"{len(lags)} lines with the frame that decided them: median {statistics.median(lags):.2f} ms, "
              f"99 % {lags[min(len(lags) - 1, len(lags) * 99 // 100)]:.2f} ms, longest {lags[-1]:.2f} ms")


main()
