// SPDX-License-Identifier: Apache-2.0
// Pages of recorded episodes (`report`) and of one run (`run --report`).
#include <gtest/gtest.h>

#include "tests/program/small_project.h"

namespace prehend::house {
namespace {

class ReportCommand : public SmallProject {
 protected:
  std::string PageAfter(const std::string& command) const {
    const Said said = Do(command);
    EXPECT_EQ(said.exit_code, 0) << said.err;
    said_ = said.out;
    return ReadFile(root_ / "page.html");
  }
  std::string Path(const char* name) const { return (root_ / name).string(); }
  mutable std::string said_;
};

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(ReportCommand, EpisodesAreSectionsOfOnePage) {
  Do("check");
  Accept();
  for (int i = 0; i < 2; ++i) Do("run carton_rests --record " + Path("a.episodes"));
  const std::string page = PageAfter("report " + Path("a.episodes") + " -o " + Path("page.html"));
  EXPECT_TRUE(Has(said_, "page.html: 2 episodes, 2 passed, 0 failed, 0 without golden\n")) << said_;
  EXPECT_TRUE(Has(page, "<h1>Recorded episodes</h1>"));
  EXPECT_TRUE(Has(page, "<section id=\"rest/carton_rests\""));
  EXPECT_TRUE(Has(page, "<section id=\"rest/carton_rests (2)\"")) << "names are unique";
  EXPECT_EQ(Has(page, "class=\"replay-data\""), !Has(page, "3D replay was left out"));
  EXPECT_FALSE(Has(page, "http"));
}

TEST_F(ReportCommand, RefusesWhatSelectsNothing) {
  Do("run carton_rests --record " + Path("a.episodes"));
  const Said nothing =
      Do("report " + Path("a.episodes") + " --episode slide/* -o " + Path("page.html"));
  EXPECT_EQ(nothing.exit_code, 4);
  EXPECT_TRUE(Has(nothing.err, "--episode: no episode matches 'slide/*'")) << nothing.err;
  EXPECT_FALSE(std::filesystem::exists(root_ / "page.html"));
  EXPECT_EQ(Do("report " + Path("a.episodes") + " -o /proc/none/page.html").exit_code, 2);
  const Said unread =
      Do("report " + Path("a.episodes") + " --set nosuch=1 -o " + Path("page.html"));
  EXPECT_EQ(unread.exit_code, 2);
  EXPECT_TRUE(Has(unread.err, "the grammar has no parameter 'nosuch'")) << unread.err;
  EXPECT_FALSE(std::filesystem::exists(root_ / "page.html"));
}

TEST_F(ReportCommand, ARunIsAPage) {
  const std::string page = PageAfter("run carton_rests --report " + Path("page.html"));
  EXPECT_TRUE(Has(said_, "supported_by")) << "the table is printed as always: " << said_;
  EXPECT_TRUE(Has(page, "<h1>Run of rest/carton_rests</h1>"));
  EXPECT_TRUE(Has(page, ", by <code>prehend run carton_rests --report "));
  EXPECT_TRUE(Has(page, ", on Linux ") && Has(page, " processor")) << "the machine";
  EXPECT_FALSE(Has(page, "of commit")) << "this project is in no repository";
  EXPECT_TRUE(Has(page, "<details open=\"open\">")) << "what is alone is open";
  EXPECT_FALSE(Has(page, "class=\"hatch\" x=")) << "without a golden nothing differs";
  EXPECT_FALSE(std::filesystem::exists(Pending())) << "a run proposes no golden";
  Do("check");
  Accept();
  const std::string passed = PageAfter("run carton_rests --report " + Path("page.html"));
  EXPECT_TRUE(Has(passed, "<span class=\"passed\">passed</span>")) << "judged as by check";
  EXPECT_EQ(Do("run carton_rests --trials 2 --report " + Path("page.html")).exit_code, 2);
  EXPECT_EQ(Do("run carton_rests --trials 2 --record " + Path("b.episodes")).exit_code, 2)
      << "it has no outcomes";
  EXPECT_FALSE(std::filesystem::exists(root_ / "b.episodes"));
}

}  // namespace
}  // namespace prehend::house
