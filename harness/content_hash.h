// SPDX-License-Identifier: Apache-2.0
// What a file holds, and which program runs, as short texts: equal texts mean that nothing changed.
// Tested by tests/harness/check_records_test.cc
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace prehend::harness {

/// FNV-1a of 64 bit, 16 hexadecimal digits. Protects against mistakes, not against attackers.
std::string ContentHash(std::string_view bytes);

/// Hash of a file that is not there or cannot be read.
inline constexpr const char* kNoFile = "none";

/// Of a file's bytes, or kNoFile.
std::string FileHash(const std::string& path);

using FileHashes = std::map<std::string, std::string>;  ///< path -> FileHash(path)
FileHashes HashFiles(const std::vector<std::string>& paths);

/// Of the running program: its own bytes, and size and date of the libraries that it is linked
/// with.
std::string ProgramHash();

}  // namespace prehend::harness
