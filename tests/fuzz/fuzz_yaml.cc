// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes as YAML, up to the tree in which every key and value knows its place.
// How to run it is in CONTRIBUTING.md.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "harness/base/yaml/located_yaml.h"

namespace {

// Every place is in the text.
void CheckPlaces(const prehend::YamlNode& node, int lines) {
  if (node.where.place.line < 0 || node.where.place.line > lines + 1) std::abort();
  for (const prehend::YamlNode& child : node.children) CheckPlaces(child, lines);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto read = prehend::ParseYaml("fuzz.yaml", text);
  if (!read && read.error().empty()) std::abort();  // no tree and no reason
  const std::string shown = Format(prehend::ErrorsOf(read));
  if (read.has_value() != shown.empty()) std::abort();
  if (read) CheckPlaces(read->root, static_cast<int>(std::count(text.begin(), text.end(), '\n')));
  return 0;
}
