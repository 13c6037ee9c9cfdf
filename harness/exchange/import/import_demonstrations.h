// SPDX-License-Identifier: Apache-2.0
// The demonstrations of an HDF5 file, each a recording.
// Tested by tests/program/import_hdf5.py
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/exchange/arrays/read_hdf5_poses.h"
#include "harness/exchange/import/import_poses.h"

namespace prehend::exchange {

class DemonstrationImport {
 public:
  static Result<DemonstrationImport> Open(const std::string& poses_path,
                                          const std::string& map_path);

  const std::vector<std::string>& groups() const { return demonstrations_->groups(); }
  /// What is wrong with the map, as a few demonstrations show: nothing comes of the others then.
  grammar::Diagnostics WrongInMap() const;
  Result<Imported> Import(const std::string& group) const;

 private:
  std::unique_ptr<MapFile> map_;
  std::optional<Demonstrations> demonstrations_;
};

}  // namespace prehend::exchange
