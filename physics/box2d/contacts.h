// SPDX-License-Identifier: Apache-2.0
// Contacts of Box2D: their friction and restitution mixed as everywhere else, read after a step,
// and the rolling friction that Box2D does not have. Only for box2d_*.cc. Tested by
// tests/physics/box2d/world_test.cc
#pragma once

#include "physics/box2d/body.h"
#include "physics/world/contact_hold.h"

namespace prehend::physics {

/// Multiplies the coefficients of the two sides.
class Box2dMixing final : public b2ContactListener {
 public:
  void PreSolve(b2Contact* contact, const b2Manifold* before) override;
};

/// After every step, between the pairs' BeginTick() and EndTick().
void ReadContacts(const b2World& world, const FixtureTable& table, TouchingPairs& pairs);

/// Slows what rolls, by the forces of the last step: after every step.
void ResistRolling(b2World& world, const FixtureTable& table);

}  // namespace prehend::physics
