// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <ftw.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <system_error>

#include "harness/base/base/content_hash.h"
#include "harness/base/base/input_files.h"
#include "harness/base/base/text_file.h"

namespace prehend {

namespace fs = std::filesystem;

namespace {

namespace fs = std::filesystem;

/// Empty, or why no file can be put at `path`: what is there is not to be replaced.
std::string WhyNotReplaceable(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);  // of what a link points to
  const std::string cannot = "cannot write " + path.string() + ": ";
  if (!path.has_filename() && !fs::exists(status)) return cannot + "it names no file";
  if (fs::is_directory(status)) return cannot + "it is a folder";
  if (!fs::exists(status))
    return fs::is_symlink(path, error) ? cannot + "it is a link to a file that does not exist" : "";
  const bool is_own_output =
      fs::equivalent(path, "/dev/stdout", error) || fs::equivalent(path, "/dev/stderr", error);
  if (is_own_output || !fs::is_regular_file(status)) {
    return cannot + "it is " +
           (is_own_output ? "an output of this program" : "a device or a pipe") +
           ", wanted a file; standard output is written as '-'";
  }
  return access(path.c_str(), W_OK) == 0 ? "" : cannot + std::strerror(errno);
}

/// By which an open file without a name can be opened and linked.
fs::path NameOf(int file) { return "/proc/self/fd/" + std::to_string(file); }

/// What names of temporary folders begin with; their maker's number follows, which is another
/// process's on another machine or in a container.
std::string BeginOfTemporary() {
  std::error_code error;
  std::string boot;
  std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), boot);
  boot += fs::read_symlink("/proc/self/ns/pid", error).string();
  return "prehend-" + ContentHash(boot).substr(8) + "-";
}

/// With one descriptor, however deep it is.
void RemoveFolder(const fs::path& folder) {
  const auto remove_one = [](const char* path, const struct stat*, int, FTW*) {
    (void)std::remove(path);
    return 0;
  };
  nftw(folder.c_str(), remove_one, 1, FTW_DEPTH | FTW_PHYS);
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  // mkdtemp() puts other letters in the place of the six.
  std::string name = (fs::temp_directory_path(error) / BeginOfTemporary()).string() +
                     std::to_string(getpid()) + "-XXXXXX";
  if (!error && !mkdtemp(name.data())) error.assign(errno, std::generic_category());
  if (error)
    problem_ = "no folder for temporary files: " + error.message();
  else
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  if (!path_.empty()) RemoveFolder(path_);
}

void RemoveLeftFolders() {
  std::error_code error;
  const fs::path above = fs::temp_directory_path(error);
  const std::string begin = BeginOfTemporary();
  bool is_one_alive = true;
  for (int round = 0; is_one_alive && round < 5; ++round) {
    if (round > 0) usleep(10'000);  // those that were killed may still be dying
    is_one_alive = false;
    for (fs::directory_iterator at(above, error), end; !error && at != end; at.increment(error)) {
      const std::string name = at->path().filename().string();
      struct stat status = {};
      if (!name.starts_with(begin) || lstat(at->path().c_str(), &status) != 0 ||
          status.st_uid != geteuid())
        continue;
      const pid_t maker = std::atoi(name.c_str() + begin.size());
      const bool is_left = maker > 0 && kill(maker, 0) != 0 && errno == ESRCH;
      if (is_left) RemoveFolder(at->path());
      is_one_alive |= !is_left;
    }
  }
}

std::string FileNameOf(std::string_view text) {
  constexpr std::size_t kMost_bytes = 180;
  std::string name(text.substr(0, kMost_bytes));
  name.resize(name.size() - BegunUtf8(name));
  for (char& c : name) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.' ||
                          static_cast<unsigned char>(c) >= 0x80;
    if (!is_plain) c = '_';
  }
  if (name.starts_with('.')) name.front() = '_';
  return name;
}

std::string MakeFolderOf(const fs::path& path) {
  std::error_code error;
  if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
  return error ? "cannot create " + path.parent_path().string() + ": " + error.message() : "";
}

AtomicFile::AtomicFile(const fs::path& path, Over over) : path_(path), over_(over) {
  if (path == "-") {
    stream_ = &std::cout;
    return;
  }
  problem_ = WhyNotReplaceable(path);
  if (problem_.empty()) problem_ = WhyInput();
  if (problem_.empty()) problem_ = MakeFolderOf(path);
  if (!problem_.empty()) return;
  std::error_code error;
  target_ = fs::weakly_canonical(path, error);
  unfinished_ = target_.string() + "." + std::to_string(getpid()) + ".unfinished";
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
  nameless_ = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (nameless_ >= 0) file_.open(NameOf(nameless_), std::ios::binary);
  if (!file_.is_open()) {
    ForgetNameless();
    file_.open(unfinished_, std::ios::binary);
  }
  if (!file_) {
    problem_ = "cannot write " + path.string() + ": " + std::strerror(errno);
  } else if (fs::exists(target_, error)) {
    fs::permissions(nameless_ >= 0 ? NameOf(nameless_) : unfinished_,
                    fs::status(target_, error).permissions(), error);
  }
}

AtomicFile::~AtomicFile() {
  ForgetNameless();
  std::error_code error;
  if (!unfinished_.empty()) fs::remove(unfinished_, error);
}

std::string AtomicFile::WhyInput() const {
  if (over_ == Over::kAnything || !IsInput(path_)) return "";
  return fmt::format("cannot write {}: {}; name another file", path_.string(), kIsRead);
}

void AtomicFile::ForgetNameless() {
  if (nameless_ >= 0) close(nameless_);
  nameless_ = -1;
}

std::string AtomicFile::Commit() {
  if (!problem_.empty()) return problem_;
  const std::string cannot = "cannot write " + path_.string() + ": ";
  if (file_.is_open()) file_.close();
  if (!stream_->flush()) return cannot + "not all of it could be written; is the disk full?";
  if (unfinished_.empty()) return "";
  if (std::string why = WhyInput(); !why.empty()) return why;
  if (nameless_ >= 0 && linkat(AT_FDCWD, NameOf(nameless_).c_str(), AT_FDCWD, unfinished_.c_str(),
                               AT_SYMLINK_FOLLOW) != 0)
    return cannot + std::strerror(errno);
  ForgetNameless();
  std::error_code error;
  fs::rename(unfinished_, target_, error);
  return error ? cannot + error.message() : "";
}

FolderLock::FolderLock(const fs::path& folder)
    : folder_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  while (folder_ >= 0 && flock(folder_, LOCK_EX) != 0 && errno == EINTR) {
  }
}

FolderLock::~FolderLock() {
  if (folder_ >= 0) close(folder_);
}

std::string WhyNotWritable(const fs::path& path) { return AtomicFile(path).problem(); }

std::string WriteTextFile(const fs::path& path, std::string_view text, Over over) {
  AtomicFile file(path, over);
  file.stream() << text;
  return file.Commit();
}

}  // namespace prehend
