// SPDX-License-Identifier: Apache-2.0
// prehend resegment: a recorded episode under another grammar, without physics.
// Tested by tests/program/recording_test.cc
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "grammar/contents.h"
#include "grammar/name_events.h"
#include "harness/cli/command.h"
#include "harness/cli/warn.h"
#include "harness/run/load_grammar.h"
#include "harness/run/run_text.h"
#include "harness/sense/episode_file.h"

namespace prehend::harness {
namespace {

void Declare(CLI::App& options) {
  options
      .add_option("recording",
                  "a file from 'prehend run --record', or from you: docs/recording-format.md")
      ->required()
      ->expected(1);
  options.add_option("--grammar", "another grammar: a name of the library or a .grammar file")
      ->type_name("NAME|FILE")
      ->expected(1);
  options.add_option("--set", "change a parameter of the grammar (reach_radius=25cm)")
      ->type_name("NAME=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  DeclareFlag(options, "--json", "one JSON object instead of a table");
}

ExitCode Run(const CLI::App& options, const CommandContext& context) {
  ReadResult<Episode> episode = ReadEpisode(ValueOf(options, "recording"));
  if (!episode.value) return Complain(context, episode.diagnostics);
  ReadResult<grammar::Overrides> settings = ParameterSettings(ValuesOf(options, "--set"));
  if (!settings.value) return Complain(context, settings.diagnostics);
  const grammar::CompileResult compiled = LoadGrammar(
      context.root, ValueOf(options, "--grammar", episode.value->header.grammar), *settings.value);
  if (!compiled.program) return Complain(context, compiled.diagnostics);

  const grammar::EntityTable& entity_table = episode.value->header.entity_table;
  WarnOf(*compiled.program, entity_table, context);
  grammar::Monitor monitor(compiled.program, entity_table);
  std::vector<grammar::Event> events;
  for (EpisodeFrame& frame : episode.value->frames) monitor.Advance(frame.View(), events);
  monitor.Finish(episode.value->end_tick, events);
  if (!monitor.error().empty()) {
    return Complain(context, ExitCode::kBadInput,
                    "the grammar cannot watch this recording: " + monitor.error());
  }
  RunResult run;
  run.status.kind = physics::RunStatus::Kind::kCompleted;
  run.ticks = episode.value->end_tick - 1;
  run.timeline = grammar::NameEvents(*compiled.program, entity_table, events);
  if (!IsGiven(options, "--json")) {
    context.out << RunTable(run);
    return ExitCode::kAgrees;
  }
  Scenario watched;
  watched.name = episode.value->header.episode;
  watched.grammar = GrammarName(*compiled.program);
  OrderedJson json = RunJson(watched, run);
  json.erase("state_hash");  // nothing was simulated
  context.out << json.dump(2) << "\n";
  return ExitCode::kAgrees;
}

}  // namespace

Command ResegmentCommand() {
  return {.name = "resegment",
          .summary = "Segment a recorded episode again, with any grammar",
          .examples =
              "prehend run milk_carton_wrap --record milk.jsonl\n"
              "prehend resegment milk.jsonl\n"
              "prehend resegment milk.jsonl --grammar my/rules.grammar --json\n"
              "prehend resegment milk.jsonl --set lift_rise=10cm",
          .declare = Declare,
          .run = Run};
}

}  // namespace prehend::harness
