// SPDX-License-Identifier: Apache-2.0
// An MCAP file (https://mcap.dev/spec, version 0) as rosbag2 of ROS 2 writes it: chunks with
// checksums, an index of the messages of each, definitions, counts. Tested by
// tests/mcap/mcap_test.mjs
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/exchange/export/export_episode.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/scene/hull.h"

namespace prehend::exchange {
namespace {

struct McapTopic {
  std::string topic, type, definition;
  bool latched = false;  ///< who subscribes later gets the last message, too
  std::uint64_t messages = 0;
};

class McapWriter {
 public:
  explicit McapWriter(std::ostream& out);

  /// Returns its number. All topics come before the first message.
  std::size_t AddTopic(McapTopic topic);
  void Message(std::size_t topic, std::uint64_t ns, const std::string& cdr);
  void Finish();

  const std::vector<McapTopic>& topics() const { return topics_; }
  std::uint64_t messages() const { return messages_; }
  std::uint64_t first_ns() const { return first_ns_; }
  std::uint64_t last_ns() const { return last_ns_; }

 private:
  struct Entry {
    std::uint64_t ns = 0, offset = 0;
  };
  void Put(std::string_view bytes);
  void EndChunk();
  std::string Schemas() const;
  std::string Channels() const;
  std::string Statistics() const;

