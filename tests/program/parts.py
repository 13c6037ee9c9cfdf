# SPDX-License-Identifier: Apache-2.0
"""parts.py PROGRAM: parts of a suite and of trials that are stopped, merged, lost, and there twice (docs/many-machines.md)."""
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree

PROGRAM, SOURCE = os.path.abspath(sys.argv[1]), pathlib.Path(__file__).resolve().parents[2]
WHICH = "reach/*"


def run(*words, code=0, folder=SOURCE):
    said = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, cwd=folder, env={**os.environ, "PREHEND_HOME": str(SOURCE)})
    assert said.returncode == code, (words, said.returncode, said.stdout[-800:], said.stderr[-800:])
    return said


def checking(folder, part, *more):
    return ["check", WHICH, "--no-pictures", "--jobs", "2", "--report", folder / f"page-{part}", "--record", folder / f"part-{part}.episodes", *more]


def episodes(file, mode="ro"):
    with sqlite3.connect(f"file:{file}?mode={mode}", uri=True) as database:
        return [row[0] for row in database.execute("SELECT scenario FROM episode JOIN task ON task.id = task WHERE status <> 'recording'")]


def killed(words, file, complete=1):
    """Kills it as soon as so many episodes are complete. Returns how many were."""
    process = subprocess.Popen([PROGRAM, *map(str, words)], cwd=SOURCE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while process.poll() is None:
        try:
            if len(episodes(file)) >= complete:
                break
        except sqlite3.Error:
            pass
        time.sleep(0.005)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    time.sleep(0.2)  # its workers die with it
    # In a copy: a transaction that was cut off is taken back, which whoever only reads may not do.
    with tempfile.TemporaryDirectory() as folder:
        for left in (file, pathlib.Path(f"{file}-journal"), pathlib.Path(f"{file}-wal")):
            if left.exists():
                shutil.copy(left, folder)
        return len(episodes(pathlib.Path(folder) / pathlib.Path(file).name, "rw"))


def verdicts(file, folder):
    junit = folder / "verdicts.xml"
    run("check", file, "--no-pictures", "--report", folder / "page", "--junit", junit)
    return sorted((case.get("classname"), case.get("name"), [one.tag for one in case]) for case in xml.etree.ElementTree.parse(junit).iter("testcase"))


def told(folder, file, file_in_order):
    """Page, verdicts and scores of an episode file without times; then the page of `report`, which has the order of the file."""
    folder.mkdir()
    shutil.copyfile(file, folder / "all.episodes")
    run("check", "all.episodes", "--no-pictures", "--report", "page", "--junit", "all.xml", folder=folder)
    scores = run("score", "all.episodes", "--json", folder=folder).stdout
    shutil.copyfile(file_in_order, folder / "all.episodes")
    run("report", "all.episodes", "-o", "all.html", folder=folder)
    times = r"\d+ s of work|, of commit \w+(, with changes)?|<div>\d+\.\d\d s  [^<]*</div>|(?<=>)\d+\.\d s(?=</td>)| time=\"[\d.]+\""
    return [re.sub(times, "", text) for text in (*((folder / name).read_text() for name in ("page/index.html", "all.xml", "all.html")), scores)]


def told_the_same(folder, merged, one_run, one_run_in_order):
    for name, here, there in zip(("the page of check", "JUnit", "the page of report", "scores"), told(folder / "of-parts", merged, merged),
                                 told(folder / "of-one", one_run, one_run_in_order)):
        if here != there:
            at = next((i for i, (a, b) in enumerate(zip(here, there)) if a != b), min(len(here), len(there)))
            raise AssertionError((name, here[at - 200:at + 200], there[at - 200:at + 200]))


def suite(folder):
    part = [folder / f"part-{i}.episodes" for i in range(4)]
    run(*checking(folder, 1, "--shard", "1/3"))
    run(*checking(folder, 3, "--shard", "3/3"))
    run(*checking(folder, 2, "--shard", "2/3"))
    unbroken = part[2].read_bytes()
    part[2].unlink()
    kept = killed(checking(folder, 2, "--shard", "2/3"), part[2])
    owed = len(list((SOURCE / "scenarios/reach").glob("*.yaml"))) // 3
    missing = run("report", part[1], part[2], part[3], "-o", folder / "page.html", code=3).stderr if kept < owed else ""
    assert "part 2 of 3 lacks" in missing or kept >= owed, missing
    again = run(*checking(folder, 2, "--shard", "2/3", "--json"))
    assert f"it has {kept} of " in again.stderr, again.stderr
    assert part[2].read_bytes() == unbroken, "the bytes of an unbroken run"
    assert [one["verdict"] for one in json.loads(again.stdout)["scenarios"]] == ["passed"] * len(episodes(part[2]))

    run(*checking(folder, 0))  # all, in one run
    run("episode", "merge", part[0], "-o", folder / "one.episodes")
    all_ = folder / "all.episodes"
    run("episode", "merge", *part[1:], "-o", all_, "--expect", 3)
    assert all_.read_bytes() == (folder / "one.episodes").read_bytes()
    import many_episodes  # needs python3-xxhash

    foreign = folder / "foreign.episodes"  # of somebody who keeps notes in the file
    shutil.copyfile(part[1], foreign)
    with sqlite3.connect(foreign) as database:
        database.executescript("CREATE TABLE notes(of, note); INSERT INTO notes VALUES(1, 'x'); ALTER TABLE episode ADD COLUMN seen_by")
    database.close()
    many_episodes.sum_pages(foreign)
    said = run("episode", "merge", foreign, *part[2:], "-o", folder / "own.episodes")
    assert f"warning: {foreign}: not copied, as it is none of prehend's: episode.seen_by, notes\n" in said.stderr, said.stderr
    assert (folder / "own.episodes").read_bytes() == all_.read_bytes()
    assert len(set(episodes(all_))) == len(episodes(all_)) == len(list((SOURCE / "scenarios/reach").glob("*.yaml")))
    assert verdicts(all_, folder) == verdicts(part[0], folder)
    told_the_same(folder, all_, part[0], folder / "one.episodes")

    lost = f"check '{WHICH}': part 2 of 3 is missing, with {len(episodes(part[2]))} episodes: " + ", ".join(sorted(episodes(part[2])))
    for words in (["report", "-o", folder / "page.html"], ["check", "--no-pictures", "--report", folder / "page"], ["score"], ["episode", "query", "--event", "reaching"],
                  ["episode", "merge", "-o", folder / "two.episodes"]):
        said = run(*words, part[1], part[3], code=3)
        assert lost in said.stderr and said.stdout, said.stderr
    assert lost in run("report", folder / "two.episodes", "-o", folder / "page.html", code=3).stderr
    assert "--expect: found 2 files, wanted 3" in run("episode", "merge", part[1], part[3], "-o", folder / "two.episodes", "--expect", 3, code=3).stderr
    run("episode", "query", part[1], part[3], "--event", "reaching", "--episode", "reach/*")  # which selects some
    # A part twice, as after a task that was queued again into another file.
    shutil.copyfile(part[1], folder / "again.episodes")
    said = run("episode", "merge", *part[1:], folder / "again.episodes", "-o", folder / "twice.episodes")
    assert f"{len(episodes(part[1]))} were there twice" in said.stdout
    assert (folder / "twice.episodes").read_bytes() == all_.read_bytes()
    # Again over what it made, but not over episodes that it would lose.
    run("episode", "merge", *part[1:], "-o", folder / "twice.episodes")
    said = run("episode", "merge", part[1], "-o", folder / "twice.episodes", code=2)
    lost = len(episodes(all_)) - len(episodes(part[1]))
    assert f"has {lost} of {len(episodes(all_))} episodes that would be lost" in said.stderr, said.stderr
    assert (folder / "twice.episodes").read_bytes() == all_.read_bytes()
    not_the_same(part, folder)
    hostile(part, folder)


def not_the_same(part, folder):
    import many_episodes  # needs python3-xxhash
    other = folder / "other.episodes"
    shutil.copyfile(part[1], other)
    with sqlite3.connect(other) as database:
        database.execute("UPDATE event SET end_tick = end_tick + 1 WHERE id = 1")
    database.close()
    run("episode", "merge", *part[1:], other, "-o", folder / "no.episodes", code=2)
    many_episodes.sum_pages(other)
    said = run("episode", "merge", *part[1:], other, "-o", folder / "no.episodes", code=2)
    assert "is not the same" in said.stderr and "part-1.episodes" in said.stderr and "other.episodes" in said.stderr, said.stderr
    assert not list(folder.glob("no.episodes*"))


def hostile(part, folder):
    """Rows that nobody wrote: numbers out of range, more of everything than anybody has."""
    import many_episodes  # needs python3-xxhash

    def after(sql, *words, code):
        file, begin = folder / "hostile.episodes", os.times()
        shutil.copyfile(part[1], file)
        with sqlite3.connect(file) as database:
            database.executescript(sql)
        database.close()
        many_episodes.sum_pages(file)
        told = run(*words, file, code=code).stderr
        assert os.times().children_user - begin.children_user < 5, sql
        return told
    many = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < {}) INSERT INTO {} FROM n"
    for sql, code, said in (("UPDATE plan_owed SET part = 4", 2, "found part 4 of 3"), ("UPDATE plan SET part = -1", 2, "found part -1 of 3"),
                            ("UPDATE plan SET parts = 1 << 40", 2, "found part 1099511627776 of 10000"),
                            ("UPDATE plan_owed SET name = 'a' || char(27) || '[31m'", 2, "the file is damaged"),
                            ("UPDATE plan SET uuid = '../../x'", 2, "the file is damaged"),
                            (many.format(20000, "plan(what, uuid, part, parts) SELECT 'x', uuid, 1, 1") + ", plan WHERE plan.id = 1", 2, "20001 plans"),
                            ("UPDATE plan SET parts = 10000", 3, "part 3 of 10000 is missing"),
                            (many.format(100000, "plan_owed(plan, position, part, name, uuid) SELECT 1, i + 1000, i % 10000 + 1, 'n' || i, ''"), 3, "and 9950 parts more"),
                            (many.format(300, "plan(id, what, uuid, part, parts) SELECT i + 9, 'x' || i, printf('%08x-0000-4000-8000-000000000000', i), 1, 1") + ";" +
                             many.format(300, "plan_owed(plan, position, part, name, uuid) SELECT i + 9, 0, 1, 'n', ''"), 3, "\nand so of 252 more\n")):
        if said.startswith("and"):
            sql = "UPDATE plan SET parts = 10000; " + sql
        told = after(sql, "episode", "merge", "-o", folder / "no.episodes", code=code)
        assert said in told and len(told) < 50 * 2300 and "\x1b" not in told, told[:300]
    for sql, said in (("UPDATE event SET begin_tick = 'abc'", "found 'abc', wanted an integer"), ("UPDATE event SET begin_tick = 1.5", "wanted an integer"),
                      ("UPDATE event SET end_tick = 1 << 62", "wanted an integer"), ("UPDATE event SET end_tick = begin_tick - 1", "found the number"),
                      ("UPDATE episode SET ticks_per_second = 0", "found the number 0, wanted 1"),
                      ("UPDATE entity SET part_of = 1 << 40", "found the number 1099511627776"), ("UPDATE entity SET size_x_m = 'wide'", "wanted a number")):
        told = after(sql, "episode", "query", "--event", "*", "--part-of", "any=Hand", code=2)
        assert "the file is damaged: " in told and said in told, (sql, told[:300])
    # Each of many events that lie in one another has the others as parts: a question that does not ask for them does not look.
    columns = "event(episode, event, begin_tick, end_tick, decided_tick, open_end, begin_s, end_s, duration_s)"
    rate = "(SELECT ticks_per_second * 1.0 FROM episode WHERE id = 1)"
    times = f"i % 1000, i % 1000 + 300, 0, 0, i % 1000 / {rate}, (i % 1000 + 300) / {rate}, 300 / {rate}"
    after(many.format(30000, columns + f" SELECT 1, 'contact', {times}"), "episode", "query", "--count-by", "event", code=3)


