// SPDX-License-Identifier: Apache-2.0
// The charts of the report page: a comparison with its golden, and the signals that decided. Tested
// by tests/harness/report/charts_test.cc
#pragma once

#include <string>

#include "harness/check/explained.h"
#include "harness/golden/compare.h"
#include "harness/timeline/event_drawings.h"

namespace prehend::harness {

/// One row per event and roles, with the interval of the golden above the recognised one, as an
/// <svg> element. `end` is the episode's end in the comparison's ticks. Without a golden nothing
/// differs.
std::string TimelineSvg(const Comparison& comparison, grammar::Tick end,
                        const EventDrawings& drawings, bool has_golden = true);

/// A signal over time: its value, its limit, and when the one crossed the other, as an <svg>
/// element. The signal has at least one sample.
std::string SignalSvg(const DecidingSignal& signal, grammar::Tick ticks_per_second);

}  // namespace prehend::harness
