// SPDX-License-Identifier: Apache-2.0
#include "harness/measure/score/found_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "grammar/contents.h"
#include "harness/episode/run/load_grammar.h"

namespace prehend::measure {

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
      episode.notes +=
          fmt::format("{}{} answers came after the next frame\n", who, recognised.late_frames);
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
    episode.ignored[label] += static_cast<int>(count);
  return said->Found(0, watched.entities.entities, rate, episode.ticks, compared);
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
