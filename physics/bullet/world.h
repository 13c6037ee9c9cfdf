// SPDX-License-Identifier: Apache-2.0
// The spatial engine: Bullet (double precision), sequential impulse, one thread. Settings:
// docs/physics.md. Tested by tests/physics/world/world_test.cc
#pragma once

#include <memory>

#include "physics/scene/scene.h"
#include "physics/world/world.h"

namespace prehend::physics {

/// Every hand starts at its pose, with its joints fully open in the style `styles[hand]`. With
/// Engine::kBulletStock none of Bullet's parts is replaced (physics/bullet/core/parts.h).
std::unique_ptr<World> MakeBulletWorld(const Scene& scene, const std::vector<int>& styles);

}  // namespace prehend::physics
