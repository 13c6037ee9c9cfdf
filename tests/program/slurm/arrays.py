# SPDX-License-Identifier: Apache-2.0
"""arrays.py PROGRAM [NAMES..]: examples/slurm with real daemons (as root): an array of 8 over the suite, or what the names select of it,
with a task that is queued again and one that is killed, a time limit, trials, imports, a sweep; then GNU parallel."""
import contextlib
import os
import pathlib
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import parts

PROGRAM, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(__file__).resolve().parents[3]
NAMES, PARTS = sys.argv[2:], 8
SUBMIT = SOURCE / "examples/slurm/submit"


def run(*words, code=0, folder=None):
    said = subprocess.run([*map(str, words)], capture_output=True, text=True, cwd=folder)
    assert said.returncode == code, (words, said.returncode, said.stdout[-800:], said.stderr[-800:])
    return said.stdout


def states():
    """By what scontrol calls a job (5_3: task 3 of array 5) its state."""
    jobs = {}
    for line in run("scontrol", "-o", "show", "job").splitlines():
        said = dict(word.split("=", 1) for word in line.split() if "=" in word)
        if "JobId" in said:
            jobs[f"{said['ArrayJobId']}_{said['ArrayTaskId']}" if "ArrayTaskId" in said else said["JobId"]] = said["JobState"]
    return jobs


def wait_for(condition, seconds, what):
    end = time.time() + seconds
    while not (found := condition()):
        assert time.time() < end, (what, states())
        time.sleep(0.1)
    return found


def ended(seconds=3600):
    wait_for(lambda: time.sleep(1) or not {"PENDING", "RUNNING", "COMPLETING", "CONFIGURING"} & set(states().values()), seconds, "jobs end")


def episodes(file):
    with contextlib.suppress(sqlite3.Error), contextlib.closing(sqlite3.connect(f"file:{file}?mode=ro", uri=True)) as database:
        return [row[0] for row in database.execute("SELECT scenario FROM episode JOIN task ON task.id = task WHERE status <> 'recording'")]
    return []


def workers(folder, part):
    """The processes that write this part."""
    wanted, found = f"parts/part-{part}.episodes", []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            words = (process / "cmdline").read_bytes().decode().split("\0")
            if wanted in words and words[0].endswith("prehend") and os.readlink(process / "cwd") == str(folder):
                found.append(int(process.name))
    return found


def suite(folder):
    array = run(SUBMIT, "check.sbatch", PARTS, *NAMES, folder=folder).strip()
    part = lambda i: folder / f"parts/part-{i}.episodes"
    first, second = 1, 2
    wait_for(lambda: len(episodes(part(first))) > 0, 600, "an episode of part 1")
    run("scontrol", "requeue", f"{array}_{first}")
    kept_first = len(episodes(part(first)))
    wait_for(lambda: len(episodes(part(second))) > 0, 600, "an episode of part 2")
    for process in workers(folder, second):
        with contextlib.suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)
    wait_for(lambda: states()[f"{array}_{second}"] == "FAILED", 60, "part 2 fails")
    kept_second = len(episodes(part(second)))
    print(f"part 1 was queued again after {kept_first} episodes, part 2 killed after {kept_second}")
    run("scontrol", "requeue", f"{array}_{second}")
    ended()
    assert {state for job, state in states().items() if job.startswith(array + "_")} == {"COMPLETED"}, \
        (states(), *[(folder / f"parts/prehend-check-{i}.log").read_text() for i in (first, second)])
    log = (folder / "parts/prehend-check-2.log").read_text()
    assert f"it has {kept_second} of " in log, log

    # What one run has: every episode once, the same bytes, page, verdicts and scores.
    one = folder / "one.episodes"
    run(PROGRAM, "check", *NAMES, "--no-pictures", "--record", one, "--report", folder / "page")
    run(PROGRAM, "episode", "merge", one, "-o", folder / "one-merged.episodes")
    run(PROGRAM, "episode", "merge", *map(part, range(1, PARTS + 1)), "-o", folder / "all.episodes", "--expect", PARTS)
    merged = episodes(folder / "all.episodes")
    assert len(merged) == len(set(merged)) == len(episodes(one))
    assert (folder / "all.episodes").read_bytes() == (folder / "one-merged.episodes").read_bytes()
    parts.told_the_same(folder, folder / "all.episodes", one, folder / "one-merged.episodes")
    print(f"{len(merged)} episodes of {PARTS} parts, each once; file, pages, JUnit and scores are those of one run")
    lost = episodes(part(3))
    part(3).unlink()
    said = subprocess.run([PROGRAM, "episode", "merge", *folder.glob("parts/part-*.episodes"), "-o", folder / "less.episodes", "--expect", str(PARTS)],
                          capture_output=True, text=True)
    assert said.returncode == 3 and f"part 3 of {PARTS} is missing, with {len(lost)} episodes: " in said.stderr, said.stderr
    assert all(name in said.stderr for name in lost)
    return one


