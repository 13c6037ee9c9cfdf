// SPDX-License-Identifier: Apache-2.0
// Contacts of Box2D: mixes friction and restitution as the other engine does, reads contact points
// after a step, and adds the rolling friction that Box2D lacks. Only for physics/box2d. Tested by
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

/// Call after every step, between the pairs' BeginTick() and EndTick().
void ReadContacts(const b2World& world, const FixtureTable& table, TouchingPairs& pairs);

/// Applies rolling friction, from the contact forces of the last step. Call after every step.
void ResistRolling(b2World& world, const FixtureTable& table);

}  // namespace prehend::physics
