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

}  // namespace prehend::episode
