// SPDX-License-Identifier: Apache-2.0
// The content of a file and the identity of the running program as short texts: equal texts mean
// that nothing changed. (The hash of a physical state is another one: physics/scene/snapshot.h.)
// How this program was compiled. Tested by tests/harness/base/base/content_hash_test.cc,
// tests/harness/suite/check/attribute_run_test.cc and tests/program/golden_workflow_test.cc
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace prehend {

/// XXH3 of 64 bits as 16 hexadecimal digits. Protects against mistakes, not against attackers.
std::string ContentHash(std::string_view bytes);
/// The same as a number; another one for the same bytes in another place.
std::uint64_t ContentHashAt(std::uint64_t place, std::string_view bytes);

/// The hash of a file that does not exist or cannot be read.
inline constexpr const char* kNoFile = "none";

/// The hash of a file's bytes, or kNoFile.
std::string FileHash(const std::string& path);

using FileHashes = std::map<std::string, std::string>;  ///< path -> FileHash(path)
FileHashes HashFiles(const std::vector<std::string>& paths);

/// The hash of the running program: of its bytes, and of size and date of each shared library.
std::string ProgramHash();

/// Compiler, processor and flags: "GNU 12.2.0, x86_64, -O2". Another build may round differently.
std::string BuildText();

}  // namespace prehend
