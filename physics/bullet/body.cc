// SPDX-License-Identifier: Apache-2.0
// Makes Bullet's shapes, and one compound shape for a body of several parts. Tested by
// tests/physics/world/world_test.cc
#include "physics/bullet/body.h"

#include <algorithm>
#include <cmath>

#include "physics/bullet/convert.h"
#include "physics/scene/welded_bodies.h"

namespace prehend::physics {
namespace {

/// A body falls asleep after two seconds below these speeds. With lower ones, resting objects keep
/// costing time and creep; with higher ones, objects in a slow hand would freeze.
constexpr double kSleepSpeed_m_per_s = 0.01;
constexpr double kSleepTurn_rad_per_s = 0.05;

/// A hull in the frame of its centre of mass and principal axes. It has no margin, because a margin
/// would enlarge the hull or cut its corners; the other body of a contact has one.
class HullShape final : public btConvexHullShape {
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

struct MakeShapeOf {
  using Result = std::unique_ptr<btCollisionShape>;

  Result operator()(const Box& s) const {
    return WithMargin<btBoxShape>(ToBullet(Eigen::Vector3d(s.size_m / 2)));
  }
  Result operator()(const Sphere& s) const { return std::make_unique<btSphereShape>(s.radius_m); }
  Result operator()(const Cylinder& s) const {
    return WithMargin<btCylinderShapeZ>(btVector3(s.radius_m, s.radius_m, s.length_m / 2));
  }
  Result operator()(const Capsule& s) const {
    return std::make_unique<btCapsuleShapeZ>(s.radius_m, s.length_m);
  }
  Result operator()(const Hull& s) const { return std::make_unique<HullShape>(s); }

 private:
  template <class BulletShape>
  static Result WithMargin(const btVector3& half_m) {
    auto shape = std::make_unique<BulletShape>(half_m);
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

std::unique_ptr<btCollisionShape> MakeShape(const Shape& shape) {
  return std::visit(MakeShapeOf{}, shape);
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
  for (const RigidMember& member : members) shapes_.push_back(MakeShape(member.placed->shape));
  btCollisionShape* whole = shapes_.front().get();
  Pose X_CR;
  if (IsSimple(members)) {
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
