// SPDX-License-Identifier: Apache-2.0
// The error classes of Ward, Lukowicz & Gellersen 2011, "Performance metrics for activity
// recognition", section 4. One kind of event at a time: the intervals in which it was true, and
// those in which it was recognised. Tested by tests/harness/measure/score/score_metrics_test.cc
#pragma once

#include <vector>

#include "grammar/base/frame.h"

namespace prehend::measure {

/// Ticks by their error class.
struct WardTicks {
  grammar::Tick correct = 0;
  grammar::Tick inserted = 0;  ///< recognised, belongs to no true interval
  grammar::Tick merged =
      0;  ///< recognised, between two true intervals that one recognised interval covers
  grammar::Tick overfilled_begin = 0;  ///< recognised before the true begin
  grammar::Tick overfilled_end = 0;    ///< recognised after the true end
  grammar::Tick deleted = 0;           ///< true, never recognised
  grammar::Tick fragmented = 0;        ///< true, between two recognised pieces
  grammar::Tick underfilled_begin = 0;
  grammar::Tick underfilled_end = 0;

  WardTicks& operator+=(const WardTicks& other);
};

/// Intervals by their class.
struct WardEvents {
  // Of the truth.
  int correct = 0;
  int deleted = 0;
  int fragmented = 0;
  int merged = 0;
  int fragmented_and_merged = 0;
  // Of what was recognised.
  int said_correct = 0;
  int inserted = 0;
  int fragmenting = 0;
  int merging = 0;
  int fragmenting_and_merging = 0;

  WardEvents& operator+=(const WardEvents& other);
  int Truths() const { return correct + deleted + fragmented + merged + fragmented_and_merged; }
  int Said() const {
    return said_correct + inserted + fragmenting + merging + fragmenting_and_merging;
  }
};

struct Ward {
  WardTicks ticks;
  WardEvents events;
};

/// Both sides in the order of time, without overlaps within a side.
Ward CompareByWard(const std::vector<grammar::Interval>& truth,
                   const std::vector<grammar::Interval>& said);

}  // namespace prehend::measure
