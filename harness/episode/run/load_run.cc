// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/load_run.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "grammar/contents.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_grammar.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/scenario/format/scenario_fields.h"

namespace prehend::episode {

namespace {

class ClaimDiagnostics {
 public:
  ClaimDiagnostics(const scenario::Scenario& scenario, const YamlDocument& document)
      : scenario_(scenario), text_(document.sources.front().text) {}

  void Add(const truth::Claim& claim, const std::vector<truth::ClaimProblem>& problems) {
    for (const truth::ClaimProblem& problem : problems) {
      const Where where = truth::PlaceIn(claim, problem.offset);
      const bool in_file = where.source == 0;
      diagnostics_.push_back(grammar::DiagnosticAt(in_file ? scenario_.file : "--set",
                                                   in_file ? text_ : "", where.place,
                                                   "expects: " + problem.message, problem.hint));
    }
  }

  grammar::Diagnostics Take() { return std::move(diagnostics_); }

 private:
  const scenario::Scenario& scenario_;
  const std::string& text_;
  grammar::Diagnostics diagnostics_;
};

struct Settings {
  std::vector<std::string> of_scenario;
  grammar::Overrides of_grammar;
  grammar::Diagnostics diagnostics;
};

/// `is_field`: whether a name means a field of the scenario.
Settings Split(const std::vector<std::string>& settings,
               const std::function<bool(const std::string&)>& is_field) {
  Settings split;
  std::set<std::string> seen;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    const std::string name = setting.substr(0, equals);
    const auto report = [&](const char* message, const std::string& hint) {
      split.diagnostics.push_back(grammar::DiagnosticAt("--set", setting, {1, 1}, message, hint));
    };
    if (equals == std::string::npos || name.empty() || equals + 1 == setting.size()) {
      report("expected NAME=VALUE", "--set reach_radius=25cm, --set entities.milk.mass_kg=8");
    } else if (!seen.insert(name).second) {
      report("the same name is set twice", "give each --set a name of its own");
    } else if (is_field(name)) {
      split.of_scenario.push_back(setting);
    } else {
      split.of_grammar[name] = setting.substr(equals + 1);
    }
  }
  return split;
}

/// The scenario's own grammar must have the events that pictures ask for.
grammar::Diagnostics CheckPictures(const scenario::Scenario& scenario, const YamlDocument& document,
                                   const grammar::Program& program) {
  grammar::Diagnostics diagnostics;
  for (const scenario::PictureYaml& picture : scenario.pictures) {
    const auto problem = WhyNoEventTime(picture.at.value, program);
    if (!problem) continue;
    const bool in_file = picture.at.where.source == 0;
    diagnostics.push_back(grammar::DiagnosticAt(
        in_file ? scenario.file : "--set", in_file ? document.sources.front().text : "",
        picture.at.where.place, "at: " + problem->message, problem->hint));
  }
  return diagnostics;
}

/// The grammar of a scenario that cannot be read, so that all errors are reported at once. Empty if
/// it is not known, or not in the library (which the reader has reported).
std::string GrammarNamedIn(const Result<YamlDocument>& document, const RunRequest& request,
                           const std::string& root) {
  const bool is_set = std::ranges::any_of(
      request.settings, [](const auto& set) { return set.starts_with("grammar="); });
  if (!document || is_set) return "";
  const YamlNode* node = document->root.Find("grammar");
  const std::string name = node ? node->text : scenario::ScenarioYaml{}.grammar.value;
  return std::ranges::count(ProjectLibrary(root).grammars, name) > 0 ? name : "";
}

}  // namespace

truth::ClaimableEvents ClaimableIn(const scenario::Scenario& scenario,
                                   const grammar::Program& program) {
  return {.grammar = GrammarName(program),
          .events = EventSignatures(program),
          .entity_table = MakeEntityTable(scenario)};
}

grammar::Diagnostics ValidateClaims(const scenario::Scenario& scenario,
                                    const YamlDocument& document, const grammar::Program& program,
                                    bool is_own_grammar) {
  if (scenario.expects.empty()) return {};
  const truth::ClaimableEvents known = ClaimableIn(scenario, program);
  ClaimDiagnostics diagnostics(scenario, document);
  for (const truth::Claim& claim : scenario.expects) {
    diagnostics.Add(claim, truth::UnknownNames(claim, known));
    if (is_own_grammar) diagnostics.Add(claim, truth::Mismatches(claim, known));
  }
  return diagnostics.Take();
}

