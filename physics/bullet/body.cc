// SPDX-License-Identifier: Apache-2.0
// Makes Bullet's shapes, and one compound shape for a body of several parts. Tested by
// tests/physics/world/world_test.cc
// A btGeneric6DofSpring2Constraint with limits, and a friction motor on the free axis. Tested by
// tests/physics/scene/joint_test.cc
#include "physics/bullet/body.h"

#include <algorithm>
#include <cmath>

#include "physics/scene/joint.h"

namespace prehend::physics {

namespace {

// The x axis of the constraint's frame is the joint's axis. Axes 0..2 are translations along x, y,
// z; axes 3..5 are rotations about them.
constexpr int kShiftAlongAxis = 0;
constexpr int kTurnAboutAxis = 3;

/// Share of a limit violation that is removed per tick, as for contacts (physics/bullet/world.cc).
constexpr double kStopErrorReduction = 0.2;
/// The distance that is left to a limit may be closed within the tick, like the gap of a contact.
/// With a smaller value Bullet brakes a fast body before it arrives: a drawer at 1.4 m/s over its
/// last 15 mm.
constexpr double kWholeWay = 1;
/// With a bounce of 0 Bullet stops a body that would arrive within the tick at its present place.
constexpr double kKeepSpeedUntilThere = -1;

/// Friction is a motor with target speed 0 and limited strength.
void Rub(btGeneric6DofSpring2Constraint& constraint, int axis, double friction) {
  constraint.enableMotor(axis, friction > 0);
  constraint.setTargetVelocity(axis, 0);
  constraint.setMaxMotorForce(axis, friction);
}

/// A body that a spring pulls, or a damper lets sink, has not arrived yet. Below this speed it is
/// within half a millimetre of its rest position, even if strong damping makes it creep for many
/// seconds.
constexpr double kSprungSleepSpeed_m_per_s = 1e-4;
constexpr double kSprungSleepTurn_rad_per_s = 5e-4;

JointSide SideOf(const btRigidBody& body) {
  JointSide side{.per_mass = body.getInvMass(),
                 .centre_W_m = FromBullet(body.getCenterOfMassPosition()),
                 .v_m_per_s = FromBullet(body.getLinearVelocity()),
                 .w_rad_per_s = FromBullet(body.getAngularVelocity())};
  for (int row = 0; row < 3; ++row)
    side.per_moment_W.row(row) = FromBullet(body.getInvInertiaTensorWorld()[row]);
  return side;
}

/// A body falls asleep after two seconds below these speeds. With lower ones, resting objects keep
/// costing time and creep; with higher ones, objects in a slow hand would freeze.
constexpr double kSleepSpeed_m_per_s = 0.01;
constexpr double kSleepTurn_rad_per_s = 0.05;

/// A hull in the frame of its centre of mass and principal axes. It has no margin, because a margin
/// would enlarge the hull or cut its corners; the other body of a contact has one.
class HullShape : public btConvexHullShape {
 public:
  explicit HullShape(const Hull& hull) : gyration_m2_(ToBullet(hull.gyration_m2)) {
    for (const Eigen::Vector3d& corner_S : hull.corners_m)
      addPoint(ToBullet(hull.X_SC.inverse() * corner_S), false);
    setMargin(0);
    recalcLocalAabb();
  }
  /// Bullet's own version is that of the bounding box.
  void calculateLocalInertia(btScalar mass, btVector3& inertia) const override {
    inertia = mass * gyration_m2_;
  }

 private:
  btVector3 gyration_m2_;
};

/// Bullet's own inertia is that of the bounding box: 1.4 times a capsule's, and a rolling one is
/// late.
struct CapsuleShape : btCapsuleShapeZ {
  using btCapsuleShapeZ::btCapsuleShapeZ;
  void calculateLocalInertia(btScalar mass, btVector3& inertia) const override {
    const double r = getRadius(), length = 2 * getHalfHeight();
    const double ball = mass / (1 + 0.75 * length / r), rod = mass - ball;
    const double across = rod * (r * r / 4 + length * length / 12) +
                          ball * (0.4 * r * r + length * length / 4 + 0.375 * length * r);
    inertia.setValue(across, across, rod * r * r / 2 + ball * 0.4 * r * r);
  }
};

/// A part of a compound. Bullet drops its contact points as soon as the bounding boxes of the two
/// sides part: at once where both stand along the axes of the world, much later where they are
/// turned. With some room points last alike however the scene is turned.
template <class BulletShape>
struct PartOf : BulletShape {
  using BulletShape::BulletShape;
  void getAabb(const btTransform& X, btVector3& least, btVector3& most) const override {
    constexpr btScalar kRoom_m = 0.001;  // a contact ends at half a millimetre
    BulletShape::getAabb(X, least, most);
    least -= btVector3(kRoom_m, kRoom_m, kRoom_m);
    most += btVector3(kRoom_m, kRoom_m, kRoom_m);
  }
};

template <template <class> class As>
struct MakeShapeAs {
  using Result = std::unique_ptr<btCollisionShape>;

