// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/world_test.cc
#include "physics/bullet_body.h"

#include <numbers>

#include "physics/bullet_convert.h"

namespace prehend::physics {
namespace {

/// Below these speeds for two seconds a body falls asleep. Lower: resting objects keep costing time
/// and creep. Higher: objects in a slow hand would freeze.
constexpr double kSleepSpeed_m_per_s = 0.01;
constexpr double kSleepTurn_rad_per_s = 0.05;

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

 private:
  template <class BulletShape>
  static Result WithMargin(const btVector3& half_m) {
    auto shape = std::make_unique<BulletShape>(half_m);
    shape->setMargin(kMargin_m);
    return shape;
  }
};

struct VolumeOf {
  static constexpr double kPi = std::numbers::pi;

  double operator()(const Box& s) const { return s.size_m.prod(); }
  double operator()(const Sphere& s) const {
    return 4.0 / 3 * kPi * s.radius_m * s.radius_m * s.radius_m;
  }
  double operator()(const Cylinder& s) const { return kPi * s.radius_m * s.radius_m * s.length_m; }
  double operator()(const Capsule& s) const {
    return (*this)(Sphere{s.radius_m}) + (*this)(Cylinder{s.radius_m, s.length_m});
  }
};

/// The mass of a compound is spread evenly over its shapes' volumes.
std::vector<btScalar> MassesOfShapes(const Body& body) {
  std::vector<btScalar> masses;
  double volume = 0;
  for (const PlacedShape& placed : body.shapes) {
    masses.push_back(std::visit(VolumeOf{}, placed.shape));
    volume += masses.back();
  }
  const double density = (body.fixed ? 1.0 : body.mass_kg) / volume;
  for (btScalar& mass : masses) mass *= density;
  return masses;
}

bool IsSimple(const Body& body) {
  const Pose& X_BS = body.shapes.front().X_BS;
  return body.shapes.size() == 1 && X_BS.p_m.isZero() && X_BS.q.vec().isZero();
}

}  // namespace

std::unique_ptr<btCollisionShape> MakeShape(const Shape& shape) {
  return std::visit(MakeShapeOf{}, shape);
}

BulletBody::BulletBody(const Body& body) {
  const btScalar mass = body.fixed ? 0 : body.mass_kg;
  btVector3 inertia(0, 0, 0);
  for (const PlacedShape& placed : body.shapes) shapes_.push_back(MakeShape(placed.shape));
  btCollisionShape* whole = shapes_.front().get();
  if (IsSimple(body)) {
    if (mass > 0) whole->calculateLocalInertia(mass, inertia);
  } else {
    btCompoundShape in_body_frame;
    for (std::size_t i = 0; i < shapes_.size(); ++i)
      in_body_frame.addChildShape(ToBullet(body.shapes[i].X_BS), shapes_[i].get());
    btTransform X_BC;
    in_body_frame.calculatePrincipalAxisTransform(MassesOfShapes(body).data(), X_BC, inertia);
    if (body.fixed) inertia.setZero();
    auto compound = std::make_unique<btCompoundShape>();
    for (std::size_t i = 0; i < shapes_.size(); ++i)
      compound->addChildShape(X_BC.inverse() * ToBullet(body.shapes[i].X_BS), shapes_[i].get());
    whole = shapes_.emplace_back(std::move(compound)).get();
    X_CB_ = FromBullet(X_BC).inverse();
  }

  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, whole, inertia);
  info.m_startWorldTransform = ToBullet(body.X_WB * X_CB_.inverse());
  info.m_friction = body.friction;
  info.m_rollingFriction = body.rolling_friction;
  info.m_restitution = body.restitution;
  info.m_linearDamping = 0;
  info.m_angularDamping = 0;
  info.m_linearSleepingThreshold = kSleepSpeed_m_per_s;
  info.m_angularSleepingThreshold = kSleepTurn_rad_per_s;
  rigid_ = std::make_unique<btRigidBody>(info);
}

BodyState BulletBody::State() const {
  const Pose X_WC = FromBullet(rigid_->getWorldTransform());
  const Eigen::Vector3d w = FromBullet(rigid_->getAngularVelocity());
  const Eigen::Vector3d v = FromBullet(rigid_->getLinearVelocity());
  return {.X_WB = X_WC * X_CB_,
          .v_WB_m_per_s = v + w.cross(X_WC.q * X_CB_.p_m),
          .w_WB_rad_per_s = w,
          .asleep = !rigid_->isStaticObject() && !rigid_->isActive()};
}

}  // namespace prehend::physics
