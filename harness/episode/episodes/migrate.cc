// SPDX-License-Identifier: Apache-2.0
// See harness/episode/episodes/migrate.h. Tested by tests/harness/episode/episodes/migrate_test.cc
#include "harness/episode/episodes/migrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "harness/episode/episodes/load_episode.h"
#include "harness/episode/episodes/schema.h"
#include "harness/episode/episodes/write_rows.h"
#include "harness/episode/run/run_text.h"
#include "physics/scene/state_hash.h"

namespace prehend::episode {
namespace {

/// Everything but the frames. Rows keep their numbers.
constexpr const char* kCopied[] = {"asset",   "task",  "task_asset", "entity",      "entity_class",
                                   "episode", "event", "event_role", "event_value", "note"};

class Migration {
 public:
  Migration(const EpisodeFile& old, const Database& database, const std::string& root)
      : old_(old), database_(database), loader_(root) {}

  void CopyTables() {
    for (const char* table : kCopied)
      database_.Execute(fmt::format("INSERT INTO main.{0} SELECT * FROM old.{0}", table));
  }

  /// Throws DatabaseError.
  void CopyFrames(const EpisodeRow& row) {
    ChunkRows rows(database_, row.id);
    if (!row.simulated) return CopyParts(row, rows);
    const Result<LoadedRun> loaded = loader_.Load(old_, row);
    if (!loaded) throw DatabaseError(About(row) + ": " + grammar::Format(loaded.error().front()));
    FrameLayout layout = LayoutOf(loaded->scenario.scene);
    ChunkWriter writer(layout);
    layout.version = static_cast<int>(std::min<std::int64_t>(old_.version(), kFrameVersion));
    physics::StateHash hash;
    EpisodeFrames frames(old_, row, layout);
    const std::string damage = frames.Play([&](const physics::Snapshot& shown) {
      physics::Snapshot snapshot = shown;
      snapshot.moved_tick.clear();  // compare all bodies
      hash.Add(snapshot);
      writer.Add(snapshot);
      if (writer.IsFull()) rows.Write(writer.Take());
    });
    if (!damage.empty()) throw DatabaseError(About(row) + ": " + damage);
    if (writer.frames() > 0) rows.Write(writer.Take());
    if (!row.state_hash.empty() && HashText(hash.value()) != row.state_hash)
      throw DatabaseError(About(row) + ": its frames do not have the state hash that was recorded");
  }

 private:
  static std::string About(const EpisodeRow& row) {
    return fmt::format("episode {} ({})", row.id, row.scenario);
  }

  /// Of a recording; these are coded as before.
  void CopyParts(const EpisodeRow& row, ChunkRows& rows) const {
    Statement find = database_.Prepare(
        "SELECT first_tick, last_tick, frames, data FROM old.chunk JOIN old.part"
        " ON part.id = chunk.id * ? WHERE episode = ? ORDER BY number");
    find.Bind(kPartsPerChunk).Bind(row.id);
    while (find.Step())
      rows.Write({.first_tick = find.Integer(0),
                  .last_tick = find.Integer(1),
                  .frames = static_cast<std::size_t>(find.Integer(2)),
                  .parts = {{0, std::string(find.Bytes(3))}}});
  }

  const EpisodeFile& old_;
  const Database& database_;
  EpisodeLoader loader_;
};

}  // namespace

Result<Migrated> MigrateFile(const std::string& old_file, const std::string& new_file,
                             const std::string& root) {
  namespace fs = std::filesystem;
  const auto failed = [](const std::string& file, const std::string& why) {
    return tl::unexpected(grammar::Diagnostics{
        {.file = file, .place = {}, .message = why, .source_line = {}, .hint = {}}});
  };
  std::error_code error;
  if (fs::exists(new_file, error)) return failed(new_file, "is there already");
  const Result<EpisodeFile> old = EpisodeFile::OpenOld(old_file);
  if (!old) return tl::unexpected(old.error());
  Migrated migrated{.episodes = old->episodes().size(),
                    .from_bytes = static_cast<std::size_t>(fs::file_size(old_file, error))};
  std::string problem;
  try {
    const Database database = OpenToWrite(new_file);
    database.Prepare("ATTACH ? AS old").Bind(fs::absolute(old_file).string()).Run();
    Transaction transaction(database);
    Migration migration(*old, database, root);
    migration.CopyTables();
    for (const EpisodeRow& row : old->episodes()) migration.CopyFrames(row);
    transaction.Commit();
  } catch (const DatabaseError& why) {
    problem = why.what();
  }
  if (problem.empty()) {
    migrated.to_bytes = static_cast<std::size_t>(fs::file_size(new_file, error));
    return migrated;
  }
  fs::remove(new_file, error);
  fs::remove(new_file + "-journal", error);
  return failed(old_file, problem);
}

}  // namespace prehend::episode
