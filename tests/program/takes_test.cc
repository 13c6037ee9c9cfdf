// SPDX-License-Identifier: Apache-2.0
// Which data count: tables of labels of several takes, files of takes, labels of a moment; and what
// is said of what does not count.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGrammar =
    "grammar near\nparam close = 10 cm\nevent near(hand: Hand, cup: Thing) while distance(hand, "
    "cup) < close\n";

class Takes : public testing::Test {
 protected:
  Takes() {
    WriteFile(folder_ / "prehend.yaml", "# a project\n");
    WriteFile(folder_ / "grammars/near.grammar", kGrammar);
  }
  ~Takes() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  std::string Write(const std::string& name, const std::string& text) const {
    WriteFile(folder_ / name, text);
    return Path(name);
  }
  /// 5 s in which a hand is near a cup from each begin to each end.
  std::string Recording(const std::string& name,
                        const std::vector<std::pair<double, double>>& near) const {
    std::string text =
        R"({"recording": 1, "episode": "e", "grammar": "near", "ticks_per_second": 100, "entities": {"cup": {"size_m": [0.1, 0.1, 0.1]}, "hand": {"hand": true, "size_m": [0, 0, 0]}}})"
        "\n";
    for (int tick = 0; tick < 500; ++tick) {
      bool is_near = false;
      for (const auto& [begin, end] : near)
        is_near |= tick >= 100 * begin - 1e-6 && tick < 100 * end - 1e-6;
      text += R"({"tick": )" + std::to_string(tick) +
              R"(, "samples": {"cup": {"at_m": [0, 0, 0]}, "hand": {"at_m": [0, 0, )" +
              (is_near ? "0.07" : "0.6") + "]}}}\n";
    }
    return Write(name + ".jsonl", text + "{\"end_tick\": 500}\n");
  }
  Said Do(const std::vector<std::string>& words) const {
    return Prehend(words, {"PREHEND_HOME=" + folder_.string()});
  }
  Said Score(std::vector<std::string> words) const {
    words.insert(words.begin(), "score");
    return Do(words);
  }
  nlohmann::json Json(std::vector<std::string> words) const {
    words.emplace_back("--json");
    const Said said = Score(words);
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return said.exit_code == 0 ? nlohmann::json::parse(said.out) : nlohmann::json();
  }
  static std::string Has(const std::string& text, const std::string& part) {
    return text.find(part) == std::string::npos ? text : "";
  }

  const fs::path folder_ =
      FreshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
  const std::string map_ = Write("map.yaml", "labels: {near: {event: near}}\n");
};

constexpr const char* kTable =
    "video,begin_s,end_s,label\nP1,1,2,near\nP2,0.5,1.5,near\nP2,3,4,near\nP3,0,4.9,near\n";

TEST_F(Takes, OneTableOfManyRecordings) {
  const std::string one = Recording("P1", {{1, 2}}), two = Recording("P2", {{0.5, 1.5}, {3, 4}}),
                    table = Write("all.csv", kTable),
                    by_take =
                        Write("by.yaml", "columns: {take: video}\nlabels: {near: {event: near}}\n");
  const auto both = Json({one, two, "--truth", table, "--map", by_take});
  EXPECT_EQ(both["grammars"][0]["total"]["true"], 3);
  EXPECT_EQ(both["grammars"][0]["total"]["f1_50"], 1);
  EXPECT_EQ(both["counted"]["takes"], 2);
  EXPECT_EQ(both["counted"]["left_out"]["of_other_takes"]["P3"], 1);
  const Said text = Score({one, "--truth", table, "--map", by_take});
  EXPECT_EQ(Has(text.out, "counted: 1 label of 1 take\nleft out: 3 rows of other takes (P2, P3)\n"),
            "");
  // Nothing says which rows: an error that names the column, for one recording and for two.
  for (const std::vector<std::string>& recordings : {std::vector{one}, std::vector{one, two}}) {
    std::vector<std::string> words = recordings;
    words.insert(words.end(), {"--truth", table, "--map", map_});
    const Said said = Score(words);
    EXPECT_EQ(said.exit_code, 2);
    EXPECT_EQ(Has(said.err, "columns: {take: "), "");
  }
  EXPECT_EQ(Has(Score({one, "--truth", table, "--map", map_}).err,
                "all.csv:1:1: error: the column 'video' has several values, and nothing says which "
                "rows are of 'P1'"),
            "");
  // Somebody who knows that it does not matter.
  const std::string ignored =
      Write("ignore.yaml", "columns: {take: ignore}\nlabels: {near: {event: near}}\n");
  EXPECT_EQ(Json({one, "--truth", table, "--map", ignored})["counted"]["labels"], 4);
  // A recording that the table does not have.
  const std::string other = Recording("P11", {{1, 2}});
  const Said none = Score({other, "--truth", table, "--map", by_take});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_EQ(Has(none.err, "no row has 'P11' in the column 'video'\n  hint: it has 'P1'; rows: "),
            "");
}

