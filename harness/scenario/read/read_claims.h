// SPDX-License-Identifier: Apache-2.0
// The claims of a scenario, from their texts. Which events and entities there are is checked when
// the grammar is known (harness/episode/run/validate_claims.h). Tested by
// tests/harness/scenario/read/read_claims_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/truth/claims/claim.h"

namespace prehend::scenario {

/// Those that can be read; the others are reported at the letter that is wrong.
std::vector<truth::Claim> ReadClaims(const std::vector<Located<std::string>>& written,
                                     const YamlDocument& document, DiagnosticList& errors);

}  // namespace prehend::scenario
