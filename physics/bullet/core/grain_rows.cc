// SPDX-License-Identifier: Apache-2.0
// Speeds wanted of a contact follow btSequentialImpulseConstraintSolver of Bullet 3.24 (zlib
// licence). Tested by tests/physics/bullet/grain_contacts_test.cc
#include "physics/bullet/core/grain_rows.h"

#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace prehend::physics {
namespace {

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
  unarranged_.clear();
  bodies_.clear();
  penetrations_.clear();
  for (GrainContact& contact : contacts) {
    const int a = SolverBodyOf(*contact.a, bodies), b = SolverBodyOf(*contact.b, bodies);
    if (a < 0 || b < 0) continue;
    unarranged_.push_back(
        MakeRow(contact, bodies[a], bodies[b], rigid.SpeedsOf(a), rigid.SpeedsOf(b), info));
    bodies_.push_back({At(a), At(b)});
    const Row& row = unarranged_.back();
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
          .n = {},
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
  const std::size_t count = unarranged_.size();
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
  for (std::size_t level = 1; level <= count; ++level) next_[level] += next_[level - 1];
  rows_.resize(count);
  for (std::size_t i = 0; i < count; ++i) rows_[next_[level_[i]]++] = unarranged_[i];
}

btScalar GrainRows::SolveRow(Row& row) {
  btScalar* const a = row.a->data();
  btScalar* const b = row.b->data();
  const btScalar nx = row.n[0], ny = row.n[1], nz = row.n[2];
  btScalar x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  // The normal.
  const btScalar along = nx * x + ny * y + nz * z;
  btScalar push = (row.wanted - along) * row.normal_mass;
  const btScalar pressure = std::max(row.impulse + push, btScalar(0));
  push = pressure - row.impulse;
  row.impulse = pressure;
  const btScalar pushed = along + 2 * row.inverse_mass * push;
  // Across it: the same without its part along the normal, and with the surfaces' turning.
  const btScalar u = a[3] + b[3], v = a[4] + b[4], w = a[5] + b[5];
  x += row.slip[0] - along * nx - row.radius * (v * nz - w * ny);
  y += row.slip[1] - along * ny - row.radius * (w * nx - u * nz);
  z += row.slip[2] - along * nz - row.radius * (u * ny - v * nx);
  btScalar fx = row.sliding[0] - x * row.sliding_mass;
  btScalar fy = row.sliding[1] - y * row.sliding_mass;
  btScalar fz = row.sliding[2] - z * row.sliding_mass;
  const btScalar limit = row.friction * pressure, squared = fx * fx + fy * fy + fz * fz;
  if (squared > limit * limit) {
    const btScalar scale = limit / std::sqrt(squared);
    fx *= scale, fy *= scale, fz *= scale;
  }
  const btScalar dx = fx - row.sliding[0], dy = fy - row.sliding[1], dz = fz - row.sliding[2];
  row.sliding[0] = fx, row.sliding[1] = fy, row.sliding[2] = fz;
  const btScalar m = row.inverse_mass, t = row.turn;
  const btScalar px = m * (push * nx + dx), py = m * (push * ny + dy), pz = m * (push * nz + dz);
  a[0] += px, a[1] += py, a[2] += pz;
  b[0] -= px, b[1] -= py, b[2] -= pz;
  // Both surfaces are turned the same way: the arm and the impulse change sign together.
  const btScalar tx = t * (ny * dz - nz * dy), ty = t * (nz * dx - nx * dz),
                 tz = t * (nx * dy - ny * dx);
  a[3] -= tx, a[4] -= ty, a[5] -= tz;
  b[3] -= tx, b[4] -= ty, b[5] -= tz;
  const btScalar changed = pushed - along, slid = row.sliding_response;
  return std::max(changed * changed, (dx * dx + dy * dy + dz * dz) * slid * slid);
}

btScalar GrainRows::Solve() {
  btScalar largest = 0;
  for (Row& row : rows_) largest = std::max(largest, SolveRow(row));
  return largest;
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
  for (const Row& row : rows_) row.source->impulse = row.impulse;
}

}  // namespace prehend::physics
