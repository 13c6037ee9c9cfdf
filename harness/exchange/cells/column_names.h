// SPDX-License-Identifier: Apache-2.0
// What the names of the columns of a table of poses say: where positions, orientations, times and
// names of bodies stand. Tested by tests/harness/exchange/cells/column_names_test.cc
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "harness/exchange/cells/table_cells.h"

namespace prehend::exchange {

struct NamedColumns {
  Separator separator = Separator::kComma;
  bool decimal_comma = false;
  int header_line = 1;
  std::string time;               ///< "": no column is called so
  std::string time_unit;          ///< as a map says it
  std::string time_doubt;         ///< "", or why it could be another one
  std::string unit;               ///< of positions, if their names say it
  std::vector<std::string> keys;  ///< columns with names of bodies
  /// '{}' stands for the body's name, unless a row or the file is of one.
  std::vector<std::string> position, orientation;
  OrientationForm form = OrientationForm::kQuaternion;
  bool in_degrees = false;          ///< of angles: some are larger than a turn in radians, or said
  bool roll_first = false;          ///< they are called roll, pitch and yaw
  std::vector<std::string> others;  ///< columns that are none of these
};

struct NamedTime {
  std::string name, unit, doubt;  ///< as those of NamedColumns
};

using CellsOfName = std::function<std::vector<std::string>(const std::string&)>;

/// Which of the names is that of a time, and its unit, by its name or by its values.
NamedTime TimeAmong(const std::vector<std::string>& names, const CellsOfName& cells_of,
                    bool decimal_comma);

/// "cup" of the pattern "{}_x" and the column "cup_x".
std::optional<std::string> BodyOfColumn(const std::string& pattern, const std::string& name);

/// By the first lines of a table; nothing if no three columns are called x, y and z.
std::optional<NamedColumns> ColumnsOf(std::string_view text);

// What the names of bodies say: hands, bones of a skeleton, tables. Tested by
// tests/program/import_propose_test.cc

using Words = std::vector<std::string>;

/// "global:LeftHand_2" -> left, hand, 2.
Words WordsIn(const std::string& name);

/// Also with a letter for the side: "lhand".
bool AnyOf(const Words& words, const std::set<std::string>& of);
/// A bone of a skeleton that is no hand.
bool IsBone(const Words& words);
bool IsHand(const Words& words);
bool IsTable(const Words& words);

}  // namespace prehend::exchange
