// SPDX-License-Identifier: Apache-2.0
// What lies in the plane y = 0, and the sections it cuts.
#include "physics/scene/planar.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/physics/library_hand.h"

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

constexpr double kRight = std::numbers::pi / 2;

Pose Turned(double angle_rad, const Vector3d& axis, const Vector3d& at_m = Vector3d::Zero()) {
  return {at_m, Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis.normalized()))};
}

TEST(PlanarTest, ShapesLieInThePlaneWhenTheirAxesDo) {
  const Box box{{0.1, 0.2, 0.3}};
  const Cylinder can{0.03, 0.1};
  EXPECT_TRUE(LiesInPlane(box, {}));
  EXPECT_TRUE(LiesInPlane(box, Turned(0.3, Vector3d::UnitY(), {1, 0, 2})));
  EXPECT_TRUE(LiesInPlane(box, Turned(kRight, Vector3d::UnitX())));
  EXPECT_TRUE(LiesInPlane(can, {})) << "upright";
  EXPECT_TRUE(LiesInPlane(can, Turned(kRight, Vector3d::UnitX()))) << "a disc";
  EXPECT_TRUE(LiesInPlane(Sphere{0.1}, Turned(1, {1, 2, 3})));
  EXPECT_FALSE(LiesInPlane(box, Turned(0.3, Vector3d::UnitZ())));
  EXPECT_FALSE(LiesInPlane(box, Turned(0.3, Vector3d::UnitX())));
  EXPECT_FALSE(LiesInPlane(can, Turned(0.3, Vector3d::UnitX())));
  EXPECT_TRUE(LiesInPlane(can, Turned(0.3, Vector3d::UnitZ()))) << "round about its axis";
  EXPECT_FALSE(LiesInPlane(Sphere{0.1}, {{0, 0.001, 0}}));
}

TEST(PlanarTest, ABodySaysWhyItDoesNotFit) {
  Body body{.name = "thing", .shapes = {{Box{}, {}}, {Box{}, {{0.1, 0, 0}}}}};
  EXPECT_EQ(WhyNotPlanar(body), "");
  body.X_WB.p_m.y() = 0.01;
  EXPECT_EQ(WhyNotPlanar(body), "its centre is off the plane y = 0");
  body.X_WB.p_m.y() = 0;
  body.shapes[1].X_BS.p_m.y() = 0.01;
  EXPECT_EQ(WhyNotPlanar(body), "a part of it is not in the plane y = 0");
  body.shapes[1] = {Box{}, Turned(0.2, Vector3d::UnitX())};
  EXPECT_EQ(WhyNotPlanar(body), "it is turned out of the plane");
}

TEST(PlanarTest, JointsMoveInThePlaneOrSayWhyNot) {
  EXPECT_EQ(WhyNotPlanar({.kind = JointKind::kSlider, .axis_W = Vector3d(1, 0, 1).normalized()}),
            "");
  EXPECT_EQ(WhyNotPlanar({.kind = JointKind::kHinge, .axis_W = -Vector3d::UnitY()}), "");
  EXPECT_EQ(WhyNotPlanar({.kind = JointKind::kFixed}), "");
  EXPECT_EQ(WhyNotPlanar({.kind = JointKind::kSlider, .axis_W = Vector3d::UnitY()}),
            "its axis leaves the plane y = 0");
  EXPECT_EQ(WhyNotPlanar({.kind = JointKind::kHinge, .axis_W = Vector3d::UnitZ()}),
            "its axis is not the y axis, so it turns out of the plane");
  EXPECT_EQ(WhyNotPlanar({.kind = JointKind::kBall}), "a ball joint turns out of the plane");
}

TEST(PlanarTest, TheGripperIsPlanarAHumanHandIsNot) {
  EXPECT_EQ(WhyNotPlanar(LibraryHand("planar_gripper")), "");
  EXPECT_EQ(WhyNotPlanar(LibraryHand("human_right")),
            "its link 'index_proximal' is not in its plane y = 0");
  HandModel gripper = LibraryHand("planar_gripper");
  gripper.styles[0].grip_axis = Vector3d::UnitY();
  EXPECT_EQ(WhyNotPlanar(gripper), "its style 'parallel' does not grip in the plane");
  gripper.links[1].joint_axis = Vector3d::UnitY();
  EXPECT_EQ(WhyNotPlanar(gripper), "its link 'jaw' moves out of its plane y = 0");
}

TEST(PlanarTest, SectionsAreThoseOfTheSolids) {
  const Outline box = OutlineOf(Box{{0.1, 0.2, 0.3}}, Turned(-0.5, Vector3d::UnitY(), {1, 0, 2}));
  EXPECT_TRUE(box.centre_m.isApprox(Eigen::Vector2d(1, 2)));
  EXPECT_NEAR(box.angle_rad, 0.5, 1e-12) << "from x towards z is about -y";
  EXPECT_TRUE(box.half_size_m.isApprox(Eigen::Vector2d(0.05, 0.15)));
  const Outline lying = OutlineOf(Box{{0.1, 0.2, 0.3}}, Turned(kRight, Vector3d::UnitX()));
  EXPECT_TRUE(lying.half_size_m.isApprox(Eigen::Vector2d(0.05, 0.10)));
  const Outline disc = OutlineOf(Cylinder{0.04, 0.1}, Turned(kRight, Vector3d::UnitX()));
  EXPECT_TRUE(disc.half_size_m.isZero());
  EXPECT_EQ(disc.radius_m, 0.04);
  const Outline can = OutlineOf(Cylinder{0.04, 0.1}, {});
  EXPECT_TRUE(can.half_size_m.isApprox(Eigen::Vector2d(0.05, 0.04))) << "its length along z";
  EXPECT_NEAR(can.angle_rad, kRight, 1e-12);
  const Outline capsule = OutlineOf(Capsule{0.04, 0.1}, {});
  EXPECT_TRUE(capsule.half_size_m.isApprox(Eigen::Vector2d(0.05, 0)));
  EXPECT_EQ(capsule.radius_m, 0.04);
}

TEST(PlanarTest, MomentsAreThoseOfTheSolids) {
  const Pose lying = Turned(kRight, Vector3d::UnitX());
  EXPECT_NEAR(MomentAboutY(Box{{0.3, 0.2, 0.4}}, {}, 12), 0.25, 1e-12);
  EXPECT_NEAR(MomentAboutY(Box{{0.3, 0.2, 0.4}}, lying, 12), 0.13, 1e-12);
  EXPECT_NEAR(MomentAboutY(Sphere{0.5}, {}, 10), 1, 1e-12);
  EXPECT_NEAR(MomentAboutY(Cylinder{0.2, 1}, lying, 2), 0.04, 1e-12);
  EXPECT_NEAR(MomentAboutY(Cylinder{0.2, 0.6}, {}, 2), 0.02 + 0.06, 1e-12);
  // A capsule without length is a ball; a long thin one is a rod.
  EXPECT_NEAR(MomentAboutY(Capsule{0.5, 1e-9}, {}, 10), 1, 1e-6);
  EXPECT_NEAR(MomentAboutY(Capsule{1e-4, 1}, {}, 12), 1, 1e-3);
}

}  // namespace
}  // namespace prehend::physics
