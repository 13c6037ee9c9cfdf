// SPDX-License-Identifier: Apache-2.0
// The map of an import: what a file of poses means. Its keys are in docs/motion-capture.md. Tested
// by tests/program/import_test.cc
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/base/base/result.h"
#include "harness/base/yaml/struct_format.h"
#include "harness/exchange/cells/table_cells.h"

namespace prehend::exchange {

/// What is imported, by the ending of its name. Bags of ROS 1 hold messages as MCAP files do.
enum class PoseFormat { kCsv, kBvh, kMcap, kHdf5, kJson, kNpz, kC3d };
enum class TimeUnit { kSecond, kMillisecond, kMicrosecond, kNanosecond, kFrame, kIso };
enum class Lost { kRefuse, kHold, kUnknown, kInRows };
enum class OutlierRule { kKeep, kLost };
enum class Clock { kHeader, kLog, kPublish };
/// What looks wrong, and is accepted because the map says that it is right.
enum class Warning { kUnit, kAxes, kOrder, kTime, kPlace, kZero, kUpright, kHanded, kAngles };

inline constexpr std::array kWarningNames = {
    "unit", "axes", "quaternion_order", "time", "place", "zero", "upright", "handed", "angle_unit"};

inline constexpr double kMostSmooth_s = 2;

/// The names of columns. `{}` in a name stands for the body's name: then a row has all bodies.
struct Columns {
  Where where;
  /// Hold the body's name, of several joined by '/': then a row has one body.
  std::vector<Located<std::string>> body;
  std::optional<Located<std::string>> time;
  std::vector<Located<std::string>> position;  ///< of x, y, z
  /// One of them, or none; by OrientationForm.
  std::vector<Located<std::string>> quaternion, euler, matrix, axis_angle;

  /// Of the orientation; nothing is turned without.
  const std::vector<Located<std::string>>& Orientation() const;
  OrientationForm Form() const;
  /// No column has the name of a body, and none has '{}' for it.
  bool IsOfOneBody() const;
};

/// Of MCAP files.
struct McapKeys {
  Where where;
  std::optional<Located<std::string>> world;  ///< the coordinate frame that is the recording's
  Clock clock = Clock::kHeader;               ///< which of a message's times counts
};

/// Of HDF5 files.
struct Hdf5Keys {
  Where where;
  Located<std::string> episodes = {"data/*", {}};  ///< the groups that are demonstrations
  /// "@success" is an attribute of the group, "success" a dataset, whose last value counts.
  std::optional<Located<std::string>> success;
  std::optional<Located<std::string>> language;
  int skip = 0;  ///< frames at the beginning
};

/// "left + right"
std::string NamesOf(const std::vector<Located<std::string>>& all);

struct ImportMap;

/// Numbers of the file that say how far a gripper or a joint is open.
struct Opening {
  Where where;
  std::vector<Located<std::string>> from;  ///< of several, their sum counts
  bool sum_abs = false;                    ///< the sum of them without their signs
  double open = 0, closed = 0;             ///< what the file has there, in its own unit
  std::optional<Unit> unit;                ///< of a joint; none: that of positions

