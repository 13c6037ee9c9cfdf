// SPDX-License-Identifier: Apache-2.0
// From recordings and people's labels to a table, as docs/labels.md says.
#include <gtest/gtest.h>

#include <iomanip>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class Labelled : public testing::Test {
 protected:
  ~Labelled() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  /// The recording of docs/motion-capture.md.
  std::string Take(const std::string& name) const {
    const Said said = Prehend(
        {"import", docs_ + "/poses.csv", "--map", docs_ + "/bodies.yaml", "-o", Path(name)});
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return Path(name);
  }

  const std::string docs_ = PREHEND_SOURCE_DIR "/docs/motion_capture";
  const std::string map_ = docs_ + "/labels.yaml";
  const fs::path folder_ =
      FreshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(Labelled, ARecordingIsScored) {
  const std::string take = Take("milk.jsonl");
  const Said said = Prehend({"score", take, "--truth", docs_ + "/labels.csv", "--map", map_,
                             "--grammar", "pick_and_place_from_motion", "--json"});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  const auto json = nlohmann::json::parse(said.out);
  const auto& score = json["grammars"][0];
  EXPECT_EQ(score["episodes"], 1);
  EXPECT_TRUE(json.contains("by_hand"));
  const Said table = Prehend({"score", take, "--truth", docs_ + "/labels.csv", "--map", map_,
                              "--grammar", "pick_and_place_from_motion"});
  EXPECT_TRUE(Has(table.out, "all              5      5  5")) << table.out;
  EXPECT_TRUE(Has(table.out, "no label means them")) << table.out;
}

TEST_F(Labelled, TheGrammarOfTheRecordingIsScoredUnlessAnotherIsNamed) {
  const std::string take = Take("milk.jsonl");
  const std::vector<std::string> truth = {"--truth", docs_ + "/labels.csv", "--map", map_};
  const auto run = [&](std::vector<std::string> words) {
    words.insert(words.end(), truth.begin(), truth.end());
    return Prehend(words);
  };
  const Said scored = run({"score", take});
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  EXPECT_TRUE(Has(scored.out, "pick_and_place_from_motion, 1 episode")) << scored.out;
  EXPECT_TRUE(Has(scored.out, "all              5      5  5")) << scored.out;
  EXPECT_FALSE(Has(scored.out, "original_2020")) << scored.out;
  const Said swept =
      run({"grammar", "sweep", take, "--over", "hold_way=3mm..4mm:2", "--collar-ms", "1000"});
  EXPECT_EQ(swept.exit_code, 0) << swept.err;
  EXPECT_EQ(Prehend({"import", take, "-o", Path("milk.episodes")}).exit_code, 0);
  EXPECT_TRUE(Has(run({"score", Path("milk.episodes")}).out, "all              5      5  5"));

  std::string text = ReadFile(take);
  const std::string own = "\"grammar\":\"pick_and_place_from_motion\"";
  ASSERT_TRUE(Has(text, own)) << text.substr(0, 400);
  WriteFile(Path("other.jsonl"),
            text.replace(text.find(own), own.size(), "\"grammar\":\"contact\""));
  WriteFile(folder_ / "labels/milk.csv", ReadFile(docs_ + "/labels.csv"));
  WriteFile(folder_ / "labels/other.csv", ReadFile(docs_ + "/labels.csv"));
  const Said two =
      Prehend({"score", take, Path("other.jsonl"), "--truth", Path("labels"), "--map", map_});
  EXPECT_EQ(two.exit_code, 2);
  EXPECT_TRUE(Has(two.err,
                  "other: error: it names the grammar contact, and milk the grammar "
                  "pick_and_place_from_motion\n  hint: one of them for all: --grammar contact"))
      << two.err;
  fs::copy_file(take, Path("third.jsonl"));
  const Said most = run({"grammar", "sweep", take, Path("other.jsonl"), Path("third.jsonl"),
                         "--over", "hold_way=3mm..4mm:2"});
  EXPECT_EQ(most.exit_code, 2);
  EXPECT_TRUE(Has(most.err, "hint: one of them for all: --grammar pick_and_place_from_motion"))
      << most.err;
}

