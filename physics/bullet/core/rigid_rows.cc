// SPDX-License-Identifier: Apache-2.0
// Method and rows: btSequentialImpulseConstraintSolver of Bullet 3.24 (zlib licence). Without
// friction the results are the same, bit by bit.
#include "physics/bullet/core/rigid_rows.h"

#include <algorithm>
#include <limits>

#include "physics/bullet/core/grain_contacts.h"

namespace prehend::physics {
namespace {

constexpr btScalar kNoLimit = std::numeric_limits<btScalar>::infinity();

/// Rows of one contact, in Bullet's order.
constexpr std::size_t kFrictionRows = 2;  // two directions
constexpr std::size_t kRollingRows = 3;   // spinning, then two directions of rolling

/// Rows of two bodies are solved once more per so much that one is heavier, up to the most.
constexpr btScalar kMassRatioOfRepeat = 2.5;
constexpr int kMostRepeats = 20;

std::size_t At(int index) { return static_cast<std::size_t>(index); }

bool IsGrain(const btSolverBody& body) {
  return body.m_originalBody && body.m_originalBody->getUserIndex2() == kGrain;
}

}  // namespace

void RigidRows::Setup(const Pools& pools) {
  grains_change_ = 0;
  const std::size_t body_count = At(pools.bodies.size());
  speeds_.resize(body_count);
  pushes_.resize(body_count);
  for (int i = 0; i < pools.bodies.size(); ++i) {
    btSolverBody& body = pools.bodies[i];
    speeds_[At(i)] =
        SixOf(body.internalGetDeltaLinearVelocity(), body.internalGetDeltaAngularVelocity());
    pushes_[At(i)] = SixOf(body.internalGetPushVelocity(), body.internalGetTurnVelocity());
  }
  others_.clear();
  FindRepeats(pools);
  single_bodies_.Setup(single_, pools.bodies, speeds_, pools.contacts, pools.frictions);
  Flatten(pools, pools.joints, 1, joints_);
  Flatten(pools, pools.contacts, 1, contacts_);
  for (Row& row : contacts_) row.most = kNoLimit;
  pressures_.resize(At(pools.contacts.size()));
  for (std::size_t i = 0; i < contacts_.size(); ++i)
    pressures_[At(order_[i])] = &contacts_[i].impulse;
  TakePenetrations(pools);
  Flatten(pools, pools.frictions, kFrictionRows, frictions_);
  Flatten(pools, pools.rolling, kRollingRows, rolling_);
  for (Rows* rows : {&frictions_, &rolling_})
    for (Row& row : *rows) row.pressure = pressures_[At(row.source->m_frictionIndex)];
  ComputeResponses(frictions_, kFrictionRows, friction_responses_);
  ComputeResponses(rolling_, kRollingRows, rolling_responses_);
}

void RigidRows::FindSingleBodies(const Pools& pools) {
  single_.resize(At(pools.bodies.size()));
  for (std::size_t i = 0; i < single_.size(); ++i) {
    const btSolverBody& body = pools.bodies[static_cast<int>(i)];
    single_[i] = Moves(body) && !IsGrain(body) && !pools.shared[i];
  }
  for (const btConstraintArray* rows : {&pools.joints, &pools.contacts, &pools.rolling}) {
    for (int i = 0; i < rows->size(); ++i) {
      const int a = (*rows)[i].m_solverBodyIdA, b = (*rows)[i].m_solverBodyIdB;
      if (rows != &pools.contacts || (Moves(pools.bodies[a]) && Moves(pools.bodies[b])))
        single_[At(a)] = single_[At(b)] = 0;
    }
  }
}

void RigidRows::FindRepeats(const Pools& pools) {
  repeats_.assign(At(pools.bodies.size()), 1);
  most_repeats_ = 1;
  for (int i = 0; i < pools.contacts.size(); ++i) {
    const int a = pools.contacts[i].m_solverBodyIdA, b = pools.contacts[i].m_solverBodyIdB;
    const btSolverBody &first = pools.bodies[a], &second = pools.bodies[b];
    if (!Moves(first) || !Moves(second) || IsGrain(first) || IsGrain(second) ||
        pools.shared[At(a)] || pools.shared[At(b)])
      continue;
    const btScalar of_a = first.internalGetInvMass().x(), of_b = second.internalGetInvMass().x();
    const btScalar ratio = std::max(of_a, of_b) / std::min(of_a, of_b) / kMassRatioOfRepeat;
    int& repeats = repeats_[At(of_a > of_b ? a : b)];
    repeats = std::max(repeats, static_cast<int>(std::min<btScalar>(ratio, kMostRepeats)));
    most_repeats_ = std::max(most_repeats_, repeats);
  }
}

bool RigidRows::MayCreep(const btSolverConstraint& contact, const Pools& pools) const {
  const int a = contact.m_solverBodyIdA, b = contact.m_solverBodyIdB;
  const auto is_loose = [&](int body) {
    return Moves(pools.bodies[body]) && !pools.shared[At(body)];
  };
  return (is_loose(a) || is_loose(b)) && !IsSingle(contact) && !IsGrain(pools.bodies[a]) &&
         !IsGrain(pools.bodies[b]);
}

bool RigidRows::IsSingle(const btSolverConstraint& source) const {
  return single_[At(source.m_solverBodyIdA)] || single_[At(source.m_solverBodyIdB)];
}

void RigidRows::Arrange(const btConstraintArray& sources, std::size_t group,
                        const btAlignedObjectArray<btSolverBody>& bodies) {
  const std::size_t count = At(sources.size()) / group;
  // The level of a group is one above the highest earlier group that shares a moving body with it.
  bodys_level_.assign(At(bodies.size()), -1);
  level_.resize(count);
  next_.assign(count + 1, 0);
  std::size_t arranged = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const btSolverConstraint& source = sources[static_cast<int>(i * group)];
    level_[i] = -1;
    if (IsSingle(source)) continue;
    ++arranged;
    int level = 0;
    for (const int body : {source.m_solverBodyIdA, source.m_solverBodyIdB})
      if (Moves(bodies[body])) level = std::max(level, bodys_level_[At(body)] + 1);
    bodys_level_[At(source.m_solverBodyIdA)] = bodys_level_[At(source.m_solverBodyIdB)] = level;
    level_[i] = level;
    ++next_[At(level) + 1];
  }
  for (std::size_t level = 1; level <= count; ++level) next_[level] += next_[level - 1];
  order_.resize(arranged * group);
  for (std::size_t i = 0; i < count; ++i) {
    if (level_[i] < 0) continue;
    const std::size_t place = At(next_[At(level_[i])]++);
    for (std::size_t k = 0; k < group; ++k)
      order_[place * group + k] = static_cast<int>(i * group + k);
  }
}

