# SPDX-License-Identifier: Apache-2.0
"""pushed.py PROGRAM COUNT: COUNT episodes in PostgreSQL, asked there and in their file, and what goes wrong on the way."""
import json
import os
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import time

import psycopg2

import many_episodes
import postgres

PROGRAM, COUNT = sys.argv[1], int(sys.argv[2])
SOURCE = pathlib.Path(__file__).resolve().parents[2]
os.environ["PREHEND_PROGRAM"] = PROGRAM
SCENARIOS = ["pick_and_place/milk_carton_wrap", "furniture/fridge_is_opened_by_its_handle", "kitchen/cereal_box_is_slid_near_and_set_down",
             "pick_up/slide_then_pick_up"]
QUESTIONS = [["--event", "transporting", "--role", "object=MilkCarton"], ["--relation", "has picking_up"], ["--event", "grasp*", "--role", "any=milk"],
             ["--event", "grasping", "--role", "object=Handle", "--part-of", "object=fridge"], ["--lasts-s", "0.5..2"], ["--lasts-s", "..0.4"],
             ["--relation", "meets transporting"], ["--relation", "during grasping", "--event", "*ing"], ["--from", "1", "--to", "4", "--episode", "pick_up/*"],
             ["--relation", "before transporting", "--event", "reaching"], ["--relation", "overlaps contact"], ["--event", "no_such_event"]]


def program(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, cwd=SOURCE)


def python(*arguments, **environment):
    return subprocess.run([sys.executable, "-m", "prehend", *arguments], capture_output=True, text=True, env={**os.environ, **environment})


def expect(said, code, *texts):
    assert said.returncode == code, (said.args, said.returncode, said.stdout[-500:], said.stderr[-1500:])
    for text in texts:
        assert text in said.stdout + said.stderr, (text, said.stdout[-500:], said.stderr[-1500:])
    assert "Traceback" not in said.stderr and "secret" not in said.stderr, said.stderr
    return said.stdout


def counts(connection, prefix=""):
    return [connection.execute(f"SELECT count(*) FROM {prefix}{table}").fetchone()[0]
            for table in ("task", "entity", "episode", "event", "event_role", "event_value")]


class Asked:
    """psycopg2 that is asked as sqlite3 is."""

    def __init__(self, url):
        self.connection = psycopg2.connect(url)
        self.connection.autocommit = True

    def execute(self, sql, values=None):
        cursor = self.connection.cursor()
        cursor.execute(sql, values)
        return cursor


def same_answers(url, file):
    for question in QUESTIONS:
        here, there = program("episode", "query", file, *question, "--json"), python("query", url, *question, "--json")
        assert here.returncode == there.returncode, (question, here.stderr, there.stderr)
        rows = [[[one[key] for key in ("episode", "scenario", "event", "roles", "begin_s", "end_s")] for one in json.loads(said.stdout)] for said in (here, there)]
        assert sorted(map(repr, rows[0])) == sorted(map(repr, rows[1])), (question, rows[0][:2], rows[1][:2])
    by = ["--event", "grasping", "--count-by", "style,object_class", "--json"]
    key = lambda text: sorted(map(repr, json.loads(text)))
    assert key(program("episode", "query", file, *by).stdout) == key(python("query", url, *by).stdout)
    expect(python("query", url, "--event", "x'; DROP TABLE prehend.event; --"), 4)


def same_documented(asked, file):
    """The questions of docs/many-machines.md, which are the same text for both."""
    page = (SOURCE / "docs/many-machines.md").read_text()
    block = re.search(r"```sql\n(.*?)```", page, re.S).group(1)
    database = sqlite3.connect(file)
    asked.execute("SET search_path = prehend")
    for sql in filter(str.strip, re.sub(r"--.*", "", block).split(";")):
        rows = [sorted(repr([round(cell, 6) if isinstance(cell, float) else cell for cell in row]) for row in side.execute(sql)) for side in (database, asked)]
        assert rows[0] == rows[1] and rows[0], (sql, rows[0][:3], rows[1][:3])
    event = [row[0] for row in asked.execute("EXPLAIN SELECT * FROM prehend.event WHERE episode = '00000000-0000-4000-8000-000000000000'")]
    assert len({name for line in event for name in re.findall(r"\bevent_\d\b", line)}) == 1, event


