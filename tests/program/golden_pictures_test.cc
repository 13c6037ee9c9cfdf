// SPDX-License-Identifier: Apache-2.0
// The project's own golden pictures: each has its list of things, and they hold on a processor
// without fused multiply-add. `check` compares them all (the suite); here are those of one
// scenario.
#include <gtest/gtest.h>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

const char* const kScenario = "pick_and_place/milk_carton_wrap";

/// What `check` says of the scenario's events and pictures.
Said Check(const std::vector<std::string>& environment) {
  const fs::path folder = FreshFolder("golden_pictures");
  return Prehend({"check", kScenario, "--report", folder.string()}, environment);
}

TEST(GoldenPictures, AreADozenAndSmallAndHaveTheirLists) {
  int count = 0;
  for (const auto& entry :
       fs::recursive_directory_iterator(fs::path(PREHEND_SOURCE_DIR) / "golden")) {
    if (entry.path().extension() != ".png") continue;
    ++count;
    EXPECT_LT(fs::file_size(entry.path()), 160'000u) << entry.path();
    const std::string things = ReadFile(fs::path(entry.path()).replace_extension(".things"));
    EXPECT_TRUE(things.starts_with("# drawn_by: ")) << entry.path();
    EXPECT_NE(things.find("\n# size: 960 x 540\n"), std::string::npos) << entry.path();
  }
  EXPECT_GE(count, 12);
}

TEST(GoldenPictures, HoldWithoutFusedMultiplyAdd) {
  const Said here = Check({});
  EXPECT_EQ(here.exit_code, 0) << here.out << here.err;
  for (const char* setting :
       {"GALLIUM_OVERRIDE_CPU_CAPS=sse4.1", "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA"}) {
    const Said said = Check({setting});
    EXPECT_EQ(said.exit_code, 0) << setting << "\n" << said.out << said.err;
  }
}

}  // namespace
}  // namespace prehend::house
