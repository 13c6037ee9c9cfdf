// SPDX-License-Identifier: Apache-2.0
// Commands as they can be pasted into a shell. Tested by
// tests/harness/base/base/shell_quote_test.cc and tests/program/command_line_test.cc
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace prehend {

/// A word that can be pasted into a POSIX shell: in single quotes if it needs them.
std::string ShellQuoted(std::string_view word);

/// How the program was called, for commands that it prints: $PREHEND_COMMAND, which ./run sets,
/// otherwise "prehend".
std::string ProgramName();

/// A command of this program: {"run", "a b"} is "prehend run 'a b'".
std::string CommandText(const std::vector<std::string>& words);

}  // namespace prehend
