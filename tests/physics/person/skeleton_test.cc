// SPDX-License-Identifier: Apache-2.0
#include "physics/person/skeleton.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/physics/library_hand.h"

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

Person Anna() { return {.name = "anna", .has_body = true, .height_m = 1.8, .X_WS = {{1, 2, 0}}}; }

BodyTargets Upright(const Person& person) { return Standing({}, person); }

std::vector<std::string> NamesOf(const std::vector<Body>& parts) {
  std::vector<std::string> names;
  for (const Body& part : parts) names.push_back(part.name);
  return names;
}

/// The pose of a part.
Pose PlaceOf(const Person& person, const BodyTargets& targets, const std::string& name) {
  const std::vector<std::string> names = NamesOf(PartsOf(person));
  const auto found = std::find(names.begin(), names.end(), name);
  EXPECT_NE(found, names.end()) << name;
  return PlacesOf(person, targets, {})[static_cast<std::size_t>(found - names.begin())];
}

double LengthOf(const Person& person, const std::string& name) {
  for (const Body& part : PartsOf(person)) {
    if (part.name == name) return std::get<Capsule>(part.shapes.front().shape).length_m;
  }
  return 0;
}

TEST(SkeletonTest, AHeadIsOnePart) {
  Person person = Anna();
  person.has_body = false;
  EXPECT_EQ(NamesOf(PartsOf(person)), std::vector<std::string>{"anna"});
}

TEST(SkeletonTest, ABodyIsWholeAndAHandOfTheSceneIsNotDoubled) {
  Person person = Anna();
  EXPECT_EQ(PartsOf(person).size(), 19u);
  person.right_hand = HandIndex(0);
  const std::vector<std::string> names = NamesOf(PartsOf(person));
  EXPECT_EQ(names.size(), 18u);
  EXPECT_EQ(std::count(names.begin(), names.end(), "anna_right_hand"), 0);
  EXPECT_EQ(std::count(names.begin(), names.end(), "anna_left_hand"), 1);
  for (const Body& part : PartsOf(person)) EXPECT_TRUE(part.kinematic && !part.fixed) << part.name;
}

TEST(SkeletonTest, StandsOnTheFloorAsTallAsSheIs) {
  const Person person = Anna();
  const std::vector<Body> parts = PartsOf(person);
  const std::vector<Pose> places = PlacesOf(person, Upright(person), {});
  double lowest = 9, highest = -9;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto& capsule = std::get<Capsule>(parts[i].shapes.front().shape);
    for (const double end : {-1.0, 1.0}) {
      const double z = (places[i] * Vector3d(0, 0, end * capsule.length_m / 2)).z();
      lowest = std::min(lowest, z - capsule.radius_m);
      highest = std::max(highest, z + capsule.radius_m);
    }
  }
  EXPECT_NEAR(lowest, 0, 0.002);
  EXPECT_NEAR(highest, 1.8, 0.02);
}

TEST(SkeletonTest, RightIsRight) {
  const Person person = Anna();  // she faces x
  const BodyTargets targets = Upright(person);
  EXPECT_LT(PlaceOf(person, targets, "anna_right_thigh").p_m.y(), 2);
  EXPECT_GT(PlaceOf(person, targets, "anna_left_forearm").p_m.y(), 2);
  EXPECT_GT(PlaceOf(person, targets, "anna_left_toes").p_m.x(), 1);
}

TEST(SkeletonTest, TheWristGoesWhereItIsSent) {
  const Person person = Anna();
  BodyTargets targets = Upright(person);
  const Vector3d there(1.35, 1.8, 1.2);
  targets.limbs[0] = {LimbEnd::kRightWrist, there};
  EXPECT_LT((PlaceOf(LimbEnd::kRightWrist, person, targets) - there).norm(), 1e-9);
  // Bones keep their lengths, and the elbow hangs below the line from shoulder to wrist.
  const Vector3d elbow = PlaceOf(LimbEnd::kRightElbow, person, targets);
  EXPECT_NEAR((elbow - there).norm(), LengthOf(person, "anna_right_forearm"), 1e-9);
  EXPECT_LT(elbow.z(), there.z());
}

