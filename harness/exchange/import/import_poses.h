// SPDX-License-Identifier: Apache-2.0
// A file of poses and its map -> a recording in metres, z up, with one time base. Tested by
// tests/program/import_test.cc
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/episode/sense/episode_file.h"
#include "harness/exchange/arrays/read_hdf5_poses.h"
#include "harness/exchange/poses/pose_file.h"

namespace prehend::exchange {

/// Of the usual step: longer is a gap, in a file as in what arrives live.
inline constexpr double kGap = 1.5;

/// What became of one entity.
struct EntityReport {
  std::string name, from;  ///< from: the body, or "" if the map says where it stands
  std::size_t poses = 0;
  double rate_hz = 0;          ///< the usual one
  std::size_t bridged = 0;     ///< gaps that were filled
  double bridged_s = 0;        ///< of them all
  std::size_t lost = 0;        ///< gaps in which it is held where it was
  double lost_s = 0;           ///< of them all
  Eigen::AlignedBox3d extent;  ///< of its origin, in the recording
  /// How it is turned in its markers' axes, if the map says when it is upright.
  std::optional<Eigen::Quaterniond> axes;
};

struct Imported {
  episode::Recording episode;  ///< its frames are made when they are looked at
  std::size_t frames = 0;
  std::vector<EntityReport> entities;
  std::string openings;  ///< of each body made of markers, grip and joint a line
  double duration_s = 0;
  std::vector<std::string> warnings;  ///< one line each
};

/// The map as it is for this file of poses, and its poses.
Result<MapFile> ReadMapFor(const std::string& poses_path, PoseFormat format,
                           Result<YamlDocument> map);
Result<PoseFile> ReadPoses(const std::string& poses_path, PoseFormat format, const MapFile& map);

/// Of its recording.
episode::EpisodeHeader HeaderOf(const MapFile& map, const std::string& poses_path);
/// Where the entity is in the recording. `upright`: how it is turned in the file where it stands as
/// it is described.
PoseSample InRecording(const PoseSample& sample, const MappedEntity& entity, const ImportMap& map,
                       const std::optional<Eigen::Quaterniond>& upright);

/// What nobody can judge without orientations, sizes and hands: a warning each.
std::vector<std::string> UnknownOfBodies(const ImportMap& map, const PoseFile& file);

/// What the file has, as its map says.
Result<Imported> ImportPoses(PoseFile poses, const MapFile& map);
/// Reads, checks and converts. Nothing comes of a file with errors.
Result<Imported> ImportPoses(const std::string& poses_path, const std::string& map_path);

/// Extents, rates and gaps of each entity; and how it is turned in its markers' axes, where a time
/// says that.
std::string ImportTable(const Imported& imported);

/// A first map for a file, which `import` accepts: bodies, units, axes and times as they are known
/// or guessed; sizes are `unknown`; what is doubtful is said in comments.
Result<std::string> ProposedMap(const std::string& poses_path);

// The demonstrations of an HDF5 file, each a recording. Tested by tests/program/import_hdf5.py

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
