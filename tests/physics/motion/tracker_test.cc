// SPDX-License-Identifier: Apache-2.0
#include "physics/motion/tracker.h"

#include <gtest/gtest.h>

#include <vector>

#include "physics/motion/trajectory.h"

namespace prehend::physics {
namespace {

constexpr int kRate_hz = 480;

/// A metre along x within a second, evenly, after half a second of rest; the trigger goes along.
TargetState Truth(std::int64_t tick) {
  TargetState truth;
  const double t_s = static_cast<double>(tick) / kRate_hz;
  truth.X_WH.p_m.x() = std::clamp(t_s - 0.5, 0.0, 1.0);
  truth.trigger = truth.X_WH.p_m.x();
  return truth;
}

std::vector<TargetState> Follow(const TrackerSettings& tracking, std::uint64_t seed = 7,
                                int ticks = 960, bool rest = false) {
  Tracker tracker(tracking, kRate_hz, seed, Truth(0));
  std::vector<TargetState> followed;
  for (int tick = 1; tick <= ticks; ++tick)
    followed.push_back(tracker.Follow(Truth(rest ? 0 : tick)));
  return followed;
}

double X(const std::vector<TargetState>& followed, double t_s) {
  return followed[static_cast<std::size_t>(t_s * kRate_hz) - 1].X_WH.p_m.x();
}

TEST(TrackingTest, APerfectTrackerIsLateByOneLook) {
  const auto followed = Follow({.tracker_hz = 80});
  EXPECT_NEAR(X(followed, 1.0), 0.5 - 1.0 / 80, 0.003);
  EXPECT_NEAR(X(followed, 2.0), 1.0, 1e-12);
  EXPECT_NEAR(followed[480].v_m_per_s.x(), 1.0, 1e-9);
}

TEST(TrackingTest, ATrackerAsFastAsTheWorldLosesNothing) {
  const auto followed = Follow({.tracker_hz = kRate_hz});
  for (std::size_t i = 0; i < followed.size(); ++i)
    ASSERT_NEAR(followed[i].X_WH.p_m.x(), Truth(static_cast<std::int64_t>(i) + 1).X_WH.p_m.x(),
                1e-12)
        << i;
}

TEST(TrackingTest, LatencyDelaysPoseAndTriggerAlike) {
  const auto late = Follow({.tracker_hz = 80, .latency_s = 0.2}),
             prompt = Follow({.tracker_hz = 80});
  for (std::size_t i = 96; i < late.size(); ++i) {
    ASSERT_NEAR(late[i].X_WH.p_m.x(), prompt[i - 96].X_WH.p_m.x(), 1e-12) << i;
    ASSERT_NEAR(late[i].trigger, late[i].X_WH.p_m.x(), 1e-12) << i;
  }
}

TEST(TrackingTest, JitterHasItsDeviation) {
  const auto noisy =
      Follow({.tracker_hz = kRate_hz, .jitter_mm = 2, .jitter_deg = 1}, 7, 40000, true);
  double sum_m2 = 0, sum_rad2 = 0;
  for (const TargetState& state : noisy) {
    sum_m2 += state.X_WH.p_m.squaredNorm();
    sum_rad2 += RotationVector(state.X_WH.q).squaredNorm();
  }
  const double count = 3.0 * static_cast<double>(noisy.size());
  EXPECT_NEAR(std::sqrt(sum_m2 / count), 0.002, 0.00003);
  EXPECT_NEAR(std::sqrt(sum_rad2 / count), 0.01745, 0.0003);
}

TEST(TrackingTest, TremorHasItsAmplitudeAndFrequency) {
  const auto trembling =
      Follow({.tracker_hz = kRate_hz, .tremor_mm = 3, .tremor_hz = 8}, 7, 4800, true);
  double most = 0;
  int upward = 0;  // crossings of zero
  for (std::size_t i = 1; i < trembling.size(); ++i) {
    const double before = trembling[i - 1].X_WH.p_m.y(), now = trembling[i].X_WH.p_m.y();
    most = std::max(most, std::abs(now));
    upward += before < 0 && now >= 0;
  }
  EXPECT_NEAR(most, 0.003, 1e-5);
  EXPECT_NEAR(upward, 80, 1);
}

/// Share of looks after which the target stands still although the hand moves on, and their mean
/// number in a row.
struct Losses {
  double share = 0, run = 0;
};
Losses LossesOf(const TrackerSettings& tracking) {
  Tracker tracker(tracking, kRate_hz, 3, {});
  int lost = 0, runs = 0, looks = 48000;
  double before = 0;
  bool losing = false;
  for (int tick = 1; tick <= looks; ++tick) {
    TargetState truth;
    truth.X_WH.p_m.x() = tick;
    const double now = tracker.Follow(truth).X_WH.p_m.x();
    const bool stands = now == before;
    lost += stands;
    runs += stands && !losing;
    losing = stands;
    before = now;
  }
  return {static_cast<double>(lost) / looks, static_cast<double>(lost) / std::max(runs, 1)};
}

TEST(TrackingTest, LossesHaveTheirShareAndLength) {
  const Losses single = LossesOf({.tracker_hz = kRate_hz, .dropped_share = 0.3});
  EXPECT_NEAR(single.share, 0.3, 0.01);
  EXPECT_NEAR(single.run, 1 / 0.7, 0.05);
  const Losses runs =
      LossesOf({.tracker_hz = kRate_hz, .dropped_share = 0.3, .dropped_run_s = 0.1});
  EXPECT_NEAR(runs.share, 0.3, 0.03);
  EXPECT_NEAR(runs.run, 48, 6);
}

TEST(TrackingTest, LossesLeaveTheNoiseOfOtherLooksAlone) {
  const TrackerSettings noisy{.tracker_hz = kRate_hz, .jitter_mm = 2};
  TrackerSettings lossy = noisy;
  lossy.dropped_share = 0.5;
  const auto all = Follow(noisy, 7, 200, true), some = Follow(lossy, 7, 200, true);
  int same = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    same += (all[i].X_WH.p_m - some[i].X_WH.p_m).norm() < 1e-12;
  EXPECT_GT(same, 60);
  EXPECT_LT(same, 140);
}

TEST(TrackingTest, TheSeedDecides) {
  const TrackerSettings noisy{.jitter_mm = 2};
  EXPECT_EQ(Follow(noisy, 1)[500].X_WH.p_m, Follow(noisy, 1)[500].X_WH.p_m);
  EXPECT_NE(Follow(noisy, 1)[500].X_WH.p_m, Follow(noisy, 2)[500].X_WH.p_m);
}

}  // namespace
}  // namespace prehend::physics
