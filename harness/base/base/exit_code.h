// SPDX-License-Identifier: Apache-2.0
// How the program ends. Scripts rely on these numbers. Tested by tests/program/command_line_test.cc
#pragma once

#include <string_view>

namespace prehend {

enum class ExitCode {
  kAgrees = 0,
  kDiffers = 1,   ///< an event differs from its golden, or an invariant is violated
  kBadInput = 2,  ///< an error in a file or in the command line
  kFailure = 3,   ///< the simulation failed, or the program itself
  kNothing = 4,   ///< nothing was selected or found
  kPending = 5,   ///< goldens wait for acceptance
};

/// Of a problem told by `text`: what the machine lacks now (room, descriptors, memory) is no bad
/// input.
ExitCode CodeOf(std::string_view text);

}  // namespace prehend
