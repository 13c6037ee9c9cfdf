// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/cells/table_cells.h"

#include <gtest/gtest.h>

namespace prehend::exchange {
namespace {

TEST(TableCells, AnyNumberOfBlanksSeparates) {
  const std::vector<CsvCell> cells = TableCellsOf("  1.5\t-2   x ", Separator::kSpace);
  ASSERT_EQ(cells.size(), 3u);
  EXPECT_EQ(cells[1].text, "-2");
  EXPECT_EQ(cells[2].column, 12);
  EXPECT_EQ(TableCellsOf("", Separator::kSpace).size(), 1u);
}

TEST(TableCells, NumbersHavePlusSignsAndCommas) {
  EXPECT_EQ(NumberOf("+1.5", false), 1.5);
  EXPECT_EQ(NumberOf("-1,5e1", true), -15.0);
  EXPECT_EQ(NumberOf("1.5", true), 1.5);
  for (const char* text : {"1,5", "", "+-1", "1.5m"})
    EXPECT_EQ(NumberOf(text, false), std::nullopt) << text;
  EXPECT_EQ(NumberOf("1,000.5", true), std::nullopt);
}

TEST(TableCells, TimesOfIso8601) {
  EXPECT_EQ(SecondsOfIsoTime("1970-01-02T00:00:00.25Z"), 86400.25);
  EXPECT_EQ(SecondsOfIsoTime("1970-01-02 02:00:01,5+02:00"), 86401.5);
  EXPECT_EQ(SecondsOfIsoTime("10:00:00.5"), 36000.5);
  EXPECT_EQ(SecondsOfIsoTime("9:59:57.5"), 35997.5);
  EXPECT_EQ(SecondsOfIsoTime("1970-01-02 2:00:01"), 93601);
  for (const char* text : {"2026-02-30T10:00:00", "2026-01-01", "25:00:00", "10:61:00", "x", "12"})
    EXPECT_EQ(SecondsOfIsoTime(text), std::nullopt) << text;
}

}  // namespace
}  // namespace prehend::exchange
