// SPDX-License-Identifier: Apache-2.0
// prehend episode label: sub-tasks of demonstrations, written back. Tested by
// tests/program/labels_back.py
#include <fmt/format.h>

#include <algorithm>

#include "harness/cli/command/command.h"
#include "harness/exchange/subtasks/label_episodes.h"

namespace prehend::cli {
namespace {

std::string TableProblem(const std::string& text) {
  return text == "csv" || text == "frames" ? "" : "found '" + text + "', wanted csv or frames";
}

ExitCode RunLabel(const ParsedOptions& options, const CommandContext& context) {
  const std::string write = options.Text("--write"), output = options.Text("--output");
  if (write.empty() == output.empty() || output.empty() == options.Has("--to"))
    return Complain(context, ExitCode::kBadInput,
                    "expected either --write OUT.hdf5, or --to csv|frames with -o FILE");
  const auto episodes = FindEpisodesOrComplain("EPISODES", options, context);
  if (!episodes) return episodes.error();
  const auto labelled = exchange::LabelEpisodes(
      *episodes, {.root = context.root,
                  .choice = {options.Text("--grammar"), options.All("--set")},
                  .map = options.Text("--map"),
                  .hdf5 = write,
                  .table = output,
                  .frames = options.Text("--to") == "frames"});
  if (!labelled) return Complain(context, labelled.error());
  for (const exchange::Subtasks& one : *labelled) {
    if (!one.missing.empty())
      context.err << "prehend: " << one.episode << " is left without labels: " << one.missing
                  << "\n";
  }
  const auto whole = std::ranges::count(*labelled, "", &exchange::Subtasks::missing);
  context.out << fmt::format("{}{}: {} of {} episodes are labelled\n", write, output, whole,
                             labelled->size());
  return whole == std::ssize(*labelled) ? ExitCode::kAgrees : ExitCode::kDiffers;
}

}  // namespace

Command LabelCommand() {
  return {.name = "episode label",
          .summary = "Write the sub-tasks of robot demonstrations back, or as a table",
          .examples = {"episode label demos.episodes --map stack.yaml --write labelled.hdf5",
                       "episode label demos.episodes --map stack.yaml --to frames -o frames.csv"},
          .options = {EpisodesArgument(),
                      EpisodesOption(),
                      Required({.name = "--map",
                                .help = "the map that they were imported with, with its labels",
                                .placeholder = "MAP.yaml"}),
                      {.name = "--write",
                       .help = "a copy of their HDF5 file with signals of sub-tasks, as Isaac Lab "
                               "and MimicGen read them",
                       .placeholder = "OUT.hdf5",
                       .is_output = true},
                      {.name = "--to",
                       .help = "csv: a row per sub-task; frames: a row per frame",
                       .placeholder = "csv|frames",
                       .rule = {.range = {}, .problem = TableProblem}},
                      OutputOption("the table of --to"),
                      GrammarOption(),
                      ParametersOption()},
          .run = RunLabel};
}

}  // namespace prehend::cli
