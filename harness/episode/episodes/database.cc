// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episodes/database.h"

#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/content_hash.h"
#include "harness/base/base/text_file.h"

namespace prehend::episode {
namespace {

constexpr int kPatience_ms = 60'000;

/// A program that wrote to it was killed, and left what undoes the half.
class HalfWritten : public DatabaseError {
  using DatabaseError::DatabaseError;
};

[[noreturn]] void Throw(sqlite3* database) {
  switch (sqlite3_errcode(database) & 0xff) {
    case SQLITE_FULL:
      throw DatabaseError("the disk is full");
    case SQLITE_READONLY:
      if (sqlite3_extended_errcode(database) == SQLITE_READONLY_ROLLBACK)
        throw HalfWritten("the program that wrote to it was killed");
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

namespace fs = std::filesystem;

constexpr std::string_view kMagic{"SQLite format 3\0", 16};

constexpr const char* kTables = R"(CREATE TABLE asset(
  hash TEXT PRIMARY KEY, bytes INTEGER NOT NULL, content BLOB NOT NULL) WITHOUT ROWID;
CREATE TABLE task(
  id INTEGER PRIMARY KEY, uuid TEXT NOT NULL UNIQUE, scenario TEXT NOT NULL, file TEXT NOT NULL,
  asked_grammar TEXT NOT NULL, settings TEXT NOT NULL, shows TEXT NOT NULL);
CREATE TABLE task_asset(
  task INTEGER NOT NULL REFERENCES task, path TEXT NOT NULL, hash TEXT NOT NULL REFERENCES asset,
  PRIMARY KEY(task, path)) WITHOUT ROWID;
CREATE TABLE entity(
  task INTEGER NOT NULL REFERENCES task, number INTEGER NOT NULL, uuid TEXT NOT NULL,
  name TEXT NOT NULL, class TEXT NOT NULL, part_of INTEGER, mass_kg REAL, size_x_m REAL NOT NULL,
  size_y_m REAL NOT NULL, size_z_m REAL NOT NULL, PRIMARY KEY(task, number)) WITHOUT ROWID;
CREATE TABLE entity_class(
  task INTEGER NOT NULL REFERENCES task, number INTEGER NOT NULL, depth INTEGER NOT NULL,
  class TEXT NOT NULL, PRIMARY KEY(task, number, depth)) WITHOUT ROWID;
CREATE TABLE episode(
  id INTEGER PRIMARY KEY, uuid TEXT NOT NULL UNIQUE, task INTEGER NOT NULL REFERENCES task,
  status TEXT NOT NULL, grammar TEXT NOT NULL, ticks_per_second INTEGER NOT NULL,
  ticks INTEGER NOT NULL, state_hash TEXT NOT NULL, outcome TEXT NOT NULL, engine TEXT NOT NULL,
  seed INTEGER NOT NULL, program TEXT NOT NULL, program_hash TEXT NOT NULL,
  recorded_on TEXT NOT NULL, failure_entity TEXT NOT NULL, failure_reason TEXT NOT NULL,
  failure_advice TEXT NOT NULL);
CREATE TABLE event(
  id INTEGER PRIMARY KEY, episode INTEGER NOT NULL REFERENCES episode, event TEXT NOT NULL,
  begin_tick INTEGER NOT NULL, end_tick INTEGER NOT NULL, decided_tick INTEGER NOT NULL,
  open_end INTEGER NOT NULL, begin_s REAL NOT NULL, end_s REAL NOT NULL, duration_s REAL NOT NULL);
CREATE INDEX event_by_episode ON event(episode, begin_tick);
CREATE INDEX event_by_name ON event(event, episode);
CREATE TABLE event_role(
  event INTEGER NOT NULL REFERENCES event, position INTEGER NOT NULL, role TEXT NOT NULL,
  value TEXT NOT NULL, entity INTEGER, PRIMARY KEY(event, position)) WITHOUT ROWID;
CREATE INDEX event_role_by_value ON event_role(role, value);
CREATE TABLE event_value(
  event INTEGER NOT NULL REFERENCES event, position INTEGER NOT NULL, name TEXT NOT NULL,
  value REAL, unit TEXT NOT NULL, PRIMARY KEY(event, position)) WITHOUT ROWID;
CREATE TABLE note(
  episode INTEGER NOT NULL REFERENCES episode, position INTEGER NOT NULL, tick INTEGER NOT NULL,
  hand INTEGER NOT NULL, text TEXT NOT NULL, PRIMARY KEY(episode, position)) WITHOUT ROWID;
CREATE TABLE chunk(
  episode INTEGER NOT NULL REFERENCES episode, first_tick INTEGER NOT NULL,
  last_tick INTEGER NOT NULL, frames INTEGER NOT NULL,
  PRIMARY KEY(episode, first_tick)) WITHOUT ROWID;
CREATE TABLE part(
  id INTEGER PRIMARY KEY, episode INTEGER NOT NULL REFERENCES episode, part INTEGER NOT NULL,
  first_tick INTEGER NOT NULL, data BLOB NOT NULL);
CREATE UNIQUE INDEX part_by_place ON part(episode, part, first_tick);
CREATE VIEW episodes_flat AS
  SELECT episode.id, episode.uuid, scenario, status, grammar,
    CAST(ticks AS REAL) / ticks_per_second AS seconds, ticks, state_hash, outcome, seed, settings,
    recorded_on
  FROM episode JOIN task ON task.id = episode.task;
CREATE VIEW events_flat AS
  SELECT event.id, event.episode, scenario, event.event,
    (SELECT group_concat(value, ', ') FROM (SELECT value FROM event_role AS one
      WHERE one.event = event.id ORDER BY position)) AS roles,
    (SELECT value FROM event_role AS one WHERE one.event = event.id AND role = 'hand') AS hand,
    (SELECT value FROM event_role AS one WHERE one.event = event.id AND role = 'object') AS object,
    (SELECT class FROM event_role AS one JOIN entity ON entity.number = one.entity
      AND entity.task = episode.task
      WHERE one.event = event.id AND role = 'object') AS object_class,
    begin_s, end_s, duration_s
  FROM event JOIN episode ON episode.id = event.episode JOIN task ON task.id = episode.task;
)";

std::string AsUuid(std::uint64_t high, std::uint64_t low, unsigned version) {
  high = (high & ~std::uint64_t{0xf000}) | (std::uint64_t{version} << 12);
  low = (low & ~(std::uint64_t{3} << 62)) | (std::uint64_t{1} << 63);
  return fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", high >> 32, (high >> 16) & 0xffff,
                     high & 0xffff, low >> 48, low & 0xffffffffffff);
}

/// Why these bytes begin no episode file, as far as can be seen without SQLite; or "".
std::string WhyNotEpisodes(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return "no such file";
  if (!fs::is_regular_file(status)) return "is not a regular file";
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::string("cannot be read: ") + std::strerror(errno);
  std::string begin(100, '\0');
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(file.gcount()));
  if (begin.empty()) return "the file is empty";
  if (!begin.starts_with(kMagic)) {
    return begin.front() == '{' ? "is a recording in JSON Lines, not an episode file"
                                : "is no episode file: it does not begin as an SQLite database";
  }
  if (begin.size() < 100) return "is cut off: an episode file has at least 100 bytes";
  const auto byte = [&](std::size_t i) {
    return std::uint64_t{static_cast<std::uint8_t>(begin[i])};
  };
  const std::uint64_t page = byte(16) << 8 | byte(17);
  const std::uint64_t pages = byte(28) << 24 | byte(29) << 16 | byte(30) << 8 | byte(31);
  const std::uint64_t wanted = (page == 1 ? 65536 : page) * pages;
  const std::string beside = fs::weakly_canonical(path, error).string();
  const fs::file_type journal = fs::symlink_status(beside + "-journal", error).type();
  // After the journal is seen to be gone: until then another process may be writing pages.
  const std::uintmax_t size = fs::file_size(path, error);
  if (journal == fs::file_type::not_found && size < wanted)
    return fmt::format("is cut off: it has {} of {} bytes", size, wanted);
  // SQLite undoes what a journal says, and removes the file that one ends with: ours names none.
  std::string end(8, '\0');
  if (journal == fs::file_type::regular)
    std::ifstream(beside + "-journal", std::ios::binary)
        .seekg(-8, std::ios::end)
        .read(end.data(), 8);
  const bool is_ours =
      journal == fs::file_type::regular && end != "\xd9\xd5\x05\xf9\x20\xa1\x63\xd7";
  if (!is_ours && journal != fs::file_type::not_found) return "has a -journal of another program";
  const bool is_wal = byte(18) == 2 || byte(19) == 2;
  if (is_wal || fs::exists(fs::symlink_status(beside + "-wal", error)))
    return "is in WAL mode, or has a -wal beside it: another program has written to it";
  return "";
}

