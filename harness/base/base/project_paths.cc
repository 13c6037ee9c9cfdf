// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/project_paths.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "harness/base/base/number_text.h"
#include "harness/base/base/text_file.h"

namespace prehend {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGrammars = "grammars";
constexpr const char* kHands = "hands";
constexpr const char* kLibrary = "grammar/library";
constexpr const char* kInstalled = "share/prehend";

/// The nearest folder, `folder` or above it, that has this in it, or in a folder `below` it.
std::optional<std::string> RootAbove(fs::path folder, const char* what, const char* below = "") {
  std::error_code error;
  for (;; folder = folder.parent_path()) {
    if (fs::exists(folder / what, error)) return folder.string();
    if (fs::exists(folder / below / what, error)) return (folder / below).string();
    if (folder == folder.parent_path()) return std::nullopt;
  }
}

/// The program, or the library or Python module that this function is in.
fs::path ThisBinary() {
  std::error_code error;
  Dl_info here{};
  const bool found = dladdr(reinterpret_cast<const void*>(&ThisBinary), &here) != 0;
  const std::string name = found && here.dli_fname ? here.dli_fname : "";
  if (fs::path(name).filename().string().find(".so") != std::string::npos)
    return fs::canonical(name, error);
  return fs::read_symlink("/proc/self/exe", error);
}

std::vector<std::string> Folders(const std::string& root, const char* own, const char* library) {
  std::vector<std::string> folders;
  std::error_code error;
  const std::string shipped = ShippedRoot();
  if (fs::is_directory(fs::path(root) / own, error)) folders.push_back(fs::path(root) / own);
  if (fs::is_directory(fs::path(root) / library, error) || shipped.empty())
    folders.push_back(fs::path(root) / library);
  else
    folders.push_back(fs::path(shipped) / library);
  return folders;
}

std::vector<std::string> Names(const std::vector<std::string>& folders, std::string_view ending) {
  std::vector<std::string> names;
  for (const std::string& folder : folders) {
    for (std::string& name : NamesIn(folder, ending)) names.push_back(std::move(name));
  }
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

std::string Found(const fs::path& own, const fs::path& library, std::vector<std::string>* tried) {
  std::error_code error;
  if (tried) tried->push_back(own.string());
  if (fs::symlink_status(own, error).type() != fs::file_type::not_found) return own.string();
  if (tried) tried->push_back(library.string());
  return library.string();
}

}  // namespace

std::string ShippedRoot() {
  static const std::string root =
      RootAbove(ThisBinary().parent_path(), kLibrary, kInstalled).value_or("");
  return root;
}

bool IsOwnProject(const std::string& root) {
  std::error_code error;
  return !fs::is_directory(fs::path(root) / kLibrary, error);
}

bool IsInstalled(const std::string& root) {
  return root == ShippedRoot() && root.ends_with(kInstalled);
}

std::string BuildFolder(const std::string& root) {
  return IsInstalled(root) ? "build" : (fs::path(root) / "build").string();
}

bool IsCalledIn(const std::string& root) {
  if (const char* home = std::getenv("PREHEND_HOME"); home && *home) return true;
  std::error_code error;
  const fs::path here = fs::current_path(error), folder = fs::weakly_canonical(root, error);
  return std::mismatch(folder.begin(), folder.end(), here.begin(), here.end()).first ==
         folder.end();
}

std::vector<std::string> GrammarFolders(const std::string& root) {
  return Folders(root, kGrammars, kLibrary);
}
std::vector<std::string> HandFolders(const std::string& root) {
  return Folders(root, kHands, "physics/library");
}

std::optional<std::string> FindProjectRoot() {
  std::error_code error;
  if (const char* home = std::getenv("PREHEND_HOME"); home && *home) {
    const bool is_project = fs::is_directory(fs::path(home) / kLibrary, error) ||
                            fs::exists(fs::path(home) / kProjectFile, error);
    return is_project ? std::optional<std::string>(home) : std::nullopt;
  }
  const fs::path here = fs::current_path(error);
  if (auto root = RootAbove(here, kProjectFile)) return root;
  if (!ShippedRoot().empty()) return ShippedRoot();
  return RootAbove(here, kLibrary);
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

std::vector<std::string> SplitGrammars(const std::string& joined) { return SplitAt(joined, '+'); }

std::vector<std::string> GrammarNames(const std::string& root) {
  return Names(GrammarFolders(root), kGrammarEnding);
}
std::vector<std::string> HandNames(const std::string& root) {
  return Names(HandFolders(root), kHandEnding);
}

std::string Shipped(const std::string& path) { return ShippedRoot() + "/" + path; }

std::string GrammarPath(const std::string& root, const std::string& name,
                        std::vector<std::string>* tried) {
  const std::string file = name + kGrammarEnding;
  return Found(fs::path(root) / kGrammars / file, GrammarFolders(root).back() / fs::path(file),
               tried);
}
std::string HandPath(const std::string& root, const std::string& name,
                     std::vector<std::string>* tried) {
  const std::string file = name + kHandEnding;
  return Found(fs::path(root) / kHands / file, HandFolders(root).back() / fs::path(file), tried);
}

}  // namespace prehend
