// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/content_hash.h"
#include "harness/base/base/text_file.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/episodes/episode_file.h"
#include "harness/episode/episodes/plan.h"
#include "harness/episode/episodes/record_episode.h"

namespace prehend::episode {
namespace {

namespace fs = std::filesystem;

/// Files that are open at a time: fewer than a process may have.
constexpr std::size_t kMostOpen = 100;

/// Rows of an episode or of a task; numbers of rows are columns before `first`, the rest is copied.
struct Rows {
  const char* table;
  const char* of;     ///< the column that says whose they are
  const char* order;  ///< of their key
  int first;
};
constexpr Rows kOfTask[] = {{"task_asset", "task", "path", 1},
                            {"entity", "task", "number", 1},
                            {"entity_class", "task", "number, depth", 1}};
constexpr Rows kEvents = {"event", "episode", "id", 2};
constexpr Rows kOfEvent[] = {{"event_role", "event", "position", 1},
                             {"event_value", "event", "position", 1}};
constexpr Rows kOfEpisode[] = {{"note", "episode", "position", 1},
                               {"chunk", "episode", "first_tick", 1},
                               {"part", "episode", "id", 2}};

/// Of the tables that this program makes: a file may have more of them, in another order.
std::string ColumnsOf(const Database& into, const std::string& table) {
  Statement names = into.Prepare("SELECT group_concat(name) FROM pragma_table_info(?)");
  names.Bind(table).Step();
  return names.Text(0);
}

Statement Select(const Database& from, const Database& into, const std::string& table,
                 const std::string& which) {
  return from.Prepare(
      fmt::format("SELECT {} FROM {} WHERE {}", ColumnsOf(into, table), table, which));
}

Statement Select(const Database& from, const Database& into, const Rows& rows) {
  return Select(from, into, rows.table, fmt::format("{} = ? ORDER BY {}", rows.of, rows.order));
}

Statement Insert(const Database& into, const std::string& table, const char* if_there = "") {
  const std::string columns = ColumnsOf(into, table);
  std::string values = "?";
  for (auto more = std::ranges::count(columns, ','); more > 0; --more) values += ", ?";
  return into.Prepare(
      fmt::format("INSERT INTO {}({}) VALUES({}) {}", table, columns, values, if_there));
}

/// Adds this row, whose columns have been bound.
void RunFor(Statement& insert, const char* table, const Statement& row) {
  try {
    insert.Run();
  } catch (const DatabaseError& error) {
    const std::string why = error.what();
    if (why.find("constraint failed") == std::string::npos) throw;
    throw DatabaseError(fmt::format("the file is damaged: row ({}, {}) of its table '{}': {}",
                                    row.Text(0), row.Text(1), table, why));
  }
}

/// Adds a row with other numbers in its first columns: its own, which the database gives (`first`
/// is 2), and that of what it belongs to.
void Add(const Statement& row, const Rows& rows, std::int64_t owner, Statement& insert) {
  if (rows.first == 2) insert.BindNothing();
  insert.Bind(owner);
  for (int column = rows.first; column < row.Columns(); ++column) insert.BindColumn(row, column);
  RunFor(insert, rows.table, row);
}

/// A file to read from.
struct Source {
  Source(const std::string& path, const Database& into)
      : database(OpenToRead(path)),
        episode(Select(database, into, "episode", "id = ?")),
        events(Select(database, into, kEvents)) {
    for (const Rows& rows : kOfEvent) of_event.push_back(Select(database, into, rows));
    for (const Rows& rows : kOfEpisode) of_episode.push_back(Select(database, into, rows));
  }

  /// Everything but when it was recorded and by which numbers of rows.
  std::string HashOf(std::int64_t id) {
    std::string hashes;
    const auto add = [&](Statement& rows, std::int64_t owner, int first, int without) {
      rows.Reset();
      for (rows.Bind(owner); rows.Step();) {
        std::string row;
        for (int i = first; i < rows.Columns(); ++i)
          if (i != without) row += fmt::format("{} {}", rows.Bytes(i).size(), rows.Bytes(i));
        hashes += ContentHash(row);
      }
    };
    constexpr int kRecordedOn = 13;
    add(episode, id, 3, kRecordedOn);
    events.Reset();
    for (events.Bind(id); events.Step();) {
      for (int i = 2; i < events.Columns(); ++i) hashes += fmt::format("{} ", events.Bytes(i));
      for (Statement& rows : of_event) add(rows, events.Integer(0), 1, -1);
    }
    for (std::size_t i = 0; i < of_episode.size(); ++i)
      add(of_episode[i], id, kOfEpisode[i].first, -1);
    return ContentHash(hashes);
  }

