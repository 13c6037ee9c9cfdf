// SPDX-License-Identifier: Apache-2.0
// Intervals of frames and what can be done with them. Tested by
// tests/harness/truth/oracle/oracle_test.cc
#pragma once

#include <algorithm>
#include <vector>

#include "grammar/base/frame.h"

namespace prehend::truth {

/// Half-open, indices into the recording. `end` may be the number of frames: then it never ended.
struct Span {
  int begin = 0;
  int end = 0;
  bool empty() const { return begin >= end; }
  bool Contains(int frame) const { return begin <= frame && frame < end; }
};
using Spans = std::vector<Span>;  ///< sorted, disjoint, none empty

inline Span Common(Span a, Span b) { return {std::max(a.begin, b.begin), std::min(a.end, b.end)}; }

/// Whether one of the spans contains the frame.
bool Covers(const Spans& spans, int frame);

/// The parts of the spans that lie in `window`.
Spans Within(const Spans& spans, Span window);

/// What the spans leave uncovered of `window`.
Spans Rest(const Spans& spans, Span window);

/// Everything that is covered by one or the other.
Spans Union(const Spans& a, const Spans& b);

/// Maximal intervals of true frames.
Spans WhereTrue(const std::vector<bool>& flags);

/// Joins spans whose gap lasts `ticks` or less; `frame_ticks[i]` is the tick of frame i.
Spans Bridged(const Spans& spans, const std::vector<grammar::Tick>& frame_ticks, double ticks);

}  // namespace prehend::truth
