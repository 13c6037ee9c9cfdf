// SPDX-License-Identifier: Apache-2.0
// Losses follow the two-state channel of Gilbert 1960.
#include "physics/motion/tracker.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prehend::physics {
namespace {

Eigen::Vector3d Noise(double deviation, Random& random) {
  const double x = random.Normal(0, deviation), y = random.Normal(0, deviation);
  return {x, y, random.Normal(0, deviation)};
}

Eigen::Quaterniond Turn(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle));
}

/// Number of samples that are due up to this tick; in integers, so that any rate works without
/// drift.
std::int64_t SamplesUntil(std::int64_t tick, const TrackerSettings& settings, int rate_hz) {
  return tick * settings.tracker_hz / rate_hz;
}

}  // namespace

Tracker::Tracker(const TrackerSettings& settings, int rate_hz, std::uint64_t seed,
                 const TargetState& start)
    : settings_(settings),
      rate_hz_(rate_hz),
      latency_ticks_(std::llround(settings.latency_s * rate_hz)),
      approach_ticks_((rate_hz + settings.tracker_hz - 1) / settings.tracker_hz),
      random_(seed),
      from_(start),
      to_(start),
      now_(start) {
  for (double& phase : tremor_phase_rad_) phase = random_.Between(0, 2 * std::numbers::pi);
}

TargetState Tracker::Follow(const TargetState& truth) {
  ++tick_;
  if (SamplesUntil(tick_, settings_, rate_hz_) > SamplesUntil(tick_ - 1, settings_, rate_hz_)) {
    // A lost sample is taken, too: losses must not change the noise of the other samples.
    const Sample sample = TakeSample(truth);
    if (!IsDropped()) in_transit_.push_back(sample);
  }
  while (!in_transit_.empty() && in_transit_.front().arrives_tick <= tick_) {
    StartToward(in_transit_.front());
    in_transit_.pop_front();
  }
  const std::int64_t ticks = tick_ - begun_tick_;
  if (ticks > approach_ticks_) {
    now_ = to_;
    return now_;
  }
  const double x = static_cast<double>(ticks) / static_cast<double>(approach_ticks_);
  const double duration_s = static_cast<double>(approach_ticks_) / rate_hz_;
  now_.X_WH.p_m = from_.X_WH.p_m + x * (to_.X_WH.p_m - from_.X_WH.p_m);
  now_.X_WH.q = from_.X_WH.q.slerp(x, to_.X_WH.q).normalized();
  now_.v_m_per_s = (to_.X_WH.p_m - from_.X_WH.p_m) / duration_s;
  now_.w_rad_per_s = RotationVector(to_.X_WH.q * from_.X_WH.q.conjugate()) / duration_s;
  now_.trigger = from_.trigger + x * (to_.trigger - from_.trigger);
  return now_;
}

Tracker::Sample Tracker::TakeSample(const TargetState& truth) {
  constexpr double kMPerMm = 0.001;
  const double turn_rad =
      2 * std::numbers::pi * settings_.tremor_hz * static_cast<double>(tick_) / rate_hz_;
  Sample sample{
      .arrives_tick = tick_ + latency_ticks_, .X_WH = truth.X_WH, .trigger = truth.trigger};
  for (int axis = 0; axis < 3; ++axis)
    sample.X_WH.p_m[axis] +=
        settings_.tremor_mm * kMPerMm * std::sin(turn_rad + tremor_phase_rad_[axis]);
  sample.X_WH.p_m += Noise(settings_.jitter_mm * kMPerMm, random_);
  sample.X_WH.q =
      (Turn(Noise(settings_.jitter_deg * kRadPerDeg, random_)) * truth.X_WH.q).normalized();
  return sample;
}

bool Tracker::IsDropped() {
  const double share = settings_.dropped_share;
  const double run_samples = std::max(1.0, settings_.dropped_run_s * settings_.tracker_hz);
  const double chance = random_.Share();
  if (settings_.dropped_run_s <= 0) return chance < share;
  losing_ = losing_ ? chance >= 1 / run_samples : chance < share / ((1 - share) * run_samples);
  return losing_;
}

void Tracker::StartToward(const Sample& sample) {
  from_ = now_;
  to_ = {.X_WH = sample.X_WH, .trigger = sample.trigger};
  begun_tick_ = tick_ - 1;  // this tick is the first of the motion
}

}  // namespace prehend::physics
