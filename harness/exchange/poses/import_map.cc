// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/poses/import_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "harness/exchange/hdf5/hdf5_file.h"

namespace prehend::exchange {
namespace {

constexpr double kMaxPosition_m = 1e4;
constexpr double kMostTilt_deg = 60;  ///< of `up` from `axes`: farther is another axis

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

ValueFormat<Opening> OpeningFormat(const char* noun) {
  return StructFormat<Opening>(noun)
      .Required("from", &Opening::from, OneOrMoreNames(),
                "The column or field with the value; of several, their sum.")
      .Optional("sum_abs", &Opening::sum_abs, Flag(), "They are added without their signs.")
      .Required("open", &Opening::open, Number(-1e9, 1e9), "The value when it is open.")
      .Required("closed", &Opening::closed, Number(-1e9, 1e9), "The value when it is closed.")
      .format();
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
      .Optional("class", &E::class_name, Word("[A-Z][A-Za-z0-9]*", "a class name like 'Cup'"),
                "What it is; not of hands.")
      .Required("size_m", &E::size_m, Vector<3>(0, kMaxPosition_m),
                "The edges of its bounding box.")
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
                "Of HDF5: a dataset of matrices of 4x4, or of places and quaternions.")
      .Optional("position", &E::position, Text(500), "Of HDF5: a dataset of places; beside it")
      .Optional("quaternion", &E::quaternion, Text(500), "its orientation, or")
      .Optional("euler", &E::euler, Text(500),
                "its angles about the fixed axes x, y and then z, radians, or")
      .Optional("axis_angle", &E::axis_angle, Text(500), "its axis times its angle, radians.")
      .Optional("first", &E::first, Text(500), "Of HDF5: its pose before the first row.")
      .Optional("shift", &E::shift, Integer<int>(-10, 10),
                "Of HDF5: its rows count so many frames later: 1 of what is written after actions.")
      .ExactlyOneOf({"from", "at_m", "pose", "position"})
      .AtMostOneOf({"quaternion", "euler", "axis_angle", "pose"})
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
      .Optional("unit", &M::unit,
                Choice<LengthUnit>({{"m", LengthUnit::kMetre},
                                    {"cm", LengthUnit::kCentimetre},
                                    {"mm", LengthUnit::kMillimetre},
                                    {"inch", LengthUnit::kInch}}),
                "The unit of positions in the file.")
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
          "Of CSV: the unit of the time column; frame: a number, rate_hz per second; iso: dates.")
      .Optional("rate_hz", &M::rate_hz, Number(0.1, 10'000),
                "Frames per second. It is compared with the times.")
      .Optional("separator", &M::separator, Separators(),
                "What separates columns; space: any number of blanks.")
      .Optional("decimal", &M::decimal_comma, Choice<bool>({{"point", false}, {"comma", true}}),
                "What separates the decimals of numbers.")
      .Optional("header_line", &M::header_line, Integer<int>(1, 1000),
                "The line with the names of the columns; those before it are not read.")
      .Optional("missing", &M::missing, ListOf(CellFormat(), 0, 20),
                "Cells that mean 'not tracked', besides empty ones: [nan].")
      .Optional("zero_is_missing", &M::zero_is_missing, Flag(),
                "A body at exactly 0, 0, 0 is not tracked.")
      .Optional("bridge_s", &M::bridge_s, Number(0, 60),
                "The longest time without a pose that is filled with a straight line.")
      .Optional(
          "lost", &M::lost,
          Choice<Lost>(
              {{"refuse", Lost::kRefuse}, {"hold", Lost::kHold}, {"unknown", Lost::kUnknown}}),
          "What is done where a body is not tracked for longer: nothing is imported, it "
          "stays where it was, or nobody knows where it is.")
      .Optional("outlier", &M::outlier,
                Choice<OutlierRule>({{"keep", OutlierRule::kKeep}, {"lost", OutlierRule::kLost}}),
                "Poses that leave and come back faster than hands do: as they are, or not tracked.")
      .Optional("smooth_s", &M::smooth_s, Number(0, 2),
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

/// Angles in columns called x, y, z that are not in the order that the map says.
void CheckEulerOrder(const ImportMap& map, DiagnosticList& errors) {
  const std::string fault = FaultOfEulerOrder(map.euler_order->value);
  if (!fault.empty()) return errors.Add(map.euler_order->where, fault);
  std::string letters;
  for (const Located<std::string>& column : map.columns.euler) {
    const char last = static_cast<char>(
        std::tolower(static_cast<unsigned char>(column.value.empty() ? ' ' : column.value.back())));
    letters += last;
  }
  std::string order = map.euler_order->value;
  for (char& c : order) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (letters.find_first_not_of("xyz") == std::string::npos && letters != order &&
      std::ranges::is_permutation(letters, order))
    errors.Add(map.columns.euler.front().where,
               fmt::format("the columns are in the order {}, and euler_order is {}", letters,
                           map.euler_order->value),
               "list the columns in the order of euler_order");
}

void CheckOrientation(const ImportMap& map, DiagnosticList& errors) {
  const Columns& columns = map.columns;
  std::vector<std::string> upright;
  for (const Named<MappedEntity>& entity : map.entities) {
    if (columns.Orientation().empty() && entity.value.from && SaysAxes(entity.value))
      upright.push_back(entity.name);
  }
  if (!upright.empty())
    errors.Add(columns.position.front().where,
               fmt::format("columns.quaternion is missing, and upright_at_s or axes_quat_wxyz of "
                           "{} needs bodies with "
                           "orientations",
                           fmt::join(upright, ", ")),
               "quaternion: [the four columns, in quaternion_order]; or, if the file has positions "
               "only, leave these out");
  if (!columns.quaternion.empty() && !map.quaternion_order)
    errors.Add(columns.quaternion.front().where,
               "quaternion_order is missing: which of the four columns is w",
               "quaternion_order: xyzw, if w is the last; wxyz, if it is the first");
  const auto& angles = columns.euler.empty() ? columns.axis_angle : columns.euler;
  if (!angles.empty() && !map.angles_in_degrees)
    errors.Add(angles.front().where, "angle_unit is missing: what the angles are in",
               "angle_unit: deg, or rad");
  if (columns.euler.empty()) return;
  if (map.euler_order) return CheckEulerOrder(map, errors);
  errors.Add(columns.euler.front().where,
             "euler_order is missing: about which axes the three angles turn, in their order",
             "euler_order: XYZ, if each is about the body's own axis; xyz, about the file's");
}

/// What only files of comma-separated values have.
void CheckColumns(const ImportMap& map, const YamlNode& root, DiagnosticList& errors) {
  const Columns& columns = map.columns;
  if (columns.position.empty()) {
    errors.Add(root.where, "'columns' is missing: a CSV file needs it",
               "columns: {time: t, position: [\"{}_x\", \"{}_y\", \"{}_z\"]}");
    return;
  }
  if (!map.time_unit && columns.time)
    return errors.Add(root.where, "'time_unit' is missing: a CSV file needs it",
                      "time_unit: s, ms, us, ns, iso or frame");
  for (const auto* list : {&columns.position, &columns.Orientation()}) {
    for (const Located<std::string>& column : *list) {
      const bool names_body = column.value.find("{}") != std::string::npos;
      if (!columns.body.empty() && names_body)
        errors.Add(column.where, fmt::format("'{}' stands for all bodies of a row, but "
                                             "columns.body says that a row has one",
                                             column.value));
      if (columns.body.empty() && !names_body && !columns.IsOfOneBody())
        errors.Add(column.where, fmt::format("'{}' names no body", column.value),
                   "write '{}' where the body's name stands, as in the others; or say in "
                   "columns.body which column has it; with neither, the file is of one body");
    }
  }
  CheckOrientation(map, errors);
  if (!columns.time && !map.rate_hz)
    errors.Add(columns.where, "neither columns.time nor rate_hz says when a row is");
  if (map.time_unit && map.time_unit->value == TimeUnit::kFrame && !map.rate_hz)
    errors.Add(map.time_unit->where, "time_unit: frame needs rate_hz");
}

void CheckUp(const ImportMap& map, const YamlNode& root, DiagnosticList& errors) {
  if (!map.axes && !map.up)
    return errors.Add(root.where, "'axes' is missing: which axis of the file points up",
                      "axes: x_up, y_up or z_up; or, where none does, up: [0, -0.82, -0.57], the "
                      "direction of up in the file's axes");
  if (!map.up) return;
  if (map.up->value.norm() < 1e-6)
    return errors.Add(map.up->where, "expected the direction of up, found a vector of length 0",
                      "the direction in the file's axes, of any length: up: [0, 1, 0.2]");
  if (!map.axes) return;
  const double degrees = std::acos(map.up->value.normalized()[map.axes->value]) * 180 / EIGEN_PI;
  if (degrees > kMostTilt_deg)
    errors.Add(map.up->where,
               fmt::format("up is {:.0f} degrees away from the {} of the file, which 'axes' says "
                           "points up",
                           degrees, "xyz"[map.axes->value]),
               "leave out 'axes', or correct one of the two");
}

void CheckOpenings(const Named<MappedEntity>& entity, PoseFormat format, DiagnosticList& errors) {
  const MappedEntity& e = entity.value;
  for (const auto* opening : {&e.grip, &e.joint}) {
    if (!*opening) continue;
    const Where& where = (*opening)->where;
    if (format != PoseFormat::kCsv && format != PoseFormat::kHdf5)
      errors.Add(where, "files of this kind have poses only: grip and joint are read from CSV");
    if ((*opening)->open == (*opening)->closed)
      errors.Add(where, fmt::format("'open' and 'closed' are both {:g}", (*opening)->open),
                 "the values that the file has when it is open and when it is closed");
  }
  if (e.grip && !e.hand)
    errors.Add(e.grip->where, fmt::format("only a hand has a grip, and '{}' is none", entity.name),
               "hand: true; or 'joint', of a drawer or a door");
  if (e.joint && (e.hand || e.fixed))
    errors.Add(e.joint->where, fmt::format("'{}' is {}, and nothing on a joint", entity.name,
                                           e.hand ? "a hand" : "fixed"));
}

/// What only HDF5 files have, and there, that a name is one of a dataset.
void CheckDatasets(const Named<MappedEntity>& entity, PoseFormat format, DiagnosticList& errors) {
  const MappedEntity& e = entity.value;
  const bool is_hdf5 = format == PoseFormat::kHdf5;
  const auto check = [&](const Located<std::string>& name, const char* key) {
    if (!is_hdf5)
      errors.Add(name.where, fmt::format("'{}' is a dataset of an HDF5 file; this is none", key));
    else if (!Hdf5PartOf(name.value))
      errors.Add(name.where,
                 fmt::format("expected a dataset below the group of a demonstration, "
                             "found '{}'",
                             name.value),
                 "obs/eef_pos, or with its columns, from 0, obs/object[0:3]");
  };
  constexpr std::array kKeys = {"pose", "position", "quaternion", "euler", "axis_angle", "first"};
  const std::array values = {&e.pose,  &e.position,   &e.quaternion,
                             &e.euler, &e.axis_angle, &e.first};
  for (std::size_t i = 0; i < values.size(); ++i)
    if (*values[i]) check(**values[i], kKeys[i]);
  for (const auto* opening : {&e.grip, &e.joint})
    for (std::size_t i = 0; is_hdf5 && *opening && i < (*opening)->from.size(); ++i)
      check((*opening)->from[i], "from");
  if (is_hdf5 && e.from && !e.pose && !e.position)
    errors.Add(e.from->where, "'from' is of files whose bodies have names",
               "pose: DATASET, or position: and quaternion: DATASET");
  if (e.first && !e.pose) errors.Add(e.first->where, "'first' is a pose; it needs 'pose'");
  if (e.at_m && (e.quaternion || e.euler || e.axis_angle))
    errors.Add(entity.name_where,
               fmt::format("'{}' has at_m, and a dataset beside it", entity.name));
}

/// Rules across keys.
void CheckMap(const ImportMap& map, PoseFormat format, const YamlNode& root,
              DiagnosticList& errors) {
  const bool is_csv = format == PoseFormat::kCsv;
  CheckUp(map, root, errors);
  if (!map.unit && !map.metres_per_unit)
    errors.Add(root.where, "a map needs one of the keys unit, metres_per_unit");
  if (is_csv) {
    CheckColumns(map, root, errors);
  } else {
    if (!map.columns.position.empty())
      errors.Add(map.columns.where, "'columns' are those of CSV files; this one has names");
    if (map.time_unit)
      errors.Add(map.time_unit->where, "'time_unit' is that of CSV files; this one has its own");
  }
  if (format == PoseFormat::kBvh && map.quaternion_order)
    errors.Add(map.quaternion_order->where, "BVH has angles, and no quaternions");
  if (format == PoseFormat::kHdf5 && !map.episode.empty())
    errors.Add(root.where, "'episode' is one name, and each demonstration has that of its group");
  if (format != PoseFormat::kHdf5 && map.hdf5.where.place.line > 0)
    errors.Add(map.hdf5.where, "'hdf5' says something of HDF5 files; this is none");
  if (format != PoseFormat::kMcap && map.mcap.where.place.line > 0)
    errors.Add(map.mcap.where, "'mcap' says something of MCAP files; this is none");
  bool tracked = false;
  std::vector<std::string> names;
  for (const Named<MappedEntity>& entity : map.entities) names.push_back(entity.name);
  for (const Named<MappedEntity>& entity : map.entities) {
    const MappedEntity& e = entity.value;
    tracked = tracked || e.from;
    CheckDatasets(entity, format, errors);
    CheckOpenings(entity, format, errors);
    if (e.part_of && std::ranges::find(names, e.part_of->value) == names.end())
      errors.AddUnknownName(e.part_of->where,
                            fmt::format("no entity is called '{}'", e.part_of->value),
                            e.part_of->value, names);
    else if (e.part_of && (e.hand || e.fixed || e.joint || e.part_of->value == entity.name))
      errors.Add(
          e.part_of->where,
          fmt::format("'{}' is part of another thing, so it is no hand, is not fixed and has "
                      "no joint",
                      entity.name));
    if (e.hand && (e.fixed || e.class_name != "Object"))
      errors.Add(entity.name_where,
                 fmt::format("'{}': a hand has no class and is not fixed", entity.name));
    if (e.upright_at_s && e.at_m)
      errors.Add(e.upright_at_s->where, "upright_at_s needs a body with orientations");
    if (e.axes_quat_wxyz && e.at_m)
      errors.Add(e.axes_quat_wxyz->where, "axes_quat_wxyz needs a body with orientations");
    if (e.ahead && !e.hand) errors.Add(e.ahead->where, "only a hand reaches 'ahead'");
    if (e.ahead && e.ahead->value.norm() < 0.1)
      errors.Add(e.ahead->where, "expected a direction, found one of length below 0.1");
  }
  if (!tracked && !map.entities.empty())
    errors.Add(map.entities.front().name_where, "no entity is 'from' a body of the file");
}

/// "supported_by(a, b)" in braces and without quotes is two keys to YAML. It becomes one value.
void JoinCalls(YamlNode& label) {
  std::vector<YamlNode>& all = label.children;
  for (std::size_t i = 1; i < all.size();) {
    std::string& before = all[i - 1].text;
    const bool is_open = !all[i - 1].quoted && before.find('(') != std::string::npos &&
                         before.find(')') == std::string::npos;
    if (!is_open || all[i].kind != YamlNode::Kind::kNull || !all[i].text.empty()) {
      ++i;
      continue;
    }
    before += ", " + all[i].key;
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace

double Opening::FractionOf(std::span<const double> numbers) const {
  double sum = 0;
  for (const double number : numbers) sum += sum_abs ? std::abs(number) : number;
  return (sum - closed) / (open - closed);
}

std::string Opening::Names() const {
  std::vector<std::string> names;
  for (const Located<std::string>& name : from) names.push_back(name.value);
  return fmt::format("{}", fmt::join(names, " + "));
}

bool ImportMap::IsSure(Warning warning) const {
  return std::ranges::find(sure, warning) != sure.end();
}

const std::vector<Located<std::string>>& Columns::Orientation() const {
  for (const auto* form : {&euler, &matrix, &axis_angle})
    if (!form->empty()) return *form;
  return quaternion;
}

OrientationForm Columns::Form() const {
  if (!euler.empty()) return OrientationForm::kEuler;
  if (!matrix.empty()) return OrientationForm::kMatrix;
  return axis_angle.empty() ? OrientationForm::kQuaternion : OrientationForm::kAxisAngle;
}

bool Columns::IsOfOneBody() const {
  const auto names_body = [](const Located<std::string>& column) {
    return column.value.find("{}") != std::string::npos;
  };
  return body.empty() && std::ranges::none_of(position, names_body) &&
         std::ranges::none_of(Orientation(), names_body);
}

OrientationFormat ImportMap::Orientation() const {
  return {.form = columns.Form(),
          .order = quaternion_order ? quaternion_order->value : QuaternionOrder::kXyzw,
          .euler_order = euler_order ? euler_order->value : "XYZ",
          .radians_per_unit = angles_in_degrees && angles_in_degrees->value
                                  ? static_cast<double>(EIGEN_PI) / 180
                                  : 1};
}

double ImportMap::MetresPerUnit() const {
  if (metres_per_unit) return metres_per_unit->value;
  constexpr std::array kMetres = {1.0, 1e-2, 1e-3, 0.0254};
  return kMetres[static_cast<std::size_t>(unit->value)];
}

Eigen::Quaterniond ImportMap::AxesTurn() const {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (axes && axes->value == 0) turn << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  if (axes && axes->value == 1) turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return Eigen::Quaterniond(turn);
}

Eigen::Quaterniond ImportMap::WorldTurn() const {
  const Eigen::Quaterniond turn = AxesTurn();
  if (!up) return turn;
  return Eigen::Quaterniond::FromTwoVectors(turn * Up(), Eigen::Vector3d::UnitZ()) * turn;
}

Eigen::Vector3d ImportMap::Up() const {
  return up ? Mirrored(up->value.normalized()) : Eigen::Vector3d::Unit(axes->value);
}

Eigen::Vector3d ImportMap::Mirrored(Eigen::Vector3d v) const {
  const int across = axes && axes->value == 0 ? 1 : 0;
  if (is_left_handed) v[across] = -v[across];
  return v;
}

Result<MapFile> ReadImportMap(const std::string& path, PoseFormat format,
                              const Completion& complete) {
  Result<YamlDocument> document = ReadYamlFile(path);
  if (!document) return tl::unexpected(std::move(document.error()));
  MapFile file{.document = std::move(*document), .map = {}};
  DiagnosticList errors(file.document);
  for (YamlNode& node : file.document.root.children)
    if (node.key == "labels") std::ranges::for_each(node.children, JoinCalls);
  if (MapFormat().Read(file.document.root, errors, file.map)) {
    for (Named<MappedEntity>& entity : file.map.entities) {
      MappedEntity& e = entity.value;
      if (e.pose || e.position) e.from = e.pose ? e.pose : e.position;
    }
    if (complete) complete(file.document.root.where, file.map, errors);
    CheckMap(file.map, format, file.document.root, errors);
  }
  if (!errors.empty()) return tl::unexpected(errors.Sorted());
  return file;
}

std::string ImportMapSchema() { return MapFormat().schema().json().dump(2) + "\n"; }

}  // namespace prehend::exchange
