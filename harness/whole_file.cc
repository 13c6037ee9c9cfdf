// SPDX-License-Identifier: Apache-2.0
// See whole_file.h. Tested by tests/harness/golden_files_test.cc
#include "harness/whole_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace prehend::harness {

namespace fs = std::filesystem;

WholeFile::WholeFile(fs::path path)
    : path_(std::move(path)),
      unfinished_(path_.string() + "." + std::to_string(getpid()) + ".unfinished") {
  std::error_code ignored;
  if (fs::is_directory(path_, ignored)) {
    problem_ = path_.string() + " is a folder";
    return;
  }
  if (fs::exists(path_, ignored) && access(path_.c_str(), W_OK) != 0) {
    problem_ = "cannot write " + path_.string() + ": " + std::strerror(errno);
    return;
  }
  stream_.open(unfinished_, std::ios::binary | std::ios::trunc);
  if (!stream_) problem_ = "cannot write " + path_.string() + ": " + std::strerror(errno);
}

WholeFile::~WholeFile() {
  std::error_code ignored;
  if (stream_.is_open()) stream_.close();
  if (problem_.empty()) fs::remove(unfinished_, ignored);
}

std::string WholeFile::Commit() {
  if (!problem_.empty()) return problem_;
  stream_.close();
  if (!stream_) return "cannot write " + path_.string() + ": " + std::strerror(errno);
  std::error_code error;
  fs::rename(unfinished_, path_, error);
  return error ? "cannot write " + path_.string() + ": " + error.message() : "";
}

std::string WriteTextFile(const fs::path& path, std::string_view text) {
  std::error_code error;
  if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
  if (error) return "cannot create " + path.parent_path().string() + ": " + error.message();
  WholeFile file(path);
  file.stream() << text;
  return file.Commit();
}

}  // namespace prehend::harness
