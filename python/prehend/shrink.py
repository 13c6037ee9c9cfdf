# SPDX-License-Identifier: Apache-2.0
"""python3 -m prehend shrink SCENARIO --keep CONDITION: the smallest scenario, or recording, that still shows it."""
import argparse
import copy
import difflib
import itertools
import json
import os
import re
import subprocess
import sys
import tempfile

from . import _prehend, episodes
from .errors import EpisodeError, amount, fail

LEAST_PLAYS = 500
KINDS = ("missing", "extra", "moved", "verdict", "not")
HEAD = ("scenario", "shows", "expects", "grammar", "world", "entities", "actors", "script")
KEPT_KEYS = {"class", "at_m", "box", "cylinder", "sphere", "hand", "scenario", "shows", "entities"}


def _yaml():
    import yaml  # pylint: disable=import-outside-toplevel

    plain = re.compile("^(?:true|false)$")
    for kind in (yaml.SafeLoader, yaml.SafeDumper):  # `on: table` is no flag
        class Ours(kind):  # pylint: disable=too-many-ancestors
            pass

        Ours.yaml_implicit_resolvers = {key: [one for one in all_ if not one[0].endswith(":bool")]
                                        for key, all_ in kind.yaml_implicit_resolvers.items()}
        Ours.add_implicit_resolver("tag:yaml.org,2002:bool", plain, list("tf"))
        setattr(yaml, "PlainLoader" if kind is yaml.SafeLoader else "PlainDumper", Ours)
    return yaml


def read(file):
    """A scenario as a dict."""
    yaml = _yaml()
    try:
        with open(file, encoding="utf-8") as lines:
            tree = yaml.load(lines, yaml.PlainLoader)
    except (OSError, yaml.YAMLError) as problem:
        fail(EpisodeError, f"{file}: {problem}", file=file)
    if not isinstance(tree, dict) or "scenario" not in tree:
        fail(EpisodeError, f"{file} is no scenario: it has no 'scenario'", file=file)
    return tree


def text_of(tree):
    """A dict as a scenario."""
    yaml = _yaml()

    def flow(value):
        text = yaml.dump(value, Dumper=yaml.PlainDumper, sort_keys=False, default_flow_style=True, width=10 ** 6, allow_unicode=True)
        return text.removesuffix("...\n").strip()

    lines = []
    for key in sorted(tree, key=lambda one: (HEAD.index(one) if one in HEAD else len(HEAD), list(tree).index(one))):
        value = tree[key]
        if key in ("entities", "actors") and value:
            lines += [f"{key}:", *(f"  {name}: {flow(one)}" for name, one in value.items())]
        elif isinstance(value, list) and value and key != "tags":
            lines += [f"{key}:", *(f"  - {flow(one)}" for one in value)]
        else:
            lines.append(f"{key}: {flow(value)}")
    return "\n".join(lines) + "\n"


def missing_in(found, wanted, tolerance):
    """Events of `wanted` that have no partner in `found` whose two ends are so near: "event(a, b)"."""
    left, lacking = list(found), []
    for event in wanted:
        same = [one for one in left if one[:2] == event[:2] and all(abs(a - b) <= tolerance for a, b in zip(one[2:4], event[2:4]))]
        if same:
            left.remove(same[0])
        else:
            lacking.append(f"{event[0]}({', '.join(who for _, who in event[1])})")
    return lacking


