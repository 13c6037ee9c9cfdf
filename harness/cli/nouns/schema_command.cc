// SPDX-License-Identifier: Apache-2.0
// prehend scenario schema. Tested by tests/program/command_line_test.cc

#include "harness/cli/command/command.h"
#include "harness/exchange/poses/import_map.h"
#include "harness/scenario/format/scenario_fields.h"

namespace prehend::cli {
namespace {

ExitCode RunSchema(const ParsedOptions& options, const CommandContext& context) {
  context.out << (options.Has("--import-map") ? exchange::ImportMapSchema()
                                              : scenario::ScenarioSchema());
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

}  // namespace prehend::cli
