// SPDX-License-Identifier: Apache-2.0
// Records come back as they were, notice what changed, and a damaged one is none.
#include "harness/suite/check/last_pass.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "harness/base/base/atomic_file.h"

namespace prehend::suite {
namespace {

namespace fs = std::filesystem;

class LastPassesTest : public testing::Test {
 protected:
  ~LastPassesTest() override { fs::remove_all(root_); }

  std::string File(const std::string& name, const std::string& text) const {
    EXPECT_EQ(WriteTextFile(root_ / name, text), "");
    return (root_ / name).string();
  }

  const fs::path root_ =
      fs::temp_directory_path() / ("prehend-check-records-" + std::to_string(getpid()));
  const LastPasses records_{root_};
};

TEST_F(LastPassesTest, ARecordComesBackAndNoticesChanges) {
  const std::string a = File("a", "one"), b = File("b", "two"), later = (root_ / "later").string();
  LastPass record{.program = "p", .pictures = true, .verdict = {.scenario = "slide/x"}};
  record.verdict.verdict = Verdict::kPassed;
  record.verdict.inputs = HashFiles({a, b, later});
  ASSERT_EQ(records_.Write(record), "");

  const auto read = records_.Read("slide/x");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->program, "p");
  EXPECT_TRUE(read->pictures);
  EXPECT_TRUE(read->passed);
  record.passed = false;
  ASSERT_EQ(records_.Write(record), "");
  EXPECT_FALSE(records_.Read("slide/x")->passed) << "accepted, but not checked yet";
  EXPECT_EQ(read->verdict.inputs, record.verdict.inputs);
  EXPECT_TRUE(ChangedInputs(*read).empty());
  File("b", "two!");
  File("later", "a file that was looked for and is there now");
  EXPECT_EQ(ChangedInputs(*read), (std::vector<std::string>{b, later}));
  fs::remove(a);
  EXPECT_EQ(ChangedInputs(*read), (std::vector<std::string>{a, b, later}));
}

TEST_F(LastPassesTest, AProjectThatWasMovedHasItsFiles) {
  const std::string a = File("a", "one"), none = (root_ / "none").string(), other = "/dev/null";
  LastPass record{.program = "p", .verdict = {.scenario = "slide/x"}};
  record.verdict.inputs = HashFiles({a, none, other});
  ASSERT_EQ(records_.Write(record), "");
  const fs::path there = root_.string() + "-moved";
  fs::rename(root_, there);
  const auto read = LastPasses(there).Read("slide/x");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->verdict.inputs,
            HashFiles({(there / "a").string(), (there / "none").string(), other}));
  EXPECT_TRUE(ChangedInputs(*read).empty());
  fs::remove_all(there);
}

TEST_F(LastPassesTest, DamagedOnesAreNone) {
  EXPECT_FALSE(records_.Read("slide/x"));
  for (const char* text : {"", "{", "[]", "{\"program\": 1}", "null"}) {
    File("build/check/slide/x.json", text);
    EXPECT_FALSE(records_.Read("slide/x")) << text;
    File("build/check/costs.json", text);
    EXPECT_NO_THROW(records_.ReadCosts()) << text;
  }
}

TEST_F(LastPassesTest, CostsComeBack) {
  EXPECT_TRUE(records_.ReadCosts().empty());
  const LastPasses::Costs costs = {{"a/b", 1.5}, {"c", 0.25}};
  ASSERT_EQ(records_.WriteCosts(costs), "");
  EXPECT_EQ(records_.ReadCosts(), costs);
}

}  // namespace
}  // namespace prehend::suite