def stopped_in_the_middle(server, file):
    """What was written is kept, the next push completes it."""
    asked = Asked(server.url(database="other"))
    url = server.url(database="other")
    expect(python("push", "--create", url), 0)
    pushing = subprocess.Popen([sys.executable, "-m", "prehend", "push", file, url], stderr=subprocess.PIPE, text=True)
    while asked.execute("SELECT count(*) FROM prehend.episode").fetchone()[0] == 0 and pushing.poll() is None:
        time.sleep(0.02)
    server.stop("immediate")
    said = pushing.communicate()[1]
    server.start()
    asked = Asked(url)
    kept = counts(asked, "prehend.")
    if pushing.returncode:  # else it was faster
        assert pushing.returncode == 2 and "push again" in said and "Traceback" not in said, said
        assert 0 < kept[2] < COUNT and kept[2] % 1000 == 0, kept
    expect(python("push", file, url), 0, f"{COUNT - kept[2]} episodes are new, {kept[2]} were there")
    assert counts(asked, "prehend.") == counts(sqlite3.connect(file))
    print(f"stopped after {kept[2]} episodes, completed by the next push")


def rights(server, asked, file):
    asked.execute("CREATE ROLE guest LOGIN PASSWORD 'secret'")
    guest = server.url(user="guest")
    expect(python("query", guest, "--event", "grasping"), 2, "permission denied", "prehend_read")
    asked.execute("GRANT prehend_read TO guest")
    expect(python("query", guest, "--event", "grasping"), 0)
    other = file + ".copy"
    shutil.copyfile(file, other)
    expect(python("push", other, guest), 2, "permission denied", "GRANT prehend_write")
    asked.execute("GRANT prehend_write TO guest")
    expect(python("push", other, guest), 0, "0 episodes are new")
    expect(python("push", file, server.url(password="wrong")), 2, "password authentication failed", "PGPASSWORD")
    expect(python("push", file, "postgresql://owner@127.0.0.1:1/postgres"), 2, "push again when the server runs")
    expect(python("push", file, "sqlite:///x"), 2, "wanted postgresql://")
    expect(python("push", file + ".none", server.url()), 2, "no such file")
    expect(python("query", server.url(), "--relation", "durng x"), 2, "wanted 'RELATION EVENT'")
    for words, said in ((("--event", ""), "--event: the value is empty"), (("--count-by", ""), "--count-by: the value is empty"),
                        (("--from", "-1"), "found '-1', wanted a number from 0"), (("--role", "foo=milk"), "no event has a role 'foo'; there are: "),
                        (("--part-of", "foo=x"), "no event has a role 'foo'")):
        expect(python("query", server.url(), *words), 2, said)


def not_the_same(server, file):
    other = file + ".other.episodes"
    shutil.copyfile(file, other)
    with sqlite3.connect(other) as database:
        database.execute("UPDATE event SET end_tick = end_tick + 1 WHERE id = 1")
    database.close()
    expect(python("push", other, server.url()), 2, "is damaged")
    many_episodes.sum_pages(other)
    expect(python("push", other, server.url()), 2, "is not the same", "many.episodes", other)


def full_disk(server, file):
    """A table space of 8 MB, where one can be mounted."""
    place = server.folder / "full"
    place.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8m", "tmpfs", place], capture_output=True).returncode:
        return print("full disk: nothing can be mounted here")
    try:
        os.chown(place, server.folder.stat().st_uid, -1)
        asked = Asked(server.url())
        asked.execute("CREATE DATABASE small")
        asked = Asked(server.url(database="small"))
        asked.execute("CREATE TABLESPACE full_disk LOCATION %s", (str(place),))
        asked.execute("ALTER DATABASE small SET default_tablespace = full_disk")
        expect(python("push", "--create", server.url(database="small")), 0)
        expect(python("push", file, server.url(database="small")), 2, "disk is full")
        asked = Asked(server.url())
        asked.execute("DROP DATABASE small WITH (FORCE)")
        asked.execute("DROP TABLESPACE full_disk")
    finally:
        subprocess.run(["umount", place], check=True)


