# SPDX-License-Identifier: Apache-2.0
"""python3 -m prehend push: episode files into PostgreSQL (docs/many-machines.md).

Events, entities, takes, labels and scores become rows; frames stay in the files, which are found by URI and hash.
An episode is known by its UUID: what is there already and equal is left alone, so a push can be repeated.
"""
import argparse
import contextlib
import hashlib
import io
import json
import os
import pathlib
import sqlite3
import subprocess
import sys

from . import episodes, grammar
from .errors import EpisodeError, fail

PARTITIONS = 8
BATCH = 1000  # episodes in a transaction

TABLES = """
CREATE SCHEMA prehend;
CREATE TABLE prehend.file(uri text PRIMARY KEY, hash text NOT NULL, bytes bigint NOT NULL);
CREATE TABLE prehend.task(uuid uuid PRIMARY KEY, scenario text NOT NULL, file text NOT NULL, asked_grammar text NOT NULL,
  settings jsonb NOT NULL, shows text NOT NULL);
CREATE TABLE prehend.entity(task uuid NOT NULL REFERENCES prehend.task, number int NOT NULL, uuid uuid NOT NULL, name text NOT NULL,
  class text NOT NULL, classes text[] NOT NULL, part_of int, wholes text[] NOT NULL, mass_kg float8, size_x_m float8 NOT NULL,
  size_y_m float8 NOT NULL, size_z_m float8 NOT NULL, PRIMARY KEY(task, number));
CREATE TABLE prehend.episode(uuid uuid PRIMARY KEY, task uuid NOT NULL REFERENCES prehend.task, scenario text NOT NULL,
  status text NOT NULL, grammar text NOT NULL, ticks_per_second int NOT NULL, ticks bigint NOT NULL, state_hash text NOT NULL,
  outcome text NOT NULL, engine text NOT NULL, seed bigint NOT NULL, program text NOT NULL, program_hash text NOT NULL,
  recorded_on text NOT NULL, failure_entity text NOT NULL, failure_reason text NOT NULL, failure_advice text NOT NULL,
  content text NOT NULL, uri text NOT NULL REFERENCES prehend.file, number int NOT NULL);
CREATE INDEX ON prehend.episode(scenario);
CREATE TABLE prehend.event(episode uuid NOT NULL, id int NOT NULL, uuid uuid NOT NULL, event text NOT NULL, begin_tick bigint NOT NULL,
  end_tick bigint NOT NULL, decided_tick bigint NOT NULL, open_end boolean NOT NULL, begin_s float8 NOT NULL, end_s float8 NOT NULL,
  duration_s float8 NOT NULL, PRIMARY KEY(episode, id)) PARTITION BY HASH(episode);
CREATE TABLE prehend.event_role(episode uuid NOT NULL, event int NOT NULL, position int NOT NULL, role text NOT NULL, value text NOT NULL,
  entity int, PRIMARY KEY(episode, event, position)) PARTITION BY HASH(episode);
CREATE TABLE prehend.event_value(episode uuid NOT NULL, event int NOT NULL, position int NOT NULL, name text NOT NULL, value float8,
  unit text NOT NULL, PRIMARY KEY(episode, event, position)) PARTITION BY HASH(episode);
CREATE TABLE prehend.take(episode uuid NOT NULL, source text NOT NULL, person text, set_name text, labels text, PRIMARY KEY(episode, source));
CREATE TABLE prehend.label(episode uuid NOT NULL, source text NOT NULL, position int NOT NULL, event text NOT NULL, roles jsonb NOT NULL,
  begin_s float8 NOT NULL, end_s float8 NOT NULL, PRIMARY KEY(episode, source, position));
CREATE TABLE prehend.score(source text NOT NULL, grammar text NOT NULL, settings text NOT NULL, event text NOT NULL, found jsonb NOT NULL,
  PRIMARY KEY(source, grammar, settings, event));
CREATE VIEW prehend.episodes_flat AS SELECT e.uuid, e.scenario, status, grammar, ticks / ticks_per_second::float8 AS seconds, ticks,
  state_hash, outcome, seed, settings, recorded_on, uri, number FROM prehend.episode e JOIN prehend.task ON task.uuid = e.task;
CREATE VIEW prehend.events_flat AS SELECT event.uuid, event.episode, scenario, event.event,
  (SELECT string_agg(value, ', ' ORDER BY position) FROM prehend.event_role r WHERE r.episode = event.episode AND r.event = event.id) AS roles,
  (SELECT value FROM prehend.event_role r WHERE r.episode = event.episode AND r.event = event.id AND role = 'hand' LIMIT 1) AS hand,
  (SELECT value FROM prehend.event_role r WHERE r.episode = event.episode AND r.event = event.id AND role = 'object' LIMIT 1) AS object,
  (SELECT class FROM prehend.event_role r JOIN prehend.entity ON entity.task = e.task AND entity.number = r.entity
    WHERE r.episode = event.episode AND r.event = event.id AND role = 'object' LIMIT 1) AS object_class,
  begin_s, end_s, duration_s FROM prehend.event JOIN prehend.episode e ON e.uuid = event.episode;
"""
INDEXES = """CREATE INDEX ON prehend.event(event, episode);
CREATE INDEX ON prehend.event_role(role, value);
"""
ROLES = """DO $$ BEGIN CREATE ROLE prehend_read NOLOGIN; EXCEPTION WHEN duplicate_object THEN NULL; END $$;
DO $$ BEGIN CREATE ROLE prehend_write NOLOGIN; EXCEPTION WHEN duplicate_object THEN NULL; END $$;
GRANT USAGE ON SCHEMA prehend TO prehend_read, prehend_write;
GRANT SELECT ON ALL TABLES IN SCHEMA prehend TO prehend_read, prehend_write;
GRANT INSERT, UPDATE, DELETE ON ALL TABLES IN SCHEMA prehend TO prehend_write;
"""


