// SPDX-License-Identifier: Apache-2.0
// The plane on which things rest, where that is not level: the frame of the tracker does not stand
// upright. Tested by tests/program/import_up_test.cc
#pragma once

#include <Eigen/Geometry>
#include <set>
#include <string>

#include "harness/episode/sense/episode_file.h"

namespace prehend::exchange {

/// Says by how much the plane is tilted on which most things rest, how well it is known, and what
/// the map could say; "" where that is less than 5 degrees, or too few places tell. `turn`: from
/// the file's axes to the recording's. Not of `untrue`, whose heights mean nothing.
std::string TiltOfRestPlane(const episode::Recording& episode, const Eigen::Quaterniond& turn,
                            const std::set<std::size_t>& untrue);

}  // namespace prehend::exchange
