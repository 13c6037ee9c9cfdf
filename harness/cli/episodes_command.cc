// SPDX-License-Identifier: Apache-2.0
// prehend episodes: what episode files hold. Tested by tests/program/episodes_test.cc
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/cli/command.h"
#include "harness/episodes/episode_file.h"
#include "harness/timeline/event_text.h"

namespace prehend::harness {
namespace {

using Json = nlohmann::ordered_json;

Json RowJson(const std::string& file, const episodes::EpisodeRow& row) {
  return {{"file", file},
          {"episode", row.id},
          {"uuid", row.uuid},
          {"scenario", row.scenario},
          {"status", row.status},
          {"seconds", static_cast<double>(row.ticks) / static_cast<double>(row.ticks_per_second)},
          {"grammar", row.grammar},
          {"outcome", row.outcome},
          {"state_hash", row.state_hash},
          {"recorded_on", row.recorded_on}};
}

ExitCode RunEpisodes(const ParsedOptions& options, const CommandContext& context) {
  std::vector<std::vector<std::string>> table = {
      {"episode", "status", "seconds", "state_hash", "recorded_on", "scenario"}};
  Json json = Json::array();
  for (const std::string& path : options.All("files")) {
    const auto file = episodes::EpisodeFile::Open(path);
    if (!file) return Complain(context, file.error());
    for (const episodes::EpisodeRow& row : file->episodes()) {
      json.push_back(RowJson(path, row));
      table.push_back(
          {std::to_string(row.id), row.status, SecondsText(row.ticks, row.ticks_per_second),
           row.state_hash.empty() ? "-" : row.state_hash, row.recorded_on, row.scenario});
    }
  }
  if (options.Has("--json")) {
    context.out << json.dump(2) << "\n";
  } else {
    for (const std::string& line : AlignColumns(table)) context.out << line << "\n";
  }
  return json.empty() ? ExitCode::kNothing : ExitCode::kAgrees;
}

}  // namespace

Command EpisodesCommand() {
  return {
      .name = "episodes",
      .summary = "List what episode files hold",
      .examples = {"episodes suite.episodes", "episodes monday.episodes tuesday.episodes --json"},
      .options = {{.name = "files",
                   .help = "files from 'run --record' or 'check --record' (docs/episodes.md)",
                   .required = true,
                   .repeatable = true},
                  {.name = "--json", .help = "print a JSON array instead of a table"}},
      .run = RunEpisodes};
}

}  // namespace prehend::harness
