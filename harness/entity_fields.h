// SPDX-License-Identifier: Apache-2.0
// The fields of an entity: its shape, what it is made of, and what it hangs on.
// Tested by tests/harness/scenario_fields_test.cc
#pragma once

#include "harness/scenario_entries.h"

namespace prehend::harness {

Format<EntityEntry> EntityFormat();

}  // namespace prehend::harness
