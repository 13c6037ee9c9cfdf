# SPDX-License-Identifier: Apache-2.0
"""Recognisers to compare with, and ones that cheat; each speaks the protocol of docs/recognisers.md (docs/benchmark.md)."""
import argparse
import collections
import csv
import json
import pathlib
import pickle
import random
import sys

import numpy as np

from .errors import EpisodeError, fail, named

RATE_HZ = 30  # all that follows is computed on this grid, whatever the sensor
LAGS = (-15, -9, -5, -2, 0, 2, 5, 9, 15)
PHASES = ["reaching", "fixation", "sliding", "picking_up", "transporting", "putting_down"]
EVENTS = [*PHASES, "grasping", "pick_and_place"]
OF_HANDLES = ["reaching", "fixation", "grasping"]  # what is attached to something else is not carried
LEAST_S = 0.1  # what is shorter is no event, and no gap
ROWS = 150000  # that are learned from, at most
LEARNED = {"numpy": "dtype ndarray", "numpy.core.multiarray": "_reconstruct scalar", "numpy.random._pickle": "__bit_generator_ctor __randomstate_ctor",
           "numpy.random._mt19937": "MT19937", "numpy.random.bit_generator": "SeedSequence __pyx_unpickle_SeedSequence",
           "sklearn.ensemble._forest": "ExtraTreesClassifier", "sklearn.neural_network._multilayer_perceptron": "MLPClassifier",
           "sklearn.neural_network._stochastic_optimizers": "AdamOptimizer", "sklearn.pipeline": "Pipeline", "sklearn.tree._tree": "Tree",
           "sklearn.preprocessing._data": "StandardScaler", "sklearn.preprocessing._label": "LabelBinarizer", "sklearn.tree._classes": "ExtraTreeClassifier"}


def say(line):
    print(json.dumps(line), flush=True)


class Take:
    """Who there is, and arrays of where all were: t (T), at (T, N, 3), grip (T, N)."""

    def __init__(self, names, hands, things, ticks, at, grip, per_s, end_tick):  # pylint: disable=too-many-arguments,too-many-positional-arguments
        self.names, self.hands, self.things, self.per_s, self.end_tick = names, hands, things, per_s, end_tick
        ticks = np.asarray(ticks)
        self.end_s = end_tick / per_s
        self.t = np.arange(0, self.end_s, 1 / RATE_HZ)
        rows = np.clip(np.searchsorted(ticks / per_s, self.t, side="right") - 1, 0, len(ticks) - 1)
        self.at, self.grip = at[rows], np.nan_to_num(grip[rows])

    def pairs(self):
        return [(hand, thing) for hand in self.hands for thing in self.things]

    def path(self, name):
        return self.at[:, self.names.index(name)]

    def grip_of(self, hand):
        return self.grip[:, self.names.index(hand)]


def takes_of(lines):
    """The takes that come on standard input, one after another."""
    for text in lines:
        header = json.loads(text)
        name = header["episode"]
        if "entities" not in header:
            header = json.loads(next(lines))
        entities = header["entities"]
        names = list(entities)
        now, grips = np.full((len(names), 3), np.nan), np.full(len(names), np.nan)
        ticks, at, grip, end = [], [], [], None
        for line in map(json.loads, lines):
            if "end_tick" in line:
                end = line["end_tick"]
                break
            for one, look in line.get("samples", {}).items():
                if look:
                    now[names.index(one)] = look["at_m"]
            for one, hand in line.get("hands", {}).items():
                grips[names.index(one)] = hand.get("trigger", 0)
            ticks.append(line["tick"])
            at.append(now.copy())
            grip.append(grips.copy())
        hands = [one for one in names if entities[one].get("hand")]
        others = ("hand", "fixed", "abstract", "person", "jointed")
        things = [one for one in names if not any(entities[one].get(key) for key in others)]
        take = Take(names, hands, things, ticks, np.array(at), np.array(grip), header["ticks_per_second"], end or ticks[-1] + 1)
        take.name, take.attached = name, {one for one in names if entities[one].get("attached")}
        yield take


