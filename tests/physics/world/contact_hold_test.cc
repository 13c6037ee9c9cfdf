// SPDX-License-Identifier: Apache-2.0
// When a contact ends, told from points as an engine reports them.
#include "physics/world/contact_hold.h"

#include <gtest/gtest.h>

namespace prehend::physics {
namespace {

constexpr double kNear_m = 0.0004, kFar_m = 0.0006;

/// Two bodies of which the first is fixed.
class ContactHold : public testing::Test {
 protected:
  bool TouchAfterTick(double impulse_n_s, double distance_m) {
    pairs_.BeginTick({1, 0});
    pairs_.Add({.a = {.body = BodyIndex(0)},
                .b = {.body = BodyIndex(1)},
                .distance_m = distance_m,
                .normal_impulse_n_s = impulse_n_s});
    pairs_.EndTick();
    Snapshot snapshot;
    pairs_.Describe(snapshot);
    return !snapshot.contacts.empty();
  }
  void Press(int ticks) {
    for (int i = 0; i < ticks; ++i) EXPECT_TRUE(TouchAfterTick(0.01, 0));
  }
  /// Of these ticks without an impulse, how many are contacts.
  int TicksThatTouch(int ticks, double distance_m) {
    int count = 0;
    for (int i = 0; i < ticks; ++i) count += TouchAfterTick(0, distance_m) ? 1 : 0;
    return count;
  }

  TouchingPairs pairs_;
};

TEST_F(ContactHold, NearnessAloneIsNone) { EXPECT_EQ(TicksThatTouch(20, kNear_m), 0); }

TEST_F(ContactHold, WhatHasPressedTouchesUntilItIsApart) {
  Press(20);
  EXPECT_EQ(TicksThatTouch(300, kNear_m), 300);
  EXPECT_EQ(TicksThatTouch(20, kFar_m), 4);
}

TEST_F(ContactHold, WhereNoPointTellsItIsMeasured) {
  Press(20);
  double apart_m = kNear_m;
  const auto touches = [&] {
    pairs_.BeginTick({1, 0});
    pairs_.EndTick([&](const ContactSide&, const ContactSide&) { return apart_m; });
    Snapshot snapshot;
    pairs_.Describe(snapshot);
    return !snapshot.contacts.empty();
  };
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(touches()) << i;
  apart_m = kFar_m;
  int count = 0;
  for (int i = 0; i < 20; ++i) count += touches() ? 1 : 0;
  EXPECT_EQ(count, 4);
}

TEST_F(ContactHold, InAGapPointsOfAHandGoAlongWithIt) {
  Snapshot now;
  now.hands.resize(1);
  const Eigen::Vector3d p_H_m(0.2, 0, 0), nhat_H = Eigen::Vector3d::UnitX();
  for (int i = 0; i < 30; ++i) {
    const Pose X_WH{{0.1 * i, 0, 0},
                    Eigen::Quaterniond(Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ()))};
    now.hands[0].palm.X_WB = X_WH;
    pairs_.BeginTick({1, 0});
    pairs_.Add({.a = {.body = BodyIndex(1)},
                .b = {.hand = HandIndex(0)},
                .p_W_m = X_WH * p_H_m,
                .nhat_BA_W = X_WH.q * nhat_H,
                .distance_m = kNear_m,
                .normal_impulse_n_s = i < 20 ? 0.01 : 0});
    pairs_.EndTick();
    pairs_.Describe(now);
    ASSERT_EQ(now.contacts.size(), 1u);
    const ContactPoint& point = now.contacts[0];
    EXPECT_LT((X_WH.inverse() * point.p_W_m - p_H_m).norm(), 1e-12) << i;
    EXPECT_LT((point.nhat_BA_W.cwiseAbs() - (X_WH.q * nhat_H).cwiseAbs()).norm(), 1e-12) << i;
  }
}

TEST_F(ContactHold, ABlowIsOverHoweverNearTheTwoStay) {
  Press(5);
  EXPECT_EQ(TicksThatTouch(20, kNear_m), 4);
}

TEST_F(ContactHold, TwiceTheTicksAreTheSameTime) {
  pairs_ = TouchingPairs(960);
  Press(15);
  EXPECT_EQ(TicksThatTouch(20, kNear_m), 8) << "a blow";
  Press(21);
  EXPECT_EQ(TicksThatTouch(100, kNear_m), 100);
  EXPECT_EQ(TicksThatTouch(20, kFar_m), 8);
}

TEST_F(ContactHold, AFlickerOfTheForceEndsNothing) {
  for (int i = 0; i < 5; ++i) {
    Press(3);
    EXPECT_EQ(TicksThatTouch(3, kFar_m), 3);
  }
}

}  // namespace
}  // namespace prehend::physics
