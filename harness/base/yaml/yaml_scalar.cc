// SPDX-License-Identifier: Apache-2.0
#include "harness/base/yaml/yaml_scalar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "harness/base/base/number_text.h"
#include "harness/base/base/project_paths.h"
#include "harness/base/yaml/located_yaml.h"

namespace prehend {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

/// Length of the run of digits at `at`.
std::size_t Digits(std::string_view text, std::size_t at) {
  std::size_t n = 0;
  while (at + n < text.size() && IsDigit(text[at + n])) ++n;
  return n;
}

/// A number as in JSON (RFC 8259): all YAML readers agree on these, and from_chars() reads them.
struct JsonNumber {
  bool matches = false;
  bool integer = false;
};
JsonNumber MatchJsonNumber(std::string_view text) {
  std::size_t at = text.starts_with('-') ? 1 : 0;
  const std::size_t whole = Digits(text, at);
  if (whole == 0 || (whole > 1 && text[at] == '0')) return {};
  at += whole;
  bool integer = true;
  if (at < text.size() && text[at] == '.') {
    const std::size_t fraction = Digits(text, at + 1);
    if (fraction == 0) return {};
    at += 1 + fraction;
    integer = false;
  }
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    ++at;
    if (at < text.size() && (text[at] == '+' || text[at] == '-')) ++at;
    const std::size_t exponent = Digits(text, at);
    if (exponent == 0) return {};
    at += exponent;
    integer = false;
  }
  return {at == text.size(), integer};
}

template <std::size_t N>
bool OneOf(std::string_view text, const std::string_view (&words)[N]) {
  return std::find(std::begin(words), std::end(words), text) != std::end(words);
}

ScalarMeaning Ambiguous(std::string reason, std::string remedy) {
  ScalarMeaning meaning;
  meaning.ambiguous = std::move(reason);
  meaning.remedy = std::move(remedy);
  return meaning;
}

/// Scalars that look like a number, or are a number only to some readers.
std::optional<ScalarMeaning> AmbiguousNumber(const std::string& text) {
  const std::string_view unsigned_text =
      std::string_view(text).substr(text.find_first_not_of("+-") == 1 ? 1 : 0);
  const std::string lower = LowerCase(unsigned_text);
  static constexpr std::string_view kNotFinite[] = {"nan", ".nan", "inf", ".inf", "infinity"};
  if (OneOf(lower, kNotFinite)) return Ambiguous("not a finite number", "write a finite number");
  if (lower.empty() ||
      !(IsDigit(lower[0]) || (lower[0] == '.' && lower.size() > 1 && IsDigit(lower[1]))))
    return {};

  const auto only = [&](std::string_view allowed) {
    return lower.find_first_not_of(allowed) == std::string::npos;
  };
  if (lower.starts_with("0x") || lower.starts_with("0o") || lower.starts_with("0b")) {
    return Ambiguous("a number in another base to some YAML readers", "write a decimal number");
  }
  if (only("0123456789_.") && lower.find('_') != std::string::npos) {
    return Ambiguous("only some YAML readers take '_' for a separator",
                     "write the digits without '_'");
  }
  if (only("0123456789:.") && lower.find(':') != std::string::npos) {
    return Ambiguous("a number in base 60 to some YAML readers",
                     "write seconds as a decimal number, or quote it");
  }
  if (only("0123456789") && lower[0] == '0') {
    const std::size_t significant = std::min(lower.find_first_not_of('0'), lower.size() - 1);
    return Ambiguous("a leading zero means octal to some YAML readers",
                     fmt::format("write {}", lower.substr(significant)));
  }
  if (text[0] == '+') return Ambiguous("a number with a plus sign", "remove the '+'");
  if (only("0123456789.") && std::count(lower.begin(), lower.end(), '.') == 1) {
    return Ambiguous("a number without a digit on both sides of the point",
                     "write for example 0.5 or 5.0");
  }
  return {};
}

// `--set a.b.c=value`: changes the tree before it is read, so every check of the file applies to
// it. Tested by tests/harness/base/yaml/located_yaml_test.cc

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

ScalarMeaning MeaningOf(const YamlNode& node) {
  ScalarMeaning meaning;
  const std::string& text = node.text;
  if (node.quoted) {
    meaning.string = text;
    return meaning;
  }
  if (const JsonNumber match = MatchJsonNumber(text); match.matches) {
    meaning.number = NumberFrom<double>(text);
    if (!meaning.number || !std::isfinite(*meaning.number))
      return Ambiguous("outside the range of numbers", "");
    meaning.integer = match.integer;
    return meaning;
  }
  if (text == "true" || text == "false") {
    meaning.flag = text == "true";
    return meaning;
  }
  const std::string lower = LowerCase(text);
  static constexpr std::string_view kTrue[] = {"yes", "on", "y", "true"};
  static constexpr std::string_view kFalse[] = {"no", "off", "n", "false"};
  if (OneOf(lower, kTrue) || OneOf(lower, kFalse)) {
    return Ambiguous("true or false to some YAML readers",
                     "write a number, true or false, or text in quotes");
  }
  if (auto number = AmbiguousNumber(text)) return *number;
  meaning.string = text;
  return meaning;
}

std::optional<double> NumberOf(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kScalar) return std::nullopt;
  const auto number = MeaningOf(node).number;
  return number && std::abs(*number) <= kMaxNumber ? number : std::nullopt;
}

std::string Describe(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::kNull:
      return node.text.empty() ? "nothing" : fmt::format("'{}'", node.text);
    case YamlNode::Kind::kSequence:
      return "a list";
    case YamlNode::Kind::kMapping:
      return "a mapping";
    case YamlNode::Kind::kScalar:
      break;
  }
  constexpr std::size_t kMaxShown = 40;
  std::string shown = node.text;
  if (shown.size() > kMaxShown) {
    std::size_t cut = kMaxShown;  // not within a UTF-8 sequence
    while (cut > 0 && (static_cast<unsigned char>(shown[cut]) & 0xC0) == 0x80) --cut;
    shown = shown.substr(0, cut) + "...";
  }
  return node.quoted ? fmt::format("the text '{}'", shown) : fmt::format("'{}'", shown);
}

std::string LookAlikeRemedy(std::string_view text) {
  struct Pair {
    std::string_view found, meant;
  };
  constexpr Pair kPairs[] = {{"\u2212", "-"},  {"\u2013", "-"},  {"\u2014", "-"}, {"\u201c", "\""},
                             {"\u201d", "\""}, {"\u201e", "\""}, {"\u2018", "'"}, {"\u2019", "'"},
                             {"\uff1a", ":"},  {"\uff0c", ","},  {"\u00a0", " "}, {"\u202f", " "},
                             {"\u3000", " "}};
  for (const auto& [found, meant] : kPairs) {
    if (text.find(found) == std::string_view::npos) continue;
    return meant == " " ? "it contains a non-standard space character; retype it"
                        : fmt::format("'{}' is not '{}'; retype it", found, meant);
  }
  return "";
}

const YamlNode* ChildOf(const YamlNode& node, std::string_view step) {
  if (node.kind != Kind::kSequence) return node.Find(step);
  const auto index = NumberFrom<std::size_t>(step);
  return index && *index < node.children.size() ? &node.children[*index] : nullptr;
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
