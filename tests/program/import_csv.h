// SPDX-License-Identifier: Apache-2.0
// Imports a file of poses by a map, for tests.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/program/program.h"

namespace prehend::house {

/// Into take.jsonl of the folder, unless `more` says what else to do.
inline Said ImportFile(const std::filesystem::path& folder, const std::string& file,
                       const std::string& bytes, const std::string& map,
                       const std::vector<std::string>& more = {}) {
  WriteFile(folder / file, bytes);
  WriteFile(folder / "map.yaml", map);
  std::vector<std::string> words = {"import", (folder / file).string(), "--map",
                                    (folder / "map.yaml").string()};
  words.insert(words.end(), more.begin(), more.end());
  if (more.empty()) words.insert(words.end(), {"-o", (folder / "take.jsonl").string()});
  return Prehend(words);
}

inline Said ImportCsv(const std::filesystem::path& folder, const std::string& csv,
                      const std::string& map, const std::vector<std::string>& more = {}) {
  return ImportFile(folder, "poses.csv", csv, map, more);
}

}  // namespace prehend::house
