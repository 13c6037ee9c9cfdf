// SPDX-License-Identifier: Apache-2.0
// The built program as a person or a script uses it: what it prints where, and how it ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/program/small_project.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

using CommandLine = SmallProject;

TEST_F(CommandLine, BenchMeasuresAGrammarOnAnEpisode) {
  const std::string take = (root_ / "take.episodes").string();
  ASSERT_EQ(Do("run carton_rests --record " + take).exit_code, 0);
  for (const auto& [episode, rows] : {std::pair<std::string, int>{"carton_rests", 2}, {take, 1}}) {
    const Said json = Do("grammar bench " + episode + " --grammar contact --quick --json");
    EXPECT_EQ(json.exit_code, 0) << json.err;
    const auto figures = nlohmann::json::parse(json.out)["figures"];
    ASSERT_EQ(figures.size(), rows);
    EXPECT_EQ(figures[0]["what"], "contact on rest/carton_rests");
    for (const auto& figure : figures) EXPECT_GT(figure["operations_per_s"], 0) << figure;
  }
  EXPECT_EQ(Do("grammar bench no_such_scenario").exit_code, 4);
}

TEST_F(CommandLine, HelpIsEverywhere) {
  const Said all = Do("--help");
  EXPECT_EQ(all.exit_code, 0);
  for (const std::string command : {"list", "validate", "run", "check", "accept", "render", "new",
                                    "scenario schema", "grammar bench"}) {
    EXPECT_NE(all.out.find("  " + command.substr(0, command.find(' '))), std::string::npos)
        << command;
    const Said ended = Do(command + " --help");
    EXPECT_EQ(ended.exit_code, 0);
    EXPECT_NE(ended.out.find("Examples:\n  prehend " + command), std::string::npos) << ended.out;
    EXPECT_EQ(ended.err, "");
  }
}

TEST_F(CommandLine, SaysItsVersion) {
  const Said said = Do("--version");
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_TRUE(std::regex_match(
      said.out, std::regex("prehend \\d+\\.\\d+\\.\\d+( \\([0-9a-f]{7,}(-dirty)?\\))?\n")))
      << said.out;
}

/// A command line that is refused.
struct Slip {
  const char* arguments;
  int code;
  const char* err;  ///< regular expression for all of it
};