// Globs overlap, and takes of several folders have one name.
TEST_F(Takes, NothingCountsTwice) {
  const std::string one = Recording("a/take", {{1, 2}}), other = Recording("b/take", {{3, 4}}),
                    same = (folder_ / "a" / ".." / "a" / "take.jsonl").string();
  Write("lab/take.csv", "begin_s,end_s,label\n1,2,near\n");
  const auto scores = Json({one, same, one, "--truth", Path("lab"), "--map", map_});
  EXPECT_EQ(scores["counted"]["takes"], 1);
  EXPECT_EQ(scores["counted"]["labels"], 1);
  EXPECT_EQ(scores["grammars"][0]["total"]["true"], 1);
  const std::string takes =
      Write("takes.yaml",
            "map: map.yaml\ntakes:\n  - {recording: a/take.jsonl, labels: "
            "lab/take.csv}\n  - {recording: ./a/take.jsonl, labels: lab/take.csv}\n");
  EXPECT_EQ(Json({takes})["counted"]["takes"], 1);

  const Said said = Score({one, other, "--truth", Path("lab"), "--map", map_});
  EXPECT_EQ(said.exit_code, 2) << said.out;
  EXPECT_EQ(Has(said.err, "the same labels of " + Path("lab/take.csv") + " would count for " + one +
                              " and for " + other + ", both called 'take'"),
            "")
      << said.err;
  const std::string named =
      Write("named.yaml",
            "map: map.yaml\ntakes:\n  - {recording: a/take.jsonl, labels: "
            "lab/take.csv}\n  - {recording: b/take.jsonl, labels: lab/b.csv}\n");
  Write("lab/b.csv", "begin_s,end_s,label\n3,4,near\n");
  EXPECT_EQ(Json({named})["grammars"][0]["total"]["f1_50"], 1);
}

