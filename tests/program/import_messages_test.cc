// SPDX-License-Identifier: Apache-2.0
// Messages of types that nobody told the program of: their definitions are in the file. They become
// the same recording as transforms of tf; what is wrong with them is named, and nothing is written.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "tests/program/bag_writer.h"
#include "tests/program/carried_cup.h"
#include "tests/program/import_csv.h"
#include "tests/program/mcap_writer.h"
#include "tests/program/message_texts.h"
#include "tests/program/program.h"

namespace prehend::house {
namespace {

using Kind = Cdr::Kind;

constexpr std::uint64_t kEpoch_ns = 1'700'000'000'000'000'000;
constexpr int kFrames = 300;

std::string Map(const std::string& cup, const std::string& hand, const std::string& more = "") {
  return "import: 1\nepisode: a_cup_is_carried\nunit: m\naxes: z_up\n" + more +
         "entities:\n"
         "  table: {at_m: [0, 0, 0.7], fixed: true, class: Table, size_m: [2.0, 1.0, 0.04]}\n"
         "  cup: {from: '" +
         cup + "', class: Cup, size_m: [0.08, 0.08, 0.1]}\n  hand: {from: '" + hand +
         "', hand: true, size_m: [0, 0, 0]}\n";
}

std::uint64_t TimeOf(int frame) {
  return kEpoch_ns + static_cast<std::uint64_t>(frame) * 1'000'000'000 / 60;
}
std::array<double, 3> Mug(int frame) {
  const Row row = CupAt(frame / 60.0);
  return {row.x, row.y, row.z};
}
std::array<double, 3> Glove(int frame) {
  const Row row = HandAt(frame / 60.0);
  return {row.x, row.y, row.z};
}

/// Messages of a topic: the bytes of each frame.
struct Topic {
  std::string name, type, definition;
  std::function<std::string(int frame, Kind kind)> message;
};

std::string Bag(const std::vector<Topic>& topics, int frames = kFrames) {
  std::string records;
  for (std::uint32_t i = 0; i < topics.size(); ++i)
    records += BagConnection(i, topics[i].name, topics[i].type, topics[i].definition);
  for (int frame = 0; frame <= frames; ++frame) {
    for (std::uint32_t i = 0; i < topics.size(); ++i)
      records += BagMessage(i, TimeOf(frame), topics[i].message(frame, Kind::kRos1));
  }
  return BagHead() + BagChunk(records, "none");
}

std::string Mcap(const std::vector<Topic>& topics, Kind kind = Kind::kLittle,
                 int frames = kFrames) {
  McapWriter writer;
  std::vector<std::uint16_t> channels;
  for (const Topic& topic : topics)
    channels.push_back(writer.Channel(topic.name, kind == Kind::kRos1 ? "ros1" : "cdr", topic.type,
                                      topic.definition));
  for (int frame = 0; frame <= frames; ++frame) {
    for (std::size_t i = 0; i < topics.size(); ++i)
      writer.Message(channels[i], TimeOf(frame), topics[i].message(frame, kind));
  }
  return writer.Bytes();
}

/// What a tracker says of a body in a frame.
struct Body {
  std::string name;
  std::array<double, 3> p;
  bool tracked = true;
};

/// A frame of NatNet's, with a marker that has no name.
std::string NatNetFrame(int frame, Kind kind, const std::vector<Body>& bodies) {
  Cdr message(kind);
  message.Header(TimeOf(frame), "world").U32(static_cast<std::uint32_t>(bodies.size()));
  for (const Body& body : bodies)
    message.U32(7).Text(body.name).Pose(body.p).F32(0.5F).Flag(body.tracked);
  return message.U32(1).U32(3).U32(5).F64(1).F64(2).F64(3).Flag(false).Bytes();
}

Topic NatNet(const std::function<std::vector<Body>(int)>& bodies) {
  return {"/natnet/frame", "natnet_bridge/NatNetFrame", kNatNetFrame,
          [=](int frame, Kind kind) { return NatNetFrame(frame, kind, bodies(frame)); }};
}
std::vector<Body> BothAndABowl(int frame) {
  return {{"Mug", Mug(frame)}, {"Glove", Glove(frame)}, {"Bowl", {1, 0, 1}}};
}

/// With each body's markers before its pose, and a covariance after it.
std::string RigidBodies(int frame, Kind kind) {
  Cdr message(kind);
  message.Header(TimeOf(frame), "map").U32(static_cast<std::uint32_t>(frame)).U32(2);
  for (const Body& body : {Body{"Mug", Mug(frame)}, Body{"Glove", Glove(frame)}}) {
    message.Text(body.name).U32(2);
    for (const char* marker : {"a", "another"}) {
      message.Flag(true).U32(4).Text(marker);
      for (const double value : body.p) message.F64(value);
    }
    message.Pose(body.p);
  }
  return message.Bytes();
}

Topic Odometry(const std::string& name, std::array<double, 3> (*place)(int)) {
  return {name, "nav_msgs/msg/Odometry", kOdometry, [=](int frame, Kind kind) {
            Cdr message(kind);
            message.Header(TimeOf(frame), "odom").Text("base_link").Pose(place(frame));
            for (int i = 0; i < 36 + 6 + 36; ++i) message.F64(0.1 * i);
            return message.Bytes();
          }};
}

class ImportMessages : public testing::Test {
 protected:
  Said Import(const std::string& file, const std::string& bytes, const std::string& map,
              bool check = false) const {
    std::filesystem::remove(folder_ / "take.jsonl");
    return ImportFile(folder_, file, bytes, map,
                      check ? std::vector<std::string>{"--check"} : std::vector<std::string>{});
  }
  std::string RecordingOf(const std::string& file, const std::string& bytes, const std::string& map,
                          const std::string& warnings = "") const {
    const Said said = Import(file, bytes, map);
    EXPECT_EQ(said.exit_code, 0) << said.err;
    EXPECT_EQ(said.err, warnings);
    return ReadFile(folder_ / "take.jsonl");
  }
  /// As transforms of tf.
  std::string Expected() const {
    McapWriter writer;
    const auto tf = writer.Channel("/tf", "cdr", "tf2_msgs/msg/TFMessage");
    for (int i = 0; i <= kFrames; ++i)
      writer.Message(tf, TimeOf(i),
                     Cdr()
                         .U32(2)
                         .Header(TimeOf(i), "w")
                         .Text("mug")
                         .Pose(Mug(i))
                         .Header(TimeOf(i), "w")
                         .Text("glove")
                         .Pose(Glove(i))
                         .Bytes());
    return RecordingOf("run.mcap", writer.Bytes(), Map("mug", "glove"));
  }

