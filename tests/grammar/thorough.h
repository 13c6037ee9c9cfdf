// SPDX-License-Identifier: Apache-2.0
// A second opinion on who has to be woken. The thorough program means the same, but asks everybody.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "grammar/monitor.h"
#include "grammar/program/program.h"

namespace prehend::grammar::testing {

/// The same program, but everybody is woken by everything, nobody waits for others, and nothing is
/// answered by what was measured.
inline std::shared_ptr<const Program> Thorough(const Program& program) {
  const auto thorough = std::make_shared<Program>(program);
  for (Rule& rule : thorough->rules) {
    rule.opened_by = kNone;
    rule.guarded_begin = false;
    rule.measured = {};
    rule.watches_press = rule.watches_grips = ~ThresholdSet{0};
  }
  for (Node& node : thorough->nodes) node.by_threshold = {};
  thorough->asks_touches = thorough->recalls_touches = true;
  thorough->waits = false;
  return thorough;
}

/// Each event in one line, with the tick at which it was decided: "rises 4 -1 [10,20) at 30 style
/// -1".
inline std::vector<std::string> Lines(const std::vector<Event>& events, const Program& program) {
  std::vector<std::string> lines;
  for (const Event& e : events) {
    lines.push_back(program.rules[e.rule].name + " " + std::to_string(e.roles[0]) + " " +
                    std::to_string(e.roles[1]) + " [" + std::to_string(e.interval.begin) + "," +
                    std::to_string(e.interval.end) + ") at " + std::to_string(e.decided) +
                    (e.open_end ? " open" : "") + " style " + std::to_string(e.style));
  }
  return lines;
}

}  // namespace prehend::grammar::testing