TEST_F(Takes, WhereNothingHappensFalseAlarmsCount) {
  const std::string take = Recording("a", {{1, 2}, {3, 4}}),
                    nothing = Write("nothing.csv", "begin_s,end_s,label\n");
  for (const std::vector<std::string>& meaning : {std::vector<std::string>{}, {"--map", map_}}) {
    std::vector<std::string> words = {take, "--truth", nothing};
    words.insert(words.end(), meaning.begin(), meaning.end());
    const auto total = Json(words)["grammars"][0]["total"];
    EXPECT_EQ(total["true"], 0);
    EXPECT_EQ(total["found"], 2);
    EXPECT_EQ(total["ward"]["inserted"], 2);
    EXPECT_EQ(total["f1_50"], 0);
  }
  EXPECT_EQ(Has(Score({take, "--truth", nothing, "--verbose"}).out, "extra    near(hand, cup)"),
            "");
  // Beside others it says nothing of what these do not name.
  const std::string other = Recording("b", {{1, 2}}),
                    marked = Write("b.csv", "begin_s,end_s,label\n1,2,near\n");
  EXPECT_EQ(
      Json({take, other, "--truth", nothing, "--truth", marked})["grammars"][0]["total"]["f1_50"],
      0.5);
  // In a table of all a row with nothing but a name says it; without one it was forgotten.
  const std::string by_take =
      Write("by.yaml", "columns: {take: video}\nlabels: {near: {event: near}}\n");
  const auto table = [&](const std::string& more) {
    return Write("all.csv", "video,begin_s,end_s,label\nb,1,2,near\n" + more);
  };
  EXPECT_EQ(Json({take, other, "--truth", table("a,,,\n"), "--map",
                  by_take})["grammars"][0]["total"]["ward"]["inserted"],
            2);
  const Said forgotten = Score({take, other, "--truth", table(""), "--map", by_take});
  EXPECT_EQ(forgotten.exit_code, 2);
  EXPECT_EQ(Has(forgotten.err, "no row has 'a' in the column 'video'"), "");
  // A file that says nothing at all is no answer.
  const Said empty = Score({take, "--truth", Write("empty.csv", "")});
  EXPECT_EQ(empty.exit_code, 2);
  EXPECT_EQ(Has(empty.err, "empty.csv: error: the file is empty"), "");
}

TEST_F(Takes, ASweepSeesTheBetterParameterInATableOfAll) {
  const std::string one = Recording("P1", {{1, 2}}), table = Write("all.csv", kTable),
                    by_take =
                        Write("by.yaml", "columns: {take: video}\nlabels: {near: {event: near}}\n");
  const auto sweep = [&](const std::string& map) {
    return Do({"grammar", "sweep", one, "--truth", table, "--map", map, "--over",
               "close=5cm..10cm:2", "-o", Path("s.csv")});
  };
  const Said said = sweep(by_take);
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(Has(said.out, "near: 2 settings on 1 episode; the best F1 is 100.00 %"), "");
  EXPECT_EQ(Has(said.out, "left out: 3 rows of other takes (P2, P3)"), "");
  EXPECT_EQ(Has(ReadFile(Path("s.csv")), "5 cm,0.000000,0,0,1"), "");
  EXPECT_EQ(sweep(map_).exit_code, 2);
  const Said margins = Do({"grammar", "margins", one, "--truth", table, "--map", by_take});
  EXPECT_EQ(Has(margins.out, "counted: 1 label of 1 take\n"), "");
}

TEST_F(Takes, AFileSaysWhatIsKnownOfEach) {
  Recording("a", {{1, 2}});
  Recording("b", {{0.5, 1.5}, {3, 4}});
  Recording("c", {{2, 3}});
  Write("all.csv", kTable);
  Write("c.csv", "begin_s,end_s,label\n1.5,2.5,near\n");
  const std::string takes = Write("takes.yaml", R"(map: map.yaml
labels: all.csv
takes:
  - {recording: a.jsonl, rows: {video: P1}, person: anna, set: tune}
  - {recording: b.jsonl, rows: {video: P2}, person: ben, set: tune}
  - {recording: c.jsonl, labels: c.csv, offset_s: 0.5, person: anna, set: test}
)");
  const auto json = Json({takes});
  ASSERT_EQ(json["grammars"].size(), 2u);
  EXPECT_EQ(json["grammars"][0]["set"], "tune");
  EXPECT_EQ(json["grammars"][0]["total"]["true"], 3);
  EXPECT_EQ(json["grammars"][1]["set"], "test");
  for (const auto& set : json["grammars"]) EXPECT_EQ(set["total"]["collar_f"], 1) << set;
  EXPECT_EQ(json["grammars"][0]["rows"][1]["person"], "ben");
  EXPECT_EQ(json["grammars"][0]["rows"][1]["hits_50_of"]["near"]["correct"], 2);
  EXPECT_EQ(json["counted"]["takes"], 3);
  EXPECT_EQ(Has(Score({takes}).out, "near, set tune, 2 episodes\n"), "");
  // Nothing is tuned on what is for tests; that is said.
  const Said swept = Do({"grammar", "sweep", takes, "--over", "close=5cm..10cm:2"});
  EXPECT_EQ(swept.exit_code, 0) << swept.err;
  EXPECT_EQ(swept.err, "prehend: left out: 1 take of the set test\n");
  EXPECT_EQ(Has(swept.out, "near: 2 settings on 2 episodes; the best F1 is 100.00 %"), "");
  EXPECT_EQ(Has(Do({"grammar", "margins", takes}).out, "counted: 3 labels of 2 takes\n"), "");
  // Other commands take the recordings; a folder has them, too.
  EXPECT_EQ(Has(Do({"episode", "resegment", takes}).out, "near"), "");
  EXPECT_EQ(Has(Do({"check", takes}).out, "3 "), "");
  EXPECT_EQ(Json({folder_.string()})["counted"]["takes"], 3);
}

