// SPDX-License-Identifier: Apache-2.0
// Poses of files of arrays and trees. Tested by tests/program/import_arrays.py
#pragma once

#include <string>

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

}  // namespace prehend::exchange
