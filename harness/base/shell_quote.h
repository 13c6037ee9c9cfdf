// SPDX-License-Identifier: Apache-2.0
// Quoting for shells. Tested by tests/harness/base/shell_quote_test.cc
#pragma once

#include <string>
#include <string_view>

namespace prehend::harness {

/// A word that can be pasted into a POSIX shell: in single quotes if it needs them.
std::string ShellQuoted(std::string_view word);

}  // namespace prehend::harness
