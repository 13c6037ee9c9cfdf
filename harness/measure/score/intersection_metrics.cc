// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/measure/score/score_metrics_test.cc
#include "harness/measure/score/intersection_metrics.h"

#include <algorithm>
#include <set>

namespace prehend::measure {
namespace {

using grammar::Tick;

/// How much of `one` the segments with its label cover.
double Covered(const Segment& one, const Segments& by) {
  Tick ticks = 0;
  for (const Segment& other : by)
    if (other.label == one.label) ticks += std::max<Tick>(0, Overlap(one.interval, other.interval));
  return static_cast<double>(ticks) / static_cast<double>(Length(one.interval));
}

struct LabelCounts {
  double truths = 0, found = 0, false_predictions = 0;
};

LabelCounts Count(const Episode& episode, const std::string& label,
                  const IntersectionSettings& settings) {
  LabelCounts counts;
  Segments believed;
  for (const Segment& predicted : episode.prediction) {
    if (predicted.label != label) continue;
    if (Covered(predicted, episode.truth) >= settings.detection_covered)
      believed.push_back(predicted);
    else
      ++counts.false_predictions;
  }
  for (const Segment& one : episode.truth) {
    if (one.label != label) continue;
    ++counts.truths;
    counts.found += Covered(one, believed) >= settings.truth_covered;
  }
  return counts;
}

}  // namespace

IntersectionScore ScoreByIntersection(const Episode& episode, double ticks_per_second,
                                      const IntersectionSettings& settings) {
  std::set<std::string> labels;
  for (const Segment& one : episode.truth) labels.insert(one.label);
  if (labels.empty()) return {};
  const double hours = static_cast<double>(episode.ticks) / ticks_per_second / 3600;
  IntersectionScore sum{0, 0};
  for (const std::string& label : labels) {
    const LabelCounts counts = Count(episode, label, settings);
    const double missed = counts.truths - counts.found;
    sum.macro_f1 += 2 * counts.found / (2 * counts.found + counts.false_predictions + missed);
    const double false_share = counts.false_predictions / hours / settings.most_false_per_hour;
    sum.psds += counts.found / counts.truths * std::max(0.0, 1 - false_share);
  }
  const auto count = static_cast<double>(labels.size());
  return {sum.macro_f1 / count, sum.psds / count};
}

}  // namespace prehend::measure
