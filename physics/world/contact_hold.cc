// SPDX-License-Identifier: Apache-2.0
// Pairs move between the two maps when a body falls asleep or wakes. Tested by
// tests/physics/world/world_test.cc
#include "physics/world/contact_hold.h"

#include <algorithm>
#include <tuple>

namespace prehend::physics {
namespace {

/// What pressed for longer than a blow also lasts until its surfaces are so far apart.
constexpr double kApart_m = 0.0005;

const Pose& PoseOf(const ContactSide& of_hand, const Snapshot& now) {
  const HandState& hand = now.hand(of_hand.hand);
  return of_hand.link == kNone ? hand.palm.X_WB : At(hand.X_WL, of_hand.link);
}

}  // namespace

bool ComesBefore(const ContactPoint& l, const ContactPoint& r) {
  // A ball in the seam of two shapes touches both at one point, so the position alone does not
  // define an order.
  const auto key = [](const ContactPoint& point) {
    return std::tuple(point.a, point.b, point.p_W_m.x(), point.p_W_m.y(), point.p_W_m.z(),
                      point.normal_impulse_n_s, point.distance_m);
  };
  return key(l) < key(r);
}

void TouchingPairs::BeginTick(const std::vector<char>& rests) {
  if (rests != rests_) {
    rests_ = rests;
    // A body that has just fallen asleep was simulated in this tick: its last points are still to
    // come.
    rested_.resize(rests.size(), 0);
    for (std::size_t i = 0; i < rests.size(); ++i) rested_[i] &= rests[i];
    if (MovePairs(resting_, pairs_, false)) ShareResting();
  }
  for (auto& [key, pair] : pairs_) pair.seen = pair.near = false;
}

void TouchingPairs::Add(ContactPoint point) {
  if (point.normal_impulse_n_s <= 0) {
    if (point.distance_m > kApart_m) return;
    const auto known = pairs_.find(std::minmax(point.a, point.b));
    if (known != pairs_.end()) known->second.near = true;
    return;
  }
  if (point.b < point.a) {
    std::swap(point.a, point.b);
    point.nhat_BA_W = -point.nhat_BA_W;
  }
  Pair& pair = pairs_[{point.a, point.b}];
  if (!pair.seen)
    pair = {.points = {}, .pressed_ticks = pair.pressed_ticks + 1, .seen = true, .near = pair.near};
  pair.points.push_back(point);
}

void TouchingPairs::EndTick(
    const std::function<double(const ContactSide&, const ContactSide&)>& apart_m) {
  for (auto& [key, pair] : pairs_) {
    if (pair.seen) {
      std::sort(pair.points.begin(), pair.points.end(), ComesBefore);
      continue;
    }
    const bool lasts = pair.pressed_ticks > blow_ticks_ &&
                       (pair.near || (apart_m && apart_m(key.first, key.second) <= kApart_m));
    pair.quiet_ticks = lasts ? 0 : pair.quiet_ticks + 1;
    for (ContactPoint& point : pair.points) point.normal_impulse_n_s = 0;
  }
  std::erase_if(pairs_,
                [this](const auto& entry) { return entry.second.quiet_ticks > hold_ticks_; });
  if (rested_ == rests_) return;
  rested_ = rests_;
  if (MovePairs(pairs_, resting_, true)) ShareResting();
}

/// Returns whether there were any.
bool TouchingPairs::MovePairs(Pairs& from, Pairs& to, bool that_rest) {
  const std::size_t before = from.size();
  for (auto it = from.begin(); it != from.end();) {
    const auto next = std::next(it);
    if (Rest(it->first.first, it->first.second) == that_rest) to.insert(from.extract(it));
    it = next;
  }
  return from.size() != before;
}

void TouchingPairs::ShareResting() {
  auto points = std::make_shared<std::vector<ContactPoint>>();
  for (const auto& [key, pair] : resting_)
    points->insert(points->end(), pair.points.begin(), pair.points.end());
  shared_ = points->empty() ? nullptr : std::move(points);
}

void TouchingPairs::Pair::GoAlong(const Pose& X_WH_now) {
  if (!seen) {
    const Pose by = X_WH_now * X_WH.inverse();
    for (ContactPoint& point : points) {
      point.p_W_m = by * point.p_W_m;
      point.nhat_BA_W = by.q * point.nhat_BA_W;
    }
    std::sort(points.begin(), points.end(), ComesBefore);
  }
  X_WH = X_WH_now;
}

void TouchingPairs::Describe(Snapshot& snapshot) {
  snapshot.contacts.clear();
  for (auto& [key, pair] : pairs_) {
    const ContactSide& hand = key.first.hand != kNone ? key.first : key.second;
    if (hand.hand != kNone) pair.GoAlong(PoseOf(hand, snapshot));
    snapshot.contacts.insert(snapshot.contacts.end(), pair.points.begin(), pair.points.end());
  }
  snapshot.resting = shared_;
}

}  // namespace prehend::physics
