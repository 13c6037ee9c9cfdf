// SPDX-License-Identifier: Apache-2.0
// Documents of elements (XML, SVG, HTML) as trees of pugixml, which escapes what has to be escaped.
// Tested by tests/harness/base/base/markup_test.cc
#pragma once

#include <initializer_list>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>

namespace prehend {

using Attributes = std::initializer_list<std::pair<const char*, std::string>>;

/// Adds <name attributes/> as the last child of `parent`.
pugi::xml_node AddElement(pugi::xml_node parent, const char* name, Attributes attributes = {});

/// Adds <name attributes>text</name>, also when the text is empty: HTML reads <i/> as <i>.
pugi::xml_node AddElement(pugi::xml_node parent, const char* name, Attributes attributes,
                          std::string_view text);

/// Adds text as the last child of `parent`.
void AddText(pugi::xml_node parent, std::string_view text);

/// Adds the elements of a text that ToText() made.
void AddMarkup(pugi::xml_node parent, std::string_view markup);

enum class Layout {
  kIndented,  ///< an element per line, and an XML declaration
  kAsItIs,    ///< no white space but that of the texts: in HTML it can be seen
};
std::string ToText(const pugi::xml_document& document, Layout layout);

}  // namespace prehend
