// SPDX-License-Identifier: Apache-2.0
// Worlds in which anything may happen: two hands, some objects, two places to put them, and now and
// then one of them is not tracked. Seeded, so it is always the same.
#pragma once

#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "grammar/base/frame.h"
#include "grammar/monitor.h"

namespace prehend::grammar::testing {

class RandomWorld {
 public:
  static constexpr int kHands = 2, kObjects = 5, kPlaces = 2;

  explicit RandomWorld(std::uint64_t seed)
      : random_(seed), lost_(kHands + kObjects + kPlaces), looks(kHands + kObjects + kPlaces) {
    entity_table.ticks_per_second = 1000;
    entity_table.styles = {"wrap", "pinch"};
    for (int i = 0; i < kHands; ++i) {
      entity_table.entities.push_back(
          {.name = "hand" + std::to_string(i), .classes = {"Hand", "Entity"}});
      hands.push_back({.entity = i});
      collision_spheres.push_back(std::vector<CollisionSphere>(2));
    }
    for (int i = 0; i < kObjects; ++i) {
      entity_table.entities.push_back(
          {.name = "object" + std::to_string(i), .classes = {"Movable", "Thing", "Entity"}});
      entity_table.entities.back().half_size_m.setConstant(0.03);
    }
    for (int i = 0; i < kPlaces; ++i) {
      entity_table.entities.push_back(
          {.name = "place" + std::to_string(i), .classes = {"Fixed", "Thing", "Entity"}});
    }
    calm_ = 2 + random_() % 60;
    uneven_ = random_() % 2 == 0;
  }

  /// The next frame; lives until the next call.
  Frame Next() {
    tick += uneven_ ? 1 + static_cast<Tick>(random_() % 20) : 10;
    for (std::size_t i = 0; i < looks.size() - kPlaces; ++i) {
      Move(looks[i]);
      lost_[i] = lost_[i] ? random_() % 8 != 0 : random_() % 16 == 0 && Sometimes();
    }
    shown_ = looks;
    for (std::size_t i = 0; i < looks.size(); ++i) {
      if (lost_[i]) shown_[i] = NotTracked();
    }
    for (int i = 0; i < kHands; ++i) {
      if (Sometimes()) hands[i].trigger = Choose({0, 0.2, 0.3, 1});
      if (Sometimes()) hands[i].style = static_cast<int>(random_() % 2);
      for (std::size_t k = 0; k < collision_spheres[i].size(); ++k) {
        collision_spheres[i][k] = {
            looks[i].p_WB_m + Eigen::Vector3d(0, 0.02 * static_cast<double>(k), 0), 0.01};
      }
      hands[i].collision_spheres = collision_spheres[i];
    }
    for (int a = 0; a < static_cast<int>(looks.size()); ++a) {
      for (int b = a + 1; b < static_cast<int>(looks.size()) - (a < kHands ? kPlaces : 0); ++b)
        Touching(a, b);
    }
    touches.clear();
    for (const auto& [pair, touch] : touching_) touches.push_back(touch);
    return {.tick = tick, .entities = shown_, .hands = hands, .touches = touches};
  }

 private:
  bool Sometimes() { return random_() % calm_ == 0; }
  double Choose(std::vector<double> values) { return values[random_() % values.size()]; }

  void Move(EntitySample& look) {
    if (Sometimes()) {
      look.v_WB_m_per_s = {Choose({0, 0, 0, 0.3, -0.3}), Choose({0, 0, 0.1}),
                           Choose({0, 0, 0, 0.2, -0.2})};
    }
    look.p_WB_m += 0.01 * look.v_WB_m_per_s;
    // Nobody gets far: they would not meet again.
    for (int k = 0; k < 3; ++k) look.p_WB_m[k] = std::clamp(look.p_WB_m[k], -0.3, 0.3);
    look.asleep = look.v_WB_m_per_s.isZero();
  }

  void Touching(int a, int b) {
    const auto found = touching_.find({a, b});
    if (found == touching_.end()) {
      if (random_() % 4 == 0 && Sometimes()) touching_[{a, b}] = Press(a, b);
    } else if (random_() % 2 == 0 && Sometimes()) {
      touching_.erase(found);
    } else if (Sometimes()) {
      found->second = Press(a, b);
    }
  }

