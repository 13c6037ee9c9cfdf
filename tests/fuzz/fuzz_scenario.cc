// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes as a scenario. How to run it is in CONTRIBUTING.md.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "harness/episode/run/find_scenario.h"
#include "harness/scenario/read/read_scenario.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prehend;
  static const scenario::ScenarioLibrary library = episode::ProjectLibrary(PREHEND_SOURCE_DIR);
  const auto read = scenario::ReadScenarioText(
      "fuzz.yaml", std::string(reinterpret_cast<const char*>(data), size), {}, library);
  if (!read && ErrorsOf(read).empty()) std::abort();  // refused without a word
  (void)Format(ErrorsOf(read));
  return 0;
}