def schema():
    """The tables, their partitions and the two roles, as SQL without anything from outside."""
    parts = [f"CREATE TABLE prehend.{table}_{i} PARTITION OF prehend.{table} FOR VALUES WITH (MODULUS {PARTITIONS}, REMAINDER {i});"
             for table in ("event", "event_role", "event_value") for i in range(PARTITIONS)]
    return TABLES + "\n".join(parts) + "\n" + INDEXES + ROLES


@contextlib.contextmanager
def connected(url):
    """A connection whose errors say what to do; the password stays out of them."""
    import psycopg2  # pylint: disable=import-outside-toplevel
    if not url.startswith(("postgresql://", "postgres://")):
        fail(EpisodeError, f"found {url!r}, wanted postgresql://USER@HOST:PORT/DATABASE")
    try:
        with contextlib.closing(psycopg2.connect(url, connect_timeout=10, application_name="prehend")) as connection:
            yield connection
    except psycopg2.Error as error:
        text = (str(error).strip().splitlines() or ["the connection broke"])
        remedy = {"42P01": "the tables are not there: whoever owns the database calls 'push --create URL' once",
                  "3F000": "the tables are not there: whoever owns the database calls 'push --create URL' once",
                  "42501": "the owner of the tables may say: GRANT prehend_write TO NAME (to read: prehend_read)",
                  "42P07": "the tables are there already", "42P06": "the tables are there already",
                  "53100": "the server's disk is full: make room and push again; what was written is kept",
                  "28P01": "passwords belong into ~/.pgpass or PGPASSWORD"}.get(error.pgcode or "", "")
        if not remedy and "password" in text[0]:
            remedy = "passwords belong into ~/.pgpass or PGPASSWORD"
        elif not remedy and isinstance(error, (psycopg2.OperationalError, psycopg2.InterfaceError)):
            remedy = "push again when the server runs: what was written is kept, the rest follows"
        fail(EpisodeError, f"PostgreSQL: {text[0]}", remedy)


def _uuid8(text):
    """As the program's: of an event, the same here, in knowledge bases and in exported tables."""
    import xxhash  # pylint: disable=import-outside-toplevel
    high, low = (xxhash.xxh3_64_intdigest(digit + text) for digit in ("1", "2"))
    high, low = (high & ~0xf000) | 0x8000, (low & ~(3 << 62)) | (1 << 63)
    return f"{high >> 32:08x}-{high >> 16 & 0xffff:04x}-{high & 0xffff:04x}-{low >> 48:04x}-{low & 0xffffffffffff:012x}"


