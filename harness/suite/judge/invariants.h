// SPDX-License-Identifier: Apache-2.0
// What must hold of every timeline, whatever its events mean: begin < end, inside the episode,
// apart from itself, decided in time. A violation is a mistake in the engine. What must hold of
// certain events is said by the laws of their grammar (grammar/check_laws.h). Tested by
// tests/harness/suite/judge/invariants_test.cc
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/base/timeline.h"
#include "grammar/check_laws.h"
#include "grammar/describe.h"
#include "harness/suite/judge/judge.h"

namespace prehend::suite {

/// What the checkers must know besides the timeline.
struct EpisodeFacts {
  grammar::Tick end = 0;              ///< first tick that no longer belongs to the episode
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

/// "decisions_come_in_time at 1.2000 s: ..."
std::string Text(const Violation& violation, grammar::Tick ticks_per_second);
/// "slides_are_supported at 1.2000..1.3000 s: ..", and a line with the law itself.
std::string Text(const grammar::LawViolation& violation, grammar::Tick ticks_per_second);

Findings JudgeInvariants(const CheckedRun& checked);

Findings JudgeLaws(const CheckedRun& checked);

}  // namespace prehend::suite
