// SPDX-License-Identifier: Apache-2.0
// See golden_files.h. Tested by tests/harness/golden_files_test.cc
#include "harness/golden_files.h"

#include <algorithm>

#include "harness/text_file.h"

namespace prehend::harness {

namespace fs = std::filesystem;

namespace {

constexpr const char* kExtension = ".timeline";

ReadResult<Golden> ReadFrom(const fs::path& path, const std::string& scenario) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};
  ReadResult<std::string> text = ReadTextFile(path.string());
  if (!text.value) return {std::nullopt, std::move(text.diagnostics)};
  ReadResult<Golden> golden = ReadGolden(path.string(), *text.value);
  if (golden.value && golden.value->scenario != scenario) {
    const std::string message =
        "this golden says it is of '" + golden.value->scenario + "', not of '" + scenario + "'";
    return {std::nullopt, {grammar::DiagnosticAt(path.string(), *text.value, {1, 1}, message)}};
  }
  return golden;
}

/// Ids of all timelines below a folder, sorted.
std::vector<std::string> IdsBelow(const fs::path& folder) {
  std::vector<std::string> scenarios;
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored)) {
    if (entry.path().extension() != kExtension) continue;
    scenarios.push_back(fs::relative(entry.path(), folder).replace_extension().generic_string());
  }
  std::sort(scenarios.begin(), scenarios.end());
  return scenarios;
}

}  // namespace

fs::path GoldenFiles::GoldenPath(const std::string& scenario) const {
  return root_ / "golden" / (scenario + kExtension);
}

fs::path GoldenFiles::PendingPath(const std::string& scenario) const {
  return root_ / "build" / "pending" / (scenario + kExtension);
}

ReadResult<Golden> GoldenFiles::ReadGoldenOf(const std::string& scenario) const {
  return ReadFrom(GoldenPath(scenario), scenario);
}

ReadResult<Golden> GoldenFiles::ReadPendingOf(const std::string& scenario) const {
  return ReadFrom(PendingPath(scenario), scenario);
}

std::string GoldenFiles::WritePending(const Golden& golden) const {
  return WriteTextFile(PendingPath(golden.scenario), WriteGolden(golden));
}

std::string GoldenFiles::WriteGoldenFile(const Golden& golden) const {
  return WriteTextFile(GoldenPath(golden.scenario), WriteGolden(golden));
}

std::string GoldenFiles::WriteAccepted(const Golden& golden) const {
  std::string problem = WriteGoldenFile(golden);
  if (problem.empty()) RemovePending(golden.scenario);
  return problem;
}

void GoldenFiles::RemovePending(const std::string& scenario) const {
  std::error_code ignored;
  fs::remove(PendingPath(scenario), ignored);
}

std::vector<fs::path> GoldenFiles::PicturesOf(const std::string& scenario) const {
  std::vector<fs::path> pictures;
  const std::string name = fs::path(scenario).filename().string();
  std::error_code ignored;
  for (int i = 1;; ++i) {
    const std::string suffix = i == 1 ? "" : "-" + std::to_string(i);
    fs::path picture = PicturePath(scenario, name + suffix + ".png");
    if (!fs::exists(picture, ignored)) return pictures;
    pictures.push_back(std::move(picture));
  }
}

std::vector<std::string> GoldenFiles::List() const { return IdsBelow(root_ / "golden"); }

std::vector<std::string> GoldenFiles::ListPending() const {
  return IdsBelow(root_ / "build" / "pending");
}

}  // namespace prehend::harness
