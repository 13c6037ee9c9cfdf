// SPDX-License-Identifier: Apache-2.0
#include "harness/truth/timeline/match_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>

#include "harness/truth/timeline/event_text.h"

namespace prehend::truth {
namespace {

using grammar::Interval;
using grammar::NamedEvent;
using grammar::Tick;

struct Indices {
  std::vector<std::size_t> expected, actual;
};

Tick Overlap(Interval a, Interval b) { return std::min(a.end, b.end) - std::max(a.begin, b.begin); }

Tick LargerOffset(Interval a, Interval b) {
  return std::max(std::abs(a.begin - b.begin), std::abs(a.end - b.end));
}

bool MayMatch(Interval a, Interval b, const MatchPolicy& policy) {
  return Overlap(a, b) > -policy.max_gap || LargerOffset(a, b) <= policy.collar;
}

/// Of a set of pairs: first how many, then how close.
struct Quality {
  int pairs = 0;
  Tick distance = 0;
  bool BetterThan(const Quality& other) const {
    return pairs != other.pairs ? pairs > other.pairs : distance < other.distance;
  }
};

/// The alignment of the events of one label: `best` of (i, j) is the best that can be done with the
/// expected ones from the i-th and the actual ones from the j-th on (Needleman and Wunsch 1970).
class Alignment {
 public:
  Alignment(std::span<const NamedEvent> expected, std::span<const NamedEvent> actual,
            const Indices& indices, const MatchPolicy& policy)
      : expected_(expected),
        actual_(actual),
        indices_(indices),
        policy_(policy),
        best_(Rows() + 1, std::vector<Quality>(Columns() + 1)) {
    for (std::size_t i = Rows(); i-- > 0;) {
      for (std::size_t j = Columns(); j-- > 0;) {
        best_[i][j] =
            best_[i][j + 1].BetterThan(best_[i + 1][j]) ? best_[i][j + 1] : best_[i + 1][j];
        if (MayPair(i, j) && !best_[i][j].BetterThan(WithPair(i, j))) best_[i][j] = WithPair(i, j);
      }
    }
  }

  LabelMatches Take(std::string label) const {
    LabelMatches matches{.label = std::move(label)};
    std::size_t i = 0, j = 0;
    while (i < Rows() || j < Columns()) {
      if (i < Rows() && j < Columns() && MayPair(i, j) && !best_[i][j].BetterThan(WithPair(i, j))) {
        matches.pairs.push_back({indices_.expected[i++], indices_.actual[j++]});
      } else if (i < Rows() && (j == Columns() || !best_[i][j].BetterThan(best_[i + 1][j]))) {
        matches.only_expected.push_back(indices_.expected[i++]);
      } else {
        matches.only_actual.push_back(indices_.actual[j++]);
      }
    }
    return matches;
  }

 private:
  std::size_t Rows() const { return indices_.expected.size(); }
  std::size_t Columns() const { return indices_.actual.size(); }
  Interval Expected(std::size_t i) const { return expected_[indices_.expected[i]].interval; }
  Interval Actual(std::size_t j) const { return actual_[indices_.actual[j]].interval; }

  bool MayPair(std::size_t i, std::size_t j) const {
    return MayMatch(Expected(i), Actual(j), policy_);
  }

  Quality WithPair(std::size_t i, std::size_t j) const {
    const Interval a = Expected(i), b = Actual(j);
    const Quality rest = best_[i + 1][j + 1];
    return {rest.pairs + 1, rest.distance + std::abs(a.begin - b.begin) + std::abs(a.end - b.end)};
  }

  std::span<const NamedEvent> expected_, actual_;
  const Indices& indices_;
  const MatchPolicy policy_;
  std::vector<std::vector<Quality>> best_;
};

struct Range {
  Tick earliest = std::numeric_limits<Tick>::max(), latest = std::numeric_limits<Tick>::min();