  Result operator()(const Box& s) const {
    return WithMargin<btBoxShape>(ToBullet(Eigen::Vector3d(s.size_m / 2)));
  }
  Result operator()(const Sphere& s) const {
    return std::make_unique<As<btSphereShape>>(s.radius_m);
  }
  Result operator()(const Cylinder& s) const {
    return WithMargin<btCylinderShapeZ>(btVector3(s.radius_m, s.radius_m, s.length_m / 2));
  }
  Result operator()(const Capsule& s) const {
    return std::make_unique<As<CapsuleShape>>(s.radius_m, s.length_m);
  }
  Result operator()(const Hull& s) const { return std::make_unique<As<HullShape>>(s); }

 private:
  template <class BulletShape>
  static Result WithMargin(const btVector3& half_m) {
    auto shape = std::make_unique<As<BulletShape>>(half_m);
    // Of a body that is no thicker than two margins nothing would be left to search for contacts.
    const double thin_m = std::min({half_m.x(), half_m.y(), half_m.z()});
    shape->setMargin(thin_m > kMargin_m ? kMargin_m : thin_m / 2);
    return shape;
  }
};

bool IsSimple(const std::vector<RigidMember>& members) {
  const Pose& X_RC = members.front().X_RC;
  return members.size() == 1 && X_RC.p_m.isZero() && X_RC.q.vec().isZero();
}

/// Converts a decay rate to Bullet's damping: the share of speed lost per second.
double ShareLost(double rate_per_s) { return 1 - std::exp(-rate_per_s); }

}  // namespace

BulletJoint::BulletJoint(const Joint& joint, int sharers, btRigidBody& base, btRigidBody& body)
    : joint_(joint), sharers_(sharers) {
  // Bullet measures these angles from the body to its base, opposite to ours.
  const Eigen::Vector3d axis_W = joint.kind == JointKind::kHinge ? -joint.axis_W : joint.axis_W;
  // A slider's pivot is its body's centre of mass: then neither its axis forces nor its limit
  // forces have a lever arm to rotate the body.
  const Eigen::Vector3d pivot_W_m = joint.kind == JointKind::kSlider
                                        ? FromBullet(body.getCenterOfMassPosition())
                                        : joint.pivot_W_m;
  const Pose X_WJ{pivot_W_m, RotationBetween(Eigen::Vector3d::UnitX(), axis_W)};
  const auto in_body = [&](const btRigidBody& owner) {
    return owner.getCenterOfMassTransform().inverse() * ToBullet(X_WJ);
  };
  constraint_ =
      std::make_unique<btGeneric6DofSpring2Constraint>(base, body, in_body(base), in_body(body));
  for (int axis = 0; axis < 6; ++axis) {
    constraint_->setLimit(axis, 0, 0);
    constraint_->setParam(BT_CONSTRAINT_STOP_ERP, kStopErrorReduction, axis);
  }
  if (joint.spring > 0 || joint.damping > 0) {
    for (btRigidBody* side : {&base, &body})
      side->setSleepingThresholds(kSprungSleepSpeed_m_per_s, kSprungSleepTurn_rad_per_s);
  }
  if (joint.kind == JointKind::kBall) {
    for (int axis = 3; axis < 6; ++axis) constraint_->setLimit(axis, 1, -1);  // no limits
  } else {
    const int axis = joint.kind == JointKind::kSlider ? kShiftAlongAxis : kTurnAboutAxis;
    constraint_->setLimit(axis, joint.lower, joint.upper);
    constraint_->setBounce(axis, kKeepSpeedUntilThere);
    Rub(*constraint_, axis, joint.friction);
  }
}

void BulletJoint::Prepare(double dt_s) {
  btRigidBody &base = constraint_->getRigidBodyA(), &body = constraint_->getRigidBodyB();
  if (joint_.kind == JointKind::kBall || !(base.isActive() || body.isActive())) return;
  constraint_->calculateTransforms();
  const bool slides = joint_.kind == JointKind::kSlider;
  const double position =
      slides ? constraint_->getRelativePivotPosition(kShiftAlongAxis) : constraint_->getAngle(0);
  const bool within = position >= joint_.lower && position <= joint_.upper;
  constraint_->setParam(BT_CONSTRAINT_STOP_ERP, within ? kWholeWay : kStopErrorReduction,
                        slides ? kShiftAlongAxis : kTurnAboutAxis);
  // Impulses, not forces: Bullet's friction ignores the effect of a torque within the tick, and an
  // object that lies on the body would creep.
  impulse_ =
      dt_s * SpringForce(joint_, Place(position), sharers_, SideOf(base), SideOf(body), dt_s);
}

JointPlace BulletJoint::Place(double position) const {
  const btTransform& X_WJ = constraint_->getCalculatedTransformA();
  const Eigen::Vector3d x_W = FromBullet(X_WJ.getBasis().getColumn(0));
  return {position, joint_.kind == JointKind::kSlider ? x_W : -x_W, FromBullet(X_WJ.getOrigin())};
}

void BulletJoint::Pull() {
  if (impulse_ == 0) return;
  btRigidBody &base = constraint_->getRigidBodyA(), &body = constraint_->getRigidBodyB();
  const btVector3 push = ToBullet(impulse_ * Place(0).axis_W);
  impulse_ = 0;
  if (joint_.kind == JointKind::kSlider) {
    body.applyCentralImpulse(push);
    base.applyImpulse(-push, body.getCenterOfMassPosition() - base.getCenterOfMassPosition());
  } else {
    body.applyTorqueImpulse(push);
    base.applyTorqueImpulse(-push);
  }
}

std::unique_ptr<btCollisionShape> MakeShape(const Shape& shape) {
  return std::visit(MakeShapeAs<std::type_identity_t>{}, shape);
}

btRigidBody::btRigidBodyConstructionInfo RigidInfo(const Body& body, btCollisionShape* shape,
                                                   const btVector3& inertia) {
  btRigidBody::btRigidBodyConstructionInfo info(body.mass_kg, nullptr, shape, inertia);
  info.m_friction = body.friction;
  info.m_rollingFriction = body.rolling_friction;
  info.m_restitution = body.restitution;
  info.m_linearDamping = ShareLost(body.linear_damping_per_s);
  info.m_angularDamping = ShareLost(body.angular_damping_per_s);
  info.m_linearSleepingThreshold = kSleepSpeed_m_per_s;
  info.m_angularSleepingThreshold = kSleepTurn_rad_per_s;
  return info;
}

BulletBody::BulletBody(const std::vector<const Body*>& bodies) {
  const Body& root = *bodies.front();
  const std::vector<RigidMember> members = MembersOf(bodies);
  for (const RigidMember& member : members) owners_.push_back(member.owner);
  btScalar mass = 0;
  for (const Body* body : bodies) mass += root.fixed ? 0 : body->mass_kg;
  btVector3 inertia(0, 0, 0);
  const bool simple = IsSimple(members);
  for (const RigidMember& member : members)
    shapes_.push_back(simple ? MakeShape(member.placed->shape)
                             : std::visit(MakeShapeAs<PartOf>{}, member.placed->shape));
  btCollisionShape* whole = shapes_.front().get();
  Pose X_CR;
  if (simple) {
    if (mass > 0) whole->calculateLocalInertia(mass, inertia);
  } else {
    btCompoundShape in_root_frame;
    std::vector<btScalar> masses;
    for (std::size_t i = 0; i < members.size(); ++i) {
      in_root_frame.addChildShape(ToBullet(members[i].X_RC), shapes_[i].get());
      masses.push_back(members[i].mass_kg);
    }
    btTransform X_RC;
    in_root_frame.calculatePrincipalAxisTransform(masses.data(), X_RC, inertia);
    if (root.fixed) inertia.setZero();
    auto compound = std::make_unique<btCompoundShape>();
    for (std::size_t i = 0; i < members.size(); ++i)
      compound->addChildShape(X_RC.inverse() * ToBullet(members[i].X_RC), shapes_[i].get());
    whole = shapes_.emplace_back(std::move(compound)).get();
    X_CR = FromBullet(X_RC).inverse();
  }
  X_CB_.push_back(X_CR);
  for (std::size_t i = 1; i < bodies.size(); ++i)
    X_CB_.push_back(X_CR * root.X_WB.inverse() * bodies[i]->X_WB);

  btRigidBody::btRigidBodyConstructionInfo info = RigidInfo(root, whole, inertia);
  info.m_mass = mass;
  info.m_startWorldTransform = ToBullet(root.X_WB * X_CR.inverse());
  rigid_ = std::make_unique<btRigidBody>(info);
  if (!root.kinematic) return;
  rigid_->setCollisionFlags(rigid_->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  rigid_->setActivationState(DISABLE_DEACTIVATION);
}

void BulletBody::KeepInPlane() {
  rigid_->setLinearFactor({1, 0, 1});
  rigid_->setAngularFactor({0, 1, 0});
}

BodyState BulletBody::State(std::size_t i) const {
  const Pose X_WC = FromBullet(rigid_->getWorldTransform());
  const Eigen::Vector3d w = FromBullet(rigid_->getAngularVelocity());
  const Eigen::Vector3d v = FromBullet(rigid_->getLinearVelocity());
  return {.X_WB = X_WC * X_CB_[i],
          .v_WB_m_per_s = v + w.cross(X_WC.q * X_CB_[i].p_m),
          .w_WB_rad_per_s = w,
          .asleep = !rigid_->isStaticObject() && !rigid_->isActive()};
}

}  // namespace prehend::physics
