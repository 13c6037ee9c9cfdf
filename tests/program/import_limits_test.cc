// SPDX-License-Identifier: Apache-2.0
// What an import writes can be read, whatever the file has: what a recording may not say is refused
// with its place, by `grammar watch` too.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "tests/program/carried_cup.h"
#include "tests/program/import_csv.h"
#include "tests/program/program.h"

namespace prehend::house {
namespace {

/// At `rate_hz`, over 5 s. `cup`: as it is, or moved.
std::string Csv(double rate_hz, const std::function<Row(Row)>& cup) {
  std::string csv = "t,name,x,y,z,qw,qx,qy,qz\n";
  for (int i = 0; i <= 5 * rate_hz; ++i)
    csv += AsWritten("Mug", cup(CupAt(i / rate_hz))) + AsWritten("Glove", HandAt(i / rate_hz));
  return csv;
}

Row AsItIs(Row row) { return row; }

TEST(ImportLimits, AGlitchOfATrackerCanBeRead) {
  const auto folder = FreshFolder("import_glitch");
  const Said imported = ImportCsv(folder,
                                  Csv(1000,
                                      [](Row row) {
                                        if (row.t_s == 4.5) row.x += 12;
                                        return row;
                                      }),
                                  kCupMap);
  EXPECT_EQ(imported.exit_code, 0) << imported.err;
  const Said said = Prehend({"episode", "resegment", (folder / "take.jsonl").string()});
  EXPECT_EQ(said.exit_code, 0) << said.err;
}

TEST(ImportLimits, ALongNameOfAFileIsCutInTheMiddle) {
  const auto folder = FreshFolder("import_long_name");
  const std::string file =
      "2024-05-01_10-11-12_subject-003_session-02_kitchen_make-coffee_take-012.csv";
  const Said imported = ImportFile(folder, file, Csv(60, AsItIs),
                                   Replaced(kCupMap, "episode: a_cup_is_carried\n", ""));
  EXPECT_NE(imported.out.find("take_2024_05_01_10_11_12_subject_02_kitchen_make_coffee_take_012: "),
            std::string::npos)
      << imported.out << imported.err;
  const Said said = Prehend({"episode", "resegment", (folder / "take.jsonl").string()});
  EXPECT_EQ(said.exit_code, 0) << said.err;
}

TEST(ImportLimits, AClockThatRunsLongerThanARecordingIsRefused) {
  const auto folder = FreshFolder("import_long_clock");
  Row last = CupAt(5);
  for (const double t_s : {2e12, 3e18}) {
    last.t_s = t_s;
    const Said said = ImportCsv(folder, Csv(60, AsItIs) + AsWritten("Mug", last),
                                std::string(kCupMap) + "lost: unknown\n");
    EXPECT_EQ(said.exit_code, 2) << said.out;
    EXPECT_NE(said.err.find("s after the first; of "), std::string::npos) << said.err;
    EXPECT_NE(said.err.find("is 'time_unit' right?"), std::string::npos) << said.err;
  }
}

TEST(ImportLimits, AJointFartherThanARecordingSaysIsRefused) {
  const auto folder = FreshFolder("import_far_joint");
  std::string csv = "t,j,dx,dy,dz,hx,hy,hz\n";
  for (int i = 0; i <= 300; ++i)
    csv += std::to_string(i / 60.0) + "," + std::to_string(100 * i) + ",0.5,0," +
           std::to_string(0.8 + 0.001 * i) + ",0,0,1\n";
  const std::string map =
      "import: 1\nunit: m\naxes: z_up\ntime_unit: s\n"
      "columns: {time: t, position: ['{}x', '{}y', '{}z']}\nentities:\n"
      "  drawer: {from: d, class: Drawer, size_m: [0.1, 0.1, 0.1],\n"
      "           joint: {from: j, closed: 0, open: 30000}}\n"
      "  hand: {from: h, hand: true, size_m: [0.1, 0.1, 0.1]}\n";
  const Said far = ImportCsv(folder, csv, map);
  EXPECT_EQ(far.exit_code, 2) << far.out;
  EXPECT_NE(far.err.find("'drawer' is at 30000 m or rad; a joint is at most at 10000"),
            std::string::npos)
      << far.err;
  const Said near = ImportCsv(folder, csv, Replaced(map, "open: 30000", "open: 30000, unit: mm"));
  EXPECT_EQ(near.exit_code, 0) << near.err;
  const Said said = Prehend({"episode", "resegment", (folder / "take.jsonl").string()});
  EXPECT_EQ(said.exit_code, 0) << said.err;
}

}  // namespace
}  // namespace prehend::house
