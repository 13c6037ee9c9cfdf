// SPDX-License-Identifier: Apache-2.0
// A comparison in words. Tested by tests/harness/compare_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/compare.h"
#include "harness/event_text.h"

namespace prehend::harness {
namespace {

using grammar::Tick;

double Milliseconds(Tick ticks, Tick ticks_per_second) {
  return 1000.0 * static_cast<double>(ticks) / static_cast<double>(ticks_per_second);
}

/// "begin +50.0 ms, end -2.1 ms (tolerance 8.3 ms)"
std::string OffsetText(const Pairing& pairing, Tick ticks_per_second) {
  return fmt::format("begin {:+.1f} ms, end {:+.1f} ms (tolerance {:.1f} ms)",
                     Milliseconds(pairing.begin_offset, ticks_per_second),
                     Milliseconds(pairing.end_offset, ticks_per_second),
                     Milliseconds(pairing.tolerance, ticks_per_second));
}

std::string PairingText(const Pairing& pairing, Tick ticks_per_second, std::string_view command) {
  const auto side = [&](const std::optional<grammar::NamedEvent>& event) {
    return event ? IntervalText(event->interval, ticks_per_second) : std::string("nothing");
  };
  std::string text = fmt::format("{} {}\n", Name(pairing.agreement), pairing.event().Label());
  text +=
      fmt::format("  expected {}, recognised {}\n", side(pairing.expected), side(pairing.actual));
  if (pairing.expected && pairing.actual)
    text += fmt::format("  {}\n", OffsetText(pairing, ticks_per_second));
  if (!pairing.changes.empty()) text += fmt::format("  {}\n", fmt::join(pairing.changes, ", "));
  return text + fmt::format("  see: {}\n", command);
}

}  // namespace

std::string_view Name(LineVerdict agreement) {
  switch (agreement) {
    case LineVerdict::kMatched:
      return "matched";
    case LineVerdict::kShifted:
      return "shifted";
    case LineVerdict::kChanged:
      return "changed";
    case LineVerdict::kMissing:
      return "missing";
    case LineVerdict::kExtra:
      return "extra";
  }
  return "";
}

std::string DifferenceText(const Comparison& comparison, std::string_view command) {
  std::string text;
  for (const Pairing& pairing : comparison.pairings) {
    if (pairing.agreement == LineVerdict::kMatched) continue;
    text += PairingText(pairing, comparison.ticks_per_second, command);
  }
  return text;
}

std::string HeadroomText(const Comparison& comparison) {
  if (!comparison.tightest) return "";
  const Headroom& tightest = *comparison.tightest;
  const Tick left = tightest.tolerance - std::abs(tightest.offset);
  return fmt::format("headroom: {:.1f} of {:.1f} ms are left at {}",
                     Milliseconds(left, comparison.ticks_per_second),
                     Milliseconds(tightest.tolerance, comparison.ticks_per_second),
                     tightest.boundary);
}

}  // namespace prehend::harness
