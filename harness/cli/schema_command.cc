// SPDX-License-Identifier: Apache-2.0
// prehend schema. Tested by tests/program/command_line_test.cc
#include <CLI/CLI.hpp>

#include "harness/cli/command.h"
#include "harness/format/scenario_fields.h"

namespace prehend::harness {
namespace {

void Declare(CLI::App&) {}

ExitCode Run(const CLI::App&, const CommandContext& context) {
  context.out << ScenarioSchema();
  return ExitCode::kAgrees;
}

}  // namespace

Command SchemaCommand() {
  return {.name = "schema",
          .summary = "Print the JSON Schema of scenario files",
          .examples = "prehend schema > scenarios/scenario.schema.json",
          .declare = Declare,
          .run = Run};
}

}  // namespace prehend::harness
