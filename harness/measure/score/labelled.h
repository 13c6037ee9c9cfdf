// SPDX-License-Identifier: Apache-2.0
// Timelines as labelled segments: all together, and label by label.
// Tested by tests/harness/measure/score/score_test.cc
#pragma once

#include <vector>

#include "grammar/base/timeline.h"
#include "harness/measure/score/segments.h"

namespace prehend::measure {

/// Labels are events with their roles. Segments of one label do not overlap within a side.
struct LabelledEpisode {
  double ticks_per_second = 480;
  Episode whole;
  std::vector<Episode> by_label;  ///< one for each label of either side, sorted
};
LabelledEpisode Labelled(const grammar::Timeline& truth, const grammar::Timeline& found,
                         grammar::Tick ticks);

std::vector<grammar::Interval> IntervalsOf(const Segments& segments);

}  // namespace prehend::measure
