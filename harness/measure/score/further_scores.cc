// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/measure/score/score_test.cc
#include "harness/measure/score/further_scores.h"

#include <cmath>

#include "harness/measure/score/intersection_metrics.h"
#include "harness/measure/score/partition_metrics.h"

namespace prehend::measure {
namespace {

using grammar::Tick;

constexpr double kMicrosPerS = 1e6;

/// A running mean.
class Mean {
 public:
  void Add(double value) {
    sum_ += value;
    ++count_;
  }
  double Or(double of_nothing) const { return count_ > 0 ? sum_ / count_ : of_nothing; }

 private:
  double sum_ = 0;
  int count_ = 0;
};

/// Appends with the ticks as microseconds, since episodes may have different ticks.
void Append(const Segments& segments, double ticks_per_second, Tick begin, Segments& to) {
  const auto micros = [&](Tick tick) {
    return begin + std::llround(static_cast<double>(tick) * kMicrosPerS / ticks_per_second);
  };
  for (const Segment& segment : segments)
    to.push_back({segment.label, {micros(segment.interval.begin), micros(segment.interval.end)}});
}

/// The episodes, concatenated.
Episode Chained(const std::vector<LabelledEpisode>& episodes, double all_s) {
  Episode chain;
  for (const LabelledEpisode& episode : episodes) {
    Append(episode.whole.truth, episode.ticks_per_second, chain.ticks, chain.truth);
    Append(episode.whole.prediction, episode.ticks_per_second, chain.ticks, chain.prediction);
    chain.ticks += std::llround(static_cast<double>(episode.whole.ticks) * kMicrosPerS /
                                episode.ticks_per_second);
  }
  chain.ticks = std::max<Tick>(chain.ticks, std::llround(all_s * kMicrosPerS));
  return chain;
}

}  // namespace

FurtherScores ScoreFurther(const std::vector<LabelledEpisode>& episodes, double collar_s,
                           double all_s) {
  Mean map, pairwise, purity, coverage, from_truth_s, from_found_s;
  FurtherScores scores;
  for (const LabelledEpisode& episode : episodes) {
    const double per_s = episode.ticks_per_second;
    map.Add(MeanAveragePrecision(episode.whole.truth, episode.whole.prediction, 0.5));
    for (const Episode& label : episode.by_label) {
      scores.boundary_hits += BoundaryHits(label, collar_s * per_s);
      pairwise.Add(PairwiseAgreement(label).F1());
      const PrecisionRecall pieces = PurityAndCoverage(label);
      purity.Add(pieces.precision);
      coverage.Add(pieces.recall);
      if (const auto deviation = BoundaryDeviation(label)) {
        from_truth_s.Add(deviation->from_truth / per_s);
        from_found_s.Add(deviation->from_prediction / per_s);
      }
    }
  }
  scores.map_50 = map.Or(1);
  scores.pairwise_f1 = pairwise.Or(1);
  scores.purity = purity.Or(1);
  scores.coverage = coverage.Or(1);
  scores.deviation_from_truth_s = from_truth_s.Or(0);
  scores.deviation_from_found_s = from_found_s.Or(0);
  const IntersectionScore chained = ScoreByIntersection(Chained(episodes, all_s), kMicrosPerS);
  scores.intersection_f1 = chained.macro_f1;
  scores.psds = chained.psds;
  return scores;
}

}  // namespace prehend::measure
