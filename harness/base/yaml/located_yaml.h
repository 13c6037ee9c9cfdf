// SPDX-License-Identifier: Apache-2.0
// YAML as a tree in which every key and value knows its place in the source. A strict subset: one
// document of plain mappings, sequences and scalars. What makes YAML ambiguous or dangerous is
// refused with its place: duplicate keys, `<<` merges, anchors and aliases, tags, several
// documents, tabs, deep nesting. harness/base/yaml/value_format.h decides what the scalars mean.
// Tested by tests/harness/base/yaml/located_yaml_test.cc
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "harness/base/base/located.h"
#include "harness/base/base/result.h"

namespace prehend {

inline constexpr int kMaxYamlDepth = 64;

struct YamlNode {
  enum class Kind { kNull, kScalar, kSequence, kMapping };
  Kind kind = Kind::kNull;
  Where where;
  std::string text;     ///< of a scalar; of a null how it is spelled: "", "~", "null"
  bool quoted = false;  ///< a scalar in quotes or a block scalar: always a string
  std::string
      key;  ///< in a mapping: its key. In a sequence: the sequence's key and index, `size_m[2]`
  Where key_where;  ///< of the key; in a sequence the same as `where`
  std::vector<YamlNode> children;

  /// The value of `name` in this mapping, or null.
  const YamlNode* Find(std::string_view name) const;
};

/// The child called `step` of a mapping, or the one with that index of a sequence; null if there is
/// none.
const YamlNode* ChildOf(const YamlNode& node, std::string_view step);

/// A text that nodes come from: the file, or one `--set` from the command line.
struct YamlSource {
  std::string name;
  std::string text;
};

struct YamlDocument {
  std::vector<YamlSource> sources;  ///< the file first
  YamlNode root;
};

/// Parses `text` after CheckText(). On failure: diagnostics with places in `file`.
Result<YamlDocument> ParseYaml(const std::string& file, std::string text);
/// ReadTextFile() and ParseYaml().
Result<YamlDocument> ReadYamlFile(const std::string& path);

/// Replaces (or adds) a value: `entities.milk.mass_kg=8`, `pictures.0.camera=left`. The value is
/// YAML, too. The new node's place is in a source called `--set`. Returns an error if the path does
/// not exist. A mapping that the file leaves out is created if the JSON Schema has a field of that
/// name there.
grammar::Diagnostics ApplyOverride(const std::string& assignment,
                                   const nlohmann::ordered_json& schema, YamlDocument& document);

/// Whether the JSON Schema requires a whole number at `path`.
bool IsWholeNumber(const std::string& path, const nlohmann::ordered_json& schema,
                   const YamlDocument& document);

// JSON as the same tree that YAML becomes (harness/base/yaml/located_yaml.h), so that one field
// table reads both: every key and value knows its place. Strict JSON (RFC 8259): no comments, no
// bare words. Duplicate keys and deep nesting are refused, too. Tested by
// tests/harness/base/yaml/located_json_test.cc

/// Parses `text`, one JSON value, after CheckText(). Of a number, `text` of its node is as it is
/// spelled. On failure: diagnostics with places in `file`; line 1 is the first line of `text`.
Result<YamlDocument> ParseJson(const std::string& file, std::string text);

}  // namespace prehend