TEST_F(CommandLine, UsageErrorsEndWithASuggestion) {
  const std::vector<Slip> slips = {
      {"chekc", 2,
       "prehend: unknown command 'chekc'; did you mean 'check'\\?\n  again: prehend check\n  see: "
       "prehend --help\n"},
      {"run carton_rests --jsn", 2,
       "prehend: unknown option '--jsn'; did you mean '--json'\\?\n  again: prehend run "
       "carton_rests "
       "--json\n  see: prehend run --help\n"},
      {"run", 2, "prehend: the argument 'scenario' is missing\n  see: prehend run --help\n"},
      {"scenario schema more", 2,
       "prehend: import-map: found 'more', wanted import-map\n"
       "  see: prehend scenario schema --help\n"},
      {"check --jobs none", 2,
       "prehend: --jobs: found 'none', wanted a whole number from 1 to 256\n  see: prehend check "
       "--help\n"},
      {"run carton_rest", 4,
       "prehend: no scenario 'carton_rest'; did you mean 'carton_rests'\\? \\('prehend list' shows "
       "all\\)\n  again: prehend run carton_rests\n"},
      {"check slide/*", 4,
       "prehend: no scenario matches 'slide/\\*' \\('prehend list' shows all\\)\n"},
      {"check rest", 4, "prehend: no scenario matches 'rest'; did you mean 'rest/\\*'\\?[^]*"},
      {"check scenarios/rest/", 4,
       "prehend: no scenario matches 'scenarios/rest/'; did you mean 'rest/\\*'\\?[^]*"},
      {"check rset/*", 4,
       "prehend: no scenario matches 'rset/\\*'; did you mean 'rest/\\*'\\?[^]*"},
      {"check carton_rets", 4, "[^]*; did you mean 'carton_rests'\\?[^]*"},
      {"score carton", 4, "[^]*; did you mean 'carton_rests'\\?[^]*"},
      {"run carton_rests --grammar pick_and_plac", 2,
       "[^]*/pick_and_plac.grammar: error: no such file\n  hint: did you mean "
       "'pick_and_place'\\?\n[^]*"},
      {"new invalid/x", 2, "prehend: scenarios/invalid/ holds examples of errors, [^]*"},
      {"check --shard 0/2", 2,
       "prehend: --shard: found '0/2', wanted I/N, like 2/3 for the second of three\n[^]*"},
      {"check --repeat 0", 2, "prehend: [^]*"},
      {"check --changed --set lift_rise=1cm", 2,
       "prehend: --changed compares files; it cannot be combined with --set\n"},
      {"check --filter tag:quiet --filter !*rests", 4, "prehend: no scenario is selected[^]*"},
      {"run carton_rests --record /dev/null/e.jsonl", 2,
       "prehend: --record: cannot create /dev/null: Not a directory\n[^]*"},
      {"check --filter tag:none", 4,
       "prehend: --filter: no scenario has the tag 'none' \\('prehend list' shows all\\)\n"},
      {"check --filter tag:quite", 4,
       "prehend: --filter: no scenario has the tag 'quite'; did you mean 'quiet'\\?[^]*"},
      {"check --filter !", 2,
       "prehend: --filter: found '!', wanted what must not match, like !reach/\\*\n[^]*"},
      {"check --filter !tag:", 2,
       "prehend: --filter: found '!tag:', wanted a tag after it, like !tag:smoke\n[^]*"},
      {"check --filter nothing*", 4, "prehend: --filter: no scenario matches 'nothing\\*' [^]*"},
      {"run carton_rests --trials 2 --record x", 2,
       "prehend: --record: many trials need an episode file, NAME.episodes\n"},
      {"run carton_rests --grammar xyz", 2,
       "[^]*no such file\n  hint: there are: [^]*pick_and_place[^]*"},
      {"run missing.yaml", 2, "missing.yaml: error: no such file\n"},
      {"run carton_rests --set lift_ris=3cm", 2, "[^]*error: [^]*lift_rise[^]*"},
      {"run carton_rests --set lift_rise", 2, "--set:1:1: error: expected NAME=VALUE\n[^]*"},
      {"run carton_rests --set lift_rise=", 2, "--set:1:1: error: expected NAME=VALUE\n[^]*"},
      {"run carton_rests --set lift_rise=1cm --set lift_rise=2cm", 2,
       "--set:1:1: error: the same name is set twice\n[^]*"},
      {"run carton_rests --set wrold.rate_hz=960", 2,
       "--set:1:1: error: [^]*did you mean 'world'[^]*"},
      {"run carton_rests --set settle_s=soon", 2,
       "--set:1:10: error: settle_s: expected a number[^]*"},
      {"run missing.yml", 2, "missing.yml: error: no such file\n[^]*"},
      {"render carton_rests --at reching.begin", 2,
       "prehend: --at: grammar 'pick_and_place' has no event 'reching'; did you mean "
       "'reaching'\\?\n[^]*"},
      {"render carton_rests --at soon", 2,
       "prehend: --at: 'soon' is not a time; write seconds[^]*"},
      {"render carton_rests --camera back", 2, "prehend: --camera: [^]*"},
      {"render carton_rests --at 0 -o /dev/null/a.png", 2,
       "prehend: --output: cannot create /dev/null: Not a directory\n[^]*"},
      {"run carton_rests --set entities.carton.mass=1", 2, "--set[^]*error: [^]*mass_kg[^]*"},
      {"run carton_rests --grammar none.grammar", 2, "none.grammar: error: [^]*"},
      {"accept carton_rests", 2,
       "prehend: accept needs a reason: --reason \"why this is right\"\n"},
      {"accept rest/* --reason x", 2,
       "prehend: 'rest/\\*' may match several scenarios; accept takes one scenario at a time, by "
       "name\n"},
      {"new Wrong-Name", 2,
       "prehend: 'Wrong-Name' is not a scenario name; wanted a small letter, then [^]*"},
      {"check --time-limit-s nan", 2,
       "prehend: --time-limit-s: found 'nan', wanted a number from 0.1 to 86400\n[^]*"},
      {"score --collar-ms nan", 2,
       "prehend: --collar-ms: found 'nan', wanted a number from 0 to 10000\n[^]*"},
      {"check --time-limit-s 0", 2,
       "prehend: --time-limit-s: found '0', wanted a number from 0.1 to 86400\n[^]*"},
      {"new carton_rests", 2, "prehend: a scenario of this name exists: [^]*"},
  };
  for (const Slip& slip : slips) {
    const Said ended = Do(slip.arguments);
    EXPECT_EQ(ended.exit_code, slip.code) << slip.arguments;
    EXPECT_EQ(ended.out, "") << slip.arguments;
    EXPECT_TRUE(std::regex_match(ended.err, std::regex(slip.err))) << slip.arguments << "\n"
                                                                   << ended.err;
  }
}