_ESCAPES = str.maketrans({"\\": "\\\\", "\t": "\\t", "\n": "\\n", "\r": "\\r"})


class _Rows:
    """Rows for COPY, as text."""

    def __init__(self):
        self._lines = []

    def add(self, *cells):
        self._lines.append("\t".join("\\N" if cell is None else cell.translate(_ESCAPES) if isinstance(cell, str) else repr(cell)
                                     for cell in cells))
        return self._lines[-1]

    def copy(self, cursor, table):
        cursor.copy_expert(f"COPY prehend.{table} FROM STDIN", io.StringIO("\n".join(self._lines) + "\n" if self._lines else ""))


def _array(texts):
    return "{" + ",".join('"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"' for text in texts) + "}"


class _File:
    """An episode file, read as SQLite without writing."""

    def __init__(self, path):
        self.program("list", path)
        self.database = sqlite3.connect(pathlib.Path(path).absolute().as_uri() + "?mode=ro", uri=True)
        self.uri, self.path = pathlib.Path(path).absolute().as_uri(), path
        self.cut_off = self.database.execute("SELECT count(*) FROM episode WHERE status = 'recording'").fetchone()[0]

    @staticmethod
    def program(*words):
        done = subprocess.run([episodes.program(), "episode", *words], capture_output=True, text=True, check=False)
        if done.returncode not in (0, 4):
            fail(EpisodeError, done.stderr.strip())

    def check(self):
        """The program compares the checksums of all that it reads, and this reads all events, their roles and their entities."""
        self.program("query", self.path, "--episode", "*", "--count-by", "event")

    def hash(self):
        import xxhash  # pylint: disable=import-outside-toplevel
        hashed = xxhash.xxh3_64()
        with open(self.path, "rb") as file:
            for block in iter(lambda: file.read(1 << 22), b""):
                hashed.update(block)
        return f"{hashed.intdigest():016x}"

    def tasks(self, wanted):
        """Their rows, and those of their entities."""
        tasks, entities = _Rows(), _Rows()
        for number, *task in self.database.execute("SELECT id, uuid, scenario, file, asked_grammar, settings, shows FROM task"):
            if task[0] not in wanted:
                continue
            tasks.add(*task)
            known = {row[0]: row[1:] for row in self.database.execute(
                "SELECT number, uuid, name, class, part_of, mass_kg, size_x_m, size_y_m, size_z_m FROM entity WHERE task = ?", (number,))}
            classes = {}
            for entity, name in self.database.execute("SELECT number, class FROM entity_class WHERE task = ? ORDER BY number, depth", (number,)):
                classes.setdefault(entity, []).append(name)
            for entity, (uuid, name, kind, part_of, mass, *size) in known.items():
                wholes, whole = [], part_of
                while whole in known and len(wholes) < 10 * len(known):
                    wholes += [known[whole][1], *classes.get(whole, [])]
                    whole = known[whole][3]
                entities.add(task[0], entity, uuid, name, kind, _array(classes.get(entity, [])), part_of, _array(wholes), mass, *size)
        return tasks, entities

    def batch(self, first, last):
        """Of the episodes with these numbers: rows of them by UUID, each with its events, roles and values."""
        found, owner = {}, {}
        for number, *row in self.database.execute(
                "SELECT episode.id, episode.uuid, task.uuid, scenario, status, grammar, ticks_per_second, ticks, state_hash, outcome,"
                " engine, seed, program, program_hash, recorded_on, failure_entity, failure_reason, failure_advice"
                " FROM episode JOIN task ON task.id = task WHERE episode.id BETWEEN ? AND ? AND status <> 'recording'", (first, last)):
            found[number] = {"row": row, "number": number, "event": [], "event_role": [], "event_value": []}
        for event, number, *row in self.database.execute(
                "SELECT id, episode, event, begin_tick, end_tick, decided_tick, open_end, begin_s, end_s, duration_s FROM event"
                " WHERE episode BETWEEN ? AND ? ORDER BY episode, begin_tick, id", (first, last)):
            if number not in found:
                continue
            one = found[number]
            uuid, place = one["row"][0], len(one["event"])
            owner[event] = (one, uuid, place)
            row[4] = "t" if row[4] else "f"
            one["event"].append((uuid, place, _uuid8(f"{uuid} event {place}"), *row))
        for table, columns in (("event_role", "role, value, entity"), ("event_value", "name, value, unit")):
            for event, *row in self.database.execute(
                    f"SELECT event, position, {columns} FROM {table} WHERE event BETWEEN ? AND ? ORDER BY event, position",
                    (min(owner, default=0), max(owner, default=-1))):
                if event in owner:
                    one, uuid, place = owner[event]
                    one[table].append((uuid, place, *row))
        return {one["row"][0]: one for one in found.values()}


