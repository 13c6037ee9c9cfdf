// SPDX-License-Identifier: Apache-2.0
// Every command that looks at an episode, with every kind of episode: it works, or says which fact
// is missing and what to do.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kKinds = 4;
const std::array<const char*, kKinds> kNames = {"a scenario", "a recorded run", "JSON Lines",
                                                "an imported recording"};

/// A scenario's name, a run of it in an episode file, a recording in JSON Lines, and the same in an
/// episode file.
const std::array<std::string, kKinds>& Episodes() {
  static const std::array<std::string, kKinds> episodes = [] {
    const fs::path folder = FreshFolder("episode_kinds");
    const std::string scenario = "reach/idling_beside_the_object_is_no_reach";
    std::array<std::string, kKinds> made = {scenario, (folder / "run.episodes").string(),
                                            (folder / "take.jsonl").string(),
                                            (folder / "take.episodes").string()};
    const std::string docs = PREHEND_SOURCE_DIR "/docs/motion_capture";
    EXPECT_EQ(Prehend({"run", scenario, "--record", made[1]}).exit_code, 0);
    EXPECT_EQ(
        Prehend({"import", docs + "/poses.csv", "--map", docs + "/bodies.yaml", "-o", made[2]})
            .exit_code,
        0);
    EXPECT_EQ(Prehend({"import", made[2], "-o", made[3]}).exit_code, 0);
    return made;
  }();
  return episodes;
}

const std::string kOut = "OUT";  // a file or folder of its own
const std::string kEpisode = "EPISODE";

struct Row {
  std::vector<std::string> words;
  std::array<int, kKinds> exit_codes;
  std::string missing;  ///< part of what a cell with exit code 2 says
};

const Row kRows[] = {
    {{"run", kEpisode},
     {0, 2, 2, 2},
     "so there is no scenario to simulate; 'prehend episode resegment"},
    {{"validate", kEpisode}, {0, 2, 2, 2}, "so there is no scenario to simulate; 'prehend"},
    {{"check", kEpisode, "--report", kOut}, {0, 0, 5, 5}, ""},
    {{"review", kEpisode}, {0, 0, 5, 2}, "has no golden: that of a recording lies beside"},
    {{"explain", kEpisode}, {0, 0, 0, 0}, ""},
    {{"grammar", "tracks", kEpisode}, {0, 0, 0, 0}, ""},
    {{"scenario", "poses", kEpisode}, {0, 0, 0, 0}, ""},
    {{"render", kEpisode, "--at", "0.5", "-o", kOut + ".png"}, {0, 0, 0, 0}, ""},
    {{"render", kEpisode, "--strip", "-o", kOut + ".svg"}, {0, 0, 0, 0}, ""},
    {{"figure", "keyframes", kEpisode, "-o", kOut + ".svg"}, {0, 0, 0, 0}, ""},
    {{"figure", "phases", kEpisode, "-o", kOut + ".svg"}, {0, 0, 0, 0}, ""},
    {{"episode", "resegment", kEpisode}, {0, 0, 0, 0}, ""},
    {{"episode", "resegment", kEpisode, "--json"}, {0, 0, 0, 0}, ""},
    {{"episode", "resegment", kEpisode, "-o", kOut + ".csv"}, {0, 0, 0, 0}, ""},
    {{"episode", "resegment", kEpisode, "--against", "recorded"},
     {2, 0, 2, 0},
     "has no events that were recorded with it; 'prehend "},
    {{"grammar", "watch", kEpisode}, {0, 0, 0, 0}, ""},
    {{"episode", "query", kEpisode}, {0, 0, 0, 0}, ""},
    {{"report", kEpisode, "-o", kOut + ".html"}, {0, 0, 0, 0}, ""},
    {{"episode", "list", kEpisode}, {2, 0, 2, 0}, "is not kept in an episode file; 'prehend "},
    {{"episode", "verify", kEpisode}, {2, 0, 2, 0}, "is not kept in an episode file; 'prehend "},
    {{"score", kEpisode}, {0, 0, 2, 2}, "its physical truth is not known; score it against labels"},
    {{"grammar", "sweep", kEpisode, "--over", "reach_radius=20cm..40cm:2"},
     {0, 0, 2, 2},
     "its physical truth is not known; score it against labels"},
    {{"grammar", "margins", kEpisode},
     {0, 0, 2, 2},
     "its physical truth is not known; score it against labels"},
    {{"episode", "knowledge", kEpisode, "-o", kOut}, {0, 0, 0, 0}, ""},
    {{"accept", kEpisode, "--reviewed", "0123456789abcdef", "--reason", "seen"},
     {0, 2, 1, 2},
     "has no golden: that of "},
};

