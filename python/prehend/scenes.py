# SPDX-License-Identifier: Apache-2.0
"""One episode of a recipe as a scenario of docs/scenario-format.md: what stands where, who does what, what is claimed."""
from . import recipe as recipes
from .recipe import BY_GRIPPERS, NOISE, OF_GRIPPERS, ON_HANDLES, Draw

# Where the table's top is, its size along x and y, and where a stand for other things is.
LAYOUTS = {"kitchen": (0.76, 0.8, 1.2, "wooden", "Counter"), "workshop": (0.92, 0.9, 1.6, "grey", "Workbench"),
           "laboratory": (0.80, 0.7, 1.4, "white", "Bench"), "robot_table": (0.72, 0.9, 0.9, "black", "Table")}
GAP_M = 0.075  # between a thing that is taken and its neighbours: fingers go there
DRAWER = """  cabinet: {{class: Cabinet, fixed: true, shelf: {{size_m: [0.45, 0.40, 0.60]}}, at_m: [{x525}, {y0}, {z700}]}}
  drawer:
    class: Drawer
    part_of: cabinet
    parts:
      - {{box: {{size_m: [0.02, 0.36, 0.16]}}}}
      - {{box: {{size_m: [0.36, 0.34, 0.01]}}, at_m: [0.19, 0, -0.07]}}
      - {{box: {{size_m: [0.36, 0.01, 0.10]}}, at_m: [0.19, 0.165, -0.02]}}
      - {{box: {{size_m: [0.36, 0.01, 0.10]}}, at_m: [0.19, -0.165, -0.02]}}
      - {{box: {{size_m: [0.01, 0.34, 0.10]}}, at_m: [0.365, 0, -0.02]}}
      - {{box: {{size_m: [0.076, 0.01, 0.01]}}, at_m: [-0.048, 0.075, 0]}}
      - {{box: {{size_m: [0.076, 0.01, 0.01]}}, at_m: [-0.048, -0.075, 0]}}
    mass_kg: {mass}
    at_m: [{x320}, {y0}, {z850}]
    slider: {{to: cabinet, axis: [-1, 0, 0], range_m: [0, 0.30], friction_n: 2}}
  handle: {{class: Handle, part_of: drawer, fixed_to: drawer, box: {{size_m: [0.014, 0.16, 0.014]}}, mass_kg: 0.1, at_m: [{x240}, {y0}, {z850}]}}
"""
DOOR = """  cupboard: {{class: Cupboard, fixed: true, shelf: {{size_m: [0.40, 0.44, 0.64]}}, at_m: [{x520}, {y0}, {z900}]}}
  door:
    class: Door
    part_of: cupboard
    parts:
      - {{box: {{size_m: [0.02, 0.40, 0.60]}}}}
      - {{box: {{size_m: [0.076, 0.01, 0.01]}}, at_m: [-0.048, 0.14, 0.075]}}
      - {{box: {{size_m: [0.076, 0.01, 0.01]}}, at_m: [-0.048, 0.14, -0.075]}}
    mass_kg: {mass}
    at_m: [{x310}, {y0}, {z900}]
    hinge: {{to: cupboard, at_m: [{x310}, {hinge_y}, {z900}], axis: [0, 0, 1], range_deg: [0, 100], friction_nm: 0.4}}
  handle: {{class: Handle, part_of: door, fixed_to: door, box: {{size_m: [0.014, 0.014, 0.16]}}, mass_kg: 0.1, at_m: [{x230}, {bar_y}, {z900}]}}
"""


class Unplayable(Exception):
    """What was drawn does not go together: it is drawn again."""


def number(value):
    return f"{round(value, 4):g}" if abs(value) >= 0.0001 else "0"


def point(*values):
    return "[" + ", ".join(map(number, values)) + "]"


