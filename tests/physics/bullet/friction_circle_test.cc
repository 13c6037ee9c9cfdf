// SPDX-License-Identifier: Apache-2.0
#include "physics/bullet/lanes/friction_circle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace prehend::physics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What PrincipalResponse is made of.
struct PairResponse {
  double first, coupling, second;
  operator PrincipalResponse() const { return {first, coupling, second}; }
};

/// The whole impulse of a contact that has none yet, and would take `wanted` without a limit.
RowPair FrictionWithin(double limit, const PairResponse& k, const RowPair& wanted) {
  return FrictionChange({0, 0}, limit, k,
                        {k.first * wanted.first + k.coupling * wanted.second,
                         k.coupling * wanted.first + k.second * wanted.second});
}

/// What it minimises.
double Cost(const PairResponse& k, const RowPair& wanted, const RowPair& x) {
  const double a = x.first - wanted.first, b = x.second - wanted.second;
  return k.first * a * a + 2 * k.coupling * a * b + k.second * b * b;
}

TEST(FrictionCircle, WhatIsWithinTheLimitStaysAsItIs) {
  const RowPair x = FrictionWithin(5, {2, 0.5, 3}, {3, -3.9});
  // Responses are made larger by 1e-9 of their sum, here at most 3e-9 of the smaller one.
  EXPECT_NEAR(x.first, 3, 3e-9 * 5);
  EXPECT_NEAR(x.second, -3.9, 3e-9 * 5);
}

TEST(FrictionCircle, EqualMassesGiveAnImpulseInTheWantedDirection) {
  for (int degrees = 0; degrees < 360; degrees += 15) {
    const double angle = degrees * std::numbers::pi / 180;
    const RowPair x = FrictionWithin(2, {7, 0, 7}, {10 * std::cos(angle), 10 * std::sin(angle)});
    EXPECT_NEAR(x.first, 2 * std::cos(angle), 1e-8) << degrees;
    EXPECT_NEAR(x.second, 2 * std::sin(angle), 1e-8) << degrees;
  }
}

TEST(FrictionCircle, NoImpulseWithinTheLimitRemovesMoreSliding) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const double first = std::pow(10, 4 * unit(random) - 2), second = first * (0.01 + unit(random));
    const PairResponse k{first, std::sqrt(first * second) * (1.98 * unit(random) - 0.99), second};
    const RowPair wanted{20 * unit(random) - 10, 20 * unit(random) - 10};
    const double limit = std::pow(10, 3 * unit(random) - 2);
    const RowPair x = FrictionWithin(limit, k, wanted);
    const double length = std::hypot(x.first, x.second);
    ASSERT_LE(length, limit * (1 + 1e-8));
    if (std::hypot(wanted.first, wanted.second) <= limit) continue;
    ASSERT_NEAR(length, limit, 1e-8 * limit);
    const double cost = Cost(k, wanted, x);
    for (int i = 0; i < 720; ++i) {
      const double angle = i * std::numbers::pi / 360;
      ASSERT_GE(Cost(k, wanted, {limit * std::cos(angle), limit * std::sin(angle)}),
                cost * (1 - 1e-7) - 1e-12)
          << "trial " << trial << ", angle " << angle;
    }
  }
}

TEST(FrictionCircle, TheSlidingThatRemainsIsOppositeToTheImpulse) {
  const PairResponse k{2, 0.9, 1};
  const RowPair wanted{6, -3};
  const RowPair x = FrictionWithin(0.5, k, wanted);
  // Velocity that remains: K (x - wanted).
  const double a = x.first - wanted.first, b = x.second - wanted.second;
  const double v1 = k.first * a + k.coupling * b, v2 = k.coupling * a + k.second * b;
  EXPECT_NEAR(v1 * x.second - v2 * x.first, 0, 1e-6);
  EXPECT_LT(v1 * x.first + v2 * x.second, 0);
}

TEST(FrictionCircle, WithoutPressureTheImpulseIsTakenBack) {
  const RowPair change = FrictionChange({0.3, -0.2}, 0, {1, 0, 1}, {5, 5});
  EXPECT_EQ(change.first, -0.3);
  EXPECT_EQ(change.second, 0.2);
}

TEST(FrictionCircle, SlidingEndsWhereFrictionSuffices) {
  const PairResponse k{4, 1, 2};
  const RowPair change = FrictionChange({0.1, 0.1}, 100, k, {3, -2});
  EXPECT_NEAR(k.first * change.first + k.coupling * change.second, 3, 1e-7);
  EXPECT_NEAR(k.coupling * change.first + k.second * change.second, -2, 1e-7);
}

TEST(FrictionCircle, RowsThatPushTheSameWayShareTheImpulse) {
  const RowPair change = FrictionChange({0, 0}, 100, {1, 1, 1}, {2, 2});
  EXPECT_NEAR(change.first + change.second, 2, 1e-6);
  EXPECT_TRUE(std::isfinite(change.first));
}

TEST(FrictionCircle, RowsThatCannotMoveGetNoImpulse) {
  for (const PairResponse& k : {PairResponse{0, 0, 0}, PairResponse{kInfinity, 0, kInfinity},
                                PairResponse{1, 0, kInfinity}, PairResponse{std::nan(""), 0, 1}}) {
    const RowPair change = FrictionChange({0.1, 0.2}, 1, k, {1, 1});
    EXPECT_EQ(change.first, 0);
    EXPECT_EQ(change.second, 0);
  }
}

}  // namespace
}  // namespace prehend::physics
