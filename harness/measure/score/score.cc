// SPDX-License-Identifier: Apache-2.0
#include "harness/measure/score/score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <set>

#include "grammar/contents.h"
#include "harness/episode/run/load_run.h"
#include "harness/truth/timeline/event_text.h"
#include "harness/truth/timeline/match_events.h"

namespace prehend::measure {
namespace {

using grammar::NamedEvent;

/// If `event` is empty, all events.
grammar::Timeline OfKind(const grammar::Timeline& timeline, const std::string& event) {
  grammar::Timeline only{.ticks_per_second = timeline.ticks_per_second};
  for (const NamedEvent& candidate : timeline.events) {
    if (event.empty() || candidate.event == event) only.events.push_back(candidate);
  }
  return only;
}

double SecondsOf(const std::vector<EpisodeToScore>& episodes) {
  double seconds = 0;
  for (const EpisodeToScore& episode : episodes)
    seconds += truth::SecondsOf(episode.ticks, episode.truth.ticks_per_second);
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
    score.ward.Add(CompareByWard(label.truth, label.prediction), per_s);
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
    if (one.decided < 0) continue;  // nothing says when
    score.late.seconds.push_back(static_cast<double>(one.decided - one.interval.end) / per_s);
  }
}

/// If `event` is empty, all kinds.
EventScore ScoreKind(const std::vector<EpisodeToScore>& episodes, const std::string& event,
                     double collar_s) {
  EventScore score{.event = event.empty() ? "all" : event, .collar_s = collar_s};
  std::vector<LabelledEpisode> labelled;
  EditOfTracks edit;
  for (const EpisodeToScore& judged : episodes) {
    const grammar::Timeline truth = OfKind(judged.truth, event),
                            found = OfKind(judged.found, event);
    LabelledEpisode episode = Labelled(truth, found, judged.ticks);
    AddEpisode(judged, episode, event, collar_s, score);
    if (episode.by_label.empty()) continue;  // neither true nor found
    edit.Add(TracksOf(truth, found, judged.ticks, judged.hands));
    labelled.push_back(std::move(episode));
  }
  score.edit = edit.Mean();
  score.further = ScoreFurther(labelled, collar_s, SecondsOf(episodes));
  return score;
}

MeanOfKinds MeanOf(const std::vector<EventScore>& kinds) {
  MeanOfKinds mean;
  if (kinds.empty()) return mean;
  mean = {0, 0, 0, 0, 0, 0};
  const double share = 1 / static_cast<double>(kinds.size());
  for (const EventScore& kind : kinds) {
    mean.f1_10 += share * kind.overlap_10.F1();
    mean.f1_25 += share * kind.overlap_25.F1();
    mean.f1_50 += share * kind.overlap_50.F1();
    mean.edit += share * kind.edit;
    mean.frame_accuracy += share * kind.frames.Accuracy();
    mean.collar_f += share * kind.within_collar.AsHits().F1();
  }
  return mean;
}

EpisodeRow RowOf(const EpisodeToScore& judged, const std::vector<EventScore>& kinds,
                 double collar_s) {
  EpisodeRow row{.episode = judged.scenario,
                 .person = judged.person,
                 .set = judged.set,
                 .ticks = judged.ticks,
                 .truth = judged.truth,
                 .found = judged.found,
                 .bands = judged.bands};
  const LabelledEpisode all = Labelled(judged.truth, judged.found, judged.ticks);
  AddEpisode(judged, all, "", collar_s, row.total);
  EditOfTracks edit;
  edit.Add(TracksOf(judged.truth, judged.found, judged.ticks, judged.hands));
  row.total.edit = edit.Mean();
  row.total.within_collar = {};
  for (const EventScore& kind : kinds) {
    const LabelledEpisode of_kind =
        Labelled(OfKind(judged.truth, kind.event), OfKind(judged.found, kind.event), judged.ticks);
    row.total.within_collar += MatchWithCollar(of_kind.whole.truth, of_kind.whole.prediction,
                                               kind.collar_s * of_kind.ticks_per_second, 0);
    row.hits[kind.event] = HitsByOverlap(of_kind.whole.truth, of_kind.whole.prediction, 0.50);
  }
  return row;
}

/// Both sides of one label.
struct TwoSides {
  Segments truth, found;
};

/// Both in the order of time, and without overlaps within a side.
bool AnyOverlaps(const Segments& a, const Segments& b) {
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    if (Overlap(i->interval, j->interval) > 0) return true;
    if (i->interval.end <= j->interval.end)
      ++i;
    else
      ++j;
  }
  return false;
}