  std::ostream& out_;
  std::uint64_t at_ = 0, messages_ = 0, first_ns_ = 0, last_ns_ = 0, chunks_ = 0;
  std::uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0;
  std::vector<McapTopic> topics_;
  std::string chunk_;                        ///< its records so far
  std::vector<std::vector<Entry>> entries_;  ///< by topic, of the chunk
  std::string chunk_indexes_;                ///< of the summary
};

constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
constexpr std::size_t kChunkBytes = 768 * 1024;

enum McapRecord : std::uint8_t {
  kMcapHeader = 1,
  kMcapFooter = 2,
  kMcapSchema = 3,
  kMcapChannel = 4,
  kMcapMessage = 5,
  kMcapChunk = 6,
  kMcapMessageIndex = 7,
  kMcapChunkIndex = 8,
  kMcapStatistics = 11,
  kMcapSummaryOffset = 14,
  kMcapDataEnd = 15,
};

std::string RecordOf(McapRecord opcode, const ByteWriter& content) {
  return ByteWriter{}.Number(opcode).U64(content.bytes.size()).bytes + content.bytes;
}

std::uint32_t Crc(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// The begins and ends of events, by time.
std::vector<std::pair<grammar::Tick, std::string>> EdgesOf(const Motion& motion) {
  std::vector<std::pair<grammar::Tick, std::string>> edges;
  for (std::size_t i = 0; i < motion.timeline.events.size(); ++i) {
    const grammar::NamedEvent& event = motion.timeline.events[i];
    nlohmann::ordered_json json = {{"event", event.event},
                                   {"edge", "begin"},
                                   {"roles", nlohmann::ordered_json::parse(RolesJson(event))},
                                   {"begin_s", motion.Seconds(event.interval.begin)},
                                   {"end_s", motion.Seconds(event.interval.end)},
                                   {"open_end", event.open_end},
                                   {"uuid", motion.uuids[i]}};
    edges.emplace_back(event.interval.begin, json.dump());
    json["edge"] = "end";
    edges.emplace_back(event.interval.end, json.dump());
  }
  std::ranges::stable_sort(edges, {}, &std::pair<grammar::Tick, std::string>::first);
  return edges;
}

/// The quality of service that rosbag2 notes for a topic.
std::string QosText(bool latched) {
  return std::string("- history: 1\n  depth: ") + (latched ? "1" : "100") +
         "\n  reliability: 1\n  durability: " + (latched ? "1" : "2") +
         "\n  deadline:\n    sec: 9223372036\n    nsec: 854775807\n  lifespan:\n    sec: "
         "9223372036\n    nsec: 854775807\n  liveliness: 1\n  liveliness_lease_duration:\n    sec: "
         "9223372036\n    nsec: 854775807\n  avoid_ros_namespace_conventions: false";
}

std::string BagMetadata(const McapWriter& bag, const std::string& file) {
  const std::uint64_t length_ns = bag.last_ns() - bag.first_ns();
  const auto times = [&](const char* indent) {
    return fmt::format("{0}starting_time:\n{0}  nanoseconds_since_epoch: {1}\n", indent,
                       bag.first_ns()) +
           fmt::format("{0}duration:\n{0}  nanoseconds: {1}\n{0}message_count: {2}\n", indent,
                       length_ns, bag.messages());
  };
  std::string text = "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n" +
                     times("  ") + "  topics_with_message_count:\n";
  for (const McapTopic& topic : bag.topics()) {
    const std::string qos = nlohmann::json(QosText(topic.latched)).dump();
    text += fmt::format(
        "    - topic_metadata:\n        name: {}\n        type: {}\n"
        "        serialization_format: cdr\n        offered_qos_profiles: {}\n"
        "      message_count: {}\n",
        topic.topic, topic.type, qos, topic.messages);
  }
  const std::string quoted = nlohmann::json(file).dump();
  return text +
         "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - " +
         quoted + "\n  files:\n    - path: " + quoted + "\n" + times("      ");
}

/// Names of topics have letters, digits and underscores.
std::string TopicOf(const std::string& entity, std::size_t number) {
  std::string word = entity;
  for (char& c : word) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return "/shapes/" + (word == entity ? word : fmt::format("{}_{}", word, number));
}

McapWriter::McapWriter(std::ostream& out) : out_(out) {
  Put(kMcapMagic);
  Put(RecordOf(kMcapHeader, ByteWriter{}.Text("ros2").Text("prehend")));
}

void McapWriter::Put(std::string_view bytes) {
  out_ << bytes;
  at_ += bytes.size();
}

std::size_t McapWriter::AddTopic(McapTopic topic) {
  topics_.push_back(std::move(topic));
  entries_.emplace_back();
  return topics_.size() - 1;
}

std::string McapWriter::Schemas() const {
  std::string schemas;
  for (std::size_t i = 0; i < topics_.size(); ++i)
    schemas += RecordOf(
        kMcapSchema,
        ByteWriter{}.U16(i + 1).Text(topics_[i].type).Text("ros2msg").Text(topics_[i].definition));
  return schemas;
}

std::string McapWriter::Channels() const {
  std::string channels;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    const McapTopic& topic = topics_[i];
    const std::string metadata =
        ByteWriter{}.Text("offered_qos_profiles").Text(QosText(topic.latched)).bytes;
    channels += RecordOf(
        kMcapChannel, ByteWriter{}.U16(i).U16(i + 1).Text(topic.topic).Text("cdr").Text(metadata));
  }
  return channels;
}

void McapWriter::Message(std::size_t topic, std::uint64_t ns, const std::string& cdr) {
  if (chunk_.empty()) {
    if (chunks_ == 0) chunk_ = Schemas() + Channels();
    chunk_first_ns_ = chunk_last_ns_ = ns;
  }
  first_ns_ = messages_ == 0 ? ns : std::min(first_ns_, ns);
  last_ns_ = std::max(last_ns_, ns);
  chunk_first_ns_ = std::min(chunk_first_ns_, ns);
  chunk_last_ns_ = std::max(chunk_last_ns_, ns);
  entries_[topic].push_back({ns, chunk_.size()});
  ByteWriter message;
  message.U16(topic).U32(topics_[topic].messages++).U64(ns).U64(ns).bytes += cdr;
  chunk_ += RecordOf(kMcapMessage, message);
  ++messages_;
  if (chunk_.size() >= kChunkBytes) EndChunk();
}

void McapWriter::EndChunk() {
  if (chunk_.empty()) return;
  const std::uint64_t begin = at_;
  ByteWriter chunk;
  chunk.U64(chunk_first_ns_).U64(chunk_last_ns_).U64(chunk_.size()).U32(Crc(chunk_)).Text("");
  chunk.U64(chunk_.size()).bytes += chunk_;
  Put(RecordOf(kMcapChunk, chunk));
  const std::uint64_t end = at_;
  ByteWriter offsets;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].empty()) continue;
    offsets.U16(i).U64(at_);
    ByteWriter list;
    for (const Entry& entry : entries_[i]) list.U64(entry.ns).U64(entry.offset);
    Put(RecordOf(kMcapMessageIndex, ByteWriter{}.U16(i).Text(list.bytes)));
    entries_[i].clear();
  }
  ByteWriter index;
  index.U64(chunk_first_ns_).U64(chunk_last_ns_).U64(begin).U64(end - begin).Text(offsets.bytes);
  index.U64(at_ - end).Text("").U64(chunk_.size()).U64(chunk_.size());
  chunk_indexes_ += RecordOf(kMcapChunkIndex, index);
  ++chunks_;
  chunk_.clear();
}

