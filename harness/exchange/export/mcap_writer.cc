// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/export/mcap_writer.h. Tested by tests/mcap/mcap_test.mjs
#include "harness/exchange/export/mcap_writer.h"

#include <zlib.h>

#include <algorithm>
#include <utility>

namespace prehend::exchange {
namespace {

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

}  // namespace

std::string QosText(bool latched) {
  return std::string("- history: 1\n  depth: ") + (latched ? "1" : "100") +
         "\n  reliability: 1\n  durability: " + (latched ? "1" : "2") +
         "\n  deadline:\n    sec: 9223372036\n    nsec: 854775807\n  lifespan:\n    sec: "
         "9223372036\n    nsec: 854775807\n  liveliness: 1\n  liveliness_lease_duration:\n    sec: "
         "9223372036\n    nsec: 854775807\n  avoid_ros_namespace_conventions: false";
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

}  // namespace prehend::exchange
