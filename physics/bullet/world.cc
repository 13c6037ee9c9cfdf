// SPDX-License-Identifier: Apache-2.0
// Needs: Bullet 3.24 built with double precision. The order of creation matters for determinism:
// bodies from below to above, then hands in scene order. One step of dt per tick, never Bullet's
// own sub-stepping, whose remainder can drop time. Tested by tests/physics/world/world_test.cc,
// tests/physics/world/grains_test.cc and tests/physics/person/gaze_test.cc
#include "physics/bullet/world.h"

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "physics/bullet/body.h"
#include "physics/bullet/core/flat_impacts.h"
#include "physics/bullet/core/grain_contacts.h"
#include "physics/bullet/core/parts.h"
#include "physics/bullet/core/swept_motion.h"
#include "physics/bullet/first_rest.h"
#include "physics/bullet/hand.h"
#include "physics/scene/joint.h"
#include "physics/world/contact_hold.h"
#include "physics/world/joint_spring.h"
#include "physics/world/sleep_tracker.h"

// The only process-wide setting of Bullet that is changed; every world sets the same constant.
extern btScalar gDbvtMargin;

namespace prehend::physics {
namespace {

/// Margin of bounding boxes in the broad phase, metres. Bullet's 50 mm joins neighbours into one
/// island, which is ten times slower.
constexpr double kBroadphaseMargin_m = 0.002;
/// With fewer iterations friction grasps fail: 20 iterations placed 28 of 40 objects.
constexpr int kSolverIterations = 50;
constexpr double kErrorReduction = 0.2;
/// Penetration deeper than this is corrected without adding velocity, at 480 ticks per second or
/// fewer. At more it is less, so that shallow penetration never adds more than 0.048 m/s: what
/// falls would rebound faster.
constexpr double kSplitImpulseThreshold_m = -0.0005;
constexpr double kSplitImpulseRate_hz = 480;
/// The solver is given islands until they have more contacts and joints together. Our parts solve
/// bodies of different islands side by side; no result depends on which they are. With stock Bullet
/// islands are solved one by one.
constexpr int kSolverBatch = 64, kStockSolverBatch = 2;

// Collision groups. Fixed bodies do not collide with each other; every hand has its own bit, from
// kFirstHandGroup on.
constexpr int kNoGroup = 0;  // abstract bodies touch nothing and are not seen
constexpr int kFixedGroup = 1;
constexpr int kMovingGroup = 2;
constexpr int kFirstHandGroup = 4;
// Persons push moving bodies only. What they do with fixed ones: physics/person/gaze.h.
constexpr int kPersonGroup = 1 << 30;

/// By collision object, its contact side; for a compound whose shapes belong to several bodies, one
/// side per shape. A collision object's user index in Bullet is its index here.
using ContactSides = std::vector<std::vector<ContactSide>>;

/// The side that this shape belongs to; `shape` is Bullet's index of the shape in a compound.
const ContactSide& SideOf(const ContactSides& sides, const btCollisionObject& object, int shape) {
  const auto& of_object = sides[static_cast<std::size_t>(object.getUserIndex())];
  return of_object[of_object.size() == 1 ? 0 : static_cast<std::size_t>(shape)];
}

/// Contact facts from the manifolds after a step (less than 1 % of a tick), without those between
/// grains of one body and between bodies that rest.
void ReadContacts(const btManifoldArray& manifolds, const ContactSides& sides,
                  TouchingPairs& pairs) {
  for (int m = 0; m < manifolds.size(); ++m) {
    const btPersistentManifold& manifold = *manifolds[m];
    // Grains of one body touch each other in every tick; these contacts are not reported.
    if (manifold.getBody0()->getUserIndex() == manifold.getBody1()->getUserIndex()) continue;
    // All shapes of one collision object rest or move together: the first one decides.
    if (pairs.Rest(SideOf(sides, *manifold.getBody0(), 0), SideOf(sides, *manifold.getBody1(), 0)))
      continue;
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      const btManifoldPoint& point = manifold.getContactPoint(k);
      // Bullet's normal points from body 1 into body 0.
      pairs.Add({.a = SideOf(sides, *manifold.getBody0(), point.m_index0),
                 .b = SideOf(sides, *manifold.getBody1(), point.m_index1),
                 .p_W_m = FromBullet(point.getPositionWorldOnB()),
                 .nhat_BA_W = FromBullet(point.m_normalWorldOnB),
                 .distance_m = point.getDistance(),
                 .normal_impulse_n_s = point.getAppliedImpulse()});
    }
  }
}

class SightCallback final : public btCollisionWorld::ClosestConvexResultCallback {
 public:
  SightCallback(const ContactSides& sides, const SightLine& line, const btVector3& from,
                const btVector3& to)
      : ClosestConvexResultCallback(from, to), sides_(sides), line_(line) {
    m_collisionFilterGroup = -1;  // every body can be seen, persons included
    m_collisionFilterMask = -1;
  }

