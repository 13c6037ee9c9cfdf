// SPDX-License-Identifier: Apache-2.0
// A comparison as a picture for web pages: one row per event and roles, with the interval of the
// golden above the recognised one. Tested by tests/harness/report/report_test.cc
#pragma once

#include <string>

#include "harness/golden/compare.h"
#include "harness/timeline/event_drawings.h"

namespace prehend::harness {

/// An <svg> element. `end` is the episode's end in the comparison's ticks. Without a golden nothing
/// differs.
std::string TimelineSvg(const Comparison& comparison, grammar::Tick end,
                        const EventDrawings& drawings, bool has_golden = true);

}  // namespace prehend::harness