def trials(folder):
    words = lambda file, *more: ["run", "trials/gripper_places_a_box", "--trials", "7", "--json", "--jobs", "2", "--record", folder / file, *more]
    whole = json.loads(run(*words("whole.episodes")).stdout)
    parts = [folder / f"trials-{i}.episodes" for i in (1, 2)]
    for i, file in enumerate(parts, 1):
        killed(words(file.name, "--shard", f"{i}/2"), file)
        said = json.loads(run(*words(file.name, "--shard", f"{i}/2")).stdout)
        assert said["results"] == whole["results"][i - 1::2], said
    run("episode", "merge", folder / "whole.episodes", "-o", folder / "one-trials.episodes")
    run("episode", "merge", *parts, "-o", folder / "all-trials.episodes")
    assert (folder / "one-trials.episodes").read_bytes() == (folder / "all-trials.episodes").read_bytes()
    missing = run("episode", "merge", parts[1], "-o", folder / "half.episodes", code=3).stderr
    assert "part 1 of 2 is missing, with 4 episodes: trials/gripper_places_a_box, trial 1, " in missing, missing


def imports(folder):
    """A folder of takes into one file: stopped at any moment, and again; the bytes are those of an unbroken import."""
    takes, map_, whole, file = folder / "takes", folder / "map.yaml", folder / "imported.episodes", folder / "stopped.episodes"
    takes.mkdir()
    map_.write_text("import: 1\nunit: m\naxes: z_up\nquaternion_order: wxyz\ntime_unit: s\ncolumns: {time: t, body: name, position: ['x', 'y', 'z'], "
                    "quaternion: [qw, qx, qy, qz]}\nentities:\n  table: {at_m: [0, 0, 0.7], fixed: true, class: Table, size_m: [2, 1, 0.04]}\n"
                    "  cup: {from: cup, class: Cup, size_m: [0.08, 0.08, 0.1]}\n  hand: {from: hand, hand: true, size_m: [0, 0, 0]}\n")
    for take in range(20):
        rows = [f"{k / 60:.4f},{name},{x + take / 100:.4f},0,{z:.4f},1,0,0,0" for k in range(240)
                for name, x, z in (("cup", 0, 0.77), ("hand", 0.3 - k / 1000, 0.9))]
        (takes / f"take{take:02}.csv").write_text("\n".join(["t,name,x,y,z,qw,qx,qy,qz", *rows]) + "\n")
    words = lambda out: ["import", takes, "--map", map_, "-o", out]
    assert run(*words(whole)).stdout.endswith("20 of 20 takes\n")
    unbroken = whole.read_bytes()
    kept = [killed(words(file), file, more) for more in (1, 4, 9)]
    said = run(*words(file))
    there = "it has this recording already; it is not added again"
    assert kept == sorted(kept) and f"{file}: {there} (and so of {kept[-1] - 1} others)\n" in said.stderr, (kept, said.stderr)
    assert file.read_bytes() == unbroken and len(set(episodes(file))) == 20
    assert f"{there} (and so of 19 others)" in run(*words(file)).stderr and file.read_bytes() == unbroken
    # Half of them on each of two machines, some on both.
    names = sorted(takes.iterdir())
    for part, its in ((1, names[:12]), (2, names[8:])):
        run("import", *its, "--map", map_, "-o", folder / f"imported-{part}.episodes")
    said = run("episode", "merge", folder / "imported-1.episodes", folder / "imported-2.episodes", "-o", folder / "both.episodes")
    assert "20 episodes of 2 files; 4 were there twice" in said.stdout, said.stdout
    run("import", names[0], "--map", map_, "-o", folder / "take.jsonl")
    for said in ("", f"{folder / 'alone.episodes'}: {there}\n"):
        assert run("import", folder / "take.jsonl", "-o", folder / "alone.episodes").stderr.endswith(said)
    assert len(episodes(folder / "alone.episodes")) == 1


