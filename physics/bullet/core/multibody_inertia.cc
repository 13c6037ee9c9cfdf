// SPDX-License-Identifier: Apache-2.0
// Composite rigid bodies in world coordinates about the base's centre of mass; a tree's inertia is
// factorised from its leaves, which keeps the zeros between limbs.
#include "physics/bullet/core/multibody_inertia.h"

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace prehend::physics {
namespace {

std::size_t At(int index) { return static_cast<std::size_t>(index); }

btMatrix3x3 Diagonal(const btVector3& d) { return {d.x(), 0, 0, 0, d.y(), 0, 0, 0, d.z()}; }

/// |v|^2 1 - v v': turning inertia of a unit mass at `v`.
btMatrix3x3 TurningInertia(const btVector3& v) {
  const btScalar x = v.x(), y = v.y(), z = v.z();
  return {y * y + z * z, -x * y,        -x * z,  //
          -x * y,        x * x + z * z, -y * z,  //
          -x * z,        -y * z,        x * x + y * y};
}

/// Replaces a symmetric positive definite matrix, n x n, by the factor L of L' L (its lower
/// triangle), and computes its inverse. The element of i and j is zero unless one is an ancestor of
/// the other; parents come before their children.
void Invert(btScalar* matrix, const int* parents, std::size_t n, btScalar* inverse,
            btScalar* scratch) {
  const auto element = [&](int i, int j) -> btScalar& { return matrix[At(i) * n + At(j)]; };
  const int last = static_cast<int>(n) - 1;
  for (int k = last; k >= 0; --k) {
    element(k, k) = std::sqrt(element(k, k));
    for (int i = parents[k]; i >= 0; i = parents[i]) element(k, i) /= element(k, k);
    for (int i = parents[k]; i >= 0; i = parents[i])
      for (int j = i; j >= 0; j = parents[j]) element(i, j) -= element(k, i) * element(k, j);
  }
  for (int column = 0; column <= last; ++column) {
    btScalar* const x = scratch;
    std::fill(x, x + n, btScalar(0));
    x[column] = 1;
    for (int i = column; i >= 0; i = parents[i]) {
      x[i] /= element(i, i);
      for (int j = parents[i]; j >= 0; j = parents[j]) x[j] -= element(i, j) * x[i];
    }
    for (int i = 0; i <= last; ++i) {
      for (int j = parents[i]; j >= 0; j = parents[j]) x[i] -= element(i, j) * x[j];
      x[i] /= element(i, i);
      inverse[At(i) * n + At(column)] = x[i];
    }
  }
}

}  // namespace

void MultibodyInertia::Compute(const btMultiBody& multibody) {
  if (!IsArranged(multibody)) ArrangeJoints(multibody);
  ComputeMotions(multibody);
  ComputeInertias(multibody);
  Factorise(multibody.hasFixedBase());
}

bool MultibodyInertia::IsArranged(const btMultiBody& multibody) const {
  if (arranged_.size() != At(multibody.getNumLinks())) return false;
  for (std::size_t i = 0; i < arranged_.size(); ++i)
    if (arranged_[i] != multibody.getLink(static_cast<int>(i)).m_parent) return false;
  return true;
}

void MultibodyInertia::ArrangeJoints(const btMultiBody& multibody) {
  const std::size_t count = At(multibody.getNumLinks());
  arranged_.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    arranged_[i] = multibody.getLink(static_cast<int>(i)).m_parent;
  joint_at_.resize(count);
  place_of_.resize(count);
  parents_.resize(count);
  limbs_.resize(count);
  std::iota(joint_at_.begin(), joint_at_.end(), std::size_t{0});
  // The first joint of a limb, which moves against the base, names it.
  const auto limb = [&](std::size_t joint) {
    int root = static_cast<int>(joint);
    while (arranged_[At(root)] >= 0) root = arranged_[At(root)];
    return root;
  };
  std::stable_sort(joint_at_.begin(), joint_at_.end(),
                   [&](std::size_t a, std::size_t b) { return limb(a) < limb(b); });
  for (std::size_t i = 0; i < count; ++i) place_of_[joint_at_[i]] = i;
  for (std::size_t i = 0; i < count; ++i) {
    const int parent = arranged_[joint_at_[i]];
    parents_[i] = parent < 0 ? -1 : static_cast<int>(place_of_[At(parent)]);
  }
  for (std::size_t first = 0, end; first < count; first = end) {
    for (end = first + 1; end < count && limb(joint_at_[end]) == limb(joint_at_[first]);) ++end;
    std::fill(limbs_.begin() + static_cast<std::ptrdiff_t>(first),
              limbs_.begin() + static_cast<std::ptrdiff_t>(end), Places{first, end});
  }
}

MultibodyInertia::Link& MultibodyInertia::ParentOf(std::size_t place) {
  return parents_[place] < 0 ? base_ : links_[At(parents_[place])];
}

void MultibodyInertia::ComputeMotions(const btMultiBody& multibody) {
  links_.resize(joint_count());
  base_.R_WL = btMatrix3x3(multibody.getWorldToBaseRot().inverse());
  base_.p.setZero();
  for (std::size_t i = 0; i < joint_count(); ++i) {
    const int joint = static_cast<int>(joint_at_[i]);
    Link& link = links_[i];
    const Link& parent = ParentOf(i);
    link.R_WL = parent.R_WL * btMatrix3x3(multibody.getParentToLocalRot(joint)).transpose();
    link.p = parent.p + link.R_WL * multibody.getRVector(joint);
    link.turn = link.R_WL * multibody.getLink(joint).getAxisTop(0);
    link.shift = link.R_WL * multibody.getLink(joint).getAxisBottom(0) + link.p.cross(link.turn);
  }
}

void MultibodyInertia::ComputeInertias(const btMultiBody& multibody) {
  const auto set = [](Link& link, btScalar mass, const btVector3& inertia) {
    link.mass = mass;
    link.mass_times_distance = link.p * mass;
    link.turning_inertia =
        link.R_WL * Diagonal(inertia) * link.R_WL.transpose() + TurningInertia(link.p) * mass;
  };
  const std::size_t count = joint_count();
  set(base_, multibody.getBaseMass(), multibody.getBaseInertia());
  for (std::size_t i = 0; i < count; ++i) {
    const int joint = static_cast<int>(joint_at_[i]);
    set(links_[i], multibody.getLinkMass(joint), multibody.getLinkInertia(joint));
  }
  by_joints_.resize(count);
  joints_.assign(count * count, 0);
  for (std::size_t i = count; i-- > 0;) {
    const Link& link = links_[i];
    const btVector3 spin =
        link.turning_inertia * link.turn + link.mass_times_distance.cross(link.shift);
    const btVector3 push = link.shift * link.mass + link.turn.cross(link.mass_times_distance);
    by_joints_[i] = {spin.x(), spin.y(), spin.z(), push.x(), push.y(), push.z()};
    for (int j = static_cast<int>(i); j >= 0; j = parents_[At(j)])
      joints_[i * count + At(j)] = links_[At(j)].turn.dot(spin) + links_[At(j)].shift.dot(push);
    Link& parent = ParentOf(i);
    parent.mass += link.mass;
    parent.mass_times_distance += link.mass_times_distance;
    parent.turning_inertia += link.turning_inertia;
  }
}

void MultibodyInertia::Factorise(bool fixed_base) {
  const std::size_t count = joint_count();
  joints_response_.resize(count * count);
  scratch_.resize(std::max<std::size_t>(count, 6));
  Invert(joints_.data(), parents_.data(), count, joints_response_.data(), scratch_.data());
  carried_.assign(count, Six{});
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = limbs_[i].first; j < limbs_[i].end; ++j)
      for (std::size_t k = 0; k < 6; ++k)
        carried_[i][k] += joints_response_[i * count + j] * by_joints_[j][k];
  base_response_.fill(0);
  if (fixed_base) return;

  const btVector3& h = base_.mass_times_distance;
  const btMatrix3x3& turning = base_.turning_inertia;
  const btScalar m = base_.mass;
  // clang-format off
  std::array<btScalar, 36> base{
      turning[0][0], turning[0][1], turning[0][2], 0, -h.z(), h.y(),
      turning[1][0], turning[1][1], turning[1][2], h.z(), 0, -h.x(),
      turning[2][0], turning[2][1], turning[2][2], -h.y(), h.x(), 0,
      0, h.z(), -h.y(), m, 0, 0,
      -h.z(), 0, h.x(), 0, m, 0,
      h.y(), -h.x(), 0, 0, 0, m};
  // clang-format on
  for (std::size_t place = 0; place < count; ++place)
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j)
        base[i * 6 + j] -= by_joints_[place][i] * carried_[place][j];
  constexpr std::array<int, 6> kChain{-1, 0, 1, 2, 3, 4};
  Invert(base.data(), kChain.data(), 6, base_response_.data(), scratch_.data());
}

