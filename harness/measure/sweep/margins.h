// SPDX-License-Identifier: Apache-2.0
// How far each parameter of a grammar may be from its value before the score drops. Tested by
// tests/program/sweep_test.cc
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/measure/sweep/sweep.h"

namespace prehend::measure {

/// One parameter, while the others keep their values.
struct Margin {
  std::string parameter, value;
  double f1 = 0;         ///< with its value
  std::string from, to;  ///< the range around the value in which F1 is within the distance of the
                         ///< best; empty: the value is not in such a range
  bool open_below = false, open_above = false;  ///< it holds as far as was tried
  double best = 0;
  std::string best_at;
  bool has_effect = false;  ///< some value that was tried has another F1
  bool near_edge = false;   ///< the next value that was tried, a fifth away, is out of the range
};

struct Margins {
  std::vector<Margin> margins;       ///< those with the smallest range first
  std::vector<std::string> without;  ///< parameters that are zero, and were not tried
  SweepResult sweep;                 ///< its episodes, and what was left out
};

/// Tries an eighth to eight times of each value, in steps of 19 or 41 percent. `within` is a share
/// of F1; `only` these parameters, all if there are none. `request.axes` is not used.
/// `so_far` is called with the result as it is after each parameter.
Result<Margins> FindMargins(const std::vector<episode::Take>& takes, SweepRequest request,
                            double within, const std::vector<std::string>& only = {},
                            const std::function<void(const Margins&)>& so_far = {});

std::string MarginsText(const Margins& margins, double within);
std::string MarginsCsv(const Margins& margins);

}  // namespace prehend::measure
