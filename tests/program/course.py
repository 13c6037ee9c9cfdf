# SPDX-License-Identifier: Apache-2.0
"""docs/course: each exercise fails with its holes and passes with its solution; the forms are found as drawn, and their
pictures are what `prehend figure` draws. course.py PREHEND [--draw]"""
import pathlib
import re
import subprocess
import sys
import tempfile

PREHEND = sys.argv[1]
COURSE = pathlib.Path(__file__).resolve().parents[2] / "docs/course"


def run(*words):
    return subprocess.run([PREHEND, *words], capture_output=True, text=True)


def tried(folder, grammar, drawing):
    (folder / "my.grammar").write_text(grammar)
    (folder / "my.txt").write_text(drawing)
    return run("grammar", "try", str(folder / "my.grammar"), str(folder / "my.txt"))


def exercises(folder):
    pages = (COURSE / "exercises.md").read_text().split("\n## ")[1:]
    assert len(pages) == 12
    for page in pages:
        title = page.splitlines()[0]
        grammar, drawing, *solution = re.findall(r"^```\n(.*?)^```$", page, re.S | re.M)
        assert "___" in grammar and grammar.count("___") == len(solution), title
        assert tried(folder, grammar, drawing).returncode == 2, f"{title}: passes with a hole"
        left_out = tried(folder, re.sub(r"___", "", grammar), drawing)
        assert left_out.returncode != 0, f"{title}: passes without what is asked for"
        for part in solution:
            grammar = grammar.replace("___", part.strip(), 1)
        done = tried(folder, grammar, drawing)
        assert done.returncode == 0, f"{title}:\n{done.stdout}{done.stderr}"


def pictures(folder, draw):
    grammar, drawings = COURSE / "tea.grammar", COURSE / "tea.txt"
    assert run("grammar", "format", str(grammar)).stdout == grammar.read_text()
    done = run("grammar", "try", str(grammar), str(drawings))
    assert done.returncode == 0, done.stdout + done.stderr
    readme = (COURSE / "README.md").read_text()
    for form in re.findall(r"^== (.*)$", drawings.read_text(), re.M):
        name = re.sub(r"\W+", "_", form).strip("_") + ".svg"
        kept = COURSE / "pictures" / name
        assert f"pictures/{name}" in readme, f"README.md does not show {name}"
        drawn = folder / name
        done = run("figure", "phases", str(drawings), "--episode", form, "--grammar", str(grammar), "-o", str(drawn))
        assert done.returncode == 0, done.stdout + done.stderr
        if draw:
            kept.parent.mkdir(exist_ok=True)
            kept.write_bytes(drawn.read_bytes())
        assert kept.read_bytes() == drawn.read_bytes(), f"{kept} is not what is drawn: course.py PREHEND --draw"


with tempfile.TemporaryDirectory() as scratch:
    exercises(pathlib.Path(scratch))
    pictures(pathlib.Path(scratch), "--draw" in sys.argv)