def bad_use(folder):
    assert "wanted a file NAME.episodes" in run("episode", "merge", folder / "part-1.episodes", "-o", folder / "x.db", code=2).stderr
    assert "no such file" in run("episode", "merge", folder / "none.episodes", "-o", folder / "x.episodes", code=2).stderr
    assert "it needs --trials" in run("run", "trials/gripper_places_a_box", "--shard", "1/2", code=2).stderr
    assert "wanted I/N" in run("check", "--shard", "3/2", code=2).stderr
    assert "no file of costs" in run("check", WHICH, "--shard", "1/2:" + str(folder / "none.json"), code=2).stderr


def begun(words, is_begun, **more):
    process = subprocess.Popen([PROGRAM, *map(str, words)], cwd=SOURCE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **more)
    while not is_begun():
        assert process.poll() is None, process.communicate()
        time.sleep(0.005)
    return process


def one_writer(folder):
    """Two processes never write the same part; who only adds episodes may do so at the same time."""
    file = folder / "written.episodes"
    words = ["check", "long/a_table_is_set_for_two", "milk_carton_wrap", "--no-pictures", "--jobs", "1", "--record", file, "--report"]
    first = begun([*words, folder / "first"], lambda: file.exists() and file.stat().st_size > 100_000)
    refused = f"{file}: another process is writing this file\n"
    others = (
        [*words, folder / "second", "--shuffle", "3"],
        ["run", "milk_carton_wrap", "--record", file],
        ["episode", "merge", folder / "part-1.episodes", "-o", file],
    )
    with concurrent.futures.ThreadPoolExecutor() as at_once:  # each waits for a second, and the first goes on
        said = list(at_once.map(lambda other: run(*other, code=3).stderr, others))
    assert all(refused in one for one in said), said
    assert all("prehend: --record: " in one for one in said[:2]), said
    said = first.communicate()
    assert first.returncode == 0, said
    assert len(set(episodes(file))) == len(episodes(file)) == 2
    run("episode", "verify", file)
    run(*words, folder / "again")  # what is complete is not played again
    together = folder / "together.episodes"
    first = begun(["run", "long/a_table_is_set_for_two", "--record", together], lambda: together.exists() and together.stat().st_size > 100_000)
    run("run", "milk_carton_wrap", "--record", together)
    assert first.wait() == 0 and len(episodes(together)) == 2
    run("episode", "verify", together)


