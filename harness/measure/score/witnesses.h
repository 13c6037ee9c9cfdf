// SPDX-License-Identifier: Apache-2.0
// What each witness says of a grammar: the definitions with their bands, and others that share
// nothing with them. Tested by tests/harness/measure/score/witnesses_test.cc
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "harness/truth/claims/judge_claims.h"

namespace prehend::measure {

/// Of things that a witness can judge, how many it confirms.
struct Confirmed {
  int of = 0, confirmed = 0;
  Confirmed& operator+=(const Confirmed& more);
};

/// What a witness says of one grammar.
struct Testimony {
  std::map<std::string, Confirmed> by_event;
  std::vector<std::string> differences;  ///< a line each, with both times
  Confirmed Total() const;
  Testimony& operator+=(const Testimony& more);
};

/// Events with both boundaries between the earliest and the latest that the definitions allow, give
/// or take `tolerance` (ticks), of all events that are recognised or missing. `scenario` is named
/// in the differences.
Testimony ByDefinitions(const std::string& scenario, std::span<const grammar::Timeline> possible,
                        const grammar::Timeline& found, grammar::Tick tolerance);

/// Claims that hold, of those that the grammar's events can decide.
Testimony ByClaims(const std::string& scenario, std::span<const truth::ClaimVerdict> verdicts);

/// One witness and what it says of each grammar.
struct Witness {
  std::string name;    ///< "definitions"
  std::string proves;  ///< one sentence
  std::vector<Testimony> of_grammars;
};

/// A Markdown table: a row per witness, a column per grammar.
std::string WitnessTable(const std::vector<std::string>& grammars,
                         const std::vector<Witness>& witnesses);

}  // namespace prehend::measure
