// SPDX-License-Identifier: Apache-2.0
// The cells of a table of numbers, as programs write them. Tested by
// tests/harness/exchange/cells/table_cells_test.cc
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "harness/base/base/quoting.h"

namespace prehend::exchange {

enum class Separator { kComma, kSemicolon, kTab, kSpace };

/// Of a line; blanks and tabs are one separator, if it is kSpace.
std::vector<CsvCell> TableCellsOf(std::string_view line, Separator separator);

/// Finite or not; a plus sign before it is accepted.
std::optional<double> NumberOf(std::string_view cell, bool decimal_comma);

/// "2026-01-31T10:00:00.25Z", with a blank for the T, another zone, or the time of day only. The
/// seconds since 1970, or since midnight.
std::optional<double> SecondsOfIsoTime(std::string_view cell);

/// Times of day begin anew at midnight: then `time`, which is after `first`, is of the next day.
inline double AfterMidnight(double time, double first) {
  constexpr double kHalfDay_s = 43'200;
  return time < 2 * kHalfDay_s && time < first - kHalfDay_s ? time + 2 * kHalfDay_s : time;
}

}  // namespace prehend::exchange