TEST_F(Takes, EachHasTheGrammarThatTheFileNames) {
  Recording("a", {{1, 2}});
  Recording("b", {{1, 2}});
  Write("grammars/far.grammar",
        Replaced(Replaced(kGrammar, "grammar near", "grammar far"), "10 cm", "1 cm"));
  const std::string labels = Write("l.csv", "begin_s,end_s,label\n1,2,near\n");
  const std::string takes = Write("takes.yaml", R"(labels: l.csv
map: map.yaml
takes:
  - recording: a.jsonl
  - {recording: b.jsonl, grammar: grammars/far.grammar}
)");
  const auto json = Json({takes});
  ASSERT_EQ(json["grammars"].size(), 2u);
  EXPECT_EQ(json["grammars"][0]["grammar"], "near");
  EXPECT_EQ(json["grammars"][0]["total"]["found"], 1);
  EXPECT_EQ(json["grammars"][1]["total"]["found"], 0);
  const Said swept = Do({"grammar", "sweep", takes, "--over", "close=5cm..10cm:2"});
  EXPECT_EQ(swept.exit_code, 2);
  EXPECT_EQ(Has(swept.err, "it names the grammar far, and a the grammar near"), "");
}

TEST_F(Takes, FaultyFilesAreNamed) {
  Recording("a", {{1, 2}});
  const auto problem = [&](const std::string& text) {
    return Score({Write("takes.yaml", text)}).err;
  };
  EXPECT_EQ(Has(problem("takes: 3\n"), "takes.yaml:1:8: error: takes: expected a list, found '3'"),
            "");
  EXPECT_EQ(
      Has(problem("takes:\n  - {labels: a.csv}\n"), "2:5: error: a take needs the key 'recording'"),
      "");
  EXPECT_EQ(Has(problem("takes:\n  - {recording: a.jsonl, ofset_s: 3}\n"),
                "2:26: error: unknown key 'ofset_s'"),
            "");
  EXPECT_EQ(Has(problem("takes:\n  - {recording: a.jsonl, offset_s: soon}\n"),
                "error: offset_s: expected a number from -1000000 to 1000000, found 'soon'"),
            "");
  EXPECT_EQ(Has(problem("takes:\n  - {recording: a.jsonl, starts_at: 3}\n"),
                "error: starts_at: expected a time like 2026-10-25T01:59:57.010, found"),
            "");
  EXPECT_EQ(Has(problem("takes:\n  - {recording: a.jsonl}\n"),
                "which labels? --truth FILE or FOLDER, or 'labels' in the file of takes"),
            "");
  EXPECT_EQ(Has(problem("takes:\n  - {recording: none.jsonl, labels: a.csv}\n"), "none.jsonl"), "");
  for (const char* itself : {"takes.yaml", ".", "./."})
    EXPECT_EQ(Has(problem(std::string("takes:\n  - {recording: ") + itself + "}\n"),
                  "is a file of takes itself"),
              "");
}

