// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <charconv>
#include <sstream>
#include <string_view>
#include <utility>

#include "harness/scenario/format/scenario_formats.h"

namespace prehend::scenario {
namespace {

constexpr const char* kConditions =
    "'touching(milk)' or 'gap(milk) < 5 mm', perhaps with ', or go on'";

/// What a condition says, as far as it says it.
struct SaidUntil {
  std::string word, who, thing;
  std::optional<double> number;  ///< of "< 5 mm"
  std::string_view rest;         ///< what follows the number
};

SaidUntil SaidBy(std::string_view text) {
  SaidUntil said;
  const std::size_t open = text.find('('), close = text.find(')');
  if (open == std::string::npos || close == std::string::npos || close < open) return said;
  said.word = text.substr(0, open);
  said.thing = text.substr(open + 1, close - open - 1);
  if (const std::size_t comma = said.thing.find(", "); comma != std::string::npos) {
    said.who = said.thing.substr(0, comma);
    said.thing.erase(0, comma + 2);
  }
  const std::size_t digits = text.find_first_of("0123456789", text.find('<', close));
  if (digits == std::string::npos) return said;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + digits, end, said.number.emplace());
  said.rest = {read.ptr, static_cast<std::size_t>(end - read.ptr)};
  return said;
}

/// How one that cannot be read was meant; "" if it can be read, or that is not known.
std::string Remedy(const SaidUntil& said) {
  if (said.word != "touching" && said.word.starts_with("touch"))
    return fmt::format("write: touching({})", said.thing);
  const bool has_unit = !said.rest.empty() && !said.rest.starts_with(',');
  if (said.word != "gap" || !said.number || has_unit) return "";
  // Who leaves the unit out thinks of millimetres, or of metres as elsewhere in the file.
  return fmt::format("a length has a unit: gap({}) < {} mm", said.thing,
                     *said.number < 1 ? 1000 * *said.number : *said.number);
}

}  // namespace

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

ValueFormat<physics::Until> UntilFormat() {
  const auto condition = Word(
      "(touching\\(([a-z][a-z0-9_]*, )?[a-z][a-z0-9_]*\\)|gap\\(([a-z][a-z0-9_]*, "
      ")?[a-z][a-z0-9_]*\\) "
      "< [0-9]+(\\.[0-9]+)? (mm|cm|m))(, or go on)?",
      kConditions, 120);
  const auto read = [condition](const YamlNode& node, DiagnosticList& errors,
                                physics::Until& until) {
    const SaidUntil said =
        SaidBy(node.kind == YamlNode::Kind::kScalar ? std::string_view(node.text) : "");
    if (const std::string remedy = Remedy(said); !remedy.empty()) {
      errors.Add(node.where, fmt::format("until: expected {}, found '{}'", kConditions, node.text),
                 remedy);
      return false;
    }
    std::string text;
    if (!condition.Read(node, errors, text)) return false;
    until = {.thing = said.thing, .or_go_on = text.ends_with("or go on"), .who = said.who};
    if (said.number)
      until.gap_m = *said.number * (said.rest.starts_with(" mm")   ? 0.001
                                    : said.rest.starts_with(" cm") ? 0.01
                                                                   : 1);
    return true;
  };
  return ValueFormat<physics::Until>(condition.schema(), read);
}

}  // namespace prehend::scenario