TEST_F(CommandLine, ARecordingIsNotAScenario) {
  const std::string file = (root_ / "cup.jsonl").string();
  ASSERT_EQ(Do("run carton_rests --record " + file).exit_code, 0);
  for (const std::string command : {"run ", "validate ", "new copy --like "}) {
    const Said said = Do(command + file);
    EXPECT_EQ(said.exit_code, 2) << command;
    EXPECT_EQ(said.out, "");
    EXPECT_EQ(said.err, "prehend: " + file +
                            " is a recording, so there is no scenario to simulate; 'prehend "
                            "episode resegment " +
                            file + "' prints its events\n");
  }
  const Said scored = Do("score " + file);
  EXPECT_EQ(scored.exit_code, 2);
  EXPECT_EQ(scored.err,
            "prehend: " + file +
                " was not simulated, so its physical truth is not known; score it against labels "
                "by people, or its golden: --truth FILE (docs/labels.md)\n");
}

TEST_F(CommandLine, PrintedCommandsHaveTheNameThatTheProgramWasCalledBy) {
  const std::vector<std::string> environment = {"PREHEND_HOME=" + root_.string(),
                                                "PREHEND_COMMAND=./run"};
  EXPECT_EQ(Prehend({"run", "carton_rest"}, environment).err,
            "prehend: no scenario 'carton_rest'; did you mean 'carton_rests'? ('./run list' shows "
            "all)\n  again: ./run run carton_rests\n");
  EXPECT_EQ(Prehend({"scenario", "schema", "more"}, environment).err,
            "prehend: import-map: found 'more', wanted import-map\n"
            "  see: ./run scenario schema --help\n");
  const Said help = Prehend({"list", "--help"}, environment);
  EXPECT_NE(help.out.find("\n  ./run list --json\n"), std::string::npos) << help.out;
}

TEST_F(CommandLine, AnUnknownOptionIsNamedBeforeAMissingArgument) {
  const std::vector<std::string> environment = {"PREHEND_HOME=" + root_.string()};
  EXPECT_EQ(Prehend({"run", "--nosuch"}, environment).err.substr(0, 36),
            "prehend: unknown option '--nosuch'\n ");
  EXPECT_EQ(Prehend({"run", "--jsn"}, environment).err.substr(0, 55),
            "prehend: unknown option '--jsn'; did you mean '--json'?");
  EXPECT_EQ(Prehend({"run", "--json"}, environment).err.substr(0, 43),
            "prehend: the argument 'scenario' is missing");
}

