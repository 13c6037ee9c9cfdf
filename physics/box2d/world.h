// SPDX-License-Identifier: Apache-2.0
// The planar engine: Box2D, one thread, for scenes with WorldSettings::planar. Settings:
// docs/physics.md. Tested by tests/physics/box2d/world_test.cc
#pragma once

#include <memory>

#include "physics/scene/scene.h"
#include "physics/world/world.h"

namespace prehend::physics {

/// All bodies and hands lie in the plane (physics/scene/planar.h). Every hand starts at its pose,
/// with its joints fully open in the style `styles[hand]`.
std::unique_ptr<World> MakeBox2dWorld(const Scene& scene, const std::vector<int>& styles);

}  // namespace prehend::physics
