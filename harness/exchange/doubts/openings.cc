// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/doubts/plausibility.h. Tested by tests/program/import_grip_test.cc
#include <fmt/format.h>

#include <algorithm>

#include "harness/exchange/doubts/plausibility.h"

namespace prehend::exchange {
namespace {

constexpr double kFarOut = 0.25;       ///< of the range, beyond its ends
constexpr double kHardlyMoves = 0.02;  ///< of the range

double BeyondEnds(const OpeningSeries::Sample& sample) {
  return std::max(-sample.open, sample.open - 1);
}

}  // namespace

OpeningDoubt JudgeOpening(const OpeningSeries& series, const Opening& said,
                          const std::string& file) {
  OpeningDoubt doubt;
  if (series.samples.empty()) return doubt;
  const auto value = [&](const OpeningSeries::Sample& sample) {
    return said.closed + sample.open * (said.open - said.closed);
  };
  const std::string range = fmt::format("of open {:g} and closed {:g}", said.open, said.closed);
  const auto far = std::ranges::count_if(series.samples, [](const OpeningSeries::Sample& sample) {
    return BeyondEnds(sample) > kFarOut;
  });
  if (far > 0) {
    const OpeningSeries::Sample& worst = *std::ranges::max_element(series.samples, {}, BeyondEnds);
    const std::string place = worst.line > 0 ? fmt::format("{}:{}", file, worst.line)
                                             : fmt::format("{}, {:.3f} s", file, worst.t_s);
    doubt.text = fmt::format(
        "{} of {} values of '{}' are more than a quarter of the range beyond 'open' or 'closed': "
        "{}: {:g}, {}",
        far, series.samples.size(), said.Names(), place, value(worst), range);
    doubt.hint = "is it another column, or another unit?";
    doubt.is_error = 2 * static_cast<std::size_t>(far) > series.samples.size();
    return doubt;
  }
  const auto [least, most] = std::ranges::minmax(series.samples, {}, &OpeningSeries::Sample::open);
  if (series.is_grip && most.open - least.open < kHardlyMoves)
    doubt.text = fmt::format(
        "'{}' hardly changes: from {:g} to {:g}, {}; is it another column, or another unit?",
        said.Names(), value(least), value(most), range);
  return doubt;
}

}  // namespace prehend::exchange
