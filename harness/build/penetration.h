// SPDX-License-Identifier: Apache-2.0
// How deep two shapes are in each other, to refuse scenes that would explode at the first tick.
// Tested by tests/harness/build/penetration_test.cc
#pragma once

#include "physics/scene/scene.h"

namespace prehend::harness {

struct PlacedSolid {
  physics::Shape shape;
  physics::Pose X_WS;
};

/// Depth in metres, negative or zero when apart. By separating axes (Gottschalk et al. 1996) over
/// the exact extents of the shapes; exact for boxes, spheres and hulls, at most slightly too deep
/// for tilted cylinders.
double Penetration(const PlacedSolid& a, const PlacedSolid& b);

}  // namespace prehend::harness
