// SPDX-License-Identifier: Apache-2.0
// A sweep of a grammar's parameters, as a person makes it.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

std::string TwoEpisodes(const std::filesystem::path& folder) {
  const auto file = (folder / "two.episodes").string();
  for (const char* scenario : {"pick_and_place/milk_carton_wrap", "slide/hop_divides_a_slide"})
    EXPECT_EQ(Prehend({"run", scenario, "--record", file}).exit_code, 0) << scenario;
  return file;
}

std::vector<std::string> LinesOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(Sweep, IsEqualToItsSingleRuns) {
  const auto folder = FreshFolder("sweep");
  const std::string file = TwoEpisodes(folder), csv = (folder / "sweep.csv").string(),
                    png = (folder / "sweep.png").string();
  const Said swept =
      Prehend({"grammar", "sweep", file, "--over", "lift_rise=1cm..41cm:3", "--over",
               "reach_min=50ms..150ms:2", "--truth", "recorded", "-o", csv, "-o", png});
  ASSERT_EQ(swept.exit_code, 0) << swept.err;
  EXPECT_NE(swept.out.find("6 settings on 2 episodes"), std::string::npos) << swept.out;
  EXPECT_EQ(ReadFile(png).substr(1, 3), "PNG");
  const std::vector<std::string> lines = LinesOf(ReadFile(csv));
  ASSERT_EQ(lines.size(), 7u);
  EXPECT_EQ(lines[0],
            "lift_rise,reach_min,f1,correct,extra,missed,begin_error_ms,end_error_ms,latency_ms");
  EXPECT_NE(lines[1].substr(lines[1].find(',', 14)), lines[6].substr(lines[6].find(',', 14)))
      << "a carton is never lifted 41 cm";
  for (const auto& [line, rise, still] :
       {std::tuple{2, "1 cm", "150 ms"}, std::tuple{5, "41 cm", "50 ms"}}) {
    const Said single = Prehend({"grammar", "sweep", file, "--over",
                                 std::string("lift_rise=") + rise + ".." + rise + ":2", "--set",
                                 std::string("reach_min=") + still, "--truth", "recorded"});
    ASSERT_EQ(single.exit_code, 0) << single.err;
    const std::string one = LinesOf(single.out)[1], same = lines[static_cast<std::size_t>(line)];
    EXPECT_EQ(one.substr(one.find(',') + 1), same.substr(same.find(',', same.find(',') + 1) + 1));
  }
}

TEST(Sweep, GoldensAndTheOracleAreTruths) {
  const std::string file = TwoEpisodes(FreshFolder("sweep_truths"));
  for (const char* truth : {"golden", "oracle"}) {
    const Said swept =
        Prehend({"grammar", "sweep", file, "--over", "reach_radius=5cm..30cm:2", "--truth", truth});
    ASSERT_EQ(swept.exit_code, 0) << swept.err;
    const std::vector<std::string> lines = LinesOf(swept.out);
    const auto f1 = [](const std::string& line) {
      return std::stod(line.substr(line.find(',') + 1));
    };
    EXPECT_GT(f1(lines[2]), 0.9) << lines[2];
    EXPECT_GT(f1(lines[2]), f1(lines[1])) << lines[1];
  }
}

TEST(Sweep, AWrongCallIsExplained) {
  const Said nothing = Prehend({"grammar", "sweep", "a.episodes"});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_NE(nothing.err.find("--over is missing"), std::string::npos) << nothing.err;
  const Said unit = Prehend({"grammar", "sweep", "a.episodes", "--over", "x=1cm..2m:3"});
  EXPECT_EQ(unit.exit_code, 2);
  EXPECT_NE(unit.err.find("both ends need the same unit"), std::string::npos) << unit.err;
  const std::string file = TwoEpisodes(FreshFolder("sweep_wrong"));
  const Said unknown = Prehend({"grammar", "sweep", file, "--over", "reach_radios=1cm..2cm:2"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("did you mean 'reach_radius'"), std::string::npos) << unknown.err;
}

}  // namespace
}  // namespace prehend::house
