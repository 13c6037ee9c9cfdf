// SPDX-License-Identifier: Apache-2.0
#include "tests/program/bag_writer.h"

#include "tests/program/mcap_writer.h"

namespace prehend::house {
namespace {

std::string Field(const std::string& name, const std::string& value) {
  return WithLength(name + "=" + value);
}

std::string Record(std::uint8_t opcode, const std::string& fields, const std::string& data) {
  return WithLength(fields + Field("op", std::string(1, static_cast<char>(opcode)))) +
         WithLength(data);
}

std::string TimeOf(std::uint64_t ns) {
  return Bytes32(static_cast<std::uint32_t>(ns / 1'000'000'000)) +
         Bytes32(static_cast<std::uint32_t>(ns % 1'000'000'000));
}

}  // namespace

std::string BagConnection(std::uint32_t id, const std::string& topic, const std::string& type,
                          const std::string& definition) {
  std::string fields = Field("topic", topic) + Field("type", type) + Field("md5sum", "*");
  if (!definition.empty()) fields += Field("message_definition", definition);
  return Record(7, Field("conn", Bytes32(id)) + Field("topic", topic), fields);
}

std::string BagMessage(std::uint32_t id, std::uint64_t ns, const std::string& data) {
  return Record(2, Field("conn", Bytes32(id)) + Field("time", TimeOf(ns)), data);
}

std::string BagChunk(const std::string& records, const std::string& compression) {
  if (compression.empty()) return records;
  return Record(5,
                Field("compression", compression) +
                    Field("size", Bytes32(static_cast<std::uint32_t>(records.size()))),
                compression == "lz4" ? AsLz4(records) : records);
}

std::string BagIndex(std::uint32_t id) { return Record(4, Field("conn", Bytes32(id)), "an index"); }

std::string BagHead() {
  return "#ROSBAG V2.0\n" +
         Record(3,
                Field("index_pos", Bytes64(0)) + Field("conn_count", Bytes32(2)) +
                    Field("chunk_count", Bytes32(0)),
                std::string(100, ' '));
}

}  // namespace prehend::house
