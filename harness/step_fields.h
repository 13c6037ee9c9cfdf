// SPDX-License-Identifier: Apache-2.0
// The steps of a scenario's script, each a record that is told by its action key.
// Tested by tests/harness/scenario_fields_test.cc
#pragma once

#include "harness/scenario_entries.h"

namespace prehend::harness {

Format<StepEntry> StepFormat();

}  // namespace prehend::harness
