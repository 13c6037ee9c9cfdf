// SPDX-License-Identifier: Apache-2.0
// The source files of the project, as the architecture tests read them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace prehend::architecture {

struct SourceFile {
  std::string path;  ///< from the root of the project, "harness/episode/run/run_trials.h"
  std::string text;
};

/// All *.h and *.cc below these top folders, sorted by path.
std::vector<SourceFile> SourceFiles(const std::vector<std::string>& folders);

/// What a file includes in quotes or angle brackets, with the number of the line.
struct Include {
  std::string header;
  int line = 0;
};
std::vector<Include> IncludesOf(const std::string& text);

std::string Slurp(const std::filesystem::path& path);

}  // namespace prehend::architecture
