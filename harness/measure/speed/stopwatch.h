// SPDX-License-Identifier: Apache-2.0
// Processor time, not wall time, because other programs may run on this machine.
// Tested by tests/bench/workload_test.cc
#pragma once

#include <ctime>

namespace prehend::measure {

class Stopwatch {
 public:
  void Restart() { begin_ = std::clock(); }
  double seconds() const { return static_cast<double>(std::clock() - begin_) / CLOCKS_PER_SEC; }

 private:
  std::clock_t begin_ = std::clock();
};

}  // namespace prehend::measure