TEST_F(CommandLine, RecordingsThatAreNoTextAreCalledSo) {
  const std::vector<std::string> environment = {"PREHEND_HOME=" + root_.string()};
  for (const auto& [bytes, wanted] : std::map<std::string, std::string>{
           {"", ": error: the file is empty\n"},
           {std::string("\xff\xfe{\0}\0", 6), "error: expected UTF-8, found UTF-16"}}) {
    const std::string file = (root_ / "strange.jsonl").string();
    std::ofstream(file, std::ios::binary) << bytes;
    const Said said = Prehend({"run", file}, environment);
    EXPECT_EQ(said.exit_code, 2);
    EXPECT_NE(said.err.find(wanted), std::string::npos) << said.err;
  }
}

TEST_F(CommandLine, AnEmptyValueIsRefused) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"run", ""},
                                                {"run", "carton_rests", "--grammar", ""},
                                                {"check", "--filter", ""}}) {
    const Said said = Prehend(words, {"PREHEND_HOME=" + root_.string()});
    EXPECT_EQ(said.exit_code, 2) << said.out;
    EXPECT_NE(said.err.find(": the value is empty\n"), std::string::npos) << said.err;
  }
  const Said homeless = Prehend({"list"}, {"PREHEND_HOME=/nowhere"});
  EXPECT_EQ(homeless.exit_code, 2);
  EXPECT_NE(homeless.err.find(
                "PREHEND_HOME is /nowhere, which has neither prehend.yaml nor grammar/library"),
            std::string::npos)
      << homeless.err;
}

TEST_F(CommandLine, ListAndSchema) {
  EXPECT_EQ(Do("list").out,
            "rest/carton_rests  [quiet]\n    a carton stands on a table and nobody touches it\n");
  EXPECT_EQ(nlohmann::json::parse(Do("list --json").out)["scenarios"][0]["scenario"],
            "rest/carton_rests");
  EXPECT_TRUE(nlohmann::json::parse(Do("scenario schema").out).contains("$schema"));
}

TEST_F(CommandLine, ValidateReadsScenariosGrammarsAndGoldens) {
  Accept();
  const Said good =
      Do("validate carton_rests " + (root_ / "grammar/library/pick_and_place.grammar").string() +
         " " + Golden().string());
  EXPECT_EQ(good.exit_code, 0) << good.err;
  const std::regex ok("(^|\n)ok: ");
  EXPECT_EQ(std::distance(std::sregex_iterator(good.out.begin(), good.out.end(), ok), {}), 3)
      << good.out;
  const Said described = Do("validate --grammar pick_and_place");
  EXPECT_NE(described.out.find("putting_down"), std::string::npos)
      << "a grammar is described: " << described.out;

  WriteFile(root_ / "bad.grammar", "grammar bad\nevent x(a: Thing\n");
  WriteFile(Scenario(), std::regex_replace(std::string(kCartonRests), std::regex("mass_kg: 0.3"),
                                           "mass_kg: no"));
  const Said bad = Do("validate --json carton_rests " + (root_ / "bad.grammar").string());
  EXPECT_EQ(bad.exit_code, 2);
  const auto files = nlohmann::json::parse(bad.out)["files"];
  EXPECT_FALSE(files[0]["ok"]);
  EXPECT_EQ(files[0]["diagnostics"][0]["line"], 6);
  EXPECT_FALSE(files[1]["ok"]);
}

