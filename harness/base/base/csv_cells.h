// SPDX-License-Identifier: Apache-2.0
// The cells of a line of comma-separated values. Tested by
// tests/harness/base/base/csv_cells_test.cc
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace prehend {

struct CsvCell {
  std::string_view text;        ///< without blanks and quotes around it
  int column = 1;               ///< in bytes, from 1
  std::string_view fault = {};  ///< what is wrong with its quotes, or ""
};

/// A cell may stand in quotes, and then hold separators; two quotes are one that does not end it.
std::vector<CsvCell> CsvCellsOf(std::string_view line, char separator);

/// A cell to be written: in quotes where it needs them. A text that a spreadsheet would run
/// ("=cmd|..") gets an apostrophe before it.
std::string AsCsvCell(std::string_view cell);

}  // namespace prehend
