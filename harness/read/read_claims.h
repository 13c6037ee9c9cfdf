// SPDX-License-Identifier: Apache-2.0
// The claims of a scenario, from their texts. Which events and entities there are is checked when
// the grammar is known (harness/run/validate_claims.h). Tested by
// tests/harness/read/read_claims_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/claims/claim.h"
#include "harness/yaml/diagnostic_list.h"

namespace prehend::harness {

/// Those that can be read; the others are reported at the letter that is wrong.
std::vector<Claim> ReadClaims(const std::vector<Located<std::string>>& written,
                              const YamlDocument& document, DiagnosticList& errors);

}  // namespace prehend::harness
