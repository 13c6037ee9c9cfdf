// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <zlib.h>

#include <map>

#include "harness/exchange/messages/log_file.h"

namespace prehend::exchange {
namespace {

constexpr std::string_view kMagic = "\x89MCAP0\r\n";

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
  explicit McapReader(LogFile& file) : file_(file) {}

  std::string Read() {
    const std::string magic = file_.ok() ? file_.Take(kMagic.size()) : std::string(kMagic);
    if (magic.starts_with("#ROSBAG")) return "it is a bag of ROS 1: call it .bag";
    if (magic != kMagic) return "it is no MCAP file: it does not begin as one";
    while (!ended_ && file_.ok()) ReadRecord();
    return file_.problem();
  }

 private:
  void ReadRecord() {
    file_.BeginRecord();
    const std::string head = file_.Take(9);
    ByteReader reader{.bytes = head};
    const auto opcode = reader.Number<std::uint8_t>();
    const auto length = reader.Number<std::uint64_t>();
    if (!reader.ok || length > file_.left())
      return file_.Fail(
          "the file is cut off: it ends within a record; if its recorder was killed, 'mcap "
          "recover' of the MCAP tools saves the rest");
    if (opcode == kFooter) {
      ended_ = true;
      file_.Skip(length);
      if (file_.Take(kMagic.size()) != kMagic) file_.Fail("the file is cut off in its last bytes");
      return;
    }
    const bool matters = opcode == kSchema || opcode == kChannel || opcode == kMessage ||
                         opcode == kChunk || opcode == kHeader;
    if (!matters || summary_) {
      summary_ = summary_ || opcode == kDataEnd;
      return file_.Skip(length);
    }
    if (!file_.Admits("record", length)) return;
    const std::string content = file_.Take(length);
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
    if (!reader.ok) return file_.Fail("a chunk that ends before its end");
    const std::string records =
        file_.Unpack(compression, packed, size, "zstd, lz4 and none are read");
    if (!file_.ok()) return;
    const auto seen = static_cast<std::uint32_t>(
        crc32_z(0, reinterpret_cast<const Bytef*>(records.data()), records.size()));
    if (checksum != 0 && checksum != seen)
      return file_.Fail("a damaged chunk: its checksum is wrong");
    ByteReader inner{.bytes = records};
    while (inner.left() > 0 && file_.ok()) {
      const auto opcode = inner.Number<std::uint8_t>();
      const std::string_view record = inner.Bytes(inner.Number<std::uint64_t>());
      if (!inner.ok) return file_.Fail("a damaged chunk: a record ends behind it");
      TakeRecord(opcode, record);
    }
  }

  void TakeRecord(std::uint8_t opcode, std::string_view content) {
    ByteReader reader{.bytes = content};
    if (opcode == kSchema) TakeSchema(reader);
    if (opcode == kChannel) TakeChannel(reader);
    if (opcode == kMessage) TakeMessage(reader);
    if (!reader.ok) file_.Fail("a record that ends before its end");
  }

  std::string NameIn(ByteReader& reader) {
    const std::string_view name = reader.Text();
    if (name.size() > kMaxLogNameBytes) file_.Fail("a name of more than 1000 bytes");
    return std::string(name.substr(0, kMaxLogNameBytes));
  }

  void TakeSchema(ByteReader& reader) {
    const auto id = reader.Number<std::uint16_t>();
    if (!schemas_.contains(id) && !file_.AdmitsMore("schema", schemas_.size())) return;
    Schema& schema = schemas_[id];
    schema.name = NameIn(reader);
    schema.encoding = NameIn(reader);
    const std::string_view definition = reader.Text();
    if (reader.ok) schema.definition = file_.Keep(definition);
  }

  void TakeChannel(ByteReader& reader) {
    const auto id = reader.Number<std::uint16_t>(), schema = reader.Number<std::uint16_t>();
    LogChannel channel;
    channel.topic = NameIn(reader);
    channel.message_encoding = NameIn(reader);
    if (!reader.ok) return;
    if (schema != 0 && !schemas_.contains(schema))
      return file_.Fail(
          fmt::format("the channel '{}' has a schema that is not there", channel.topic));
    if (schema != 0) {
      channel.schema = schemas_.at(schema).name;
      channel.schema_encoding = schemas_.at(schema).encoding;
      channel.definition = schemas_.at(schema).definition;
    }
    file_.TakeChannel("channel", id, channel);
  }

  void TakeMessage(ByteReader& reader) {
    const auto id = reader.Number<std::uint16_t>();
    reader.Number<std::uint32_t>();  // its number
    const auto log = reader.Number<std::uint64_t>(), publish = reader.Number<std::uint64_t>();
    if (!reader.ok) return;
    const LogChannel* const channel = file_.ChannelOf("channel", id);
    if (!channel) return;
    file_.TakeMessage({.channel = *channel,
                       .log_ns = static_cast<std::int64_t>(log),
                       .publish_ns = static_cast<std::int64_t>(publish),
                       .data = reader.Bytes(reader.left())});
  }

  struct Schema {
    std::string name, encoding;
    std::string_view definition;
  };
  LogFile& file_;
  bool ended_ = false, summary_ = false;
  std::map<std::uint16_t, Schema> schemas_;
};

}  // namespace

std::string ReadMcap(std::istream& in, std::uint64_t size, const TakesMessage& take,
                     const HearsOfChannel& channels) {
  LogFile file(in, size, take, channels);
  return McapReader(file).Read();
}

}  // namespace prehend::exchange
