// SPDX-License-Identifier: Apache-2.0
// See harness/import/import_map.h. Tested by tests/program/import_test.cc
#include "harness/import/import_map.h"

#include <fmt/format.h>

#include <algorithm>

namespace prehend::harness::import {
namespace {

constexpr double kMaxPosition_m = 1e4;

ValueFormat<Columns> ColumnsFormat() {
  const auto name = WithPlace(Text(200));
  return StructFormat<Columns>("columns")
      .Optional("body", &Columns::body, Text(200),
                "The column with the body's name, of a file with one body per row.")
      .Optional("time", &Columns::time, Text(200),
                "The column with the time. Without it, rows are 1 / rate_hz apart.")
      .Required("position", &Columns::position, ListOf(name, 3, 3),
                "The columns of x, y and z. '{}' stands for the body's name.")
      .Optional("quaternion", &Columns::quaternion, ListOf(name, 4, 4),
                "The columns of the orientation, in the order of quaternion_order.")
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
      .ExactlyOneOf({"from", "at_m"})
      .format();
}

ValueFormat<ImportMap> MapFormat() {
  using M = ImportMap;
  const auto name = Word("[A-Za-z_][A-Za-z0-9_]*", "a name like 'milk_carton'");
  std::vector<std::pair<std::string, Doubt>> doubts;
  for (std::size_t i = 0; i < kDoubtNames.size(); ++i)
    doubts.emplace_back(kDoubtNames[i], static_cast<Doubt>(i));
  return StructFormat<M>("a map")
      .Required("import", &M::version, Integer<int>(1, 1), "The version of this format.")
      .Optional("episode", &M::episode, name, "The recording's name.")
      .Optional("grammar", &M::grammar, name, "The grammar that segments it.")
      .Required("unit", &M::unit,
                Choice<LengthUnit>({{"m", LengthUnit::kMetre},
                                    {"cm", LengthUnit::kCentimetre},
                                    {"mm", LengthUnit::kMillimetre}}),
                "The unit of positions in the file.")
      .Required("axes", &M::up, Choice<int>({{"x_up", 0}, {"y_up", 1}, {"z_up", 2}}),
                "Which axis of the file points up.")
      .Optional("quaternion_order", &M::quaternion_order,
                Choice<QuaternionOrder>(
                    {{"wxyz", QuaternionOrder::kWxyz}, {"xyzw", QuaternionOrder::kXyzw}}),
                "The order of the four columns of columns.quaternion.")
      .Required("time_unit", &M::time_unit,
                Choice<TimeUnit>({{"s", TimeUnit::kSecond},
                                  {"ms", TimeUnit::kMillisecond},
                                  {"us", TimeUnit::kMicrosecond},
                                  {"ns", TimeUnit::kNanosecond},
                                  {"frame", TimeUnit::kFrame}}),
                "The unit of the time column; frame: a number, rate_hz per second.")
      .Optional("rate_hz", &M::rate_hz, Number(0.1, 10'000),
                "Frames per second. It is compared with the times.")
      .Optional("separator", &M::separator,
                Choice<Separator>({{"comma", Separator::kComma},
                                   {"semicolon", Separator::kSemicolon},
                                   {"tab", Separator::kTab}}),
                "What separates columns.")
      .Optional("header_line", &M::header_line, Integer<int>(1, 1000),
                "The line with the names of the columns; those before it are not read.")
      .Optional("missing", &M::missing, ListOf(Text(40), 0, 20),
                "Cells that mean 'not tracked', besides empty ones: [nan].")
      .Optional("zero_is_missing", &M::zero_is_missing, Flag(),
                "A body at exactly 0, 0, 0 is not tracked.")
      .Optional("bridge_s", &M::bridge_s, Number(0, 60),
                "The longest time without a pose that is filled with a straight line.")
      .Optional("lost", &M::lost, Choice<Lost>({{"refuse", Lost::kRefuse}, {"hold", Lost::kHold}}),
                "What is done where a body is not tracked for longer: nothing is imported, or it "
                "stays where it was.")
      .Optional("sure", &M::sure, ListOf(Choice<Doubt>(doubts), 0, kDoubtNames.size()),
                "Looks wrong, but is right.")
      .Optional("ticks_per_second", &M::ticks_per_second, Integer<std::int64_t>(100, 1'000'000),
                "The recording's unit of time.")
      .Required("columns", &M::columns, ColumnsFormat(), "Where the values stand.")
      .Required("entities", &M::entities, MapOf(name, EntityFormat(), 1, 1000),
                "What the bodies are, and what no tracker sees.")
      .format();
}

/// Rules across keys.
void CheckMap(const ImportMap& map, DiagnosticList& errors) {
  const Columns& columns = map.columns;
  for (const auto* list : {&columns.position, &columns.quaternion}) {
    for (const Located<std::string>& column : *list) {
      const bool names_body = column.value.find("{}") != std::string::npos;
      if (columns.body && names_body)
        errors.Add(column.where, fmt::format("'{}' stands for all bodies of a row, but "
                                             "columns.body says that a row has one",
                                             column.value));
      if (!columns.body && !names_body)
        errors.Add(column.where, fmt::format("'{}' names no body", column.value),
                   "write '{}' where the body's name stands, or say in columns.body which column "
                   "has it");
    }
  }
  if (!columns.quaternion.empty() && !map.quaternion_order)
    errors.Add(columns.quaternion.front().where,
               "quaternion_order is missing: which of the four columns is w",
               "quaternion_order: xyzw, if w is the last; wxyz, if it is the first");
  if (!columns.time && !map.rate_hz)
    errors.Add(columns.where, "neither columns.time nor rate_hz says when a row is");
  if (!columns.time && columns.body)
    errors.Add(columns.where, "a file with one body per row needs columns.time");
  if (map.time_unit.value == TimeUnit::kFrame && !map.rate_hz)
    errors.Add(map.time_unit.where, "time_unit: frame needs rate_hz");
  bool tracked = false;
  for (const Named<MappedEntity>& entity : map.entities) {
    const MappedEntity& e = entity.value;
    tracked = tracked || e.from;
    if (e.hand && (e.fixed || e.class_name != "Object"))
      errors.Add(entity.name_where,
                 fmt::format("'{}': a hand has no class and is not fixed", entity.name));
    if (e.upright_at_s && (e.at_m || columns.quaternion.empty()))
      errors.Add(e.upright_at_s->where, "upright_at_s needs a body with orientations");
  }
  if (!tracked && !map.entities.empty())
    errors.Add(map.entities.front().name_where, "no entity is 'from' a body of the file");
}

}  // namespace

bool ImportMap::IsSure(Doubt doubt) const { return std::ranges::find(sure, doubt) != sure.end(); }

Result<MapFile> ReadImportMap(const std::string& path) {
  Result<YamlDocument> document = ReadYamlFile(path);
  if (!document) return tl::unexpected(std::move(document.error()));
  MapFile file{.document = std::move(*document), .map = {}};
  DiagnosticList errors(file.document);
  if (MapFormat().Read(file.document.root, errors, file.map)) CheckMap(file.map, errors);
  if (!errors.empty()) return tl::unexpected(errors.Sorted());
  return file;
}

std::string ImportMapSchema() { return MapFormat().schema().dump(2) + "\n"; }

}  // namespace prehend::harness::import
