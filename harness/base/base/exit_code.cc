// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/exit_code.h"

#include <algorithm>

namespace prehend {

ExitCode CodeOf(std::string_view text) {
  constexpr std::string_view kOfMachine[] = {"the disk is full",
                                             "is the disk full?",
                                             "another process is writing",
                                             "the file would become larger than it may",
                                             "No space left on device",
                                             "Disk quota exceeded",
                                             "disk I/O error",
                                             "Input/output error",
                                             "Too many open files",
                                             "Cannot allocate memory",
                                             "Resource temporarily unavailable",
                                             "no folder for temporary files",
                                             "its process ended",
                                             "File too large"};
  const bool is_of_machine = std::ranges::any_of(
      kOfMachine, [&](std::string_view why) { return text.find(why) != text.npos; });
  return is_of_machine ? ExitCode::kFailure : ExitCode::kBadInput;
}

}  // namespace prehend
