// SPDX-License-Identifier: Apache-2.0
#include "harness/library/library/study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <ranges>
#include <set>
#include <thread>

#include "grammar/contents.h"
#include "grammar/language/parser.h"
#include "harness/episode/run/load_run.h"
#include "harness/exchange/labels/read_truths.h"
#include "harness/library/library/opened.h"
#include "harness/measure/score/score_labels.h"
#include "harness/measure/sweep/sweep.h"
#include "harness/show/chart/chart.h"
#include "harness/show/explain/explain.h"
#include "harness/show/explain/query.h"
#include "harness/show/explain/why_event.h"
#include "harness/show/tracks/tracks.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend {
namespace {

/// What a grammar saw of an episode.
show::Watched Watch(episode::Episode& episode) {
  show::Watched watched = show::Watch(episode);
  if (!watched.problem.empty()) Refuse(episode.name().file, watched.problem);
  return watched;
}

/// Events as if they stood in a file below a head, so that the same is wrong with them.
exchange::LabelFile FileOf(const grammar::Timeline& found, std::size_t number) {
  exchange::LabelFile file{.file = "found[" + std::to_string(number) + "]", .text = "\n"};
  const auto seconds = [per_s = static_cast<double>(found.ticks_per_second)](grammar::Tick tick) {
    return static_cast<double>(tick) / per_s;
  };
  for (const grammar::NamedEvent& event : found.events) {
    file.text += event.Label() + "\n";
    file.labels.push_back({.begin_s = seconds(event.interval.begin),
                           .end_s = seconds(event.interval.end),
                           .text = event.event,
                           .place = {static_cast<int>(file.labels.size()) + 2, 1},
                           .roles = event.roles,
                           .decided_s = seconds(event.decided)});
  }
  return file;
}

}  // namespace

