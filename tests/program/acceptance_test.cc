// SPDX-License-Identifier: Apache-2.0
// What users rely on, run as they run it: determinism, truthful timelines, grammars that are data.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

using Json = nlohmann::json;

Json RunJson(const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"run", "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Said said = Prehend(arguments);
  EXPECT_EQ(said.exit_code, 0) << said.err;
  return Json::parse(said.out, nullptr, false);
}

int Count(const Json& run, const std::string& event) {
  int count = 0;
  for (const Json& e : run["events"]) count += e["event"] == event;
  return count;
}

/// One of each kind; the whole library would be played for minutes.
std::vector<std::string> SmokeScenarios() {
  const Json list = Json::parse(Prehend({"list", "--json"}).out);
  std::vector<std::string> names;
  for (const Json& entry : list.at("scenarios")) {
    if (std::ranges::count(entry.at("tags"), Json("smoke"))) names.push_back(entry.at("scenario"));
  }
  return names;
}

TEST(Acceptance, ScenariosTwiceInBothOrdersAreTheSameRuns) {
  std::vector<std::string> names = SmokeScenarios();
  ASSERT_GE(names.size(), 6u);
  std::map<std::string, Json> first;
  for (const std::string& name : names) first[name] = RunJson({name});
  std::ranges::reverse(names);
  for (const std::string& name : names) {
    EXPECT_EQ(RunJson({name}), first[name]) << name;
  }
}

TEST(Acceptance, PicturesDoNotChangeARun) {
  const std::string name = "milk_carton_wrap";
  const auto folder = FreshFolder("pictures");
  const Json plain = RunJson({name});
  const Said drawn = Prehend({"render", name, "--json", "-o", (folder / "picture.png").string()});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_EQ(Json::parse(drawn.out).at("state_hash"), plain["state_hash"]);
  EXPECT_GT(std::filesystem::file_size(folder / "picture.png"), 10'000u);
  std::filesystem::remove_all(folder);
}

TEST(Acceptance, EightKilogramsAreNotLifted) {
  const Json light = RunJson({"milk_carton_wrap"});
  const Json heavy = RunJson({"milk_carton_wrap", "--set", "entities.milk.mass_kg=8"});
  EXPECT_EQ(Count(light, "picking_up"), 1);
  EXPECT_EQ(Count(light, "transporting"), 1);
  EXPECT_EQ(Count(light, "putting_down"), 1);
  EXPECT_EQ(Count(heavy, "grasping"), 1) << "it is grasped all the same";
  EXPECT_EQ(Count(heavy, "picking_up"), 0);
  EXPECT_EQ(Count(heavy, "transporting"), 0);
  EXPECT_EQ(Count(heavy, "putting_down"), 0);
  EXPECT_NE(light["state_hash"], heavy["state_hash"]);
}

TEST(Acceptance, ANumberInTheGrammarChangesTheOutcomeWithoutRebuilding) {
  const Json before = RunJson({"milk_carton_wrap"});
  const Json overridden = RunJson({"milk_carton_wrap", "--set", "lift_rise=40 cm"});
  EXPECT_EQ(Count(before, "picking_up"), 1);
  EXPECT_EQ(Count(overridden, "picking_up"), 0) << "it rises by less than 40 cm";
  EXPECT_EQ(before["state_hash"], overridden["state_hash"])
      << "the grammar must not reach the physics";
}

TEST(Acceptance, ARuleInTheGrammarFileChangesTheOutcome) {
  const auto folder = FreshFolder("grammar");
  WriteFile(folder / "mine.grammar", R"(grammar mine
use contact
event held_up(object: Movable)
  while not supported_by(object, any)
  lasting 200 ms
)");
  const Json run = RunJson({"milk_carton_wrap", "--grammar", (folder / "mine.grammar").string()});
  EXPECT_EQ(Count(run, "held_up"), 1);
  EXPECT_EQ(Count(run, "picking_up"), 0);
  EXPECT_EQ(run["grammar"], "mine");
  std::filesystem::remove_all(folder);
}

TEST(Acceptance, RunJsonKeepsItsContract) {
  const Json run = RunJson({"milk_carton_wrap"});
  EXPECT_EQ(run["scenario"], "milk_carton_wrap");
  EXPECT_EQ(run["status"], "completed");
  EXPECT_EQ(run["ticks_per_second"], 480);
  EXPECT_EQ(run["grammar"], "pick_and_place");
  EXPECT_TRUE(run["ticks"].is_number_integer());
  EXPECT_TRUE(run["state_hash"].is_string());
  ASSERT_FALSE(run["events"].empty());
  for (const Json& event : run["events"]) {
    EXPECT_TRUE(event["event"].is_string());
    EXPECT_TRUE(event["roles"].is_object());
    EXPECT_LT(event["begin_tick"], event["end_tick"]);
    EXPECT_GE(event["decided_tick"], event["begin_tick"]);
    EXPECT_NEAR(event["begin_s"].get<double>(), event["begin_tick"].get<double>() / 480, 1e-6);
    EXPECT_NEAR(event["end_s"].get<double>(), event["end_tick"].get<double>() / 480, 1e-6);
  }
}

TEST(Acceptance, CheckJsonKeepsItsContract) {
  const auto folder = FreshFolder("report");
  const Said said = Prehend(
      {"check", "--filter", "tag:smoke", "--json", "--no-pictures", "--report", folder.string()});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  const Json check = Json::parse(said.out);
  EXPECT_GE(check["passed"], 6);
  EXPECT_EQ(check["failed"], 0);
  EXPECT_EQ(check["pending"], 0);
  EXPECT_EQ(check["scenarios"].size(), check["passed"]);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace prehend::house
