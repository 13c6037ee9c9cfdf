# SPDX-License-Identifier: Apache-2.0
"""Data sets from a recipe: scenarios, played, with the labels of three witnesses and splits (docs/benchmark.md)."""
import argparse
import collections
import csv
import datetime
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import tempfile

from . import recipe as recipes
from . import scenes
from .episodes import program
from .errors import EpisodeError, amount, cell, fail, named
from .robustness import PLAYED

BATCH, ATTEMPTS, ROLES = 100, 20, ("train", "dev", "test")
PARTS = ["hand", "object", "support", "a", "b"]  # columns of labels
WORDS = {"reaching": "reach for the {object}", "fixation": "touch the {object} before the grasp", "grasping": "hold the {object}",
         "sliding": "slide the {object}", "picking_up": "pick up the {object}", "hovering": "lift the {object} by a hair",
         "transporting": "carry the {object}", "putting_down": "put down the {object}"}


def told(command, ok=(0,), **more):
    """What the program prints, as JSON."""
    done = subprocess.run([program(), *command], capture_output=True, text=True, check=False, **more)
    if done.returncode not in ok or not done.stdout.lstrip().startswith(("{", "[")):
        fail(EpisodeError, f"prehend {' '.join(command[:2])} .. ended with {done.returncode}:\n{done.stderr.strip()[-2000:]}")
    return json.loads(done.stdout)


def sha256(path):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def label(event):
    return f"{event['event']}({', '.join(event['roles'].values())})"


def witnessed(truth, found, tolerance):
    """Of each true event what the grammar says of it, and what it finds that is not true."""
    left, rows = list(found), []
    for event in truth:
        same = [one for one in left if label(one) == label(event)
                and one["begin_tick"] <= event["end_tick"] + tolerance and one["end_tick"] >= event["begin_tick"] - tolerance]
        best = min(same, key=lambda one: abs(one["begin_tick"] - event["begin_tick"]) + abs(one["end_tick"] - event["end_tick"]), default=None)
        says = "misses"
        if best:
            left.remove(best)
            inside = all(event[f"{side}_band_tick"][0] - tolerance <= best[f"{side}_tick"] <= event[f"{side}_band_tick"][1] + tolerance
                         for side in ("begin", "end"))
            says = "agrees" if inside else "differs"
        rows.append((event, says))
    return rows, left


