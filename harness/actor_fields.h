// SPDX-License-Identifier: Apache-2.0
// The fields of one of a scenario's `actors:`. Tested by tests/harness/scenario_fields_test.cc
#pragma once

#include "harness/format.h"
#include "harness/scenario_entries.h"

namespace prehend::harness {

Format<ActorEntry> ActorFormat();
Format<physics::Eyes> EyesFormat();

}  // namespace prehend::harness
