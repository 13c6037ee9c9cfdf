// SPDX-License-Identifier: Apache-2.0
// The rules, the made-up worlds and the yardstick of the speed figures: four rules of the kind that
// other monitors are measured with, as a grammar and as the automata that a careful programmer
// would write by hand. Tested by tests/harness/speed/workload_test.cc
#pragma once

#include <cstdint>
#include <memory>

#include "grammar/monitor.h"
#include "harness/speed/change_log.h"

namespace prehend::harness {

/// grasping; supported, for 0.1 s; unanswered: touched, and no grasp within 0.5 s; picking_up.
inline constexpr int kFourRules = 4;
std::shared_ptr<const grammar::Program> CompileFourRules();

/// At 240 frames per second, `objects` objects on a table, each with a hand of its own that takes
/// it up and puts it down again once in `period_s`; in between both rest. Entities: hands, objects,
/// the table.
ChangeLog MakeStations(int objects, int frames, double period_s, std::uint64_t seed = 1);

/// Touches that flicker, `per_frame` a frame, one object after the other.
enum class Flicker {
  kPressure,  ///< from one sensor set to another one: no rule can tell
  kFact,      ///< from one sensor set to two and back, by a hand that is open: `sensor_sets >= 2`
              ///< changes, nothing begins
  kGrasp,     ///< likewise, by a hand that is closed: each is the begin or the end of a grasp
};
ChangeLog MakeFlicker(int objects, int frames, int per_frame, Flicker flicker);

/// What was recognised: order does not matter, everything else does.
struct Recognised {
  std::uint64_t events = 0;
  std::uint64_t hash = 0;
  void Add(int rule, int hand, int object, grammar::Interval interval);
  friend bool operator==(const Recognised&, const Recognised&) = default;
};

struct Watched {
  Recognised recognised;     ///< all of it
  std::uint64_t events = 0;  ///< among them, those after the warm-up
  double seconds = 0;        ///< that the frames after the warm-up took
};

/// Plays the log to a monitor, or to the automata by hand, which look at each object in each frame.
/// The first frames are `warm_up`: what is new is bound, and memory is taken.
Watched WatchByGrammar(const ChangeLog& log, grammar::Monitor& monitor, std::size_t warm_up = 0);
Watched WatchByHand(const ChangeLog& log, std::size_t warm_up = 0);

}  // namespace prehend::harness
