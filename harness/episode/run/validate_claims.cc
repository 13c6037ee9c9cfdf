// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/validate_claims.h"

#include <utility>

#include "harness/episode/sense/entity_table.h"

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

}  // namespace prehend::episode
