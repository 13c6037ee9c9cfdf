// SPDX-License-Identifier: Apache-2.0
// prehend scenario schema. Tested by tests/program/command_line_test.cc

#include "harness/command/command.h"
#include "harness/format/scenario_fields.h"
#include "harness/import/import_map.h"

namespace prehend::harness {
namespace {

ExitCode RunSchema(const ParsedOptions& options, const CommandContext& context) {
  context.out << (options.Has("--import-map") ? import::ImportMapSchema() : ScenarioSchema());
  return ExitCode::kAgrees;
}

}  // namespace

Command SchemaCommand() {
  return {.name = "scenario schema",
          .summary = "Print the JSON Schema of scenario files",
          .examples = {"scenario schema > scenarios/scenario.schema.json"},
          .options = {{.name = "--import-map",
                       .help = "that of the maps of 'prehend import' (docs/motion-capture.md)"}},
          .run = RunSchema};
}

}  // namespace prehend::harness
