// SPDX-License-Identifier: Apache-2.0
// The compiler and its flags come from harness/CMakeLists.txt.
#include "harness/base/base/content_hash.h"

#include <fmt/format.h>
#include <link.h>
#include <sys/stat.h>
#include <xxhash.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>

namespace prehend {
namespace {

/// For dl_iterate_phdr: adds "path size seconds" of one library. Its bytes would take too long.
int AddLibrary(dl_phdr_info* info, std::size_t, void* text) {
  struct stat status {};
  if (info->dlpi_name && *info->dlpi_name && stat(info->dlpi_name, &status) == 0) {
    *static_cast<std::string*>(text) +=
        fmt::format("{} {} {}\n", info->dlpi_name, status.st_size, status.st_mtim.tv_sec);
  }
  return 0;
}

}  // namespace

std::string ContentHash(std::string_view bytes) {
  return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()));
}

std::uint64_t ContentHashAt(std::uint64_t place, std::string_view bytes) {
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), place);
}

std::string FileHash(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return kNoFile;
  std::ifstream file(path, std::ios::binary);
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(),
                                                                       XXH3_freeState);
  XXH3_64bits_reset(state.get());
  std::array<char, 1 << 16> bytes;  // a file may be larger than the memory
  while (file.read(bytes.data(), bytes.size()), file.gcount() > 0)
    XXH3_64bits_update(state.get(), bytes.data(), static_cast<std::size_t>(file.gcount()));
  if (!file.is_open() || file.bad()) return kNoFile;
  return fmt::format("{:016x}", XXH3_64bits_digest(state.get()));
}

FileHashes HashFiles(const std::vector<std::string>& paths) {
  FileHashes hashes;
  for (const std::string& path : paths) hashes[path] = FileHash(path);
  return hashes;
}

std::string ProgramHash() {
  static const std::string hash = [] {
    std::string libraries;
    dl_iterate_phdr(AddLibrary, &libraries);
    return ContentHash(FileHash("/proc/self/exe") + libraries);
  }();
  return hash;
}

std::string BuildText() { return PREHEND_BUILD; }

}  // namespace prehend
