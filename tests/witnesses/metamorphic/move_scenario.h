// SPDX-License-Identifier: Apache-2.0
// A scenario as a whole, moved: each place and direction in it, those of its script and its
// outcomes included. Tested by tests/witnesses/metamorphic/metamorphic_test.cc
#pragma once

#include "harness/scenario/scenario/scenario.h"

namespace prehend::witnesses {

/// A motion of the whole world: first a mirror image in the plane y = 0, if any, then `X`, which
/// turns about the vertical only.
struct WorldMotion {
  bool mirrors = false;
  physics::Pose X;
};

/// In a mirror image right hands are left ones.
scenario::Scenario Moved(scenario::Scenario scenario, const WorldMotion& motion);

}  // namespace prehend::witnesses
