// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episode/open_episode.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "grammar/contents.h"
#include "harness/episode/episodes/recordings.h"
#include "harness/episode/run/load_grammar.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/sense/episode_file.h"

namespace prehend::episode {
namespace {

/// Of JSON Lines. What is wrong with it is said by who reads all of it.
Result<EpisodeHeader> HeaderOf(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  EpisodeStream stream(file);
  if (std::getline(in, line) && stream.Take(line).empty() && stream.has_header())
    return stream.header();
  Result<Recording> whole = ReadRecording(file);
  if (!whole) return tl::unexpected(std::move(whole.error()));
  return std::move(whole->header);
}

}  // namespace

Result<Episode> EpisodeOpener::OpenLines(const EpisodeName& name, const GrammarChoice& choice) {
  Result<Recording> recording = ReadRecording(name.file);
  if (!recording) return tl::unexpected(std::move(recording.error()));
  return Open(std::move(*recording), name, choice);
}

Result<Episode> EpisodeOpener::Open(Recording recording, const EpisodeName& name,
                                    const GrammarChoice& choice) {
  const Result<grammar::Overrides> parameters = ParameterSettings(choice.settings);
  if (!parameters) return tl::unexpected(parameters.error());
  const EpisodeHeader& header = recording.header;
  grammar::CompileResult compiled = LoadGrammarOf(header, choice.grammar, root_, *parameters);
  if (!compiled.program) return tl::unexpected(std::move(compiled.diagnostics));
  LoadedRun loaded{.scenario = PlaceholderFor(header), .program = std::move(compiled.program)};
  loaded.scenario.file = name.file;
  loaded.scenario.grammar = GrammarName(*loaded.program);
  loaded.warnings = Warnings(*loaded.program, header.entity_table);
  Episode episode(name, std::move(loaded));
  episode.recording_ = std::move(recording);
  return episode;
}

Result<EpisodeRow> EpisodeOpener::FindKept(const EpisodeName& name) {
  if (!file_ || file_->path() != name.file) {
    auto opened = EpisodeFile::Open(name.file);
    if (!opened) return tl::unexpected(std::move(opened.error()));
    file_ = std::make_shared<const EpisodeFile>(std::move(*opened));
  }
  const auto row = std::ranges::find(file_->episodes(), *name.number, &EpisodeRow::id);
  if (row == file_->episodes().end())
    return tl::unexpected(
        grammar::Diagnostics{{.file = name.file, .place = {}, .message = "the episode is gone"}});
  return *row;
}

Result<Episode> EpisodeOpener::OpenKept(const EpisodeName& name, const GrammarChoice& choice) {
  const Result<EpisodeRow> row = FindKept(name);
  if (!row) return tl::unexpected(row.error());
  Result<LoadedRun> loaded = loader_.Load(*file_, *row, choice);
  if (!loaded) return tl::unexpected(std::move(loaded.error()));
  const Origin origin = row->simulated ? Origin::kRecordedRun : Origin::kRecording;
  Episode episode({name.file, row->id, row->scenario, origin, row->grammar}, std::move(*loaded));
  episode.file_ = file_;
  episode.row_ = *row;
  if (row->simulated) return episode;
  Result<Recording> recording = ReadWhole(*file_, *row);
  if (!recording) return tl::unexpected(std::move(recording.error()));
  episode.recording_ = std::move(*recording);
  return episode;
}

Result<Episode> EpisodeOpener::Open(const EpisodeName& name, const GrammarChoice& asked,
                                    std::vector<std::string>* files) {
  GrammarChoice choice = asked;
  if (choice.grammar.empty()) choice.grammar = name.asked;
  if (name.number) return OpenKept(name, choice);
  if (name.origin == Origin::kRecording) return OpenLines(name, choice);
  Result<LoadedRun> loaded = LoadRun({name.file, choice.grammar, choice.settings}, root_, files);
  if (!loaded) return tl::unexpected(std::move(loaded.error()));
  return Episode(name, std::move(*loaded));
}

grammar::CompileResult EpisodeOpener::Compile(const EpisodeName& name, const std::string& asked,
                                              const grammar::Overrides& parameters) {
  if (const std::string& other = asked.empty() ? name.asked : asked; !other.empty())
    return LoadGrammar(root_, other, parameters);
  if (compiled_ != name) {
    compiled_.reset();
    own_ = {};
    if (name.number) {
      const Result<EpisodeRow> row = FindKept(name);
      Result<LoadedRun> loaded = row ? loader_.Load(*file_, *row) : tl::unexpected(row.error());
      if (!loaded) return {nullptr, std::move(loaded.error())};
      own_ = std::move(*loaded);
    } else if (name.origin == Origin::kRecording) {
      Result<EpisodeHeader> header = HeaderOf(name.file);
      if (!header) return {nullptr, std::move(header.error())};
      return LoadGrammarOf(*header, "", root_, parameters);
    } else {
      Result<LoadedRun> loaded = LoadRun({name.file, "", {}}, root_);
      if (!loaded) return {nullptr, std::move(loaded.error())};
      own_ = std::move(*loaded);
    }
    compiled_ = name;
  }
  return name.number ? loader_.CompileOwn(own_.grammar, parameters)
                     : LoadGrammar(root_, own_.grammar, parameters);
}

grammar::Diagnostics WhyNotOneGrammar(std::span<const EpisodeName> episodes,
                                      const std::string& root) {
  EpisodeOpener opener(root);
  std::shared_ptr<const grammar::Program> first;
  for (const EpisodeName& episode : episodes) {
    if (episodes.size() == 1) break;
    grammar::CompileResult own = opener.Compile(episode, "", {});
    if (!own.program) return std::move(own.diagnostics);
    if (!first) first = own.program;
    if (SameTexts(*first, *own.program)) continue;
    const std::string &name = GrammarName(*own.program), &other = GrammarName(*first);
    return {{.file = episode.scenario,
             .place = {},
             .message = name == other
                            ? fmt::format("its grammar {} is not the same as that of {}, which has "
                                          "the same name",
                                          name, episodes.front().scenario)
                            : fmt::format("it names the grammar {}, and {} the grammar {}", name,
                                          episodes.front().scenario, other),
             .hint = fmt::format("one of them for all: --grammar {}", name)}};
  }
  return {};
}

Result<Episode> OpenEpisode(const EpisodeName& name, const GrammarChoice& choice,
                            const std::string& root, std::vector<std::string>* files) {
  return EpisodeOpener(root).Open(name, choice, files);
}

}  // namespace prehend::episode
