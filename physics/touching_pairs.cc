// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/world_test.cc
#include "physics/touching_pairs.h"

#include <algorithm>
#include <tuple>

namespace prehend::physics {
namespace {

/// Engines keep points that are farther apart; larger values here would report contacts before they
/// happen.
constexpr double kTouchDistance_m = 0.0005;
/// A pair that stops pushing for no longer than this still touches: 8 ms at 480 Hz.
constexpr int kHoldTicks = 4;

bool PointLess(const ContactPoint& l, const ContactPoint& r) {
  return std::tuple(l.p_W_m.x(), l.p_W_m.y(), l.p_W_m.z()) <
         std::tuple(r.p_W_m.x(), r.p_W_m.y(), r.p_W_m.z());
}

}  // namespace

void TouchingPairs::BeginTick() {
  for (auto& [key, pair] : pairs_) pair.seen = false;
}

void TouchingPairs::Add(ContactPoint point) {
  if (point.distance_m >= kTouchDistance_m || point.normal_impulse_n_s <= 0) return;
  if (point.b < point.a) {
    std::swap(point.a, point.b);
    point.nhat_BA_W = -point.nhat_BA_W;
  }
  Pair& pair = pairs_[{point.a, point.b}];
  if (!pair.seen) pair = {.points = {}, .quiet_ticks = 0, .seen = true};
  pair.points.push_back(point);
}

void TouchingPairs::EndTick() {
  for (auto& [key, pair] : pairs_) {
    if (pair.seen) {
      std::sort(pair.points.begin(), pair.points.end(), PointLess);
      continue;
    }
    ++pair.quiet_ticks;
    for (ContactPoint& point : pair.points) point.normal_impulse_n_s = 0;
  }
  std::erase_if(pairs_, [](const auto& entry) { return entry.second.quiet_ticks > kHoldTicks; });
}

void TouchingPairs::Describe(std::vector<ContactPoint>& contacts) const {
  contacts.clear();
  for (const auto& [key, pair] : pairs_)
    contacts.insert(contacts.end(), pair.points.begin(), pair.points.end());
}

}  // namespace prehend::physics