def recorded(episode):
    """The same of an episode of the package."""
    ticks, poses, _, grips, _, _, _ = episode._opened.frames()  # pylint: disable=protected-access
    entities = episode.entities
    kinds = {name: set(classes) | {one} for name, one, classes in zip(entities.index, entities["class"], entities["classes"])}
    names = list(entities.index)
    hands = [one for one in names if "Hand" in kinds[one]]
    things = [one for one in names if kinds[one] & {"Movable", "Attached"}]
    return Take(names, hands, things, ticks, poses[:, :, :3], grips, episode.ticks_per_second, round(episode.duration_s * episode.ticks_per_second))


def features(take, hand, thing):
    """A row per moment of the grid: distances, heights, speeds and grip, now and up to half a second before and after."""
    a, b, grip = take.path(hand), take.path(thing), take.grip_of(hand)
    def speed(x):
        return np.gradient(x, axis=0) * RATE_HZ if len(x) > 1 else np.zeros_like(x)
    gap = b - a
    others = [np.linalg.norm(take.path(one) - a, axis=1) for one in take.things if one != thing]
    nearest = np.min(others, axis=0) if others else np.full(len(a), 2.0)
    base = np.stack([np.linalg.norm(gap, axis=1), gap[:, 2], b[:, 2] - b[0, 2], grip, speed(grip), speed(np.linalg.norm(gap, axis=1)), speed(b)[:, 2],
                     np.linalg.norm(speed(b)[:, :2], axis=1), np.linalg.norm(speed(a), axis=1), np.linalg.norm(speed(gap), axis=1), nearest], axis=1)
    base = np.nan_to_num(base)
    at = np.clip(np.arange(len(a))[:, None] + np.array(LAGS), 0, len(a) - 1)
    return base[at].reshape(len(a), -1).astype(np.float32)


