// SPDX-License-Identifier: Apache-2.0
// The committed schema, the scenarios of the project and the examples of the documentation agree
// with the reader.
#include "harness/scenario/format/scenario_fields.h"

#include <gtest/gtest.h>

#include "harness/base/base/text_file.h"
#include "harness/episode/run/find_scenario.h"
#include "tests/harness/scenario/format/python_validator.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

const std::string kRoot = PREHEND_SOURCE_DIR;

std::string TextOf(const std::string& path) {
  auto text = ReadTextFile(path);
  EXPECT_TRUE(text) << grammar::Format(ErrorsOf(text));
  return text.value_or("");
}

TEST(ScenarioSchema, TheCommittedFileIsTheGeneratedOne) {
  EXPECT_EQ(TextOf(kRoot + "/scenarios/scenario.schema.json"), ScenarioSchema())
      << "renew it: prehend scenario schema > scenarios/scenario.schema.json";
}

TEST(ScenarioSchema, EveryScenarioIsReadAndValid) {
  PythonValidator validator;
  const auto scenarios = episode::ListScenarios(kRoot);
  ASSERT_GE(scenarios.size(), 6u);
  for (const episode::ScenarioFile& scenario : scenarios) {
    const auto read = ReadScenario(scenario.path, {}, episode::ProjectLibrary(kRoot));
    EXPECT_TRUE(read) << grammar::Format(ErrorsOf(read));
    EXPECT_TRUE(read && !read->expects.empty()) << scenario.path << " expects nothing";
    const std::string text = TextOf(scenario.path);
    EXPECT_TRUE(text.starts_with("# yaml-language-server: $schema=../scenario.schema.json\n"))
        << scenario.path;
    validator.Add(scenario.skill + "-" + scenario.name, text);
  }
  for (const auto& [name, valid] : validator.Validate(ScenarioSchema())) EXPECT_TRUE(valid) << name;
  EXPECT_EQ(validator.Validate(ScenarioSchema()).size(), scenarios.size());
}

/// The ```yaml blocks of a Markdown text.
std::vector<std::string> YamlBlocks(const std::string& markdown) {
  const std::string open = "```yaml\n", close = "```\n";
  std::vector<std::string> blocks;
  for (std::size_t at = markdown.find(open); at != std::string::npos;
       at = markdown.find(open, at)) {
    at += open.size();
    const std::size_t end = markdown.find(close, at);
    blocks.push_back(markdown.substr(at, end - at));
    at = end + close.size();
  }
  return blocks;
}

/// The probe with what else an example of the document speaks of.
std::string ProbeFor(const std::string& example) {
  std::string text = kProbe;
  const auto add = [&](const std::string& section, const std::string& name,
                       const std::string& what) {
    if (example.find(name) == std::string::npos) return;
    text.insert(text.find(section) + section.size(), "  " + name + ": " + what + "\n");
  };
  add("entities:\n", "cup",
      "{cylinder: {radius_m: 0.035, length_m: 0.1}, mass_kg: 0.25, at_m: [0.1, -0.3, 0.81]}");
  add("actors:\n", "left_hand", "{hand: human_left, at_m: [-0.2, 0.3, 1.05]}");
  return text;
}

TEST(ScenarioFormatDocument, ItsFirstExampleIsTheScenarioThatShips) {
  const std::string shipped = TextOf(kRoot + "/scenarios/pick_and_place/milk_carton_wrap.yaml");
  const auto blocks = YamlBlocks(TextOf(kRoot + "/docs/scenario-format.md"));
  ASSERT_FALSE(blocks.empty());
  EXPECT_EQ(blocks.front(), shipped.substr(shipped.find('\n') + 1));  // without the editor's line
}

TEST(ScenarioFormatDocument, ItsExamplesAreReadAndValid) {
  PythonValidator validator;
  int scenarios = 0;
  for (const std::string& block : YamlBlocks(TextOf(kRoot + "/docs/scenario-format.md"))) {
    // A block is a scenario, or a part that replaces or extends the probe's of the same key.
    std::string text = block;
    if (!block.starts_with("scenario:")) {
      const std::string key = block.substr(0, block.find(':') + 1);
      text = ProbeFor(block);
      const std::size_t at = text.find("\n" + key);
      if (at != std::string::npos) {
        std::size_t end = at + 1;
        do end = text.find('\n', end) + 1;
        while (end < text.size() && text[end] == ' ');
        text.erase(at + 1, end - at - 1);
      }
      text += block;
    }
    const std::string name = text.substr(10, text.find('\n') - 10);
    // The files that examples name are there.
    const std::string file = kRoot + "/scenarios/recorded/" + name + ".yaml";
    const auto read = ReadScenarioText(file, text, {}, episode::ProjectLibrary(kRoot));
    EXPECT_TRUE(read) << grammar::Format(ErrorsOf(read)) << text;
    validator.Add("example" + std::to_string(scenarios++), text);
  }
  EXPECT_GE(scenarios, 7);
  const auto valid = validator.Validate(ScenarioSchema());
  EXPECT_EQ(valid.size(), static_cast<std::size_t>(scenarios));
  for (const auto& [name, is_valid] : valid) EXPECT_TRUE(is_valid) << name;
}

TEST(ScenarioFormatDocument, NamesEveryKey) {
  const std::string document = TextOf(kRoot + "/docs/scenario-format.md");
  const std::function<void(const Json&)> check = [&](const Json& schema) {
    if (schema.contains("properties")) {
      for (const auto& [key, value] : schema["properties"].items()) {
        const bool named = document.find("`" + key + "`") != std::string::npos ||
                           document.find("`" + key + ": ") != std::string::npos;
        EXPECT_TRUE(named) << key;
      }
    }
    for (const Json& inner : schema) {
      if (inner.is_structured()) check(inner);
    }
  };
  check(ScenarioFormat().schema().json());
}

}  // namespace
}  // namespace prehend::scenario
