// SPDX-License-Identifier: Apache-2.0
// Every way to get a scenario wrong, with everything that is said about it; and that the JSON
// Schema refuses the same typos and wrong types.
#include <gtest/gtest.h>

#include "harness/scenario/format/scenario_fields.h"
#include "tests/harness/scenario/format/python_validator.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

enum class Schema { kRefuses, kAccepts, kCannotRead };
using enum Schema;

/// One edit of the probe.
struct Case {
  const char* name;
  const char* from;
  const char* to;
  Schema schema;  ///< what a validator makes of it: it does not know what names mean, nor geometry
  const char* errors;
};

constexpr const char* kMilk =
    "milk: {box: {size_m: [0.07, 0.07, 0.20]}, mass_kg: 0.4, on: table, at_m: [0.2, 0.1]}";

// clang-format off
const Case kCases[] = {
      {"missing_key", "shows: a carton on a table\n", "", kRefuses,
       "1:1: the scenario needs the key 'shows'\n"},
      {"unknown_key", "shows:", "show:", kRefuses,
       "2:1: unknown key 'show' in the scenario | did you mean 'shows'?\n"},
      {"unknown_key_far", "shows:", "explanation:", kRefuses,
       "1:1: the scenario needs the key 'shows'\n"
       "2:1: unknown key 'explanation' in the scenario | known: scenario, shows, expects, grammar, tags, world, sensors, entities, classes, actors, script, settle_s, vary, outcomes, pictures\n"},
      {"wrong_unit", "mass_kg: 0.4", "mass_g: 400", kRefuses,
       "7:45: unknown key 'mass_g' in entity 'milk' | did you mean 'mass_kg'?\n"},
      {"wrong_unit_far", "size_m: [0.07", "size_inch: [0.07", kRefuses,
       "7:16: unknown key 'size_inch' in a box | did you mean 'size_m'?\n"},
      {"name_differs", "scenario: probe", "scenario: porbe", kAccepts,
       "1:11: scenario: the name is 'porbe', but the file is called 'probe.yaml' | rename one of them\n"},
      {"name_not_identifier", "scenario: probe", "scenario: Probe", kRefuses,
       "1:11: scenario: expected a name like 'milk_carton', found 'Probe' | write 'probe': small letters, digits and '_'\n"},
      {"shows_empty", "a carton on a table", "\"\"", kRefuses,
       "2:8: shows: expected text of 1 to 500 bytes, found the text ''\n"},
      {"shows_number", "a carton on a table", "7", kRefuses,
       "2:8: shows: expected text of 1 to 500 bytes, found the number 7 | put it in quotes if text is meant: '7'\n"},
      {"unknown_grammar", "grammar: pick_and_place", "grammar: pick_and_plaice", kAccepts,
       "3:10: grammar: no grammar is called 'pick_and_plaice' | did you mean 'pick_and_place'?\n"},
      {"entity_called_any", "actors:\n", "  any: {class: Cup, box: {size_m: [0.1, 0.1, 0.1]}, mass_kg: 0.1, on: table, at_m: [-0.4, 0]}\nactors:\n", kAccepts,
       "8:3: 'any': this name stands for everybody, in claims and queries | choose another name\n"},
      {"hand_called_any", "actors:\n", "actors:\n  any: {hand: human_left, at_m: [-0.2, 0.2, 1.05]}\n", kAccepts,
       "9:3: 'any': this name stands for everybody, in claims and queries | choose another name\n"},
      {"tags_not_list", "grammar: pick_and_place", "tags: smoke", kRefuses,
       "3:7: tags: expected a list, found 'smoke'\n"},
      {"unknown_engine", "engine: bullet", "engine: bulet", kRefuses,
       "4:17: engine: expected one of bullet, box2d, bullet_stock, found 'bulet' | did you mean 'bullet'?\n"},
      {"rate_too_high", "rate_hz: 480", "rate_hz: 100000", kRefuses,
       "4:34: rate_hz: expected a whole number from 60 to 4800, found '100000'\n"},
      {"rate_not_whole", "rate_hz: 480", "rate_hz: 480.5", kRefuses,
       "4:34: rate_hz: expected a whole number from 60 to 4800, found '480.5'\n"},
      {"sensing_above_rate", "sensing_hz: 240", "sensing_hz: 960", kAccepts,
       "4:51: sensing_hz 960 is above rate_hz 480\n"},
      {"seed_negative", "seed: 1", "seed: -1", kRefuses,
       "4:62: seed: expected a whole number from 0 to 9007199254740992, found '-1'\n"},
      {"sensors_without_unit", "grammar: pick_and_place", "sensors: {position_noise: 0.003}", kRefuses,
       "3:11: unknown key 'position_noise' in the sensors | did you mean 'position_noise_m'?\n"},
      {"sensors_too_noisy", "grammar: pick_and_place", "sensors: {position_noise_m: 3, lost_frames_share: 1}", kRefuses,
       "3:29: position_noise_m: expected a number from 0 to 0.1, found '3'\n"
       "3:51: lost_frames_share: expected a number from 0 to 0.95, found '1'\n"},
      {"world_is_scalar", "world: {engine: bullet, rate_hz: 480, sensing_hz: 240, seed: 1}", "world: bullet", kRefuses,
       "4:8: world: expected a mapping with the fields of the world, found 'bullet'\n"},
      {"no_shape", "box: {size_m: [0.07, 0.07, 0.20]}, ", "", kRefuses,
       "7:3: entity 'milk' needs one of the keys box, sphere, cylinder, capsule, hull, tray, mug, bowl, shelf, parts, grains, region, gaze_target, camera, light\n"},
      {"two_shapes", "box: {size_m: [0.07, 0.07, 0.20]}, ", "box: {size_m: [0.07, 0.07, 0.20]}, sphere: {radius_m: 0.1}, ", kRefuses,
       "7:45: entity 'milk' cannot have both 'box' and 'sphere'\n"},
      {"size_zero", "[0.07, 0.07, 0.20]", "[0.07, 0, 0.20]", kRefuses,
       "7:31: size_m[1]: expected a number from 0.001 to 100, found '0'\n"},
      {"size_huge", "[0.07, 0.07, 0.20]", "[0.07, 0.07, 200]", kRefuses,
       "7:37: size_m[2]: expected a number from 0.001 to 100, found '200'\n"},
      {"size_two_items", "[0.07, 0.07, 0.20]", "[0.07, 0.07]", kRefuses,
       "7:24: size_m: expected 3 items, found 2\n"},
      {"size_scalar", "[0.07, 0.07, 0.20]", "0.07", kRefuses,
       "7:24: size_m: expected a list of 3, found '0.07'\n"},
      {"class_lower", "class: Table", "class: table", kRefuses,
       "6:18: class: expected a class name like 'MilkCarton', found 'table' | write 'Table': it begins with a capital letter\n"},
      {"class_builtin", "class: Table", "class: Thing", kAccepts,
       "6:18: class: 'Thing' is a built-in class; entities get it automatically | name what the entity is, for example Cup\n"},
      {"fixed_word", "fixed: true", "fixed: yes", kRefuses,
       "6:32: fixed: expected true or false, found 'yes' (true or false to some YAML readers) | write a number, true or false, or text in quotes\n"},
      {"fixed_with_mass", "fixed: true", "fixed: true, mass_kg: 3", kAccepts,
       "6:47: entity 'table' is fixed: it cannot have a mass | remove fixed or mass_kg\n"},
      {"movable_without_mass", "mass_kg: 0.4, ", "", kAccepts,
       "7:3: entity 'milk' can move: it needs the key 'mass_kg' | or 'fixed: true'\n"},
      {"mass_negative", "mass_kg: 0.4", "mass_kg: -0.4", kRefuses,
       "7:54: mass_kg: expected a number from 0.001 to 1000, found '-0.4'\n"},
      {"mass_no", "mass_kg: 0.4", "mass_kg: no", kRefuses,
       "7:54: mass_kg: expected a number from 0.001 to 1000, found 'no' (true or false to some YAML readers) | write a number, true or false, or text in quotes\n"},
      {"decimal_comma", "mass_kg: 0.4", "mass_kg: 1,4", kRefuses,
       "7:56: unknown key '4' in entity 'milk' | decimals have a point: 0.5\n"},
      {"typographic_minus", "[0.2, 0.1]", "[0.2, \u22120.1]", kRefuses,
       "7:82: at_m[1]: expected a number from -20 to 20, found '\u22120.1' | '\u2212' is not '-'; retype it\n"},
      {"mass_null", "mass_kg: 0.4", "mass_kg: ~", kRefuses,
       "7:54: mass_kg: expected a number from 0.001 to 1000, found '~'\n"},
      {"mass_missing_value", "mass_kg: 0.4", "mass_kg: ", kRefuses,
       "7:45: mass_kg: expected a number from 0.001 to 1000, found nothing\n"},
      {"mass_text", "mass_kg: 0.4", "mass_kg: \"0.4\"", kRefuses,
       "7:54: mass_kg: expected a number from 0.001 to 1000, found the text '0.4'\n"},
      {"mass_list", "mass_kg: 0.4", "mass_kg: [0.4]", kRefuses,
       "7:54: mass_kg: expected a number from 0.001 to 1000, found a list\n"},
      {"mass_mapping", "mass_kg: 0.4", "mass_kg: {kg: 0.4}", kRefuses,
       "7:54: mass_kg: expected a number from 0.001 to 1000, found a mapping\n"},
      {"friction_too_high", "mass_kg: 0.4", "mass_kg: 0.4, friction: 50", kRefuses,
       "7:69: friction: expected a number from 0 to 5, found '50'\n"},
      {"both_rotations", "mass_kg: 0.4", "mass_kg: 0.4, yaw_deg: 3, rpy_deg: [0, 0, 3]", kRefuses,
       "7:71: entity 'milk' cannot have both 'yaw_deg' and 'rpy_deg'\n"},
      {"unknown_support", "on: table", "on: tabel", kAccepts,
       "7:63: on: no entity is called 'tabel' | did you mean 'table'?\n"},
      {"stands_on_itself", "on: table", "on: milk", kAccepts,
       "7:63: on: 'milk' stands, directly or not, on itself\n"},
      {"beside_support", "at_m: [0.2, 0.1]", "at_m: [0.7, 0.1]", kAccepts,
       "7:76: at_m: the centre of 'milk' is not above 'table' | at_m is in world coordinates, also with 'on'\n"},
      {"beside_a_tilted_support", "at_m: [0, 0, 0.74]}", "at_m: [0, 0, 0.74], rpy_deg: [0, 75, 0]}", kAccepts,
       "7:76: at_m: the centre of 'milk' is not above 'table' | at_m is in world coordinates, also with 'on'\n"},
      {"falls_through_its_support", "box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]",
       "parts: [{box: {size_m: [0.1, 0.8, 0.04]}, at_m: [0.6, 0, 0]}, {box: {size_m: [0.1, 0.8, 0.04]}, at_m: [-0.6, 0, 0]}], at_m: [0, 0, 0.74]", kAccepts,
       "7:76: at_m: no part of 'table' is below 'milk' | 'on' lets it straight down until it touches; here it would fall through\n"},
      {"z_with_on", "at_m: [0.2, 0.1]", "at_m: [0.2, 0.1, 0.9]", kAccepts,
       "7:76: at_m: with 'on' expected [x, y], found 3 numbers | z follows from the top of the support\n"},
      {"no_z_without_on", "on: table, ", "", kAccepts,
       "7:65: at_m: expected [x, y, z], the centre, found 2 numbers | or [x, y] together with 'on: SUPPORT'\n"},
      {"no_place", ", at_m: [0.2, 0.1]", "", kRefuses,
       "7:3: entity 'milk' needs one of the keys at_m, in\n"},
      {"in_is_for_grains", "on: table, at_m: [0.2, 0.1]", "in: table", kAccepts,
       "7:63: in: only grains can be put into a vessel | for a thing: 'on', with at_m: [x, y]\n"},
      {"grains_without_vessel", "box: {size_m: [0.07, 0.07, 0.20]}", "grains: {count: 10, radius_m: 0.005}", kAccepts,
       "7:3: entity 'milk' is grains: it needs the key 'in' | the vessel that they fill\n"
       "7:62: on: this key does not apply to grains; they lie loose in their vessel\n"
       "7:73: at_m: this key does not apply to grains; they lie loose in their vessel\n"
       "11:25: reach: 'milk' is grains, not a physical object | name the vessel that holds them\n"},
      {"too_many_grains", "box: {size_m: [0.07, 0.07, 0.20]}", "grains: {count: 501, radius_m: 0.005}", kRefuses,
       "7:26: count: expected a whole number from 1 to 500, found '501'\n"},
      {"too_small_grains", "box: {size_m: [0.07, 0.07, 0.20]}", "grains: {count: 50, radius_m: 0.001}", kRefuses,
       "7:40: radius_m: expected a number from 0.002 to 0.05, found '0.001'\n"},
      {"grains_in_nothing", kMilk, "milk: {grains: {count: 10, radius_m: 0.005}, mass_kg: 0.4, in: tabel}", kAccepts,
       "7:66: in: no entity is called 'tabel' | did you mean 'table'?\n"
       "11:25: reach: 'milk' is grains, not a physical object | name the vessel that holds them\n"},
      {"grains_in_what_is_solid", kMilk, "milk: {grains: {count: 10, radius_m: 0.005}, mass_kg: 0.4, in: table}", kAccepts,
       "7:66: in: 0 of 10 grains fit into 'table' below its rim | use fewer or smaller grains, or a larger vessel; its hollow is centred on the vertical through its at_m\n"
       "11:25: reach: 'milk' is grains, not a physical object | name the vessel that holds them\n"},
      {"inside_table", "on: table, at_m: [0.2, 0.1]", "at_m: [0.2, 0.1, 0.8]", kAccepts,
       "7:65: 'milk' overlaps 'table' by 60 mm | 'on: table' with at_m: [x, y] puts it on top\n"},
      {"entity_name_upper", "milk: {", "Milk: {", kRefuses,
       "7:3: expected a name like 'milk_carton', found 'Milk' | write 'milk': small letters, digits and '_'\n"},
      {"entity_name_bool", "milk: {", "no: {", kAccepts,
       "7:3: expected a name like 'milk_carton', found 'no' (true or false to some YAML readers) | write a number, true or false, or text in quotes\n"},
      {"actor_named_like_entity", "right_hand: {hand", "milk: {hand", kAccepts,
       "9:3: 'milk' is already the name of an entity\n"
       "11:5: no actor is called 'right_hand' | known: milk\n"
       "12:5: no actor is called 'right_hand' | known: milk\n"},
      {"unknown_hand", "hand: human_right", "hand: human_rigth", kAccepts,
       "9:22: hand: no hand is called 'human_rigth' | did you mean 'human_right'?\n"},
      {"broken_hand_file", "hand: human_right", "hand: broken.hand.yaml", kAccepts,
       "9:22: hand: 'broken.hand.yaml' cannot be used, see below\n"
       "broken.hand.yaml:3:4: no links\n"},
      {"hand_inside_table", "at_m: [-0.2, -0.2, 1.05]", "at_m: [-0.2, -0.2, 0.76]", kAccepts,
       "9:41: actor 'right_hand' starts inside 'table', 12 mm deep | start the hand in free space; the thumb of an open hand hangs 10 cm below its palm\n"},
      {"gains_unstable", "hand: human_right", "hand: human_right, gains: {translation: {derivative_n_s_per_m: 300}}", kAccepts,
       "9:42: actor 'right_hand': the translation derivative gain 300 cannot be stable: gain * dt / inertia = 300 * (1/480 s) / 0.6 kg = 1.04, which must stay below 1 (at most 285.1 here) | it is stable from 'world: {rate_hz: 501}' on\n"},
      {"gains_at_low_rate", "rate_hz: 480, sensing_hz: 240", "rate_hz: 90, sensing_hz: 90", kAccepts,
       "9:22: actor 'right_hand': the translation derivative gain 120 cannot be stable: gain * dt / inertia = 120 * (1/90 s) / 0.6 kg = 2.22, which must stay below 1 (at most 53.46 here) | it is stable from 'world: {rate_hz: 217}' on\n"},
      {"unknown_actor", "- right_hand: {close_to", "- left_hand: {close_to", kAccepts,
       "12:5: no actor is called 'left_hand' | known: right_hand\n"},
      {"unknown_object", "reach: milk", "reach: milky", kAccepts,
       "11:25: reach: no entity is called 'milky' | did you mean 'milk'?\n"},
      {"unknown_style", "style: wrap", "style: warp", kAccepts,
       "11:38: style: hand 'human_right' has no style 'warp' | did you mean 'wrap'?\n"},
      {"point_elsewhere", "over_s: 0.8", "point_m: [0, 0, 0.2]", kAccepts,
       "11:53: point_m: the point is 100.0 mm outside 'milk', more than 5 mm | point_m is in the entity's own frame: [0, 0, 0] is where its at_m is\n"},
      {"no_side_grasp", "style: wrap", "style: pinch, from: side", kAccepts,
       "11:25: style 'pinch' does not grasp from the side\n"},
      {"unknown_approach", "style: wrap", "from: below", kRefuses,
       "11:37: from: expected one of auto, above, side, found 'below'\n"},
      {"grip_too_strong", "close_to: 1.0", "close_to: 1.5", kRefuses,
       "12:28: close_to: expected a number from 0 to 1, found '1.5'\n"},
      {"no_action", "close_to: 1.0", "closeto: 1.0", kRefuses,
       "12:18: a step needs one of the keys reach, close_to, open_to, lift_by_m, move_by_m, carry_to_m, place_on, retreat_by_m, follow_joint, wait_s, poses, turn_by_deg, orbit, press_n, recording, look_at, look_at_m, eyes, walk_to_m, turn_to_deg, lean_deg, sway_by_m, move_limb | did you mean 'close_to'?\n"},
      {"no_action_at_all", "{close_to: 1.0}", "{over_s: 1}", kRefuses,
       "12:18: a step needs one of the keys reach, close_to, open_to, lift_by_m, move_by_m, carry_to_m, place_on, retreat_by_m, follow_joint, wait_s, poses, turn_by_deg, orbit, press_n, recording, look_at, look_at_m, eyes, walk_to_m, turn_to_deg, lean_deg, sway_by_m, move_limb\n"},
      {"two_actions", "close_to: 1.0", "close_to: 1.0, open_to: 0", kRefuses,
       "12:33: a step has one of 'close_to' and 'open_to', not both | steps that follow each other are a list: 'right_hand: [{reach: milk}, {close_to: 1}]'\n"},
      {"key_of_another_step", "close_to: 1.0", "close_to: 1.0, style: wrap", kRefuses,
       "12:33: unknown key 'style' in a close_to step | known: close_to, over_s, until, delay_s, "
        "name, after, with\n"},
      {"renamed_key_of_a_limb", "close_to: 1.0", "move_limb: right_elbow, to_m: [0, 0, 1], most_n: 40", kRefuses,
       "12:59: unknown key 'most_n' in a move_limb step | it is called 'max_force_n' now\n"},
      {"renamed_keys_of_a_recording", "close_to: 1.0", "recording: a.csv, most_gap_s: 0.1, most_jump_m: 0.2", kRefuses,
       "12:36: unknown key 'most_gap_s' in a recording step | it is called 'max_gap_s' now\n"
       "12:53: unknown key 'most_jump_m' in a recording step | it is called 'max_jump_m' now\n"},
      {"duration_zero", "over_s: 0.8", "over_s: 0", kRefuses,
       "11:52: over_s: expected a number from 0.01 to 600, found '0'\n"},
      {"place_on_unknown", "close_to: 1.0", "place_on: shelf", kAccepts,
       "12:28: place_on: no entity is called 'shelf' | known: table, milk\n"},
      {"word_tried_first", "close_to: 1.0", "grasp: milk", kRefuses,
       "12:18: a step has no key 'grasp' | a grasp is two steps: 'reach: milk', then 'close_to: 1'\n"},
      {"word_with_a_duration", "close_to: 1.0", "over_s: 1, release: milk", kRefuses,
       "12:29: a step has no key 'release' | to let go is 'open_to: 0'; before it 'place_on: table' sets down\n"},
      {"word_touch", "close_to: 1.0", "touch: milk", kRefuses,
       "12:18: a step has no key 'touch' | 'move_by_m: [0.2, 0, 0], until: touching(milk)' goes until it touches\n"},
      {"word_circle", "close_to: 1.0", "circle: milk", kRefuses,
       "12:18: a step has no key 'circle' | 'orbit: {around: milk, by_deg: 180, at_m: 0.2}' goes around a thing\n"},
      {"word_squeeze", "close_to: 1.0", "squeeze: milk", kRefuses,
       "12:18: a step has no key 'squeeze' | 'press_n: 5, against: table' presses with 5 N; 'close_to: 1' closes with full effort\n"},
      {"word_slide", "close_to: 1.0", "slide_to_m: [0, 0.1]", kRefuses,
       "12:18: a step has no key 'slide_to_m' | a hand that moves pushes, and what it holds slides where it still rests on something: 'close_to: 0.8', then 'move_by_m: [0.1, 0, 0]'\n"},
      {"step_several_times", "close_to: 1.0", "close_to: 1.0, times: 3", kRefuses,
       "12:33: unknown key 'times' in a close_to step | steps are repeated by a block of their own: '- repeat: 3' and below it 'steps: [..]'\n"},
      {"block_several_times", "- right_hand: {close_to: 1.0}", "- times: 3\n    steps: [{right_hand: {close_to: 1}}]", kRefuses,
       "12:5: unknown key 'times' in a repeated block | known: repeat, steps; 'repeat: 3' says how often\n"},
      {"block_without_steps", "- right_hand: {close_to: 1.0}", "- repeat: 3\n    right_hand: {close_to: 1}", kRefuses,
       "13:5: unknown key 'right_hand' in a repeated block | what is repeated is a list below 'steps:', like '- repeat: 3' and below it 'steps: [{right_hand: {close_to: 1}}]'\n"},
      {"orbit_is_word", "close_to: 1.0", "orbit: milk", kRefuses,
       "12:25: orbit: expected a mapping with the fields of an orbit, found 'milk' | write 'orbit: {around: milk}'\n"},
      {"box_is_list", "box: {size_m: [0.07, 0.07, 0.20]}", "box: [0.07, 0.07, 0.20]", kRefuses,
       "7:15: box: expected a mapping with the fields of a box, found a list | write 'box: {size_m: [0.07, 0.07, 0.20]}'\n"},
      {"cylinder_is_list", "box: {size_m: [0.07, 0.07, 0.20]}", "cylinder: [0.07, 0.20]", kRefuses,
       "7:20: cylinder: expected a mapping with the fields of a cylinder, found a list | write 'cylinder: {radius_m: .., length_m: ..}'\n"},
      {"color_is_comment", "milk: {box: {size_m: [0.07, 0.07, 0.20]}, mass_kg: 0.4, on: table, at_m: [0.2, 0.1]}", "milk:\n    color: #ff0000\n    box: {size_m: [0.07, 0.07, 0.20]}\n    mass_kg: 0.4\n    on: table\n    at_m: [0.2, 0.1]", kRefuses,
       "8:5: color: expected a word or \"#RRGGBB\" in quotes, found nothing | '#' begins a comment in YAML: a colour goes in quotes, color: \"#ff0000\"\n"},
      {"color_hides_the_brace", "mass_kg: 0.4", "color: #ff0000, mass_kg: 0.4", kCannotRead,
       "8:7: not valid YAML: '#' begins a comment, which hides the rest of the line | a colour goes in quotes: \"#ff0000\"\n"},
      {"until_without_unit", "close_to: 1.0", "close_to: 1.0, until: gap(milk) < 5", kRefuses,
       "12:40: until: expected 'touching(milk)' or 'gap(milk) < 5 mm', perhaps with ', or go on', found 'gap(milk) < 5' | a length has a unit: gap(milk) < 5 mm\n"},
      {"until_in_metres", "close_to: 1.0", "close_to: 1.0, until: gap(milk) < 0.005", kRefuses,
       "12:40: until: expected 'touching(milk)' or 'gap(milk) < 5 mm', perhaps with ', or go on', found 'gap(milk) < 0.005' | a length has a unit: gap(milk) < 5 mm\n"},
      {"until_another_word", "close_to: 1.0", "close_to: 1.0, until: touch(milk)", kRefuses,
       "12:40: until: expected 'touching(milk)' or 'gap(milk) < 5 mm', perhaps with ', or go on', found 'touch(milk)' | write: touching(milk)\n"},
      {"relative_to_nothing", "close_to: 1.0", "poses: [{t_s: 1, at_m: [0, 0, 0]}], relative_to: mlik", kAccepts,
       "12:67: relative_to: no entity or hand is called 'mlik' | did you mean 'milk'?\n"},
      {"relative_to_itself", "close_to: 1.0", "poses: [{t_s: 1, at_m: [0, 0, 0], relative_to: right_hand}]", kAccepts,
       "12:65: relative_to: 'right_hand' is this hand itself | write 'relative_to: hand'\n"},
      {"height_where_there_is_none", "close_to: 1.0", "carry_to_m: [0, 0, 1]", kRefuses,
       "12:30: carry_to_m: expected [x, y], found 3 numbers | the height is kept; 'lift_by_m' changes it\n"},
      {"word_for_many_steps", "close_to: 1.0", "shake: milk", kRefuses,
       "12:18: a step has no key 'shake' | 'repeat: 3' with 'steps: [..]' plays steps several times; docs/script-cookbook.md has a script\n"},
      {"until_is_no_condition", "close_to: 1.0", "close_to: 1.0, until: touches milk", kRefuses,
       "12:40: until: expected 'touching(milk)' or 'gap(milk) < 5 mm', perhaps with ', or go on', found 'touches milk'\n"},
      {"until_unknown", "close_to: 1.0", "close_to: 1.0, until: touching(mlik)", kAccepts,
       "12:40: until: no entity is called 'mlik' | did you mean 'milk'?\n"},
      {"until_unknown_who", "close_to: 1.0", "wait_s: 1, until: 'touching(lef_hand, milk)'", kAccepts,
       "12:36: until: no entity is called 'lef_hand' | known: right_hand, table, milk\n"},
      {"until_gap_of_a_thing", "close_to: 1.0", "wait_s: 1, until: 'gap(table, milk) < 5 mm'", kAccepts,
       "12:36: until: no hand is called 'table' | known: right_hand\n"},
      {"until_itself", "close_to: 1.0", "wait_s: 1, until: 'touching(milk, milk)'", kAccepts,
       "12:36: until: 'milk' is itself\n"},
      {"until_too_far", "close_to: 1.0", "close_to: 1.0, until: gap(milk) < 20 cm", kAccepts,
       "12:40: until: a gap of 200 mm is too far, at most 90 mm\n"},
      {"turns_by_nothing", "close_to: 1.0", "turn_by_deg: [0, 0, 0]", kAccepts,
       "12:31: turn_by_deg: all three are 0, so nothing turns\n"},
      {"presses_nothing", "close_to: 1.0", "press_n: 5, against: shelf, along: [0, 0, 0]", kAccepts,
       "12:39: press_n: no entity is called 'shelf' | known: table, milk\n"
       "12:53: along: the direction has no length\n"},
      {"step_is_word", "{close_to: 1.0}", "close", kRefuses,
       "12:17: right_hand: expected a mapping with the fields of a step, found 'close' | write who does what: 'right_hand: {close_to: 1}'\n"},
      {"script_is_mapping", "script:\n  - right_hand: {reach: milk, style: wrap, over_s: 0.8}\n  - right_hand: {close_to: 1.0}", "script:\n  right_hand: {close_to: 1.0}", kRefuses,
       "11:3: script: expected a list, found a mapping | begin each item with '- ' on a line of its own, or put all in [..]\n"},
      {"poses_not_increasing", "close_to: 1.0", "poses: [{t_s: 0.5, at_m: [0, 0, 1]}, {t_s: 0.5, at_m: [0, 0, 1]}]", kAccepts,
       "12:61: t_s: expected more than 0.5, the time of the previous pose, found 0.5 | t_s counts from the beginning of the step, not from the previous pose\n"},
      {"quaternion_not_unit", "close_to: 1.0", "poses: [{t_s: 0.5, at_m: [0, 0, 1], quat_wxyz: [1, 1, 0, 0]}]", kAccepts,
       "12:65: quat_wxyz: expected a unit quaternion [w, x, y, z], found one of length 1.414\n"},
      {"pose_with_both", "close_to: 1.0", "poses: [{t_s: 0.5, at_m: [0, 0, 1], quat_wxyz: [1, 0, 0, 0], rpy_deg: [0, 0, 0]}]", kRefuses,
       "12:79: a pose cannot have both 'quat_wxyz' and 'rpy_deg'\n"},
      {"picture_moment", "at: reaching.begin", "at: reaching", kRefuses,
       "14:10: at: expected a time in seconds, or an event like 'reaching.begin', found 'reaching'\n"},
      {"picture_time_ambiguous", "at: reaching.begin", "at: 1:30", kRefuses,
       "14:10: at: expected a time in seconds, or an event like 'reaching.begin', found '1:30' (a number in base 60 to some YAML readers) | write seconds as a decimal number, or quote it\n"},
      {"camera", "camera: front", "camera: frnt", kAccepts,
       "14:34: camera: no camera is called 'frnt' | did you mean 'front'?\n"},
      {"duplicate_key", "grammar: pick_and_place", "shows: again", kAccepts,
       "3:1: duplicate key 'shows' | first given in line 2\n"},
      {"alias", "a carton on a table", "*carton", kCannotRead,
       "2:8: not valid YAML: aliases ('*name') are not supported | write the value out; text that begins with '*' goes in quotes\n"},
      {"anchor", "a carton on a table", "&carton text", kAccepts,
       "2:8: anchors ('&name') are not supported | write the value out where it is used\n"},
      {"tag", "a carton on a table", "!!str text", kAccepts,
       "2:8: tags ('!name') are not supported | remove the tag\n"},
      {"two_documents", "grammar: pick_and_place", "---", kCannotRead,
       "3:1: a second document begins here | one file holds one document; remove the '---'\n"},
      {"tab", "a carton on", "a\tcarton on", kCannotRead,
       "2:9: tab character | indent and separate with spaces\n"},
      {"unclosed", "at_m: [0, 0, 0.74]}", "at_m: [0, 0, 0.74]", kCannotRead,
       "7:3: not valid YAML: a '{' before this is not closed | each '[' needs its ']', each '{' its '}'\n"},
};
// clang-format on

