// SPDX-License-Identifier: Apache-2.0
// The claims of a scenario against the names of its entities and of the events of a grammar.
// Tested by tests/harness/episode/run/validate_claims_test.cc
#pragma once

#include "grammar/base/diagnostic.h"
#include "grammar/monitor.h"
#include "harness/base/yaml/located_yaml.h"
#include "harness/scenario/scenario/scenario.h"
#include "harness/truth/claims/judge_claims.h"

namespace prehend::episode {

/// The events of a grammar in this scenario.
truth::ClaimableEvents ClaimableIn(const scenario::Scenario& scenario,
                                   const grammar::Program& program);

/// Names that there are not; `document` is the scenario's. Of events and roles only if the grammar
/// is the scenario's own: another one may have others.
grammar::Diagnostics ValidateClaims(const scenario::Scenario& scenario,
                                    const YamlDocument& document, const grammar::Program& program,
                                    bool is_own_grammar);

/// A warning for each claim that this grammar cannot decide.
grammar::Diagnostics UndecidedClaims(const scenario::Scenario& scenario,
                                     const YamlDocument& document, const grammar::Program& program);

}  // namespace prehend::episode
