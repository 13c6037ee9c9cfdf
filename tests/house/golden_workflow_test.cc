// SPDX-License-Identifier: Apache-2.0
// Differences as a person meets them: what differs, who is to blame, what waits for acceptance, and
// what acceptance keeps.
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

#include "tests/house/small_project.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class GoldenWorkflow : public SmallProject {
 protected:
  bool SaysIn(const Said& said, const std::string& pattern) const {
    return std::regex_search(said.out, std::regex(pattern));
  }
};

TEST_F(GoldenWorkflow, WhatIsPendingIsReviewedThenAccepted) {
  EXPECT_EQ(Do("review").out, "nothing is pending ('prehend check' finds out what should be)\n");
  EXPECT_EQ(Do("review").exit_code, 0);
  EXPECT_EQ(Do("check --no-pictures").exit_code, 5);
  const Said fresh = Do("review");
  EXPECT_EQ(fresh.exit_code, 5);
  EXPECT_TRUE(SaysIn(fresh, "new  rest/carton_rests\n    contact +0\\.0")) << fresh.out;
  EXPECT_TRUE(SaysIn(fresh,
                     "\n    if right: prehend accept rest/carton_rests --reviewed [0-9a-f]{8} "
                     "--reason \"...\"\n"));
  Accept();
  EXPECT_EQ(Do("review").exit_code, 0);

  WriteFile(Golden(), ReadFile(Golden()) + "sliding 0.1 0.2 hand=right_hand object=carton\n");
  EXPECT_EQ(Do("check --no-pictures").exit_code, 1);
  const Said changed = Do("review carton_rests");
  EXPECT_TRUE(
      SaysIn(changed, "changed  rest/carton_rests\n    missing sliding\\(right_hand, carton\\)\n"))
      << changed.out;
  EXPECT_EQ(Do("review no_such").exit_code, 4);
  const Json json = Json::parse(Do("review --json").out);
  EXPECT_EQ(json["pending"][0]["kind"], "changed");

  fs::remove(Scenario());
  const Said orphans = Do("review");
  EXPECT_TRUE(
      SaysIn(orphans, "orphan  rest/carton_rests\n    pending, but there is no such scenario"))
      << orphans.out;
  EXPECT_TRUE(SaysIn(orphans, "a golden, but there is no such scenario")) << orphans.out;
}

TEST_F(GoldenWorkflow, TheGrammarIsToBlameWhenNothingMovesOtherwise) {
  Accept();
  ASSERT_EQ(Do("check --no-pictures").exit_code, 0);
  const fs::path grammar = root_ / "grammar/library/pick_and_place.grammar";
  WriteFile(grammar, ReadFile(grammar) +
                         "\nevent resting(object: Movable)\n  while supported_by(object, any)\n");
  const Said said = Do("check --no-pictures");
  EXPECT_EQ(said.exit_code, 1) << said.out << said.err;
  EXPECT_TRUE(
      SaysIn(said,
             "blame: the grammar or the golden: everything moves as when this last agreed "
             "with its golden; changed since then: grammar/library/pick_and_place.grammar\n"))
      << said.out;
}

TEST_F(GoldenWorkflow, ThePhysicsIsToBlameFromTheTickItParts) {
  Accept();
  ASSERT_EQ(Do("check --no-pictures").exit_code, 0);
  WriteFile(Scenario(), Replaced(kCartonRests, "mass_kg: 0.3, on: table, at_m: [0.15, 0.15]",
                                 "mass_kg: 0.3, at_m: [0.15, 0.15, 0.9]"));
  const Said said = Do("check --no-pictures");
  EXPECT_EQ(said.exit_code, 1) << said.out << said.err;
  EXPECT_TRUE(SaysIn(said,
                     "blame: physics: since 0\\.00\\d+ s \\(tick \\d\\) carton does not move as "
                     "when this last agreed with its golden; changed since then: "
                     "scenarios/rest/carton_rests.yaml\n"))
      << said.out;
  EXPECT_TRUE(SaysIn(said, "\n      facts at [0-9.]+ s \\(tick \\d+\\):\n")) << said.out;
}

TEST_F(GoldenWorkflow, WhatWasAcceptedIsWhatTheNextBlameComparesWith) {
  Accept();
  ASSERT_EQ(Do("check --no-pictures").exit_code, 0);
  WriteFile(Scenario(), Replaced(kCartonRests, "mass_kg: 0.3, on: table, at_m: [0.15, 0.15]",
                                 "mass_kg: 0.3, at_m: [0.15, 0.15, 0.9]"));
  Accept();
  WriteFile(Golden(), ReadFile(Golden()) + "sliding 0.1 0.2 hand=right_hand object=carton\n");
  EXPECT_TRUE(SaysIn(Do("check --no-pictures"),
                     "blame: the grammar or the golden: everything moves as when this last agreed "
                     "with its golden; "
                     "changed since then: golden/rest/carton_rests.timeline\n"));
  EXPECT_TRUE(
      SaysIn(Do("check --no-pictures --grammar original_2020"),
             "changed since then: golden/rest/carton_rests.timeline, --grammar original_2020\n"));
}

TEST_F(GoldenWorkflow, WhatWasAcceptedIsStillChecked) {
  Accept();
  EXPECT_TRUE(SaysIn(Do("check --changed --no-pictures"), "passed  rest/carton_rests"));
  EXPECT_TRUE(SaysIn(Do("check --changed --no-pictures"), "1 unchanged"));
}

