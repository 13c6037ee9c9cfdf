// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/run_limits.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace prehend::physics {
namespace {

struct CheckCase {
  const char* reason;
  std::function<void(Snapshot&)> spoil;
};

TEST(RunChecksTest, EveryDisasterIsNamedWithItsEntity) {
  Scene scene;
  scene.bodies = {{.name = "table"}, {.name = "cup"}};
  Snapshot good;
  good.bodies.resize(2);
  EXPECT_FALSE(CheckSnapshot(scene, good).has_value());

  const CheckCase cases[] = {
      {"not finite",
       [](Snapshot& s) {
         s.bodies[1].v_WB_m_per_s.x() = std::numeric_limits<double>::quiet_NaN();
       }},
      {"60 m/s", [](Snapshot& s) { s.bodies[1].v_WB_m_per_s.z() = 60; }},
      {"25 m from", [](Snapshot& s) { s.bodies[1].X_WB.p_m.y() = -25; }},
      {"30 mm deep in table",
       [](Snapshot& s) {
         s.contacts = {
             {.a = {.body = BodyIndex(1)}, .b = {.body = BodyIndex(0)}, .distance_m = -0.03}};
       }},
  };
  for (const CheckCase& c : cases) {
    Snapshot bad = good;
    c.spoil(bad);
    const auto problem = CheckSnapshot(scene, bad);
    ASSERT_TRUE(problem.has_value()) << c.reason;
    EXPECT_EQ(problem->entity, "cup");
    EXPECT_NE(problem->reason.find(c.reason), std::string::npos) << problem->reason;
    EXPECT_FALSE(problem->advice.empty());
  }
}

TEST(RunChecksTest, APersonWhoIsTooFastIsNotSqueezed) {
  Scene scene;
  scene.bodies = {{.name = "anna", .kinematic = true}};
  Snapshot now;
  now.bodies.resize(1);
  now.bodies[0].v_WB_m_per_s.x() = 60;
  EXPECT_EQ(CheckSnapshot(scene, now)->advice,
            "a person goes where her script says: give the step more time ('over_s', 'wait_s', "
            "'join_s'); an "
            "arm or a leg whose end passes its own shoulder or hip closely bends the other way "
            "there: lead it around");
}

TEST(RunChecksTest, WhatIsPressedIntoAnotherByAHugeMassIsAdvisedOfIt) {
  Scene scene;
  scene.bodies = {{.name = "table", .fixed = true},
                  {.name = "feather", .mass_kg = 0.001},
                  {.name = "anvil", .mass_kg = 1000}};
  Snapshot now;
  now.bodies.resize(3);
  now.contacts = {{.a = {.body = BodyIndex(0)}, .b = {.body = BodyIndex(1)}, .distance_m = -0.03}};
  EXPECT_EQ(CheckSnapshot(scene, now)->advice, "start them apart, or let them meet more slowly");
  now.contacts.push_back({.a = {.body = BodyIndex(1)}, .b = {.body = BodyIndex(2)}});
  EXPECT_EQ(CheckSnapshot(scene, now)->advice,
            "a mass presses on one that is 1000000 times smaller; make them more similar");
}

TEST(RunChecksTest, WhatStandsBesideOnTheSameTablePressesOnNothing) {
  Scene scene;
  scene.bodies = {{.name = "table", .fixed = true},
                  {.name = "plate", .mass_kg = 0.2},
                  {.name = "pot", .mass_kg = 20},
                  {.name = "feather", .mass_kg = 0.001},
                  {.name = "tray", .mass_kg = 1}};
  const auto between = [](int a, int b) {
    return ContactPoint{.a = {.body = BodyIndex(a)}, .b = {.body = BodyIndex(b)}};
  };
  Snapshot now;
  now.contacts = {between(0, 1), between(1, 2), between(3, 0), between(2, 4)};
  EXPECT_DOUBLE_EQ(MassRatioAt(scene, now, now.contacts[0]), 100) << "pot on plate";
  EXPECT_DOUBLE_EQ(MassRatioAt(scene, now, now.contacts[1]), 100) << "and tray on pot";
  EXPECT_DOUBLE_EQ(MassRatioAt(scene, now, now.contacts[2]), 1) << "the feather bears nothing";
}

}  // namespace
}  // namespace prehend::physics