class Scene:  # pylint: disable=too-many-instance-attributes
    """One episode while it is written."""

    def __init__(self, recipe, recipe_hash, index, attempt):
        self.recipe, self.name = recipe, f"e{index:05d}"
        self.words = recipes.words(recipe, recipe_hash, index)
        self.draw = Draw(recipe_hash, index, "details", attempt)
        self.person = recipes.person(recipe, recipe_hash, self.words["person"])
        self.top, self.size_x, self.size_y, self.color, self.table = LAYOUTS[self.words["layout"]]
        self.of_gripper = self.words["layout"] == "robot_table"
        self.hand = {"right": "right_hand", "left": "left_hand", "gripper": "gripper"}[self.words["hand"]]
        self.side = 1 if self.words["hand"] == "left" else -1
        self.pace = self.person["pace"] * self.draw.of(recipe["pace"])
        self.things, self.used, self.taken = recipes.things(), {}, []
        self.entities, self.actors, self.script, self.claims, self.styles = [], [], [], [], []

    # What there is.
    def place(self, radius, y_least=-0.34, y_most=0.34):
        """A free place for something so wide."""
        for _ in range(200):
            x, y = self.draw.between(0.0, 0.28), self.draw.between(y_least, y_most)
            if all((x - a) ** 2 + (y - b) ** 2 > (radius + r) ** 2 for a, b, r in self.taken):
                self.taken.append((x, y, radius))
                return x, y
        raise Unplayable("no free place")

    def stand(self, name, x, y, support="table", friction=None, mass=1.0, yaw=0.0):
        """The thing of this name stands there."""
        thing = self.things[name]
        a, b, c = thing["size"]
        shape = {"box": f"box: {{size_m: {point(a, b, c)}}}", "sphere": f"sphere: {{radius_m: {number(a / 2)}}}",
                 "cylinder": f"cylinder: {{radius_m: {number(a / 2)}, length_m: {number(c)}}}",
                 "mug": f"mug: {{radius_m: {number(a / 2)}, height_m: {number(c)}, handle_m: 0}}",
                 "bowl": f"bowl: {{radius_m: {number(a / 2)}, height_m: {number(c)}}}"}[thing["shape"]]
        friction = self.draw.of(self.recipe["friction"]) if friction is None else friction
        mass *= thing["mass"] * max(0.5, self.draw.of(self.recipe["mass"]))
        self.entities.append(f"  {name}: {{class: {thing['class']}, {shape}, mass_kg: {number(mass)}, friction: {number(friction)}, "
                             f"on: {support}, at_m: {point(x, y)}, yaw_deg: {number(yaw)}}}\n")
        self.used[name] = (x, y)

    def choose(self, of_thing=lambda thing: True, styles=None):
        """A thing of the layout and a style that holds it, and where the thing stands."""
        weights = {style: w for style, w in self.recipe["style"].items()
                   if (style in OF_GRIPPERS) == self.of_gripper and (styles is None or style in styles)}
        kind = self.words["layout"][0]
        fitting = {style: {name: self.recipe["thing"].get(name, 1) for name, thing in self.things.items()
                           if kind in thing["kinds"] and name not in self.used and recipes.fits(style, thing) and of_thing(thing)}
                   for style in weights}
        style = self.draw.word({style: w for style, w in weights.items() if fitting[style]})
        self.styles.append(style)
        return self.draw.word(fitting[style]), style

    def radius(self, name):
        a, b, _ = self.things[name]["size"]
        return (a * a + b * b) ** 0.5 / 2

    def ready(self, **how):
        """A thing that is going to be taken, where it stands, and its style."""
        zone = how.pop("zone", (-0.34, 0.34))
        friction, mass = how.pop("friction", None), how.pop("mass", 1.0)
        name, style = self.choose(**how)
        x, y = self.place(self.radius(name) + GAP_M, *zone)
        self.stand(name, x, y, friction=friction, mass=mass, yaw=self.draw.of(self.recipe["yaw_deg"]))
        return name, style

    # What happens.
    def do(self, hand, action, base_s=None, **more):
        keys = {**more, **({"over_s": number(max(0.01, base_s * self.pace * self.draw.of(self.recipe["step"])))} if base_s else {})}
        self.script.append(f"  - {hand}: {{{action}{''.join(f', {k}: {v}' for k, v in keys.items())}}}\n")

    def pause(self, hand):
        """As long as the person's, or twice as long, or hardly: so that timing tells nothing."""
        if self.person["pause_s"] > 0.08:
            self.do(hand, f"wait_s: {number(0.02 + self.person['pause_s'] * self.draw.between(0, 2))}")

    def wait(self, hands):
        """Before the first step: so that the time since the beginning tells nothing."""
        waits = number(max(0.01, self.draw.of(self.recipe["rest_s"])))
        self.script += [f"{'    ' if i else '  - '}{hand}: {{wait_s: {waits}}}\n" for i, hand in enumerate(hands)]

    def wander(self, hands, x_most):
        """At last to any place above the table: so that the thing that is beside the hand then tells nothing."""
        over_s, height = number(self.draw.between(0.8, 2)), self.top + self.draw.between(0.25, 0.35)
        for i, hand in enumerate(hands):
            way = self.draw.between(0.05, 0.4) * (1 if hand == "left_hand" else -1) if len(hands) > 1 else self.draw.between(-0.4, 0.4)
            at = point(self.draw.between(-0.2, x_most), way, height)
            self.script.append(f"{'    ' if i else '  - '}{hand}: {{poses: [{{t_s: {over_s}, at_m: {at}}}]}}\n")

    def take(self, name, style, hand=None, grip=1.0, offset=(0.0, 0.0, 0.0), **more):
        """Reach and close."""
        hand = hand or self.hand
        aim = [self.draw.of(self.recipe["aim_m"]), self.draw.of(self.recipe["aim_m"]), 0]
        if "from" not in more and style in ("precision_sphere", "lateral", "parallel", "parallel_narrow"):
            more["from"] = "above"
        self.do(hand, f"reach: {name}", 0.85, style=style, offset_m=point(*(a + b for a, b in zip(aim, offset))), **more)
        self.do(hand, f"close_to: {number(grip)}", 0.6)
        self.pause(hand)

    def carry(self, hand, name, to, support, height=None):
        self.do(hand, f"lift_by_m: {number(height or self.person['lift_m'])}", 0.6)
        x, y = self.used[name]
        self.do(hand, f"carry_to_m: {point(*to)}", 0.5 + 1.2 * ((to[0] - x) ** 2 + (to[1] - y) ** 2) ** 0.5)
        self.pause(hand)
        self.do(hand, f"place_on: {support}", 0.7)
        self.used[name] = to

    def let_go(self, hand, over_s=0.45):
        self.do(hand, "open_to: 0", over_s)
        self.do(hand, "retreat_by_m: 0.18", 0.6)

    def claim(self, *claims):
        self.claims += claims

    def pick_and_place(self, name, style, hand=None, support="table", zone=(-0.34, 0.34)):
        hand = hand or self.hand
        to = self.stand_at if support != "table" else self.place(self.radius(name) + 0.05, *zone)
        self.take(name, style, hand)
        self.carry(hand, name, to, support)
        self.let_go(hand)


