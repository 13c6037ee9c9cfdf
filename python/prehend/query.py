# SPDX-License-Identifier: Apache-2.0
"""python3 -m prehend query: 'prehend episode query' with the same filters, asked of PostgreSQL (docs/many-machines.md)."""
import argparse
import collections
import csv
import fnmatch
import json
import re
import sys

from . import push
from .errors import EpisodeError, amount, cell, fail

# How an event e lies to another event o, in Allen's words.
RELATIONS = {
    "before": "e.end_tick < o.begin_tick", "meets": "e.end_tick = o.begin_tick",
    "overlaps": "e.begin_tick < o.begin_tick AND o.begin_tick < e.end_tick AND e.end_tick < o.end_tick",
    "starts": "e.begin_tick = o.begin_tick AND e.end_tick < o.end_tick",
    "inside": "o.begin_tick < e.begin_tick AND e.end_tick < o.end_tick",
    "finishes": "o.begin_tick < e.begin_tick AND e.end_tick = o.end_tick",
    "equals": "e.begin_tick = o.begin_tick AND e.end_tick = o.end_tick",
    "finished_by": "e.begin_tick < o.begin_tick AND e.end_tick = o.end_tick",
    "contains": "e.begin_tick < o.begin_tick AND o.end_tick < e.end_tick",
    "started_by": "e.begin_tick = o.begin_tick AND o.end_tick < e.end_tick",
    "overlapped_by": "o.begin_tick < e.begin_tick AND e.begin_tick < o.end_tick AND o.end_tick < e.end_tick",
    "met_by": "o.end_tick = e.begin_tick", "after": "o.end_tick < e.begin_tick"}

# The events that begin within e and whose participants are all its own.
PART = """FROM prehend.event o WHERE o.episode = e.episode AND o.id <> e.id AND o.begin_tick >= e.begin_tick AND o.begin_tick < e.end_tick
  AND NOT EXISTS (SELECT 1 FROM prehend.event_role r WHERE r.episode = o.episode AND r.event = o.id AND r.entity IS NOT NULL
    AND r.value NOT IN (SELECT value FROM prehend.event_role w WHERE w.episode = e.episode AND w.event = e.id))"""


def _regex(glob):
    """A glob for the server's operator ~, which knows no (?s:..)\\Z."""
    return "^" + re.sub(r"^\(\?s:(.*)\)\\Z$", r"\1", fnmatch.translate(glob), flags=re.S) + "$"


def _role(text):
    role, _, value = text.partition("=")
    if not role or not value:
        raise argparse.ArgumentTypeError(f"found {text!r}, wanted ROLE=NAME, like object=milk or any=milk")
    return role, value


def _check_roles(connection, options):
    """A role that no event has is a mistake, and not 'nothing found'."""
    with connection, connection.cursor() as cursor:
        cursor.execute("SELECT DISTINCT role FROM prehend.event_role ORDER BY role")
        known = [role for role, in cursor]
    for option, asked in (("--role", options.role), ("--part-of", options.part_of)):
        for role, _ in asked:
            if known and role not in ("any", *known):
                fail(EpisodeError, f"{option}: no event has a role {role!r}; there are: {', '.join(known)}")


def _relation(text):
    name, _, event = text.partition(" ")
    name = "inside" if name == "during" else name
    if name not in (*RELATIONS, "has") or not event:
        raise argparse.ArgumentTypeError(f"found {text!r}, wanted 'RELATION EVENT' with one of has, {', '.join(RELATIONS)}")
    return name, event


def _lasts(text):
    bounds = text.partition("..")[::2]
    if not any(bounds) or not all(re.fullmatch(r"|(\d+\.?\d*|\.\d+)(e-?\d+)?", one) for one in bounds):
        raise argparse.ArgumentTypeError(f"found {text!r}, wanted seconds: 0.5, 0.5..2 or ..2")
    return [float(one) if one else None for one in bounds]


def question(options):
    """The WHERE of a question, whose values are all parameters, and these."""
    conditions, values = ["true"], []

    def ask(condition, *its):
        conditions.append(condition)
        values.extend(its)

    if options.event:
        ask("e.event ~ %s", _regex(options.event))
    which = options.episode or ""
    if which.startswith(("status=", "outcome=")):
        ask("p.status ~ %s" if which.startswith("status=") else "p.outcome ~ %s", _regex(which.partition("=")[2]))
    elif which:
        ask("(p.scenario ~ %s OR regexp_replace(p.scenario, '.*/', '') ~ %s)", *[_regex(which)] * 2)
    for bound, condition in ((options.lasts_s[0], "e.duration_s >= %s"), (options.lasts_s[1], "e.duration_s <= %s"),
                             (options.begins, "e.begin_s >= %s"), (options.ends, "e.end_s <= %s")):
        if bound is not None:
            ask(condition, bound)
    has_role = """EXISTS (SELECT 1 FROM prehend.event_role r LEFT JOIN prehend.entity n ON n.task = p.task AND n.number = r.entity
      WHERE r.episode = e.episode AND r.event = e.id AND (%s = 'any' OR r.role = %s) AND """
    for role, value in options.role:
        ask(has_role + "(r.value ~ %s OR EXISTS (SELECT 1 FROM unnest(n.classes) c WHERE c ~ %s)))", role, role, *[_regex(value)] * 2)
    for role, value in options.part_of:
        ask(has_role + "EXISTS (SELECT 1 FROM unnest(n.wholes) c WHERE c ~ %s))", role, role, _regex(value))
    others = "FROM prehend.event o WHERE o.episode = e.episode AND o.id <> e.id AND "
    for name, event in options.relation:
        ask(f"EXISTS (SELECT 1 {PART if name == 'has' else others + RELATIONS[name]} AND o.event ~ %s)", _regex(event))
    return " AND ".join(conditions), values


