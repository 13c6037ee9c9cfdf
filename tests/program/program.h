// SPDX-License-Identifier: Apache-2.0
// Runs the built program as a user would, and keeps what it said.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace prehend::house {

struct Said {
  int exit_code = -1;  ///< 128 + signal when killed
  std::string out;
  std::string err;
};

/// `prehend ARGS` in the source tree. The binary is this build's, or the one PREHEND_BINARY names
/// (sanitizers). `environment` holds NAME=value pairs on top of the present ones; `first` is done
/// in the same shell before ("ulimit -f 10").
Said Prehend(const std::vector<std::string>& arguments,
             const std::vector<std::string>& environment = {}, const std::string& first = {});

/// A folder of its own for one test, emptied first.
std::filesystem::path FreshFolder(const std::string& name);

void WriteFile(const std::filesystem::path& path, const std::string& text);
std::string ReadFile(const std::filesystem::path& path);

/// Replaces the only occurrence of `from`; fails the test when there is none or more than one.
std::string Replaced(std::string text, const std::string& from, const std::string& to);

}  // namespace prehend::house
