// SPDX-License-Identifier: Apache-2.0
// The joints of skeletons become a recording; what is wrong with a file, or looks wrong, is named,
// and nothing is written.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <sstream>

#include "tests/program/carried_cup.h"
#include "tests/program/program.h"

namespace prehend::house {
namespace {

constexpr const char* kMap = R"(import: 1
episode: a_cup_is_carried
unit: cm
axes: y_up
entities:
  table: {at_m: [0, 0, 0.7], fixed: true, class: Table, size_m: [2.0, 1.0, 0.04]}
  cup: {from: Mug, class: Cup, size_m: [0.08, 0.08, 0.1]}
  hand: {from: RightHand, hand: true, size_m: [0, 0, 0], ahead: [0, -1, 0]}
)";

constexpr const char* kHierarchy = R"(HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Head
  {
    OFFSET 0 70 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 10 0
    }
  }
  JOINT RightHand
  {
    OFFSET 0 0 0
    CHANNELS 3 Xposition Yposition Zposition
  }
  JOINT LeftFoot
  {
    OFFSET 0 -85 0
  }
}
ROOT Mug
{
  OFFSET 0 0 0
  CHANNELS 3 Xposition Yposition Zposition
}
MOTION
)";

/// y up, centimetres. The person stands at -20, 90, 30, turned by 90 degrees, and her hand's joint
/// moves in her frame.
std::string Values(const Row& hand, const Row& cup) {
  const double x = hand.x * 100 + 20, y = hand.z * 100 - 90, z = -hand.y * 100 - 30;
  char text[300];
  std::snprintf(text, sizeof text, "-20 90 30 0 0 90 0 0 0 %.4f %.4f %.4f %.4f %.4f %.4f\n", -z, y,
                x, cup.x * 100, cup.z * 100, -cup.y * 100);
  return text;
}

using Writer = std::function<std::string(double t_s)>;
std::string AsItIs(double t_s) { return Values(HandAt(t_s), CupAt(t_s)); }

std::string Bvh(const Writer& write = AsItIs) {
  std::string text = std::string(kHierarchy) + "Frames: 301\nFrame Time: 0.0166666667\n";
  for (int i = 0; i <= 300; ++i) text += write(i / 60.0);
  return text;
}

class ImportBvh : public testing::Test {
 protected:
  Said Import(const std::string& bvh, const std::string& map = kMap) const {
    std::filesystem::remove(folder_ / "take.jsonl");
    WriteFile(folder_ / "take.bvh", bvh);
    WriteFile(folder_ / "map.yaml", map);
    return Prehend({"import", (folder_ / "take.bvh").string(), "--map",
                    (folder_ / "map.yaml").string(), "-o", (folder_ / "take.jsonl").string()});
  }
  std::string Events() const {
    return Prehend({"episode", "resegment", (folder_ / "take.jsonl").string()}).out;
  }

  const std::filesystem::path folder_ = FreshFolder("import_bvh");
};

TEST_F(ImportBvh, JointsBecomeARecordingInWhichACupIsCarried) {
  const Said said = Import(Bvh());
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(said.err, "");
  EXPECT_TRUE(said.out.starts_with("a_cup_is_carried: 301 frames, 5.000 s\n")) << said.out;
  // As the CSV of the same story, at the times of tests/program/import_test.cc.
  const std::string events = Events();
  for (const char* event : {"picking_up", "transporting", "putting_down", "pick_and_place"})
    EXPECT_NE(events.find(event), std::string::npos) << event << "\n" << events;
  // Her turn is in the hand's frame, and 'ahead' is in it, too.
  std::istringstream take(ReadFile(folder_ / "take.jsonl"));
  std::string line;
  std::getline(take, line);
  std::getline(take, line);
  EXPECT_NE(line.find("\"ahead\":[1.0,"), std::string::npos) << line;
  const Said metres = Import(Bvh(), Replaced(kMap, "unit: cm", "metres_per_unit: 0.01"));
  EXPECT_EQ(metres.exit_code, 0) << metres.err;
  EXPECT_EQ(Events(), events);
}

struct Fault {
  const char* name;
  std::string bvh, map, says;
};

