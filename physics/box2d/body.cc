// SPDX-License-Identifier: Apache-2.0
// Mass and moment of inertia are those of the solid and are set from outside; fixtures have no
// density. Tested by tests/physics/box2d/world_test.cc
// Friction is a motor of speed 0 with limited strength. Tested by tests/physics/box2d/world_test.cc
#include "physics/box2d/body.h"

#include <algorithm>

#include "physics/scene/joint.h"
#include "physics/scene/planar.h"
#include "physics/world/joint_spring.h"

namespace prehend::physics {

namespace {

JointSide SideOf(const b2Body& body) {
  const bool moves = body.GetType() == b2_dynamicBody;
  const double per_moment = moves ? kTorqueScale / MomentAboutCentre(body) : 0;
  return {.per_mass = moves ? 1.0 / body.GetMass() : 0,
          .per_moment_W = per_moment * Eigen::Matrix3d::Identity(),  // it rotates about y only
          .centre_W_m = FromBox2d(body.GetWorldCenter()),
          .v_m_per_s = FromBox2d(body.GetLinearVelocity()),
          .w_rad_per_s = {0, -body.GetAngularVelocity(), 0}};
}

/// Slower impacts do not bounce.
constexpr double kRestitutionThreshold_m_per_s = 0.2;

/// A rectangle whose Box2D skin lies inside, so that outer sizes are exact. Thin rectangles have a
/// thinner skin.
b2PolygonShape Rectangle(const Eigen::Vector2d& half, const b2Vec2& centre, double angle_rad) {
  const float skin = std::min(b2_polygonRadius, static_cast<float>(half.minCoeff()) / 2);
  b2PolygonShape rectangle;
  rectangle.SetAsBox(static_cast<float>(half.x()) - skin, static_cast<float>(half.y()) - skin,
                     centre, static_cast<float>(angle_rad));
  rectangle.m_radius = skin;
  return rectangle;
}

b2CircleShape Circle(const b2Vec2& centre, double radius) {
  b2CircleShape circle;
  circle.m_p = centre;
  circle.m_radius = static_cast<float>(radius);
  return circle;
}

}  // namespace

Box2dJoint::Box2dJoint(const Joint& joint, int sharers, b2Body& base, b2Body& body, b2World& world)
    : joint_(joint),
      sharers_(sharers),
      sign_(joint.kind != JointKind::kSlider && joint.axis_W.y() > 0 ? -1 : 1) {
  if (joint.spring > 0) {
    // Box2D has one sleeping speed for all bodies, and a spring may pull more slowly than that.
    for (b2Body* side : {&base, &body}) side->SetSleepingAllowed(false);
  }
  const float friction = static_cast<float>(joint.friction);
  if (joint.kind == JointKind::kSlider) {
    b2PrismaticJointDef def;
    def.Initialize(&base, &body, body.GetPosition(), DirectionToBox2d(joint.axis_W));
    def.enableLimit = true;
    SetLimits(joint.lower, joint.upper, kLengthScale, def.lowerTranslation, def.upperTranslation);
    def.enableMotor = joint.friction > 0;
    def.maxMotorForce = friction * static_cast<float>(kLengthScale);
    slider_ = static_cast<b2PrismaticJoint*>(world.CreateJoint(&def));
  } else {
    b2RevoluteJointDef def;
    def.Initialize(&base, &body, ToBox2d(joint.pivot_W_m));
    def.enableLimit = joint.kind == JointKind::kHinge;
    SetLimits(joint.lower, joint.upper, sign_, def.lowerAngle, def.upperAngle);
    def.enableMotor = joint.friction > 0;
    def.maxMotorTorque = friction * static_cast<float>(kTorqueScale);
    hinge_ = static_cast<b2RevoluteJoint*>(world.CreateJoint(&def));
  }
}

void Box2dJoint::Pull(double dt_s) {
  if (joint_.spring == 0 && joint_.damping == 0) return;
  if (hinge_) {
    b2Body &base = *hinge_->GetBodyA(), &body = *hinge_->GetBodyB();
    const JointPlace place{
        sign_ * hinge_->GetJointAngle(), {0, -sign_, 0}, FromBox2d(hinge_->GetAnchorA())};
    const auto torque =
        static_cast<float>(sign_ * kTorqueScale *
                           SpringForce(joint_, place, sharers_, SideOf(base), SideOf(body), dt_s));
    base.ApplyTorque(-torque, false);
    body.ApplyTorque(torque, false);
  } else {
    b2Body &base = *slider_->GetBodyA(), &body = *slider_->GetBodyB();
    const Eigen::Vector3d axis_W =
        FromBox2d(base.GetWorldVector(slider_->GetLocalAxisA())) * kLengthScale;
    const JointPlace place{slider_->GetJointTranslation() / kLengthScale, axis_W, {0, 0, 0}};
    const b2Vec2 force =
        ToBox2d(SpringForce(joint_, place, sharers_, SideOf(base), SideOf(body), dt_s) * axis_W);
    base.ApplyForce(-force, body.GetWorldCenter(), false);
    body.ApplyForceToCenter(force, false);
  }
}

void AddSection(const Shape& shape, const Pose& X_PS, const Surface& surface, b2Body& body,
                FixtureTable& table) {
  const auto add = [&](const b2Shape& section) {
    b2FixtureDef fixture;
    fixture.shape = &section;
    fixture.friction = static_cast<float>(surface.friction);
    fixture.restitution = static_cast<float>(surface.restitution);
    fixture.restitutionThreshold = static_cast<float>(kRestitutionThreshold_m_per_s * kLengthScale);
    fixture.filter.groupIndex = static_cast<int16>(surface.group);
    fixture.userData.pointer = table.size();
    body.CreateFixture(&fixture);
    table.push_back(surface.facts);
  };
  const Outline outline = OutlineOf(shape, X_PS);
  Eigen::Vector2d half = outline.half_size_m * kLengthScale;
  double radius = outline.radius_m * kLengthScale;
  const bool round = radius > 0;
  if (round)
    radius += kSink / 2;
  else
    half.array() += kSink / 2;
  const b2Vec2 centre = ToBox2d({outline.centre_m.x(), 0, outline.centre_m.y()});
  if (half.isZero()) return add(Circle(centre, radius));
  if (!round) return add(Rectangle(half, centre, outline.angle_rad));
  // Box2D has no capsule: a rectangle between two discs stands in for it.
  const b2Vec2 to_end(static_cast<float>(half.x() * std::cos(outline.angle_rad)),
                      static_cast<float>(half.x() * std::sin(outline.angle_rad)));
  add(Circle(centre - to_end, radius));
  add(Rectangle({half.x(), radius}, centre, outline.angle_rad));
  add(Circle(centre + to_end, radius));
}

Box2dBody::Box2dBody(const std::vector<const Body*>& bodies,
                     const std::vector<std::size_t>& indices, b2World& world, FixtureTable& table) {
  const Body& root = *bodies.front();
  b2BodyDef def;
  def.type = root.fixed ? b2_staticBody : b2_dynamicBody;
  def.position = ToBox2d(root.X_WB.p_m);
  def.linearDamping = static_cast<float>(root.linear_damping_per_s);
  def.angularDamping = static_cast<float>(root.angular_damping_per_s);
  rigid_ = world.CreateBody(&def);

  const Pose X_PW{
      {-root.X_WB.p_m.x(), 0, -root.X_WB.p_m.z()}};  // an abstract body may be outside the plane
  for (const Body* body : bodies) X_PB_.push_back(X_PW * body->X_WB);
  if (root.abstract != Abstract::kNot) return;
  double mass_kg = 0, moment = 0;
  Eigen::Vector3d centre_P = Eigen::Vector3d::Zero();
  for (const RigidMember& member : MembersOf(bodies)) {
    const Pose X_PS = X_PB_.front() * member.X_RC;
    const BodyIndex index(indices[member.owner]);
    AddSection(member.placed->shape, X_PS,
               {root.friction, root.restitution, 0, {{.body = index}, root.rolling_friction}},
               *rigid_, table);
    mass_kg += member.mass_kg;
    centre_P += member.mass_kg * X_PS.p_m;
    moment += MomentAboutY(member.placed->shape, X_PS, member.mass_kg) +
              member.mass_kg * X_PS.p_m.squaredNorm();
  }
  const b2MassData mass{static_cast<float>(mass_kg), ToBox2d(centre_P / mass_kg),
                        static_cast<float>(moment * kTorqueScale)};
  rigid_->SetMassData(&mass);
}

BodyState Box2dBody::State(std::size_t i) const { return StateOf(*rigid_, X_PB_[i]); }

BodyState StateOf(const b2Body& body, const Pose& X_PB) {
  const Pose X_WB = PoseOf(body) * X_PB;
  return {.X_WB = X_WB,
          .v_WB_m_per_s = FromBox2d(body.GetLinearVelocityFromWorldPoint(ToBox2d(X_WB.p_m))),
          .w_WB_rad_per_s = -body.GetAngularVelocity() * Eigen::Vector3d::UnitY(),
          .asleep = body.GetType() == b2_dynamicBody && !body.IsAwake()};
}

}  // namespace prehend::physics
