// SPDX-License-Identifier: Apache-2.0
// Method and order of rows: btMultiBodyConstraintSolver of Bullet 3.24 (zlib licence). Without
// friction the results are the same, bit by bit.
#include "physics/bullet/core/solver.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <algorithm>
#include <cstring>
#include <tuple>

#include "physics/bullet/core/flat_impacts.h"

namespace prehend::physics {
namespace {

/// A contact whose friction is above this share of the limit slides.
constexpr btScalar kSticks = 1 - 1e-6;

using Two = btScalar __attribute__((vector_size(2 * sizeof(btScalar))));

Two Load(const btScalar* two) {
  Two loaded;
  std::memcpy(&loaded, two, sizeof loaded);
  return loaded;
}

/// Clamps an impulse that changes from `old` by `change` to `sum`.
void Clamp(btScalar least, btScalar most, btScalar old, btScalar& sum, btScalar& change) {
  if (sum < least) {
    change = least - old;
    sum = least;
  } else if (sum > most) {
    change = most - old;
    sum = most;
  }
}

/// What the place of a manifold among the others follows from: its bodies in the order in which the
/// scene was built, then the parts of their shapes that touch.
std::tuple<int, int, int, int> PlaceOf(const btPersistentManifold& manifold) {
  const int a = manifold.getBody0()->getBroadphaseHandle()->getUid();
  const int b = manifold.getBody1()->getBroadphaseHandle()->getUid();
  if (manifold.getNumContacts() == 0) return {a, b, -1, -1};
  const btManifoldPoint& point = manifold.getContactPoint(0);
  return {a, b, point.m_index0, point.m_index1};
}

}  // namespace

void PlaceInOrder(btPersistentManifold** manifolds, int count) {
  std::stable_sort(manifolds, manifolds + count,
                   [](const btPersistentManifold* a, const btPersistentManifold* b) {
                     return PlaceOf(*a) < PlaceOf(*b);
                   });
}

btScalar BulletSolver::solveGroupCacheFriendlySetup(
    btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
    int manifold_count, btTypedConstraint** constraints, int constraint_count,
    const btContactSolverInfo& info, btIDebugDraw* drawer) {
  inertias_.Clear();
  const MultibodyInertias::Use use(inertias_);
  const btScalar result = btMultiBodyConstraintSolver::solveGroupCacheFriendlySetup(
      bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info, drawer);
  FindShared();
  rigid_.FindSingleBodies(RigidPools());
  HoldRigidAnchors(info);
  rigid_.Setup(RigidPools());
  if (grain_contacts_)
    grains_.Setup(grain_contacts_->contacts(), m_tmpSolverBodyPool, rigid_, info);
  grains_change_ = 0;
  // No row of a multibody is warm-started: its speeds start at zero here, and their final values
  // are added to the multibody.
  coefficients_.clear();
  multibodies_.clear();
  joint_speeds_.clear();
  Flatten(m_multiBodyNonContactConstraints, joints_);
  if (multibodies_.size() > 1) Interleave(joints_);
  Flatten(m_multiBodyNormalContactConstraints, normals_);
  Flatten(m_multiBodyFrictionContactConstraints, frictions_);
  Flatten(m_multiBodyTorsionalFrictionContactConstraints, rolling_);
  Flatten(m_multiBodySpinningFrictionContactConstraints, spinning_);
  ComputeResponses(frictions_, friction_responses_);
  ComputeResponses(rolling_, rolling_responses_);
  HoldAnchors(info);
  return result;
}

template <class Constraint>
FrictionAnchors::Drift BulletSolver::AddAnchor(const Constraint& contact,
                                               const FrictionAnchors::Side& a,
                                               const FrictionAnchors::Side& b) {
  return anchors_.Add(*static_cast<const btManifoldPoint*>(contact.m_originalContactPoint), {a, b});
}

FrictionAnchors::Side BulletSolver::RigidSideOf(int body) const {
  return {.rigid = body < 0 ? nullptr : m_tmpSolverBodyPool[body].m_originalBody};
}

void BulletSolver::HoldRigidAnchors(const btContactSolverInfo& info) {
  const RigidRows::Pools pools = RigidPools();
  rigid_anchors_.clear();
  const btScalar rate = info.m_erp / info.m_timeStep;
  for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); ++i) {
    const btSolverConstraint& contact = m_tmpSolverContactConstraintPool[i];
    if (!rigid_.MayCreep(contact, pools)) continue;
    rigid_anchors_.push_back({i, anchors_.size()});
    const btVector3 way = AddAnchor(contact, RigidSideOf(contact.m_solverBodyIdA),
                                    RigidSideOf(contact.m_solverBodyIdB))
                              .way;
    btSolverConstraint* const rows =
        &m_tmpSolverContactFrictionConstraintPool[contact.m_frictionIndex];
    for (btSolverConstraint* row : {rows, rows + 1})
      row->m_rhs -= rate * way.dot(row->m_contactNormal1) * row->m_jacDiagABInv;
  }
}

