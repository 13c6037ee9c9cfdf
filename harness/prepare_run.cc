// SPDX-License-Identifier: Apache-2.0
// See prepare_run.h. Tested by tests/house/command_line_test.cc
#include "harness/prepare_run.h"

#include "grammar/program.h"
#include "harness/library_paths.h"
#include "harness/load_grammar.h"

namespace prehend::harness {
namespace {

struct Settings {
  std::vector<std::string> of_scenario;
  grammar::Overrides of_grammar;
  grammar::Diagnostics diagnostics;
};

Settings Split(const std::vector<std::string>& settings) {
  Settings split;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    const std::string name = setting.substr(0, equals);
    if (equals == std::string::npos || name.empty()) {
      split.diagnostics.push_back(
          grammar::DiagnosticAt("--set", setting, {1, 1}, "expected name=value",
                                "--set reach_radius=25cm, --set entities.milk.mass_kg=8"));
    } else if (name.find('.') != std::string::npos) {
      split.of_scenario.push_back(setting);
    } else {
      split.of_grammar[name] = setting.substr(equals + 1);
    }
  }
  return split;
}

}  // namespace

ReadResult<PreparedRun> PrepareRun(const RunRequest& request, const std::string& root) {
  Settings settings = Split(request.settings);
  if (!settings.diagnostics.empty()) return {std::nullopt, std::move(settings.diagnostics)};
  if (!request.pictures.empty()) settings.of_scenario.push_back("pictures=" + request.pictures);
  ReadResult<Scenario> scenario =
      ReadScenario(request.scenario_file, settings.of_scenario, ProjectLibrary(root));
  if (!scenario.value) return {std::nullopt, std::move(scenario.diagnostics)};
  if (!request.grammar.empty()) scenario.value->grammar = request.grammar;
  grammar::CompileResult compiled = LoadGrammar(root, scenario.value->grammar, settings.of_grammar);
  if (!compiled.program) return {std::nullopt, std::move(compiled.diagnostics)};
  scenario.value->grammar = compiled.program->name;
  return {PreparedRun{std::move(*scenario.value), std::move(compiled.program)}, {}};
}

std::string ScenarioId(const std::string& skill, const std::string& name) {
  return skill.empty() ? name : skill + "/" + name;
}

std::set<std::string> MovableEntities(const Scenario& scenario) {
  std::set<std::string> movable;
  for (const physics::Body& body : scenario.scene.bodies) {
    if (!body.fixed) movable.insert(body.name);
  }
  return movable;
}

}  // namespace prehend::harness
