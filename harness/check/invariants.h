// SPDX-License-Identifier: Apache-2.0
// What must hold of every timeline, whatever happened: begin < end, phases that lie inside a grasp
// and cover its unsupported time exactly once, reaches that meet what follows, supports inside
// contacts, bounded latency. A violation is a mistake in a grammar or in the engine. Tested by
// tests/harness/check/invariants_test.cc
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/base/timeline.h"
#include "grammar/describe.h"

namespace prehend::harness {

/// What the checkers must know besides the timeline.
struct EpisodeFacts {
  grammar::Tick end = 0;              ///< first tick that no longer belongs to the episode
  std::set<std::string> movable;      ///< entities that can lose their support
  grammar::Tick ticks_per_frame = 2;  ///< of sensing
  std::map<std::string, grammar::Wait>
      latency;  ///< per event: what its decision may wait for after its end
};

struct Violation {
  std::string_view invariant;  ///< its name in the table
  grammar::Tick tick = 0;      ///< where
  std::string what;            ///< a sentence
};

using Violations = std::vector<Violation>;

struct Invariant {
  std::string_view name;
  std::string_view says;
  void (*check)(const grammar::Timeline& timeline, const EpisodeFacts& facts, std::string_view name,
                Violations& violations);
};

/// All of them.
std::span<const Invariant> Invariants();

/// Runs every checker; violations in the order of the table, then of time.
Violations CheckInvariants(const grammar::Timeline& timeline, const EpisodeFacts& facts);

/// "phases_cover_the_grasp at 1.2000 s: ..."
std::string Text(const Violation& violation, grammar::Tick ticks_per_second);

}  // namespace prehend::harness