TEST_F(CommandLine, ValidateTellsOfAllThatIsWrongAtOnce) {
  Accept();
  WriteFile(Golden(), ReadFile(Golden()) + "sliding 0.2 0.1\n");
  WriteFile(root_ / "grammar/library/odd.grammar", "grammar odd\nevent x(a: Thing\n");
  const std::string wrong =
      std::regex_replace(std::string(kCartonRests), std::regex("mass_kg: 0.3"), "mass_kg: no");
  WriteFile(Scenario(),
            std::regex_replace(wrong, std::regex("hand: human_right"), "hand: human_rigt") +
                "grammar: odd\n");
  const Said said = Do("validate carton_rests");
  EXPECT_EQ(said.exit_code, 2);
  for (const char* part :
       {"mass_kg", "did you mean 'human_right'?", "odd.grammar:", "carton_rests.timeline:"}) {
    EXPECT_NE(said.err.find(part), std::string::npos) << part << "\n" << said.err;
  }
  std::string many = wrong;
  for (int i = 0; i < 150; ++i) many += "odd_" + std::to_string(i) + ": 1\n";
  WriteFile(Scenario(), many);
  EXPECT_NE(Do("validate carton_rests").err.find("\nand 5"), std::string::npos)
      << "of a hundred and more";
  WriteFile(Scenario(),
            std::regex_replace(wrong, std::regex("tags:"), "grammar: pick_and_plac\ntags:"));
  const std::string err = Do("validate carton_rests").err;
  EXPECT_NE(err.find("did you mean 'pick_and_place'?"), std::string::npos) << err;
  EXPECT_EQ(err.find("no such file"), std::string::npos) << "said once\n" << err;
}

TEST_F(CommandLine, WarningsOfAGrammarStopNothing) {
  WriteFile(root_ / "odd.grammar",
            "grammar odd\nparam unused = 1 cm\nevent high(c: Cartoon) while height(c) > 1 m\n");
  const std::string file = (root_ / "odd.grammar").string();
  const std::string unused = file + ":2:7: warning: the parameter 'unused' is not used\n";
  const std::string nobody = file + ":3:12: warning: no entity of this episode is a 'Cartoon'\n";
  const Said validated = Do("validate " + file);
  EXPECT_EQ(validated.exit_code, 0);
  EXPECT_NE(validated.err.find(unused), std::string::npos) << validated.err;
  EXPECT_EQ(validated.err.find("nobody"), std::string::npos) << "no scenario is asked about";
  for (const std::string command :
       {"validate carton_rests --grammar ", "run carton_rests --grammar "}) {
    const Said said = Do(command + file);
    EXPECT_EQ(said.exit_code, 0) << said.err;
    EXPECT_NE(said.err.find(unused), std::string::npos) << said.err;
    EXPECT_NE(said.err.find(nobody), std::string::npos) << said.err;
  }
}

TEST_F(CommandLine, RunPrintsATableOrAnObject) {
  const Said table = Do("run carton_rests");
  EXPECT_EQ(table.exit_code, 0) << table.err;
  EXPECT_TRUE(std::regex_search(
      table.out,
      std::regex("supported_by +0\\.0\\d+ +0\\.\\d+ +object=carton +support=table +open_end\n")))
      << table.out;
  EXPECT_TRUE(std::regex_search(table.out, std::regex("\ncompleted: .* s, .* ticks\n$")));

  const auto json = nlohmann::json::parse(Do("run carton_rests --json --measure").out);
  EXPECT_EQ(json["status"], "completed");
  EXPECT_GT(json["measured"]["times_real_time"], 0);
  EXPECT_EQ(json["state_hash"],
            nlohmann::json::parse(Do("run carton_rests --json").out)["state_hash"]);
  EXPECT_NE(json["state_hash"],
            nlohmann::json::parse(
                Do("run carton_rests --json --set entities.carton.mass_kg=0.5").out)["state_hash"]);
}