MultibodyInertia::Places MultibodyInertia::LimbsOf(const btScalar* impulse) const {
  Places places;
  for (std::size_t i = 0; i < joint_count(); i = limbs_[i].end) {
    std::size_t acts = i;
    while (acts < limbs_[i].end && impulse[joint(acts)] == 0) ++acts;
    if (acts == limbs_[i].end) continue;
    if (places.end == 0) places.first = i;
    places.end = limbs_[i].end;
  }
  return places;
}

btScalar MultibodyInertia::JointResponse(std::size_t place, const btScalar* impulse) const {
  btScalar sum = 0;
  for (std::size_t i = limbs_[place].first; i < limbs_[place].end; ++i)
    sum += joints_response_[place * joint_count() + i] * impulse[joint(i)];
  return sum;
}

Six MultibodyInertia::OnBase(const btScalar* impulse) const {
  Six sum;
  std::copy(impulse, impulse + 6, sum.begin());
  for (std::size_t place = 0; place < joint_count(); ++place) {
    const btScalar scale = impulse[joint(place)];
    if (scale == 0) continue;
    for (std::size_t k = 0; k < 6; ++k) sum[k] -= scale * carried_[place][k];
  }
  return sum;
}

void MultibodyInertia::ToSpeeds(const Six& base, const btScalar* u, btScalar* speeds) const {
  ToSpeeds(base, u, {0, joint_count()}, speeds);
}

