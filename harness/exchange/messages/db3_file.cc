// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/messages/log_file.h: bags of ROS 2 in SQLite (.db3). Tested by
// tests/program/import_db3.py
#include <fmt/format.h>
#include <sqlite3.h>

#include <filesystem>
#include <map>
#include <memory>

#include "harness/base/base/text_file.h"
#include "harness/exchange/messages/log_file.h"

namespace prehend::exchange {
namespace {

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
    // A bag that is still written to, or was, has a file beside it; others may lie where no lock
    // can.
    std::string uri = "file:";
    for (const char c : std::filesystem::absolute(path_).string())
      uri += c == '?' || c == '#' || c == '%' ? fmt::format("%{:02x}", static_cast<int>(c))
                                              : std::string(1, c);
    if (!std::filesystem::exists(path_ + "-wal")) uri += "?immutable=1";
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
  std::unique_ptr<sqlite3, CloseDatabase> database_;
  std::map<std::string, std::pair<std::string, std::string_view>> definitions_;  ///< by type
};

}  // namespace

std::string ReadDb3(const std::string& path, std::istream& in, std::uint64_t size,
                    const TakesMessage& take, const HearsOfChannel& channels) {
  LogFile file(in, size, take, channels);
  if (!file.ok()) return file.problem();
  return Db3Reader(file, path).Read();
}

}  // namespace prehend::exchange
