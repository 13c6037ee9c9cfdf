// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/measure/score/score_test.cc
#include "harness/measure/score/score.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "harness/measure/score/overlap_metrics.h"
#include "harness/truth/timeline/match_events.h"

namespace prehend::measure {
namespace {

using grammar::NamedEvent;

template <class Less = std::less<double>>
double Quantile(std::vector<double> values, double share, Less less = {}) {
  if (values.empty()) return 0;
  std::stable_sort(values.begin(), values.end(), less);
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::clamp<std::size_t>(rank, 1, values.size()) - 1];
}

/// If `event` is empty, all events.
grammar::Timeline OfKind(const grammar::Timeline& timeline, const std::string& event) {
  grammar::Timeline only{.ticks_per_second = timeline.ticks_per_second, .events = {}};
  for (const NamedEvent& candidate : timeline.events) {
    if (event.empty() || candidate.event == event) only.events.push_back(candidate);
  }
  return only;
}

double SecondsOf(const std::vector<EpisodeToScore>& episodes) {
  double seconds = 0;
  for (const EpisodeToScore& episode : episodes)
    seconds +=
        static_cast<double>(episode.ticks) / static_cast<double>(episode.truth.ticks_per_second);
  return seconds;
}

/// Adds one episode to the score of one kind of event.
void AddEpisode(const EpisodeToScore& judged, const LabelledEpisode& episode,
                const std::string& event, double collar_s, EventScore& score) {
  const double per_s = episode.ticks_per_second;
  const Segments &truth = episode.whole.truth, &found = episode.whole.prediction;
  score.truths += static_cast<int>(truth.size());
  score.found += static_cast<int>(found.size());
  score.overlap_10 += HitsByOverlap(truth, found, 0.10);
  score.overlap_25 += HitsByOverlap(truth, found, 0.25);
  score.overlap_50 += HitsByOverlap(truth, found, 0.50);
  score.within_collar += MatchWithCollar(truth, found, collar_s * per_s, 0);
  // Frames and Ward's classes are per label, because events of different labels overlap.
  for (const Episode& label : episode.by_label) {
    score.ward += CompareByWard(label.truth, label.prediction);
    score.frames += CountFrames(label);
  }
  const grammar::Timeline true_events = OfKind(judged.truth, event),
                          found_events = OfKind(judged.found, event);
  const truth::Agreement agreement =
      truth::Agree(true_events, found_events, static_cast<grammar::Tick>(collar_s * per_s));
  for (const truth::LabelAgreement& label : agreement.labels) {
    for (const truth::Match& match : label.matches) {
      score.begin.seconds.push_back(static_cast<double>(match.begin_offset()) / per_s);
      score.end.seconds.push_back(static_cast<double>(match.end_offset()) / per_s);
    }
  }
  for (const NamedEvent& one : found_events.events) {
    score.latency_s.push_back(static_cast<double>(one.decided - one.interval.end) / per_s);
  }
}

/// If `event` is empty, all kinds.
EventScore ScoreKind(const std::vector<EpisodeToScore>& episodes, const std::string& event,
                     double collar_s) {
  EventScore score{.event = event.empty() ? "all" : event};
  std::vector<LabelledEpisode> labelled;
  double edits = 0;
  for (const EpisodeToScore& judged : episodes) {
    LabelledEpisode episode =
        Labelled(OfKind(judged.truth, event), OfKind(judged.found, event), judged.ticks);
    AddEpisode(judged, episode, event, collar_s, score);
    if (episode.by_label.empty()) continue;  // neither true nor found
    edits += EditScore(episode.whole.truth, episode.whole.prediction);
    labelled.push_back(std::move(episode));
  }
  if (!labelled.empty()) score.edit = edits / static_cast<double>(labelled.size());
  score.further = ScoreFurther(labelled, collar_s, SecondsOf(episodes));
  return score;
}

}  // namespace

double BoundaryErrors::Median() const { return Quantile(seconds, 0.5); }

double BoundaryErrors::QuantileByMagnitude(double share) const {
  return Quantile(seconds, share, [](double a, double b) { return std::abs(a) < std::abs(b); });
}

double EventScore::LatencyQuantile(double share) const { return Quantile(latency_s, share); }

Score ScoreOf(const std::string& grammar, const std::vector<EpisodeToScore>& episodes,
              double collar_s) {
  std::set<std::string> kinds;
  for (const EpisodeToScore& episode : episodes) {
    for (const auto* side : {&episode.truth, &episode.found}) {
      for (const NamedEvent& event : side->events) kinds.insert(event.event);
    }
  }
  Score score{.grammar = grammar,
              .events = {},
              .total = ScoreKind(episodes, "", collar_s),
              .episodes = static_cast<int>(episodes.size()),
              .not_covered = {},
              .ignored = {}};
  for (const EpisodeToScore& episode : episodes) {
    for (const auto& [event, times] : episode.ignored) score.ignored[event] += times;
  }
  for (const std::string& kind : kinds) score.events.push_back(ScoreKind(episodes, kind, collar_s));
  return score;
}

}  // namespace prehend::measure