def _content(one):
    """A hash of all of it, whenever and wherever it was recorded."""
    row = one["row"][:13] + one["row"][14:]
    return hashlib.sha256(repr((row, one["event"], one["event_role"], one["event_value"])).encode()).hexdigest()[:32]


def _push_batch(cursor, file, batch):
    """Returns how many are new. The same UUID with other content is an error that names both."""
    cursor.execute("SELECT uuid::text, content, uri, number FROM prehend.episode WHERE uuid = ANY(%s::uuid[])", (list(batch),))
    rows = {table: _Rows() for table in ("episode", "event", "event_role", "event_value")}
    known = {uuid: rest for uuid, *rest in cursor}
    new = {}
    for uuid, one in batch.items():
        content = _content(one)
        if uuid not in known:
            new[uuid] = one
            rows["episode"].add(*one["row"], content, file.uri, one["number"])
            for table in ("event", "event_role", "event_value"):
                for row in one[table]:
                    rows[table].add(*row)
        elif known[uuid][0] != content:
            fail(EpisodeError, f"{file.path}: episode {one['number']} ({one['row'][2]}) has the UUID {uuid} of episode {known[uuid][2]} of "
                 f"{known[uuid][1]}, and is not the same", "delete one of the two", file.path)
    tasks = {one["row"][1] for one in new.values()}
    cursor.execute("SELECT uuid::text FROM prehend.task WHERE uuid = ANY(%s::uuid[])", (list(tasks),))
    task_rows, entities = file.tasks(tasks - {row[0] for row in cursor})
    for table, its in (("task", task_rows), ("entity", entities), *rows.items()):
        its.copy(cursor, table)
    return len(new)


def push_file(connection, path):
    """Pushes an episode file; returns how many episodes are new, were there, and were cut off."""
    file = _File(path)
    numbers = [row[0] for row in file.database.execute("SELECT id FROM episode WHERE status <> 'recording' ORDER BY id")]
    new, content = 0, file.hash()
    with connection, connection.cursor() as cursor:
        cursor.execute("SELECT 1 FROM prehend.file WHERE uri = %s AND hash = %s", (file.uri, content))
        if cursor.fetchone():  # it was pushed to its end, and has not changed since
            return 0, len(numbers), file.cut_off
        file.check()
        cursor.execute("INSERT INTO prehend.file VALUES(%s, '', 0) ON CONFLICT(uri) DO UPDATE SET hash = ''", (file.uri,))
    for start in range(0, len(numbers), BATCH):
        of_batch = numbers[start:start + BATCH]
        with connection, connection.cursor() as cursor:
            cursor.execute("SELECT pg_advisory_xact_lock(hashtext('prehend.push'))")  # parts of an array push at the same time
            new += _push_batch(cursor, file, file.batch(of_batch[0], of_batch[-1]))
    with connection, connection.cursor() as cursor:
        cursor.execute("UPDATE prehend.file SET hash = %s, bytes = %s WHERE uri = %s", (content, os.path.getsize(path), file.uri))
    return new, len(numbers) - new, file.cut_off


