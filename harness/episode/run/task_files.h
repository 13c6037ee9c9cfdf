// SPDX-License-Identifier: Apache-2.0
// The files that a run was made from, kept with its episode, so that it can be loaded again where
// the project has changed or is not there. Tested by tests/harness/episode/run/task_files_test.cc
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/base/base/atomic_file.h"
#include "harness/episode/run/load_run.h"

namespace prehend::episode {

struct TaskFiles {
  /// Its scenario and its grammar, if that is a file, are keys of `files`.
  RunRequest run;
  /// Path -> content. A path is relative to the project's folder or, outside of it, absolute.
  std::map<std::string, std::string> files;

  /// Equal texts: the same files, the same settings.
  std::string Identity() const;
};

/// `tried`: all paths that LoadRun() tried; those that do not exist are left out.
TaskFiles PackTask(const RunRequest& run, const std::vector<std::string>& tried,
                   const std::string& root);

/// A folder in which tasks are unpacked, to be loaded as if they were the project; it is made for
/// the first of them, and removed at the end.
class UnpackedTasks {
 public:
  /// Writes the files that are not there yet. Returns "" or what went wrong.
  std::string Unpack(const TaskFiles& task);
  /// After Unpack(): what LoadRun() needs.
  RunRequest RequestOf(const TaskFiles& task) const;
  /// What a file of a task names is looked for in the folder, whatever its path says.
  std::string Within(const std::string& path) const;
  /// The same of a grammar's name or path, or of several.
  std::string GrammarWithin(const std::string& grammar) const;
  const std::string& root() const { return root_; }
  /// How often a file that is no scenario was written: as long as it is the same, what was read
  /// from them holds.
  std::size_t writes() const { return writes_; }
  /// A path in the folder as it was in the project.
  std::string Original(const std::string& path) const;

 private:
  std::string PathOf(const std::string& path) const;

  std::optional<TemporaryFolder> folder_;
  std::string root_;
  std::size_t writes_ = 0;
  std::map<std::string, std::string> written_;  ///< path -> content hash
};

}  // namespace prehend::episode
