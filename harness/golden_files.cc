// SPDX-License-Identifier: Apache-2.0
// See golden_files.h. Tested by tests/harness/golden_files_test.cc
#include "harness/golden_files.h"

#include <algorithm>

#include "harness/text_file.h"

namespace prehend::harness {

namespace fs = std::filesystem;

namespace {
constexpr const char* kExtension = ".timeline";
}

fs::path GoldenFiles::GoldenPath(const std::string& scenario) const {
  return root_ / "golden" / (scenario + kExtension);
}

fs::path GoldenFiles::PendingPath(const std::string& scenario) const {
  return root_ / "build" / "pending" / (scenario + kExtension);
}

ReadResult<Golden> GoldenFiles::ReadGoldenOf(const std::string& scenario) const {
  const fs::path path = GoldenPath(scenario);
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

std::string GoldenFiles::WritePending(const Golden& golden) const {
  return WriteTextFile(PendingPath(golden.scenario), WriteGolden(golden));
}

std::string GoldenFiles::WriteAccepted(const Golden& golden) const {
  std::string problem = WriteTextFile(GoldenPath(golden.scenario), WriteGolden(golden));
  if (problem.empty()) RemovePending(golden.scenario);
  return problem;
}

void GoldenFiles::RemovePending(const std::string& scenario) const {
  std::error_code ignored;
  fs::remove(PendingPath(scenario), ignored);
}

std::vector<std::string> GoldenFiles::List() const {
  std::vector<std::string> scenarios;
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(root_ / "golden", ignored)) {
    if (entry.path().extension() != kExtension) continue;
    scenarios.push_back(
        fs::relative(entry.path(), root_ / "golden").replace_extension().generic_string());
  }
  std::sort(scenarios.begin(), scenarios.end());
  return scenarios;
}

}  // namespace prehend::harness
