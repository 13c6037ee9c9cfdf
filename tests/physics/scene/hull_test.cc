// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/hull.h"

#include <gtest/gtest.h>

#include <numbers>

#include "physics/bullet/world.h"
#include "physics/scene/geometry.h"
#include "physics/scene/planar.h"
#include "physics/world/world.h"

namespace prehend::physics {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

/// A box from its corners; the frame is in the corner with the least coordinates.
Points BoxPoints(const Vector3d& size) {
  Points points;
  for (int i = 0; i < 8; ++i)
    points.push_back(size.cwiseProduct(Vector3d(i & 1, i >> 1 & 1, i >> 2 & 1)));
  return points;
}

Points Ball(int rings, int around, double radius) {
  Points points;
  for (int r = 0; r < rings; ++r) {
    const double polar = std::numbers::pi * (r + 0.5) / rings;
    for (int i = 0; i < around; ++i) {
      const double turn = 2 * std::numbers::pi * i / around;
      points.emplace_back(radius * std::sin(polar) * std::cos(turn),
                          radius * std::sin(polar) * std::sin(turn), radius * std::cos(polar));
    }
  }
  return points;
}

TEST(Hull, OfABoxIsTheBox) {
  const Vector3d size(0.1, 0.2, 0.3);
  const auto made = MakeHull(BoxPoints(size));
  ASSERT_TRUE(made.hull) << made.problem;
  EXPECT_EQ(made.hull->faces.size(), 6u);
  for (const Hull::Face& face : made.hull->faces) EXPECT_EQ(face.corners.size(), 4u);
  EXPECT_NEAR(made.hull->volume_m3, size.prod(), 1e-15);
  EXPECT_LT((made.hull->X_SC.p_m - size / 2).norm(), 1e-12);
  Vector3d wanted =
      Vector3d(size.y() * size.y() + size.z() * size.z(), size.x() * size.x() + size.z() * size.z(),
               size.x() * size.x() + size.y() * size.y()) /
      12;
  std::sort(wanted.begin(), wanted.end());
  EXPECT_LT((made.hull->gyration_m2 - wanted).norm(), 1e-12);
  EXPECT_EQ(EdgesOf(*made.hull).size(), 3u);
}

TEST(Hull, OfATetrahedronHasItsCentreInAQuarter) {
  const auto made = MakeHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  ASSERT_TRUE(made.hull) << made.problem;
  EXPECT_EQ(made.hull->faces.size(), 4u);
  EXPECT_NEAR(made.hull->volume_m3, 1.0 / 6, 1e-12);
  EXPECT_LT((made.hull->X_SC.p_m - Vector3d::Constant(0.25)).norm(), 1e-12);
  EXPECT_NEAR(made.hull->gyration_m2.maxCoeff(), 0.1, 1e-12)
      << "about each edge direction: 3/40 and 1/40";
}

TEST(Hull, FacesSeeOutwards) {
  const auto made = MakeHull(Ball(8, 8, 0.05));
  ASSERT_TRUE(made.hull) << made.problem;
  for (const Hull::Face& face : made.hull->faces) {
    const auto corner = [&](std::size_t i) {
      return made.hull->corners_m[static_cast<std::size_t>(face.corners[i])];
    };
    EXPECT_GT((corner(1) - corner(0)).cross(corner(2) - corner(1)).dot(face.nhat_S), 0);
    EXPECT_LT(face.nhat_S.dot(made.hull->X_SC.p_m), face.offset_m);
  }
  EXPECT_NEAR(made.hull->volume_m3, 4.0 / 3 * std::numbers::pi * std::pow(0.05, 3), 0.15 * 5.2e-4);
}

TEST(Hull, DistancesAreThoseOfTheSolid) {
  const Hull box = *MakeHull(BoxPoints({0.2, 0.2, 0.2})).hull;
  EXPECT_NEAR(SignedDistance(box, {0.3, 0.1, 0.1}), 0.1, 1e-12) << "a face";
  EXPECT_NEAR(SignedDistance(box, {0.3, 0.3, 0.1}), 0.1 * std::numbers::sqrt2, 1e-12) << "an edge";
  EXPECT_NEAR(SignedDistance(box, {-0.1, -0.1, -0.1}), 0.1 * std::sqrt(3), 1e-12) << "a corner";
  EXPECT_NEAR(SignedDistance(box, {0.1, 0.1, 0.05}), -0.05, 1e-12) << "inside";
  EXPECT_LT((NearestIn(box, {0.1, 0.1, 0.05}) - Vector3d(0.1, 0.1, 0.05)).norm(), 1e-12);
}

TEST(Hull, WhatIsNoHullIsToldWhy) {
  const struct {
    const char* what;
    Points points;
    int point;
    std::string problem;
  } table[] = {
      {"in a plane",
       {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
       -1,
       "the points lie in a plane, or within 1 mm of one"},
      {"on a line",
       {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
       -1,
       "the points lie in a plane, or within 1 mm of one"},
      {"thin", BoxPoints({0.1, 0.1, 0.0009}), -1,
       "the points lie in a plane, or within 1 mm of one"},
      {"a point twice",
       {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0.00005}},
       4,
       "point 4 is at the same place as point 1"},
      {"one inside",
       {{0, 0, 0}, {0.1, 0.1, 0.1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
       1,
       "point 1 is not a corner: it lies inside, on a face or on an edge of the hull"},
      {"one on a face",
       {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2, 0.3, 0}},
       4,
       "point 4 is not a corner: it lies inside, on a face or on an edge of the hull"},
      {"one on an edge",
       {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0, 0}},
       4,
       "point 4 is not a corner: it lies inside, on a face or on an edge of the hull"},
  };
  for (const auto& row : table) {
    const MadeHull made = MakeHull(row.points);
    EXPECT_FALSE(made.hull) << row.what;
    EXPECT_EQ(made.point, row.point) << row.what;
    EXPECT_EQ(made.problem, row.problem) << row.what;
  }
}

TEST(Hull, PointsThatAreRoundedAreStillOneFace) {
  for (const double digits : {1e4, 1e6, 1e7, 1e9}) {
    Points points;
    for (const Vector3d& p : Ball(2, 7, 0.05))
      points.push_back((p * digits).array().round() / digits);
    const auto made = MakeHull(points);
    ASSERT_TRUE(made.hull) << digits << ": " << made.problem;
    const double exact = MakeHull(Ball(2, 7, 0.05)).hull->volume_m3;
    EXPECT_NEAR(made.hull->volume_m3, exact, 0.01 * exact) << digits;
  }
}

/// A body on a floor whose top is at 0.
Scene OnAFloor(const Shape& shape, const Pose& X_WB) {
  Scene scene;
  scene.bodies.push_back({.name = "floor",
                          .shapes = {{Box{{2, 2, 0.1}}, {}}},
                          .fixed = true,
                          .X_WB = {{0, 0, -0.05}}});
  scene.bodies.push_back({.name = "thing", .shapes = {{shape, {}}}, .mass_kg = 0.3, .X_WB = X_WB});
  return scene;
}

TEST(Hull, RestsAtItsTrueHeight) {
  const Scene scene = OnAFloor(*MakeHull(BoxPoints({0.06, 0.08, 0.1})).hull, {{0.3, 0.2, 0.0}});
  const auto world = MakeBulletWorld(scene, {});
  for (int tick = 0; tick < 240; ++tick) world->Step({});
  Snapshot now;
  world->Describe(now);
  EXPECT_NEAR(now.bodies[1].X_WB.p_m.z(), 0, 5e-4);
  EXPECT_LT((now.bodies[1].X_WB.p_m.head<2>() - Eigen::Vector2d(0.3, 0.2)).norm(), 1e-3);
  EXPECT_GE(now.contacts.size(), 1u);
}

TEST(Hull, FallsAsTheBoxThatItIs) {
  // Thrown and turning: the same motion, though the frame of the hull is in a corner.
  const Vector3d size(0.06, 0.08, 0.1);
  const Pose X_WBox{{0, 0, 1},
                    Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Vector3d(1, 2, 3).normalized()))};
  const auto as_box = MakeBulletWorld(OnAFloor(Box{size}, X_WBox), {});
  const auto as_hull =
      MakeBulletWorld(OnAFloor(*MakeHull(BoxPoints(size)).hull, X_WBox * Pose{-size / 2}), {});
  Snapshot box, hull;
  for (int tick = 0; tick < 200; ++tick) {
    as_box->Step({});
    as_hull->Step({});
  }
  as_box->Describe(box);
  as_hull->Describe(hull);
  EXPECT_LT((box.bodies[1].X_WB.p_m - hull.bodies[1].X_WB * Vector3d(size / 2)).norm(), 1e-9);
}

TEST(Hull, IsRefusedInAPlane) {
  Body body{.name = "gem", .shapes = {{*MakeHull(BoxPoints({0.1, 0.1, 0.1})).hull, {}}}};
  EXPECT_EQ(WhyNotPlanar(body), "a hull does not have the same cross-section all along y");
}

}  // namespace
}  // namespace prehend::physics
