# SPDX-License-Identifier: Apache-2.0
"""examples/recognisers/windows.py, trained on some scenarios and scored on others beside the grammar: above chance, below it.
And the commands of docs/recognisers.md, typed.

    python3 tests/program/learned_recogniser.py build/test/prehend
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PREHEND = os.path.abspath(sys.argv[1])
TRAIN = ["grasp/short_grasp_counts", "grasp/grasp_ends_with_the_release", "grasp/touch_without_closing_is_no_grasp",
         "grasp/regrasp_after_a_lost_touch_is_a_second_reach", "grasp/closing_beside_the_carton_is_no_grasp",
         "pick_and_place/milk_carton_wrap"]
TEST = ["grasp/letting_go_for_a_twentieth_of_a_second_ends_the_grasp", "grasp/let_go_for_a_moment_in_the_air_is_two_grasps",
        "grasp/open_hand_that_pushes_does_not_grasp", "grasp/regrasp_within_a_fifth_of_a_second_is_a_second_grasp",
        "slide/hop_divides_a_slide", "reach/a_grasp_drops_the_reach_for_its_neighbour"]


def prehend(*words):
    done = subprocess.run([PREHEND, *words], cwd=ROOT, text=True, capture_output=True)
    assert done.returncode == 0, (words, done.returncode, done.stderr)
    return done.stdout


with tempfile.TemporaryDirectory() as folder:
    for name in TRAIN:
        take = os.path.join(folder, name.replace("/", "_") + ".jsonl")
        prehend("run", name, "--record", take)
        prehend("episode", "resegment", take, "--event", "grasping", "-o", take.replace(".jsonl", ".csv"))
    python = "/usr/bin/python3" if os.path.exists("/usr/bin/python3") else "python3"
    windows = f"{python} -B {ROOT}/examples/recognisers/windows.py {folder}"
    scores = {score["grammar"]: score for score in json.loads(prehend(
        "score", *TEST, "--event", "grasping", "--json", "--grammar", "pick_and_place", "--recogniser", windows))["grammars"]}
learned, grammar = scores[windows], scores["pick_and_place"]
for name, score in ("learned", learned), ("grammar", grammar):
    total = score["total"]
    print("%s: %d true, %d found, F1@50 %.3f, kappa %.3f" %
          (name, total["true"], total["found"], total["f1_50"], total["kappa"]))
assert learned["episodes"] == len(TEST) and not learned["failed"]
assert learned["total"]["kappa"] > 0.2, "no better than chance"
assert learned["total"]["f1_50"] > 0.2
assert learned["total"]["f1_50"] < grammar["total"]["f1_50"], "better than the grammar: is it told the truth?"


def typed_pages(folder):
    """What the commands of the page need lies in `folder`; of skills some scenarios are enough."""
    motion = ROOT / "docs/motion_capture"
    for take in "take1", "take2":
        prehend("import", str(motion / "poses.csv"), "--map", str(motion / "bodies.yaml"), "-o", f"{folder}/{take}.jsonl")
        for part in "labels", "predictions":
            os.makedirs(f"{folder}/{part}", exist_ok=True)
        shutil.copy(motion / "labels.csv", f"{folder}/labels/{take}.csv")
        prehend("episode", "resegment", f"{folder}/{take}.jsonl", "-o", f"{folder}/predictions/{take}.csv")
    shutil.copy(motion / "labels.csv", f"{folder}/predictions/take2.csv")  # with a tier that the map ignores
    shutil.copy(motion / "labels.yaml", folder)
    shutil.copy(ROOT / "examples/recognisers/distance.py", f"{folder}/reco.py")
    prehend("check", TRAIN[0], "--record", f"{folder}/demos.episodes", "--no-pictures", "--report", f"{folder}/page")
    commands = [line for line in (ROOT / "docs/recognisers.md").read_text().splitlines() if line.startswith("prehend ")]
    assert len(commands) == 8, commands
    for command in commands:
        if "train" in command:
            continue  # above
        typed = command.replace("'grasp/*'", TRAIN[0])
        done = subprocess.run(typed, shell=True, cwd=folder, text=True, capture_output=True, env=dict(
            os.environ, PATH=os.path.dirname(PREHEND) + ":" + os.environ["PATH"], PREHEND_HOME=str(ROOT)))
        # Of these two, the example finds other boundaries than the golden has.
        assert done.returncode == (1 if " check " in command else 0), (command, done.returncode, done.stdout, done.stderr)
        print("typed:", typed)


with tempfile.TemporaryDirectory() as folder:
    typed_pages(folder)
