# SPDX-License-Identifier: Apache-2.0
"""Recipes of data sets: words with distributions, drawn alike on every machine (docs/benchmark.md)."""
import csv
import hashlib
import json
import math
import pathlib

from .errors import EpisodeError, fail

HERE = pathlib.Path(__file__).parent
WEIGHED = ["layout", "outcome", "skill", "hand", "person", "body", "noise", "sensing_hz", "distractors", "retry", "style", "thing"]
# Numbers, and the least of each that can be played.
NUMBERS = {"pace": 0.1, "step": 0.1, "rest_s": 0, "mass": 0.5, "friction": 0, "yaw_deg": -360, "aim_m": -1}
OF_PERSON = {"pace": 0.1, "pause_s": 0, "lift_m": 0, "start_m": -1, "height_m": 0.5}
AXES = ["thing", "layout", "person", "style", "noise"]
QUESTIONS = {"same": "as in training", "thing": "things never seen", "layout": "a room never seen", "person": "people never seen",
             "style": "grasps never seen", "noise": "sensors worse than those seen"}
NOISE = {
    "clean": {}, "jitter": {"sensors": {"position_noise_m": 0.001, "rotation_noise_deg": 0.5}},
    "tracked": {"tracking": {"tracker_hz": 90, "latency_s": 0.03, "jitter_mm": 0.3, "dropped_share": 0.02, "tremor_mm": 0.3}},
    "coarse": {"sensors": {"position_noise_m": 0.003, "rotation_noise_deg": 1, "contact_dropout_share": 0.02}},
    "lossy": {"sensors": {"position_noise_m": 0.001, "contact_dropout_share": 0.05, "lost_frames_share": 0.1}}}
ON_HANDLES = {"medium_wrap", "hook", "prismatic_two_finger", "prismatic_four_finger"}
OF_GRIPPERS = {"parallel", "parallel_narrow"}
BY_GRIPPERS = {"pick_and_place", "put_on", "lift_and_back", "two_in_turn", "again"}


class Draw:
    """Numbers that follow from a key: SHA-256 of it and a count, nothing of the machine."""

    def __init__(self, *key):
        self.key, self.count = "/".join(map(str, key)), 0

    def unit(self):
        """From 0 to below 1, in 53 bits."""
        self.count += 1
        return int.from_bytes(hashlib.sha256(f"{self.key}#{self.count}".encode()).digest()[:7], "big") // 8 / 2.0**53

    def of(self, distribution):
        """A number of {uniform: [a, b]} or {normal: [mean, deviation]} (a sum of twelve: no library's logarithm)."""
        if "uniform" in distribution:
            least, most = distribution["uniform"]
            return least + (most - least) * self.unit()
        mean, deviation = distribution["normal"]
        return mean + deviation * (sum(self.unit() for _ in range(12)) - 6)

    def between(self, least, most):
        return self.of({"uniform": [least, most]})

    def word(self, weights):
        """One of these, by weight; in the order of their names, so that the order in a file means nothing."""
        names = sorted(weights, key=str)
        at = self.unit() * sum(weights[name] for name in names)
        for name in names:
            at -= weights[name]
            if at < 0:
                return name
        return names[-1]


def things():
    """By name: class, shape, size in metres, mass in kg, kinds, and the number in the YCB set."""
    with open(HERE / "things.csv", encoding="utf-8") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return {row["name"]: {"class": row["class"], "shape": row["shape"], "kinds": row["kinds"], "ycb": row["ycb"],
                              "size": [float(row[f"{axis}_mm"]) / 1000 for axis in "xyz"],
                              "mass": float(row["mass_g"]) / 1000} for row in rows}


def fits(style, thing):
    """Whether docs/physics.md says that the style holds such a thing where it stands."""
    x, y, height = thing["size"]
    width, ball = min(x, y), thing["shape"] == "sphere"
    if thing["shape"] in ("bowl", "mug"):
        return style == "wrap" and thing["shape"] == "mug"
    stands = height >= 0.05
    return {"wrap": 0.06 <= width <= 0.076 if ball else 0.04 <= width <= 0.08 and height >= 0.045,
            "pinch": not ball and 0.035 <= width <= 0.058 and stands,
            "tripod": 0.062 <= width <= 0.076 if ball else 0.05 <= width <= 0.07 and stands,
            "precision_sphere": ball and 0.062 <= width <= 0.08,
            "lateral": width <= 0.02 and height >= 0.1,
            "parallel": 0.025 <= width <= 0.076 and stands,
            "parallel_narrow": 0.005 <= width <= 0.03 and stands}.get(style, False)


def _check_number(word, one, least, at):
    """A distribution of which the least, or the mean, can be played."""
    kind = next(iter(one), "") if isinstance(one, dict) and len(one) == 1 else ""
    two = one[kind] if kind in ("uniform", "normal") else None
    if not isinstance(two, list) or len(two) != 2 or any(isinstance(n, bool) or not isinstance(n, (int, float)) or not math.isfinite(n) for n in two):
        fail(EpisodeError, f"{at}'{word}' of the recipe: found {one!r}, wanted {{uniform: [a, b]}} or {{normal: [mean, deviation]}}")
    if kind == "uniform" and two[0] > two[1]:
        fail(EpisodeError, f"{at}'{word}' of the recipe: found uniform {two}, wanted the least first", f"uniform: {two[::-1]}")
    if kind == "normal" and two[1] < 0:
        fail(EpisodeError, f"{at}'{word}' of the recipe: found the deviation {two[1]}, wanted 0 or more", f"normal: [{two[0]}, {-two[1]}]")
    if two[0] < least:
        fail(EpisodeError, f"{at}'{word}' of the recipe: found {one!r}, wanted {'times' if word == 'mass' else 'numbers'} from {least}",
             f"{kind}: [{least}, {max(two[1], least) if kind == 'uniform' else two[1]}]")


