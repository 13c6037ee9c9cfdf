// SPDX-License-Identifier: Apache-2.0
// Paths into JSON, as maps of imports have them: "$.frames[*]", "hands[type=right].palm",
// "pos_{x,y,z}". Tested by tests/program/import_arrays.py
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace prehend::exchange {

struct JsonStep {
  enum class Kind { kKey, kIndex, kAll, kMatch } kind = Kind::kKey;
  std::string key;        ///< of kMatch: whose value is
  std::string value;      ///< this
  std::size_t index = 0;  ///< of kIndex
};

using JsonPath = std::vector<JsonStep>;

/// None if it is none. A "$" or "@" at the beginning may be left out.
std::optional<JsonPath> ParseJsonPath(std::string_view text);

/// "a_{x,y}.b" is "a_x.b" and "a_y.b".
std::vector<std::string> WithoutBraces(const std::string& text);

/// Where a path ends that leads nowhere.
struct JsonMiss {
  std::size_t steps = 0;           ///< that it went
  std::string name;                ///< that is not there
  std::vector<std::string> names;  ///< that are there instead
};

/// Null if there is nothing: then `miss` says why, unless a null is in the way.
const nlohmann::json* FindInJson(const nlohmann::json& root, const JsonPath& path, JsonMiss& miss);

/// Appends the numbers of a value: of lists those in them, of {x, y, z, w} in this order, of
/// members that end in two digits (m00, m01, ..) by their names, of text "(1, 2, 3)". NaN for null.
/// `by_name`: it is {x, y, z, w}. False if it is something else.
bool NumbersOfJson(const nlohmann::json& value, std::vector<double>& numbers, bool& by_name);

}  // namespace prehend::exchange
