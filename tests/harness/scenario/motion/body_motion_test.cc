// SPDX-License-Identifier: Apache-2.0
// From a BVH file to how a person holds herself.
#include "harness/scenario/motion/body_motion.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <map>

#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

using Eigen::Vector3d;
using physics::Posture;

/// A person of sticks: arms hang, legs of 40 + 40. Names of the parts that have one.
struct Names {
  std::string head = "Head", arm = "Arm", forearm = "ForeArm", hand = "Hand", thigh = "UpLeg",
              shin = "Leg", foot = "Foot";
  std::string (*sided)(bool, const std::string&) = [](bool right, const std::string& name) {
    return (right ? "Right" : "Left") + name;
  };
};

std::string Joint(const std::string& name, const std::string& offset, const std::string& inside) {
  return "JOINT " + name + "\n{\nOFFSET " + offset + "\nCHANNELS 1 Xrotation\n" + inside + "}\n";
}

std::string Person(const Names& names) {
  const std::string end = "End Site\n{\nOFFSET 0 -5 0\n}\n";
  std::string text =
      "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 4 Xposition Yposition Zposition Yrotation\n";
  text += Joint(names.head, "0 60 0", end);
  for (const bool right : {true, false}) {
    const std::string x = right ? "-" : "";
    text += Joint(names.sided(right, names.arm), x + "20 50 0",
                  Joint(names.sided(right, names.forearm), "0 -30 0",
                        Joint(names.sided(right, names.hand), "0 -25 0", end)));
    text += Joint(names.sided(right, names.thigh), x + "10 0 0",
                  Joint(names.sided(right, names.shin), "0 -40 0",
                        Joint(names.sided(right, names.foot), "0 -40 0", end)));
  }
  return text + "}\n";
}

/// Channels: hips x y z ry, head, then of each side arm, forearm, hand, thigh, shin, foot.
std::string Rows(const std::string& a, const std::string& b) {
  return "MOTION\nFrames: 2\nFrame Time: 0.1\n" + a + "\n" + b + "\n";
}
const std::string kStill = " 0  0 0 0 0 0 0  0 0 0 0 0 0";

Result<BodyTrack> ReadBody(const std::string& text) {
  const std::string path = testing::TempDir() + "body_track_" + std::to_string(getpid()) + ".bvh";
  std::ofstream(path, std::ios::binary) << text;
  return ReadBodyTrack(path);
}

TEST(BodyTrackTest, AxesBecomeOurs) {
  const auto read = ReadBody(Person({}) + Rows("1 90 3 0" + kStill, "1 90 3 90" + kStill));
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  const BodySample &a = read->samples[0], &b = read->samples[1];
  EXPECT_DOUBLE_EQ(read->leg_units, 80);
  EXPECT_DOUBLE_EQ(b.t_s, 0.1);
  EXPECT_LT((a.posture.hips_W_m - Vector3d(3, 1, 90)).norm(), 1e-9);
  EXPECT_LT((a.posture.directions_W[Posture::kTrunk] - Vector3d::UnitZ()).norm(), 1e-9);
  EXPECT_LT((a.posture.directions_W[Posture::kFace] - Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_LT((a.posture.directions_W[Posture::kAcrossHips] - Vector3d::UnitY()).norm(), 1e-9);
  EXPECT_LT((a.posture.directions_W[Posture::kHand] + Vector3d::UnitZ()).norm(), 1e-9);
  // A turn by 90 degrees about y takes z to x, which is our left.
  EXPECT_LT((b.posture.directions_W[Posture::kFace] - Vector3d::UnitY()).norm(), 1e-9);
  EXPECT_LT((b.points[3] - Vector3d(3 + 10, 1, 10)).norm(), 1e-9);  // her right ankle
}

TEST(BodyTrackTest, ALegThatIsBentForwards) {
  const auto read =
      ReadBody(Person({}) + Rows("0 90 0 0" + kStill, "0 90 0 0 0  0 0 0 -90 90 0  0 0 0 0 0 0"));
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  const auto& directions = read->samples[1].posture.directions_W;
  EXPECT_LT((directions[Posture::kThigh] - Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_LT((directions[Posture::kShank] + Vector3d::UnitZ()).norm(), 1e-9);
  EXPECT_LT((directions[Posture::kFoot] - Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_LT((directions[Posture::kThigh + 1] + Vector3d::UnitZ()).norm(), 1e-9);
}

TEST(BodyTrackTest, NamesOfManyConventions) {
  Names mixamo;
  mixamo.head = "mixamorig:Head";
  mixamo.sided = [](bool right, const std::string& name) {
    return std::string("mixamorig:") + (right ? "Right" : "Left") + name;
  };
  Names blender{
      "head",    "upper_arm",
      "forearm", "hand",
      "thigh",   "shin",
      "foot",    [](bool right, const std::string& name) { return name + (right ? ".R" : ".L"); }};
  Names biovision{"Head", "Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle", Names{}.sided};
  for (const Names& names : {mixamo, blender, biovision}) {
    const auto read = ReadBody(Person(names) + Rows("0 90 0 0" + kStill, "0 90 0 0" + kStill));
    EXPECT_TRUE(read) << Brief(ErrorsOf(read));
  }
}

TEST(BodyTrackTest, SaysWhichJointIsMissing) {
  Names names;
  names.shin = "Tail";
  const std::string said =
      Brief(ErrorsOf(ReadBody(Person(names) + Rows("0 90 0 0" + kStill, "0 90 0 0" + kStill))));
  EXPECT_NE(said.find(":2:6: no joint is a person's right knee: expected 'right' with one of leg, "
                      "lowerleg, lowleg, shin, calf, knee | like "),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("no joint is a person's left knee"), std::string::npos) << said;
  EXPECT_EQ(said.find("hip"), std::string::npos) << said;
}

TEST(BodyTrackTest, BonesWithoutLength) {
  std::string flat = Person({});
  for (std::size_t at; (at = flat.find("-40")) != std::string::npos;) flat.replace(at, 3, "0");
  const std::string said =
      Brief(ErrorsOf(ReadBody(flat + Rows("0 90 0 0" + kStill, "0 90 0 0" + kStill))));
  EXPECT_NE(said.find("the offsets put both hips, or hips and ankles, at the same point"),
            std::string::npos)
      << said;
}

}  // namespace
}  // namespace prehend::scenario