def _put_on(scene):
    name, style = scene.ready(of_thing=lambda thing: max(thing["size"][:2]) < 0.12)
    scene.stand_at = scene.place(0.16)
    scene.entities.append(f"  stand: {{class: Stand, fixed: true, box: {{size_m: [0.18, 0.18, 0.06]}}, on: table, at_m: {point(*scene.stand_at)}}}\n")
    scene.pick_and_place(name, style, support="stand")
    scene.claim(f"one pick_and_place({scene.hand}, {name})", f"one supported_by({name}, stand)")


def _pick_and_place(scene):
    name, style = scene.ready()
    scene.pick_and_place(name, style)
    scene.claim(f"one pick_and_place({scene.hand}, {name})", f"one grasping({scene.hand}, {name})")


def _lift_and_back(scene):
    name, style = scene.ready()
    scene.take(name, style)
    scene.do(scene.hand, f"lift_by_m: {number(scene.person['lift_m'])}", 0.6)
    scene.pause(scene.hand)
    scene.do(scene.hand, "place_on: table", 0.8)
    scene.let_go(scene.hand)
    scene.claim(f"one picking_up({scene.hand}, {name})", f"one putting_down({scene.hand}, {name})")


def _slide(scene, then_lift=False):
    name, style = scene.ready(friction=0.35, of_thing=lambda thing: thing["mass"] > 0.09 and thing["shape"] != "sphere")
    (x, y), way = scene.used[name], scene.draw.between(0.08, 0.2)
    way = -way if y > 0 else way
    scene.take(name, style, grip=0.9)
    scene.do(scene.hand, "press_n: 3", against="table", over_s=0.3)
    scene.do(scene.hand, f"move_by_m: {point(scene.draw.between(-0.04, 0.04), way, 0)}", 1.0)
    scene.do(scene.hand, "wait_s: 0.3")
    scene.claim(f"one sliding({scene.hand}, {name})")
    if then_lift:
        scene.do(scene.hand, f"lift_by_m: {number(scene.person['lift_m'])}", 0.6)
        scene.do(scene.hand, "place_on: table", 0.8)
        scene.claim(f"one pick_and_place({scene.hand}, {name})")
    else:
        scene.claim(f"no picking_up({scene.hand}, {name})")
    scene.let_go(scene.hand)
    scene.taken.append((x, y + way, 0.1))


