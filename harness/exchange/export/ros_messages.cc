// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/export/ros_messages.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "harness/exchange/export/byte_writer.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/scene/hull.h"

namespace prehend::exchange {
namespace {

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