  btScalar addSingleResult(btCollisionWorld::LocalConvexResult& result,
                           bool normal_in_world) override {
    const int shape = result.m_localShapeInfo ? result.m_localShapeInfo->m_triangleIndex : 0;
    const ContactSide& side = SideOf(sides_, *result.m_hitCollisionObject, shape);
    if (side.body >= line_.ignore_from && side.body < line_.ignore_to) return m_closestHitFraction;
    side_ = side;
    return ClosestConvexResultCallback::addSingleResult(result, normal_in_world);
  }

  const ContactSide& side() const { return side_; }

 private:
  const ContactSides& sides_;
  const SightLine& line_;
  ContactSide side_;
};

/// What a person sees: the first surface that a sphere meets on its way from her eyes.
Sight FirstInSight(const btCollisionWorld& world, const ContactSides& sides,
                   const SightLine& line) {
  const btVector3 from = ToBullet(line.from_W_m),
                  to = ToBullet(Eigen::Vector3d(line.from_W_m + line.length_m * line.toward_W));
  const btSphereShape ball(line.radius_m);
  SightCallback callback(sides, line, from, to);
  world.convexSweepTest(&ball, btTransform(btQuaternion::getIdentity(), from),
                        btTransform(btQuaternion::getIdentity(), to), callback);
  if (!callback.hasHit()) return {};
  return {callback.side().body, callback.side().hand,
          callback.m_closestHitFraction * line.length_m};
}

/// A grain farther from the origin than this has left the scene.
constexpr double kLost_m = 10;
/// Sleeping speed of a grain, and of a point of its surface.
constexpr double kGrainSleepSpeed_m_per_s = 0.05;

/// The grains of one body: many Bullet spheres that share one shape.
class BulletGrains {
 public:
  /// Requires a body with grains.
  explicit BulletGrains(const Body& body);

  std::span<const std::unique_ptr<btRigidBody>> rigids() const { return rigids_; }

  /// Stops grains that left the world, so that spilt grains do not fall for ever.
  void StopLost();

  /// Whether all grains are asleep.
  bool rests() const;
  /// Mean position and velocity.
  BodyState Mean() const;
  void AppendCentres(std::vector<Eigen::Vector3d>& centres_W_m) const;

