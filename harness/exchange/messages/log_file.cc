// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/messages/log_file.h"

#include <fmt/format.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/text_file.h"

namespace prehend::exchange {
namespace {

/// Frames of LZ4, one after another. "" if they do not become `size` bytes.
std::string FromLz4(std::string_view packed, std::size_t size) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION))) return "";
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, &LZ4F_freeDecompressionContext);
  std::string out(size, '\0');
  std::size_t read = 0, written = 0;
  while (read < packed.size()) {
    std::size_t in_size = packed.size() - read, out_size = size - written;
    const std::size_t state = LZ4F_decompress(context.get(), out.data() + written, &out_size,
                                              packed.data() + read, &in_size, nullptr);
    read += in_size;
    written += out_size;
    if (LZ4F_isError(state) || (in_size == 0 && out_size == 0)) return "";
  }
  return written == size ? out : "";
}

std::string FromZstd(std::string_view packed, std::size_t size) {
  std::string out(size, '\0');
  return ZSTD_decompress(out.data(), size, packed.data(), packed.size()) == size ? out : "";
}

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

// See harness/exchange/messages/log_file.h. A record is a header of named fields, and data. Chunks
// hold the records of connections and messages.

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

// See harness/exchange/messages/log_file.h: bags of ROS 2 in SQLite (.db3). Tested by
// tests/program/import_db3.py

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};
struct EndStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

std::string_view BytesIn(sqlite3_stmt* row, int column) {
  const void* const bytes = sqlite3_column_blob(row, column);
  return {static_cast<const char*>(bytes),
          bytes ? static_cast<std::size_t>(sqlite3_column_bytes(row, column)) : 0};
}

class Db3Reader {
 public:
  Db3Reader(LogFile& file, const std::string& path) : file_(file), path_(path) {}

  std::string Read() {
    // A bag that is still written to, or was, has a file beside it. SQLite reads that in a copy
    // only, as it would leave another one there; others may lie where no lock can.
    const bool is_written = std::filesystem::exists(path_ + "-wal");
    if (is_written) {
      copies_.emplace();
      if (!copies_->problem().empty()) return copies_->problem();
      std::error_code error;
      for (const char* end : {"-wal", ""})
        if (!error) std::filesystem::copy_file(path_ + end, Copy() + end, error);
      if (error) return "it has a -wal beside it, and cannot be copied: " + error.message();
    }
    std::string uri = "file:";
    for (const char c : is_written ? Copy() : std::filesystem::absolute(path_).string())
      uri += c == '?' || c == '#' || c == '%' ? fmt::format("%{:02x}", static_cast<int>(c))
                                              : std::string(1, c);
    if (!is_written) uri += "?immutable=1";
    sqlite3* database = nullptr;
    const int code =
        sqlite3_open_v2(uri.c_str(), &database, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    database_.reset(database);
    if (code != SQLITE_OK) return "it cannot be opened";
    // What a file says is data: no function or view of it may do anything else.
    sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_limit(database, SQLITE_LIMIT_LENGTH, static_cast<int>(kMaxLogRecordBytes));
    const auto tables = [&](const char* name) {
      bool has = false;
      Each(fmt::format("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = '{}'", name),
           [&](sqlite3_stmt*) { has = true; });
      return has;
    };
    const bool is_bag = tables("topics") && tables("messages");
    if (file_.ok() && !is_bag)
      return "it is no bag of ROS 2: it has no tables 'topics' and 'messages'";
    if (file_.ok() && tables("message_definitions")) ReadDefinitions();
    if (file_.ok()) ReadTopics();
    if (file_.ok()) ReadMessages();
    return file_.problem();
  }

 private:
  std::string Copy() const { return (copies_->path() / "copy").string(); }

  template <class Take>
  void Each(const std::string& sql, const Take& take) {
    sqlite3_stmt* prepared = nullptr;
    int code = sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &prepared, nullptr);
    const std::unique_ptr<sqlite3_stmt, EndStatement> row(prepared);
    while (code == SQLITE_OK && file_.ok()) {
      code = sqlite3_step(prepared);
      if (code == SQLITE_DONE) return;
      if (code != SQLITE_ROW) break;
      take(prepared);
      code = SQLITE_OK;
    }
    if (!file_.ok()) return;
    const bool is_other = (code & 0xff) == SQLITE_NOTADB;
    file_.Fail(is_other ? "it is no SQLite database"
                        : fmt::format("the file is damaged: {}",
                                      ReadableText(sqlite3_errmsg(database_.get()))));
  }

  std::string NameIn(sqlite3_stmt* row, int column) {
    const std::string_view name = BytesIn(row, column);
    if (name.size() > kMaxLogNameBytes) file_.Fail("a name of more than 1000 bytes");
    return std::string(name.substr(0, kMaxLogNameBytes));
  }

  void ReadDefinitions() {
    Each("SELECT topic_type, encoding, encoded_message_definition FROM message_definitions",
         [&](sqlite3_stmt* row) {
           if (!file_.AdmitsMore("definition", definitions_.size())) return;
           definitions_[NameIn(row, 0)] = {NameIn(row, 1), file_.Keep(BytesIn(row, 2))};
         });
  }

  void ReadTopics() {
    Each("SELECT id, name, type, serialization_format FROM topics", [&](sqlite3_stmt* row) {
      LogChannel channel{
          .topic = NameIn(row, 1), .message_encoding = NameIn(row, 3), .schema = NameIn(row, 2)};
      const auto definition = definitions_.find(channel.schema);
      if (definition != definitions_.end()) {
        channel.schema_encoding = definition->second.first;
        channel.definition = definition->second.second;
      }
      file_.TakeChannel("topic", static_cast<std::uint32_t>(sqlite3_column_int64(row, 0)), channel);
    });
  }

