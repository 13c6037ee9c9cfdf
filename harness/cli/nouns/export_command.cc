// SPDX-License-Identifier: Apache-2.0
// prehend episode export: motion and events for other programs. prehend episode label: sub-tasks of
// demonstrations, written back. prehend episode knowledge: recorded episodes for knowledge bases.
// Tested by tests/program/exported.py, tests/program/labels_back.py and
// tests/program/knowledge_test.cc
#include <fmt/format.h>

#include <algorithm>

#include "harness/cli/command/command.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/exchange/export/export_episode.h"
#include "harness/exchange/knowledge/write_knowledge.h"
#include "harness/exchange/subtasks/label_episodes.h"

namespace prehend::cli {
namespace {

ExitCode RunExport(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(const auto episodes, FindEpisodesOrComplain("EPISODES", options, context));
  const auto files = exchange::ExportEpisodes(
      episodes, {.root = context.root,
                 .ending = "." + options.Text("--to"),
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

ExitCode RunLabel(const ParsedOptions& options, const CommandContext& context) {
  const std::string output = options.Text("--output");
  const bool is_copy = output.ends_with(".hdf5") || output.ends_with(".h5");
  if (is_copy == options.Has("--to"))
    return Refuse(context, "expected either -o OUT.hdf5, or --to csv|frames with -o FILE");
  PREHEND_TRY(const auto episodes, FindEpisodesOrComplain("EPISODES", options, context));
  const auto labelled = exchange::LabelEpisodes(
      episodes, {.root = context.root,
                 .choice = {options.Text("--grammar"), options.All("--set")},
                 .map = options.Text("--map"),
                 .hdf5 = is_copy ? output : "",
                 .table = output,
                 .frames = options.Text("--to") == "frames"});
  if (!labelled) return Complain(context, labelled.error());
  for (const exchange::Subtasks& one : *labelled) {
    if (!one.missing.empty())
      context.err << "prehend: " << one.episode << " is left without labels: " << one.missing
                  << "\n";
  }
  const auto whole = std::ranges::count(*labelled, "", &exchange::Subtasks::missing);
  context.out << fmt::format("{}: {} of {} episodes are labelled\n", output, whole,
                             labelled->size());
  return whole == std::ssize(*labelled) ? ExitCode::kAgrees : ExitCode::kDiffers;
}

ExitCode RunKnowledge(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(auto episodes, FindEpisodesOrComplain("EPISODES", options, context, {}));
  const std::vector<std::string> forms = options.All("--also");
  const auto asked = [&](const char* form) {
    return std::ranges::find(forms, form) != forms.end();
  };
  const std::string folder = options.TextOr("--output", "kb");
  const auto kept = episode::EpisodeKeeper(context.root, context.today, folder).KeepAll(episodes);
  if (!kept) return Complain(context, kept.error());
  const Result<exchange::KnowledgeWritten> written = exchange::WriteKnowledge(
      *kept, {.root = context.root, .folder = folder, .owl = asked("owl"), .neem = asked("neem")});
  if (!written) return Complain(context, written.error());
  context.out << fmt::format("{}: {} episodes of {} tasks, {} events, {} statements\n", folder,
                             written->episodes, written->tasks, written->events,
                             written->statements);
  return ExitCode::kAgrees;
}

}  // namespace

Command ExportCommand() {
  return {.name = "episode export",
          .summary = "Write motion and events for other programs: MCAP (ROS 2), CSV, NumPy",
          .examples = {"episode export milk_carton_wrap --to mcap -o bags",
                       "episode export suite.episodes --episode 'slide/*' --to csv -o poses",
                       "episode export take.jsonl --to npz -o take.npz"},
          .options = {EpisodesArgument(), EpisodesOption(),
                      Required(Value("--to", "mcap|csv|jsonl|npz",
                                     "mcap, csv (poses and events), jsonl (a recording) or npz",
                                     OneOf({"mcap", "csv", "jsonl", "npz"}))),
                      Required(OutputOption("the folder, which gets a file per episode; of one "
                                            "episode a file with the format's ending",
                                            "PATH")),
                      GrammarOption(), SettingsOption()},
          .run = RunExport};
}

Command LabelCommand() {
  return {.name = "episode label",
          .summary = "Write the sub-tasks of robot demonstrations back, or as a table",
          .examples = {"episode label demos.episodes --map stack.yaml -o labelled.hdf5",
                       "episode label demos.episodes --map stack.yaml --to frames -o frames.csv"},
          .options = {EpisodesArgument(), EpisodesOption(),
                      Required(Value("--map", "MAP.yaml",
                                     "the map that they were imported with, with its labels")),
                      Value("--to", "csv|frames",
                            "a table instead; csv: a row per sub-task; frames: a row per frame",
                            OneOf({"csv", "frames"})),
                      Required(OutputOption(
                          "NAME.hdf5, a copy of their HDF5 file with signals of sub-tasks, as "
                          "Isaac Lab and MimicGen read them; or the table of --to")),
                      GrammarOption(), ParametersOption()},
          .run = RunLabel};
}

Command KnowledgeCommand() {
  return {
      .name = "episode knowledge",
      .summary = "Write recorded episodes for knowledge bases (RDF, OWL, NEEM)",
      .examples =
          {"episode knowledge suite.episodes -o kb",
           "episode knowledge suite.episodes --episode 'slide/*' --also owl --also neem -o kb"},
      .options = {EpisodesArgument(),
                  {.name = "--output",
                   .help = "the folder; default: kb. It gets prehend.ttl, maps/ and episodes/",
                   .placeholder = "FOLDER",
                   .other_name = "-o",
                   .is_output = true},
                  Repeatable(Value("--also", "owl|neem",
                                   "also as owl (RDF/XML beside each Turtle file) or neem (BSON "
                                   "collections as mongodump writes them); may be repeated",
                                   OneOf({"owl", "neem"}))),
                  EpisodesOption()},
      .run = RunKnowledge};
}

}  // namespace prehend::cli
