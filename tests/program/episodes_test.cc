// SPDX-License-Identifier: Apache-2.0
// Episode files, as a person uses them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

const std::string kShort = "reach/idling_beside_the_object_is_no_reach";

TEST(Episodes, ARunAndItsEpisodeSayTheSame) {
  const auto file = (FreshFolder("episodes") / "two.episodes").string();
  const Said alone = Prehend({"run", "milk_carton_wrap", "--json"});
  const Said played = Prehend({"run", "milk_carton_wrap", "--json", "--record", file});
  ASSERT_EQ(played.exit_code, 0) << played.err;
  EXPECT_EQ(played.out, alone.out) << "recording changes nothing";
  ASSERT_EQ(Prehend({"run", kShort, "--record", file}).exit_code, 0);

  const Said again =
      Prehend({"episode", "resegment", file, "--episode", "milk_carton_wrap", "--json"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  auto first = nlohmann::json::parse(played.out), second = nlohmann::json::parse(again.out);
  EXPECT_EQ(second["file"], file);
  EXPECT_EQ(second["episode"], 1);
  second.erase("file");
  second.erase("episode");
  EXPECT_EQ(first["claims"][0]["verdict"], "holds") << "of an episode, check judges them";
  first.erase("claims");
  EXPECT_EQ(first, second);

  const Said both = Prehend({"episode", "resegment", file, file, "--against", "recorded"});
  EXPECT_EQ(both.exit_code, 0) << both.err;
  EXPECT_EQ(both.out, "2 episodes, 0 with differences\n") << "a file named twice counts once";
  const Said differs =
      Prehend({"episode", "resegment", file, "--against", "recorded", "--set", "lift_rise=10m"});
  EXPECT_EQ(differs.exit_code, 1) << differs.err;
  EXPECT_NE(differs.out.find("- picking_up"), std::string::npos) << differs.out;
  EXPECT_NE(differs.out.find("2 episodes, 2 with differences\n"), std::string::npos);
  const Said none = Prehend({"episode", "resegment", file, "--episode", "slide/*"});
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_EQ(none.err, "prehend: --episode: no episode matches 'slide/*'\n");
}

TEST(Episodes, EveryCommandTakesThem) {
  const auto folder = FreshFolder("all_commands");
  const auto file = (folder / "two.episodes").string();
  const std::string slide = "slide/hop_divides_a_slide";
  ASSERT_EQ(Prehend({"run", kShort, "--record", file}).exit_code, 0);
  ASSERT_EQ(Prehend({"run", slide, "--record", file}).exit_code, 0);
  const Said listed = Prehend({"episode", "list", file});
  EXPECT_NE(listed.out.find("completed  "), std::string::npos) << listed.out;
  EXPECT_NE(listed.out.find(slide), std::string::npos) << listed.out;
  EXPECT_EQ(Prehend({"episode", "verify", file}).out,
            "2 of 2 episodes have the frames and events that were recorded\n");

  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"explain"},
                                             {"explain", "--expected", "sliding@2s", "--json"},
                                             {"grammar", "tracks", "--only", "grasping"}}) {
    std::vector<std::string> from_file = words, from_scenario = words;
    from_file.insert(from_file.end(), {file, "--episode", "slide/*"});
    from_scenario.push_back(slide);
    const Said one = Prehend(from_file), other = Prehend(from_scenario);
    EXPECT_EQ(one.exit_code, 0) << one.err;
    EXPECT_EQ(one.out, other.out);
  }
  const auto report = (folder / "report").string();
  const Said checked = Prehend({"check", file, "--no-pictures", "--report", report});
  EXPECT_EQ(checked.exit_code, 0) << checked.out;
  EXPECT_NE(checked.out.find("passed  " + slide), std::string::npos) << checked.out;
  const Said scored = Prehend({"score", file, "--grammar", "pick_and_place"}),
             played = Prehend({"score", kShort, slide, "--grammar", "pick_and_place"});
  EXPECT_EQ(scored.exit_code, 0) << scored.err;
  EXPECT_EQ(scored.out, played.out);

  const Said which = Prehend({"explain", file});
  EXPECT_EQ(which.exit_code, 4);
  EXPECT_NE(which.err.find("has 2 such episodes; --episode selects one"), std::string::npos);
  const Said again = Prehend({"check", file, "--repeat", "2"});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_EQ(again.err, "prehend: --repeat plays scenarios; " + file + " is a recording\n");
}

TEST(Episodes, ThePictureOfAnEpisodeIsThatOfItsScenario) {
  const auto folder = FreshFolder("episode_pictures");
  const auto file = (folder / "a.episodes").string(), one = (folder / "one.png").string(),
             other = (folder / "other.png").string();
  ASSERT_EQ(Prehend({"run", kShort, "--record", file}).exit_code, 0);
  const Said drawn = Prehend({"render", file, "--at", "1.5", "-o", one});
  if (drawn.exit_code == 3 && drawn.err.find("no picture") != std::string::npos)
    GTEST_SKIP() << "this build draws no pictures";
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  ASSERT_EQ(Prehend({"render", kShort, "--at", "1.5", "-o", other}).exit_code, 0);
  EXPECT_EQ(ReadFile(one), ReadFile(other));
  EXPECT_FALSE(ReadFile(one).empty());
}

