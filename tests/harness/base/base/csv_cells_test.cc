// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "harness/base/base/quoting.h"

namespace prehend {
namespace {

std::vector<std::string> Texts(std::string_view line, char separator = ',') {
  std::vector<std::string> texts;
  for (const CsvCell& cell : CsvCellsOf(line, separator)) texts.emplace_back(cell.text);
  return texts;
}

TEST(CsvCells, AreCutAtSeparatorsOutsideOfQuotes) {
  using V = std::vector<std::string>;
  EXPECT_EQ(Texts("a, b ,c"), (V{"a", "b", "c"}));
  EXPECT_EQ(Texts("\"a, b\",c"), (V{"a, b", "c"}));
  EXPECT_EQ(Texts("a;b", ';'), (V{"a", "b"}));
  EXPECT_EQ(Texts(""), (V{""}));
  EXPECT_EQ(Texts("a,"), (V{"a", ""}));
  EXPECT_EQ(Texts("\"open, end"), (V{"open", "end"}));
  EXPECT_EQ(Texts("a , \"b, c\" ,d"), (V{"a", "b, c", "d"}));
  EXPECT_EQ(Texts("say \"a\",\"\"\"b\"\"\",\"\""), (V{"say \"a\"", "\"\"b\"\"", ""}));
}

TEST(CsvCells, OfTwoQuotesInQuotesOneIsMeant) {
  const auto cells = CsvCellsOf(R"(say ""a"","say ""b""",""""" c")", ',');
  EXPECT_EQ(cells[0].Value(), R"(say ""a"")");
  EXPECT_EQ(cells[1].Value(), R"(say "b")");
  EXPECT_EQ(cells[2].Value(), R"("" c)");
}

TEST(CsvCells, KnowTheirPlace) {
  const auto cells = CsvCellsOf("ab, \"c\"", ',');
  EXPECT_EQ(cells[1].column, 6);
}

TEST(CsvCells, AFaultOfQuotesIsNamed) {
  EXPECT_EQ(CsvCellsOf("a,\"b,c", ',')[1].fault, "its quote is not closed");
  EXPECT_EQ(CsvCellsOf("a,\"b\" x,c", ',')[1].fault, "there is more after its closing quote");
  EXPECT_EQ(CsvCellsOf("\"b \"\"c\"\", d\" ,e", ',')[0].fault, "");
  EXPECT_EQ(CsvCellsOf("\"b \"\"c\"\", d\" ,e", ',').size(), 2u);
}

TEST(CsvCells, AreWrittenInQuotesWhereTheyNeedThem) {
  EXPECT_EQ(AsCsvCell("milk"), "milk");
  EXPECT_EQ(AsCsvCell("hand=a, object=b"), "\"hand=a, object=b\"");
  EXPECT_EQ(AsCsvCell("say \"a\""), "\"say \"\"a\"\"\"");
}

TEST(CsvCells, ASpreadsheetRunsNoneOfThem) {
  EXPECT_EQ(AsCsvCell("=cmd|' /C calc'!A0"), "'=cmd|' /C calc'!A0");
  EXPECT_EQ(AsCsvCell("@SUM(A1,A2)"), "\"'@SUM(A1,A2)\"");
  EXPECT_EQ(AsCsvCell("-2+3"), "'-2+3");
  for (const char* number : {"-2.5", "+1e-3", "7"}) EXPECT_EQ(AsCsvCell(number), number);
}

}  // namespace
}  // namespace prehend
