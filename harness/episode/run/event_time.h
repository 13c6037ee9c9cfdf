// SPDX-License-Identifier: Apache-2.0
// A time of an episode as people write it: "reaching.begin", "grasping.end", or in seconds "1.25".
// Tested by tests/harness/episode/run/event_time_test.cc
#pragma once

#include <optional>
#include <string>

#include "grammar/compile/compile.h"
#include "harness/episode/run/run_scenario.h"

namespace prehend::episode {

/// Either seconds or a boundary of an event.
struct EventTime {
  std::optional<double> time_s;
  std::string event;
  bool end = false;  ///< the end of the event, otherwise its begin
};

/// No value if the text is neither seconds nor EVENT.begin nor EVENT.end.
std::optional<EventTime> ParseEventTime(const std::string& text);

/// Why an episode with this grammar cannot have such a time; no value if it can.
struct EventTimeProblem {
  std::string message;
  std::string hint;
};
std::optional<EventTimeProblem> WhyNoEventTime(const std::string& text,
                                               const grammar::Program& program);

/// The tick that the text names; the first such event counts. If it did not happen, or is after the
/// episode, the tick is the end of the run, and `missed` gives the reason.
struct FoundTime {
  grammar::Tick tick = 0;
  std::string missed;
};
FoundTime FindEventTime(const std::string& text, const RunResult& run);

/// First recorded snapshot at or after a tick, else the last one. Something was recorded.
const physics::Snapshot& SnapshotAt(const RunResult& run, grammar::Tick tick);

}  // namespace prehend::episode
