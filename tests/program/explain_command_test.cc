// SPDX-License-Identifier: Apache-2.0
// prehend explain, as a person or a script uses it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

TEST(ExplainCommand, AScenarioAndItsRecordingAreExplainedAlike) {
  const auto file = (FreshFolder("explain") / "milk.jsonl").string();
  ASSERT_EQ(Prehend({"run", "milk_carton_wrap", "--record", file}).exit_code, 0);
  const Said played = Prehend({"explain", "milk_carton_wrap"});
  const Said recorded = Prehend({"explain", file});
  EXPECT_EQ(played.exit_code, 0) << played.err;
  EXPECT_EQ(played.out, recorded.out);
  EXPECT_NE(played.out.find("reaching(right_hand, milk)"), std::string::npos) << played.out;

  const Said one = Prehend({"explain", file, "--event", "contact milk right_hand", "--json"});
  ASSERT_EQ(one.exit_code, 0) << one.err;
  const auto json = nlohmann::json::parse(one.out);
  EXPECT_EQ(json["episode"], "milk_carton_wrap");
  ASSERT_EQ(json["events"].size(), 1);
  EXPECT_FALSE(json["events"][0]["began"].empty());
  EXPECT_FALSE(json["events"][0]["waited"].empty());

  const Said changed =
      Prehend({"explain", file, "--set", "lift_rise=40cm", "--expected", "picking_up", "--json"});
  ASSERT_EQ(changed.exit_code, 0) << changed.err;
  const auto missing = nlohmann::json::parse(changed.out)["missing"];
  EXPECT_EQ(missing["happened"], false);
  EXPECT_TRUE(
      missing["because"].get<std::string>().starts_with("requires rise(milk) >= lift_rise: is "))
      << missing;
  const auto& decisive = missing["decisive"];
  const double instead = decisive["instead"], limit = decisive["limit"];
  EXPECT_NEAR(decisive["share"].get<double>(), 1 - instead / limit, 1e-12) << decisive;
}

