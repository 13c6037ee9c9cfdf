// SPDX-License-Identifier: Apache-2.0
// The charts of the report page: a comparison with its golden, and the signals that decided. Tested
// by tests/harness/suite/report/charts_test.cc
#pragma once

#include <pugixml.hpp>
#include <string>

#include "harness/suite/check/explained.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/timeline/event_drawings.h"

namespace prehend::suite {

/// One row per event and roles, with the interval of the golden above the recognised one, as an
/// <svg> element. `end` is the episode's end in the comparison's ticks. Without a golden nothing
/// differs.
std::string TimelineSvg(const truth::Comparison& comparison, grammar::Tick end,
                        const truth::EventDrawings& drawings, bool has_golden = true);

/// A signal over time: its value, its limit, and when the one crossed the other, as an <svg>
/// element. The signal has at least one sample.
std::string SignalSvg(const DecidingSignal& signal, grammar::Tick ticks_per_second);

/// Adds an explanation for each difference, the first one unfolded, with its signals; and as data
/// what turned at each boundary, which the page's script shows at the cursor.
void AddExplanations(pugi::xml_node section, const Explained& explained,
                     grammar::Tick ticks_per_second);

}  // namespace prehend::suite
