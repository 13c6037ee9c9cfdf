// SPDX-License-Identifier: Apache-2.0
// A scenario under another name and in another folder, its comments and layout kept. Tested by
// tests/program/command_line_test.cc
#pragma once

#include <filesystem>
#include <string>

#include "harness/base/base/result.h"

namespace prehend::scenario {

/// `text` of the scenario `from`, changed for the file `to`: its name is that of the new file, and
/// the paths of its recordings, hands and grasps are relative to the new folder. On failure: the
/// errors of the YAML.
Result<std::string> CopyOfScenario(const std::filesystem::path& from, const std::string& text,
                                   const std::filesystem::path& to);

}  // namespace prehend::scenario
