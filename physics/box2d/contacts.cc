// SPDX-License-Identifier: Apache-2.0
// Rolling friction is a torque of at most coefficient times friction of the other side times normal
// force. Tested by tests/physics/box2d/world_test.cc
#include "physics/box2d/contacts.h"

#include <algorithm>

namespace prehend::physics {
namespace {

/// Box2D's accessor is not const although it changes nothing.
const FixtureFacts& FactsOf(const b2Fixture& fixture, const FixtureTable& table) {
  return table[const_cast<b2Fixture&>(fixture).GetUserData().pointer];
}

float InverseMoment(const b2Body& body) {
  return body.GetType() == b2_dynamicBody ? 1 / MomentAboutCentre(body) : 0;
}

}  // namespace

void Box2dMixing::PreSolve(b2Contact* contact, const b2Manifold*) {
  const b2Fixture &a = *contact->GetFixtureA(), &b = *contact->GetFixtureB();
  contact->SetFriction(a.GetFriction() * b.GetFriction());
  contact->SetRestitution(a.GetRestitution() * b.GetRestitution());
}

void ReadContacts(const b2World& world, const FixtureTable& table, TouchingPairs& pairs) {
  for (const b2Contact* contact = world.GetContactList(); contact; contact = contact->GetNext()) {
    const ContactSide &a = FactsOf(*contact->GetFixtureA(), table).side,
                      &b = FactsOf(*contact->GetFixtureB(), table).side;
    if (!contact->IsTouching() || pairs.Rest(a, b)) continue;
    b2WorldManifold at;
    contact->GetWorldManifold(&at);
    const b2Manifold& manifold = *contact->GetManifold();
    const Eigen::Vector3d nhat_AB_W(at.normal.x, 0, at.normal.y);
    for (int k = 0; k < manifold.pointCount; ++k) {
      pairs.Add({.a = a,
                 .b = b,
                 .p_W_m = FromBox2d(at.points[k]),
                 .nhat_BA_W = -nhat_AB_W,
                 .distance_m = (at.separations[k] + kSink) / kLengthScale,
                 .normal_impulse_n_s = manifold.points[k].normalImpulse / kLengthScale});
    }
  }
}

void ResistRolling(b2World& world, const FixtureTable& table) {
  for (b2Contact* contact = world.GetContactList(); contact; contact = contact->GetNext()) {
    if (!contact->IsTouching()) continue;
    const b2Fixture &a = *contact->GetFixtureA(), &b = *contact->GetFixtureB();
    const double coefficient = FactsOf(a, table).rolling_friction * b.GetFriction() +
                               FactsOf(b, table).rolling_friction * a.GetFriction();
    if (coefficient <= 0) continue;
    float pressed = 0;
    const b2Manifold& manifold = *contact->GetManifold();
    for (int k = 0; k < manifold.pointCount; ++k) pressed += manifold.points[k].normalImpulse;
    b2Body &body_a = *contact->GetFixtureA()->GetBody(),
           &body_b = *contact->GetFixtureB()->GetBody();
    const float inverse = InverseMoment(body_a) + InverseMoment(body_b);
    if (inverse <= 0) continue;
    const float limit = static_cast<float>(coefficient * kLengthScale) * pressed;
    const float turning = body_b.GetAngularVelocity() - body_a.GetAngularVelocity();
    const float impulse = std::clamp(turning / inverse, -limit, limit);
    body_a.ApplyAngularImpulse(impulse, false);
    body_b.ApplyAngularImpulse(-impulse, false);
  }
}

}  // namespace prehend::physics
