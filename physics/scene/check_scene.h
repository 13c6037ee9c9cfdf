// SPDX-License-Identifier: Apache-2.0
// What every scene and every snapshot of it are, or else the program that made them is wrong.
// Tested by tests/physics/scene/check_scene_test.cc
#pragma once

#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// Once per run: indices are those of bodies, hands and links that exist, numbers are finite,
/// quaternions and axes have unit length, and lists have one element for each link or style.
void CheckScene(const Scene& scene);

/// Whether a snapshot has one state for each body, joint, hand and link, and its contacts and gazes
/// are of these. For PREHEND_DCHECK: it costs as much as the contacts are many.
bool IsOf(const Scene& scene, const Snapshot& snapshot);

}  // namespace prehend::physics