def time_limit(folder):
    """SIGTERM ends a task cleanly; it is queued again, and complete in the end."""
    array = run(SUBMIT, "check.sbatch", 2, *NAMES, folder=folder).strip()
    wait_for(lambda: len(episodes(folder / "parts/part-1.episodes")) > 0, 600, "an episode of part 1")
    run("scancel", "--batch", "--signal=TERM", f"{array}_1")  # what --signal=B:TERM@60 sends
    log = folder / "parts/prehend-check-1.log"
    wait_for(lambda: "stopped by SIGTERM" in log.read_text(), 60, "it ends by SIGTERM")
    ended()
    assert states()[f"{array}_1"] == "COMPLETED", states()
    assert len(episodes(folder / "all.episodes")) == sum(len(episodes(folder / f"parts/part-{i}.episodes")) for i in (1, 2))


def others(folder, one):
    scenario = "trials/gripper_places_a_box"
    for job, words in (("trials", ["trials.sbatch", 3, scenario, 7]), ("import", ["import.sbatch", 2, "takes"]),
                       ("sweep", ["sweep.sbatch", 3, "one.episodes", "reach_radius", 20, 30, "cm", "--over", "lift_rise=3cm..6cm:2", "--grammar", "pick_and_place"])):
        here = folder / job
        here.mkdir()
        if job == "import":
            (here / "takes").mkdir()
            for i in range(4):
                run(PROGRAM, "episode", "export", one, "--episode", i + 1, "--to", "jsonl", "-o", here / f"takes/take{i}.jsonl")
        if job == "sweep":
            shutil.copyfile(one, here / "one.episodes")
        run(SUBMIT, *words, folder=here)
        ended()
        if job != "trials":
            killed(folder / (job + "-killed"), here, words)
        if job == "sweep":
            lines = (here / "sweep.csv").read_text().splitlines()
            assert len(lines) == 7 and {line.split(",")[0] for line in lines[1:]} == {"20cm", "25cm", "30cm"}, lines
            refused(here)
        else:
            assert len(episodes(here / "all.episodes")) == (7 if job == "trials" else 4), job
            assert (here / "all.html").exists()
        if job == "import":
            (here / "parts/part-take2.jsonl.episodes").unlink()
            said = subprocess.run(["bash", SUBMIT.with_name("merge.sbatch"), "import.sbatch", "2", "takes"], cwd=here, capture_output=True, text=True)
            assert said.returncode == 3 and "take2.jsonl is missing; " in said.stderr and len(episodes(here / "all.episodes")) == 3, said


def killed(folder, unbroken, words):
    """The first task of a job, killed when it has begun to write; it goes on to the bytes of the other folder's, which nobody killed."""
    (folder / "parts").mkdir(parents=True)
    job, _, *rest = words
    environment = {**os.environ, "SLURM_ARRAY_TASK_ID": "1", "SLURM_JOB_ID": "0", "SLURM_CPUS_PER_TASK": "1"}
    rest = [unbroken / word if str(word) in ("takes", "one.episodes") else word for word in rest]
    begin = lambda: subprocess.Popen(["bash", SUBMIT.with_name(job), *map(str, words[1:2] + rest)], cwd=folder, env=environment, start_new_session=True,
                                     stdout=subprocess.DEVNULL)
    process = begin()
    wait_for(lambda: any((folder / "parts").iterdir()) or process.poll() is not None, 60, "it writes")
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    there = sorted(file.name for file in (folder / "parts").iterdir())
    assert begin().wait() == 0
    same = [file.name for file in (folder / "parts").iterdir() if file.suffix in (".episodes", ".csv")]
    assert same and all((folder / "parts" / name).read_bytes() == (unbroken / "parts" / name).read_bytes() for name in same), same
    print(f"{job} was killed with {there or 'nothing'}; the bytes are those of an unbroken task")


