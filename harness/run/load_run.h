// SPDX-License-Identifier: Apache-2.0
// Everything a run needs, from files: the scenario and its compiled grammar, with what the command
// line changes. Tested by tests/program/command_line_test.cc
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "grammar/monitor.h"
#include "harness/base/read_result.h"
#include "harness/scenario/scenario.h"

namespace prehend::harness {

struct RunRequest {
  std::string scenario_file;
  std::string grammar;                ///< name or path; empty: the scenario's own
  std::vector<std::string> settings;  ///< "name=value": a field of the scenario when the name has a
                                      ///< dot or is that of a field, else a parameter
};

struct LoadedRun {
  Scenario scenario;  ///< its `grammar` is what the one that is used calls itself
  std::shared_ptr<const grammar::Program> program;
  grammar::Diagnostics
      warnings;  ///< of scenario and grammar: what is allowed and yet looks like a mistake
};

/// `files` gets every path that was looked at, also when the result is no run.
ReadResult<LoadedRun> LoadRun(const RunRequest& request, const std::string& root,
                              std::vector<std::string>* files = nullptr);

/// Whether this name in a setting means a field of the scenario, and not a parameter of its
/// grammar.
bool IsFieldOfScenario(const std::string& name);

/// "name=value" settings that can only mean parameters of a grammar.
ReadResult<grammar::Overrides> ParameterSettings(const std::vector<std::string>& settings);

/// "skill/name": how goldens, reports and the command line call it.
std::string ScenarioId(const std::string& skill, const std::string& name);

}  // namespace prehend::harness
