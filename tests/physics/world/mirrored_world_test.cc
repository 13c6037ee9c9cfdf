// SPDX-License-Identifier: Apache-2.0
// Left is the mirror of right: of states and contacts, and of whole runs.
#include "physics/world/mirrored_world.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "physics/bullet/world.h"
#include "physics/scene/compounds.h"
#include "physics/world/contact_hold.h"
#include "tests/physics/tabletop.h"

namespace prehend::physics {
namespace {

Script LiftedAndPutBack(int hand = 0) {
  Script script;
  for (const auto& [action, over_s] :
       std::initializer_list<std::pair<StepAction, double>>{{ReachStep{"object", "wrap"}, 0.8},
                                                            {TriggerStep{1}, 0.5},
                                                            {MoveStep{{0, 0, 0.1}}, 0.5},
                                                            {PlaceStep{"table"}, 0.4},
                                                            {TriggerStep{0}, 0.4}})
    script.stages.push_back({{{HandIndex(hand), action, over_s}}});
  return script;
}

/// How far anything of one snapshot is from the mirror image of the other, metres.
double Apart_m(const Snapshot& here, const Snapshot& image) {
  double apart_m = 0;
  const auto compare = [&](const Pose& a, const Pose& b) {
    apart_m = std::max(
        {apart_m, (a.p_m - InMirror(b.p_m)).norm(), a.q.angularDistance(InMirror(b.q)) * 0.1});
  };
  for (std::size_t i = 0; i < here.bodies.size(); ++i)
    compare(here.bodies[i].X_WB, image.bodies[i].X_WB);
  for (std::size_t i = 0; i < here.hands.size(); ++i) {
    compare(here.hands[i].palm.X_WB, image.hands[i].palm.X_WB);
    for (std::size_t k = 0; k < here.hands[i].X_WL.size(); ++k)
      compare(here.hands[i].X_WL[k], image.hands[i].X_WL[k]);
  }
  return apart_m;
}

TEST(MirroredWorld, LeftIsTheMirrorOfRight) {
  const Scene right = MakeScene(Tabletop{.yaw_rad = 0.3}), left = InMirror(right);
  ASSERT_TRUE(left.hands[0].model.left);
  Simulation here(right, LiftedAndPutBack()), image(left, LiftedAndPutBack());
  double apart_m = 0;
  while (here.Step()) {
    ASSERT_TRUE(image.Step());
    apart_m = std::max(apart_m, Apart_m(here.snapshot(), image.snapshot()));
    ASSERT_EQ(here.snapshot().contacts.size(), image.snapshot().contacts.size())
        << "tick " << here.snapshot().tick;
  }
  EXPECT_GT(here.snapshot().tick, 1000);
  // Without the mirrored world they are a millimetre apart when the hand opens.
  EXPECT_EQ(apart_m, 0);
}

TEST(MirroredWorld, SaysWhatTheImageDoes) {
  // A tray falls onto a corner and tips over: a compound that spins and has many contacts.
  Scene scene;
  scene.bodies.push_back({.name = "floor",
                          .shapes = {{Box{{2, 2, 0.1}}, {}}},
                          .fixed = true,
                          .X_WB = {{0, 0, -0.05}}});
  Body tray{.name = "tray", .shapes = ShapesOf(Tray{}), .mass_kg = 0.3};
  tray.X_WB = {{0.1, 0.2, 0.3}, FromRollPitchYaw({40, 20, 30})};
  scene.bodies.push_back(tray);
  const auto plain = MakeBulletWorld(scene, {});
  const auto mirrored = MirrorImageOf(MakeBulletWorld(scene, {}));
  Snapshot now, image;
  for (int tick = 0; tick < 1500; ++tick) {
    plain->Step({});
    mirrored->Step({});
    plain->Describe(now);
    mirrored->Describe(image);
    const BodyState &a = now.bodies[1], &b = image.bodies[1];
    ASSERT_EQ(a.X_WB.p_m, InMirror(b.X_WB.p_m));
    ASSERT_EQ(a.X_WB.q.coeffs(), InMirror(b.X_WB.q).coeffs());
    ASSERT_EQ(a.v_WB_m_per_s, InMirror(b.v_WB_m_per_s));
    ASSERT_EQ(a.w_WB_rad_per_s, AxisInMirror(b.w_WB_rad_per_s));
    // The point beside the centre moves as its image does: the spin has the right sense.
    const Eigen::Vector3d arm = Eigen::Vector3d::UnitX() * 0.05;
    const Eigen::Vector3d v = a.v_WB_m_per_s + a.w_WB_rad_per_s.cross(arm);
    ASSERT_LT((v - InMirror(Eigen::Vector3d(b.v_WB_m_per_s + b.w_WB_rad_per_s.cross(arm)))).norm(),
              1e-9);
    ASSERT_TRUE(std::ranges::is_sorted(image.contacts, ComesBefore));
    ASSERT_EQ(now.contacts.size(), image.contacts.size());
    for (const ContactPoint& point : now.contacts)
      ASSERT_TRUE(std::ranges::any_of(image.contacts, [&](const ContactPoint& other) {
        return point.p_W_m == InMirror(other.p_W_m) && point.nhat_BA_W == InMirror(other.nhat_BA_W);
      }));
  }
  ASSERT_TRUE(image.bodies[1].asleep);
  ASSERT_TRUE(image.resting);
  const auto before = image.resting;
  mirrored->Step({});
  mirrored->Describe(image);
  EXPECT_EQ(image.resting, before) << "shared while nothing changes";
  EXPECT_EQ(image.resting->size(), now.resting->size());
}

TEST(MirroredWorld, LinesOfSightAreMirrored) {
  Scene scene;
  scene.bodies.push_back(
      {.name = "post", .shapes = {{Box{{0.1, 0.1, 1}}, {}}}, .fixed = true, .X_WB = {{1, 0.5, 0}}});
  const auto world = MirrorImageOf(MakeBulletWorld(InMirror(scene), {}));
  world->Step({});
  EXPECT_EQ(world->Look({.from_W_m = {0, 0.5, 0}}).body, BodyIndex(0));
  EXPECT_EQ(world->Look({.from_W_m = {0, -0.5, 0}}).body, kNone);
}

TEST(MirroredWorld, TheHandThatHasMoreToDoFirstLeads) {
  const Scene right = MakeScene(Tabletop{}), left = InMirror(right);
  EXPECT_FALSE(LeftHandLeads({}, {}));
  EXPECT_FALSE(LeftHandLeads(right, LiftedAndPutBack()));
  EXPECT_TRUE(LeftHandLeads(left, LiftedAndPutBack()));
  Scene both = right;
  both.hands.push_back(left.hands[0]);
  EXPECT_FALSE(LeftHandLeads(both, {})) << "neither does more";
  EXPECT_FALSE(LeftHandLeads(both, LiftedAndPutBack(0)));
  EXPECT_TRUE(LeftHandLeads(both, LiftedAndPutBack(1)));
  Script together = LiftedAndPutBack(1);
  together.stages.insert(together.stages.begin(), {{{HandIndex(0), TriggerStep{0}, 0.1},
                                                    {HandIndex(1), TriggerStep{0}, 0.1}}});
  EXPECT_TRUE(LeftHandLeads(both, together)) << "the first stage in which they differ decides";
  std::ranges::reverse(both.hands);
  EXPECT_TRUE(LeftHandLeads(both, LiftedAndPutBack(0))) << "in whatever order they are listed";
}

}  // namespace
}  // namespace prehend::physics