Signals SignalsOf(const Episode& episode, const Grammar* grammar,
                  const std::vector<std::string>& only) {
  return episode.impl().With(grammar, [&](episode::Episode& opened) {
    const std::vector<std::string> known = show::TrackNames(*opened.program());
    for (const std::string& name : only) {
      if (std::ranges::count(known, name) > 0) continue;
      Refuse("", "no event, condition or signal of the grammar is called '" + name + "'",
             grammar::DidYouMean(name, known));
    }
    const show::Watched watched = Watch(opened);
    show::Tracks tracks =
        show::CollectTracks(*watched.past, std::set<std::string>(only.begin(), only.end()));
    if (!tracks.problem.empty()) Refuse("", tracks.problem);
    Signals signals{.ticks = std::move(tracks.ticks)};
    for (const show::Track& track : tracks.tracks) {
      Signals::Signal& signal = signals.signals.emplace_back();
      signal.name = track.name;
      signal.unit = track.unit;
      for (const std::optional<double>& value : track.values)
        signal.values.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    return signals;
  });
}

grammar::Diagnostics CheckText(const std::string& file, const std::string& text) {
  grammar::CompileResult result =
      episode::LoadGrammar(ProjectRoot(), file, {}, nullptr, {{file, text}});
  std::ranges::move(result.warnings, std::back_inserter(result.diagnostics));
  return std::move(result.diagnostics);
}

std::string FormatGrammar(const std::string& text) { return grammar::FormatText({"", text}); }

Explanation Explain(const Episode& episode, const Grammar* grammar, const std::string& event) {
  return episode.impl().With(grammar, [&](episode::Episode& opened) {
    std::optional<show::Ask> ask;
    if (!event.empty())
      ask = Unwrap(show::ParseAsk("event", event, *opened.program(), opened.entities()));
    const auto length_s = truth::SecondsOf(episode.impl().end, opened.entities().ticks_per_second);
    if (ask && ask->time_s.value_or(0) > length_s)
      Refuse("event",
             fmt::format("found {:g} s, the episode ends after {:g} s", *ask->time_s, length_s));
    const show::Watched watched = Watch(opened);
    grammar::ReplayMonitor& past = *watched.past;
    const grammar::Tick per_s = past.entity_table().ticks_per_second;
    nlohmann::ordered_json json = {{"episode", episode.name()},
                                   {"grammar", grammar::GrammarName(past.program())},
                                   {"ticks_per_second", per_s}};
    std::vector<show::WhyEvent> events =
        ask ? show::ExplainEvents(past, *ask) : show::ExplainAll(past);
    const show::Recognise recognise = [&](const auto& program) -> std::optional<grammar::Timeline> {
      Result<grammar::Timeline> timeline = opened.Segment(program);
      return timeline ? std::optional(std::move(*timeline)) : std::nullopt;
    };
    if (ask && events.size() == 1) show::FindDecisive(past, *ask, recognise, events.front());
    Explanation explanation;
    if (ask && events.empty()) {
      show::WhyMissing why = show::ExplainMissing(past, *ask);
      show::FindDecisive(past, *ask, recognise, why);
      explanation.text = show::Text(why, per_s);
      json["missing"] = show::ToJson(why, per_s);
    } else {
      json["events"] = nlohmann::ordered_json::array();
      for (const show::WhyEvent& why : events) json["events"].push_back(show::ToJson(why, per_s));
      if (!ask) explanation.text = show::Table(events, per_s);
      for (const show::WhyEvent& why : events) {
        if (ask) explanation.text += show::Text(why, per_s);
      }
    }
    explanation.json = json.dump();
    return explanation;
  });
}

grammar::Timeline ReadLabels(const Episode& episode, const Grammar* grammar,
                             const std::string& file, const std::string& map,
                             std::optional<std::size_t> entry) {
  return episode.impl().With(grammar, [&](episode::Episode& opened) {
    const grammar::EntityTable table = opened.entities();
    std::vector<episode::Take> takes = episode::TakesOf({opened.name()});
    if (entry) {
      takes.front() = Unwrap(episode::ReadTakes(file)).at(*entry).take;
      takes.front().episode = opened.name();
    }
    const auto reading = Unwrap(exchange::ReadTruths(
        takes, entry ? std::vector<std::string>() : std::vector{file}, map, *opened.program()));
    Unwrap(reading.Truth(0, table.entities, table.ticks_per_second, episode.end()));
    return reading.Marked(0, table.ticks_per_second, episode.end(), true);
  });
}

Warned ScoreJson(const Grammar& grammar, const std::vector<Compared>& episodes,
                 const std::string& map, std::optional<double> collar_s) {
  std::vector<episode::EpisodeName> names;
  std::vector<std::string> files;
  for (const Compared& one : episodes) {
    names.push_back(one.episode.impl().name);
    files.push_back(one.labels);
  }
  const double collar = collar_s.value_or(measure::LabelsRequest().collar_s);
  const auto truths =
      Unwrap(exchange::ReadTruths(episode::TakesOf(names), files, map, *grammar.program()));
  std::vector<measure::EpisodeToScore> all;
  std::string doubts;
  for (const Compared& one : episodes) {
    const grammar::EntityTable table = one.episode.entities();
    const std::size_t take = all.size();
    measure::EpisodeToScore& scored = all.emplace_back();
    scored.ticks = one.end;
    scored.truth = Unwrap(truths.Truth(take, table.entities, table.ticks_per_second, scored.ticks));
    doubts += measure::RateWarning(truths, take, truth::SecondsOf(one.end, table.ticks_per_second));
    const auto found = Unwrap(exchange::AsFound(
        FileOf(one.found, take), episode::TakesOf({names[take]}), "", *grammar.program()));
    measure::AddFound(
        Unwrap(found.Found(0, table.entities, table.ticks_per_second, one.end, truths.compared())),
        take, truths, collar, scored);
  }
  const auto unread = std::views::keys(truths.counted().unread);
  if (!unread.empty())
    doubts +=
        fmt::format("warning: truth: columns that are not read: {}\n", fmt::join(unread, ", "));
  const measure::Score score = measure::ScoreOf(
      "", all, collar, collar_s ? measure::Collars() : measure::Collars(truths.collars_s()));
  return {
      measure::ScoresJson({score})["grammars"][0].dump(),
      exchange::WarningsOf(truths) + doubts + measure::ClockWarning(grammar.name(), all, truths)};
}

Warned MarginsCsv(const std::vector<std::string>& files, const Grammar& grammar,
                  const std::vector<std::string>& truth, const std::string& map,
                  const std::vector<std::string>& over, double within) {
  measure::SweepRequest request{.root = ProjectRoot(), .grammar = grammar.name_or_path()};
  for (const auto& [name, value] : grammar.parameters())
    request.settings.push_back(name + "=" + value);
  if (const std::string why = measure::SetTruth(truth, request); !why.empty()) Refuse("", why);
  request.label_map = map;
  request.by_overlap = request.truth == measure::Truth::kLabels;
  request.jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<episode::EpisodeName> names;
  for (const Episode& episode : OpenEpisodes(files)) names.push_back(episode.impl().name);
  const measure::Margins margins =
      Unwrap(measure::FindMargins(episode::TakesOf(names), request, within, over));
  const std::vector<std::string>& left_out = margins.sweep.left_out;
  if (margins.sweep.IsRefused(request) || margins.sweep.episodes == 0)
    Refuse("", left_out.empty() ? "no episode has events to compare with" : left_out.front());
  return {measure::MarginsCsv(margins), margins.sweep.label_warning};
}

std::string TimelineSvg(const grammar::Timeline& timeline, grammar::Tick end,
                        const Grammar* grammar) {
  const truth::EventDrawings drawings =
      grammar ? truth::EventDrawings(*grammar->program()) : truth::EventDrawings();
  truth::HandRoles hands;
  if (grammar) hands = truth::HandRolesOf(EventSignatures(*grammar->program()));
  const auto seconds = [&](grammar::Tick tick) {
    return truth::SecondsOf(tick, timeline.ticks_per_second);
  };
  show::Chart chart{.title = "", .from_s = 0, .to_s = seconds(end)};
  for (const grammar::NamedEvent& event : timeline.events) {
    const std::string& hand = truth::HandOf(event, hands);
    const std::string name = hand.empty() ? event.event : hand + ": " + event.event;
    const std::string label = event.Label();
    show::Bar bar{.begin_s = seconds(event.interval.begin),
                  .end_s = seconds(event.interval.end),
                  .text = label.substr(std::min(label.size(), label.find('(') + 1)),
                  .color = drawings.Of(event.event).color,
                  .kind = event.event};
    if (bar.text.ends_with(')')) bar.text.pop_back();
    const auto is_free = [&](const show::Row& row) {
      return row.name == name && row.bars.back().end_s <= bar.begin_s + 1e-9;
    };
    auto row = std::ranges::find_if(chart.rows, is_free);
    if (row == chart.rows.end()) row = chart.rows.insert(row, {.name = name});
    row->bars.push_back(std::move(bar));
  }
  std::ranges::stable_sort(chart.rows, {}, &show::Row::name);
  return show::ChartSvg(chart);
}

}  // namespace prehend