class Condition:
    """What has to stay: 'missing EVENT', 'extra EVENT', 'moved EVENT', 'verdict WORD', a claim, or 'not CLAIM'.

    An event that is missing, extra or moved is so beside the physical oracle, or beside another grammar: `against`.
    """

    def __init__(self, text, grammar="", against=""):
        self.text, self.grammar, self.against = text, grammar, against
        self.kind, _, rest = text.strip().partition(" ")
        if not text.strip() or not rest and self.kind in KINDS:
            fail(EpisodeError, f"--keep: found {text!r}, wanted what has to stay", "--keep 'missing putting_down', 'verdict failed' or 'no sliding'")
        self.event = re.compile(re.escape(rest.replace(" ", "")) + (r"\(" if "(" not in rest else "$")) if rest else None
        if self.kind not in KINDS:
            self.kind, rest = "claim", text
        self.claim = rest if self.kind in ("claim", "not") else None
        self.rest = rest

    def check(self, grammars):
        """A word that nothing can ever be is a mistake, and not 'it does not show'."""
        known = ["passed", "failed", "pending"] if self.kind == "verdict" else []
        if self.kind in ("missing", "extra", "moved"):
            known = [one[0] for name in grammars if name for one in _prehend.Grammar(name, {}).events()]
        word = self.rest.partition("(")[0].strip()
        if known and word not in known:
            near = difflib.get_close_matches(word, known, 1)
            fail(EpisodeError, f"--keep: found {self.text!r}, and there is no {'verdict' if self.kind == 'verdict' else 'event'} {word!r}",
                 f"did you mean {near[0]!r}?" if near else f"known: {', '.join(dict.fromkeys(known))}")

    def about(self, lines):
        """Whether one of these events, "event(a, b)", is the one."""
        return any(self.event.match(line.replace(" ", "")) for line in lines)

    def of_check(self, verdict):
        """By what `check --json` says."""
        if self.kind == "verdict":
            return verdict["verdict"] == self.rest
        if self.claim:
            found = [one["verdict"] for one in verdict["claims"] if one["claim"] == self.claim]
            return bool(found) == (self.kind == "not")
        ways = {"missing": r"ground truth: (?!no )(\w+\([^)]*\)) .*, not recognised", "extra": r"ground truth: no (\w+\([^)]*\)), recognised",
                "moved": r"ground truth: (?!no )(\w+\([^)]*\)) .*(?:than recognised|\(recognised)"}
        return self.about(re.findall(ways[self.kind], verdict["details"]))

    def of_episode(self, opened):
        """By both grammars on the same frames."""
        found, wanted = (opened.segment(_prehend.Grammar(one, {}))[0] for one in (self.grammar, self.against))
        ticks = opened.frames()[0]
        tolerance = 2 * int(min(ticks[1:] - ticks[:-1])) if len(ticks) > 1 else 1
        far = 10 ** 15
        lacking = {"missing": missing_in(found, wanted, far), "extra": missing_in(wanted, found, far),
                   "moved": missing_in(found, wanted, tolerance)}[self.kind]
        return self.about(lacking)


class Player:
    """Plays candidates; asks for each text once."""

    def __init__(self, condition, beside, budget):
        self.condition, self.budget, self.seen, self.plays, self.wrong = condition, budget, {}, 0, ""
        self.folder = tempfile.TemporaryDirectory(prefix="prehend_")  # pylint: disable=consider-using-with
        for one in sorted(os.listdir(beside)):  # what the scenario may read from its own folder
            if one.endswith((".grammar", ".csv", ".json", ".jsonl", ".bvh", ".hand.yaml")):
                os.symlink(os.path.abspath(os.path.join(beside, one)), os.path.join(self.folder.name, one))

    def keeps(self, tree):
        text = text_of(tree)
        if text not in self.seen:
            if self.plays >= self.budget:
                return False
            self.plays += 1
            self.seen[text] = self._play(tree, text)
        return self.seen[text]

    def _play(self, tree, text):
        file = os.path.join(self.folder.name, tree["scenario"] + ".yaml")
        if os.path.lexists(file):
            os.unlink(file)
        with open(file, "w", encoding="utf-8") as lines:
            lines.write(text)
        grammar = ["--grammar", self.condition.grammar] if self.condition.grammar else []
        if self.condition.against:
            kept = os.path.join(self.folder.name, "kept.episodes")
            if os.path.exists(kept):
                os.unlink(kept)
            subprocess.run([episodes.program(), "run", file, "--record", kept, "--time-limit-s", "86400", *grammar], capture_output=True, check=False)
            return os.path.exists(kept) and self.condition.of_episode(_prehend.open([kept], "")[0])
        words = ["check", file, "--no-pictures", "--json", "--replay", "none", "--jobs", "1", "--time-limit-s", "86400",
                 "--report", os.path.join(self.folder.name, "report"), *grammar]
        done = subprocess.run([episodes.program(), *words], capture_output=True, text=True, check=False)
        if not done.stdout.startswith("{"):
            self.wrong = done.stderr.strip()
            return False
        verdict = json.loads(done.stdout)["scenarios"][0]
        self.wrong = verdict["details"] or verdict["reason"] if verdict["exit_code"] in (2, 3) else ""
        self.wrong = self.wrong.replace(self.folder.name + os.sep, "").strip()
        return not verdict["errors"] and self.condition.of_check(verdict)


