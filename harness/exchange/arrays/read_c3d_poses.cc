// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/arrays/read_array_poses.h: the points of C3D files, each a body without
// orientation, or a marker of one. Tested by tests/program/import_markers.py
#include <fmt/format.h>

#include <algorithm>

#include "harness/exchange/arrays/c3d_file.h"
#include "harness/exchange/arrays/read_array_poses.h"
#include "harness/exchange/arrays/row_poses.h"
#include "harness/exchange/poses/marker_bodies.h"
#include "harness/exchange/poses/table_layout.h"

namespace prehend::exchange {
namespace {

/// Its positions, of a body or a marker of the map.
void TakePoint(const C3dFile& file, const Located<std::string>& from, const ImportMap& map,
               PoseBody& body, DiagnosticList& errors) {
  const auto label = std::ranges::find(file.labels, from.value);
  if (label == file.labels.end())
    return errors.AddUnknownName(from.where, fmt::format("no point is called '{}'", from.value),
                                 from.value, file.labels);
  if (std::ranges::count(file.labels, from.value) > 1)
    return errors.Add(from.where, fmt::format("several points are called '{}'", from.value));
  const auto point = static_cast<std::size_t>(label - file.labels.begin());
  for (std::size_t i = 0; i < file.frames; ++i) {
    const auto at = file.At(i, point);
    if (at && !(map.zero_is_missing && at->isZero(0)))
      body.samples.push_back({.t_s = static_cast<double>(i) / map.rate_hz->value, .p = *at});
  }
}

}  // namespace

Result<PoseFile> ReadC3dPoses(const std::string& path, const std::string& map_path, MapFile& map) {
  Result<std::string> bytes = ReadBytes(path);
  if (!bytes) return tl::unexpected(std::move(bytes.error()));
  C3dFile file;
  if (const std::string why = file.Load(std::move(*bytes)); !why.empty())
    return tl::unexpected(ErrorOfFile(path, why));
  TableLayout layout{.name = "a C3D file", .unit = UnitCalled(file.unit)};
  if (file.rate_hz > 0) layout.rate_hz = file.rate_hz;
  Result<MapFile> read = ReadMapWith(map_path, PoseFormat::kC3d, layout);
  if (!read) return tl::unexpected(std::move(read.error()));
  map = std::move(*read);
  DiagnosticList errors(map.document);
  if (!map.map.rate_hz)
    errors.Add(map.document.root.where, "'rate_hz' is missing: the file does not say it");
  PoseFile poses{.file = path, .bodies = BodiesOf(map.map, errors), .markers = MarkersOf(map.map)};
  poses.has_orientations = false;
  poses.rows = file.frames;
  for (const Named<MappedEntity>& entity : map.map.entities) {
    if (!errors.empty()) break;
    if (entity.value.from && entity.value.markers.empty())
      TakePoint(file, *entity.value.from, map.map,
                *std::ranges::find(poses.bodies, entity.value.from->value, &PoseBody::name),
                errors);
    for (const Located<std::string>& marker : entity.value.markers) {
      PoseBody& body = *std::ranges::find(poses.markers, marker.value, &PoseBody::name);
      if (body.samples.empty()) TakePoint(file, marker, map.map, body, errors);
    }
  }
  if (errors.empty()) {
    poses.last_s = static_cast<double>(file.frames - 1) / map.map.rate_hz->value;
    poses.notes = file.notes;
    const auto is_asked = [&](const std::string& label) {
      return std::ranges::find(poses.bodies, label, &PoseBody::name) != poses.bodies.end() ||
             std::ranges::find(poses.markers, label, &PoseBody::name) != poses.markers.end();
    };
    for (const std::string& label : file.labels)
      if (!is_asked(label) && !label.starts_with('*')) poses.unused.push_back(label);
    ComposeMarkers(map.map, poses, errors);
  }
  if (errors.empty()) RefuseAbsentBodies(poses, map.map, errors);
  if (!errors.empty()) return tl::unexpected(errors.Sorted());
  return poses;
}

}  // namespace prehend::exchange