/// Whether its tables are those that this program makes, word by word.
bool IsAsMade(const Database& database) {
  std::string made;
  Statement rows =
      database.Prepare("SELECT sql FROM sqlite_master WHERE sql IS NOT NULL ORDER BY rowid");
  while (rows.Step()) made += rows.Text(0) + ";\n";
  if (made == kTables) return true;
  std::string with_plans = kPlanTables;  // SQLite keeps the text without these words
  const std::string if_new = "IF NOT EXISTS ";
  for (std::size_t at = 0; (at = with_plans.find(if_new)) != std::string::npos;)
    with_plans.erase(at, if_new.size());
  return made == kTables + with_plans;
}

void RefuseOthers(const Database& database) {
  const std::int64_t application = database.Number("PRAGMA application_id");
  if (application != kApplicationId)
    throw DatabaseError("is an SQLite database of another program, not an episode file");
  const std::int64_t version = database.Number("PRAGMA user_version");
  if (version > kSchemaVersion) {
    throw DatabaseError(fmt::format(
        "has version {} of the format; this program reads version {}, a newer one is needed",
        version, kSchemaVersion));
  }
  if (version < 1) throw DatabaseError("is damaged: its format has no version");
  if (IsAsMade(database)) return;
  // Tables and columns that a program reads must be there; what others added is left alone.
  constexpr const char* kColumns =
      "SELECT tables.name, columns.name FROM sqlite_master AS tables,"
      " pragma_table_info(tables.name) AS columns WHERE tables.type = 'table'";
  const Database model = Database::InMemory();
  model.Execute(kTables);
  std::map<std::string, std::set<std::string>> found;
  Statement columns = database.Prepare(kColumns);
  while (columns.Step()) found[columns.Text(0)].insert(columns.Text(1));
  Statement wanted = model.Prepare(kColumns);
  while (wanted.Step()) {
    const auto table = found.find(wanted.Text(0));
    if (table == found.end())
      throw DatabaseError(fmt::format("is damaged: it has no table '{}'", wanted.Text(0)));
    if (!table->second.contains(wanted.Text(1))) {
      throw DatabaseError(fmt::format("is damaged: its table '{}' has no column '{}'",
                                      wanted.Text(0), wanted.Text(1)));
    }
  }
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
  const fs::path whole = fs::weakly_canonical(fs::absolute(path));  // a link's journal is there
  const std::string folder = whole.parent_path().string();
  if (!writes && access(folder.c_str(), W_OK) != 0 && !fs::exists(whole.string() + "-journal"))
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

const char* const kPlanTables = R"(CREATE TABLE IF NOT EXISTS plan(
  id INTEGER PRIMARY KEY, what TEXT NOT NULL, uuid TEXT NOT NULL, part INTEGER NOT NULL,
  parts INTEGER NOT NULL);
