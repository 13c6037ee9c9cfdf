// SPDX-License-Identifier: Apache-2.0
// Tables of poses that are long: what is wrong with them is found where it is, and they need not
// fit into memory. What a recording may be called.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "tests/program/carried_cup.h"
#include "tests/program/import_csv.h"
#include "tests/program/program.h"

namespace prehend::house {
namespace {

/// At 60 Hz. After five seconds both bodies rest.
std::string LongCsv(int last_row) {
  std::string csv = "t,name,x,y,z,qw,qx,qy,qz\n";
  for (int i = 0; i <= last_row; ++i) {
    for (const char* name : {"Mug", "Glove"}) {
      const double t_s = i / 60.0;
      const Row row = (name[0] == 'M' ? CupAt : HandAt)(std::min(t_s, 5.0));
      csv += AsWritten(name, {t_s, row.x, row.y, row.z});
    }
  }
  return csv;
}

TEST(ImportLong, TablesTakeLittleMemory) {
  const auto folder = FreshFolder("little_memory");
  WriteFile(folder / "poses.csv", LongCsv(72'000));
  WriteFile(folder / "map.yaml", kCupMap);
  const Said said =
      Prehend({"import", (folder / "poses.csv").string(), "--map", (folder / "map.yaml").string(),
               "-o", (folder / "take.jsonl").string()},
              {}, "ulimit -d 30000");
  EXPECT_EQ(said.exit_code, 0) << "it takes 24 MB, and 97 if all poses are kept\n" << said.err;
  EXPECT_NE(said.out.find("a_cup_is_carried: 72001 frames, 1200.000 s"), std::string::npos);
}

TEST(ImportLong, FaultsAreShownWithTheirLines) {
  const std::string csv = LongCsv(30'000);
  const auto folder = FreshFolder("long_file");
  const std::string rows = "\n400.0000,Mug,";
  const Said said = ImportCsv(folder, Replaced(csv, rows, rows + "left"), kCupMap);
  EXPECT_NE(said.exit_code, 0);
  EXPECT_NE(said.err.find("poses.csv:48002:14: error: expected a number, found 'left"),
            std::string::npos)
      << said.err;
  EXPECT_NE(said.err.find("400.0000,Mug,left"), std::string::npos) << said.err;
  EXPECT_EQ(ImportCsv(folder, csv, kCupMap, {"--check"}).out.substr(0, 41),
            "a_cup_is_carried: 30001 frames, 500.000 s");
}

TEST(ImportLong, ARecordingHasTheNameOfOne) {
  const auto folder = FreshFolder("name_of_one");
  for (const char* name : {"x.npz", "x.csv", "x.json", "x"}) {
    const Said said = ImportCsv(folder, LongCsv(360), kCupMap, {"-o", (folder / name).string()});
    EXPECT_EQ(said.exit_code, 2) << name;
    EXPECT_NE(said.err.find(": of poses it is NAME.jsonl, NAME.episodes or -; of that, 'episode "
                            "export' writes other files"),
              std::string::npos)
        << said.err;
    EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
  }
}

}  // namespace
}  // namespace prehend::house
