// SPDX-License-Identifier: Apache-2.0
// Sets of ticks as sorted lists of disjoint half-open intervals. Tested by
// tests/harness/check/invariants_test.cc
#pragma once

#include <vector>

#include "grammar/base/frame.h"

namespace prehend::harness {

/// Sorted, disjoint, not touching, none empty: what Union() makes.
using IntervalSet = std::vector<grammar::Interval>;

IntervalSet Union(std::vector<grammar::Interval> intervals);

/// What is left of `whole` without `parts`.
IntervalSet Without(grammar::Interval whole, const IntervalSet& parts);

/// Whether all of `interval` is in the set.
bool Covers(const IntervalSet& set, grammar::Interval interval);

}  // namespace prehend::harness