CREATE TABLE IF NOT EXISTS plan_owed(
  plan INTEGER NOT NULL REFERENCES plan, position INTEGER NOT NULL, part INTEGER NOT NULL,
  name TEXT NOT NULL, uuid TEXT NOT NULL, PRIMARY KEY(plan, position)) WITHOUT ROWID;
)";

bool IsEpisodeFile(const std::string& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return path.ends_with(".episodes");
  if (!fs::is_regular_file(path, error)) return false;
  std::ifstream file(path, std::ios::binary);
  std::string begin(kMagic.size(), '\0');
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return path.ends_with(".episodes") ||
         (file.gcount() == static_cast<std::streamsize>(kMagic.size()) && begin == kMagic);
}

Database OpenToWrite(const std::string& path) {
  std::error_code error;
  if (fs::exists(path, error) && !(fs::is_regular_file(path, error) && fs::is_empty(path, error))) {
    if (const std::string why = WhyNotEpisodes(path); !why.empty()) throw DatabaseError(why);
  }
  if (const std::string why = MakeFolderOf(path); !why.empty()) throw DatabaseError(why);
  Database database(path, Database::Mode::kWrite);
  // It survives a crash of the program, not a power cut.
  database.Execute("PRAGMA synchronous=OFF; PRAGMA cache_size=-4000");
  Transaction transaction(database);
  if (database.Number("SELECT count(*) FROM sqlite_master") == 0) {
    database.Execute(kTables);
    database.Execute(fmt::format("PRAGMA application_id={}; PRAGMA user_version={}", kApplicationId,
                                 kSchemaVersion));
  }
  transaction.Commit();
  RefuseOthers(database);
  // A trigger would run when something is added; a view or a column of others could be wronged.
  if (!IsAsMade(database)) {
    throw DatabaseError(
        "has tables, views or triggers of another program; it is read, but nothing is added to it");
  }
  return database;
}