TEST_F(CommandLine, AGoldenIsPendingThenAcceptedThenKept) {
  const Said pending = Do("check --no-pictures");
  EXPECT_EQ(pending.exit_code, 5) << pending.err;
  EXPECT_TRUE(
      pending.out.ends_with("\n1 new scenario has no golden: review it, then accept it with a "
                            "reason\n0 passed, 0 failed\n"))
      << pending.out;
  EXPECT_TRUE(fs::exists(Pending()));
  EXPECT_FALSE(fs::exists(Golden())) << "a run must never write a golden";

  const Said refused = Do("accept carton_rests --reason x", "true");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_FALSE(fs::exists(Golden()));

  Accept();
  EXPECT_FALSE(fs::exists(Pending()));
  const std::string golden = ReadFile(Golden());
  EXPECT_TRUE(std::regex_search(
      golden, std::regex("# accepted: \\d{4}-\\d\\d-\\d\\d \"nothing_happens\"\n")))
      << golden;
  const Said again = Do("accept carton_rests --reason other");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_TRUE(again.out.starts_with("nothing to accept")) << again.out;
  EXPECT_EQ(ReadFile(Golden()), golden) << "accepting twice is accepting once";

  const Said passed = Do("check --no-pictures");
  EXPECT_EQ(passed.exit_code, 0) << passed.out;
  EXPECT_TRUE(passed.out.ends_with("\n1 passed, 0 failed\n")) << passed.out;
  EXPECT_NE(ReadFile(root_ / "build/report/index.html").find("1 passed"), std::string::npos);
}

TEST_F(CommandLine, OnlyScenariosOfTheProjectHaveGoldens) {
  const fs::path loose = root_ / "elsewhere/carton_waits.yaml";
  WriteFile(loose, std::regex_replace(std::string(kCartonRests), std::regex("carton_rests"),
                                      "carton_waits"));
  const Said ended = Do("accept " + loose.string() + " --reason because");
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_NE(ended.err.find("only scenarios in scenarios/ of this project have goldens"),
            std::string::npos)
      << ended.err;
  EXPECT_FALSE(fs::exists(root_ / "golden"));
}

TEST_F(CommandLine, FieldsThatTheFileLeavesOutCanBeSet) {
  const auto ticks = [&](const std::string& settings) {
    return nlohmann::json::parse(Do("run carton_rests --json " + settings).out)["ticks"].get<int>();
  };
  EXPECT_EQ(ticks("--set settle_s=0.6") - ticks(""), 240);
  EXPECT_EQ(ticks("--set world.rate_hz=960"), 2 * ticks(""));
}

TEST_F(CommandLine, ADifferenceNamesTheEventTheIntervalsAndTheCommand) {
  Accept();
  const std::string golden = ReadFile(Golden());
  WriteFile(Golden(), golden + "sliding 0.1 0.2 hand=right_hand object=carton\n");
  const Said ended = Do("check carton_rests --no-pictures");
  EXPECT_EQ(ended.exit_code, 1);
  for (const char* part :
       {"missing sliding(right_hand, carton)", "expected 0.1000..0.2000 s, recognised nothing",
        "why: prehend explain rest/carton_rests --expected 'sliding right_hand carton @0.1000s'\n",
        "again: prehend check rest/carton_rests", "0 passed, 1 failed"}) {
    EXPECT_NE(ended.out.find(part), std::string::npos) << part << "\n" << ended.out;
  }
  const auto json = nlohmann::json::parse(Do("check --no-pictures --json").out);
  EXPECT_EQ(json["failed"], 1);
  EXPECT_EQ(json["scenarios"][0]["verdict"], "failed");
  EXPECT_EQ(json["scenarios"][0]["differences"][0]["kind"], "missing");
  EXPECT_EQ(json["scenarios"][0]["differences"][0]["expected"]["roles"]["object"], "carton");
  EXPECT_TRUE(fs::exists(Pending()));

  Accept();
  EXPECT_EQ(Do("check --no-pictures").exit_code, 0);
}

TEST_F(CommandLine, OrphansUnreadableGoldensAndScenariosFail) {
  Accept();
  fs::rename(Scenario(), root_ / "scenarios/rest/other.yaml");
  const Said orphan = Do("check --no-pictures");
  EXPECT_EQ(orphan.exit_code, 2) << orphan.out;
  EXPECT_NE(orphan.out.find("rest/carton_rests  a golden without scenario"), std::string::npos)
      << orphan.out;
  EXPECT_NE(orphan.out.find("rest/other  cannot be read"), std::string::npos)
      << "its name is not that of its file";
  fs::rename(root_ / "scenarios/rest/other.yaml", Scenario());

  WriteFile(Golden(), "not a golden\n");
  const Said unreadable = Do("check --no-pictures");
  EXPECT_EQ(unreadable.exit_code, 2);
  EXPECT_NE(unreadable.out.find("the golden cannot be read"), std::string::npos) << unreadable.out;
}

