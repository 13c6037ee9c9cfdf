// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episodes/database.h"

#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "harness/base/base/text_file.h"

namespace prehend::episode {
namespace {

constexpr int kPatience_ms = 60'000;

[[noreturn]] void Throw(sqlite3* database) {
  switch (sqlite3_errcode(database) & 0xff) {
    case SQLITE_FULL:
      throw DatabaseError("the disk is full");
    case SQLITE_READONLY:
      throw DatabaseError("the file, or its folder, cannot be written");
    case SQLITE_CORRUPT:
      throw DatabaseError("the file is damaged");
    case SQLITE_NOTADB:
      throw DatabaseError("it is no SQLite database");
    case SQLITE_BUSY:
      throw DatabaseError("another program has been writing to it for a minute");
    default:
      break;
  }
  if (sqlite3_extended_errcode(database) == SQLITE_IOERR_DATA)
    throw DatabaseError("the file is damaged");
  const int system = sqlite3_system_errno(database);
  if (system == ENOSPC || system == EDQUOT) throw DatabaseError("the disk is full");
  if (system == EFBIG) throw DatabaseError("the file would become larger than it may");
  std::string text = sqlite3_errmsg(database);
  if (system != 0) text += std::string(": ") + std::strerror(system);
  throw DatabaseError(text);
}

/// The path as a URI, so that options can be given.
std::string AsUri(const std::string& path, const std::string& options) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(path).string()) {
    if (c == '?' || c == '#' || c == '%') {
      constexpr const char* kDigits = "0123456789abcdef";
      const auto byte = static_cast<unsigned char>(c);
      uri += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
    } else {
      uri += c;
    }
  }
  return uri + options;
}

}  // namespace

Statement::Statement(sqlite3* database, std::string_view sql) : database_(database) {
  if (sqlite3_prepare_v3(database, sql.data(), static_cast<int>(sql.size()),
                         SQLITE_PREPARE_PERSISTENT, &statement_, nullptr) != SQLITE_OK)
    Throw(database);
}

Statement::~Statement() { sqlite3_finalize(statement_); }

Statement::Statement(Statement&& other) noexcept
    : database_(other.database_),
      statement_(std::exchange(other.statement_, nullptr)),
      next_(other.next_) {}

Statement& Statement::Bind(std::int64_t value) {
  if (sqlite3_bind_int64(statement_, next_++, value) != SQLITE_OK) Throw(database_);
  return *this;
}

Statement& Statement::Bind(double value) {
  if (sqlite3_bind_double(statement_, next_++, value) != SQLITE_OK) Throw(database_);
  return *this;
}

Statement& Statement::Bind(std::string_view text) {
  if (sqlite3_bind_text64(statement_, next_++, text.data(), text.size(), SQLITE_TRANSIENT,
                          SQLITE_UTF8) != SQLITE_OK)
    Throw(database_);
  return *this;
}

Statement& Statement::BindBytes(std::string_view bytes) {
  if (sqlite3_bind_blob64(statement_, next_++, bytes.data(), bytes.size(), SQLITE_STATIC) !=
      SQLITE_OK)
    Throw(database_);
  return *this;
}

Statement& Statement::BindNothing() {
  if (sqlite3_bind_null(statement_, next_++) != SQLITE_OK) Throw(database_);
  return *this;
}

Statement& Statement::BindColumn(const Statement& row, int column) {
  if (sqlite3_bind_value(statement_, next_++, sqlite3_column_value(row.statement_, column)) !=
      SQLITE_OK)
    Throw(database_);
  return *this;
}

int Statement::Columns() const { return sqlite3_column_count(statement_); }

bool Statement::Step() {
  const int code = sqlite3_step(statement_);
  if (code != SQLITE_ROW && code != SQLITE_DONE) Throw(database_);
  return code == SQLITE_ROW;
}

void Statement::Run() {
  while (Step()) {
  }
  Reset();
}

void Statement::Reset() {
  sqlite3_reset(statement_);
  next_ = 1;
}

