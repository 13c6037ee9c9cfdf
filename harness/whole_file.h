// SPDX-License-Identifier: Apache-2.0
// A file that appears as a whole or not at all: written beside its place under another name, and
// moved there at the end. Tested by tests/harness/golden_files_test.cc
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace prehend::harness {

class WholeFile {
 public:
  /// The folder must exist; problem() says whether the file can be written there.
  explicit WholeFile(std::filesystem::path path);
  /// Without Commit() nothing is left behind.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  std::ostream& stream() { return stream_; }

  /// "" or why the file cannot be written.
  const std::string& problem() const { return problem_; }

  /// Moves the file to its place. "" or what went wrong, then an older file is still as it was.
  std::string Commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path unfinished_;
  std::ofstream stream_;
  std::string problem_;
};

/// Writes a file and the folders above it, as a whole or not at all. "" or what went wrong.
std::string WriteTextFile(const std::filesystem::path& path, std::string_view text);

}  // namespace prehend::harness