TEST_F(Takes, WhatIsCutOrOutsideIsSaid) {
  const std::string take = Recording("a", {{1, 2}, {4, 5}});
  const auto said = [&](const std::string& row) {
    return Score({take, "--truth", Write("c.csv", "begin_s,end_s,label\n1,2,near\n" + row + "\n"),
                  "--map", map_});
  };
  for (const char* row : {"4,5.7,near", "-0.4,0.3,near"})
    EXPECT_EQ(Has(said(row).out, "counted: 2 labels of 1 take; 1 cut at an end of the recording\n"),
              "")
        << row;
  EXPECT_EQ(Has(said("4,5.01,near").out, "counted: 2 labels of 1 take\n"), "") << "a frame";
  for (const char* row : {"5.2,5.6,near", "-0.5,-0.1,near", "5.2,5.2,near", "-0.1,-0.1,near"}) {
    const Said outside = said(row);
    EXPECT_EQ(outside.exit_code, 2) << row;
    EXPECT_EQ(Has(outside.err, "c.csv:3:"), "");
    EXPECT_EQ(Has(outside.err, "s, the recording ends after 5 s"), "");
  }
}

TEST_F(Takes, LabelsThatBecomeOneAreSaid) {
  const std::string take = Recording("a", {{1, 2}, {3, 4}});
  const auto counted = [&](const std::string& rows, const std::string& map) {
    const std::vector<std::string> words = {take, "--truth",
                                            Write("c.csv", "begin_s,end_s,label\n" + rows), "--map",
                                            Write("m.yaml", map)};
    const auto json = Json(words);
    const auto merged = json["counted"]["merged"].get<int>();
    EXPECT_EQ(json["counted"]["labels"].get<int>() - merged, json["grammars"][0]["total"]["true"]);
    EXPECT_EQ(Has(Score(words).out,
                  merged == 0 ? "counted: 2 labels of 1 take\n"
                              : "counted: 3 labels of 1 take; 1 became part of another\n"),
              "");
    return merged;
  };
  const std::string map = "labels: {near: {event: near}}\n";
  EXPECT_EQ(counted("1,2,near\n3,4,near\n", map), 0);
  EXPECT_EQ(counted("1,2,near\n1.5,2.5,near\n3,4,near\n", map), 1) << "they overlap";
  EXPECT_EQ(counted("1,2,near\n1,2,near\n3,4,near\n", map), 1) << "a row twice";
  EXPECT_EQ(counted("1,1.4,near\n1.5,2,near\n3,4,near\n", map + "join_s: 0.2\n"), 1) << "joined";
}

// Frames that nobody marked are no events, neither of the labels nor of what was found.
TEST_F(Takes, BackgroundIsNoEvent) {
  const std::string take = Recording("a", {{1, 2}});
  const std::string rows = "begin_s,end_s,label\n0,1,background\n1,2,near\n2,4.9,background\n";
  const Said said = Score(
      {take, "--truth", Write("c.csv", rows), "--found", Write("f.csv", rows), "--map", map_});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(Has(said.out, "left out: 2 labels without a meaning (background)\n"), "");
  EXPECT_EQ(said.out.find("ignored: background"), std::string::npos) << said.out;
}