  Database database;
  Statement episode, events;
  std::vector<Statement> of_event, of_episode;
};

/// What a file has beside what this program makes: tables, and columns of its own ones, with
/// commas.
std::string OthersIn(const Database& file, const Database& own) {
  const std::string all =
      "SELECT one.name, of.name FROM sqlite_schema one, pragma_table_info(one.name) of WHERE "
      "one.type = 'table' AND one.name NOT LIKE 'sqlite~_%' ESCAPE '~'";
  std::set<std::string> known, others;
  for (Statement row = own.Prepare(all); row.Step();)
    known.insert({row.Text(0), row.Text(0) + "." + row.Text(1)});
  for (Statement row = file.Prepare(all); row.Step();) {
    const std::string table = row.Text(0), column = table + "." + row.Text(1);
    if (!known.contains(column)) others.insert(known.contains(table) ? column : table);
  }
  return fmt::format("{}", fmt::join(others, ", "));
}

/// An episode of one of the files.
struct Found {
  std::string uuid, task, scenario;
  bool complete = false;
  std::size_t file = 0;
  std::int64_t id = 0;
};

class Merger {
 public:
  Merger(std::span<const std::string> files, const Database& into)
      : files_(files),
        sources_(files.size()),
        into_(into),
        task_(Insert(into, "task")),
        asset_(Insert(into, "asset", "ON CONFLICT(hash) DO NOTHING")),
        episode_(Insert(into, "episode")),
        event_(Insert(into, "event")) {
    for (const Rows& rows : kOfTask) of_task_.push_back(Insert(into, rows.table));
    for (const Rows& rows : kOfEvent) of_event_.push_back(Insert(into, rows.table));
    for (const Rows& rows : kOfEpisode) of_episode_.push_back(Insert(into, rows.table));
  }

  Merged Run() {
    Merged merged{.files = files_.size(), .missing = {}};
    std::vector<Standing> standings = StandingsOf();
    merged.missing = TextOf(standings);
    std::map<std::string, std::size_t> places;
    for (Standing& standing : standings) {
      Plan& plan = standing.plan;
      for (const Plan::Owed& owed : plan.owed)
        places.try_emplace(plan.UuidOfEpisode(owed.name), places.size());
      if (standing.missing.empty()) {
        plan.number = plan.count = 1;
        for (Plan::Owed& owed : plan.owed) owed.part = 1;
      }
      WritePlan(into_, plan);
    }
    std::vector<Found> found = Look(places, merged);
    std::ranges::stable_sort(found, {}, [&](const Found& one) {
      const auto place = places.find(one.uuid);
      return place == places.end() ? places.size() : place->second;
    });
    for (const Found& one : found) InFile(one.file, [&] { Copy(one); });
    merged.episodes = found.size();
    return merged;
  }

 private:
  /// What goes wrong with a file is said with its name.
  void InFile(std::size_t file, const std::function<void()>& work) const {
    try {
      work();
    } catch (const DatabaseError& error) {
      throw DatabaseError(fmt::format("{}: {}", ReadableName(files_[file]), error.what()));
    }
  }

  Source& Open(std::size_t file) {
    if (!sources_[file]) {
      if (open_ == kMostOpen) {
        for (auto& source : sources_) source.reset();
        open_ = 0;
      }
      sources_[file].emplace(files_[file], into_);
      ++open_;
    }
    return *sources_[file];
  }

  std::vector<Standing> StandingsOf() {
    StandingFinder finder;
    for (std::size_t i = 0; i < files_.size(); ++i)
      InFile(i, [&] { finder.Add(Open(i).database); });
    return finder.Standings();
  }

  /// Each episode once. What was cut off and is of a plan is left out.
  std::vector<Found> Look(const std::map<std::string, std::size_t>& places, Merged& merged) {
    std::vector<Found> found;
    std::map<std::string, std::size_t> known;
    const auto look = [&](std::size_t file) {
      Statement find = Open(file).database.Prepare(
          "SELECT episode.uuid, task.uuid, scenario, status <> 'recording', episode.id FROM episode"
          " LEFT JOIN task ON task.id = episode.task ORDER BY episode.id");
      std::vector<Found> here;
      while (find.Step())
        here.push_back({find.Uuid(0), find.Uuid(1), find.Text(2), find.Integer(3) != 0, file,
                        find.Integer(4)});
      for (Found& one : here) {
        if (!one.complete && places.contains(one.uuid)) continue;
        const auto [at, is_new] = known.try_emplace(one.uuid, found.size());
        if (is_new) {
          found.push_back(std::move(one));
          continue;
        }
        if (one.complete && !found[at->second].complete)
          found[at->second] = std::move(one);
        else if (one.complete)
          CheckSame(found[at->second], one);
        ++merged.twice;
      }
    };
    for (std::size_t file = 0; file < files_.size(); ++file) {
      InFile(file, [&] { look(file); });
      if (const std::string others = OthersIn(Open(file).database, into_); !others.empty())
        merged.notes += fmt::format("warning: {}: not copied, as it is none of prehend's: {}\n",
                                    ReadableName(files_[file]), ReadableName(others));
    }
    return found;
  }

  void CheckSame(const Found& one, const Found& other) {
    const std::string hash = Open(one.file).HashOf(one.id);
    if (one.task == other.task && hash == Open(other.file).HashOf(other.id)) return;
    throw DatabaseError(
        fmt::format("episode {} ({}) has the same UUID as episode {} of {} and is not the same: {}",
                    other.id, other.scenario, one.id, ReadableName(files_[one.file]), other.uuid));
  }

