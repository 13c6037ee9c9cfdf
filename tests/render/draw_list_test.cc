// SPDX-License-Identifier: Apache-2.0
#include "render/draw_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/render/demo_picture.h"

namespace prehend::render {
namespace {

using Eigen::Vector3f;

std::vector<std::string> Names(const DrawList& list) {
  std::vector<std::string> names;
  for (const DrawnObject& object : list.objects) names.push_back(object.name);
  return names;
}

int Count(const std::vector<Item>& items, Primitive primitive) {
  return static_cast<int>(std::count_if(items.begin(), items.end(),
                                        [&](const Item& i) { return i.primitive == primitive; }));
}

TEST(DrawListTest, EverythingHasItsName) {
  const physics::Scene scene = DemoScene();
  const std::vector<std::string> names = Names(MakeDrawList(DemoPicture(scene)));
  const std::vector<std::string> expected = {"background",
                                             "ground",
                                             "body:table",
                                             "body:milk",
                                             "body:cereal",
                                             "body:mug",
                                             "body:apple",
                                             "body:plate",
                                             "body:can",
                                             "hand:right_hand",
                                             "forearm:right_hand",
                                             "path:0:reaching",
                                             "path:1:fixation",
                                             "path:2:picking_up",
                                             "path:3:transporting",
                                             "path:4:putting_down",
                                             "path:5:sliding",
                                             "path:6:",
                                             "ghost:0:right_hand",
                                             "ghost:1:right_hand",
                                             "ghost:2:right_hand",
                                             "ghost:3:right_hand",
                                             "marker:0:contact",
                                             "marker:1:support",
                                             "marker:2:region"};
  EXPECT_EQ(names, expected);
}

TEST(DrawListTest, RegionsOfInterestAreSpheresCylindersAndStars) {
  const physics::Scene scene = DemoScene();
  Picture picture = DemoPicture(scene);
  picture.markers = {{.kind = MarkerKind::kSphere,
                      .half_size_m = Vector3f::Constant(0.3f),
                      .color = Color(1, 0, 0)},
                     {.kind = MarkerKind::kCylinder, .half_size_m = {0.09f, 0.09f, 0.12f}},
                     {.kind = MarkerKind::kCandidate},
                     {.kind = MarkerKind::kPersonsContact},
                     {.kind = MarkerKind::kContact}};
  const DrawList list = MakeDrawList(picture);
  EXPECT_EQ(Names(list).at(Names(list).size() - 4), "marker:1:cylinder");
  EXPECT_EQ(Names(list).back(), "marker:4:contact");
  EXPECT_EQ(Count(list.markers, Primitive::kCylinder), 1);
  EXPECT_EQ(Count(list.markers, Primitive::kBox), 3) << "the star's three boards";
  EXPECT_EQ(list.markers[0].color, Color(1, 0, 0)) << "that of its phase";
  EXPECT_NEAR(list.markers[1].half_size_m.z() + list.markers[1].rounding_m, 0.12f, 1e-6f);
  const auto shining = std::count_if(list.markers.begin(), list.markers.end(),
                                     [](const Item& item) { return item.shines_through; });
  EXPECT_EQ(shining, 4) << "the star and the contact of a person, which something may hide";
}

TEST(DrawListTest, PathsAreThinnerNearAHand) {
  const physics::Scene scene = DemoScene();
  Picture picture = DemoPicture(scene);
  const auto bead_at = [&](float distance_m) {
    picture.camera.eye_m = picture.camera.look_at_m + Vector3f(0, -distance_m, 0);
    const DrawList list = MakeDrawList(picture);
    const auto ball = std::find_if(list.paths.begin(), list.paths.end(), [](const Item& item) {
      return item.primitive == Primitive::kBall;
    });
    return ball == list.paths.end() ? 0.0f : ball->rounding_m;
  };
  EXPECT_GT(bead_at(0.4f), 0);
  EXPECT_LT(bead_at(0.4f), 0.6f * bead_at(1));
  EXPECT_EQ(bead_at(1), bead_at(1.2f)) << "no less than this from afar";
}

TEST(DrawListTest, LegsAndGazesAreDrawnLast) {
  const physics::Scene scene = DemoScene();
  Picture picture{.scene = &scene};
  picture.props = {{.name = "leg:table", .center_m = {0, 0, 0.3f}, .half_size_m = {1, 2, 0.3f}}};
  picture.gazes = {{.from_m = {0, 0, 1}, .to_m = {0, 1, 1}, .hits = true},
                   {.from_m = {0, 0, 1}, .to_m = {0, 0, 1}}};
  const DrawList list = MakeDrawList(picture);
  ASSERT_GE(list.objects.size(), 3u);
  const auto end = list.objects.end();
  EXPECT_EQ((end - 3)->name, "leg:table");
  EXPECT_NEAR((end - 3)->bounds.high_m.z(), 0.6f, 1e-6f);
  EXPECT_EQ((end - 2)->name, "gaze:0");
  EXPECT_EQ(list.paths.size(), 2u) << "a rod and a ball; a gaze of no length is not drawn";
}

TEST(DrawListTest, APaleBodyIsAGhost) {
  const physics::Scene scene = DemoScene();
  Picture picture{.scene = &scene, .body_alphas = {1, 0.3f}};
  const DrawList list = MakeDrawList(picture);
  ASSERT_EQ(list.ghosts.size(), 1u);
  EXPECT_EQ(list.ghosts[0].front().object, list.first_body + 1);
  EXPECT_EQ(list.ghosts[0].front().alpha, 0.3f);
  EXPECT_TRUE(std::ranges::none_of(
      list.solids, [&](const Item& item) { return item.object == list.first_body + 1; }));
}

TEST(DrawListTest, AHandWithAPersonsArmHasNoOtherForearm) {
  physics::Scene scene = DemoScene();
  scene.persons.push_back({.name = "anna",
                           .head = physics::kNone,
                           .has_body = true,
                           .right_hand = physics::HandIndex(0)});
  Picture picture{.scene = &scene, .snapshot = DemoPicture(scene).snapshot};
  EXPECT_TRUE(MakeDrawList(picture).ghosts.empty());
  scene.persons[0].right_hand = physics::kNone;
  EXPECT_EQ(MakeDrawList(picture).ghosts.size(), 1u);
}

TEST(DrawListTest, ASecondHandsPathHasSquareBeads) {
  PathInterval interval{.label = "reaching", .points_per_s = 60, .square_beads = true};
  for (int i = 0; i <= 60; ++i) interval.points_m.emplace_back(0.01f * static_cast<float>(i), 0, 1);
  EXPECT_EQ(Count(MakeDrawList({.path = {interval}}).paths, Primitive::kBox), 6);
}

TEST(DrawListTest, GrainsAreBallsWhereTheSnapshotHasThem) {
  physics::Scene scene;
  physics::Body peas{
      .name = "peas", .shapes = {}, .grains = physics::Grains{.radius_m = 0.004, .p_WG_m = {}}};
  peas.grains->p_WG_m = {{0, 0, 1}, {0, 0, 2}};
  scene.bodies = {peas};
  Picture picture;
  picture.scene = &scene;
  picture.snapshot.bodies.resize(1);
  picture.snapshot.grains = {{0, 0, 3}, {0, 0, 4}};
  const DrawList list = MakeDrawList(picture);
  ASSERT_EQ(Count(list.solids, Primitive::kBall), 2);
  const auto first = std::ranges::find(list.solids, Primitive::kBall, &Item::primitive);
  EXPECT_FLOAT_EQ(first->X_WI.translation().z(), 3);
  EXPECT_FLOAT_EQ(first->rounding_m, 0.004f);
}

TEST(DrawListTest, BoundsAreThoseOfTheShapes) {
  physics::Scene scene;
  const double s = std::sqrt(0.5);
  scene.bodies = {{.name = "turned",
                   .shapes = {{physics::Box{{0.2, 0.4, 0.6}}, {}}},
                   .X_WB = {{1, 2, 3}, {s, 0, 0, s}}},
                  {.name = "ball", .shapes = {{physics::Sphere{0.5}, {{0, 0, 1}, {1, 0, 0, 0}}}}},
                  {.name = "cylinder", .shapes = {{physics::Cylinder{0.1, 0.6}, {}}}},
                  {.name = "capsule", .shapes = {{physics::Capsule{0.1, 0.6}, {}}}}};
  const DrawList list = MakeDrawList({.scene = &scene});
  const struct {
    int body;
    Vector3f low, high;
  } kCases[] = {{0, {0.8f, 1.9f, 2.7f}, {1.2f, 2.1f, 3.3f}},
                {1, {-0.5f, -0.5f, 0.5f}, {0.5f, 0.5f, 1.5f}},
                {2, {-0.1f, -0.1f, -0.3f}, {0.1f, 0.1f, 0.3f}},
                {3, {-0.1f, -0.1f, -0.4f}, {0.1f, 0.1f, 0.4f}}};
  for (const auto& c : kCases) {
    const Bounds& bounds = list.objects[list.first_body + c.body].bounds;
    EXPECT_LT((bounds.low_m - c.low).norm(), 1e-5f) << c.body;
    EXPECT_LT((bounds.high_m - c.high).norm(), 1e-5f) << c.body;
  }
}

TEST(DrawListTest, SnapshotMovesBodiesAndHandsAreDrawnLinkByLink) {
  const physics::Scene scene = DemoScene();
  Picture picture{.scene = &scene, .snapshot = DemoPicture(scene).snapshot};
  picture.snapshot.bodies[1].X_WB.p_m = {5, 6, 7};
  const DrawList list = MakeDrawList(picture);
  EXPECT_LT((list.objects[list.first_body + 1].bounds.center_m() - Vector3f(5, 6, 7)).norm(),
            1e-5f);
  const auto of_hand = std::count_if(list.solids.begin(), list.solids.end(), [&](const Item& item) {
    return item.object == list.first_hand;
  });
  EXPECT_EQ(of_hand, 1 + 15) << "palm and links";
}

TEST(DrawListTest, PathHasBeadsInTimeAndAnArrow) {
  PathInterval interval{.label = "reaching", .points_per_s = 60};
  for (int i = 0; i <= 60; ++i) interval.points_m.emplace_back(0.01f * static_cast<float>(i), 0, 1);
  DrawList list = MakeDrawList({.path = {interval}});
  EXPECT_EQ(Count(list.paths, Primitive::kMesh), 1);
  EXPECT_EQ(Count(list.paths, Primitive::kBall), 6) << "one second, a bead every 0.2 s";
  EXPECT_EQ(Count(list.paths, Primitive::kCone), 1);
  const auto arrow = std::find_if(list.paths.begin(), list.paths.end(),
                                  [](const Item& i) { return i.primitive == Primitive::kCone; });
  EXPECT_LT((arrow->X_WI.linear() * Vector3f::UnitZ() - Vector3f::UnitX()).norm(), 1e-4f)
      << "points along the path";

  interval.label = "";
  list = MakeDrawList({.path = {interval}});
  EXPECT_EQ(list.paths.size(), 1u) << "idle: only the tube";
}

TEST(DrawListTest, NeighbouringIntervalsAreJoined) {
  const PathInterval first{.label = "a", .points_m = {{0, 0, 0}, {0.1f, 0, 0}}},
      second{.label = "b", .points_m = {{0.13f, 0, 0}, {0.2f, 0, 0}}},
      far{.label = "c", .points_m = {{1, 0, 0}, {1.1f, 0, 0}}};
  const DrawList list = MakeDrawList({.path = {first, second, far}});
  ASSERT_EQ(list.meshes.size(), 3u);
  EXPECT_EQ(list.meshes[1].vertices.front().corner, Vector3f(0.1f, 0, 0));
  EXPECT_EQ(list.meshes[2].vertices.front().corner, Vector3f(1, 0, 0));
}

TEST(DrawListTest, WhatIsNotFiniteIsSkipped) {
  const double nan = std::nan("");
  const float nanf = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  physics::Scene scene = DemoScene();
  Picture picture = DemoPicture(scene);
  scene.bodies[2].shapes[0].shape = physics::Sphere{nan};
  picture.snapshot.bodies[1].X_WB.p_m.x() = nan;
  picture.path = {{"nan", {1, 0, 0}, {{nanf, 0, 0}, {infinity, 0, 0}}, nan},
                  {"one", {1, 0, 0}, {{0, 0, 1}}},
                  {"none"}};
  picture.markers = {
      {.half_size_m = {nanf, 1, 1}}, {.half_size_m = {0, 0, 0}}, {.p_W_m = {nanf, 0, 0}}};
  const DrawList list = MakeDrawList(picture);
  const auto finite = [](const Item& item) {
    return item.X_WI.matrix().allFinite() && std::isfinite(item.rounding_m);
  };
  EXPECT_TRUE(std::all_of(list.solids.begin(), list.solids.end(), finite));
  EXPECT_TRUE(list.objects[list.first_body + 1].bounds.empty());
  EXPECT_TRUE(list.objects[list.first_body + 2].bounds.empty());
  EXPECT_TRUE(list.meshes.empty());
  EXPECT_TRUE(list.markers.empty());
  EXPECT_TRUE(list.bounds.low_m.allFinite() && list.bounds.high_m.allFinite());
}

TEST(DrawListTest, IndicesThatTheSceneDoesNotHaveAreSkipped) {
  const physics::Scene scene = DemoScene();
  Picture picture{.scene = &scene};
  picture.ghosts = {{.hand = physics::HandIndex(7)},
                    {.hand = physics::kNone, .bodies = {physics::kNone, physics::BodyIndex(99)}},
                    {.hand = physics::HandIndex(0)}};
  const DrawList list = MakeDrawList(picture);
  EXPECT_EQ(list.ghosts.size(), 3u);
  for (const auto& ghost : list.ghosts) EXPECT_TRUE(ghost.empty());
}

TEST(DrawListTest, WithoutASceneThereAreStillPaths) {
  const DrawList list = MakeDrawList(
      {.path = {{"a", {1, 0, 0}, {{0, 0, 0}, {1, 0, 0}}}},
       .ghosts = {{.hand = physics::HandIndex(0), .bodies = {physics::BodyIndex(0)}}}});
  EXPECT_EQ(list.meshes.size(), 1u);
  EXPECT_TRUE(list.ghosts.empty());
}

}  // namespace
}  // namespace prehend::render
