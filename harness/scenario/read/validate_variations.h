// SPDX-License-Identifier: Apache-2.0
// Checks at load time that every value `vary:` can produce gives a valid scenario, so that no trial
// fails later. Tested by tests/harness/scenario/read/validate_variations_test.cc
#pragma once

#include <functional>
#include <vector>

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/scenario/scenario/variations.h"

namespace prehend::scenario {

/// Reports fields that do not exist, that are varied twice, or that are not numbers although
/// numbers are sampled.
void ValidateVariations(const YamlDocument& document, const std::vector<VariationYaml>& variations,
                        DiagnosticList& errors);

/// The errors of reading a scenario; empty if it is valid.
using Reader = std::function<grammar::Diagnostics(const YamlDocument&)>;

/// Applies each bound of each variation alone and reports the first that gives an invalid scenario.
/// Fields set on the command line are not varied and are skipped. ValidateVariations() found
/// nothing.
grammar::Diagnostics CheckDraws(const YamlDocument& document,
                                const std::vector<VariationYaml>& variations, const Reader& read);

}  // namespace prehend::scenario
