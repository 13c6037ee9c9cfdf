// SPDX-License-Identifier: Apache-2.0
// A folder of one's own among the temporary files, removed with all that is in it. Tested by
// tests/harness/base/base/temporary_folder_test.cc
#pragma once

#include <filesystem>
#include <string>

namespace prehend {

class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Empty if it could not be made.
  const std::filesystem::path& path() const { return path_; }
  /// Why it could not be made, or "".
  const std::string& problem() const { return problem_; }

 private:
  std::filesystem::path path_;
  std::string problem_;
};

}  // namespace prehend
