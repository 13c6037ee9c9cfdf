// SPDX-License-Identifier: Apache-2.0
// A file that appears as a whole or not at all: written beside its place under another name, and
// moved there at the end. Links are followed to the file they mean. What is no regular file (a
// device, a pipe, the program's own output) is written directly, nothing can be moved there.
// Tested by tests/harness/whole_file_test.cc
#pragma once

#include <filesystem>
#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

namespace prehend::harness {

/// Writes to an open file, and remembers what the system said when it could not.
class FileBuffer : public std::streambuf {
 public:
  FileBuffer();
  ~FileBuffer() override;
  FileBuffer(const FileBuffer&) = delete;
  FileBuffer& operator=(const FileBuffer&) = delete;

  /// Takes the descriptor over.
  void Attach(int descriptor) { descriptor_ = descriptor; }
  /// 0, or the errno of the first write that failed.
  int Close();

 protected:
  int overflow(int character) override;
  int sync() override;

 private:
  std::vector<char> kept_;
  int descriptor_ = -1;
  int error_ = 0;
};

class WholeFile {
 public:
  /// The folder must exist; problem() says whether the file can be written there. A named pipe is
  /// waited for until somebody reads it.
  explicit WholeFile(const std::filesystem::path& path);
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
  void Fail(int error);

  std::filesystem::path named_;       ///< as the caller called it
  std::filesystem::path path_;        ///< what that means, links followed
  std::filesystem::path unfinished_;  ///< empty when the file is written directly
  FileBuffer buffer_;
  std::ostream stream_;
  std::string problem_;
};

/// "" or why a WholeFile cannot be written there; makes the folders above it, and leaves nothing
/// else behind. For asking before the work is done.
std::string WhyNotWritable(const std::filesystem::path& path);

/// Writes a file and the folders above it, as a whole or not at all. "" or what went wrong.
std::string WriteTextFile(const std::filesystem::path& path, std::string_view text);

}  // namespace prehend::harness
