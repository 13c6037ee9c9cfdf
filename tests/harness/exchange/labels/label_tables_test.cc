// SPDX-License-Identifier: Apache-2.0
// Tables of labels in all their layouts: lengths, rows for both ends, a row or a line for each
// frame; and which rows are of which take.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "harness/episode/episode/take.h"
#include "harness/exchange/labels/label_map.h"

namespace prehend::exchange {
namespace {

namespace fs = std::filesystem;

class LabelTables : public testing::Test {
 protected:
  LabelTables() { fs::create_directories(folder_); }
  ~LabelTables() override { fs::remove_all(folder_); }

  Result<LabelFile> File(const std::string& name, const std::string& text,
                         const CsvReading& how) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return ReadLabels((folder_ / name).string(), how);
  }
  /// "0.5..1.5 hold [right]; .."; or the message and its hint, without the folder.
  std::string Read(const std::string& name, const std::string& text,
                   const CsvReading& how = {}) const {
    const Result<LabelFile> file = File(name, text, how);
    if (!file) {
      const grammar::Diagnostic& problem = file.error().front();
      return fmt::format("{}:{} {} | {}", problem.place.line, problem.place.column, problem.message,
                         problem.hint);
    }
    std::string all;
    for (const Label& label : file->labels)
      all += fmt::format("{:g}..{:g} {}{}; ", label.begin_s, label.end_s, label.text,
                         label.tier.empty() ? "" : " [" + label.tier + "]");
    return all;
  }
  static bool StartsWith(const std::string& text, const std::string& part) {
    return text.starts_with(part);
  }

