# SPDX-License-Identifier: Apache-2.0
"""What is said of a data set: a datasheet, the table of classes, plots; and HDF5 as simulators lay it out."""
import collections
import hashlib
import io
import json
import os
import pathlib
import statistics
import tarfile

from . import recipe as recipes

LICENCE = """This data set is licensed under Creative Commons Attribution 4.0 International (CC BY 4.0):
https://creativecommons.org/licenses/by/4.0/legalcode
Sizes and masses of things: YCB object set, Calli et al. 2015, doi:10.1109/MRA.2015.2448951.
"""
CITATION = """cff-version: 1.2.0
message: If you use this data set, please cite it and the program that made it.
type: dataset
title: "{set}: {episodes} simulated episodes of manipulation, with labels of three witnesses"
authors:
  - name: The prehend developers
license: CC-BY-4.0
version: {version}
date-released: {date}
references:
  - {{type: software, title: prehend, version: "{program}", authors: [{{name: The prehend developers}}]}}
  - {{type: article, title: Benchmarking in Manipulation Research, year: 2015, doi: 10.1109/MRA.2015.2448951,
     authors: [{{family-names: Calli, given-names: Berk}}]}}
"""
SHEET = """# Datasheet of '{name}'

{episodes} simulated episodes of manipulation, {minutes:.1f} minutes, made by `python3 -m prehend dataset make` ({program}) from the recipe
{recipe_sha256} (in `manifest.json`). Licence: CC BY 4.0. After Gebru et al. 2021, "Datasheets for Datasets".

| question | answer |
|---|---|
| Why? | to compare recognisers of activities; docs/benchmark.md has the rules |
| What is in it? | poses, touches and grips of hands and things, at 20 to 240 frames per second; labels of who did what to which thing, when |
| Are people in it? | no: hands and bodies are simulated. Its figures say nothing of recordings of people until somebody measures that |
| Who labelled? | the physical oracle (`labels_*.csv`, with the band of each boundary); the recipe's claims and the grammar `pick_and_place` are witnesses: where they say something else stands in `disagreements_*.csv` |
| Which splits? | train, dev, test. Nothing that `held_out` of the recipe names is in train or dev; `asks` of `episodes.csv` says which question a test episode asks |
| Is the test split secret? | no, only apart: who has the recipe can play it again. An organiser who wants a secret one keeps the seed, and publishes the manifest's hash |
| What is wrong with it? | simple shapes, evenly filled; touches without errors of their own but those of `noise`; scripts, not people, decide what happens |
| What could not be played? | {redrawn_sum} drafts, which were drawn again: {redrawn} |

## Splits

{splits}

## Witnesses

| witness | agrees | of |
|---|---|---|
| claims of the recipe | {claims} | {claims_of} |
| grammar, events within their bands | {agrees} | {agrees_of} |

{extra} events of the grammar are not true by the oracle.

## Classes

{classes}
"""


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def chi_square(recipe, rows):
    """By word: chi square of the counts against the recipe, degrees of freedom, and the chance of a larger one."""
    from scipy.stats import chi2
    found = {}
    for word, shares in recipes.expected(recipe).items():
        counts = collections.Counter(row["words"][word] for row in rows)
        shares = {value: share for value, share in shares.items() if share > 0}
        square = sum((counts[value] - share * len(rows)) ** 2 / (share * len(rows)) for value, share in shares.items())
        freedom = max(1, len(shares) - 1)
        found[word] = (square, freedom, float(chi2.sf(square, freedom)))
        if set(counts) - set(shares):
            found[word] = (float("inf"), freedom, 0.0)
    return found


def write(folder, manifest, rows):
    """DATASHEET.md, LICENSE, classes.csv and plots."""
    from .dataset import ROLES, write_table
    (folder / "LICENSE").write_text(LICENCE, encoding="utf-8")
    labels = [(row, one) for row in rows for one in row["labels"]]
    kinds = sorted({one["event"] for _, one in labels})
    classes = []
    for kind in kinds:
        of_kind = [(row, one) for row, one in labels if one["event"] == kind]
        classes.append([kind, *(sum(row["role"] == role for row, _ in of_kind) for role in ROLES), len(of_kind),
                        round(statistics.median(one["end_s"] - one["begin_s"] for _, one in of_kind), 3), f"{sum(one['grammar'] == 'agrees' for _, one in of_kind) / len(of_kind):.3f}"])
    header = ["event", *ROLES, "all", "median_s", "grammar_agrees"]
    write_table(folder / "classes.csv", header, classes)
    splits = [[role, "", sum(row["role"] == role for row in rows)] for role in ROLES]
    splits += [["test", f"{axis}: {text}", sum(axis in row["asks"] for row in rows)] for axis, text in recipes.QUESTIONS.items()]
    tests = [[word, f"{square:.1f}", freedom, f"{chance:.3f}"] for word, (square, freedom, chance) in chi_square(manifest["recipe"], rows).items()]
    claims = [one["verdict"] for row in rows for one in row["claims"]]
    text = SHEET.format(
        name=manifest["set"], episodes=len(rows), minutes=sum(row["seconds"] for row in rows) / 60, program=manifest["program"],
        recipe_sha256=manifest["recipe_sha256"], redrawn_sum=sum(manifest["redrawn"].values()),
        redrawn="; ".join(f"{why} ({count})" for why, count in manifest["redrawn"].items()) or "none",
        splits=table(["split", "asks", "episodes"], splits), classes=table(header, classes), claims=claims.count("holds"), claims_of=len(claims),
        agrees=sum(one["grammar"] == "agrees" for _, one in labels), agrees_of=len(labels), extra=sum(len(row["extra"]) for row in rows))
    text += "\n## Drawn as the recipe says\n\n" + table(["word", "chi square", "degrees of freedom", "chance of a larger one"], tests) + "\n"
    (folder / "DATASHEET.md").write_text(text, encoding="utf-8")
    _plots(folder, rows, labels, kinds)