def merged(own, at=lambda word: ""):
    """The words of a recipe over those of the package's; `at`: where one stands."""
    import yaml
    with open(HERE / "tabletop.yaml", encoding="utf-8") as file:
        recipe = yaml.safe_load(file)
    unknown = sorted(set(own) - set(recipe))
    if unknown:
        fail(EpisodeError, f"{at(unknown[0])}the recipe has the unknown word '{unknown[0]}'", "known: " + ", ".join(recipe))
    for word, value in own.items():
        recipe[word] = {**recipe[word], **value} if word in ("held_out", "of_person") else value
    for word in WEIGHED:
        weights = recipe[word]
        if not isinstance(weights, dict) or any(isinstance(w, bool) or not isinstance(w, (int, float)) or w < 0 for w in weights.values()):
            fail(EpisodeError, f"{at(word)}'{word}' of the recipe: found {weights!r}, wanted weights, {{NAME: 3, ..}}", "docs/benchmark.md")
        recipe[word] = {str(value): weight for value, weight in weights.items()}  # as JSON has them
    for word, least in NUMBERS.items():
        _check_number(word, recipe[word], least, at(word))
    for word, least in OF_PERSON.items():
        _check_number(word, recipe["of_person"][word], least, at("of_person"))
    if unknown := sorted(set(recipe["of_person"]) - set(OF_PERSON)):
        fail(EpisodeError, f"{at('of_person')}'of_person' of the recipe has the unknown word '{unknown[0]}'", "known: " + ", ".join(OF_PERSON))
    for word in ("dev", "test"):
        if isinstance(recipe[word], bool) or not isinstance(recipe[word], (int, float)) or not 0 <= recipe[word] <= 1:
            fail(EpisodeError, f"{at(word)}'{word}' of the recipe: found {recipe[word]!r}, wanted a share of the episodes, 0 to 1", f"{word}: 0.2")
    if recipe["dev"] + recipe["test"] > 1:
        fail(EpisodeError, f"{at('test') or at('dev')}'dev' and 'test' of the recipe: found {recipe['dev']} and {recipe['test']}, wanted shares of at most 1 together",
             "dev: 0.2 and test: 0.1")
    return recipe


def read(path):
    """A recipe, with what its words leave out, and the hash from which everything is drawn."""
    import yaml
    try:
        with open(path, encoding="utf-8") as file:
            text = file.read()
        own = yaml.safe_load(text)
    except (OSError, yaml.YAMLError) as error:
        fail(EpisodeError, f"{path}: error: {error}")
    if not isinstance(own, dict) or own.get("recipe") != 1:
        fail(EpisodeError, f"{path}:1:1: error: found no 'recipe: 1', wanted a recipe", "docs/benchmark.md")
    places = {key.value: f"{path}:{key.start_mark.line + 1}:{key.start_mark.column + 1}: error: " for key, _ in yaml.compose(text).value}
    recipe = merged(own, lambda word: places.get(word, ""))
    return recipe, hashlib.sha256(json.dumps(recipe, sort_keys=True).encode()).hexdigest()


def skills_of(recipe, layout):
    """Weights of the skills in a layout: those of grippers at the robot's table."""
    return {skill: w for skill, w in recipe["skill"].items() if layout != "robot_table" or skill in BY_GRIPPERS}


def words(recipe, recipe_hash, index):
    """What an episode is about. Nothing of it is drawn again if the episode cannot be played."""
    def draw(word, weights):
        return Draw(recipe_hash, index, word).word(weights)
    drawn = {word: draw(word, recipe[word]) for word in WEIGHED if word not in ("skill", "style", "thing")}
    drawn["skill"] = draw("skill", skills_of(recipe, drawn["layout"])) if drawn["outcome"] == "success" else "pick_and_place"
    if drawn["layout"] == "robot_table":
        drawn["person"], drawn["body"] = "robot", "none"
        drawn["hand"] = "gripper"
    return drawn


def expected(recipe):
    """By word the share of each value that `words` draws: what counts are compared with."""
    def shares(weights):
        return {value: w / sum(weights.values()) for value, w in weights.items()}
    of = {word: shares(recipe[word]) for word in ("layout", "outcome", "noise", "sensing_hz", "distractors")}
    robot, success = of["layout"].get("robot_table", 0), of["outcome"].get("success", 0)
    of["skill"] = {skill: 0.0 for skill in recipe["skill"]} | {"pick_and_place": 1 - success}
    for layout, share in (("robot_table", robot), ("", 1 - robot)):
        for skill, one in shares(skills_of(recipe, layout)).items():
            of["skill"][skill] += success * share * one
    for word, one in (("person", "robot"), ("body", "none"), ("hand", "gripper")):
        of[word] = {value: share * (1 - robot) for value, share in shares(recipe[word]).items()}
        of[word][one] = of[word].get(one, 0) + robot
    return of


def person(recipe, recipe_hash, name):
    """Pace, pauses and heights of a person: the same in all of her episodes."""
    return {word: Draw(recipe_hash, "person", name, word).of(one) for word, one in recipe["of_person"].items()}


def role(recipe, recipe_hash, index, drawn):
    """train, dev or test, and which questions an episode of the test split asks."""
    asks = [axis for axis in AXES
            if set(drawn[axis] if isinstance(drawn[axis], list) else [drawn[axis]]) & set(recipe["held_out"].get(axis) or [])]
    if asks:
        return "test", asks
    at = Draw(recipe_hash, index, "role").unit()
    return ("test", ["same"]) if at < recipe["test"] else ("dev" if at < recipe["test"] + recipe["dev"] else "train", [])