class ScenarioError : public testing::TestWithParam<Case> {};

TEST_P(ScenarioError, IsExplainedInFull) {
  const std::string text = ProbeWith(GetParam().from, GetParam().to);
  EXPECT_EQ(Brief(ErrorsOf(ReadScenarioText("probe.yaml", text, {}, ProbeLibrary()))),
            GetParam().errors);
}

INSTANTIATE_TEST_SUITE_P(All, ScenarioError, testing::ValuesIn(kCases),
                         [](const auto& i) { return i.param.name; });

TEST(ScenarioErrors, TheSchemaRefusesTheSameTyposAndTypes) {
  PythonValidator validator;
  for (const Case& c : kCases) {
    if (c.schema != kCannotRead) validator.Add(c.name, ProbeWith(c.from, c.to));
  }
  const auto valid = validator.Validate(ScenarioSchema());
  for (const Case& c : kCases) {
    if (c.schema == kCannotRead) continue;
    ASSERT_TRUE(valid.contains(c.name))
        << c.name << " was not validated: are python3-jsonschema and python3-yaml there?";
    EXPECT_EQ(valid.at(c.name), c.schema == kAccepts) << c.name;
  }
}

TEST(ScenarioErrors, AreShownWithLineAndCaret) {
  const auto read =
      ReadScenarioText("probe.yaml", ProbeWith("mass_kg: 0.4", "mass_g: 400"), {}, ProbeLibrary());
  EXPECT_EQ(
      grammar::Format(ErrorsOf(read)),
      "probe.yaml:7:45: error: unknown key 'mass_g' in entity 'milk'\n"
      "    milk: {box: {size_m: [0.07, 0.07, 0.20]}, mass_g: 400, on: table, at_m: [0.2, 0.1]}\n"
      "                                              ^\n"
      "  hint: did you mean 'mass_kg'?\n");
}

