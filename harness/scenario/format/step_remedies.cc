// SPDX-License-Identifier: Apache-2.0
#include <sstream>
#include <utility>

#include "harness/scenario/format/scenario_formats.h"

namespace prehend::scenario {

Remedies StepRemedies() {
  const std::pair<const char*, const char*> groups[] = {
      {"grasp grip grab take pick pick_up",
       "a grasp is two steps: 'reach: milk', then 'close_to: 1'"},
      {"release let_go drop", "to let go is 'open_to: 0'; before it 'place_on: table' sets down"},
      {"open open_hand",
       "a hand opens by 'open_to: 0'; a drawer or door by 'reach: handle', 'close_to: 1', "
       "'follow_joint: drawer'"},
      {"close close_hand shut",
       "a hand closes by 'close_to: 1'; a drawer or door by 'follow_joint: drawer, to: 0'"},
      {"lift lift_m raise", "straight up is 'lift_by_m: 0.2'"},
      {"move move_to move_to_m go_to goto carry carry_to transport",
       "'reach: milk' goes to a thing, 'move_by_m: [x, y, z]' by a way, 'carry_to_m: [x, y]' "
       "brings "
       "what is held to a place, 'poses: [..]' goes anywhere"},
      {"wait pause hold sleep delay_s", "to hold still is 'wait_s: 1'"},
      {"turn rotate twist", "to turn the hand is 'turn_by_deg: [0, 0, 90]'"},
      {"place put put_down put_on set_down", "to set down is 'place_on: table'"},
      {"push push_to_m push_by_m slide slide_to slide_to_m slide_by_m drag",
       "a hand that moves pushes, and what it holds slides where it still rests on something: "
       "'close_to: 0.8', then 'move_by_m: [0.1, 0, 0]'"},
      {"pour", "'lift_by_m', 'carry_to_m' above the vessel, then 'turn_by_deg: [120, 0, 0]'"},
      {"retreat withdraw leave", "'retreat_by_m: 0.2' goes back the way the hand came"},
      {"press squeeze",
       "'press_n: 5, against: table' presses with 5 N; 'close_to: 1' closes with full effort"},
      {"touch brush tap poke nudge",
       "'move_by_m: [0.2, 0, 0], until: touching(milk)' goes until it touches"},
      {"circle circle_around go_around",
       "'orbit: {around: milk, by_deg: 180, at_m: 0.2}' goes around a thing"},
      {"times loop for", kRepeatRemedy},
      {"shake stir wipe",
       "'repeat: 3' with 'steps: [..]' plays steps several times; "
       "docs/script-cookbook.md has a script"},
      {"hand_over give stack throw",
       "it takes several steps; docs/script-cookbook.md and 'prehend new NAME' have scripts"},
      {"look", "a person looks by 'look_at: milk'"},
      {"walk walk_to", "a person walks by 'walk_to_m: [x, y]'"}};
  Remedies remedies = {
      {"",
       "steps that follow each other are a list: 'right_hand: [{reach: milk}, {close_to: 1}]'"}};
  for (const auto& [words, remedy] : groups) {
    std::istringstream each(words);
    for (std::string word; each >> word;) remedies.emplace_back(word, remedy);
  }
  return remedies;
}

}  // namespace prehend::scenario
