// SPDX-License-Identifier: Apache-2.0
// See harness/import/bag_file.h. A record is a header of named fields, and data. Chunks hold the
// records of connections and messages.
#include "harness/import/bag_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "harness/import/byte_reader.h"
#include "harness/import/unpack.h"

namespace prehend::harness::import {
namespace {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";
constexpr std::size_t kMostTopicBytes = 1000;

enum BagOpcode : std::uint8_t { kBagMessage = 2, kBagChunk = 5, kBagConnection = 7 };

using Fields = std::map<std::string, std::string_view, std::less<>>;

/// "name=value" with its length before it, one after another.
Fields FieldsOf(std::string_view header, bool& ok) {
  Fields fields;
  ByteReader reader{.bytes = header};
  while (reader.left() > 0 && reader.ok) {
    const std::string_view field = reader.Text();
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) reader.ok = false;
    if (reader.ok) fields.emplace(field.substr(0, equals), field.substr(equals + 1));
  }
  ok = ok && reader.ok;
  return fields;
}

class BagReader {
 public:
  BagReader(std::istream& in, std::uint64_t size, const McapTaker& take,
            const std::function<void(const McapChannel&)>& channels)
      : in_(in), size_(size), take_(take), tell_(channels) {}

  std::string Read() {
    if (size_ > kMaxMcapBytes) return fmt::format("it is larger than {} GiB", kMaxMcapBytes >> 30);
    if (Take(kBagMagic.size()) != kBagMagic)
      return "it is no bag of ROS 1, version 2.0: it does not begin as one";
    while (at_ < size_ && problem_.empty()) ReadRecord();
    return problem_;
  }

 private:
  /// The next bytes of the file. Fewer at its end.
  std::string Take(std::uint64_t count) {
    std::string bytes(static_cast<std::size_t>(std::min(count, size_ - at_)), '\0');
    in_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(in_.gcount()));
    at_ += bytes.size();
    return bytes;
  }

  void Fail(std::string why) {
    if (problem_.empty()) problem_ = fmt::format("at byte {}: {}", record_at_, why);
  }

  /// With its length before it; "" after an error.
  std::string TakePart() {
    const std::string head = Take(4);
    ByteReader reader{.bytes = head};
    const auto length = reader.Number<std::uint32_t>();
    if (!reader.ok || length > size_ - at_) {
      Fail(
          "the file is cut off: it ends within a record; if its recorder was killed, 'rosbag "
          "reindex' "
          "saves the rest");
      return "";
    }
    if (length > kMaxMcapRecordBytes) {
      Fail(fmt::format("a record of {} MiB; at most {} MiB are read", length >> 20,
                       kMaxMcapRecordBytes >> 20));
      return "";
    }
    return Take(length);
  }

  void ReadRecord() {
    record_at_ = at_;
    const std::string header = TakePart(), data = TakePart();
    if (!problem_.empty()) return;
    bool ok = true;
    const Fields fields = FieldsOf(header, ok);
    if (!ok) return Fail("a damaged record: its header is no list of fields");
    if (Number<std::uint8_t>(fields, "op") == kBagChunk) return ReadChunk(fields, data);
    TakeRecord(fields, data);
  }

  template <class T>
  T Number(const Fields& fields, std::string_view name) {
    const auto field = fields.find(name);
    if (field == fields.end() || field->second.size() != sizeof(T)) {
      Fail(fmt::format("a record without a whole '{}'", name));
      return T{};
    }
    ByteReader reader{.bytes = field->second};
    return reader.Number<T>();
  }

  void ReadChunk(const Fields& fields, std::string_view packed) {
    const auto size = Number<std::uint32_t>(fields, "size");
    const auto field = fields.find("compression");
    const std::string_view compression = field == fields.end() ? "none" : field->second;
    if (size > kMaxMcapRecordBytes)
      return Fail(fmt::format("a chunk of {} MiB; at most {} MiB are read", size >> 20,
                              kMaxMcapRecordBytes >> 20));
    content_bytes_ += size;
    if (content_bytes_ > kMaxMcapContentBytes)
      return Fail(fmt::format("more than {} GiB of messages", kMaxMcapContentBytes >> 30));
    std::string records;
    if (compression == "lz4")
      records = FromLz4(packed, size);
    else if (compression == "none")
      records = packed;
    else
      return Fail(
          fmt::format("a chunk with the compression '{}'; lz4 and none are read: 'rosbag "
                      "decompress' makes such a file",
                      compression.substr(0, 40)));
    if (records.size() != size) return Fail("a damaged chunk: it cannot be decompressed");
    ByteReader inner{.bytes = records};
    while (inner.left() > 0 && problem_.empty()) {
      bool ok = true;
      const Fields inner_fields = FieldsOf(inner.Text(), ok);
      const std::string_view data = inner.Text();
      if (!inner.ok || !ok) return Fail("a damaged chunk: a record ends behind it");
      TakeRecord(inner_fields, data);
    }
  }

  void TakeRecord(const Fields& fields, std::string_view data) {
    const auto opcode = Number<std::uint8_t>(fields, "op");
    if (opcode == kBagConnection) TakeConnection(fields, data);
    if (opcode == kBagMessage) TakeMessage(fields, data);
  }

  void TakeConnection(const Fields& fields, std::string_view data) {
    const auto id = Number<std::uint32_t>(fields, "conn");
    bool ok = true;
    const Fields of_topic = FieldsOf(data, ok);
    const auto topic = fields.find("topic"), type = of_topic.find("type");
    if (!ok || topic == fields.end() || type == of_topic.end())
      return Fail("a connection without a topic or a type");
    if (std::max(topic->second.size(), type->second.size()) > kMostTopicBytes)
      return Fail("a name of more than 1000 bytes");
    const McapChannel channel{.topic = std::string(topic->second),
                              .message_encoding = "ros1",
                              .schema = std::string(type->second),
                              .schema_encoding = "ros1msg"};
    const auto [known, is_new] = connections_.try_emplace(id, channel);
    if (is_new) return tell_(known->second);
    if (known->second.topic != channel.topic)
      Fail(fmt::format("connection {} is '{}' and '{}'", id, known->second.topic, channel.topic));
  }

  void TakeMessage(const Fields& fields, std::string_view data) {
    const auto id = Number<std::uint32_t>(fields, "conn");
    const auto time = Number<std::uint64_t>(fields, "time");
    if (!problem_.empty()) return;
    const auto connection = connections_.find(id);
    if (connection == connections_.end())
      return Fail(fmt::format("a message of connection {}, which is not there", id));
    // Seconds in the lower half, nanoseconds in the upper one.
    const auto ns = static_cast<std::int64_t>((time & 0xffffffffU) * 1'000'000'000 + (time >> 32));
    const std::string why =
        take_({.channel = connection->second, .log_ns = ns, .publish_ns = ns, .data = data});
    if (!why.empty()) Fail(why);
  }

  std::istream& in_;
  const std::uint64_t size_;
  const McapTaker& take_;
  const std::function<void(const McapChannel&)>& tell_;
  std::uint64_t at_ = 0, record_at_ = 0, content_bytes_ = 0;
  std::map<std::uint32_t, McapChannel> connections_;
  std::string problem_;
};

}  // namespace

std::string ReadBag(std::istream& in, std::uint64_t size, const McapTaker& take,
                    const std::function<void(const McapChannel&)>& channels) {
  return BagReader(in, size, take, channels).Read();
}

}  // namespace prehend::harness::import
