// SPDX-License-Identifier: Apache-2.0
// See harness/whole_file.h. Tested by tests/harness/whole_file_test.cc
#include "harness/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>
#include <optional>

namespace prehend::harness {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBuffer_bytes = 1 << 16;
constexpr mode_t kReadAndWrite = 0666;  // less what the user's mask forbids

std::optional<struct stat> StatusOf(const fs::path& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? std::optional(status) : std::nullopt;
}

/// Standard output or standard error, when the path is another name of it.
std::optional<int> OwnOutput(const struct stat& status) {
  for (const int own : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat other {};
    if (fstat(own, &other) == 0 && other.st_dev == status.st_dev && other.st_ino == status.st_ino)
      return own;
  }
  return std::nullopt;
}

/// What a link means, also when that does not exist yet.
fs::path Followed(fs::path path) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(path, error); ++i) {
    const fs::path target = fs::read_symlink(path, error);
    path = target.is_absolute() ? target : path.parent_path() / target;
  }
  return path;
}

std::string MakeFolderOf(const fs::path& path) {
  std::error_code error;
  if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
  return error ? "cannot create " + path.parent_path().string() + ": " + error.message() : "";
}

}  // namespace

FileBuffer::FileBuffer() : kept_(kBuffer_bytes) { setp(kept_.data(), kept_.data() + kept_.size()); }

FileBuffer::~FileBuffer() {
  if (descriptor_ >= 0) close(descriptor_);
}

int FileBuffer::sync() {
  for (const char* next = pbase(); next < pptr() && error_ == 0;) {
    const ssize_t written = write(descriptor_, next, static_cast<std::size_t>(pptr() - next));
    if (written >= 0) next += written;
    if (written < 0 && errno != EINTR) error_ = errno;
  }
  setp(kept_.data(), kept_.data() + kept_.size());
  return error_ == 0 ? 0 : -1;
}

int FileBuffer::overflow(int character) {
  if (sync() != 0) return traits_type::eof();
  if (!traits_type::eq_int_type(character, traits_type::eof()))
    sputc(traits_type::to_char_type(character));
  return traits_type::not_eof(character);
}

int FileBuffer::Close() {
  sync();
  if (descriptor_ >= 0 && close(descriptor_) != 0 && error_ == 0) error_ = errno;
  descriptor_ = -1;
  return error_;
}

WholeFile::WholeFile(const fs::path& path)
    : named_(path), path_(Followed(path)), stream_(&buffer_) {
  int descriptor = -1;
  const auto status = StatusOf(named_);
  if (status && S_ISDIR(status->st_mode)) {
    problem_ = named_.string() + " is a folder";
    return;
  }
  if (!status && (errno != ENOENT || named_.empty())) {  // links in a circle, a file for a folder
    Fail(errno);
    return;
  }
  const auto own = status ? OwnOutput(*status) : std::nullopt;
  if (own) {
    std::cout.flush();
    descriptor = dup(*own);
  } else if (status && !S_ISREG(status->st_mode)) {
    descriptor = open(named_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  } else if (!status || access(named_.c_str(), W_OK) == 0) {
    unfinished_ = path_.string() + "." + std::to_string(getpid()) + ".unfinished";
    descriptor = open(unfinished_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kReadAndWrite);
  }
  if (descriptor < 0) {
    Fail(errno);
    return;
  }
  if (status && !unfinished_.empty()) fchmod(descriptor, status->st_mode & 07777);
  buffer_.Attach(descriptor);
}

WholeFile::~WholeFile() {
  if (!problem_.empty() || unfinished_.empty()) return;
  std::error_code ignored;
  fs::remove(unfinished_, ignored);
}

void WholeFile::Fail(int error) {
  problem_ = "cannot write " + named_.string() + ": " + std::strerror(error);
}

std::string WholeFile::Commit() {
  if (!problem_.empty()) return problem_;
  if (const int error = buffer_.Close()) {
    return "cannot write " + named_.string() + ": " + std::strerror(error);
  }
  if (unfinished_.empty()) return "";
  std::error_code error;
  fs::rename(unfinished_, path_, error);
  return error ? "cannot write " + named_.string() + ": " + error.message() : "";
}

std::string WhyNotWritable(const fs::path& path) {
  if (std::string problem = MakeFolderOf(path); !problem.empty()) return problem;
  const auto status = StatusOf(path);
  const bool may_wait = status && S_ISFIFO(status->st_mode);
  if (!may_wait) return WholeFile(path).problem();
  return access(path.c_str(), W_OK) == 0
             ? ""
             : "cannot write " + path.string() + ": " + std::strerror(errno);
}

std::string WriteTextFile(const fs::path& path, std::string_view text) {
  if (std::string problem = MakeFolderOf(path); !problem.empty()) return problem;
  WholeFile file(path);
  file.stream() << text;
  return file.Commit();
}

}  // namespace prehend::harness
