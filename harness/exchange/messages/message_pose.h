// SPDX-License-Identifier: Apache-2.0
// A pose, as a message says it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace prehend::exchange {

inline constexpr std::uint32_t kMostPosesOfMessage = 10'000;
inline constexpr std::size_t kMostBodyNameBytes = 200;  ///< the rest of a name is not read

struct MessagePose {
  std::size_t field = 0;  ///< which of the type's pose fields
  /// Of each list on the way to it, from the outside: the element's name, or its number.
  std::vector<std::string> keys;
  /// Of a transform the child frame; of one of several named bodies its name.
  std::string name;
  std::string frame;                     ///< that it is measured in; "": not said
  std::optional<std::int64_t> stamp_ns;  ///< when it was measured, if the message says it
  bool missing = false;                  ///< not tracked
  bool oriented = true;                  ///< else its orientation is not known
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector4d xyzw = Eigen::Vector4d(0, 0, 0, 1);  ///< the fields x, y, z, w as they are
};

}  // namespace prehend::exchange
