// SPDX-License-Identifier: Apache-2.0
// What people write first in a script, and what is written instead. Tested by
// tests/harness/scenario/format/scenario_errors_test.cc
#pragma once

#include <string>

#include "harness/base/yaml/struct_format.h"

namespace prehend::scenario {

/// How steps are repeated.
inline constexpr const char* kRepeatRemedy =
    "steps are repeated by a block of their own: '- repeat: 3' and below it 'steps: [..]'";

/// Keys of steps that there are not.
Remedies StepRemedies();

}  // namespace prehend::scenario
