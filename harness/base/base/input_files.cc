// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/input_files.h"

#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace prehend {
namespace {

using FileId = std::pair<dev_t, ino_t>;

/// What is remembered; of a process, as it is about the process.
struct Inputs {
  std::mutex mutex;
  std::map<FileId, std::filesystem::path> read;  ///< and by which name
  std::string untold;                            ///< each with a zero byte behind it
};

Inputs& InputsOfProcess() {
  static Inputs inputs;
  return inputs;
}

std::optional<FileId> IdOf(const std::filesystem::path& path) {
  struct stat status = {};
  if (stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return FileId{status.st_dev, status.st_ino};
}

}  // namespace

void RememberInput(const std::filesystem::path& path) {
  const auto id = IdOf(path);
  if (!id) return;
  Inputs& inputs = InputsOfProcess();
  const std::lock_guard lock(inputs.mutex);
  std::filesystem::path& known = inputs.read[*id];
  if (known == path) return;
  known = path;
  inputs.untold += path.string() + '\0';
}

std::string TakeNewInputs() {
  Inputs& inputs = InputsOfProcess();
  const std::lock_guard lock(inputs.mutex);
  return std::exchange(inputs.untold, {}) + '\0';
}

std::string_view RememberInputs(std::string_view told) {
  std::string_view name;
  do {
    name = told.substr(0, told.find('\0'));
    told.remove_prefix(std::min(name.size() + 1, told.size()));
    RememberInput(name);
  } while (!name.empty());
  return told;
}

std::ifstream OpenInput(const std::string& path) {
  RememberInput(path);
  return std::ifstream(path, std::ios::binary);
}

bool IsInput(const std::filesystem::path& path) {
  const auto id = IdOf(path);
  if (!id) return false;
  Inputs& inputs = InputsOfProcess();
  const std::lock_guard lock(inputs.mutex);
  const auto found = inputs.read.find(*id);
  // The number of a file that was removed may be another one's now.
  return found != inputs.read.end() && IdOf(found->second) == id;
}

}  // namespace prehend
