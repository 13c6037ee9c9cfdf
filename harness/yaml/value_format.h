// SPDX-License-Identifier: Apache-2.0
// How a value is written in YAML: one object that both reads it and states its JSON Schema, so that
// the two cannot disagree. This file has the formats of single values and of lists and mappings of
// them; harness/yaml/struct_format.h has the format of a struct.
//
// How to use it, for a file of your own:
//
//   Format<Wheel> WheelFormat() {
//     return Record<Wheel>("a wheel")
//         .Required("radius_m", &Wheel::radius_m, Number(0.01, 2), "Distance from axle to tread.")
//         .Optional("spokes", &Wheel::spokes, Integer<int>(0, 100), "How many; the default is that
//         of Wheel{}.") .format();
//   }
//   ReadResult<YamlDocument> document = ReadYamlFile(path);
//   if (document.value) ReadResult<Wheel> wheel = ReadDocument(*document.value, WheelFormat());
//
// Members may be T, std::optional<T>, Located<T> (remembers its place, for checks across fields;
// see DiagnosticList) or std::optional<Located<T>>. A struct with a member `Where where` learns its
// own place. Tested by tests/harness/yaml/struct_format_test.cc
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "harness/yaml/diagnostic_list.h"
#include "harness/yaml/located_yaml.h"

