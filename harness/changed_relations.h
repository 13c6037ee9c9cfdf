// SPDX-License-Identifier: Apache-2.0
// Where events lie to each other otherwise than the golden says. Tested by
// tests/harness/compare_test.cc
#pragma once

#include <vector>

#include "harness/compare.h"

namespace prehend::harness {

/// Of every two pairs that share their entities and of which at least one differs. Two boundaries
/// count as equal when they are no further apart than the tolerance.
std::vector<RelationChange> ChangedRelations(const std::vector<Pairing>& pairings);

}  // namespace prehend::harness
