// SPDX-License-Identifier: Apache-2.0
// See harness/suite/judge/unreferenced_goldens.h. Tested by
// tests/harness/truth/golden/golden_files_test.cc
#include "harness/suite/judge/unreferenced_goldens.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "harness/base/base/text_file.h"
#include "harness/truth/golden/golden_files.h"

namespace prehend::suite {

namespace fs = std::filesystem;

std::vector<UnreferencedGolden> FindUnreferencedGoldens(
    const std::vector<episode::ScenarioFile>& all, const std::string& root) {
  std::set<std::string> known;
  for (const episode::ScenarioFile& file : all) known.insert(episode::IdOf(file));
  const truth::GoldenFiles goldens(root);
  std::map<std::string, std::vector<fs::path>> files;
  for (const std::string& id : goldens.List()) {
    if (!known.contains(id)) files[id].push_back(goldens.GoldenPath(id));
  }
  for (const truth::KeptPicture& picture : goldens.Pictures()) {
    if (!known.contains(picture.scenario)) files[picture.scenario].push_back(picture.path);
  }
  std::vector<UnreferencedGolden> orphans;
  for (auto& [id, paths] : files) orphans.push_back({id, std::move(paths)});
  return orphans;
}

std::string Text(const UnreferencedGolden& orphan) {
  std::string text;
  for (const fs::path& file : orphan.files) {
    text += fmt::format("{} belongs to no scenario: remove it, or bring scenarios/{}.yaml back\n",
                        ReadableName(file.string()), orphan.scenario);
  }
  return text;
}

std::vector<fs::path> UnrequestedPictures(const std::string& scenario, std::size_t asked,
                                          const std::string& root) {
  std::vector<fs::path> unrequested;
  for (const truth::KeptPicture& picture : truth::GoldenFiles(root).PicturesOf(scenario)) {
    if (static_cast<std::size_t>(picture.number) > asked) unrequested.push_back(picture.path);
  }
  return unrequested;
}

std::string UnrequestedText(const fs::path& picture, std::size_t asked) {
  return fmt::format("{} belongs to no picture: the scenario asks for {}",
                     ReadableName(picture.string()),
                     asked == 0 ? std::string("none") : std::to_string(asked));
}

}  // namespace prehend::suite