std::string McapWriter::Statistics() const {
  ByteWriter counts;
  for (std::size_t i = 0; i < topics_.size(); ++i) counts.U16(i).U64(topics_[i].messages);
  ByteWriter statistics;
  statistics.U64(messages_).U16(topics_.size()).U32(topics_.size()).U32(0).U32(0).U32(chunks_);
  statistics.U64(first_ns_).U64(last_ns_).Text(counts.bytes);
  return RecordOf(kMcapStatistics, statistics);
}

void McapWriter::Finish() {
  EndChunk();
  Put(RecordOf(kMcapDataEnd, ByteWriter{}.U32(0)));
  const std::uint64_t begin = at_;
  std::string summary, offsets;
  const auto add = [&](McapRecord opcode, const std::string& group) {
    if (!group.empty())
      offsets +=
          RecordOf(kMcapSummaryOffset,
                   ByteWriter{}.Number(opcode).U64(begin + summary.size()).U64(group.size()));
    summary += group;
  };
  add(kMcapSchema, Schemas());
  add(kMcapChannel, Channels());
  add(kMcapStatistics, Statistics());
  add(kMcapChunkIndex, chunk_indexes_);
  const std::uint64_t offsets_begin = begin + summary.size();
  summary += offsets;
  ByteWriter footer;
  footer.Number(kMcapFooter).U64(20).U64(begin).U64(offsets_begin);
  summary += footer.bytes;
  Put(summary + ByteWriter{}.U32(Crc(summary)).bytes);
  Put(kMcapMagic);
}

