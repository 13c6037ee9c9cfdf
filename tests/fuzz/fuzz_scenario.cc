// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes as a scenario. How to run it is in CONTRIBUTING.md.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "harness/read/read_scenario.h"
#include "harness/run/find_scenario.h"
#include "harness/run/project_library.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prehend::harness;
  static const ScenarioLibrary library = ProjectLibrary(PREHEND_SOURCE_DIR);
  const auto read = ReadScenarioText(
      "fuzz.yaml", std::string(reinterpret_cast<const char*>(data), size), {}, library);
  if (!read && ErrorsOf(read).empty()) std::abort();  // refused without a word
  (void)Format(ErrorsOf(read));
  return 0;
}
