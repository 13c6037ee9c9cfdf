// SPDX-License-Identifier: Apache-2.0
// Tables of poses as trackers export them, known by their heads: Motive, Vicon, Qualisys, TRC,
// EuRoC; and by their rows: TUM, KITTI. What such a file says of itself the map need not. Tested by
// tests/program/import_layouts_test.cc
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "harness/exchange/poses/import_map.h"

namespace prehend::exchange {

struct TableLayout {
  std::string name;     ///< "a CSV file of Motive"
  bool yields = false;  ///< to the columns of the map: a plain table that has names, or none
  Separator separator = Separator::kComma;
  int first_row = 1;                 ///< the line
  bool ends_at_blank = false;        ///< another part follows a blank line
  std::vector<std::string> names;    ///< of the columns
  std::vector<std::string> turning;  ///< bodies with orientations
  Columns columns;
  std::optional<Unit> unit;
  bool says_unit = true;  ///< else it is usual
  std::optional<TimeUnit> time_unit;
  bool says_time_unit = true;         ///< likewise
  std::optional<double> rate_hz;      ///< it is compared with the times, if there are some
  std::optional<std::size_t> frames;  ///< that it should have
  std::optional<QuaternionOrder> quaternion_order;
  std::optional<std::string> euler_order;
  std::optional<bool> angles_in_degrees;
  bool zero_is_missing = false;
  std::string error;  ///< how the tracker's error of a body is called
  std::vector<std::string> notes;
};

/// By the first lines of a file.
std::optional<TableLayout> LayoutOf(std::string_view text);
Result<std::optional<TableLayout>> LayoutOfTable(const std::string& table);
/// Of a text that begins as a tracker's table with a long head: it has no row yet.
std::optional<bool> HeadGoesOn(std::string_view text);

/// With what a file says of itself, if it says anything; where the map says otherwise, that is an
/// error.
Result<MapFile> ReadMapWith(Result<YamlDocument> document, PoseFormat format,
                            std::optional<TableLayout> layout);
/// With what the file `table` says of itself; where the map says otherwise, that is an error.
Result<MapFile> ReadMapOfTable(Result<YamlDocument> document, const std::string& table);
/// Likewise of a table that begins so.
Result<MapFile> ReadMapOfHead(Result<YamlDocument> document, std::string_view head);

/// What is wrong with the numbers of frames that a head says, or "".
std::string CountDoubt(const std::set<std::size_t>& said, std::size_t there);

/// Where the values of a body stand in a row.
struct Seats {
  std::vector<std::size_t> all;      ///< three of its position, then those of its orientation
  std::optional<std::size_t> error;  ///< of its orientation and position, as the tracker says
};

/// The name of a column in which '{}' stands for that of a body.
std::string WithBody(const std::string& column, const std::string& body);

}  // namespace prehend::exchange
