// SPDX-License-Identifier: Apache-2.0
// Differences as a person meets them: what differs and why, what waits for acceptance, and what
// acceptance keeps.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

#include "tests/program/small_project.h"

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
  EXPECT_EQ(Do("review").out,
            "nothing is pending ('prehend check' finds what differs from its golden)\n");
  EXPECT_EQ(Do("review").exit_code, 0);
  EXPECT_EQ(Do("check --no-pictures").exit_code, 5);
  const Said fresh = Do("review");
  EXPECT_EQ(fresh.exit_code, 5);
  EXPECT_TRUE(SaysIn(fresh, "new  rest/carton_rests\n    contact +0\\.0")) << fresh.out;
  EXPECT_TRUE(SaysIn(fresh,
                     "\n    if right: prehend accept rest/carton_rests --reviewed [0-9a-f]{16} "
                     "--reason \"...\"\n"));
  Accept();
  EXPECT_EQ(Do("review").exit_code, 0);
  const Said stale = Do("accept carton_rests --reviewed 0123456789abcdef --reason seen");
  EXPECT_EQ(stale.exit_code, 0);
  EXPECT_NE(stale.err.find("--reviewed 0123456789abcdef is not what the scenario yields now, which "
                           "agrees with its golden\n"),
            std::string::npos)
      << stale.err;

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
  EXPECT_TRUE(
      SaysIn(Do("review carton_rests"), "orphan  rest/carton_rests\n .* belongs to no scenario"));
  const Said some = Do("check --no-pictures rest/carton_rests");
  EXPECT_EQ(some.exit_code, 1) << some.out << some.err;
  EXPECT_TRUE(SaysIn(some, "failed  rest/carton_rests  a golden without scenario\n")) << some.out;
  const Said orphans = Do("review");
  EXPECT_TRUE(SaysIn(
      orphans, "orphan  rest/carton_rests\n    the scenario of this pending golden does not exist"))
      << orphans.out;
  EXPECT_TRUE(SaysIn(orphans, "carton_rests.timeline belongs to no scenario: remove it"))
      << orphans.out;
}

TEST_F(GoldenWorkflow, TheGrammarIsTheCauseWhenEverythingMovesAsBefore) {
  Accept();
  ASSERT_EQ(Do("check --no-pictures").exit_code, 0);
  const fs::path grammar = root_ / "grammar/library/pick_and_place.grammar";
  WriteFile(grammar, ReadFile(grammar) +
                         "\nevent resting(object: Movable)\n  while supported_by(object, any)\n");
  const Said said = Do("check --no-pictures");
  EXPECT_EQ(said.exit_code, 1) << said.out << said.err;
  EXPECT_TRUE(
      SaysIn(said,
             "cause: the grammar or the golden\\. Everything moves as in the last passing run\\. "
             "Changed since: grammar/library/pick_and_place.grammar\n"))
      << said.out;
}

TEST_F(GoldenWorkflow, ThePhysicsIsTheCauseFromTheTickOfDivergence) {
  Accept();
  ASSERT_EQ(Do("check --no-pictures").exit_code, 0);
  WriteFile(Scenario(), Replaced(kCartonRests, "mass_kg: 0.3, on: table, at_m: [0.15, 0.15]",
                                 "mass_kg: 0.3, at_m: [0.15, 0.15, 0.9]"));
  const Said said = Do("check --no-pictures");
  EXPECT_EQ(said.exit_code, 1) << said.out << said.err;
  EXPECT_TRUE(SaysIn(said,
                     "cause: physics\\. `carton` moves differently from the last passing run, "
                     "first at 0\\.00\\d+ s \\(tick \\d\\)\\. Changed since: "
                     "scenarios/rest/carton_rests.yaml\n"))
      << said.out;
  EXPECT_TRUE(SaysIn(said, "\n      facts at [0-9.]+ s \\(tick \\d+\\):\n")) << said.out;
}

TEST_F(GoldenWorkflow, TheCauseIsFoundAgainstWhatWasAccepted) {
  Accept();
  ASSERT_EQ(Do("check --no-pictures").exit_code, 0);
  WriteFile(Scenario(), Replaced(kCartonRests, "mass_kg: 0.3, on: table, at_m: [0.15, 0.15]",
                                 "mass_kg: 0.3, at_m: [0.15, 0.15, 0.9]"));
  Accept();
  WriteFile(Golden(), ReadFile(Golden()) + "sliding 0.1 0.2 hand=right_hand object=carton\n");
  EXPECT_TRUE(SaysIn(Do("check --no-pictures"),
                     "cause: the grammar or the golden\\. Everything moves as in the last passing "
                     "run\\. Changed since: golden/rest/carton_rests.timeline\n"));
  EXPECT_TRUE(
      SaysIn(Do("check --no-pictures --grammar original_2020"),
             "Changed since: golden/rest/carton_rests.timeline, --grammar original_2020\n"));
}