/// Three actions of two hands: the second one begins and ends in the first and third of the other.
void WriteTwoHands(const std::string& file) {
  const std::string size = R"("size_m": [0.1, 0.1, 0.1]})";
  std::string text = R"({"recording": 1, "episode": "e", "ticks_per_second": 10, "entities": {)";
  for (const char* hand : {"h1", "h2"})
    text += "\"" + std::string(hand) + R"(": {"hand": true, )" + size + ", ";
  text += R"("a": {"class": "A", )" + size + R"(, "b": {"class": "B", )" + size + "}}\n";
  const auto touch = [](const char* hand, const char* thing, bool on) {
    return on ? R"({"a": ")" + std::string(hand) + R"(", "b": ")" + thing + R"("},)"
              : std::string();
  };
  for (int tick = 0; tick < 60; ++tick) {
    std::string touches = touch("h1", "a", tick < 20) + touch("h2", "a", tick >= 10 && tick < 50) +
                          touch("h1", "b", tick >= 30);
    if (!touches.empty()) touches.pop_back();
    text += R"({"tick": )" + std::to_string(tick) + R"(, "touches": [)" + touches + "]}\n";
  }
  WriteFile(file, text + "{\"end_tick\": 60}\n");
}

TEST_F(Labelled, AHandIsKnownByTheClassOfItsRole) {
  WriteTwoHands(Path("take.jsonl"));
  WriteFile(Path("truth.csv"),
            "begin_s,end_s,label\n0,2,\"p(h1, a)\"\n1,5,\"p(h2, a)\"\n2,6,\"q(h1, b)\"\n");
  const auto all_of = [&](const std::string& role) {
    const std::string rules =
        "grammar g\nevent p({0}: Hand, a: A) while touching({0}, a)\n"
        "event q({0}: Hand, b: B) while touching({0}, b)\n";
    WriteFile(Path("g.grammar"), std::regex_replace(rules, std::regex("\\{0\\}"), role));
    const Said scored = Prehend({"score", Path("take.jsonl"), "--truth", Path("truth.csv"),
                                 "--grammar", Path("g.grammar")});
    EXPECT_TRUE(Has(scored.out, "\nEach hand for itself:\n")) << scored.out << scored.err;
    EXPECT_TRUE(Has(scored.out, "\nq of h1     1      1")) << scored.out;
    EXPECT_EQ(Prehend({"episode", "resegment", Path("take.jsonl"), "--grammar", Path("g.grammar"),
                       "-o", Path("found.csv")})
                  .exit_code,
              0);
    return scored.out + ReadFile(Path("found.csv"));
  };
  const std::string named = all_of("hand");
  EXPECT_EQ(all_of("h"), named);
  EXPECT_TRUE(Has(named,
                  "0.0000,2.0000,\"p(h1, a)\",p of h1\n1.0000,5.0000,\"p(h2, a)\",p of h2\n"
                  "3.0000,6.0000,\"q(h1, b)\",q of h1\n"))
      << named;
}

TEST_F(Labelled, TakesOfAFolderAreSummed) {
  const std::string one = Take("one.jsonl"), two = Take("two.jsonl");
  for (const char* name : {"one.csv", "two.csv"})
    WriteFile(folder_ / "labels" / name, ReadFile(docs_ + "/labels.csv"));
  const Said both = Prehend({"score", one, two, "--truth", Path("labels"), "--map", map_,
                             "--grammar", "pick_and_place_from_motion"});
  EXPECT_TRUE(Has(both.out, "2 episodes")) << both.out << both.err;
  EXPECT_TRUE(Has(both.out, "all             10     10  10")) << both.out;
  fs::remove(folder_ / "labels/two.csv");
  const Said missing = Prehend({"score", one, two, "--truth", Path("labels"), "--map", map_});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_TRUE(Has(missing.err, "has no labels of 'two'")) << missing.err;
}

