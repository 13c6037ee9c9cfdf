// SPDX-License-Identifier: Apache-2.0
// Method and order of rows: btMultiBodyConstraintSolver of Bullet 3.24 (zlib licence). Without
// friction the results are the same, bit by bit. Tested by tests/physics/bullet/solver_test.cc
#include "physics/bullet/core/solver.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <algorithm>
#include <tuple>

#include "physics/bullet/core/friction_circle.h"
#include "physics/bullet/core/restitution.h"

namespace prehend::physics {
namespace {

void AddScaled(const btScalar* __restrict what, btScalar scale, int count,
               btScalar* __restrict sum) {
  for (int i = 0; i < count; ++i) sum[i] += what[i] * scale;
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
  const btScalar result = btMultiBodyConstraintSolver::solveGroupCacheFriendlySetup(
      bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info, drawer);
  rigid_.Setup(RigidPools());
  // No row of a multibody is warm-started: its speeds start at zero here, and their final values
  // are added to the multibody.
  terms_.clear();
  multibodies_.clear();
  Flatten(m_multiBodyNonContactConstraints, joints_);
  Flatten(m_multiBodyNormalContactConstraints, normals_);
  Flatten(m_multiBodyFrictionContactConstraints, frictions_);
  Flatten(m_multiBodyTorsionalFrictionContactConstraints, rolling_);
  Flatten(m_multiBodySpinningFrictionContactConstraints, spinning_);
  ComputeCouplings(frictions_, friction_couplings_);
  ComputeCouplings(rolling_, rolling_couplings_);
  return result;
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
    rows.push_back({.a = MakeSide(source.m_multiBodyA, source.m_solverBodyIdA, source.m_jacAindex,
                                  source.m_deltaVelAindex, source.m_contactNormal1,
                                  source.m_relpos1CrossNormal, source.m_angularComponentA),
                    .b = MakeSide(source.m_multiBodyB, source.m_solverBodyIdB, source.m_jacBindex,
                                  source.m_deltaVelBindex, source.m_contactNormal2,
                                  source.m_relpos2CrossNormal, source.m_angularComponentB),
                    .wanted = source.m_rhs,
                    .softness = source.m_cfm,
                    .inverse_mass = source.m_jacDiagABInv,
                    .least = source.m_lowerLimit,
                    .most = source.m_upperLimit,
                    .friction = source.m_friction,
                    .impulse = source.m_appliedImpulse,
                    .normal = source.m_frictionIndex,
                    .source = &source});
  }
}

BulletSolver::Side BulletSolver::MakeSide(btMultiBody* multibody, int solver_body, int jacobian,
                                          int speeds, const btVector3& linear,
                                          const btVector3& angular,
                                          const btVector3& angular_response) {
  Side side;
  if (multibody) {
    RegisterMultibody(*multibody, speeds);
    side.speeds = speeds;
    side.response = jacobian;
    side.speed_count = multibody->getNumDofs() + 6;
    side.first_term = static_cast<int>(terms_.size());
    for (int i = 0; i < side.speed_count; ++i)
      if (m_data.m_jacobians[jacobian + i] != 0)
        terms_.push_back({speeds + i, m_data.m_jacobians[jacobian + i]});
    side.end_term = static_cast<int>(terms_.size());
  } else if (solver_body >= 0) {
    side.rigid = MakeRigidSide(m_tmpSolverBodyPool[solver_body], rigid_.SpeedsOf(solver_body),
                               linear, angular, angular_response);
  }
  return side;
}

btScalar BulletSolver::Coupling(const Side& first, const Side& second) const {
  btScalar coupling = first.rigid.SpeedBy(second.rigid);
  for (int i = first.first_term; i < first.end_term; ++i) {
    const Term& term = terms_[static_cast<std::size_t>(i)];
    coupling += term.factor *
                m_data.m_deltaVelocitiesUnitImpulse[second.response + term.speed - first.speeds];
  }
  return coupling;
}

void BulletSolver::ComputeCouplings(const Rows& pairs, std::vector<btScalar>& couplings) const {
  couplings.clear();
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2)
    couplings.push_back(Coupling(pairs[i].a, pairs[i + 1].a) +
                        Coupling(pairs[i].b, pairs[i + 1].b));
}

void BulletSolver::RegisterMultibody(btMultiBody& multibody, int speeds) {
  const auto known = [&](const MultibodyUse& use) { return use.multibody == &multibody; };
  if (std::any_of(multibodies_.begin(), multibodies_.end(), known)) return;
  multibody.setPosUpdated(false);
  multibodies_.push_back({&multibody, speeds});
}

