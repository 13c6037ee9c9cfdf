// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/poses/import_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "grammar/base/frame.h"
#include "harness/base/base/number_text.h"
#include "harness/exchange/hdf5/hdf5_file.h"

namespace prehend::exchange {
namespace {

constexpr double kMostTilt_deg = 60;  ///< of `up` from `axes`: farther is another axis

/// Angles in columns called x, y, z that are not in the order that the map says.
void CheckEulerOrder(const ImportMap& map, DiagnosticList& errors) {
  const std::string fault = FaultOfEulerOrder(map.euler_order->value);
  if (!fault.empty()) return errors.Add(map.euler_order->where, fault);
  std::string letters;
  for (const Located<std::string>& column : map.columns.euler)
    letters += column.value.empty() ? ' ' : column.value.back();
  letters = LowerCase(letters);
  const std::string order = LowerCase(map.euler_order->value);
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
    if (columns.Orientation().empty() && entity.value.from && entity.value.markers.empty() &&
        SaysAxes(entity.value))
      upright.push_back(entity.name);
  }
  if (!upright.empty())
    errors.Add(columns.position.front().where,
               fmt::format("columns.quaternion is missing, and upright_at_s or axes_quat_wxyz of "
                           "{} needs bodies with orientations",
                           fmt::join(upright, ", ")),
               "quaternion: [the four columns, in quaternion_order]; or, if the file has positions "
               "only, leave these out");
  if (!columns.quaternion.empty() && !map.quaternion_order)
    errors.Add(columns.quaternion.front().where,
               "quaternion_order is missing: which of the four columns is w",
               "quaternion_order: xyzw, if w is the last; wxyz, if it is the first");
  if (map.quaternion_order && columns.quaternion.empty() && !columns.Orientation().empty())
    errors.Add(map.quaternion_order->where,
               fmt::format("'quaternion_order' says nothing here: the file has {}",
                           columns.matrix.empty() ? "angles" : "matrices"),
               "leave it out; or columns.quaternion names four columns");
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

/// What must differ: columns of a pose, markers of a body.
void CheckTwice(const std::vector<Located<std::string>>& names, const char* has,
                DiagnosticList& errors) {
  std::set<std::string> taken;
  for (const auto& [name, where] : names)
    if (!taken.insert(name).second)
      errors.Add(where, "'" + name + "' is named twice", fmt::format("each {} of its own", has));
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
  std::vector<Located<std::string>> all = columns.body;
  if (columns.time) all.push_back(*columns.time);
  for (const auto* list : {&columns.position, &columns.Orientation()}) {
    all.insert(all.end(), list->begin(), list->end());
    for (const Located<std::string>& column : *list) {
      const bool names_body = column.value.find("{}") != std::string::npos;
      if (!columns.body.empty() && names_body)
        errors.Add(
            column.where,
            fmt::format(
                "'{}' stands for all bodies of a row, but columns.body says that a row has one",
                column.value));
      if (columns.body.empty() && !names_body && !columns.IsOfOneBody())
        errors.Add(column.where, fmt::format("'{}' names no body", column.value),
                   "write '{}' where the body's name stands, as in the others; or say in "
                   "columns.body which column has it; with neither, the file is of one body");
    }
  }
  CheckTwice(all, "number has a column", errors);
  CheckOrientation(map, errors);
  if (!columns.time && !map.rate_hz)
    errors.Add(columns.where, "neither columns.time nor rate_hz says when a row is");
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
               fmt::format(
                   "up is {:.0f} degrees away from the {} of the file, which 'axes' says points up",
                   degrees, "xyz"[map.axes->value]),
               "leave out 'axes', or correct one of the two");
}

void CheckOpenings(const Named<MappedEntity>& entity, PoseFormat format, DiagnosticList& errors) {
  const MappedEntity& e = entity.value;
  for (const auto* opening : {&e.grip, &e.joint}) {
    if (!*opening) continue;
    const Where& where = (*opening)->where;
    CheckTwice((*opening)->from, "number that is added has a source", errors);
    if (format == PoseFormat::kBvh || format == PoseFormat::kC3d)
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

/// What only files of arrays have, and there, that a name is one of a dataset.
void CheckDatasets(const Named<MappedEntity>& entity, PoseFormat format, DiagnosticList& errors) {
  const MappedEntity& e = entity.value;
  const bool has_arrays =
      format == PoseFormat::kHdf5 || format == PoseFormat::kNpz || format == PoseFormat::kJson;
  const auto check = [&](const Located<std::string>& name, const char* key) {
    if (!has_arrays)
      errors.Add(name.where, fmt::format("'{}' is a dataset of an HDF5 file, an array of .npz or a "
                                         "path of JSON; this file is none of these",
                                         key));
    else if (format != PoseFormat::kJson && !Hdf5PartOf(name.value))
      errors.Add(name.where,
                 fmt::format("expected a dataset below the group of a demonstration, found '{}'",
                             name.value),
                 "obs/eef_pos, or with its columns, from 0, obs/object[0:3]");
  };
  constexpr std::array kKeys = {"pose",       "position", "quaternion", "euler",
                                "axis_angle", "rotation", "first"};
  const std::array values = {&e.pose,       &e.position, &e.quaternion, &e.euler,
                             &e.axis_angle, &e.rotation, &e.first};
  std::vector<Located<std::string>> all;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!*values[i]) continue;
    check(**values[i], kKeys[i]);
    all.push_back(**values[i]);
  }
  CheckTwice(all, "key has a dataset", errors);
  for (const auto* opening : {&e.grip, &e.joint})
    for (std::size_t i = 0; has_arrays && *opening && i < (*opening)->from.size(); ++i)
      check((*opening)->from[i], "from");
  if (has_arrays && e.from && !e.pose && !e.position)
    errors.Add(e.from->where, "'from' is of files whose bodies have names",
               "pose: DATASET, or position: and quaternion: DATASET; of JSON, paths");
  if (e.first && !e.pose) errors.Add(e.first->where, "'first' is a pose; it needs 'pose'");
  if (e.at_m && (e.quaternion || e.euler || e.axis_angle || e.rotation))
    errors.Add(entity.name_where,
               fmt::format("'{}' has at_m, and a dataset beside it", entity.name));
}

/// What only JSON and arrays of NumPy have: paths, and the times among them.
void CheckFrames(const ImportMap& map, PoseFormat format, const YamlNode& root,
                 DiagnosticList& errors) {
  const bool has_times = format == PoseFormat::kJson || format == PoseFormat::kNpz;
  if (map.frames && format != PoseFormat::kJson)
    errors.Add(map.frames->where, "'frames' is a path of JSON; this file is none");
  if (map.t && !has_times)
    errors.Add(map.t->where, "'t' is of JSON and of .npz; this file is neither");
  if (!has_times) return;
  if (!map.t && !map.rate_hz)
    errors.Add(root.where, "neither t nor rate_hz says when a frame is",
               "t: timestamp and time_unit: s, or rate_hz: 60");
  if (map.t && !map.time_unit)
    errors.Add(map.t->where, "time_unit is missing: what the times are in",
               "time_unit: s, ms, us, ns, iso or frame");
  const std::string fault = map.euler_order ? FaultOfEulerOrder(map.euler_order->value) : "";
  if (!fault.empty()) errors.Add(map.euler_order->where, fault);
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
    if (map.time_unit && !map.t)
      errors.Add(map.time_unit->where,
                 "'time_unit' is that of CSV files, and of 't'; this one has its own");
    for (const char* key : {"separator", "decimal", "header_line"})
      if (const YamlNode* const node = root.Find(key))
        errors.Add(node->where, fmt::format("'{}' is that of CSV files; this is none", key));
  }
  CheckFrames(map, format, root, errors);
  if (map.time_unit && map.time_unit->value == TimeUnit::kFrame && !map.rate_hz)
    errors.Add(map.time_unit->where, "time_unit: frame needs rate_hz");
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
    if (entity.name == "any")
      errors.Add(entity.name_where, "'any': this name stands for everybody, in claims and queries",
                 "another name, and from: any");
    CheckDatasets(entity, format, errors);
    CheckOpenings(entity, format, errors);
    CheckTwice(e.markers, "marker has a name", errors);
    if (!e.markers.empty() && !is_csv && format != PoseFormat::kC3d)
      errors.Add(e.markers.front().where,
                 "'markers' are of tables and of C3D; this file is neither");
    if (e.part_of && std::ranges::find(names, e.part_of->value) == names.end())
      errors.AddUnknownName(e.part_of->where,
                            fmt::format("no entity is called '{}'", e.part_of->value),
                            e.part_of->value, names);
    else if (e.part_of && (e.hand || e.fixed || e.joint || e.part_of->value == entity.name))
      errors.Add(
          e.part_of->where,
          fmt::format(
              "'{}' is part of another thing, so it is no hand, is not fixed and has no joint",
              entity.name));
    if (e.hand && (e.fixed || e.class_name.value != "Object"))
      errors.Add(entity.name_where,
                 fmt::format("'{}': a hand has no class and is not fixed", entity.name));
    else if (!grammar::WrongRoot({e.class_name.value}, RootsOf(e)).empty())
      errors.Add(e.class_name.where,
                 fmt::format("class: '{}' is built in, and '{}' is {}", e.class_name.value,
                             entity.name, RootsOf(e).front()),
                 "of a hand hand: true, of a table fixed: true; name your own classes otherwise");
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

std::string NamesOf(const std::vector<Located<std::string>>& all) {
  std::vector<std::string> names;
  for (const Located<std::string>& name : all) names.push_back(name.value);
  return fmt::format("{}", fmt::join(names, " + "));
}

double Opening::FractionOf(std::span<const double> numbers) const {
  double sum = 0;
  for (const double number : numbers) sum += sum_abs ? std::abs(number) : number;
  return (sum - closed) / (open - closed);
}

double Opening::PositionAt(double fraction, const ImportMap& map) const {
  return (closed + fraction * (open - closed)) * (unit ? SiPerUnit(*unit) : map.MetresPerUnit());
}

std::string Opening::Names() const { return NamesOf(from); }

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
  return metres_per_unit ? metres_per_unit->value : SiPerUnit(unit->value);
}