TEST_F(CommandLine, AScenarioThatNeverEndsIsAVerdict) {
  Accept();
  const Said ended =
      Do("check --no-pictures --time-limit-s 0.2 --set script.0.right_hand.wait_s=600");
  EXPECT_EQ(ended.exit_code, 3) << ended.out;
  EXPECT_NE(ended.out.find("its process ended: no end after 0.2 s"), std::string::npos)
      << ended.out;
  EXPECT_NE(
      ended.out.find("again: prehend check rest/carton_rests --set script.0.right_hand.wait_s=600 "
                     "--no-pictures --time-limit-s 0.2 --memory-limit-mb 1000\n"),
      std::string::npos)
      << ended.out;
}

TEST_F(CommandLine, NewWritesAScenarioThatRuns) {
  const Said made = Do("new lift/carton_is_lifted");
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(Do("validate lift/carton_is_lifted").exit_code, 0)
      << Do("validate lift/carton_is_lifted").err;
  EXPECT_EQ(Do("new carton_still_rests --like carton_rests").exit_code, 0);
  EXPECT_TRUE(ReadFile(root_ / "scenarios/rest/carton_still_rests.yaml")
                  .starts_with("# yaml-language-server: $schema=../scenario.schema.json\n"
                               "scenario: carton_still_rests\nshows: a carton stands"));
  EXPECT_EQ(Do("run carton_still_rests").exit_code, 0);
}

TEST_F(CommandLine, WhatIsNewCanBeReadWhateverItsName) {
  for (const char* name : {"on", "true", "null", "words/off"}) {
    EXPECT_EQ(Do(std::string("new ") + name).exit_code, 0) << name;
    EXPECT_EQ(Do(std::string("validate ") + name).exit_code, 0)
        << Do(std::string("validate ") + name).err;
  }
  EXPECT_NE(ReadFile(root_ / "scenarios/words/off.yaml").find("\nscenario: \"off\"\n"),
            std::string::npos);
}

TEST_F(CommandLine, ACopyFindsTheRecordingsOfItsModel) {
  WriteFile(root_ / "scenarios/rest/track.csv",
            "t_s,x_m,y_m,z_m\n0,-0.25,-0.1,1.1\n0.1,-0.25,-0.1,1.12\n");
  WriteVariant("rest/moved", "wait_s: 0.2", "recording: 'track.csv'  ");
  ASSERT_EQ(Do("validate moved").exit_code, 0) << Do("validate moved").err;
  for (const char* name : {"rest/beside", "other/elsewhere"}) {
    EXPECT_EQ(Do(std::string("new ") + name + " --like moved").exit_code, 0) << name;
    EXPECT_EQ(Do(std::string("validate ") + name).exit_code, 0)
        << Do(std::string("validate ") + name).err;
  }
  EXPECT_NE(
      ReadFile(root_ / "scenarios/other/elsewhere.yaml").find("{recording: ../rest/track.csv  }"),
      std::string::npos);
  EXPECT_NE(ReadFile(root_ / "scenarios/rest/beside.yaml").find("{recording: 'track.csv'  }"),
            std::string::npos);
  WriteVariant("rest/wrong", "mass_kg", "mass");
  const Said refused = Do("new rest/as_wrong --like wrong");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("/wrong.yaml:6:62: error: unknown key 'mass'"), std::string::npos)
      << refused.err;
  EXPECT_FALSE(fs::exists(root_ / "scenarios/rest/as_wrong.yaml"));
}

}  // namespace
}  // namespace prehend::house
