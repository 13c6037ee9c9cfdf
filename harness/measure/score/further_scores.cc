// SPDX-License-Identifier: Apache-2.0
#include "harness/measure/score/further_scores.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "harness/base/base/median.h"
#include "harness/truth/timeline/event_text.h"
#include "harness/truth/timeline/match_events.h"

namespace prehend::measure {
namespace {

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
  return Median(std::move(distances));
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

constexpr double kCovered = 0.5;  ///< of a prediction by true events, and of these by predictions
constexpr double kMostFalsePerHour = 100;

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

LabelCounts Count(const Episode& episode, const std::string& label) {
  LabelCounts counts;
  Segments believed;
  for (const Segment& predicted : episode.prediction) {
    if (predicted.label != label) continue;
    if (Covered(predicted, episode.truth) >= kCovered)
      believed.push_back(predicted);
    else
      ++counts.false_predictions;
  }
  for (const Segment& one : episode.truth) {
    if (one.label != label) continue;
    ++counts.truths;
    counts.found += Covered(one, believed) >= kCovered;
  }
  return counts;
}

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

double PrecisionRecall::F1() const {
  return precision + recall > 0 ? 2 * precision * recall / (precision + recall) : 0;
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

IntersectionScore ScoreByIntersection(const Episode& episode, double ticks_per_second) {
  std::set<std::string> labels;
  for (const Segment& one : episode.truth) labels.insert(one.label);
  if (labels.empty())
    return episode.prediction.empty() ? IntersectionScore{} : IntersectionScore{0, 0};
  const double hours = static_cast<double>(episode.ticks) / ticks_per_second / 3600;
  IntersectionScore sum{0, 0};
  for (const std::string& label : labels) {
    const LabelCounts counts = Count(episode, label);
    const double missed = counts.truths - counts.found;
    sum.macro_f1 += 2 * counts.found / (2 * counts.found + counts.false_predictions + missed);
    const double false_share = counts.false_predictions / hours / kMostFalsePerHour;
    sum.psds += counts.found / counts.truths * std::max(0.0, 1 - false_share);
  }
  const auto count = static_cast<double>(labels.size());
  return {sum.macro_f1 / count, sum.psds / count};
}

FurtherScores ScoreFurther(const std::vector<LabelledEpisode>& episodes, double collar_s,
                           double all_s) {
  Mean pairwise, purity, coverage, from_truth_s, from_found_s;
  FurtherScores scores;
  for (const LabelledEpisode& episode : episodes) {
    const double per_s = episode.ticks_per_second;
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
  scores.map_50 = MeanAveragePrecision(episodes, 0.5);
  scores.pairwise_f1 = pairwise.Or(1);
  scores.purity = purity.Or(1);
  scores.coverage = coverage.Or(1);
  scores.deviation_from_truth_s = from_truth_s.Or(NAN);
  scores.deviation_from_found_s = from_found_s.Or(NAN);
  const IntersectionScore chained = ScoreByIntersection(Chained(episodes, all_s), kMicrosPerS);
  scores.intersection_f1 = chained.macro_f1;
  scores.psds = chained.psds;
  return scores;
}

Confirmed& Confirmed::operator+=(const Confirmed& more) {
  of += more.of;
  confirmed += more.confirmed;
  return *this;
}

Confirmed Evaluation::Total() const {
  Confirmed total;
  for (const auto& [event, count] : by_event) total += count;
  return total;
}

Evaluation& Evaluation::operator+=(const Evaluation& more) {
  for (const auto& [event, count] : more.by_event) by_event[event] += count;
  differences.insert(differences.end(), more.differences.begin(), more.differences.end());
  return *this;
}

Evaluation ByDefinitions(const std::string& scenario, std::span<const grammar::Timeline> possible,
                         const grammar::Timeline& found, grammar::Tick tolerance) {
  Evaluation evaluation;
  const auto differs = [&](const std::string& label, const std::string& what) {
    evaluation.differences.push_back(fmt::format("{}  {}  {}", scenario, label, what));
  };
  const auto when = [&](const grammar::NamedEvent& event) {
    return truth::IntervalText(event.interval, found.ticks_per_second);
  };
  for (const truth::LabelAgreement& label : truth::AgreeWithin(possible, found, tolerance).labels) {
    for (const truth::Match& match : label.matches) {
      Confirmed& count = evaluation.by_event[match.found.event];
      ++count.of;
      if (std::max(std::abs(match.begin_offset()), std::abs(match.end_offset())) <= tolerance)
        ++count.confirmed;
      else
        differs(label.label, fmt::format("recognised {}, by the definitions {}", when(match.found),
                                         when(match.truth)));
    }
    for (const grammar::NamedEvent& event : label.extra) {
      ++evaluation.by_event[event.event].of;
      differs(label.label, fmt::format("recognised {}, not by the definitions", when(event)));
    }
    for (const grammar::NamedEvent& event : label.missing) {
      ++evaluation.by_event[event.event].of;
      differs(label.label, fmt::format("not recognised, by the definitions {}", when(event)));
    }
  }
  return evaluation;
}

Evaluation ByClaims(const std::string& scenario, std::span<const truth::ClaimVerdict> verdicts) {
  Evaluation evaluation;
  for (const truth::ClaimVerdict& verdict : verdicts) {
    if (verdict.says == truth::kNotJudged) continue;
    Confirmed& count = evaluation.by_event["claims"];
    ++count.of;
    if (verdict.says == truth::kHolds)
      ++count.confirmed;
    else
      evaluation.differences.push_back(scenario + "  " + Text(verdict));
  }
  return evaluation;
}

std::string EvaluatorTable(const std::vector<std::string>& grammars,
                           const std::vector<Evaluator>& evaluators) {
  std::string text = "| evaluator |", rule = "|---|";
  for (const std::string& grammar : grammars) {
    text += fmt::format(" {} |", grammar);
    rule += "---|";
  }
  text += " what it proves |\n" + rule + "---|\n";
  for (const Evaluator& evaluator : evaluators) {
    text += fmt::format("| {} |", evaluator.name);
    for (const Evaluation& evaluation : evaluator.of_grammars) {
      const Confirmed total = evaluation.Total();
      text += total.of == 0 ? std::string(" - |")
                            : fmt::format(" {} of {} ({:.1f} %) |", total.confirmed, total.of,
                                          100.0 * total.confirmed / total.of);
    }
    text += fmt::format(" {} |\n", evaluator.proves);
  }
  return text;
}

}  // namespace prehend::measure
