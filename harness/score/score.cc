// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/score_test.cc
#include "harness/score/score.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "harness/oracle/agreement.h"

namespace prehend::harness::score {
namespace {

using grammar::Interval;
using grammar::NamedEvent;

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::clamp<std::size_t>(rank, 1, values.size()) - 1];
}

Segments SegmentsOf(const std::vector<NamedEvent>& events) {
  Segments segments;
  for (const NamedEvent& event : events) segments.push_back({event.Label(), event.interval});
  return segments;
}

std::vector<Interval> IntervalsOf(const Segments& segments, const std::string& label) {
  std::vector<Interval> intervals;
  for (const Segment& segment : segments) {
    if (segment.label == label) intervals.push_back(segment.interval);
  }
  return intervals;
}

Segments Only(const Segments& segments, const std::string& label) {
  Segments only;
  for (const Segment& segment : segments) {
    if (segment.label == label) only.push_back(segment);
  }
  return only;
}

std::vector<NamedEvent> Only(const grammar::Timeline& timeline, const std::string& event) {
  std::vector<NamedEvent> only;
  for (const NamedEvent& candidate : timeline.events) {
    if (event.empty() || candidate.event == event) only.push_back(candidate);
  }
  return only;
}

/// Adds what one episode says about one kind of event (all kinds when `event` is empty). Returns its edit score.
double AddEpisode(const JudgedEpisode& episode, const std::string& event, double collar_s, EventScore& score) {
  const auto per_s = static_cast<double>(episode.truth.ticks_per_second);
  const std::vector<NamedEvent> true_events = Only(episode.truth, event), found_events = Only(episode.found, event);
  const Segments truth = SegmentsOf(true_events), found = SegmentsOf(found_events);
  score.truths += static_cast<int>(truth.size());
  score.found += static_cast<int>(found.size());
  score.overlap_10 += HitsByOverlap(truth, found, 0.10);
  score.overlap_25 += HitsByOverlap(truth, found, 0.25);
  score.overlap_50 += HitsByOverlap(truth, found, 0.50);
  score.within_collar += MatchWithCollar(truth, found, collar_s * per_s, 0);
  // Frames and Ward's classes are of one label at a time: events of different labels overlap.
  std::set<std::string> labels;
  for (const Segments* side : {&truth, &found}) {
    for (const Segment& segment : *side) labels.insert(segment.label);
  }
  for (const std::string& label : labels) {
    const Ward ward = CompareByWard(IntervalsOf(truth, label), IntervalsOf(found, label));
    score.ward.ticks += ward.ticks;
    score.ward.events += ward.events;
    score.frames += CountFrames({episode.ticks, Only(truth, label), Only(found, label)});
  }
  const Agreement agreement = Agree({episode.truth.ticks_per_second, true_events},
                                    {episode.truth.ticks_per_second, found_events},
                                    static_cast<grammar::Tick>(collar_s * per_s));
  for (const LabelAgreement& label : agreement.labels) {
    for (const Match& match : label.matches) {
      score.begin.seconds.push_back(static_cast<double>(match.begin_offset()) / per_s);
      score.end.seconds.push_back(static_cast<double>(match.end_offset()) / per_s);
    }
  }
  for (const NamedEvent& one : found_events) {
    score.latency_s.push_back(static_cast<double>(one.decided - one.interval.end) / per_s);
  }
  return truth.empty() && found.empty() ? -1 : EditScore(truth, found);
}

EventScore ScoreKind(const std::vector<JudgedEpisode>& episodes, const std::string& event, double collar_s) {
  EventScore score{.event = event.empty() ? "all" : event};
  double edits = 0;
  int count = 0;
  for (const JudgedEpisode& episode : episodes) {
    const double edit = AddEpisode(episode, event, collar_s, score);
    if (edit < 0) continue;
    edits += edit;
    ++count;
  }
  if (count > 0) score.edit = edits / count;
  return score;
}

}  // namespace

double BoundaryErrors::Median() const { return Quantile(seconds, 0.5); }

double BoundaryErrors::AbsoluteQuantile(double share) const {
  std::vector<double> absolute;
  for (const double offset : seconds) absolute.push_back(std::abs(offset));
  return Quantile(std::move(absolute), share);
}

double EventScore::LatencyQuantile(double share) const { return Quantile(latency_s, share); }

Score ScoreOf(const std::string& grammar, const std::vector<JudgedEpisode>& episodes, double collar_s) {
  std::set<std::string> kinds;
  for (const JudgedEpisode& episode : episodes) {
    for (const auto* side : {&episode.truth, &episode.found}) {
      for (const NamedEvent& event : side->events) kinds.insert(event.event);
    }
  }
  Score score{.grammar = grammar, .events = {}, .total = ScoreKind(episodes, "", collar_s),
              .episodes = static_cast<int>(episodes.size())};
  for (const std::string& kind : kinds) score.events.push_back(ScoreKind(episodes, kind, collar_s));
  return score;
}

}  // namespace prehend::harness::score
