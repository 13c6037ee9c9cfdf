// SPDX-License-Identifier: Apache-2.0
#include "harness/sensing.h"

#include <algorithm>

namespace prehend::harness {

namespace {

constexpr int kFeelersPerLink = 3;
constexpr int kPalmFeelersPerSide = 3;

// A point counts for "what holds the object" only if it carries a share of the pair's load;
// otherwise an idle corner point with a skewed normal would decide. Larger: support of rocking
// objects is lost. Smaller: side contact with one stray point becomes support.
constexpr double kLoadBearingShare = 0.05;

/// Balls inscribed in the palm's box, in the hand's frame.
std::vector<grammar::Feeler> PalmFeelers(const physics::HandModel& model) {
  const double radius = model.palm_size_m.z() / 2;
  const Eigen::Vector2d reach = model.palm_size_m.head<2>() / 2 - Eigen::Vector2d::Constant(radius);
  std::vector<grammar::Feeler> feelers;
  for (int i = 0; i < kPalmFeelersPerSide; ++i) {
    for (int j = 0; j < kPalmFeelersPerSide; ++j) {
      const double u = 2.0 * i / (kPalmFeelersPerSide - 1) - 1,
                   v = 2.0 * j / (kPalmFeelersPerSide - 1) - 1;
      feelers.push_back({{u * reach.x(), v * reach.y(), 0}, radius});
    }
  }
  return feelers;
}

/// Balls inscribed in every link's box, in that link's frame (x along the link).
std::vector<grammar::Feeler> LinkFeelers(const physics::HandModel& model) {
  std::vector<grammar::Feeler> feelers;
  for (const physics::HandLink& link : model.links) {
    const double radius = std::min({link.half_thickness_m, link.half_width_m, link.length_m / 2});
    const double reach = link.length_m / 2 - radius;
    for (int i = 0; i < kFeelersPerLink; ++i)
      feelers.push_back({{(2.0 * i / (kFeelersPerLink - 1) - 1) * reach, 0, 0}, radius});
  }
  return feelers;
}

/// For each style of the hand its index in `names`, which has them all.
std::vector<int> StyleIndices(const physics::HandModel& model,
                              const std::vector<std::string>& names) {
  std::vector<int> indices;
  for (const physics::GraspStyle& style : model.styles)
    indices.push_back(static_cast<int>(std::ranges::find(names, style.name) - names.begin()));
  return indices;
}

grammar::EntityLook LookAt(const physics::BodyState& body) {
  return {.p_WB_m = body.X_WB.p_m,
          .q_WB = body.X_WB.q,
          .v_WB_m_per_s = body.v_WB_m_per_s,
          .w_WB_rad_per_s = body.w_WB_rad_per_s,
          .asleep = body.asleep};
}

}  // namespace

std::vector<std::string> StyleNames(const physics::Scene& scene) {
  std::vector<std::string> names;
  for (const physics::Hand& hand : scene.hands) {
    for (const physics::GraspStyle& style : hand.model.styles) {
      if (std::ranges::find(names, style.name) == names.end()) names.push_back(style.name);
    }
  }
  return names;
}

Sensing::Sensing(const physics::Scene& scene, int sensing_hz)
    : rate_hz_(scene.world.rate_hz),
      sensing_hz_(sensing_hz),
      body_count_(static_cast<int>(scene.bodies.size())) {
  const std::vector<std::string> styles = StyleNames(scene);
  for (const physics::Hand& hand : scene.hands) {
    geometry_.push_back({hand.model, PalmFeelers(hand.model), LinkFeelers(hand.model),
                         StyleIndices(hand.model, styles)});
    feelers_.emplace_back(geometry_.back().palm.size() + geometry_.back().links.size());
  }
  for (const physics::Person& person : scene.persons) heads_.push_back(person.head);
  for (const physics::Joint& joint : scene.joints) jointed_.push_back(joint.body);
  entities_.resize(scene.bodies.size() + scene.hands.size());
  hands_.resize(scene.hands.size());
}

grammar::Frame Sensing::Sense(const physics::Snapshot& snapshot) {
  for (std::size_t i = 0; i < snapshot.bodies.size(); ++i)
    entities_[i] = LookAt(snapshot.bodies[i]);
  for (std::size_t i = 0; i < snapshot.joints.size(); ++i) {
    grammar::EntityLook& look = entities_[static_cast<std::size_t>(jointed_[i])];
    look.joint_position = snapshot.joints[i].position;
    look.joint_fraction = snapshot.joints[i].fraction;
  }
  for (std::size_t i = 0; i < snapshot.gazes.size(); ++i) {
    const physics::GazeState& gaze = snapshot.gazes[i];
    entities_[static_cast<std::size_t>(heads_[i])].gazes_at =
        gaze.hand >= 0 ? body_count_ + gaze.hand : gaze.body >= 0 ? gaze.body : grammar::kNobody;
  }
  SenseHands(snapshot);
  SenseTouches(snapshot);
  return {snapshot.tick, entities_, hands_, touches_};
}

void Sensing::SenseHands(const physics::Snapshot& snapshot) {
  for (std::size_t h = 0; h < snapshot.hands.size(); ++h) {
    const physics::HandState& hand = snapshot.hands[h];
    const HandGeometry& geometry = geometry_[h];
    std::vector<grammar::Feeler>& feelers = feelers_[h];
    std::size_t next = 0;
    for (const grammar::Feeler& feeler : geometry.palm)
      feelers[next++] = {hand.palm.X_WB * feeler.p_W_m, feeler.radius_m};
    for (std::size_t i = 0; i < geometry.links.size(); ++i) {
      const grammar::Feeler& feeler = geometry.links[i];
      feelers[next++] = {hand.X_WL[i / kFeelersPerLink] * feeler.p_W_m, feeler.radius_m};
    }
    const int entity = body_count_ + static_cast<int>(h);
    entities_[entity] = LookAt(hand.palm);
    const auto style = static_cast<std::size_t>(hand.style);
    const int named = style < geometry.styles.size() ? geometry.styles[style] : grammar::kNobody;
    hands_[h] = {entity, hand.trigger, named, hand.palm.X_WB.q * geometry.model.ahead,
                 feelers};
  }
}

void Sensing::SenseTouches(const physics::Snapshot& snapshot) {
  points_.clear();
  for (const physics::ContactPoint& contact : snapshot.contacts) {
    const int a = EntityOf(contact.a), b = EntityOf(contact.b);
    if (a == b) continue;
    const double up = contact.nhat_BA_W.z();
    points_.push_back({std::minmax(a, b), a < b ? up : -up, contact.normal_impulse_n_s,
                       SensorSetOf(contact.a) | SensorSetOf(contact.b)});
  }
  std::ranges::stable_sort(points_, {}, &PairPoint::pair);

  touches_.clear();
  for (std::size_t first = 0; first < points_.size();) {
    std::size_t last = first;
    double load = 0;
    grammar::Touch touch{.a = points_[first].pair.first, .b = points_[first].pair.second};
    for (; last < points_.size() && points_[last].pair == points_[first].pair; ++last) {
      load += points_[last].impulse_n_s;
      touch.sensor_sets |= points_[last].sensor_sets;
    }
    for (std::size_t i = first; i < last; ++i) {
      if (points_[i].impulse_n_s < kLoadBearingShare * load) continue;
      touch.up_on_a = std::max(touch.up_on_a, points_[i].up_on_a);
      touch.up_on_b = std::max(touch.up_on_b, -points_[i].up_on_a);
    }
    touch.normal_force_n = load * static_cast<double>(rate_hz_);
    touches_.push_back(touch);
    first = last;
  }
}

int Sensing::EntityOf(const physics::ContactSide& side) const {
  return side.hand >= 0 ? body_count_ + side.hand : side.body;
}

std::uint32_t Sensing::SensorSetOf(const physics::ContactSide& side) const {
  if (side.hand < 0) return 0;
  const physics::HandModel& model = geometry_[side.hand].model;
  return 1u << (side.link < 0 ? model.palm_sensor_set : model.links[side.link].sensor_set);
}

}  // namespace prehend::harness