TEST(SkeletonTest, ALimbThatCannotReachIsStretched) {
  const Person person = Anna();
  BodyTargets targets = Upright(person);
  targets.limbs[2] = {LimbEnd::kRightFoot, Vector3d(9, 1.9, 0.3)};
  const Vector3d foot = PlaceOf(LimbEnd::kRightFoot, person, targets);
  EXPECT_NEAR(foot.x(), 1.75, 0.2);
  const Pose thigh = PlaceOf(person, targets, "anna_right_thigh"),
             shank = PlaceOf(person, targets, "anna_right_shank");
  EXPECT_GT((thigh.q * Vector3d::UnitZ()).dot(shank.q * Vector3d::UnitZ()), 0.99);
}

TEST(SkeletonTest, TheElbowGoesWhereItIsSentAndTheForearmIsFoldedUp) {
  const Person person = Anna();
  BodyTargets targets = Upright(person);
  const Vector3d shoulder = RestOf(0, person, targets).p_W_m;  // roughly below it
  targets.limbs[0] = {LimbEnd::kRightElbow, shoulder + Vector3d(0.3, 0, 0.3)};
  const Vector3d elbow = PlaceOf(LimbEnd::kRightElbow, person, targets);
  EXPECT_GT(elbow.x(), 1.1);
  EXPECT_GT(PlaceOf(LimbEnd::kRightWrist, person, targets).z(), elbow.z());
}

TEST(SkeletonTest, LeaningBringsTheHeadForwardAndLeavesTheFeet) {
  const Person person = Anna();
  const BodyTargets upright = Upright(person);
  BodyTargets leaning = upright;
  leaning.lean_rad = 0.5;
  EXPECT_GT(NeckTop(person, leaning).x(), NeckTop(person, upright).x() + 0.2);
  EXPECT_LT(NeckTop(person, leaning).z(), NeckTop(person, upright).z());
  EXPECT_EQ(RestOf(2, person, leaning).p_W_m, RestOf(2, person, upright).p_W_m);
}

TEST(SkeletonTest, SwayingHipsLeaveTheFeetAndNearlyTheShoulders) {
  const Person person = Anna();
  const BodyTargets upright = Upright(person);
  BodyTargets swayed = upright;
  swayed.sway_m = {0, 0.2};  // to her left, which is y
  const auto moved = [&](const char* part) -> Vector3d {
    return PlaceOf(person, swayed, part).p_m - PlaceOf(person, upright, part).p_m;
  };
  EXPECT_NEAR(moved("anna_pelvis").y(), 0.2, 1e-9);
  EXPECT_LT(moved("anna_pelvis").z(), -0.01);  // legs have their length
  // No leg is ever quite stretched: standing, the ankles are a millimetre higher.
  EXPECT_LT(moved("anna_right_foot").norm(), 0.002);
  EXPECT_LT(moved("anna_left_foot").norm(), 0.002);
  EXPECT_LT(std::abs(moved("anna_neck").y()), 0.02);
}

TEST(SkeletonTest, APostureGivesThePartsOfItsTargets) {
  const Person person = Anna();
  BodyTargets targets = Upright(person);
  targets.lean_rad = 0.4;
  targets.limbs[0] = {LimbEnd::kRightWrist, Vector3d(1.35, 1.8, 1.2)};
  targets.limbs[3] = {LimbEnd::kLeftFoot, Vector3d(1.3, 2.1, 0.4)};
  targets.X_WHead = HeadToward(person, NeckTop(person, targets), {0.9, 0.3, -0.2});
  BodyTargets as_posture = Upright(person);
  as_posture.posture = PostureOf(person, targets);
  as_posture.X_WHead = HeadOfPosture(person, as_posture);
  const std::vector<Pose> places = PlacesOf(person, targets, {}),
                          again = PlacesOf(person, as_posture, {});
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_LT((places[i].p_m - again[i].p_m).norm(), 1e-9) << i;
}

