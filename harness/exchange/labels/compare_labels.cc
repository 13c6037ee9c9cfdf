// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/labels/label_map.h: what is compared, and what was counted. Tested by
// tests/harness/exchange/labels/labels_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <ranges>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "harness/exchange/labels/label_map.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::exchange {

grammar::Diagnostic SeveralTakes(const LabelFile& file, const std::string& take) {
  return file.At(
      {1, 1},
      fmt::format("the {} several values, and nothing says which rows are of '{}'",
                  file.several.size() == 1
                      ? fmt::format("column '{}' has", file.several.front())
                      : fmt::format("columns '{}' have", fmt::join(file.several, "' and '")),
                  take),
      fmt::format("in the map columns: {{take: {0}}}, if recordings are called as in it; or rows: "
                  "{{{0}: VALUE}} in a file of takes; or columns: {{take: ignore}}",
                  file.several.front()));
}

std::map<std::string, Moments> LabelReading::TakeMoments(std::size_t take,
                                                         const grammar::Timeline& truth,
                                                         grammar::Tick before,
                                                         grammar::Timeline& found) const {
  std::map<std::string, Moments> moments;
  std::set<std::size_t> explained;
  for (const LabelledEvent& label : events_[take]) {
    if (!label.IsMoment()) continue;
    grammar::NamedEvent one = label.event;
    std::erase_if(one.roles, [&](const grammar::Role& role) {
      return std::ranges::count(compared_.at(one.event), role.name) == 0;
    });
    const grammar::Tick at = truth::TickAt(label.begin_s, truth.ticks_per_second);
    Moments& counted = moments[one.event];
    ++counted.marked;
    counted.labels.emplace_back(label.begin_s, label.event);
    bool is_found = false;
    // One label excuses one event: the nearest that no other one excuses.
    std::optional<std::pair<grammar::Tick, std::size_t>> nearest;
    for (std::size_t i = 0; i < found.events.size(); ++i) {
      const grammar::NamedEvent& event = found.events[i];
      if (at < event.interval.begin - before || at >= event.interval.end ||
          event.Label() != one.Label())
        continue;
      is_found = true;
      const bool is_marked = std::ranges::any_of(truth.events, [&](const auto& other) {
        return other.Label() == event.Label() && other.interval.begin < event.interval.end &&
               event.interval.begin < other.interval.end;
      });
      const std::pair candidate(std::max<grammar::Tick>(0, event.interval.begin - at), i);
      if (!is_marked && !explained.contains(i) && (!nearest || candidate < *nearest))
        nearest = candidate;
    }
    if (nearest) explained.insert(nearest->second);
    counted.found += is_found ? 1 : 0;
  }
  for (auto at = explained.rbegin(); at != explained.rend(); ++at)
    found.events.erase(found.events.begin() + static_cast<std::ptrdiff_t>(*at));
  return moments;
}

namespace {

/// "7 rows of 2 other takes (P2, P3)"
std::string CountedText(const std::map<std::string, std::size_t>& counts, const char* row,
                        const std::string& what) {
  constexpr std::size_t kMostNamed = 8;
  std::size_t all = 0;
  std::vector<std::string> names;
  for (const auto& [name, count] : counts) {
    all += count;
    if (names.size() < kMostNamed) names.push_back(name);
  }
  if (counts.size() > kMostNamed) names.emplace_back("..");
  return all == 0
             ? ""
             : fmt::format("{} {} ({})", grammar::CountOf(all, row), what, fmt::join(names, ", "));
}

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

Counted& Counted::operator+=(const Counted& more) {
  takes += more.takes;
  labels += more.labels;
  moments += more.moments;
  cut += more.cut;
  merged += more.merged;
  without_text += more.without_text;
  for (const auto& [label, count] : more.ignored) ignored[label] += count;
  unread.insert(more.unread.begin(), more.unread.end());
  backward.insert(more.backward.begin(), more.backward.end());
  of_other_takes.insert(more.of_other_takes.begin(), more.of_other_takes.end());
  return *this;
}

std::size_t Counted::Backward() const {
  std::size_t all = 0;
  for (const auto& [file, count] : backward) all += count;
  return all;
}

std::map<std::string, std::size_t> Counted::OfOtherTakes() const {
  std::map<std::string, std::size_t> all;
  for (const auto& [file, by_take] : of_other_takes)
    for (const auto& [take, count] : by_take) all[take] += count;
  return all;
}

std::string Counted::Text() const {
  std::string text = fmt::format("counted: {} of {}", grammar::CountOf(labels, "label"),
                                 grammar::CountOf(takes, "take"));
  if (moments > 0) text += fmt::format(", and {} of a moment", moments);
  if (merged > 0) text += fmt::format("; {} became part of another", merged);
  if (cut > 0) text += fmt::format("; {} cut at an end of the recording", cut);
  std::vector<std::string> left_out = {
      CountedText(OfOtherTakes(), "row", "of other takes"),
      CountedText(ignored, "label", "without a meaning"),
      without_text > 0 ? grammar::CountOf(without_text, "label") + " without text" : "",
      Backward() > 0 ? grammar::CountOf(Backward(), "label") + " with an end before the begin" : "",
      unread.empty() ? ""
                     : fmt::format("{} not read ({})", grammar::CountOf(unread.size(), "column"),
                                   fmt::join(std::views::keys(unread), ", "))};
  std::erase(left_out, "");
  return text + "\n" +
         (left_out.empty() ? "" : fmt::format("left out: {}\n", fmt::join(left_out, "; ")));
}

grammar::Timeline Compared(const grammar::Timeline& timeline, const ComparedRoles& roles,
                           grammar::Tick join) {
  std::map<std::string, std::vector<grammar::NamedEvent>> by_label;
  for (grammar::NamedEvent event : timeline.events) {
    const auto compared = roles.find(event.event);
    if (compared == roles.end()) continue;
    std::erase_if(event.roles, [&](const grammar::Role& role) {
      return std::ranges::find(compared->second, role.name) == compared->second.end();
    });
    event.values.clear();
    by_label[event.Label()].push_back(std::move(event));
  }
  grammar::Timeline all{.ticks_per_second = timeline.ticks_per_second};
  for (auto& [label, events] : by_label) {
    std::ranges::sort(events, {}, [](const grammar::NamedEvent& event) {
      return std::pair(event.interval.begin, event.interval.end);
    });
    const std::size_t first = all.events.size();
    for (grammar::NamedEvent& event : events) {
      const bool follows = all.events.size() > first;
      if (follows &&
          (event.interval.begin < all.events.back().interval.end ||
           (join > 0 && event.interval.begin <= all.events.back().interval.end + join))) {
        grammar::NamedEvent& before = all.events.back();
        before.interval.end = std::max(before.interval.end, event.interval.end);
        before.decided = std::max(before.decided, event.decided);
      } else {
        all.events.push_back(std::move(event));
      }
    }
  }
  Sort(all);
  return all;
}

grammar::Timeline ByHand(grammar::Timeline timeline, const truth::HandRoles& hands) {
  for (grammar::NamedEvent& event : timeline.events) event.event = truth::NameByHand(event, hands);
  return timeline;
}

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