Database OpenToRead(const std::string& path) {
  if (const std::string why = WhyNotEpisodes(path); !why.empty()) throw DatabaseError(why);
  const auto opened = [](const std::string& file, Database::Mode mode) {
    Database database(file, mode);
    RefuseOthers(database);
    return database;
  };
  try {
    return opened(path, Database::Mode::kRead);
  } catch (const HalfWritten&) {
    // Who reads changes nothing: SQLite undoes the half in a copy, which is gone when it is closed.
    const std::string whole = fs::weakly_canonical(path).string();
    const TemporaryFolder folder;
    if (!folder.problem().empty()) throw DatabaseError(folder.problem());
    const std::string copy = (folder.path() / "copy").string();
    try {
      const auto written = fs::last_write_time(whole);
      for (const char* end : {"-journal", ""}) fs::copy_file(whole + end, copy + end);
      fs::permissions(copy, fs::perms::owner_read | fs::perms::owner_write);
      if (fs::last_write_time(whole) == written) return opened(copy, Database::Mode::kWrite);
    } catch (const fs::filesystem_error& error) {
      if (fs::exists(whole + "-journal"))
        throw DatabaseError(
            "the program that wrote to it was killed, and there is no copy in which the half that "
            "it wrote is undone: " +
            error.code().message());
    }
    return OpenToRead(path);  // a writer has come meanwhile, and has undone it
  }
}

std::string NewUuid() {
  std::random_device random;
  const auto word = [&] { return std::uint64_t{random()} << 32 | random(); };
  const std::uint64_t high = word(), low = word();
  return AsUuid(high, low, 4);
}

std::string UuidOf(const std::string& text) {
  const auto word = [](const std::string& bytes) {
    return std::stoull(ContentHash(bytes), nullptr, 16);
  };
  return AsUuid(word("1" + text), word("2" + text), 8);
}

std::string UuidOfEvent(const std::string& episode_uuid, std::size_t index) {
  return UuidOf(episode_uuid + " event " + std::to_string(index));
}

}  // namespace prehend::episode
