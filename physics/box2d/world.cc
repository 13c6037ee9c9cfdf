// SPDX-License-Identifier: Apache-2.0
// Needs: Box2D 2.4.1. The order of creation matters for determinism: bodies first, then hands, in
// scene order; one step per tick.
#include "physics/box2d/world.h"

#include <algorithm>

#include "physics/box2d/body.h"
#include "physics/box2d/hand.h"
#include "physics/scene/joint.h"
#include "physics/world/contact_hold.h"
#include "physics/world/joint_spring.h"
#include "physics/world/sleep_tracker.h"

namespace prehend::physics {
namespace {

constexpr int kVelocityIterations = 16;
constexpr int kPositionIterations = 6;

/// Mixes friction and restitution as the other engine does: multiplies the coefficients of the two
/// sides.
class Box2dMixing final : public b2ContactListener {
 public:
  void PreSolve(b2Contact* contact, const b2Manifold*) override {
    const b2Fixture &a = *contact->GetFixtureA(), &b = *contact->GetFixtureB();
    contact->SetFriction(a.GetFriction() * b.GetFriction());
    contact->SetRestitution(a.GetRestitution() * b.GetRestitution());
  }
};

/// Box2D's accessor is not const although it changes nothing.
const FixtureFacts& FactsOf(const b2Fixture& fixture, const FixtureTable& table) {
  return table[const_cast<b2Fixture&>(fixture).GetUserData().pointer];
}

float InverseMoment(const b2Body& body) {
  return body.GetType() == b2_dynamicBody ? 1 / MomentAboutCentre(body) : 0;
}

/// The points of contact, between the pairs' BeginTick() and EndTick().
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

/// The rolling friction that Box2D lacks, from the contact forces of the last step: a torque of at
/// most coefficient times friction of the other side times normal force.
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

class Box2dWorld final : public World {
 public:
  Box2dWorld(const Scene& scene, const std::vector<int>& styles);

  void Step(const std::vector<HandCommand>& commands) override;
  void Describe(Snapshot& snapshot) const override;

 private:
  void AddBodies();
  void AddJoints();

  struct Place {
    std::size_t rigid = 0;   ///< index into rigids_
    std::size_t member = 0;  ///< index into that rigid body's members
  };
  const Scene scene_;
  const double dt_s_;
  std::int64_t tick_ = 0;
  Box2dMixing mixing_;
  b2World world_;
  FixtureTable table_;
  std::vector<Box2dBody> rigids_;
  std::vector<Place> places_;  ///< one per body of the scene
  std::vector<Box2dJoint> joints_;
  std::vector<Box2dHand> hands_;
  Stillness stillness_;
  mutable TouchingPairs touching_;  ///< its points go along as they are described
};

Box2dWorld::Box2dWorld(const Scene& scene, const std::vector<int>& styles)
    : scene_(scene),
      dt_s_(1.0 / scene.world.rate_hz),
      world_(ToBox2d({0, 0, -scene.world.gravity_m_per_s2})),
      stillness_(scene.bodies.size()),
      touching_(scene.world.rate_hz) {
  // As in Bullet: the run's checks report bodies that are too fast for the tick.
  world_.SetContinuousPhysics(false);
  world_.SetContactListener(&mixing_);
  AddBodies();
  AddJoints();
  for (std::size_t i = 0; i < scene_.hands.size(); ++i)
    hands_.emplace_back(scene_.hands[i], HandIndex(i), styles[i], world_, table_);
}

void Box2dWorld::AddBodies() {
  places_.resize(scene_.bodies.size());
  for (const auto& group : RigidGroups(scene_)) {
    std::vector<const Body*> bodies;
    for (const std::size_t i : group) {
      places_[i] = {rigids_.size(), bodies.size()};
      bodies.push_back(&scene_.bodies[i]);
    }
    rigids_.emplace_back(bodies, group, world_, table_);
  }
}

void Box2dWorld::AddJoints() {
  const auto rigid = [&](BodyIndex body) -> b2Body& {
    return rigids_[At(places_, body).rigid].rigid();
  };
  for (const Joint& joint : scene_.joints) {
    if (joint.kind == JointKind::kFixed) continue;
    joints_.emplace_back(joint, SpringsOnOneBody(scene_, joint), rigid(joint.base),
                         rigid(joint.body), world_);
  }
}

void Box2dWorld::Step(const std::vector<HandCommand>& commands) {
  for (std::size_t i = 0; i < hands_.size(); ++i) hands_[i].Drive(commands[i], dt_s_);
  for (Box2dJoint& joint : joints_) joint.Pull(dt_s_);
  world_.Step(static_cast<float>(dt_s_), kVelocityIterations, kPositionIterations);
  stillness_.Update(++tick_, [this](std::size_t i) { return rigids_[places_[i].rigid].rests(); });
  touching_.BeginTick(stillness_.rests());
  ReadContacts(world_, table_, touching_);
  touching_.EndTick();
  ResistRolling(world_, table_);
}

void Box2dWorld::Describe(Snapshot& snapshot) const {
  stillness_.Describe(snapshot, [this](std::size_t i) {
    return rigids_[places_[i].rigid].State(places_[i].member);
  });
  snapshot.tick = tick_;
  DescribeJoints(scene_, snapshot);
  snapshot.hands.resize(hands_.size());
  for (std::size_t i = 0; i < hands_.size(); ++i) hands_[i].Describe(snapshot.hands[i]);
  touching_.Describe(snapshot);
}

}  // namespace

std::unique_ptr<World> MakeBox2dWorld(const Scene& scene, const std::vector<int>& styles) {
  return std::make_unique<Box2dWorld>(scene, styles);
}

}  // namespace prehend::physics
