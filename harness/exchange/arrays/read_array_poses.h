// SPDX-License-Identifier: Apache-2.0
// Poses of files of arrays and trees. Tested by tests/program/import_arrays.py
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
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
/// A value on each line: the first line is one, and others follow or the file is called so.
bool IsJsonLines(const std::string& path, std::string_view text);
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

  std::string keys;                             ///< "frames: .." and "t: ..", a line each
  bool needs_rate = true, is_of_unity = false;  ///< vectors are texts: "(0.1, 0.2, 0.3)"
  std::vector<FoundBody> bodies;                ///< some have only a rotation
  std::vector<std::string> aside;               ///< what has as many numbers, and no such name
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

// Poses from named rows of numbers, one for each frame: datasets of HDF5, arrays of NumPy, paths
// into JSON. Tested by tests/program/import_hdf5.py and tests/program/import_arrays.py

/// Of one name.
struct Rows {
  std::size_t count = 0, width = 0;
  bool is_matrix = false;  ///< each row is a matrix of 4 x 4
  bool by_name = false;    ///< its four numbers are x, y, z, w: the file says so
  std::string shape = {};  ///< "(220, 7) float32"
  std::vector<double> values;

  std::span<const double> At(std::size_t row) const { return {&values[row * width], width}; }
};

class RowSource {
 public:
  virtual ~RowSource() = default;
  /// Errors are at the name.
  virtual std::optional<Rows> Read(const Located<std::string>& name, DiagnosticList& errors) = 0;
  /// Empty, or of each row the line of the file.
  virtual std::vector<int> Lines() const { return {}; }
  /// How a map says which columns of a row it means: "NAME[0:3]"; "": it cannot.
  virtual std::string Columns(const std::string& name, std::size_t width) const;
  /// What a user should know, or "".
  virtual std::string Note() const { return ""; }
  bool nan_is_missing = false;  ///< whatever the map says
  bool knows_angles = false;    ///< three angles turn about the fixed x, then y, then z, in radians
};

/// Of lines that come one after the other, each with a frame: what was before.
struct RowStream {
  std::optional<double> first_time;  ///< in the file's unit
  std::size_t frames = 0;
};

/// What the map asks for. `file`: with its map's `t`, or with `rate_hz` frames a second.
/// `stream`: it is a line of these, and bodies that are not in it are not tracked in this frame.
Result<PoseFile> ReadRowPoses(RowSource& source, const MapFile& map, std::string file,
                              double rate_hz, RowStream* stream = nullptr);

/// All bytes of a file.
Result<std::string> ReadBytes(const std::string& path);
/// What is wrong with a file.
grammar::Diagnostics ErrorOfFile(const std::string& path, std::string why);

}  // namespace prehend::exchange
