// SPDX-License-Identifier: Apache-2.0
// What is scored: labelled half-open intervals of integer ticks, the truth's and the prediction's,
// of one episode.
#pragma once

#include <string>
#include <vector>

#include "grammar/base/frame.h"

namespace prehend::harness::score {

struct Segment {
  std::string label;
  grammar::Interval interval;
};
using Segments = std::vector<Segment>;  ///< in the order of their begins

/// [0, ticks) with two opinions about it. What no segment covers is background.
struct Episode {
  grammar::Tick ticks = 0;
  Segments truth;
  Segments prediction;
};

inline grammar::Tick Length(const grammar::Interval& i) { return i.end - i.begin; }
/// Negative when they lie apart.
inline grammar::Tick Overlap(const grammar::Interval& a, const grammar::Interval& b) {
  return (a.end < b.end ? a.end : b.end) - (a.begin > b.begin ? a.begin : b.begin);
}

}  // namespace prehend::harness::score