def judged(row, text, drawn, role, asks, checked, attempt):
    """All that is known of an episode, as one line of rows.jsonl."""
    per_s = row["truth_events"]["ticks_per_second"]
    sensing = int(drawn["sensing_hz"])
    marked, extra = witnessed(row["truth_events"]["events"], row["found_events"]["events"], 2 * per_s // sensing)

    def plain(event, says):
        bands = [[round(tick / per_s, 6) for tick in event[f"{side}_band_tick"]] for side in ("begin", "end")] if "begin_band_tick" in event else None
        return {"event": event["event"], "roles": event["roles"], "begin_s": round(event["begin_s"], 6), "end_s": round(event["end_s"], 6),
                "bands_s": bands, "grammar": says}
    claims = [{"claim": one["claim"], "verdict": one["verdict"]} for one in checked["claims"]]
    return {"episode": checked["name"], "role": role, "asks": asks, "words": drawn, "attempts": attempt + 1, "seconds": round(row["end_tick"] / per_s, 6),
            "state_hash": checked["state_hash"], "claims": claims, "scenario": text, "scenario_sha256": hashlib.sha256(text.encode()).hexdigest(),
            "labels": [plain(*one) for one in marked], "extra": [plain(one, "adds") for one in extra]}


class Shard:
    """Episodes that are drawn, played and judged, in batches of one process each."""

    def __init__(self, recipe, recipe_hash, folder):
        self.recipe, self.hash, self.folder = recipe, recipe_hash, pathlib.Path(folder)
        self.redrawn, self.rows, self.batches = collections.Counter(), [], 0

    def write(self, index, attempt):
        """The next scenario of an index that can be written, with the number of the attempt."""
        while attempt < ATTEMPTS:
            try:
                return attempt, *scenes.written(self.recipe, self.hash, index, attempt)
            except scenes.Unplayable as why:
                self.redrawn[str(why)] += 1
                attempt += 1
        return fail(EpisodeError, f"episode {index} of the recipe cannot be played in {ATTEMPTS} attempts")

    def play(self, indices, jobs):
        waiting = {index: 0 for index in indices}
        while waiting:
            drawn = {index: self.write(index, attempt) for index, attempt in waiting.items()}
            waiting = {}
            for role in ROLES:
                of_role = [(index, one) for index, one in drawn.items() if recipes.role(self.recipe, self.hash, index, one[2])[0] == role]
                for at in range(0, len(of_role), BATCH):
                    self.batches += 1
                    waiting |= self.batch(of_role[at:at + BATCH], role, f"{role}_{self.batches:03d}.episodes", jobs)

    def batch(self, drawn, role, file, jobs):
        """Plays them; returns those that have to be drawn again, with the next attempt."""
        again, texts = {}, {}
        with tempfile.TemporaryDirectory(prefix="prehend_") as folder:
            for index, (attempt, text, words, _) in drawn:
                texts[f"e{index:05d}"] = (index, attempt, text, words)
                pathlib.Path(folder, f"e{index:05d}.yaml").write_text(text, encoding="utf-8")
            record = os.path.abspath(self.folder / file)
            played = told(["check", *(f"{name}.yaml" for name in texts), "--no-pictures", "--json", "--record", record, "--report", "report",
                           *(["--jobs", str(jobs)] if jobs else [])], (0, 1, 2, 3, 5), cwd=folder)
            good = {}  # by name
            for one in played["scenarios"]:
                one["name"] = pathlib.Path(one["file"]).stem
                physics = [line for line in one["details"].splitlines() if "physics:" in line]
                if one["exit_code"] in (0, 1, 5) and one["state_hash"] and not physics:
                    good[one["name"]] = one
                    continue
                index, attempt, _, _ = texts[one["name"]]
                why = str(physics[0]) if physics else (one["errors"][0]["message"] if one["errors"] else one["reason"])
                self.redrawn[why.split("physics:")[-1].strip()[:60]] += 1
                again[index] = attempt + 1
            if good:
                scored = told(["score", record, "--grammar", "pick_and_place", "--json", "--verbose"], (0, 1, 2, 3))
                for row in scored["grammars"][0]["rows"]:
                    name = pathlib.Path(row["episode"]).name
                    if name in good:
                        index, attempt, text, words = texts[name]
                        _, asks = recipes.role(self.recipe, self.hash, index, words)
                        self.rows.append(judged(row, text, words, role, asks, good[name], attempt) | {"file": file})
        return again


def make(options):
    recipe, recipe_hash = recipes.read(options.recipe)
    part, parts = options.shard
    final = pathlib.Path(options.output)
    if final.exists():
        fail(EpisodeError, f"{final} is there already", "name another folder")
    final.mkdir(parents=True)
    shard = Shard(recipe, recipe_hash, final)
    shard.play(range(part - 1, options.episodes, parts), options.jobs)
    with open(final / "rows.jsonl", "w", encoding="utf-8") as file:
        for row in sorted(shard.rows, key=lambda one: one["episode"]):
            file.write(json.dumps(row, sort_keys=True) + "\n")
    about = {"recipe": recipe, "recipe_sha256": recipe_hash, "episodes": options.episodes, "shard": [part, parts], "redrawn": shard.redrawn}
    (final / "shard.json").write_text(json.dumps(about, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    print(f"{final}: {len(shard.rows)} episodes, {sum(shard.redrawn.values())} drawn again")
    return join_into(final, [final]) if parts == 1 else 0


def labels_of(rows):
    """Rows of a table of labels."""
    for row in rows:
        if not row["labels"]:
            yield [row["episode"]] + [""] * (9 + len(PARTS))
        for one in row["labels"]:
            bands = [value for side in one["bands_s"] for value in side]
            yield [row["episode"], one["begin_s"], one["end_s"], label(one), one["event"],
                   *(one["roles"].get(part, "") for part in PARTS), *bands, one["grammar"]]


def write_table(path, header, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows(map(cell, row) for row in [header, *rows])


def write_labels(path, rows):
    write_table(path, ["episode", "begin_s", "end_s", "label", "event", *PARTS, "begin_least_s", "begin_most_s", "end_least_s", "end_most_s",
                       "grammar"], labels_of(rows))


def subtasks(rows):
    for row in rows:
        for one in row["labels"]:
            if one["event"] in WORDS:
                yield [row["episode"], one["roles"]["hand"], WORDS[one["event"]].format(object=one["roles"]["object"].replace("_", " ")),
                       one["begin_s"], one["end_s"]]


def disagreements(rows):
    for row in rows:
        for one in row["claims"]:
            if one["verdict"] != "holds":
                yield [row["episode"], "claim", one["claim"], one["verdict"], "", ""]
        for one in row["labels"] + row["extra"]:
            if one["grammar"] != "agrees":
                yield [row["episode"], "grammar", label(one), one["grammar"], one["begin_s"], one["end_s"]]


def join_into(output, shards):
    """One set of all shards: tables, splits, hashes."""
    abouts = [json.loads((shard / "shard.json").read_text(encoding="utf-8")) for shard in shards]
    if len({(about["recipe_sha256"], about["episodes"], about["shard"][1]) for about in abouts}) != 1 or \
            sorted(about["shard"][0] for about in abouts) != list(range(1, abouts[0]["shard"][1] + 1)):
        fail(EpisodeError, "these are not all shards of one recipe", "make each with --shard 1/N to N/N")
    rows = []
    output.mkdir(parents=True, exist_ok=True)
    for shard, about in zip(shards, abouts):
        prefix = f"{about['shard'][0]}of{about['shard'][1]}." if about["shard"][1] > 1 else ""
        for line in (shard / "rows.jsonl").read_text(encoding="utf-8").splitlines():
            row = json.loads(line)
            rows.append(row | {"file": prefix + named(row["file"]), "episode": named(row["episode"])})
        for file in sorted(shard.glob("*.episodes")):
            if output != shard:
                shutil.copyfile(file, output / (prefix + file.name))
    rows.sort(key=lambda row: row["episode"])
    redrawn = sum((collections.Counter(about["redrawn"]) for about in abouts), collections.Counter())
    write_set(output, abouts[0], rows, redrawn)
    if output in shards:
        (output / "rows.jsonl").unlink()
        (output / "shard.json").unlink()
    return 0


def write_set(output, about, rows, redrawn):
    apart = output / "held_out"
    for folder in (output / "scenarios", apart / "scenarios"):
        folder.mkdir(parents=True, exist_ok=True)
    for row in rows:
        folder = apart if row["role"] == "test" else output
        (folder / "scenarios" / f"{row['episode']}.yaml").write_text(row["scenario"], encoding="utf-8")
    tables = []
    for role in ROLES:
        of_role, folder = [row for row in rows if row["role"] == role], apart if role == "test" else output
        for what, write in (("labels", write_labels),
                            ("subtasks", lambda path, some: write_table(path, ["episode", "hand", "text", "begin_s", "end_s"], subtasks(some))),
                            ("disagreements", lambda path, some: write_table(path, ["episode", "witness", "what", "says", "begin_s", "end_s"],
                                                                             disagreements(some)))):
            path = folder / f"{what}_{role}.csv"
            write(path, of_role)
            tables.append(path)
    words = recipes.WEIGHED
    write_table(output / "episodes.csv", ["episode", "role", "asks", *words, "seconds", "attempts", "state_hash", "scenario_sha256"],
                ([row["episode"], row["role"], " ".join(row["asks"]),
                  *(" ".join(value) if isinstance(value := row["words"][word], list) else value for word in words),
                  row["seconds"], row["attempts"], row["state_hash"], row["scenario_sha256"]] for row in rows))
    tables.append(output / "episodes.csv")
    manifest = {"set": about["recipe"]["name"], "recipe_sha256": about["recipe_sha256"], "recipe": about["recipe"], "licence": "CC-BY-4.0",
                "program": subprocess.run([program(), "--version"], capture_output=True, text=True, check=True).stdout.strip(),
                "episodes": len(rows), "redrawn": dict(sorted(redrawn.items())), "things_sha256": sha256(recipes.HERE / "things.csv"),
                "sha256": {str(path.relative_to(output)): sha256(path) for path in tables}}
    (output / "manifest.json").write_text(json.dumps(manifest, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    (output / "files.json").write_text(json.dumps({row["episode"]: row["file"] for row in rows}, indent=0, sort_keys=True) + "\n", encoding="utf-8")
    from .datasheet import write as write_datasheet
    write_datasheet(output, manifest, rows)
    print(f"{output}: " + ", ".join(f"{sum(row['role'] == role for row in rows)} {role}" for role in ROLES)
          + f"; manifest {sha256(output / 'manifest.json')[:16]}")


def export(options):
    """Other forms of a set: those of the program, and HDF5 as simulators lay it out."""
    if options.to != "hdf5":
        files = sorted(pathlib.Path(options.set).absolute().glob("*.episodes")) or fail(EpisodeError, f"{options.set}: it has no file NAME.episodes")
        done = subprocess.run([program(), "episode", "export", *map(str, files), *PLAYED, "--to", options.to, "-o", options.output], check=False)
        return done.returncode
    from .datasheet import write_hdf5
    return write_hdf5(options.set, options.output)


def shard_text(text):
    part, _, parts = text.partition("/")
    if not (part.isdigit() and parts.isdigit() and 1 <= int(part) <= int(parts)):
        raise argparse.ArgumentTypeError(f"found '{text}', wanted I/N, as 2/7")
    return int(part), int(parts)


def main(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m prehend dataset", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("make", help="draw and play the episodes of a recipe")
    one.add_argument("recipe")
    one.add_argument("--episodes", type=amount(int, 1), required=True, metavar="N")
    one.add_argument("--shard", type=shard_text, default=(1, 1), metavar="I/N", help="episodes I, I+N, ..: for many machines; then 'join'")
    one.add_argument("--jobs", type=amount(int, 0), default=0, help="so many at a time; default: one per core")
    one.add_argument("-o", "--output", required=True, metavar="DIR")
    one = commands.add_parser("join", help="one set of all shards")
    one.add_argument("shards", nargs="+", type=pathlib.Path)
    one.add_argument("-o", "--output", required=True, type=pathlib.Path, metavar="DIR")
    one = commands.add_parser("export", help="the same set for other programs")
    one.add_argument("set")
    one.add_argument("--to", choices=["mcap", "csv", "jsonl", "npz", "hdf5"], required=True)
    one.add_argument("-o", "--output", required=True)
    one = commands.add_parser("archive", help="a set, results on it, hashes, licence and citation as one file")
    one.add_argument("set")
    one.add_argument("results", nargs="*", help="folders of 'benchmark'")
    one.add_argument("--date", required=True, type=datetime.date.fromisoformat, metavar="YYYY-MM-DD", help="of the release")
    one.add_argument("-o", "--output", required=True, metavar="FILE.tar")
    options = parser.parse_args(arguments)
    if options.command == "archive":
        from .datasheet import archive
        return archive(options.set, options.results, options.date, options.output)
    if options.command == "join":
        return join_into(options.output, options.shards)
    return make(options) if options.command == "make" else export(options)