TEST_F(GoldenWorkflow, WhatWasAcceptedIsStillChecked) {
  Accept();
  EXPECT_TRUE(SaysIn(Do("check --changed --no-pictures"), "passed  rest/carton_rests"));
  EXPECT_TRUE(SaysIn(Do("check --changed --no-pictures"), "1 unchanged"));
}

TEST_F(GoldenWorkflow, WithoutARunThatPassedTheCauseIsUnknown) {
  Accept();
  fs::remove_all(root_ / "build/check");
  WriteFile(Golden(), ReadFile(Golden()) + "sliding 0.1 0.2 hand=right_hand object=carton\n");
  EXPECT_TRUE(SaysIn(Do("check --no-pictures"),
                     "cause: unknown\\. This scenario has not passed here yet\\. "
                     "This program: [A-Za-z]+ [0-9.]+, [a-z0-9_]+, -.+\\.\n"));
}

TEST_F(GoldenWorkflow, AnotherBuildIsNamedAsAPossibleCause) {
  Accept();
  const fs::path record = root_ / "build/check/rest/carton_rests.json";
  std::string text = ReadFile(record);
  const std::size_t program = text.find("\"program\":"), build = text.find("\"build\":");
  ASSERT_NE(program, std::string::npos) << text;
  ASSERT_NE(build, std::string::npos) << text;
  const auto replace_value = [&](const std::string& key, const std::string& value) {
    const std::size_t begin = text.find('"', text.find("\"" + key + "\":") + key.size() + 3) + 1;
    text.replace(begin, text.find('"', begin) - begin, value);
  };
  replace_value("program", "0000000000000000");
  replace_value("build", "Clang 14.0.6, aarch64, -O3");
  WriteFile(record, text);
  WriteFile(Golden(), ReadFile(Golden()) + "sliding 0.1 0.2 hand=right_hand object=carton\n");
  EXPECT_TRUE(SaysIn(Do("check --no-pictures"),
                     "the program \\(now [A-Za-z]+ [0-9.]+, [a-z0-9_]+, -.+; "
                     "then Clang 14\\.0\\.6, aarch64, -O3\\)"));
}

