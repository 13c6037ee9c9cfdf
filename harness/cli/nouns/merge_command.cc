// SPDX-License-Identifier: Apache-2.0
// prehend episode merge. Tested by tests/program/parts.py
#include <fmt/format.h>

#include "harness/cli/command/command.h"
#include "harness/episode/episodes/plan.h"
#include "harness/episode/episodes/schema.h"

namespace prehend::cli {
namespace {

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