double ImportMap::SecondsPerUnit() const {
  constexpr std::array kSeconds = {1.0, 1e-3, 1e-6, 1e-9};
  if (time_unit->value == TimeUnit::kFrame) return 1 / rate_hz->value;
  return time_unit->value == TimeUnit::kIso ? 1
                                            : kSeconds[static_cast<std::size_t>(time_unit->value)];
}

Eigen::Quaterniond ImportMap::AxesTurn() const {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (axes && axes->value == 0) turn << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  if (axes && axes->value == 1) turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return Eigen::Quaterniond(turn);
}

Eigen::Quaterniond ImportMap::WorldTurn() const {
  const Eigen::Quaterniond turn = AxesTurn();
  return up ? Eigen::Quaterniond::FromTwoVectors(turn * Up(), Eigen::Vector3d::UnitZ()) * turn
            : turn;
}

Eigen::Vector3d ImportMap::Up() const {
  return up ? Mirrored(up->value.normalized()) : Eigen::Vector3d::Unit(axes->value);
}

Eigen::Vector3d ImportMap::Mirrored(Eigen::Vector3d v) const {
  const int across = axes && axes->value == 0 ? 1 : 0;
  if (is_left_handed) v[across] = -v[across];
  return v;
}

Result<MapFile> ReadImportMap(const std::string& path, PoseFormat format) {
  return ReadImportMap(ReadYamlFile(path), format);
}

