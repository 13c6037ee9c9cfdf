// SPDX-License-Identifier: Apache-2.0
// Definitions of types that everybody uses, for files that lack them.
#pragma once

#include <string_view>

namespace prehend::exchange {

/// The definition of "geometry_msgs/Pose" and its like, or "".
std::string_view TextOfKnownType(std::string_view type, bool ros1);

}  // namespace prehend::exchange
