// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/sense/sensor_noise.h"

#include <algorithm>
#include <numbers>

namespace prehend::episode {
namespace {

constexpr std::uint64_t kFrames = ~std::uint64_t{0};  // the channel of losses of whole frames
constexpr double kRadiansPerDegree = std::numbers::pi / 180;

Eigen::Vector3d NormalVector(physics::Random& random, double deviation) {
  Eigen::Vector3d vector;
  for (double& component : vector) component = random.Normal(0, deviation);
  return vector;
}

}  // namespace

SensorNoise::SensorNoise(const scenario::SensorSettings& settings, std::vector<bool> measured)
    : settings_(settings), measured_(std::move(measured)) {}

physics::Random SensorNoise::At(grammar::Tick tick, std::uint64_t channel) const {
  const std::uint64_t of_tick =
      physics::Random(settings_.seed).Next() ^ static_cast<std::uint64_t>(tick);
  return physics::Random(physics::Random(of_tick).Next() ^ channel);
}

bool SensorNoise::Loses(grammar::Tick tick) const {
  return At(tick, kFrames).Share() < settings_.lost_frames_share;
}

SensorNoise::Offset SensorNoise::OffsetOf(grammar::Tick tick, int entity) const {
  Offset offset;
  if (!measured_[static_cast<std::size_t>(entity)]) return offset;
  physics::Random random = At(tick, static_cast<std::uint64_t>(entity));
  offset.p_m = NormalVector(random, settings_.position_noise_m);
  const Eigen::Vector3d turn =
      NormalVector(random, settings_.rotation_noise_deg * kRadiansPerDegree);
  if (turn.norm() > 0) offset.q = Eigen::AngleAxisd(turn.norm(), turn.normalized());
  return offset;
}

void SensorNoise::ShowPoses(const grammar::Frame& truth) {
  entities_.assign(truth.entities.begin(), truth.entities.end());
  hands_.assign(truth.hands.begin(), truth.hands.end());
  collision_spheres_.resize(hands_.size());
  for (std::size_t h = 0; h < hands_.size(); ++h) {
    grammar::HandSample& hand = hands_[h];
    const Offset offset = OffsetOf(truth.tick, hand.entity);
    const Eigen::Vector3d& palm_m = truth.entities[static_cast<std::size_t>(hand.entity)].p_WB_m;
    // The hand is measured as a whole: all of it is off as its palm is.
    auto& spheres = collision_spheres_[h];
    spheres.assign(hand.collision_spheres.begin(), hand.collision_spheres.end());
    for (grammar::CollisionSphere& sphere : spheres)
      sphere.p_W_m = palm_m + offset.p_m + offset.q * (sphere.p_W_m - palm_m);
    hand.collision_spheres = spheres;
    hand.ahead_W = offset.q * hand.ahead_W;
  }
  entity_changes_.clear();
  for (std::size_t i = 0; i < entities_.size(); ++i) {
    grammar::EntitySample& look = entities_[i];
    if (measured_[i]) {
      const Offset offset = OffsetOf(truth.tick, static_cast<int>(i));
      look.p_WB_m += offset.p_m;
      look.q_WB = offset.q * look.q_WB;
      look.asleep = false;
    }
    entity_changes_.push_back({static_cast<int>(i), look});
  }
}

void SensorNoise::ShowTouches(const grammar::Frame& truth) {
  std::swap(touches_, before_);
  touches_.clear();
  for (const grammar::Touch& touch : truth.touches) {
    const auto channel = (static_cast<std::uint64_t>(touch.a) << 32 | 1u << 31) +
                         static_cast<std::uint64_t>(touch.b);
    if (At(truth.tick, channel).Share() >= settings_.contact_dropout_share)
      touches_.push_back(touch);
  }
  contact_ends_.clear();
  for (const grammar::Touch& touch : before_) {
    if (!std::ranges::binary_search(touches_, PairOf(touch), {}, PairOf))
      contact_ends_.push_back({touch.a, touch.b});
  }
}

grammar::FrameChanges SensorNoise::Show(const grammar::Frame& truth) {
  tick_ = truth.tick;
  ShowPoses(truth);
  ShowTouches(truth);
  return {tick_, entity_changes_, hands_, touches_, contact_ends_};
}

}  // namespace prehend::episode
