// SPDX-License-Identifier: Apache-2.0
// prehend: see harness/cli/cli/command_line.h.
#include "harness/cli/cli/command_line.h"

/// " (COMMIT)", or "" of a source tree without history; of harness/install/commit.cmake.
extern const char* const kPrehendCommit;

int main(int argc, char** argv) {
  return static_cast<int>(prehend::cli::RunCommandLine(argc, argv, kPrehendCommit));
}
