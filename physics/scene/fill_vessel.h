// SPDX-License-Identifier: Apache-2.0
// Initial positions of the grains that fill a vessel. Tested by
// tests/physics/scene/fill_vessel_test.cc
//
// Needs: an upright vessel whose hollow is around the vertical axis through its origin.
// Algorithm: layers from the floor to the rim, each a square lattice; every second layer is shifted
// by half a step (the densest packing of spheres, seen along an edge of its cube). A flood fill
// from the axis outwards finds the points of a layer that are clear of the walls; a layer that
// leaks out of the vessel holds no grains.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/scene/scene.h"

namespace prehend::physics {

/// Centres of the grains in the vessel's frame, metres: `count` of them, or fewer if the vessel is
/// full to the rim. The seed rotates the lattice and shifts every grain a little.
std::vector<Eigen::Vector3d> FillVessel(const Body& vessel, double radius_m, int count,
                                        std::uint64_t seed);

}  // namespace prehend::physics
