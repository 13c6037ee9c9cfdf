// SPDX-License-Identifier: Apache-2.0
// Whether the classes that a scenario writes can be. Tested by tests/harness/kinds_test.cc
#pragma once

#include "harness/complaints.h"
#include "harness/scenario_entries.h"

namespace prehend::harness {

/// Complains about kinds of themselves, and about classes that nothing is of.
void CheckKinds(const ScenarioEntry& entry, Complaints& complaints);

}  // namespace prehend::harness