  const std::filesystem::path folder_ = FreshFolder("import_messages");
};

TEST_F(ImportMessages, ElementsOfListsAreFoundByTheirNames) {
  const std::string expected = Expected();
  const std::string map = Map("/natnet/frame[Mug]", "/natnet/frame[Glove]");
  const std::string bowl =
      "warning: the file has '/natnet/frame[Bowl]', which the map does not mention\n";
  const Topic natnet = NatNet(BothAndABowl);
  EXPECT_EQ(RecordingOf("run.bag", Bag({natnet}), map, bowl), expected);
  EXPECT_EQ(RecordingOf("run.mcap", Mcap({natnet}, Kind::kRos1), map, bowl), expected);
  const std::string path =
      Map("/natnet/frame:rigid_bodies[Mug]", "/natnet/frame:rigid_bodies[Glove].pose");
  EXPECT_EQ(RecordingOf("run.bag", Bag({natnet}), path, bowl), expected);
  const Topic mocap = {"/bodies", "mocap4r2_msgs/msg/RigidBodies", kRigidBodies, RigidBodies};
  for (const Kind kind : {Kind::kLittle, Kind::kBig})
    EXPECT_EQ(RecordingOf("run.mcap", Mcap({mocap}, kind), Map("/bodies[Mug]", "/bodies[Glove]")),
              expected);
  // Numbers, with the namespace; names in a list beside the poses.
  const Topic markers = {
      "/markers", "visualization_msgs/msg/MarkerArray", kMarkerArray, [](int frame, Kind kind) {
        Cdr message(kind);
        message.U32(2);
        for (const Body& body : {Body{"cups", Mug(frame)}, Body{"hands", Glove(frame)}})
          message.Header(TimeOf(frame), "map").Text(body.name).U32(4).Pose(body.p);
        return message.Bytes();
      }};
  EXPECT_EQ(RecordingOf("run.mcap", Mcap({markers}), Map("/markers[cups/4]", "/markers[hands/4]")),
            expected);
  const Topic states = {"/states", "gazebo_msgs/ModelStates", kModelStates,
                        [](int frame, Kind kind) {
                          return Cdr(kind)
                              .U32(2)
                              .Text("mug")
                              .Text("glove")
                              .U32(2)
                              .Pose(Mug(frame))
                              .Pose(Glove(frame))
                              .Bytes();
                        }};
  EXPECT_EQ(RecordingOf("run.bag", Bag({states}), Map("/states[mug]", "/states[glove]"),
                        "warning: the messages of '/states' have no time of their own: they count "
                        "as measured when they were logged\n"),
            expected);
}

TEST_F(ImportMessages, ATopicWithOnePoseNeedsNoMore) {
  const std::string expected = Expected();
  const std::vector<Topic> topics = {Odometry("/mug/odom", Mug), Odometry("/odom", Glove)};
  const std::string map = Map("/mug/odom", "/odom");
  for (const Kind kind : {Kind::kLittle, Kind::kBig})
    EXPECT_EQ(RecordingOf("run.mcap", Mcap(topics, kind), map), expected);
  EXPECT_EQ(RecordingOf("run.mcap", Mcap(topics), Map("/mug/odom:pose", "/odom:pose.pose")),
            expected);
  EXPECT_EQ(RecordingOf("run.mcap", Mcap({topics[0], topics[1], NatNet(BothAndABowl)}), map,
                        "warning: the file has '/natnet/frame[Bowl]', '/natnet/frame[Glove]', "
                        "'/natnet/frame[Mug]', which the map does not mention\n"),
            expected);
  // Two poses: which one?
  const Topic two = {
      "/two", "mine/Two", kTwoPoses, [](int frame, Kind kind) {
        return Cdr(kind).Header(TimeOf(frame), "map").Pose(Mug(frame)).Pose(Glove(frame)).Bytes();
      }};
  EXPECT_EQ(RecordingOf("run.bag", Bag({two}), Map("/two:left", "/two:right.pose")), expected);
  const Said said = Import("run.bag", Bag({two}), Map("/two", "/two:right"));
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("map.yaml:7:15: error: '/two' can be 2 bodies\n"), std::string::npos)
      << said.err;
  EXPECT_NE(said.err.find("hint: write one of '/two:left', '/two:right'\n"), std::string::npos)
      << said.err;
}

TEST_F(ImportMessages, WhatIsNotTrackedIsAGap) {
  const auto lost = [](int frame) {
    std::vector<Body> bodies = BothAndABowl(frame);
    bodies.pop_back();
    bodies[0].tracked = frame < 131 || frame > 169;
    if (!bodies[0].tracked) bodies[0].p = {0, 0, std::nan("")};
    return bodies;
  };
  const std::string map = Map("/natnet/frame[Mug]", "/natnet/frame[Glove]");
  const Said said = Import("run.bag", Bag({NatNet(lost)}), map);
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("map.yaml:7:15: error: '/natnet/frame[Mug]' is not tracked for 0.667 s "
                          "from 2.167 s on"),
            std::string::npos)
      << said.err;
  // The same flags the other way round.
  const std::string occluded = Replaced(kNatNetFrame, "track_valid", "is_occluded");
  Topic hidden = NatNet([](int frame) {
    std::vector<Body> bodies = BothAndABowl(frame);
    bodies.pop_back();
    for (Body& body : bodies) body.tracked = false;
    return bodies;
  });
  hidden.definition = occluded;
  EXPECT_EQ(RecordingOf("run.bag", Bag({hidden}), map), Expected());
}

