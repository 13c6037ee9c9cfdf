// SPDX-License-Identifier: Apache-2.0
// A scenario under another name and in another folder, its comments and layout kept. Tested by
// tests/program/command_line_test.cc
#pragma once

#include <filesystem>
#include <string>

#include "harness/base/read_result.h"

namespace prehend::harness {

/// `text` of the scenario `from` as it has to stand in `to`: it says the name of that file, and
/// what lies beside `from`, its recordings, hands and grasps, is found from there. Complains about
/// YAML that cannot be read.
ReadResult<std::string> CopyOfScenario(const std::filesystem::path& from, const std::string& text,
                                       const std::filesystem::path& to);

}  // namespace prehend::harness
