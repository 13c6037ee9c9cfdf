// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/import/import_demonstrations.h. Tested by tests/program/import_hdf5.py
#include "harness/exchange/import/import_demonstrations.h"

#include <algorithm>

#include "harness/exchange/import/compare_series.h"

namespace prehend::exchange {
namespace {

grammar::Diagnostics OfGroup(const std::string& group, grammar::Diagnostics errors) {
  for (grammar::Diagnostic& error : errors) error.message = group + ": " + error.message;
  return errors;
}

}  // namespace

Result<DemonstrationImport> DemonstrationImport::Open(const std::string& poses_path,
                                                      const std::string& map_path) {
  PREHEND_TRY(MapFile map, ReadImportMap(map_path, PoseFormat::kHdf5));
  DemonstrationImport import;
  import.map_ = std::make_unique<MapFile>(std::move(map));
  PREHEND_TRY(import.demonstrations_, Demonstrations::Open(poses_path, *import.map_));
  return import;
}

grammar::Diagnostics DemonstrationImport::WrongInMap() const {
  constexpr std::size_t kLooks = 10;
  const std::size_t step = std::max<std::size_t>(1, groups().size() / kLooks);
  std::size_t looked = 0, refused = 0;
  grammar::Diagnostics first;
  for (std::size_t i = 0; i < groups().size(); i += step) {
    ++looked;
    const std::string& group = groups()[i];
    const Result<PoseFile> poses = demonstrations_->Read(group);
    grammar::Diagnostics wrong;
    if (poses) wrong = OfGroup(group, CompareSeries(*demonstrations_, group, *poses, *map_));
    if (!wrong.empty()) return wrong;
    const Result<Imported> imported = Import(group);
    refused += !imported;
    if (!imported && first.empty()) first = imported.error();
  }
  return 2 * refused > looked ? first : grammar::Diagnostics{};
}

Result<Imported> DemonstrationImport::Import(const std::string& group) const {
  Result<PoseFile> poses = demonstrations_->Read(group);
  if (!poses) return tl::unexpected(OfGroup(group, std::move(poses.error())));
  Result<Imported> imported = ImportPoses(std::move(*poses), *map_);
  if (!imported) return tl::unexpected(OfGroup(group, std::move(imported.error())));
  return imported;
}

}  // namespace prehend::exchange
