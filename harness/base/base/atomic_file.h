// SPDX-License-Identifier: Apache-2.0
// A file that appears as a whole or not at all: it is written without a name (or, where the file
// system has no such files, beside its place under another name) and gets its name at the end.
// Tested by tests/harness/base/base/atomic_file_test.cc
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace prehend {

/// What may be replaced: an input (IsInput()) only where a file is brought up to date.
enum class Over { kNoInput, kAnything };

/// In what AtomicFile says of an output that is an input: the user's mistake, no failure.
inline constexpr std::string_view kIsRead = "it is what is read";
/// Messages about a file that is not as it was written say this, and are about the input.
inline constexpr std::string_view kIsDamaged = "the file is damaged";

/// Replaces only regular files, and follows a link to one. It is not synchronised to the disk: it
/// is safe from a crash of the program, not from a power cut.
class AtomicFile {
 public:
  /// Creates the folders above it. "-" is standard output, which is written directly.
  explicit AtomicFile(const std::filesystem::path& path, Over over = Over::kNoInput);
  /// Without Commit() an older file is as it was.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream() { return *stream_; }

  /// Empty, or why the file cannot be written.
  const std::string& problem() const { return problem_; }

  /// Moves the file to its place. Returns "", or what went wrong; then an older file is as it was.
  std::string Commit();

 private:
  void ForgetNameless();
  std::string WhyInput() const;

  std::filesystem::path path_;  ///< as the caller named it
  Over over_;
  std::filesystem::path target_;      ///< what it is after links
  std::filesystem::path unfinished_;  ///< beside the target; empty for standard output
  int nameless_ = -1;  ///< the file while it has no name, which a killed process leaves nothing of
  std::ofstream file_;
  std::ostream* stream_ = &file_;
  std::string problem_;
};

/// While it lives, another one for the same folder waits. Without the folder it locks nothing.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int folder_ = -1;
};

/// A name that stays in its folder, whatever the text is: of ASCII, letters,
/// digits, '-' and '.' stay, the rest and a '.' at the begin become '_'; at most 180 bytes.
std::string FileNameOf(std::string_view text);

/// Creates the folders above this path. Empty, or why that is not possible.
std::string MakeFolderOf(const std::filesystem::path& path);

/// Empty, or why an AtomicFile cannot be written there; creates the folders above it. For asking
/// before long work.
std::string WhyNotWritable(const std::filesystem::path& path);

/// Writes a file, and creates the folders above it. Returns "", or what went wrong; then an older
/// file is as it was.
std::string WriteTextFile(const std::filesystem::path& path, std::string_view text,
                          Over over = Over::kNoInput);

// A folder of one's own among the temporary files, removed with all that is in it. Tested by
// tests/harness/base/base/temporary_folder_test.cc

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

/// Those of processes that were killed.
void RemoveLeftFolders();

}  // namespace prehend
