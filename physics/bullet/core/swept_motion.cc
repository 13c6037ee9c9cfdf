// SPDX-License-Identifier: Apache-2.0
// Method: conservative advancement (Mirtich 1996). Two bodies go on for as long as they cannot meet
// yet, by their distance and their speeds, until they touch.
#include "physics/bullet/core/swept_motion.h"

#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <LinearMath/btTransformUtil.h>

#include <algorithm>
#include <cmath>

namespace prehend::physics {
namespace {

/// Bodies that are nearer touch.
constexpr btScalar kTouch_m = 20e-6;
/// How deep they are put into each other, so that the next tick finds all points of a face.
constexpr btScalar kOverlap_m = 10e-6;
/// What would go less far into another one than this share of their half thicknesses is left to the
/// contacts of the next tick, as what slides along another one.
constexpr btScalar kDeepShare = 0.2;
constexpr int kMaxSteps = 24;
/// A corner goes so much deeper than what touches already that the next tick finds it.
constexpr btScalar kCorner_m = 50e-6;
constexpr int kHalvings = 12;

/// Half of the smallest extent of the thinnest part.
btScalar HalfThickness(const btCollisionShape& shape) {
  if (shape.isCompound()) {
    const auto& compound = static_cast<const btCompoundShape&>(shape);
    btScalar least_m = SIMD_INFINITY;
    for (int i = 0; i < compound.getNumChildShapes(); ++i)
      least_m = std::min(least_m, HalfThickness(*compound.getChildShape(i)));
    return least_m;
  }
  const auto& convex = static_cast<const btConvexShape&>(shape);
  const auto half_m = [&](const btVector3& along) {
    const btVector3 a = convex.localGetSupportingVertex(along);
    return (a - convex.localGetSupportingVertex(-along)).dot(along) / 2;
  };
  return std::min({half_m({1, 0, 0}), half_m({0, 1, 0}), half_m({0, 0, 1})});
}

// Bullet's own continuous collision detection, which is off, would keep its sizes in these fields.
btScalar HalfThicknessOf(const btCollisionObject& object) {
  return object.getCcdSweptSphereRadius();
}
btScalar ReachOf(const btCollisionObject& object) { return object.getCcdMotionThreshold(); }

/// How a collision object moves in a tick: rigid bodies that are awake with their speeds, all
/// others not.
struct Way {
  btTransform X_WB;
  btVector3 v_m{0, 0, 0}, w_rad{0, 0, 0};  ///< way and turn of the whole tick

  Way(const btCollisionObject& object, btScalar dt_s) : X_WB(object.getWorldTransform()) {
    const btRigidBody* body = btRigidBody::upcast(&object);
    if (!body || body->isStaticOrKinematicObject() || !body->isActive()) return;
    v_m = body->getLinearVelocity() * dt_s;
    w_rad = body->getAngularVelocity() * dt_s;
  }
  btTransform At(btScalar share) const {
    btTransform at;
    btTransformUtil::integrateTransform(X_WB, v_m, w_rad, share, at);
    return at;
  }
};

/// A convex part on its way.
struct MovedPart {
  const Way& way;
  const Part& part;

  btTransform At(btScalar share) const { return way.At(share) * part.X_BP; }
  /// The point, in the part's frame, that is farthest along a direction after this share.
  btVector3 Farthest(const btVector3& n_W, btScalar share) const {
    return part.shape->localGetSupportingVertex(n_W * At(share).getBasis());
  }
};

/// Two bodies that may meet in this tick.
struct Encounter {
  Way a, b;
  btScalar turning_m;  ///< the farthest that a point of either goes by turning
  btScalar deep_m;     ///< what would go farther into the other one is stopped