  Touch Press(int a, int b) {
    const double up = Choose({-1, 0, 0.49, 0.5, 1});
    const double force_n = Choose({1, 2});
    return {.a = a,
            .b = b,
            .up_on_a = up,
            .up_on_b = -up,
            .normal_force_n = force_n,
            .vertical_speed_m_per_s = force_n > 1 ? 0.1 : 0,
            .p_W_m = {Choose({0, 0.1}), 0, 0},
            .nhat_BA_W = {0, 0, force_n > 1 ? 1.0 : 0},
            .sensor_sets = a < kHands ? static_cast<std::uint32_t>(random_() % 8) : 0};
  }

  std::mt19937_64 random_;
  std::uint64_t calm_ = 1;
  bool uneven_ = false;
  std::map<std::pair<int, int>, Touch> touching_;
  std::vector<bool> lost_;
  std::vector<EntitySample> shown_;

 public:
  EntityTable entity_table;
  Tick tick = 0;
  std::vector<EntitySample> looks;  ///< of all, tracked or not
  std::vector<HandSample> hands;
  std::vector<std::vector<CollisionSphere>> collision_spheres;
  std::vector<Touch> touches;
};

/// Rules that ask everything at all times, so that something is always awake, to stand beside those
/// of the library.
inline constexpr const char* kTimeDependentRules = R"(
use pick_and_place
event near(hand: Hand, object: Movable) while distance(hand, object) < 10 cm bridging 50 ms lasting 30 ms
event apart(object: Movable, support: Thing)
  while not contact(object, support) and speed(object) < 1 cm/s bridging 30 ms
event closing(hand: Hand, object: Movable) while closing_speed(hand, object) > 5 cm/s
event drifting(object: Movable, support: Thing) while touching(object, support) and drift_along(object, support, 200 ms) > 3 cm/s
event steady(hand: Hand, object: Movable)
  while relative_speed(hand, object, 150 ms) < 5 cm/s and median(distance(hand, object), 100 ms) < 20 cm
event alone(hand: Hand, object: Movable) while nearest(hand, object) and distance(hand, object) < 30 cm
event stays(hand: Hand, object: Movable)
  while near(hand, object) until distance(hand, object) > distance(hand, object)@begin + 1 cm bridging 20 ms
event above(object: Movable, support: Thing) while clearance(object, support) < 5 cm and clearance(object, support) > -5 cm
event gripping(hand: Hand) while trigger(hand) > 0.25 and surface_speed_ok(hand)
condition surface_speed_ok(hand: Hand) while vertical_speed(hand) < 10 cm/s
event nudged(object: Movable, other: Movable)
  from touching(object, other) begins to (contact(object, other) ends or near_any(object) begins)
  during force(object, other) < 1.5 N or near_any(object)
condition near_any(object: Movable) while near(any, object)
event away(hand: Hand, object: Movable)
  until near(hand, object) begins since in_sphere(object, position(object)@end, 20 cm) and gripping(hand) at most 2 s back
  lasting 50 ms
event carried_off(object: Movable, support: Thing)
  from contact(object, support) ends to not in_sphere(position(object), position(object)@begin, 5 cm) begins
event left(hand: Hand, object: Movable) rest of away(hand, object) outside apart_any(object), gripping(hand)
condition apart_any(object: Movable) while apart(object, any)
event tilted(object: Movable) while tilt(object) < 1 rad and not left_any(object) and rises(object)
condition left_any(object: Movable) while left(any, object)
condition rises(object: Movable) while vertical_speed(object) > 1 cm/s bridging 40 ms requires rise(object) > 5 mm
event hoisted(hand: Hand, object: Movable)
  from touching(hand, object) begins to rate(height(object), 150 ms) >= rate(height(object), 150 ms)@begin + 5 cm/s begins
  during gripping(hand)
event unhoisted(hand: Hand, object: Movable) while touching(hand, object) and not hoisted(hand, object)
event story(hand: Hand, object: Movable)
  compose first: near(hand, object), then: grasping(hand, object) where first overlaps|before|meets|contains then
)";

}  // namespace prehend::grammar::testing