std::int64_t Statement::Integer(int column) const {
  constexpr std::int64_t kMost = std::int64_t{1} << 53;  // as large as all programs can read
  const int type = sqlite3_column_type(statement_, column);
  const std::int64_t number = sqlite3_column_int64(statement_, column);
  if ((type != SQLITE_INTEGER && type != SQLITE_NULL) || number < -kMost || number > kMost)
    throw DatabaseError("the file is damaged: found '" + Text(column) + "', wanted an integer");
  return number;
}

double Statement::Double(int column) const {
  const int type = sqlite3_column_type(statement_, column);
  if (type == SQLITE_TEXT || type == SQLITE_BLOB)
    throw DatabaseError("the file is damaged: found '" + Text(column) + "', wanted a number");
  return sqlite3_column_double(statement_, column);
}

bool Statement::IsNothing(int column) const {
  return sqlite3_column_type(statement_, column) == SQLITE_NULL;
}

std::string Statement::Text(int column) const {
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
  if (!bytes) return {};
  std::string text(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)));
  const auto is_plain = [](char c) { return (c >= ' ' && c <= '~') || c == '\t'; };
  if (std::ranges::all_of(text, is_plain)) return text;
  if (const std::string strange = StrangeIn(text); !strange.empty())
    throw DatabaseError("the file is damaged: a text of it holds a " + strange);
  return text;
}

std::string Statement::Uuid(int column) const {
  std::string text = Text(column);
  constexpr std::string_view kForm = "01234567-9012-4567-9012-456789012345";
  const auto fits = [](char found, char wanted) {
    return wanted == '-' ? found == '-' : std::isxdigit(static_cast<unsigned char>(found)) != 0;
  };
  if (!std::ranges::equal(text, kForm, fits))
    throw DatabaseError("the file is damaged: found the UUID '" + text + "'");
  return text;
}

std::string_view Statement::Bytes(int column) const {
  const void* bytes = sqlite3_column_blob(statement_, column);
  return {static_cast<const char*>(bytes),
          static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
}

Database::Database(const std::string& path, Mode mode) {
  const bool writes = mode == Mode::kWrite;
  std::string options;
  // A finished file can be read where nothing can be written, not even a lock.
  const std::string folder = std::filesystem::absolute(path).parent_path().string();
  if (!writes && access(folder.c_str(), W_OK) != 0 && !std::filesystem::exists(path + "-wal"))
    options = "?immutable=1";
  if (writes && !std::filesystem::exists(path) && access(folder.c_str(), W_OK) != 0)
    throw DatabaseError(std::string("its folder cannot be written: ") + std::strerror(errno));
  Open(AsUri(path, options),
       writes ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY);
}

Database Database::InMemory() {
  Database database;
  database.Open("file::memory:", SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  return database;
}

void Database::Open(const std::string& uri, int flags) {
  sqlite3* database = nullptr;
  const int code = sqlite3_open_v2(uri.c_str(), &database, flags | SQLITE_OPEN_URI, SummedPages());
  database_.reset(database);
  if (code != SQLITE_OK) {
    if (!database_) throw DatabaseError("out of memory");
    Throw(database_.get());
  }
  sqlite3_extended_result_codes(database_.get(), 1);
  sqlite3_busy_timeout(database_.get(), kPatience_ms);
  // What a file says is data: no function or view of it may do anything else.
  sqlite3_db_config(database_.get(), SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database_.get(), SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  // For a new file; one that has tables stays as it is.
  Execute("PRAGMA page_size=2048");
  int sum = kBytesOfSum;
  sqlite3_file_control(database_.get(), "main", SQLITE_FCNTL_RESERVE_BYTES, &sum);
}

void Database::Execute(const std::string& sql) const {
  if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    Throw(database_.get());
}

std::int64_t Database::LastRow() const { return sqlite3_last_insert_rowid(database_.get()); }

std::int64_t Database::Number(std::string_view sql) const {
  Statement statement = Prepare(sql);
  return statement.Step() ? statement.Integer(0) : 0;
}

void Database::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

Transaction::Transaction(const Database& database) : database_(database) {
  database_.Execute("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  if (!open_) return;
  try {
    database_.Execute("ROLLBACK");
  } catch (const DatabaseError&) {
    // SQLite has rolled back already.
  }
}

void Transaction::Commit() {
  database_.Execute("COMMIT");
  open_ = false;
}

}  // namespace prehend::episode