  void Copy(const Found& one) {
    Source& from = Open(one.file);
    from.episode.Reset();
    if (!from.episode.Bind(one.id).Step()) throw DatabaseError("an episode has gone");
    const Statement& row = from.episode;
    episode_.BindNothing().BindColumn(row, 1).Bind(TaskOf(from, row.Integer(2), one.task));
    for (int column = 3; column < row.Columns(); ++column) episode_.BindColumn(row, column);
    RunFor(episode_, "episode", row);
    const std::int64_t id = into_.LastRow();
    from.events.Reset();
    for (from.events.Bind(one.id); from.events.Step();) {
      Add(from.events, kEvents, id, event_);
      const std::int64_t event = into_.LastRow();
      for (std::size_t i = 0; i < of_event_.size(); ++i)
        CopyAll(from.of_event[i], kOfEvent[i], from.events.Integer(0), event, of_event_[i]);
    }
    for (std::size_t i = 0; i < of_episode_.size(); ++i)
      CopyAll(from.of_episode[i], kOfEpisode[i], one.id, id, of_episode_[i]);
  }

  static void CopyAll(Statement& found, const Rows& rows, std::int64_t owner,
                      std::int64_t new_owner, Statement& insert) {
    found.Reset();
    for (found.Bind(owner); found.Step();) Add(found, rows, new_owner, insert);
  }

  std::int64_t TaskOf(const Source& from, std::int64_t id, const std::string& uuid) {
    const auto known = tasks_.find(uuid);
    if (known != tasks_.end()) return known->second;
    Statement row = Select(from.database, into_, "task", "id = ?");
    row.Bind(id).Step();
    task_.BindNothing();
    for (int column = 1; column < row.Columns(); ++column) task_.BindColumn(row, column);
    RunFor(task_, "task", row);
    const std::int64_t task = into_.LastRow();
    Statement assets = Select(from.database, into_, "asset",
                              "hash IN (SELECT hash FROM task_asset WHERE task = ?) ORDER BY hash");
    for (assets.Bind(id); assets.Step();) {
      for (int column = 0; column < assets.Columns(); ++column) asset_.BindColumn(assets, column);
      RunFor(asset_, "asset", assets);
    }
    for (std::size_t i = 0; i < of_task_.size(); ++i) {
      Statement found = Select(from.database, into_, kOfTask[i]);
      CopyAll(found, kOfTask[i], id, task, of_task_[i]);
    }
    return tasks_[uuid] = task;
  }

  std::span<const std::string> files_;
  std::vector<std::optional<Source>> sources_;
  std::size_t open_ = 0;
  const Database& into_;
  Statement task_, asset_, episode_, event_;
  std::vector<Statement> of_task_, of_event_, of_episode_;
  std::map<std::string, std::int64_t> tasks_;
};

/// Nothing may be lost of a file that the new one replaces.
Result<void> KeepsAllOf(const std::string& old, const std::string& merged) {
  std::error_code error;
  if (!fs::exists(old, error)) return {};
  PREHEND_TRY(const EpisodeFile before, EpisodeFile::Open(old));
  PREHEND_TRY(const EpisodeFile after, EpisodeFile::Open(merged));
  std::set<std::string> kept;
  for (const EpisodeRow& row : after.episodes()) kept.insert(row.uuid);
  const auto lost = std::ranges::count_if(
      before.episodes(), [&](const EpisodeRow& row) { return !kept.contains(row.uuid); });
  if (lost == 0) return {};
  return tl::unexpected(grammar::Diagnostics{
      {.file = old,
       .message = fmt::format("exists, and has {} of {} episodes that would be lost: none of the "
                              "merged files has them",
                              lost, before.episodes().size()),
       .hint = "merge it with them, name another file, or remove it first"}});
}

}  // namespace

Result<Merged> MergeEpisodes(std::span<const std::string> files, const std::string& output) {
  if (const std::string problem = WhyNotWritable(output); !problem.empty())
    return tl::unexpected(grammar::Diagnostics{{.file = output, .message = problem}});
  std::error_code error;
  const std::string target = fs::weakly_canonical(output, error).string();
  const std::string unfinished = fmt::format("{}.{}.unfinished", target, getpid());
  Result<Merged> merged = Guarded(output, [&] {
    const Database into = OpenToWrite(unfinished);
    into.Execute("PRAGMA journal_mode=OFF");  // what is not finished is removed
    Transaction transaction(into);
    Merged done = Merger(files, into).Run();
    transaction.Commit();
    // What undoes the half of an old file there would undo this one.
    if (fs::exists(target + "-journal")) (void)OpenToWrite(target);
    return done;
  });
  if (merged) {
    if (Result<void> kept = KeepsAllOf(target, unfinished); !kept)
      merged = tl::unexpected(std::move(kept.error()));
  }
  if (merged) fs::rename(unfinished, target, error);
  if (merged && error)
    merged = tl::unexpected(
        grammar::Diagnostics{{.file = output, .message = "cannot be written: " + error.message()}});
  std::error_code ignored;
  fs::remove(unfinished, ignored);
  return merged;
}

}  // namespace prehend::episode