namespace prehend::harness {

using Json = nlohmann::ordered_json;

template <class T>
struct Format {
  Json schema;
  /// False, after complaining, when the node is not such a value; then the value means nothing.
  std::function<bool(const YamlNode&, DiagnosticList&, T&)> read;
  /// How a value is written, for defaults in the schema; may be empty.
  std::function<Json(const T&)> show;
};

/// An entry of a mapping whose keys are names that the writer chose.
template <class T>
struct Named {
  std::string name;
  Where name_where;
  T value{};
};

/// Complains "KEY: expected WANTED, found ..." and, about an ambiguous scalar, why. Returns false.
bool ReportExpected(const YamlNode& node, DiagnosticList& errors, const std::string& wanted);

/// A finite number, bounds included. Units belong into the key.
Format<double> Number(double lowest, double highest);
/// True or false.
Format<bool> Flag();
/// One or more lines for people, not empty.
Format<std::string> Text(std::size_t max_length = 500);
/// A string that matches `pattern` as a whole; `wanted` describes it: "a name like 'milk_carton'".
/// The pattern must mean the same to POSIX (the reader) and to ECMAScript (the schema).
Format<std::string> Word(const std::string& pattern, const std::string& wanted,
                         std::size_t max_length = 64);
/// snake_case, as entities, actors and files are called.
Format<std::string> Identifier();
/// One of a few words.
Format<std::string> Choice(std::vector<std::string> words);
Format<std::int64_t> Integer64(std::int64_t lowest, std::int64_t highest);
/// Complains when the node is no list, or has a wrong number of items. The same for mappings.
bool IsListOf(const YamlNode& node, DiagnosticList& errors, std::size_t least, std::size_t most);
bool IsMappingOf(const YamlNode& node, DiagnosticList& errors, std::size_t least, std::size_t most);

/// Complains "KEY: expected [least, most], found ..." unless the first of the two is smaller.
void CheckLeastMost(const std::string& key, const Eigen::Vector2d& range, Where where,
                    DiagnosticList& errors);

template <class Int>
Format<Int> Integer(Int lowest, Int highest) {
  const auto wide =
      Integer64(static_cast<std::int64_t>(lowest), static_cast<std::int64_t>(highest));
  return {.schema = wide.schema,
          .read =
              [wide](const YamlNode& node, DiagnosticList& errors, Int& value) {
                std::int64_t read = 0;
                if (!wide.read(node, errors, read)) return false;
                value = static_cast<Int>(read);
                return true;
              },
          .show = [](const Int& value) { return Json(value); }};
}

/// One of a few words, each standing for a value.
template <class T>
Format<T> Choice(std::vector<std::pair<std::string, T>> meanings) {
  std::vector<std::string> words;
  for (const auto& [word, meaning] : meanings) words.push_back(word);
  const Format<std::string> choice = Choice(std::move(words));
  return {.schema = choice.schema,
          .read =
              [choice, meanings](const YamlNode& node, DiagnosticList& errors, T& value) {
                std::string chosen;
                if (!choice.read(node, errors, chosen)) return false;
                for (const auto& [word, meaning] : meanings) {
                  if (word == chosen) value = meaning;
                }
                return true;
              },
          .show =
              [meanings](const T& value) {
                for (const auto& [word, meaning] : meanings) {
                  if (meaning == value) return Json(word);
                }
                return Json();
              }};
}

template <class T>
Format<std::vector<T>> ListOf(Format<T> item, std::size_t least, std::size_t most) {
  return {
      .schema = {{"type", "array"},
                 {"items", item.schema},
                 {"minItems", least},
                 {"maxItems", most}},
      .read =
          [item, least, most](const YamlNode& node, DiagnosticList& errors, std::vector<T>& list) {
            list.clear();
            if (!IsListOf(node, errors, least, most)) return false;
            bool good = true;
            for (const YamlNode& child : node.children) {
              T value{};
              good &= item.read(child, errors, value);
              list.push_back(std::move(value));
            }
            return good;
          },
      .show =
          [item](const std::vector<T>& list) {
            Json shown = Json::array();
            for (const T& value : list) shown.push_back(item.show ? item.show(value) : Json());
            return shown;
          }};
}

/// A value that remembers where it was written, for members that are lists or mappings of such.
template <class T>
Format<Located<T>> WithPlace(Format<T> format) {
  return {.schema = format.schema,
          .read =
              [format](const YamlNode& node, DiagnosticList& errors, Located<T>& value) {
                value.where = node.where;
                return format.read(node, errors, value.value);
              },
          .show = {}};
}

/// N numbers, each within the bounds: [x, y, z].
template <int N>
Format<Eigen::Matrix<double, N, 1>> Vector(double lowest, double highest) {
  using Value = Eigen::Matrix<double, N, 1>;
  const auto list = ListOf(Number(lowest, highest), N, N);
  return {.schema = list.schema,
          .read =
              [list](const YamlNode& node, DiagnosticList& errors, Value& value) {
                std::vector<double> numbers;
                if (!list.read(node, errors, numbers)) return false;
                value = Eigen::Map<const Value>(numbers.data());
                return true;
              },
          .show =
              [](const Value& value) {
                return Json(std::vector<double>(value.data(), value.data() + N));
              }};
}

/// [w, x, y, z] of length 1.
Format<Eigen::Vector4d> UnitQuaternion();

/// A mapping from names to values, in the order of the file.
template <class T>
Format<std::vector<Named<T>>> MapOf(Format<std::string> name, Format<T> item, std::size_t least,
                                    std::size_t most) {
  return {.schema = {{"type", "object"},
                     {"propertyNames", name.schema},
                     {"additionalProperties", item.schema},
                     {"minProperties", least},
                     {"maxProperties", most}},
          .read =
              [=](const YamlNode& node, DiagnosticList& errors, std::vector<Named<T>>& entries) {
                entries.clear();
                bool good = IsMappingOf(node, errors, least, most);
                for (const YamlNode& child : node.children) {
                  YamlNode key;
                  key.kind = YamlNode::Kind::kScalar;
                  key.text = child.key;
                  key.where = child.key_where;
                  Named<T> entry{.name = child.key, .name_where = child.key_where, .value = {}};
                  good &= name.read(key, errors, entry.name);
                  good &= item.read(child, errors, entry.value);
                  entries.push_back(std::move(entry));
                }
                return good;
              },
          .show = {}};
}

/// Reads a whole document. The value is there when nothing is wrong with it.
template <class T>
ReadResult<T> ReadDocument(const YamlDocument& document, const Format<T>& format) {
  DiagnosticList errors(document);
  T value{};
  format.read(document.root, errors, value);
  if (!errors.empty()) return {std::nullopt, errors.Sorted()};
  return {std::move(value), {}};
}

}  // namespace prehend::harness
