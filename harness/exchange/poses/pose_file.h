// SPDX-License-Identifier: Apache-2.0
// Poses of bodies over time, as a file has them: its own unit, axes and names. Tested by
// tests/program/import_test.cc
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/base/base/paged_memory.h"
#include "harness/episode/sense/episode_file.h"
#include "harness/exchange/poses/import_map.h"

namespace prehend::exchange {

inline constexpr std::size_t kMaxPoseFileBytes = std::size_t{1} << 30;

struct PoseSample {
  double t_s = 0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();            ///< in the file's unit and axes
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  ///< in the file's axes
  int line = 0;                                           ///< 0: the file has no lines
  bool after_loss = false;                                ///< how it came here is not known
};

/// Whoever has gone through one lets go of it: those of all bodies may be larger than memory.
using PoseSeries = PagedVector<PoseSample>;

struct PoseBody {
  std::string name;
  PoseSeries samples;   ///< times increase; where it is not tracked there is none
  bool stands = false;  ///< it is known once, and for ever
};

/// How far a gripper or a joint of the map is open, over time.
struct OpeningSeries {
  struct Sample {
    double t_s = 0;
    double open = 0;  ///< Opening::FractionOf
    int line = 0;     ///< 0: the file has no lines
  };
  std::size_t entity = 0;       ///< of the map
  bool is_grip = false;         ///< else a joint
  std::vector<Sample> samples;  ///< times increase; where nothing is known there is none

  /// What the map says of it.
  const Opening& Of(const ImportMap& map) const;
};

struct PoseFile {
  std::string file;
  std::string text;                     ///< of the file, for messages
  std::vector<PoseBody> bodies;         ///< those of the map, in its order
  std::vector<PoseBody> markers;        ///< of which bodies are made
  std::string quality;                  ///< of each of these a line
  std::vector<OpeningSeries> openings;  ///< those of OpeningsOf(), in this order
  std::vector<std::string> unused;      ///< names of bodies that the map does not mention
  episode::EpisodeAttributes attributes;
  std::vector<std::string> notes;  ///< what a user should know, one line each
  /// Of a skeleton: from its feet to its head, in the file's unit and axes.
  std::optional<Eigen::Vector3d> stature;
  std::optional<QuaternionOrder> quaternion_order;  ///< as they were read; none: there are none
  double most_angle = 0;         ///< of angles and axes times angles, as they are in the file
  bool has_orientations = true;  ///< else only positions
  bool counts_frames = false;    ///< its times, in a unit of time, are whole and grow by one each
  std::size_t rows = 0, zeros = 0;  ///< zeros: poses at 0, 0, 0, which the map says are none
  double first_s = 0, last_s = 0;   ///< of all rows, also of those in which nothing is tracked
  std::vector<double> rows_s;       ///< their times, where what is lost is lost in rows
};

/// "": there is none.
void AddNote(PoseFile& poses, std::string note);
/// The bodies of the map, without poses. One that is two entities is an error.
std::vector<PoseBody> BodiesOf(const ImportMap& map, DiagnosticList& errors);
/// The grips and joints of the map, without values.
std::vector<OpeningSeries> OpeningsOf(const ImportMap& map);
/// Bodies with less than two poses are errors.
void RefuseAbsentBodies(const PoseFile& poses, const ImportMap& map, DiagnosticList& errors);

void BeginAtZero(PoseFile& poses);
/// Left-handed positions and orientations, seen in a mirror.
void MirrorPoses(const ImportMap& map, PoseFile& poses);

/// Errors name the place, in the map or in the file of poses; at most a dozen.
Result<PoseFile> ReadCsvPoses(const std::string& path, const MapFile& map);
/// Lines of a table, or of JSON, while they come.
class PoseLines {
 public:
  /// `head`: the lines up to the first row of poses; they are taken, too, after that.
  PoseLines(const std::string& name, std::string head, const MapFile& map);
  /// Of JSON, a frame each. Their places are those of the map that stays.
  PoseLines(const std::string& name, const MapFile& map);
  /// Returns what is wrong with the line. Its time, if it is a row, and what it says of bodies and
  /// openings are known until the next one.
  grammar::Diagnostics Take(const std::string& line) { return take_(line, row_s_); }
  const std::optional<double>& row_s() const { return row_s_; }
  const PoseFile& poses() const { return *poses_; }

 private:
  std::function<grammar::Diagnostics(const std::string&, std::optional<double>&)> take_;
  const PoseFile* poses_ = nullptr;
  std::optional<double> row_s_;
};

/// JSON that is no recording of our own: the file's name and its first line say so.
bool IsJsonOfPoses(const std::string& poses_path);

bool IsBag(const std::string& poses_path);
bool IsDb3(const std::string& poses_path);

/// Whether it is called as files of poses usually are; others are not looked for in folders.
bool IsNamedAsPoses(const std::string& path);

/// A kind of file that is not read is an error that says what helps.
Result<PoseFormat> PoseFormatOf(const std::string& poses_path);

// Bodies made of markers: the rigid motion that moves their shape nearest to where they were seen,
// least squares, in each frame. Tested by tests/program/import_markers.py

/// The markers of the map, without positions, each once.
std::vector<PoseBody> MarkersOf(const ImportMap& map);

/// Poses of the bodies of the map that have markers, from `poses.markers`. Their origin is the mean
/// of the markers; x points from the first to the second of them. Frames in which they are farther
/// off their shape than the map allows have no pose, and are named.
void ComposeMarkers(const ImportMap& map, PoseFile& poses, DiagnosticList& errors);

/// Counts poses whose error, as the tracker says, is more than the map allows.
struct MarkerErrors {
  std::size_t count = 0, of = 0;
  double most = 0, most_s = 0;  ///< in the file's unit
  int line = 0;

  /// False: it is too large.
  bool Take(double error, double limit, double t_s, int line_of_file);
  /// "'Cup': 3 of 301 poses ..", or "".
  std::string Text(const std::string& body, const std::string& what, const std::string& file,
                   double metres_per_unit, double limit_m) const;
};

}  // namespace prehend::exchange