TEST(Episodes, AGrammarOfOnesOwnIsKeptWithTheEpisode) {
  const auto folder = FreshFolder("own_grammar");
  const auto file = (folder / "a.episodes").string(), own = (folder / "own.grammar").string();
  WriteFile(own, Replaced(ReadFile(PREHEND_SOURCE_DIR "/grammar/library/contact.grammar"),
                          "grammar contact", "grammar own"));
  const Said played = Prehend({"run", kShort, "--grammar", own, "--record", file});
  ASSERT_EQ(played.exit_code, 0) << played.err;
  std::filesystem::remove(own);
  const Said again = Prehend({"episode", "resegment", file});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.out, played.out);
}

TEST(Episodes, ASuiteIsRecordedByWorkersIntoOneFile) {
  const auto folder = FreshFolder("suite_episodes");
  const auto file = (folder / "suite.episodes").string();
  const Said checked = Prehend({"check", "reach/*", "--no-pictures", "--jobs", "3", "--record",
                                file, "--report", (folder / "report").string()});
  ASSERT_EQ(checked.exit_code, 0) << checked.out << checked.err;
  const Said compared =
      Prehend({"episode", "resegment", file, "--against", "recorded", "--jobs", "3"});
  EXPECT_EQ(compared.exit_code, 0) << compared.err;
  EXPECT_TRUE(compared.out.ends_with("episodes, 0 with differences\n")) << compared.out;
}

TEST(Episodes, TrialsAreRecordedEachByItself) {
  const auto file = (FreshFolder("recorded_trials") / "trials.episodes").string();
  const std::string scenario = "trials/gripper_places_a_box";
  const Said alone = Prehend({"run", scenario, "--trials", "3", "--json"});
  const Said recorded =
      Prehend({"run", scenario, "--trials", "3", "--json", "--jobs", "2", "--record", file});
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  EXPECT_EQ(recorded.out, alone.out) << "recording changes nothing";
  EXPECT_EQ(Prehend({"episode", "resegment", file, "--against", "recorded"}).out,
            "3 episodes, 0 with differences\n");
  const auto trial =
      nlohmann::json::parse(Prehend({"run", scenario, "--trial", "2", "--json"}).out);
  EXPECT_NE(Prehend({"episode", "list", file}).out.find(trial["state_hash"].get<std::string>()),
            std::string::npos);

  // Other values have other boundaries.
  const Said judged = Prehend({"check", file, "--no-pictures"});
  EXPECT_EQ(judged.exit_code, 0) << judged.out;
  EXPECT_NE(judged.out.find("a trial: judged by its claims and its outcome, not by the golden of "
                            "what was not varied\n"),
            std::string::npos)
      << judged.out;
  EXPECT_TRUE(judged.out.ends_with("3 passed, 0 failed\n")) << judged.out;
  const Said page = Prehend({"report", file, "-o", file + ".html"});
  EXPECT_TRUE(page.out.ends_with(": 3 episodes, 3 passed, 0 failed, 0 without golden\n"))
      << page.out;
  EXPECT_EQ(Prehend({"run", scenario, "--trials", "3", "--shard", "4/5"}).out,
            "no trial is of this part\n");
}

TEST(Episodes, BadUseIsExplained) {
  const auto folder = FreshFolder("bad_episodes");
  const auto text = (folder / "text.episodes").string();
  WriteFile(text, "name: x\n");
  const std::string cause = ": is no episode file: it does not begin as an SQLite database\n";
  const Said run = Prehend({"run", kShort, "--record", text});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.err, "prehend: --record: " + text + cause);
  const Said check = Prehend({"check", kShort, "--record", text});
  EXPECT_EQ(check.exit_code, 2);
  EXPECT_EQ(check.err, "prehend: --record: " + text + cause);
  const auto below_file = text + "/a.episodes";
  const Said lost = Prehend({"run", kShort, "--record", below_file});
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_EQ(lost.err,
            "prehend: --record: " + below_file + ": cannot create " + text + ": Not a directory\n");
  for (const char* name : {"no/folder/a.episodes", "no/other/a.jsonl"})
    EXPECT_EQ(Prehend({"run", kShort, "--record", (folder / name).string()}).exit_code, 0);
  const Said other = Prehend({"check", kShort, "--record", (folder / "a.jsonl").string()});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("wanted a file NAME.episodes"), std::string::npos) << other.err;
  const Said read = Prehend({"episode", "resegment", text});
  EXPECT_EQ(read.exit_code, 2);
  EXPECT_NE(read.err.find("is no episode file"), std::string::npos) << read.err;
  const Said lines =
      Prehend({"episode", "resegment", (folder / "a.jsonl").string(), "--jobs", "2"});
  EXPECT_EQ(lines.exit_code, 2);
  EXPECT_NE(lines.err.find("a.jsonl: error: no such file"), std::string::npos) << lines.err;
}

