// SPDX-License-Identifier: Apache-2.0
// prehend: see harness/cli/cli/command_line.h.
#include "harness/cli/cli/command_line.h"

int main(int argc, char** argv) {
  return static_cast<int>(prehend::cli::RunCommandLine(argc, argv));
}
