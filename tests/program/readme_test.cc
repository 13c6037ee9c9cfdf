// SPDX-License-Identifier: Apache-2.0
// The failed test at the top of README.md is what the program prints.
#include <gtest/gtest.h>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

/// What stands between "```text" and "```" for the nth time, from 0.
std::string TextBlock(const std::string& page, int nth) {
  const std::string begin = "```text\n";
  std::size_t at = 0;
  for (int i = 0; i <= nth; ++i) at = page.find(begin, at) + begin.size();
  return page.substr(at, page.find("```", at) - at);
}

TEST(Readme, ShowsAFailedTestAsItIsPrinted) {
  const fs::path root = FreshFolder("readme");
  for (const char* library : {"grammar/library", "physics/library"}) {
    fs::create_directories(root / library);
    fs::copy(fs::path(PREHEND_SOURCE_DIR) / library, root / library, fs::copy_options::recursive);
  }
  const std::string id = "slide/four_centimetres_are_a_slide";
  for (const auto& file : {"scenarios/" + id + ".yaml", "golden/" + id + ".timeline"})
    WriteFile(root / file, ReadFile(fs::path(PREHEND_SOURCE_DIR) / file));
  const std::vector<std::string> environment = {"PREHEND_HOME=" + root.string(),
                                                "PREHEND_COMMAND=./run"};
  ASSERT_EQ(Prehend({"check", "--no-pictures"}, environment).exit_code, 0);
  const fs::path grammar = root / "grammar/library/pick_and_place.grammar";
  WriteFile(grammar, Replaced(ReadFile(grammar), "slide_distance = 2 cm", "slide_distance = 5 cm"));

  std::string checked = Prehend({"check", "--no-pictures"}, environment).out;
  for (std::size_t at; (at = checked.find(root.string() + "/")) != checked.npos;)
    checked.erase(at, root.string().size() + 1);
  const std::string readme = ReadFile(fs::path(PREHEND_SOURCE_DIR) / "README.md");
  EXPECT_EQ(checked.substr(0, checked.find("1 cause:\n")), TextBlock(readme, 0));

  const std::string why = "--expected '";
  const std::size_t at = checked.find(why) + why.size();
  const std::string expected = checked.substr(at, checked.find('\'', at) - at);
  const std::string explained = Prehend({"explain", id, "--expected", expected}, environment).out;
  EXPECT_EQ(explained.substr(0, explained.find("\n\n") + 1), TextBlock(readme, 1));
}

}  // namespace
}  // namespace prehend::house