 private:
  btSphereShape shape_;
  std::vector<std::unique_ptr<btRigidBody>> rigids_;
};

BulletGrains::BulletGrains(const Body& body) : shape_(body.grains->radius_m) {
  const auto count = static_cast<double>(body.grains->p_WG_m.size());
  Body grain = body;
  grain.grains.reset();
  grain.mass_kg = body.mass_kg / count;
  btVector3 inertia;
  shape_.calculateLocalInertia(grain.mass_kg, inertia);
  btRigidBody::btRigidBodyConstructionInfo info = RigidInfo(grain, &shape_, inertia);
  // Grains in a heap tremble, and they rotate fast for their size: with the thresholds of other
  // bodies no heap would ever sleep.
  info.m_linearSleepingThreshold = kGrainSleepSpeed_m_per_s;
  info.m_angularSleepingThreshold = kGrainSleepSpeed_m_per_s / body.grains->radius_m;
  for (const Eigen::Vector3d& p_WG_m : body.grains->p_WG_m) {
    info.m_startWorldTransform.setOrigin(ToBullet(p_WG_m));
    rigids_.push_back(std::make_unique<btRigidBody>(info));
  }
}

void BulletGrains::StopLost() {
  for (const auto& rigid : rigids_) {
    const bool lost =
        rigid->isActive() && rigid->getWorldTransform().getOrigin().length() > kLost_m;
    if (!lost) continue;
    rigid->setLinearVelocity({0, 0, 0});
    rigid->setAngularVelocity({0, 0, 0});
    rigid->forceActivationState(DISABLE_SIMULATION);
  }
}

bool BulletGrains::rests() const {
  return std::none_of(rigids_.begin(), rigids_.end(),
                      [](const auto& rigid) { return rigid->isActive(); });
}

BodyState BulletGrains::Mean() const {
  BodyState mean{.asleep = rests()};
  const auto count = static_cast<double>(rigids_.size());
  for (const auto& rigid : rigids_) {
    mean.X_WB.p_m += FromBullet(rigid->getWorldTransform().getOrigin()) / count;
    mean.v_WB_m_per_s += FromBullet(rigid->getLinearVelocity()) / count;
  }
  return mean;
}

void BulletGrains::AppendCentres(std::vector<Eigen::Vector3d>& centres_W_m) const {
  for (const auto& rigid : rigids_)
    centres_W_m.push_back(FromBullet(rigid->getWorldTransform().getOrigin()));
}

class BulletWorld final : public World {
 public:
  BulletWorld(const Scene& scene, const std::vector<int>& styles);
  ~BulletWorld() override;

  void Step(const std::vector<HandCommand>& commands) override;
  void Describe(Snapshot& snapshot) const override;
  void MoveKinematic(BodyIndex body, const Pose& X_WB, bool jumps) override;
  Sight Look(const SightLine& line) const override;

 private:
  /// How far the surfaces of two bodies are from each other; infinitely of grains and hands.
  double Apart(const ContactSide& a, const ContactSide& b) const;
  void Configure();
  void AddBodies();
  /// Adds one rigid body made of these bodies of the scene, the root first.
  void AddRigid(const std::vector<std::size_t>& group);
  void AddGrains(std::size_t body);
  void AddJoints();
  void AddHands(const std::vector<Hand>& hands, const std::vector<int>& styles);

  const Scene scene_;
  const double dt_s_;
  std::int64_t tick_ = 0;
  const std::unique_ptr<BulletEngine> engine_;
  btMultiBodyDynamicsWorld& world_;
  struct Place {
    std::size_t rigid = 0;   ///< index into rigids_
    std::size_t member = 0;  ///< index into that rigid body's members
  };
  std::vector<std::unique_ptr<BulletBody>> rigids_;
  std::vector<Place> places_;                   ///< one per body of the scene; unused for grains
  std::map<std::size_t, BulletGrains> grains_;  ///< by index of the body
  std::vector<BulletJoint> joints_;
  std::vector<std::unique_ptr<BulletHand>> hands_;
  FirstRest first_rest_;
  ContactSides sides_;
  Stillness stillness_;
  mutable TouchingPairs touching_;  ///< its points go along as they are described
};

BulletWorld::BulletWorld(const Scene& scene, const std::vector<int>& styles)
    : scene_(scene),
      dt_s_(1.0 / scene.world.rate_hz),
      engine_(MakeBulletEngine(scene.world.engine == Engine::kBulletStock
                                   ? BulletParts::kStock
                                   : BulletParts::kReplaced)),
      world_(engine_->world()),
      stillness_(scene.bodies.size()),
      touching_(scene.world.rate_hz) {
  Configure();
  AddBodies();
  AddJoints();
  AddHands(scene.hands, styles);
}

BulletWorld::~BulletWorld() {
  hands_.clear();
  for (BulletJoint& joint : joints_) world_.removeConstraint(&joint.constraint());
  for (auto& rigid : rigids_) world_.removeRigidBody(&rigid->rigid());
  for (auto& [body, grains] : grains_)
    for (const auto& grain : grains.rigids()) world_.removeRigidBody(grain.get());
}

void BulletWorld::Configure() {
  gDbvtMargin = kBroadphaseMargin_m;
  world_.setGravity({0, 0, -scene_.world.gravity_m_per_s2});
  world_.setForceUpdateAllAabbs(false);
  world_.setLatencyMotionStateInterpolation(false);
  world_.getDispatchInfo().m_deterministicOverlappingPairs = true;
  world_.getDispatchInfo().m_useContinuous = false;
  engine_->solver().setRandSeed(0);
  btContactSolverInfo& info = world_.getSolverInfo();
  info.m_numIterations = kSolverIterations;
  info.m_erp = kErrorReduction;
  info.m_erp2 = kErrorReduction;
  info.m_splitImpulse = true;
  info.m_splitImpulsePenetrationThreshold =
      kSplitImpulseThreshold_m * std::min(1.0, kSplitImpulseRate_hz / scene_.world.rate_hz);
  info.m_restitutionVelocityThreshold = kMinImpact_m_per_s;
  info.m_minimumSolverBatchSize =
      scene_.world.engine == Engine::kBulletStock ? kStockSolverBatch : kSolverBatch;
  info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  info.m_solverMode &= ~SOLVER_RANDMIZE_ORDER;
}

void BulletWorld::AddBodies() {
  places_.resize(scene_.bodies.size());
  // Contacts are solved in the order of bodies (PlaceInOrder()), which must not follow from the
  // order in which a file lists them: from below to above, light before heavy.
  auto groups = RigidGroups(scene_);
  std::ranges::stable_sort(groups, {}, [&](const std::vector<std::size_t>& group) {
    const Body& root = scene_.bodies[group.front()];
    return std::tuple(!root.fixed, root.X_WB.p_m.z(), root.mass_kg);
  });
  for (const auto& group : groups) AddRigid(group);
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i)
    if (scene_.bodies[i].grains) AddGrains(i);
}

