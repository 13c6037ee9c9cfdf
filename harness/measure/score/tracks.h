// SPDX-License-Identifier: Apache-2.0
// Sequences of events without overlaps: what an edit score is about. Tested by
// tests/harness/measure/score/tracks_test.cc
#pragma once

#include <vector>

#include "harness/measure/score/overlap_metrics.h"

namespace prehend::measure {

/// The events of one hand, or of those without a hand the events with the same roles, as far as
/// they overlap on neither side: labels, by the alphabet, each in the first track in which it
/// overlaps no other one.
std::vector<Episode> TracksOf(const grammar::Timeline& truth, const grammar::Timeline& found,
                              grammar::Tick ticks);

/// Mean edit score of tracks; 100 if there are none.
class EditOfTracks {
 public:
  void Add(const std::vector<Episode>& tracks);
  double Mean() const { return tracks_ > 0 ? sum_ / tracks_ : 100; }

 private:
  double sum_ = 0;
  int tracks_ = 0;
};

}  // namespace prehend::measure
