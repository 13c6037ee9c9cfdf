// SPDX-License-Identifier: Apache-2.0
// Method: further points are found by tilting the smaller body a little, an idea of van den Bergen
// that Bullet's btConvexConvexAlgorithm (zlib licence) applies to all contacts or to none. Tested
// by tests/physics/world/bounce_test.cc
// Speeds are read from the bodies once per manifold. Tested by tests/physics/world/bounce_test.cc
#include "physics/bullet/core/flat_impacts.h"

#include <BulletCollision/CollisionDispatch/btSphereBoxCollisionAlgorithm.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>

#include "physics/bullet/core/grain_contacts.h"

namespace prehend::physics {

namespace {

/// Motion of one side of a contact. A hand's link counts as still: hands do not bounce.
struct Motion {
  explicit Motion(const btCollisionObject& object) {
    const btRigidBody* const body = btRigidBody::upcast(&object);
    if (!body) return;
    centre_W = body->getWorldTransform().getOrigin();
    v = body->getLinearVelocity();
    w = body->getAngularVelocity();
  }
  btVector3 At(const btVector3& p_W) const { return v + w.cross(p_W - centre_W); }

  btVector3 centre_W{0, 0, 0}, v{0, 0, 0}, w{0, 0, 0};
};

btScalar SpeedTogether(const Motion& a, const Motion& b, const btManifoldPoint& point) {
  return (b.At(point.getPositionWorldOnB()) - a.At(point.getPositionWorldOnA()))
      .dot(point.m_normalWorldOnB);
}

/// Three directions of tilt: their points enclose the middle of a face.
constexpr int kTilts = 3;
/// The smallest tilt that finds a rim: a round body is touched that much beside its lowest line.
constexpr btScalar kTilt_rad = 0.005;
/// Least cosine between normals of one face; the normal of an edge tilts with the body.
constexpr btScalar kSameNormal = 0.9995;
constexpr int kMaxPoints = 4;
/// The point that Bullet finds is the deepest one; deeper ones are errors of its search.
constexpr btScalar kSlack_m = 1e-4;

/// Converts points of the tilted body to points of the body as it is.
class PointsOfTilted final : public btManifoldResult {
 public:
  /// `back` undoes the tilt of the point's first or second body.
  PointsOfTilted(const btManifoldResult& found, bool tilted_is_first, const btTransform& back,
                 const btManifoldPoint& deepest)
      : btManifoldResult(found),
        tilted_is_first_(tilted_is_first),
        back_(back),
        deepest_(deepest) {}

  void addContactPoint(const btVector3& normal_W, const btVector3& p_W,
                       btScalar distance) override {
    if (normal_W.dot(deepest_.m_normalWorldOnB) < kSameNormal) return;
    if (getPersistentManifold()->getNumContacts() >= kMaxPoints) return;
    btVector3 on_a = p_W + normal_W * distance, on_b = p_W;
    btVector3& moved = tilted_is_first_ ? on_a : on_b;
    moved = back_ * moved;
    const btScalar apart = (on_a - on_b).dot(normal_W);
    if (apart < deepest_.getDistance() - kSlack_m) return;
    btManifoldResult::addContactPoint(normal_W, on_a - normal_W * apart, apart);
  }

 private:
  const bool tilted_is_first_;
  const btTransform back_;
  const btManifoldPoint deepest_;
};

/// A person's parts are round and have no restitution to distribute over points.
bool CanMeetFlat(const btCollisionObjectWrapper& side) {
  const btCollisionObject& object = *side.getCollisionObject();
  return object.getInternalType() == btCollisionObject::CO_RIGID_BODY &&
         !object.isKinematicObject() &&
         side.getCollisionShape()->getShapeType() != SPHERE_SHAPE_PROXYTYPE;
}

/// Whether a box around one, in the other's frame, is too far from it for Bullet to find points.
bool IsBeside(const btCollisionObjectWrapper& one, const btCollisionObjectWrapper& other,
              const btPersistentManifold& manifold) {
  btVector3 least, most, its_least, its_most;
  one.getCollisionShape()->getAabb(other.getWorldTransform().inverseTimes(one.getWorldTransform()),
                                   least, most);
  other.getCollisionShape()->getAabb(btTransform::getIdentity(), its_least, its_most);
  btVector3 gap = least - its_most;
  gap.setMax(its_least - most);
  return gap[gap.maxAxis()] > manifold.getContactBreakingThreshold() + kSlack_m;
}

class ImpactAlgorithm final : public btConvexConvexAlgorithm {
 public:
  ImpactAlgorithm(const btCollisionAlgorithmConstructionInfo& info,
                  const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                  btConvexPenetrationDepthSolver* deep)
      : btConvexConvexAlgorithm(info.m_manifold, info, a, b, deep, 0, 0) {}

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult* found) override {
    // Most parts of a hand are beside what is near it.
    if (manifold_ && manifold_->getNumContacts() == 0 &&
        (IsBeside(*a, *b, *manifold_) || IsBeside(*b, *a, *manifold_)))
      return;
    btConvexConvexAlgorithm::processCollision(a, b, info, found);
    manifold_ = found->getPersistentManifold();
    const btPersistentManifold& manifold = *manifold_;
    const int count = manifold.getNumContacts();
    if (count == 0 || count > 2 || !CanMeetFlat(*a) || !CanMeetFlat(*b)) return;
    if (ApproachSpeed(manifold, manifold.getContactPoint(0)) < kMinImpact_m_per_s) return;
    const btManifoldPoint deepest = manifold.getContactPoint(0);
    for (int i = 0; i < kTilts; ++i) Tilt(*a, *b, info, deepest, SIMD_2_PI * i / kTilts, *found);
  }

