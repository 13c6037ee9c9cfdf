// SPDX-License-Identifier: Apache-2.0
// What each evaluator says of a grammar: the definitions with their bands, and others that share
// nothing with them. Tested by tests/harness/measure/score/evaluators_test.cc
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "harness/truth/claims/judge_claims.h"

namespace prehend::measure {

/// Of things that an evaluator can judge, how many it confirms.
struct Confirmed {
  int of = 0, confirmed = 0;
  Confirmed& operator+=(const Confirmed& more);
};

/// What an evaluator says of one grammar.
struct Evaluation {
  std::map<std::string, Confirmed> by_event;
  std::vector<std::string> differences;  ///< a line each, with both times
  Confirmed Total() const;
  Evaluation& operator+=(const Evaluation& more);
};

/// Events with both boundaries between the earliest and the latest that the definitions allow, give
/// or take `tolerance` (ticks), of all events that are recognised or missing. `scenario` is named
/// in the differences.
Evaluation ByDefinitions(const std::string& scenario, std::span<const grammar::Timeline> possible,
                         const grammar::Timeline& found, grammar::Tick tolerance);

/// Claims that hold, of those that the grammar's events can decide.
Evaluation ByClaims(const std::string& scenario, std::span<const truth::ClaimVerdict> verdicts);

/// One evaluator and what it says of each grammar.
struct Evaluator {
  std::string name;    ///< "definitions"
  std::string proves;  ///< one sentence
  std::vector<Evaluation> of_grammars;
};

/// A Markdown table: a row per evaluator, a column per grammar.
std::string EvaluatorTable(const std::vector<std::string>& grammars,
                           const std::vector<Evaluator>& evaluators);

}  // namespace prehend::measure