TEST(ScenarioErrors, ARenamedKeyIsShownWithItsNewName) {
  const auto read = ReadScenarioText(
      "probe.yaml", ProbeWith("close_to: 1.0", "move_limb: right_elbow, most_n: 40"), {},
      ProbeLibrary());
  EXPECT_EQ(grammar::Format(ErrorsOf(read)),
            "probe.yaml:12:42: error: unknown key 'most_n' in a move_limb step\n"
            "    - right_hand: {move_limb: right_elbow, most_n: 40}\n"
            "                                           ^\n"
            "  hint: it is called 'max_force_n' now\n");
}

TEST(ScenarioErrors, AllOfAFileAreCollected) {
  std::string text = ProbeWith("mass_kg: 0.4", "mass_kg: no");
  text.replace(text.find("over_s: 0.8"), 11, "overs: 0.8");
  text.replace(text.find("seed: 1"), 7, "seed: x");
  const auto read = ReadScenarioText("probe.yaml", text, {}, ProbeLibrary());
  ASSERT_EQ(ErrorsOf(read).size(), 3u);
  EXPECT_EQ(ErrorsOf(read)[0].place.line, 4);
  EXPECT_EQ(ErrorsOf(read)[1].place.line, 7);
  EXPECT_EQ(ErrorsOf(read)[2].place.line, 11);
}

}  // namespace
}  // namespace prehend::scenario
