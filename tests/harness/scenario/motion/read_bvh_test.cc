// SPDX-License-Identifier: Apache-2.0
// BVH files: what is read, and every complaint.
#include "harness/scenario/motion/read_bvh.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

const std::string kArm =
    "HIERARCHY\n"
    "ROOT Hips\n"
    "{\n"
    "  OFFSET 0 0 0\n"
    "  CHANNELS 2 Yposition Zrotation\n"
    "  JOINT Upper Arm {\n"
    "    OFFSET 1.5 -2 0\n"
    "    CHANNELS 1 Xrotation\n"
    "    End Site\n"
    "    {\n"
    "      OFFSET 0 3 0\n"
    "    }\n"
    "  }\n"
    "}\n"
    "MOTION\n"
    "Frames: 2\n"
    "Frame   Time: 0.25\n"
    "1 2 3\n"
    "\n"
    "4 5 -6e-1\n";

Result<BvhFile> ReadArm(const std::string& text) {
  const std::string path = testing::TempDir() + "motion_bvh_" + std::to_string(getpid()) + ".bvh";
  std::ofstream(path, std::ios::binary) << text;
  return ReadBvh(path);
}

/// With `what` replaced; where and what is said.
std::string ErrorsWith(const std::string& what, const std::string& by) {
  std::string text = kArm;
  text.replace(text.find(what), what.size(), by);
  std::string said = Brief(ErrorsOf(ReadArm(text)));
  const std::string path = testing::TempDir() + "motion_bvh_" + std::to_string(getpid()) + ".bvh:";
  for (std::size_t at; (at = said.find(path)) != std::string::npos;) said.erase(at, path.size());
  return said;
}

TEST(MotionBvhTest, ReadsHierarchyAndRows) {
  const auto read = ReadArm(kArm);
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  const BvhFile& bvh = *read;
  ASSERT_EQ(bvh.joints.size(), 3u);
  EXPECT_EQ(bvh.joints[1].name, "Upper Arm");
  EXPECT_EQ(bvh.joints[1].parent, 0);
  EXPECT_EQ(bvh.joints[1].offset, Eigen::Vector3d(1.5, -2, 0));
  EXPECT_EQ(bvh.joints[1].first_value, 2u);
  EXPECT_TRUE(bvh.joints[2].name.empty());
  ASSERT_EQ(bvh.joints[0].channels.size(), 2u);
  EXPECT_FALSE(bvh.joints[0].channels[0].turns);
  EXPECT_EQ(bvh.joints[0].channels[0].axis, 1);
  EXPECT_TRUE(bvh.joints[0].channels[1].turns);
  EXPECT_DOUBLE_EQ(bvh.frame_time_s, 0.25);
  EXPECT_EQ(bvh.rows[1], (std::vector<double>{4, 5, -0.6}));
  EXPECT_EQ(bvh.places[1].line, 20);
}

TEST(MotionBvhTest, SaysWhatIsWrongAndWhere) {
  struct Bad {
    std::string what, by, said;
  };
  const Bad bads[] = {
      {"HIERARCHY", "HIERARHCY", "1:1: expected 'HIERARCHY', found 'HIERARHCY'\n"},
      {"ROOT Hips", "JOINT Hips", "2:1: expected 'ROOT' and a name, found 'JOINT Hips'\n"},
      {"Zrotation", "Zrotatoin",
       "5:24: no channel is called 'Zrotatoin' | did you mean 'Zrotation'?\n"},
      {"Yposition Zrotation", "Zrotation Zrotation", "5:24: 'Zrotation' is given twice\n"},
      {"CHANNELS 2", "CHANNELS 3", "5:12: CHANNELS: 3 are announced, 2 follow\n"},
      {"OFFSET 1.5 -2 0", "OFFSET 1.5 -2",
       "7:5: expected 'OFFSET' and three numbers, found 'OFFSET 1.5 -2'\n"},
      {"1.5 -2 0", "1.5 -2 nan", "7:19: expected a number, found 'nan'\n"},
      {"Upper Arm", "Hips", "6:9: a second joint is called 'Hips'\n"},
      {"    }\n  }\n}\n", "    }\n  }\n",
       "14:1: expected 'OFFSET', 'CHANNELS', 'JOINT', 'End Site' or '}', found 'MOTION'\n"},
      {"Frames: 2", "Frames: 1", "16:9: expected a number from 2 to 20000, found 1\n"},
      {"Frames: 2", "Frames: 3", "16:9: Frames: 3 are announced, 2 follow\n"},
      {"Frames: 2", "Frames: 2.5", "16:9: Frames: expected a whole number, found 2.5\n"},
      {"Time: 0.25", "Time: 0", "17:15: Frame Time: expected a number above 0, found 0\n"},
      {"Time: 0.25", "Time: -1", "17:15: expected a number from 0 to 1, found -1\n"},
      {"1 2 3", "1 2",
       "18:3: expected 3 values, as many as the hierarchy has channels, found 2 | every frame is "
       "one line\n"},
      {"1 2 3", "1 inf 3", "18:3: expected a number, found 'inf'\n"},
      {"1 2 3", "1 2e9 3", "18:3: expected a number from -1000000 to 1000000, found 2e9\n"},
  };
  for (const Bad& bad : bads) EXPECT_EQ(ErrorsWith(bad.what, bad.by), bad.said) << bad.by;
}

TEST(MotionBvhTest, TheEndComesTooEarly) {
  EXPECT_NE(Brief(ErrorsOf(ReadArm("HIERARCHY\nROOT Hips\n{\n")))
                .find("expected '}', found the end of the file"),
            std::string::npos);
  EXPECT_NE(Brief(ErrorsOf(ReadArm("HIERARCHY\n")))
                .find("expected 'ROOT' and a name, found the end of the file"),
            std::string::npos);
}

TEST(MotionBvhTest, DepthAndSizeAreLimited) {
  std::string deep = "HIERARCHY\nROOT j\n{\n";
  for (int i = 0; i < 70; ++i) deep += "JOINT j" + std::to_string(i) + "\n{\n";
  EXPECT_NE(Brief(ErrorsOf(ReadArm(deep))).find("more than 256 joints, or deeper than 64"),
            std::string::npos);
}

}  // namespace
}  // namespace prehend::scenario
