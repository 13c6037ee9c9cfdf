// SPDX-License-Identifier: Apache-2.0
// Poses of files of arrays and trees. Tested by tests/program/import_arrays.py
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/base/base/result.h"
#include "harness/exchange/poses/pose_file.h"
#include "harness/exchange/poses/table_layout.h"

namespace prehend::exchange {

inline constexpr std::size_t kMostJsonBytes = std::size_t{256} << 20;
inline constexpr std::size_t kMostJsonDepth = 100;
inline constexpr std::size_t kMostJsonValues = 4'000'000;   ///< of a frame
inline constexpr std::size_t kMostRowNumbers = 16'000'000;  ///< of all that a map asks for
inline constexpr std::size_t kMostJsonFrames = 1'000'000;

/// The joints of skeletons, each a body.
Result<PoseFile> ReadBvhPoses(const std::string& path, const MapFile& map);
/// JSON, or lines of it. One frame is kept at a time.
Result<PoseFile> ReadJsonPoses(const std::string& path, const MapFile& map);
/// The points of C3D. The file says some of what a map says: its map is read with that.
Result<TableLayout> LayoutOfC3d(const std::string& path);
Result<PoseFile> ReadC3dPoses(const std::string& path, const MapFile& map);
/// The arrays of NumPy's savez.
Result<PoseFile> ReadNpzPoses(const std::string& path, const MapFile& map);

// Which paths of JSON and arrays of .npz look like poses of bodies, by their names and by how many
// numbers they have: for a first map. Tested by tests/program/import_arrays.py

struct FoundBody {
  std::string called;  ///< words of which its name can be made
  std::string position, rotation, pose;
  bool has_order = true;  ///< of its quaternion: which number is w is known

  std::string From() const { return position.empty() ? pose : position; }
  /// "position: .., rotation: ..", as a map has them.
  std::string Keys() const;
};

class FoundPoses {
 public:
  /// Numbers that are called `name`, of something called `owner`: "hand right", or "".
  void Add(const std::string& owner, const std::string& name, const std::string& path,
           std::size_t width, bool has_order);
  /// The time among names with values.
  void AddTime(const std::map<std::string, std::vector<std::string>>& values);

  std::string keys;  ///< "frames: .." and "t: ..", a line each
  bool needs_rate = true;
  std::vector<FoundBody> bodies;   ///< some have only a rotation
  std::vector<std::string> aside;  ///< what has as many numbers, and no such name
};

Result<FoundPoses> FindJsonPoses(const std::string& path);
Result<FoundPoses> FindNpzPoses(const std::string& path);

// Paths into JSON, as maps of imports have them: "$.frames[*]", "hands[type=right].palm",
// "pos_{x,y,z}". Tested by tests/program/import_arrays.py

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
