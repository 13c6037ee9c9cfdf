// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <vector>

#include "harness/base/base/content_hash.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/episodes/record_episode.h"
#include "harness/episode/episodes/recordings.h"

namespace prehend::episode {
namespace {

namespace fs = std::filesystem;

/// Plays a scenario into a file. Returns what went wrong.
grammar::Diagnostics Record(RecordRequest request) {
  const Result<LoadedRun> loaded = LoadRun(request.run, request.root, &request.files);
  if (!loaded) return loaded.error();
  RunRecorder recorder(request, loaded->scenario);
  PlayScenario(*loaded, {}, &recorder);
  if (recorder.problem().empty()) return {};
  return {{.file = request.file, .place = {}, .message = recorder.problem()}};
}

grammar::Diagnostics Import(const ImportRequest& request) {
  Result<Recording> recording = ReadRecording(request.source);
  if (!recording) return recording.error();
  const auto imported = ImportRecording(request, *recording);
  if (!imported) return imported.error();
  if (imported->problem.empty()) return {};
  return {{.file = request.file, .place = {}, .message = imported->problem}};
}

}  // namespace

EpisodeKeeper::EpisodeKeeper(std::string root, std::string today, std::string folder)
    : root_(std::move(root)),
      today_(std::move(today)),
      folder_(folder.empty() ? temporary_.path().string() : std::move(folder)) {}

Result<EpisodeName> EpisodeKeeper::Keep(const EpisodeName& episode) {
  if (episode.number) return episode;
  std::string name = episode.scenario;
  std::ranges::replace(name, '/', '_');
  const std::string file = (fs::path(folder_) / (name + ".episodes")).string();
  std::error_code error;
  fs::create_directories(folder_, error);
  fs::remove(file, error);
  sources_[file] = episode.origin == Origin::kScenario ? episode.scenario : episode.file;
  grammar::Diagnostics problems =
      episode.origin == Origin::kRecording
          ? Import({file, root_, episode.file, "", today_, ProgramHash()})
          : Record({file, root_, {.scenario_file = episode.file}, {}, today_, ProgramHash()});
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  Result<std::vector<EpisodeName>> kept = EpisodesOf(file);
  if (!kept) return tl::unexpected(std::move(kept.error()));
  return std::move(kept->front());
}

Result<std::vector<EpisodeName>> EpisodeKeeper::KeepAll(std::vector<EpisodeName> episodes) {
  for (EpisodeName& episode : episodes) {
    Result<EpisodeName> kept = Keep(episode);
    if (!kept) return tl::unexpected(std::move(kept.error()));
    episode = std::move(*kept);
  }
  return episodes;
}

std::string EpisodeKeeper::SourceOf(const std::string& file) const {
  const auto source = sources_.find(file);
  return source == sources_.end() ? file : source->second;
}

}  // namespace prehend::episode
