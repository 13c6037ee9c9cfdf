// SPDX-License-Identifier: Apache-2.0
// Demonstrations of robots in an HDF5 file, as simulators write them: each group an episode, each
// entity one or two datasets of it. Tested by tests/program/import_hdf5.py
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/exchange/hdf5/hdf5_file.h"
#include "harness/exchange/poses/pose_file.h"

namespace prehend::exchange {

class Demonstrations {
 public:
  /// An error if there is none, or nothing says how many frames a second has. The map outlives it.
  static Result<Demonstrations> Open(const std::string& path, const MapFile& map);

  const Hdf5File& file() const { return file_; }
  /// "data/demo_0", "data/demo_1", ..
  const std::vector<std::string>& groups() const { return groups_; }
  double rate_hz() const { return rate_hz_; }
  /// The poses of one, by its group.
  Result<PoseFile> Read(const std::string& group) const;

 private:
  Demonstrations(Hdf5File file, const MapFile& map) : file_(std::move(file)), map_(&map) {}

  Hdf5File file_;
  const MapFile* map_;
  std::vector<std::string> groups_;
  double rate_hz_ = 0;
};

/// The groups that a pattern means: "data/*", "traj_*".
Result<std::vector<std::string>> GroupsLike(const Hdf5File& file, const std::string& pattern);

/// Frames per second, of robosuite's `env_args`; none if they do not say it.
std::optional<double> ControlRateOf(const Hdf5File& file, const std::string& group);

/// What the first demonstration has, as comments, and a map for it, as far as names tell; sizes,
/// and often the rate, are not in such files.
Result<std::string> ProposedMapOfDemonstrations(const std::string& path);

}  // namespace prehend::exchange
