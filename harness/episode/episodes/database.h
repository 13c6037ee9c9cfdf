// SPDX-License-Identifier: Apache-2.0
// SQLite behind a small fence: connections and statements that close themselves, and errors as
// exceptions that do not leave this room. Tested by
// tests/harness/episode/episodes/episode_file_test.cc
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "harness/base/base/result.h"
#include "harness/episode/frames/columns.h"

struct sqlite3;
struct sqlite3_stmt;

namespace prehend::episode {

class DatabaseError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Statement {
 public:
  Statement(sqlite3* database, std::string_view sql);
  ~Statement();
  Statement(Statement&& other) noexcept;
  Statement& operator=(Statement&&) = delete;

  /// The parameters from the first on, in this order; then Step() or Run().
  Statement& Bind(std::int64_t value);
  Statement& Bind(int value) { return Bind(std::int64_t{value}); }
  Statement& Bind(double value);
  Statement& Bind(std::string_view text);
  Statement& Bind(const char* text) { return Bind(std::string_view(text)); }
  Statement& BindBytes(std::string_view bytes);  ///< kept by the caller until the next Reset()
  Statement& BindNothing();
  Statement& BindColumn(const Statement& row, int column);  ///< of another statement, as it is

  /// Whether there is a row. Throws DatabaseError.
  bool Step();
  /// Steps to the end and resets.
  void Run();
  void Reset();

  std::int64_t Integer(int column) const;
  double Double(int column) const;
  bool IsNothing(int column) const;
  /// Damage if it holds what no text of a file holds (CheckText()).
  std::string Text(int column) const;
  /// Damage if it is no UUID: it becomes the name of a file, and of a thing in a knowledge base.
  std::string Uuid(int column) const;
  std::string_view Bytes(int column) const;  ///< valid until the next step
  int Columns() const;

 private:
  sqlite3* database_ = nullptr;
  sqlite3_stmt* statement_ = nullptr;
  int next_ = 1;
};

class Database {
 public:
  enum class Mode { kRead, kWrite };
  /// `kWrite` creates the file. Waits for other writers. Throws DatabaseError.
  Database(const std::string& path, Mode mode);
  static Database InMemory();

  Statement Prepare(std::string_view sql) const { return {database_.get(), sql}; }
  void Execute(const std::string& sql) const;
  std::int64_t LastRow() const;
  std::int64_t Number(std::string_view sql) const;  ///< the first column of the first row, or 0

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  Database() = default;
  void Open(const std::string& uri, int flags);
  std::unique_ptr<sqlite3, Close> database_;
};

/// Rolls back what is not committed.
class Transaction {
 public:
  explicit Transaction(const Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void Commit();

 private:
  const Database& database_;
  bool open_ = true;
};

// Where exceptions of the database and of frames become diagnostics: they do not leave this room.

/// What `work` returns, or an error about the file. `about`: begins its message.
template <typename Work>
auto Guarded(const std::string& file, const Work& work, const std::string& about = "")
    -> Result<std::invoke_result_t<Work>> {
  const auto wrong = [&](const std::string& message) {
    return tl::unexpected(grammar::Diagnostics{{.file = file, .message = about + message}});
  };
  try {
    if constexpr (std::is_void_v<std::invoke_result_t<Work>>) {
      work();
      return {};
    } else {
      return work();
    }
  } catch (const DatabaseError& error) {
    return wrong(error.what());
  } catch (const Damage& damage) {
    return wrong(std::string("the file is damaged: ") + damage.what());
  }
}

/// The same as a text: "", or "FILE: what went wrong".
template <typename Work>
std::string ProblemOf(const std::string& file, const Work& work) {
  const auto done = Guarded(file, work);
  return done ? "" : file + ": " + done.error().front().message;
}

// Checksums of an episode file: each page of the database ends with a hash of the rest of it and of
// its place. So whatever is read was written so, rows, indices and tables alike. SQLite itself
// keeps its hands off the end of a page where a database asks for it when it is made, so that every
// program can read the file. Tested by tests/program/damaged_episodes_test.cc

/// Of an episode file, in its header ("preh").
inline constexpr std::int64_t kApplicationId = 0x70726568;
/// Of each page, for its checksum.
inline constexpr int kBytesOfSum = 8;

/// The name of a file system of SQLite that writes checksums and compares them; a page that does
/// not have its own cannot be read (SQLITE_IOERR_DATA). Databases of other programs, which have
/// neither room for them nor the application id of an episode file, are read as they are.
const char* SummedPages();

// The tables of an episode file (docs/episodes.md), and which files are such. Tested by
// tests/harness/episode/episodes/episode_file_test.cc

inline constexpr std::int64_t kSchemaVersion = 1;  ///< of the format

/// Of files that are parts of something larger (harness/episode/episodes/plan.h); made when they
/// are needed.
extern const char* const kPlanTables;

/// Whether a file is meant to be an episode file: it is an SQLite database, or does not exist yet
/// and ends with `.episodes`.
bool IsEpisodeFile(const std::string& path);

/// Opens a file for writing; creates it with its tables if it is not there. Throws DatabaseError.
Database OpenToWrite(const std::string& path);

/// Opens a file for reading. Throws DatabaseError with the reason why it is no episode file.
Database OpenToRead(const std::string& path);

/// A random one (version 4, RFC 9562).
std::string NewUuid();
/// The same for the same text (version 8).
std::string UuidOf(const std::string& text);
/// Of the event that stands at this place of an episode's timeline.
std::string UuidOfEvent(const std::string& episode_uuid, std::size_t index);

}  // namespace prehend::episode
