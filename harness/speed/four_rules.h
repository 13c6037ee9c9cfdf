// SPDX-License-Identifier: Apache-2.0
// The rules, the made-up worlds and the yardstick of the speed figures: four rules of the kind that other monitors are
// measured with, as a grammar and as the automata that a careful programmer would write by hand.
// Tested by tests/harness/speed_test.cc
#pragma once

#include <cstdint>
#include <memory>

#include "grammar/monitor.h"
#include "harness/speed/change_log.h"

namespace prehend::harness {

/// grasping; supported, for 0.1 s; unanswered: touched, and no grasp within 0.5 s; picking_up.
inline constexpr int kFourRules = 4;
std::shared_ptr<const grammar::Program> CompileFourRules();

/// At 240 frames per second, `objects` objects on a table, each with a hand of its own that takes it up and puts it
/// down again once in `period_s`; in between both rest. Entities: hands, objects, the table.
ChangeLog MakeStations(int objects, int frames, double period_s, std::uint64_t seed = 1);

/// Touches that flicker, `per_frame` a frame: with every flicker a grasp begins or ends, or none ever does.
ChangeLog MakeFlicker(int objects, int frames, int per_frame, bool grasps);

/// What was recognised: order does not matter, everything else does.
struct Recognised {
  std::uint64_t events = 0;
  std::uint64_t hash = 0;
  void Add(int rule, int hand, int object, grammar::Interval interval);
  friend bool operator==(const Recognised&, const Recognised&) = default;
};

/// Plays the log to a monitor, or to the automata by hand, which look at each object in each frame.
Recognised WatchByGrammar(const ChangeLog& log, grammar::Monitor& monitor);
Recognised WatchByHand(const ChangeLog& log);

}  // namespace prehend::harness