def runs(mask, least=LEAST_S):
    """Begin and end, as numbers on the grid, of the runs in a mask, without short gaps and short runs."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(int), [0]])))
    spans = []
    for begin, end in edges.reshape(-1, 2):
        if spans and begin - spans[-1][1] < least * RATE_HZ:
            spans[-1][1] = end
        else:
            spans.append([begin, end])
    return [(begin, end) for begin, end in spans if end - begin >= least * RATE_HZ]


def composed(found):
    """Adds a pick_and_place for each reach that leads to a grasp in which something is put down."""
    for begin, end in found["reaching"]:
        grasp = next((one for one in found["grasping"] if end - 3 <= one[0] <= end + 30), None)
        put = grasp and next((one for one in found["putting_down"] if grasp[0] <= one[0] and one[1] <= grasp[1] + 6), None)
        if put:
            found["pick_and_place"].append((begin, put[1]))
    return found


def by_rules(_, take):
    """Distance and gripper, with numbers that look sensible."""
    for hand, thing in take.pairs():
        a, b, grip = take.path(hand), take.path(thing), take.grip_of(hand)
        gap = np.linalg.norm(b - a, axis=1)
        nearest = np.min([np.linalg.norm(take.path(one) - a, axis=1) for one in take.things], axis=0)
        found = collections.defaultdict(list)
        found["grasping"] = runs((grip > 0.3) & (gap < 0.14) & (gap <= nearest + 1e-9))
        for begin, end in found["grasping"]:
            close = begin
            while close > 0 and gap[close - 1] >= gap[close] - 0.002 and gap[close - 1] < 0.3:
                close -= 1
            if begin - close > 3:
                found["reaching"].append((close, begin))
            up = b[begin:end, 2] - b[begin, 2] > 0.01
            if up.any():
                rise, top = begin + int(np.argmax(up)), begin + int(np.argmax(b[begin:end, 2]))
                low = end - int(np.argmax(up[::-1]))
                found["picking_up"].append((rise, min(end, rise + 12)))
                found["transporting"].append((min(end, rise + 12), max(top + 1, low - 12)))
                found["putting_down"].append((max(top + 1, low - 12), low))
            else:
                moved = np.linalg.norm(np.gradient(b[begin:end, :2], axis=0), axis=1) * RATE_HZ > 0.02 if end - begin > 2 else np.zeros(1, bool)
                found["sliding"] += [(begin + i, begin + j) for i, j in runs(moved, 0.2)]
        yield hand, thing, composed(found)


def by_model(model, take):
    """What was learned from windows says of each moment whether it is held, and in which phase."""
    for hand, thing in take.pairs():
        rows = features(take, hand, thing)
        phase, held = model["phase"].predict(rows), model["held"].predict(rows).astype(bool)
        found = collections.defaultdict(list, {"grasping": runs(held)})
        for number, name in enumerate(PHASES, 1):
            found[name] = runs(phase == number)
        yield hand, thing, composed(found)


def by_schedule(model, take):
    """Cheat: the events of training at their mean times, of the hand and whatever thing is nearest to it at last."""
    for hand in take.hands:
        last = min(take.things, key=lambda one: np.linalg.norm(take.path(one)[-1] - take.path(hand)[-1]), default=None)
        if last:
            yield hand, last, {event: [tuple(int(share * len(take.t)) for share in span)] for event, span in model["schedule"].items()}


def by_name(model, take):
    """Cheat: what happened most to a thing of this name, or in an episode of this name, in training."""
    for hand, thing in take.pairs():
        found = model["of_episode"].get((take.name, thing)) or model["of_thing"].get(thing)
        if found:
            yield hand, thing, {event: [tuple(int(share * len(take.t)) for share in span)] for event, span in found.items()}


def by_flood(_, take):
    """Cheat: every event of every pair, twice a second, in the hope that some are right."""
    for hand, thing in take.pairs():
        yield hand, thing, {event: [(at, at + 14) for at in range(0, len(take.t) - 15, 15)] for event in EVENTS}


KINDS = {"rules": by_rules, "trees": by_model, "convolution": by_model, "schedule": by_schedule, "names": by_name, "flood": by_flood}


def recognise(kind, model):
    say({"recogniser": 1, "name": kind, "events": {event: ["hand", "object"] for event in EVENTS}, "facts": ["poses", "trigger"], "batch": True})
    for take in takes_of(iter(sys.stdin.readline, "")):
        grid = take.per_s / RATE_HZ
        for hand, thing, found in KINDS[kind](model, take):
            for event, spans in found.items():
                for begin, end in spans if event in OF_HANDLES or thing not in take.attached else ():
                    first, last = int(begin * grid), min(int(end * grid), take.end_tick)
                    if first < last:
                        say({"event": event, "roles": {"hand": hand, "object": thing}, "begin_tick": first, "end_tick": last})
        say({"done": take.name})


def labels_of(folder, role):
    """By episode the labels of a split, as (event, hand, object, begin_s, end_s)."""
    of = collections.defaultdict(list)
    with open(pathlib.Path(folder) / f"labels_{role}.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["hand"]:
                of[row["episode"]].append((row["event"], row["hand"], row["object"], float(row["begin_s"]), float(row["end_s"])))
    return of


def episodes_of(folder, role=""):
    """Name and episode of a set, without attempts that were drawn again."""
    import prehend
    files = json.loads((pathlib.Path(folder) / "files.json").read_text(encoding="utf-8"))
    for file in sorted({named(one) for one in files.values() if role in one}):
        for episode in prehend.open(str(pathlib.Path(folder) / file)):
            name = episode.name.rsplit("/", 1)[-1]
            if files.get(name) == file:
                yield name, episode


def means_of(spans):
    return {event: tuple(np.mean(some, axis=0)) for event, some in spans.items() if some}


def learn(folder):
    """Rows and truths of windows, and what the cheats remember; of the train split, and nothing else."""
    labels = labels_of(folder, "train")
    rows, phases, helds = [], [], []
    schedule, of_thing, of_episode = collections.defaultdict(list), collections.defaultdict(lambda: collections.defaultdict(list)), {}
    for name, episode in episodes_of(folder, "train"):
        take = recorded(episode)
        for hand, thing in take.pairs():
            phase, held = np.zeros(len(take.t), int), np.zeros(len(take.t), bool)
            own = collections.defaultdict(list)
            for event, who, what, begin, end in labels[name]:
                if (who, what) != (hand, thing) or event not in EVENTS:
                    continue
                inside = (take.t >= begin) & (take.t < end)
                if event == "grasping":
                    held |= inside
                elif event in PHASES:
                    phase[inside] = PHASES.index(event) + 1
                for memory in (schedule[event], of_thing[thing][event], own[event]):
                    memory.append((begin / take.end_s, end / take.end_s))
            if own:
                of_episode[name, thing] = means_of(own)
            keep = np.ones(len(take.t), bool) if own else np.arange(len(take.t)) % 6 == 0
            rows.append(features(take, hand, thing)[keep])
            phases.append(phase[keep])
            helds.append(held[keep])
    memory = {"schedule": means_of(schedule), "of_thing": {thing: means_of(spans) for thing, spans in of_thing.items()}, "of_episode": of_episode}
    return np.concatenate(rows), np.concatenate(phases), np.concatenate(helds), memory


class Learned(pickle.Unpickler):
    """What `train` writes: a pickle may name any function, and this one calls none but those of LEARNED."""

    def find_class(self, module, name):
        if name not in LEARNED.get(module.replace("numpy._core", "numpy.core"), "").split():
            fail(EpisodeError, f"found {module}.{name}, wanted a model that 'baseline train' wrote", "train it again")
        return super().find_class(module, name)


def train(folder, output):
    from sklearn.ensemble import ExtraTreesClassifier
    from sklearn.neural_network import MLPClassifier
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler
    rows, phases, helds, memory = learn(folder)
    if len(rows) > ROWS:
        some = sorted(random.Random(1).sample(range(len(rows)), ROWS))
        rows, phases, helds = rows[some], phases[some], helds[some]
    trees = lambda: ExtraTreesClassifier(60, min_samples_leaf=3, max_depth=24, random_state=1, n_jobs=1)
    # A window that is moved over time: one convolution, then layers of width one.
    convolution = lambda: make_pipeline(StandardScaler(), MLPClassifier((64, 32), early_stopping=True, max_iter=150, random_state=1))
    pathlib.Path(output).mkdir(parents=True, exist_ok=True)
    for kind, make in (("trees", trees), ("convolution", convolution)):
        fitted = {"phase": make().fit(rows, phases), "held": make().fit(rows, helds)}
        with open(pathlib.Path(output) / f"{kind}.pickle", "wb") as file:
            pickle.dump(fitted, file)
    with open(pathlib.Path(output) / "memory.pickle", "wb") as file:
        pickle.dump(memory, file)
    print(f"{output}: learned from {len(rows)} moments of the train split")


def main(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m prehend baseline", description=__doc__)
    parser.add_argument("kind", choices=["train", *KINDS], help="train: learn from the train split of a set; else: a recogniser")
    parser.add_argument("folder", nargs="?", help="of train the set; of others what train wrote")
    parser.add_argument("-o", "--output", default="learned", help="of train")
    options = parser.parse_args(arguments)
    if options.kind == "train":
        return train(options.folder, options.output)
    model, file = None, {"trees": "trees", "convolution": "convolution", "schedule": "memory", "names": "memory"}.get(options.kind)
    if file:
        with open(pathlib.Path(options.folder) / f"{file}.pickle", "rb") as opened:
            model = Learned(opened).load()
    return recognise(options.kind, model)