TEST_F(Takes, LabelsOfAMomentLieInEvents) {
  const std::string take = Recording("a", {{1, 2}, {3, 4}});
  const std::string head = "begin_s,end_s,label\n";
  const std::string labels = Write("m.csv", head + "1.5,1.5,near\n2.5,2.5,near\n3,4,near\n");
  const Said said = Score({take, "--truth", labels, "--map", map_});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(Has(said.out,
                "labels of a moment, and so many lie in such an event; they are in no other "
                "figure: near 1 of 2\n"),
            "");
  EXPECT_EQ(Has(said.out, "counted: 1 label of 1 take, and 2 of a moment\n"), "");
  const auto json = Json({take, "--truth", labels, "--map", map_})["grammars"][0];
  EXPECT_EQ(json["total"]["f1_50"], 1) << "what has the moment is not too much";
  EXPECT_EQ(json["moments"]["near"]["true"], 2);
  // Without any moment in it, it is too much.
  const std::string other = Write("n.csv", head + "0.5,0.5,near\n3,4,near\n");
  const auto extra = Json({take, "--truth", other, "--map", map_})["grammars"][0];
  EXPECT_EQ(extra["total"]["ward"]["inserted"], 1);
  EXPECT_EQ(extra["moments"]["near"]["found"], 0);
  // It excuses one event, the nearest.
  const std::string two = Write("t.csv", head + "1.48,1.51,near\n1.52,1.9,near\n3,4,near\n");
  const auto both = Json({take, "--truth", Write("o.csv", head + "1.5,1.5,near\n3,4,near\n"),
                          "--found", two, "--map", map_})["grammars"][0];
  EXPECT_EQ(both["total"]["ward"]["inserted"], 1) << both;
  EXPECT_EQ(both["moments"]["near"]["found"], 1);
  // Praat's points and BORIS's, too.
  const std::string boris =
      Write("b.csv", "Time,Behavior,Type\n1.2,near,POINT\n3,near,START\n4,near,STOP\n");
  const std::string map =
      Write("b.yaml", "columns: {time: Time, kind: Type}\nlabels: {near: {event: near}}\n");
  EXPECT_EQ(Json({take, "--truth", boris, "--map", map})["grammars"][0]["moments"]["near"]["found"],
            1);
}

TEST_F(Takes, LayoutsOfOtherProgramsAreScored) {
  const std::string take = Recording("a", {{1, 2}, {3, 4}});
  const auto f1 = [&](const std::string& name, const std::string& text, const std::string& map) {
    return Json({take, "--truth", Write(name, text), "--map",
                 Write("m.yaml",
                       map + "labels: {near: {event: near}, SIL: ignore}\n")})["grammars"][0]
                                                                              ["total"]["collar_f"]
                                                                                  .get<double>();
  };
  EXPECT_EQ(f1("a.tsv", "onset\tduration\ttrial_type\n1\t1\tnear\n3\t1\tnear\n", ""), 1);
  std::string frames = "frame,label\n", lines;
  for (int frame = 0; frame < 50; ++frame) {
    const bool is_near = (frame >= 10 && frame < 20) || (frame >= 30 && frame < 40);
    frames += std::to_string(frame) + (is_near ? ",near\n" : ",SIL\n");
    lines += is_near ? "near\n" : "SIL\n";
  }
  EXPECT_EQ(f1("f.csv", frames, "rate_hz: 10\n"), 1);
  EXPECT_EQ(f1("f.txt", lines, "rate_hz: 10\n"), 1);
  const auto rated = [&](const std::string& rate, const std::string& name = "f.txt") {
    return Score({take, "--truth", Path(name), "--map",
                  Write("r.yaml", rate + "labels: {near: {event: near}, SIL: ignore}\n")})
        .err;
  };
  EXPECT_EQ(
      Has(rated("rate_hz: 20\n"),
          "f.txt: its lines last 2.50 s at 20 per second, the recording 5.00 s\n  hint: if it "
          "has a line for each frame of the video: rate_hz: 10 in the map\n"),
      "");
  EXPECT_EQ(rated("rate_hz: 10.5\n").find("its lines last"), std::string::npos);
  for (const char* name : {"f.txt", "f.csv"})
    EXPECT_EQ(Has(rated("rate_hz: 8\n", name),
                  name + std::string(": its lines last 6.25 s at 8 per second, the recording 5.00 "
                                     "s\n  hint: if it has a line for each frame of the video: "
                                     "rate_hz: 10 in the map\n")),
              "");
  EXPECT_EQ(Has(rated("rate_hz: 20\n", "f.csv"), "f.csv: its lines last 2.50 s at 20 per"), "");
  Write("some.csv", "frame,label\n10,near\n11,near\n12,near\n");  // the others are not named
  EXPECT_EQ(rated("rate_hz: 10\n", "some.csv").find("its lines last"), std::string::npos);
  EXPECT_EQ(f1("d.csv",
               "begin,end,label\n2026-10-25T02:00:01.0,2026-10-25T02:00:02.0,near\n"
               "2026-10-25T02:00:03.0,2026-10-25T02:00:04.0,near\n",
               "starts_at: 2026-10-25T02:00:00\n"),
            1);
  const Said dates = Score({take, "--truth", Path("d.csv"), "--map", map_});
  EXPECT_EQ(Has(dates.err, "starts_at: 2026-10-25T01:59:50"), "");
  EXPECT_EQ(f1("o.csv", "begin,end,label\n0.5,1.5,near\n2.5,3.5,near\n", "offset_s: {a: 0.5}\n"),
            1);
  const Said unknown =
      Score({take, "--truth", Path("o.csv"), "--map",
             Write("m.yaml", "offset_s: {b: 0.5}\nlabels: {near: {event: near}}\n")});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_EQ(Has(unknown.err, "offset_s: the map has none of a"), "");
}