TEST_F(ImportMessages, TwoFramesInAMessageAreNoTwoBodies) {
  const auto twice = [](int frame) {
    std::vector<Body> bodies = {{"Mug", Mug(frame)}, {"Glove", Glove(frame)}};
    if (frame == 100) bodies.insert(bodies.begin(), {{"Mug", Mug(99)}, {"Glove", Glove(99)}});
    return bodies;
  };
  const std::string map = Map("/natnet/frame[Mug]", "/natnet/frame[Glove]");
  EXPECT_EQ(RecordingOf("run.bag", Bag({NatNet(twice)}), map,
                        "warning: bodies of '/natnet/frame' are twice in 1 message: the last pose "
                        "counts\n"),
            Expected());
}

TEST_F(ImportMessages, PositionsAloneAreReadAndTold) {
  const auto frame = [](int i) { return std::vector<Body>{{"Mug", Mug(i)}, {"Glove", Glove(i)}}; };
  const Said said =
      Import("run.bag", Bag({NatNet(frame)}),
             Map("/natnet/frame[Mug]", "/natnet/frame:labeled_markers[3/5]", "sure: [place]\n"),
             /*check=*/true);
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.err.find("warning: '/natnet/frame:labeled_markers[3/5]' is a position without an "
                          "orientation: it never turns or tilts (boxes, offset_m)\n"),
            std::string::npos)
      << said.err;
  const Said all = Import("run.mcap",
                          Mcap({{"/a", "geometry_msgs/msg/PointStamped", kPointStamped,
                                 [](int i, Kind kind) {
                                   Cdr message(kind);
                                   message.Header(TimeOf(i), "map");
                                   for (const double value : Mug(i)) message.F64(value);
                                   return message.Bytes();
                                 }},
                                {"/b", "geometry_msgs/msg/PointStamped", kPointStamped,
                                 [](int i, Kind kind) {
                                   Cdr message(kind);
                                   message.Header(TimeOf(i), "map");
                                   for (const double value : Glove(i)) message.F64(value);
                                   return message.Bytes();
                                 }}}),
                          Map("/a", "/b", "quaternion_order: xyzw\n"));
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_NE(all.err.find("warning: the file has positions only, of 2 bodies"), std::string::npos)
      << all.err;
  EXPECT_NE(all.err.find("warning: 'quaternion_order' of the map says nothing here: no pose has an "
                         "orientation\n"),
            std::string::npos)
      << all.err;
}

