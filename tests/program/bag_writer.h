// SPDX-License-Identifier: Apache-2.0
// Bags of ROS 1 for tests, written byte by byte from their specification
// (http://wiki.ros.org/Bags/Format/2.0). Messages for them are in tests/program/mcap_writer.h.
#pragma once

#include <cstdint>
#include <string>

namespace prehend::house {

std::string BagConnection(std::uint32_t id, const std::string& topic, const std::string& type,
                          const std::string& definition = "");
std::string BagMessage(std::uint32_t id, std::uint64_t ns, const std::string& data);
/// `compression`: "none", "lz4", or "": the records, without a chunk.
std::string BagChunk(const std::string& records, const std::string& compression);
/// What follows a chunk, and is not read.
std::string BagIndex(std::uint32_t id);
/// How a bag begins.
std::string BagHead();

}  // namespace prehend::house