void BulletSolver::HoldAnchors(const btContactSolverInfo& info) {
  drifts_.clear();
  first_anchor_ = anchors_.size();
  const auto side = [&](const btMultiBody* multibody, int link, int body) {
    return multibody ? FrictionAnchors::Side{multibody, link} : RigidSideOf(body);
  };
  for (const Row& row : normals_) {
    const btMultiBodySolverConstraint& source = *row.source;
    drifts_.push_back(AddAnchor(source,
                                side(source.m_multiBodyA, source.m_linkA, source.m_solverBodyIdA),
                                side(source.m_multiBodyB, source.m_linkB, source.m_solverBodyIdB)));
  }
  const btScalar rate = info.m_erp / info.m_timeStep;
  const auto drift_of = [&](const Row& row) {
    return drifts_[static_cast<std::size_t>(row.normal)];
  };
  for (Row& row : frictions_)
    row.wanted -= rate * drift_of(row).way.dot(row.source->m_contactNormal1);
  for (Rows* rows : {&rolling_, &spinning_})
    for (Row& row : *rows)
      row.wanted -= rate * drift_of(row).turn.dot(row.source->m_relpos1CrossNormal);
}

void BulletSolver::ForgetSlidingAnchors() {
  const auto slides = [&](const Row& row, btScalar square) {
    const btScalar limit = kSticks * row.friction * Pressure(row);
    return square >= limit * limit;
  };
  const auto anchor_of = [&](const Row& row) {
    return first_anchor_ + static_cast<std::size_t>(row.normal);
  };
  const auto square = [](const Row& row) { return row.impulse * row.impulse; };
  for (std::size_t i = 0; i + 1 < frictions_.size(); i += 2)
    if (slides(frictions_[i], square(frictions_[i]) + square(frictions_[i + 1])))
      anchors_.Forget(anchor_of(frictions_[i]));
  for (std::size_t i = 0; i + 1 < rolling_.size(); i += 2)
    if (slides(rolling_[i], square(rolling_[i]) + square(rolling_[i + 1])))
      anchors_.ForgetRoll(anchor_of(rolling_[i]));
  for (const Row& row : spinning_)
    if (slides(row, square(row))) anchors_.ForgetSpin(anchor_of(row));
  for (const auto& [i, anchor] : rigid_anchors_) {
    const btSolverConstraint& contact = m_tmpSolverContactConstraintPool[i];
    const btSolverConstraint* const rows =
        &m_tmpSolverContactFrictionConstraintPool[contact.m_frictionIndex];
    const btScalar limit = kSticks * rows[0].m_friction * contact.m_appliedImpulse;
    const btScalar first = rows[0].m_appliedImpulse, second = rows[1].m_appliedImpulse;
    if (first * first + second * second >= limit * limit) anchors_.Slip(anchor);
  }
}

void BulletSolver::allSolved(const btContactSolverInfo& info, btIDebugDraw* drawer) {
  btMultiBodyConstraintSolver::allSolved(info, drawer);
  anchors_.BeginTick();
}

void BulletSolver::convertContacts(btPersistentManifold** manifolds, int count,
                                   const btContactSolverInfo& info) {
  PlaceInOrder(manifolds, count);
  const TimelyBounces bounces(manifolds, count, info.m_timeStep,
                              info.m_restitutionVelocityThreshold);
  btMultiBodyConstraintSolver::convertContacts(manifolds, count, info);
}

