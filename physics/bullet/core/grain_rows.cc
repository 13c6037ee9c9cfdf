// SPDX-License-Identifier: Apache-2.0
// Speeds wanted of a contact follow btSequentialImpulseConstraintSolver of Bullet 3.24 (zlib
// licence).
#include "physics/bullet/core/grain_rows.h"

#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>

namespace prehend::physics {
namespace {

constexpr std::size_t kLanes = GrainBlock::kLanes;

std::size_t At(int index) { return static_cast<std::size_t>(index); }

void Copy(const btVector3& from, btScalar* to) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

}  // namespace

int GrainRows::SolverBodyOf(const btRigidBody& grain,
                            const btAlignedObjectArray<btSolverBody>& bodies) {
  // A body of another group may keep the number that it had there.
  const int i = grain.getCompanionId();
  return i >= 0 && i < bodies.size() && bodies[i].m_originalBody == &grain ? i : -1;
}

void GrainRows::Setup(std::vector<GrainContact>& contacts,
                      const btAlignedObjectArray<btSolverBody>& bodies, RigidRows& rigid,
                      const btContactSolverInfo& info) {
  rows_.clear();
  bodies_.clear();
  penetrations_.clear();
  for (GrainContact& contact : contacts) {
    const int a = SolverBodyOf(*contact.a, bodies), b = SolverBodyOf(*contact.b, bodies);
    if (a < 0 || b < 0) continue;
    rows_.push_back(
        MakeRow(contact, bodies[a], bodies[b], rigid.SpeedsOf(a), rigid.SpeedsOf(b), info));
    bodies_.push_back({At(a), At(b)});
    const Row& row = rows_.back();
    if (contact.gap_m > info.m_splitImpulsePenetrationThreshold) continue;
    penetrations_.push_back({.a = &rigid.PushesOf(a),
                             .b = &rigid.PushesOf(b),
                             .n = {row.n[0], row.n[1], row.n[2]},
                             .wanted = -contact.gap_m * info.m_erp2 / info.m_timeStep,
                             .normal_mass = row.normal_mass,
                             .inverse_mass = row.inverse_mass,
                             .impulse = 0});
  }
  Arrange(At(bodies.size()));
  for (const Row& row : rows_) {  // warm start
    for (std::size_t i = 0; i < 3; ++i) {
      (*row.a)[i] += row.impulse * row.inverse_mass * row.n[i];
      (*row.b)[i] -= row.impulse * row.inverse_mass * row.n[i];
    }
  }
}

GrainRows::Row GrainRows::MakeRow(GrainContact& contact, const btSolverBody& a,
                                  const btSolverBody& b, Six& a_speeds, Six& b_speeds,
                                  const btContactSolverInfo& info) const {
  const btRigidBody& grain = *contact.a;
  const btScalar radius = static_cast<const btSphereShape*>(grain.getCollisionShape())->getRadius();
  const btScalar inverse_mass = grain.getInvMass();
  const btScalar inverse_inertia = grain.getInvInertiaDiagLocal().x();
  const btVector3& n = contact.normal;
  const btVector3 turning = a.m_angularVelocity + b.m_angularVelocity;
  const btVector3 apart = a.m_linearVelocity - b.m_linearVelocity;
  const btVector3 pulled = apart + a.m_externalForceImpulse - b.m_externalForceImpulse;
  const btVector3 slipping = pulled - radius * turning.cross(n);
  const btScalar restitution = contact.a->getRestitution() * contact.b->getRestitution();
  const btScalar approach = -apart.dot(n);
  btScalar wanted = -pulled.dot(n);
  if (approach > info.m_restitutionVelocityThreshold) wanted += restitution * approach;
  if (contact.gap_m > 0)
    wanted -= contact.gap_m / info.m_timeStep;
  else if (contact.gap_m > info.m_splitImpulsePenetrationThreshold)
    wanted -= contact.gap_m * info.m_erp2 / info.m_timeStep;
  const btScalar response = 2 * inverse_mass + 2 * radius * radius * inverse_inertia;
  Row row{.a = &a_speeds,
          .b = &b_speeds,
          .wanted = wanted,
          .slip = {},
          .normal_mass = 1 / (2 * inverse_mass),
          .sliding_mass = 1 / response,
          .sliding_response = response,
          .inverse_mass = inverse_mass,
          .turn = radius * inverse_inertia,
          .radius = radius,
          .friction = contact.a->getFriction() * contact.b->getFriction(),
          .impulse = contact.impulse * info.m_warmstartingFactor,
          .sliding = {},
          .source = &contact};
  Copy(n, row.n);
  Copy(slipping - n * slipping.dot(n), row.slip);
  return row;
}

void GrainRows::Arrange(std::size_t body_count) {
  const std::size_t count = rows_.size();
  // The level of a row is one above the highest of the earlier rows that share a grain with it.
  bodys_level_.assign(body_count, 0);
  level_.resize(count);
  next_.assign(count + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const auto [a, b] = bodies_[i];
    level_[i] = std::max(bodys_level_[a], bodys_level_[b]);
    bodys_level_[a] = bodys_level_[b] = level_[i] + 1;
    ++next_[level_[i] + 1];
  }
  first_block_.resize(count + 1);
  std::size_t blocks = 0;
  for (std::size_t level = 0; level < count; ++level) {
    first_block_[level] = blocks;
    blocks += (next_[level + 1] + kLanes - 1) / kLanes;
  }
  blocks_.assign(blocks, GrainBlock{});
  sources_.assign(blocks, {});
  for (GrainBlock& block : blocks_)
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      block.a[lane] = block.b[lane] = nothing_.data();
  next_.assign(count + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = next_[level_[i]]++;
    const std::size_t block = first_block_[level_[i]] + place / kLanes;
    Put(rows_[i], blocks_[block], place % kLanes);
    sources_[block][place % kLanes] = rows_[i].source;
  }
}

void GrainRows::Put(const Row& row, GrainBlock& block, std::size_t lane) {
  block.a[lane] = row.a->data();
  block.b[lane] = row.b->data();
  for (std::size_t i = 0; i < 3; ++i) {
    block.n[i][lane] = row.n[i];
    block.slip[i][lane] = row.slip[i];
    block.sliding[i][lane] = row.sliding[i];
  }
  block.wanted[lane] = row.wanted;
  block.normal_mass[lane] = row.normal_mass;
  block.sliding_mass[lane] = row.sliding_mass;
  block.sliding_response[lane] = row.sliding_response;
  block.inverse_mass[lane] = row.inverse_mass;
  block.turn[lane] = row.turn;
  block.radius[lane] = row.radius;
  block.friction[lane] = row.friction;
  block.impulse[lane] = row.impulse;
}

btScalar GrainRows::Solve(const Kernels& kernels) {
  return kernels.solve_grains(blocks_.data(), blocks_.size());
}

btScalar GrainRows::SolvePenetrations() {
  btScalar largest = 0;
  for (Penetration& row : penetrations_) {
    Six &a = *row.a, &b = *row.b;
    btScalar along = 0;
    for (std::size_t i = 0; i < 3; ++i) along += row.n[i] * (a[i] - b[i]);
    const btScalar sum =
        std::max(row.impulse + (row.wanted - along) * row.normal_mass, btScalar(0));
    const btScalar change = (sum - row.impulse) * row.inverse_mass;
    row.impulse = sum;
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] += change * row.n[i];
      b[i] -= change * row.n[i];
    }
    largest = std::max(largest, 4 * change * change);
  }
  return largest;
}

void GrainRows::WriteBack() const {
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      if (sources_[i][lane]) sources_[i][lane]->impulse = blocks_[i].impulse[lane];
}

}  // namespace prehend::physics