def _two_in_turn(scene):
    for name, style in [scene.ready(), scene.ready()]:
        scene.pick_and_place(name, style)
        scene.claim(f"one pick_and_place({scene.hand}, {name})")


def _again(scene):
    name, style = scene.ready()
    for _ in range(2):
        scene.pick_and_place(name, style)
    scene.claim(f"2 pick_and_place({scene.hand}, {name})", f"2 grasping({scene.hand}, {name})")


def _hand_over(scene):
    name, style = scene.choose(lambda thing: thing["size"][2] >= 0.17, {"wrap"})
    giver, taker = ("right_hand", "left_hand") if scene.side < 0 else ("left_hand", "right_hand")
    height = scene.things[name]["size"][2]
    scene.taken += [(0.2, -0.1 * scene.side, 0.2), (0.1, -0.25 * scene.side, 0.2)]  # from here to there
    scene.stand(name, 0.2, -0.1 * scene.side)
    scene.take(name, style, giver, point_m=point(-0.008, 0, -0.25 * height), **{"from": "side"})
    scene.do(giver, "lift_by_m: 0.2", 0.6)
    scene.take(name, style, taker, point_m=point(-0.008, 0, 0.3 * height), **{"from": "side"})
    scene.do(giver, "open_to: 0", 0.45)
    scene.do(giver, "retreat_by_m: 0.2", 0.6)
    scene.do(taker, f"carry_to_m: {point(0.1, -0.25 * scene.side)}", 1.0)
    scene.do(taker, "place_on: table", 0.7)
    scene.let_go(taker)
    scene.claim(f"grasping({giver}, {name}) overlaps grasping({taker}, {name})", f"one putting_down({taker}, {name})")


def _two_hands(scene):
    """Both hands, each with its own thing, at the same time: the stages of the two stories side by side."""
    stories = []
    for hand, zone in (("right_hand", (-0.36, -0.1)), ("left_hand", (0.1, 0.36))):
        name, style = scene.ready(zone=zone, of_thing=lambda thing: max(thing["size"][:2]) < 0.12)
        before = len(scene.script)
        scene.pick_and_place(name, style, hand, zone=zone)
        scene.claim(f"one pick_and_place({hand}, {name})")
        stories.append(scene.script[before:])
        del scene.script[before:]
    for right, left in zip(*stories):
        scene.script += [right, left.replace("  - ", "    ", 1)]


def _furniture(scene, which):
    style = scene.draw.word({s: w for s, w in scene.recipe["style"].items() if s in ON_HANDLES})
    scene.styles.append(style)
    dx, dy, dz = scene.draw.between(-0.02, 0.02), scene.draw.between(-0.05, 0.05), scene.draw.between(-0.05, 0.05)
    at = {f"x{mm}": number(mm / 1000 + dx) for mm in (525, 320, 240, 520, 310, 230)} | {f"z{mm}": number(mm / 1000 + dz) for mm in (700, 850, 900)}
    mass = number((1.9 if which == "drawer" else 3.9) * scene.draw.between(0.6, 1.4))
    scene.entities.append((DRAWER if which == "drawer" else DOOR).format(
        mass=mass, y0=number(dy), hinge_y=number(dy - 0.2), bar_y=number(dy + 0.14), **at))
    scene.take("handle", style, **{"from": "side"})
    scene.do(scene.hand, f"follow_joint: {which}", 1.4, to=number(scene.draw.between(0.5, 0.9)))
    scene.do(scene.hand, "open_to: 0", 0.5)
    scene.do(scene.hand, "retreat_by_m: 0.2", 0.6)
    scene.claim(f"one grasping({scene.hand}, handle, style={style})", f"at least one opened_by({which}, {scene.hand})", "no picking_up")


def _push(scene):
    """An open hand pushes a thing aside and takes nothing."""
    name, _ = scene.ready(of_thing=lambda thing: 0.05 < thing["size"][2] < 2.2 * min(thing["size"][:2]) and thing["shape"] != "sphere")
    toward = 1 if scene.used[name][1] < 0 else -1
    scene.do(scene.hand, f"reach: {name}", 0.9, offset_m=point(0, -0.13 * toward, 0.0), **{"from": "side"})
    scene.do(scene.hand, f"move_by_m: {point(0, 0.2 * toward, 0)}", 1.0)
    scene.do(scene.hand, "retreat_by_m: 0.15", 0.6)
    scene.claim("no grasping", "no picking_up", f"at least one contact({scene.hand}, {name})")
    scene.styles.clear()


