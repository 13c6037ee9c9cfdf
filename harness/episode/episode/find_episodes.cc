// SPDX-License-Identifier: Apache-2.0
// See harness/episode/episode/find_episodes.h. Tested by tests/program/episode_kinds_test.cc
#include "harness/episode/episode/find_episodes.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "harness/base/base/shell_quote.h"
#include "harness/episode/episodes/episode_file.h"
#include "harness/episode/episodes/schema.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/sense/episode_stream.h"

namespace prehend::episode {
namespace {

bool IsJsonLines(const std::string& typed) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(typed, error)) return typed.ends_with(".jsonl");
  if (typed.ends_with(".yaml") || typed.ends_with(".yml")) return false;
  std::ifstream file(typed, std::ios::binary);
  return file.get() == '{';
}

/// "" if the recording cannot be read, which whoever reads all of it reports.
std::string GrammarNamedIn(const std::string& recording) {
  std::ifstream in(recording);
  std::string line;
  EpisodeStream stream(recording);
  const bool is_read = std::getline(in, line) && stream.Take(line).empty() && stream.has_header();
  return is_read ? stream.header().grammar : "";
}

bool IsSelected(const EpisodeName& episode, const std::string& which) {
  const std::string& scenario = episode.scenario;
  if (which.empty() || std::to_string(*episode.number) == which || scenario == which) return true;
  return scenario.substr(scenario.rfind('/') + 1) == which ||
         fnmatch(which.c_str(), scenario.c_str(), 0) == 0;
}

tl::expected<EpisodeName, NotFound> ScenarioNamed(const std::string& typed,
                                                  const std::string& root) {
  const std::vector<ScenarioFile> scenarios = ListScenarios(root);
  auto path = FindScenario(scenarios, typed);
  if (!path) path = FindScenario(ShippedScenarios(root), typed);
  if (path)
    return EpisodeName{.file = *path, .number = {}, .scenario = IdOf(ScenarioAt(scenarios, *path))};
  NotFound none{.exit_code = ExitCode::kNothing, .message = "no scenario '" + typed + "'"};
  const std::string hint = HintForScenario(scenarios, typed);
  if (!hint.empty()) none.message += "; " + hint;
  none.message += " ('" + CommandText({"list"}) + "' shows all)";
  none.typed = typed;
  none.nearest = NearestScenario(scenarios, typed);
  return tl::unexpected(std::move(none));
}

}  // namespace

EpisodeKind EpisodeKindOf(const std::string& typed) {
  if (IsEpisodeFile(typed)) return EpisodeKind::kEpisodeFile;
  return IsJsonLines(typed) ? EpisodeKind::kJsonLines : EpisodeKind::kScenario;
}

Result<std::vector<EpisodeName>> EpisodesOf(const std::string& path) {
  const auto file = EpisodeFile::Open(path);
  if (!file) return tl::unexpected(file.error());
  if (file->episodes().empty())
    return tl::unexpected(
        grammar::Diagnostics{{.file = path,
                              .place = {},
                              .message = "has no episodes",
                              .source_line = {},
                              .hint = "its recording ended before the first one began"}});
  std::vector<EpisodeName> names;
  for (const EpisodeRow& row : file->episodes())
    names.push_back({path, row.id, row.scenario,
                     row.simulated ? Origin::kRecordedRun : Origin::kRecording, row.grammar});
  return names;
}

tl::expected<std::vector<EpisodeName>, NotFound> FindEpisodes(std::span<const std::string> typed,
                                                              const std::string& which,
                                                              const std::string& root) {
  std::vector<EpisodeName> names;
  NotFound unread;
  const auto is_kept = [](const std::string& one) {
    return EpisodeKindOf(one) == EpisodeKind::kEpisodeFile;
  };
  if (!which.empty() && std::ranges::none_of(typed, is_kept))
    return tl::unexpected(
        NotFound{ExitCode::kBadInput,
                 fmt::format("--episode needs episode files; {} is none", typed.front())});
  for (const std::string& one : typed) {
    const EpisodeKind kind = EpisodeKindOf(one);
    if (kind == EpisodeKind::kJsonLines) {
      names.push_back({one,
                       {},
                       std::filesystem::path(one).stem().string(),
                       Origin::kRecording,
                       GrammarNamedIn(one)});
    } else if (kind == EpisodeKind::kScenario) {
      auto scenario = ScenarioNamed(one, root);
      if (!scenario) return tl::unexpected(std::move(scenario.error()));
      names.push_back(std::move(*scenario));
    } else if (const auto kept = EpisodesOf(one)) {
      std::ranges::copy_if(*kept, std::back_inserter(names),
                           [&](const EpisodeName& episode) { return IsSelected(episode, which); });
    } else {
      std::ranges::copy(kept.error(), std::back_inserter(unread.diagnostics));
    }
  }
  if (!unread.diagnostics.empty()) return tl::unexpected(std::move(unread));
  if (names.empty())
    return tl::unexpected(
        NotFound{ExitCode::kNothing, fmt::format("--episode: no episode matches '{}'", which)});
  return names;
}

tl::expected<EpisodeName, NotFound> FindEpisode(const std::string& typed, const std::string& which,
                                                const std::string& root) {
  auto found = FindEpisodes({&typed, 1}, which, root);
  if (!found) return tl::unexpected(std::move(found.error()));
  if (found->size() == 1) return std::move(found->front());
  return tl::unexpected(
      NotFound{ExitCode::kNothing,
               fmt::format("{} has {} such episodes; --episode selects one, and '{}' shows all",
                           typed, found->size(), CommandText({"episode", "list", typed}))});
}

}  // namespace prehend::episode
