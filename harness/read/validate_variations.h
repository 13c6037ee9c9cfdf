// SPDX-License-Identifier: Apache-2.0
// What `vary:` can draw has to be a scenario, too: found out when the file is read, and not at the
// first trial that draws it. Tested by tests/harness/read/validate_variations_test.cc
#pragma once

#include <functional>
#include <vector>

#include "harness/scenario/variations.h"
#include "harness/yaml/diagnostic_list.h"

namespace prehend::harness {

/// Complains about fields that lead nowhere, that are varied twice, or that are no numbers where
/// numbers are varied.
void ValidateVariations(const YamlDocument& document, const std::vector<VariationYaml>& variations,
                        DiagnosticList& errors);

/// What the reader says of a scenario: nothing, if it can be read.
using Reader = std::function<grammar::Diagnostics(const YamlDocument&)>;

/// Applies the bounds of each variation, all else as written, and complains about the first one
/// that cannot be read. What the command line sets is not varied, and so not looked at.
/// ValidateVariations() found nothing.
grammar::Diagnostics CheckDraws(const YamlDocument& document,
                                const std::vector<VariationYaml>& variations, const Reader& read);

}  // namespace prehend::harness