def answers(connection, options):
    """Rows of dicts, in the order of episodes and of their events."""
    where, values = question(options)
    with connection, connection.cursor() as cursor:
        cursor.execute(f"""SELECT p.uri, p.number, p.scenario, e.event, e.begin_s, e.end_s, e.uuid::text, coalesce((SELECT json_agg(json_build_array(r.role,
          r.value, coalesce(n.class, '')) ORDER BY position) FROM prehend.event_role r LEFT JOIN prehend.entity n ON n.task = p.task AND
          n.number = r.entity WHERE r.episode = e.episode AND r.event = e.id), '[]') FROM prehend.event e JOIN prehend.episode p ON
          p.uuid = e.episode WHERE {where} ORDER BY p.uri, p.number, e.id""", values)
        return [{"file": uri, "episode": number, "scenario": scenario, "event": event, "roles": roles, "begin_s": begin, "end_s": end, "uuid": uuid}
                for uri, number, scenario, event, begin, end, uuid, roles in cursor]


def _columns(found, columns):
    known = {"event", "scenario", "episode", "file"}
    for one in found:
        one["cells"] = {key: str(one[key]) for key in known}
        for role, value, kind in one["roles"]:
            one["cells"].update({role: value, role + "_class": kind})
    names = {name for one in found for name in one["cells"]}
    for column in columns:
        if found and column not in names:
            fail(EpisodeError, f"--count-by: there is no column {column!r}; there are: {', '.join(sorted(names))}")
    counts = collections.Counter(tuple(one["cells"].get(column, "") for column in columns) for one in sorted(
        found, key=lambda one: [one["cells"].get(column, "") for column in columns]))
    return [dict(zip(columns, cells), count=count) for cells, count in counts.most_common()]


def _print(rows, options):
    if options.json:
        print(json.dumps(rows, indent=2, ensure_ascii=False))
        return
    table = [list(rows[0])] if rows else []
    table += [[f"{one:.4f}" if isinstance(one, float) else str(one) for one in row.values()] for row in rows]
    if options.csv:
        csv.writer(sys.stdout, lineterminator="\n").writerows(map(cell, row) for row in table)
        return
    widths = [max(map(len, column)) for column in zip(*table)]
    for row in table:
        print("  ".join(map(str.ljust, row, widths)).rstrip())


def main(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m prehend query", description="Finds events that were pushed into PostgreSQL.")
    parser.add_argument("url", metavar="postgresql://USER@HOST/DATABASE")
    parser.add_argument("--event", metavar="NAME", help="its name, or a glob")
    parser.add_argument("--role", type=_role, action="append", default=[], metavar="ROLE=NAME")
    parser.add_argument("--part-of", type=_role, action="append", default=[], metavar="ROLE=NAME")
    parser.add_argument("--lasts-s", type=_lasts, default=(None, None), metavar="S[..S]")
    for name, place in (("--from", "begins"), ("--to", "ends")):
        parser.add_argument(name, type=amount(float, 0, 1e6), dest=place, metavar="S")
    parser.add_argument("--relation", type=_relation, action="append", default=[], metavar="'RELATION EVENT'")
    parser.add_argument("--episode", metavar="WHICH", help="a scenario (a name, skill/name or a glob), status=failed, outcome=NAME")
    parser.add_argument("--count-by", metavar="COLUMN,..")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--csv", action="store_true")
    options = parser.parse_args(arguments)
    for name in ("event", "episode", "count_by"):
        if getattr(options, name) == "":
            parser.error(f"--{name.replace('_', '-')}: the value is empty")
    with push.connected(options.url) as connection:
        found = answers(connection, options)
        if not found:
            _check_roles(connection, options)
    if options.count_by:
        _print(_columns(found, options.count_by.split(",")), options)
    else:
        for one in found:
            roles = one.pop("roles")
            one["roles"] = {role: value for role, value, _ in roles} if options.json else " ".join(f"{role}={value}" for role, value, _ in roles)
        _print(found, options)
    if not options.json and not options.csv:
        print(f"{len(found)} answer{'' if len(found) == 1 else 's'}")
    return 0 if found else 4