TEST(Episodes, DamageIsNamedByEveryCommandThatLooksAtFrames) {
  const auto file = (FreshFolder("damaged_episodes") / "a.episodes").string();
  ASSERT_EQ(Prehend({"run", kShort, "--record", file}).exit_code, 0);
  // The first bytes of each part, to find it in the file.
  const std::string listed = file + ".parts";
  ASSERT_EQ(std::system(("sqlite3 '" + file + "' 'SELECT hex(substr(data, 1, 24)) FROM part' > '" +
                         listed + "'")
                            .c_str()),
            0);
  std::string bytes = ReadFile(file);
  std::istringstream parts(ReadFile(listed));
  for (std::string part; parts >> part;) {
    std::string begin;
    for (std::size_t i = 0; i + 2 <= part.size(); i += 2)
      begin += static_cast<char>(std::stoi(part.substr(i, 2), nullptr, 16));
    const std::size_t at = bytes.find(begin);
    if (at != std::string::npos) bytes[at + 20] ^= 1;
  }
  WriteFile(file, bytes);
  const std::string svg = file + ".svg", png = file + ".png", page = file + ".html";
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"explain", file},
           {"grammar", "tracks", file},
           {"episode", "resegment", file},
           {"scenario", "poses", file},
           {"episode", "verify", file},
           {"figure", "phases", file, "-o", svg},
           {"render", file, "-o", png},
           {"report", file, "-o", page},
           {"grammar", "sweep", file, "--over", "reach_radius=10cm..20cm:2", "--truth",
            "recorded"}}) {
    const Said said = Prehend(words);
    EXPECT_EQ(said.exit_code, 2) << words[0] << said.out;
    EXPECT_NE(said.err.find(file), std::string::npos) << words[0] << ": " << said.err;
    EXPECT_NE(said.err.find("the file is damaged"), std::string::npos)
        << words[0] << ": " << said.err;
  }
  EXPECT_FALSE(std::filesystem::exists(svg) || std::filesystem::exists(png));
}

TEST(Episodes, AreWholeAfterTheProgramWasKilledAtAnyMoment) {
  const auto folder = FreshFolder("killed_episodes");
  const auto file = (folder / "a.episodes").string();
  const char* count = std::getenv("PREHEND_KILLS");  // more of them, by hand
  const int kills = count ? std::atoi(count) : 6;
  std::size_t most_cut_off = 0, whole = 0;  // each run goes on where the one before was stopped
  for (int i = 0; i < kills || (whole == 0 && i < kills + 10); ++i) {
    // On a busy machine none may have come to its end by then.
    const double seconds =
        i < kills ? 0.02 + 1.3 * std::fmod(0.618034 * i, 1.0) : 2.0 * (i - kills + 1);
    const std::string command =
        "cd '" PREHEND_SOURCE_DIR "' && { setsid '" PREHEND_BINARY_DIR
        "/prehend' check 'reach/*' 'slide/*' --no-pictures --jobs 3 --record " +
        file + " --report " + (folder / "report").string() + " >/dev/null 2>&1 & p=$!; sleep " +
        std::to_string(seconds) + "; kill -s KILL -- -$p; wait $p; } >/dev/null 2>&1";
    (void)std::system(command.c_str());
    if (!std::filesystem::exists(file) || std::filesystem::file_size(file) == 0) continue;
    const Said listed = Prehend({"episode", "list", file, "--json"});
    ASSERT_TRUE(listed.exit_code == 0 || listed.exit_code == 4) << listed.err;
    std::size_t finished = 0, cut_off = 0;
    for (const auto& row : nlohmann::json::parse(listed.out))
      ++(row["status"] == "recording" ? cut_off : finished);
    most_cut_off = std::max(most_cut_off, cut_off);
    EXPECT_GE(finished, whole) << "no finished episode is lost";
    whole = finished;
    if (whole == 0 || (i % 20 != 5 && i + 1 < kills)) continue;
    const Said replayed = Prehend({"episode", "verify", file, "--jobs", "2"});
    EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
    EXPECT_NE(replayed.out.find(std::to_string(whole) + " of "), std::string::npos);
  }
  EXPECT_GT(most_cut_off, 0u);
  EXPECT_GT(whole, 0u);
}

TEST(Episodes, AFullDiskLeavesTheVerdict) {
  // A small limit for the size of files stands for a full disk; its signal is ignored.
  const auto file = (FreshFolder("full_episodes") / "a.episodes").string();
  const Said said =
      Prehend({"run", "milk_carton_wrap", "--record", file}, {}, "trap '' XFSZ && ulimit -f 1000");
  EXPECT_EQ(said.exit_code, 3);
  EXPECT_NE(said.out.find("completed: 5.1500 s"), std::string::npos) << said.out;
  EXPECT_NE(said.err.find("--record: " + file + ": "), std::string::npos) << said.err;
}

}  // namespace
}  // namespace prehend::house