TEST_F(ImportMessages, WhatIsNotThereIsAnsweredWithWhatIs) {
  const std::string bag = Bag({NatNet(BothAndABowl)});
  const struct {
    std::string cup, says, hint;
  } cases[] = {{"/natnet/frame[Mugg]", "'/natnet/frame' has no body '/natnet/frame[Mugg]'",
                "did you mean '/natnet/frame[Mug]'? there is '/natnet/frame[Bowl]', "
                "'/natnet/frame[Glove]', '/natnet/frame[Mug]'"},
               {"/natnet/frame", "the messages of '/natnet/frame' have several bodies",
                "there is '/natnet/frame[Bowl]', '/natnet/frame[Glove]', '/natnet/frame[Mug]'"},
               {"/natnet/frame[Mug", "'/natnet/frame' has no body '/natnet/frame[Mug'",
                "did you mean '/natnet/frame[Mug]'? there is '/natnet/frame[Bowl]'"},
               {"/natnet", "no topic of poses, no body and no frame is called '/natnet'",
                "there is '/natnet/frame[Bowl]', '/natnet/frame[Glove]', '/natnet/frame[Mug]'"}};
  for (const auto& [cup, says, hint] : cases) {
    const Said said = Import("run.bag", bag, Map(cup, "/natnet/frame[Glove]"));
    EXPECT_EQ(said.exit_code, 2) << cup;
    EXPECT_NE(said.err.find("map.yaml:7:15: error: " + says + "\n"), std::string::npos) << said.err;
    EXPECT_NE(said.err.find("hint: " + hint), std::string::npos) << said.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "take.jsonl")) << cup;
  }
}

