#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tests/program/watch_latency.py PREHEND RECORDING.jsonl [GRAMMAR]: how long after the frame that decided it an event is
printed. The recording's frames go through a FIFO to `prehend grammar watch --json` at their own rate, in real time; what is printed
must be the events that `prehend episode resegment` finds. Prints the lags, and ends with 1 if the events differ."""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import threading
import time


def main():
    program, recording = sys.argv[1:3]
    grammar = ["--grammar", sys.argv[3]] if len(sys.argv) > 3 else []
    with open(recording, "rb") as file:
        lines = file.readlines()
    rate = json.loads(lines[0])["ticks_per_second"]
    with tempfile.TemporaryDirectory() as folder:
        fifo = os.path.join(folder, "tracker")
        os.mkfifo(fifo)
        watch = subprocess.Popen([program, "grammar", "watch", fifo, "--json"] + grammar, stdout=subprocess.PIPE)
        sent = {}

        def produce():
            with open(fifo, "wb", buffering=0) as out:
                out.write(lines[0])
                time.sleep(0.5)  # it compiles the grammar
                begin, first = time.monotonic(), None
                for line in lines[1:]:
                    tick = json.loads(line).get("tick")
                    if tick is not None:
                        first = tick if first is None else first
                        wait = begin + (tick - first) / rate - time.monotonic()
                        if wait > 0:
                            time.sleep(wait)
                        sent[tick] = time.monotonic()
                    out.write(line)

        producer = threading.Thread(target=produce)
        producer.start()
        lags, events = [], []
        for line in watch.stdout:
            now = time.monotonic()
            event = json.loads(line)
            events.append(event)
            if event["decided_tick"] in sent:
                lags.append((now - sent[event["decided_tick"]]) * 1e3)
        producer.join()
    found = json.loads(subprocess.run([program, "episode", "resegment", recording, "--json"] + grammar, capture_output=True).stdout)
    key = lambda event: json.dumps(event, sort_keys=True)
    same = sorted(map(key, events)) == sorted(map(key, found["events"]))
    print(f"{len(sent)} frames in {(max(sent) - min(sent)) / rate:.2f} s; {len(events)} events, "
          f"{'the same as' if same else 'NOT those of'} resegment")
    if lags:
        print(f"{len(lags)} lines printed with the frame that decided them: after {statistics.median(lags):.2f} ms (median), "
              f"{max(lags):.2f} ms (longest)")
    return 0 if same else 1


sys.exit(main())
