// SPDX-License-Identifier: Apache-2.0
// A joint between two bodies in Bullet: one kind of constraint with six axes, of which the joint
// frees some. Only for bullet_*.cc. Tested by tests/physics/joint_test.cc
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>

#include "physics/scene.h"

namespace prehend::physics {

/// For sliders, hinges and balls; fixed joints need none, their bodies are one (BulletBody). The
/// bodies must stand as placed.
std::unique_ptr<btTypedConstraint> MakeConstraint(const Joint& joint, btRigidBody& base,
                                                  btRigidBody& body);

}  // namespace prehend::physics
