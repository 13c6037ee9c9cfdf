// SPDX-License-Identifier: Apache-2.0
// A scenario elsewhere, turned, mirrored, or in another order: the same events, boundaries within
// two frames. Tested by tests/harness/transform/transform_test.cc
#pragma once

#include <vector>

#include "harness/golden/golden.h"
#include "harness/judge/judge.h"
#include "harness/transform/transform.h"

namespace prehend::harness {

/// Plays the scenario once per transform that leaves its story the same. `here` is the
/// untransformed run, with the tolerances of its golden.
Findings JudgeTransforms(const CheckedRun& checked, const Golden& here,
                         const std::vector<Transform>& transforms);

}  // namespace prehend::harness
