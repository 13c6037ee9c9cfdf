// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "grammar/base/diagnostic.h"
#include "harness/scenario/read/read_parts.h"

namespace prehend::scenario {
namespace {

/// The steps that are left, "a b a b", or what is wrong.
std::string Written(const std::string& script) {
  const auto document = ParseYaml("a.yaml", "script:\n" + script);
  if (!document) return grammar::Format(document.error());
  DiagnosticList errors(*document);
  const YamlNode root = WithoutRepeats(document->root, errors);
  if (!errors.empty()) {
    const grammar::Diagnostic first = errors.Sorted().front();
    return std::to_string(first.place.line) + ":" + std::to_string(first.place.column) + ": " +
           first.message;
  }
  std::string steps;
  for (const YamlNode& stage : root.Find("script")->children)
    steps += (steps.empty() ? "" : " ") + stage.children.front().key;
  return steps;
}

TEST(RepeatBlocks, AreWrittenOut) {
  EXPECT_EQ(Written("- {a: 1}\n- {b: 1}\n"), "a b");
  EXPECT_EQ(Written("- {a: 1}\n- {repeat: 2, steps: [{b: 1}, {c: 1}]}\n- {d: 1}\n"), "a b c b c d");
  EXPECT_EQ(Written("- {repeat: 2, steps: [{a: 1}, {repeat: 2, steps: [{b: 1}]}]}\n"),
            "a b b a b b");
}

TEST(RepeatBlocks, WhatIsNoBlockIsReportedOnce) {
  EXPECT_EQ(Written("- {repeat: 2}\n"), "2:3: a repeated block needs 'steps'");
  EXPECT_EQ(Written("- {steps: [{a: 1}]}\n"), "2:3: a repeated block needs 'repeat'");
  EXPECT_EQ(Written("- {repeat: 2, steps: [{a: 1}], over_s: 1}\n"),
            "2:32: unknown key 'over_s' in a repeated block");
  EXPECT_EQ(Written("- {repeat: 2, steps: {a: 1}}\n"), "2:22: steps: expected a list of stages");
  EXPECT_EQ(Written("- {repeat: 0, steps: [{a: 1}]}\n"),
            "2:12: repeat: expected a whole number from 1 to 100, found '0'");
}

TEST(RepeatBlocks, AreLimitedHoweverDeep) {
  std::string block = "{a: 1}";
  for (int i = 0; i < 12; ++i) block = "{repeat: 100, steps: [" + block + "]}";
  const std::string written = Written("- " + block + "\n");
  EXPECT_LT(written.size(), 10'000u) << "the format then reports too many stages";
}

}  // namespace
}  // namespace prehend::scenario
