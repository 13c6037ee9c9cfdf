// SPDX-License-Identifier: Apache-2.0
// Events while a recording is written: the same as afterwards, each when it is decided.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

using Json = nlohmann::json;

/// A recording of the scenario, all facts.
std::filesystem::path Recorded(const std::filesystem::path& folder) {
  const auto file = folder / "milk.jsonl";
  EXPECT_EQ(Prehend({"run", "milk_carton_wrap", "--record", file.string()}).exit_code, 0);
  return file;
}

std::vector<Json> Lines(const std::string& text) {
  std::vector<Json> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(Json::parse(line));
  return lines;
}

void ExpectTheEventsOf(const std::filesystem::path& file, const Said& watched) {
  const Json all =
      Json::parse(Prehend({"episode", "resegment", file.string(), "--json"}).out)["events"];
  std::vector<Json> lines = Lines(watched.out);
  EXPECT_TRUE(std::is_sorted(lines.begin(), lines.end(), [](const Json& a, const Json& b) {
    return a["decided_tick"] < b["decided_tick"];
  })) << watched.out;
  EXPECT_EQ(lines.size(), all.size());
  for (const Json& event : all)
    EXPECT_NE(std::find(lines.begin(), lines.end(), event), lines.end()) << event;
}

TEST(Watch, PrintsTheEventsOfResegmentInTheOrderInWhichTheyAreDecided) {
  const auto folder = FreshFolder("watch");
  const auto file = Recorded(folder);
  const Said said = Prehend({"grammar", "watch", file.string(), "--json"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_GT(Lines(said.out).size(), 8u);
  ExpectTheEventsOf(file, said);
}

TEST(Watch, ReadsAPipeAndPrintsBeforeItsEnd) {
  const auto folder = FreshFolder("watch");
  const auto file = Recorded(folder);
  const std::string out = (folder / "out").string(), fifo = (folder / "fifo").string();
  // The producer writes two thirds of the lines, waits until a reach is printed, and writes the
  // rest.
  const std::string producer = "mkfifo " + fifo + " && { { head -n 800 " + file.string() +
                               "; for i in $(seq 100); do grep -q reaching " + out +
                               " && break; sleep 0.1; done; grep -q reaching " + out +
                               " && echo seen > " + (folder / "seen").string() + "; tail -n +801 " +
                               file.string() + "; } > " + fifo + " & } && { " + PREHEND_BINARY_DIR +
                               "/prehend grammar watch " + fifo + " --json > " + out + "; }";
  ASSERT_EQ(std::system(("cd " PREHEND_SOURCE_DIR " && " + producer).c_str()), 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "seen"));
  ExpectTheEventsOf(file, {.exit_code = 0, .out = ReadFile(out), .err = ""});
}

TEST(Watch, AFrameFarAheadIsLeftOutAndFaultsOfAKindAreCounted) {
  const auto folder = FreshFolder("watch");
  const auto file = Recorded(folder);
  const std::string text = ReadFile(file);
  std::size_t at = 0;
  for (int i = 0; i < 300; ++i) at = text.find('\n', at) + 1;
  const auto faulty = folder / "faulty.jsonl";
  std::string late = "{\"tick\": 90000000000, \"samples\": {}}\n";
  for (int i = 0; i < 50; ++i) late += "{\"tick\": " + std::to_string(i) + ", \"samples\": {}}\n";
  WriteFile(faulty, text.substr(0, at) + late + text.substr(at));
  const Said said = Prehend({"grammar", "watch", faulty.string(), "--json"});
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("s after the one before is left out"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("50 lines in all, the first: the ticks must increase"), std::string::npos)
      << said.err;
  EXPECT_EQ(said.err.find("faulty.jsonl:304:"), std::string::npos) << said.err;
  EXPECT_EQ(said.out, Prehend({"grammar", "watch", file.string(), "--json"}).out);
}

TEST(Watch, FramesAfterAPauseAreTaken) {
  const auto folder = FreshFolder("watch");
  const auto file = folder / "pause.jsonl";
  const std::string text = ReadFile(Recorded(folder));
  const std::string head = text.substr(0, text.find('\n') + 1);
  const auto watched = [&](const std::vector<int>& ticks) {
    std::string frames;
    for (const int tick : ticks)
      frames += "{\"tick\": " + std::to_string(tick) + ", \"samples\": {}}\n";
    WriteFile(file, head + frames + "{\"end_tick\": 9000300}\n");
    return Prehend({"grammar", "watch", file.string()});
  };
  const Said paused = watched({0, 100, 9'000'000, 9'000'100, 9'000'200});
  EXPECT_EQ(paused.exit_code, 0) << paused.err;
  // Of two frames that are far away, and from each other, and of the last one nothing agrees.
  const Said lost = watched({0, 100, 4'000'000, 9'000'000});
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_NE(lost.err.find("2 faulty lines were skipped"), std::string::npos) << lost.err;
  EXPECT_NE(lost.err.find("pause.jsonl:4:1: error: a frame 8333.12 s after the one before is left "
                          "out"),
            std::string::npos)
      << lost.err;
}

// Online and offline are alike: the first frame after a pause counts, and no frames are an error.
TEST(Watch, SeesWhatIsSeenOfAWholeFile) {
  const auto folder = FreshFolder("watch");
  const std::string file = (folder / "f.jsonl").string(), rules = (folder / "g.grammar").string();
  const std::string head =
      R"({"recording": 1, "episode": "e", "ticks_per_second": 10, "entities": {"h": {"hand": true, )"
      R"("size_m": [0.02, 0.02, 0.02]}, "a": {"class": "A", "size_m": [0.02, 0.02, 0.02]}}})"
      "\n";
  WriteFile(rules,
            "grammar g\nevent p(h: Hand, a: A) while touching(h, a)\n"
            "event n(h: Hand, a: A) while not touching(h, a) and height(a) < 1 m\n");
  WriteFile(file,
            head + R"({"tick": 0, "samples": {"h": {"at_m": [0, 0, 0]}, "a": {"at_m": [0, 0, 0]}}})"
                   "\n"
                   R"({"tick": 400, "touches": [{"a": "h", "b": "a"}]})"
                   "\n"
                   R"({"tick": 401, "touches": [{"a": "h", "b": "a"}]})"
                   "\n{\"tick\": 402}\n{\"end_tick\": 410}\n");
  const Said said = Prehend({"grammar", "watch", file, "--grammar", rules, "--json"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(Lines(said.out),
            Json::parse(
                Prehend({"episode", "resegment", file, "--grammar", rules, "--json"}).out)["events"]
                .get<std::vector<Json>>());
  ASSERT_EQ(Lines(said.out).size(), 3u) << said.out;
  EXPECT_EQ(Lines(said.out)[1]["begin_tick"], 400);
  WriteFile(file, head + "{\"end_tick\": 5}\n");
  for (const char* noun : {"watch", "resegment"})
    EXPECT_EQ(
        Prehend({noun[0] == 'w' ? "grammar" : "episode", noun, file, "--grammar", rules}).exit_code,
        2);
}

TEST(Watch, AFaultyLineIsNamedAndLeftOut) {
  const auto folder = FreshFolder("watch");
  const auto file = Recorded(folder);
  const std::string text = ReadFile(file);
  std::size_t at = 0;
  for (int i = 0; i < 300; ++i) at = text.find('\n', at) + 1;
  const auto faulty = folder / "faulty.jsonl";
  WriteFile(faulty, text.substr(0, at) + "{\"tick\": 1, \n" +
                        "{\"tick\": 100000, \"samples\": {\"milk\": {\"at_m\": [9, 9, 9]}, "
                        "\"mlk\": {\"at_m\": [0, 0, 0]}}}\n" +
                        text.substr(at));
  const Said said = Prehend({"grammar", "watch", faulty.string(), "--json"});
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("faulty.jsonl:301:"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("faulty.jsonl:302:"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("did you mean 'milk'?"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("2 faulty lines were skipped"), std::string::npos) << said.err;
  ExpectTheEventsOf(file, said);
}

TEST(Watch, AProducerThatIsLostEndsTheEpisode) {
  const auto folder = FreshFolder("watch");
  const std::string text = ReadFile(Recorded(folder));
  const auto cut = folder / "cut.jsonl";
  WriteFile(cut, text.substr(0, text.find("\n{\"end_tick\"") + 1));
  const Said said = Prehend({"grammar", "watch", cut.string(), "--json"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.err.find("without 'end_tick': what was open ends there"), std::string::npos)
      << said.err;
  ExpectTheEventsOf(cut, said);
  WriteFile(cut, "");
  EXPECT_EQ(Prehend({"grammar", "watch", cut.string()}).exit_code, 2);
  WriteFile(cut, "no recording\n");
  const Said none = Prehend({"grammar", "watch", cut.string()});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("cut.jsonl:1:1: error: "), std::string::npos) << none.err;
}

TEST(Watch, AFolderIsNoFile) {
  const auto folder = FreshFolder("watched_folder").string();
  const Said said = Prehend({"grammar", "watch", folder});
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.err.find("prehend: " + folder + " is a directory, not a file\n"), 0u) << said.err;
}

}  // namespace
}  // namespace prehend::house
