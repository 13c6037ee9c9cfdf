// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/hand_model.h"

#include <gtest/gtest.h>

#include "tests/physics/library_hand.h"

namespace prehend::physics {
namespace {

TEST(HandModelTest, JointTargetsRunThroughTheFrames) {
  const GraspStyle style{.frames = {{0, 1}, {1, 1}, {1, 3}}};
  EXPECT_EQ(JointTargets(style, -1), (std::vector<double>{0, 1}));
  EXPECT_EQ(JointTargets(style, 0.25), (std::vector<double>{0.5, 1}));
  EXPECT_EQ(JointTargets(style, 0.75), (std::vector<double>{1, 2}));
  EXPECT_EQ(JointTargets(style, 2), (std::vector<double>{1, 3}));
}

TEST(HandModelTest, PositiveAnglesCurlAFingerTowardsThePalm) {
  const HandModel model = LibraryHand("human_right");
  std::vector<double> joints(model.links.size(), 0.0);
  const Pose straight = LinkPoses(model, joints)[2];
  EXPECT_NEAR(straight.p_m.z(), 0, 1e-12);
  for (int i = 0; i < 3; ++i) joints[static_cast<std::size_t>(i)] = 0.5;
  const Pose curled = LinkPoses(model, joints)[2];
  EXPECT_LT(curled.p_m.z(), -0.02);
  EXPECT_LT(curled.p_m.x(), straight.p_m.x());
}

TEST(HandModelTest, TheMirrorImageStandsWhereTheMirrorShowsIt) {
  const HandModel right = LibraryHand("human_right"), left = LibraryHand("human_left");
  EXPECT_FALSE(right.left);
  EXPECT_TRUE(left.left);
  for (const double trigger : {0.0, 0.5, 1.0}) {
    const auto a = LinkPoses(right, JointTargets(right.styles[0], trigger));
    const auto b = LinkPoses(left, JointTargets(left.styles[0], trigger));
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_LT((b[i].p_m - Eigen::Vector3d(a[i].p_m.x(), -a[i].p_m.y(), a[i].p_m.z())).norm(),
                1e-12);
    }
  }
}

TEST(HandModelTest, UnstableGainsAreNamed) {
  HandModel model = LibraryHand("human_right");
  EXPECT_EQ(CheckGains(model, 480), "");
  EXPECT_NE(CheckGains(model, 60).find("derivative"), std::string::npos);
  model.translation.derivative = 480;
  EXPECT_NE(CheckGains(model, 480).find("translation"), std::string::npos);
  model.translation.derivative = 120;
  model.rotation.derivative = 12;
  EXPECT_NE(CheckGains(model, 480).find("rotation"), std::string::npos);
}

TEST(HandModelTest, GainsThatCannotFollowOrDivergeAreNamed) {
  const HandModel good = LibraryHand("human_right");
  const auto why = [&](double PidGains::*gain, double value) {
    HandModel model = good;
    model.translation.*gain = value;
    return CheckGains(model, 480);
  };
  EXPECT_NE(why(&PidGains::proportional, 0).find("proportional gain is 0"), std::string::npos);
  EXPECT_NE(why(&PidGains::derivative, 0).find("derivative gain is 0"), std::string::npos);
  EXPECT_NE(why(&PidGains::limit, 0).find("limit is 0"), std::string::npos);
  EXPECT_NE(why(&PidGains::proportional, 1e6).find("overshoots"), std::string::npos);
  EXPECT_NE(why(&PidGains::integral, 1e6).find("integral"), std::string::npos);
  EXPECT_EQ(why(&PidGains::integral, 0), "");
}

TEST(HandModelTest, OfAnErrorAShareIsRemovedThatGoesWithATickAndWithTheSquareOfALongOne) {
  const JointDriver driver;
  const auto share = [&](double rate_hz) {
    return WantedSpeed(driver, {}, 0.001, 0, 1 / rate_hz) / rate_hz / 0.001;
  };
  EXPECT_EQ(WantedSpeed(driver, {}, 0.001, 0, 1.0 / 480), driver.stiffness * 0.001 / (1.0 / 480));
  EXPECT_NEAR(share(960), driver.stiffness / 2, 1e-9);
  EXPECT_NEAR(share(240), driver.stiffness * 4, 1e-9);
  EXPECT_NEAR(share(120), 1, 1e-9) << "not more than all of it";
}

TEST(HandModelTest, StylesAreFoundByName) {
  const HandModel model = LibraryHand("human_right");
  for (const char* name : {"wrap", "pinch", "tripod", "lateral"})
    EXPECT_GE(FindStyle(model, name), 0) << name;
  EXPECT_EQ(FindStyle(model, "claw"), -1);
}

}  // namespace
}  // namespace prehend::physics
