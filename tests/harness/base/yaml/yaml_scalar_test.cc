// SPDX-License-Identifier: Apache-2.0
#include "harness/base/yaml/yaml_scalar.h"

#include <gtest/gtest.h>

namespace prehend {
namespace {

ScalarMeaning Plain(const std::string& text) {
  YamlNode node;
  node.kind = YamlNode::Kind::kScalar;
  node.text = text;
  return MeaningOf(node);
}

TEST(YamlScalar, NumbersOnWhichAllReadersAgree) {
  for (const auto& [text, value] : {std::pair{"0", 0.0},
                                    {"-0", 0.0},
                                    {"12", 12.0},
                                    {"-1.5", -1.5},
                                    {"0.25", 0.25},
                                    {"1e3", 1000.0},
                                    {"2.5E-3", 0.0025},
                                    {"1e+2", 100.0}}) {
    ASSERT_TRUE(Plain(text).number) << text;
    EXPECT_EQ(*Plain(text).number, value) << text;
  }
  EXPECT_TRUE(Plain("12").integer);
  EXPECT_FALSE(Plain("12.0").integer);
  EXPECT_FALSE(Plain("1e3").integer);
}

TEST(YamlScalar, AmbiguousScalarsSayWhy) {
  const std::pair<const char*, const char*> table[] = {
      {"no", "true or false to some YAML readers"},
      {"Yes", "true or false to some YAML readers"},
      {"ON", "true or false to some YAML readers"},
      {"off", "true or false to some YAML readers"},
      {"y", "true or false to some YAML readers"},
      {"True", "true or false to some YAML readers"},
      {"010", "a leading zero means octal to some YAML readers"},
      {"-007", "a leading zero means octal to some YAML readers"},
      {"0x10", "a number in another base to some YAML readers"},
      {"0o17", "a number in another base to some YAML readers"},
      {"0b11", "a number in another base to some YAML readers"},
      {"1_000", "only some YAML readers take '_' for a separator"},
      {"1:30", "a number in base 60 to some YAML readers"},
      {"1:30.5", "a number in base 60 to some YAML readers"},
      {".5", "a number without a digit on both sides of the point"},
      {"5.", "a number without a digit on both sides of the point"},
      {"+1", "a number with a plus sign"},
      {"nan", "not a finite number"},
      {".NaN", "not a finite number"},
      {"-.inf", "not a finite number"},
      {"Infinity", "not a finite number"},
      {"1e999", "outside the range of numbers"},
  };
  for (const auto& [text, reason] : table) {
    const ScalarMeaning meaning = Plain(text);
    EXPECT_EQ(meaning.ambiguous, reason) << text;
    EXPECT_FALSE(meaning.number || meaning.flag || meaning.string) << text;
  }
}

TEST(YamlScalar, FlagsAndStrings) {
  EXPECT_EQ(Plain("true").flag, true);
  EXPECT_EQ(Plain("false").flag, false);
  for (const char* text : {"milk", "on_top", "1.2.3", "10cm", "3-4", "-", "note", "information"}) {
    EXPECT_EQ(Plain(text).string, text);
  }
}

TEST(YamlScalar, QuotesMakeStrings) {
  YamlNode node;
  node.kind = YamlNode::Kind::kScalar;
  node.text = "010";
  node.quoted = true;
  EXPECT_EQ(MeaningOf(node).string, "010");
}

TEST(YamlScalar, DescriptionsAreCutBetweenCharacters) {
  YamlNode node;
  node.kind = YamlNode::Kind::kScalar;
  node.text = std::string(39, 'x') + "ü and more";
  EXPECT_EQ(Describe(node), "'" + std::string(39, 'x') + "...'");
}

}  // namespace
}  // namespace prehend
