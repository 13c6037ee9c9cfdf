// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/measure/score/score_metrics_test.cc
#include "harness/measure/score/partition_metrics.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

namespace prehend::measure {
namespace {

using grammar::Interval;
using grammar::Tick;

/// The segments with the background between them, as pieces with the label "".
Segments Partition(const Segments& segments, Tick ticks) {
  Segments pieces;
  Tick covered_to = 0;
  for (const Segment& segment : segments) {
    if (covered_to < segment.interval.begin)
      pieces.push_back({"", {covered_to, segment.interval.begin}});
    pieces.push_back(segment);
    covered_to = segment.interval.end;
  }
  if (covered_to < ticks) pieces.push_back({"", {covered_to, ticks}});
  return pieces;
}

double NearestOf(const std::vector<Tick>& boundaries, Tick tick) {
  Tick nearest = std::abs(boundaries.front() - tick);
  for (const Tick boundary : boundaries) nearest = std::min(nearest, std::abs(boundary - tick));
  return static_cast<double>(nearest);
}

double MedianDistance(const std::vector<Tick>& from, const std::vector<Tick>& to) {
  std::vector<double> distances;
  for (const Tick boundary : from) distances.push_back(NearestOf(to, boundary));
  std::ranges::sort(distances);
  const std::size_t half = distances.size() / 2;
  return distances.size() % 2 == 1 ? distances[half] : (distances[half - 1] + distances[half]) / 2;
}

double PairsIn(Tick frames) {
  return static_cast<double>(frames) * static_cast<double>(frames - 1) / 2;
}

template <class Counts>
double SumOfPairs(const Counts& counts) {
  double pairs = 0;
  for (const auto& [label, frames] : counts) pairs += PairsIn(frames);
  return pairs;
}

/// Frames in the piece of `of` that has most of them, summed over the pieces of `in`.
double Dominated(const Segments& in, const Segments& of) {
  Tick frames = 0;
  for (const Segment& piece : in) {
    Tick most = 0;
    for (const Segment& other : of) most = std::max(most, Overlap(piece.interval, other.interval));
    frames += most;
  }
  return static_cast<double>(frames);
}

}  // namespace

double PrecisionRecall::F1() const {
  return precision + recall > 0 ? 2 * precision * recall / (precision + recall) : 0;
}

std::vector<Tick> InnerBoundaries(const Segments& segments, Tick ticks) {
  std::set<Tick> boundaries;
  for (const Segment& segment : segments)
    boundaries.insert({segment.interval.begin, segment.interval.end});
  boundaries.erase(0);
  boundaries.erase(ticks);
  return {boundaries.begin(), boundaries.end()};
}

std::optional<Deviation> BoundaryDeviation(const Episode& episode) {
  const std::vector<Tick> truth = InnerBoundaries(episode.truth, episode.ticks);
  const std::vector<Tick> predicted = InnerBoundaries(episode.prediction, episode.ticks);
  if (truth.empty() || predicted.empty()) return std::nullopt;
  return Deviation{MedianDistance(truth, predicted), MedianDistance(predicted, truth)};
}

PrecisionRecall PairwiseAgreement(const Episode& episode) {
  std::map<std::string, Tick> truth, predicted;
  std::map<std::pair<std::string, std::string>, Tick> both;
  const Segments pieces = Partition(episode.prediction, episode.ticks);
  for (const Segment& piece : pieces) predicted[piece.label] += Length(piece.interval);
  for (const Segment& one : Partition(episode.truth, episode.ticks)) {
    truth[one.label] += Length(one.interval);
    for (const Segment& piece : pieces)
      both[{one.label, piece.label}] += std::max<Tick>(0, Overlap(one.interval, piece.interval));
  }
  const double matches = SumOfPairs(both), in_truth = SumOfPairs(truth),
               in_prediction = SumOfPairs(predicted);
  return {in_prediction > 0 ? matches / in_prediction : 1, in_truth > 0 ? matches / in_truth : 1};
}

PrecisionRecall PurityAndCoverage(const Episode& episode) {
  if (episode.ticks == 0) return {};
  const Segments truth = Partition(episode.truth, episode.ticks),
                 predicted = Partition(episode.prediction, episode.ticks);
  const auto all = static_cast<double>(episode.ticks);
  return {Dominated(predicted, truth) / all, Dominated(truth, predicted) / all};
}

}  // namespace prehend::measure
