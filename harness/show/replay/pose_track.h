// SPDX-License-Identifier: Apache-2.0
// Poses at many ticks as few of them, between which a player interpolates: positions linearly,
// rotations along the shortest arc. Tested by tests/harness/show/replay/pose_track_test.cc
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "physics/base/pose.h"

namespace prehend::show {

/// How far an interpolated pose may be from the true one.
inline constexpr double kTrackTolerance_m = 0.0003;
inline constexpr double kTrackTolerance_rad = 0.006;

/// Indices of the poses that are kept, from the first to the last; of poses that are all the same,
/// the first. `at`: when each pose is, strictly increasing.
std::vector<std::size_t> KeysOf(std::span<const physics::Pose> poses,
                                std::span<const std::int64_t> at);

/// The pose between two others, `share` of the way.
physics::Pose Between(const physics::Pose& a, const physics::Pose& b, double share);

}  // namespace prehend::show
