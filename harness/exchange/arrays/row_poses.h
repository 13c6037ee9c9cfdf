// SPDX-License-Identifier: Apache-2.0
// Poses from named rows of numbers, one for each frame: datasets of HDF5, arrays of NumPy, paths
// into JSON. Tested by tests/program/import_hdf5.py and tests/program/import_arrays.py
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/exchange/poses/pose_file.h"

namespace prehend::exchange {

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