TEST_F(GoldenWorkflow, OnlyWhatWasShownIsAccepted) {
  EXPECT_EQ(Do("check --no-pictures").exit_code, 5);
  const std::string shown = Json::parse(Do("review --json").out)["pending"][0]["fingerprint"];
  WriteFile(Scenario(), Replaced(kCartonRests, "wait_s: 0.2", "wait_s: 0.3"));
  const std::string by_fingerprint = " --reviewed " + shown;
  for (const auto& [how, why] :
       {std::pair(std::string(), "is " + shown + ", but the scenario now yields"),
        std::pair(by_fingerprint, ", not " + shown)}) {
    const Said refused = Do("accept carton_rests --reason seen" + how);
    EXPECT_EQ(refused.exit_code, 1) << refused.err;
    EXPECT_NE(refused.err.find(why), std::string::npos) << refused.err;
    EXPECT_TRUE(SaysIn(refused, "new golden:\n")) << "it shows what: " << refused.out;
    EXPECT_FALSE(fs::exists(Golden()));
  }
  const std::string now = Json::parse(Do("review --json").out)["pending"][0]["fingerprint"];
  for (const std::string typed : {"ABCDEF0123456789", "3fa90c11"}) {
    const Said no_fingerprint = Do("accept carton_rests --reason seen --reviewed " + typed);
    EXPECT_EQ(no_fingerprint.exit_code, 2);
    EXPECT_EQ(no_fingerprint.err,
              "prehend: --reviewed: found '" + typed +
                  "', wanted the 16 digits from 0-9 and a-f that 'prehend review' prints, like "
                  "3fa90c11d27e5b60\n  see: prehend accept --help\n");
  }
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
  if (accepted.err.find("cannot draw pictures") != std::string::npos)
    GTEST_SKIP() << "a build without OSMesa draws nothing: " << accepted.err;
  ASSERT_EQ(accepted.exit_code, 0) << accepted.err;
  ASSERT_TRUE(fs::exists(golden));
  EXPECT_NE(ReadFile(root_ / "golden/rest/carton_rests.things").find("\nlabel:carton "),
            std::string::npos);
  EXPECT_EQ(Do("check").exit_code, 0);
  const std::string timeline = ReadFile(Golden());
  EXPECT_TRUE(Do("accept carton_rests --pictures --reason again").out.starts_with("nothing to"));
  EXPECT_EQ(ReadFile(Golden()), timeline) << "accepting twice is accepting once";

  WriteFile(Scenario(), Replaced(kCartonRests, "wait_s: 0.2", "wait_s: 0.3") +
                            "pictures: [{at: 0.1, camera: top}]\n");
  const Said differs = Do("check");
  EXPECT_EQ(differs.exit_code, 1) << differs.out;
  EXPECT_TRUE(SaysIn(differs,
                     "picture .*carton_rests.png:\n(  .*\n)* +thing `carton` is elsewhere, .*\n"
                     "(  .*\n)* +[0-9]+ of its pixels differ .*, at most 20 may; .*\n"
                     " +expected .*golden/rest/carton_rests.png\n"))
      << differs.out;
  EXPECT_TRUE(SaysIn(differs, "  accept it with: prehend accept rest/carton_rests --pictures "));
  EXPECT_FALSE(SaysIn(Do("check --set settle_s=0.2"), "accept it"))
      << "what is tried is not accepted";
  const Said reviewed = Do("review");
  EXPECT_TRUE(
      SaysIn(reviewed,
             "picture  rest/carton_rests\n    golden      .*/golden/rest/carton_rests.png\n"
             "    new         .*/build/pending/rest/carton_rests.png\n"
             "    difference  .*/build/pending/rest/carton_rests.difference.png\n"
             "    if right: prehend accept rest/carton_rests --pictures --reason \"...\"\n"))
      << reviewed.out;
  EXPECT_TRUE(fs::exists(root_ / "build/pending/rest/carton_rests.difference.png"));
  EXPECT_EQ(Do("accept carton_rests --pictures --reason from_above").exit_code, 0);
  const std::string with_reason = ReadFile(Golden());
  EXPECT_NE(with_reason.find("# pictures: "), std::string::npos);
  EXPECT_NE(with_reason.find("\"from_above\""), std::string::npos);
  EXPECT_EQ(with_reason.find("accepted=2"), std::string::npos) << "no event was accepted";
  EXPECT_FALSE(SaysIn(Do("review"), "picture"));
  EXPECT_EQ(Do("check").exit_code, 1) << "the events still differ";
}

TEST_F(GoldenWorkflow, PicturesThatBelongToNothingAreTold) {
  Accept();
  EXPECT_EQ(Do("check --no-pictures").exit_code, 0);
  WriteFile(root_ / "golden/rest/carton_rests.png", "");
  EXPECT_EQ(Do("check --changed --no-pictures").exit_code, 1) << "what appears is a change";
  const std::string unrequested =
      "golden/rest/carton_rests.png belongs to no picture: the scenario asks for none\n";
  for (const char* command :
       {"check carton_rests --no-pictures", "review carton_rests", "validate carton_rests"}) {
    const Said said = Do(command);
    EXPECT_NE((said.out + said.err).find(unrequested), std::string::npos)
        << command << ": " << said.out << said.err;
  }
  EXPECT_EQ(Do("check carton_rests --no-pictures").exit_code, 1);
  fs::rename(root_ / "golden/rest/carton_rests.png", root_ / "golden/rest/gone-2.png");
  for (const char* command : {"check --no-pictures", "review", "validate"}) {
    const Said said = Do(command);
    const std::regex told(
        "golden/rest/gone-2.png(: error:)? belongs to no scenario(: |\n  hint: )remove it, or "
        "bring "
        "scenarios/rest/gone.yaml back");
    EXPECT_TRUE(std::regex_search(said.out + said.err, told))
        << command << ": " << said.out << said.err;
    EXPECT_NE(said.exit_code, 0) << command;
  }
}

