// SPDX-License-Identifier: Apache-2.0
// Grains are sorted by cell; the cells beside one are found by pointers that only move on.
#include "physics/bullet/core/grain_contacts.h"

#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace prehend::physics {
namespace {

/// A contact ends when the gap is wider than this share of the radius, as in Bullet.
constexpr btScalar kKeptGap = 0.02;
constexpr int kCellBits = 21;  ///< of a cell's place along one axis
constexpr std::uint64_t kZ = 1, kY = kZ << kCellBits, kX = kY << kCellBits;
constexpr btScalar kMiddleCell = 1 << (kCellBits - 1);

/// Cells above and below each other have neighbouring keys.
std::uint64_t KeyOf(const btVector3& p_W, btScalar cell_m) {
  std::uint64_t key = 0;
  for (const btScalar p : {p_W.x(), p_W.y(), p_W.z()}) {
    const btScalar cell = std::floor(p / cell_m) + kMiddleCell;
    // Grains are stopped at 10 m; one that is no longer finite ends the run.
    const bool inside = cell >= 1 && cell < 2 * kMiddleCell - 1;
    key = key << kCellBits | (inside ? static_cast<std::uint64_t>(cell) : 1);
  }
  return key;
}

btScalar RadiusOf(const btCollisionObject& grain) {
  return static_cast<const btSphereShape*>(grain.getCollisionShape())->getRadius();
}

}  // namespace

bool GrainContacts::Own(const btCollisionObject& a, const btCollisionObject& b) {
  return a.getUserIndex2() == kGrain && b.getUserIndex2() == kGrain &&
         a.getUserIndex() == b.getUserIndex() && a.getRollingFriction() == 0;
}

void GrainContacts::Add(btRigidBody& body) {
  if (!Own(body, body)) return;
  if (heaps_.empty() || heaps_.back().user_index != body.getUserIndex())
    heaps_.push_back({body.getUserIndex(), RadiusOf(body), {}});
  heaps_.back().grains.push_back(&body);
}

void GrainContacts::Find() {
  const bool any_awake = std::ranges::any_of(heaps_, [](const Heap& heap) {
    return std::ranges::any_of(heap.grains,
                               [](const btRigidBody* grain) { return grain->isActive(); });
  });
  if (!any_awake) return;
  contacts_.swap(before_);
  contacts_.clear();
  for (std::size_t heap = 0; heap < heaps_.size(); ++heap) FindNear(heap);
  std::ranges::sort(contacts_, {}, &GrainContact::place);
  KeepTouching();
}

void GrainContacts::FindNear(std::size_t heap) {
  const std::vector<btRigidBody*>& grains = heaps_[heap].grains;
  const btScalar cell_m = (2 + kKeptGap) * heaps_[heap].radius_m;
  cells_.clear();
  for (std::uint32_t i = 0; i < grains.size(); ++i)
    cells_.push_back({KeyOf(grains[i]->getWorldTransform().getOrigin(), cell_m), i});
  std::ranges::sort(cells_, {}, [](const Cell& cell) { return std::tuple(cell.key, cell.grain); });
  // Half of the cells around: each has the other half on its own list.
  constexpr std::array<std::uint64_t, 4> kColumns{kY, kX - kY, kX, kX + kY};
  std::array<std::size_t, 4> first{};
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const std::uint64_t key = cells_[i].key;
    for (std::size_t j = i + 1; j < cells_.size() && cells_[j].key <= key + kZ; ++j)
      AddIfNear(heap, cells_[i].grain, cells_[j].grain);
    for (std::size_t column = 0; column < kColumns.size(); ++column) {
      const std::uint64_t middle = key + kColumns[column];
      std::size_t& j = first[column];
      while (j < cells_.size() && cells_[j].key < middle - kZ) ++j;
      for (std::size_t k = j; k < cells_.size() && cells_[k].key <= middle + kZ; ++k)
        AddIfNear(heap, cells_[i].grain, cells_[k].grain);
    }
  }
}

void GrainContacts::AddIfNear(std::size_t heap, std::uint32_t i, std::uint32_t j) {
  const auto [a, b] = std::minmax(i, j);
  const Heap& of = heaps_[heap];
  const btVector3 apart =
      of.grains[a]->getWorldTransform().getOrigin() - of.grains[b]->getWorldTransform().getOrigin();
  const btScalar farthest = (2 + kKeptGap) * of.radius_m, squared = apart.length2();
  if (!(squared <= farthest * farthest)) return;
  const btScalar distance = std::sqrt(squared);
  contacts_.push_back(
      {.place = static_cast<std::uint64_t>(heap) << 48 | static_cast<std::uint64_t>(a) << 24 | b,
       .a = of.grains[a],
       .b = of.grains[b],
       .normal = distance > 0 ? apart / distance : btVector3(0, 0, 1),
       .gap_m = distance - 2 * of.radius_m,
       .impulse = 0});
}

void GrainContacts::KeepTouching() {
  std::size_t old = 0;
  std::erase_if(contacts_, [&](GrainContact& contact) {
    while (old < before_.size() && before_[old].place < contact.place) ++old;
    const bool known = old < before_.size() && before_[old].place == contact.place;
    if (known) contact.impulse = before_[old].impulse;
    return !known && contact.gap_m > 0;
  });
}

bool GrainFilter::needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const {
  if ((a->m_collisionFilterGroup & b->m_collisionFilterMask) == 0 ||
      (b->m_collisionFilterGroup & a->m_collisionFilterMask) == 0)
    return false;
  return !GrainContacts::Own(*static_cast<const btCollisionObject*>(a->m_clientObject),
                             *static_cast<const btCollisionObject*>(b->m_clientObject));
}

}  // namespace prehend::physics
