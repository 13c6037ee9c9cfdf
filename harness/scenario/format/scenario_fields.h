// SPDX-License-Identifier: Apache-2.0
// The scenario format, version 1: every key, declared once. The reader and `prehend scenario
// schema` both come from here; docs/scenario-format.md explains it to people. Tested by
// tests/harness/scenario/format/scenario_fields_test.cc
#pragma once

#include <string>

#include "harness/scenario/format/scenario_yaml.h"

namespace prehend::scenario {

/// Built once: its schemas take longer to build than most scenarios take to read.
const ValueFormat<ScenarioYaml>& ScenarioFormat();

/// The JSON Schema (2020-12) of scenario files, for editors and validators, with a newline at its
/// end.
std::string ScenarioSchema();

}  // namespace prehend::scenario
