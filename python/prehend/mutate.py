# SPDX-License-Identifier: Apache-2.0
"""python3 -m prehend mutate EPISODES.. --grammar G: which mistakes in a grammar would nobody notice?"""
import argparse
import json
import math
import multiprocessing
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from . import _prehend, episodes, worlds
from .errors import EpisodeError, amount, fail
from .mutants import mutants, texts

_work = None  # of a worker: what it keeps from one mutant to the next


def differ(before, now, tolerance):
    """Whether two timelines differ by more than so many ticks; else the largest shift of a boundary."""
    if len(before) != len(now):
        return True, 0
    shift, left = 0, list(now)
    for event, roles, begin, end, *_ in before:
        same = [one for one in left if one[0] == event and one[1] == roles]
        if not same:
            return True, 0
        nearest = min(same, key=lambda one: abs(one[2] - begin) + abs(one[3] - end))
        shift = max(shift, abs(nearest[2] - begin), abs(nearest[3] - end))
        left.remove(nearest)
    return shift > tolerance, shift


class Work:
    """Episodes, and what the grammar as it is finds in them."""

    def __init__(self, files, which, grammar, random_files):
        self.grammar, self.random_files = grammar, random_files
        self.plain = _prehend.Grammar(grammar, {})
        self.opened = [one._opened for one in episodes.open(files, which)] if files else []
        self.found, self.worlds = {}, []

    def before(self, number):
        if number not in self.found:
            one = self.opened[number]
            ticks = one.frames()[0]
            apart = int(np.diff(ticks).min()) if len(ticks) > 1 else 1
            self.found[number] = one.segment(self.plain)[0], 2 * apart  # as `prehend check` does
        return self.found[number]

    def kill(self, mutant, order):
        """(killed, episode, shift in seconds): by which episode, or the largest shift that is tolerated."""
        program, most = _prehend.Grammar(self.grammar, {}, {mutant.file: mutant.text}), (0, None)
        for number in order:
            before, tolerance = self.before(number)
            is_killed, shift = differ(before, self.opened[number].segment(program)[0], tolerance)
            if is_killed:
                return True, number, 0
            if shift > most[0]:
                most = shift, number
        return False, most[1], most[0] / self.opened[most[1]].ticks_per_second() if most[0] else 0

    def is_equivalent(self, mutant):
        """Whether it finds the same in random worlds, to the tick."""
        program = _prehend.Grammar(self.grammar, {}, {mutant.file: mutant.text})
        for number, file in enumerate(self.random_files):
            if number == len(self.worlds):
                world = _prehend.open([file], "")[0]
                self.worlds.append((world, world.segment(self.plain)[0]))
            world, before = self.worlds[number]
            if differ(before, world.segment(program)[0], 0)[0]:
                return False
        return True


def _begin(*what):
    global _work  # pylint: disable=global-statement
    _work = Work(*what)


def _kill(task):
    return _work.kill(*task)


def _is_equivalent(mutant):
    return _work.is_equivalent(mutant)


def reasons(grammars):
    """What stands in equivalent_mutants.tsv beside them, by a mutant's file, source line and mistake: why it is no mistake."""
    found = {}
    for file in grammars:
        beside = os.path.join(os.path.dirname(file), "equivalent_mutants.tsv")
        lines = pathlib.Path(beside).read_text("utf-8").splitlines() if os.path.isfile(beside) else []
        for number, row in ((number, line.split("\t")) for number, line in enumerate(lines, 1) if line[:1] not in ("", "#")):
            if len(row) != 4:
                fail(EpisodeError, f"{beside}:{number}: error: found {len(row)} columns, wanted 4: file, source line, mistake, reason")
            found[os.path.join(os.path.dirname(file), row[0]), row[1], row[2]] = row[3]
    return found


def covered(files, which, grammar, jobs):
    """What `prehend grammar coverage --json` says."""
    words = [episodes.program(), "grammar", "coverage", *files, "--grammar", grammar, "--json", "--jobs", str(jobs)]
    done = subprocess.run(words + (["--episode", which] if which else []), capture_output=True, text=True, check=False)
    if done.returncode != 0:
        fail(EpisodeError, done.stderr.strip())
    return json.loads(done.stdout)


def order_of(mutant, clauses, count):
    """Episodes that reach what the mutant touches, those that came nearest to it first; all, if that is no clause, as in `rest of`."""
    nearest = {} if mutant.clauses else {episode: (math.inf, episode) for episode in range(count)}
    for clause in (clauses[number] for number in mutant.clauses):
        for episode, sides in clause["seen"]:
            near = min((one for one in sides["nearest"] if one is not None), default=None)
            rank = (near if near is not None else 1.0 / (1 + min(sides["decided"])), episode)
            nearest[episode] = min(rank, nearest.get(episode, rank))
    return sorted(nearest, key=nearest.get), nearest


