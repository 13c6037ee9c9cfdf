// SPDX-License-Identifier: Apache-2.0
#include "harness/measure/score/overlap_metrics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

namespace prehend::measure {
namespace {

using grammar::Interval;
using grammar::Tick;

double Ratio(double part, double whole, double of_nothing) {
  return whole > 0 ? part / whole : of_nothing;
}

/// Intersection over hull; negative if they do not overlap.
double Closeness(const Interval& a, const Interval& b) {
  const Tick hull = std::max(a.end, b.end) - std::min(a.begin, b.begin);
  return static_cast<double>(Overlap(a, b)) / static_cast<double>(hull);
}

/// Size of the largest matching of `left` with `right` (augmenting paths). partner[i] is the
/// partner of left i, or -1.
int LargestMatching(int left, int right, const std::function<bool(int, int)>& fits,
                    std::vector<int>& partner) {
  std::vector<int> taken_by(static_cast<std::size_t>(right), -1);
  std::vector<bool> tried;
  const std::function<bool(int)> place = [&](int i) {
    for (int j = 0; j < right; ++j) {
      if (tried[j] || !fits(i, j)) continue;
      tried[j] = true;
      if (taken_by[j] >= 0 && !place(taken_by[j])) continue;
      taken_by[j] = i;
      return true;
    }
    return false;
  };
  int size = 0;
  for (int i = 0; i < left; ++i) {
    tried.assign(static_cast<std::size_t>(right), false);
    size += place(i);
  }
  partner.assign(static_cast<std::size_t>(left), -1);
  for (int j = 0; j < right; ++j) {
    if (taken_by[j] >= 0) partner[taken_by[j]] = j;
  }
  return size;
}

const std::string* LabelAt(const Segments& segments, Tick tick) {
  for (const Segment& segment : segments) {
    if (segment.interval.begin <= tick && tick < segment.interval.end) return &segment.label;
  }
  return nullptr;
}

std::ptrdiff_t Meeting(const Segment& one, const Segments& others) {
  return std::ranges::count_if(
      others, [&](const Segment& other) { return Overlap(one.interval, other.interval) > 0; });
}

/// Whether a segment that overlaps `one` also overlaps another one of its side.
bool SharesPartner(const Segment& one, const Segments& others, const Segments& own) {
  return std::ranges::any_of(others, [&](const Segment& other) {
    return Overlap(one.interval, other.interval) > 0 && Meeting(other, own) > 1;
  });
}

/// Of `own` what `others` do not cover.
WardFrames UncoveredOf(const Segments& own, const Segments& others) {
  WardFrames frames;
  for (const Segment& one : own) {
    const Segment* last = nullptr;
    for (const Segment& other : others) {
      if (Overlap(one.interval, other.interval) <= 0) continue;
      const Tick from = last ? last->interval.end : one.interval.begin;
      (last ? frames.between : frames.before) +=
          static_cast<double>(std::max<Tick>(0, other.interval.begin - from));
      last = &other;
    }
    if (last)
      frames.after += static_cast<double>(std::max<Tick>(0, one.interval.end - last->interval.end));
    else
      frames.alone += static_cast<double>(Length(one.interval));
  }
  return frames;
}

/// How many of `own` meet none of `others`, one that meets no other one, ..
struct WardSide {
  int alone = 0, plain = 0, several = 0, shares = 0, both = 0;
};
WardSide SideOf(const Segments& own, const Segments& others) {
  WardSide side;
  for (const Segment& one : own) {
    const auto pieces = Meeting(one, others);
    const bool shares = SharesPartner(one, others, own);
    ++(pieces == 0            ? side.alone
       : pieces > 1 && shares ? side.both
       : pieces > 1           ? side.several
       : shares               ? side.shares
                              : side.plain);
  }
  return side;
}

Segments SegmentsOf(const grammar::Timeline& timeline) {
  Segments segments;
  for (const grammar::NamedEvent& event : timeline.events)
    segments.push_back({event.Label(), event.interval});
  return segments;
}

}  // namespace

double Hits::Precision() const { return Ratio(correct, correct + extra, missed == 0 ? 1 : 0); }
double Hits::Recall() const { return Ratio(correct, correct + missed, extra == 0 ? 1 : 0); }
double Hits::F1() const { return Ratio(2 * correct, 2 * correct + extra + missed, 1); }

Hits HitsByOverlap(const Segments& truth, const Segments& prediction, double least_overlap) {
  Hits hits;
  std::vector<bool> taken(truth.size(), false);
  for (const Segment& predicted : prediction) {
    std::size_t best = truth.size();
    double best_overlap = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (truth[i].label != predicted.label) continue;
      const double overlap = Closeness(truth[i].interval, predicted.interval);
      if (best < truth.size() && overlap <= best_overlap) continue;
      best = i;
      best_overlap = overlap;
    }
    const bool correct = best < truth.size() && best_overlap >= least_overlap && !taken[best];
    if (correct) taken[best] = true;
    ++(correct ? hits.correct : hits.extra);
  }
  hits.missed = static_cast<int>(truth.size()) - hits.correct;
  return hits;
}