void RigidRows::Flatten(const Pools& pools, const btConstraintArray& sources, std::size_t group,
                        Rows& rows) {
  Arrange(sources, group, pools.bodies);
  rows.clear();
  for (const int i : order_) rows.push_back(MakeRow(sources[i], pools, speeds_));
}

RigidRows::Row RigidRows::MakeRow(const btSolverConstraint& source, const Pools& pools,
                                  std::vector<Six>& speeds) {
  const int a = source.m_solverBodyIdA, b = source.m_solverBodyIdB;
  const RigidSide side_a = MakeRigidSide(pools.bodies[a], speeds[At(a)], source.m_contactNormal1,
                                         source.m_relpos1CrossNormal, source.m_angularComponentA);
  const RigidSide side_b = MakeRigidSide(pools.bodies[b], speeds[At(b)], source.m_contactNormal2,
                                         source.m_relpos2CrossNormal, source.m_angularComponentB);
  Row row{.side = side_a.speeds ? side_a : side_b,
          .wanted = source.m_rhs,
          .softness = source.m_cfm,
          .inverse_mass = source.m_jacDiagABInv,
          .mass = 1 / source.m_jacDiagABInv,
          .least = source.m_lowerLimit,
          .most = source.m_upperLimit,
          .friction = source.m_friction,
          .impulse = source.m_appliedImpulse,
          .pressure = nullptr,
          .iterations = source.m_overrideNumSolverIterations,
          .repeats = std::max(repeats_[At(a)], repeats_[At(b)]),
          .grain = IsGrain(pools.bodies[a]) || IsGrain(pools.bodies[b]),
          .source = &source};
  if (side_a.speeds && side_b.speeds) {
    row.other = static_cast<int>(others_.size());
    others_.push_back(side_b);
  }
  return row;
}

void RigidRows::TakePenetrations(const Pools& pools) {
  penetrations_.clear();
  const auto take = [&](const btSolverConstraint& source) {
    if (source.m_rhsPenetration == 0) return;
    Row& row = penetrations_.emplace_back(MakeRow(source, pools, pushes_));
    row.wanted = source.m_rhsPenetration;
    row.impulse = source.m_appliedPushImpulse;
    row.most = kNoLimit;
  };
  for (const Row& contact : contacts_) take(*contact.source);
  for (int i = 0; i < pools.contacts.size(); ++i)
    if (IsSingle(pools.contacts[i])) take(pools.contacts[i]);
}

inline const RigidSide* RigidRows::OtherOf(const Row& row) const {
  return row.other < 0 ? nullptr : &others_[At(row.other)];
}

inline btScalar RigidRows::WantedChange(const Row& row) const {
  btScalar change = row.wanted - row.impulse * row.softness;
  change -= row.side.SpeedAlong() * row.inverse_mass;
  if (const RigidSide* other = OtherOf(row)) change -= other->SpeedAlong() * row.inverse_mass;
  return change;
}

inline void RigidRows::Push(Row& row, btScalar change) {
  row.side.Push(change);
  if (const RigidSide* other = OtherOf(row)) other->Push(change);
}