TEST_F(GoldenWorkflow, WhatAGoldenNamesMustExist) {
  Accept();
  const std::string golden = ReadFile(Golden());
  const auto says = [&](const std::string& from, const std::string& to,
                        const std::string& complaint) {
    WriteFile(Golden(), Replaced(golden, from, to));
    for (const std::string& what : {std::string("carton_rests"), Golden().string()}) {
      const Said said = Do("validate " + what);
      EXPECT_EQ(said.exit_code, 2) << to;
      EXPECT_NE(said.err.find(complaint), std::string::npos) << said.err;
    }
    const Said checked = Do("check --no-pictures");  // also says how the events differ, if they do
    EXPECT_EQ(checked.exit_code, to.starts_with("#") ? 2 : 1) << to << checked.out;
    EXPECT_NE((checked.out + checked.err).find(complaint), std::string::npos)
        << checked.out << checked.err;
  };
  const std::string file = Golden().string();
  says("contact  ", "contakt  ", file + ":8:1: error: the grammar has no event 'contakt'\n");
  says("support=table", "suport=table",
       file + ":9:47: error: 'supported_by' has no role 'suport'\n");
  says("a=carton", "a=karton", file + ":8:32: error: the scenario has no 'karton'\n");
  says("object=carton  support=table", "object=table  support=carton",
       "error: 'table' is never 'object' of 'supported_by', which takes a Movable\n");
  says("a=carton       b=table", "a=table b=carton",
       file + ":8:32: error: the two of 'contact' stand in the order of the alphabet\n");
  says("b=table", "style=wrap", "error: 'contact' has no style\n");
  says("b=table", "", file + ":8:1: error: 'contact' has a role 'b', which is missing here\n");
  says("# grammar: pick_and_place", "# grammar: contact",
       file +
           ":2:12: error: this golden is of the grammar 'contact', but the scenario uses "
           "'pick_and_place'\n");
  says(
      "# scenario: rest/carton_rests", "# scenario: rest/carton",
      file + ":1:13: error: this golden says it is of 'rest/carton', not of 'rest/carton_rests'\n");
  const fs::path elsewhere = root_ / "elsewhere.timeline";
  WriteFile(elsewhere, Replaced(golden, "rest/carton_rests", "rest/carton_rest"));
  EXPECT_NE(Do("validate " + elsewhere.string())
                .err.find(":1:13: error: there is no scenario 'rest/carton_rest'\n"),
            std::string::npos);
  WriteFile(elsewhere, golden);
  EXPECT_EQ(Do("validate " + elsewhere.string()).exit_code, 0);
}

TEST_F(GoldenWorkflow, WhatMovedWithinTheToleranceIsNotWrittenUnseen) {
  Accept();
  const std::string by_hand = "contact 0.0042 0.3 a=carton b=table open_end\n";  // a tick early
  std::string golden =
      std::regex_replace(ReadFile(Golden()), std::regex("contact +0.*\n"), by_hand);
  WriteFile(Golden(), golden + "sliding 0.1 0.2 hand=right_hand object=carton\n");
  EXPECT_EQ(Do("check --no-pictures").exit_code, 1);
  EXPECT_EQ(Do("accept carton_rests --reason it_does_not_slide").exit_code, 0);
  const std::string table = "# event";
  EXPECT_EQ(ReadFile(Golden()).substr(ReadFile(Golden()).find(table)),
            golden.substr(golden.find(table)));
  const Said again = Do("accept carton_rests --reason again");
  EXPECT_TRUE(SaysIn(again, "nothing to accept: .*; margin: 6.2 of 8.3 ms left at end of contact"))
      << again.out;
  const Said exact = Do("accept carton_rests --exact --reason it_rests_a_tick_longer");
  EXPECT_TRUE(SaysIn(exact,
                     "moved contact\\(carton, table\\): begin \\+0.0 ms, end \\+2.1 ms, within "
                     "the tolerance\n"))
      << exact.out;
  EXPECT_TRUE(std::regex_search(ReadFile(Golden()),
                                std::regex("contact +0\\.0042 +0\\.3021 .*accepted=3")));
  const Said once_more = Do("accept carton_rests --exact --reason again");
  EXPECT_TRUE(SaysIn(once_more, "nothing to accept: ")) << once_more.out;
}

