// SPDX-License-Identifier: Apache-2.0
// What is scored: labelled half-open intervals of integer ticks, true and predicted, of one
// episode; all together, and label by label. Tested by
// tests/harness/measure/score/score_metrics_test.cc and tests/harness/measure/score/score_test.cc
#pragma once

#include <string>
#include <vector>

#include "grammar/base/frame.h"
#include "grammar/base/timeline.h"

namespace prehend::measure {

struct Segment {
  std::string label;
  grammar::Interval interval;
};
using Segments = std::vector<Segment>;  ///< in the order of their begins

/// The segments of [0, ticks), true and predicted. What no segment covers is background.
struct Episode {
  grammar::Tick ticks = 0;
  Segments truth;
  Segments prediction;
};

inline grammar::Tick Length(const grammar::Interval& i) { return i.end - i.begin; }
/// Negative if they do not overlap.
inline grammar::Tick Overlap(const grammar::Interval& a, const grammar::Interval& b) {
  return (a.end < b.end ? a.end : b.end) - (a.begin > b.begin ? a.begin : b.begin);
}

/// Boundaries of the partition without its two outer ends; sorted.
std::vector<grammar::Tick> InnerBoundaries(const Segments& segments, grammar::Tick ticks);

/// Labels are events with their roles. Segments of one label do not overlap within a side.
struct LabelledEpisode {
  double ticks_per_second = 480;
  Episode whole;
  std::vector<Episode> by_label;  ///< one for each label of either side, sorted
};
LabelledEpisode Labelled(const grammar::Timeline& truth, const grammar::Timeline& found,
                         grammar::Tick ticks);

}  // namespace prehend::measure