TEST_F(GoldenWorkflow, WithoutARunThatAgreedTheBlameIsUnknown) {
  Accept();
  fs::remove_all(root_ / "build/check");
  WriteFile(Golden(), ReadFile(Golden()) + "sliding 0.1 0.2 hand=right_hand object=carton\n");
  EXPECT_TRUE(SaysIn(Do("check --no-pictures"),
                     "blame: unknown, this scenario has not agreed with its golden"));
}

TEST_F(GoldenWorkflow, OnlyWhatWasShownIsAccepted) {
  EXPECT_EQ(Do("check --no-pictures").exit_code, 5);
  const std::string shown = Json::parse(Do("review --json").out)["pending"][0]["fingerprint"];
  WriteFile(Scenario(), Replaced(kCartonRests, "wait_s: 0.2", "wait_s: 0.3"));
  for (const std::string& how : {std::string(), " --reviewed " + shown}) {
    const Said refused = Do("accept carton_rests --reason seen" + how);
    EXPECT_EQ(refused.exit_code, 1) << refused.err;
    EXPECT_NE(refused.err.find("was " + shown + ", but the scenario yields something else now"),
              std::string::npos)
        << refused.err;
    EXPECT_TRUE(SaysIn(refused, "new golden:\n")) << "it shows what: " << refused.out;
    EXPECT_FALSE(fs::exists(Golden()));
  }
  const std::string now = Json::parse(Do("review --json").out)["pending"][0]["fingerprint"];
  EXPECT_EQ(Do("accept carton_rests --reason seen --reviewed " + now).exit_code, 0);
}

TEST_F(GoldenWorkflow, PicturesHaveAGateOfTheirOwn) {
  WriteFile(Scenario(), std::string(kCartonRests) + "pictures: [{at: 0.1}]\n");
  EXPECT_EQ(Do("accept carton_rests --pictures --reason too_early").exit_code, 5)
      << "events come first";
  EXPECT_EQ(Do("accept carton_rests --pictures --derived x --reason y").exit_code, 2);
  Accept();
  const Said accepted = Do("accept carton_rests --pictures --reason a_carton_is_seen");
  const fs::path golden = root_ / "golden/rest/carton_rests.png";
  if (accepted.err.find("no render room") != std::string::npos) GTEST_SKIP() << "a build without OSMesa draws nothing: " << accepted.err;
  ASSERT_EQ(accepted.exit_code, 0) << accepted.err;
  ASSERT_TRUE(fs::exists(golden));
  EXPECT_EQ(Do("check").exit_code, 0);
  const std::string timeline = ReadFile(Golden());
  EXPECT_TRUE(Do("accept carton_rests --pictures --reason again").out.starts_with("nothing to"));
  EXPECT_EQ(ReadFile(Golden()), timeline) << "accepting twice is accepting once";

  WriteFile(Scenario(), Replaced(kCartonRests, "wait_s: 0.2", "wait_s: 0.3") +
                            "pictures: [{at: 0.1, camera: top}]\n");
  const Said differs = Do("check");
  EXPECT_EQ(differs.exit_code, 1) << differs.out;
  EXPECT_TRUE(
      SaysIn(differs, "picture .*carton_rests.png: .* % of its pixels differ, at most 1 % may\n"))
      << differs.out;
  EXPECT_EQ(Do("accept carton_rests --pictures --reason from_above").exit_code, 0);
  const std::string with_reason = ReadFile(Golden());
  EXPECT_NE(with_reason.find("# pictures: "), std::string::npos);
  EXPECT_NE(with_reason.find("\"from_above\""), std::string::npos);
  EXPECT_EQ(with_reason.find("accepted=2"), std::string::npos) << "no event was accepted";
  EXPECT_EQ(Do("check").exit_code, 1) << "the events still differ";
}

TEST_F(GoldenWorkflow, WatchingReadsAgainWhatASaveAffects) {
  WriteVariant("rest/b", "wait_s: 0.2", "wait_s: 0.1");
  const fs::path out = root_ / "watched.txt";
  const std::string command = "cd '" + root_.string() + "' && PREHEND_HOME='" + root_.string() +
                              "' timeout 8 '" PREHEND_BINARY_DIR "/prehend' validate --watch >'" +
                              out.string() + "' 2>&1";
  std::thread watcher([&] { (void)!std::system(command.c_str()); });
  const auto wait_for = [&](const std::string& text) {
    for (int i = 0; i < 70 && ReadFile(out).find(text) == std::string::npos; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return ReadFile(out);
  };
  const std::string first = wait_for("carton_rests.yaml\n");
  WriteFile(Scenario(), Replaced(kCartonRests, "mass_kg: 0.3", "mass: 0.3"));
  const std::string said = wait_for("did you mean 'mass_kg'?").substr(first.size());
  watcher.join();
  EXPECT_NE(first.find("ok: "), std::string::npos) << first;
  EXPECT_NE(said.find("wrong: "), std::string::npos) << said;
  EXPECT_NE(said.find("unknown key 'mass'"), std::string::npos) << said;
  EXPECT_EQ(said.find("rest/b.yaml"), std::string::npos) << "it is not affected: " << said;
}

}  // namespace
}  // namespace prehend::house
