// SPDX-License-Identifier: Apache-2.0
// The field table of a struct: every field is declared once, with key, member, format and a
// sentence for people; reader and JSON Schema follow from it. See harness/yaml/value_format.h for
// how to use it. Tested by tests/harness/yaml/struct_format_test.cc
#pragma once

#include <concepts>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "harness/yaml/value_format.h"

namespace prehend::harness {

/// The parts of a record's work that do not depend on its struct.
struct RecordRules {
  struct Field {
    std::string key;
    bool required = false;
    Json schema;
  };
  std::string
      noun;  ///< with its article, or without it when the record is named by its key: "entity"
  bool named_by_key = false;
  std::vector<Field> fields;
  std::vector<std::vector<std::string>> exactly_one;  ///< of these keys
  std::vector<std::vector<std::string>> at_most_one;

  /// "a box", or "entity 'milk'".
  std::string TitleOf(const YamlNode& node) const;
  Json Schema() const;
  /// Complains when the node is no mapping, and about unknown and missing keys. False after
  /// complaining.
  bool CheckKeys(const YamlNode& node, DiagnosticList& errors) const;
};

/// Complains unless exactly one key of `cases` is in the mapping; else returns its index.
std::optional<std::size_t> FindCase(const YamlNode& node, const std::string& noun,
                                    const std::vector<std::string>& cases, DiagnosticList& errors);

template <class T>
class Record {
 public:
  /// `noun` is how complaints call it: "a box".
  explicit Record(std::string noun) { state_.rules.noun = std::move(noun); }

  /// DiagnosticList call it by its key: "entity 'milk'" for noun "entity".
  Record& NamedByKey() {
    state_.rules.named_by_key = true;
    return *this;
  }
  template <class M, class F>
  Record& Required(const std::string& key, M T::*member, Format<F> format, const std::string& doc) {
    return Add(key, true, member, std::move(format), doc);
  }
  /// The default is the member's value in T{}.
  template <class M, class F>
  Record& Optional(const std::string& key, M T::*member, Format<F> format, const std::string& doc) {
    return Add(key, false, member, std::move(format), doc);
  }
  Record& ExactlyOneOf(std::vector<std::string> keys) {
    state_.rules.exactly_one.push_back(std::move(keys));
    return *this;
  }
  Record& AtMostOneOf(std::vector<std::string> keys) {
    state_.rules.at_most_one.push_back(std::move(keys));
    return *this;
  }
  /// A rule across fields, checked when all of them are well-formed. The node is the mapping.
  Record& Check(std::function<void(const YamlNode&, const T&, DiagnosticList&)> rule) {
    state_.checks.push_back(std::move(rule));
    return *this;
  }

  Format<T> format() const {
    return {.schema = state_.rules.Schema(),
            .read = [state = state_](const YamlNode& node, DiagnosticList& errors,
                                     T& value) { return Read(state, node, errors, value); },
            .show = {}};
  }

 private:
  struct State {
    RecordRules rules;
    std::vector<std::function<bool(const YamlNode&, DiagnosticList&, T&)>>
        readers;  ///< one per field
    std::vector<std::function<void(const YamlNode&, const T&, DiagnosticList&)>> checks;
  };

  template <class F>
  static void Store(F&& read, const YamlNode&, std::decay_t<F>& member) {
    member = std::forward<F>(read);
  }
  template <class F>
  static void Store(F&& read, const YamlNode&, std::optional<std::decay_t<F>>& member) {
    member = std::forward<F>(read);
  }
  template <class F>
  static void Store(F&& read, const YamlNode& node, Located<std::decay_t<F>>& member) {
    member = {std::forward<F>(read), node.where};
  }
  template <class F>
  static void Store(F&& read, const YamlNode& node,
                    std::optional<Located<std::decay_t<F>>>& member) {
    member = Located<std::decay_t<F>>{std::forward<F>(read), node.where};
  }

  template <class M, class F>
  static void ShowDefault(const M& member, const Format<F>& format, Json& schema) {
    if (!format.show) return;
    if constexpr (std::same_as<M, F>) schema["default"] = format.show(member);
    if constexpr (std::same_as<M, Located<F>>) schema["default"] = format.show(member.value);
  }

  template <class M, class F>
  Record& Add(const std::string& key, bool required, M T::*member, Format<F> format,
              const std::string& doc) {
    Json schema = {{"description", doc}};
    schema.update(format.schema);
    if (!required) ShowDefault(T{}.*member, format, schema);
    state_.rules.fields.push_back({key, required, std::move(schema)});
    state_.readers.push_back(
        [member, format](const YamlNode& node, DiagnosticList& errors, T& value) {
          F read{};
          if constexpr (std::same_as<M, F>)
            read = value.*member;  // keeps what an inner record does not mention
          if (!format.read(node, errors, read)) return false;
          Store(std::move(read), node, value.*member);
          return true;
        });
    return *this;
  }

  static bool Read(const State& state, const YamlNode& node, DiagnosticList& errors, T& value) {
    if constexpr (requires(T & t) { t.where = Where{}; }) value.where = node.where;
    if (node.kind != YamlNode::Kind::kMapping) return state.rules.CheckKeys(node, errors);
    bool good = state.rules.CheckKeys(node, errors);
    for (std::size_t i = 0; i < state.readers.size(); ++i) {
      const YamlNode* child = node.Find(state.rules.fields[i].key);
      if (child) good &= state.readers[i](*child, errors, value);
    }
    if (good) {
      for (const auto& check : state.checks) check(node, value, errors);
    }
    return good;
  }

  State state_;
};

/// A record read as one alternative of a variant.
template <class V, class A>
Format<V> AsAlternative(Format<A> format) {
  return {.schema = format.schema,
          .read =
              [format](const YamlNode& node, DiagnosticList& errors, V& value) {
                A alternative{};
                if (!format.read(node, errors, alternative)) return false;
                value = std::move(alternative);
                return true;
              },
          .show = {}};
}

/// One of several records, told apart by a key that only that one has.
template <class T>
Format<T> ByKey(const std::string& noun, std::vector<std::pair<std::string, Format<T>>> cases) {
  Json one_of = Json::array();
  std::vector<std::string> keys;
  for (const auto& [key, format] : cases) {
    one_of.push_back(format.schema);
    keys.push_back(key);
  }
  return {.schema = {{"oneOf", std::move(one_of)}},
          .read =
              [noun, keys, cases](const YamlNode& node, DiagnosticList& errors, T& value) {
                const auto found = FindCase(node, noun, keys, errors);
                return found && cases[*found].second.read(node, errors, value);
              },
          .show = {}};
}

}  // namespace prehend::harness