void BulletWorld::AddGrains(std::size_t body) {
  const BulletGrains& grains = grains_.try_emplace(body, scene_.bodies[body]).first->second;
  for (const auto& grain : grains.rigids()) {
    grain->setUserIndex(static_cast<int>(sides_.size()));
    grain->setUserIndex2(kGrain);
    world_.addRigidBody(grain.get(), kMovingGroup, -1);
  }
  sides_.push_back({{.body = BodyIndex(body)}});
}

void BulletWorld::AddRigid(const std::vector<std::size_t>& group) {
  std::vector<const Body*> bodies;
  for (const std::size_t i : group) {
    places_[i] = {rigids_.size(), bodies.size()};
    bodies.push_back(&scene_.bodies[i]);
  }
  auto made = std::make_unique<BulletBody>(bodies);
  made->rigid().setUserIndex(static_cast<int>(sides_.size()));
  std::vector<ContactSide>& sides = sides_.emplace_back();
  for (const std::size_t owner : made->owners()) sides.push_back({.body = BodyIndex(group[owner])});
  if (scene_.world.planar) made->KeepInPlane();
  if (bodies.front()->abstract != Abstract::kNot)
    world_.addRigidBody(&made->rigid(), kNoGroup, kNoGroup);
  else if (bodies.front()->kinematic)
    world_.addRigidBody(&made->rigid(), kPersonGroup, kMovingGroup);
  else if (bodies.front()->fixed)
    world_.addRigidBody(&made->rigid(), kFixedGroup, ~kFixedGroup);
  else
    world_.addRigidBody(&made->rigid(), kMovingGroup, -1);
  if (scene_.world.engine != Engine::kBulletStock && !made->rigid().isStaticOrKinematicObject())
    first_rest_.Add(made->rigid());
  rigids_.push_back(std::move(made));
}

void BulletWorld::AddJoints() {
  const auto rigid = [&](BodyIndex body) -> btRigidBody& {
    return rigids_[At(places_, body).rigid]->rigid();
  };
  for (const Joint& joint : scene_.joints) {
    if (joint.kind == JointKind::kFixed) continue;
    BulletJoint& made = joints_.emplace_back(joint, SpringsOnOneBody(scene_, joint),
                                             rigid(joint.base), rigid(joint.body));
    world_.addConstraint(&made.constraint(), /*disableCollisionsBetweenLinkedBodies=*/true);
  }
}

