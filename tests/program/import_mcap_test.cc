// SPDX-License-Identifier: Apache-2.0
// MCAP files of every kind that is read become the same recording; what is wrong with them is
// named, and nothing is written.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "tests/program/carried_cup.h"
#include "tests/program/mcap_writer.h"
#include "tests/program/program.h"

namespace prehend::house {
namespace {

using Chunks = McapWriter::Chunks;

constexpr const char* kMap = R"(import: 1
episode: a_cup_is_carried
unit: m
axes: z_up
entities:
  table: {at_m: [0, 0, 0.7], fixed: true, class: Table, size_m: [2.0, 1.0, 0.04]}
  cup: {from: mug, class: Cup, size_m: [0.08, 0.08, 0.1]}
  hand: {from: glove, hand: true, size_m: [0, 0, 0]}
)";
constexpr std::uint64_t kEpoch_ns = 1'700'000'000'000'000'000;

std::uint64_t TimeOf(int frame) {
  return kEpoch_ns + static_cast<std::uint64_t>(frame) * 1'000'000'000 / 60;
}

/// What a message says of a body; it may be changed.
using Change = std::function<Row(const std::string& body, Row row)>;
Row AsItIs(const std::string&, Row row) { return row; }

std::array<double, 3> Place(const Row& row) { return {row.x, row.y, row.z}; }

/// Five seconds at 60 Hz as transforms of tf, both bodies in a message.
std::string Transforms(Chunks chunks = Chunks::kZstd, Cdr::Kind kind = Cdr::Kind::kLittle,
                       const Change& change = AsItIs,
                       const std::function<std::string(int, std::string)>& spoil = {}) {
  McapWriter writer(chunks);
  const bool ros1 = kind == Cdr::Kind::kRos1;
  const auto tf = writer.Channel("/tf", ros1 ? "ros1" : "cdr",
                                 ros1 ? "tf2_msgs/TFMessage" : "tf2_msgs/msg/TFMessage");
  for (int i = 0; i <= 300; ++i) {
    Cdr message(kind);
    message.U32(2);
    for (const std::string body : {"mug", "glove"}) {
      const Row row = change(body, body == "mug" ? CupAt(i / 60.0) : HandAt(i / 60.0));
      message.Header(TimeOf(i), "world").Text(body).Pose(Place(row));
    }
    std::string data = message.Bytes();
    if (spoil) data = spoil(i, data);
    writer.Message(tf, TimeOf(i) + 3'000'000, data);
  }
  return writer.Bytes();
}

class ImportMcap : public testing::Test {
 protected:
  Said Import(const std::string& bytes, const std::string& map = kMap) const {
    std::filesystem::remove(folder_ / "take.jsonl");
    WriteFile(folder_ / "run.mcap", bytes);
    WriteFile(folder_ / "map.yaml", map);
    return Prehend({"import", (folder_ / "run.mcap").string(), "--map",
                    (folder_ / "map.yaml").string(), "-o", (folder_ / "take.jsonl").string()});
  }
  std::string EventsOf(const std::string& bytes, const std::string& map = kMap) const {
    const Said said = Import(bytes, map);
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return Prehend({"episode", "resegment", (folder_ / "take.jsonl").string()}).out;
  }

