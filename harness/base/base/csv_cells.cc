// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/csv_cells.h"

#include <algorithm>
#include <charconv>

namespace prehend {

namespace {

/// Of the quote at `open`; npos if there is none.
std::size_t ClosingQuote(std::string_view line, std::size_t open) {
  std::size_t quote = line.find('"', open + 1);
  while (quote < line.size() - 1 && line[quote + 1] == '"') quote = line.find('"', quote + 2);
  return quote;
}

}  // namespace

std::vector<CsvCell> CsvCellsOf(std::string_view line, char separator) {
  std::vector<CsvCell> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    std::size_t end = std::min(line.find(separator, begin), line.size());
    std::string_view fault;
    if (begin < line.size() && line[begin] == '"') {
      const std::size_t quote = ClosingQuote(line, begin);
      if (quote == std::string_view::npos) {
        fault = "its quote is not closed";
      } else {
        end = std::min(line.find(separator, quote), line.size());
        if (line.substr(quote + 1, end - quote - 1).find_first_not_of(' ') !=
            std::string_view::npos)
          fault = "there is more after its closing quote";
      }
    }
    std::size_t first = begin, last = end;
    while (first < last && (line[first] == ' ' || line[first] == '"')) ++first;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '"')) --last;
    cells.push_back({line.substr(first, last - first), static_cast<int>(first) + 1, fault});
    begin = end + 1;
  }
  return cells;
}

std::string AsCsvCell(std::string_view cell) {
  double number = 0;
  const std::string_view digits = cell.substr(cell.starts_with('+') ? 1 : 0);
  const char* const end = digits.data() + digits.size();
  const bool is_number = std::from_chars(digits.data(), end, number).ptr == end;
  const bool is_run = !cell.empty() &&
                      std::string_view("=+-@").find(cell.front()) != std::string_view::npos &&
                      !is_number;
  std::string text = is_run ? "'" : "";
  if (cell.find_first_of(",;\"\t\n") == std::string_view::npos) return text.append(cell);
  text.insert(0, "\"");
  for (const char c : cell) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

}  // namespace prehend