void BulletWorld::AddHands(const std::vector<Hand>& hands, const std::vector<int>& styles) {
  for (std::size_t i = 0; i < hands.size(); ++i) {
    auto hand = std::make_unique<BulletHand>(hands[i], styles[i], kFirstHandGroup << i, world_);
    for (auto& collider : hand->colliders()) {
      collider->setUserIndex(static_cast<int>(sides_.size()));
      sides_.push_back({{.hand = HandIndex(i), .link = LinkIndex(collider->m_link)}});
    }
    hands_.push_back(std::move(hand));
  }
}

void BulletWorld::Step(const std::vector<HandCommand>& commands) {
  for (std::size_t i = 0; i < hands_.size(); ++i)
    hands_[i]->Drive(commands[i], dt_s_, scene_.world.gravity_m_per_s2);
  for (BulletJoint& joint : joints_) joint.Prepare(dt_s_);
  for (BulletJoint& joint : joints_) joint.Pull();
  world_.stepSimulation(dt_s_, 0);
  first_rest_.Watch(dt_s_);
  for (auto& [body, grains] : grains_) grains.StopLost();
  stillness_.Update(++tick_, [this](std::size_t i) {
    return scene_.bodies[i].grains ? grains_.at(i).rests() : rigids_[places_[i].rigid]->rests();
  });
  touching_.BeginTick(stillness_.rests());
  ReadContacts(engine_->ChangedManifolds(), sides_, touching_);
  // Bullet drops points that slid by some 0.3 mm, and finds none where boxes are apart.
  touching_.EndTick([this](const ContactSide& a, const ContactSide& b) { return Apart(a, b); });
}

double BulletWorld::Apart(const ContactSide& a, const ContactSide& b) const {
  const auto parts_at = [this](const ContactSide& side) {
    std::vector<Part> parts;
    if (side.hand != kNone || scene_.bodies[side.body.index()].grains) return parts;
    const btRigidBody& rigid = rigids_[At(places_, side.body).rigid]->rigid();
    int shape = 0;
    for (const Part& part : PartsOf(*rigid.getCollisionShape()))
      if (SideOf(sides_, rigid, shape++) == side)
        parts.push_back({part.shape, rigid.getWorldTransform() * part.X_BP});
    return parts;
  };
  double least_m = SIMD_INFINITY;
  for (const Part& of_a : parts_at(a))
    for (const Part& of_b : parts_at(b))
      if (const Gap gap = GapBetween(*of_a.shape, of_a.X_BP, *of_b.shape, of_b.X_BP); gap.is_known)
        least_m = std::min(least_m, gap.distance_m);
  return least_m;
}

void BulletWorld::MoveKinematic(BodyIndex body, const Pose& X_WB, bool jumps) {
  // Bullet derives the velocity from the previous pose and this one when it steps.
  btRigidBody& rigid = rigids_[At(places_, body).rigid]->rigid();
  rigid.setWorldTransform(ToBullet(X_WB));
  if (jumps) rigid.setInterpolationWorldTransform(rigid.getWorldTransform());
}

Sight BulletWorld::Look(const SightLine& line) const { return FirstInSight(world_, sides_, line); }

void BulletWorld::Describe(Snapshot& snapshot) const {
  stillness_.Describe(snapshot, [this](std::size_t i) {
    return scene_.bodies[i].grains ? grains_.at(i).Mean()
                                   : rigids_[places_[i].rigid]->State(places_[i].member);
  });
  snapshot.tick = tick_;
  snapshot.grains.clear();
  for (const auto& [body, grains] : grains_) grains.AppendCentres(snapshot.grains);
  DescribeJoints(scene_, snapshot);
  snapshot.hands.resize(hands_.size());
  for (std::size_t i = 0; i < hands_.size(); ++i) hands_[i]->Describe(snapshot.hands[i]);
  touching_.Describe(snapshot);
}

}  // namespace

std::unique_ptr<World> MakeBulletWorld(const Scene& scene, const std::vector<int>& styles) {
  return std::make_unique<BulletWorld>(scene, styles);
}

}  // namespace prehend::physics