TEST_F(GoldenWorkflow, WhatDiffersFromTheGroundTruthIsShownAndCounted) {
  WriteFile(root_ / "grammar/library/slow.grammar",
            "grammar slow\nsymmetric event contact(a: Entity, b: Entity)\n  while touching(a, b)\n "
            " lasting 10 s\n");
  WriteFile(Scenario(), std::string(kCartonRests) + "grammar: slow\n");
  const std::string truth =
      "ground truth: contact\\(carton, table\\) 0\\.0042\\.\\.0\\.3021 s, not recognised\n";
  const std::string line =
      "oracle: 0 of 0 events follow from the definitions of docs/events.md; 1 that follow are not "
      "recognised\n";
  const Said pending = Do("check --no-pictures");
  EXPECT_EQ(pending.exit_code, 5);
  EXPECT_TRUE(SaysIn(pending, truth)) << pending.out;
  EXPECT_TRUE(SaysIn(Do("review"), "new  rest/carton_rests\n    " + line + "    if right: "));
  const Said accepted = Do("accept carton_rests --reason seen");
  EXPECT_EQ(accepted.exit_code, 0) << accepted.err;
  EXPECT_TRUE(SaysIn(accepted, truth)) << accepted.out;
  EXPECT_NE(ReadFile(Golden()).find("# derived: " + line), std::string::npos) << ReadFile(Golden());
  EXPECT_EQ(Do("check --no-pictures").exit_code, 0) << "a person has accepted that";

  const auto with_line = [&](const std::string& other) {
    return std::regex_replace(ReadFile(Golden()), std::regex("# derived: oracle: .*\n"), other);
  };
  WriteFile(Golden(), with_line(""));
  const Said unseen = Do("check --no-pictures");
  EXPECT_EQ(unseen.exit_code, 1);
  EXPECT_TRUE(SaysIn(unseen, "  1 event differs from the ground truth\n    " + truth))
      << unseen.out;
  EXPECT_TRUE(SaysIn(Do("review"), "changed  rest/carton_rests\n    " + line));
  Accept();
  EXPECT_NE(ReadFile(Golden()).find(line), std::string::npos) << ReadFile(Golden());
  WriteFile(Golden(), ReadFile(Golden()) + "# below\n");
  EXPECT_EQ(Do("check --no-pictures").exit_code, 0);
  const std::string two = "; 2 that follow";
  WriteFile(Golden(), std::regex_replace(ReadFile(Golden()), std::regex("; 1 that follow"), two));
  EXPECT_TRUE(SaysIn(Do("check --no-pictures"),
                     "  1 event differs from the ground truth, the golden records 2\n"));
}

