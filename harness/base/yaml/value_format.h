// SPDX-License-Identifier: Apache-2.0
// How a value is written in YAML: one object that both reads it and states its JSON Schema, so that
// the two cannot disagree. This file has the formats of single values and of lists and mappings of
// them; harness/base/yaml/struct_format.h has the format of a struct.
//
// How to use it, for a file of your own:
//
//   ValueFormat<Wheel> WheelFormat() {
//     return StructFormat<Wheel>("a wheel")
//         .Required("radius_m", &Wheel::radius_m, Number(0.01, 2), "Distance from axle to tread.")
//         .Optional("spokes", &Wheel::spokes, Integer<int>(0, 100), "How many.")
//         .format();
//   }
//
// Members may be T, std::optional<T>, Located<T> (remembers its place, for checks across fields;
// see DiagnosticList) or std::optional<Located<T>>. A struct with a member `Where where` learns its
// own place. Tested by tests/harness/base/yaml/struct_format_test.cc
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/base/yaml/located_yaml.h"

namespace prehend {

using Json = nlohmann::ordered_json;

/// A JSON Schema, made when somebody asks for it: to read a file, nobody does. Copies share it.
class Schema {
 public:
  /// `make` is Json().
  template <std::invocable Maker>
  Schema(Maker make) : state_(std::make_shared<State>(State{std::move(make), {}})) {}
  const Json& json() const;

 private:
  struct State {
    std::function<Json()> make;
    std::optional<Json> made;
  };
  std::shared_ptr<State> state_;
};

/// One of these.
Schema AnyOf(std::vector<Schema> schemas);

/// A format without the type of its values: `value` points to one. Lists, mappings and structs are
/// made of these, so that only a few lines are compiled anew for each type.
struct ErasedFormat {
  /// False after an error; then the value is meaningless.
  using Read = std::function<bool(const YamlNode&, DiagnosticList&, void* value)>;
  /// How a value is written, for defaults in the schema.
  using Show = std::function<Json(const void* value)>;

  Schema schema;
  Read read;
  Show show = {};                      ///< may be empty
  std::vector<std::string> keys = {};  ///< of a mapping whose fields are known
};

/// Holds an erased format. Its special members are compiled once, not wherever a field is declared.
class FormatHolder {
 public:
  explicit FormatHolder(ErasedFormat erased);
  FormatHolder(const FormatHolder& other);
  FormatHolder(FormatHolder&& other) noexcept;
  FormatHolder& operator=(const FormatHolder& other) = delete;
  ~FormatHolder();

  const Schema& schema() const { return erased_.schema; }
  const ErasedFormat& erased() const { return erased_; }

 protected:
  ErasedFormat erased_;
};

template <class T>
class ValueFormat : public FormatHolder {
 public:
  using FormatHolder::FormatHolder;
  /// `read` is bool(const YamlNode&, DiagnosticList&, T&).
  template <class Reader>
  ValueFormat(Schema schema, Reader read)
      : FormatHolder({.schema = std::move(schema),
                      .read = [read = std::move(read)](const YamlNode& node, DiagnosticList& errors,
                                                       void* value) {
                        return read(node, errors, *static_cast<T*>(value));
                      }}) {}