  void ReadMessages() {
    std::uint64_t number = 0;
    Each("SELECT topic_id, timestamp, data FROM messages ORDER BY rowid", [&](sqlite3_stmt* row) {
      file_.BeginRow(number++);
      const LogChannel* const channel =
          file_.ChannelOf("topic", static_cast<std::uint32_t>(sqlite3_column_int64(row, 0)));
      if (!channel) return;
      const std::int64_t ns = sqlite3_column_int64(row, 1);
      file_.TakeMessage(
          {.channel = *channel, .log_ns = ns, .publish_ns = ns, .data = BytesIn(row, 2)});
    });
  }

  LogFile& file_;
  const std::string& path_;
  std::optional<TemporaryFolder> copies_;
  std::unique_ptr<sqlite3, CloseDatabase> database_;
  std::map<std::string, std::pair<std::string, std::string_view>> definitions_;  ///< by type
};

}  // namespace

LogFile::LogFile(std::istream& in, std::uint64_t size, const TakesMessage& take,
                 const HearsOfChannel& tell)
    : in_(in), size_(size), take_(take), tell_(tell) {
  if (size > kMaxLogBytes) problem_ = fmt::format("it is larger than {} GiB", kMaxLogBytes >> 30);
}

void LogFile::Fail(std::string_view why) {
  if (ok()) problem_ = fmt::format("{} {}: {}", place_, record_at_, why);
}

std::string LogFile::Take(std::uint64_t count) {
  std::string bytes(static_cast<std::size_t>(std::min(count, left())), '\0');
  in_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in_.gcount()));
  at_ += bytes.size();
  return bytes;
}

void LogFile::Skip(std::uint64_t count) {
  in_.seekg(static_cast<std::streamoff>(count), std::ios::cur);
  at_ += count;
}

bool LogFile::Admits(const char* what, std::uint64_t bytes) {
  if (bytes > kMaxLogRecordBytes)
    Fail(fmt::format("a {} of {} MiB; at most {} MiB are read", what, bytes >> 20,
                     kMaxLogRecordBytes >> 20));
  return ok();
}

bool LogFile::AdmitsChunk(std::uint64_t bytes) {
  if (!Admits("chunk", bytes)) return false;
  content_bytes_ += bytes;
  if (content_bytes_ > std::max(kMaxLogContentBytes, kMaxLogContentOfByte * size_))
    Fail(fmt::format("its chunks become more than {} MiB and more than {} times the file",
                     kMaxLogContentBytes >> 20, kMaxLogContentOfByte));
  return ok();
}

bool LogFile::AdmitsMore(const char* what, std::size_t count) {
  if (count >= kMaxLogChannels) Fail(fmt::format("more than {} {}s", kMaxLogChannels, what));
  return ok();
}

std::string LogFile::Unpack(std::string_view compression, std::string_view packed,
                            std::uint64_t size, std::string_view what_is_read) {
  if (!AdmitsChunk(size)) return "";
  const auto bytes = static_cast<std::size_t>(size);
  const bool is_plain = compression.empty() || compression == "none";
  if (!is_plain && compression != "lz4" && compression != "zstd") {
    Fail(fmt::format("a chunk with the compression '{}'; {}", compression.substr(0, 40),
                     what_is_read));
    return "";
  }
  std::string records = is_plain               ? std::string(packed)
                        : compression == "lz4" ? FromLz4(packed, bytes)
                                               : FromZstd(packed, bytes);
  if (records.size() != size) Fail("a damaged chunk: it cannot be decompressed");
  return records;
}

std::string_view LogFile::Keep(std::string_view definition) {
  const auto known = definitions_.find(definition);
  if (known != definitions_.end()) return *known;
  definition_bytes_ += definition.size();
  if (definition_bytes_ > kMostDefinitionBytes) {
    Fail(fmt::format("more than {} MiB of definitions of types", kMostDefinitionBytes >> 20));
    return {};
  }
  return *definitions_.emplace(definition).first;
}

void LogFile::TakeChannel(const char* kind, std::uint32_t id, const LogChannel& channel) {
  const auto known = channels_.find(id);
  if (known == channels_.end()) {
    if (AdmitsMore(kind, channels_.size())) tell_(channels_.emplace(id, channel).first->second);
    return;
  }
  if (known->second.topic != channel.topic)
    Fail(fmt::format("{} {} is '{}' and '{}'", kind, id, known->second.topic, channel.topic));
}

const LogChannel* LogFile::ChannelOf(const char* kind, std::uint32_t id) {
  const auto channel = channels_.find(id);
  if (channel != channels_.end()) return &channel->second;
  Fail(fmt::format("a message of {} {}, which is not there", kind, id));
  return nullptr;
}

void LogFile::TakeMessage(const LogMessage& message) {
  const std::string why = take_(message);
  if (!why.empty()) Fail(why);
}

std::string ReadMcap(std::istream& in, std::uint64_t size, const TakesMessage& take,
                     const HearsOfChannel& channels) {
  LogFile file(in, size, take, channels);
  return McapReader(file).Read();
}

std::string ReadBag(std::istream& in, std::uint64_t size, const TakesMessage& take,
                    const HearsOfChannel& channels) {
  LogFile file(in, size, take, channels);
  return BagReader(file).Read();
}

std::string ReadDb3(const std::string& path, std::istream& in, std::uint64_t size,
                    const TakesMessage& take, const HearsOfChannel& channels) {
  LogFile file(in, size, take, channels);
  if (!file.ok()) return file.problem();
  return Db3Reader(file, path).Read();
}

}  // namespace prehend::exchange
