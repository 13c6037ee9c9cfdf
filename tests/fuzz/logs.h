// SPDX-License-Identifier: Apache-2.0
// Logs of robots that the fuzzers damage: a second of the bodies of
// docs/motion_capture/mcap_bodies.yaml, as tf and as other topics.
#pragma once

#include <string>

namespace prehend::fuzz {

/// Schemas, channels and messages of an MCAP file, with frames in frames and JSON.
std::string McapRecords();
/// Connections and messages of a bag of ROS 1.
std::string BagRecords();

}  // namespace prehend::fuzz
