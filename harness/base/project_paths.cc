// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/run/find_scenario_test.cc
#include "harness/base/project_paths.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "harness/base/text_file.h"

namespace prehend::harness {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> RootAbove(fs::path folder) {
  std::error_code error;
  for (;; folder = folder.parent_path()) {
    if (fs::is_directory(GrammarFolder(folder), error)) return folder.string();
    if (folder == folder.parent_path()) return std::nullopt;
  }
}

}  // namespace

std::string GrammarFolder(const std::string& root) {
  return (fs::path(root) / "grammar" / "library").string();
}
std::string HandFolder(const std::string& root) {
  return (fs::path(root) / "physics" / "library").string();
}

std::optional<std::string> FindProjectRoot() {
  std::error_code error;
  if (const char* home = std::getenv("PREHEND_HOME"); home && *home) {
    return fs::is_directory(GrammarFolder(home), error) ? std::optional<std::string>(home)
                                                        : std::nullopt;
  }
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  if (auto root = RootAbove(executable.parent_path())) return root;
  return RootAbove(fs::current_path(error));
}

std::vector<std::string> FilesIn(const std::string& folder, std::string_view ending) {
  std::vector<std::string> files;
  std::error_code error;
  for (const fs::directory_entry& file : fs::directory_iterator(folder, error)) {
    const std::string name = file.path().filename().string();
    if (name.ends_with(ending)) files.push_back(name);
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> NamesIn(const std::string& folder, std::string_view ending) {
  std::vector<std::string> names;
  for (const std::string& file : FilesIn(folder, ending)) {
    if (ReadableName(file) == file) names.push_back(file.substr(0, file.size() - ending.size()));
  }
  return names;
}

std::string GrammarPath(const std::string& root, const std::string& name) {
  return (fs::path(GrammarFolder(root)) / (name + kGrammarEnding)).string();
}

std::string HandPath(const std::string& root, const std::string& name) {
  return (fs::path(HandFolder(root)) / (name + kHandEnding)).string();
}

}  // namespace prehend::harness
