// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/messages/known_types.h. From the packages std_msgs, geometry_msgs, tf and
// tf2_msgs.
#include "harness/exchange/messages/known_types.h"

#include <map>

namespace prehend::exchange {

std::string_view TextOfKnownType(std::string_view type, bool ros1) {
  if (type == "std_msgs/Header")
    return ros1 ? "uint32 seq\ntime stamp\nstring frame_id" : "time stamp\nstring frame_id";
  static const std::map<std::string_view, std::string_view> kTexts = {
      {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z"},
      {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z"},
      {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w"},
      {"geometry_msgs/Pose", "Point position\nQuaternion orientation"},
      {"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation"},
      {"geometry_msgs/PoseStamped", "Header header\nPose pose"},
      {"geometry_msgs/PoseArray", "Header header\nPose[] poses"},
      {"geometry_msgs/TransformStamped",
       "Header header\nstring child_frame_id\nTransform transform"},
      {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms"},
      {"tf/tfMessage", "geometry_msgs/TransformStamped[] transforms"}};
  const auto known = kTexts.find(type);
  return known == kTexts.end() ? std::string_view() : known->second;
}

}  // namespace prehend::exchange