  const std::filesystem::path folder_ = FreshFolder("import_mcap");
};

TEST_F(ImportMcap, TransformsAreOfAnyCompressionAndEncoding) {
  const std::string events = EventsOf(Transforms());
  for (const char* event : {"picking_up", "transporting", "putting_down", "pick_and_place"})
    EXPECT_NE(events.find(event), std::string::npos) << event << "\n" << events;
  EXPECT_EQ(EventsOf(Transforms(Chunks::kNone)), events);
  EXPECT_EQ(EventsOf(Transforms(Chunks::kPlain)), events);
  EXPECT_EQ(EventsOf(Transforms(Chunks::kLz4)), events);
  EXPECT_EQ(EventsOf(Transforms(Chunks::kZstd, Cdr::Kind::kBig)), events);
  EXPECT_EQ(EventsOf(Transforms(Chunks::kZstd, Cdr::Kind::kRos1)), events);
}

std::string JsonPose(const char* position, const char* orientation, const Row& row) {
  char text[200];
  std::snprintf(text, sizeof text,
                "\"%s\": {\"x\": %.17g, \"y\": %.17g, \"z\": %.17g}, \"%s\": {\"x\": 0, \"y\": 0, "
                "\"z\": 0, \"w\": 1}",
                position, row.x, row.y, row.z, orientation);
  return text;
}
std::string Stamp(int frame, const char* nanoseconds = "nsec") {
  const std::uint64_t ns = TimeOf(frame);
  return "{\"sec\": " + std::to_string(ns / 1'000'000'000) + ", \"" + nanoseconds +
         "\": " + std::to_string(ns % 1'000'000'000) + "}";
}

/// One message for each frame and body, or, with "", for all bodies of a frame.
std::string JsonFile(const std::string& schema, const std::vector<std::string>& topics,
                     const std::function<std::string(int, const std::string& topic)>& message) {
  McapWriter writer;
  std::vector<std::uint16_t> channels;
  for (const std::string& topic : topics) channels.push_back(writer.Channel(topic, "json", schema));
  for (int i = 0; i <= 300; ++i) {
    for (std::size_t k = 0; k < topics.size(); ++k)
      writer.Message(channels[k], TimeOf(i), message(i, topics[k]));
  }
  return writer.Bytes();
}

TEST_F(ImportMcap, PosesOfTopicsAndBodiesAsJson) {
  const std::string events = EventsOf(Transforms());
  const auto row = [](int frame, const std::string& body) {
    return body == "mug" || body == "/mug" ? CupAt(frame / 60.0) : HandAt(frame / 60.0);
  };
  const std::string topics = Replaced(Replaced(kMap, "mug", "/mug"), "glove", "/glove");
  EXPECT_EQ(EventsOf(JsonFile("foxglove.PoseInFrame", {"/mug", "/glove"},
                              [&](int i, const std::string& topic) {
                                return "{\"timestamp\": " + Stamp(i) +
                                       ", \"frame_id\": \"world\", \"pose\": {" +
                                       JsonPose("position", "orientation", row(i, topic)) + "}}";
                              }),
                     topics),
            events);
  EXPECT_EQ(EventsOf(JsonFile("geometry_msgs/msg/PoseStamped", {"/mug", "/glove"},
                              [&](int i, const std::string& topic) {
                                return "{\"header\": {\"stamp\": " + Stamp(i, "nanosec") +
                                       ", \"frame_id\": \"world\"}, \"pose\": {" +
                                       JsonPose("position", "orientation", row(i, topic)) + "}}";
                              }),
                     topics),
            events);
  EXPECT_EQ(EventsOf(JsonFile("foxglove.PosesInFrame", {"/all"},
                              [&](int i, const std::string&) {
                                return "{\"timestamp\": " + Stamp(i) +
                                       ", \"frame_id\": \"world\", \"poses\": [{" +
                                       JsonPose("position", "orientation", row(i, "mug")) + "}, {" +
                                       JsonPose("position", "orientation", row(i, "glove")) + "}]}";
                              }),
                     Replaced(Replaced(kMap, "mug", "'/all[0]'"), "glove", "'/all[1]'")),
            events);
  EXPECT_EQ(EventsOf(JsonFile(
                "foxglove.FrameTransforms", {"/tf"},
                [&](int i, const std::string&) {
                  std::string all;
                  for (const char* body : {"mug", "glove"})
                    all += (all.empty() ? "{" : ", {") + std::string("\"timestamp\": ") + Stamp(i) +
                           ", \"parent_frame_id\": \"world\", \"child_frame_id\": \"" + body +
                           "\", " + JsonPose("translation", "rotation", row(i, body)) + "}";
                  return "{\"transforms\": [" + all + "]}";
                })),
            events);
  // Our own: what is not tracked is null; the time is that of the log.
  EXPECT_EQ(EventsOf(JsonFile("", {"poses"},
                              [&](int i, const std::string&) {
                                return "{\"bodies\": {\"mug\": {" +
                                       JsonPose("position", "orientation", row(i, "mug")) +
                                       "}, \"glove\": {" +
                                       JsonPose("position", "orientation", row(i, "glove")) +
                                       "}, \"chair\": null}}";
                              })),
            events);
}

TEST_F(ImportMcap, ChainsOfFramesAreComposedAndTheWorldMayBeAnyOfThem) {
  const std::string events = EventsOf(Transforms());
  // room -> tracker (fixed, turned by 90 degrees) -> mug; room -> arm (half as often) -> glove.
  McapWriter writer(Chunks::kZstd);
  const auto tf = writer.Channel("/tf", "cdr", "tf2_msgs/msg/TFMessage"),
             still = writer.Channel("/tf_static", "cdr", "tf2_msgs/msg/TFMessage");
  const double half = std::sqrt(0.5);
  writer.Message(still, kEpoch_ns,
                 Cdr()
                     .U32(2)
                     .Header(0, "room")
                     .Text("tracker")
                     .Pose({1, 2, 3}, {0, 0, half, half})
                     .Header(0, "room")
                     .Text("desk")
                     .Pose({5, 0, 0})
                     .Bytes());
  for (int i = 0; i <= 300; ++i) {
    const Row cup = CupAt(i / 60.0), hand = HandAt(i / 60.0);
    // In the tracker's frame, which sees room x along -y.
    Cdr message;
    message.U32(i % 2 == 0 ? 3 : 2);
    message.Header(TimeOf(i), "tracker")
        .Text("mug")
        .Pose({cup.y - 2, 1 - cup.x, cup.z - 3}, {0, 0, -half, half});
    message.Header(TimeOf(i), "arm").Text("glove").Pose({hand.x, hand.y, hand.z - 0.1 * i / 60});
    if (i % 2 == 0) message.Header(TimeOf(i), "room").Text("arm").Pose({0, 0, 0.1 * i / 60});
    writer.Message(tf, TimeOf(i), message.Bytes());
  }
  EXPECT_EQ(EventsOf(writer.Bytes()), events);
  // The desk's frame is 5 m off; a table in it is elsewhere.
  const std::string desk = Replaced(kMap, "unit: m\n", "unit: m\nmcap: {world: desk}\n");
  EXPECT_EQ(EventsOf(writer.Bytes(), Replaced(desk, "[0, 0, 0.7]", "[-5, 0, 0.7]")), events);
  const Said far = Import(writer.Bytes(), desk);
  EXPECT_EQ(far.exit_code, 2);
  EXPECT_NE(far.err.find("nothing tracked comes nearer to 'table' than 3.6"), std::string::npos)
      << far.err;
}

struct Fault {
  const char* name;
  std::string bytes, map, says;
};

TEST_F(ImportMcap, EveryFaultIsFoundAndNamedAndNothingIsWritten) {
  const std::string good = Transforms(), plain = Transforms(Chunks::kNone);
  const auto moved = [](const Change& change) {
    return Transforms(Chunks::kZstd, Cdr::Kind::kLittle, change);
  };
  const auto spoiled = [](const std::function<std::string(int, std::string)>& spoil) {
    return Transforms(Chunks::kZstd, Cdr::Kind::kLittle, AsItIs, spoil);
  };
  const std::size_t middle = good.size() / 2;
  std::string flipped = good;
  const std::size_t in_chunk = flipped.find("zstd") + 30;
  flipped[in_chunk] = static_cast<char>(flipped[in_chunk] ^ 1);
  const std::vector<Fault> faults = {
      {"millimetres", moved([](const std::string&, Row row) {
         return Row{row.t_s, row.x * 1e3, row.y * 1e3, row.z * 1e3};
       }),
       kMap, "map.yaml:3:7: error: the poses are 8"},
      {"metres as mm", good, Replaced(kMap, "unit: m\n", "unit: mm\n"),
       "map.yaml:3:7: error: all poses are within 0.9"},
      {"y up", moved([](const std::string&, Row row) {
         return Row{row.t_s, row.x, row.z, row.y};
       }),
       kMap, "map.yaml:4:7: error: nothing is lifted along z, but 'mug' rises 0.2"},
      {"another rate", good, Replaced(kMap, "axes: z_up", "axes: z_up\nrate_hz: 120"),
       "map.yaml:5:10: error: rate_hz: 120, but poses are 0.01667 s apart"},
      {"a gap", spoiled([](int i, std::string data) {
         return i > 130 && i < 170 ? Cdr().U32(0).Bytes() : data;
       }),
       kMap, "map.yaml:7:15: error: 'mug' is not tracked for 0.667 s from 2.167 s on"},
      {"no number", moved([](const std::string& body, Row row) {
         if (body == "mug" && row.t_s == 2) row.x = std::nan("");
         return row;
       }),
       kMap, "'mug' has a pose that is no number; if that means 'not tracked'"},
      {"zeros", moved([](const std::string& body, Row row) {
         return body == "mug" && row.t_s > 2.5 && row.t_s < 2.58 ? Row{row.t_s, 0, 0, 0} : row;
       }),
       kMap, "map.yaml:7:15: error: 'mug' is at exactly 0, 0, 0 in 4 of 301 poses"},
      {"no unit quaternion", spoiled([](int i, std::string data) {
         if (i != 100) return data;
         return Cdr()
             .U32(1)
             .Header(TimeOf(i), "world")
             .Text("mug")
             .Pose({0, 0, 1}, {0, 0, 1, 1})
             .Bytes();
       }),
       kMap, "'mug': expected a unit quaternion, found one of length 1.414"},
      {"time goes back", spoiled([](int i, std::string data) {
         if (i != 100) return data;
         return Cdr()
             .U32(1)
             .Header(TimeOf(0) - 5'000'000'000, "world")
             .Text("mug")
             .Pose({0, 0, 1})
             .Bytes();
       }),
       kMap, "the times of 'mug' go back from 1700000001.650000 to 1699999995.000000 s"},
      {"two places at a time", spoiled([](int i, std::string data) {
         if (i != 100) return data;
         return Cdr().U32(1).Header(TimeOf(99), "world").Text("mug").Pose({0, 0, 1}).Bytes();
       }),
       kMap, "run.mcap: error: 'mug' has two poses at 1700000001.650000 s"},
      {"time zero", spoiled([](int, std::string) {
         return Cdr().U32(1).Header(0, "world").Text("mug").Pose({0, 0, 1}).Bytes();
       }),
       kMap, "'mug' has the time 0 in its header"},
      {"another parent", spoiled([](int i, std::string data) {
         if (i != 100) return data;
         return Cdr().U32(1).Header(TimeOf(i), "odom").Text("mug").Pose({0, 0, 1}).Bytes();
       }),
       kMap, "'mug' is in the frame 'odom', and before it was in 'world'"},
      {"no such world", good, Replaced(kMap, "axes: z_up", "axes: z_up\nmcap: {world: wrld}"),
       "map.yaml:5:15: error: no body is tracked in the frame 'wrld'"},
      {"cut in a chunk", good.substr(0, middle), kMap,
       "the file is cut off: it ends within a record"},
      {"cut between records", plain.substr(0, plain.size() - 8 - 29 - 13), kMap,
       "the file is cut off"},
      {"cut in its end", good.substr(0, good.size() - 3), kMap, "the file is cut off in its last"},
      {"a message cut off",
       spoiled([](int i, std::string data) { return i == 100 ? data.substr(0, 60) : data; }), kMap,
       "a message of '/tf', logged at 1700000001.669667 s: it is cut off, or not of its type"},
      {"more than its type", spoiled([](int i, std::string data) {
         return i == 100 ? data + std::string(40, 'x') : data;
       }),
       kMap, "40 bytes too many for its type"},
      {"another compression", Replaced(good, "zstd", "gzip"), kMap,
       "a chunk with the compression 'gzip'; zstd, lz4 and none are read"},
      {"a bag", "#ROSBAG V2.0\n", kMap, "run.mcap: error: it is a bag of ROS 1: call it .bag"},
      {"no MCAP", "once upon a time", kMap, "it is no MCAP file: it does not begin as one"},
      {"empty", "", kMap, "it is no MCAP file"},
      {"no such frame", good, Replaced(kMap, "from: mug", "from: mugg"), "did you mean 'mug'?"},
      {"columns", good, Replaced(kMap, "unit: m\n", "unit: m\ntime_unit: s\n"),
       "map.yaml:4:12: error: 'time_unit' is that of CSV files"},
  };
  for (const Fault& fault : faults) {
    const Said said = Import(fault.bytes, fault.map);
    EXPECT_EQ(said.exit_code, 2) << fault.name << "\n" << said.out << said.err;
    EXPECT_NE(said.err.find(fault.says), std::string::npos) << fault.name << "\n" << said.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "take.jsonl")) << fault.name;
  }
}

TEST_F(ImportMcap, ATypeThatIsNotReadIsNamedWhereItIsAskedFor) {
  McapWriter writer;
  writer.Message(writer.Channel("/mug", "protobuf", "foxglove.PoseInFrame"), 1, "x");
  const Said said = Import(writer.Bytes(), Replaced(kMap, "from: mug", "from: /mug"));
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("map.yaml:7:15: error: the messages of '/mug' are of a type that is not "
                          "read: foxglove.PoseInFrame (protobuf)"),
            std::string::npos)
      << said.err;
}

TEST_F(ImportMcap, TimesAreOfACenturyThatMakesSense) {
  McapWriter writer;
  const auto tf = writer.Channel("/tf", "cdr", "tf2_msgs/msg/TFMessage");
  const std::string map = Replaced(kMap, "axes: z_up", "axes: z_up\nmcap: {clock: log}");
  for (const std::uint64_t ns : {std::uint64_t{1}, std::uint64_t{1} << 63, ~std::uint64_t{0}}) {
    McapWriter late = writer;
    late.Message(tf, ns, Cdr().U32(1).Header(1, "world").Text("mug").Pose({0, 0, 1}).Bytes());
    const Said said = Import(late.Bytes(), map);
    EXPECT_EQ(said.exit_code, 2) << ns;
    EXPECT_EQ(said.err.find("expected one of the years 1970 to 2116") != std::string::npos, ns > 1)
        << said.err;
  }
}

/// A second of frames, each in the next one.
std::string Chain(const std::vector<std::string>& frames) {
  McapWriter writer;
  const auto tf = writer.Channel("/tf", "cdr", "tf2_msgs/msg/TFMessage");
  for (int i = 0; i <= 60; ++i) {
    Cdr message;
    message.U32(static_cast<std::uint32_t>(frames.size() - 1));
    for (std::size_t k = 1; k < frames.size(); ++k)
      message.Header(TimeOf(i), frames[k]).Text(frames[k - 1]).Pose({0, 0, 1});
    writer.Message(tf, TimeOf(i), message.Bytes());
  }
  return writer.Bytes();
}

TEST_F(ImportMcap, AnOrderThatNamesOfFieldsContradictIsTold) {
  const auto said = [&](const std::string& order) {
    return Import(Transforms(), Replaced(kMap, "unit: m\n", "unit: m\n" + order)).err;
  };
  const std::string told =
      "warning: quaternion_order is wxyz: of an orientation, the field x, or the first number, is "
      "w\n";
  EXPECT_NE(said("quaternion_order: wxyz\nsure: [upright, quaternion_order, place]\n").find(told),
            std::string::npos)
      << said("quaternion_order: wxyz\n");
  EXPECT_EQ(said("quaternion_order: xyzw\n"), "");
  EXPECT_EQ(said(""), "");
}

TEST_F(ImportMcap, ABodyTwiceInAMessageOfTfHasTheLastPose) {
  const auto twice = [](double off_m, double later_s, const std::string& topic = "/tf") {
    McapWriter writer;
    const auto tf = writer.Channel(topic, "cdr", "tf2_msgs/msg/TFMessage");
    for (int i = 0; i <= 300; ++i) {
      Cdr message;
      message.U32(3);
      Row first = CupAt(i / 60.0 - later_s);
      first.x += off_m;
      const auto before_ns = static_cast<std::uint64_t>(later_s * 1e9);
      message.Header(TimeOf(i) - before_ns, "world").Text("mug").Pose(Place(first));
      message.Header(TimeOf(i), "world").Text("mug").Pose(Place(CupAt(i / 60.0)));
      message.Header(TimeOf(i), "world").Text("glove").Pose(Place(HandAt(i / 60.0)));
      writer.Message(tf, TimeOf(i), message.Bytes());
    }
    return writer.Bytes();
  };
  const std::string wanted = EventsOf(Transforms());
  EXPECT_EQ(EventsOf(twice(0.001, 0)), wanted);
  EXPECT_NE(Import(twice(0.001, 0))
                .err.find("warning: 'mug' is twice in 301 messages: the last pose counts\n"),
            std::string::npos);
  const Said far = Import(twice(0.2, 0));
  EXPECT_EQ(far.exit_code, 2);
  EXPECT_NE(far.err.find("'mug' is in it twice, 0.20 m apart"), std::string::npos) << far.err;
  // At another time it is another pose.
  const Said later = Import(twice(0, 0.5 / 60));
  EXPECT_EQ(later.exit_code, 0) << later.err;
  EXPECT_EQ(later.err.find("twice"), std::string::npos) << later.err;
  EXPECT_NE(later.out.find("602   120."), std::string::npos) << later.out;
}

TEST_F(ImportMcap, FramesInARingAndTooManyFramesAreNamed) {
  std::vector<std::string> deep = {"glove", "mug"};
  for (int i = 0; i < 250; ++i) deep.push_back("f" + std::to_string(i));
  const std::vector<Fault> faults = {
      {"a ring", Chain({"glove", "mug", "a", "b", "c", "a"}), kMap,
       "run.mcap: error: the frames are in a ring: 'a' in 'b' in 'c' in 'a' again"},
      {"itself", Chain({"glove", "mug", "a", "a"}), kMap,
       "run.mcap: error: the frames are in a ring: 'a' in 'a' again"},
      {"too deep", Chain(deep), kMap, "is in more than 200 frames, one in another"}};
  for (const Fault& fault : faults) {
    const Said said = Import(fault.bytes, fault.map);
    EXPECT_EQ(said.exit_code, 2) << fault.name;
    EXPECT_NE(said.err.find(fault.says), std::string::npos) << fault.name << "\n" << said.err;
  }
}

TEST_F(ImportMcap, ChunksThatBecomeFarMoreThanTheFileAreRefused) {
  constexpr std::size_t kBytes = 60'000'003;  // of records of nothing, each 9 bytes
  const std::string chunk = McapWriter::ChunkOf(RunAsZstd('\0', kBytes), kBytes, "zstd");
  std::string chunks;
  for (int i = 0; i < 5; ++i) chunks += chunk;
  const Said said = Import(McapWriter::FileOf(chunks, Chunks::kNone));
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("its chunks become more than 256 MiB and more than 100 times the file"),
            std::string::npos)
      << said.err;
}

TEST_F(ImportMcap, ManyChannelsAreRefused) {
  McapWriter writer;
  for (int i = 0; i <= 10'000; ++i) writer.Channel("/t" + std::to_string(i), "json", "x");
  const Said said = Import(writer.Bytes());
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("more than 10000 schemas"), std::string::npos) << said.err;
}

TEST_F(ImportMcap, ABombIsRefused) {
  // A chunk that says that it is large.
  McapWriter writer(Chunks::kZstd);
  std::string bytes = writer.Bytes();
  const std::size_t chunk = bytes.find(std::string("\6", 1), 8);
  bytes.replace(chunk + 9 + 16, 8, Bytes64(std::uint64_t{1} << 40));
  const Said said = Import(bytes);
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("at most 64 MiB are read"), std::string::npos) << said.err;
}

}  // namespace
}  // namespace prehend::house