 private:
  void Tilt(const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b,
            const btDispatcherInfo& info, const btManifoldPoint& deepest, btScalar way_rad,
            const btManifoldResult& found) {
    const bool a_is_smaller = a.getCollisionShape()->getAngularMotionDisc() <
                              b.getCollisionShape()->getAngularMotionDisc();
    const btCollisionObjectWrapper& smaller = a_is_smaller ? a : b;
    btVector3 across_W, also_across_W;
    btPlaneSpace1(deepest.m_normalWorldOnB, across_W, also_across_W);
    const btVector3 axis_W = across_W * std::cos(way_rad) + also_across_W * std::sin(way_rad);
    const btTransform& X_WS = smaller.getWorldTransform();
    const btTransform tilted(btQuaternion(axis_W, kTilt_rad) * X_WS.getRotation(),
                             X_WS.getOrigin());
    const btCollisionObjectWrapper side(smaller.m_parent, smaller.m_shape,
                                        smaller.m_collisionObject, tilted, smaller.m_partId,
                                        smaller.m_index);
    PointsOfTilted points(found, a_is_smaller, X_WS * tilted.inverse(), deepest);
    btConvexConvexAlgorithm::processCollision(a_is_smaller ? &side : &a, a_is_smaller ? &b : &side,
                                              info, &points);
  }

  const btPersistentManifold* manifold_ = nullptr;  ///< of the last call
};

btDefaultCollisionConstructionInfo WithRoomForImpacts() {
  btDefaultCollisionConstructionInfo info;
  // Pools are cleared when they are made; what does not fit is allocated one by one.
  info.m_defaultMaxPersistentManifoldPoolSize = info.m_defaultMaxCollisionAlgorithmPoolSize = 256;
  info.m_customCollisionAlgorithmMaxElementSize =
      static_cast<int>(std::max(sizeof(ImpactAlgorithm), sizeof(btSphereBoxCollisionAlgorithm)));
  return info;
}

/// A grain and a box: Bullet has a closed form, which it uses nowhere. It is kept for grains, whose
/// number it pays for: other spheres are found by a search, as in stock Bullet.
bool IsGrain(const btCollisionObjectWrapper& side) {
  return side.getCollisionObject()->getUserIndex2() == kGrain;
}
bool IsBox(const btCollisionObjectWrapper& side) {
  return side.getCollisionShape()->getShapeType() == BOX_SHAPE_PROXYTYPE;
}

}  // namespace

btScalar ApproachSpeed(const btPersistentManifold& manifold, const btManifoldPoint& point) {
  return SpeedTogether(Motion(*manifold.getBody0()), Motion(*manifold.getBody1()), point);
}

TimelyBounces::TimelyBounces(btPersistentManifold* const* manifolds, int count, btScalar dt_s,
                             btScalar slowest_m_per_s) {
  for (int m = 0; m < count; ++m) {
    const Motion a(*manifolds[m]->getBody0()), b(*manifolds[m]->getBody1());
    for (int k = 0; k < manifolds[m]->getNumContacts(); ++k) {
      btManifoldPoint& point = manifolds[m]->getContactPoint(k);
      const btScalar speed = SpeedTogether(a, b, point);
      if (speed < -slowest_m_per_s) point.m_appliedImpulse = 0;
      if (point.m_combinedRestitution <= 0 || point.getDistance() <= 0) continue;
      if (speed < slowest_m_per_s) continue;
      if (point.getDistance() <= speed * dt_s) {
        point.setDistance(0);  // Bullet computes it anew in every tick
      } else {
        later_.emplace_back(&point, point.m_combinedRestitution);
        point.m_combinedRestitution = 0;
      }
    }
  }
}

TimelyBounces::~TimelyBounces() {
  for (const auto& [point, restitution] : later_) point->m_combinedRestitution = restitution;
}

ImpactConfiguration::ImpactConfiguration()
    : btDefaultCollisionConfiguration(WithRoomForImpacts()), impacts_(m_pdSolver) {}

btCollisionAlgorithmCreateFunc* ImpactConfiguration::getCollisionAlgorithmCreateFunc(int type0,
                                                                                     int type1) {
  btCollisionAlgorithmCreateFunc* const maker =
      btDefaultCollisionConfiguration::getCollisionAlgorithmCreateFunc(type0, type1);
  return maker == m_convexConvexCreateFunc ? &impacts_ : maker;
}

btCollisionAlgorithm* ImpactConfiguration::Impacts::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
    const btCollisionObjectWrapper* b) {
  if ((IsGrain(*a) && IsBox(*b)) || (IsBox(*a) && IsGrain(*b))) {
    void* const place =
        info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(btSphereBoxCollisionAlgorithm));
    return new (place) btSphereBoxCollisionAlgorithm(info.m_manifold, info, a, b, IsBox(*a));
  }
  void* const place = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(ImpactAlgorithm));
  return new (place) ImpactAlgorithm(info, a, b, m_pdSolver);
}

}  // namespace prehend::physics