/// A project with the one scenario: `accept` writes goldens, and those of the library are no
/// test's to write.
fs::path ProjectToAcceptIn() {
  const fs::path project = FreshFolder("episode_kinds_project");
  WriteFile(project / "prehend.yaml", "");
  for (const std::string& file :
       {"scenarios/" + Episodes()[0] + ".yaml", "golden/" + Episodes()[0] + ".timeline"})
    WriteFile(project / file, ReadFile(fs::path(PREHEND_SOURCE_DIR) / file));
  return project;
}

TEST(EpisodeKinds, EveryCommandTakesEachOrSaysWhatIsMissing) {
  const fs::path folder = FreshFolder("episode_kinds_out"), project = ProjectToAcceptIn();
  int number = 0;
  for (const Row& row : kRows) {
    for (std::size_t kind = 0; kind < kKinds; ++kind) {
      std::vector<std::string> words = row.words;
      const std::string out = (folder / std::to_string(++number)).string();
      for (std::string& word : words) {
        if (word == kEpisode) word = Episodes()[kind];
        if (word.starts_with(kOut)) word = out + word.substr(kOut.size());
      }
      std::vector<std::string> environment = {"CI="};
      if (words[0] == "accept") environment.push_back("PREHEND_HOME=" + project.string());
      const Said said = Prehend(words, environment);
      const std::string which =
          row.words[row.words[1] == kEpisode ? 0 : 1] + " of " + kNames[kind] + ": " + said.err;
      EXPECT_EQ(said.exit_code, row.exit_codes[kind]) << which;
      if (said.exit_code == 2) {
        EXPECT_NE(said.err.find(row.missing), std::string::npos) << which;
      }
      for (const char* never : {"control character", "no such file", "No such file"})
        EXPECT_EQ((said.out + said.err).find(never), std::string::npos) << which;
    }
  }
}

TEST(EpisodeKinds, AcceptDoesNotAskWhyWhereThereIsNoGolden) {
  const std::string project = "PREHEND_HOME=" + ProjectToAcceptIn().string();
  for (const std::size_t kept : {1, 3}) {
    const Said said = Prehend({"accept", Episodes()[kept]}, {"CI=", project});
    EXPECT_EQ(said.exit_code, 2);
    EXPECT_NE(said.err.find("has no golden: that of "), std::string::npos) << said.err;
  }
}

// What is played first says the same as a run.
TEST(EpisodeKinds, AScenarioIsPlayedFirst) {
  const std::string& scenario = Episodes()[0];
  EXPECT_EQ(Prehend({"episode", "resegment", scenario}).out, Prehend({"run", scenario}).out);
  EXPECT_EQ(Prehend({"episode", "resegment", scenario}).out,
            Prehend({"episode", "resegment", Episodes()[1]}).out);
  const Said asked = Prehend({"episode", "query", scenario, "--json"}),
             kept = Prehend({"episode", "query", Episodes()[1], "--json"});
  EXPECT_EQ(std::ranges::count(asked.out, '{'), std::ranges::count(kept.out, '{'));
}

// A recording is the same in either form.
TEST(EpisodeKinds, ARecordingIsTheSameInEitherForm) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"episode", "resegment"},
                                             {"explain"},
                                             {"grammar", "tracks"},
                                             {"grammar", "watch"},
                                             {"scenario", "poses"}}) {
    std::vector<std::string> lines = words, kept = words;
    lines.push_back(Episodes()[2]);
    kept.push_back(Episodes()[3]);
    EXPECT_EQ(Prehend(lines).out, Prehend(kept).out) << words.back();
  }
}

TEST(EpisodeKinds, AChoiceNeedsAnEpisodeFile) {
  for (const std::size_t kind : {0u, 2u}) {
    const Said said = Prehend({"explain", Episodes()[kind], "--episode", "1"});
    EXPECT_EQ(said.exit_code, 2);
    EXPECT_EQ(said.err,
              "prehend: --episode needs episode files; " + Episodes()[kind] + " is none\n");
  }
}

}  // namespace
}  // namespace prehend::house
