// SPDX-License-Identifier: Apache-2.0
// What the goldens of the shipped scenarios say of the definitions. `prehend check` plays every
// scenario, lets the oracle judge what is found, and fails unless as many events differ as the
// golden's header says. So the headers are the published record of all disagreements; docs/truth.md
// explains each. They are few, not none: grammar and oracle are two readings of one page.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "harness/episode/run/find_scenario.h"
#include "harness/suite/judge/validate_golden.h"
#include "harness/truth/golden/golden.h"
#include "harness/truth/oracle/oracle.h"

namespace prehend::suite {
namespace {

constexpr double kMaxDifferingShare = 0.01;

std::string PageOfTruth() {
  std::ostringstream text;
  text << std::ifstream(PREHEND_SOURCE_DIR "/docs/truth.md").rdbuf();
  return text.str();
}

TEST(OracleAgreement, DisagreementsOfTheLibraryAreFewAndExplained) {
  const std::string page = PageOfTruth();
  int differing = 0, judged = 0;
  for (const episode::ScenarioFile& file : episode::ListScenarios(PREHEND_SOURCE_DIR)) {
    const auto golden = truth::GoldenFiles(PREHEND_SOURCE_DIR).ReadGoldenOf(episode::IdOf(file));
    ASSERT_TRUE(golden && *golden)
        << episode::IdOf(file) << ": no golden, or one that cannot be read\n"
        << grammar::Format(ErrorsOf(golden));
    const std::vector<std::string>& derived = (*golden)->derived;
    EXPECT_TRUE(std::ranges::any_of(derived, [](const std::string& line) {
      return line.starts_with(kOracleLine);
    })) << episode::IdOf(file);
    judged += static_cast<int>(std::ranges::count_if(
        (*golden)->events,
        [](const truth::GoldenEvent& line) { return truth::OracleDefines(line.event); }));
    const int of_this = AcceptedDiffering(derived);
    differing += of_this;
    EXPECT_EQ(of_this > 0, page.find("| `" + episode::IdOf(file) + "` | ") != std::string::npos)
        << episode::IdOf(file)
        << ": docs/truth.md lists each scenario with a disagreement, and no other";
  }
  EXPECT_GT(judged, 2000);
  EXPECT_LE(differing, kMaxDifferingShare * judged);
  RecordProperty("differing", differing);
}

}  // namespace
}  // namespace prehend::suite