TEST_F(Labelled, WhatIsWrittenIsReadAgain) {
  const std::string take = Take("milk.jsonl");
  for (const char* ending : {"csv", "eaf", "TextGrid"}) {
    const std::string file = Path(std::string("out.") + ending);
    EXPECT_EQ(Prehend({"episode", "resegment", take, "-o", file}).exit_code, 0);
    const Said said = Prehend(
        {"score", take, "--truth", file, "--grammar", "pick_and_place_from_motion", "--json"});
    ASSERT_EQ(said.exit_code, 0) << said.err;
    const auto total = nlohmann::json::parse(said.out)["grammars"][0]["total"];
    EXPECT_EQ(total["f1_50"], 1.0) << ending << total;
  }
  const Said some = Prehend({"episode", "resegment", take, "-o", Path("some.csv"), "--event",
                             "grasping", "--event", "reaching"});
  EXPECT_TRUE(Has(some.out, ": 2 labels")) << some.out << some.err;
  EXPECT_FALSE(Has(ReadFile(Path("some.csv")), "putting_down"));
  const Said unknown =
      Prehend({"episode", "resegment", take, "-o", Path("some.csv"), "--event", "graspin"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_TRUE(Has(unknown.err,
                  "--event: grammar 'pick_and_place_from_motion' has no event "
                  "'graspin'; did you mean 'grasping'?"))
      << unknown.err;
  EXPECT_EQ(Prehend({"episode", "resegment", take, "--event", "grasping"}).exit_code, 2);
  const Said other = Prehend({"episode", "resegment", take, "-o", Path("out.txt")});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_TRUE(Has(other.err, "wanted a file .csv, .eaf or .TextGrid")) << other.err;
  EXPECT_FALSE(fs::exists(Path("out.txt")));
}

TEST_F(Labelled, ARunIsWrittenByItsOwnGrammar) {
  ASSERT_EQ(Prehend({"run", "milk_carton_wrap", "--record", Path("milk.episodes")}).exit_code, 0);
  const Said said =
      Prehend({"episode", "resegment", Path("milk.episodes"), "-o", Path("milk.csv")});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_TRUE(Has(ReadFile(Path("milk.csv")), "picking_up")) << ReadFile(Path("milk.csv"));
}

TEST_F(Labelled, EpisodesAndScenariosOfASuiteTakeLabelsToo) {
  const std::string file = Path("a.episodes");
  for (const char* scenario : {"pick_and_place/milk_carton_wrap", "slide/hop_divides_a_slide"})
    ASSERT_EQ(Prehend({"run", scenario, "--record", file}).exit_code, 0);
  const Said swept = Prehend({"grammar", "sweep", file, "--over", "reach_radius=10cm..30cm:2",
                              "--truth", PREHEND_SOURCE_DIR "/golden"});
  ASSERT_EQ(swept.exit_code, 0) << swept.err;
  EXPECT_TRUE(
      Has(swept.out, "pick_and_place: 2 settings on 2 episodes; the best F1 is 100.00 %\nF1@50: "))
      << swept.out;
  const Said of_lines =
      Prehend({"grammar", "sweep", Take("a.jsonl"), "--over", "reach_radius=1cm..3cm:2"});
  EXPECT_EQ(of_lines.exit_code, 2);
  EXPECT_TRUE(Has(of_lines.err, "labels by people, or its golden: --truth")) << of_lines.err;
}

TEST_F(Labelled, WhatASweepWouldDropInSilenceIsRefused) {
  const Said said = Prehend({"grammar", "sweep", Take("a.jsonl"), "--over",
                             "reach_radius=1cm..3cm:2", "--set", "reach_radius=2cm"});
  EXPECT_EQ(said.exit_code, 2) << said.out;
  EXPECT_TRUE(Has(said.err, "--over: reach_radius is given by --set, too")) << said.err;
}

TEST_F(Labelled, MarginsNameWhatIsAtAnEdge) {
  const Said said = Prehend(
      {"grammar", "margins", Take("milk.jsonl"), "--truth", docs_ + "/labels.csv", "--map", map_,
       "--grammar", "pick_and_place_from_motion", "--collar-ms", "200", "-o", Path("margins.csv")});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_TRUE(Has(said.out, "touch_back")) << said.out;
  EXPECT_TRUE(Has(said.out, "warning: not among the best")) << said.out;
  EXPECT_TRUE(Has(said.out, "without any effect on the scores: ")) << said.out;
  EXPECT_TRUE(ReadFile(Path("margins.csv")).starts_with("parameter,value,f1,from,to"));
}

TEST_F(Labelled, MarginsOfSomeParametersOnly) {
  const auto margins = [&](const std::string& only) {
    return Prehend({"grammar", "margins", Take("milk.jsonl"), "--truth", docs_ + "/labels.csv",
                    "--map", map_, "--over", "hold_way", "--over", only, "-o",
                    Path("margins.csv")});
  };
  ASSERT_EQ(margins("touch_back").exit_code, 0);
  std::istringstream lines(ReadFile(Path("margins.csv")));
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);)
    names.push_back(line.substr(0, line.find(',')));
  std::ranges::sort(names);
  EXPECT_EQ(names, (std::vector<std::string>{"hold_way", "parameter", "touch_back"}));
  const Said unknown = margins("hold_wey");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_TRUE(Has(unknown.err,
                  "--over: error: the grammar has no parameter 'hold_wey'\n  hint: did you "
                  "mean 'hold_way'?"))
      << unknown.err;
}