void BulletSolver::Flatten(btMultiBodyConstraintArray& sources, Rows& rows) {
  rows.clear();
  for (int i = 0; i < sources.size(); ++i) {
    btMultiBodySolverConstraint& source = sources[i];
    // A row that cannot move has no mass, and its impulse stays as it is.
    const btScalar mass = source.m_jacDiagABInv > 0 ? 1 / source.m_jacDiagABInv : 0;
    rows.push_back({.a = MakeSide(source.m_multiBodyA, source.m_solverBodyIdA, source.m_jacAindex,
                                  source.m_deltaVelAindex, source.m_contactNormal1,
                                  source.m_relpos1CrossNormal, source.m_angularComponentA),
                    .b = MakeSide(source.m_multiBodyB, source.m_solverBodyIdB, source.m_jacBindex,
                                  source.m_deltaVelBindex, source.m_contactNormal2,
                                  source.m_relpos2CrossNormal, source.m_angularComponentB),
                    .wanted = source.m_rhs * mass,
                    .softness = source.m_cfm * mass,
                    .inverse_mass = source.m_jacDiagABInv,
                    .least = source.m_lowerLimit,
                    .most = source.m_upperLimit,
                    .friction = source.m_friction,
                    .impulse = source.m_appliedImpulse,
                    .normal = source.m_frictionIndex,
                    .source = &source});
  }
}

void BulletSolver::Interleave(Rows& rows) {
  // The level of a row is one above the highest of the earlier rows that have a body in common.
  std::vector<std::pair<const Six*, std::size_t>> next_level;
  std::vector<std::size_t> level(rows.size()), order(rows.size());
  const auto next_of = [&](const Six* body) -> std::size_t& {
    const auto it = std::ranges::find(next_level, body, &std::pair<const Six*, std::size_t>::first);
    return it != next_level.end() ? it->second : next_level.emplace_back(body, 0).second;
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const Side* side : {&rows[i].a, &rows[i].b})
      if (side->rigid.speeds) level[i] = std::max(level[i], next_of(side->rigid.speeds));
    for (const Side* side : {&rows[i].a, &rows[i].b})
      if (side->rigid.speeds) next_of(side->rigid.speeds) = level[i] + 1;
    order[i] = i;
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return level[i]; });
  interleaved_.clear();
  for (const std::size_t i : order) interleaved_.push_back(rows[i]);
  rows.swap(interleaved_);
}

BulletSolver::Side BulletSolver::MakeSide(btMultiBody* multibody, int solver_body, int jacobian,
                                          int speeds, const btVector3& linear,
                                          const btVector3& angular,
                                          const btVector3& angular_response) {
  if (multibody) return MakeSide(*multibody, jacobian, speeds);
  if (solver_body < 0) return {};
  return {.rigid = MakeRigidSide(m_tmpSolverBodyPool[solver_body], rigid_.SpeedsOf(solver_body),
                                 linear, angular, angular_response)};
}

BulletSolver::Side BulletSolver::MakeSide(btMultiBody& multibody, int place, int speeds) {
  const btScalar* const jacobian = &m_data.m_jacobians[place];
  MultibodyUse& use = UseOf(multibody, speeds);
  const MultibodyInertia& inertia = *use.inertia;
  Side side;
  const MultibodyInertia::Places limbs = inertia.LimbsOf(jacobian);
  // Bullet gives a joint motor a second side without effect.
  if (limbs.end == 0 && std::count(jacobian, jacobian + 6, 0) == 6) return {};
  side.rigid.speeds = &use.base;
  side.rigid.jacobian = inertia.OnBase(jacobian);
  // Bullet asked for it when it made the row.
  std::copy_n(&m_data.m_deltaVelocitiesUnitImpulse[place], 6, side.rigid.response.begin());
  side.first_joint = use.first_joint + limbs.first;
  const std::size_t count = limbs.end - limbs.first;
  side.joint_count = count + count % 2;
  side.coefficients = coefficients_.size();
  coefficients_.resize(side.coefficients + 2 * side.joint_count);
  btScalar* const elements = coefficients_.data() + side.coefficients;
  for (std::size_t i = 0; i < count; ++i) {
    elements[i] = jacobian[6 + inertia.JointAt(limbs.first + i)];
    elements[side.joint_count + i] = inertia.JointResponse(limbs.first + i, jacobian);
    if (elements[i] != 0 && side.acts_to == 0) side.acts_from = i;
    if (elements[i] != 0) side.acts_to = i + 1;
  }
  return side;
}

