// SPDX-License-Identifier: Apache-2.0
// Which files this process reads, or was told to: what people wrote must not be replaced by what
// a command makes of it (AtomicFile). Tested by tests/harness/base/base/atomic_file_test.cc
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace prehend {

/// Nothing is kept of what is no regular file. May be called by any thread.
void RememberInput(const std::filesystem::path& path);

/// What was remembered since the last call, to be told to the process that this one reads for.
std::string TakeNewInputs();
/// Of a text that begins with what TakeNewInputs() returned. Returns what follows.
std::string_view RememberInputs(std::string_view told);

/// To read a file, which is remembered.
std::ifstream OpenInput(const std::string& path);

/// `path` names a file that was remembered, by this name or another (a link), and that is still
/// where it was read.
bool IsInput(const std::filesystem::path& path);

}  // namespace prehend
