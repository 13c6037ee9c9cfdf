// SPDX-License-Identifier: Apache-2.0
// Recorded episodes and scores, as a person uses them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

TEST(Recording, ResegmentingGivesTheSameTimelineAndOtherGrammarsTheirs) {
  const auto file = (FreshFolder("recording") / "milk.jsonl").string();
  const Said played = Prehend({"run", "milk_carton_wrap", "--json", "--record", file});
  ASSERT_EQ(played.exit_code, 0) << played.err;
  const Said again = Prehend({"episode", "resegment", file, "--json"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const auto first = nlohmann::json::parse(played.out), second = nlohmann::json::parse(again.out);
  EXPECT_EQ(first["events"], second["events"]);
  EXPECT_EQ(second["scenario"], "milk_carton_wrap");
  EXPECT_FALSE(first["events"].empty());

  const Said contacts = Prehend({"episode", "resegment", file, "--grammar", "contact", "--json"});
  for (const auto& event : nlohmann::json::parse(contacts.out)["events"]) {
    EXPECT_TRUE(event["event"] == "contact" || event["event"] == "supported_by") << event;
  }
  const Said higher = Prehend({"episode", "resegment", file, "--set", "lift_rise=10m"});
  EXPECT_EQ(higher.out.find("picking_up"), std::string::npos) << higher.out;
}

TEST(Recording, WhatBadSensorsSawIsSegmentedAgainAsItWas) {
  const auto file = (FreshFolder("bad_sensors") / "slide.jsonl").string();
  const Said played =
      Prehend({"run", "a_slide_is_seen_through_bad_sensors", "--json", "--record", file});
  ASSERT_EQ(played.exit_code, 0) << played.err;
  const Said again = Prehend({"episode", "resegment", file, "--json"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const auto first = nlohmann::json::parse(played.out), second = nlohmann::json::parse(again.out);
  EXPECT_EQ(first["events"], second["events"]);
  EXPECT_FALSE(first["events"].empty());
}

/// What begins before time 0 counts from its first frame, and everything that is written of it is
/// read again.
TEST(Recording, WhatBeginsBeforeZeroIsCountedFromItsFirstFrame) {
  const auto folder = FreshFolder("before_zero");
  const auto file = [&](const char* name) { return (folder / name).string(); };
  const std::string docs = PREHEND_SOURCE_DIR "/docs/motion_capture";
  ASSERT_EQ(Prehend({"import", docs + "/poses.csv", "--map", docs + "/bodies.yaml", "-o",
                     file("from_0.jsonl")})
                .exit_code,
            0);
  std::string moved;
  std::istringstream lines(ReadFile(folder / "from_0.jsonl"));
  for (std::string line; std::getline(lines, line);) {
    auto json = nlohmann::ordered_json::parse(line);
    for (const char* key : {"tick", "end_tick"})
      if (json.contains(key)) json[key] = json[key].get<std::int64_t>() - 30'000;
    moved += json.dump() + "\n";
  }
  WriteFile(folder / "before_0.jsonl", moved);
  const std::string said =
      "warning: 'milk_is_carried' begins at -3 s: times count from its first frame\n"
      "  hint: of labels by its own clock: offset_s: 3 in their map\n";
  const auto events = [&](const std::string& of) {
    return nlohmann::json::parse(Prehend({"episode", "resegment", of, "--json"}).out)["events"];
  };
  EXPECT_EQ(events(file("before_0.jsonl")), events(file("from_0.jsonl")));
  EXPECT_EQ(Prehend({"grammar", "watch", file("before_0.jsonl"), "--json"}).out,
            Prehend({"grammar", "watch", file("from_0.jsonl"), "--json"}).out);
  for (const char* ending : {".csv", ".eaf", ".TextGrid"}) {
    const std::string labels = file("labels") + ending;
    const Said written = Prehend({"episode", "resegment", file("before_0.jsonl"), "-o", labels});
    EXPECT_EQ(written.err, said);
    const Said scored = Prehend({"score", file("before_0.jsonl"), "--truth", labels, "--json"});
    ASSERT_EQ(scored.exit_code, 0) << scored.err;
    EXPECT_EQ(scored.err, said);
    EXPECT_EQ(nlohmann::json::parse(scored.out)["grammars"][0]["total"]["f1_50"], 1) << ending;
  }
  EXPECT_EQ(Prehend({"grammar", "margins", file("before_0.jsonl"), "--truth", file("labels.csv"),
                     "--over", "reach_radius"})
                .err,
            said);
  const auto page = file("page.html");
  EXPECT_EQ(Prehend({"report", file("before_0.jsonl"), "-o", page}).err, said);
  EXPECT_EQ(Prehend({"episode", "query", file("before_0.jsonl"), "--event", "grasping"}).err, said);
  EXPECT_EQ(Prehend({"episode", "knowledge", file("before_0.jsonl"), "-o", file("knowledge")}).err,
            said);
  ASSERT_EQ(Prehend({"accept", file("before_0.jsonl"), "--reason", "a test"}, {"CI="}).exit_code,
            0);
  EXPECT_EQ(Prehend({"check", file("before_0.jsonl")}).exit_code, 0);
  EXPECT_EQ(Prehend({"report", file("before_0.jsonl"), "-o", page}).err, said);
  EXPECT_NE(ReadFile(page).find("times count from its first frame"), std::string::npos);
  const Said kept = Prehend({"import", file("before_0.jsonl"), "-o", file("all.episodes")});
  EXPECT_EQ(kept.err, said);
  EXPECT_EQ(events(file("all.episodes")), events(file("from_0.jsonl")));
  for (const std::string to : {"csv", "npz", "mcap"}) {
    const std::string out = file("out.") + to, take = file("again.jsonl");
    EXPECT_EQ(
        Prehend({"episode", "export", file("before_0.jsonl"), "--to", to, "-o", out}).exit_code, 0);
    const Said again = Prehend({"import", out, "--map", out + ".map.yaml", "-o", take});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    if (to != "csv") continue;
    const Said scored = Prehend({"score", take, "--truth", file("out.events.csv"), "--json"});
    EXPECT_EQ(nlohmann::json::parse(scored.out)["grammars"][0]["total"]["f1_50"], 1) << scored.err;
  }
}

/// Files of scenarios that ship.
std::vector<std::string> ShippedScenarios() {
  std::vector<std::string> files;
  for (const auto& one : std::filesystem::recursive_directory_iterator(
           std::filesystem::path(PREHEND_SOURCE_DIR) / "scenarios")) {
    const std::string folder = one.path().parent_path().filename().string();
    if (one.path().extension() == ".yaml" && folder != "invalid" && folder != "templates" &&
        ReadFile(one.path()).find("\nscript:") != std::string::npos)
      files.push_back(one.path().string());
  }
  std::ranges::sort(files);
  return files;
}

/// Played, and recorded as lines; `grammar` is that of both.
void ExpectSegmentedAgainAsItWas(const std::string& scenario, const std::filesystem::path& folder) {
  const auto file = (folder / "recorded.jsonl").string();
  const Said played = Prehend({"run", scenario, "--json", "--record", file});
  ASSERT_EQ(played.exit_code, 0) << scenario << "\n" << played.err;
  const Said again = Prehend({"episode", "resegment", file, "--json"});
  ASSERT_EQ(again.exit_code, 0) << scenario << "\n" << again.err;
  const auto first = nlohmann::json::parse(played.out), second = nlohmann::json::parse(again.out);
  EXPECT_EQ(first["grammar"], second["grammar"]) << scenario;
  EXPECT_EQ(first["events"], second["events"]) << scenario;
}

TEST(Recording, OfPersonsAndOthersIsSegmentedAgainAsItWas) {
  const auto folder = FreshFolder("all_alike");
  std::size_t persons = 0, others = 0;
  for (const std::string& scenario : ShippedScenarios()) {
    const bool has_person = ReadFile(scenario).find("person:") != std::string::npos;
    if (!has_person && ++others % 40 != 0) continue;
    persons += has_person ? 1 : 0;
    ExpectSegmentedAgainAsItWas(scenario, folder);
  }
  EXPECT_GE(persons, 17u);
}

TEST(Recording, OfSeveralGrammarsNamesThemAll) {
  const auto folder = FreshFolder("several");
  std::size_t several = 0;
  for (const std::string& scenario : ShippedScenarios()) {
    const std::string text = ReadFile(scenario);
    const std::size_t list = text.find("\ngrammar: [");
    if (list == std::string::npos || text.find(',', list) > text.find('\n', list + 1)) continue;
    ++several;
    ExpectSegmentedAgainAsItWas(scenario, folder);
  }
  EXPECT_GE(several, 3u);

  // The one of an episode file, too.
  const auto episodes = (folder / "hook.episodes").string(),
             file = (folder / "hook.jsonl").string();
  const std::string hook = "force/a_hook_holds_on_while_it_pulls";
  const Said played = Prehend({"run", hook, "--json", "--record", episodes});
  ASSERT_EQ(Prehend({"episode", "export", episodes, "--to", "jsonl", "-o", file}).exit_code, 0);
  const std::string written = ReadFile(file);
  const auto header = nlohmann::json::parse(written.substr(0, written.find('\n')));
  EXPECT_EQ(header["grammar"], (std::vector<std::string>{"pick_and_place", "force"}));
  const Said again = Prehend({"episode", "resegment", file, "--json"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const auto first = nlohmann::json::parse(played.out), second = nlohmann::json::parse(again.out);
  EXPECT_EQ(first["events"], second["events"]);
  EXPECT_EQ(first["grammar"], second["grammar"]);

  // Into an episode file and out of it, as lines of others.
  const auto imported = (folder / "imported.episodes").string();
  const Said import = Prehend({"import", file, "-o", imported});
  ASSERT_EQ(import.exit_code, 0) << import.err;
  const Said kept = Prehend({"episode", "resegment", imported, "--against", "recorded"});
  EXPECT_EQ(kept.exit_code, 0) << kept.err << kept.out;

  // One that is not known is named where the recording says it.
  WriteFile(file,
            Replaced(written, R"(["pick_and_place","force"])", R"(["pick_and_place","frce"])"));
  const Said unknown = Prehend({"episode", "resegment", file});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find(file + ":1:"), std::string::npos) << unknown.err;
  EXPECT_NE(unknown.err.find("no grammar is called 'frce'"), std::string::npos) << unknown.err;
}

/// The events of this name in what `--json` printed.
std::vector<nlohmann::json> EventsNamed(const std::string& name, const Said& said) {
  EXPECT_EQ(said.exit_code, 0) << said.err;
  std::vector<nlohmann::json> found;
  const auto printed = nlohmann::json::parse(said.out, nullptr, false);
  if (printed.is_discarded()) return found;
  for (const auto& event : printed["events"]) {
    if (event["event"] == name) found.push_back(event);
  }
  return found;
}

TEST(Recording, ClassesAreSegmentedAgainAsTheScenarioNamesThem) {
  const auto folder = FreshFolder("classes");
  const auto file = (folder / "ball.jsonl").string();
  const Said played =
      Prehend({"run", "ball_in_a_carried_cup_is_supported_by_it", "--json", "--record", file});
  const Said again = Prehend({"episode", "resegment", file, "--json"});
  EXPECT_EQ(EventsNamed("contained_in", played).size(), 1u);
  EXPECT_EQ(EventsNamed("contained_in", again), EventsNamed("contained_in", played));

  // A grammar of one's own can name the class and its superclass; both mean the cup.
  WriteFile(
      folder / "mine.grammar",
      "grammar mine\nuse contact\n"
      "event by_class(ball: Ball, cup: Cup) while supported_by(ball, cup)\n"
      "event by_superclass(ball: Movable, vessel: Container) while supported_by(ball, vessel)\n");
  const Said mine = Prehend(
      {"episode", "resegment", file, "--grammar", (folder / "mine.grammar").string(), "--json"});
  ASSERT_EQ(EventsNamed("by_class", mine).size(), 1u);
  ASSERT_EQ(EventsNamed("by_superclass", mine).size(), 1u);
  EXPECT_EQ(EventsNamed("by_class", mine)[0]["begin_tick"],
            EventsNamed("by_superclass", mine)[0]["begin_tick"]);

  // Without its superclass the cup is no container, and who asks for containers is warned of it.
  const auto poorer = folder / "poorer.jsonl";
  WriteFile(poorer, Replaced(ReadFile(file), R"("kinds":["Container"],)", ""));
  const Said none =
      Prehend({"episode", "resegment", poorer.string(), "--grammar", "containers", "--json"});
  EXPECT_TRUE(EventsNamed("contained_in", none).empty()) << none.out;
  EXPECT_NE(none.err.find("no entity of this episode is a 'Container'"), std::string::npos)
      << none.err;
}

TEST(Recording, AHandIsPartOfItsPerson) {
  const auto folder = FreshFolder("part_of");
  const auto file = (folder / "milk.jsonl").string(), rules = (folder / "hers.grammar").string();
  WriteFile(rules,
            "grammar hers\nuse grasp\n"
            "event she_holds(person: Person, object: Movable, hand: Hand)\n"
            "  while grasping(hand, object) and part_of(hand, person)\n"
            "event nobody_holds(person: Person, object: Movable, hand: Hand)\n"
            "  while grasping(hand, object) and not part_of(hand, person)\n");
  const Said played =
      Prehend({"run", "arm_follows_the_hand", "--grammar", rules, "--json", "--record", file});
  const auto hers = EventsNamed("she_holds", played), grasps = EventsNamed("grasping", played);
  ASSERT_EQ(hers.size(), 1u) << played.out;
  ASSERT_EQ(grasps.size(), 1u) << played.out;
  EXPECT_EQ(hers[0]["begin_tick"], grasps[0]["begin_tick"]);
  EXPECT_EQ(hers[0]["end_tick"], grasps[0]["end_tick"]);
  EXPECT_TRUE(EventsNamed("nobody_holds", played).empty()) << played.out;
  EXPECT_EQ(EventsNamed("she_holds",
                        Prehend({"episode", "resegment", file, "--grammar", rules, "--json"})),
            hers);

  // The same motion of a hand that belongs to nobody.
  const std::string alone = ReadFile(file);
  const std::size_t hand = alone.find(R"("right_hand":{)"),
                    part = alone.find(R"("part_of":"anna",)", hand);
  ASSERT_LT(part, alone.find('\n'));
  const auto nobodys = folder / "nobodys.jsonl";
  WriteFile(nobodys, alone.substr(0, part) +
                         alone.substr(part + std::string(R"("part_of":"anna",)").size()));
  const Said said =
      Prehend({"episode", "resegment", nobodys.string(), "--grammar", rules, "--json"});
  EXPECT_TRUE(EventsNamed("she_holds", said).empty()) << said.out;
  EXPECT_EQ(EventsNamed("nobody_holds", said).size(), 1u) << said.out;
}

TEST(Recording, WithoutItsLastLineItIsUnfinished) {
  const auto folder = FreshFolder("open_recording");
  const auto file = (folder / "whole.jsonl").string();
  ASSERT_EQ(Prehend({"run", "milk_carton_wrap", "--record", file}).exit_code, 0);
  const std::string whole = ReadFile(file);
  const auto cut = folder / "cut.jsonl";
  WriteFile(cut, whole.substr(0, whole.rfind("{\"end_tick\"")));
  EXPECT_NE(Prehend({"episode", "resegment", file}).out.find("\ncompleted: 5.1521 s, 2473 ticks\n"),
            std::string::npos);
  const Said open = Prehend({"episode", "resegment", cut.string()});
  EXPECT_NE(
      open.out.find("\nunfinished: 5.1521 s, 2473 ticks; the recording does not say that it ended "
                    "here\n"),
      std::string::npos)
      << open.out;
  EXPECT_NE(Prehend({"episode", "resegment", cut.string(), "--json"})
                .out.find("\"status\": \"unfinished\""),
            std::string::npos);
  // Cut within a line it has no end either, and is refused at the place of the cut.
  WriteFile(cut, whole.substr(0, whole.size() / 2));
  const Said refused = Prehend({"episode", "resegment", cut.string()});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("the line ends within a value"), std::string::npos) << refused.err;
}

TEST(Recording, ADashPrintsIt) {
  const auto file = (FreshFolder("printed_recording") / "rests.jsonl").string();
  ASSERT_EQ(Prehend({"run", "milk_carton_wrap", "--record", file}).exit_code, 0);
  const Said printed = Prehend({"run", "milk_carton_wrap", "--record", "-"});
  EXPECT_EQ(printed.exit_code, 0);
  EXPECT_EQ(printed.out, ReadFile(file));
  const Said both = Prehend({"run", "milk_carton_wrap", "--record", "-", "--json"});
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_EQ(both.out, "");
  EXPECT_EQ(both.err, "prehend: --record - contradicts --json: both would be printed\n");
}

TEST(Recording, ADeviceIsNotReplacedByAFile) {
  const Said said = Prehend({"run", "milk_carton_wrap", "--record", "/dev/full"});
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.out, "");
  EXPECT_EQ(said.err,
            "prehend: --record: cannot write /dev/full: it is a device or a pipe, wanted a file; "
            "standard output is written as '-'\n");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(Recording, TheDocumentedExampleIsRead) {
  std::ifstream document(std::string(PREHEND_SOURCE_DIR) + "/docs/recording-format.md");
  const std::string text{std::istreambuf_iterator<char>(document), {}};
  const std::string fence = "```json\n";
  const std::size_t begin = text.find(fence) + fence.size();
  const auto file = FreshFolder("recording") / "example.jsonl";
  for (const char* mark : {"", "\xEF\xBB\xBF"}) {  // of the byte order, as some editors write it
    WriteFile(file, mark + text.substr(begin, text.find("```", begin) - begin));
    const Said said = Prehend({"episode", "resegment", file.string(), "--json"});
    ASSERT_EQ(said.exit_code, 0) << said.err;
    EXPECT_EQ(nlohmann::json::parse(said.out)["events"].size(), 3) << said.out;
    EXPECT_EQ(Prehend({"grammar", "watch", file.string()}).exit_code, 0);
  }
}

TEST(Grammar, TheFirstDocumentedExampleRecognisesItsEvent) {
  std::ifstream document(std::string(PREHEND_SOURCE_DIR) + "/docs/grammar-tutorial.md");
  const std::string text{std::istreambuf_iterator<char>(document), {}};
  const std::size_t begin = text.find("```\n") + 4;
  const auto file = FreshFolder("grammar") / "carrying.grammar";
  WriteFile(file, text.substr(begin, text.find("```", begin) - begin));
  const Said said = Prehend({"run", "milk_carton_wrap", "--grammar", file.string()});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.out.find("carried"), std::string::npos) << said.out;
}

TEST(Recording, BadOnesEndWithExitCodeTwo) {
  const auto folder = FreshFolder("recording");
  WriteFile(folder / "bad.jsonl", "{\"recording\": 1}\n");
  for (const std::string& file :
       {(folder / "bad.jsonl").string(), (folder / "none.jsonl").string(), folder.string()}) {
    const Said said = Prehend({"episode", "resegment", file});
    EXPECT_EQ(said.exit_code, 2) << said.err;
    EXPECT_EQ(said.out, "");
    EXPECT_NE(said.err.find(file), std::string::npos) << said.err;
  }
  EXPECT_EQ(Prehend({"run", "milk_carton_wrap", "--record", "/dev/null/x.jsonl"}).exit_code, 2);
}

TEST(Score, ATruthfulGrammarScoresFullMarksAndAChangedOneLess) {
  const Said said = Prehend({"score", "milk_carton_wrap", "--grammar", "pick_and_place", "--json"});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  const auto total = nlohmann::json::parse(said.out)["grammars"][0]["total"];
  EXPECT_EQ(total["f1_50"], 1.0) << total;
  EXPECT_GT(total["true"], 8);
  EXPECT_EQ(Prehend({"score", "--grammar", "pick_and_plaice"}).exit_code, 2);
  EXPECT_EQ(Prehend({"score", "no_such_scenario", "--grammar", "pick_and_place"}).exit_code, 4);
}

}  // namespace
}  // namespace prehend::house
