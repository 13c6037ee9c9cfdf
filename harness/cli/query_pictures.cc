// SPDX-License-Identifier: Apache-2.0
// See harness/cli/query_pictures.h. Tested by tests/program/query_test.cc
#include "harness/cli/query_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "harness/episodes/load_episode.h"
#include "harness/pictures/pictures.h"

namespace prehend::harness {
namespace {

using episodes::EpisodeFile;
using episodes::EpisodeLoader;
using episodes::EventAnswer;

/// An episode, played; answers of one episode follow each other.
struct Shown {
  LoadedRun loaded;
  RunResult run;
};

Result<Shown> Play(const EventAnswer& answer, EpisodeLoader& loader) {
  const Result<EpisodeFile> file = EpisodeFile::Open(answer.file);
  if (!file) return tl::unexpected(file.error());
  const auto row = std::ranges::find(file->episodes(), answer.episode, &episodes::EpisodeRow::id);
  if (row == file->episodes().end()) {
    return tl::unexpected(grammar::Diagnostics{{.file = answer.file,
                                                .place = {},
                                                .message = "the episode is gone",
                                                .source_line = {},
                                                .hint = {}}});
  }
  Result<LoadedRun> loaded = loader.Load(*file, *row);
  if (!loaded) return tl::unexpected(loaded.error());
  Result<RunResult> run = episodes::Replay(*file, *row, *loaded);
  if (!run) return tl::unexpected(run.error());
  return Shown{std::move(*loaded), std::move(*run)};
}

/// What of the episode is drawn: the event's time, its hand, and the first other entity.
PictureFormat FormatOf(const EventAnswer& answer, const physics::Scene& scene) {
  const auto seconds = [&](grammar::Tick tick) {
    return static_cast<double>(tick) / static_cast<double>(answer.ticks_per_second);
  };
  PictureFormat format;
  format.from_s = seconds(answer.event.interval.begin);
  format.to_s = seconds(answer.event.interval.end);
  for (const grammar::Role& role : answer.event.roles) {
    const auto is_it = [&](const auto& entity) { return entity.name == role.value; };
    if (format.only.empty() && std::ranges::any_of(scene.hands, is_it)) format.only = role.value;
    if (format.of.empty() && std::ranges::any_of(scene.bodies, is_it)) format.of = role.value;
  }
  return format;
}

std::string FileName(std::size_t number, const EventAnswer& answer) {
  const std::string scenario = answer.scenario.substr(answer.scenario.rfind('/') + 1);
  return fmt::format("{:03}-{}-{}.png", number, scenario, answer.event.event);
}

}  // namespace

QueryPictures DrawAnswers(const std::vector<EventAnswer>& answers, const std::string& folder,
                          const std::string& root) {
  QueryPictures drawn{.files = std::vector<std::string>(answers.size()), .error = {}};
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder, error)) {
    drawn.error = folder + " is not a folder, and cannot be made one";
    return drawn;
  }
  EpisodeLoader loader(root);
  std::optional<Result<Shown>> shown;
  const EventAnswer* last = nullptr;
  for (std::size_t i = 0; i < std::min(answers.size(), kMostQueryPictures); ++i) {
    const EventAnswer& answer = answers[i];
    if (!last || last->file != answer.file || last->episode != answer.episode)
      shown.emplace(Play(answer, loader));
    last = &answer;
    if (!*shown) {
      drawn.error = grammar::Format(shown->error());
      continue;
    }
    const Scenario& scenario = (*shown)->loaded.scenario;
    PictureYaml entry;
    const PictureFormat format = FormatOf(answer, scenario.scene);
    entry.at.value = fmt::format("{:.6f}", *format.from_s);
    const std::string file = (std::filesystem::path(folder) / FileName(i + 1, answer)).string();
    const PictureResult result = DrawPicture(scenario, (*shown)->run, entry, file, format);
    if (result.error.empty())
      drawn.files[i] = file;
    else
      drawn.error = result.error;
  }
  if (answers.size() > kMostQueryPictures && drawn.error.empty()) {
    drawn.error = fmt::format("there are {} answers, at most {} are drawn", answers.size(),
                              kMostQueryPictures);
  }
  return drawn;
}

}  // namespace prehend::harness