def push_takes(connection, path):
    """Takes and their labels, of a file of takes (docs/labels.md) whose recordings are episode files; returns two counts."""
    import yaml  # pylint: disable=import-outside-toplevel
    _File.program("query", path, "--count-by", "event")  # which reads them all, and says what is wrong
    here, takes, labels = pathlib.Path(path).parent, _Rows(), _Rows()
    said = yaml.safe_load(pathlib.Path(path).read_text(encoding="utf-8"))
    counted, source = [0, 0], pathlib.Path(path).absolute().as_uri()
    for entry, take in enumerate(said["takes"]):
        recording, file = here / take["recording"], take.get("labels", said.get("labels"))
        if recording.suffix != ".episodes":
            fail(EpisodeError, f"{path}: {take['recording']} is not kept in an episode file", "prehend import FILE -o NAME.episodes", path)
        uuids = [row[0] for row in sqlite3.connect(recording.absolute().as_uri() + "?mode=ro", uri=True).execute("SELECT uuid FROM episode ORDER BY id")]
        for uuid, one in zip(uuids, episodes.open(recording)):
            takes.add(uuid, source, str(take.get("person", "")), str(take.get("set", "")), str(file or ""))
            counted[0] += 1
            if not file:
                continue
            asked = str(take.get("grammar", ""))  # its own stands in the episode file
            compiled = grammar.Grammar(here / asked if asked.endswith(".grammar") else asked)._compiled if asked else None
            read = one._opened.read_labels(compiled, str(path), "", entry)  # with its rows, and by its clock
            for place, (event, roles, begin, end, *_) in enumerate(read):
                labels.add(uuid, source, place, event, json.dumps(dict(roles)), begin / one.ticks_per_second, end / one.ticks_per_second)
            counted[1] += len(read)
    with connection, connection.cursor() as cursor:
        for table in ("take", "label"):
            cursor.execute(f"DELETE FROM prehend.{table} WHERE source = %s", (source,))
        takes.copy(cursor, "take")
        labels.copy(cursor, "label")
    return counted


def push_scores(connection, path):
    """What 'prehend score --json' printed; returns how many rows."""
    rows, source, count = _Rows(), pathlib.Path(path).absolute().as_uri(), 0
    try:
        for one in json.loads(pathlib.Path(path).read_text(encoding="utf-8"))["grammars"]:
            for event in one["events"] + [one["total"]]:
                rows.add(source, *map(str, (one["grammar"], one["set"], event["event"])), json.dumps(event))
                count += 1
    except (LookupError, RecursionError, TypeError, ValueError) as error:
        fail(EpisodeError, f"{path}: found {error!r:.200}, wanted what 'prehend score --json' printed", file=path)
    with connection, connection.cursor() as cursor:
        cursor.execute("DELETE FROM prehend.score WHERE source = %s", (source,))
        rows.copy(cursor, "score")
    return count


def main(arguments):
    parser = argparse.ArgumentParser(prog="python3 -m prehend push", description="Episode files, files of takes and scores into PostgreSQL.")
    parser.add_argument("files", nargs="*", metavar="FILE", help="NAME.episodes; takes.yaml; what 'prehend score --json' printed, NAME.json")
    parser.add_argument("url", metavar="postgresql://USER@HOST/DATABASE")
    parser.add_argument("--create", action="store_true", help="make the tables and the roles prehend_read and prehend_write first")
    options = parser.parse_args(arguments)
    if not options.files and not options.create:
        parser.error("no file is named")
    for path in options.files:
        if not os.path.isfile(path):
            fail(EpisodeError, f"{path}: no such file", file=path)
    with connected(options.url) as connection:
        if options.create:
            with connection, connection.cursor() as cursor:
                cursor.execute(schema())
        for path in options.files:
            if path.endswith((".yaml", ".yml")):
                print("{}: {} takes, {} labels".format(path, *push_takes(connection, path)))
            elif path.endswith(".json"):
                print(f"{path}: {push_scores(connection, path)} rows of scores")
            else:
                new, same, cut_off = push_file(connection, path)
                print(f"{path}: {new} episodes are new, {same} were there" + (f"; {cut_off} were cut off, and stay away" if cut_off else ""))
            sys.stdout.flush()
    return 0
