// SPDX-License-Identifier: Apache-2.0
// See check_golden.h. Tested by tests/house/golden_workflow_test.cc
#include "harness/check_golden.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "grammar/frame.h"
#include "grammar/program.h"
#include "harness/event_text.h"
#include "harness/golden_files.h"
#include "harness/library_paths.h"
#include "harness/sensing.h"
#include "harness/text_file.h"

namespace prehend::harness {
namespace {

namespace fs = std::filesystem;

using Names = std::vector<std::string>;

class GoldenChecker {
 public:
  GoldenChecker(std::string_view file, std::string_view text, const PreparedRun& prepared)
      : file_(file),
        text_(text),
        rules_(prepared.program->events),
        cast_(MakeCast(prepared.scenario)) {
    for (const grammar::Rule& rule : rules_) {
      if (rule.printed) events_.push_back(rule.name);
    }
    for (const grammar::CastMember& member : cast_.entities) entities_.push_back(member.name);
  }

  void CheckLine(const GoldenEvent& line) {
    const std::string& event = line.event.event;
    const auto rule = std::ranges::find_if(rules_, [&](const grammar::Rule& candidate) {
      return candidate.printed && candidate.name == event;
    });
    if (rule == rules_.end())
      return Unknown(line, event, "the grammar has no event '" + event + "'", event, events_);
    for (const grammar::Role& role : line.event.roles) CheckRole(line, *rule, role);
    for (const grammar::RuleRole& role : rule->roles) {
      if (RoleValue(line.event, role.name).empty())
        Complain(line, event,
                 fmt::format("'{}' has a role '{}', which is missing here", event, role.name), "");
    }
    Names values;
    for (const grammar::RuleAttribute& attribute : rule->attributes)
      values.push_back(attribute.name);
    for (const grammar::NamedValue& value : line.event.values) {
      if (std::ranges::count(values, value.name) == 0)
        Unknown(line, value.name + "~", fmt::format("'{}' has no value '{}'", event, value.name),
                value.name, values);
    }
  }

  void CheckGrammar(const std::string& grammar, const std::string& watching) {
    if (grammar == watching) return;
    const std::size_t found = text_.find("# grammar: ");
    const auto line = static_cast<int>(std::ranges::count(text_.substr(0, found), '\n')) + 1;
    diagnostics_.push_back(grammar::DiagnosticAt(
        file_, text_, {line, 12},
        fmt::format("this golden is of the grammar '{}', but the scenario uses '{}'", grammar,
                    watching),
        "play it with that grammar and accept the result: prehend accept"));
  }

  grammar::Diagnostics Take() { return std::move(diagnostics_); }

 private:
  void CheckRole(const GoldenEvent& line, const grammar::Rule& rule, const grammar::Role& role) {
    if (IsAttribute(role)) {
      if (rule.style_role == grammar::kNone)
        return Complain(line, role.name + "=", fmt::format("'{}' has no style", rule.name), "");
      if (std::ranges::count(cast_.styles, role.value) == 0)
        Unknown(line, role.name + "=", "no hand of the scenario has the style '" + role.value + "'",
                role.value, cast_.styles);
      return;
    }
    Names roles;
    for (const grammar::RuleRole& known : rule.roles) roles.push_back(known.name);
    if (std::ranges::count(roles, role.name) == 0)
      return Unknown(line, role.name + "=",
                     fmt::format("'{}' has no role '{}'", rule.name, role.name), role.name, roles);
    if (std::ranges::count(entities_, role.value) == 0)
      Unknown(line, role.name + "=", "the scenario has no '" + role.value + "'", role.value,
              entities_);
  }

  void Unknown(const GoldenEvent& line, const std::string& word, std::string message,
               const std::string& name, const Names& known) {
    const std::string near = grammar::NearestName(name, known);
    std::string hint = near.empty() ? "" : "did you mean '" + near + "'?";
    if (near.empty() && !known.empty() && known.size() <= 8) {
      hint = "known:";
      for (const std::string& candidate : known) hint += " " + candidate;
    }
    Complain(line, word, std::move(message), std::move(hint));
  }

  /// At the first place where the word stands by itself.
  void Complain(const GoldenEvent& line, const std::string& word, std::string message,
                std::string hint) {
    std::size_t at = line.as_written.find(word);
    while (at != std::string::npos && at > 0 && line.as_written[at - 1] != ' ' &&
           line.as_written[at - 1] != '\t')
      at = line.as_written.find(word, at + 1);
    const int column = at == std::string::npos ? 1 : static_cast<int>(at) + 1;
    diagnostics_.push_back(grammar::DiagnosticAt(file_, text_, {line.line, column},
                                                 std::move(message), std::move(hint)));
  }

  std::string_view file_, text_;
  const std::vector<grammar::Rule>& rules_;
  const grammar::Cast cast_;
  Names events_, entities_;
  grammar::Diagnostics diagnostics_;
};

/// skill/name of the scenario whose golden or proposal is at this path; "" when it is elsewhere.
std::string ScenarioOfGoldenAt(const std::string& path, const std::string& root) {
  std::error_code error;
  const fs::path file = fs::weakly_canonical(path, error);
  for (const char* folder : {"golden", "build/pending"}) {
    const fs::path inside =
        file.lexically_relative(fs::weakly_canonical(fs::path(root) / folder, error));
    if (!inside.empty() && *inside.begin() != "..")
      return fs::path(inside).replace_extension().generic_string();
  }
  return "";
}

}  // namespace

grammar::Diagnostics CheckGoldenFile(const std::string& path, const std::string& id,
                                     const PreparedRun& prepared) {
  ReadResult<std::string> text = ReadTextFile(path);
  if (!text.value) return std::move(text.diagnostics);
  ReadResult<Golden> golden = ReadGolden(path, *text.value);
  if (!golden.value) return std::move(golden.diagnostics);
  grammar::Diagnostics other = OfAnotherScenario(path, *text.value, *golden.value, id);
  if (!other.empty()) return other;
  GoldenChecker checker(path, *text.value, prepared);
  checker.CheckGrammar(golden.value->grammar, prepared.scenario.grammar);
  for (const GoldenEvent& line : golden.value->events) checker.CheckLine(line);
  return checker.Take();
}

grammar::Diagnostics CheckGoldenAlone(const std::string& path, const std::string& root,
                                      std::vector<std::string>& inputs) {
  inputs.push_back(path);
  ReadResult<std::string> text = ReadTextFile(path);
  if (!text.value) return std::move(text.diagnostics);
  ReadResult<Golden> golden = ReadGolden(path, *text.value);
  if (!golden.value) return std::move(golden.diagnostics);
  const std::string of = ScenarioOfGoldenAt(path, root);
  const std::string& id = of.empty() ? golden.value->scenario : of;
  const std::vector<ScenarioFile> all = ListScenarios(root);
  const auto scenario = std::ranges::find(all, id, IdOf);
  if (scenario == all.end()) {
    return {grammar::DiagnosticAt(path, *text.value, ScenarioLine(*text.value),
                                  "there is no scenario '" + id + "'", HintForScenario(all, id))};
  }
  const ReadResult<PreparedRun> prepared =
      PrepareRun({.scenario_file = scenario->path}, root, &inputs);
  return prepared.value ? CheckGoldenFile(path, id, *prepared.value) : prepared.diagnostics;
}

}  // namespace prehend::harness
