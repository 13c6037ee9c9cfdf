// SPDX-License-Identifier: Apache-2.0
// Sets of ticks as sorted lists of disjoint half-open intervals. Tested by
// tests/grammar/base/interval_set_test.cc
#pragma once

#include <vector>

#include "grammar/base/frame.h"

namespace prehend::grammar {

/// Sorted, disjoint, not touching, none empty: what Union() makes.
using IntervalSet = std::vector<Interval>;

IntervalSet Union(std::vector<Interval> intervals);

/// What is left of `whole` without `parts`.
IntervalSet Without(Interval whole, const IntervalSet& parts);

}  // namespace prehend::grammar