  const fs::path folder_ =
      fs::path(testing::TempDir()) /
      ("tables_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(LabelTables, ALabelTrackHasNoHeader) {
  const std::string track =
      "0.600000\t1.600000\treach, slow\n\\\t200.000000\t4000.000000\n2.5\t2.5\tclick\n";
  for (const char* name : {"a.txt", "a.tsv", "a.csv"})
    EXPECT_EQ(Read(name, track), "0.6..1.6 reach, slow; 2.5..2.5 click; ") << name;
  EXPECT_EQ(Read("a.txt", "1\t2\thold\n3\tfour\thold\n"),
            "2:3 end_s: found 'four', wanted a number or a time like 0:01:02.5 | ");
  EXPECT_EQ(Read("a.txt", "1\n1\n2\n", {.rate_hz = 2}), "0..1 1; 1..1.5 2; ") << "frames";
}

TEST_F(LabelTables, ALengthStandsForAnEnd) {
  EXPECT_EQ(Read("a.tsv", "onset\tduration\ttrial_type\n1.3\t1.6\tgrasp, firmly\n"),
            "1.3..2.9 grasp, firmly; ");
  EXPECT_EQ(Read("a.csv", "begin_ms,duration_ms,label\n500,250,hold\n"), "0.5..0.75 hold; ");
  EXPECT_EQ(Read("a.csv", "t0,long,what\n2,0.5,hold\n",
                 {.begin = "t0", .duration = "long", .label = "what"}),
            "2..2.5 hold; ");
  // A negative length is an error.
  EXPECT_TRUE(StartsWith(Read("a.csv", "begin,duration,label\n1,-2,hold\n"),
                         "2:6 'hold' ends before it begins: 1 s to -1 s"));
  EXPECT_EQ(Read("a.csv", "onset,duration,trial_type\n1.3,1.6,grasp\n",
                 {.begin = "onset", .end = "duration", .label = "trial_type"}),
            "1:1 found the columns onset, duration, trial_type; the map says that 'duration' is "
            "the end of a label | a length is no end: columns: {duration: duration}");
}

TEST_F(LabelTables, OfTwoColumnsThatCouldBeMeantNoneIsTaken) {
  EXPECT_EQ(
      Read("a.csv", "begin,end,end_s,label\n1,2,3,hold\n"),
      "1:1 found the columns begin, end, end_s, label: which of 'end' and 'end_s' is the end? "
      "| in the map: columns: {end: end}");
  EXPECT_EQ(Read("a.csv", "begin,end,end_s,label\n1,2,3,hold\n", {.end = "end_s"}), "1..3 hold; ");
  EXPECT_EQ(Read("a.csv", "begin,end,label,action\n1,2,x,hold\n"),
            "1:1 found the columns begin, end, label, action: which of 'label' and 'action' is the "
            "label? | in the map: columns: {label: label}");
  EXPECT_EQ(Read("a.csv", "begin,end,duration,label\n1,2,3,hold\n"),
            "2:5 duration: found 3 s, and the end is 1 s after the begin; which is right? In the "
            "map: columns: {end: end} | ");
  EXPECT_EQ(Read("a.csv", "begin,end,duration,label\n1,2,3,hold\n", {.end = "end"}), "1..2 hold; ");
  EXPECT_EQ(Read("a.csv", "begin,end,duration,label\n1,2,1.05,hold\n"), "1..2 hold; ");
  EXPECT_EQ(Read("a.csv", "start_frame,start_s,stop_frame,stop_s,label\n10,1,20,2,hold\n"),
            "1..2 hold; ");
}

TEST_F(LabelTables, RowsForBothEndsArePaired) {
  const CsvReading how = {.label = "Behavior", .tier = "Subject", .time = "Time", .kind = "Type"};
  const std::string head = "Time,Subject,Behavior,Type\n";
  EXPECT_EQ(Read("a.csv",
                 head + "0.5,right,hold,START\n0.7,left,hold,START\n1,right,hold,STOP\n"
                        "1.2,right,click,POINT\n1.5,left,hold,STOP\n2,right,hold,start\n"
                        "3,right,hold,stop\n",
                 how),
            "0.5..1 hold [right]; 1.2..1.2 click [right]; 0.7..1.5 hold [left]; 2..3 hold "
            "[right]; ");
  EXPECT_TRUE(StartsWith(Read("a.csv", head + "0.5,right,hold,START\n", how),
                         "2:11 'hold' begins and never ends"));
  EXPECT_TRUE(StartsWith(Read("a.csv", head + "0.5,right,hold,STOP\n", how),
                         "2:11 'hold' ends, and no row before it begins it"));
  EXPECT_TRUE(StartsWith(Read("a.csv", head + "0.5,right,hold,START\n1,right,hold,START\n", how),
                         "3:9 'hold' begins again; it began in line 2 and has not ended"));
  EXPECT_TRUE(StartsWith(Read("a.csv", head + "0.5,right,hold,BEGUN\n", how),
                         "2:16 Type: found 'BEGUN', wanted START, STOP or POINT"));
  // One column for both is what people try first.
  EXPECT_EQ(Read("a.csv", head + "0.5,right,hold,START\n",
                 {.begin = "Time", .end = "Time", .label = "Behavior"}),
            "1:1 found the columns Time, Subject, Behavior, Type; the map says that 'Time' is both "
            "the begin and the end | are there rows for START and for STOP? columns: {time: Time, "
            "kind: COLUMN}");
  // The other one may be found by its usual name.
  EXPECT_EQ(
      Read("a.csv", "begin,end,label\n0,1,hold\n", {.begin = "end"}),
      "1:1 found the columns begin, end, label; the map says that 'end' is both the begin and "
      "the end | are there rows for START and for STOP? columns: {time: end, kind: COLUMN}");
}

TEST_F(LabelTables, FramesOneAfterAnotherAreOneLabel) {
  const CsvReading how = {.rate_hz = 10};
  EXPECT_EQ(Read("a.csv",
                 "frame,label,tier\n0,reach,right\n1,reach,right\n1,hold,left\n2,reach,right\n"
                 "2,,left\n3,hold,right\n5,hold,right\n",
                 how),
            "0..0.3 reach [right]; 0.1..0.2 hold [left]; 0.3..0.4 hold [right]; 0.5..0.6 hold "
            "[right]; ");
  EXPECT_EQ(Read("a.txt", "SIL\nreach\nreach\n\nreach\n", how),
            "0..0.1 SIL; 0.1..0.3 reach; 0.4..0.5 reach; ");
  // In any order.
  EXPECT_EQ(Read("a.csv", "frame,label\n12,A\n10,A\n14,A\n11,B\n11,A\n12,A\n", how),
            "1..1.3 A; 1.1..1.2 B; 1.4..1.5 A; ");
  EXPECT_EQ(Read("a.csv", "nr,what\n7,x\n8,x\n", {.label = "what", .frame = "nr", .rate_hz = 100}),
            "0.07..0.09 x; ");
  EXPECT_TRUE(StartsWith(Read("a.csv", "frame,label\n1.5,x\n", how),
                         "2:1 frame: found '1.5', wanted the number of a frame"));
  for (const auto& [name, text] :
       {std::pair{"a.csv", "frame,label\n1,x\n"}, std::pair{"a.txt", "x\nx\n"}})
    EXPECT_TRUE(Read(name, text).ends_with("In the map: rate_hz: 30")) << Read(name, text);
}

TEST_F(LabelTables, TimesHaveSignsAndDates) {
  EXPECT_EQ(Read("a.csv", "begin,end,label\n+0.5000,+1,hold\n"), "0.5..1 hold; ");
  // The sign of a clock is that of all of it, also before a zero.
  EXPECT_EQ(Read("a.csv",
                 "begin,end,label\n-0:02,0:03,a\n-0:00.5,+0:01,b\n-00:00:00.500,0:00,c\n"
                 "-0:01:00,-0:00:30,d\n-1:02,-1,e\n-1:00:00,-0:59:59.25,f\n"),
            "-2..3 a; -0.5..1 b; -0.5..0 c; -60..-30 d; -62..-1 e; -3600..-3599.25 f; ");
  for (const char* none : {"--0:02", "-+0:02", "0:-02", "-0:-02", "1:+02", "0:-0:01", "-0:61", "-"})
    EXPECT_TRUE(StartsWith(Read("a.csv", std::string("begin,end,label\n") + none + ",9,hold\n"),
                           std::string("2:1 begin: found '") + none + "'"))
        << none;
  const Result<LabelFile> file =
      File("a.csv", "begin,end,label\n2026-10-25T01:59:57.250,2026-10-25 02:00:01Z,hold\n", {});
  ASSERT_TRUE(file);
  const double start_s = *episode::SecondsOfDate("2026-10-25T01:59:50");
  EXPECT_NEAR(file->labels[0].begin_s - start_s, 7.25, 1e-6);
  EXPECT_NEAR(file->labels[0].end_s - start_s, 11, 1e-6);
  EXPECT_EQ(episode::SecondsOfDate("1970-01-02T00:00:00+01:00"), 82800);
  EXPECT_EQ(episode::SecondsOfDate("2000-02-29T12:00:00-0530"), 951845400);
  for (const char* none :
       {"2026-10-25", "2026-13-25T00:00:00", "2026-02-30T00:00:00", "2026-10-25T24:00:00",
        "2026-10-25T00:60:00", "2026-10-25T00:00:00+x", "26-10-25T00:00:00", "2026-10-25T00:00",
        "1.5", "", "2026-10-25T00:00:-1"})
    EXPECT_FALSE(episode::SecondsOfDate(none)) << none;
}

// RFC 4180, as spreadsheets write it.
TEST_F(LabelTables, CellsInQuotesHaveQuotesAndLineBreaks) {
  const std::string head = "begin,end,label,tier\n";
  EXPECT_EQ(Read("a.csv", head + "1,2,\"A \"\"x\"\" y\",\"a \"\"b\"\"\"\n"),
            "1..2 A \"x\" y [a \"b\"]; ");
  EXPECT_EQ(Read("a.csv", head + "1,2,\"\"\"x\"\"\",5\"\n1,2,say \"\"x\"\",y\n"),
            "1..2 \"x\" [5\"]; 1..2 say \"\"x\"\" [y]; ");
  EXPECT_EQ(Read("a.csv", "\"begin \"\"s\"\"\",end,label\n1,2,x\n", {.begin = "begin \"s\""}),
            "1..2 x; ");
  const std::string note = "note,begin,end,label\n\"two\n\"\"lines\"\"\n, and\n\",1,2,x\n";
  EXPECT_EQ(Read("a.csv", note + "\"\n\",2,3,\"y\nz\"\nn,3,4,x\n"), "1..2 x; 2..3 y\nz; 3..4 x; ");
  // Places count lines, and a quote that is not closed is that of its row alone.
  EXPECT_TRUE(StartsWith(Read("a.csv", note + "n,two,3,x\n"), "6:3 begin: found 'two'"));
  for (const char* more : {"", "n,2,3,x\n", "n,2,3,\"x\"\n"})
    EXPECT_TRUE(StartsWith(Read("a.csv", "note,begin,end,label\n\"n,1,2,x\n" + std::string(more)),
                           "2:2 the cell 'n': its quote is not closed"))
        << more;
}

TEST_F(LabelTables, ColumnsThatTellTakesAreNoticed) {
  const auto several = [&](const std::string& text, const CsvReading& how = {}) {
    const auto file = File("a.csv", text, how);
    std::string names;
    for (const std::string& name : file ? file->several : std::vector<std::string>{"?"})
      names += name + " ";
    return names;
  };
  const std::string rows = ",0,1,hold\n";
  for (const char* column : {"take", "video", "video_id", "Video", "file", "File name",
                             "Observation id", "session", "participant_id", "annotator", "coder"})
    EXPECT_EQ(several(std::string(column) + ",begin,end,label\nP1" + rows + "P2" + rows),
              std::string(column) + " ");
  EXPECT_EQ(several("take,begin,end,label\nP1" + rows + "P1" + rows), "") << "all of one";
  EXPECT_EQ(several("narration_id,begin,end,label\nP1" + rows + "P2" + rows), "");
  // A column that is read says what it is.
  EXPECT_EQ(several("take,begin,end,label\nP1" + rows + "P2" + rows, {.keys = {"take"}}), "");
  EXPECT_EQ(several("session,begin,end,label\nP1" + rows + "P2" + rows, {.tier = "session"}), "");
}

TEST_F(LabelTables, CellsWithoutTextAreCounted) {
  const auto file =
      File("a.csv", "begin,end,label,tier\n0,1,hold,right\n2,3,,left\n4,5,,left\n", {});
  ASSERT_TRUE(file);
  EXPECT_EQ(file->labels.size(), 1u);
  ASSERT_EQ(file->empty.size(), 2u);
  EXPECT_EQ(file->empty[0].tier, "left");
  EXPECT_EQ(file->empty[0].begin_s, 2);
  EXPECT_EQ(file->empty[0].place.line, 3);
}

}  // namespace
}  // namespace prehend::exchange
