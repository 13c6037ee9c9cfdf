// SPDX-License-Identifier: Apache-2.0
// Events that somebody else found, in files, scored as those of a grammar are
// (docs/recognisers.md).
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kGrammar = "pick_and_place_from_motion";

std::string Has(const std::string& text, const std::string& part) {
  return text.find(part) == std::string::npos ? text : "";
}

class Found : public testing::Test {
 protected:
  ~Found() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  std::string Write(const std::string& name, const std::string& text) const {
    WriteFile(folder_ / name, text);
    return Path(name);
  }
  std::string Take(const std::string& name) const {
    const Said said = Prehend(
        {"import", docs_ + "/poses.csv", "--map", docs_ + "/bodies.yaml", "-o", Path(name)});
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return Path(name);
  }
  static json Score(std::vector<std::string> words) {
    words.insert(words.begin(), "score");
    words.emplace_back("--json");
    const Said said = Prehend(words);
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return said.exit_code == 0 ? json::parse(said.out)["grammars"] : json::array();
  }
  static Said Refused(std::vector<std::string> words) {
    words.insert(words.begin(), "score");
    const Said said = Prehend(words);
    EXPECT_EQ(said.exit_code, 2) << said.out;
    EXPECT_EQ(said.out, "");
    return said;
  }

  const std::string docs_ = PREHEND_SOURCE_DIR "/docs/motion_capture";
  const fs::path folder_ =
      FreshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
};

/// Everything but the name, and when events were decided.
json Figures(json score) {
  for (const char* name : {"grammar", "cpu_s_per_s"}) score.erase(name);
  score["total"].erase("latency_s");
  for (json& event : score["events"]) event.erase("latency_s");
  return score;
}

TEST_F(Found, RolesThatAnEventDoesNotHaveAreTold) {
  const std::string take = Take("milk.jsonl");
  const std::string line =
      R"({"event": "grasping", "roles": {"hand": "right_hand", "object": "milk", "objct": "table"}, )";
  const std::string found = Write("milk.found.jsonl", line +
                                                          R"("begin_s": 1, "end_s": 2})"
                                                          "\n" +
                                                          line +
                                                          R"("begin_s": 3, "end_s": 4})"
                                                          "\n");
  const Said said = Prehend({"score", take, "--truth", docs_ + "/labels.csv", "--map",
                             docs_ + "/labels.yaml", "--grammar", kGrammar, "--found", found});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(Has(said.err,
                ": warning: 'grasping' has no role 'objct': it is left out of 2 lines\n"
                "  hint: did you mean 'object'?\n"),
            "");
}

TEST_F(Found, EachKindOfFileHasTheGrammarsOwnRow) {
  const std::string take = Take("milk.jsonl"), truth = docs_ + "/labels.csv";
  const std::vector<std::string> labels = {
      take, "--truth", truth, "--map", docs_ + "/labels.yaml", "--grammar", kGrammar};
  for (const char* ending : {"csv", "eaf", "TextGrid", "timeline", "jsonl"}) {
    const std::string file = Path(std::string("milk.found.") + ending);
    if (ending == std::string("jsonl")) {
      Write("milk.found.jsonl",
            Prehend({"grammar", "watch", take, "--grammar", kGrammar, "--json"}).out);
    } else if (ending == std::string("timeline")) {
      const Said accepted = Prehend({"accept", take, "--reason", "for this test"}, {"CI="});
      ASSERT_EQ(accepted.exit_code, 0) << accepted.err;
      fs::rename(Path("milk.timeline"), file);
    } else {
      ASSERT_EQ(Prehend({"episode", "resegment", take, "-o", file}).exit_code, 0);
    }
    // As truth and found they are the same everywhere.
    const json same = Score({take, "--truth", file, "--found", file, "--grammar", kGrammar});
    ASSERT_EQ(same.size(), 2u);
    // EAF keeps whole milliseconds, and a tick is a tenth of one.
    const double rounding = ending == std::string("eaf") ? 1e-3 : 0;
    for (const json& score : same) {
      EXPECT_EQ(score["total"]["f1_50"], 1) << ending;
      EXPECT_EQ(score["total"]["edit"], 100) << ending;
      EXPECT_NEAR(score["total"]["frame_accuracy"], 1, rounding) << ending;
      EXPECT_NEAR(score["mean_of_events"]["collar_f"], 1, 1e-12) << ending;
    }
    EXPECT_EQ(same[1]["total"]["frame_accuracy"], 1) << ending;
    // Beside the grammar against a person's labels, which a map explains.
    std::vector<std::string> words = labels;
    words.insert(words.end(), {"--found", file});
    const json two = Score(words);
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(two[0]["grammar"], kGrammar);
    EXPECT_EQ(two[1]["grammar"], file);
    if (rounding == 0)
      EXPECT_EQ(Figures(two[0]), Figures(two[1])) << ending;
    else
      EXPECT_NEAR(two[0]["total"]["frame_accuracy"], two[1]["total"]["frame_accuracy"], rounding);
    EXPECT_EQ(two[0]["rows"][0]["hits_50"], two[1]["rows"][0]["hits_50"]);
    // A file of `watch` says when each event was decided; the others do not.
    EXPECT_EQ(two[1]["total"]["latency_s"] == two[0]["total"]["latency_s"],
              ending == std::string("jsonl"))
        << ending;
  }
}

