// SPDX-License-Identifier: Apache-2.0
// The format of a struct: every field is declared once, with key, member, format and a sentence for
// people; reader and JSON Schema follow from it. See harness/base/yaml/value_format.h for how to
// use it.
//
// A field is kept without the types of its struct and of its value: as an offset and a function
// that reads a value into the member there. So a table of fields compiles to data, and the work is
// done by one reader in harness/base/yaml/struct_format.cc. Tested by
// tests/harness/base/yaml/struct_format_test.cc
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "harness/base/yaml/value_format.h"

namespace prehend {

/// Reads a value with `read` and stores it in the member. False after an error.
using MemberReader = bool (*)(const ErasedFormat::Read& read, const YamlNode& node,
                              DiagnosticList& errors, void* member);

/// One row of the table.
struct Field {
  std::string key;
  bool required = false;
  Schema schema;  ///< of its value
  std::string doc;
  std::optional<Json> initial;  ///< its default, where the schema shows one
  std::ptrdiff_t offset = 0;    ///< of the member in the struct, in bytes
  MemberReader read_member = nullptr;
  ErasedFormat::Read read;
};

/// The table of a struct, without its type: `value` points to one.
struct StructRules {
  using Check = std::function<void(const YamlNode&, const void* value, DiagnosticList&)>;

  // Compiled once, not for each struct.
  explicit StructRules(std::string called);
  StructRules(const StructRules& other);
  ~StructRules();

  std::string noun;  ///< with its article: "a box"; without when it is named by its key: "entity"
  bool named_by_key = false;
  std::optional<std::ptrdiff_t> where_offset;  ///< of its member `Where where`
  std::vector<Field> fields;
  std::vector<std::vector<std::string>> exactly_one;  ///< of these keys
  std::vector<std::vector<std::string>> at_most_one;
  std::vector<std::pair<std::string, std::string>> remedies;  ///< of keys that people try
  std::vector<Check> checks;

  /// `initial` is the member's default value, or null if the schema shows none.
  void Add(std::string_view key, bool required, std::ptrdiff_t offset, MemberReader read_member,
           const ErasedFormat& format, std::string_view doc, const void* initial);
  bool Read(const YamlNode& node, DiagnosticList& errors, void* value) const;
  Json MakeSchema() const;

 private:
  /// "a box", or "entity 'milk'".
  std::string TitleOf(const YamlNode& node) const;
  /// Reports a node that is no mapping, unknown keys and missing keys. False after an error.
  bool CheckKeys(const YamlNode& node, DiagnosticList& errors) const;
  /// What is not a mapping written as one: "box: {size_m: [0.1, 0.1, 0.1]}"; or "".
  std::string AsMapping(const YamlNode& node) const;
};

/// The format that these rules describe.
ErasedFormat FormatOf(const StructRules& rules);

/// How a member holds a value of the type F: as it is, optionally, or with its place.
template <class M, class F>
struct MemberOf {
  static void Store(F&& read, const YamlNode&, std::optional<F>& member) {
    member = std::move(read);
  }
  static void Store(F&& read, const YamlNode& node, Located<F>& member) {
    member = {std::move(read), node.where};
  }
  static void Store(F&& read, const YamlNode& node, std::optional<Located<F>>& member) {
    member = Located<F>{std::move(read), node.where};
  }

  static bool Read(const ErasedFormat::Read& reader, const YamlNode& node, DiagnosticList& errors,
                   void* member) {
    M& stored = *static_cast<M*>(member);
    if constexpr (std::is_same_v<M, F>) {
      F read = stored;  // keeps what an inner struct does not mention
      if (!reader(node, errors, &read)) return false;
      stored = std::move(read);
    } else {
      F read{};
      if (!reader(node, errors, &read)) return false;
      Store(std::move(read), node, stored);
    }
    return true;
  }

  /// The default value for the schema, or null if there is none.
  static const void* Shown(const M& member) {
    if constexpr (std::is_same_v<M, F>) return &member;
    if constexpr (std::is_same_v<M, Located<F>>) return &member.value;
    return nullptr;
  }
};

template <class T>
class StructFormat {
 public:
  /// `noun` is its name in messages: "a box".
  explicit StructFormat(std::string noun) : rules_(std::move(noun)) {
    if constexpr (requires(T & t) { t.where = Where{}; })
      rules_.where_offset = OffsetOf(defaults_.where);
  }