constexpr const char* kEaf = R"(<?xml version="1.0" encoding="UTF-8"?>
<ANNOTATION_DOCUMENT FORMAT="3.0">
  <HEADER TIME_UNITS="milliseconds"><MEDIA_DESCRIPTOR MEDIA_URL="v.mp4" TIME_ORIGIN="350"/></HEADER>
  <TIME_ORDER>
    <TIME_SLOT TIME_SLOT_ID="t1" TIME_VALUE="1000"/><TIME_SLOT TIME_SLOT_ID="t2" TIME_VALUE="2000"/>
    <TIME_SLOT TIME_SLOT_ID="t3" TIME_VALUE="3000"/><TIME_SLOT TIME_SLOT_ID="t4" TIME_VALUE="4000"/>
  </TIME_ORDER>
  <TIER TIER_ID="right"><ANNOTATION>
    <ALIGNABLE_ANNOTATION ANNOTATION_ID="a1" TIME_SLOT_REF1="t1" TIME_SLOT_REF2="t2">
      <ANNOTATION_VALUE>near</ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION><ANNOTATION>
    <ALIGNABLE_ANNOTATION ANNOTATION_ID="a2" TIME_SLOT_REF1="t3" TIME_SLOT_REF2="t4">
      <ANNOTATION_VALUE></ANNOTATION_VALUE></ALIGNABLE_ANNOTATION></ANNOTATION></TIER>
  <TIER TIER_ID="right_object" PARENT_REF="right"><ANNOTATION>
    <REF_ANNOTATION ANNOTATION_ID="a3" ANNOTATION_REF="a1">
      <ANNOTATION_VALUE>the cup</ANNOTATION_VALUE></REF_ANNOTATION></ANNOTATION></TIER>
</ANNOTATION_DOCUMENT>
)";