  void Add(Tick tick) {
    earliest = std::min(earliest, tick);
    latest = std::max(latest, tick);
  }
  bool IsKnown() const { return earliest <= latest; }
  Tick Nearest(Tick tick) const { return std::clamp(tick, earliest, latest); }
};

struct Allowed {
  Range begin, end;
};

bool Overlaps(const NamedEvent& a, const NamedEvent& b) {
  return a.interval.begin < b.interval.end && b.interval.begin < a.interval.end;
}

}  // namespace

std::vector<LabelMatches> MatchEvents(std::span<const NamedEvent> expected,
                                      std::span<const NamedEvent> actual,
                                      const MatchPolicy& policy) {
  std::map<std::string, Indices> by_label;
  for (std::size_t i = 0; i < expected.size(); ++i)
    by_label[expected[i].Label()].expected.push_back(i);
  for (std::size_t j = 0; j < actual.size(); ++j) by_label[actual[j].Label()].actual.push_back(j);
  std::vector<LabelMatches> matches;
  for (const auto& [label, indices] : by_label)
    matches.push_back(Alignment(expected, actual, indices, policy).Take(label));
  return matches;
}

Agreement Agree(const grammar::Timeline& truth, const grammar::Timeline& found, Tick collar) {
  Agreement agreement{.ticks_per_second = truth.ticks_per_second};
  for (LabelMatches& matches : MatchEvents(truth.events, found.events, {.collar = collar})) {
    LabelAgreement& label = agreement.labels.emplace_back();
    label.label = std::move(matches.label);
    for (const auto& [t, f] : matches.pairs)
      label.matches.push_back({truth.events[t], found.events[f]});
    for (const std::size_t t : matches.only_expected) label.missing.push_back(truth.events[t]);
    for (const std::size_t f : matches.only_actual) label.extra.push_back(found.events[f]);
  }
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
    for (const Match& match : label.matches)
      largest = std::max(largest, LargerOffset(match.truth.interval, match.found.interval));
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
      if (LargerOffset(match.truth.interval, match.found.interval) > tolerance)
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

Agreement AgreeWithin(std::span<const grammar::Timeline> possible, const grammar::Timeline& found,
                      Tick collar) {
  Agreement agreement{.ticks_per_second = found.ticks_per_second};
  if (possible.empty()) return agreement;
  std::vector<Allowed> allowed(found.events.size());
  std::map<std::string, LabelAgreement> labels;
  // By label, what every timeline so far has and what was not found.
  std::map<std::string, std::vector<NamedEvent>> missing;
  for (const grammar::Timeline& truth : possible) {
    const bool first = &truth == &possible.front();
    std::map<std::string, std::vector<NamedEvent>> missing_here;
    for (const LabelMatches& matches :
         MatchEvents(truth.events, found.events, {.collar = collar})) {
      for (const auto& [t, f] : matches.pairs) {
        allowed[f].begin.Add(truth.events[t].interval.begin);
        allowed[f].end.Add(truth.events[t].interval.end);
      }
      for (const std::size_t t : matches.only_expected) {
        if (truth.events[t].interval.end - truth.events[t].interval.begin > collar)
          missing_here[matches.label].push_back(truth.events[t]);
      }
    }
    if (first) {
      missing = std::move(missing_here);
      continue;
    }
    for (auto& [label, events] : missing) {
      const std::vector<NamedEvent>& here = missing_here[label];
      std::erase_if(events, [&](const NamedEvent& event) {
        return std::ranges::none_of(
            here, [&](const NamedEvent& other) { return Overlaps(event, other); });
      });
    }
  }
  for (std::size_t f = 0; f < found.events.size(); ++f) {
    const NamedEvent& event = found.events[f];
    LabelAgreement& label = labels[event.Label()];
    if (!allowed[f].begin.IsKnown()) {
      label.extra.push_back(event);
      continue;
    }
    NamedEvent truth = event;
    truth.interval = {allowed[f].begin.Nearest(event.interval.begin),
                      allowed[f].end.Nearest(event.interval.end)};
    label.matches.push_back({std::move(truth), event});
  }
  for (auto& [name, events] : missing) {
    if (!events.empty()) labels[name].missing = std::move(events);
  }
  for (auto& [name, label] : labels) {
    label.label = name;
    agreement.labels.push_back(std::move(label));
  }
  return agreement;
}

}  // namespace prehend::truth
