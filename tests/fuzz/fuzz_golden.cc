// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes as a golden. What can be read is written as it was read. How to run
// it is in CONTRIBUTING.md.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "harness/truth/golden/golden.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prehend;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const Result<truth::Golden> read = truth::ReadGolden("fuzz.timeline", text);
  if (!read) {
    if (ErrorsOf(read).empty()) std::abort();  // refused without a word
    (void)Format(ErrorsOf(read));
    return 0;
  }
  const Result<truth::Golden> again =
      truth::ReadGolden("again.timeline", truth::WriteGolden(*read));
  if (!again || !(*again == *read)) std::abort();  // something is lost
  return 0;
}
