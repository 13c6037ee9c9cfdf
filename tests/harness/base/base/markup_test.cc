// SPDX-License-Identifier: Apache-2.0
// Trees become documents that an XML reader or a browser reads back as they were.
#include <gtest/gtest.h>

#include "harness/base/base/quoting.h"

namespace prehend {
namespace {

TEST(Markup, WhatMeansSomethingIsEscaped) {
  pugi::xml_document document;
  const pugi::xml_node a =
      AddElement(document, "a", {{"title", "\"1\" < 2 &\n3"}}, "1 < 2 & \"3\"");
  AddElement(a, "b");
  EXPECT_EQ(ToText(document, Layout::kAsItIs),
            "<a title=\"&quot;1&quot; &lt; 2 &amp;&#10;3\">1 &lt; 2 &amp; \"3\"<b/></a>");
}

TEST(Markup, WhatXmlCannotCarryIsReplaced) {
  pugi::xml_document document;
  AddElement(document, "a", {{"title", "\x1b[1m"}}, std::string_view("\0\xff\n", 3));
  const std::string text = ToText(document, Layout::kAsItIs);
  EXPECT_EQ(text, "<a title=\"\uFFFD[1m\">\uFFFD\uFFFD\n</a>");
  EXPECT_TRUE(pugi::xml_document().load_string(text.c_str()));
}

TEST(Markup, AnElementWithEmptyTextHasAnEnd) {
  pugi::xml_document document;
  const pugi::xml_node p = AddElement(document, "p");
  AddElement(p, "br");
  AddElement(p, "i", {}, "");
  EXPECT_EQ(ToText(document, Layout::kAsItIs), "<p><br/><i></i></p>");
}

TEST(Markup, OneDocumentCanBecomePartOfAnother) {
  pugi::xml_document picture, page;
  AddElement(AddElement(picture, "svg"), "text", {}, "a < b");
  const pugi::xml_node body = AddElement(page, "body");
  AddText(body, "before ");
  AddMarkup(body, ToText(picture, Layout::kAsItIs));
  EXPECT_EQ(ToText(page, Layout::kAsItIs), "<body>before <svg><text>a &lt; b</text></svg></body>");
}

TEST(Markup, IndentedForReaders) {
  pugi::xml_document document;
  AddElement(AddElement(document, "a"), "b", {}, "text");
  EXPECT_EQ(ToText(document, Layout::kIndented),
            "<?xml version=\"1.0\"?>\n<a>\n  <b>text</b>\n</a>\n");
}

}  // namespace
}  // namespace prehend