def _plots(folder, rows, labels, kinds):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(1, 3, figsize=(13, 4), constrained_layout=True)
    axes[0].barh(kinds, [sum(one["event"] == kind for _, one in labels) for kind in kinds])
    axes[0].set_xlabel("labels")
    axes[1].boxplot([[one["end_s"] - one["begin_s"] for _, one in labels if one["event"] == kind] for kind in kinds], vert=False, labels=kinds, showfliers=False)
    axes[1].set_xlabel("length, s")
    outcomes = collections.Counter(row["words"]["outcome"] for row in rows)
    axes[2].barh(sorted(outcomes), [outcomes[one] for one in sorted(outcomes)])
    axes[2].set_xlabel("episodes")
    figure.savefig(folder / "classes.png", metadata={"Software": None})
    pyplot.close(figure)


def archive(folder, results, date, path):
    """What of a set is the same on every machine, and results on it, as one file with all hashes: the same bytes in every run."""
    manifest = json.loads((pathlib.Path(folder) / "manifest.json").read_text(encoding="utf-8"))
    files = {}
    for place, below in ((folder, ""), *((one, f"results/{pathlib.Path(one).name}/") for one in results)):
        for file in pathlib.Path(place).rglob("*"):
            if file.is_file() and file.suffix != ".episodes" and file.name not in ("files.json", "cpu.json") and not file.name.startswith("scored_"):
                files[below + file.relative_to(place).as_posix()] = file.read_bytes()
    version = hashlib.sha256(files["manifest.json"]).hexdigest()[:16]
    files["CITATION.cff"] = CITATION.format(**manifest, version=version, date=date).encode()
    files["SHA256SUMS"] = "".join(f"{hashlib.sha256(data).hexdigest()}  {name}\n" for name, data in sorted(files.items())).encode()
    with tarfile.open(path, "w", format=tarfile.USTAR_FORMAT) as tar:
        for name, data in sorted(files.items()):
            info = tarfile.TarInfo(f"{manifest['set']}/{name}")
            info.size = len(data)
            tar.addfile(info, io.BytesIO(data))
    print(f"{path}: {len(files)} files, {hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()}")


def write_hdf5(folder, path):
    """data/demo_N with actions and obs, as robomimic, robosuite and Isaac Lab lay out demonstrations; labels under `labels`."""
    import h5py
    import numpy as np

    from .baselines import episodes_of
    with h5py.File(path, "w") as out:
        data = out.create_group("data")
        total = 0
        for number, (name, episode) in enumerate(episodes_of(folder)):
            poses = episode.poses()
            names = list(episode.entities.index)
            frames = len(poses) // len(names)
            demo = data.create_group(f"demo_{number}")
            demo.attrs.update(num_samples=frames, name=name)
            obs = demo.create_group("obs")
            hands = [name for name in names if name in ("right_hand", "left_hand", "gripper")]
            for name in names:
                one = poses[poses.entity == name]
                obs[f"{name}_pos"] = one[["x", "y", "z"]].to_numpy()
                obs[f"{name}_quat"] = one[["qx", "qy", "qz", "qw"]].to_numpy()
            obs["t_s"] = poses.t.to_numpy()[:: len(names)]
            parts = [np.column_stack([obs[f"{hand}_pos"], obs[f"{hand}_quat"], poses[poses.entity == hand].grip]) for hand in hands]
            demo["actions"] = np.concatenate(parts, axis=1)  # of each hand position, quaternion (w last) and grip
            demo["actions"].attrs["hands"] = json.dumps(hands)
            total += frames
        data.attrs.update(total=total, env_args=json.dumps({"env_name": "prehend", "type": 0, "env_kwargs": {}}))
    print(f"{path}: {total} frames")
    return 0 if os.path.exists(path) else 1