// One recording is right where the other one is wrong: every setting has the same F1.
TEST_F(Labelled, WhatOneRecordingGainsAndAnotherLosesIsAnEffect) {
  WriteFile(Path("g.grammar"),
            "grammar g\nparam reach = 10 cm\n"
            "event near(hand: Hand, cup: Cup) while distance(hand, cup) < reach\n");
  std::vector<std::string> call = {"grammar", "margins"};
  for (const std::string take : {"a", "b"}) {
    std::string text = R"({"recording": 1, "episode": ")" + take +
                       R"(", "ticks_per_second": 1000, "entities": {"cup": {"class": "Cup", )"
                       R"("size_m": [0, 0, 0]}, "hand": {"hand": true, "size_m": [0, 0, 0]}}})";
    for (int i = 0; i < 50; ++i)
      text += "\n{\"tick\": " + std::to_string(100 * i) +
              R"(, "samples": {"cup": {"at_m": [0, 0, 1]}, "hand": {"at_m": [)" +
              (i >= 20 && i < 30 ? "0.005" : "0.3") + ", 0, 1]}}}";
    WriteFile(Path(take + ".jsonl"), text + "\n{\"end_tick\": 5000}\n");
    fs::create_directories(Path("labels"));
    WriteFile(Path("labels/" + take + ".csv"),
              std::string("begin_s,end_s,label\n") + (take == "a" ? "2,3,near\n" : "0,5,near\n"));
    call.push_back(Path(take + ".jsonl"));
  }
  call.insert(call.end(), {"--truth", Path("labels"), "--grammar", Path("g.grammar")});
  const Said said = Prehend(call);
  EXPECT_TRUE(Has(said.out, "reach      0.1 m  50.0  <= 0.0125 m  >= 0.8 m  50.0  0.1 m"))
      << said.out << said.err;
  EXPECT_FALSE(Has(said.out, "without any effect")) << said.out;
}

// More than two seconds, on any machine: 241 settings.
TEST_F(Labelled, ALongSweepSaysHowLongItTakes) {
  const Said said =
      Prehend({"grammar", "sweep", Take("milk.jsonl"), "--truth", docs_ + "/labels.csv", "--map",
               map_, "--over", "hold_way=1mm..9mm:241", "-o", Path("sweep.csv")});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_TRUE(said.err.empty() || said.err.starts_with("prehend: 241 settings on 1 recording, "
                                                       "about "))
      << said.err;
}

TEST_F(Labelled, DifferencesAreListed) {
  const std::string take = Take("milk.jsonl");
  const auto score = [&](const std::string& labels) {
    WriteFile(folder_ / "a.csv", labels);
    return Prehend({"score", take, "--truth", Path("a.csv"), "--map", map_, "--collar-ms", "200",
                    "--verbose"});
  };
  const std::string head = "begin_s,end_s,label,tier\n";
  const Said said = score(head + "0.1,0.7,reach,right\n1.5,1.7,lift,right\n4.5,4.6,lift,right\n");
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_TRUE(Has(said.out, "\npick_and_place_from_motion, against the labels:\nmilk:\n"))
      << said.out;
  EXPECT_TRUE(Has(said.out, "missing  picking_up(right_hand, milk)    true 4.50000..4.60000 s\n"))
      << said.out;
  EXPECT_TRUE(Has(said.out, "extra    grasping(right_hand, milk)      found 1.47910.."))
      << said.out;
  EXPECT_FALSE(Has(said.out, "off ")) << said.out;
  const Said agrees = Prehend({"score", take, "--truth", docs_ + "/labels.csv", "--map", map_,
                               "--collar-ms", "1000", "--verbose"});
  EXPECT_TRUE(Has(agrees.out, "against the labels:\nno differences")) << agrees.out;
}

