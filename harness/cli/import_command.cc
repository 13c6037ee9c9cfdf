// SPDX-License-Identifier: Apache-2.0
// prehend import: poses of a tracker become a recording.
// Tested by tests/program/import_test.cc
#include <fmt/format.h>

#include "harness/base/atomic_file.h"
#include "harness/command/command.h"
#include "harness/import/import_poses.h"
#include "harness/run/load_grammar.h"
#include "harness/run/missing_facts.h"

namespace prehend::harness {
namespace {

/// Says what the grammar will miss. Its exit code: kNothing if it can recognise nothing.
ExitCode LookWith(const std::string& grammar_name, Episode& episode,
                  const CommandContext& context) {
  const grammar::CompileResult compiled = LoadGrammar(context.root, grammar_name);
  if (!compiled.program) return Complain(context, compiled.diagnostics);
  Warn(context, Warnings(*compiled.program, episode.header.entity_table));
  const MissingFacts missing = FindMissingFacts(episode, *compiled.program);
  context.err << missing.warnings;
  return missing.nothing_left ? ExitCode::kNothing : ExitCode::kAgrees;
}

ExitCode RunImport(const ParsedOptions& options, const CommandContext& context) {
  const std::string output = options.Text("--output");
  const bool check = options.Has("--check");
  if (check == !output.empty())
    return Complain(context, ExitCode::kBadInput,
                    "expected either -o, the recording to write, or --check, to write nothing");
  if (output.ends_with(".episodes"))
    return Complain(
        context, ExitCode::kBadInput,
        "poses become a recording as JSON Lines: NAME.jsonl; an episode file holds what "
        "was simulated");
  auto imported = import::ImportPoses(options.Text("poses"), options.Text("--map"));
  if (!imported) return Complain(context, imported.error());
  Episode& episode = imported->episode;
  for (const std::string& warning : imported->warnings)
    context.err << "warning: " << warning << "\n";
  ExitCode exit_code = ExitCode::kAgrees;
  if (check || options.Has("--grammar")) {
    exit_code = LookWith(options.TextOr("--grammar", episode.header.grammar), episode, context);
    if (exit_code == ExitCode::kBadInput) return exit_code;
  }
  if (!check) {
    AtomicFile file(output);
    if (!file.problem().empty()) return Complain(context, ExitCode::kBadInput, file.problem());
    EpisodeWriter writer(file.stream(), episode.header);
    for (EpisodeFrame& frame : episode.frames) writer.Write(frame.View());
    writer.Finish(episode.end_tick);
    if (const std::string problem = file.Commit(); !problem.empty())
      return Complain(context, ExitCode::kFailure, problem);
  }
  if (output != "-") context.out << import::ImportTable(*imported);
  return exit_code;
}

}  // namespace

Command ImportCommand() {
  return {
      .name = "import",
      .summary = "Make a recording of a tracker's poses",
      .examples = {"import poses.csv --map bodies.yaml --check",
                   "import poses.csv --map bodies.yaml -o take.jsonl", "resegment take.jsonl"},
      .options = {{.name = "poses",
                   .help = "a CSV file with poses of hands and things (docs/motion-capture.md)",
                   .required = true},
                  {.name = "--map",
                   .help = "what the file means: unit, axes, times, columns, bodies",
                   .placeholder = "MAP.yaml",
                   .required = true},
                  {.name = "--output",
                   .help = "the recording (docs/recording-format.md); -: standard output",
                   .placeholder = "FILE.jsonl",
                   .other_name = "-o",
                   .is_output = true},
                  {.name = "--check",
                   .help = "write nothing; show what the file has, and what a grammar will miss"},
                  {.name = "--grammar",
                   .help = "the grammar to look with; default: that of the map",
                   .placeholder = "GRAMMAR"}},
      .run = RunImport};
}

}  // namespace prehend::harness