def _bar(scene):
    bars = {name: 1 for name, thing in scene.things.items()
            if thing["size"][1] > 0.15 and thing["size"][0] <= 0.031 and thing["size"][2] <= 0.031 and scene.words["layout"][0] in thing["kinds"]}
    if not bars:
        bars = {"spoon": 1}
    name = scene.draw.word(bars)
    x, y = 0.2, scene.draw.between(-0.15, 0.15)
    for which, dy in (("near_post", -0.07), ("far_post", 0.07)):
        scene.entities.append(f"  {which}: {{class: Post, fixed: true, box: {{size_m: [0.02, 0.02, 0.15]}}, on: table, at_m: {point(x, y + dy)}}}\n")
    scene.taken.append((x, y, 0.2))
    scene.stand(name, x, y, "near_post")
    scene.entities[-1] = scene.entities[-1].replace(f"on: near_post, at_m: {point(x, y)}",
                                                    f"at_m: {point(x, y, scene.top + 0.15 + scene.things[name]['size'][2] / 2)}")
    scene.styles.append("medium_wrap")
    scene.take(name, "medium_wrap", **{"from": "above"})
    scene.do(scene.hand, "lift_by_m: 0.1", 0.6)
    scene.do(scene.hand, "wait_s: 0.3")
    scene.claim(f"one picking_up({scene.hand}, {name})", f"one grasping({scene.hand}, {name})")


def _failure(scene, what):
    """What goes wrong on purpose; after a miss or an aborted reach the hand may try again."""
    hand, slips = scene.hand, what == "slip"
    name, style = scene.ready(of_thing=lambda thing: not slips or thing["mass"] > 0.1 and thing["shape"] != "sphere", friction=0.1 if slips else None,
                              mass=1.6 if slips else 1.0)
    none = ["no putting_down", "no pick_and_place"]
    if what in ("miss", "abort"):
        side = [scene.draw.between(0.12, 0.16) * scene.draw.word({1: 1, -1: 1}) if axis == 1 else 0 for axis in range(3)]
        if what == "abort":
            side = [-scene.draw.between(0.05, 0.1), 0, scene.draw.between(0.1, 0.16)]
        scene.do(hand, f"reach: {name}", 0.85, style=style, offset_m=point(*side), **{"from": "above"})
        if what == "miss":
            scene.do(hand, "close_to: 1", 0.6)
            scene.do(hand, "open_to: 0", 0.45)
        scene.do(hand, "retreat_by_m: 0.15", 0.6)
        if scene.words["retry"] == "again":
            scene.pick_and_place(name, style)
            none = [f"one grasping({hand}, {name})", f"one pick_and_place({hand}, {name})"]
        else:
            none = ["no grasping", "no reaching", *none]
    else:
        scene.take(name, style, grip=0.5 if slips else 1.0)
        lift = max(0.16, scene.person["lift_m"])
        scene.do(hand, f"lift_by_m: {number(lift)}", 0.5)
        x, y = scene.used[name]
        to = (x, y + 0.12 * (1 if y < 0 else -1))
        scene.taken.append((*to, 0.1))
        scene.do(hand, f"move_by_m: {point(0, to[1] - y, 0)}", 0.6)
        if what == "early_release":
            scene.do(hand, f"lift_by_m: {number(scene.draw.between(0.03, 0.06) - lift)}", 0.6)
            scene.do(hand, "wait_s: 0.2")
        scene.do(hand, "open_to: 0", over_s=number(0.15))
        scene.do(hand, "retreat_by_m: 0.15", 0.6)
        if not slips:
            none.insert(0, f"one grasping({hand}, {name})")
    scene.claim(*none)


SKILLS = {"pick_and_place": _pick_and_place, "put_on": _put_on, "lift_and_back": _lift_and_back, "slide": _slide,
          "slide_and_lift": lambda scene: _slide(scene, True), "two_in_turn": _two_in_turn, "again": _again, "hand_over": _hand_over,
          "two_hands": _two_hands, "drawer": lambda scene: _furniture(scene, "drawer"), "door": lambda scene: _furniture(scene, "door"),
          "push": _push, "bar": _bar}


def _hands(scene):
    return ["right_hand", "left_hand"] if scene.words["skill"] in ("hand_over", "two_hands") else [scene.hand]


