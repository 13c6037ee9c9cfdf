// SPDX-License-Identifier: Apache-2.0
// prehend episode list: what episode files hold. prehend episode verify: their frames, checked
// against their state hashes. prehend episode merge. Tested by tests/program/episodes_test.cc and
// tests/program/parts.py
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/cli/command/command.h"
#include "harness/episode/episode/resegment_many.h"
#include "harness/episode/episodes/episode_file.h"
#include "harness/episode/episodes/plan.h"
#include "harness/episode/episodes/schema.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::cli {
namespace {

using Json = nlohmann::ordered_json;

Json RowJson(const std::string& file, const episode::EpisodeRow& row) {
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
    if (episode::EpisodeKindOf(path) != episode::EpisodeKind::kEpisodeFile) {
      const auto other = episode::FindEpisodes({&path, 1}, "", context.root);
      return other ? Refuse(context, episode::Lack(*other, episode::Need::kEpisodeFile))
                   : Complain(context, other.error());
    }
    const auto file = episode::EpisodeFile::Open(path);
    if (!file) return Complain(context, file.error());
    for (const episode::EpisodeRow& row : file->episodes()) {
      json.push_back(RowJson(path, row));
      table.push_back(
          {std::to_string(row.id), row.status, truth::SecondsText(row.ticks, row.ticks_per_second),
           row.state_hash.empty() ? "-" : row.state_hash, row.recorded_on, row.scenario});
    }
  }
  if (options.Has("--json")) {
    context.out << json.dump(2) << "\n";
  } else {
    for (const std::string& line : truth::AlignColumns(table)) context.out << line << "\n";
  }
  return json.empty() ? ExitCode::kNothing : ExitCode::kAgrees;
}

ExitCode RunVerify(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(const auto selected,
              FindEpisodesOrComplain("files", options, context, {episode::Need::kEpisodeFile}));
  const std::vector<episode::Resegmented> results =
      episode::ResegmentAll(selected, {.root = context.root,
                                       .compare = true,
                                       .replay = true,
                                       .jobs = options.IntOr("--jobs", CoreCount())});
  ExitCode worst = ExitCode::kAgrees;
  std::size_t same = 0, unfinished = 0;
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const episode::Resegmented& result : results) {
    const std::string heading = fmt::format("episode {} of {}: {}\n", *result.episode.number,
                                            result.episode.file, result.episode.scenario);
    if (!result.problem.empty()) {
      context.err << result.problem;
      worst = ExitCode::kBadInput;
    } else if (!result.differences.empty()) {
      context.err << heading << result.differences;
      if (worst == ExitCode::kAgrees) worst = ExitCode::kDiffers;
    } else if (result.finished) {
      ++same;
    } else {
      ++unfinished;
    }
    json.push_back({{"file", result.episode.file},
                    {"episode", *result.episode.number},
                    {"scenario", result.episode.scenario},
                    {"finished", result.finished},
                    {"same", result.problem.empty() && result.differences.empty()}});
  }
  if (options.Has("--json")) {
    context.out << json.dump(2) << "\n";
  } else {
    context.out << fmt::format("{} of {} episodes have the frames and events that were recorded\n",
                               same, results.size());
    if (unfinished > 0)
      context.out << fmt::format(
          "{} were cut off while they were recorded: nothing to compare with\n", unfinished);
  }
  return worst;
}

constexpr int kMostParts = 10'000;

ExitCode RunMerge(const ParsedOptions& options, const CommandContext& context) {
  const std::vector<std::string> files = options.All("files");
  const std::string output = options.Text("--output");
  if (!episode::IsEpisodeFile(output))
    return Refuse(context, "--output: found '" + output + "', wanted a file NAME.episodes");
  const auto merged = episode::MergeEpisodes(files, output);
  if (!merged) return Complain(context, merged.error());
  context.out << fmt::format("{}: {} episodes of {} files", output, merged->episodes, files.size());
  if (merged->twice > 0) context.out << fmt::format("; {} were there twice", merged->twice);
  context.out << "\n" << std::flush;
  context.err << merged->missing;
  const int wanted = options.IntOr("--expect", static_cast<int>(files.size()));
  if (wanted != static_cast<int>(files.size()))
    context.err << fmt::format("--expect: found {} files, wanted {}\n", files.size(), wanted);
  const bool whole = merged->missing.empty() && wanted == static_cast<int>(files.size());
  return whole ? ExitCode::kAgrees : ExitCode::kFailure;
}

}  // namespace

Command EpisodesCommand() {
  return {.name = "episode list",
          .summary = "List what episode files hold",
          .examples = {"episode list suite.episodes",
                       "episode list monday.episodes tuesday.episodes --json"},
          .options = {EpisodeFilesArgument(), JsonOption()},
          .run = RunEpisodes};
}

Command VerifyCommand() {
  return {.name = "episode verify",
          .summary = "Read every frame of recorded episodes again and check them by their hashes",
          .examples = {"episode verify suite.episodes",
                       "episode verify suite.episodes --episode 'slide/*'"},
          .options = {EpisodeFilesArgument(), EpisodesOption(), JobsOption(), JsonOption()},
          .run = RunVerify};
}

Command MergeCommand() {
  return {.name = "episode merge",
          .summary = "Make one file of the parts of a suite or of many trials",
          .examples = {"episode merge part-*.episodes -o all.episodes",
                       "episode merge part-*.episodes -o all.episodes --expect 16"},
          .options = {EpisodeFilesArgument(),
                      Required(OutputOption("NAME.episodes, which gets each episode once")),
                      Value("--expect", "N", "so many files must be there: exit code 3",
                            IntegersFrom(1, kMostParts))},
          .run = RunMerge,
          .note =
              "What a part owes and does not have is named, and the exit code is 3; the file is "
              "written all\nthe same, and says so, too. An episode that two files have is written "
              "once if it is the same\nin both; otherwise nothing is written."};
}

}  // namespace prehend::cli
