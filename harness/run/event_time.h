// SPDX-License-Identifier: Apache-2.0
// A moment of an episode as people write it: "reaching.begin", "grasping.end", or seconds: "1.25".
// Tested by tests/harness/run/event_time_test.cc
#pragma once

#include <optional>
#include <string>

#include "grammar/compile/compile.h"
#include "harness/run/run_scenario.h"

namespace prehend::harness {

/// Either a time or an event's boundary.
struct EventTime {
  std::optional<double> time_s;
  std::string event;
  bool end = false;  ///< the event's end, not its begin
};

/// Nothing when the text is neither a time nor EVENT.begin nor EVENT.end.
std::optional<EventTime> ParseEventTime(const std::string& text);

/// What is wrong with asking for this moment of an episode that this grammar watches.
struct EventTimeProblem {
  std::string message;
  std::string hint;
};
std::optional<EventTimeProblem> WhyNoEventTime(const std::string& text,
                                               const grammar::Program& program);

/// The tick that the text names; the first such event counts. When it did not happen, or is later
/// than the episode, the end of the run, and `missed` says why.
struct FoundTime {
  grammar::Tick tick = 0;
  std::string missed;
};
FoundTime FindEventTime(const std::string& text, const RunResult& run);

}  // namespace prehend::harness
