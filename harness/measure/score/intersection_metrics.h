// SPDX-License-Identifier: Apache-2.0
// Scores by how much of an event is covered; a fragmented event still counts (Bilen et al.
// 2020, "A framework for the robust evaluation of sound event detection"; psds_eval). Tested by
// tests/harness/measure/score/score_metrics_test.cc against printouts of the reference program.
#pragma once

#include "harness/measure/score/segments.h"

namespace prehend::measure {

struct IntersectionSettings {
  double detection_covered =
      0.5;  ///< share of a prediction that must lie in true events of its label (DTC)
  double truth_covered = 0.5;  ///< share of a true event that such predictions must cover (GTC)
  double most_false_per_hour = 100;  ///< a label with so many false predictions scores 0
};

struct IntersectionScore {
  double macro_f1 = 1;  ///< mean F1 over the labels of the truth
  /// Mean over the labels of the truth of the share of events that are found, times how far the
  /// label is from `most_false_per_hour`: the area under the polyphonic ROC of a recogniser with
  /// one operating point.
  double psds = 1;
};

/// Both are 1 without truth. Predictions whose label the truth does not have are ignored (psds_eval
/// refuses them).
IntersectionScore ScoreByIntersection(const Episode& episode, double ticks_per_second,
                                      const IntersectionSettings& settings = {});

}  // namespace prehend::measure
