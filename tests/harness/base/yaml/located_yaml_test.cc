// SPDX-License-Identifier: Apache-2.0
#include "harness/base/yaml/located_yaml.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/harness/scenario_fixture.h"

namespace prehend {
namespace {

using Kind = YamlNode::Kind;

YamlDocument Parse(const std::string& text) {
  auto document = ParseYaml("probe.yaml", text);
  EXPECT_TRUE(document) << grammar::Format(ErrorsOf(document));
  return document.value_or(YamlDocument{});
}

std::string ErrorsInText(const std::string& text) {
  return scenario::Brief(ErrorsOf(ParseYaml("probe.yaml", text)));
}

void ExpectPlace(const Where& where, int line, int column) {
  EXPECT_EQ(where.place.line, line);
  EXPECT_EQ(where.place.column, column);
}

TEST(LocatedYaml, EveryKeyAndValueKnowsItsPlace) {
  const YamlDocument document = Parse("# comment\na: 1\nlist:\n  - x\n  - {deep: [7, 8]}\n");
  const YamlNode* a = document.root.Find("a");
  ASSERT_TRUE(a);
  ExpectPlace(a->key_where, 2, 1);
  ExpectPlace(a->where, 2, 4);
  const YamlNode& deep = *document.root.Find("list")->children[1].Find("deep");
  ExpectPlace(deep.key_where, 5, 6);
  ExpectPlace(deep.where, 5, 12);
  ExpectPlace(deep.children[1].where, 5, 16);
  EXPECT_EQ(deep.children[1].key, "deep[1]");
}

TEST(LocatedYaml, ColumnsCountBytes) {
  ExpectPlace(Parse("{ä: 1, b: 2}\n").root.Find("b")->key_where, 1, 9);
}

TEST(LocatedYaml, QuotedScalarsAreMarked) {
  const YamlDocument document = Parse("a: no\nb: 'no'\nc: \"no\"\nd: |\n  no\n");
  EXPECT_FALSE(document.root.Find("a")->quoted);
  EXPECT_TRUE(document.root.Find("b")->quoted);
  EXPECT_TRUE(document.root.Find("c")->quoted);
  EXPECT_TRUE(document.root.Find("d")->quoted);
}

TEST(LocatedYaml, NullKnowsItsSpelling) {
  const YamlDocument document = Parse("a: ~\nb: null\nc:\nd: {e: , f: 1}\n");
  EXPECT_EQ(document.root.Find("a")->text, "~");
  EXPECT_EQ(document.root.Find("b")->text, "null");
  EXPECT_EQ(document.root.Find("c")->text, "");
  ExpectPlace(document.root.Find("c")->where, 3,
              1);  // a value that is absent has the place of its key
  EXPECT_EQ(document.root.Find("d")->Find("e")->kind, Kind::kNull);
}

struct Refused {
  const char* text;
  const char* errors;
};

TEST(LocatedYaml, RefusesWhatIsAmbiguous) {
  const Refused table[] = {
      {"a: 1\nb: {c: 1, c: 2}\n", "2:11: duplicate key 'c' | first given in line 2\n"},
      {"a: 1\na: 2\na: 3\n",
       "2:1: duplicate key 'a' | first given in line 1\n3:1: duplicate key 'a' | first given in "
       "line 1\n"},
      {"a: 1\n'a': 2\n", "2:1: duplicate key 'a' | first given in line 1\n"},
      {"a: 1\nb: \"a\\x1b[31m\"\n",
       "2:4: expected text, found the control character U+001B | an escape in quotes stands for a "
       "character; leave this one out\n"},
      {"{\"a\\0\": 1}\n",
       "1:2: expected text, found the control character U+0000 | an escape in quotes stands for a "
       "character; leave this one out\n"},
      {"a: \"\\u202eb\"\n",
       "1:4: expected text, found the character that turns the direction of writing U+202E | an "
       "escape in quotes stands for a character; leave this one out\n"},
      {"<<: {a: 1}\n", "1:1: merge keys ('<<') are not supported | write the keys out\n"},
      {"a: &x 1\nb: *x\n",
       "1:4: anchors ('&name') are not supported | write the value out where it is used\n"
       "2:4: aliases ('*name') are not supported | write the value out\n"},
      {"a: !!int 1\n", "1:4: tags ('!name') are not supported | remove the tag\n"},
      {"a: ! x\n", "1:4: tags ('!name') are not supported | remove the tag\n"},
      {"a: 1\n---\nb: 2\n",
       "2:1: a second document begins here | one file holds one document; remove the '---'\n"},
      {"# a grammar\ngrammar g\nuse contact\n",
       "2:1: expected YAML, found a grammar | the name of a grammar's file ends in .grammar\n"},
      {"a: [1]\nb:\u00A0[2]\nc: 3\n",
       "2:3: not valid YAML: a character that looks like a blank, but is none | separate with "
       "plain "
       "spaces\n"},
      {"a: 1\nb [2, 3]\nc: 3\n", "2:1: not valid YAML: a line without ':' | write 'KEY: VALUE'\n"},
      {"a: 1\nb:\t2\n", "2:3: tab character | indent and separate with spaces\n"},
      {"[1, 2]: 3\n", "1:1: a key must be a word, not a list or mapping\n"},
      {"~: 3\n", "1:1: a key is missing here\n"},
      {"# nothing\n", "0:0: the file contains only comments\n"},
      {"", "0:0: the file is empty\n"},
      {"a: {b: 1\n",
       "2:1: not valid YAML: a '{' before this is not closed | each '[' needs its ']', each '{' "
       "its '}'\n"},
      {"a: b: c\n",
       "1:5: not valid YAML: a second ':' in one value | text with ': ' in it goes in "
       "quotes, like \"first: second\"\n"},
      {"x: 1\na: b c:\n",
       "2:7: not valid YAML: a second ':' in one value | text with ': ' in it goes in "
       "quotes, like \"first: second\"\n"},
      {"a: {b: c: d}\n",
       "1:9: not valid YAML: a second ':' in one value | text with ': ' in it goes in "
       "quotes, like \"first: second\"\n"},
      {"a: \"b\" c\n",
       "1:8: not valid YAML: unexpected text after the value before it | put the whole value in "
       "quotes\n"},
      {"a: * b\n",
       "1:5: not valid YAML: text cannot begin with '*' | text with special characters goes in "
       "quotes\n"},
      {"a: 1\n b: 2\n",
       "2:3: not valid YAML: no ':' is expected here | a key begins a line or is inside '{}'; "
       "text with ': ' goes in quotes\n"},
  };
  for (const Refused& refused : table)
    EXPECT_EQ(ErrorsInText(refused.text), refused.errors) << refused.text;
}

TEST(LocatedYaml, QuotedMergeKeyIsAKey) { EXPECT_TRUE(Parse("'<<': 1\n").root.Find("<<")); }

TEST(LocatedYaml, DeepNestingIsRefusedBeforeTheStackIsGone) {
  const auto repeated = [](const std::string& piece, int times) {
    std::string text;
    for (int i = 0; i < times; ++i) text += piece;
    return text;
  };
  for (const char* piece : {"[", "{", "- ", "{a: ", "[[{a: ", "? "}) {
    const std::string errors = ErrorsInText(repeated(piece, 10'000));
    EXPECT_NE(errors.find("nested deeper than 64 levels"), std::string::npos) << piece << errors;
  }
  EXPECT_EQ(ErrorsInText(repeated("[", 64) + repeated("]", 64)), "");
  EXPECT_NE(ErrorsInText(repeated("[", 65) + repeated("]", 65)), "");
}

const nlohmann::ordered_json kSchema = {
    {"properties",
     {{"world", {{"properties", {{"rate_hz", {{"type", "integer"}}}}}}},
      {"settle_s", {{"type", "number"}}}}}};

TEST(LocatedYaml, QuotationsMustEnd) {
  EXPECT_EQ(ErrorsInText("a: 'it''s\n"),
            "1:4: this quote is not closed | close it with the same quote\n");
  EXPECT_EQ(ErrorsInText("a: \"b\\\"\n"),
            "1:4: this quote is not closed | close it with the same quote\n");
  EXPECT_EQ(ErrorsInText("a: 'it''s'\nb: \"c\\\\\"\nd: |\n  'e\n"), "");
}

std::string Overridden(const std::string& assignment) {
  YamlDocument document = Parse("entities:\n  milk: {mass_kg: 1, at_m: [1, 2]}\n");
  const auto diagnostics = ApplyOverride(assignment, kSchema, document);
  if (!diagnostics.empty()) return scenario::Brief(diagnostics);
  const YamlNode& milk = *document.root.Find("entities")->Find("milk");
  std::string all;
  for (const YamlNode& child : milk.children) {
    all += child.key + "=" + child.text;
    for (const YamlNode& item : child.children) all += item.key + "=" + item.text + ",";
    all += " ";
  }
  return all;
}

TEST(Override, ReplacesAndAdds) {
  EXPECT_EQ(Overridden("entities.milk.mass_kg=8"), "mass_kg=8 at_m=at_m[0]=1,at_m[1]=2, ");
  EXPECT_EQ(Overridden("entities.milk.at_m.1=8"), "mass_kg=1 at_m=at_m[0]=1,at_m[1]=8, ");
  EXPECT_EQ(Overridden("entities.milk.at_m=[3]"), "mass_kg=1 at_m=at_m[0]=3, ");
  EXPECT_EQ(Overridden("entities.milk.fixed=true"),
            "mass_kg=1 at_m=at_m[0]=1,at_m[1]=2, fixed=true ");
}

TEST(Override, KnowsItsPlace) {
  YamlDocument document = Parse("a: {b: 1}\n");
  ASSERT_TRUE(ApplyOverride("a.b=[x, y]", {}, document).empty());
  const YamlNode& y = document.root.Find("a")->Find("b")->children[1];
  EXPECT_EQ(document.sources[static_cast<std::size_t>(y.where.source)].name, "--set");
  ExpectPlace(y.where, 1, 9);
}

TEST(Override, MakesMappingsThatTheFileLeavesOut) {
  YamlDocument document = Parse("entities: {}\n");
  ASSERT_TRUE(ApplyOverride("world.rate_hz=960", kSchema, document).empty());
  EXPECT_EQ(document.root.Find("world")->Find("rate_hz")->text, "960");
  EXPECT_EQ(scenario::Brief(ApplyOverride("wrold.rate_hz=960", kSchema, document)),
            "--set:1:1: nothing is called 'wrold' here | did you mean 'world'?\n");
}

TEST(Override, ComplainsAboutPathsThatLeadNowhere) {
  EXPECT_EQ(Overridden("entities.milc.mass_kg=8"),
            "--set:1:10: nothing is called 'milc' here | did you mean 'milk'?\n");
  EXPECT_EQ(Overridden("entities.milk.at_m.2=8"),
            "--set:1:20: nothing is called '2' here | 'at_m' is a list of 2\n");
  EXPECT_EQ(Overridden("entities.milk.mass_kg.g=8"), "--set:1:23: nothing is called 'g' here\n");
  EXPECT_EQ(Overridden("entities"),
            "--set:1:1: expected PATH=VALUE | for example entities.milk.mass_kg=8\n");
  EXPECT_EQ(Overridden("entities.milk.mass_kg="),
            "--set:1:1: expected PATH=VALUE | for example entities.milk.mass_kg=8\n");
}

}  // namespace
}  // namespace prehend