void MultibodyInertia::ToSpeeds(const Six& base, const btScalar* u, Places places,
                                btScalar* speeds) const {
  std::copy(base.begin(), base.end(), speeds);
  for (std::size_t i = places.first; i < places.end; ++i) {
    btScalar speed = u[i];
    for (std::size_t k = 0; k < 6; ++k) speed -= carried_[i][k] * base[k];
    speeds[joint(i)] = speed;
  }
}

void MultibodyInertia::Respond(const btScalar* impulse, btScalar* change) {
  scratch_.assign(scratch_.size(), 0);
  Respond(impulse, LimbsOf(impulse), {0, joint_count()}, change);
}

void MultibodyInertia::RespondWhereItActs(const btScalar* impulse, btScalar* change) {
  std::fill(change, change + 6 + joint_count(), btScalar(0));
  const Places limbs = LimbsOf(impulse);
  const bool acts = limbs.end > 0 || std::any_of(impulse, impulse + 6,
                                                 [](btScalar element) { return element != 0; });
  if (acts) Respond(impulse, limbs, limbs, change);
}

void MultibodyInertia::Respond(const btScalar* impulse, Places limbs, Places wanted,
                               btScalar* change) {
  for (std::size_t i = limbs.first; i < limbs.end; ++i) scratch_[i] = JointResponse(i, impulse);
  const Six on_base = OnBase(impulse);
  Six base{};
  for (std::size_t j = 0; j < 6; ++j)  // symmetric: columns are rows
    for (std::size_t i = 0; i < 6; ++i) base[i] += base_response_[j * 6 + i] * on_base[j];
  ToSpeeds(base, scratch_.data(), wanted, change);
}

namespace {

thread_local MultibodyInertias* in_use = nullptr;

}  // namespace

MultibodyInertia& MultibodyInertias::Of(const btMultiBody& multibody) {
  for (std::size_t i = 0; i < used_; ++i)
    if (entries_[i].multibody == &multibody) return entries_[i].inertia;
  if (used_ == entries_.size()) entries_.emplace_back();
  Entry& entry = entries_[used_++];
  entry.multibody = &multibody;
  entry.inertia.Compute(multibody);
  return entry.inertia;
}

MultibodyInertias::Use::Use(MultibodyInertias& inertias) : before_(in_use) { in_use = &inertias; }

MultibodyInertias::Use::~Use() { in_use = before_; }

namespace {

void BulletsOwn(const btMultiBody& multibody, const btScalar* impulse, btScalar* change,
                btAlignedObjectArray<btScalar>& scalars, btAlignedObjectArray<btVector3>& vectors) {
  using Method = void (*)(const btMultiBody*, const btScalar*, btScalar*,
                          btAlignedObjectArray<btScalar>&, btAlignedObjectArray<btVector3>&);
  static const auto method = reinterpret_cast<Method>(
      dlsym(RTLD_NEXT,
            "_ZNK11btMultiBody30calcAccelerationDeltasMultiDofEPKdPdR20btAlignedObjectArrayIdERS3_"
            "I9btVector3E"));
  if (!method)
    std::abort();  // Bullet is linked as a shared library (physics/bullet/core/parts.cc checks its
                   // version)
  method(&multibody, impulse, change, scalars, vectors);
}

}  // namespace
}  // namespace prehend::physics

/// Takes precedence over Bullet's method of that name, which computes the same in O(n) for each
/// row. Outside of MultibodyInertias::Use (stock Bullet), it calls Bullet's.
void btMultiBody::calcAccelerationDeltasMultiDof(const btScalar* force, btScalar* output,
                                                 btAlignedObjectArray<btScalar>& scratch_r,
                                                 btAlignedObjectArray<btVector3>& scratch_v) const {
  if (prehend::physics::in_use)
    prehend::physics::in_use->Of(*this).RespondWhereItActs(force, output);
  else
    prehend::physics::BulletsOwn(*this, force, output, scratch_r, scratch_v);
}
