// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/cells/table_cells.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <string>

namespace prehend::exchange {
namespace {

/// Takes `count` digits and what follows them, one of `after`, off the text; -1 if they are not
/// there.
int TakeDigits(std::string_view& text, std::size_t count, std::string_view after) {
  int value = 0;
  if (text.size() < count) return -1;
  for (const char c : text.substr(0, count)) {
    if (c < '0' || c > '9') return -1;
    value = 10 * value + (c - '0');
  }
  text.remove_prefix(count);
  if (after.empty()) return value;
  if (text.empty() || after.find(text.front()) == std::string_view::npos) return -1;
  text.remove_prefix(1);
  return value;
}

/// "Z", "", "+02:00", "-0530".
std::optional<double> ZoneOf(std::string_view text) {
  if (text.empty() || text == "Z") return 0;
  const double sign = text.front() == '-' ? -1 : 1;
  if (text.front() != '+' && text.front() != '-') return std::nullopt;
  text.remove_prefix(1);
  const int hours = TakeDigits(text, 2, "");
  if (text.starts_with(':')) text.remove_prefix(1);
  const int minutes = text.empty() ? 0 : TakeDigits(text, 2, "");
  if (hours < 0 || minutes < 0 || !text.empty()) return std::nullopt;
  return sign * (3600 * hours + 60 * minutes);
}

}  // namespace

std::vector<CsvCell> TableCellsOf(std::string_view line, Separator separator) {
  if (separator != Separator::kSpace) {
    constexpr std::array kSeparators = {',', ';', '\t'};
    return CsvCellsOf(line, kSeparators[static_cast<std::size_t>(separator)]);
  }
  std::vector<CsvCell> cells;
  for (std::size_t end = 0, begin; (begin = line.find_first_not_of(" \t", end)) < line.size();) {
    end = std::min(line.find_first_of(" \t", begin), line.size());
    cells.push_back({line.substr(begin, end - begin), static_cast<int>(begin) + 1});
  }
  if (cells.empty()) cells.emplace_back();
  return cells;
}

std::optional<double> NumberOf(std::string_view cell, bool decimal_comma) {
  if (cell.starts_with('+') && !cell.starts_with("+-")) cell.remove_prefix(1);
  std::string with_point;
  if (decimal_comma && cell.find('.') == std::string_view::npos) {
    with_point = cell;
    std::ranges::replace(with_point, ',', '.');
    cell = with_point;
  }
  double value = 0;
  const char* const end = cell.data() + cell.size();
  const auto [rest, error] = std::from_chars(cell.data(), end, value);
  if (error != std::errc() || rest != end) return std::nullopt;
  return value;
}

std::optional<double> SecondsOfIsoTime(std::string_view cell) {
  double days = 0;
  if (cell.find(':') != 2) {
    const int year = TakeDigits(cell, 4, "-/"), month = TakeDigits(cell, 2, "-/"),
              day = TakeDigits(cell, 2, "T ");
    const std::chrono::year_month_day date{std::chrono::year(year),
                                           std::chrono::month(static_cast<unsigned>(month)),
                                           std::chrono::day(static_cast<unsigned>(day))};
    if (year < 0 || month < 0 || day < 0 || !date.ok()) return std::nullopt;
    days = static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
  }
  const int hour = TakeDigits(cell, 2, ":"), minute = TakeDigits(cell, 2, ":");
  const std::size_t zone_at = std::min(cell.find_first_of("Z+-"), cell.size());
  const auto seconds = NumberOf(cell.substr(0, zone_at), true);
  const auto zone = ZoneOf(cell.substr(zone_at));
  if (hour < 0 || hour > 24 || minute < 0 || minute > 59 || !seconds || !(*seconds < 61) || !zone)
    return std::nullopt;
  return 86400 * days + 3600 * hour + 60 * minute + *seconds - *zone;
}

}  // namespace prehend::exchange
