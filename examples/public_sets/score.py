# SPDX-License-Identifier: Apache-2.0
"""Scores a grammar on recordings of people that the user has cloned: python3 score.py bimacs|handovers CLONE OUT (docs/benchmark.md)."""
import csv
import json
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).parent
COMMITS = {"bimacs": "744fcbd8f40378cd046b094e193d045f34a68f32", "handovers": "b3fbd4096cf53bf574b39d3ad8e7ee011a70f77f"}
ACTIONS = "idle approach retreat lift place hold pour cut hammer saw stir screw drink wipe".split()


def table(path, header, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([header, *rows])


def imported(source, out, name):
    with open(out.parent / "import.log", "a", encoding="utf-8") as log:
        subprocess.run(["prehend", "import", source, "--map", HERE / f"{name}.yaml", "-o", out], check=True, stdout=log, stderr=log)
    with open(out, encoding="utf-8") as lines:
        head = json.loads(next(lines))
        return [line["tick"] / head["ticks_per_second"] for line in map(json.loads, lines) if "tick" in line]


def bimacs(clone, out):
    """Twenty takes; their labels count frames."""
    for subject in (0, 1):
        for number, bag in enumerate(sorted((clone / f"downsampled_60/downsampled_subject{subject}").glob("*.bag"))):
            take = f"subject{subject}_take{number}"
            seconds = imported(bag, out / f"{take}.jsonl", "bimacs")
            said = json.loads((clone / f"optitrack_data_ground_truth/subject_{subject}/task_1_k_cooking/take_{number}.json").read_text())
            rows = []
            for tier, marks in said.items():
                for begin, (action, _, thing), end in zip(marks[0::2], marks[1::2], marks[2::2]):
                    thing = {"whisk_4": "whisk_2"}.get(thing, thing)  # a slip in one file
                    rows.append([seconds[begin], seconds[min(end, len(seconds) - 1)], ACTIONS[action], tier, thing or ""])
            table(out / "labels" / f"{take}.csv", ["begin_s", "end_s", "label", "tier", "object"], rows)


def handovers(clone, out):
    """The sample; whoever grips the baton with more than 2 N for 0.1 s holds it."""
    folder = clone / "one_saved_handover_New/handover_sample"
    rows = []
    for body in ("baton", *(f"{who}_{hand}Hand" for who in ("giver", "taker") for hand in "RL")):
        with open(folder / f"{body}_pose_saved.csv", encoding="utf-8") as file:
            rows += [[body, *row] for row in list(csv.reader(file))[1:]]
    table(out / "sample.csv", ["name", "x", "y", "z", "q0", "q1", "q2", "q3"], rows)
    imported(out / "sample.csv", out / "sample.jsonl", "handovers")
    (out / "sample.csv").unlink()
    labels = []
    for who in ("giver", "taker"):
        with open(folder / f"Wrench_{who}_saved.csv", encoding="utf-8") as file:
            grips = [-float(row["Fz"]) > 2 for row in csv.DictReader(file)] + [False]
        begin = None
        for frame, grip in enumerate(grips):
            if grip and begin is None:
                begin = frame
            elif not grip and begin is not None:
                labels += [[begin / 120, frame / 120, f"grasping({who}_hand, baton)"]] if frame - begin >= 12 else []
                begin = None
    table(out / "labels" / "sample.csv", ["begin_s", "end_s", "label"], labels)


def main(name, clone, out):
    clone, out = pathlib.Path(clone), pathlib.Path(out)
    commit = subprocess.run(["git", "-C", clone, "rev-parse", "HEAD"], capture_output=True, text=True, check=True).stdout.strip()
    if commit != COMMITS[name]:
        print(f"note: the clone is at {commit}; the figures of docs/benchmark.md are of {COMMITS[name]}", file=sys.stderr)
    (out / "labels").mkdir(parents=True, exist_ok=True)
    {"bimacs": bimacs, "handovers": handovers}[name](clone, out)
    labels = ["--map", HERE / "bimacs_labels.yaml", "--skip-bad-labels"] if name == "bimacs" else []
    return subprocess.run(["prehend", "score", *sorted(out.glob("*.jsonl")), "--truth", out / "labels", *labels], check=False).returncode


if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] not in COMMITS:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
