// SPDX-License-Identifier: Apache-2.0
// Messages of ROS 2 in CDR, and the definitions of their types. Tested by tests/mcap/mcap_test.mjs
#pragma once

#include <span>
#include <string>

#include "harness/exchange/export/motion.h"

namespace prehend::exchange {

/// Of these types: "tf2_msgs/msg/TFMessage", "visualization_msgs/msg/MarkerArray",
/// "sensor_msgs/msg/JointState", "sensor_msgs/msg/PointCloud2", "std_msgs/msg/String".
std::string RosDefinition(const std::string& type);

/// A frame of coordinates in the world.
struct FramePose {
  const std::string* name = nullptr;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};
std::string TransformsMessage(std::uint64_t ns, const std::string& world,
                              std::span<const FramePose> frames);

/// What each entity looks like, fixed to the frame that has its name.
std::string ShapesMessage(std::uint64_t ns, const grammar::EntityTable& table);

/// The same of one of them in points, for viewers without markers.
std::string OutlineMessage(std::uint64_t ns, const grammar::EntityInfo& entity);

struct JointValue {
  std::string name;
  double position = 0;
};
std::string JointsMessage(std::uint64_t ns, std::span<const JointValue> joints);

std::string StringMessage(const std::string& text);

}  // namespace prehend::exchange