TEST_F(GoldenWorkflow, WatchingReadsAgainWhatASaveAffects) {
  WriteVariant("rest/b", "wait_s: 0.2", "wait_s: 0.1");
  const fs::path out = root_ / "watched.txt";
  const std::string command = "cd '" + root_.string() + "' && PREHEND_HOME='" + root_.string() +
                              "' timeout 8 '" PREHEND_BINARY_DIR "/prehend' validate --on-save >'" +
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

/// Stones that fall upon each other do not do so in both engines alike.
const char* const kStonesTumble = R"(scenario: stones_tumble
shows: stones fall upon each other and bounce
grammar: contact
world: {engine: box2d, planar: true}
entities:
  table: {fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  a: {box: {size_m: [0.05, 0.05, 0.05]}, mass_kg: 0.2, restitution: 0.9, at_m: [0.3, 0, 1.9], rpy_deg: [0, 20, 0]}
  b: {box: {size_m: [0.05, 0.05, 0.15]}, mass_kg: 0.2, restitution: 0.6, at_m: [0.28, 0, 1.4], rpy_deg: [0, 35, 0]}
  c: {cylinder: {radius_m: 0.04, length_m: 0.03}, mass_kg: 0.2, restitution: 0.8, at_m: [0.32, 0, 1.1], rpy_deg: [90, 0, 0]}
settle_s: 1
)";

/// One that lies already.
const char* const kStoneLies = R"(scenario: stones_tumble
shows: a stone lies
grammar: contact
world: {engine: box2d, planar: true}
entities:
  table: {fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  a: {box: {size_m: [0.05, 0.05, 0.05]}, mass_kg: 0.2, on: table, at_m: [0.3, 0]}
settle_s: 0.2
)";

TEST_F(GoldenWorkflow, WhatDiffersBetweenEnginesIsShownAndNotAccepted) {
  WriteFile(Scenario("rest/stones_tumble"), kStonesTumble);
  const Said check = Do("check stones_tumble --no-pictures");
  EXPECT_EQ(check.exit_code, 1);
  EXPECT_TRUE(SaysIn(check, "    again: prehend check rest/stones_tumble\n")) << check.out;
  const Said review = Do("review stones_tumble");
  EXPECT_FALSE(SaysIn(review, "if right")) << "it cannot be accepted";
  EXPECT_TRUE(SaysIn(
      review,
      "engines  rest/stones_tumble\n    recognised in bullet, expected as recognised in box2d:\n"))
      << review.out;
  EXPECT_TRUE(SaysIn(review, "expected [^\n]*[0-9]\\.\\.[0-9][^\n]*recognised [0-9]"))
      << review.out;
  const Said refused = Do("accept stones_tumble --reason why");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(SaysIn(refused, "recognised in bullet, expected as recognised in box2d:\n"))
      << refused.out;
  EXPECT_NE(refused.err.find("bullet yields other events (printed above); nothing was accepted"),
            std::string::npos)
      << refused.err;
  EXPECT_FALSE(fs::exists(Golden("rest/stones_tumble")));

  // There is nothing to say any more once they agree.
  WriteFile(Scenario("rest/stones_tumble"), kStoneLies);
  EXPECT_EQ(Do("check stones_tumble --no-pictures").exit_code, 5);
  Accept("stones_tumble");
  EXPECT_EQ(Do("review stones_tumble").out,
            "nothing is pending ('prehend check' finds what differs from its golden)\n");
}

TEST_F(GoldenWorkflow, WhatContradictsAClaimIsNotAccepted) {
  WriteFile(Scenario(), Replaced(ReadFile(Scenario()), "tags: [quiet]\n",
                                 "expects:\n  - one contact(table, carton)\n  - grasping\n"));
  const std::string contradiction =
      "expects: 'grasping' (" + Scenario().string() + ":5): found none";
  const Said run = Do("run carton_rests");
  EXPECT_EQ(run.exit_code, 0) << "a run shows what happens, a check judges it";
  EXPECT_EQ(run.err, contradiction + "\n  no grasping\n");
  EXPECT_NE(Do("run --help").out.find("It shows and does not judge"), std::string::npos);
  EXPECT_EQ(Json::parse(Do("run carton_rests --json").out)["claims"][1]["found"], "found none");
  const Said checked = Do("check --no-pictures");
  EXPECT_EQ(checked.exit_code, 1);
  const std::string in_project = Replaced(contradiction, root_.string() + "/", "");
  EXPECT_TRUE(checked.out.starts_with("failed  rest/carton_rests  " + in_project + "\n    " +
                                      in_project + "\n      no grasping\n"))
      << checked.out;
  const Said review = Do("review");
  EXPECT_TRUE(SaysIn(review, "new  rest/carton_rests\n")) << review.out;
  EXPECT_NE(review.out.find("    " + contradiction +
                            "\n      no grasping\n"
                            "    it cannot be accepted until its claims hold: "),
            std::string::npos)
      << review.out;
  const Said refused = Do("accept carton_rests --reason why");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_EQ(refused.out, contradiction + "\n  no grasping\n");
  EXPECT_NE(refused.err.find("the events contradict what the scenario expects (printed above); "
                             "nothing was accepted\n  it cannot be accepted until its claims "
                             "hold: change the script"),
            std::string::npos)
      << refused.err;
  EXPECT_FALSE(fs::exists(Golden()));
  const Json json = Json::parse(Do("check --no-pictures --json").out)["scenarios"][0]["claims"];
  EXPECT_EQ(json[0]["verdict"], "holds");
  EXPECT_EQ(json[1]["verdict"], "contradicted");
  EXPECT_EQ(json[1]["claim"], "grasping");
}

/// Four balls bounce in a pit: a micrometre decides which of them meet.
constexpr const char* kBalls = R"(scenario: balls
shows: four balls bounce in a pit
entities:
  floor: {fixed: true, box: {size_m: [2, 2, 0.1]}, at_m: [0, 0, -0.05], restitution: 1}
  east: {fixed: true, box: {size_m: [0.1, 0.3, 0.6]}, at_m: [0.2, 0, 0.3], restitution: 1}
  west: {fixed: true, box: {size_m: [0.1, 0.3, 0.6]}, at_m: [-0.2, 0, 0.3], restitution: 1}
  north: {fixed: true, box: {size_m: [0.5, 0.1, 0.6]}, at_m: [0, 0.2, 0.3], restitution: 1}
  south: {fixed: true, box: {size_m: [0.5, 0.1, 0.6]}, at_m: [0, -0.2, 0.3], restitution: 1}
  a: {sphere: {radius_m: 0.04}, mass_kg: 0.2, restitution: 0.95, friction: 0, at_m: [0.05, 0.03, 0.2]}
  b: {sphere: {radius_m: 0.04}, mass_kg: 0.2, restitution: 0.95, friction: 0, at_m: [-0.06, 0.02, 0.3]}
  c: {sphere: {radius_m: 0.04}, mass_kg: 0.2, restitution: 0.95, friction: 0, at_m: [0.01, -0.07, 0.4]}
  d: {sphere: {radius_m: 0.04}, mass_kg: 0.2, restitution: 0.95, friction: 0, at_m: [0.02, 0.05, 0.5]}
actors:
  hand: {hand: gripper, at_m: [1.5, 0, 1.1]}
script:
  - hand: {wait_s: 0.1}
settle_s: 4
)";

