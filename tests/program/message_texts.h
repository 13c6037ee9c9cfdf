// SPDX-License-Identifier: Apache-2.0
// Definitions of message types as drivers of trackers have them, for tests.
#pragma once

namespace prehend::house {

/// Of ROS 1; markers have two numbers and no names.
inline constexpr const char* kNatNetFrame = R"(std_msgs/Header header
RigidBody[]     rigid_bodies # by name
Marker[]        labeled_markers
================================================================================
MSG: natnet_bridge/RigidBody
int32 id
string name
geometry_msgs/Pose pose
float32 error
bool track_valid
================================================================================
MSG: natnet_bridge/Marker
int32 model_id
int32 marker_id
geometry_msgs/Point position
bool b_occluded
)";

inline constexpr const char* kRigidBodies = R"(std_msgs/Header header
uint32 frame_number
RigidBody[] rigidbodies
================================================================================
MSG: mocap4r2_msgs/RigidBody
string rigid_body_name
mocap4r2_msgs/Marker[] markers
geometry_msgs/Pose pose
================================================================================
MSG: mocap4r2_msgs/Marker
int8 USE_NAME = 0
int8 USE_INDEX = 1
int8 id_type
int32 marker_index
string marker_name
geometry_msgs/Point translation
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/Pose
Point position
Quaternion orientation
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x 0
float64 y 0
float64 z 0
float64 w 1
)";

inline constexpr const char* kOdometry = R"(std_msgs/Header header
string child_frame_id
geometry_msgs/PoseWithCovariance pose
geometry_msgs/TwistWithCovariance twist
================================================================================
MSG: geometry_msgs/PoseWithCovariance
Pose pose
float64[36] covariance
================================================================================
MSG: geometry_msgs/TwistWithCovariance
Twist twist
float64[36] covariance
================================================================================
MSG: geometry_msgs/Twist
Vector3 linear
Vector3 angular
)";

/// As far as the pose.
inline constexpr const char* kMarkerArray = R"(Marker[] markers
================================================================================
MSG: visualization_msgs/Marker
std_msgs/Header header
string ns
int32 id
geometry_msgs/Pose pose
)";

inline constexpr const char* kModelStates = "string[] name\ngeometry_msgs/Pose[] pose\n";

inline constexpr const char* kTwoPoses =
    "Header header\ngeometry_msgs/Pose left\nWrapped right\n===\nMSG: mine/Wrapped\n"
    "geometry_msgs/Pose pose\n";

inline constexpr const char* kPointStamped = "std_msgs/Header header\ngeometry_msgs/Point point\n";

}  // namespace prehend::house
