// SPDX-License-Identifier: Apache-2.0
// Time of the processor, not of the wall: others may use this machine, too.
// Tested by tests/harness/speed/workload_test.cc
#pragma once

#include <ctime>

namespace prehend::harness {

class Stopwatch {
 public:
  void Restart() { begin_ = std::clock(); }
  double seconds() const { return static_cast<double>(std::clock() - begin_) / CLOCKS_PER_SEC; }

 private:
  std::clock_t begin_ = std::clock();
};

}  // namespace prehend::harness
