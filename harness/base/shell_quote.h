// SPDX-License-Identifier: Apache-2.0
// Tested by tests/program/command_line_test.cc
#pragma once

#include <string>
#include <string_view>

namespace prehend::harness {

/// A word as it can be pasted into a shell: in quotes when it needs them.
std::string ShellQuoted(std::string_view word);

}  // namespace prehend::harness
