// SPDX-License-Identifier: Apache-2.0
// What looks wrong in the numbers that say how far a gripper or a joint is open. Tested by
// tests/program/import_grip_test.cc
#pragma once

#include <string>

#include "harness/exchange/poses/pose_file.h"

namespace prehend::exchange {

struct OpeningDoubt {
  std::string text;  ///< "": nothing looks wrong
  std::string hint;
  bool is_error = false;
};

/// Values far beyond open and closed: of the most an error, of some a warning. A gripper that
/// hardly moves is a warning, too. `file`: what messages call the file.
OpeningDoubt JudgeOpening(const OpeningSeries& series, const Opening& said,
                          const std::string& file);

}  // namespace prehend::exchange
