// SPDX-License-Identifier: Apache-2.0
// What an import makes of times in which nothing is tracked.
#include <gtest/gtest.h>

#include <string>

#include "tests/program/carried_cup.h"
#include "tests/program/import_csv.h"
#include "tests/program/program.h"

namespace prehend::house {
namespace {

/// At 60 Hz. No body has a row from 1.2 to 3.6 s, when the cup is lifted, carried 40 cm and put
/// down.
std::string CsvWithAGap() {
  std::string csv = "t,name,x,y,z,qw,qx,qy,qz\n";
  for (int i = 0; i <= 360; ++i) {
    if (i > 72 && i < 216) continue;
    csv += AsWritten("Mug", CupAt(i / 60.0)) + AsWritten("Glove", HandAt(i / 60.0));
  }
  return csv;
}

/// What `episode resegment` says of the take.
Said Segment(const std::filesystem::path& folder, const std::string& lost) {
  const Said imported = ImportCsv(folder, CsvWithAGap(), kCupMap + lost);
  EXPECT_EQ(imported.exit_code, 0) << imported.err;
  return Prehend({"episode", "resegment", (folder / "take.jsonl").string()});
}

TEST(ImportGaps, WhenAllIsLostAFrameSaysSo) {
  const auto folder = FreshFolder("all_is_lost");
  const Said said = Segment(folder, "lost: unknown\n");
  const std::string recording = ReadFile(folder / "take.jsonl");
  EXPECT_NE(recording.find("{\"tick\":13001,\"samples\":{\"cup\":null,\"hand\":null}"),
            std::string::npos)
      << recording;
  EXPECT_EQ(said.out.find("grasping"), std::string::npos) << said.out;
  EXPECT_NE(said.err.find("'cup' is not tracked in 1 gap: 0.000 s are bridged, in 2.300 s it is "
                          "unknown"),
            std::string::npos)
      << said.err;
}

// The cup stands 40 cm from where it was lost: no support goes on.
TEST(ImportGaps, ASupportEndsWhereTheThingIsLost) {
  const Said said = Segment(FreshFolder("support_is_lost"), "lost: unknown\n");
  EXPECT_EQ(said.out,
            "event         begin_s  end_s    roles\n"
            "contact       0.00000  1.30010  a=cup       b=table\n"
            "supported_by  0.00000  1.30010  object=cup  support=table\n"
            "contact       3.60000  6.00010  a=cup       b=table        open_end\n"
            "supported_by  3.60000  6.00010  object=cup  support=table  open_end\n"
            "completed: 6.00010 s, 60001 ticks\n");
}

TEST(ImportGaps, WhatIsHeldNeedsNoSuchFrame) {
  const auto folder = FreshFolder("all_is_held");
  Segment(folder, "lost: hold\n");
  EXPECT_EQ(ReadFile(folder / "take.jsonl").find("null"), std::string::npos);
}

TEST(ImportGaps, LostInRowsAPauseIsNone) {
  const auto folder = FreshFolder("lost_in_rows");
  EXPECT_EQ(Segment(folder, "lost: in_rows\nend_s: 6.1\n").err, "");
  const std::string recording = ReadFile(folder / "take.jsonl");
  EXPECT_EQ(recording.find("null"), std::string::npos) << recording;
  EXPECT_TRUE(recording.ends_with("{\"end_tick\":61000}\n")) << recording;
  const Said early =
      ImportCsv(folder, CsvWithAGap(), kCupMap + std::string("lost: in_rows\nend_s: 5\n"));
  EXPECT_EQ(early.exit_code, 2);
  EXPECT_NE(early.err.find("error: the last row of the file is at 6 s\n"), std::string::npos)
      << early.err;
}

// The cup is seen once a second, the hand in between.
TEST(ImportGaps, StepsOfASlowBodyAreToldOrDecidedByBridge) {
  std::string csv = "t,name,x,y,z,qw,qx,qy,qz\n";
  for (int i = 0; i <= 360; ++i)
    csv += (i % 60 == 0 ? AsWritten("Mug", CupAt(i / 60.0)) : "") +
           AsWritten("Glove", HandAt(i / 60.0));
  const auto folder = FreshFolder("slow_body");
  const Said filled = ImportCsv(folder, csv, kCupMap);
  EXPECT_EQ(filled.exit_code, 0) << filled.err;
  EXPECT_NE(filled.err.find("'Mug' is seen every 1.000 s only: straight lines fill 6 such times"),
            std::string::npos)
      << filled.err;
  const Said refused = ImportCsv(folder, csv, kCupMap + std::string("bridge_s: 0.1\n"));
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  EXPECT_NE(refused.err.find("'Mug' is not tracked for 1.000 s from 0.000 s on; in all 6 such "
                             "times, 6.000 s"),
            std::string::npos)
      << refused.err;
  const Said bridged = ImportCsv(folder, csv, kCupMap + std::string("bridge_s: 1.01\n"));
  EXPECT_EQ(bridged.exit_code, 0) << bridged.err;
  EXPECT_EQ(bridged.err.find("straight lines"), std::string::npos) << bridged.err;
}

TEST(ImportGaps, AfterTheLastRowNothingIsKnown) {
  const auto folder = FreshFolder("ends_late");
  std::string csv = "t,name,x,y,z,qw,qx,qy,qz\n";
  for (int i = 0; i <= 360; ++i)
    csv += AsWritten("Mug", CupAt(i / 60.0)) + AsWritten("Glove", HandAt(i / 60.0));
  const Said refused = ImportCsv(folder, csv, kCupMap + std::string("end_s: 100\n"));
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  EXPECT_NE(refused.err.find("'Mug' is not tracked for 94.000 s from 6.000 s on"),
            std::string::npos)
      << refused.err;
  const Said unknown = ImportCsv(folder, csv, kCupMap + std::string("end_s: 100\nlost: unknown\n"));
  EXPECT_EQ(unknown.exit_code, 0) << unknown.err;
  EXPECT_TRUE(ReadFile(folder / "take.jsonl")
                  .find("{\"tick\":61001,\"samples\":{\"cup\":null,\"hand\":null}") !=
              std::string::npos)
      << unknown.err;
}

TEST(ImportGaps, AFrameThatIsMissingAtAnEndIsCounted) {
  const auto folder = FreshFolder("frame_missing");
  std::string csv = "t,name,x,y,z,qw,qx,qy,qz\n";
  for (int i = 0; i <= 360; ++i)
    csv += (i > 0 && i < 360 ? AsWritten("Mug", CupAt(i / 60.0)) : "") +
           AsWritten("Glove", HandAt(i / 60.0));
  const Said said = ImportCsv(folder, csv, kCupMap);
  EXPECT_NE(
      said.out.find("cup              Mug                  359    59.9        2     0.033     0"),
      std::string::npos)
      << said.out;
}

}  // namespace
}  // namespace prehend::house
