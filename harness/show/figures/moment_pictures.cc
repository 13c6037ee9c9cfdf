// SPDX-License-Identifier: Apache-2.0
#include "harness/show/figures/moment_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "harness/base/base/atomic_file.h"
#include "harness/episode/episode/open_episode.h"
#include "harness/show/pictures/pictures.h"

namespace prehend::show {
namespace {

using episode::EventAnswer;

/// An episode, played.
struct Shown {
  episode::LoadedRun loaded;
  episode::RunResult run;
};

Result<Shown> Play(const Moment& moment, episode::EpisodeOpener& opener) {
  Result<episode::Episode> episode = opener.Open({.file = moment.file, .number = moment.episode});
  if (!episode) return tl::unexpected(std::move(episode.error()));
  Result<episode::RunResult> run = episode->Run(true);
  if (!run) return tl::unexpected(std::move(run.error()));
  return Shown{std::move(episode->loaded()), std::move(*run)};
}

PictureFormat FormatOf(const Moment& moment, const physics::Scene& scene) {
  PictureFormat format;
  format.from_s = moment.from_s;
  format.to_s = moment.to_s;
  format.marked = moment.marked;
  for (const std::string& name : moment.of) {
    const auto is_it = [&](const auto& entity) { return entity.name == name; };
    if (format.only.empty() && std::ranges::any_of(scene.hands, is_it)) format.only = name;
    if (format.of.empty() && std::ranges::any_of(scene.bodies, is_it)) format.of = name;
  }
  return format;
}

std::string FileName(std::size_t number, const Moment& moment) {
  const std::string scenario = moment.scenario.substr(moment.scenario.rfind('/') + 1);
  return FileNameOf(fmt::format("{:03}-{}-{}", number, scenario, moment.name)) + ".png";
}

}  // namespace

Moment MomentOf(const EventAnswer& answer) {
  const auto seconds = [&](grammar::Tick tick) {
    return static_cast<double>(tick) / static_cast<double>(answer.ticks_per_second);
  };
  Moment moment{.file = answer.file,
                .episode = answer.episode,
                .scenario = answer.scenario,
                .name = answer.event.event,
                .at_s = seconds(answer.event.interval.begin),
                .from_s = seconds(answer.event.interval.begin),
                .to_s = seconds(answer.event.interval.end),
                .of = {},
                .marked = {}};
  for (const grammar::Role& role : answer.event.roles) moment.of.push_back(role.value);
  return moment;
}

MomentPictures DrawMoments(const std::vector<Moment>& moments, const std::string& folder,
                           const std::string& root) {
  MomentPictures drawn{.files = std::vector<std::string>(moments.size()), .error = {}};
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder, error)) {
    drawn.error = folder + " is not a folder, and cannot be made one";
    return drawn;
  }
  episode::EpisodeOpener opener(root);
  std::optional<Result<Shown>> shown;
  const Moment* last = nullptr;
  for (std::size_t i = 0; i < std::min(moments.size(), kMostMoments); ++i) {
    const Moment& moment = moments[i];
    if (!last || last->file != moment.file || last->episode != moment.episode)
      shown.emplace(Play(moment, opener));
    last = &moment;
    if (!*shown) {
      drawn.error = grammar::Format(shown->error());
      continue;
    }
    const scenario::Scenario& scenario = (*shown)->loaded.scenario;
    scenario::PictureYaml entry;
    const PictureFormat format = FormatOf(moment, scenario.scene);
    entry.at.value = fmt::format("{:.6f}", moment.at_s);
    const std::string file = (std::filesystem::path(folder) / FileName(i + 1, moment)).string();
    const PictureResult result = DrawPicture(scenario, (*shown)->run, entry, file, format);
    if (result.error.empty())
      drawn.files[i] = file;
    else
      drawn.error = result.error;
  }
  if (moments.size() > kMostMoments && drawn.error.empty()) {
    drawn.error =
        fmt::format("there are {} moments, at most {} are drawn", moments.size(), kMostMoments);
  }
  return drawn;
}

}  // namespace prehend::show
