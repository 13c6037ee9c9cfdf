// SPDX-License-Identifier: Apache-2.0
// What the report says about the events of a run that did not pass: which clause turned at each
// boundary, and why what differs is as it is, with the signals that decided. Tested by
// tests/harness/suite/check/explained_test.cc
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "grammar/monitor.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/truth/golden/compare.h"

namespace prehend::suite {

struct ExplainedEvent {
  std::string event;  ///< "reaching(right_hand, milk)"
  grammar::Tick begin = 0, end = 0;
  std::string began, ended;  ///< "in_sphere(..) fell to 198 mm from the centre, within 200 mm"
};

/// What a comparison or a region saw around the frame at which it decided, SI units.
struct DecidingSignal {
  std::string clause, how, unit;
  grammar::Tick tick = 0;
  grammar::Tick golden_tick = -1;  ///< when the golden has the boundary that it decided; -1: then
  std::vector<grammar::Tick> ticks;
  std::vector<double> values, limits;  ///< one for each of `ticks`
};

struct ExplainedDifference {
  std::string what;  ///< "shifted reaching(right_hand, milk)"
  std::string text;  ///< as `prehend explain` answers
  std::vector<DecidingSignal> signals;
};

struct Explained {
  std::vector<ExplainedEvent> events;            ///< in the order of time
  std::vector<ExplainedDifference> differences;  ///< of the first kMostExplained
};

inline constexpr std::size_t kMostExplained = 12;
inline constexpr std::size_t kMostSignals = 4;  ///< of one difference

/// Of a run with its recording. Empty if it is too long to be explained.
Explained Explain(const scenario::Scenario& scenario, const episode::RunResult& run,
                  std::shared_ptr<const grammar::Program> program,
                  const truth::Comparison& comparison);

void to_json(nlohmann::json& packed, const Explained& explained);
void from_json(const nlohmann::json& packed, Explained& explained);

}  // namespace prehend::suite
