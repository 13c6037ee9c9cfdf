// SPDX-License-Identifier: Apache-2.0
// Samples are stored where they change; binary search finds the one that holds at a frame.
#include "grammar/state/history.h"

#include <algorithm>
#include <cmath>

#include "grammar/base/frame.h"

namespace prehend::grammar {
namespace {

constexpr double kRounding = 1e-6;  // of a product of seconds and ticks per second; of metres
constexpr double kMaxTracedTicks = 1e15;
constexpr double kFar_m = 1e3;

}  // namespace

History::History(const EntityTable& entity_table)
    : ticks_per_second_(static_cast<double>(entity_table.ticks_per_second)),
      looks_(entity_table.entities.size()),
      hand_of_entity_(entity_table.entities.size(), -1) {}

void History::MeasureWays(const EntityTable& entity_table) {
  ways_m_.resize(entity_table.entities.size());
  bounds_m_.reserve(entity_table.entities.size());
  for (const EntityInfo& entity : entity_table.entities) bounds_m_.push_back(BoundOf_m(entity));
}

void History::BeginFrame(Tick tick) {
  ticks_.PushBack() = tick;
  ++count_;
}

bool History::SetSample(int entity, const EntitySample& look, FrameNumber first) {
  RingBuffer<PoseAtFrame>& samples = looks_[entity].samples;
  ForgetSamples(samples, first);
  if (samples.empty() && now() > 0) samples.PushBack() = {};  // what it was before anybody said
  const double before_m = ways_m_.empty() ? -1 : ways_m_[entity].way_m;
  if (!ways_m_.empty() && samples.empty()) {
    ways_m_[entity].way_m += kFar_m;
    ways_m_[entity].place = look;
  } else if (!ways_m_.empty()) {
    Move(entity, look);
  }
  PoseAtFrame& sample = samples.PushBack();
  sample.frame = now();
  sample.look = look;
  if (!IsTracked(look)) looks_[entity].was_lost = true;
  looks_[entity].GiveBack();
  return ways_m_.empty() || ways_m_[entity].way_m != before_m;
}

void History::Move(int entity, const EntitySample& to) {
  Way& way = ways_m_[entity];
  const double away_m = StepOf(entity, way.place, to);
  if (!way.moved && away_m > 0) {
    way.moved = true;
    way.way_m += 2 * kTremble_m;  // of which nobody knew so far
  }
  if (away_m <= kTremble_m) return;
  way.way_m += away_m;
  way.place = to;
}

// A hand carries its surface along; how far it gets beyond that is its way, too.
void History::MoveSurface(int hand, const std::vector<CollisionSphere>& to) {
  const EntitySample& look = Look(hand, now());
  std::vector<CollisionSphere>& surface_B = ways_m_[hand].surface_B;
  double away_m = to.size() == surface_B.size() ? 0 : kFar_m;
  surface_B.resize(to.size());
  for (std::size_t i = 0; i < to.size(); ++i) {
    CollisionSphere sphere = to[i];
    sphere.p_W_m = look.q_WB.conjugate() * (to[i].p_W_m - look.p_WB_m);
    const double step_m = (sphere.p_W_m - surface_B[i].p_W_m).norm() +
                          std::abs(sphere.radius_m - surface_B[i].radius_m);
    if (step_m <= kRounding) continue;
    away_m = std::max(away_m, sphere.p_W_m.norm() <= kArm_m ? step_m : kFar_m);
    surface_B[i] = sphere;
  }
  ways_m_[hand].way_m += away_m;
}

// A bound for all of its points: what turns by an angle moves them by at most four times the sine
// of a quarter of it, which is half the distance of the quaternions, times their distance from the
// origin.
double History::StepOf(int entity, const EntitySample& from, const EntitySample& to) const {
  const auto& before = from.q_WB.coeffs();
  const auto& after = to.q_WB.coeffs();
  const double turned = std::min((after - before).norm(), (after + before).norm());
  const double step_m =
      (to.p_WB_m - from.p_WB_m).norm() + 2 * turned * std::max(bounds_m_[entity], kArm_m);
  return std::isnan(step_m) ? kFar_m : step_m;
}

void History::SetHand(const HandSample& look, std::uint64_t crossed_thresholds, FrameNumber first) {
  int& index = hand_of_entity_[look.entity];
  if (index < 0) {
    index = static_cast<int>(hands_.size());
    hands_.emplace_back();
  }
  RingBuffer<HandAtFrame>& samples = hands_[index].samples;
  ForgetSamples(samples, first);
  HandAtFrame& sample = samples.PushBack();
  sample.frame = now();
  sample.look = look;
  sample.collision_spheres.assign(look.collision_spheres.begin(), look.collision_spheres.end());
  sample.look.collision_spheres = {};
  sample.crossed_thresholds = crossed_thresholds;
  if (!ways_m_.empty()) MoveSurface(look.entity, sample.collision_spheres);
  hands_[index].GiveBack();
}

void History::Forget(FrameNumber ticks, FrameNumber looks) {
  while (ticks_.size() > 2 && first() < ticks) ticks_.PopFront();
  first_look_ = std::max(first_look_, looks);
}

// Frames mostly come at even steps. Then it is where it would be if all steps were even, or beside.
FrameNumber History::FirstNotBefore(Tick tick) const {
  if (ticks_.empty() || tick <= ticks_.front()) return first();
  if (tick > ticks_.back()) return count_;
  std::size_t low = 0;
  std::size_t high = ticks_.size() - 1;  // the tick is after that of low and not after that of high
  const auto narrow = [&](std::size_t i) {
    if (i > low && i < high) (ticks_[i] < tick ? low : high) = i;
  };
  const double share = static_cast<double>(tick - ticks_.front()) /
                       static_cast<double>(ticks_.back() - ticks_.front());
  const auto guess = static_cast<std::size_t>(share * static_cast<double>(high) + 0.5);
  narrow(guess);
  narrow(low == guess ? guess + 1 : guess - 1);
  while (high - low > 1) narrow(low + (high - low) / 2);
  return first() + static_cast<FrameNumber>(high);
}

FrameNumber History::LastNotAfter(Tick tick) const {
  const FrameNumber next = FirstNotBefore(tick);
  const bool here = next <= now() && At(next).tick == tick;
  return here ? next : std::max(first(), next - 1);
}

Tick History::AtMostTicks(double seconds) const {
  return static_cast<Tick>(
      std::floor(std::min(seconds * ticks_per_second_, kMaxTracedTicks) + kRounding));
}

Tick History::AtLeastTicks(double seconds) const {
  return static_cast<Tick>(
      std::ceil(std::min(seconds * ticks_per_second_, kMaxTracedTicks) - kRounding));
}

}  // namespace prehend::grammar
