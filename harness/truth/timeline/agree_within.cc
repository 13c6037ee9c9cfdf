// SPDX-License-Identifier: Apache-2.0
#include "harness/truth/timeline/agree_within.h"

#include <algorithm>
#include <limits>
#include <map>

namespace prehend::truth {

namespace {

using grammar::NamedEvent;
using grammar::Tick;

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

Agreement AgreeWithin(std::span<const grammar::Timeline> possible, const grammar::Timeline& found,
                      Tick collar) {
  Agreement agreement{.labels = {}, .ticks_per_second = found.ticks_per_second};
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
