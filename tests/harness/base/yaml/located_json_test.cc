// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "harness/base/yaml/located_yaml.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend {
namespace {

using Kind = YamlNode::Kind;

YamlDocument ParsedJson(const std::string& text) {
  auto document = ParseJson("probe.jsonl", text);
  EXPECT_TRUE(document) << grammar::Format(ErrorsOf(document));
  return document.value_or(YamlDocument{});
}

/// "LINE:COLUMN: MESSAGE", without hints.
std::string JsonErrors(const std::string& text) {
  std::string all;
  for (const grammar::Diagnostic& d : ErrorsOf(ParseJson("probe.jsonl", text)))
    all += std::to_string(d.place.line) + ":" + std::to_string(d.place.column) + ": " + d.message;
  return all;
}

void ExpectColumn(const Where& where, int column) {
  EXPECT_EQ(where.place.line, 1);
  EXPECT_EQ(where.place.column, column);
}

TEST(LocatedJson, EveryKeyAndValueKnowsItsPlace) {
  const YamlDocument document =
      ParsedJson(R"({"a": -1.5e3, "list": ["x,:\"]", {"deep" : [7, true , null]}], "b": {}})");
  const YamlNode& root = document.root;
  ASSERT_EQ(root.kind, Kind::kMapping);
  ASSERT_EQ(root.children.size(), 3u);
  const YamlNode& a = *root.Find("a");
  ExpectColumn(a.key_where, 2);
  ExpectColumn(a.where, 7);
  EXPECT_EQ(a.text, "-1.5e3");
  EXPECT_FALSE(a.quoted);
  const YamlNode& list = *root.Find("list");
  ExpectColumn(list.where, 23);
  EXPECT_EQ(list.children[0].text, "x,:\"]");
  EXPECT_TRUE(list.children[0].quoted);
  const YamlNode& deep = *list.children[1].Find("deep");
  ExpectColumn(deep.key_where, 35);
  ExpectColumn(deep.where, 44);
  EXPECT_EQ(deep.children[1].key, "deep[1]");
  EXPECT_EQ(deep.children[1].text, "true");
  ExpectColumn(deep.children[1].where, 48);
  EXPECT_EQ(deep.children[2].kind, Kind::kNull);
  ExpectColumn(root.Find("b")->key_where, 64);
}

TEST(LocatedJson, LinesAreCounted) {
  const YamlDocument document = ParsedJson("{\n  \"a\": 1,\n  \"b\": [\n 2]\n}");
  EXPECT_EQ(document.root.Find("b")->key_where.place.line, 3);
  EXPECT_EQ(document.root.Find("b")->key_where.place.column, 3);
  EXPECT_EQ(document.root.Find("b")->children[0].where.place.line, 4);
}

TEST(LocatedJson, WhatIsNoJsonIsRefusedAtItsPlace) {
  EXPECT_EQ(JsonErrors(R"({"a": no})"), "1:7: not valid JSON: unexpected text here");
  EXPECT_EQ(JsonErrors(R"({"a":, 1})"), "1:6: not valid JSON: unexpected text here");
  EXPECT_EQ(JsonErrors(R"({"a": 1 "b": 2})"), "1:9: not valid JSON: unexpected text here");
  EXPECT_EQ(JsonErrors(R"({"a": 1} {"b": 2})"), "1:10: not valid JSON: unexpected text here");
  EXPECT_EQ(JsonErrors("{'a': 1}"), "1:2: not valid JSON: unexpected text here");
  EXPECT_EQ(JsonErrors("{\"a\": [1, 2"), "1:11: the line ends within a value");
  EXPECT_EQ(JsonErrors("{\"a\": \"x"), "1:8: the line ends within a value");
  EXPECT_EQ(JsonErrors(R"({"a": 1, "a": 2})"), "1:10: duplicate key 'a'");
  EXPECT_EQ(JsonErrors(R"({"a": 1e999})"), "1:7: this number is too large");
  EXPECT_EQ(JsonErrors("{\"a\": \"\\u001b[2J\"}").substr(0, 29), "1:7: expected text, found the");
  EXPECT_EQ(JsonErrors(std::string(100, '[')), "1:65: nested deeper than 64 levels");
}

}  // namespace
}  // namespace prehend
