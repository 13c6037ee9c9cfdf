// SPDX-License-Identifier: Apache-2.0
// Answers of `prehend explain`, as values, as text and as JSON. Tested by
// tests/harness/show/explain/explain_test.cc
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "grammar/replay_monitor.h"
#include "harness/show/explain/clauses.h"
#include "harness/show/explain/query.h"

namespace prehend::show {

/// Every event of the episode in the order of time, with what turned at its boundaries.
std::vector<WhyEvent> ExplainAll(grammar::ReplayMonitor& past);
/// The intervals that are asked for, in the order of time: those that contain its moment, if it has
/// one.
std::vector<WhyEvent> ExplainEvents(grammar::ReplayMonitor& past, const Ask& ask);
/// The intervals of the asked name and entities that are nearest to its moment, at most three;
/// without reasons.
std::vector<WhyEvent> NearestEvents(grammar::ReplayMonitor& past, const Ask& ask);
/// Why there is none.
WhyMissing ExplainMissing(grammar::ReplayMonitor& past, const Ask& ask);

std::string Text(const WhyEvent& why, grammar::Tick ticks_per_second);
std::string Text(const WhyMissing& why, grammar::Tick ticks_per_second);
/// The clause that turned first, in one line; or "".
std::string InOneLine(const Reasons& reasons);
/// One line per event.
std::string Table(const std::vector<WhyEvent>& events, grammar::Tick ticks_per_second);

nlohmann::ordered_json ToJson(const WhyEvent& why, grammar::Tick ticks_per_second);
nlohmann::ordered_json ToJson(const WhyMissing& why, grammar::Tick ticks_per_second);

}  // namespace prehend::show