TEST_F(Found, ALabelForEachFrame) {
  const std::string take = Take("milk.jsonl"), csv = Path("grasps.csv");
  ASSERT_EQ(Prehend({"episode", "resegment", take, "--event", "grasping", "-o", csv}).exit_code, 0);
  double begin_s = 0, end_s = 0;
  std::string label;
  std::istringstream row(ReadFile(csv).substr(ReadFile(csv).find('\n') + 1));
  char comma = 0;
  row >> begin_s >> comma >> end_s >> comma >> comma;
  std::getline(row, label, '"');
  ASSERT_EQ(Has(label, "grasping("), "");
  // As many lines as frames: line by line that of the frame.
  std::istringstream lines(ReadFile(take));
  std::string frames, line;
  double per_s = 0;
  while (std::getline(lines, line)) {
    const json one = json::parse(line);
    if (one.contains("ticks_per_second")) per_s = one["ticks_per_second"].get<double>();
    if (!one.contains("tick")) continue;
    const double at_s = one["tick"].get<double>() / per_s;
    frames += (at_s >= begin_s - 1e-4 && at_s < end_s - 1e-4 ? label : "background") + "\n";
  }
  const std::string by_frame = Write("milk.txt", frames);
  const json exact = Score({take, "--truth", csv, "--found", by_frame})[0]["total"];
  EXPECT_EQ(exact["f1_50"], 1);
  EXPECT_EQ(exact["frame_accuracy"], 1);
  // By the rate of the map: within half a frame.
  const double rate_hz = 25;
  std::string coarse;
  for (int i = 0; i < 25 * 5; ++i) {
    const double middle_s = (i + 0.5) / rate_hz;
    coarse += (middle_s >= begin_s && middle_s < end_s ? label : "") + "\n";
  }
  const std::string map = Write("map.yaml",
                                "rate_hz: 25\nlabels: {hold: {event: grasping, object: milk}}\n"
                                "tiers: {grasping of right_hand: {hand: right_hand}}\n");
  const json half =
      Score({take, "--truth", Write("hold.csv", Replaced(ReadFile(csv), label, "hold")), "--map",
             map, "--found", Write("coarse.txt", coarse)})[0]["total"];
  EXPECT_EQ(half["f1_50"], 1);
  EXPECT_LE(std::abs(half["begin_s"]["max"].get<double>()), 0.5 / rate_hz + 1e-3);
  EXPECT_LE(std::abs(half["end_s"]["max"].get<double>()), 0.5 / rate_hz + 1e-3);
  const Said wrong = Refused({take, "--truth", csv, "--found", Write("few.txt", "a\nb\n")});
  EXPECT_EQ(Has(wrong.err, "few.txt: error: it has 2 lines, and the recording "), "");
  EXPECT_EQ(Has(wrong.err, "rate_hz: 30"), "");
}

TEST_F(Found, SwappedSidesSwapWhatIsMissingAndTooMuch) {
  const std::string take = Take("milk.jsonl"),
                    one = Write("one.csv",
                                "begin_s,end_s,label\n0.1,1,\"reaching(right_hand, milk)\"\n"
                                "1.1,3.8,\"grasping(right_hand, milk)\"\n"),
                    two = Write("two.csv",
                                "begin_s,end_s,label\n1.2,3.9,\"grasping(right_hand, milk)\"\n"
                                "4,4.2,\"grasping(right_hand, milk)\"\n4.5,4.9,\"reaching("
                                "right_hand, milk)\"\n");
  const json there = Score({take, "--truth", one, "--found", two})[0]["total"],
             back = Score({take, "--truth", two, "--found", one})[0]["total"];
  for (const char* figure : {"f1_10", "f1_25", "f1_50", "collar_f"})
    EXPECT_EQ(there[figure], back[figure]) << figure;
  EXPECT_EQ(there["ward"]["deleted"], back["ward"]["inserted"]);
  EXPECT_EQ(there["ward"]["inserted"], back["ward"]["deleted"]);
  EXPECT_GT(there["ward"]["inserted"], there["ward"]["deleted"]);
}