TEST(SkeletonTest, APostureSuitsATallerPerson) {
  Person person = Anna();
  BodyTargets targets = Upright(person);
  targets.posture = PostureOf(person, targets);
  person.height_m = 2.1;
  EXPECT_NEAR((PlaceOf(LimbEnd::kRightElbow, person, targets) -
               PlaceOf(LimbEnd::kRightWrist, person, targets))
                  .norm(),
              LengthOf(person, "anna_right_forearm"), 1e-9);
}

TEST(SkeletonTest, PartsOfLimbsAreTheOnesOfTheirNames) {
  Person person = Anna();
  for (const int hand : {-1, 0}) {
    person.right_hand = HandIndex(hand);
    const std::vector<std::string> names = NamesOf(PartsOf(person));
    const std::string words[4] = {"_right_", "_left_", "_right_", "_left_"};
    int covered = 5;  // head and trunk
    for (int limb = 0; limb < 4; ++limb) {
      const PartRange range = PartsOfLimb(person, limb);
      EXPECT_EQ(range.begin, covered);
      for (int i = range.begin; i < range.end; ++i) {
        const std::string& name = names[static_cast<std::size_t>(i)];
        EXPECT_NE(name.find(words[limb]), std::string::npos) << name;
        const bool of_arm =
            name.find("arm") != std::string::npos || name.find("hand") != std::string::npos;
        EXPECT_EQ(of_arm, limb < 2) << name;
      }
      covered = range.end;
    }
    EXPECT_EQ(static_cast<std::size_t>(covered), names.size());
  }
}

TEST(SkeletonTest, ArmsFollowTheHandsOfTheScene) {
  Scene scene;
  scene.hands.push_back(
      {.name = "hand", .model = LibraryHand("human_right"), .X_WH = {{1.4, 1.8, 1.1}}});
  Person person = Anna();
  person.right_hand = HandIndex(0);
  const Vector3d wrist = scene.hands[0].X_WH * WristInHand(person, scene.hands[0].model);
  EXPECT_LT((PlaceOf(LimbEnd::kRightWrist, person, Standing(scene, person)) - wrist).norm(), 1e-9);
}

TEST(SkeletonTest, PartsDoNotSpinWhenALimbSwingsOverhead) {
  const Person person = Anna();
  BodyTargets targets = Upright(person);
  std::vector<Pose> before = PlacesOf(person, targets, {});
  const Vector3d shoulder(1, 2 - 0.129 * 1.8, 0.818 * 1.8);
  double most = 0;
  for (int i = 0; i <= 400; ++i) {
    const double angle = i * 0.01;
    targets.limbs[0].p_W_m = shoulder + 0.55 * Vector3d(std::sin(angle), 0, -std::cos(angle));
    const std::vector<Pose> now = PlacesOf(person, targets, before);
    if (i > 0) {
      for (std::size_t p = 0; p < now.size(); ++p)
        most = std::max(most, RotationVector(now[p].q * before[p].q.conjugate()).norm());
    }
    before = now;
  }
  EXPECT_LT(most, 0.05);
}

TEST(SkeletonTest, TheHeadNodsAndTurnsWithoutRolling) {
  const Person person = Anna();
  const Pose head = HeadToward(person, {0, 0, 1.5}, Vector3d(1, 1, -1).normalized());
  EXPECT_LT((head.q * Vector3d::UnitX() - Vector3d(1, 1, -1).normalized()).norm(), 1e-9);
  EXPECT_NEAR((head.q * Vector3d::UnitY()).z(), 0, 1e-9);
  EXPECT_NEAR(EyesOf(person, head).z(), 1.5 + 0.07, 0.06);
}

}  // namespace
}  // namespace prehend::physics
