// SPDX-License-Identifier: Apache-2.0
// `--set a.b.c=value`: changes the tree before it is read, so every check of the file applies to
// it. Tested by tests/harness/base/yaml/located_yaml_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "harness/base/base/project_paths.h"
#include "harness/base/yaml/located_yaml.h"

namespace prehend {
namespace {

using grammar::Diagnostics;
using grammar::Place;
using Kind = YamlNode::Kind;

/// Moves a parsed value to its place in the assignment's text, and names the items of lists after
/// `node.key`.
void Relocate(YamlNode& node, int source, int column_offset) {
  for (Where* where : {&node.where, &node.key_where}) {
    where->source = source;
    if (where->place.line <= 1) where->place.column += column_offset;
  }
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    if (node.kind == Kind::kSequence) node.children[i].key = fmt::format("{}[{}]", node.key, i);
    Relocate(node.children[i], source, column_offset);
  }
}

using SchemaJson = nlohmann::ordered_json;

/// The schema of the field called `step`, or of a list's items; null if there is none.
const SchemaJson* FieldSchema(const SchemaJson* schema, const std::string& step) {
  if (!schema) return nullptr;
  const auto properties = schema->find("properties");
  if (properties != schema->end() && properties->contains(step)) return &(*properties)[step];
  for (const char* others : {"additionalProperties", "items"}) {
    const auto found = schema->find(others);
    if (found != schema->end() && found->is_object()) return &*found;
  }
  return nullptr;
}

/// For a schema with alternatives (an actor is a hand or a person): the first that has every key of
/// the node.
const SchemaJson* Alternative(const SchemaJson* schema, const YamlNode& node) {
  if (!schema || !schema->contains("oneOf")) return schema;
  for (const SchemaJson& alternative : (*schema)["oneOf"]) {
    const auto known = alternative.find("properties");
    const bool fits = known != alternative.end() &&
                      std::ranges::all_of(node.children, [&](const YamlNode& child) {
                        return known->contains(child.key);
                      });
    if (fits) return &alternative;
  }
  return schema;
}

/// Whether a field of that name may be left out in the file, and is a mapping.
bool IsOptionalMapping(const SchemaJson* schema, const std::string& step) {
  return schema && schema->contains("properties") && (*schema)["properties"].contains(step) &&
         (*schema)["properties"][step].contains("properties");
}

/// The keys that a mapping has and those that its schema allows.
std::vector<std::string> NamesIn(const YamlNode& node, const SchemaJson* schema) {
  std::vector<std::string> names;
  if (schema && schema->contains("properties")) {
    for (const auto& [name, field] : (*schema)["properties"].items()) names.push_back(name);
  }
  for (const YamlNode& child : node.children) names.push_back(child.key);
  return names;
}

std::string HintFor(const YamlNode& node, const SchemaJson* schema, const std::string& step) {
  if (node.kind == Kind::kSequence)
    return fmt::format("'{}' is a list of {}", node.key, node.children.size());
  const std::string near = grammar::NearestName(step, NamesIn(node, schema));
  return near.empty() ? "" : fmt::format("did you mean '{}'?", near);
}

}  // namespace

const YamlNode* ChildOf(const YamlNode& node, std::string_view step) {
  if (node.kind != Kind::kSequence) return node.Find(step);
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(step.data(), step.data() + step.size(), index);
  const bool whole = error == std::errc() && end == step.data() + step.size();
  return whole && index < node.children.size() ? &node.children[index] : nullptr;
}

Diagnostics ApplyOverride(const std::string& assignment, const SchemaJson& schema,
                          YamlDocument& document) {
  const auto report = [&](std::size_t offset, std::string message,
                          std::string hint) -> Diagnostics {
    return {grammar::DiagnosticAt("--set", assignment, {1, static_cast<int>(offset) + 1},
                                  std::move(message), std::move(hint))};
  };
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == assignment.size()) {
    return report(0, "expected PATH=VALUE", "for example entities.milk.mass_kg=8");
  }
  PREHEND_TRY(auto parsed, ParseYaml("--set", assignment.substr(equals + 1)));

  document.sources.push_back({"--set", assignment});
  const int source = static_cast<int>(document.sources.size()) - 1;
  YamlNode* node = &document.root;
  const SchemaJson* known = &schema;  // about `node`
  std::size_t last_step = 0;
  for (std::size_t begin = 0; begin <= equals;) {
    last_step = begin;
    const std::size_t end = std::min(assignment.find('.', begin), equals);
    const std::string step = assignment.substr(begin, end - begin);
    auto* child = const_cast<YamlNode*>(ChildOf(*node, step));
    const bool last = end == equals;
    const bool may_add = node->kind == Kind::kMapping && (last || IsOptionalMapping(known, step));
    if (!child && !may_add) {
      return report(begin, fmt::format("nothing is called '{}' here", step),
                    HintFor(*node, known, step));
    }
    if (!child) {
      child = &node->children.emplace_back();
      child->key = step;
      if (!last) child->kind = Kind::kMapping;
      child->where = child->key_where = {source, {1, static_cast<int>(begin) + 1}};
    }
    known = Alternative(FieldSchema(known, step), *child);
    node = child;
    begin = end + 1;
  }

  YamlNode value = std::move(parsed.root);
  value.key = node->key;
  Relocate(value, source, static_cast<int>(equals) + 1);
  value.key_where = {source, {1, static_cast<int>(last_step) + 1}};
  *node = std::move(value);
  return {};
}

bool IsWholeNumber(const std::string& path, const SchemaJson& schema,
                   const YamlDocument& document) {
  const YamlNode* node = &document.root;
  const SchemaJson* known = &schema;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string step = path.substr(begin, end - begin);
    known = FieldSchema(known, step);
    if (node) node = ChildOf(*node, step);
    if (node) known = Alternative(known, *node);
    begin = end + 1;
  }
  return known && known->value("type", "") == "integer";
}

}  // namespace prehend
