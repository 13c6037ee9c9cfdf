// SPDX-License-Identifier: Apache-2.0
// How deep two shapes are in each other, to refuse scenes that would explode at the first tick. Not
// by libccd: on 60,000 random pairs, its EPA is three times slower (9 ms per pair if both shapes
// have the same centre), and decides 0.8 % of the overlapping pairs otherwise. Tested by
// tests/harness/scenario/resolve/penetration_test.cc
#pragma once

#include "physics/scene/scene.h"

namespace prehend::scenario {

struct PlacedSolid {
  physics::Shape shape;
  physics::Pose X_WS;
};

/// Depth in metres; zero or negative if the shapes are apart. By separating axes (Gottschalk et al.
/// 1996) over the exact extents of the shapes: exact for boxes, spheres and hulls, never too small,
/// and too large for some poses of tilted cylinders and capsules.
double Penetration(const PlacedSolid& a, const PlacedSolid& b);

}  // namespace prehend::scenario
