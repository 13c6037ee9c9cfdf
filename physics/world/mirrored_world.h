// SPDX-License-Identifier: Apache-2.0
// A world that is simulated as its mirror image. No engine treats left and right alike to the last
// bit: the order in which corners are found and contacts are solved favours a side, and a release
// some frames later is another timeline. So a scene of a left hand is simulated as that of the
// right hand which it mirrors, and both do exactly the same. Tested by
// tests/physics/world/mirrored_world_test.cc
#pragma once

#include <memory>

#include "physics/motion/script.h"
#include "physics/world/world.h"

namespace prehend::physics {

/// Whether a left hand leads: there is no right one, or it has more to do in the first stage of the
/// script in which one of the sides has more to do.
bool LeftHandLeads(const Scene& scene, const Script& script);

/// The mirror image of `image`, which is a world of InMirror(scene).
std::unique_ptr<World> MirrorImageOf(std::unique_ptr<World> image);

}  // namespace prehend::physics
