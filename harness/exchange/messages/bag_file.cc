// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/messages/log_file.h. A record is a header of named fields, and data. Chunks
// hold the records of connections and messages.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "harness/exchange/messages/log_file.h"

namespace prehend::exchange {
namespace {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";

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
  explicit BagReader(LogFile& file) : file_(file) {}

  std::string Read() {
    const std::string magic = file_.ok() ? file_.Take(kBagMagic.size()) : std::string(kBagMagic);
    if (magic.starts_with("\x89MCAP")) return "it is an MCAP file: call it .mcap";
    if (magic != kBagMagic) return "it is no bag of ROS 1, version 2.0: it does not begin as one";
    while (file_.left() > 0 && file_.ok()) ReadRecord();
    return file_.problem();
  }

 private:
  /// With its length before it; "" after an error.
  std::string TakePart() {
    const std::string head = file_.Take(4);
    ByteReader reader{.bytes = head};
    const auto length = reader.Number<std::uint32_t>();
    if (!reader.ok || length > file_.left()) {
      file_.Fail(
          "the file is cut off: it ends within a record; if its recorder was killed, 'rosbag "
          "reindex' saves the rest");
      return "";
    }
    return file_.Admits("record", length) ? file_.Take(length) : "";
  }

  void ReadRecord() {
    file_.BeginRecord();
    const std::string header = TakePart(), data = TakePart();
    if (!file_.ok()) return;
    bool ok = true;
    const Fields fields = FieldsOf(header, ok);
    if (!ok) return file_.Fail("a damaged record: its header is no list of fields");
    if (Number<std::uint8_t>(fields, "op") == kBagChunk) return ReadChunk(fields, data);
    TakeRecord(fields, data);
  }

  template <class T>
  T Number(const Fields& fields, std::string_view name) {
    const auto field = fields.find(name);
    if (field == fields.end() || field->second.size() != sizeof(T)) {
      file_.Fail(fmt::format("a record without a whole '{}'", name));
      return T{};
    }
    ByteReader reader{.bytes = field->second};
    return reader.Number<T>();
  }

  void ReadChunk(const Fields& fields, std::string_view packed) {
    const auto size = Number<std::uint32_t>(fields, "size");
    const auto field = fields.find("compression");
    const std::string_view compression = field == fields.end() ? "none" : field->second;
    const std::string records = file_.Unpack(
        compression, packed, size, "lz4 and none are read: 'rosbag decompress' makes such a file");
    if (!file_.ok()) return;
    ByteReader inner{.bytes = records};
    while (inner.left() > 0 && file_.ok()) {
      bool ok = true;
      const Fields inner_fields = FieldsOf(inner.Text(), ok);
      const std::string_view data = inner.Text();
      if (!inner.ok || !ok) return file_.Fail("a damaged chunk: a record ends behind it");
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
      return file_.Fail("a connection without a topic or a type");
    if (std::max(topic->second.size(), type->second.size()) > kMaxLogNameBytes)
      return file_.Fail("a name of more than 1000 bytes");
    const auto definition = of_topic.find("message_definition");
    const LogChannel channel{.topic = std::string(topic->second),
                             .message_encoding = "ros1",
                             .schema = std::string(type->second),
                             .schema_encoding = "ros1msg",
                             .definition = definition == of_topic.end()
                                               ? std::string_view()
                                               : file_.Keep(definition->second)};
    file_.TakeChannel("connection", id, channel);
  }

  void TakeMessage(const Fields& fields, std::string_view data) {
    const auto id = Number<std::uint32_t>(fields, "conn");
    const auto time = Number<std::uint64_t>(fields, "time");
    if (!file_.ok()) return;
    const LogChannel* const connection = file_.ChannelOf("connection", id);
    if (!connection) return;
    // Seconds in the lower half, nanoseconds in the upper one.
    const auto ns = static_cast<std::int64_t>((time & 0xffffffffU) * 1'000'000'000 + (time >> 32));
    file_.TakeMessage({.channel = *connection, .log_ns = ns, .publish_ns = ns, .data = data});
  }

  LogFile& file_;
};

}  // namespace

std::string ReadBag(std::istream& in, std::uint64_t size, const TakesMessage& take,
                    const HearsOfChannel& channels) {
  LogFile file(in, size, take, channels);
  return BagReader(file).Read();
}

}  // namespace prehend::exchange