btScalar BulletSolver::SpeedAlong(const Side& side) const {
  btScalar speed = side.rigid.SpeedAlong();
  for (int i = side.first_term; i < side.end_term; ++i) {
    const Term& term = terms_[static_cast<std::size_t>(i)];
    speed += term.factor * m_data.m_deltaVelocities[term.speed];
  }
  return speed;
}

btScalar BulletSolver::Pressure(const Row& friction) const {
  return normals_[static_cast<std::size_t>(friction.normal)].impulse;
}

btScalar BulletSolver::WantedChange(const Row& row) const {
  btScalar change = row.wanted - row.impulse * row.softness;
  change -= SpeedAlong(row.a) * row.inverse_mass;
  change -= SpeedAlong(row.b) * row.inverse_mass;
  return change;
}

void BulletSolver::Push(const Side& side, btScalar impulse) {
  side.rigid.Push(impulse);
  if (side.speed_count > 0)
    AddScaled(&m_data.m_deltaVelocitiesUnitImpulse[side.response], impulse, side.speed_count,
              &m_data.m_deltaVelocities[side.speeds]);
}

void BulletSolver::Push(const Row& row, btScalar impulse) {
  if (impulse == 0) return;
  Push(row.a, impulse);
  Push(row.b, impulse);
}

btScalar BulletSolver::Solve(Row& row) {
  btScalar change = WantedChange(row);
  btScalar sum = row.impulse + change;
  Clamp(row.least, row.most, row.impulse, sum, change);
  row.impulse = sum;
  Push(row, change);
  return change * change;
}

btScalar BulletSolver::SolvePair(Row& first, Row& second, btScalar coupling) {
  const btScalar limit = first.friction * Pressure(first);
  if (limit <= 0 && first.impulse == 0 && second.impulse == 0) return 0;
  const PairResponse response{1 / first.inverse_mass, coupling, 1 / second.inverse_mass};
  const RowPair errors{WantedChange(first) * response.first,
                       WantedChange(second) * response.second};
  const RowPair change = FrictionChange({first.impulse, second.impulse}, limit, response, errors);
  first.impulse += change.first;
  second.impulse += change.second;
  Push(first, change.first);
  Push(second, change.second);
  return std::max(change.first * change.first, change.second * change.second);
}

btScalar BulletSolver::SolvePairs(Rows& rows, const std::vector<btScalar>& couplings,
                                  bool only_pressed) {
  btScalar largest = 0;
  for (std::size_t i = 0; i + 1 < rows.size(); i += 2)
    if (!only_pressed || Pressure(rows[i]) > 0)
      largest = std::max(largest, SolvePair(rows[i], rows[i + 1], couplings[i / 2]));
  return largest;
}

RigidRows::Pools BulletSolver::RigidPools() {
  return {.bodies = m_tmpSolverBodyPool,
          .joints = m_tmpSolverNonContactConstraintPool,
          .contacts = m_tmpSolverContactConstraintPool,
          .frictions = m_tmpSolverContactFrictionConstraintPool,
          .rolling = m_tmpSolverContactRollingFrictionConstraintPool};
}

void BulletSolver::solveGroupCacheFriendlySplitImpulseIterations(btCollisionObject**, int,
                                                                 btPersistentManifold**, int,
                                                                 btTypedConstraint**, int,
                                                                 const btContactSolverInfo& info,
                                                                 btIDebugDraw*) {
  if (!info.m_splitImpulse) return;
  for (int i = 0; i < info.m_numIterations; ++i)
    if (rigid_.SolvePenetrations() <= info.m_leastSquaresResidualThreshold) return;
}

btScalar BulletSolver::solveSingleIteration(int iteration, btCollisionObject**, int,
                                            btPersistentManifold**, int, btTypedConstraint**, int,
                                            const btContactSolverInfo& info, btIDebugDraw*) {
  btScalar largest = rigid_.Solve(iteration, info.m_numIterations);
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
  largest = std::max(largest, SolvePairs(rolling_, rolling_couplings_, /*only_pressed=*/true));
  return std::max(largest, SolvePairs(frictions_, friction_couplings_, /*only_pressed=*/false));
}

btScalar BulletSolver::solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                                     const btContactSolverInfo& info) {
  for (const Rows* rows : {&joints_, &normals_, &frictions_, &rolling_, &spinning_})
    for (const Row& row : *rows) row.source->m_appliedImpulse = row.impulse;
  rigid_.WriteBack(RigidPools());
  for (const MultibodyUse& use : multibodies_)
    use.multibody->applyDeltaVeeMultiDof2(&m_data.m_deltaVelocities[use.speeds], 1);
  return btMultiBodyConstraintSolver::solveGroupCacheFriendlyFinish(bodies, body_count, info);
}

}  // namespace prehend::physics