def mutate(paths, grammar, which="", jobs=2, frames=100_000, folder=None):
    """Kills the mutants of a grammar. Returns a dict, as --json prints it."""
    opened = episodes.open(paths, which)
    files = list(dict.fromkeys(one.file for one in opened))
    names = [one.name for one in opened]
    coverage = covered(files, which, grammar, jobs)
    clauses = coverage["clauses"]
    all_mutants, sources = mutants(grammar, clauses), texts(grammar)
    known = reasons(sources)
    said_of = [known.get((one.file, sources[one.file].splitlines()[one.line - 1].strip(), one.what)) for one in all_mutants]
    orders = [order_of(one, clauses, len(names)) for one in all_mutants]
    random_files = [os.path.join(folder, f"world_{number}.jsonl") for number in range(-(-frames // worlds.FRAMES))]
    for number, file in enumerate(random_files):
        worlds.write(file, number)
    looked = covered(random_files, "", grammar, jobs)["clauses"] if random_files else []
    both = {number for number, one in enumerate(looked) if min(one["all"]["decided"]) > 0}
    with multiprocessing.get_context("fork").Pool(jobs, _begin, (files, which, grammar, random_files)) as pool:
        ends = pool.map(_kill, [(one, order) for one, (order, _) in zip(all_mutants, orders)], 1)
        # Only worlds in which its clauses decide both ways can tell that it is equivalent.
        left = [number for number, end in enumerate(ends) if not end[0] and set(all_mutants[number].clauses) <= both]
        equivalent = dict(zip(left, pool.map(_is_equivalent, [all_mutants[one] for one in left], 1)))
    said = []
    for number, (one, (killed, episode, shift_s), (order, nearest)) in enumerate(zip(all_mutants, ends, orders)):
        is_equal = said_of[number] or equivalent.get(number) and one.clauses
        end = "killed" if killed else "equivalent" if is_equal else "survived" if order else "not reached"
        row = {"file": one.file, "line": one.line, "column": one.column, "what": one.what, "end": end,
               **({"reason": said_of[number]} if said_of[number] else {})}
        if killed or shift_s:
            row.update(episode=names[episode], **({} if killed else {"shift_s": shift_s}))
        elif order and one.threshold and one.clauses:
            clause = clauses[one.clauses[0]]
            row.update(episode=names[order[0]], nearest=nearest[order[0]][0], unit=clause["unit"])
        elif order:
            row.update(episode=names[order[0]])
        said.append(row)
    count = {end: sum(row["end"] == end for row in said) for end in ("killed", "survived", "not reached", "equivalent")}
    judged = len(said) - count["equivalent"]
    return {"grammar": coverage["grammar"], "episodes": len(names), "mutants": len(said), **count,
            "score_percent": 100 * count["killed"] / judged if judged else 100.0, "all": said}


def near_text(row):
    """Which episode came nearest, and by how much."""
    if "shift_s" in row:
        return f"; {row['episode']} moves by {1000 * row['shift_s']:.3g} ms, which is tolerated"
    if "nearest" in row:
        return f"; {row['episode']} is nearest, {row['nearest']:.3g}{' ' if row['unit'] else ''}{row['unit']} from the threshold"
    return f"; {row['episode']} comes there" if "episode" in row else ""


def text_of(result, frames):
    lines = [f"{result['grammar']}: {result['mutants']} mutants on {result['episodes']} episodes"]
    for end, says, told in (("survived", "survived", False), ("not reached", "no episode comes there", False),
                            ("equivalent", f"the same in {frames:,} random frames, too", False), ("equivalent", "no mistake", True),
                            ("killed", "killed, though said to be no mistake", True)):
        rows = [row for row in result["all"] if row["end"] == end and (end == "survived" or ("reason" in row) == told)]
        lines += [f"\n{says}: {len(rows)}"] if rows else []
        lines += [f"  {os.path.relpath(row['file'])}:{row['line']}:{row['column']}: {row['what']}{'; ' + row['reason'] if told else near_text(row)}" for row in rows]
    return "\n".join(lines + [f"\nkilled {result['killed']} of {result['mutants'] - result['equivalent']} that are not equivalent: "
                              f"{result['score_percent']:.1f} %"])


def main(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m prehend mutate", description=__doc__)
    parser.add_argument("EPISODES", nargs="+", help="as prehend.open takes them: files, globs, scenarios")
    parser.add_argument("--grammar", required=True, metavar="NAME|FILE")
    parser.add_argument("--episode", default="", metavar="WHICH", help="only these of episode files")
    parser.add_argument("--frames", type=amount(int, 0), default=100_000, metavar="N", help="random ones, that tell equivalent mutants")
    parser.add_argument("--fail-below", type=amount(float, 0, 100), default=0, metavar="PERCENT", help="exit code 1 if less are killed")
    parser.add_argument("--jobs", type=amount(int, 1), default=os.cpu_count() or 1, metavar="N")
    parser.add_argument("--json", action="store_true")
    asked = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="prehend_") as folder:
        result = mutate(asked.EPISODES, asked.grammar, asked.episode, asked.jobs, asked.frames, folder)
    print(json.dumps(result, indent=1) if asked.json else text_of(result, asked.frames))
    if result["score_percent"] >= asked.fail_below:
        return 0
    print(f"prehend: {result['score_percent']:.1f} % of the mutants are killed, wanted {asked.fail_below:g} %", file=sys.stderr)
    return 1
