// SPDX-License-Identifier: Apache-2.0
// Bags of ROS 1 become the same recording whatever their chunks are; what
// is wrong with them is named, and nothing is written.
#include <gtest/gtest.h>

#include <functional>

#include "tests/program/bag_writer.h"
#include "tests/program/carried_cup.h"
#include "tests/program/mcap_writer.h"
#include "tests/program/program.h"

namespace prehend::house {
namespace {

constexpr const char* kMap = R"(import: 1
episode: a_cup_is_carried
unit: m
axes: z_up
entities:
  table: {at_m: [0, 0, 0.7], fixed: true, class: Table, size_m: [2.0, 1.0, 0.04]}
  cup: {from: mug, class: Cup, size_m: [0.08, 0.08, 0.1]}
  hand: {from: /tracker/glove, hand: true, size_m: [0, 0, 0]}
)";
constexpr std::uint64_t kEpoch_ns = 1'700'000'000'000'000'000;

/// Five seconds at 60 Hz: the cup as a frame of tf, the hand as a topic of poses; `compression` of
/// its chunks, "": it has none.
std::string Bag(const std::string& compression = "none",
                const std::function<std::string(int, std::string)>& spoil = {}) {
  std::string bag = BagHead();
  std::string records = BagConnection(0, "/tf", "tf2_msgs/TFMessage") +
                        BagConnection(1, "/tracker/glove", "geometry_msgs/PoseStamped");
  for (int i = 0; i <= 300; ++i) {
    const std::uint64_t ns = kEpoch_ns + static_cast<std::uint64_t>(i) * 1'000'000'000 / 60;
    const Row cup = CupAt(i / 60.0), hand = HandAt(i / 60.0);
    Cdr transforms(Cdr::Kind::kRos1), pose(Cdr::Kind::kRos1);
    transforms.U32(1).Header(ns, "world").Text("mug").Pose({cup.x, cup.y, cup.z});
    pose.Header(ns, "world").Pose({hand.x, hand.y, hand.z});
    std::string data = transforms.Bytes();
    if (spoil) data = spoil(i, data);
    records += BagMessage(0, ns, data) + BagMessage(1, ns, pose.Bytes());
    if (i % 100 != 0) continue;
    bag += BagChunk(records, compression);
    bag += BagIndex(0);
    records.clear();
  }
  return bag;
}

std::string FirstReplaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

class ImportBag : public testing::Test {
 protected:
  Said Import(const std::string& bytes) const {
    std::filesystem::remove(folder_ / "take.jsonl");
    WriteFile(folder_ / "run.bag", bytes);
    WriteFile(folder_ / "map.yaml", kMap);
    return Prehend({"import", (folder_ / "run.bag").string(), "--map",
                    (folder_ / "map.yaml").string(), "-o", (folder_ / "take.jsonl").string()});
  }

  const std::filesystem::path folder_ = FreshFolder("import_bag");
};

TEST_F(ImportBag, ChunksOfAnyKindHaveTheSamePoses) {
  std::string first;
  for (const char* compression : {"none", "lz4", ""}) {
    const Said said = Import(Bag(compression));
    EXPECT_EQ(said.exit_code, 0) << said.err;
    EXPECT_EQ(said.err, "");
    const std::string recording = ReadFile(folder_ / "take.jsonl");
    if (first.empty()) first = recording;
    EXPECT_EQ(recording, first) << compression;
  }
  const std::string events =
      Prehend({"episode", "resegment", (folder_ / "take.jsonl").string()}).out;
  for (const char* event : {"picking_up", "transporting", "putting_down", "pick_and_place"})
    EXPECT_NE(events.find(event), std::string::npos) << event << "\n" << events;
}

TEST_F(ImportBag, EveryFaultIsFoundAndNamedAndNothingIsWritten) {
  const std::string good = Bag(), lz4 = Bag("lz4");
  std::string flipped = lz4;
  const std::size_t size_at = flipped.find("size=") + 5;
  flipped[size_at] = static_cast<char>(flipped[size_at] ^ 1);
  struct Fault {
    const char* name;
    std::string bytes, says;
  };
  const std::vector<Fault> faults = {
      {"MCAP",
       "\x89"
       "MCAP0\r\n 0000000000",
       "run.bag: error: it is an MCAP file: call it .mcap"},
      {"no bag", "x" + good, "it is no bag of ROS 1, version 2.0"},
      {"an older bag", FirstReplaced(good, "V2.0", "V1.2"), "it is no bag of ROS 1, version 2.0"},
      {"cut off", good.substr(0, good.size() / 2), "the file is cut off"},
      {"cut off in a length", good.substr(0, 15), "the file is cut off"},
      {"another size", flipped, "a damaged chunk"},
      {"bz2", FirstReplaced(good, "compression=none", "compression=bzip"), "'rosbag decompress'"},
      {"no time", FirstReplaced(good, "time=", "tine="), "a record without a whole 'time'"},
      {"no connection", FirstReplaced(good, "conn=", "comn="), "a record without a whole 'conn'"},
      {"no field", FirstReplaced(good, "op=\x05", "op:\x05"), "its header is no list of fields"},
      {"a message that is cut",
       Bag("none", [](int i, std::string data) { return i == 90 ? data.substr(0, 40) : data; }),
       "a message of '/tf', logged at 1700000001.500000 s"},
      {"a name that is not there", FirstReplaced(good, "/tracker/glove", "/tracker/gl0ve"),
       "map.yaml:8:16: error: no topic of poses, no body and no frame is called "
       "'/tracker/glove'"}};
  for (const Fault& fault : faults) {
    const Said said = Import(fault.bytes);
    EXPECT_EQ(said.exit_code, 2) << fault.name << "\n" << said.out << said.err;
    EXPECT_NE(said.err.find(fault.says), std::string::npos) << fault.name << "\n" << said.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "take.jsonl")) << fault.name;
  }
}

TEST_F(ImportBag, TopicsOfTypesThatAreNotReadAreNamedWithTheirTypes) {
  std::string records = BagConnection(0, "/markers", "vicon_bridge/Markers") +
                        BagConnection(1, "/plan", "nav_msgs/Path");
  const Said said = Import(BagHead() + records + BagMessage(0, kEpoch_ns, "some bytes"));
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(
      said.err.find(
          "map.yaml:7:15: error: the file has no topic of a type that is read, so no 'mug'; it "
          "has '/markers': vicon_bridge/Markers (ros1), whose definition is not in the file, "
          "'/plan': nav_msgs/Path (ros1), whose definition is not in the file\n"),
      std::string::npos)
      << said.err;
  EXPECT_NE(
      said.err.find("hint: read are messages of ROS with a definition in which there is a pose"),
      std::string::npos)
      << said.err;
  EXPECT_EQ(said.err.find("/tracker"), std::string::npos) << "said once\n" << said.err;
}

}  // namespace
}  // namespace prehend::house
