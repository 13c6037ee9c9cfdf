// SPDX-License-Identifier: Apache-2.0
// prehend resegment: a recorded episode under another grammar, without physics.
// Tested by tests/program/recording_test.cc
#include <nlohmann/json.hpp>

#include "grammar/contents.h"
#include "grammar/name_events.h"
#include "harness/cli/command.h"
#include "harness/run/load_grammar.h"
#include "harness/run/run_text.h"
#include "harness/sense/episode_file.h"

namespace prehend::harness {
namespace {

ExitCode RunResegment(const ParsedOptions& options, const CommandContext& context) {
  Result<Episode> episode = ReadEpisode(options.Text("recording"));
  if (!episode) return Complain(context, episode.error());
  Result<grammar::Overrides> settings = ParameterSettings(options.All("--set"));
  if (!settings) return Complain(context, settings.error());
  const grammar::CompileResult compiled =
      LoadGrammar(context.root, options.TextOr("--grammar", episode->header.grammar), *settings);
  if (!compiled.program) return Complain(context, compiled.diagnostics);

  const grammar::EntityTable& entity_table = episode->header.entity_table;
  Warn(context, Warnings(*compiled.program, entity_table));
  grammar::Monitor monitor(compiled.program, entity_table);
  std::vector<grammar::Event> events;
  for (EpisodeFrame& frame : episode->frames) monitor.Advance(frame.View(), events);
  monitor.Finish(episode->end_tick, events);
  if (!monitor.error().empty()) {
    return Complain(context, ExitCode::kBadInput,
                    "the grammar cannot segment this recording: " + monitor.error());
  }
  RunResult run;
  run.status.kind = physics::RunStatus::Kind::kCompleted;
  run.ticks = episode->end_tick - 1;
  run.timeline = grammar::NameEvents(*compiled.program, entity_table, events);
  if (!options.Has("--json")) {
    context.out << RunTable(run);
    return ExitCode::kAgrees;
  }
  Scenario watched;
  watched.name = episode->header.episode;
  watched.grammar = GrammarName(*compiled.program);
  OrderedJson json = RunJson(watched, run);
  json.erase("state_hash");  // nothing was simulated
  context.out << json.dump(2) << "\n";
  return ExitCode::kAgrees;
}

}  // namespace

Command ResegmentCommand() {
  return {
      .name = "resegment",
      .summary = "Segment a recorded episode again, with any grammar",
      .examples = {"run milk_carton_wrap --record milk.jsonl", "resegment milk.jsonl",
                   "resegment milk.jsonl --grammar my/rules.grammar --json",
                   "resegment milk.jsonl --set lift_rise=10cm"},
      .options = {{.name = "recording",
                   .help = "a file from 'run --record', or your own (docs/recording-format.md)",
                   .required = true},
                  GrammarOption(),
                  {.name = "--set",
                   .help = "set a parameter of the grammar (reach_radius=25cm); may be repeated",
                   .placeholder = "NAME=VALUE",
                   .repeatable = true},
                  {.name = "--json", .help = "print one JSON object instead of a table"}},
      .run = RunResegment};
}

}  // namespace prehend::harness
