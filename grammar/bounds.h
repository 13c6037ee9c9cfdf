// SPDX-License-Identifier: Apache-2.0
// What the parts of an `and` say about the same value: `speed(x) > 5 cm/s and speed(x) < 3 cm/s` is never true, and
// whoever writes it made a mistake. Compares values by how they are written, so it misses what is the same in other words.
// Tested by tests/grammar/compile_test.cc
#pragma once

#include <map>
#include <string>

#include "grammar/program.h"

namespace prehend::grammar {

class Bounds {
 public:
  explicit Bounds(const Program& program) : program_(program) {}

  /// Adds what must be so for this truth value to be true. False: it contradicts what was added before.
  bool Add(int node, bool negated = false);

 private:
  struct Limit {
    double low;
    double high;
    bool low_open = false;
    bool high_open = false;
  };
  bool Narrow(const std::string& value, Op op, double number);

  const Program& program_;
  std::map<std::string, Limit> limits_;
};

}  // namespace prehend::grammar
