// SPDX-License-Identifier: Apache-2.0
// Where a body lands that is lowered straight down: on the true surface below it, be it level,
// tilted, round or hollow. No engine involved. Tested by tests/physics/scene/landing_test.cc
#pragma once

#include <optional>

#include "physics/scene/scene.h"

namespace prehend::physics {

/// Height of the lowest point of an object at X_WO once it has been lowered straight down until it
/// touches `support`, metres. Above a level surface, this is the height of that surface. Parts of
/// the support that begin more than 5 mm above what is over them are not below the object. None if
/// no part of the support is below it. Exact to 1 micrometre, for compounds on either side, too.
std::optional<double> LandingHeight(const Body& support, const Pose& X_WS, const Body& object,
                                    const Pose& X_WO);

/// The pose of an object at X_WO once it has been lowered straight down until it touches `support`,
/// not turned. None if no part of the support is below it.
std::optional<Pose> RestOn(const Body& support, const Pose& X_WS, const Body& object,
                           const Pose& X_WO);

/// Whether the vertical through a point meets a body, its hollows included: the convex solid around
/// all of its parts.
bool IsAbove(const Body& support, const Pose& X_WS, const Eigen::Vector2d& p_W_m);

}  // namespace prehend::physics