def _actors(scene):
    """Hands where they start, and the person whose they are."""
    hands = _hands(scene)
    tracking = NOISE[scene.words["noise"]].get("tracking")
    more = ", tracking: {" + ", ".join(f"{k}: {v}" for k, v in tracking.items()) + "}" if tracking else ""
    # In front of furniture a hand begins at its height.
    for hand in hands:
        side = 1 if hand == "left_hand" else -1
        dx, dy, dz = (scene.draw.of(scene.recipe["of_person"]["start_m"]) for _ in range(3))
        at = (-0.2 + dx, 0.24 * side + dy, scene.top + 0.28 + dz)
        if scene.words["skill"] in ("drawer", "door") and scene.words["outcome"] == "success":
            at = (-0.1 + dx, -0.1 + dy, 0.95 + dz)
        if scene.of_gripper:
            scene.actors.append(f"  gripper: {{hand: gripper, at_m: {point(at[0], at[1], at[2] + 0.06)}, rpy_deg: [0, 90, 0]{more}}}\n")
        else:
            scene.actors.append(f"  {hand}: {{hand: human_{hand.split('_')[0]}, at_m: {point(*at)}{more}}}\n")
    if scene.words["body"] != "none":
        scene.actors.append(f"  {scene.words['person']}: {{person: {scene.words['body']}, at_m: [-0.5, 0, 0], height_m: "
                            f"{number(scene.person['height_m'])}, {', '.join(f'{hand}: {hand}' for hand in hands)}}}\n")


def written(recipe, recipe_hash, index, attempt):
    """The scenario's text and what is known of it, or Unplayable."""
    scene = Scene(recipe, recipe_hash, index, attempt)
    words, furniture = scene.words, scene.words["skill"] in ("drawer", "door") and scene.words["outcome"] == "success"
    assert not scene.of_gripper or words["skill"] in BY_GRIPPERS
    if not furniture:
        slippery = ", friction: 0.5" if words["skill"].startswith("slide") else ""
        scene.entities.append(f"  table: {{class: {scene.table}, fixed: true, color: {scene.color}, box: {{size_m: "
                              f"{point(scene.size_x, scene.size_y, 0.04)}}}, at_m: {point(0.2, 0, scene.top - 0.02)}{slippery}}}\n")
    hands = _hands(scene)
    scene.wait(hands)
    if words["outcome"] == "success":
        SKILLS[words["skill"]](scene)
    else:
        _failure(scene, words["outcome"])
    scene.wander(hands, -0.1 if furniture else 0.25)
    acted = sorted(scene.used)
    held_out = set(recipe["held_out"].get("thing") or [])
    for _ in range(0 if furniture else int(words["distractors"])):  # things that only stand there
        around = {name: 1 for name, thing in scene.things.items() if name not in scene.used and name not in held_out
                  and words["layout"][0] in thing["kinds"] and max(thing["size"][:2]) < 0.2}
        name = scene.draw.word(around)
        x, y = scene.place(scene.radius(name) + 0.02, -0.5 * scene.size_y + 0.1, 0.5 * scene.size_y - 0.1)
        scene.stand(name, x, y, yaw=scene.draw.of(recipe["yaw_deg"]))
    _actors(scene)
    order = sorted(range(1, len(scene.entities)), key=lambda _: scene.draw.unit()) if not furniture else []
    entities = scene.entities[:1] + [scene.entities[i] for i in order]  # so that the place in a file tells nothing
    sensors = NOISE[words["noise"]].get("sensors")
    grammar = "kitchen" if furniture else "pick_and_place"
    drawn = {**words, "thing": acted, "style": sorted(set(scene.styles))}
    text = (f"scenario: {scene.name}\nshows: {words['skill']}, {words['outcome']}\nexpects:\n" + "".join(f"  - {c}\n" for c in scene.claims)
            + f"grammar: {grammar}\nworld: {{rate_hz: 480, sensing_hz: {words['sensing_hz']}, seed: {index + 1}}}\n"
            + (f"sensors: {{{', '.join(f'{k}: {v}' for k, v in sensors.items())}, seed: {index + 1}}}\n" if sensors else "")
            + "entities:\n" + "".join(entities) + "actors:\n" + "".join(scene.actors) + "script:\n" + "".join(scene.script) + f"settle_s: {number(0.4 + scene.draw.of(recipe['rest_s']))}\n")
    return text, drawn, scene.claims