TEST_F(ImportBvh, EveryFaultIsFoundAndNamedAndNothingIsWritten) {
  const std::string good = Bvh();
  const std::string row = AsItIs(2);
  const auto spoiled = [&](const std::string& with) { return Replaced(good, row, with); };
  const std::vector<Fault> faults = {
      {"metres", good, Replaced(kMap, "unit: cm", "unit: m"),
       "map.yaml:3:7: error: from feet to head the skeleton is 155 m (155 in the file)"},
      {"millimetres", good, Replaced(kMap, "unit: cm", "unit: mm"),
       "map.yaml:3:7: error: from feet to head the skeleton is 0.155 m (155 in the file)"},
      {"z up", good, Replaced(kMap, "y_up", "z_up"),
       "map.yaml:4:7: error: the head is 1.55 m from the feet along y, and 0.00 m along z: y looks "
       "up"},
      {"another rate", good, Replaced(kMap, "unit: cm", "unit: cm\nrate_hz: 120"),
       "map.yaml:4:10: error: rate_hz: 120, but poses are 0.01667 s apart: 60 Hz"},
      {"another order of channels", Replaced(good, "Yrotation\n  JOINT Head", "W\n  JOINT Head"),
       kMap, "take.bvh:5:64: error: no channel is called 'W'"},
      {"nan", spoiled("nan" + row.substr(3)), kMap, "take.bvh:153:1: error: expected a number"},
      {"a word", spoiled("lost" + row.substr(3)), kMap,
       "take.bvh:153:1: error: expected a number, found 'lost'"},
      {"values missing", spoiled("-20 90 30\n"), kMap,
       "take.bvh:153:8: error: expected 15 values, as many as the hierarchy has channels, found 3"},
      {"cut", good.substr(0, good.size() / 2), kMap, "take.bvh:"},
      {"cut at a line", good.substr(0, good.rfind('\n', good.size() / 2) + 1), kMap,
       "take.bvh:31:9: error: Frames: 301 are announced, "},
      {"cut in the hierarchy", good.substr(0, 300), kMap, "take.bvh:"},
      {"zeros where the thing is not tracked", Bvh([](double t_s) {
         Row cup = CupAt(t_s);
         if (t_s > 2.5 && t_s < 2.58) cup = {t_s, 0, 0, 0};
         return Values(HandAt(t_s), cup);
       }),
       kMap, "map.yaml:7:15: error: 'Mug' is at exactly 0, 0, 0 in 4 of 301 poses"},
      {"a gap", Bvh([](double t_s) {
         Row cup = CupAt(t_s);
         if (t_s > 2.2 && t_s < 2.9) cup = {t_s, 0, 0, 0};
         return Values(HandAt(t_s), cup);
       }),
       std::string(kMap) + "zero_is_missing: true\n",
       "map.yaml:7:15: error: 'Mug' is not tracked for 0.700 s from 2.200 s on"},
      {"no such joint", good, Replaced(kMap, "RightHand", "RigthHand"),
       "map.yaml:8:16: error: no joint is called 'RigthHand'"},
      {"quaternions", good, Replaced(kMap, "y_up", "y_up\nquaternion_order: wxyz"),
       "map.yaml:5:19: error: BVH has angles, and no quaternions"},
      {"no frame time", Replaced(good, "Frame Time: 0.0166666667", "Frame Time: 0"), kMap,
       "take.bvh:32:13: error: Frame Time: expected a number above 0, found 0"},
      {"a time in milliseconds", Replaced(good, "Frame Time: 0.0166666667", "Frame Time: 16.67"),
       kMap, "take.bvh:32:13: error: expected a number from 0 to 1, found 16.67"},
      {"far from the table", good, Replaced(kMap, "[0, 0, 0.7]", "[5, 0, 0.7]"),
       "map.yaml:6:3: error: nothing tracked comes nearer to 'table' than 3.6"},
      {"empty", "", kMap, "take.bvh: error: the file is empty"},
      {"two joints of a name", Replaced(good, "ROOT Mug", "ROOT Head"), kMap,
       "a second joint is called 'Head'"},
  };
  for (const Fault& fault : faults) {
    const Said said = Import(fault.bvh, fault.map);
    EXPECT_EQ(said.exit_code, 2) << fault.name << "\n" << said.out << said.err;
    EXPECT_NE(said.err.find(fault.says), std::string::npos) << fault.name << "\n" << said.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "take.jsonl")) << fault.name;
  }
}

TEST_F(ImportBvh, FilesThatAreNotReadSayWhatHelps) {
  WriteFile(folder_ / "map.yaml", kMap);
  for (const char* name : {"take.fbx", "take.XLSX", "take.npy", "take.parquet", "take.pkl"}) {
    WriteFile(folder_ / name, "x");
    const Said said = Prehend(
        {"import", (folder_ / name).string(), "--map", (folder_ / "map.yaml").string(), "--check"});
    EXPECT_EQ(said.exit_code, 2);
    EXPECT_NE(
        said.err.find("are not read; CSV, BVH, MCAP, bags of ROS, HDF5, JSON, .npz and C3D are"),
        std::string::npos)
        << said.err;
  }
}

}  // namespace
}  // namespace prehend::house
