// SPDX-License-Identifier: Apache-2.0
// See harness/import/mcap_file.h. Tested by tests/program/import_mcap_test.cc
#include "harness/import/mcap_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <map>

#include "harness/import/byte_reader.h"
#include "harness/import/unpack.h"

namespace prehend::harness::import {
namespace {

constexpr std::string_view kMagic = "\x89MCAP0\r\n";
constexpr std::size_t kMostNameBytes = 1000;

enum Opcode : std::uint8_t {
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kDataEnd = 15,
};

class McapReader {
 public:
  McapReader(std::istream& in, std::uint64_t size, const McapTaker& take,
             const std::function<void(const McapChannel&)>& channels)
      : in_(in), size_(size), take_(take), tell_(channels) {}

  std::string Read() {
    if (size_ > kMaxMcapBytes) return fmt::format("it is larger than {} GiB", kMaxMcapBytes >> 30);
    if (Take(kMagic.size()) != kMagic) return "it is no MCAP file: it does not begin as one";
    while (!ended_ && problem_.empty()) ReadRecord();
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

  void ReadRecord() {
    record_at_ = at_;
    const std::string head = Take(9);
    ByteReader reader{.bytes = head};
    const auto opcode = reader.Number<std::uint8_t>();
    const auto length = reader.Number<std::uint64_t>();
    if (!reader.ok || length > size_ - at_)
      return Fail(
          "the file is cut off: it ends within a record; if its recorder was killed, 'mcap "
          "recover' of the MCAP tools saves the rest");
    if (opcode == kFooter) {
      ended_ = true;
      Take(length);
      if (Take(kMagic.size()) != kMagic) Fail("the file is cut off in its last bytes");
      return;
    }
    const bool matters = opcode == kSchema || opcode == kChannel || opcode == kMessage ||
                         opcode == kChunk || opcode == kHeader;
    if (!matters || summary_) {
      summary_ = summary_ || opcode == kDataEnd;
      in_.seekg(static_cast<std::streamoff>(length), std::ios::cur);
      at_ += length;
      return;
    }
    if (length > kMaxMcapRecordBytes)
      return Fail(fmt::format("a record of {} MiB; at most {} MiB are read", length >> 20,
                              kMaxMcapRecordBytes >> 20));
    const std::string content = Take(length);
    if (opcode == kChunk) return ReadChunk(content);
    TakeRecord(opcode, content);
  }

  void ReadChunk(std::string_view content) {
    ByteReader reader{.bytes = content};
    reader.Bytes(16);  // its times
    const auto size = reader.Number<std::uint64_t>();
    const auto checksum = reader.Number<std::uint32_t>();
    const std::string compression(reader.Text());
    const std::string_view packed = reader.Bytes(reader.Number<std::uint64_t>());
    if (!reader.ok) return Fail("a chunk that ends before its end");
    if (size > kMaxMcapRecordBytes)
      return Fail(fmt::format("a chunk of {} MiB; at most {} MiB are read", size >> 20,
                              kMaxMcapRecordBytes >> 20));
    content_bytes_ += size;
    if (content_bytes_ > kMaxMcapContentBytes)
      return Fail(fmt::format("more than {} GiB of messages", kMaxMcapContentBytes >> 30));
    const auto bytes = static_cast<std::size_t>(size);
    std::string records;
    if (compression == "zstd")
      records = FromZstd(packed, bytes);
    else if (compression == "lz4")
      records = FromLz4(packed, bytes);
    else if (compression.empty())
      records = packed;
    else
      return Fail(fmt::format("a chunk with the compression '{}'; zstd, lz4 and none are read",
                              compression.substr(0, 40)));
    if (records.size() != size) return Fail("a damaged chunk: it cannot be decompressed");
    const auto seen = static_cast<std::uint32_t>(
        crc32_z(0, reinterpret_cast<const Bytef*>(records.data()), records.size()));
    if (checksum != 0 && checksum != seen) return Fail("a damaged chunk: its checksum is wrong");
    ByteReader inner{.bytes = records};
    while (inner.left() > 0 && problem_.empty()) {
      const auto opcode = inner.Number<std::uint8_t>();
      const std::string_view record = inner.Bytes(inner.Number<std::uint64_t>());
      if (!inner.ok) return Fail("a damaged chunk: a record ends behind it");
      TakeRecord(opcode, record);
    }
  }

  void TakeRecord(std::uint8_t opcode, std::string_view content) {
    ByteReader reader{.bytes = content};
    if (opcode == kSchema) TakeSchema(reader);
    if (opcode == kChannel) TakeChannel(reader);
    if (opcode == kMessage) TakeMessage(reader);
    if (!reader.ok) Fail("a record that ends before its end");
  }

  std::string NameIn(ByteReader& reader) {
    const std::string_view name = reader.Text();
    if (name.size() > kMostNameBytes) Fail("a name of more than 1000 bytes");
    return std::string(name.substr(0, kMostNameBytes));
  }

  void TakeSchema(ByteReader& reader) {
    const auto id = reader.Number<std::uint16_t>();
    Schema& schema = schemas_[id];
    schema.name = NameIn(reader);
    schema.encoding = NameIn(reader);
  }

  void TakeChannel(ByteReader& reader) {
    const auto id = reader.Number<std::uint16_t>(), schema = reader.Number<std::uint16_t>();
    McapChannel channel;
    channel.topic = NameIn(reader);
    channel.message_encoding = NameIn(reader);
    if (!reader.ok) return;
    if (schema != 0 && !schemas_.contains(schema))
      return Fail(fmt::format("the channel '{}' has a schema that is not there", channel.topic));
    if (schema != 0) {
      channel.schema = schemas_.at(schema).name;
      channel.schema_encoding = schemas_.at(schema).encoding;
    }
    const auto [known, is_new] = channels_.try_emplace(id, channel);
    if (is_new) return tell_(known->second);
    if (known->second.topic != channel.topic)
      Fail(fmt::format("channel {} is '{}' and '{}'", id, known->second.topic, channel.topic));
  }

  void TakeMessage(ByteReader& reader) {
    const auto id = reader.Number<std::uint16_t>();
    reader.Number<std::uint32_t>();  // its number
    const auto log = reader.Number<std::uint64_t>(), publish = reader.Number<std::uint64_t>();
    if (!reader.ok) return;
    const auto channel = channels_.find(id);
    if (channel == channels_.end())
      return Fail(fmt::format("a message of channel {}, which is not there", id));
    const std::string why = take_({.channel = channel->second,
                                   .log_ns = static_cast<std::int64_t>(log),
                                   .publish_ns = static_cast<std::int64_t>(publish),
                                   .data = reader.Bytes(reader.left())});
    if (!why.empty()) Fail(why);
  }

  struct Schema {
    std::string name, encoding;
  };
  std::istream& in_;
  const std::uint64_t size_;
  const McapTaker& take_;
  const std::function<void(const McapChannel&)>& tell_;
  std::uint64_t at_ = 0, record_at_ = 0, content_bytes_ = 0;
  bool ended_ = false, summary_ = false;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::string problem_;
};

}  // namespace

std::string ReadMcap(std::istream& in, std::uint64_t size, const McapTaker& take,
                     const std::function<void(const McapChannel&)>& channels) {
  return McapReader(in, size, take, channels).Read();
}

}  // namespace prehend::harness::import
