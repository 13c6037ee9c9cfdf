// SPDX-License-Identifier: Apache-2.0
#include "grammar/program/thresholds.h"

#include <gtest/gtest.h>

#include <limits>

namespace prehend::grammar {
namespace {

using enum Threshold::Value;

TEST(Thresholds, ATouchIsBeyondWhatItReaches) {
  const Thresholds thresholds({{kSensorSets, 2},
                               {kUpOnFirst, 0.5},
                               {kUpOnSecond, 0.5},
                               {kForce, 3},
                               {kTrigger, 0.3},
                               {kVerticalSpeed, 0.02}});
  EXPECT_EQ(thresholds.OfTouch(-1, -1, 0, 0, 0), 0u);
  EXPECT_EQ(thresholds.OfTouch(-1, -1, 0, 0, 0b101), 0b00001u) << "two sets, whichever they are";
  EXPECT_EQ(thresholds.OfTouch(0.5, 0.4, 0, 0, 1), 0b00010u);
  EXPECT_EQ(thresholds.OfTouch(0.4, 0.5, 3, 0, 1), 0b01100u);
  EXPECT_EQ(thresholds.OfTouch(-1, -1, 0, 0.02, 1), 0b100000u);
  EXPECT_EQ(thresholds.OfGrip(0.3), 0b10000u);
  EXPECT_EQ(thresholds.OfGrip(0.2), 0u);
}

TEST(Thresholds, NoTouchMeasuresNothing) {
  const Thresholds thresholds(
      {{kSensorSets, 0}, {kUpOnFirst, -1}, {kUpOnSecond, -0.9}, {kForce, 0}, {kSensorSets, 0.5}});
  EXPECT_EQ(thresholds.OfNoTouch(), 0b01011u);
}

TEST(Thresholds, SetsAreCounted) {
  const Thresholds thresholds({{kSensorSets, 32},
                               {kSensorSets, 33},
                               {kSensorSets, std::numeric_limits<double>::quiet_NaN()}});
  EXPECT_EQ(thresholds.OfTouch(-1, -1, 0, 0, 0xffffffff), 0b001u);
  EXPECT_EQ(thresholds.OfTouch(-1, -1, 0, 0, 0x7fffffff), 0u);
}

}  // namespace
}  // namespace prehend::grammar
