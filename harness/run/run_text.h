// SPDX-License-Identifier: Apache-2.0
// A run for people (a table) and for programs (one JSON object).
// Tested by tests/harness/run/run_text_test.cc
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "harness/run/run_scenario.h"

namespace prehend::harness {

using OrderedJson = nlohmann::ordered_json;

/// "completed at 5.1000 s (2448 ticks)", or "failed at ...: milk: reason (advice)".
std::string StatusText(const RunResult& run);

/// The events as an aligned table with a title, then the status line.
std::string RunTable(const RunResult& run);

/// "note: 0.250 s: right_hand: ..." for each note of the run.
std::vector<std::string> NoteLines(const Scenario& scenario, const RunResult& run);

/// {"scenario", "status", "ticks_per_second", "ticks", "state_hash", "grammar", "events": [...]}; a
/// failed run has "failure": {"tick", "entity", "reason", "advice"}, a judged one "outcome", one
/// with notes "notes".
OrderedJson RunJson(const Scenario& scenario, const RunResult& run);

/// "0x" and 16 digits: 64 bits don't fit into a JSON number.
std::string HashText(std::uint64_t hash);

/// Shares of time, times real time, and the process's peak memory, as text and as JSON.
struct Measurement {
  RunSeconds seconds;
  double simulated_s = 0;
  std::int64_t peak_memory_kib = 0;
};
Measurement Measure(const RunResult& run);
std::string MeasurementText(const Measurement& measurement);
OrderedJson MeasurementJson(const Measurement& measurement);

}  // namespace prehend::harness