def full_disk(folder):
    """Exit code 3, and nothing is left: a small limit for the size of files stands for a full disk."""
    for words, left in ((["episode", "merge", folder / "part-1.episodes", "-o", folder / "full" / "a.episodes"], []),
                        (["check", "reach/*", "--shard", "1/1", "--no-pictures", "--report", folder / "page", "--record", folder / "full" / "b.episodes"], [])):
        (folder / "full").mkdir(exist_ok=True)
        said = subprocess.run(["bash", "-c", 'ulimit -f 20; exec "$@"', "x", PROGRAM, *map(str, words)], capture_output=True, text=True, cwd=SOURCE)
        assert said.returncode == 3 and any(why in said.stderr for why in ("become larger than it may", "disk is full", "disk I/O error")), said
        assert list((folder / "full").iterdir()) == left
        shutil.rmtree(folder / "full")


def nothing_left(folder):
    """No folder for temporary files stays, however a command ends."""
    temporary = folder / "temporary"
    temporary.mkdir()
    more = {"env": {**os.environ, "TMPDIR": str(temporary)}, "start_new_session": True}
    file = folder / "part-1.episodes"
    for word in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        for words in (["check", file, "--no-pictures", "--jobs", "2", "--report", folder / "page"], ["episode", "verify", file, "--jobs", "2"]):
            stopped = begun(words, lambda: any(temporary.iterdir()), **more)
            stopped.send_signal(word)
            stopped.communicate()
            assert stopped.returncode in (-word, 0, 3) and not list(temporary.iterdir()), (words, word, stopped.returncode, list(temporary.iterdir()))
    for limit in ("0.05", "0.1", "0.2"):
        subprocess.run([PROGRAM, "episode", "verify", file, "--time-limit-s", limit], capture_output=True, cwd=SOURCE, **more)
        assert not list(temporary.iterdir()), limit
    for descriptors in range(4, 12):
        subprocess.run(["bash", "-c", f'ulimit -n {descriptors}; exec "$@"', "x", PROGRAM, "episode", "verify", file, "--jobs", "1"], capture_output=True, cwd=SOURCE, **more)
        assert not list(temporary.iterdir()), descriptors