TEST_F(Labelled, AnotherClockIsAWarning) {
  const std::string take = Take("milk.jsonl");
  WriteFile(folder_ / "a.csv",
            "begin_s,end_s,label,tier\n1.6,2.5,reach,right\n3.0,3.2,lift,right\n"
            "3.2,4.8,carry,right\n4.8,4.9,put down,right\n");
  const Said said = Prehend({"score", take, "--truth", Path("a.csv"), "--map", map_});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_TRUE(Has(said.err, "of 4 labels 0 are found, and 4 if all of them were moved by -1.50 s"))
      << said.err;
  EXPECT_TRUE(Has(said.err, "hint: offset_s: -1.50 in the map")) << said.err;
  // Labels of the right clock, moved by the map: 0.6 and -0.6 are none, and no minus.
  WriteFile(folder_ / "b.csv",
            "begin_s,end_s,label,tier\n0.1,1.0,reach,right\n1.5,1.7,lift,right\n"
            "1.7,3.3,carry,right\n3.3,3.4,put down,right\n");
  WriteFile(folder_ / "moved.yaml", "offset_s: 0.6\n" + ReadFile(map_));
  const Said moved =
      Prehend({"score", take, "--truth", Path("b.csv"), "--map", Path("moved.yaml")});
  EXPECT_TRUE(Has(moved.err, "hint: offset_s: 0.00 in the map")) << moved.err;
}

// Begins and ends by people are a few tenths of a second off, so a collar of 50 ms finds nothing.
TEST_F(Labelled, ASweepMeasuresLabelsAsScoreDoes) {
  const std::string take = Take("milk.jsonl");
  WriteFile(folder_ / "a.csv",
            "begin_s,end_s,label,tier\n1.65,4.3,hold,right\n1.9,3.1,carry,right\n");
  const auto sweep = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"grammar", "sweep",          take,
                                      "--truth", Path("a.csv"),    "--map",
                                      map_,      "--over",         "hold_way=3mm..4mm:2",
                                      "-o",      Path("sweep.csv")};
    words.insert(words.end(), more.begin(), more.end());
    return Prehend(words);
  };
  // Two are right; reach, lift and put-down have labels in the map, and nobody marked them.
  const Said by_overlap = sweep({});
  EXPECT_TRUE(by_overlap.out.starts_with(
      "pick_and_place_from_motion: 2 settings on 1 episode; the best F1 is 57.14 %\n"
      "F1@50: an event is right if it and its label have half of their union in common; "
      "--collar-ms asks for both boundaries instead\n"))
      << by_overlap.out << by_overlap.err;
  const Said by_collar = sweep({"--collar-ms", "50"});
  EXPECT_EQ(by_collar.exit_code, 0);
  EXPECT_EQ(by_collar.out,
            "pick_and_place_from_motion: 2 settings on 1 episode; every one scores 0: no event is "
            "right with any of them, so none is the best\n"
            "F1: an event is right if both boundaries are within 50 ms\n"
            "counted: 2 labels of 1 take\n");
  const Said svg = sweep({"--collar-ms", "50", "-o", Path("sweep.svg")});
  EXPECT_EQ(svg.exit_code, 0) << svg.err;
  EXPECT_FALSE(Has(ReadFile(Path("sweep.svg")), "#d00"));
  EXPECT_TRUE(Has(ReadFile(Path("sweep.svg")), "every setting scores 0"));
}

TEST_F(Labelled, ASweepTellsErrorsWithTheirSignAsScoreDoes) {
  const std::string take = Take("milk.jsonl");
  // Of an even number of begins, and of ends, that are found too early or too late.
  WriteFile(folder_ / "a.csv",
            "begin_s,end_s,label,tier\n1.75,4.2,hold,right\n2.0,3.3,carry,right\n");
  const std::vector<std::string> truth = {"--truth", Path("a.csv"), "--map", map_};
  const auto run = [&](std::vector<std::string> words) {
    words.insert(words.end(), truth.begin(), truth.end());
    const Said said = Prehend(words);
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return said.out;
  };
  const auto score = nlohmann::json::parse(
      run({"score", take, "--set", "hold_way=3 mm", "--json"}))["grammars"][0]["total"];
  const double begin_ms = 1000 * score["begin_s"]["median"].get<double>(),
               end_ms = 1000 * score["end_s"]["median"].get<double>();
  EXPECT_LT(begin_ms, 0);
  const std::string swept =
      run({"grammar", "sweep", take, "--over", "hold_way=3mm..4mm:2", "-o", Path("sweep.csv")});
  std::istringstream rows(ReadFile(Path("sweep.csv")));
  std::string row;
  std::getline(rows, row);
  EXPECT_EQ(row, "hold_way,f1,correct,extra,missed,begin_error_ms,end_error_ms,latency_ms");
  std::getline(rows, row);
  std::ostringstream errors, said;
  errors << std::fixed << std::setprecision(3) << "," << begin_ms << "," << end_ms << ",";
  EXPECT_TRUE(Has(row, errors.str())) << row << errors.str();
  said << std::fixed << std::setprecision(1) << std::showpos << "begin " << begin_ms << " ms, end "
       << end_ms << " ms, ";
  EXPECT_TRUE(Has(swept, said.str())) << swept << said.str();
}