btScalar BulletSolver::Coupling(const Side& first, const Side& second) const {
  btScalar coupling = first.rigid.SpeedBy(second.rigid);
  const std::size_t from = std::max(first.first_joint, second.first_joint);
  const std::size_t to =
      std::min(first.first_joint + first.joint_count, second.first_joint + second.joint_count);
  for (std::size_t joint = from; joint < to; ++joint)
    coupling +=
        coefficients_[first.coefficients + joint - first.first_joint] *
        coefficients_[second.coefficients + second.joint_count + joint - second.first_joint];
  return coupling;
}

void BulletSolver::ComputeResponses(const Rows& pairs, Responses& responses) const {
  responses.clear();
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2) {
    const Row &first = pairs[i], &second = pairs[i + 1];
    responses.emplace_back(1 / first.inverse_mass,
                           Coupling(first.a, second.a) + Coupling(first.b, second.b),
                           1 / second.inverse_mass);
  }
}

BulletSolver::MultibodyUse& BulletSolver::UseOf(btMultiBody& multibody, int speeds) {
  for (MultibodyUse& use : multibodies_)
    if (use.multibody == &multibody) return use;
  multibody.setPosUpdated(false);
  const MultibodyInertia& inertia = inertias_.Of(multibody);
  const std::size_t first_joint = joint_speeds_.size();
  // One more, which always stays zero, for a limb with an odd number of joints.
  joint_speeds_.resize(first_joint + inertia.joint_count() + 1);
  return multibodies_.emplace_back(
      MultibodyUse{&multibody, &inertia, speeds, first_joint, /*base=*/{}});
}

void BulletSolver::ApplySpeeds(const MultibodyUse& use) {
  btScalar* const speeds = &m_data.m_deltaVelocities[use.speeds];
  use.inertia->ToSpeeds(use.base, joint_speeds_.data() + use.first_joint, speeds);
  use.multibody->applyDeltaVeeMultiDof2(speeds, 1);
}

inline btScalar BulletSolver::SpeedAlong(const Side& side) const {
  btScalar speed = side.rigid.SpeedAlong();
  const btScalar* const factors = coefficients_.data() + side.coefficients;
  const btScalar* const speeds = joint_speeds_.data() + side.first_joint;
  for (std::size_t i = side.acts_from; i < side.acts_to; ++i) speed += factors[i] * speeds[i];
  return speed;
}

btScalar BulletSolver::Pressure(const Row& friction) const {
  return normals_[static_cast<std::size_t>(friction.normal)].impulse;
}

inline btScalar BulletSolver::SpeedError(const Row& row) const {
  // Each row waits for the one before, so that a sum with nothing counts, too.
  const btScalar error = row.wanted - row.impulse * row.softness - SpeedAlong(row.a);
  return row.b.rigid.speeds ? error - SpeedAlong(row.b) : error;
}

inline void BulletSolver::Push(const Side& side, btScalar impulse) {
  side.rigid.Push(impulse);
  const btScalar* const responses = coefficients_.data() + side.coefficients + side.joint_count;
  btScalar* const speeds = joint_speeds_.data() + side.first_joint;
  for (std::size_t i = 0; i < side.joint_count; i += 2) {
    const Two changed = Load(speeds + i) + Load(responses + i) * impulse;
    std::memcpy(speeds + i, &changed, sizeof changed);
  }
}

inline void BulletSolver::Push(const Row& row, btScalar impulse) {
  if (impulse == 0) return;
  Push(row.a, impulse);
  Push(row.b, impulse);
}

btScalar BulletSolver::Solve(Row& row) {
  btScalar change = SpeedError(row) * row.inverse_mass;
  btScalar sum = row.impulse + change;
  Clamp(row.least, row.most, row.impulse, sum, change);
  row.impulse = sum;
  Push(row, change);
  return change * change;
}

btScalar BulletSolver::SolvePair(Row& first, Row& second, const PrincipalResponse& response) {
  const btScalar limit = first.friction * Pressure(first);
  if (limit <= 0 && first.impulse == 0 && second.impulse == 0) return 0;
  const RowPair change = FrictionChange({first.impulse, second.impulse}, limit, response,
                                        {SpeedError(first), SpeedError(second)});
  first.impulse += change.first;
  second.impulse += change.second;
  Push(first, change.first);
  Push(second, change.second);
  return std::max(change.first * change.first, change.second * change.second);
}

