// SPDX-License-Identifier: Apache-2.0
// Only the values that change are written anew, at the places where they stand.
#include <functional>
#include <vector>

#include "harness/base/yaml/located_yaml.h"
#include "harness/base/yaml/yaml_scalar.h"
#include "harness/scenario/format/scenario_fields.h"

namespace prehend::scenario {
namespace {

namespace fs = std::filesystem;

/// Quoted if some YAML reader would not read a string: `on`, `no`, `null`.
std::string YamlWord(const std::string& value) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-";
  YamlNode plain;
  plain.kind = YamlNode::Kind::kScalar;
  plain.text = value;
  if (value.find_first_not_of(kPlain) == std::string::npos && value != "null" &&
      MeaningOf(plain).string)
    return value;
  std::string quoted = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

/// Where a place begins in the text.
std::size_t OffsetOf(grammar::Place place, const std::string& text) {
  std::size_t offset = 0;
  for (int line = 1; line < place.line; ++line) offset = text.find('\n', offset) + 1;
  return offset + static_cast<std::size_t>(place.column) - 1;
}

/// How long a scalar is in the text, quotes and all.
std::size_t LengthAt(std::size_t offset, const YamlNode& node, const std::string& text) {
  if (!node.quoted) return node.text.size();
  const char quote = text[offset];
  std::size_t end = offset + 1;
  while (end < text.size() && text[end] != quote) end += quote == '"' && text[end] == '\\' ? 2 : 1;
  return end + 1 - offset;
}

/// Calls `visit` for every file beside the scenario that is named, in the order of the text.
void ForEachFile(const YamlNode& node, const std::function<void(const YamlNode&)>& visit) {
  const bool is_hand_file = node.key == "hand" && node.text.ends_with(".hand.yaml");
  const bool is_grasp_file = node.text.ends_with(".grasps.yaml");
  if (node.kind == YamlNode::Kind::kScalar &&
      (node.key == "recording" || is_hand_file || is_grasp_file))
    visit(node);
  for (const YamlNode& child : node.children) ForEachFile(child, visit);
}

struct Edit {
  const YamlNode* node;
  std::string value;
};

}  // namespace

Result<std::string> CopyOfScenario(const fs::path& from, const std::string& text,
                                   const fs::path& to) {
  PREHEND_TRY(const YamlDocument document, ParseYaml(from.string(), text));
  std::vector<Edit> edits;
  if (const YamlNode* name = document.root.Find("scenario");
      name && name->kind == YamlNode::Kind::kScalar)
    edits.push_back({name, to.stem().string()});
  const fs::path old_folder = fs::absolute(from).lexically_normal().parent_path();
  const fs::path new_folder = fs::absolute(to).lexically_normal().parent_path();
  ForEachFile(document.root, [&](const YamlNode& node) {
    const fs::path file = node.text;
    if (old_folder == new_folder || file.is_absolute()) return;
    edits.push_back({&node, (old_folder / file).lexically_relative(new_folder).generic_string()});
  });
  std::string copy = text;
  for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit) {
    const std::size_t offset = OffsetOf(edit->node->where.place, copy);
    copy.replace(offset, LengthAt(offset, *edit->node, copy), YamlWord(edit->value));
  }
  return copy;
}

}  // namespace prehend::scenario
