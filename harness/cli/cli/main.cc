// SPDX-License-Identifier: Apache-2.0
// prehend: see harness/cli/cli/command_line.h.
#include <malloc.h>

#include "harness/cli/cli/command_line.h"

/// " (COMMIT)", or "" of a source tree without history; of harness/install/commit.cmake.
extern const char* const kPrehendCommit;

int main(int argc, char** argv) {
  // What one setting or episode gives back is for the next one: to have pages cleared anew is slow.
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
  return static_cast<int>(prehend::cli::RunCommandLine(argc, argv, kPrehendCommit));
}
