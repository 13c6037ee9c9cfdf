// SPDX-License-Identifier: Apache-2.0
#include "harness/base/yaml/struct_format.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "harness/base/yaml/yaml_scalar.h"

namespace prehend {
namespace {

/// The key without its unit: "mass_kg" -> "mass". Units are the last words of a key.
std::string WithoutUnit(const std::string& key) {
  static constexpr std::string_view kUnits[] = {
      "_m",   "_mm",  "_cm", "_km", "_kg", "_g",    "_s",      "_ms",     "_hz",      "_n",
      "_deg", "_rad", "_nm", "_in", "_lb", "_inch", "_meters", "_metres", "_seconds", "_degrees"};
  for (const std::string_view unit : kUnits) {
    if (key.size() > unit.size() && key.ends_with(unit))
      return key.substr(0, key.size() - unit.size());
  }
  return key;
}

/// Returns the known key that was probably meant, or "".
std::string ReportUnknownKey(const YamlNode& child, const std::string& title,
                             const std::vector<std::string>& known,
                             const std::vector<std::pair<std::string, std::string>>& remedies,
                             DiagnosticList& errors) {
  const std::string message = fmt::format("unknown key '{}' in {}", child.key, title);
  for (const auto& [key, said] : remedies) {
    const std::string& remedy = said;  // clang 14 captures no structured binding
    if (child.key != key) continue;
    errors.Add(child.key_where, message, remedy);
    const auto named = std::ranges::find_if(known, [&](const std::string& other) {
      return remedy.find("'" + other + "'") != std::string::npos;
    });
    return named == known.end() ? "" : *named;
  }
  const auto same_stem = std::find_if(known.begin(), known.end(), [&](const std::string& key) {
    return WithoutUnit(key) == WithoutUnit(child.key);
  });
  if (same_stem != known.end()) {
    errors.Add(child.key_where, message, fmt::format("did you mean '{}'?", *same_stem));
    return *same_stem;
  }
  if (const std::string remedy = LookAlikeRemedy(child.key); !remedy.empty()) {
    errors.Add(child.key_where, message, remedy);
    return "";
  }
  const bool is_number = child.key.find_first_not_of("0123456789") == std::string::npos,
             closes_call = child.key.find(')') != std::string::npos;
  if ((is_number || closes_call) && child.kind == YamlNode::Kind::kNull) {
    errors.Add(child.key_where, message,
               is_number ? "decimals have a point: 0.5"
                         : "in {..} a comma ends a value: put one with a comma in quotes");
    return "";
  }
  errors.AddUnknownName(child.key_where, message, child.key, known);
  return grammar::NearestName(child.key, known);
}

/// Where an error about a whole mapping is shown: at its name, if it has one.
Where HeadOf(const YamlNode& node) {
  const bool in_list = node.key.ends_with(']');
  return node.key.empty() || in_list || node.key_where.place.line == 0 ? node.where
                                                                       : node.key_where;
}

/// "[0.1, 0.2]" of a list of scalars; "[..]" of another one.
std::string FlowOf(const YamlNode& list) {
  constexpr std::size_t kMostItems = 6;
  std::string items;
  for (const YamlNode& item : list.children) {
    if (item.kind != YamlNode::Kind::kScalar || list.children.size() > kMostItems) return "[..]";
    items += (items.empty() ? "" : ", ") + item.text;
  }
  return "[" + items + "]";
}

std::vector<std::string> KeysPresent(const YamlNode& node, const std::vector<std::string>& keys) {
  std::vector<std::string> present;
  for (const YamlNode& child : node.children) {
    if (std::find(keys.begin(), keys.end(), child.key) != keys.end()) present.push_back(child.key);
  }
  return present;
}

Json Requires(const std::vector<std::string>& keys) { return {{"required", keys}}; }

/// The index of the one key of `cases` that is in the mapping; nothing after an error.
std::optional<std::size_t> FindCase(const YamlNode& node, const std::string& noun,
                                    const std::vector<std::string>& cases, const Remedies& remedies,
                                    DiagnosticList& errors) {
  if (node.kind != YamlNode::Kind::kMapping) {
    ReportExpected(node, errors, fmt::format("a mapping with the fields of {}", noun));
    return std::nullopt;
  }
  const auto present = KeysPresent(node, cases);
  if (present.size() == 1) {
    return static_cast<std::size_t>(std::find(cases.begin(), cases.end(), present[0]) -
                                    cases.begin());
  }
  if (present.size() > 1) {
    const auto both = std::ranges::find(remedies, "", &Remedies::value_type::first);
    errors.Add(node.Find(present[1])->key_where,
               fmt::format("{} has one of '{}' and '{}', not both", noun, present[0], present[1]),
               both == remedies.end() ? "" : both->second);
    return std::nullopt;
  }
  for (const YamlNode& child : node.children) {
    const auto tried = std::ranges::find(remedies, child.key, &Remedies::value_type::first);
    if (tried == remedies.end()) continue;
    errors.Add(child.key_where, fmt::format("{} has no key '{}'", noun, child.key), tried->second);
    return std::nullopt;
  }
  const std::string first = node.children.empty() ? "" : node.children[0].key;
  errors.AddUnknownName(
      node.children.empty() ? node.where : node.children[0].key_where,
      fmt::format("{} needs one of the keys {}", noun, fmt::join(cases, ", ")), first,
      grammar::NearestName(first, cases).empty() ? std::vector<std::string>{} : cases);
  return std::nullopt;
}

}  // namespace

StructRules::StructRules(std::string called) : noun(std::move(called)) {}
StructRules::StructRules(const StructRules& other) = default;
StructRules::~StructRules() = default;

void StructRules::Add(std::string_view key, bool required, std::ptrdiff_t offset,
                      MemberReader read_member, const ErasedFormat& format, std::string_view doc,
                      const void* initial) {
  fields.push_back(
      {.key = std::string(key),
       .required = required,
       .schema = format.schema,
       .doc = std::string(doc),
       .initial = initial && format.show ? std::optional(format.show(initial)) : std::nullopt,
       .offset = offset,
       .read_member = read_member,
       .read = format.read});
}

bool StructRules::Read(const YamlNode& node, DiagnosticList& errors, void* value) const {
  char* const bytes = static_cast<char*>(value);
  if (where_offset) *reinterpret_cast<Where*>(bytes + *where_offset) = node.where;
  bool good = CheckKeys(node, errors);
  if (node.kind != YamlNode::Kind::kMapping) return good;
  for (const Field& field : fields) {
    const YamlNode* child = node.Find(field.key);
    if (child) good &= field.read_member(field.read, *child, errors, bytes + field.offset);
  }
  if (good) {
    for (const Check& check : checks) check(node, value, errors);
  }
  return good;
}

std::string StructRules::TitleOf(const YamlNode& node) const {
  return named_by_key && !node.key.empty() ? fmt::format("{} '{}'", noun, node.key) : noun;
}

Json StructRules::MakeSchema() const {
  Json schema = {
      {"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
  Json required = Json::array();
  for (const Field& field : fields) {
    Json& property = schema["properties"][field.key];
    property = {{"description", field.doc}};
    property.update(field.schema.json());
    if (field.initial) property["default"] = *field.initial;
    if (field.required) required.push_back(field.key);
  }
  if (!required.empty()) schema["required"] = std::move(required);
  Json all_of = Json::array();
  for (const auto& keys : exactly_one) {
    Json one_of = Json::array();
    for (const std::string& key : keys) one_of.push_back(Requires({key}));
    all_of.push_back({{"oneOf", std::move(one_of)}});
  }
  for (const auto& keys : at_most_one) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
      for (std::size_t j = i + 1; j < keys.size(); ++j)
        all_of.push_back({{"not", Requires({keys[i], keys[j]})}});
    }
  }
  if (!all_of.empty()) schema["allOf"] = std::move(all_of);
  return schema;
}

std::string StructRules::AsMapping(const YamlNode& node) const {
  if (named_by_key || node.key.empty() || node.key.ends_with(']')) return "";
  std::string fields_text;
  std::vector<std::string> needed;
  for (const Field& field : fields)
    if (field.required) needed.push_back(field.key);
  std::string value = "..";
  if (needed.size() == 1 && node.kind == YamlNode::Kind::kScalar) value = node.text;
  if (needed.size() == 1 && node.kind == YamlNode::Kind::kSequence) value = FlowOf(node);
  for (const std::string& key : needed)
    fields_text += fmt::format("{}{}: {}", fields_text.empty() ? "" : ", ", key, value);
  return needed.empty() ? "" : fmt::format("{}: {{{}}}", node.key, fields_text);
}

bool StructRules::CheckKeys(const YamlNode& node, DiagnosticList& errors) const {
  if (node.kind != YamlNode::Kind::kMapping) {
    const std::string wanted = fmt::format("a mapping with the fields of {}", TitleOf(node));
    const std::string written = AsMapping(node);
    if (written.empty()) return ReportExpected(node, errors, wanted);
    errors.Add(node.where,
               fmt::format("{}: expected {}, found {}", node.key, wanted, Describe(node)),
               "write '" + written + "'");
    return false;
  }
  std::vector<std::string> known;
  for (const Field& field : fields) known.push_back(field.key);
  bool good = true;
  std::set<std::string> meant;  // but misspelt: not reported as missing, too
  for (const YamlNode& child : node.children) {
    if (std::find(known.begin(), known.end(), child.key) != known.end()) continue;
    meant.insert(ReportUnknownKey(child, TitleOf(node), known, remedies, errors));
    good = false;
  }
  for (const Field& field : fields) {
    if (!field.required || node.Find(field.key) || meant.contains(field.key)) continue;
    errors.Add(HeadOf(node), fmt::format("{} needs the key '{}'", TitleOf(node), field.key));
    good = false;
  }
  for (const auto& keys : exactly_one) {
    const bool misspelt =
        std::any_of(keys.begin(), keys.end(), [&](const auto& key) { return meant.contains(key); });
    if (misspelt || !KeysPresent(node, keys).empty()) continue;
    errors.Add(HeadOf(node),
               fmt::format("{} needs one of the keys {}", TitleOf(node), fmt::join(keys, ", ")));
    good = false;
  }
  for (const auto* groups : {&exactly_one, &at_most_one}) {
    for (const auto& keys : *groups) {
      const auto present = KeysPresent(node, keys);
      if (present.size() < 2) continue;
      errors.Add(
          node.Find(present[1])->key_where,
          fmt::format("{} cannot have both '{}' and '{}'", TitleOf(node), present[0], present[1]));
      good = false;
    }
  }
  return good;
}

ErasedFormat FormatOf(const StructRules& rules) {
  const auto shared = std::make_shared<const StructRules>(rules);
  ErasedFormat format{.schema = [shared] { return shared->MakeSchema(); },
                      .read = [shared](const YamlNode& node, DiagnosticList& errors,
                                       void* value) { return shared->Read(node, errors, value); }};
  for (const Field& field : rules.fields) format.keys.push_back(field.key);
  return format;
}

ErasedFormat ErasedByKey(const std::string& noun,
                         std::vector<std::pair<std::string, ErasedFormat>> cases,
                         Remedies remedies) {
  std::vector<Schema> schemas;
  std::vector<std::string> keys;
  std::vector<ErasedFormat::Read> readers;
  for (auto& [key, format] : cases) {
    schemas.push_back(std::move(format.schema));
    keys.push_back(key);
    readers.push_back(std::move(format.read));
  }
  return {.schema =
              [schemas = std::move(schemas)] {
                Json one_of = Json::array();
                for (const Schema& schema : schemas) one_of.push_back(schema.json());
                return Json{{"oneOf", std::move(one_of)}};
              },
          .read =
              [noun, keys = std::move(keys), readers = std::move(readers),
               remedies = std::move(remedies)](const YamlNode& node, DiagnosticList& errors,
                                               void* value) {
                const auto found = FindCase(node, noun, keys, remedies, errors);
                return found && readers[*found](node, errors, value);
              }};
}

}  // namespace prehend
