// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/task_files.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "harness/base/base/content_hash.h"
#include "harness/base/base/project_paths.h"

namespace prehend::episode {
namespace {

namespace fs = std::filesystem;

/// Relative to the project, or to what ships with the program, whose folders have other names.
std::string Stored(const std::string& path, const fs::path& root) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  for (const fs::path& home : {root, fs::path(ShippedRoot())}) {
    const fs::path relative = home.empty() ? fs::path() : whole.lexically_relative(home);
    if (!relative.empty() && *relative.begin() != "..") return relative.generic_string();
  }
  return whole.generic_string();
}

/// The same with other paths, of one grammar or of several joined with '+'.
template <typename Change>
std::string WithPaths(const std::string& grammars, const Change& change) {
  std::string all;
  for (const std::string& one : SplitGrammars(grammars)) {
    const bool is_path = one.find('/') != std::string::npos || one.ends_with(kGrammarEnding);
    all += (all.empty() ? "" : "+") + (is_path ? change(one) : one);
  }
  return all;
}

}  // namespace

std::string TaskFiles::Identity() const {
  std::string text = run.scenario_file + "\n" + run.grammar + "\n";
  for (const std::string& setting : run.settings) text += setting + "\n";
  for (const auto& [path, content] : files) text += path + " " + ContentHash(content) + "\n";
  return text;
}

TaskFiles PackTask(const RunRequest& run, const std::vector<std::string>& tried,
                   const std::string& root) {
  const fs::path home = fs::absolute(root).lexically_normal();
  TaskFiles task{.run = run};
  task.run.scenario_file = Stored(run.scenario_file, home);
  std::error_code error;
  const auto stored = [&](const std::string& path) { return Stored(path, home); };
  const bool is_one = run.grammar.find('+') != std::string::npos && fs::exists(run.grammar, error);
  task.run.grammar = is_one ? stored(run.grammar) : WithPaths(run.grammar, stored);
  std::vector<std::string> paths = tried;
  // The scenario's own grammar is not read then, but has to be known.
  for (const std::string& name : GrammarNames(root)) {
    if (!run.grammar.empty()) paths.push_back(GrammarPath(root, name));
  }
  for (const std::string& path : paths) {
    if (!fs::is_regular_file(path, error)) continue;
    std::ifstream file(path, std::ios::binary);
    std::ostringstream content;
    content << file.rdbuf();
    task.files[Stored(path, home)] = std::move(content).str();
  }
  return task;
}

std::string UnpackedTasks::PathOf(const std::string& path) const {
  // A file says where it wants to be: it stays below the folder.
  const fs::path normal = fs::path("/" + path).lexically_normal().relative_path();
  return (path.starts_with('/') ? folder_->path() / "outside" : fs::path(root_)) / normal;
}

std::string UnpackedTasks::Unpack(const TaskFiles& task) {
  if (!folder_) folder_.emplace();
  if (!folder_->problem().empty()) return folder_->problem();
  std::error_code error;
  if (root_.empty()) {
    root_ = folder_->path().string() + "/project";
    fs::create_directories(root_ + "/grammar/library", error);
    fs::create_directories(root_ + "/physics/library", error);
  }
  for (const auto& [path, content] : task.files) {
    // What another task's project had in the place of this one would be found first.
    for (const auto& [own, library] : {std::pair("grammars/", std::string("grammar/library/")),
                                       std::pair("hands/", std::string("physics/library/"))}) {
      if (!path.starts_with(library)) continue;
      const std::string first = own + path.substr(library.size());
      if (task.files.contains(first) || written_.erase(first) == 0) continue;
      fs::remove(PathOf(first), error);
      ++writes_;
    }
    const std::string hash = ContentHash(content);
    const auto [known, is_new] = written_.try_emplace(path, hash);
    if (!is_new && known->second == hash) continue;
    known->second = hash;
    if (!path.starts_with("scenarios/") || path.ends_with(".grammar")) ++writes_;
    const std::string problem = WriteTextFile(PathOf(path), content, Over::kAnything);
    if (!problem.empty()) return problem;
  }
  return "";
}

RunRequest UnpackedTasks::RequestOf(const TaskFiles& task) const {
  RunRequest run = task.run;
  run.scenario_file = PathOf(run.scenario_file);
  run.grammar = GrammarWithin(run.grammar);
  return run;
}

std::string UnpackedTasks::Within(const std::string& path) const {
  const std::string normal = fs::path(path).lexically_normal().string();
  const bool is_in = normal.starts_with(folder_->path().lexically_normal().string() + "/");
  return is_in ? path : PathOf(path);
}

std::string UnpackedTasks::GrammarWithin(const std::string& grammar) const {
  if (const std::string whole = Within(grammar); written_.contains(Original(whole))) return whole;
  return WithPaths(grammar, [&](const std::string& path) { return Within(path); });
}

std::string UnpackedTasks::Original(const std::string& path) const {
  if (path.find('+') != std::string::npos)
    return WithPaths(path, [&](const std::string& one) { return Original(one); });
  const std::string outside = folder_->path().string() + "/outside";
  if (path.starts_with(root_ + "/")) return path.substr(root_.size() + 1);
  if (path.starts_with(outside + "/")) return path.substr(outside.size());
  return path;
}

}  // namespace prehend::episode