  /// The share of the tick after which these parts overlap a little; 1 if they do not meet.
  btScalar Share(const Part& part_a, const Part& part_b) const;
  /// The same for a corner of one of two that touch already: that which would go deepest into the
  /// face of the other, which has the normal `n_W`, towards the corner.
  btScalar ShareOfCorner(const MovedPart& cornered, const MovedPart& faced, const btVector3& n_W,
                         btScalar from) const;
};

btScalar Encounter::Share(const Part& part_a, const Part& part_b) const {
  btScalar share = 0;
  for (int i = 0; i < kMaxSteps; ++i) {
    const btTransform X_WA = a.At(share), X_WB = b.At(share);
    const Gap gap =
        GapBetween(*part_a.shape, X_WA * part_a.X_BP, *part_b.shape, X_WB * part_b.X_BP);
    if (!gap.is_known) return 1;
    const btVector3 way = a.v_m - b.v_m + a.w_rad.cross(gap.p_W - X_WA.getOrigin()) -
                          b.w_rad.cross(gap.p_W - X_WB.getOrigin());
    const btScalar approach_m = -way.dot(gap.n_BA_W);
    // One that stays near while another corner comes down counts as touching, too.
    if (gap.distance_m <= kTouch_m || i + 1 == kMaxSteps) {
      // What overlaps when the tick begins is in contact.
      if ((i > 0 || gap.distance_m > 0) && approach_m * (1 - share) > deep_m + gap.distance_m)
        return std::min(share + (gap.distance_m + kOverlap_m) / approach_m, btScalar(1));
      const MovedPart moved_a{a, part_a}, moved_b{b, part_b};
      return std::min(ShareOfCorner(moved_a, moved_b, gap.n_BA_W, share),
                      ShareOfCorner(moved_b, moved_a, -gap.n_BA_W, share));
    }
    const btScalar most_m = -(a.v_m - b.v_m).dot(gap.n_BA_W) + turning_m;
    if (most_m <= 0) return 1;
    share += (gap.distance_m - kTouch_m / 2) / most_m;
    if (share >= 1) return 1;
  }
  return 1;
}

btScalar Encounter::ShareOfCorner(const MovedPart& cornered, const MovedPart& faced,
                                  const btVector3& n_W, btScalar from) const {
  const btVector3 corner = cornered.Farthest(-n_W, 1);
  const auto above_m = [&](btScalar share) {
    return n_W.dot(cornered.At(share) * corner - faced.At(share) * faced.Farthest(n_W, share));
  };
  const btScalar stop_m = std::min(above_m(from), btScalar(0)) - kCorner_m;
  if (above_m(1) > stop_m - deep_m) return 1;
  btScalar to = 1;
  for (int i = 0; i < kHalvings; ++i) {
    const btScalar middle = (from + to) / 2;
    (above_m(middle) > stop_m ? from : to) = middle;
  }
  // It may pass beside the face.
  btSphereShape point(0);
  const btTransform X_WCorner(btMatrix3x3::getIdentity(), cornered.At(to) * corner);
  const Gap gap = GapBetween(point, X_WCorner, *faced.part.shape, faced.At(to));
  return gap.is_known && gap.distance_m <= kTouch_m ? to : 1;
}

/// The objects whose bounding boxes meet another one.
struct Nearby final : btBroadphaseAabbCallback {
  std::vector<btBroadphaseProxy*> proxies;
  bool process(const btBroadphaseProxy* proxy) override {
    proxies.push_back(const_cast<btBroadphaseProxy*>(proxy));
    return true;
  }
};

}  // namespace

Gap GapBetween(const btConvexShape& a, const btTransform& X_WA, const btConvexShape& b,
               const btTransform& X_WB) {
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver depth;
  btGjkPairDetector detector(&a, &b, &simplex, &depth);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA = X_WA;
  input.m_transformB = X_WB;
  btPointCollector found;
  detector.getClosestPoints(input, found, nullptr);
  return {found.m_hasResult, found.m_distance, found.m_normalOnBInWorld, found.m_pointInWorld};
}

std::vector<Part> PartsOf(const btCollisionShape& shape) {
  if (shape.isConvex())
    return {{static_cast<const btConvexShape*>(&shape), btTransform::getIdentity()}};
  std::vector<Part> parts;
  if (!shape.isCompound()) return parts;
  const auto& compound = static_cast<const btCompoundShape&>(shape);
  for (int i = 0; i < compound.getNumChildShapes(); ++i)
    for (const Part& part : PartsOf(*compound.getChildShape(i)))
      parts.push_back({part.shape, compound.getChildTransform(i) * part.X_BP});
  return parts;
}

void SweptMotion::Measure() {
  thinnest_m_ = SIMD_INFINITY;
  const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    const btCollisionShape& shape = *objects[i]->getCollisionShape();
    objects[i]->setCcdSweptSphereRadius(HalfThickness(shape));
    objects[i]->setCcdMotionThreshold(shape.getAngularMotionDisc());
    thinnest_m_ = std::min(thinnest_m_, HalfThicknessOf(*objects[i]));
  }
}

