// SPDX-License-Identifier: Apache-2.0
// Tested by tests/program/import_test.cc

#include "harness/exchange/poses/import_map.h"

namespace prehend::exchange {
namespace {

constexpr double kMaxPosition_m = 1e4;

/// One name, or a list of names.
ValueFormat<std::vector<Located<std::string>>> OneOrMoreNames() {
  using Names = std::vector<Located<std::string>>;
  const auto one = WithPlace(Text(200));
  const auto list = ListOf(one, 1, 16);
  return ValueFormat<Names>(
      {.schema = AnyOf({one.schema(), list.schema()}),
       .read = [one, list](const YamlNode& node, DiagnosticList& errors, void* value) {
         Names& names = *static_cast<Names*>(value);
         if (node.kind == YamlNode::Kind::kSequence) return list.Read(node, errors, names);
         return one.Read(node, errors, names.emplace_back());
       }});
}

ValueFormat<Columns> ColumnsFormat() {
  const auto name = WithPlace(Text(200));
  return StructFormat<Columns>("columns")
      .Optional("body", &Columns::body, OneOrMoreNames(),
                "The column with the body's name, of a file with one body per row; the names in "
                "several columns are joined by '/'.")
      .Optional("time", &Columns::time, Text(200),
                "The column with the time. Without it, rows are 1 / rate_hz apart.")
      .Required("position", &Columns::position, ListOf(name, 3, 3),
                "The columns of x, y and z. '{}' stands for the body's name.")
      .Optional("quaternion", &Columns::quaternion, ListOf(name, 4, 4),
                "The columns of the orientation, in the order of quaternion_order.")
      .Optional("euler", &Columns::euler, ListOf(name, 3, 3),
                "Instead: the columns of three angles, in the order of euler_order.")
      .Optional("matrix", &Columns::matrix, ListOf(name, 9, 9),
                "Instead: the columns of a rotation matrix, row by row.")
      .Optional("axis_angle", &Columns::axis_angle, ListOf(name, 3, 3),
                "Instead: the columns of the axis that is turned about, times the angle.")
      .AtMostOneOf({"quaternion", "euler", "matrix", "axis_angle"})
      .format();
}

ValueFormat<McapKeys> McapFormat() {
  return StructFormat<McapKeys>("mcap")
      .Optional("world", &McapKeys::world, Text(200),
                "The coordinate frame of the recording. Default: the root of the tree of frames.")
      .Optional(
          "clock", &McapKeys::clock,
          Choice<Clock>(
              {{"header", Clock::kHeader}, {"log", Clock::kLog}, {"publish", Clock::kPublish}}),
          "Which time of a message counts: when it was measured, logged or published.")
      .format();
}

ValueFormat<Hdf5Keys> Hdf5Format() {
  return StructFormat<Hdf5Keys>("hdf5")
      .Optional("episodes", &Hdf5Keys::episodes, Text(200),
                "The groups that are demonstrations; '*' in the last name stands for any text.")
      .Optional("success", &Hdf5Keys::success, Text(200),
                "Whether it succeeded: '@name' is an attribute of the group, 'name' a dataset.")
      .Optional("language", &Hdf5Keys::language, Text(200), "What was to be done, likewise.")
      .Optional("skip", &Hdf5Keys::skip, Integer<int>(0, 1'000'000),
                "Frames at the beginning that are not read.")
      .format();
}

ValueFormat<SubtaskLabel> LabelFormat() {
  using L = SubtaskLabel;
  return StructFormat<L>("a label")
      .Required("at", &L::at_end, Choice<bool>({{"begin", false}, {"end", true}}),
                "Which boundary of the event.")
      .Required("of", &L::of, WithPlace(Text(200)), "The event.")
      .Optional("hand", &L::hand, Text(200), "Its hand.")
      .Optional("object", &L::object, Text(200), "Its object.")
      .Optional("requires", &L::required, Text(500), "An event that holds there.")
      .format();
}

/// A cell as it is spelled: numbers and nan, too.
ValueFormat<std::string> CellFormat() {
  const auto text = Text(40);
  return ValueFormat<std::string>(
      {.schema = AnyOf({text.schema(), Number(-1e300, 1e300).schema()}),
       .read = [text](const YamlNode& node, DiagnosticList& errors, void* value) {
         YamlNode cell = node;
         cell.quoted = cell.quoted || node.kind == YamlNode::Kind::kScalar;
         return text.erased().read(cell, errors, value);
       }});
}

/// The first ones.
ValueFormat<Unit> Units(std::ptrdiff_t count) {
  using enum Unit;
  const std::vector<std::pair<std::string, Unit>> all = {{"m", kMetre},       {"cm", kCentimetre},
                                                         {"mm", kMillimetre}, {"inch", kInch},
                                                         {"rad", kRadian},    {"deg", kDegree}};
  return Choice<Unit>({all.begin(), all.begin() + count});
}

ValueFormat<Opening> OpeningFormat(const char* noun) {
  return StructFormat<Opening>(noun)
      .Required("from", &Opening::from, OneOrMoreNames(),
                "The column or field with the value; of several, their sum.")
      .Optional("sum_abs", &Opening::sum_abs, Flag(), "They are added without their signs.")
      .Required("open", &Opening::open, Number(-1e9, 1e9), "The value when it is open.")
      .Required("closed", &Opening::closed, Number(-1e9, 1e9), "The value when it is closed.")
      .Optional("unit", &Opening::unit, Units(6), "Of a joint: what these are in.")
      .format();
}

/// Three edges, or the word: not a number then, until it is known what it is of.
ValueFormat<Eigen::Vector3d> SizeFormat() {
  const auto edges = Vector<3>(0, kMaxPosition_m);
  const auto unknown = Choice<int>({{"unknown", 0}});
  return ValueFormat<Eigen::Vector3d>(
      {.schema = AnyOf({edges.schema(), unknown.schema()}),
       .read = [edges](const YamlNode& node, DiagnosticList& errors, void* value) {
         if (node.text != "unknown") return edges.erased().read(node, errors, value);
         static_cast<Eigen::Vector3d*>(value)->setConstant(std::nan(""));
         return true;
       }});
}

ValueFormat<MappedEntity> EntityFormat() {
  using E = MappedEntity;
  return StructFormat<E>("entity")
      .NamedByKey()
      .Optional("from", &E::from, Text(200), "The body in the file of poses.")
      .Optional("at_m", &E::at_m, Vector<3>(-kMaxPosition_m, kMaxPosition_m),
                "Where it stands, z up, of what no tracker sees: a table.")
      .Optional("quat_wxyz", &E::quat_wxyz, UnitQuaternion(), "How it is turned there.")
      .Optional("hand", &E::hand, Flag(), "It is a hand.")
      .Optional("fixed", &E::fixed, Flag(), "It never moves.")
      .Optional("class", &E::class_name,
                WithPlace(Word("[A-Z][A-Za-z0-9]*", "a class name like 'Cup'")),
                "What it is; not of hands.")
      .Required("size_m", &E::size_m, SizeFormat(),
                "The edges of its bounding box; unknown: as such things often are.")
      .Optional("offset_m", &E::offset_m, Vector<3>(-10, 10),
                "From the origin of its markers to its centre, in the body's frame, z up.")
      .Optional("upright_at_s", &E::upright_at_s, Number(0, 1e6),
                "A time at which it stands upright: its orientation there counts as not turned.")
      .Optional("axes_quat_wxyz", &E::axes_quat_wxyz, UnitQuaternion(),
                "How it is turned, as it stands upright, in the axes of its markers.")
      .Optional("ahead", &E::ahead, Vector<3>(-1, 1),
                "Where a hand reaches, in its own frame, z up.")
      .Optional("grip", &E::grip, OpeningFormat("a grip"), "How far its gripper is open.")
      .Optional("part_of", &E::part_of, Text(200),
                "What it is fixed to, as a handle is to a drawer.")
      .Optional("joint", &E::joint, OpeningFormat("a joint"),
                "How far it is open, of what is on a slider or a hinge.")
      .Optional("pose", &E::pose, Text(500),
                "Of HDF5, .npz and JSON: matrices of 4x4, or places and quaternions.")
      .Optional("position", &E::position, Text(500),
                "Of HDF5 and .npz a dataset of places, of JSON a path; beside it")
      .Optional("quaternion", &E::quaternion, Text(500), "its orientation, or")
      .Optional("euler", &E::euler, Text(500),
                "its angles; of HDF5 about the fixed axes x, y and then z, radians; or")
      .Optional("axis_angle", &E::axis_angle, Text(500), "its axis times its angle, or")
      .Optional("rotation", &E::rotation, Text(500),
                "four numbers of a quaternion, three angles or nine of a matrix.")
      .Optional(
          "markers", &E::markers, ListOf(WithPlace(Text(200)), 3, 100),
          "Of tables and C3D: the markers that are on it, the body's name in the place of {}.")
      .Optional("residual_m", &E::residual_m, Number(0, 10),
                "How far its markers may be off their shape, or the tracker's error be; beyond "
                "that it is not tracked.")
      .Optional("first", &E::first, Text(500), "Of HDF5: its pose before the first row.")
      .Optional("shift", &E::shift, Integer<int>(-10, 10),
                "Of HDF5: its rows count so many frames later: 1 of what is written after actions.")
      .ExactlyOneOf({"from", "at_m", "pose", "position", "markers"})
      .AtMostOneOf({"quaternion", "euler", "axis_angle", "rotation", "pose"})
      .AtMostOneOf({"upright_at_s", "axes_quat_wxyz"})
      .format();
}

ValueFormat<TimeUnit> TimeUnits() {
  return Choice<TimeUnit>({{"s", TimeUnit::kSecond},
                           {"ms", TimeUnit::kMillisecond},
                           {"us", TimeUnit::kMicrosecond},
                           {"ns", TimeUnit::kNanosecond},
                           {"frame", TimeUnit::kFrame},
                           {"iso", TimeUnit::kIso}});
}

ValueFormat<Separator> Separators() {
  return Choice<Separator>({{"comma", Separator::kComma},
                            {"semicolon", Separator::kSemicolon},
                            {"tab", Separator::kTab},
                            {"space", Separator::kSpace}});
}

}  // namespace

ValueFormat<ImportMap> MapFormat() {
  using M = ImportMap;
  const auto name = Word("[A-Za-z_][A-Za-z0-9_]*", "a name like 'milk_carton'");
  std::vector<std::pair<std::string, Warning>> warnings;
  for (std::size_t i = 0; i < kWarningNames.size(); ++i)
    warnings.emplace_back(kWarningNames[i], static_cast<Warning>(i));
  return StructFormat<M>("a map")
      .Required("import", &M::version, Integer<int>(1, 1), "The version of this format.")
      .Optional("episode", &M::episode, name, "The recording's name.")
      .Optional("grammar", &M::grammar, name, "The grammar that segments it.")
      .Optional("unit", &M::unit, Units(4), "The unit of positions in the file.")
      .Optional("metres_per_unit", &M::metres_per_unit, Number(1e-6, 1e3),
                "The same as a number, where it is none of these.")
      .AtMostOneOf({"unit", "metres_per_unit"})
      .Optional("axes", &M::axes, Choice<int>({{"x_up", 0}, {"y_up", 1}, {"z_up", 2}}),
                "Which axis of the file points up. This, or up, or both.")
      .Optional("up", &M::up, Vector<3>(-1e6, 1e6),
                "The direction of up in the file's axes, of any length, where no axis points up.")
      .Optional("handed", &M::is_left_handed, Choice<bool>({{"right", false}, {"left", true}}),
                "Whether the file's axes are right-handed, or left-handed as in Unity and Unreal.")
      .Optional(
          "quaternion_order", &M::quaternion_order,
          Choice<QuaternionOrder>(
              {{"wxyz", QuaternionOrder::kWxyz}, {"xyzw", QuaternionOrder::kXyzw}}),
          "The order of the four columns of columns.quaternion; of MCAP, of the fields x, y, z, w.")
      .Optional("euler_order", &M::euler_order, Text(3),
                "Of columns.euler, first turn first: XYZ about the body's axes, xyz the file's.")
      .Optional("angle_unit", &M::angles_in_degrees, Choice<bool>({{"deg", true}, {"rad", false}}),
                "Of angles.")
      .Optional(
          "time_unit", &M::time_unit, TimeUnits(),
          "The unit of the time column, or of t; frame: a number, rate_hz per second; iso: dates.")
      .Optional("frames", &M::frames, Text(500), "Of JSON: the path to the frames: $.frames[*].")
      .Optional("t", &M::t, Text(500), "Of JSON and .npz: the time of each frame.")
      .Optional("rate_hz", &M::rate_hz, Number(0.1, 10'000), "Frames per second, as times have.")
      .Optional("separator", &M::separator, Separators(),
                "What separates columns; space: any number of blanks.")
      .Optional("decimal", &M::decimal_comma, Choice<bool>({{"point", false}, {"comma", true}}),
                "What separates the decimals of numbers.")
      .Optional("header_line", &M::header_line, Integer<int>(1, 1000),
                "The line with the names of the columns; those before it are not read.")
      .Optional("missing", &M::missing, ListOf(CellFormat(), 0, 20),
                "Cells that mean 'not tracked', besides empty ones: [nan].")
      .Optional("zero_is_missing", &M::zero_is_missing, Flag(), "At 0, 0, 0 it is not tracked.")
      .Optional("bridge_s", &M::bridge_s, Number(0, 60),
                "The longest time without a pose that is filled with a straight line.")
      .Optional(
          "lost", &M::lost,
          Choice<Lost>({{"refuse", Lost::kRefuse},
                        {"hold", Lost::kHold},
                        {"unknown", Lost::kUnknown},
                        {"in_rows", Lost::kInRows}}),
          "What is done where a body is not tracked for longer: nothing is imported, it stays "
          "where it was, nobody knows where it is, or that in rows without its pose only.")
      .Optional("end_s", &M::end_s, Number(0, 1e6), "When the recording ends, after its last row.")
      .Optional("outlier", &M::outlier,
                Choice<OutlierRule>({{"keep", OutlierRule::kKeep}, {"lost", OutlierRule::kLost}}),
                "Poses that leave and come back faster than hands do: as they are, or not tracked.")
      .Optional("smooth_s", &M::smooth_s, Number(0, kMostSmooth_s),
                "Each pose is the mean of those at most half of this before or after it.")
      .Optional("sure", &M::sure, ListOf(Choice<Warning>(warnings), 0, kWarningNames.size()),
                "Looks wrong, but is right.")
      .Optional("ticks_per_second", &M::ticks_per_second, Integer<std::int64_t>(100, 1'000'000),
                "The recording's unit of time.")
      .Optional("columns", &M::columns, ColumnsFormat(), "Of CSV: where the values stand.")
      .Optional("mcap", &M::mcap, McapFormat(), "Of MCAP: frame and clock.")
      .Optional("hdf5", &M::hdf5, Hdf5Format(), "Of HDF5: where the demonstrations are.")
      .Required("entities", &M::entities, MapOf(name, EntityFormat(), 1, 1000),
                "What the bodies are, and what no tracker sees.")
      .Optional("labels", &M::labels, MapOf(name, LabelFormat(), 0, 1000),
                "Of demonstrations: where each sub-task ends.")
      .Optional("text", &M::text, MapOf(name, Text(500), 0, 1000),
                "What each sub-task is in words; rest: the last one.")
      .format();
}

}  // namespace prehend::exchange
