// SPDX-License-Identifier: Apache-2.0
#include "harness/oracle/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "harness/event_text.h"

namespace prehend::harness {

namespace {

using grammar::Interval;
using grammar::NamedEvent;
using grammar::Tick;

struct Events {
  std::vector<NamedEvent> truth, found;
};

struct Candidate {
  Tick offset = 0;  ///< of both boundaries together
  std::size_t truth = 0, found = 0;
  friend auto operator<=>(const Candidate&, const Candidate&) = default;
};

Tick LargerOffset(const Match& match) {
  return std::max(std::abs(match.begin_offset()), std::abs(match.end_offset()));
}

bool CanMatch(const Match& match, Tick collar) {
  const Interval &a = match.truth.interval, &b = match.found.interval;
  return std::max(a.begin, b.begin) < std::min(a.end, b.end) || LargerOffset(match) <= collar;
}

std::vector<Candidate> CandidatesOf(const Events& events, Tick collar) {
  std::vector<Candidate> candidates;
  for (std::size_t t = 0; t < events.truth.size(); ++t) {
    for (std::size_t f = 0; f < events.found.size(); ++f) {
      const Match match{events.truth[t], events.found[f]};
      if (CanMatch(match, collar))
        candidates.push_back({std::abs(match.begin_offset()) + std::abs(match.end_offset()), t, f});
    }
  }
  std::ranges::sort(candidates);
  return candidates;
}

std::vector<NamedEvent> LeftOver(const std::vector<NamedEvent>& events,
                                 const std::vector<bool>& taken) {
  std::vector<NamedEvent> rest;
  for (std::size_t i = 0; i < events.size(); ++i)
    if (!taken[i]) rest.push_back(events[i]);
  return rest;
}

LabelAgreement Pair(const std::string& label, const Events& events, Tick collar) {
  LabelAgreement agreement{.label = label};
  std::vector<bool> truth_taken(events.truth.size()), found_taken(events.found.size());
  for (const Candidate& candidate : CandidatesOf(events, collar)) {
    if (truth_taken[candidate.truth] || found_taken[candidate.found]) continue;
    truth_taken[candidate.truth] = found_taken[candidate.found] = true;
    agreement.matches.push_back({events.truth[candidate.truth], events.found[candidate.found]});
  }
  std::ranges::sort(agreement.matches, {},
                    [](const Match& match) { return match.truth.interval.begin; });
  agreement.missing = LeftOver(events.truth, truth_taken);
  agreement.extra = LeftOver(events.found, found_taken);
  return agreement;
}

}  // namespace

Agreement Agree(const grammar::Timeline& truth, const grammar::Timeline& found, Tick collar) {
  std::map<std::string, Events> by_label;
  for (const NamedEvent& event : truth.events) by_label[event.Label()].truth.push_back(event);
  for (const NamedEvent& event : found.events) by_label[event.Label()].found.push_back(event);
  Agreement agreement{.labels = {}, .ticks_per_second = truth.ticks_per_second};
  for (const auto& [label, events] : by_label)
    agreement.labels.push_back(Pair(label, events, collar));
  return agreement;
}

int Agreement::matched() const {
  int count = 0;
  for (const LabelAgreement& label : labels) count += static_cast<int>(label.matches.size());
  return count;
}

int Agreement::missing() const {
  int count = 0;
  for (const LabelAgreement& label : labels) count += static_cast<int>(label.missing.size());
  return count;
}

int Agreement::extra() const {
  int count = 0;
  for (const LabelAgreement& label : labels) count += static_cast<int>(label.extra.size());
  return count;
}

Tick Agreement::largest_offset() const {
  Tick largest = 0;
  for (const LabelAgreement& label : labels)
    for (const Match& match : label.matches) largest = std::max(largest, LargerOffset(match));
  return largest;
}

bool Agreement::Within(Tick tolerance) const {
  return missing() == 0 && extra() == 0 && largest_offset() <= tolerance;
}

std::string DescribeDisagreement(const Agreement& agreement, Tick tolerance) {
  const auto interval = [&](const NamedEvent& event) {
    return IntervalText(event.interval, agreement.ticks_per_second);
  };
  const auto ms = [&](Tick ticks) { return MillisecondsOf(ticks, agreement.ticks_per_second); };
  std::size_t width = 0;
  for (const LabelAgreement& label : agreement.labels) width = std::max(width, label.label.size());
  std::string text;
  for (const LabelAgreement& label : agreement.labels) {
    for (const Match& match : label.matches)
      if (LargerOffset(match) > tolerance)
        text += fmt::format("off      {:{}}  true {}  found {}  begin {:+.1f} ms, end {:+.1f} ms\n",
                            label.label, width, interval(match.truth), interval(match.found),
                            ms(match.begin_offset()), ms(match.end_offset()));
    for (const NamedEvent& event : label.missing)
      text += fmt::format("missing  {:{}}  true {}\n", label.label, width, interval(event));
    for (const NamedEvent& event : label.extra)
      text += fmt::format("extra    {:{}}  found {}\n", label.label, width, interval(event));
  }
  return text;
}

}  // namespace prehend::harness