double EditScore(const Segments& truth, const Segments& prediction) {
  const std::size_t longer = std::max(truth.size(), prediction.size());
  if (longer == 0) return 100;
  std::vector<int> row(prediction.size() + 1);
  for (std::size_t j = 0; j < row.size(); ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= truth.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j < row.size(); ++j) {
      const int substitute = diagonal + (truth[i - 1].label != prediction[j - 1].label);
      diagonal = row[j];
      row[j] = std::min({substitute, row[j] + 1, row[j - 1] + 1});
    }
  }
  return 100 * (1 - static_cast<double>(row.back()) / static_cast<double>(longer));
}

double MeanAveragePrecision(const std::vector<LabelledEpisode>& episodes, double least_overlap) {
  std::map<std::string, Hits> by_label;
  for (const LabelledEpisode& episode : episodes) {
    for (const Episode& one : episode.by_label) {
      const int truths = static_cast<int>(one.truth.size()),
                found = static_cast<int>(one.prediction.size());
      const auto fits = [&](int i, int j) {
        return Closeness(one.truth[i].interval, one.prediction[j].interval) >= least_overlap;
      };
      std::vector<int> partner;
      const int hits = LargestMatching(truths, found, fits, partner);
      by_label[(truths > 0 ? one.truth : one.prediction).front().label] +=
          {hits, found - hits, truths - hits};
    }
  }
  double sum = 0, labels = 0;
  for (const auto& [label, hits] : by_label) {
    sum += hits.Precision() * hits.Recall();
    labels += hits.correct + hits.missed > 0;
  }
  return Ratio(sum, labels, by_label.empty() ? 1 : 0);
}

double FrameCounts::Accuracy() const {
  return Ratio(static_cast<double>(equal), static_cast<double>(all), 1);
}
double FrameCounts::ErrorRate() const {
  return Ratio(static_cast<double>(confused + missed + false_alarm), static_cast<double>(InTruth()),
               false_alarm == 0 ? 0 : 1);
}
double FrameCounts::DetectionErrorRate() const {
  return Ratio(static_cast<double>(missed + false_alarm), static_cast<double>(InTruth()),
               false_alarm == 0 ? 0 : 1);
}
double FrameCounts::F1() const {
  const auto wrong = static_cast<double>(2 * confused + missed + false_alarm);
  return Ratio(2 * static_cast<double>(correct), 2 * static_cast<double>(correct) + wrong, 1);
}

double FrameCounts::Kappa() const {
  if (all == 0) return 1;
  const auto frames = static_cast<double>(all);
  const double one = static_cast<double>(InTruth()) / frames,
               other = static_cast<double>(correct + confused + false_alarm) / frames;
  const double by_chance = one * other + (1 - one) * (1 - other);
  return by_chance < 1 ? (Accuracy() - by_chance) / (1 - by_chance) : 1;
}

FrameCounts CountFrames(const Episode& episode, Tick collar) {
  std::set<Tick> cuts = {0, episode.ticks}, boundaries;
  for (const Segments* side : {&episode.truth, &episode.prediction}) {
    for (const Segment& segment : *side)
      cuts.insert({segment.interval.begin, segment.interval.end});
  }
  for (const Segment& segment : episode.truth)
    boundaries.insert({segment.interval.begin, segment.interval.end});
  for (const Tick boundary : boundaries) cuts.insert({boundary - collar, boundary + collar});
  FrameCounts counts;
  for (auto cut = cuts.begin(); std::next(cut) != cuts.end(); ++cut) {
    const Tick begin = *cut, length = *std::next(cut) - begin;
    if (begin < 0 || begin >= episode.ticks) continue;
    const auto near = boundaries.upper_bound(begin - collar);
    if (collar > 0 && near != boundaries.end() && *near - collar <= begin) continue;
    const std::string *truth = LabelAt(episode.truth, begin),
                      *predicted = LabelAt(episode.prediction, begin);
    const bool equal = truth && predicted ? *truth == *predicted : truth == predicted;
    counts.all += length;
    if (equal) counts.equal += length;
    if (truth && predicted) (equal ? counts.correct : counts.confused) += length;
    if (truth && !predicted) counts.missed += length;
    if (!truth && predicted) counts.false_alarm += length;
  }
  return counts;
}

