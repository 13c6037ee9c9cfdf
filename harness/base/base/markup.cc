// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/markup.h"

#include <sstream>

#include "harness/base/base/text_file.h"

namespace prehend {

pugi::xml_node AddElement(pugi::xml_node parent, const char* name, Attributes attributes) {
  pugi::xml_node element = parent.append_child(name);
  for (const auto& [key, value] : attributes)
    element.append_attribute(key).set_value(ReadableText(value).c_str());
  return element;
}

pugi::xml_node AddElement(pugi::xml_node parent, const char* name, Attributes attributes,
                          std::string_view text) {
  const pugi::xml_node element = AddElement(parent, name, attributes);
  AddText(element, text);
  return element;
}

void AddText(pugi::xml_node parent, std::string_view text) {
  parent.append_child(pugi::node_pcdata).set_value(ReadableText(text).c_str());
}

void AddMarkup(pugi::xml_node parent, std::string_view markup) {
  parent.append_buffer(markup.data(), markup.size(), pugi::parse_default, pugi::encoding_utf8);
}

std::string ToText(const pugi::xml_document& document, Layout layout) {
  std::ostringstream text;
  const unsigned flags = layout == Layout::kIndented
                             ? pugi::format_indent
                             : pugi::format_raw | pugi::format_no_declaration;
  document.save(text, "  ", flags, pugi::encoding_utf8);
  return std::move(text).str();
}

}  // namespace prehend
