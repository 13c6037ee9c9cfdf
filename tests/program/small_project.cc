// SPDX-License-Identifier: Apache-2.0
#include "tests/program/small_project.h"

#include <iterator>
#include <sstream>

namespace prehend::house {

namespace fs = std::filesystem;

const char* const kCartonRests = R"(scenario: carton_rests
shows: a carton stands on a table and nobody touches it
tags: [quiet]
entities:
  table: {class: Table, fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  carton: {class: Carton, box: {size_m: [0.06, 0.06, 0.10]}, mass_kg: 0.3, on: table, at_m: [0.15, 0.15]}
actors:
  right_hand: {hand: human_right, at_m: [-0.25, -0.1, 1.1]}
script:
  - right_hand: {wait_s: 0.2}
settle_s: 0.1
)";

SmallProject::SmallProject() {
  for (const char* library : {"grammar/library", "physics/library"}) {
    fs::create_directories(root_ / library);
    fs::copy(fs::path(PREHEND_SOURCE_DIR) / library, root_ / library, fs::copy_options::recursive);
  }
  WriteFile(Scenario(), kCartonRests);
}

SmallProject::~SmallProject() { fs::remove_all(root_); }

fs::path SmallProject::Scenario(const std::string& id) const {
  return root_ / "scenarios" / (id + ".yaml");
}
fs::path SmallProject::Golden(const std::string& id) const {
  return root_ / "golden" / (id + ".timeline");
}
fs::path SmallProject::Pending() const {
  return root_ / "build/pending/rest/carton_rests.timeline";
}

void SmallProject::WriteVariant(const std::string& id, const std::string& from,
                                const std::string& to) const {
  const std::string renamed =
      Replaced(kCartonRests, "carton_rests", fs::path(id).filename().string());
  WriteFile(Scenario(id), Replaced(renamed, from, to));
}

Said SmallProject::Do(const std::string& arguments, const std::string& ci) const {
  std::istringstream words(arguments);
  const std::vector<std::string> split{std::istream_iterator<std::string>(words), {}};
  return Prehend(split, {"PREHEND_HOME=" + root_.string(), "CI=" + ci});
}

void SmallProject::Accept(const std::string& id) const {
  const Said ended = Do("accept " + id + " --reason nothing_happens");
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
}

}  // namespace prehend::house
