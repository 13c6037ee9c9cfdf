// SPDX-License-Identifier: Apache-2.0
// Where the grains that fill a vessel lie before the first tick. Tested by
// tests/physics/scene/fill_vessel_test.cc
//
// Needs: a vessel that stands upright; its hollow is around the vertical axis through its origin.
// Algorithm: layers from the floor to the rim, each a square lattice of which every second one is
// shifted by half a step (the densest packing of spheres, seen along an edge of its cube). A layer
// is flooded from the axis outwards over what keeps clear of the walls; one that leaks out of the
// vessel holds nothing.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/scene/scene.h"

namespace prehend::physics {

/// Centres in the vessel's frame, metres: `count` of them, or fewer when no more fit below the rim.
/// The seed turns the lattice and shakes it a little.
std::vector<Eigen::Vector3d> FillVessel(const Body& vessel, double radius_m, int count,
                                        std::uint64_t seed);

}  // namespace prehend::physics