double EventErrors::ErrorRate() const {
  return Ratio(substituted + Deleted() + Inserted(), truths, predictions == 0 ? 0 : 1);
}

EventErrors MatchWithCollar(const Segments& truth, const Segments& prediction, double collar,
                            double share) {
  const auto near = [&](int i, int j) {
    const Interval &a = truth[i].interval, &b = prediction[j].interval;
    const double slack = std::max(collar, share * static_cast<double>(Length(a)));
    return static_cast<double>(std::abs(a.begin - b.begin)) <= collar &&
           static_cast<double>(std::abs(a.end - b.end)) <= slack;
  };
  const int truths = static_cast<int>(truth.size()),
            predictions = static_cast<int>(prediction.size());
  std::vector<int> partner;
  EventErrors errors{.truths = truths, .predictions = predictions};
  errors.correct = LargestMatching(
      truths, predictions,
      [&](int i, int j) { return truth[i].label == prediction[j].label && near(i, j); }, partner);
  const std::set<int> matched(partner.begin(), partner.end());
  std::vector<bool> replaced(truth.size(), false);
  for (int j = 0; j < predictions; ++j) {
    for (int i = 0; i < truths && !matched.contains(j); ++i) {
      if (partner[i] >= 0 || replaced[i] || !near(i, j)) continue;
      replaced[i] = true;
      ++errors.substituted;
      break;
    }
  }
  return errors;
}

Hits BoundaryHits(const Episode& episode, double window) {
  const std::vector<Tick> truth = InnerBoundaries(episode.truth, episode.ticks);
  const std::vector<Tick> predicted = InnerBoundaries(episode.prediction, episode.ticks);
  std::vector<int> partner;
  const int hits = LargestMatching(
      static_cast<int>(truth.size()), static_cast<int>(predicted.size()),
      [&](int i, int j) {
        return static_cast<double>(std::abs(truth[i] - predicted[j])) <= window;
      },
      partner);
  return {hits, static_cast<int>(predicted.size()) - hits, static_cast<int>(truth.size()) - hits};
}

void WardFrames::Add(const WardFrames& more, double share) {
  alone += share * more.alone;
  between += share * more.between;
  before += share * more.before;
  after += share * more.after;
}

void Ward::Add(const Ward& other, double ticks_per_second) {
  AddCounts<&Ward::correct, &Ward::deleted, &Ward::fragmented, &Ward::merged,
            &Ward::fragmented_and_merged, &Ward::inserted, &Ward::found_correct, &Ward::fragmenting,
            &Ward::merging, &Ward::fragmenting_and_merging>(*this, other);
  missed.Add(other.missed, 1 / ticks_per_second);
  false_alarm.Add(other.false_alarm, 1 / ticks_per_second);
}

Ward CompareByWard(const Segments& truth, const Segments& said) {
  const WardSide of_truth = SideOf(truth, said), of_said = SideOf(said, truth);
  return {.correct = of_truth.plain,
          .deleted = of_truth.alone,
          .fragmented = of_truth.several,
          .merged = of_truth.shares,
          .fragmented_and_merged = of_truth.both,
          .inserted = of_said.alone,
          .found_correct = of_said.plain,
          .fragmenting = of_said.shares,
          .merging = of_said.several,
          .fragmenting_and_merging = of_said.both,
          .missed = UncoveredOf(truth, said),
          .false_alarm = UncoveredOf(said, truth)};
}

std::vector<grammar::Tick> InnerBoundaries(const Segments& segments, grammar::Tick ticks) {
  std::set<grammar::Tick> boundaries;
  for (const Segment& segment : segments)
    boundaries.insert({segment.interval.begin, segment.interval.end});
  boundaries.erase(0);
  boundaries.erase(ticks);
  return {boundaries.begin(), boundaries.end()};
}

LabelledEpisode Labelled(const grammar::Timeline& truth, const grammar::Timeline& found,
                         grammar::Tick ticks) {
  LabelledEpisode episode{.ticks_per_second = static_cast<double>(truth.ticks_per_second),
                          .whole = {ticks, SegmentsOf(truth), SegmentsOf(found)}};
  std::map<std::string, Episode> by_label;
  for (const Segment& segment : episode.whole.truth)
    by_label[segment.label].truth.push_back(segment);
  for (const Segment& segment : episode.whole.prediction)
    by_label[segment.label].prediction.push_back(segment);
  for (auto& [label, of_label] : by_label) {
    of_label.ticks = ticks;
    episode.by_label.push_back(std::move(of_label));
  }
  return episode;
}

}  // namespace prehend::measure