def projects(folder):
    """What lies in a project without being a part of it."""
    project = folder / "project"
    (project / "scenarios").mkdir(parents=True)
    (project / "prehend.yaml").write_text("project: 1\n")
    shutil.copyfile(SOURCE / "scenarios/pick_and_place/milk_carton_wrap.yaml", project / "scenarios/milk_carton_wrap.yaml")
    with open(project / "scenarios/take.mp4", "wb") as film:
        film.truncate(1 << 40)
    here = {"capture_output": True, "text": True, "cwd": project, "env": {key: value for key, value in os.environ.items() if key != "PREHEND_HOME"}}
    said = subprocess.run([PROGRAM, "check", "--no-pictures", "--record", "a.episodes"], timeout=120, **here)
    assert said.returncode == 5, said  # it has no golden
    # One that is there twice and one that is not there: each is named by its file.
    (project / "scenarios/loop").symlink_to(".")
    (project / "scenarios/dangling.yaml").symlink_to("nope")
    said = subprocess.run([PROGRAM, "validate"], **here)
    assert said.returncode == 2, said
    for name in ("scenarios/milk_carton_wrap.yaml", "scenarios/loop/milk_carton_wrap.yaml"):
        assert f"ok: {project / name}\n" in said.stdout, said
    for name in ("scenarios/dangling.yaml", "scenarios/loop/dangling.yaml"):
        assert f"{project / name}: error: " in said.stderr, said
    # Recorded work is not replaced by another kind of file.
    before = (project / "a.episodes").read_bytes()
    for words in (["check", "milk_carton_wrap", "--junit", "a.episodes"], ["run", "milk_carton_wrap", "--report", "a.episodes"]):
        said = subprocess.run([PROGRAM, *words], **here)
        assert said.returncode == 2 and "is a file of episodes; name another file" in said.stderr, said
    assert (project / "a.episodes").read_bytes() == before


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as path:
        suite(pathlib.Path(path))
        trials(pathlib.Path(path))
        imports(pathlib.Path(path))
        one_writer(pathlib.Path(path))
        full_disk(pathlib.Path(path))
        nothing_left(pathlib.Path(path))
        projects(pathlib.Path(path))
        bad_use(pathlib.Path(path))