TEST_F(GoldenWorkflow, WhatRestsOnChaosIsAcceptedOnlyWithAReason) {
  WriteFile(Scenario("rest/balls"), kBalls);
  const Said refused = Do("accept balls --reason why");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("transforms (printed above); nothing was accepted"), std::string::npos)
      << refused.err;
  EXPECT_FALSE(fs::exists(Golden("rest/balls")));
  const Said accepted = Do("accept balls --reason why --unsteady chaotic_balls");
  EXPECT_EQ(accepted.exit_code, 0) << accepted.err;
  const std::string golden = ReadFile(Golden("rest/balls"));
  EXPECT_NE(golden.find("# ensemble: 7 plays\n# unsteady: \"chaotic_balls\"\n"), std::string::npos)
      << golden;
  EXPECT_NE(golden.find("spread="), std::string::npos);
}

// A reason for other events is none for a claim that does not hold.
TEST_F(GoldenWorkflow, AClaimMustHoldInEachPlay) {
  WriteFile(Scenario("rest/balls"), kBalls);
  ASSERT_EQ(Do("accept balls --reason why --unsteady chaotic_balls").exit_code, 0);
  const std::string golden = ReadFile(Golden("rest/balls"));
  const Json events = Json::parse(Do("run balls --json").out)["events"];
  const auto contacts =
      std::ranges::count_if(events, [](const Json& event) { return event["event"] == "contact"; });
  WriteFile(Scenario("rest/balls"),
            Replaced(kBalls, "settle_s: 4",
                     "settle_s: 4\nexpects: [" + std::to_string(contacts) + " contact]"));
  EXPECT_EQ(Do("check balls --no-pictures").exit_code, 0);
  const Said refused = Do("accept balls --reason why --unsteady chaotic_balls");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("what the scenario expects does not hold after "), std::string::npos)
      << refused.err;
  EXPECT_NE(refused.out.find("nudge: expects: '"), std::string::npos) << refused.out;
  EXPECT_EQ(ReadFile(Golden("rest/balls")), golden);
}

TEST_F(GoldenWorkflow, WhatIsSteadyAgainLosesTheReason) {
  ASSERT_EQ(Do("accept carton_rests --reason why --unsteady shaky").exit_code, 0);
  const std::string golden = ReadFile(Golden());
  EXPECT_NE(golden.find("# ensemble: 7 plays\n"), std::string::npos) << golden;
  EXPECT_EQ(golden.find("unsteady"), std::string::npos) << golden;
}

TEST_F(GoldenWorkflow, AClaimThatAnotherGrammarCannotDecideIsSaidToBeOpen) {
  WriteFile(Scenario(), Replaced(ReadFile(Scenario()), "tags: [quiet]\n",
                                 "expects:\n  - no grasping\n  - one contact\n"));
  Accept();
  const std::string open = "expects: 'no grasping' (" + Scenario().string() +
                           ":4): not judged: grammar 'contact' has no event 'grasping'\n";
  const Said checked = Do("check --no-pictures --grammar contact");
  EXPECT_EQ(checked.exit_code, 0);
  EXPECT_NE(checked.out.find("\n    " + open), std::string::npos) << checked.out;
  const Said validated = Do("validate carton_rests --grammar contact");
  EXPECT_EQ(validated.exit_code, 0);
  EXPECT_NE(validated.err.find(":4:8: warning: expects: not judged: grammar 'contact' has no "
                               "event 'grasping'\n"),
            std::string::npos)
      << validated.err;
}

}  // namespace
}  // namespace prehend::house
