// SPDX-License-Identifier: Apache-2.0
// The scores of the literature that do not stand in the table, over the episodes in which an event
// happened or was said to. Labels are events with their roles; each is scored alone, because events
// of different labels overlap. Tested by tests/harness/score/score_test.cc
#pragma once

#include <vector>

#include "harness/score/labelled.h"
#include "harness/score/overlap_metrics.h"

namespace prehend::harness::score {

struct FurtherScores {
  double map_50 = 1;   ///< mean over the episodes of the mean average precision at IoU 0.5
  Hits boundary_hits;  ///< boundaries within the collar, pooled
  /// Means over the labels of the episodes.
  double pairwise_f1 = 1, purity = 1, coverage = 1;
  /// Of a label's boundaries to the nearest of the other side, median, mean over the labels that
  /// have both; seconds.
  double deviation_from_truth_s = 0, deviation_from_found_s = 0;
  /// All episodes one after the other.
  double intersection_f1 = 1, psds = 1;
};

/// `all_s`: how long all episodes last, those in which nothing of the kind happened, too.
FurtherScores ScoreFurther(const std::vector<LabelledEpisode>& episodes, double collar_s,
                           double all_s);

}  // namespace prehend::harness::score
