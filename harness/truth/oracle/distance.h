// SPDX-License-Identifier: Apache-2.0
// Distances between true surfaces: boxes, spheres, cylinders, capsules, hulls and what is made of
// them. Tested by tests/harness/truth/oracle/oracle_test.cc
#pragma once

#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::truth {

/// Between the surfaces of the hand (palm and links) and of the body, metres; 0 when they touch or
/// overlap. Within 0.01 mm.
double SurfaceDistance(const physics::HandModel& model, const physics::HandState& hand,
                       const physics::Body& body, const physics::BodyState& state);

/// Of a point from the body, metres; 0 inside.
double PointDistance(const Eigen::Vector3d& p_W_m, const physics::Body& body,
                     const physics::BodyState& state);

}  // namespace prehend::truth