/// Fields of the types of ROS 2 Humble and later.
const std::map<std::string, std::string> kRosTypes = {
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"},
    {"std_msgs/String", "string data\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
    {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    {"geometry_msgs/Transform",
     "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    {"sensor_msgs/JointState",
     "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
     "float64[] effort\n"},
    {"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
    {"sensor_msgs/PointField", "string name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    {"sensor_msgs/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
     "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
    {"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"},
    {"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"},
    {"visualization_msgs/Marker",
     "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\n"
     "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\n"
     "builtin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\n"
     "std_msgs/ColorRGBA[] colors\nstring texture_resource\nsensor_msgs/CompressedImage texture\n"
     "visualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\n"
     "visualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n"},
    {"visualization_msgs/MarkerArray", "visualization_msgs/Marker[] markers\n"},
};

void PutHeader(CdrWriter& out, std::uint64_t ns, const std::string& frame) {
  out.U32(ns / 1'000'000'000).U32(ns % 1'000'000'000);
  out.String(frame);
}
void PutVector(CdrWriter& out, const Eigen::Vector3d& v) { out.F64(v.x()).F64(v.y()).F64(v.z()); }
void PutQuaternion(CdrWriter& out, const Eigen::Quaterniond& q) {
  out.F64(q.x()).F64(q.y()).F64(q.z()).F64(q.w());
}

constexpr int kRosCube = 1, kRosSphere = 2, kRosCylinder = 3, kRosTriangles = 11;

/// A marker: a solid, with the edges of the box around it as its scale.
struct RosMarker {
  int type = kRosCube;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones(), p_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  std::vector<Eigen::Vector3d> points = {};
};

struct MarkersOf {
  const grammar::SolidPart& part;
  std::vector<RosMarker>& all;

  void Add(int type, const Eigen::Vector3d& scale, double along_m = 0) const {
    all.push_back(
        {type, scale, part.p_BS_m + part.q_BS * Eigen::Vector3d(0, 0, along_m), part.q_BS});
  }
  void operator()(const grammar::Box& box) const { Add(kRosCube, 2 * box.half_size_m); }
  void operator()(const grammar::Ball& ball) const {
    Add(kRosSphere, Eigen::Vector3d::Constant(2 * ball.radius_m));
  }
  void operator()(const grammar::Cylinder& c) const {
    Add(kRosCylinder, 2 * Eigen::Vector3d(c.radius_m, c.radius_m, c.half_length_m));
  }
  void operator()(const grammar::Capsule& c) const {
    (*this)(grammar::Cylinder{c.radius_m, c.half_length_m});
    for (const double end_m : {-c.half_length_m, c.half_length_m})
      Add(kRosSphere, Eigen::Vector3d::Constant(2 * c.radius_m), end_m);
  }
  void operator()(const grammar::Hull& hull) const {
    const physics::MadeHull made = physics::MakeHull(hull.points_m);
    if (!made.hull) return;
    Add(kRosTriangles, Eigen::Vector3d::Ones());
    for (const auto& face : made.hull->faces) {
      for (std::size_t i = 2; i < face.corners.size(); ++i) {
        for (const std::size_t corner : {std::size_t{0}, i - 1, i})
          all.back().points.push_back(made.hull->corners_m[face.corners[corner]]);
      }
    }
  }
};

std::vector<RosMarker> MarkersIn(const grammar::EntityInfo& entity) {
  std::vector<RosMarker> markers;
  for (const grammar::SolidPart& part : entity.solid.parts())
    std::visit(MarkersOf{part, markers}, part.shape);
  if (markers.empty())
    markers.push_back({.type = entity.round ? kRosSphere : kRosCube,
                       .scale = 2 * entity.half_size_m,
                       .p_m = entity.p_BC_m});
  return markers;
}

/// Points on it, in the entity's axes: of a box on its edges, of what is round on three circles.
void AddOutline(const RosMarker& marker, std::vector<Eigen::Vector3d>& points) {
  constexpr int kSteps = 24;
  for (const Eigen::Vector3d& corner : marker.points) points.push_back(corner);
  for (int i = 0; i < kSteps && marker.points.empty(); ++i) {
    for (const int axis : {0, 1, 2}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (const int edge : {0, 1, 2, 3}) {
        Eigen::Vector3d p;
        const double angle = 2 * static_cast<double>(EIGEN_PI) * (i + 0.25 * edge) / kSteps;
        if (marker.type == kRosCube) {
          p[axis] = static_cast<double>(i) / kSteps - 0.5;
          p[u] = edge % 2 - 0.5;
          p[v] = edge / 2 - 0.5;
        } else {
          p[axis] = 0;
          p[u] = std::cos(angle) / 2;
          p[v] = std::sin(angle) / 2;
          if (marker.type == kRosCylinder && axis == 2) p.z() = edge % 2 - 0.5;
        }
        points.push_back(marker.p_m + marker.q * p.cwiseProduct(marker.scale));
      }
    }
  }
}

void PutColor(CdrWriter& out, const grammar::EntityInfo& entity) {
  constexpr std::uint32_t kSkin = 0xE0B090, kGrey = 0xA0A4AA;
  const std::string& own = entity.classes.front();
  std::optional<std::uint32_t> rgb = scenario::ColorInName(entity.name);
  if (!rgb) rgb = scenario::ColorOfClass(own);
  const std::uint32_t color = rgb.value_or(own == "Hand" ? kSkin : kGrey);
  for (const int shift : {16, 8, 0}) out.Number(static_cast<float>(color >> shift & 0xFF) / 255);
  const bool is_body = std::ranges::find(entity.classes, "Abstract") == entity.classes.end();
  out.Number(is_body ? 1.0F : 0.25F);
}

void PutMarker(CdrWriter& out, std::uint64_t ns, int id, const RosMarker& marker,
               const grammar::EntityInfo& entity) {
  PutHeader(out, ns, entity.name);
  out.String(entity.name);
  for (const int number : {id, marker.type, 0}) out.Number(number);  // 0: add
  PutVector(out, marker.p_m);
  PutQuaternion(out, marker.q);
  PutVector(out, marker.scale);
  PutColor(out, entity);
  out.U32(0).U32(0).Number(std::uint8_t{1});  // it stays for ever, and with its frame
  out.U32(marker.points.size());
  for (const Eigen::Vector3d& point : marker.points) PutVector(out, point);
  out.U32(0);  // colours
  out.String("");
  PutHeader(out, 0, "");  // texture
  out.String("").U32(0).U32(0);
  out.String("").String("").String("").U32(0).Number(std::uint8_t{0});
}

}  // namespace

std::string WorldName(const grammar::EntityTable& table) {
  std::string name = "world";
  const auto is_taken = [&](const grammar::EntityInfo& entity) { return entity.name == name; };
  while (std::ranges::any_of(table.entities, is_taken)) name += "_";
  return name;
}

std::string WriteMcap(const Motion& motion, const std::string& name, std::ostream& out) {
  McapWriter bag(out);
  const auto topic = [&](const std::string& called, const std::string& type, bool latched = false) {
    return bag.AddTopic({called, type, RosDefinition(type), latched});
  };
  const std::size_t still = topic("/tf_static", "tf2_msgs/msg/TFMessage", true),
                    shapes = topic("/markers", "visualization_msgs/msg/MarkerArray", true),
                    moving = topic("/tf", "tf2_msgs/msg/TFMessage"),
                    joints = topic("/joint_states", "sensor_msgs/msg/JointState"),
                    events = topic("/events", "std_msgs/msg/String");
  const grammar::EntityTable& table = motion.table();
  std::vector<std::size_t> outlines;
  for (const grammar::EntityInfo& entity : table.entities)
    outlines.push_back(
        topic(TopicOf(entity.name, outlines.size()), "sensor_msgs/msg/PointCloud2", true));
  const std::string world = WorldName(table);
  std::vector<FramePose> frames;
  // The rest are seen by the clock of what moves all the time.
  const bool has_clock = std::ranges::any_of(motion.seen, [&](const Motion::Seen& seen) {
    return seen.moves && seen.looks == motion.frames;
  });
  std::vector<bool> stands;
  for (std::size_t i = 0; i < table.entities.size(); ++i) {
    const Motion::Seen& seen = motion.seen[i];
    stands.push_back(has_clock && !seen.moves && seen.looks == motion.frames);
    if (stands[i] && seen.looks > 0)
      frames.push_back({&table.entities[i].name, seen.first.p_WB_m, seen.first.q_WB});
  }
  bag.Message(shapes, 0, ShapesMessage(0, table));
  for (std::size_t i = 0; i < table.entities.size(); ++i)
    bag.Message(outlines[i], 0, OutlineMessage(0, table.entities[i]));
  if (!frames.empty()) bag.Message(still, 0, TransformsMessage(0, world, frames));
  const auto edges = EdgesOf(motion);
  auto edge = edges.begin();
  const auto tell_events = [&](grammar::Tick until) {
    for (; edge != edges.end() && edge->first <= until; ++edge)
      bag.Message(events, motion.Nanoseconds(edge->first), StringMessage(edge->second));
  };
  std::vector<JointValue> values;
  motion.EachFrame([&](const grammar::Frame& frame) {
    tell_events(frame.tick);
    const std::uint64_t ns = motion.Nanoseconds(frame.tick);
    frames.clear();
    values.clear();
    for (std::size_t i = 0; i < frame.entities.size(); ++i) {
      const grammar::EntitySample& look = frame.entities[i];
      if (!stands[i] && grammar::IsMeasured(look))
        frames.push_back({&table.entities[i].name, look.p_WB_m, look.q_WB});
      if (motion.seen[i].has_joint && grammar::IsMeasured(look))
        values.push_back({table.entities[i].name, look.joint_position});
    }
    for (const grammar::HandSample& hand : frame.hands)
      values.push_back({table.entities[hand.entity].name + "_grip", hand.trigger});
    bag.Message(moving, ns, TransformsMessage(ns, world, frames));
    if (!values.empty()) bag.Message(joints, ns, JointsMessage(ns, values));
  });
  tell_events(std::max(motion.end_tick, edges.empty() ? 0 : edges.back().first));
  bag.Finish();
  return BagMetadata(bag, name);
}

std::string RosDefinition(const std::string& type) {
  std::string name = type;
  name.erase(name.find("msg/"), 4);
  std::string text = kRosTypes.at(name);
  for (const auto& [part, fields] : kRosTypes)  // also those that it does not need
    text += std::string(80, '=') + "\nMSG: " + part + "\n" + fields;
  return text;
}

std::string TransformsMessage(std::uint64_t ns, const std::string& world,
                              std::span<const FramePose> frames) {
  CdrWriter out;
  out.U32(frames.size());
  for (const FramePose& frame : frames) {
    PutHeader(out, ns, world);
    out.String(*frame.name);
    PutVector(out, frame.p);
    PutQuaternion(out, frame.q);
  }
  return out.bytes;
}

std::string ShapesMessage(std::uint64_t ns, const grammar::EntityTable& table) {
  CdrWriter out;
  std::uint32_t count = 0;
  out.U32(count);
  for (const grammar::EntityInfo& entity : table.entities) {
    for (int id = 0; const RosMarker& marker : MarkersIn(entity)) {
      if (marker.scale.isZero(0)) continue;
      PutMarker(out, ns, id++, marker, entity);
      ++count;
    }
  }
  out.bytes.replace(out.origin, sizeof count, ByteWriter{}.Number(count).bytes);
  return out.bytes;
}

std::string OutlineMessage(std::uint64_t ns, const grammar::EntityInfo& entity) {
  constexpr std::uint8_t kFloat32 = 7, kNo = 0, kYes = 1;
  std::vector<Eigen::Vector3d> points;
  for (const RosMarker& marker : MarkersIn(entity)) AddOutline(marker, points);
  CdrWriter out;
  PutHeader(out, ns, entity.name);
  out.U32(1).U32(points.size()).U32(3);
  for (const int axis : {0, 1, 2}) {
    out.String(std::string(1, "xyz"[axis]));
    out.U32(4 * static_cast<std::size_t>(axis)).Number(kFloat32).U32(1);
  }
  out.Number(kNo).U32(12).U32(12 * points.size()).U32(12 * points.size());
  for (const Eigen::Vector3d& p : points)
    for (const double value : p) out.Number(static_cast<float>(value));
  out.Number(kYes);
  return out.bytes;
}

std::string JointsMessage(std::uint64_t ns, std::span<const JointValue> joints) {
  CdrWriter out;
  PutHeader(out, ns, "");
  out.U32(joints.size());
  for (const JointValue& joint : joints) out.String(joint.name);
  out.U32(joints.size());
  for (const JointValue& joint : joints) out.F64(joint.position);
  out.U32(0).U32(0);  // velocities, efforts
  return out.bytes;
}

std::string StringMessage(const std::string& text) {
  CdrWriter out;
  out.String(text);
  return out.bytes;
}

}  // namespace prehend::exchange
