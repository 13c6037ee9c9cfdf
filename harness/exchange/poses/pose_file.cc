// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/poses/pose_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>

#include "harness/base/base/text_file.h"

namespace prehend::exchange {

std::vector<PoseBody> BodiesOf(const ImportMap& map, DiagnosticList& errors) {
  std::vector<PoseBody> bodies;
  for (const Named<MappedEntity>& entity : map.entities) {
    if (!entity.value.from) continue;
    const std::string& name = entity.value.from->value;
    if (std::ranges::find(bodies, name, &PoseBody::name) != bodies.end())
      errors.Add(entity.value.from->where, fmt::format("'{}' is two entities", name));
    else
      bodies.push_back({.name = name});
  }
  return bodies;
}

std::vector<OpeningSeries> OpeningsOf(const ImportMap& map) {
  std::vector<OpeningSeries> openings;
  for (std::size_t i = 0; i < map.entities.size(); ++i) {
    for (const bool is_grip : {true, false}) {
      const MappedEntity& e = map.entities[i].value;
      if (is_grip ? e.grip : e.joint) openings.push_back({.entity = i, .is_grip = is_grip});
    }
  }
  return openings;
}

const Opening& OpeningSeries::Of(const ImportMap& map) const {
  const MappedEntity& e = map.entities[entity].value;
  return is_grip ? *e.grip : *e.joint;
}

void RefuseAbsentBodies(const PoseFile& poses, const ImportMap& map, DiagnosticList& errors) {
  for (const Named<MappedEntity>& entity : map.entities) {
    if (!entity.value.from || map.is_draft) continue;
    const Located<std::string>& from = *entity.value.from;
    const std::size_t count =
        std::ranges::find(poses.bodies, from.value, &PoseBody::name)->samples.size();
    if (count >= 2) continue;
    errors.AddUnknownName(
        from.where,
        fmt::format("'{}' has {} poses in the file; at least 2 are needed", from.value, count),
        from.value, poses.unused);
  }
}

void MirrorPoses(const ImportMap& map, PoseFile& poses) {
  for (PoseBody& body : poses.bodies) {
    for (PoseSample& sample : body.samples) {
      sample.p = map.Mirrored(sample.p);
      // Turns are the other way round, but for the part about the mirror's own axis.
      sample.q.vec() = -map.Mirrored(sample.q.vec());
    }
    LetGo(body.samples);
  }
  if (poses.stature) poses.stature = map.Mirrored(*poses.stature);
}

namespace {

std::string EndingOf(const std::string& poses_path) {
  std::string ending = std::filesystem::path(poses_path).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

}  // namespace

bool IsBag(const std::string& poses_path) { return EndingOf(poses_path) == ".bag"; }
bool IsDb3(const std::string& poses_path) { return EndingOf(poses_path) == ".db3"; }

bool IsJsonOfPoses(const std::string& poses_path) {
  const Result<PoseFormat> format = PoseFormatOf(poses_path);
  std::ifstream file(poses_path, std::ios::binary);
  std::string head(200, ' ');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return format && *format == PoseFormat::kJson &&
         head.substr(0, head.find('\n')).find("\"recording\":") == std::string::npos;
}

bool IsNamedAsPoses(const std::string& path) {
  constexpr std::array kTables = {".csv", ".tsv", ".txt", ".trc", ".tum"};
  const Result<PoseFormat> format = PoseFormatOf(path);
  if (!format) return false;
  if (*format == PoseFormat::kCsv)
    return std::ranges::find(kTables, EndingOf(path)) != kTables.end();
  return *format != PoseFormat::kJson || IsJsonOfPoses(path);
}

Result<PoseFormat> PoseFormatOf(const std::string& poses_path) {
  const std::string ending = EndingOf(poses_path);
  if (ending == ".bvh") return PoseFormat::kBvh;
  if (ending == ".hdf5" || ending == ".h5") return PoseFormat::kHdf5;
  if (ending == ".json" || ending == ".jsonl" || ending == ".ndjson") return PoseFormat::kJson;
  if (ending == ".npz") return PoseFormat::kNpz;
  if (ending == ".c3d") return PoseFormat::kC3d;
  if (ending == ".mcap" || ending == ".bag" || ending == ".db3") return PoseFormat::kMcap;
  static const std::string kTable = "write its poses to a CSV file: one row a time, named columns";
  static const std::map<std::string, std::string> kOthers = {
      {".npy", "write it with its times and others as .npz: numpy.savez"},
      {".pkl", "pickles run code when they are read: write its arrays as HDF5 with h5py"},
      {".parquet",
       "write its poses as CSV, or as HDF5 with h5py; Python passes tables (docs/python.md)"},
      {".fbx", "export it as BVH"},
      {".pickle", "pickles run code when they are read: write its arrays as HDF5 with h5py"},
      {".mat", kTable},
      {".xlsx", "save the sheet as CSV"},
      {".xls", "save the sheet as CSV"},
      {".ods", "save the sheet as CSV"},
      {".zip", "unpack it"},
      {".gz", "unpack it"},
      {".zst", "unpack it"},
      {".zstd", "unpack it"},
      {".7z", "unpack it"}};
  const auto other = kOthers.find(ending);
  if (other == kOthers.end()) return PoseFormat::kCsv;
  return tl::unexpected(grammar::Diagnostics{
      {.file = ReadableName(poses_path),
       .message = fmt::format(
           "files {} are not read; CSV, BVH, MCAP, bags of ROS, HDF5, JSON, .npz and C3D are",
           ending),
       .hint = other->second}});
}

}  // namespace prehend::exchange
