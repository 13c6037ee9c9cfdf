// SPDX-License-Identifier: Apache-2.0
#include "physics/hand/grip.h"

#include <gtest/gtest.h>

namespace prehend::physics {
namespace {

using Joints = std::vector<double>;

/// Two hinges and a style that closes the first by 1 rad, the second by 0.5 rad.
HandModel TwoFingers() {
  HandModel model;
  model.sensor_sets = {"finger", "thumb"};
  model.links.resize(2);
  model.links[1].sensor_set = 1;
  model.styles = {{.name = "squeeze", .frames = {{0, 0}, {1, 0.5}}, .effort = {1, 1}}};
  return model;
}

TEST(GripTest, FollowsTheTriggerWhileNothingIsInTheWay) {
  const HandModel model = TwoFingers();
  Grip grip;
  EXPECT_EQ(grip.Targets(model, model.styles[0], 0.5, {0.5, 0.25}), (Joints{0.5, 0.25}));
  EXPECT_EQ(grip.Targets(model, model.styles[0], 1, {1, 0.5}), (Joints{1, 0.5}));
  EXPECT_EQ(grip.Targets(model, model.styles[0], 0.5, {1, 0.5}), (Joints{0.5, 0.25}));
}

TEST(GripTest, NoDigitOpensWhileAnotherPresses) {
  const HandModel model = TwoFingers();
  Grip grip;
  // The first is held back at 0.6 by what the hand holds, the second has got to its place.
  grip.Targets(model, model.styles[0], 1, {0.6, 0.5});
  EXPECT_EQ(grip.Targets(model, model.styles[0], 0.8, {0.6, 0.5}), (Joints{0.8, 0.5}));
  EXPECT_EQ(grip.Targets(model, model.styles[0], 0.62, {0.6, 0.5}), (Joints{0.62, 0.5}));
  EXPECT_EQ(grip.Targets(model, model.styles[0], 0.6, {0.6, 0.5}), (Joints{0.6, 0.3}));
  // A trigger that stays goes on as before; one that rises closes at once.
  EXPECT_EQ(grip.Targets(model, model.styles[0], 0.6, {0.6, 0.3}), (Joints{0.6, 0.3}));
  EXPECT_EQ(grip.Targets(model, model.styles[0], 0.9, {0.6, 0.3}), (Joints{0.9, 0.45}));
}

/// Both fingers closed, the first held back at 0.4 by what stands.
Grip Closed(const HandModel& model) {
  Grip grip;
  grip.Targets(model, model.styles[0], 1, {0.4, 0.5});
  return grip;
}

void ExpectTargets(const Joints& targets, const Joints& right) {
  ASSERT_EQ(targets.size(), right.size());
  for (std::size_t i = 0; i < right.size(); ++i) EXPECT_NEAR(targets[i], right[i], 1e-12) << i;
}

TEST(GripTest, WhatLetsGoOpensFromWhereItsJointsStoppedAtOnce) {
  const HandModel model = TwoFingers();
  Grip grip = Closed(model);
  ExpectTargets(grip.Targets(model, model.styles[0], 0.9, {0.4, 0.5}, 0), {0.3, 0.45});
  ExpectTargets(grip.Targets(model, model.styles[0], 0.7, {0.3, 0.45}, 0), {0.1, 0.35});
  // What has got to where it is to be stays there.
  ExpectTargets(grip.Targets(model, model.styles[0], 0.5, {0.1, 0.35}, 0), {0, 0.25});
  ExpectTargets(grip.Targets(model, model.styles[0], 0, {0, 0.25}, 0), {0, 0});
  // A trigger that rises closes as if nothing had been.
  ExpectTargets(grip.Targets(model, model.styles[0], 0.5, {0, 0}), {0.5, 0.25});
}

TEST(GripTest, JointThatIsHeldBackByLittleOpensAtOnceToo) {
  const HandModel model = TwoFingers();
  const Joints held = {0.995, 0.5};  // the first by 0.005 rad, less than joints lag when they move
  Grip grip;
  grip.Targets(model, model.styles[0], 1, held);
  grip.Targets(model, model.styles[0], 1, held);
  ExpectTargets(grip.Targets(model, model.styles[0], 0.999, held, 0), {0.994, 0.4995});
  Grip at_once;
  at_once.Targets(model, model.styles[0], 1, held);
  ExpectTargets(at_once.Targets(model, model.styles[0], 0.999, held, 0), {0.999, 0.4995});
}

TEST(GripTest, WhatLetsGoAndStopsHalfWayOpensNoFartherThanItsTrigger) {
  const HandModel model = TwoFingers();
  Grip grip = Closed(model);
  ExpectTargets(grip.Targets(model, model.styles[0], 0.9, {0.4, 0.5}, 0.2), {0.3, 0.45});
  ExpectTargets(grip.Targets(model, model.styles[0], 0.6, {0.3, 0.45}, 0.2), {0.2, 0.3});
  ExpectTargets(grip.Targets(model, model.styles[0], 0.2, {0.2, 0.3}, 0.2), {0.2, 0.1});
  // A second opening begins anew.
  ExpectTargets(grip.Targets(model, model.styles[0], 0.1, {0.2, 0.1}, 0), {0.1, 0.05});
}

TEST(GripTest, GripThatIsOnlyLoosenedPressesOn) {
  const HandModel model = TwoFingers();
  Grip grip = Closed(model);
  EXPECT_EQ(grip.Targets(model, model.styles[0], 0.9, {0.4, 0.5}, 0.6), (Joints{0.9, 0.5}));
}

TEST(GripTest, JointThatIsBentBackBeyondItsOpenPlaceDoesNotPressWhileTheHandOpens) {
  HandModel model = TwoFingers();
  model.styles[0].frames = {{0.3, 0}, {0.1, 0.5}};
  Grip grip;
  grip.Targets(model, model.styles[0], 1, {0, 0.5});
  ExpectTargets(grip.Targets(model, model.styles[0], 0.9, {0, 0.5}, 0), {0.02, 0.45});
  ExpectTargets(grip.Targets(model, model.styles[0], 0.5, {0, 0.45}, 0), {0.1, 0.25});
  ExpectTargets(grip.Targets(model, model.styles[0], 0, {0, 0.25}, 0), {0.3, 0});
}

}  // namespace
}  // namespace prehend::physics