Result<MapFile> ReadImportMap(Result<YamlDocument> document, PoseFormat format,
                              const Completion& complete) {
  if (!document) return tl::unexpected(std::move(document.error()));
  MapFile file{.document = std::move(*document), .map = {}};
  DiagnosticList errors(file.document);
  YamlNode& root = file.document.root;
  const bool is_of_labels = root.Find("labels") && !root.Find("import") && !root.Find("axes");
  if (is_of_labels)
    errors.Add(root.where, "expected a map of poses, found one of labels", "import: 1");
  for (YamlNode& node : root.children)
    if (node.key == "labels") std::ranges::for_each(node.children, JoinCalls);
  if (!is_of_labels && MapFormat().Read(root, errors, file.map)) {
    for (Named<MappedEntity>& entity : file.map.entities) {
      MappedEntity& e = entity.value;
      if (e.pose || e.position) e.from = e.pose ? e.pose : e.position;
      if (!e.markers.empty()) e.from = {NamesOf(e.markers), e.markers.front().where};
      e.guesses_size = e.size_m.hasNaN();
      if (e.guesses_size)
        e.size_m = e.hand    ? Eigen::Vector3d(0.1, 0.09, 0.03)
                   : e.fixed ? Eigen::Vector3d(1.2, 0.8, 0.04)
                             : Eigen::Vector3d(0.1, 0.1, 0.1);
    }
    file.map.says_bridge = root.Find("bridge_s") != nullptr;
    if (complete) complete(root.where, file.map, errors);
    CheckMap(file.map, format, root, errors);
  }
  if (!errors.empty()) return tl::unexpected(errors.Sorted());
  return file;
}

std::string ImportMapSchema() { return MapFormat().schema().json().dump(2) + "\n"; }

}  // namespace prehend::exchange