TEST(ExplainCommand, WhatIsExpectedAndThereIsExplained) {
  const Said said = Prehend({"explain", "milk_carton_wrap", "--expected", "grasping@2s"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_TRUE(said.out.starts_with("it happened:\ngrasping(right_hand, milk)  ")) << said.out;
}

TEST(ExplainCommand, AnEventAtTheWrongMomentEndsWithExitCodeFourAndTheNearestOnes) {
  const Said said = Prehend({"explain", "milk_carton_wrap", "--event", "transporting@0.1s"});
  EXPECT_EQ(said.exit_code, 4);
  EXPECT_EQ(said.out, "");
  EXPECT_TRUE(
      said.err.starts_with("prehend: --event: there is no 'transporting@0.1s'; the nearest:\n"
                           "  transporting(right_hand, milk)  "))
      << said.err;
  EXPECT_NE(
      said.err.find("why not: prehend explain milk_carton_wrap --expected transporting@0.1s\n"),
      std::string::npos)
      << said.err;
}

TEST(ExplainCommand, AMomentAfterTheEndIsToldApart) {
  const std::string warning =
      "prehend: warning: 99 s is after the end; this is the end of the episode\n";
  const Said missing = Prehend({"explain", "milk_carton_wrap", "--expected", "sliding@99s"});
  EXPECT_EQ(missing.exit_code, 0);
  EXPECT_EQ(missing.err, warning);
  const Said event = Prehend({"explain", "milk_carton_wrap", "--event", "grasping @99 s"});
  EXPECT_EQ(event.exit_code, 4);
  EXPECT_TRUE(event.err.starts_with(warning)) << event.err;
  EXPECT_EQ(Prehend({"explain", "milk_carton_wrap", "--expected", "sliding@1s"}).err, "");
}

TEST(ExplainCommand, WhyNotIsAskedOfTheSameGrammarAndSettings) {
  const Said said = Prehend({"explain", "milk_carton_wrap", "--grammar", "original_2020", "--set",
                             "entities.milk.mass_kg=0.9", "--event", "transporting@0.1s"});
  EXPECT_EQ(said.exit_code, 4);
  EXPECT_NE(said.err.find("why not: prehend explain milk_carton_wrap --grammar original_2020 --set "
                          "entities.milk.mass_kg=0.9 --expected transporting@0.1s\n"),
            std::string::npos)
      << said.err;
}

// What is said to be enough is enough: the hand is 240 mm away when it has to be nearer.
TEST(ExplainCommand, TheNumberThatWouldHaveMadeItDoes) {
  const auto folder = FreshFolder("explain_command");
  const std::string file = (folder / "f.jsonl").string(), rules = (folder / "g.grammar").string();
  WriteFile(rules,
            "grammar g\nparam lim = 20 cm\n"
            "event near(h: Hand, a: A) while distance(h, a) < lim lasting 0.6 s\n");
  std::string text =
      R"({"recording": 1, "episode": "e", "ticks_per_second": 10, "entities": {"h": {"hand": true, )"
      R"("size_m": [0.02, 0.02, 0.02]}, "a": {"class": "A", "size_m": [0.02, 0.02, 0.02]}}})"
      "\n";
  for (int tick = 0; tick < 11; ++tick)
    text += "{\"tick\": " + std::to_string(tick) +
            R"(, "samples": {"a": {"at_m": [0, 0, 0]}, "h": )" + R"({"at_m": [)" +
            (tick < 5    ? "0.5"
             : tick == 5 ? "0.24"
                         : "0.1") +
            ", 0, 0]}}}\n";
  WriteFile(file, text + "{\"end_tick\": 11}\n");
  const auto why = [&](const std::string& set) {
    return Prehend({"explain", file, "--grammar", rules, "--set", set, "--expected", "near@0.6s"});
  };
  const Said said = why("lim=20cm");
  EXPECT_NE(said.out.find("\n    with 241 mm instead of 200 mm it would have happened\n"),
            std::string::npos)
      << said.out;
  EXPECT_NE(why("lim=240mm").out.find("did not happen"), std::string::npos);
  EXPECT_EQ(why("lim=241mm").out.find("did not happen"), std::string::npos);
}

TEST(ExplainCommand, BadQuestionsEndWithExitCodeTwo) {
  const std::vector<std::vector<std::string>> slips = {
      {"milk_carton_wrap", "--event", "reching@1s"},
      {"milk_carton_wrap", "--expected", "sliding right_hand mlik"},
      {"milk_carton_wrap", "--event", "reaching@soon"},
      {"milk_carton_wrap", "--event", "reaching", "--expected", "sliding"},
      {"milk_carton_wrap", "--grammar", "no_such_thing"},
      {"no_such_recording.jsonl"},
      {"milk_carton_wrap", "--evnt", "reaching"}};
  for (const std::vector<std::string>& slip : slips) {
    std::vector<std::string> arguments = {"explain"};
    arguments.insert(arguments.end(), slip.begin(), slip.end());
    const Said said = Prehend(arguments);
    EXPECT_EQ(said.exit_code, 2) << said.err;
    EXPECT_EQ(said.out, "");
  }
  EXPECT_EQ(Prehend({"explain", "milk_carton_warp"}).exit_code, 4);
}

TEST(TracksCommand, WritesAWholeFileOrNothing) {
  const auto folder = FreshFolder("tracks");
  const auto csv = folder / "milk.csv";
  const Said said = Prehend({"grammar", "tracks", "milk_carton_wrap", "-o", csv.string()});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  const std::string text = ReadFile(csv);
  EXPECT_TRUE(text.starts_with("time_s,tick,\"touching(")) << text.substr(0, 200);
  EXPECT_NE(text.find("\"speed_along(milk, table) [m/s]\""), std::string::npos);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1)
      << "something was left behind";

  const Said some =
      Prehend({"grammar", "tracks", "milk_carton_wrap", "--only", "grasping", "--json"});
  ASSERT_EQ(some.exit_code, 0) << some.err;
  EXPECT_EQ(nlohmann::json::parse(some.out)["tracks"][0]["name"], "grasping(right_hand, milk)");
  EXPECT_EQ(
      Prehend({"grammar", "tracks", "milk_carton_wrap", "--only", "grasping", "--json", "-o", "-"})
          .out,
      some.out);

  for (const std::vector<std::string>& slip :
       std::vector<std::vector<std::string>>{{"-o", "/dev/null/milk.csv"},
                                             {"-o", folder.string() + "/milk.txt"},
                                             {"-o", "/dev/stdout"},
                                             {"--only", "graping"},
                                             {"-o", "/x.csv", "--json"}}) {
    std::vector<std::string> arguments = {"grammar", "tracks", "milk_carton_wrap"};
    arguments.insert(arguments.end(), slip.begin(), slip.end());
    const Said bad = Prehend(arguments);
    EXPECT_EQ(bad.exit_code, 2) << bad.err;
    EXPECT_EQ(bad.out, "");
  }
}

}  // namespace
}  // namespace prehend::house