  /// Of the numbers at one time, in the order of `from`: 0 closed .. 1 open, and beyond.
  double FractionOf(std::span<const double> numbers) const;
  /// Of a joint that is so far open, in m or rad.
  double PositionAt(double fraction, const ImportMap& map) const;
  std::string Names() const;  ///< "left + right"
};

/// Where a sub-task of a demonstration ends: at a boundary of an event.
struct SubtaskLabel {
  Where where;
  bool at_end = false;  ///< of the event; else where it begins
  Located<std::string> of;
  std::optional<Located<std::string>> hand, object;
  std::optional<Located<std::string>> required;  ///< an event that holds then: "supported_by(a, b)"
};

/// One entity of the recording.
struct MappedEntity {
  std::optional<Located<std::string>> from;  ///< the body in the file
  /// Of HDF5 and NumPy, arrays, with their columns: "obs/object[0:3]"; of JSON, paths in a frame.
  /// `from` is the first of them.
  std::optional<Located<std::string>> pose, position, quaternion, euler, axis_angle, rotation;
  /// Of tables and C3D: it is made of these; `from` is their names.
  std::vector<Located<std::string>> markers;
  double residual_m = 0.01;                   ///< the farthest that markers may be off their shape
  std::optional<Located<std::string>> first;  ///< its pose before the first row
  int shift = 0;                              ///< frames by which the rows come later
  std::optional<Eigen::Vector3d> at_m;        ///< of what no tracker sees
  Eigen::Vector4d quat_wxyz = {1, 0, 0, 0};
  bool hand = false;
  bool fixed = false;
  Located<std::string> class_name = {"Object", {}};
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  bool guesses_size = false;  ///< the map says that it is unknown
  /// From the markers' origin to the entity's, in the body's frame, z up, metres.
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
  std::optional<Located<double>> upright_at_s;  ///< when it stands as it is described, not turned
  /// How it is turned in its markers' axes, this or the time.
  std::optional<Located<Eigen::Vector4d>> axes_quat_wxyz;
  std::optional<Located<Eigen::Vector3d>> ahead;  ///< of a hand: where it reaches, likewise; x
  std::optional<Located<std::string>> part_of;    ///< another entity, to which it is fixed
  std::optional<Opening> grip;                    ///< of a hand
  std::optional<Opening> joint;                   ///< of a drawer or a door
};

/// What it is by its keys, if it is no hand.
inline std::vector<std::string> RootsOf(const MappedEntity& e) {
  const char* moves = e.joint ? "Jointed" : e.part_of ? "Attached" : e.fixed ? "Fixed" : "Movable";
  return {moves, "Thing", "Entity"};
}

/// Whether the map says how it is turned in its markers' axes.
inline bool SaysAxes(const MappedEntity& e) { return e.upright_at_s || e.axes_quat_wxyz; }

/// The whole file.
struct ImportMap {
  int version = 1;
  std::string episode;  ///< "": as the file of poses is called
  Located<std::string> grammar = {"pick_and_place_from_motion", {}};
  std::optional<Located<Unit>> unit;               ///< this, or
  std::optional<Located<double>> metres_per_unit;  ///< this
  std::optional<Located<int>> axes;  ///< which axis of the file is up: 0 x, 1 y, 2 z; this or
  std::optional<Located<Eigen::Vector3d>> up;  ///< the direction of up in the file's axes, or both
  bool is_left_handed = false;  ///< the file's axes; positions and orientations are mirrored
  std::optional<Located<QuaternionOrder>> quaternion_order;
  std::optional<Located<std::string>> euler_order;
  std::optional<Located<bool>> angles_in_degrees;
  std::optional<Located<TimeUnit>> time_unit;  ///< of CSV; of `t`
  std::optional<Located<std::string>> frames;  ///< of JSON: the path to them; none: the lines
  std::optional<Located<std::string>> t;       ///< of JSON and NumPy: the times
  std::optional<Located<double>> rate_hz;
  Separator separator = Separator::kComma;
  bool decimal_comma = false;
  int header_line = 0;               ///< 0: the first; of lines with '#', the one with the names
  std::vector<std::string> missing;  ///< cells that mean "not tracked", besides empty ones
  bool zero_is_missing = false;
  double bridge_s = 0.1;     ///< the longest gap that is filled with a straight line
  bool says_bridge = false;  ///< the map does
  Lost lost = Lost::kRefuse;
  std::optional<Located<double>> end_s;      ///< none: at its last row
  OutlierRule outlier = OutlierRule::kKeep;  ///< of poses that leave and come back too fast
  double smooth_s = 0;  ///< poses are means over so long, where nothing was lost
  std::vector<Warning> sure;
  std::int64_t ticks_per_second = 10'000;
  bool is_draft = false;  ///< bodies without poses are no error, and all others are `unused`
  Columns columns;        ///< of CSV only
  McapKeys mcap;
  Hdf5Keys hdf5;
  std::vector<Named<MappedEntity>> entities;
  std::vector<Named<SubtaskLabel>> labels;  ///< of what is written back, in their order
  std::vector<Named<std::string>> text;     ///< of each sub-task, and of the "rest"

  bool IsSure(Warning warning) const;
  /// Of a body.
  std::size_t LeastPoses() const { return lost == Lost::kInRows ? 1 : 2; }
  double MetresPerUnit() const;
  /// Of `time_unit`.
  double SecondsPerUnit() const;
  /// Of `columns`.
  OrientationFormat Orientation() const;
  /// From the file's axes to those of which `axes` is z: of positions, and of bodies' own axes.
  Eigen::Quaterniond AxesTurn() const;
  /// From the file's axes to the recording's, z up: of positions. Where `axes` has left it, `up`
  /// turns the world on, the shortest way, and not the bodies' own axes.
  Eigen::Quaterniond WorldTurn() const;
  /// In the file's axes.
  Eigen::Vector3d Up() const;
  /// Of left-handed axes, seen in a mirror across the way up: they are right-handed then.
  Eigen::Vector3d Mirrored(Eigen::Vector3d v) const;
  /// Where the map says what is up.
  const Where& UpWhere() const { return up ? up->where : axes->where; }
  /// Where the map says it.
  const Where& UnitWhere() const { return unit ? unit->where : metres_per_unit->where; }
};

struct TableLayout;

/// The map with the document that its places refer to.
struct MapFile {
  YamlDocument document;
  ImportMap map;
  std::shared_ptr<const TableLayout> layout = nullptr;  ///< of the table, if its head is known
};

/// Puts what a file says of itself into a map, before the map is checked.
using Completion = std::function<void(Where, ImportMap&, DiagnosticList&)>;

/// For a file of this format. Errors have their places.
Result<MapFile> ReadImportMap(Result<YamlDocument> document, PoseFormat format,
                              const Completion& complete = {});
Result<MapFile> ReadImportMap(const std::string& path, PoseFormat format);

/// The JSON Schema of maps, as text.
std::string ImportMapSchema();

/// Its keys (harness/exchange/poses/import_map_format.cc).
ValueFormat<ImportMap> MapFormat();

}  // namespace prehend::exchange
