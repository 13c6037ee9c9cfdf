// SPDX-License-Identifier: Apache-2.0
// An explanation as a value: clauses with what was measured, each with what stands behind it.
// Tested by tests/harness/show/explain/explain_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grammar/base/frame.h"

namespace prehend::show {

/// What a comparison or a region saw at one frame, SI units.
struct Reading {
  double value = 0;
  double limit = 0;
  std::string unit;  ///< of both, SI: "m", "m/s"; empty for a plain number
  struct Sample {
    grammar::Tick tick = 0;
    double value = 0, limit = 0;
  };
  std::vector<Sample> course;  ///< around that frame, where it decided something; else empty
};

struct Reason {
  enum class Mark {
    kTurned,  ///< became so at this moment
    kHeld,    ///< was so already
    kFailed,  ///< was not as it had to be
    kNote,    ///< says more about what stands above it
  };
  Mark mark = Mark::kNote;
  std::string what;                   ///< the clause: "grasping(right_hand, milk)"
  std::string how;                    ///< "rose to 31 mm, above 20 mm"
  std::string where;                  ///< of a rule: "pick_and_place.grammar:57"
  std::optional<grammar::Tick> tick;  ///< when
  std::optional<Reading> reading;
  std::vector<Reason> because;
};
using Reasons = std::vector<Reason>;

/// Why an event that happened began, ended, counted and was known as late as it was.
struct WhyEvent {
  std::string event;  ///< "reaching(right_hand, milk)"
  std::string where;
  grammar::Interval interval;
  grammar::Tick decided = 0;
  bool open_end = false;
  Reasons began;
  Reasons ended;
  Reasons counted;
  Reasons waited;
};

/// Why an event that was expected did not happen.
struct WhyMissing {
  std::string event;
  std::string where;
  std::optional<grammar::Tick> expected_at;
  std::string because;  ///< the first clause that failed, in one sentence
  Reasons reasons;
  std::vector<WhyEvent>
      nearest;  ///< of the same name and entities, at other times; without reasons
};

}  // namespace prehend::show
