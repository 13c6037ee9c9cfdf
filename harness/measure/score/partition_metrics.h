// SPDX-License-Identifier: Apache-2.0
// Scores of the partition of an episode into labelled segments and background: where its boundaries
// are, and which frames belong together. Segments must not overlap within a side. Tested by
// tests/harness/measure/score/score_metrics_test.cc against printouts of the reference programs.
#pragma once

#include <optional>
#include <vector>

#include "harness/measure/score/segments.h"

namespace prehend::measure {

/// Boundaries of the partition without its two outer ends; sorted.
std::vector<grammar::Tick> InnerBoundaries(const Segments& segments, grammar::Tick ticks);

/// Median distance, in ticks, from a boundary of one side to the nearest of the other
/// (mir_eval.segment.deviation, trimmed). No value if one side has none.
struct Deviation {
  double from_truth = 0, from_prediction = 0;
};
std::optional<Deviation> BoundaryDeviation(const Episode& episode);

struct PrecisionRecall {
  double precision = 1, recall = 1;
  double F1() const;  ///< 0 when both are 0
};

/// Of all pairs of frames that the prediction gives the same label, the share for which the truth
/// does, and the other way round (Levy & Sandler 2008; mir_eval.segment.pairwise at one frame per
/// tick). Background is a label. 1 without pairs.
PrecisionRecall PairwiseAgreement(const Episode& episode);

/// Precision: purity, the share of frames in the piece of the truth that dominates their predicted
/// piece. Recall: coverage, the same with the sides exchanged (Bredin 2017, pyannote.metrics).
/// Pieces of background count.
PrecisionRecall PurityAndCoverage(const Episode& episode);

}  // namespace prehend::measure