  /// Messages name it by its key: "entity 'milk'" for the noun "entity".
  StructFormat& NamedByKey() {
    rules_.named_by_key = true;
    return *this;
  }
  /// The member is one of T or of a base of T.
  template <class M, class Base, class F>
  StructFormat& Required(std::string_view key, M Base::*member, const ValueFormat<F>& format,
                         std::string_view doc) {
    return Add<M>(key, true, member, format, doc);
  }
  /// The default is the member's value in T{}.
  template <class M, class Base, class F>
  StructFormat& Optional(std::string_view key, M Base::*member, const ValueFormat<F>& format,
                         std::string_view doc) {
    return Add<M>(key, false, member, format, doc);
  }
  StructFormat& ExactlyOneOf(std::vector<std::string> keys) {
    rules_.exactly_one.push_back(std::move(keys));
    return *this;
  }
  StructFormat& AtMostOneOf(std::vector<std::string> keys) {
    rules_.at_most_one.push_back(std::move(keys));
    return *this;
  }
  /// The key was called `former`; the error about the former key names the new one.
  StructFormat& Renamed(std::string former, std::string key) {
    return Remedy(std::move(former), "it is called '" + key + "' now");
  }
  /// People try this key; the error about it says what is written instead.
  StructFormat& Remedy(std::string key, std::string remedy) {
    rules_.remedies.emplace_back(std::move(key), std::move(remedy));
    return *this;
  }
  /// A rule across fields, checked when all of them are well-formed. The node is the mapping, the
  /// rule void(const YamlNode&, const T&, DiagnosticList&).
  template <class Rule>
  StructFormat& Check(Rule rule) {
    rules_.checks.push_back(
        [rule = std::move(rule)](const YamlNode& node, const void* value, DiagnosticList& errors) {
          rule(node, *static_cast<const T*>(value), errors);
        });
    return *this;
  }

  ValueFormat<T> format() const { return ValueFormat<T>(FormatOf(rules_)); }

 private:
  template <class M>
  std::ptrdiff_t OffsetOf(const M& member) const {
    return reinterpret_cast<const char*>(&member) - reinterpret_cast<const char*>(&defaults_);
  }

  template <class M, class F>
  StructFormat& Add(std::string_view key, bool required, M T::*member, const ValueFormat<F>& format,
                    std::string_view doc) {
    const M& initial = defaults_.*member;
    rules_.Add(key, required, OffsetOf(initial), &MemberOf<M, F>::Read, format.erased(), doc,
               required ? nullptr : MemberOf<M, F>::Shown(initial));
    return *this;
  }

  T defaults_{};
  StructRules rules_;
};

/// Keys that people try, and what is written instead; with the key "" what to do with two actions.
using Remedies = std::vector<std::pair<std::string, std::string>>;

/// One of several structs, told apart by a key that only that one has. `cases` are formats of the
/// same type.
ErasedFormat ErasedByKey(const std::string& noun,
                         std::vector<std::pair<std::string, ErasedFormat>> cases,
                         Remedies remedies);

template <class T>
ValueFormat<T> ByKey(const std::string& noun,
                     const std::vector<std::pair<std::string, ValueFormat<T>>>& cases,
                     Remedies remedies = {}) {
  std::vector<std::pair<std::string, ErasedFormat>> erased;
  for (const auto& [key, format] : cases) erased.emplace_back(key, format.erased());
  return ValueFormat<T>(ErasedByKey(noun, std::move(erased), std::move(remedies)));
}

/// A struct read as one alternative of a variant, or as what `convert` makes of it.
template <class V, class A, class Convert = std::identity>
ValueFormat<V> AsAlternative(const ValueFormat<A>& format, Convert convert = {}) {
  return ValueFormat<V>({.schema = format.schema(),
                         .read = [read = format.erased().read, convert](
                                     const YamlNode& node, DiagnosticList& errors, void* value) {
                           A alternative{};
                           if (!read(node, errors, &alternative)) return false;
                           *static_cast<V*>(value) = convert(std::move(alternative));
                           return true;
                         }});
}

}  // namespace prehend
