// SPDX-License-Identifier: Apache-2.0
// The scenario format, version 1: every key, declared once. The reader and `prehend scenario
// schema` both come from here; docs/scenario-format.md explains it to people. Tested by
// tests/harness/scenario/format/scenario_fields_test.cc
#pragma once

#include <filesystem>
#include <string>

#include "harness/base/base/result.h"
#include "harness/scenario/format/scenario_yaml.h"

namespace prehend::scenario {

/// A grammar, or a list of them, which are joined with '+'.
ValueFormat<std::string> OneOrJoined(const ValueFormat<std::string>& one);

/// Built once: its schemas take longer to build than most scenarios take to read.
const ValueFormat<ScenarioYaml>& ScenarioFormat();

/// The JSON Schema (2020-12) of scenario files, for editors and validators, with a newline at its
/// end.
std::string ScenarioSchema();

/// `text` of the scenario `from`, changed for the file `to`, its comments and layout kept: its name
/// is that of the new file, and the paths of its recordings, hands and grasps are relative to the
/// new folder. On failure: the errors of the YAML.
Result<std::string> CopyOfScenario(const std::filesystem::path& from, const std::string& text,
                                   const std::filesystem::path& to);

}  // namespace prehend::scenario