def fewer(items, keeps):
    """Delta debugging: a part of the list of which nothing can be left out. Zeller and Hildebrandt 2002, complements only."""
    parts = 2
    while items and parts <= 2 * len(items):
        size = max(1, len(items) // min(parts, len(items)))
        for begin in range(0, len(items), size):
            rest = items[:begin] + items[begin + size:]
            if keeps(rest):
                items, parts = rest, max(2, parts - 1)
                break
        else:
            if size == 1:
                break
            parts *= 2
    return items


def mentions(value, name):
    """Whether a text of the value is the name, or begins with it and a point."""
    if isinstance(value, dict):
        return any(mentions(one, name) for one in value.values())
    if isinstance(value, list):
        return any(mentions(one, name) for one in value)
    return isinstance(value, str) and name in re.split(r"[.:(), ]+", value)


def without(tree, names):
    """The scenario without these entities and actors, and without the steps that are about them."""
    tree = copy.deepcopy(tree)
    for kind in ("entities", "actors"):
        for name in names:
            tree.get(kind, {}).pop(name, None)
    stages = []
    for stage in tree.get("script", []):
        left = {actor: step for actor, step in stage.items()
                if actor not in names and not any(mentions(step, name) for name in names)}
        stages += [left] if left else []
    if "script" in tree:
        tree["script"] = stages
    if not tree.get("actors", True):
        del tree["actors"]
    return tree


def places(value, path=()):
    """Paths of all values in a tree, the inner ones last."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, one in items:
        yield path + (key,)
        yield from places(one, path + (key,))


def at(tree, path):
    for key in path:
        tree = tree[key]
    return tree


def changed(tree, path, value=None):
    """A copy with another value there; None: without it."""
    tree = copy.deepcopy(tree)
    owner = at(tree, path[:-1])
    if value is None:
        del owner[path[-1]]
    else:
        owner[path[-1]] = value
    return tree


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def rounded(value, digits):
    """With so many decimals; what would become nothing stays."""
    other = round(value, digits)
    return value if other == 0 else int(other) if other == int(other) else other


def all_rounded(value, digits):
    if isinstance(value, dict):
        return {key: all_rounded(one, digits) for key, one in value.items()}
    if isinstance(value, list):
        return [all_rounded(one, digits) for one in value]
    return rounded(value, digits) if isinstance(value, float) else value


def fewer_parts(tree, keeps):
    """Fewer steps, which take the time, then actors, entities and keys of the file."""
    if "script" in tree:
        tree = {**tree, "script": fewer(tree["script"], lambda some: keeps({**tree, "script": some}))}
    for kind in ("actors", "entities"):
        names = list(tree.get(kind, {}))
        left = fewer(names, lambda some, all_=names, now=tree: keeps(without(now, [one for one in all_ if one not in some])))
        tree = without(tree, [one for one in names if one not in left])
    for key in [one for one in tree if one not in KEPT_KEYS | {"actors", "script", "expects"}]:
        if keeps(changed(tree, (key,))):
            tree = changed(tree, (key,))
    return tree


def merged(value, gone, other):
    """With the other one's name in the place of the one that is gone."""
    if isinstance(value, dict):
        return {key: merged(one, gone, other) for key, one in value.items() if key != gone}
    if isinstance(value, list):
        return [merged(one, gone, other) for one in value]
    return re.sub(rf"\b{gone}\b", other, value) if isinstance(value, str) else value


def merge_two(tree, keeps):
    """One of the last entities in the place of another one, if need be without the step that leads from one to the other."""
    names = list(tree.get("entities", {}))
    for gone, other in itertools.permutations(names, 2) if 2 < len(names) <= 4 and "script" in tree else ():
        one = merged(tree, gone, other)
        for out in range(-1, len(one["script"])):
            now = {**one, "script": [step for i, step in enumerate(one["script"]) if i != out]}
            if keeps(now):
                return now
    return tree


def elsewhere(tree, keeps):
    """A thing that is fixed and needs no support; or one that falls onto another one while nobody acts."""
    for name, other in itertools.permutations(tree.get("entities", {}), 2):
        thing, at_m = tree["entities"][name], tree["entities"][other].get("at_m", [])
        if "on" in thing and len(at_m) == 3 and len(thing.get("at_m", [])) == 2:
            idle = {key: one for key, one in tree.items() if key != "actors"} | {"script": []}
            falls = {key: one for key, one in thing.items() if key != "on"} | {"at_m": [*at_m[:2], at_m[2] + 0.2]}
            fixed = {key: one for key, one in falls.items() if key != "mass_kg"} | {"fixed": True, "at_m": [*thing["at_m"], at_m[2] + 0.2]}
            for now, one in ((tree, fixed), (idle, falls))[:1 + bool(tree.get("script"))]:
                now = {**now, "entities": {**now["entities"], name: one}}
                if keeps(now):
                    return now
    return tree


def simpler_values(tree, keeps):
    """Fewer keys of steps and entities, then shorter times and fewer decimals: of all at once, if that does, else of each."""
    for path in reversed(list(places(tree))):
        is_key = len(path) > 1 and isinstance(path[-1], str) and path[-1] not in KEPT_KEYS and path[0] in ("entities", "actors", "script")
        if is_key and len(at(tree, path[:-1])) > 1 and keeps(changed(tree, path)):
            tree = changed(tree, path)
    for path in [one for one in places(tree) if str(one[-1]).endswith("_s") and is_number(at(tree, one))]:
        value = at(tree, path)
        for other in (0.1, *(rounded(value / part, 1 if value >= 1 else 2) for part in (4, 2))):
            if other < value and keeps(changed(tree, path, other)):
                tree = changed(tree, path, other)
                break
    for digits in (1, 2):
        if keeps(all_rounded(tree, digits)):
            return all_rounded(tree, digits)
    for path in [one for one in places(tree) if isinstance(at(tree, one), float)]:
        for digits in (1, 2):
            other = rounded(at(tree, path), digits)
            if other != at(tree, path) and keeps(changed(tree, path, other)):
                tree = changed(tree, path, other)
                break
    return tree


def shrink(tree, player):
    """The scenario with fewer entities, steps, keys, seconds and decimals; the same result every time."""
    if not player.keeps(tree):
        fail(EpisodeError, player.wrong or "the scenario does not show what is to be kept",
             "" if player.wrong else "play it: prehend check SCENARIO; or name another --keep")
    before = None
    while before != tree:
        before = tree
        tree = elsewhere(merge_two(fewer_parts(tree, player.keeps), player.keeps), player.keeps)
    return simpler_values(tree, player.keeps)


def shrink_recording(lines, keeps):
    """A recording with fewer bodies and a shorter window."""
    head, frames, end = lines[0], [one for one in lines[1:] if "tick" in one], [one for one in lines[1:] if "end_tick" in one]

    def part(names, first, last):
        known, kept = {}, []
        gone = set(head["entities"]) - set(names)
        for frame in frames[:last]:
            samples = {who: look for who, look in frame.get("samples", {}).items() if who not in gone}
            known.update(samples)
            kept.append({**frame, "samples": samples,
                         "hands": {who: one for who, one in frame.get("hands", {}).items() if who not in gone},
                         "touches": [one for one in frame.get("touches", []) if not {one["a"], one["b"]} & gone]})
            if len(kept) == first + 1:
                kept[-1]["samples"] = dict(known)
        entities = {who: {key: one for key, one in what.items() if key != "part_of" or one not in gone}
                    for who, what in head["entities"].items() if who not in gone}
        return [{**head, "entities": entities}, *kept[first:], *(end if last == len(frames) else [{"end_tick": frames[last]["tick"]}])]

    names, first, last = list(head["entities"]), 0, len(frames)
    if not keeps(part(names, first, last)):
        fail(EpisodeError, "the recording does not show what is to be kept", "name another --keep, or another --against")
    names = fewer(names, lambda some: bool(some) and keeps(part(some, 0, last)))
    step = len(frames) // 2
    while step > 0:  # the same from both ends, by ever smaller steps
        while last - step > first and keeps(part(names, first, last - step)):
            last -= step
        while first + step < last and keeps(part(names, first + step, last)):
            first += step
        step //= 2
    return part(names, first, last)


def _recording(asked, condition):
    if condition.kind not in ("missing", "extra", "moved") or not condition.against or not condition.grammar:
        fail(EpisodeError, "a recording shows a difference of two grammars", "--keep 'missing EVENT' --grammar G --against OTHER")
    condition.check([asked.grammar, asked.against])
    with tempfile.TemporaryDirectory(prefix="prehend_") as folder:
        file = os.path.join(folder, "part.jsonl")

        def keeps(lines):
            with open(file, "w", encoding="utf-8") as out:
                out.writelines(json.dumps(line) + "\n" for line in lines)
            return condition.of_episode(_prehend.open([file], "")[0])

        with open(asked.SCENARIO, encoding="utf-8") as text:
            lines = [json.loads(line) for line in text if line.strip()]
        kept = shrink_recording(lines, keeps)
    return "".join(json.dumps(line) + "\n" for line in kept), \
        f"{len(kept[0]['entities'])} of {len(lines[0]['entities'])} bodies, {len(kept) - 2} of {len(lines) - 2} frames"


def _scenario(asked, condition):
    tree = read(asked.SCENARIO)
    condition.check([asked.grammar or str(tree.get("grammar", "pick_and_place")), asked.against])
    player = Player(condition, os.path.dirname(os.path.abspath(asked.SCENARIO)), asked.budget)
    before = copy.deepcopy(tree)
    tree["scenario"] = os.path.splitext(os.path.basename(asked.output or asked.SCENARIO))[0]
    tree.pop("expects", None)
    tree.update({"expects": [condition.claim]} if condition.claim else {})
    tree = shrink(tree, player)
    tree["shows"] = f"{condition.text}: a part of {before['scenario']}"
    count = lambda one: f"{len(one.get('entities', {}))} entities, {len(one.get('script', []))} steps"
    return text_of(tree), f"{count(before)} -> {count(tree)}, {player.plays} plays"


def main(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m prehend shrink", description=__doc__, epilog=Condition.__doc__)
    parser.add_argument("SCENARIO", help="a file .yaml; or a recording, .jsonl")
    parser.add_argument("--keep", required=True, metavar="CONDITION", help="'missing putting_down', 'extra sliding(right_hand, cup)', "
                        "'moved grasping', 'verdict failed', 'no sliding', 'not one grasping'")
    parser.add_argument("--grammar", default="", metavar="NAME|FILE")
    parser.add_argument("--against", default="", metavar="NAME|FILE", help="another grammar; default: the physical oracle")
    parser.add_argument("--budget", type=amount(int, 1), default=LEAST_PLAYS, metavar="N", help="plays at most; default: %(default)s")
    parser.add_argument("-o", "--output", metavar="FILE", help="default: print it")
    asked = parser.parse_args(arguments)
    if asked.against and not asked.grammar and not asked.SCENARIO.endswith(".jsonl"):
        asked.grammar = str(read(asked.SCENARIO).get("grammar", "pick_and_place"))
    condition = Condition(asked.keep, asked.grammar, asked.against)
    text, says = (_recording if asked.SCENARIO.endswith(".jsonl") else _scenario)(asked, condition)
    write(asked.output, text)
    print(f"prehend: {says}", file=sys.stderr)
    return 0


def write(file, text):
    """Prints it, or writes it as a whole or not at all."""
    if not file:
        sys.stdout.write(text)
        return
    if os.path.exists(file) and {"golden", "scenarios", "grammars", "library"} & set(os.path.abspath(file).split(os.sep)):
        fail(EpisodeError, f"{file} is there already, and the project's own", "write it elsewhere: -o small.yaml", file)
    try:
        with open(file + ".part", "w", encoding="utf-8") as lines:
            lines.write(text)
        os.replace(file + ".part", file)
    except OSError as problem:
        fail(EpisodeError, f"{file} cannot be written: {problem.strerror}", file=file)
