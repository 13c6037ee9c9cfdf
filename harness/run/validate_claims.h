// SPDX-License-Identifier: Apache-2.0
// The claims of a scenario against the names of its entities and of the events of a grammar.
// Tested by tests/harness/run/validate_claims_test.cc
#pragma once

#include "grammar/base/diagnostic.h"
#include "grammar/monitor.h"
#include "harness/claims/fit_claim.h"
#include "harness/scenario/scenario.h"
#include "harness/yaml/located_yaml.h"

namespace prehend::harness {

/// The events of a grammar in this scenario.
ClaimableEvents ClaimableIn(const Scenario& scenario, const grammar::Program& program);

/// Names that there are not; `document` is the scenario's. Of events and roles only if the grammar
/// is the scenario's own: another one may have others.
grammar::Diagnostics ValidateClaims(const Scenario& scenario, const YamlDocument& document,
                                    const grammar::Program& program, bool is_own_grammar);

/// A warning for each claim that this grammar cannot decide.
grammar::Diagnostics UndecidedClaims(const Scenario& scenario, const YamlDocument& document,
                                     const grammar::Program& program);

}  // namespace prehend::harness
