// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episodes/episode_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "harness/base/base/content_hash.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/episodes/load_episode.h"
#include "harness/episode/episodes/plan.h"
#include "harness/episode/episodes/query_events.h"
#include "harness/episode/episodes/record_episode.h"
#include "harness/episode/run/run_text.h"

namespace prehend::episode {
namespace {

namespace fs = std::filesystem;

const std::string kRoot = PREHEND_SOURCE_DIR;
const std::string kScenario = kRoot + "/scenarios/reach/idling_beside_the_object_is_no_reach.yaml";

fs::path Fresh(const std::string& name) {
  const fs::path folder =
      fs::temp_directory_path() / ("prehend_" + name + "_" + std::to_string(getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

std::string Slurped(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

void Spill(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

struct Played {
  LoadedRun loaded;
  RunResult result;
  std::string problem;
};

/// Plays a short scenario and records it; without `finish` as if the program had been killed.
Played Record(const std::string& file, bool finish = true) {
  std::vector<std::string> files;
  const RunRequest request{.scenario_file = kScenario, .grammar = "", .settings = {}};
  Played played{.loaded = *LoadRun(request, kRoot, &files), .result = {}, .problem = {}};
  EpisodeRecorder recorder({file, kRoot, request, files, "2026-01-02", "0123"},
                           played.loaded.scenario);
  ScenarioRun playing(played.loaded.scenario, played.loaded.program, {.record = true});
  while (playing.Step()) recorder.Add(playing.snapshot());
  played.result = playing.Finish();
  if (finish) recorder.Finish(played.result);
  played.problem = recorder.problem();
  return played;
}

std::string MessageOf(const Result<EpisodeFile>& opened) {
  return opened ? "" : opened.error().front().message;
}

TEST(EpisodeFileOfMany, GivesBackWhatWasPlayed) {
  const std::string file = (Fresh("whole") / "a.episodes").string();
  const Played first = Record(file), second = Record(file);
  ASSERT_EQ(first.problem + second.problem, "");
  const auto opened = EpisodeFile::Open(file);
  ASSERT_TRUE(opened) << MessageOf(opened);
  ASSERT_EQ(opened->episodes().size(), 2u);
  EXPECT_NE(opened->episodes()[0].uuid, opened->episodes()[1].uuid);
  const EpisodeRow& row = opened->episodes()[1];
  EXPECT_EQ(row.scenario, "reach/idling_beside_the_object_is_no_reach");
  EXPECT_EQ(row.status, "completed");
  EXPECT_EQ(row.recorded_on, "2026-01-02");
  EXPECT_EQ(row.state_hash, HashText(first.result.state_hash));

  EpisodeLoader loader(kRoot);
  const auto loaded = loader.Load(*opened, row);
  ASSERT_TRUE(loaded) << grammar::Format(loaded.error());
  const auto again = Resegment(*opened, row, *loaded, /*frames=*/true);
  ASSERT_TRUE(again) << grammar::Format(again.error());
  EXPECT_EQ(RunTable(*again), RunTable(first.result));
  EXPECT_EQ(again->state_hash, first.result.state_hash);
  ASSERT_EQ(again->recording.size(), first.result.recording.size());
  const auto recorded = opened->TimelineOf(row);
  ASSERT_TRUE(recorded);
  RunResult kept = *again;
  kept.timeline = *recorded;
  EXPECT_EQ(RunTable(kept), RunTable(first.result));
}

TEST(EpisodeFileOfMany, AnyFrameAndAnyTrackIsFound) {
  const std::string file = (Fresh("at") / "a.episodes").string();
  const Played played = Record(file);
  const auto opened = EpisodeFile::Open(file);
  ASSERT_TRUE(opened);
  EpisodeFrames frames(*opened, opened->episodes()[0], LayoutOf(played.loaded.scenario.scene));
  for (std::size_t i = 0; i < played.result.recording.size(); i += 97) {
    const physics::Snapshot& truth = played.result.recording[i];
    const auto found = frames.At(truth.tick);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->tick, truth.tick);
    for (std::size_t b = 0; b < truth.bodies.size(); ++b)
      EXPECT_EQ(found->bodies[b].X_WB.p_m, truth.bodies[b].X_WB.p_m);
    EXPECT_EQ(found->hands[0].X_WL.back().p_m, truth.hands[0].X_WL.back().p_m);
    EXPECT_EQ(found->contacts.size(), truth.contacts.size());
  }
  const auto none = frames.At(0);
  ASSERT_FALSE(none) << "the first frame is after the first tick";
  EXPECT_EQ(none.error().front().message,
            "episode 1 (reach/idling_beside_the_object_is_no_reach): has no frame up to tick 0");
  EXPECT_EQ(frames.At(1'000'000)->tick, played.result.ticks);
  const auto track = frames.TrackOf(1);
  ASSERT_TRUE(track);
  ASSERT_EQ(track->size(), played.result.recording.size());
  for (std::size_t i = 0; i < track->size(); ++i)
    EXPECT_EQ((*track)[i].body.X_WB.p_m, played.result.recording[i].bodies[1].X_WB.p_m);
}

TEST(EpisodeFileOfMany, AnEpisodeThatIsNotFinishedSaysSoAndIsReadUpToItsLastChunk) {
  const std::string file = (Fresh("cut") / "a.episodes").string();
  const Played played = Record(file, false);
  const auto opened = EpisodeFile::Open(file);
  ASSERT_TRUE(opened);
  const EpisodeRow& row = opened->episodes()[0];
  EXPECT_EQ(row.status, "recording");
  EXPECT_GT(row.ticks, 100);
  EXPECT_LT(row.ticks, played.result.ticks);
  EpisodeLoader loader(kRoot);
  const auto loaded = loader.Load(*opened, row);
  ASSERT_TRUE(loaded);
  const auto again = Resegment(*opened, row, *loaded, /*frames=*/true);
  ASSERT_TRUE(again) << grammar::Format(again.error());
  EXPECT_EQ(again->status.kind, physics::RunStatus::Kind::kFailed);
  EXPECT_NE(StatusText(*again).find("its recording was cut off here"), std::string::npos);
  EXPECT_EQ(again->recording.back().tick, row.ticks);
}

TEST(EpisodeFileOfMany, ForeignAndDamagedFilesAreRefusedWithTheirCause) {
  const fs::path folder = Fresh("bad");
  EXPECT_EQ(MessageOf(EpisodeFile::Open((folder / "none").string())), "no such file");
  EXPECT_EQ(MessageOf(EpisodeFile::Open(folder.string())), "is not a regular file");
  Spill(folder / "empty", "");
  EXPECT_EQ(MessageOf(EpisodeFile::Open((folder / "empty").string())), "the file is empty");
  Spill(folder / "text", "name: x\n");
  EXPECT_EQ(MessageOf(EpisodeFile::Open((folder / "text").string())),
            "is no episode file: it does not begin as an SQLite database");
  Spill(folder / "lines", "{\"recording\": 1}\n");
  EXPECT_EQ(MessageOf(EpisodeFile::Open((folder / "lines").string())),
            "is a recording in JSON Lines, not an episode file");
  {
    const Database other((folder / "other").string(), Database::Mode::kWrite);
    other.Execute("CREATE TABLE cat(name TEXT)");
  }
  EXPECT_EQ(MessageOf(EpisodeFile::Open((folder / "other").string())),
            "is an SQLite database of another program, not an episode file");

  const fs::path good = folder / "a.episodes";
  ASSERT_EQ(Record(good.string()).problem, "");
  const std::string bytes = Slurped(good);
  Spill(folder / "cut", bytes.substr(0, bytes.size() - 5000));
  EXPECT_EQ(MessageOf(EpisodeFile::Open((folder / "cut").string())),
            "is cut off: it has " + std::to_string(bytes.size() - 5000) + " of " +
                std::to_string(bytes.size()) + " bytes");
  Spill(folder / "short", bytes.substr(0, 50));
  EXPECT_EQ(MessageOf(EpisodeFile::Open((folder / "short").string())),
            "is cut off: an episode file has at least 100 bytes");
  OpenToWrite(good.string()).Execute("PRAGMA user_version=9");
  EXPECT_EQ(MessageOf(EpisodeFile::Open(good.string())),
            "has version 9 of the format; this program reads version 1, a newer one is "
            "needed");
}

TEST(EpisodeFileOfMany, MissingTablesAndColumnsAreNamed) {
  const fs::path folder = Fresh("missing");
  const fs::path good = folder / "a.episodes", bad = folder / "b.episodes";
  ASSERT_EQ(Record(good.string()).problem, "");
  const auto said = [&](const char* change) {
    fs::copy_file(good, bad, fs::copy_options::overwrite_existing);
    Database(bad.string(), Database::Mode::kWrite).Execute(change);
    return MessageOf(EpisodeFile::Open(bad.string()));
  };
  EXPECT_EQ(said("ALTER TABLE part RENAME TO parx"), "is damaged: it has no table 'part'");
  EXPECT_EQ(said("ALTER TABLE note RENAME COLUMN text TO texx"),
            "is damaged: its table 'note' has no column 'text'");
  EXPECT_TRUE([&] {
    said("CREATE TABLE remark(text TEXT); ALTER TABLE note ADD COLUMN author TEXT");
    return EpisodeFile::Open(bad.string()).has_value();
  }()) << "what others added is left alone";
}

/// What the first command that needs it says of a file after this change to its rows, whose pages
/// have the right checksums.
std::string AfterChange(const std::string& whole, const std::string& sql) {
  const std::string file = whole + "2";
  fs::copy_file(whole, file, fs::copy_options::overwrite_existing);
  Database(file, Database::Mode::kWrite).Execute(sql);
  const auto opened = EpisodeFile::Open(file);
  if (!opened) return opened.error().front().message;
  const EpisodeRow& row = opened->episodes().front();
  if (const auto task = opened->DescribeTaskOf(row); !task) return task.error().front().message;
  if (const auto things = opened->EntitiesOf(row); !things) return things.error().front().message;
  const auto timeline = opened->TimelineOf(row);
  return timeline ? "" : timeline.error().front().message;
}

TEST(EpisodeFileOfMany, AUuidIsOne) {
  const std::string file = (Fresh("uuid") / "a.episodes").string();
  ASSERT_EQ(Record(file).problem, "");
  for (const std::string uuid : {"../../target", "x a log:Evil . log:y", "", "/etc/passwd",
                                 "01234567-0123-0123-0123-01234567890g"}) {
    for (const char* where : {"episode SET uuid = '", "task SET uuid = '", "entity SET uuid = '"}) {
      EXPECT_EQ(AfterChange(file, "UPDATE " + (where + uuid) + "'"),
                "the file is damaged: found the UUID '" + uuid + "'")
          << where;
    }
  }
  EXPECT_EQ(AfterChange(file, "UPDATE task SET uuid = '01234567-89ab-cdef-0123-456789abcdef'"), "");
}

TEST(EpisodeFileOfMany, NoTextOfItReachesATerminalAsACommand) {
  const std::string file = (Fresh("strange") / "a.episodes").string();
  ASSERT_EQ(Record(file).problem, "");
  for (const char* change :
       {"task SET scenario = 'a' || char(27) || '[31m'", "event SET event = 'a' || char(155)",
        "event_role SET value = 'm' || char(8238)", "entity SET name = 'm' || char(8232)",
        "episode SET grammar = cast(x'ff' AS TEXT)"}) {
    const std::string said = AfterChange(file, std::string("UPDATE ") + change);
    EXPECT_EQ(said.find("the file is damaged: a text of it holds a "), 0u) << change << said;
  }
}

/// With a day of events, which meet each other; a question about every pair would take minutes.
TEST(EpisodeFileOfMany, AQuestionCostsByEvents) {
  const std::string file = (Fresh("day") / "a.episodes").string();
  ASSERT_EQ(Record(file).problem, "");
  const char* const count = std::getenv("PREHEND_EVENTS");  // more of them, by hand
  const int events = count ? std::atoi(count) : 20'000;
  Database(file, Database::Mode::kWrite)
      .Execute(
          "DELETE FROM event_role; DELETE FROM event_value; DELETE FROM event;"
          "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n WHERE x < " +
          std::to_string(events) +
          ") INSERT INTO event SELECT x, 1, iif(x % 2, 'contact', 'sliding'), x, x + 1, x,"
          " 0, x / 480.0, (x + 1) / 480.0, 1 / 480.0 FROM n");
  const auto answers = [&](const char* relation) {
    KnownNames known;
    EventQuestion question{.event = "contact"};
    if (*relation) question.relations = {{relation, "sliding"}};
    return Ask(file, question, known)->size();
  };
  const auto half = static_cast<std::size_t>(events) / 2;
  EXPECT_EQ(answers(""), half);
  EXPECT_EQ(answers("meets"), half);
  EXPECT_EQ(answers("met_by"), half - 1) << "nothing is before the first one";
  EXPECT_EQ(answers("before"), half - 1) << "the last one meets all that follows it";
  EXPECT_EQ(answers("after"), half - 2) << "the second one meets the only one before it";
  EXPECT_EQ(answers("overlaps") + answers("equals") + answers("inside"), 0u);
}

TEST(EpisodeFileOfMany, NothingOfAFileRunsWhenSomethingIsAdded) {
  const fs::path folder = Fresh("trigger");
  const fs::path good = folder / "a.episodes", bad = folder / "b.episodes";
  ASSERT_EQ(Record(good.string()).problem, "");
  for (const char* addition :
       {"CREATE TRIGGER t AFTER INSERT ON episode BEGIN DELETE FROM event; END",
        "CREATE VIEW v AS SELECT * FROM event", "CREATE TABLE remark(text TEXT)",
        "ALTER TABLE event ADD COLUMN author TEXT DEFAULT (1)",
        "CREATE INDEX i ON event(open_end)"}) {
    fs::copy_file(good, bad, fs::copy_options::overwrite_existing);
    Database(bad.string(), Database::Mode::kWrite).Execute(addition);
    const std::string before = Slurped(bad);
    EXPECT_NE(Record(bad.string()).problem.find("nothing is added to it"), std::string::npos)
        << addition;
    EXPECT_EQ(Slurped(bad), before) << addition;
    EXPECT_EQ(MessageOf(EpisodeFile::Open(bad.string())), "") << "it is still read";
  }
}

/// SQLite undoes a journal that it finds beside a file, and removes the file that the journal ends
/// with.
TEST(EpisodeFileOfMany, AJournalOfAnotherRemovesNothing) {
  const fs::path folder = Fresh("journal"), file = folder / "a.episodes",
                 letter = folder / "letter";
  EXPECT_EQ(Record(file.string()).problem, "");
  Spill(letter, "of the user");
  fs::create_symlink(file, folder / "link.episodes");
  const std::string magic = "\xd9\xd5\x05\xf9\x20\xa1\x63\xd7", name = letter.string();
  const auto word = [](std::uint64_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
    return bytes;
  };
  const std::string bytes = Slurped(file);
  const std::uint64_t page =
      static_cast<std::uint8_t>(bytes[16]) << 8 | static_cast<std::uint8_t>(bytes[17]);
  std::string journal =
      magic + word(0) + word(0) + word(bytes.size() / page) + word(512) + word(page);
  journal.resize(512, '\0');
  std::uint64_t sum = 0;
  for (const char one : name) sum += static_cast<std::uint64_t>(static_cast<signed char>(one));
  journal += word((1 << 30) / page + 1) + name + word(name.size()) + word(sum) + magic;
  const fs::path beside = file.string() + "-journal";
  const auto refused = [](const fs::path& path, Database (*open)(const std::string&)) {
    try {
      open(path.string());
    } catch (const DatabaseError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string why = "has a -journal of another program";
  Spill(folder / "link.episodes-journal", "");
  for (const fs::path& door : {file, folder / "link.episodes"}) {
    Spill(beside, journal);
    EXPECT_EQ(refused(door, OpenToRead), why) << door;
    EXPECT_EQ(refused(door, OpenToWrite), why) << door;
    EXPECT_EQ(Slurped(letter), "of the user") << door;
    EXPECT_EQ(Slurped(beside), journal) << door;
  }
  fs::remove(beside);
  ASSERT_EQ(mkfifo(beside.c_str(), 0600), 0);
  EXPECT_EQ(refused(file, OpenToRead), why) << "it hung";
  fs::remove(beside);
  EXPECT_EQ(refused(file, OpenToRead), "");
  EXPECT_EQ(Slurped(file), bytes);
}

/// The same file with another asset in the place of the one whose path ends so.
void Replace(const fs::path& file, const std::string& end, const std::string& from,
             const std::string& to) {
  const auto opened = EpisodeFile::Open(file);
  ASSERT_TRUE(opened) << MessageOf(opened);
  const auto task = opened->TaskOf(opened->episodes()[0]);
  ASSERT_TRUE(task);
  const auto asset =
      std::ranges::find_if(task->files, [&](const auto& one) { return one.first.ends_with(end); });
  ASSERT_NE(asset, task->files.end()) << end;
  std::string content = asset->second;
  const std::size_t at = content.find(from);
  ASSERT_NE(at, std::string::npos) << content;
  content.replace(at, from.size(), to);
  Compressor compressor;
  const Database database(file, Database::Mode::kWrite);
  Statement add = database.Prepare("INSERT INTO asset VALUES(?, ?, ?)");
  add.Bind(ContentHash(content)).Bind(static_cast<std::int64_t>(content.size()));
  add.BindBytes(compressor.Pack(content)).Run();
  Statement name = database.Prepare("UPDATE task_asset SET hash = ? WHERE path = ?");
  name.Bind(ContentHash(content)).Bind(asset->first).Run();
}

TEST(EpisodeFileOfMany, NoFileIsReadThatWasNotKeptWithAnEpisode) {
  const fs::path folder = Fresh("asked"), good = folder / "a.episodes", bad = folder / "b.episodes";
  ASSERT_EQ(Record(good.string()).problem, "");
  const std::string letter = (folder / "letter").string(), secret = "grammar of the user";
  for (const char* end : {"", ".grammar", ".csv", ".hand.yaml"}) Spill(letter + end, secret);
  const auto loaded = [&] {
    const auto opened = EpisodeFile::Open(bad);
    if (!opened) return MessageOf(opened);
    EpisodeLoader loader(kRoot);
    const auto run = loader.Load(*opened, opened->episodes()[0]);
    return run ? "" : grammar::Format(run.error());
  };
  const std::string kept =
      ": error: no such file was kept with episode 1 "
      "(reach/idling_beside_the_object_is_no_reach)";
  for (const std::string& asked :
       {letter, letter + ".grammar", "../../../../../../../../.." + letter,
        "pick_and_place+" + letter + ".grammar", std::string("no/such.grammar")}) {
    fs::copy_file(good, bad, fs::copy_options::overwrite_existing);
    Database(bad, Database::Mode::kWrite)
        .Prepare("UPDATE task SET asked_grammar = ?")
        .Bind(asked)
        .Run();
    const std::string said = loaded();
    EXPECT_EQ(said.find(secret), std::string::npos) << said;
    EXPECT_TRUE(said.find(kept) != std::string::npos || said.find("'letter'") != std::string::npos)
        << asked << said;
    EXPECT_EQ(said.find("prehend-"), std::string::npos) << "a folder that nobody knows: " << said;
  }
  const std::string scenario = "idling_beside_the_object_is_no_reach.yaml";
  for (const auto& [from, to] :
       {std::pair<std::string, std::string>{"hand: human_right", "hand: " + letter + ".hand.yaml"},
        {"{wait_s: 1.0}", "{recording: " + letter + ".csv}"}}) {
    fs::copy_file(good, bad, fs::copy_options::overwrite_existing);
    Replace(bad, scenario, from, to);
    const std::string said = loaded();
    EXPECT_NE(said.find(kept), std::string::npos) << said;
    EXPECT_EQ(said.find(secret), std::string::npos) << said;
  }
}

TEST(EpisodeFileOfMany, WhatATaskUnpacksHasALimit) {
  const fs::path file = Fresh("large") / "a.episodes";
  ASSERT_EQ(Record(file.string()).problem, "");
  Database(file, Database::Mode::kWrite).Execute("UPDATE asset SET bytes = 100 << 20");
  const auto opened = EpisodeFile::Open(file);
  const auto task = opened->TaskOf(opened->episodes()[0]);
  ASSERT_FALSE(task);
  EXPECT_EQ(task.error().front().message,
            "episode 1 (reach/idling_beside_the_object_is_no_reach): the files of a task have more "
            "than 256 MiB in all");
}

TEST(EpisodeFileOfMany, AnAlteredFileIsMergedByNameOrRefused) {
  const fs::path folder = Fresh("altered"), good = folder / "a.episodes",
                 bad = folder / "b.episodes", out = folder / "c.episodes";
  ASSERT_EQ(Record(good.string()).problem, "");
  const EpisodeRow row = EpisodeFile::Open(good)->episodes()[0];
  const auto merged = [&](const std::string& table, const std::string& columns) {
    fs::copy_file(good, bad, fs::copy_options::overwrite_existing);
    Database(bad, Database::Mode::kWrite)
        .Execute("DROP VIEW events_flat; DROP VIEW episodes_flat; CREATE TABLE other AS SELECT " +
                 columns + " FROM " + table + "; DROP TABLE " + table +
                 "; ALTER TABLE other RENAME TO " + table);
    const std::string files[] = {bad.string()};
    const auto done = MergeEpisodes(files, out);
    return done ? "" : done.error().front().message;
  };
  const std::string others =
      "failure_advice, failure_reason, failure_entity, 'x' AS remark, recorded_on, program_hash, "
      "program, seed, engine, state_hash, ticks, ticks_per_second, status, task, uuid, id, ";
  EXPECT_EQ(merged("episode", others + "outcome, grammar"), "");
  const EpisodeRow again = EpisodeFile::Open(out)->episodes()[0];
  EXPECT_EQ(again.status + again.grammar + again.state_hash + again.uuid,
            row.status + row.grammar + row.state_hash + row.uuid);
  fs::remove(out);
  const std::string begin = bad.string() + ": the file is damaged: row (1, ";
  EXPECT_EQ(
      merged("episode", others + "grammar, NULL AS outcome"),
      begin + row.uuid + ") of its table 'episode': NOT NULL constraint failed: episode.outcome");
  EXPECT_EQ(merged("entity", "*, 1 AS x"), "");
  fs::remove(out);
  EXPECT_EQ(
      merged(
          "entity",
          "task, 0 AS number, uuid, name, class, part_of, mass_kg, size_x_m, size_y_m, size_z_m"),
      begin + "0) of its table 'entity': UNIQUE constraint failed: entity.task, entity.number");
  EXPECT_NE(merged("asset", "hash, bytes, NULL AS content")
                .find(") of its table 'asset': NOT NULL constraint failed: asset.content"),
            std::string::npos);
  EXPECT_NE(merged("task", "id + 9 AS id, uuid, scenario, file, asked_grammar, settings, shows"),
            "")
      << "the episode has no task";
  EXPECT_FALSE(fs::exists(out));
}

/// Every file of a folder: name -> bytes.
std::map<std::string, std::string> Contents(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& file : fs::directory_iterator(folder)) all[file.path()] = Slurped(file.path());
  return all;
}

TEST(EpisodeFileOfMany, WhoReadsChangesNothingBesideAJournal) {
  const fs::path folder = Fresh("half"), file = folder / "a.episodes",
                 killed = folder / "killed/k.episodes", beside = killed.string() + "-journal";
  ASSERT_EQ(Record(file.string()).problem, "");
  fs::create_directories(killed.parent_path());
  const std::string whole = Slurped(file);
  {
    const Database writer = OpenToWrite(file);
    const Transaction transaction(writer);
    writer.Execute(
        "UPDATE task SET shows = 'half'; INSERT INTO part SELECT NULL, episode, part + 1000, "
        "first_tick, data FROM part");
    writer.Execute("PRAGMA cache_spill=1; PRAGMA cache_size=1; UPDATE event SET event = 'half'");
    fs::copy_file(file, killed);  // as if it were killed here
    fs::copy_file(file.string() + "-journal", beside);
  }
  ASSERT_NE(Slurped(killed), whole) << "nothing was written yet";
  const auto before = Contents(killed.parent_path());
  const auto half = [](const Database& database) {
    return database.Number("SELECT count(*) FROM event WHERE event = 'half'") +
           database.Number("SELECT count(*) FROM part WHERE part >= 1000");
  };
  EXPECT_EQ(half(OpenToRead(killed)), 0);
  fs::permissions(killed, fs::perms::owner_read);
  const auto opened = EpisodeFile::Open(killed);
  ASSERT_TRUE(opened) << MessageOf(opened);
  EXPECT_EQ(Contents(killed.parent_path()), before);
  // Of a stranger: it says that the file has one page.
  Spill(beside, before.at(beside).substr(0, 16) + std::string("\0\0\0\1", 4) +
                    before.at(beside).substr(20, 492));
  const auto shortened = Contents(killed.parent_path());
  EXPECT_NE(MessageOf(EpisodeFile::Open(killed)), "");
  EXPECT_EQ(Contents(killed.parent_path()), shortened);
  // Who merges over it, or writes to it, undoes it.
  Spill(beside, before.at(beside));
  fs::permissions(killed, fs::perms::owner_all);
  const std::string input = file.string();
  const auto merged = MergeEpisodes({&input, 1}, killed);
  ASSERT_TRUE(merged) << grammar::Format(merged.error());
  EXPECT_FALSE(fs::exists(beside)) << "it would undo the new file";
  Spill(killed, before.at(killed));
  Spill(beside, before.at(beside));
  EXPECT_EQ(half(OpenToWrite(killed)), 0);
  EXPECT_FALSE(fs::exists(beside));
}

TEST(EpisodeFileOfMany, NothingIsMadeBesideAFileInWalMode) {
  const fs::path folder = Fresh("wal"), file = folder / "a.episodes";
  ASSERT_EQ(Record(file.string()).problem, "");
  const std::string why =
      "is in WAL mode, or has a -wal beside it: another program has written to it";
  const std::string good = Slurped(file);
  Spill(folder / "a.episodes-wal", "");
  auto before = Contents(folder);
  EXPECT_EQ(MessageOf(EpisodeFile::Open(file)), why);
  EXPECT_EQ(Contents(folder), before);
  fs::remove(folder / "a.episodes-wal");
  std::string wal = good;
  wal[18] = wal[19] = 2;
  Spill(file, wal);
  before = Contents(folder);
  EXPECT_EQ(MessageOf(EpisodeFile::Open(file)), why);
  EXPECT_EQ(Record(file).problem, file.string() + ": " + why);
  EXPECT_EQ(Contents(folder), before);
}

TEST(EpisodeFileOfMany, EveryDamagedByteIsReportedOrHarmless) {
  const fs::path folder = Fresh("flipped");
  const fs::path good = folder / "a.episodes";
  const Played played = Record(good.string());
  const std::string bytes = Slurped(good);
  int refused = 0;
  for (std::size_t place = 4096; place < bytes.size(); place += bytes.size() / 40) {
    std::string bad = bytes;
    for (std::size_t i = 0; i < 16 && place + i < bad.size(); ++i) bad[place + i] ^= 0x55;
    Spill(folder / "b.episodes", bad);
    const auto opened = EpisodeFile::Open((folder / "b.episodes").string());
    if (!opened || opened->episodes().empty()) {
      ++refused;
      continue;
    }
    EpisodeLoader loader(kRoot);
    const auto loaded = loader.Load(*opened, opened->episodes()[0]);
    const auto again = loaded ? Resegment(*opened, opened->episodes()[0], *loaded, /*frames=*/true)
                              : Result<RunResult>(tl::unexpected(loaded.error()));
    if (!again) {
      ++refused;
      EXPECT_NE(again.error().front().message, "");
      continue;
    }
    EXPECT_EQ(again->state_hash, played.result.state_hash) << "changed frames are not passed on";
  }
  EXPECT_GT(refused, 20);
}

TEST(EpisodeFileOfMany, WhatCannotBeWrittenIsReported) {
  const fs::path folder = Fresh("foreign");
  Spill(folder / "a.episodes", "name: x\n");
  const std::string in_a_file = (folder / "a.episodes" / "b.episodes").string();
  EXPECT_TRUE(Record(in_a_file).problem.starts_with(in_a_file + ": ")) << Record(in_a_file).problem;
  EXPECT_EQ(Record((folder / "a.episodes").string()).problem,
            (folder / "a.episodes").string() +
                ": is no episode file: it does not begin as an SQLite database");
  EXPECT_EQ(Slurped(folder / "a.episodes"), "name: x\n");
}

}  // namespace
}  // namespace prehend::episode
