// SPDX-License-Identifier: Apache-2.0
// Persons as mannequins: every part is drawn as what it is, where its capsule is.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "render/draw_list.h"

namespace prehend::render {
namespace {

class DrawPersonTest : public testing::Test {
 protected:
  DrawPersonTest() {
    const physics::Person anna{.name = "anna", .head = physics::BodyIndex(0), .has_body = true};
    const std::pair<const char*, double> parts[] = {{"anna", 0.05},
                                                    {"anna_neck", 0.09},
                                                    {"anna_chest", 0.1},
                                                    {"anna_abdomen", 0.12},
                                                    {"anna_pelvis", 0.17},
                                                    {"anna_right_upper_arm", 0.32},
                                                    {"anna_right_hand", 0.19},
                                                    {"anna_right_forearm", 0.25},
                                                    {"anna_right_thigh", 0.43},
                                                    {"anna_right_shank", 0.43},
                                                    {"anna_right_foot", 0.16},
                                                    {"anna_right_toes", 0.06}};
    for (const auto& [name, length_m] : parts) {
      scene_.bodies.push_back(
          {.name = name, .shapes = {{physics::Capsule{0.05, length_m}, {}}}, .kinematic = true});
      scene_.bodies.back().X_WB.p_m.z() = 0.1 * static_cast<double>(scene_.bodies.size());
    }
    scene_.bodies.push_back({.name = "ball", .shapes = {{physics::Sphere{0.1}, {}}}});
    scene_.persons = {anna};
  }
  std::size_t Count(const DrawList& list, const std::string& name) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        list.solids, [&](const Item& item) { return list.objects[item.object].name == name; }));
  }

  physics::Scene scene_;
};

TEST_F(DrawPersonTest, AllPartsOfAPersonAndNothingElse) {
  const std::vector<bool> drawn = DrawnAsMannequin(scene_);
  ASSERT_EQ(drawn.size(), scene_.bodies.size());
  EXPECT_EQ(std::ranges::count(drawn, false), 1) << "the ball";
  EXPECT_FALSE(drawn.back());
  const DrawList list = MakeDrawList({.scene = &scene_});
  for (const physics::Body& body : scene_.bodies)
    EXPECT_GE(Count(list, "body:" + body.name), 1u) << body.name;
  EXPECT_EQ(Count(list, "body:anna_right_thigh"), 2u) << "the limb and the ball of its joint";
  EXPECT_GE(Count(list, "body:anna"), 7u) << "a head has eyes, brows, ears, a nose, a mouth";
}

TEST_F(DrawPersonTest, APartStaysWhereItsCapsuleIs) {
  const DrawList list = MakeDrawList({.scene = &scene_});
  for (const DrawnObject& object : list.objects) {
    for (const physics::Body& body : scene_.bodies) {
      if (object.name != "body:" + body.name) continue;
      const auto* capsule = std::get_if<physics::Capsule>(&body.shapes.front().shape);
      if (!capsule) continue;
      const double reach = capsule->length_m / 2 + capsule->radius_m + 0.08;
      EXPECT_LT((object.bounds.center_m().cast<double>() - body.X_WB.p_m).norm(), 0.08)
          << body.name;
      EXPECT_LT(object.bounds.high_m.z() - body.X_WB.p_m.z(), reach) << body.name;
    }
  }
}

TEST_F(DrawPersonTest, WhatHidesIsTranslucentAsAWhole) {
  Picture picture{.scene = &scene_};
  picture.body_alphas.assign(scene_.bodies.size(), 0.35f);
  const DrawList list = MakeDrawList(picture);
  ASSERT_EQ(list.ghosts.size(), 2u) << "the person, and the ball";
  EXPECT_EQ(Count(list, "body:anna_chest"), 0u);
}

}  // namespace
}  // namespace prehend::render
