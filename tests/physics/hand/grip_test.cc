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

}  // namespace
}  // namespace prehend::physics