def takes_and_scores(server, asked, base, folder):
    labels = folder / "labels.csv"
    labels.write_text("begin_s,end_s,label\n0.5,1.0,reaching(right_hand, milk)\n1.0,2.5,\"grasping(right_hand, milk)\"\n".replace("reaching(right_hand, milk)", '"reaching(right_hand, milk)"'))
    one = folder / "one.episodes"
    program("run", SCENARIOS[0], "--record", str(one))
    takes = folder / "takes.yaml"
    takes.write_text("takes:\n- {recording: one.episodes, labels: labels.csv, person: P7, set: test}\n")
    mine = folder / "mine"
    mine.mkdir()
    (mine / "own.grammar").write_text("grammar own\nuse grasp\nevent reaching(hand: Hand, object: Thing) while distance(hand, object) < 1 m\n")
    beside = mine / "takes.yaml"
    beside.write_text("takes:\n- {recording: ../one.episodes, labels: ../labels.csv, grammar: own.grammar}\n")
    expect(python("push", str(one), str(beside), server.url()), 0, "1 takes, 2 labels")
    scores = folder / "scores.json"
    scores.write_text(program("score", str(takes), "--json").stdout)
    for _ in range(2):
        expect(python("push", str(one), str(takes), str(scores), server.url()), 0, "1 takes, 2 labels", "rows of scores")
    for name, text in (("a.json", "[" * 100000), ("b.json", '{"grammars": 3}'), ("c.json", '{"grammars": [{"events": [], "total": {}}]}'), ("d.json", ""),
                       ("e.yaml", "takes: &a [*a]"), ("f.yaml", "- 1"), ("g.yaml", "takes:\n- {recording: none.episodes}\n"), ("h.yaml", "takes: 3"), ("i.yaml", "takes: [3]")):
        (folder / name).write_text(text)
        expect(python("push", str(folder / name), server.url()), 2, "none.episodes" if name == "g.yaml" else name)
    assert asked.execute("SELECT person, set_name, count(*) FROM prehend.take JOIN prehend.label USING(episode, source) GROUP BY 1, 2").fetchall() == [("P7", "test", 2)]
    assert asked.execute("SELECT count(*) FROM prehend.score WHERE event = 'all' AND (found->>'true')::int = 2").fetchone() == (1,)


def main(folder):
    base, file = str(folder / "base.episodes"), str(folder / "many.episodes")
    for scenario in SCENARIOS:
        assert program("run", scenario, "--record", base).returncode in (0, 1)
    many_episodes.multiply(base, COUNT, file)
    with postgres.server() as server:
        asked = Asked(server.url())
        expect(python("push", file, server.url()), 2, "push --create")
        expect(python("push", "--create", server.url()), 0)
        expect(python("push", "--create", server.url()), 2, "already")
        before, begin = os.times(), time.time()
        expect(python("push", file, server.url()), 0, f"{COUNT} episodes are new, 0 were there")
        after = os.times()
        cpu_s = after.children_user + after.children_system - before.children_user - before.children_system
        print(f"{COUNT} episodes pushed in {time.time() - begin:.1f} s, {cpu_s:.1f} CPU-s of the client")
        assert cpu_s < 3 + COUNT / 1000, cpu_s
        first, begin = counts(asked, "prehend."), time.time()
        expect(python("push", file, server.url()), 0, f"0 episodes are new, {COUNT} were there")
        print(f"and again in {time.time() - begin:.1f} s")
        assert counts(asked, "prehend.") == first == counts(sqlite3.connect(file)), first
        same_answers(server.url(), file)
        same_documented(asked, file)
        rights(server, asked, file)
        not_the_same(server, base)
        takes_and_scores(server, asked, base, folder)
        full_disk(server, file)
        asked.execute("CREATE DATABASE other")
        stopped_in_the_middle(server, file)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as path:
        main(pathlib.Path(path))
