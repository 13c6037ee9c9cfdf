// SPDX-License-Identifier: Apache-2.0
// See harness/base/csv_cells.h. Tested by tests/harness/base/csv_cells_test.cc
#include "harness/base/csv_cells.h"

#include <algorithm>

namespace prehend::harness {

std::vector<CsvCell> CsvCellsOf(std::string_view line, char separator) {
  std::vector<CsvCell> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    std::size_t end = std::min(line.find(separator, begin), line.size());
    if (begin < line.size() && line[begin] == '"') {
      const std::size_t quote = line.find('"', begin + 1);
      if (quote != std::string_view::npos) end = std::min(line.find(separator, quote), line.size());
    }
    std::size_t first = begin, last = end;
    while (first < last && (line[first] == ' ' || line[first] == '"')) ++first;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '"')) --last;
    cells.push_back({line.substr(first, last - first), static_cast<int>(first) + 1});
    begin = end + 1;
  }
  return cells;
}

}  // namespace prehend::harness
