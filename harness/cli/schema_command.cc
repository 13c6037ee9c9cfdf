// SPDX-License-Identifier: Apache-2.0
// prehend schema. Tested by tests/program/command_line_test.cc

#include "harness/command/command.h"
#include "harness/format/scenario_fields.h"

namespace prehend::harness {
namespace {

ExitCode RunSchema(const ParsedOptions&, const CommandContext& context) {
  context.out << ScenarioSchema();
  return ExitCode::kAgrees;
}

}  // namespace

Command SchemaCommand() {
  return {.name = "schema",
          .summary = "Print the JSON Schema of scenario files",
          .examples = {"schema > scenarios/scenario.schema.json"},
          .options = {},
          .run = RunSchema};
}

}  // namespace prehend::harness
