// SPDX-License-Identifier: Apache-2.0
// Blocks of a script that are played several times: {repeat: 3, steps: [..]}. Tested by
// tests/harness/scenario/read/repeat_blocks_test.cc
#pragma once

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/base/yaml/located_yaml.h"

namespace prehend::scenario {

/// The scenario with each block of its `script` written out, so often as it says; blocks may stand
/// in blocks. Reports blocks that are not well formed, or too many stages.
YamlNode WithoutRepeats(const YamlNode& scenario, DiagnosticList& errors);

}  // namespace prehend::scenario