void MergeInto(Segments& track, const Segments& more) {
  track.insert(track.end(), more.begin(), more.end());
  std::ranges::stable_sort(track, {}, [](const Segment& one) { return one.interval.begin; });
}

std::string WhoseOf(const NamedEvent& event, const truth::HandRoles& hands) {
  const std::string& hand = truth::HandOf(event, hands);
  if (!hand.empty()) return hand;
  std::string roles;
  for (const grammar::Role& role : event.roles) roles += role.value + ",";
  return roles;
}

}  // namespace

double TimeErrors::QuantileByMagnitude(double share) const {
  if (seconds.empty()) return 0;
  std::vector<double> sorted = seconds;
  std::ranges::stable_sort(sorted, {}, [](double error) { return std::abs(error); });
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

Score ScoreOf(const std::string& grammar, const std::vector<EpisodeToScore>& all, double collar_s,
              const Collars& collars) {
  std::vector<EpisodeToScore> episodes;
  std::vector<std::string> failed;
  double cpu_s = 0;
  for (const EpisodeToScore& episode : all) {
    cpu_s += episode.cpu_s;
    if (episode.failure.empty())
      episodes.push_back(episode);
    else
      failed.push_back(episode.scenario);
  }
  std::set<std::string> kinds;
  for (const EpisodeToScore& episode : episodes) {
    for (const auto* side : {&episode.truth, &episode.found}) {
      for (const NamedEvent& event : side->events) kinds.insert(event.event);
    }
  }
  Score score{.grammar = grammar,
              .total = ScoreKind(episodes, "", collar_s),
              .episodes = static_cast<int>(episodes.size()),
              .failed = std::move(failed),
              .cpu_share = cpu_s / std::max(1e-9, SecondsOf(all))};
  for (const EpisodeToScore& episode : episodes) {
    for (const auto& [event, times] : episode.ignored) score.ignored[event] += times;
    for (const auto& [event, moments] : episode.moments) {
      score.moments[event].marked += moments.marked;
      score.moments[event].found += moments.found;
    }
  }
  for (const std::string& kind : kinds) {
    const auto own = collars.find(kind.substr(0, kind.find(" of ")));
    score.events.push_back(
        ScoreKind(episodes, kind, own == collars.end() ? collar_s : own->second));
  }
  score.mean = MeanOf(score.events);
  if (!collars.empty()) {
    score.total.within_collar = {};
    for (const EventScore& kind : score.events) score.total.within_collar += kind.within_collar;
    if (!score.events.empty()) score.total.collar_s = score.events.front().collar_s;
    for (const EventScore& kind : score.events)
      if (kind.collar_s != score.total.collar_s) score.total.collar_s = -1;
  }
  for (const EpisodeToScore& episode : episodes)
    score.rows.push_back(RowOf(episode, score.events, collar_s));
  return score;
}

std::vector<Episode> TracksOf(const grammar::Timeline& truth, const grammar::Timeline& found,
                              grammar::Tick ticks, const truth::HandRoles& hands) {
  std::map<std::string, std::map<std::string, TwoSides>> by_hand;
  for (const grammar::NamedEvent& event : truth.events)
    by_hand[WhoseOf(event, hands)][event.Label()].truth.push_back({event.Label(), event.interval});
  for (const grammar::NamedEvent& event : found.events)
    by_hand[WhoseOf(event, hands)][event.Label()].found.push_back({event.Label(), event.interval});
  std::vector<Episode> all;
  for (const auto& [hand, labels] : by_hand) {
    const std::size_t first = all.size();
    for (const auto& [label, sides] : labels) {
      auto track = std::find_if(all.begin() + static_cast<std::ptrdiff_t>(first), all.end(),
                                [&sides = sides](const Episode& one) {
                                  return !AnyOverlaps(one.truth, sides.truth) &&
                                         !AnyOverlaps(one.prediction, sides.found);
                                });
      if (track == all.end()) track = all.insert(track, Episode{.ticks = ticks});
      MergeInto(track->truth, sides.truth);
      MergeInto(track->prediction, sides.found);
    }
  }
  return all;
}

void EditOfTracks::Add(const std::vector<Episode>& tracks) {
  for (const Episode& track : tracks) sum_ += EditScore(track.truth, track.prediction);
  tracks_ += static_cast<int>(tracks.size());
}

Source SourceOf(const std::string& typed, const std::string& root) {
  if (typed.starts_with("files:")) return {Source::Kind::kFiles, typed.substr(6)};
  const bool is_grammar =
      typed.find(' ') == std::string::npos &&
      (typed.ends_with(".grammar") || episode::LoadGrammar(root, typed).program);
  return {is_grammar ? Source::Kind::kGrammar : Source::Kind::kProgram, typed};
}

std::string Asking::WhoseEvents() const {
  const auto grammar = std::ranges::find(sources, Source::Kind::kGrammar, &Source::kind);
  return grammar == sources.end() ? "" : grammar->text;
}

WatchedEpisode Watched(episode::Episode& episode) {
  return {.name = episode.name().scenario,
          .entities = episode.entities(),
          .each_frame = [&episode](const std::function<void(const grammar::Frame&)>& look) {
            return episode.EachFrame(look).tick;
          }};
}

Foreign::Foreign(const Asking& asking, const Source& source)
    : asking_(asking),
      source_(source),
      recogniser_({source.text, asking.pace, asking.time_limit_s}) {}

Result<grammar::Timeline> Foreign::Find(const std::vector<episode::Take>& takes, std::size_t take,
                                        const WatchedEpisode& watched,
                                        const grammar::Program& program,
                                        const exchange::ComparedRoles& compared,
                                        EpisodeToScore& episode) {
  const grammar::Tick rate = watched.entities.ticks_per_second;
  Result<exchange::LabelReading> said;
  if (source_.kind == Source::Kind::kFiles) {
    said = exchange::ReadFound(takes, take, source_.text, asking_.label_map, program, [&] {
      const auto per_s = static_cast<double>(rate);
      exchange::TakeClock clock{.ticks_per_second = per_s};
      const grammar::Tick end = watched.each_frame([&](const grammar::Frame& frame) {
        clock.frames_s.push_back(static_cast<double>(frame.tick) / per_s);
      });
      clock.frames_s.push_back(static_cast<double>(end) / per_s);
      return clock;
    });
  } else {
    Recognised recognised = recogniser_.Recognise(watched);
    const std::string who = source_.text + ", " + watched.name + ": ";
    if (!recognised.stderr_tail.empty()) episode.notes += who + recognised.stderr_tail;
    if (!episode.notes.empty() && !episode.notes.ends_with('\n')) episode.notes += '\n';
    if (recognised.late_frames > 0)
      episode.notes += fmt::format("{}{} answer{} came after the next frame\n", who,
                                   recognised.late_frames, recognised.late_frames == 1 ? "" : "s");
    episode.cpu_s = recognised.cpu_s;
    episode.covers = std::move(recognised.covers);
    if (recognised.broken) {
      episode.failure = grammar::Format(recognised.broken->what);
      return grammar::Timeline{.ticks_per_second = rate};
    }
    said = exchange::AsFound(std::move(recognised.events), takes, asking_.label_map, program);
  }
  if (!said) return tl::unexpected(std::move(said.error()));
  episode.notes += exchange::WarningsOf(*said);
  for (const auto& [label, count] : said->counted().ignored)
    if (label != "background") episode.ignored[label] += static_cast<int>(count);
  auto found = said->Found(0, watched.entities.entities, rate, episode.ticks, compared);
  // Of its own lines, and not of the map.
  if (source_.kind != Source::Kind::kProgram || found || found.error().front().file != source_.text)
    return found;
  episode.failure = grammar::Format(found.error());
  return grammar::Timeline{.ticks_per_second = rate};
}

Result<EpisodeToScore> HeardIn(episode::Episode& episode, const Asking& asking) {
  const grammar::Program& program = *episode.program();
  PREHEND_TRY(const grammar::Tick end, episode.EndTick());
  exchange::ComparedRoles roles;
  for (const grammar::EventSignature& event : grammar::EventSignatures(program))
    roles[event.name] = event.roles;
  EpisodeToScore said{.ticks = end};
  episode::EpisodeName name = episode.name();
  if (name.origin == episode::Origin::kRecording && !name.number)  // a path, where it is checked
    name.scenario = std::filesystem::path(name.file).stem().string();
  WatchedEpisode watched = Watched(episode);
  watched.name = name.scenario;
  PREHEND_TRY(said.found, Foreign(asking, asking.sources.front())
                              .Find(episode::TakesOf({name}), 0, watched, program, roles, said));
  return said;
}

}  // namespace prehend::measure