  /// False after an error; then the value is meaningless.
  bool Read(const YamlNode& node, DiagnosticList& errors, T& value) const {
    return erased_.read(node, errors, &value);
  }
  /// The same, with defaults shown in the schema as `other` shows them.
  ValueFormat ShownAs(const ValueFormat& other) && {
    erased_.show = other.erased_.show;
    return std::move(*this);
  }
};

/// An entry of a mapping whose keys are names that the writer chose.
template <class T>
struct Named {
  std::string name;
  Where name_where;
  T value{};
};

/// Reports "KEY: expected WANTED, found ..." and, for an ambiguous scalar, why. Returns false.
bool ReportExpected(const YamlNode& node, DiagnosticList& errors, const std::string& wanted);

/// A finite number, bounds included. Units belong in the key.
ValueFormat<double> Number(double lowest, double highest);
/// True or false.
ValueFormat<bool> Flag();
/// One or more lines for people, not empty.
ValueFormat<std::string> Text(std::size_t max_length = 500);
/// A string that matches `pattern` as a whole; `wanted` describes it: "a name like 'milk_carton'".
/// The pattern must mean the same to POSIX (the reader) and to ECMAScript (the schema).
ValueFormat<std::string> Word(const std::string& pattern, const std::string& wanted,
                              std::size_t max_length = 64);
/// snake_case, as entities, actors and files are called.
ValueFormat<std::string> Identifier();
/// One of a few words.
ValueFormat<std::string> Choice(std::vector<std::string> words);
/// [w, x, y, z] of length 1.
ValueFormat<Eigen::Vector4d> UnitQuaternion();

/// Reports "KEY: expected [min, max], found ..." unless the first of the two is smaller.
void CheckLeastMost(const std::string& key, const Eigen::Vector2d& range, Where where,
                    DiagnosticList& errors);

/// A whole number within the bounds, read into an integer type of any width.
struct IntegerAccess {
  void (*set)(std::int64_t number, void* value);
  std::int64_t (*get)(const void* value);
};
ErasedFormat ErasedInteger(std::int64_t lowest, std::int64_t highest, const IntegerAccess& access);

template <class Int>
ValueFormat<Int> Integer(Int lowest, Int highest) {
  return ValueFormat<Int>(ErasedInteger(
      static_cast<std::int64_t>(lowest), static_cast<std::int64_t>(highest),
      {.set = [](std::int64_t number,
                 void* value) { *static_cast<Int*>(value) = static_cast<Int>(number); },
       .get =
           [](const void* value) {
             return static_cast<std::int64_t>(*static_cast<const Int*>(value));
           }}));
}

/// One of a few words, each standing for a value of an enumeration.
ErasedFormat ErasedChoice(std::vector<std::string> words, std::vector<std::int64_t> meanings,
                          const IntegerAccess& access);

template <class T>
ValueFormat<T> Choice(const std::vector<std::pair<std::string, T>>& meanings) {
  std::vector<std::string> words;
  std::vector<std::int64_t> values;
  for (const auto& [word, meaning] : meanings) {
    words.push_back(word);
    values.push_back(static_cast<std::int64_t>(meaning));
  }
  return ValueFormat<T>(
      ErasedChoice(std::move(words), std::move(values),
                   {.set = [](std::int64_t meaning,
                              void* value) { *static_cast<T*>(value) = static_cast<T>(meaning); },
                    .get =
                        [](const void* value) {
                          return static_cast<std::int64_t>(*static_cast<const T*>(value));
                        }}));
}

/// How the items of a list are reached without their type.
struct ListAccess {
  void (*clear)(void* list);
  void* (*append)(void* list);  ///< a new item at the end
  std::size_t (*size)(const void* list);
  const void* (*at)(const void* list, std::size_t index);
};
ErasedFormat ErasedList(const ErasedFormat& item, std::size_t least, std::size_t most,
                        const ListAccess& access);

template <class T>
ValueFormat<std::vector<T>> ListOf(const ValueFormat<T>& item, std::size_t least,
                                   std::size_t most) {
  using List = std::vector<T>;
  return ValueFormat<List>(ErasedList(
      item.erased(), least, most,
      {.clear = [](void* list) { static_cast<List*>(list)->clear(); },
       .append = [](void* list) -> void* { return &static_cast<List*>(list)->emplace_back(); },
       .size = [](const void* list) { return static_cast<const List*>(list)->size(); },
       .at = [](const void* list, std::size_t index) -> const void* {
         return &(*static_cast<const List*>(list))[index];
       }}));
}

/// N numbers, each within the bounds: [x, y, z].
template <int N>
ValueFormat<Eigen::Matrix<double, N, 1>> Vector(double lowest, double highest);
template <>
ValueFormat<Eigen::Vector2d> Vector<2>(double lowest, double highest);
template <>
ValueFormat<Eigen::Vector3d> Vector<3>(double lowest, double highest);
template <>
ValueFormat<Eigen::Vector4d> Vector<4>(double lowest, double highest);

/// A value that remembers where it was written, for members that are lists or mappings of such.
template <class T>
ValueFormat<Located<T>> WithPlace(const ValueFormat<T>& format) {
  return ValueFormat<Located<T>>(
      {.schema = format.schema(),
       .read = [read = format.erased().read](const YamlNode& node, DiagnosticList& errors,
                                             void* value) {
         auto* located = static_cast<Located<T>*>(value);
         located->where = node.where;
         return read(node, errors, &located->value);
       }});
}

/// How the entries of a mapping are reached without their type.
struct MapAccess {
  void (*clear)(void* map);
  /// A new entry at the end, with this name and place; returns its value.
  void* (*append)(void* map, const std::string& name, const Where& name_where);
};
ErasedFormat ErasedMap(const ValueFormat<std::string>& name, const ErasedFormat& item,
                       std::size_t least, std::size_t most, const MapAccess& access);

/// A mapping from names to values, in the order of the file.
template <class T>
ValueFormat<std::vector<Named<T>>> MapOf(const ValueFormat<std::string>& name,
                                         const ValueFormat<T>& item, std::size_t least,
                                         std::size_t most) {
  using Map = std::vector<Named<T>>;
  return ValueFormat<Map>(
      ErasedMap(name, item.erased(), least, most,
                {.clear = [](void* map) { static_cast<Map*>(map)->clear(); },
                 .append = [](void* map, const std::string& key, const Where& where) -> void* {
                   Named<T>& entry = static_cast<Map*>(map)->emplace_back();
                   entry.name = key;
                   entry.name_where = where;
                   return &entry.value;
                 }}));
}

}  // namespace prehend