def refused(folder):
    """A unit with a slash; one of two parts is lost, which is named; all fail, and no table is left of the sweep before."""
    log, table = folder / "parts/prehend-merge.log", folder / "sweep.csv"
    words = (SUBMIT, "sweep.sbatch", 2, "one.episodes", "slide_speed", 1, 2, "cm/s", "--grammar", "pick_and_place", "--over")
    run(*words, "lift_rise=3cm..6cm:2", folder=folder)
    ended()
    assert [line.split(",")[0] for line in table.read_text().splitlines()] == ["slide_speed", "1cm/s", "1cm/s", "2cm/s", "2cm/s"], table.read_text()
    (folder / "parts/sweep-1.csv").unlink()
    said = subprocess.run(["bash", SUBMIT.with_name("merge.sbatch"), "sweep.sbatch", "2"], cwd=folder, capture_output=True, text=True)
    assert said.returncode == 3 and "part 1 of 2 is missing" in said.stderr, said
    assert [line.split(",")[0] for line in table.read_text().splitlines()] == ["slide_speed", "2cm/s", "2cm/s"], table.read_text()
    array = run(*words, "lift_rice=3cm..6cm:2", folder=folder).strip()
    ended()
    assert {state for job, state in states().items() if int(job.split("_")[0]) >= int(array)} == {"FAILED"}, states()
    assert not table.exists() and "part 2 of 2 is missing" in log.read_text() and "sweep.csv is not written" in log.read_text(), log.read_text()
    assert "did you mean 'lift_rise'" in (folder / "parts/prehend-sweep-2.log").read_text()


def desktops(folder):
    """One of three parts fails the first time: its file cannot be written."""
    (folder / "parts/part-2.episodes").mkdir(parents=True)
    parallel = SOURCE / "examples/parallel/check"
    said = subprocess.run([parallel, "3"], cwd=folder, capture_output=True, text=True, env={**os.environ, "PREHEND_HOME": str(project(folder))})
    assert said.returncode != 0, said
    (folder / "parts/part-2.episodes").rmdir()
    before = (folder / "parts/part-1.episodes").stat().st_mtime_ns
    said = subprocess.run([parallel, "--resume-failed", "3"], cwd=folder, capture_output=True, text=True, env={**os.environ, "PREHEND_HOME": str(project(folder))})
    assert said.returncode == 0 and len(episodes(folder / "all.episodes")) == 4, (said.stdout, said.stderr)
    assert (folder / "parts/part-1.episodes").stat().st_mtime_ns == before, "what was done is not done again"


def project(folder):
    """Four scenarios of the suite."""
    root = folder / "project"
    if not root.exists():
        (root / "scenarios").mkdir(parents=True)
        (root / "prehend.yaml").write_text("")
        for name in sorted((SOURCE / "scenarios/reach").glob("*.yaml"))[:4]:
            (root / "scenarios/reach").mkdir(exist_ok=True)
            shutil.copyfile(name, root / "scenarios/reach" / name.name)
            golden = SOURCE / "golden/reach" / (name.stem + ".timeline")
            if golden.exists():
                (root / "golden/reach").mkdir(parents=True, exist_ok=True)
                shutil.copyfile(golden, root / "golden/reach" / golden.name)
    return root


def main(folder):
    os.environ.update(PREHEND_HOME=str(SOURCE), PATH=f"{PROGRAM.parent}:{os.environ['PATH']}", SLURM_CONF=str(folder / "slurm.conf"))
    try:
        subprocess.run([SOURCE / "tests/program/slurm/start", folder, "2"], check=True)
        for name in ("suite", "limit", "desktops"):
            (folder / name).mkdir()
        one = suite(folder / "suite")
        time_limit(folder / "limit")
        others(folder, one)
        desktops(folder / "desktops")
    finally:
        for name in ("slurmd", "slurmctld", "munged"):
            with contextlib.suppress(OSError, ValueError):
                os.kill(int((folder / f"{name}.pid").read_text()), signal.SIGTERM)
        time.sleep(1)


if __name__ == "__main__":
    if os.geteuid() != 0:
        sys.exit("slurmd has to be started as root")
    with tempfile.TemporaryDirectory(prefix="prehend_slurm_", ignore_cleanup_errors=True) as path:
        main(pathlib.Path(path))
