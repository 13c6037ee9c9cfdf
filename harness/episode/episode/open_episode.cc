// SPDX-License-Identifier: Apache-2.0
// See harness/episode/episode/open_episode.h. Tested by tests/program/episode_kinds_test.cc
#include "harness/episode/episode/open_episode.h"

#include <algorithm>

#include "grammar/contents.h"
#include "harness/episode/episodes/placeholder_scene.h"
#include "harness/episode/episodes/recordings.h"
#include "harness/episode/run/load_grammar.h"
#include "harness/episode/run/load_run.h"

namespace prehend::episode {

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

Result<Episode> EpisodeOpener::OpenKept(const EpisodeName& name, const GrammarChoice& choice) {
  if (!file_ || file_->path() != name.file) {
    auto opened = EpisodeFile::Open(name.file);
    if (!opened) return tl::unexpected(std::move(opened.error()));
    file_ = std::make_shared<const EpisodeFile>(std::move(*opened));
  }
  const auto row = std::ranges::find(file_->episodes(), *name.number, &EpisodeRow::id);
  if (row == file_->episodes().end())
    return tl::unexpected(
        grammar::Diagnostics{{.file = name.file, .place = {}, .message = "the episode is gone"}});
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

Result<Episode> EpisodeOpener::Open(const EpisodeName& name, const GrammarChoice& choice,
                                    std::vector<std::string>* files) {
  if (name.number) return OpenKept(name, choice);
  if (name.origin == Origin::kRecording) return OpenLines(name, choice);
  Result<LoadedRun> loaded = LoadRun({name.file, choice.grammar, choice.settings}, root_, files);
  if (!loaded) return tl::unexpected(std::move(loaded.error()));
  return Episode(name, std::move(*loaded));
}

Result<Episode> OpenEpisode(const EpisodeName& name, const GrammarChoice& choice,
                            const std::string& root, std::vector<std::string>* files) {
  return EpisodeOpener(root).Open(name, choice, files);
}

}  // namespace prehend::episode
