// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/labels/clock_offset.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace prehend::exchange {
namespace {

constexpr double kMost_s = 5, kStep_s = 0.05;
/// A smaller one is how people mark.
constexpr double kLeast_s = 0.2;
constexpr int kLeastGain = 3;
constexpr double kLeastGainShare = 0.2;  ///< of all labels

struct Seconds {
  double begin_s = 0, end_s = 0;
};

double Share(const Seconds& a, const Seconds& b) {
  const double both = std::min(a.end_s, b.end_s) - std::max(a.begin_s, b.begin_s);
  return both / (std::max(a.end_s, b.end_s) - std::min(a.begin_s, b.begin_s));
}

/// The labels of one name and roles in one recording, and what was recognised of these, which does
/// not overlap.
struct Pair {
  std::vector<Seconds> marked, recognised;

  /// How many of the labels are found if they were so much later; adds how far these begin from
  /// what was recognised, moved and not.
  int Found(double offset_s, double* moved_s = nullptr, double* now_s = nullptr) const {
    int found = 0;
    for (Seconds label : marked) {
      const double begin_s = label.begin_s;
      label.begin_s += offset_s;
      label.end_s += offset_s;
      // What shares half of the union has the middle of both.
      const double middle_s = (label.begin_s + label.end_s) / 2;
      const auto at = std::ranges::lower_bound(recognised, middle_s, {}, &Seconds::end_s);
      if (at == recognised.end() || Share(label, *at) < 0.5) continue;
      ++found;
      if (moved_s) *moved_s += std::abs(label.begin_s - at->begin_s);
      if (now_s) *now_s += std::abs(begin_s - at->begin_s);
    }
    return found;
  }
};

}  // namespace

std::optional<ClockOffset> FindClockOffset(
    std::span<const std::pair<grammar::Timeline, grammar::Timeline>> recordings) {
  std::vector<Pair> pairs;
  ClockOffset best;
  for (const auto& [truth, recognised] : recordings) {
    const auto seconds = [](const grammar::NamedEvent& event, grammar::Tick per_s) {
      return Seconds{static_cast<double>(event.interval.begin) / static_cast<double>(per_s),
                     static_cast<double>(event.interval.end) / static_cast<double>(per_s)};
    };
    std::map<std::string, Pair> by_label;
    for (const grammar::NamedEvent& event : truth.events)
      by_label[event.Label()].marked.push_back(seconds(event, truth.ticks_per_second));
    for (const grammar::NamedEvent& event : recognised.events)
      by_label[event.Label()].recognised.push_back(seconds(event, recognised.ticks_per_second));
    for (auto& [label, pair] : by_label) {
      std::ranges::sort(pair.recognised, {}, &Seconds::begin_s);
      best.all += static_cast<int>(pair.marked.size());
      pairs.push_back(std::move(pair));
    }
  }
  const auto found = [&](double offset_s) {
    int sum = 0;
    for (const Pair& pair : pairs) sum += pair.Found(offset_s);
    return sum;
  };
  best.found_now = best.found_then = found(0);
  double first_s = 0, last_s = 0;  // of the offsets in a row that are best
  const int steps = static_cast<int>(std::lround(kMost_s / kStep_s));
  bool is_best_yet = false;
  for (int i = -steps; i <= steps; ++i) {
    const double offset_s = i * kStep_s;
    const int count = found(offset_s);
    if (count > best.found_then) {
      best.found_then = count;
      first_s = last_s = offset_s;
      is_best_yet = true;
    } else if (count == best.found_then && is_best_yet) {
      last_s = offset_s;
    } else {
      is_best_yet = false;
    }
  }
  best.offset_s = std::round((first_s + last_s) / 2 / kStep_s) * kStep_s;
  const int gain = best.found_then - best.found_now;
  if (gain < kLeastGain || gain < kLeastGainShare * best.all || std::abs(best.offset_s) < kLeast_s)
    return std::nullopt;
  // Where only the ends come late, moving makes the begins worse: that is no other clock.
  double moved_s = 0, now_s = 0;
  for (const Pair& pair : pairs) pair.Found(best.offset_s, &moved_s, &now_s);
  if (moved_s > now_s) return std::nullopt;
  return best;
}

}  // namespace prehend::exchange