TEST_F(ImportMessages, EveryFaultIsFoundAndNamedAndNothingIsWritten) {
  const std::string map = Map("/natnet/frame[Mug]", "/natnet/frame[Glove]");
  const auto with_text = [](const std::string& from, const std::string& to) {
    Topic topic = NatNet(BothAndABowl);
    topic.definition = from.empty() ? to : Replaced(topic.definition, from, to);
    return Bag({topic}, 2);
  };
  const auto with_message = [](const std::function<std::string(std::string)>& spoil) {
    Topic topic = NatNet(BothAndABowl);
    topic.message = [spoil](int frame, Kind kind) {
      const std::string good = NatNetFrame(frame, kind, BothAndABowl(frame));
      return frame == 1 ? spoil(good) : good;
    };
    return Bag({topic}, 2);
  };
  // A header of 21 bytes, the number of bodies, an id, and the length of a name.
  constexpr std::size_t kBodies = 21, kName = 29;
  const auto with_number = [&](std::size_t at, std::uint32_t number) {
    return with_message(
        [at, number](std::string good) { return good.replace(at, 4, Bytes32(number)); });
  };
  const std::string type =
      "map.yaml:7:15: error: the messages of '/natnet/frame' are of a type "
      "that is not read: natnet_bridge/NatNetFrame (ros1)";
  const std::string message = "a message of '/natnet/frame', logged at 1700000000.016667 s: ";
  const struct {
    const char* name;
    std::string bytes, says;
  } faults[] = {
      {"no definition", with_text("", ""), type + ", whose definition is not in the file"},
      {"a definition that is cut", with_text("", std::string(kNatNetFrame).substr(0, 60)),
       type + "; its definition, line 2: no type 'natnet_bridge/RigidBody' is in it"},
      {"cut in a line", with_text("", "std_msgs/Header header\nRigid"),
       type + "; its definition, line 2: expected a type and a name, found 'Rigid'"},
      {"no such type", with_text("MSG: natnet_bridge/Marker", "MSG: natnet_bridge/Market"),
       type + "; its definition, line 3: no type 'natnet_bridge/Marker' is in it"},
      {"in itself", with_text("float32 error", "NatNetFrame error"),
       type + "; its definition, line 9: 'natnet_bridge/NatNetFrame' is in itself"},
      {"no pose", with_text("", "float64 x\nstring name"), type + ", which has no pose"},
      {"too many bodies", with_number(kBodies, 1'000'000),
       message + "it is cut off, or not of its type: 'rigid_bodies' has 1000000 elements, in "},
      {"most bodies", with_number(kBodies, ~std::uint32_t{0}), "has 4294967295 elements, in "},
      {"a text without end", with_number(kName, ~std::uint32_t{0} - 3),
       message + "it is cut off, or not of its type"},
      {"cut off", with_message([](std::string good) { return good.substr(0, good.size() - 40); }),
       message + "it is cut off, or not of its type"},
      {"too long", with_message([](std::string good) { return good + std::string(9, 'x'); }),
       message + "9 bytes too many for its type"},
      {"no number", with_message([](std::string good) {
         return good.replace(kName + 4 + 3, 8, BytesOf(std::nan("")));
       }),
       message + "'/natnet/frame[Mug]' has a pose that is no number"},
      {"twice", Bag({NatNet([](int frame) {
         return std::vector<Body>{{"Mug", Mug(frame)}, {"Mug", {5, 5, 5}}};
       })}),
       "'/natnet/frame[Mug]' is in it twice, 8."},
      {"two types",
       Bag({NatNet(BothAndABowl),
            {"/natnet/frame", "nav_msgs/Odometry", kOdometry, Odometry("", Mug).message}}),
       "the messages of this topic are of two types"},
      {"zeros",
       with_message([](std::string good) { return good.replace(kName + 7, 56, 56, '\0'); }),
       "found one of length 0; if a body at exactly 0, 0, 0 is not tracked, the map says "
       "zero_is_missing: true"},
      {"tf with a definition that is cut",
       Bag({{"/tf", "tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[]",
             Odometry("", Mug).message}}),
       "'/tf': tf2_msgs/TFMessage (ros1); its definition, line 1: expected a type and a name"},
      {"tf beside others",
       Bag({{"/tf", "tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[]",
             Odometry("", Mug).message},
            Odometry("/odom", Mug)}),
       "hint: there is '/odom'; '/tf' is not read: tf2_msgs/TFMessage (ros1); its definition"},
      {"another definition language",
       Replaced(Mcap({{"/natnet/frame", "a/B", "struct B {};", Odometry("", Mug).message}}),
                "ros2msg", "ros2idl"),
       "a/B (cdr), whose definition is in 'ros2idl', which is not read"}};
  for (const auto& [name, bytes, says] : faults) {
    const Said said = Import(bytes.starts_with('#') ? "run.bag" : "run.mcap", bytes, map);
    EXPECT_EQ(said.exit_code, 2) << name << "\n" << said.out << said.err;
    EXPECT_NE(said.err.find(says), std::string::npos) << name << "\n" << said.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "take.jsonl")) << name;
  }
}

TEST_F(ImportMessages, BytesThatAreDamagedAreImportedOrRefused) {
  const Topic mocap = {"/bodies", "mocap4r2_msgs/msg/RigidBodies", kRigidBodies, RigidBodies};
  const std::pair<std::string, std::string> files[] = {
      {"run.bag", Bag({NatNet(BothAndABowl)}, 5)},
      {"run.mcap", Mcap({mocap, Odometry("/odom", Mug)}, Kind::kLittle, 5)}};
  std::mt19937 random(1);
  int imported = 0, refused = 0;
  for (const auto& [file, good] : files) {
    const std::string map =
        file == "run.bag"
            ? Map("/natnet/frame[Mug]", "/natnet/frame[Glove]", "sure: [axes, place]\n")
            : Map("/odom", "/bodies[Glove]", "sure: [axes, place]\n");
    for (int i = 0; i < 150; ++i) {
      std::string bytes = good;
      if (i % 5 == 4) bytes.resize(random() % bytes.size());
      for (std::size_t n = 1 + random() % 3; i > 0 && n > 0 && !bytes.empty(); --n)
        bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
      const Said said = Import(file, bytes, map);
      EXPECT_TRUE(said.exit_code == 0 || said.exit_code == 2)
          << file << " " << i << ": " << said.exit_code << "\n"
          << said.err;
      EXPECT_EQ(std::filesystem::exists(folder_ / "take.jsonl"), said.exit_code == 0);
      (said.exit_code == 0 ? imported : refused) += 1;
    }
  }
  EXPECT_GT(imported, 20);
  EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace prehend::house