btScalar BulletSolver::SolvePairs(Rows& rows, const Responses& responses, bool only_pressed) {
  btScalar largest = 0;
  for (std::size_t i = 0; i + 1 < rows.size(); i += 2)
    if (!only_pressed || Pressure(rows[i]) > 0)
      largest = std::max(largest, SolvePair(rows[i], rows[i + 1], responses[i / 2]));
  return largest;
}

RigidRows::Pools BulletSolver::RigidPools() {
  return {.bodies = m_tmpSolverBodyPool,
          .joints = m_tmpSolverNonContactConstraintPool,
          .contacts = m_tmpSolverContactConstraintPool,
          .frictions = m_tmpSolverContactFrictionConstraintPool,
          .rolling = m_tmpSolverContactRollingFrictionConstraintPool,
          .shared = shared_};
}

void BulletSolver::FindShared() {
  shared_.assign(static_cast<std::size_t>(m_tmpSolverBodyPool.size()), 0);
  const auto mark = [&](int body) { shared_[static_cast<std::size_t>(body)] = 1; };
  for (const btMultiBodyConstraintArray* rows :
       {&m_multiBodyNonContactConstraints, &m_multiBodyNormalContactConstraints})
    for (int i = 0; i < rows->size(); ++i) {
      const btMultiBodySolverConstraint& row = (*rows)[i];
      if (!row.m_multiBodyA && row.m_solverBodyIdA >= 0) mark(row.m_solverBodyIdA);
      if (!row.m_multiBodyB && row.m_solverBodyIdB >= 0) mark(row.m_solverBodyIdB);
    }
}

void BulletSolver::solveGroupCacheFriendlySplitImpulseIterations(btCollisionObject**, int,
                                                                 btPersistentManifold**, int,
                                                                 btTypedConstraint**, int,
                                                                 const btContactSolverInfo& info,
                                                                 btIDebugDraw*) {
  if (!info.m_splitImpulse) return;
  for (int i = 0; i < info.m_numIterations; ++i) {
    // One after the other: a grain may be in rows of both.
    const btScalar grains_change = grains_.SolvePenetrations();
    if (std::max(rigid_.SolvePenetrations(), grains_change) <= info.m_leastSquaresResidualThreshold)
      return;
  }
}

btScalar BulletSolver::solveSingleIteration(int iteration, btCollisionObject**, int,
                                            btPersistentManifold**, int, btTypedConstraint**, int,
                                            const btContactSolverInfo& info, btIDebugDraw*) {
  if (iteration % kGrainPeriod == 0) grains_change_ = grains_.Solve();
  btScalar largest = std::max(rigid_.Solve(iteration, info.m_numIterations), grains_change_);
  // Joints are solved forwards and backwards in turn, as in Bullet.
  const std::size_t joint_count = joints_.size();
  for (std::size_t i = 0; i < joint_count; ++i)
    largest = std::max(largest, Solve(joints_[iteration & 1 ? i : joint_count - 1 - i]));
  for (Row& row : normals_) largest = std::max(largest, Solve(row));
  for (Row& row : spinning_) {
    const btScalar pressure = Pressure(row);
    if (pressure <= 0) continue;
    row.most = row.friction * pressure;
    row.least = -row.most;
    largest = std::max(largest, Solve(row));
  }
  largest = std::max(largest, SolvePairs(rolling_, rolling_responses_, /*only_pressed=*/true));
  return std::max(largest, SolvePairs(frictions_, friction_responses_, /*only_pressed=*/false));
}

btScalar BulletSolver::solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                                     const btContactSolverInfo& info) {
  for (const Rows* rows : {&joints_, &normals_, &frictions_, &rolling_, &spinning_})
    for (const Row& row : *rows) row.source->m_appliedImpulse = row.impulse;
  rigid_.WriteBack(RigidPools());
  ForgetSlidingAnchors();
  grains_.WriteBack();
  for (const MultibodyUse& use : multibodies_) ApplySpeeds(use);
  return btMultiBodyConstraintSolver::solveGroupCacheFriendlyFinish(bodies, body_count, info);
}

}  // namespace prehend::physics
