// SPDX-License-Identifier: Apache-2.0
// The result of a run as text: a table for people, one JSON object for programs.
// Tested by tests/harness/episode/run/run_text_test.cc
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "harness/episode/run/run_scenario.h"

namespace prehend::episode {

using OrderedJson = nlohmann::ordered_json;

/// "completed: 5.1000 s, 2448 ticks", "unfinished: ..", or "failed at 0.5000 s (tick 240): milk:
/// reason; advice".
std::string StatusText(const RunResult& run);

/// The events as an aligned table with a head, then the status line.
std::string RunTable(const RunResult& run);

/// "note: 0.250 s: right_hand: ..." for each note of the run.
std::vector<std::string> NoteLines(const scenario::Scenario& scenario, const RunResult& run);

/// What is said of a run besides what happened in it.
struct RunHeading {
  std::string name, skill = {}, grammar = {};
  std::vector<std::string> notes = {};  ///< NoteLines()
};
RunHeading HeadingOf(const scenario::Scenario& scenario, const RunResult& run);

/// {"scenario", "id", "status", "ticks_per_second", "ticks", "state_hash", "grammar", "events":
/// [..]}. A failed run also has "failure": {"tick", "entity", "reason", "advice"}; a run with
/// outcomes has "outcome"; a run with notes has "notes".
OrderedJson RunJson(const RunHeading& heading, const RunResult& run);

/// "0x" and 16 digits: a JSON number cannot hold 64 bits.
std::string HashText(std::uint64_t hash);

/// Where the time of a run went, its speed against real time, and the peak memory of the process.
struct Measurement {
  RunSeconds seconds;
  double simulated_s = 0;
  std::int64_t peak_memory_kib = 0;
};
Measurement Measure(const RunResult& run);
std::string MeasurementText(const Measurement& measurement);
OrderedJson MeasurementJson(const Measurement& measurement);

}  // namespace prehend::episode
