// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "physics/hand/hand_clearance.h"
#include "physics/scene/geometry.h"
#include "physics/scene/joint.h"
#include "physics/scene/run_limits.h"
#include "physics/step_watch.h"

namespace prehend::physics {
namespace {

/// An overlap is noted that is deeper than this, or than half of the thinner one,
constexpr double kDeep_m = 0.002;
/// or than this with a hand, whose grip squeezes,
constexpr double kDeepInHand_m = 0.004;
/// or than this where masses differ so much that it will get deeper,
constexpr double kDeepOfUnequal_m = 0.0005;
/// for so long: an impact is over sooner.
constexpr double kLasting_s = 0.05;
/// The highest rate that a scenario may ask for.
constexpr double kMaxRate_hz = 4800;

double HalfThickness(const Body& body) {
  double least_m = HUGE_VAL;
  for (const PlacedShape& part : body.shapes)
    least_m = std::min(least_m, WorldBounds(part.shape, {}).sizes().minCoeff() / 2);
  return least_m;
}

/// "0.8 mm".
std::string Tenths(double length_m) {
  const long tenths = std::lround(1e4 * length_m);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " mm";
}

ContactSide Whole(const ContactSide& side) {
  return side.hand == kNone ? side : ContactSide{.hand = side.hand};
}

bool IsGrains(const Scene& scene, const ContactSide& side) {
  return side.hand == kNone && scene.body(side.body).grains.has_value();
}

/// Heavier ones sink into lighter ones, what cannot yield into what can.
double WeightOf(const Scene& scene, const ContactSide& side) {
  if (side.hand != kNone) return HUGE_VAL;
  const Body& body = scene.body(side.body);
  return body.fixed ? 0 : body.kinematic ? HUGE_VAL : body.mass_kg;
}

}  // namespace

LimitWatch::LimitWatch(const Scene& scene) : scene_(scene), thinnest_m_(HUGE_VAL) {
  for (const Body& body : scene.bodies) {
    half_m_.push_back(HalfThickness(body));
    before_.push_back(body.X_WB);
    if (body.abstract == Abstract::kNot) thinnest_m_ = std::min(thinnest_m_, half_m_.back());
  }
}

void LimitWatch::See(const Snapshot& now) {
  SeeOverlaps(now);
  SeeWays(now);
}

bool LimitWatch::MayCollide(BodyIndex a, BodyIndex b) const {
  const Body &one = scene_.body(a), &other = scene_.body(b);
  const auto is_solid = [](const Body& body) {
    return body.abstract == Abstract::kNot && !body.grains;
  };
  const bool one_moves = !one.fixed && !one.kinematic,
             other_moves = !other.fixed && !other.kinematic;
  return a != b && (one_moves || other_moves) && is_solid(one) && is_solid(other) &&
         !NeverTouch(scene_, a, b);
}

void LimitWatch::SeeWays(const Snapshot& now) {
  for (std::size_t i = 0; i < before_.size(); ++i) {
    if (!now.MayHaveMoved(i, now.tick - 1)) continue;
    const double way_m = (now.bodies[i].X_WB.p_m - before_[i].p_m).norm();
    // What a script lets jump goes through nothing.
    const bool jumps = scene_.bodies[i].kinematic && now.bodies[i].v_WB_m_per_s.isZero();
    if (way_m > half_m_[i] + thinnest_m_ && !jumps) SeeWay(BodyIndex(i), now);
  }
  const auto entered = entered_;
  for (const auto& [pair, from_m] : entered) SeeWay(pair.first, pair.second, now);
  for (std::size_t i = 0; i < before_.size(); ++i)
    if (now.MayHaveMoved(i, now.tick - 1)) before_[i] = now.bodies[i].X_WB;
}

void LimitWatch::SeeWay(BodyIndex body, const Snapshot& now) {
  for (std::size_t j = 0; j < before_.size(); ++j) {
    const BodyIndex other(j);
    const Eigen::Vector3d way_m = now.body(body).X_WB.p_m - At(before_, body).p_m -
                                  (now.body(other).X_WB.p_m - At(before_, other).p_m);
    if (way_m.norm() <= At(half_m_, body) + half_m_[j] || !MayCollide(body, other)) continue;
    SeeWay(body, other, now);
    SeeWay(other, body, now);
  }
}

void LimitWatch::SeeWay(BodyIndex body, BodyIndex other, const Snapshot& now) {
  const Eigen::Vector3d p_BC_m = BoundingBox(scene_.body(body)).p_BC_m;
  const Body& thing = scene_.body(other);
  const BodyPair pair{body, other};
  const auto known = entered_.find(pair);
  const Eigen::Vector3d from_m = known != entered_.end()
                                     ? known->second
                                     : At(before_, other).inverse() * (At(before_, body) * p_BC_m);
  const Eigen::Vector3d to_m = now.body(other).X_WB.inverse() * (now.body(body).X_WB * p_BC_m);
  if (DistanceTo(thing, to_m) < 0) {
    if (DistanceTo(thing, from_m) >= 0) entered_.try_emplace(pair, from_m);
    return;
  }
  if (known != entered_.end()) entered_.erase(known);
  const Eigen::Vector3d way_m = to_m - from_m;
  const double step_m = At(half_m_, other) / 2, length_m = way_m.norm();
  for (double at_m = 0; at_m < length_m;) {
    const double away_m = DistanceTo(thing, from_m + way_m * (at_m / length_m));
    if (away_m <= -step_m) {
      through_.try_emplace(pair, Through{now.tick, length_m});
      return;
    }
    at_m += std::max(away_m, step_m);
  }
}

void LimitWatch::SeeOverlaps(const Snapshot& now) {
  for (const ContactPoint& contact : now.contacts) {
    const ContactSide a = Whole(contact.a), b = Whole(contact.b);
    const double thin_m = a.hand != kNone || b.hand != kNone
                              ? HUGE_VAL
                              : std::min(At(half_m_, a.body), At(half_m_, b.body));
    const bool are_bodies = a.hand == kNone && b.hand == kNone;
    if (are_bodies && !MayCollide(a.body, b.body)) continue;
    // The centre of a thin body may go slowly through another one, too.
    if (are_bodies && -contact.distance_m > thin_m / 2) {
      SeeEntry(a.body, b.body);
      SeeEntry(b.body, a.body);
    }
    if (contact.distance_m > -kDeepOfUnequal_m || IsGrains(scene_, a) || IsGrains(scene_, b))
      continue;
    const double mass_ratio = are_bodies ? MassRatioAt(scene_, now, contact) : 1;
    const double deep_m = !are_bodies                  ? kDeepInHand_m
                          : mass_ratio > kMaxMassRatio ? kDeepOfUnequal_m
                                                       : std::min(kDeep_m, thin_m);
    if (contact.distance_m > -deep_m) continue;
    const bool swap = WeightOf(scene_, a) < WeightOf(scene_, b);
    Overlap& overlap = overlaps_[swap ? SidePair{b, a} : SidePair{a, b}];
    if (overlap.last_tick + 1 < now.tick) overlap.begin_tick = now.tick;
    overlap.last_tick = now.tick;
    overlap.deepest_m = std::max(overlap.deepest_m, -contact.distance_m);
    const double lasted_s =
        static_cast<double>(now.tick - overlap.begin_tick) / scene_.world.rate_hz;
    if (overlap.noted_tick >= 0 || lasted_s < kLasting_s) continue;
    overlap.noted_tick = now.tick;
    overlap.mass_ratio = mass_ratio;
  }
}

void LimitWatch::SeeEntry(BodyIndex body, BodyIndex other) {
  const Eigen::Vector3d p_BC_m = BoundingBox(scene_.body(body)).p_BC_m;
  const Eigen::Vector3d from_m = At(before_, other).inverse() * (At(before_, body) * p_BC_m);
  if (DistanceTo(scene_.body(other), from_m) >= 0) entered_.try_emplace({body, other}, from_m);
}

std::vector<ScriptNote> LimitWatch::Notes() const {
  std::vector<ScriptNote> notes;
  const auto add = [&](std::int64_t tick, const std::string& text) {
    notes.push_back({tick, kNone, std::string(kLimitNote) + text});
  };
  for (const auto& [pair, through] : through_) {
    const std::string &name = scene_.body(pair.first).name, &other = scene_.body(pair.second).name;
    const double half_m = At(half_m_, pair.first) + At(half_m_, pair.second);
    const double rate_hz = 100 * std::ceil(scene_.world.rate_hz * through.way_m / half_m / 100);
    add(through.tick,
        name + std::string(kGoesThrough) + other + ": it moves " + Tenths(through.way_m) +
            " in a tick, and " + other + " is " + Tenths(2 * At(half_m_, pair.second)) +
            " thick; " +
            (rate_hz > kMaxRate_hz
                 ? "let it move more slowly"
                 : "write 'world: {rate_hz: " + std::to_string(std::lround(rate_hz)) + "}'") +
            ", or make it thicker");
  }
  for (const auto& [pair, overlap] : overlaps_) {
    if (overlap.noted_tick < 0) continue;
    const std::string ratio = std::to_string(std::lround(overlap.mass_ratio));
    add(overlap.noted_tick,
        NameOf(scene_, pair.first) + std::string(kSinksInto) + NameOf(scene_, pair.second) + ": " +
            Tenths(overlap.deepest_m) + " deep" +
            (overlap.mass_ratio > kMaxMassRatio
                 ? ", where masses are " + ratio +
                       " to 1; make them more alike, or raise 'world: {rate_hz: ..}'"
                 : "; let it press less, or raise 'world: {rate_hz: ..}'"));
  }
  std::ranges::stable_sort(notes, {}, &ScriptNote::tick);
  return notes;
}

}  // namespace prehend::physics
