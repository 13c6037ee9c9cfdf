// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes as a file of labels, of the format that the first byte names. What is
// read has a place in the file. How to run it is in CONTRIBUTING.md.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "harness/exchange/labels/read_labels.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prehend;
  using namespace prehend::exchange;
  if (size == 0) return 0;
  LabelFile file{.file = "labels",
                 .text = std::string(reinterpret_cast<const char*>(data) + 1, size - 1),
                 .labels = {}};
  switch (data[0] % 3) {
    case 0:
      (void)ReadCsvLabels(file);
      break;
    case 1:
      (void)ReadEafLabels(file);
      break;
    default:
      (void)ReadTextGridLabels(file);
  }
  for (const Label& label : file.labels) {
    if (label.text.empty() || label.place.line < 1) std::abort();
  }
  return 0;
}