inline btScalar RigidRows::Solve(Row& row) {
  btScalar change = WantedChange(row);
  btScalar sum = row.impulse + change;
  if (sum < row.least) {
    change = row.least - row.impulse;
    sum = row.least;
  } else if (sum > row.most) {
    change = row.most - row.impulse;
    sum = row.most;
  }
  row.impulse = sum;
  Push(row, change);
  const btScalar speed = change * row.mass;
  return speed * speed;
}

btScalar RigidRows::Coupling(const Row& first, const Row& second) const {
  const RigidSide *other = OtherOf(first), *seconds_other = OtherOf(second);
  return first.side.SpeedBy(second.side) + (other ? other->SpeedBy(*seconds_other) : 0);
}

void RigidRows::ComputeResponses(const Rows& rows, std::size_t group, Responses& responses) const {
  responses.clear();
  for (std::size_t end = group; end <= rows.size(); end += group) {
    const Row &first = rows[end - 2], &second = rows[end - 1];
    responses.emplace_back(first.mass, Coupling(first, second), second.mass);
  }
}

btScalar RigidRows::SolvePair(Row& first, Row& second, btScalar limit,
                              const PrincipalResponse& response) {
  const RowPair change =
      FrictionChange({first.impulse, second.impulse}, limit, response,
                     {WantedChange(first) * first.mass, WantedChange(second) * second.mass});
  first.impulse += change.first;
  second.impulse += change.second;
  Push(first, change.first);
  Push(second, change.second);
  const btScalar first_speed = change.first * first.mass;
  const btScalar second_speed = change.second * second.mass;
  return std::max(first_speed * first_speed, second_speed * second_speed);
}

btScalar RigidRows::Solve(int iteration, int contact_iterations) {
  if (iteration == 0) single_bodies_.Solve(contact_iterations);
  btScalar largest = 0;
  for (Row& row : joints_)
    if (iteration < row.iterations) largest = std::max(largest, Solve(row));
  if (iteration >= contact_iterations) return largest;
  const bool with_grains = iteration % kGrainPeriod == 0;
  if (with_grains) grains_change_ = 0;
  for (int repeat = 0; repeat < most_repeats_; ++repeat)
    largest = std::max(largest, SolveContacts(repeat, with_grains));
  return std::max(largest, grains_change_);
}

btScalar RigidRows::SolveContacts(int repeat, bool with_grains) {
  btScalar largest = 0;
  const auto changed = [&](const Row& row, btScalar change) {
    btScalar& most = row.grain ? grains_change_ : largest;
    most = std::max(most, change);
  };
  const auto waits = [&](const Row& row) {
    return row.repeats <= repeat || (row.grain && !with_grains);
  };
  for (Row& row : contacts_)
    if (!waits(row)) changed(row, Solve(row));
  for (std::size_t i = 0; i + 1 < frictions_.size(); i += kFrictionRows) {
    Row& row = frictions_[i];
    if (*row.pressure > 0 && !waits(row))
      changed(row, SolvePair(row, frictions_[i + 1], row.friction * *row.pressure,
                             friction_responses_[i / kFrictionRows]));
  }
  for (std::size_t i = 0; i + 2 < rolling_.size(); i += kRollingRows) {
    Row& spin = rolling_[i];
    if (*spin.pressure <= 0 || waits(spin)) continue;
    const auto limit = [&](const Row& row) {
      return std::min(row.friction * *row.pressure, row.friction);
    };
    spin.most = limit(spin);
    spin.least = -spin.most;
    changed(spin, Solve(spin));
    Row& roll = rolling_[i + 1];
    changed(roll,
            SolvePair(roll, rolling_[i + 2], limit(roll), rolling_responses_[i / kRollingRows]));
  }
  return largest;
}

btScalar RigidRows::SolvePenetrations() {
  btScalar largest = 0;
  for (Row& row : penetrations_) largest = std::max(largest, Solve(row));
  return largest;
}

void RigidRows::WriteBack(const Pools& pools) const {
  for (const Rows* rows : {&joints_, &contacts_, &frictions_, &rolling_})
    for (const Row& row : *rows) row.source->m_appliedImpulse = row.impulse;
  single_bodies_.WriteBack();
  for (int i = 0; i < pools.bodies.size(); ++i) {
    btSolverBody& body = pools.bodies[i];
    if (!Moves(body)) continue;
    const Six &v = speeds_[At(i)], &push = pushes_[At(i)];
    body.internalGetDeltaLinearVelocity().setValue(v[0], v[1], v[2]);
    body.internalGetDeltaAngularVelocity().setValue(v[3], v[4], v[5]);
    body.internalGetPushVelocity().setValue(push[0], push[1], push[2]);
    body.internalGetTurnVelocity().setValue(push[3], push[4], push[5]);
  }
}

}  // namespace prehend::physics
