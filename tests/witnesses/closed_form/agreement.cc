// SPDX-License-Identifier: Apache-2.0
// Tested by tests/witnesses/closed_form/agreement_test.cc
#include "tests/witnesses/closed_form/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/truth/timeline/match_events.h"

namespace prehend::witnesses {
namespace {

using grammar::NamedEvent;
using grammar::Tick;

/// Moments this close are the same: rounding of formulas.
constexpr double kSameMoment_ticks = 1e-6;

/// A label without the names of its roles; they have none on paper.
NamedEvent AsEvent(const KnownEvent& known, double rate_hz) {
  const std::size_t open = known.label.find('('), comma = known.label.find(", ", open);
  return {.event = known.label.substr(0, open),
          .roles = {{"", known.label.substr(open + 1, comma - open - 1)},
                    {"", known.label.substr(comma + 2, known.label.size() - comma - 3)}},
          .interval = {std::lround(known.begin_s * rate_hz), std::lround(known.end_s * rate_hz)}};
}

/// No frame lies between the two. The episode's begin and end count as frames.
bool WithinOneFrame(double expected_ticks, Tick recognised, const ClosedFormRecording& recording) {
  Tick before = 0, after = recording.end;
  for (const physics::Snapshot& frame : recording.frames) {
    const auto tick = static_cast<double>(frame.tick);
    if (tick < expected_ticks - kSameMoment_ticks) before = frame.tick;
    if (tick > expected_ticks + kSameMoment_ticks) after = std::min(after, frame.tick);
  }
  return before <= recognised && recognised <= after;
}

class Judge {
 public:
  explicit Judge(const ClosedFormRecording& recording)
      : recording_(recording), rate_hz_(recording.scenario.scene.world.rate_hz) {}

  JudgedBoundary Boundary(std::optional<double> expected_s, std::optional<Tick> recognised) const {
    JudgedBoundary boundary{.expected_s = expected_s};
    if (recognised) boundary.recognised_s = static_cast<double>(*recognised) / rate_hz_;
    boundary.right =
        expected_s && recognised && WithinOneFrame(*expected_s * rate_hz_, *recognised, recording_);
    return boundary;
  }

  JudgedEvent Event(const std::string& label, const KnownEvent* known,
                    const NamedEvent* found) const {
    std::optional<double> begin_s, end_s;
    std::optional<Tick> begin, end;
    if (known) begin_s = known->begin_s, end_s = known->end_s;
    if (found) begin = found->interval.begin, end = found->interval.end;
    return {label, Boundary(begin_s, begin), Boundary(end_s, end)};
  }

 private:
  const ClosedFormRecording& recording_;
  double rate_hz_;
};

std::string BoundaryText(const char* verb, const JudgedBoundary& boundary) {
  if (boundary.right) return fmt::format("{} {:.4f} s", verb, *boundary.expected_s);
  return fmt::format("{} {:.4f} s, recognised {:.4f} s ({:+.1f} ms)", verb, *boundary.expected_s,
                     *boundary.recognised_s, 1000 * boundary.OffsetS());
}

}  // namespace

std::vector<JudgedEvent> ClosedFormAgreement(const std::vector<KnownEvent>& truth,
                                             const ClosedFormRecording& recording,
                                             const grammar::Timeline& recognised) {
  const double rate_hz = recording.scenario.scene.world.rate_hz;
  std::vector<KnownEvent> known = truth;
  std::ranges::stable_sort(known, {}, &KnownEvent::begin_s);
  std::vector<NamedEvent> expected;
  for (const KnownEvent& event : known) expected.push_back(AsEvent(event, rate_hz));
  const Tick frame = std::lround(std::ceil(rate_hz / recording.scenario.sensing.sensing_hz));
  const Judge judge(recording);
  std::vector<JudgedEvent> judged;
  for (const truth::LabelMatches& label :
       truth::MatchEvents(expected, recognised.events, {.collar = 2 * frame})) {
    for (const auto& [e, a] : label.pairs)
      judged.push_back(judge.Event(label.label, &known[e], &recognised.events[a]));
    for (const std::size_t e : label.only_expected)
      judged.push_back(judge.Event(label.label, &known[e], nullptr));
    for (const std::size_t a : label.only_actual)
      judged.push_back(judge.Event(label.label, nullptr, &recognised.events[a]));
  }
  return judged;
}

int RightBoundaries(const std::vector<JudgedEvent>& events) {
  int right = 0;
  for (const JudgedEvent& event : events) right += event.begin.right + event.end.right;
  return right;
}

std::string WrongBoundaries(const std::vector<JudgedEvent>& events) {
  std::string text;
  for (const auto& [label, begin, end] : events) {
    if (begin.right && end.right) continue;
    if (!begin.recognised_s)
      text += fmt::format("{}: {:.4f}..{:.4f} s, not recognised\n", label, *begin.expected_s,
                          *end.expected_s);
    else if (!begin.expected_s)
      text += fmt::format("{}: there is none, recognised {:.4f}..{:.4f} s\n", label,
                          *begin.recognised_s, *end.recognised_s);
    else
      text += fmt::format("{}: {}; {}\n", label, BoundaryText("begins", begin),
                          BoundaryText("ends", end));
  }
  return text;
}

}  // namespace prehend::witnesses
