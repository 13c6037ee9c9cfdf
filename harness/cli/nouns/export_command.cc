// SPDX-License-Identifier: Apache-2.0
// prehend episode export: motion and events for other programs. Tested by
// tests/program/exported.py
#include <fmt/format.h>

#include "harness/cli/command/command.h"
#include "harness/exchange/export/export_episode.h"

namespace prehend::cli {
namespace {

std::string FormatProblem(const std::string& text) {
  return exchange::EndingOf(text).empty() ? "found '" + text + "', wanted mcap, csv, jsonl or npz"
                                          : "";
}

ExitCode RunExport(const ParsedOptions& options, const CommandContext& context) {
  const auto episodes = FindEpisodesOrComplain("EPISODES", options, context);
  if (!episodes) return episodes.error();
  const auto files = exchange::ExportEpisodes(
      *episodes, {.root = context.root,
                  .ending = exchange::EndingOf(options.Text("--to")),
                  .output = options.Text("--output"),
                  .choice = {options.Text("--grammar"), options.All("--set")}});
  if (!files) return Complain(context, files.error());
  ExitCode worst = ExitCode::kAgrees;
  for (const exchange::Exported& file : *files) {
    context.err << file.warnings;
    context.out << fmt::format("{}: {} frames, {} events\n", file.file, file.frames, file.events);
    if (!file.failure.empty()) worst = Complain(context, ExitCode::kFailure, file.failure);
  }
  return worst;
}

}  // namespace

Command ExportCommand() {
  return {.name = "episode export",
          .summary = "Write motion and events for other programs: MCAP (ROS 2), CSV, NumPy",
          .examples = {"episode export milk_carton_wrap --to mcap -o bags",
                       "episode export suite.episodes --episode 'slide/*' --to csv -o poses",
                       "episode export take.jsonl --to npz -o take.npz"},
          .options = {EpisodesArgument(), EpisodesOption(),
                      Required({.name = "--to",
                                .help = "mcap, csv (poses and events), jsonl (a recording) or npz",
                                .placeholder = "mcap|csv|jsonl|npz",
                                .rule = {.range = {}, .problem = FormatProblem}}),
                      Required(OutputOption("the folder, which gets a file per episode; of one "
                                            "episode a file with the format's ending",
                                            "PATH")),
                      GrammarOption(), SettingsOption()},
          .run = RunExport};
}

}  // namespace prehend::cli
