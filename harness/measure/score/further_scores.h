// SPDX-License-Identifier: Apache-2.0
// Scores from the literature that are not in the table: of the partition of an episode into
// labelled segments and background (where its boundaries are, which frames belong together), and by
// how much of an event is covered. Segments must not overlap within a side. Tested by
// tests/harness/measure/score/score_metrics_test.cc against printouts of the reference programs.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "harness/measure/score/overlap_metrics.h"
#include "harness/truth/claims/judge_claims.h"

namespace prehend::measure {

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

/// A fragmented event still counts (Bilen et al. 2020, "A framework for the robust evaluation of
/// sound event detection"; psds_eval with 50 % for detections and for true events, and at most 100
/// false predictions an hour).
struct IntersectionScore {
  double macro_f1 = 1;  ///< mean F1 over the labels of the truth
  /// Mean over the labels of the truth of the share of events that are found, times how far the
  /// label is from having too many false predictions: the area under the polyphonic ROC of a
  /// recogniser with one operating point.
  double psds = 1;
};

/// Without truth both are 1 if nothing is predicted, either, else 0. Predictions whose label the
/// truth does not have are ignored (psds_eval refuses them).
IntersectionScore ScoreByIntersection(const Episode& episode, double ticks_per_second);

/// All of them, over the episodes in which an event is true or found. Labels are events with their
/// roles; each label is scored alone, because events of different labels overlap.
struct FurtherScores {
  double map_50 = 1;   ///< mean average precision at IoU 0.5
  Hits boundary_hits;  ///< boundaries within the collar, pooled
  /// Means over the labels of the episodes.
  double pairwise_f1 = 1, purity = 1, coverage = 1;
  /// Distance of a label's boundaries to the nearest one of the other side, in seconds: the median,
  /// averaged over the labels that both sides have; no numbers if there are none.
  double deviation_from_truth_s = 0, deviation_from_found_s = 0;
  /// Of all episodes, concatenated.
  double intersection_f1 = 1, psds = 1;
};

/// `all_s`: the length of all episodes together, also of those without such events.
FurtherScores ScoreFurther(const std::vector<LabelledEpisode>& episodes, double collar_s,
                           double all_s);

// What each evaluator says of a grammar: the definitions with their bands, and others that share
// nothing with them. Tested by tests/harness/measure/score/evaluators_test.cc

/// Of things that an evaluator can judge, how many it confirms.
struct Confirmed {
  int of = 0, confirmed = 0;
  Confirmed& operator+=(const Confirmed& more);
};

/// What an evaluator says of one grammar.
struct Evaluation {
  std::map<std::string, Confirmed> by_event;
  std::vector<std::string> differences;  ///< a line each, with both times
  Confirmed Total() const;
  Evaluation& operator+=(const Evaluation& more);
};

/// Events with both boundaries between the earliest and the latest that the definitions allow, give
/// or take `tolerance` (ticks), of all events that are recognised or missing. `scenario` is named
/// in the differences.
Evaluation ByDefinitions(const std::string& scenario, std::span<const grammar::Timeline> possible,
                         const grammar::Timeline& found, grammar::Tick tolerance);

/// Claims that hold, of those that the grammar's events can decide.
Evaluation ByClaims(const std::string& scenario, std::span<const truth::ClaimVerdict> verdicts);

/// One evaluator and what it says of each grammar.
struct Evaluator {
  std::string name;    ///< "definitions"
  std::string proves;  ///< one sentence
  std::vector<Evaluation> of_grammars;
};

/// A Markdown table: a row per evaluator, a column per grammar.
std::string EvaluatorTable(const std::vector<std::string>& grammars,
                           const std::vector<Evaluator>& evaluators);

}  // namespace prehend::measure
