// SPDX-License-Identifier: Apache-2.0
// Scores of whole segments and of frames, as the literature on temporal segmentation defines them;
// and the event errors of Ward et al. All are of one episode; counts of several episodes may be
// added (pooled). What is scored: labelled half-open intervals of integer ticks, all together and
// label by label. Tested by tests/harness/measure/score/score_metrics_test.cc against printouts of
// the reference programs.
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

/// Adds these members of `more` to those of `sum`.
template <auto... counts, class T>
T& AddCounts(T& sum, const T& more) {
  ((sum.*counts += more.*counts), ...);
  return sum;
}

struct Hits {
  int correct = 0;  ///< true positives
  int extra = 0;    ///< false positives
  int missed = 0;   ///< false negatives

  Hits& operator+=(const Hits& other) {
    return AddCounts<&Hits::correct, &Hits::extra, &Hits::missed>(*this, other);
  }
  /// 0..1; 1 if there is nothing.
  double Precision() const;
  double Recall() const;
  double F1() const;
};

/// F1@k of Lea et al. 2017, as in ms-tcn: predictions in order of time; the truth of the same label
/// that overlaps best counts if its intersection over union (of the hull) is at least
/// `least_overlap` and it is still free.
Hits HitsByOverlap(const Segments& truth, const Segments& prediction, double least_overlap);

/// Segmental edit score, 0..100: 100 (1 - Levenshtein distance / longer length) of the sequences of
/// labels. Both empty: 100.
double EditScore(const Segments& truth, const Segments& prediction);

/// Mean over the labels that are true in some episode of the average precision at this temporal
/// IoU, of all episodes together (ActivityNet). Events have no confidence, so that none comes
/// before another: precision times recall, the area below a curve of one point. If nothing is true:
/// 1 if nothing is predicted, either, else 0.
double MeanAveragePrecision(const std::vector<LabelledEpisode>& episodes, double least_overlap);

/// Per frame: what the truth says and what is predicted. Segments must not overlap within a side.
struct FrameCounts {
  grammar::Tick equal = 0;  ///< background included
  grammar::Tick all = 0;
  grammar::Tick correct = 0;      ///< the same label, not background
  grammar::Tick confused = 0;     ///< another label
  grammar::Tick missed = 0;       ///< a label in the truth only
  grammar::Tick false_alarm = 0;  ///< a label in the prediction only

  FrameCounts& operator+=(const FrameCounts& other) {
    using F = FrameCounts;
    return AddCounts<&F::equal, &F::all, &F::correct, &F::confused, &F::missed, &F::false_alarm>(
        *this, other);
  }
  grammar::Tick InTruth() const { return correct + confused + missed; }
  /// Mean over frames (MoF), 0..1, with background.
  double Accuracy() const;
  /// Identification error rate; the same as the segment-based error rate on the tick grid.
  double ErrorRate() const;
  /// The same without labels: event or background (pyannote's detection error rate).
  double DetectionErrorRate() const;
  /// F1 of labelled frames.
  double F1() const;
  /// Cohen's kappa of frames with one label or none: agreement beyond chance, at most 1.
  double Kappa() const;
};
/// `collar`: frames nearer than this to a boundary of the truth do not count.
FrameCounts CountFrames(const Episode& episode, grammar::Tick collar = 0);

/// Event-based scores with a collar (Mesaros et al. 2016, sed_eval): label equal, begins at most
/// `collar` apart, ends at most the larger of `collar` and `share` of the true length; the largest
/// matching.
struct EventErrors {
  int truths = 0, predictions = 0, correct = 0, substituted = 0;

  EventErrors& operator+=(const EventErrors& other) {
    using E = EventErrors;
    return AddCounts<&E::truths, &E::predictions, &E::correct, &E::substituted>(*this, other);
  }
  Hits AsHits() const { return {correct, predictions - correct, truths - correct}; }
  int Deleted() const { return truths - correct - substituted; }
  int Inserted() const { return predictions - correct - substituted; }
  double ErrorRate() const;
};
EventErrors MatchWithCollar(const Segments& truth, const Segments& prediction, double collar,
                            double share);

/// Boundaries of the partition (background included, both outer ends left out) hit within a window
/// (<=): the largest matching. As mir_eval.segment.detection, trimmed.
Hits BoundaryHits(const Episode& episode, double window);

/// Frames of one side that the other has not, by why: of a segment that meets none, between two
/// that it meets, before the first and after the last of these.
struct WardFrames {
  double alone = 0, between = 0, before = 0, after = 0;

  void Add(const WardFrames& more, double share);
};

/// True segments by their class; and of what was recognised, what belongs to no true one. The found
/// side has classes, too: a fragmenting one shares its true one with others, a merging one meets
/// several.
struct Ward {
  int correct = 0, deleted = 0, fragmented = 0, merged = 0, fragmented_and_merged = 0;
  int inserted = 0;
  int found_correct = 0, fragmenting = 0, merging = 0, fragmenting_and_merging = 0;
  /// In ticks, after Add() in seconds. Missed: deletion, fragmentation, underfill at begin and end.
  /// False: insertion, merge, overfill at begin and end.
  WardFrames missed, false_alarm;

  void Add(const Ward& other, double ticks_per_second);
};

/// Of one label. Both sides in the order of time, without overlaps within a side.
Ward CompareByWard(const Segments& truth, const Segments& said);

}  // namespace prehend::measure
