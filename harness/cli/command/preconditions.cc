// SPDX-License-Identifier: Apache-2.0
#include "harness/cli/command/preconditions.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>

#include "harness/base/base/project_paths.h"
#include "harness/base/base/text_file.h"

namespace prehend::cli {
namespace {

namespace fs = std::filesystem;

/// Four times what 64 levels of brackets in a grammar were seen to need.
constexpr rlim_t kStack_bytes = 1 << 20;
constexpr const char* kFolders[] = {"scenarios", "golden",   "grammar",
                                    "physics",   "grammars", "hands"};

bool IsBelow(const fs::path& file, const fs::path& folder) {
  std::error_code error;
  const fs::path real_file = fs::weakly_canonical(fs::absolute(file), error);
  const fs::path real_folder = fs::weakly_canonical(fs::absolute(folder), error);
  return std::ranges::mismatch(real_folder, real_file).in1 == real_folder.end();
}

std::optional<Refusal> RefuseToWrite(const Option& output, const std::string& file,
                                     const std::string& what) {
  std::error_code error;
  return Refusal{ExitCode::kBadInput,
                 fmt::format("{}: {} {} {}; name another file", output.name, ReadableName(file),
                             fs::exists(file, error) ? "is" : "would be", what)};
}

}  // namespace

std::optional<Refusal> RefuseSmallStack() {
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= kStack_bytes) return std::nullopt;
  const rlim_t had = limit.rlim_cur;
  limit.rlim_cur = std::min(kStack_bytes, limit.rlim_max);
  if (limit.rlim_cur == kStack_bytes && setrlimit(RLIMIT_STACK, &limit) == 0) return std::nullopt;
  return Refusal{ExitCode::kFailure,
                 fmt::format("found a stack of {} KiB, wanted {} KiB: see ulimit -s", had / 1024,
                             kStack_bytes / 1024)};
}

std::optional<Refusal> RefuseUnreadableFolders(const std::string& root) {
  for (const char* const name : kFolders) {
    const fs::path folder = fs::path(root) / name;
    std::error_code error;
    if (!fs::exists(folder, error)) continue;
    fs::recursive_directory_iterator entry(folder, error);
    while (!error && entry != fs::recursive_directory_iterator()) entry.increment(error);
    if (!error) continue;
    const bool of_system = error == std::errc::too_many_files_open ||
                           error == std::errc::too_many_files_open_in_system;
    return Refusal{of_system ? ExitCode::kFailure : ExitCode::kBadInput,
                   fmt::format("{} or a folder in it cannot be read: {}",
                               ReadableName(folder.string()), error.message())};
  }
  return std::nullopt;
}

std::optional<Refusal> RefuseOutputsThatAreInputs(const std::string& root, const Command& command,
                                                  const ParsedOptions& options) {
  for (const Option& output : command.options) {
    if (!output.is_output) continue;
    for (const std::string& file : options.All(output.name)) {
      if (file == "-") continue;
      std::error_code error;
      if (IsBelow(file, fs::path(root) / kProjectFile))
        return RefuseToWrite(output, file, "what makes a folder a project");
      for (const char* const folder : kFolders) {
        if (IsBelow(file, fs::path(root) / folder))
          return RefuseToWrite(output, file, fmt::format("a file of the project's {}/", folder));
      }
      for (const Option& input : command.options) {
        if (input.is_output) continue;
        for (const std::string& other : options.All(input.name)) {
          if (fs::equivalent(file, other, error))
            return RefuseToWrite(output, file, "what is read");
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace prehend::cli