TEST_F(Found, OneTableOfAllEpisodes) {
  const std::string one = Take("a.jsonl"), two = Take("b.jsonl"), truth = docs_ + "/labels.csv";
  const std::string head = "episode,begin_s,end_s,label,hand,object\n",
                    a = "a,1.1,3.8,grasping,right_hand,milk\n";
  const auto words = [&](const std::string& found) {
    return std::vector<std::string>{one,       two,
                                    "--truth", truth,
                                    "--truth", truth,
                                    "--map",   docs_ + "/labels.yaml",
                                    "--found", Write("all.csv", head + found)};
  };
  const json both = Score(words(a + "b,1.1,3.8,hold,right_hand,milk\n"))[0];
  EXPECT_EQ(both["episodes"], 2);
  EXPECT_EQ(both["total"]["found"], 2);
  EXPECT_EQ(both["rows"][1]["found"], 1) << "by the map a hold is a grasp";
  // A row with nothing but a name: nothing was found. No row: nobody looked.
  EXPECT_EQ(Score(words(a + "b,,,,,\n"))[0]["rows"][1]["found"], 0);
  EXPECT_EQ(Has(Refused(words(a)).err, "all.csv: error: no row has 'b' in the column 'episode'"),
            "");
}

TEST_F(Found, WhatIsNotThereIsNeverNothing) {
  const std::string take = Take("milk.jsonl"), truth = docs_ + "/labels.csv";
  const auto refused = [&](const std::string& found) {
    return Refused({take, "--truth", truth, "--map", docs_ + "/labels.yaml", "--found", found}).err;
  };
  fs::create_directories(folder_ / "none");
  EXPECT_EQ(Has(refused(Path("none")), "none has no events of 'milk': no milk with one of the "),
            "");
  EXPECT_EQ(Has(refused(Write("x/milk.jsonl", "")), "error: the file is empty"), "");
  EXPECT_EQ(Has(refused(take), "it is a line of a recording, and no event"), "");
  const auto line = [&](const std::string& text) { return Write("x/milk.jsonl", text + "\n"); };
  EXPECT_EQ(Has(refused(line("[1]")), "milk.jsonl:1:1: error: it is no JSON object"), "");
  EXPECT_EQ(Has(refused(line(R"({"event": "grasping", "begin_tick": 1})")), "a begin_tick and"),
            "");
  EXPECT_EQ(Has(refused(line(R"({"event": "grasping", "begin_tick": 1.5, "end_tick": 3})")),
                "begin_tick: found 1.5, wanted a whole number"),
            "");
  const std::string times = R"(, "begin_tick": 10, "end_tick": 30})";
  EXPECT_EQ(Has(refused(line(R"({"event": "grasping")" + times)),
                "'grasping' says no hand, and what is true does"),
            "");
  EXPECT_EQ(Has(refused(line(R"({"event": "grasping", "roles": {"hand": "right_hnd", "object": )"
                             R"("milk"})" +
                             times)),
                "did you mean 'right_hand'?"),
            "");
  EXPECT_EQ(Has(refused(line(R"({"event": "graspin")" + times)), "wanted an event of the grammar"),
            "");
  EXPECT_EQ(Has(refused(line(R"({"error": "no model"})")), "the recogniser failed: \"no model\""),
            "");
  EXPECT_EQ(Has(refused(line(R"({"recogniser": 2})")),
                "milk.jsonl:1:1: error: found version 2 of the protocol, wanted 1\n"
                "  {\"recogniser\": 2}\n  ^\n"
                "  hint: {\"recogniser\": 1, ..}\n"),
            "");
  // Nothing found, said by a first line alone.
  EXPECT_EQ(Score({take, "--truth", truth, "--map", docs_ + "/labels.yaml", "--found",
                   line(R"({"recogniser": 1})")})[0]["total"]["found"],
            0);
}

TEST_F(Found, InScenariosAgainstWhatHappened) {
  const std::string name = "pick_and_place/milk_carton_wrap";
  const Said run = Prehend({"run", name, "--record", Path("run.episodes")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ASSERT_EQ(Prehend({"episode", "resegment", Path("run.episodes"), "-o",
                     Path("found/milk_carton_wrap.csv")})
                .exit_code,
            0);
  const json two =
      Score({name, "--grammar", "pick_and_place", "--found", Path("found"), "--verbose"});
  ASSERT_EQ(two.size(), 2u);
  EXPECT_GT(two[0]["total"]["true"], 0);
  for (const char* figure : {"true", "found", "f1_50", "edit", "frame_accuracy", "ward"})
    EXPECT_EQ(two[0]["total"][figure], two[1]["total"][figure]) << figure;
  // Nothing is true and nothing found: what is found there is too much.
  const Said none = Prehend({"score", "grasp/closing_beside_the_carton_is_no_grasp", "--event",
                             "grasping", "--found",
                             Write("f/closing_beside_the_carton_is_no_grasp.csv",
                                   "begin_s,end_s,label\n0.1,0.2,\"grasping(right_hand, milk)\"\n"),
                             "--json"});
  ASSERT_EQ(none.exit_code, 0) << none.err;
  EXPECT_EQ(json::parse(none.out)["grammars"][0]["total"]["ward"]["inserted"], 1);
}

}  // namespace
}  // namespace prehend::house
