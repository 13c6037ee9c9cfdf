// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episodes/recordings.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "harness/episode/episode/episode.h"

namespace prehend::episode {
namespace {

namespace fs = std::filesystem;

const std::string kProject = PREHEND_SOURCE_DIR;

constexpr const char* kLines =
    R"({"recording": 1, "episode": "cup_is_touched", "grammar": "contact", "ticks_per_second": 100, "styles": ["wrap"], "entities": {"right_hand": {"hand": true, "size_m": [0.09, 0.08, 0.03]}, "table": {"class": "Table", "fixed": true, "size_m": [1.0, 1.0, 0.04]}, "cup": {"class": "Mug", "kinds": ["Cup"], "part_of": "table", "size_m": [0.08, 0.08, 0.1], "parts": [{"cylinder": {"radius_m": 0.04, "length_m": 0.1}}]}}}
{"tick": 0, "samples": {"table": {"at_m": [0, 0, 0.7]}, "cup": {"at_m": [0, 0, 0.77]}, "right_hand": {"at_m": [0.2, 0, 0.9]}}, "hands": {"right_hand": {"trigger": 0.25}}, "touches": [{"a": "cup", "b": "table", "up_on_a": 1, "force_n": 5, "at_m": [0, 0, 0.72], "normal": [0, 0, 1]}]}
{"tick": 50, "samples": {"right_hand": {"at_m": [0.05, 0, 0.77]}}, "touches": [{"a": "cup", "b": "table", "up_on_a": 1}, {"a": "right_hand", "b": "cup", "sensor_sets": ["thumb"]}]}
)";

/// A folder with the recording in a file, and the episode file.
struct Imported {
  fs::path folder;
  Recording recording;
  ImportedRecording imported;

  explicit Imported(const std::string& end = "{\"end_tick\": 100}\n") {
    folder = fs::temp_directory_path() / ("prehend_recordings_" + std::to_string(getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder);
    std::ofstream(folder / "take.jsonl") << kLines << end;
    recording = *episode::ReadRecording((folder / "take.jsonl").string());
    imported = *ImportRecording({.file = file(),
                                 .root = kProject,
                                 .source = (folder / "take.jsonl").string(),
                                 .grammar = {},
                                 .recorded_on = "2026-01-02",
                                 .program_hash = "0123"},
                                recording);
  }
  std::string file() const { return (folder / "takes.episodes").string(); }
};

TEST(Recordings, BecomeEpisodesAndComeBack) {
  Imported made;
  EXPECT_EQ(made.imported.problem, "");
  ASSERT_EQ(made.imported.segmented.timeline.events.size(), 3);

  const auto opened = EpisodeFile::Open(made.file());
  ASSERT_TRUE(opened);
  ASSERT_EQ(opened->episodes().size(), 1);
  const EpisodeRow& row = opened->episodes()[0];
  EXPECT_FALSE(row.simulated);
  EXPECT_EQ(row.scenario, "cup_is_touched");
  EXPECT_EQ(row.status, "completed");
  EXPECT_EQ(row.grammar, "contact");
  EXPECT_EQ(row.ticks, 99);
  EXPECT_EQ(opened->EntitiesOf(row)->size(), 3);
  EXPECT_EQ(opened->EntitiesOf(row)->at(2).part_of, 1);

  auto read = ReadRecording(*opened, row);
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->frames.empty()) << "they stay in the file";
  const std::uint64_t hash = HashOfFrames(*read);
  read->Keep();
  EXPECT_EQ(read->frames.size(), 2);
  read->hash = 0;
  EXPECT_EQ(HashOfFrames(*read), hash) << "of frames in memory, too";
  EXPECT_EQ(read->end_tick, 100);
  EXPECT_TRUE(read->says_its_end);
  EXPECT_EQ(read->placed, (std::vector<bool>{true, true, true}));
  EXPECT_EQ(HashOfFrames(*read), HashOfFrames(made.recording));
  EXPECT_EQ(read->header.entity_table.entities[2].classes,
            made.recording.header.entity_table.entities[2].classes);

  auto episode = OpenEpisode({.file = made.file(), .number = row.id}, {}, kProject);
  ASSERT_TRUE(episode);
  const auto again = episode->Run(true);
  ASSERT_TRUE(again);
  ASSERT_EQ(again->timeline.events.size(), 3);
  EXPECT_EQ(again->timeline.events[1].Label(), opened->TimelineOf(row)->events[1].Label());
  EXPECT_FALSE(again->is_unfinished);
  EXPECT_EQ(again->recording.size(), 2);
}

TEST(Recordings, WithoutAnEndAreUnfinished) {
  const Imported made("");
  const auto opened = EpisodeFile::Open(made.file());
  ASSERT_TRUE(opened);
  const EpisodeRow& row = opened->episodes()[0];
  EXPECT_EQ(row.status, "unfinished");
  EXPECT_EQ(row.end.kind, physics::RunStatus::Kind::kCompleted);
  auto episode = OpenEpisode({.file = made.file(), .number = row.id}, {}, kProject);
  ASSERT_TRUE(episode);
  EXPECT_TRUE(episode->Run(false)->is_unfinished);
}

TEST(Recordings, HaveASceneThatStandsInForThem) {
  Imported made;
  const scenario::Scenario scenario = PlaceholderFor(made.recording.header);
  ASSERT_EQ(scenario.scene.bodies.size(), 2);
  ASSERT_EQ(scenario.scene.hands.size(), 1);
  EXPECT_EQ(scenario.scene.bodies[0].name, "table");
  EXPECT_TRUE(scenario.scene.bodies[0].fixed);
  EXPECT_TRUE(
      std::holds_alternative<physics::Cylinder>(scenario.scene.bodies[1].shapes.front().shape));
  EXPECT_EQ(scenario.body_part_of, (std::vector<int>{-1, 0}));
  EXPECT_TRUE(scenario.scene.hands[0].model.links.empty()) << "fingers are not known";

  const physics::Snapshot first =
      PlaceholderSnapshotAt(made.recording.header, made.recording.frames[0]);
  EXPECT_EQ(first.bodies[1].X_WB.p_m.z(), 0.77);
  EXPECT_EQ(first.hands[0].palm.X_WB.p_m.x(), 0.2);
  EXPECT_EQ(first.hands[0].trigger, 0.25);
  ASSERT_EQ(first.contacts.size(), 1);
  EXPECT_NEAR(first.contacts[0].normal_impulse_n_s, 0.05, 1e-12);
  EXPECT_TRUE(
      PlaceholderSnapshotAt(made.recording.header, made.recording.frames[1]).contacts.empty())
      << "where these touches are is not known";
}

}  // namespace
}  // namespace prehend::episode
