// SPDX-License-Identifier: Apache-2.0
// Four rules of the kind that other monitors are measured with, as a grammar, and the events that
// it recognises in a made-up world. bench/yardsticks/four_automata.h has the same rules by hand.
// Tested by tests/bench/workload_test.cc
#pragma once

#include <cstdint>
#include <memory>

#include "bench/yardsticks/change_log.h"
#include "grammar/monitor.h"

namespace prehend::bench {

/// A grasp; a support of some duration; a touch of some duration without a grasp; a grasped object
/// that leaves its support.
struct FourRules {
  enum Number { kGrasping, kSupported, kUnanswered, kPickingUp, kCount };
  static constexpr double kGripOn = 0.3;  ///< of the commanded grip
  static constexpr int kSides = 2;        ///< sensor sets that touch
  static constexpr double kLevel = 0.5;   ///< cosine between a contact normal and up
  static constexpr int kSupport_ms = 100;
  static constexpr int kUnanswered_ms = 500;
  static constexpr double kRegion_m = 0.09;
};
std::shared_ptr<const grammar::Program> CompileFourRules();

/// The recognised events, independent of their order.
struct Recognised {
  std::uint64_t events = 0;
  std::uint64_t hash = 0;
  void Add(int rule, int hand, int object, grammar::Interval interval);
  friend bool operator==(const Recognised&, const Recognised&) = default;
};

struct Watched {
  Recognised recognised;     ///< all of it
  std::uint64_t events = 0;  ///< of them, those after the warm-up
  double seconds = 0;        ///< for the frames after the warm-up
};

/// Plays a log of bench/yardsticks/worlds.h to a monitor of the four rules. During the first
/// `warm_up` frames, new instances are bound and memory is allocated.
Watched WatchByGrammar(const ChangeLog& log, grammar::Monitor& monitor, std::size_t warm_up = 0);

}  // namespace prehend::bench