TEST_F(Takes, ElanHasRolesInChildTiersAndWarnings) {
  const std::string take = Recording("a", {{1, 2}, {3, 4}}), file = Write("a.eaf", kEaf);
  const std::string map = Write("m.yaml", R"(tiers:
  right: {hand: hand}
  right_object: {role: cup, of: right}
entities: {the cup: cup}
labels: {near: {event: near}}
)");
  const Said said = Score({take, "--truth", file, "--map", map, "--verbose"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(
      Has(said.err, "a.eaf:3:38: warning: TIME_ORIGIN: 0 s of the labels is 0.35 s of the video"),
      "");
  EXPECT_EQ(Has(said.err,
                "a label is without text, and left out; the first of the tier 'right' at 3 "
                "to 4 s"),
            "");
  EXPECT_EQ(Has(said.out, "extra    near(hand, cup)"), "");
  EXPECT_EQ(Has(said.out, "left out: 1 label without text\n"), "");
  // By the take's own clock nobody needs to be warned; a child without a parent is wrong.
  const Said clock = Score({Write("takes.yaml",
                                  "map: m.yaml\ntakes:\n  - {recording: a.jsonl, labels: a.eaf, "
                                  "offset_s: 0}\n")});
  EXPECT_EQ(clock.err.find("TIME_ORIGIN"), std::string::npos) << clock.err;
  const Said alone = Score({take, "--truth", file, "--map",
                            Write("m.yaml", Replaced(ReadFile(map), "of: right", "of: left"))});
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_EQ(Has(alone.err, "the tier 'left' has no label here whose cup 'the cup' could be"), "");
}

TEST_F(Takes, CollarsAreOfSingleEvents) {
  const std::string take = Recording("a", {{1, 2}}),
                    labels = Write("l.csv", "begin_s,end_s,label\n1.2,2.2,near\n");
  const auto collar_f = [&](const std::string& map, std::vector<std::string> more) {
    std::vector<std::string> words = {take, "--truth", labels, "--map",
                                      Write("m.yaml", map + "labels: {near: {event: near}}\n")};
    words.insert(words.end(), more.begin(), more.end());
    return Json(words)["grammars"][0]["total"]["collar_f"].get<double>();
  };
  EXPECT_EQ(collar_f("", {}), 0);
  EXPECT_EQ(collar_f("collar_ms: {near: 250}\n", {}), 1);
  EXPECT_EQ(collar_f("collar_ms: {near: 250}\n", {"--collar-ms", "100"}), 0);
  // A label means its event; of two the larger one counts.
  Write("l.csv", "begin_s,end_s,label\n1.2,2.2,by it\n");
  const std::string also = "labels: {by it: {event: near}, at it: {event: near}}\ncollar_ms: ";
  for (const auto& [collars, f] : {std::pair{"{by it: 250, at it: 9}", 1}, {"{at it: 90}", 0}}) {
    const std::string map = Write("m.yaml", also + collars + "\n");
    EXPECT_EQ(Json({take, "--truth", labels, "--map", map})["grammars"][0]["total"]["collar_f"], f);
  }
  const Said unknown =
      Score({take, "--truth", labels, "--map", Write("m.yaml", also + "{by ti: 250}\n")});
  EXPECT_EQ(Has(unknown.err, "the grammar has no event 'by ti'"), "");
}

// Labels are events of the first grammar that is named; others may have fewer.
TEST_F(Takes, AGrammarWithoutTheEventOfALabelMissesIt) {
  const std::string take = Recording("a", {{1, 2}}),
                    labels = Write("l.csv", "begin_s,end_s,label\n1,2,near\n"), map = map_;
  Write("grammars/far.grammar",
        "grammar far\nevent far(hand: Hand, cup: Thing) while distance(hand, cup) < 10 cm\n");
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--map", map}}) {
    std::vector<std::string> words = {take,   "--truth",   labels, "--grammar",
                                      "near", "--grammar", "far"};
    words.insert(words.end(), more.begin(), more.end());
    const auto both = Json(words)["grammars"];
    EXPECT_EQ(both[0]["total"]["f1_50"], 1);
    EXPECT_EQ(both[0]["not_covered"], nlohmann::json::array());
    EXPECT_EQ(both[1]["total"]["true"], 1);
    EXPECT_EQ(both[1]["total"]["found"], 0);
    EXPECT_EQ(both[1]["not_covered"], nlohmann::json::array({"near"}));
    EXPECT_EQ(both[1]["ignored"], nlohmann::json({{"far", 1}}));
    EXPECT_EQ(Has(Score(words).out, "not covered: near (1 true); "), "");
    words.insert(words.begin(), "report");
    words.insert(words.end(), {"-o", Path("page.html")});
    EXPECT_EQ(Do(words).exit_code, 0) << Do(words).err;
    // The other way round the event is nobody's.
    words = {take, "--truth", labels, "--grammar", "far", "--grammar", "near"};
    words.insert(words.end(), more.begin(), more.end());
    const Said said = Score(words);
    EXPECT_EQ(said.exit_code, 2);
    EXPECT_EQ(
        Has(said.err, "labels are events of the first grammar (far): name one that has it first\n"),
        "");
  }
}

}  // namespace
}  // namespace prehend::house
