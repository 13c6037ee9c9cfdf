# SPDX-License-Identifier: Apache-2.0
"""python3 conformance.py PREHEND [EPISODES [SEED]]: the kit of this folder, played by prehend and by meaning.py, and then so
many random recordings for each grammar, of which the two must say the same."""
import json
import pathlib
import random
import subprocess
import sys
import tempfile

from meaning import Meaning

CASES = pathlib.Path(__file__).parent / "cases"
ENTITIES = {"hand": {"hand": True}, "cup": {"class": "Cup"}, "mug": {"class": "Cup"}, "drum": {"class": "Drum", "fixed": True},
            "bell": {"class": "Bell"}}


def recording(seed, name, frames):
    """One entity after another touches the hand or does not; cups rise, sink and are lost; frames come when they like."""
    rng = random.Random(seed)
    calm, uneven, tick, touched, height, lost = rng.randint(2, 7), rng.random() < 0.5, 0, set(), {}, {}
    lines = [{"recording": 1, "episode": name, "grammar": name, "ticks_per_second": 1000, "bridge_s": 0,
              "entities": {who: {**entity, "size_m": [0.1, 0.1, 0.1]} for who, entity in ENTITIES.items()}}]
    for frame in range(frames):
        samples = {}
        for who in ENTITIES:
            if who != "hand" and rng.randrange(calm) == 0:
                touched ^= {who}
            is_lost = who in ("cup", "mug") and (lost.get(who) or 0) > 0
            if frame == 0 or is_lost or who in ("cup", "mug") and rng.randrange(calm) == 0:
                lost[who] = (lost.get(who) or 0) - 1 if is_lost else rng.choice([0, 0, 0, rng.randint(1, 5)])
                height[who] = rng.randint(0, 3) if who in ("cup", "mug") else 1
                samples[who] = None if lost[who] > 0 and who != "hand" else {"at_m": [0, 0, height[who]]}
        lines.append({"tick": tick, "samples": samples, "touches": [{"a": "hand", "b": who} for who in sorted(touched)]})
        tick += rng.choice([3, 5, 10, 10, 25]) if uneven else 10
    return "".join(json.dumps(line) + "\n" for line in [*lines, {"end_tick": tick}])


def in_order(events):
    return sorted(json.dumps(event, sort_keys=True) for event in events)


def played(prehend, grammar, text):
    with tempfile.NamedTemporaryFile("w", suffix=".jsonl") as file:
        file.write(text)
        file.flush()
        done = subprocess.run([prehend, "episode", "resegment", file.name, "--grammar", str(grammar), "--json"],
                              capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stdout + done.stderr)
    keys = ("event", "roles", "begin_tick", "end_tick")
    return [{key: event[key] for key in keys} for event in json.loads(done.stdout)["events"]]


def main(prehend, episodes=3, seed=1):
    wrong = seen = 0
    for grammar in sorted(CASES.glob("*.grammar")):
        case = grammar.with_suffix(".jsonl")
        texts = [recording(f"{seed}/{grammar.stem}/{i}", grammar.stem, 60) for i in range(int(episodes))]
        events_file = grammar.with_suffix(".events.jsonl")
        for text in [case.read_text(), *texts]:
            meant = in_order(Meaning(grammar.read_text(), text).events())
            found = {"prehend": in_order(played(prehend, grammar, text))}
            if text == case.read_text():
                found["its events"] = in_order(map(json.loads, events_file.read_text().splitlines()))
            for who, events in found.items():
                seen += len(events)
                if events == meant:
                    continue
                wrong += 1
                kept = pathlib.Path(tempfile.gettempdir(), "differs.jsonl")
                kept.write_text(text)
                print(f"{grammar} on {kept}: only by meaning.py:", *sorted(set(meant) - set(events)), f"only by {who}:",
                      *sorted(set(events) - set(meant)), sep="\n  ")
    print(f"{seen} events, {wrong} recordings differ")
    return wrong > 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