grammar::Diagnostics UndecidedClaims(const scenario::Scenario& scenario,
                                     const YamlDocument& document,
                                     const grammar::Program& program) {
  const truth::ClaimableEvents known = ClaimableIn(scenario, program);
  ClaimDiagnostics diagnostics(scenario, document);
  for (const truth::Claim& claim : scenario.expects) {
    std::vector<truth::ClaimProblem> mismatches = truth::Mismatches(claim, known);
    if (mismatches.empty()) continue;
    mismatches.resize(1);
    mismatches.front().message = "not judged: " + mismatches.front().message;
    diagnostics.Add(claim, mismatches);
  }
  grammar::Diagnostics warnings = diagnostics.Take();
  for (grammar::Diagnostic& warning : warnings) warning.is_warning = true;
  return warnings;
}

bool IsFieldOfScenario(const std::string& name) {
  static const auto kFields = scenario::ScenarioFormat().schema().json().at("properties");
  return name.find('.') != std::string::npos || kFields.contains(name);
}

Result<LoadedRun> LoadRun(const RunRequest& request, const std::string& root,
                          std::vector<std::string>* files) {
  const auto load_grammar = [&](const std::string& name, const grammar::Overrides& overrides) {
    return LoadGrammar(root, name, overrides, files, request.instead);
  };
  return LoadRun(request, root, ProjectLibrary(root, files), load_grammar, files);
}

Result<LoadedRun> LoadRun(const RunRequest& request, const std::string& root,
                          const scenario::ScenarioLibrary& library,
                          const GrammarLoader& load_grammar, std::vector<std::string>* files) {
  Settings settings = Split(request.settings, IsFieldOfScenario);
  if (!settings.diagnostics.empty()) return tl::unexpected(std::move(settings.diagnostics));
  if (files) files->push_back(request.scenario_file);
  Result<YamlDocument> document = ReadYamlFile(request.scenario_file);
  Result<scenario::Scenario> scenario =
      document
          ? scenario::ReadScenario(request.scenario_file, *document, settings.of_scenario, library)
          : tl::unexpected(document.error());
  const std::string grammar = !request.grammar.empty() ? request.grammar
                              : scenario               ? scenario->grammar
                                                       : GrammarNamedIn(document, request, root);
  grammar::CompileResult compiled =
      grammar.empty() ? grammar::CompileResult{} : load_grammar(grammar, settings.of_grammar);
  if (!scenario || !compiled.program) {
    grammar::Diagnostics diagnostics = ErrorsOf(scenario);
    std::ranges::move(compiled.diagnostics, std::back_inserter(diagnostics));
    return tl::unexpected(std::move(diagnostics));
  }
  const bool is_own_grammar = request.grammar.empty();
  grammar::Diagnostics misnamed =
      ValidateClaims(*scenario, *document, *compiled.program, is_own_grammar);
  if (is_own_grammar)
    std::ranges::move(CheckPictures(*scenario, *document, *compiled.program),
                      std::back_inserter(misnamed));
  if (!misnamed.empty()) return tl::unexpected(std::move(misnamed));
  scenario->grammar = GrammarName(*compiled.program);
  grammar::Diagnostics warnings = scenario->warnings;
  std::ranges::move(Warnings(*compiled.program, MakeEntityTable(*scenario)),
                    std::back_inserter(warnings));
  return LoadedRun{std::move(*scenario), std::move(compiled.program), std::move(warnings),
                   std::move(*document), grammar};
}

Result<grammar::Overrides> ParameterSettings(const std::vector<std::string>& settings) {
  Settings split = Split(settings, [](const std::string&) { return false; });
  if (!split.diagnostics.empty()) return tl::unexpected(std::move(split.diagnostics));
  return std::move(split.of_grammar);
}

std::string ScenarioId(const std::string& skill, const std::string& name) {
  return skill.empty() ? name : skill + "/" + name;
}

}  // namespace prehend::episode
