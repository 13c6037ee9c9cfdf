// SPDX-License-Identifier: Apache-2.0
// Scores from the literature that are not in the table, over the episodes in which an event is true
// or found. Labels are events with their roles; each label is scored alone, because events of
// different labels overlap. Tested by tests/harness/measure/score/score_test.cc
#pragma once

#include <vector>

#include "harness/measure/score/labelled.h"
#include "harness/measure/score/overlap_metrics.h"

namespace prehend::measure {

struct FurtherScores {
  double map_50 = 1;   ///< mean over the episodes of the mean average precision at IoU 0.5
  Hits boundary_hits;  ///< boundaries within the collar, pooled
  /// Means over the labels of the episodes.
  double pairwise_f1 = 1, purity = 1, coverage = 1;
  /// Distance of a label's boundaries to the nearest one of the other side, in seconds: the median,
  /// averaged over the labels that both sides have.
  double deviation_from_truth_s = 0, deviation_from_found_s = 0;
  /// Of all episodes, concatenated.
  double intersection_f1 = 1, psds = 1;
};

/// `all_s`: the length of all episodes together, also of those without such events.
FurtherScores ScoreFurther(const std::vector<LabelledEpisode>& episodes, double collar_s,
                           double all_s);

}  // namespace prehend::measure