TEST_F(Labelled, ScoreSetsParameters) {
  const std::string take = Take("milk.jsonl");
  const std::vector<std::string> words = {"score", take, "--truth", docs_ + "/labels.csv",
                                          "--map", map_};
  const auto score = [&](const std::string& setting) {
    std::vector<std::string> all = words;
    all.insert(all.end(), {"--set", setting});
    return Prehend(all);
  };
  EXPECT_TRUE(Has(score("hold_way=4mm").out, "all              5      5  5"));
  const Said never = score("hold_shortest=9s");
  EXPECT_TRUE(Has(never.out, "all              5      0  .")) << never.out << never.err;
  const Said unknown = score("hold_mooves=9m/s");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_TRUE(Has(unknown.err, "did you mean 'hold_moves'?")) << unknown.err;
}

TEST_F(Labelled, LabelsThatEndBeforeTheyBeginAreNamedTogetherOrLeftOut) {
  const std::string one = Take("one.jsonl"), two = Take("two.jsonl");
  const std::string good = ReadFile(docs_ + "/labels.csv");
  std::string bad;
  for (int i = 0; i < 3; ++i) bad += "2.5,1.5,lift,right\n";
  WriteFile(folder_ / "labels/one.csv", good + bad);
  WriteFile(folder_ / "labels/two.csv", good + bad);
  const std::vector<std::string> words = {"score",        one,     two, "--truth",
                                          Path("labels"), "--map", map_};
  const Said refused = Prehend(words);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.out, "");
  std::size_t named = 0;
  for (std::size_t at = 0; (at = refused.err.find("'lift' ends before it begins: 2.5 s to 1.5 s",
                                                  at)) != std::string::npos;
       ++at)
    ++named;
  EXPECT_EQ(named, 6u) << refused.err;
  EXPECT_TRUE(Has(refused.err, "hint: --skip-bad-labels leaves out what ends before it begins"))
      << refused.err;
  auto skipping = words;
  skipping.push_back("--skip-bad-labels");
  const Said skipped = Prehend(skipping);
  EXPECT_EQ(skipped.exit_code, 0) << skipped.err;
  EXPECT_TRUE(Has(skipped.err, "warning: 6 labels end before they begin, and are left out: 3 of "))
      << skipped.err;
  EXPECT_TRUE(Has(skipped.out, "all             10     10  10")) << skipped.out;
  const Said swept = Prehend({"grammar", "sweep", one, "--truth", Path("labels/one.csv"), "--map",
                              map_, "--over", "hold_way=3mm..4mm:2", "--skip-bad-labels"});
  EXPECT_EQ(swept.exit_code, 0) << swept.err;
  EXPECT_TRUE(Has(swept.err, "warning: 3 labels end before they begin")) << swept.err;
}

TEST_F(Labelled, OptionsOfLabelsNeedLabels) {
  EXPECT_EQ(Prehend({"score", "--skip-bad-labels"}).exit_code, 2);
  EXPECT_EQ(Prehend({"score", "--map", map_}).exit_code, 2);
  EXPECT_EQ(Prehend({"score", "--truth", docs_ + "/labels.csv"}).exit_code, 2);
  EXPECT_EQ(
      Prehend({"score", Take("a.jsonl"), "--truth", docs_ + "/labels.csv", "--event", "grasping"})
          .exit_code,
      2);
  const Said unknown = Prehend(
      {"grammar", "sweep", "a.episodes", "--over", "reach_radius=1cm..3cm:2", "--truth", "gold"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_TRUE(Has(unknown.err, "found 'gold', wanted golden, oracle or recorded")) << unknown.err;
}

}  // namespace
}  // namespace prehend::house