void SweptMotion::Find(const btAlignedObjectArray<btRigidBody*>& awake, btScalar dt_s) {
  if (thinnest_m_ == 0) Measure();
  dt_s_ = dt_s;
  held_.clear();
  fast_.clear();
  btScalar farthest2_m2 = 0;
  for (int i = 0; i < awake.size(); ++i) {
    const btRigidBody& body = *awake[i];
    const btScalar radius_m = ReachOf(body);
    // The square of a sum is at most twice the sum of the squares.
    const btScalar way2_m2 = 2 * dt_s * dt_s *
                             (body.getLinearVelocity().length2() +
                              radius_m * radius_m * body.getAngularVelocity().length2());
    farthest2_m2 = std::max(farthest2_m2, way2_m2);
    const btScalar limit_m = HalfThicknessOf(body) + thinnest_m_;
    if (way2_m2 > limit_m * limit_m) fast_.push_back(awake[i]);
  }
  farthest_m_ = std::sqrt(farthest2_m2);
  for (btRigidBody* body : fast_) FindFirst(*body);
}

void SweptMotion::FindFirst(btRigidBody& body) {
  const Way motion(body, dt_s_);
  btVector3 least, most;
  body.getCollisionShape()->getAabb(motion.X_WB, least, most);
  const btVector3 way(farthest_m_, farthest_m_, farthest_m_);
  Nearby nearby;
  world_.getBroadphase()->aabbTest(least - 2 * way, most + 2 * way, nearby);
  const btBroadphaseProxy& own = *body.getBroadphaseHandle();
  const std::vector<Part> parts = PartsOf(*body.getCollisionShape());
  btScalar first = 1;
  btRigidBody* other = nullptr;
  std::ranges::sort(nearby.proxies, {}, &btBroadphaseProxy::m_uniqueId);
  for (btBroadphaseProxy* proxy : nearby.proxies) {
    auto& object = *static_cast<btCollisionObject*>(proxy->m_clientObject);
    if (&object == &body || !body.checkCollideWith(&object) || !object.checkCollideWith(&body) ||
        !world_.getPairCache()->needsBroadphaseCollision(const_cast<btBroadphaseProxy*>(&own),
                                                         proxy))
      continue;
    const Way its(object, dt_s_);
    const btScalar turning_m =
        motion.w_rad.length() * ReachOf(body) + its.w_rad.length() * ReachOf(object);
    const btScalar thickness_m = HalfThicknessOf(body) + HalfThicknessOf(object);
    if ((motion.v_m - its.v_m).length() + turning_m <= thickness_m) continue;
    const Encounter encounter{motion, its, turning_m, kDeepShare * thickness_m};
    for (const Part& a : parts)
      for (const Part& b : PartsOf(*object.getCollisionShape()))
        if (const btScalar share = encounter.Share(a, b); share < first) {
          first = share;
          other = its.v_m.length() > thickness_m / 2 ? btRigidBody::upcast(&object) : nullptr;
        }
  }
  if (first == 1) return;
  HoldAt(body, first);
  if (other) HoldAt(*other, first);
}

void SweptMotion::HoldAt(btRigidBody& body, btScalar share) {
  const auto known = std::ranges::find(held_, &body, &Held::body);
  if (known != held_.end() && known->share <= share) return;
  const Held held{&body, Way(body, dt_s_).At(share), share};
  if (known == held_.end())
    held_.push_back(held);
  else
    *known = held;
}

void SweptMotion::Hold() {
  for (const Held& held : held_) held.body->proceedToTransform(held.X_WB);
}

}  // namespace prehend::physics
