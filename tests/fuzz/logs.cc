// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/logs.h"

#include <algorithm>

#include "tests/program/bag_writer.h"
#include "tests/program/mcap_writer.h"

namespace prehend::fuzz {
namespace {

using house::Cdr;

constexpr int kFrames = 60;

std::uint64_t TimeOf(int frame) {
  return 1'000'000'000 + static_cast<std::uint64_t>(frame) * 16'666'667;
}

std::string Transforms(Cdr::Kind kind, int frame) {
  const double lift = 0.01 * std::min(frame, kFrames - frame);
  return Cdr(kind)
      .U32(3)
      .Header(TimeOf(frame), "map")
      .Text("tracker")
      .Pose({0.1, 0, 0})
      .Header(TimeOf(frame), "tracker")
      .Text("carton")
      .Pose({0, 0, 0.86 + lift})
      .Header(TimeOf(frame), "map")
      .Text("glove")
      .Pose({0, 0, 0.86 + lift})
      .Bytes();
}

/// A list of named bodies with markers, by a definition.
constexpr const char* kBodies =
    "std_msgs/Header header\nBody[] bodies\nfloat32[<=9] other\n===\nMSG: mine/Body\nstring name\n"
    "Marker[] markers\ngeometry_msgs/Pose pose\nbool valid\n===\nMSG: mine/Marker\nint32 id\n"
    "geometry_msgs/Point position\n";

std::string Bodies(Cdr::Kind kind, int frame) {
  return Cdr(kind)
      .Header(TimeOf(frame), "map")
      .U32(1)
      .Text("cup")
      .U32(1)
      .U32(7)
      .F64(0)
      .F64(0)
      .F64(1)
      .Pose({0, 0, 1})
      .Flag(true)
      .U32(1)
      .F32(0.5F)
      .Bytes();
}

}  // namespace

std::string McapRecords() {
  house::McapWriter writer;
  const auto tf = writer.Channel("/tf", "cdr", "tf2_msgs/msg/TFMessage");
  const auto json = writer.Channel("/more", "json", "foxglove.PoseInFrame");
  const auto bodies = writer.Channel("/bodies", "cdr", "mine/msg/Bodies", kBodies);
  for (int i = 0; i <= kFrames; ++i) {
    const std::uint64_t ns = TimeOf(i);
    writer.Message(bodies, ns, Bodies(Cdr::Kind::kLittle, i));
    writer.Message(tf, ns, Transforms(Cdr::Kind::kLittle, i));
    writer.Message(json, ns,
                   "{\"timestamp\": {\"sec\": 1, \"nsec\": " + std::to_string(i) +
                       "}, \"frame_id\": \"map\", \"pose\": {\"position\": {\"x\": 0, \"y\": 0, "
                       "\"z\": 1}, \"orientation\": {\"x\": 0, \"y\": 0, \"z\": 0, \"w\": 1}}}");
  }
  return writer.records();
}

std::string BagRecords() {
  std::string records = house::BagConnection(0, "/tf", "tf2_msgs/TFMessage") +
                        house::BagConnection(1, "/tracker/more", "geometry_msgs/PoseStamped") +
                        house::BagConnection(2, "/bodies", "mine/Bodies", kBodies);
  for (int i = 0; i <= kFrames; ++i) {
    records += house::BagMessage(0, TimeOf(i), Transforms(Cdr::Kind::kRos1, i));
    records += house::BagMessage(2, TimeOf(i), Bodies(Cdr::Kind::kRos1, i));
    records += house::BagMessage(
        1, TimeOf(i), Cdr(Cdr::Kind::kRos1).Header(TimeOf(i), "map").Pose({0, 0.1, 1}).Bytes());
  }
  return records;
}

}  // namespace prehend::fuzz
