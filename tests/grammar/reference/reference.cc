// SPDX-License-Identifier: Apache-2.0
#include "tests/grammar/reference/reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace prehend::grammar::reference {

Stream And(const Stream& a, const Stream& b) {
  Stream both(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) both[i] = a[i] && b[i];
  return both;
}

Stream Or(const Stream& a, const Stream& b) {
  Stream either(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) either[i] = a[i] || b[i];
  return either;
}

Stream Not(const Stream& a) {
  Stream other(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) other[i] = !a[i];
  return other;
}

Truths And(const Truths& a, const Truths& b) { return {And(a.is, b.is), And(a.may, b.may)}; }

Truths Or(const Truths& a, const Truths& b) { return {Or(a.is, b.is), Or(a.may, b.may)}; }

Truths Not(const Truths& a) { return {Not(a.may), Not(a.is)}; }

Stream Truth(const Runs& runs, int frames) {
  Stream truth(frames, false);
  for (const Run& run : runs) {
    for (int i = run.begin; i < run.end; ++i) truth[i] = true;
  }
  return truth;
}

Stream Begins(const Runs& runs, int frames) {
  Stream begins(frames, false);
  for (const Run& run : runs) begins[run.begin] = true;
  return begins;
}

Stream Ends(const Runs& runs, int frames) {
  Stream ends(frames, false);
  for (const Run& run : runs) {
    if (run.end < frames) ends[run.end] = true;
  }
  return ends;
}

Runs While(const Stream& f, const Ticks& ticks, Tick bridging) {
  Runs runs;
  const int frames = static_cast<int>(f.size());
  for (int i = 0; i < frames; ++i) {
    if (!f[i]) continue;
    const bool goes_on = !runs.empty() && ticks[i] - ticks[runs.back().end] <= bridging;
    if (!goes_on && (runs.empty() || runs.back().end != i)) runs.push_back({i, i});
    runs.back().end = i + 1;
  }
  return runs;
}

Runs Hold(const Stream& on, const Anchored& off, const Ticks& ticks, Tick bridging) {
  Stream held(on.size(), false);
  int begin = -1;
  for (int i = 0; i < static_cast<int>(on.size()); ++i) {
    held[i] = (begin >= 0 || on[i]) && !off.at(begin >= 0 ? begin : i)[i];
    begin = !held[i] ? -1 : begin >= 0 ? begin : i;
  }
  return While(held, ticks, bridging);
}

Runs FromTo(const Stream& from, const Anchored& to, const Anchored& during, bool or_drop,
            const Ticks& ticks, Tick within) {
  Runs runs;
  const int frames = static_cast<int>(from.size());
  for (int i = 0; i < frames; ++i) {
    if (!from[i]) continue;
    const Stream ends = to.at(i);
    const Stream holds = during.at(i);
    if (!holds[i] || ends[i]) continue;
    int end = i + 1;
    const auto in_time = [&] { return within < 0 || ticks[end] - ticks[i] <= within; };
    while (end < frames && in_time() && !ends[end] && holds[end]) ++end;
    const bool reached = in_time() && end < frames && ends[end];
    if (reached || (in_time() && !or_drop)) runs.push_back({i, end});
    i = end - (end < frames && in_time()
                   ? 0
                   : 1);  // what ends one does not begin the next; a frame after the deadline may
  }
  return runs;
}

Runs FromEachTo(const Stream& from, const Stream& to, const Stream& during, bool or_drop,
                const Ticks& ticks, Tick within) {
  Runs runs;
  const int frames = static_cast<int>(from.size());
  const auto waits = [&](int i) { return from[i] && during[i] && !to[i]; };
  for (int i = 0; i < frames; ++i) {
    if (!waits(i)) continue;
    int end = i + 1;
    while (end < frames && !to[end] && during[end]) ++end;
    while (i < end && (!waits(i) || ticks[end] - ticks[i] > within)) ++i;
    const bool reached = end < frames && to[end];
    if (i < end && (reached || !or_drop)) runs.push_back({i, end});
    i = end;
  }
  return runs;
}

std::vector<Timed> FromWithout(const Stream& from, const Anchored& without, const Anchored& during,
                               const Ticks& ticks, double within) {
  std::vector<Timed> found;
  const int frames = static_cast<int>(from.size());
  for (int i = 0; i < frames; ++i) {
    if (!from[i]) continue;
    const Stream comes = without.at(i);
    const Stream holds = during.at(i);
    if (!holds[i] || comes[i]) continue;
    const Tick deadline = ticks[i] + static_cast<Tick>(std::ceil(within));
    int end = i + 1;
    while (end < frames && ticks[end] < deadline && !comes[end] && holds[end]) ++end;
    const bool waited = ticks[end] >= deadline;
    const bool in_time = static_cast<double>(ticks[end] - ticks[i]) <= within;
    const bool just_in_time = waited && end < frames && in_time && comes[end];
    if (!waited || just_in_time) continue;
    found.push_back({{i, end}, {ticks[i], deadline}});
    i = end - 1;
  }
  return found;
}

namespace {

// Frames at most half of `over` ticks before or after frame `i`, up to `last`.
std::vector<int> Around(int i, double over, const Ticks& ticks, int last) {
  std::vector<int> around;
  for (int k = 0; k <= last; ++k)
    if (std::abs(static_cast<double>(ticks[k] - ticks[i])) <= over / 2) around.push_back(k);
  return around;
}

// What must not recede: the signal, or its median.
std::vector<double> Levels(const Approach& a, const Ticks& ticks, int end) {
  std::vector<double> levels;
  for (int i = 0; i <= end; ++i) {
    std::vector<double> values;
    for (const int k : Around(i, a.over, ticks, end)) values.push_back(a.signal[k]);
    const bool all_known = std::ranges::none_of(values, [](double v) { return std::isnan(v); });
    if (all_known) std::sort(values.begin(), values.end());
    levels.push_back(!all_known   ? std::numeric_limits<double>::quiet_NaN()
                     : a.over > 0 ? values[values.size() / 2]
                                  : a.signal[i]);
  }
  return levels;
}

// Where an approach that reaches `end` begins; `earliest` is as far back as anything else allows.
int ApproachBegin(const Approach& a, const Ticks& ticks, int earliest, int end) {
  const std::vector<double> levels = Levels(a, ticks, end);
  for (int i = end; i >= earliest; --i) {  // nothing leads back over what nobody knows
    if (std::isnan(levels[i]) || std::isnan(a.signal[i])) earliest = std::min(i + 1, end);
  }
  if (std::isnan(levels[end])) return end;
  const bool by_hand = a.still >= 0;
  const auto speed = [&](int i) {
    const double way = a.signal[i] - a.signal[i + 1];
    return (by_hand ? std::abs(way) : way) / (static_cast<double>(ticks[i + 1] - ticks[i]) / 1000);
  };
  const auto stays = [&](int i) {
    const std::vector<int> around = Around(i, a.still_over, ticks, end);
    return by_hand && around.size() > 1 && std::all_of(around.begin(), around.end(), [&](int k) {
             return std::abs(a.signal[k] - a.signal[i]) <= a.still;
           });
  };
  const auto fast = [&](int i) { return speed(i) >= a.speed && !stays(i + 1); };
  const auto largest_after = [&](int i) {
    return *std::max_element(levels.begin() + i + 1, levels.begin() + end + 1);
  };
  // How far back it goes before it recedes or pauses.
  int limit = end;
  bool receded = false, paused = false;
  for (Tick moved = ticks[end]; limit > earliest; --limit) {
    const int i = limit - 1;
    receded = levels[i] < largest_after(i) - a.slack;
    if (receded) break;
    if (fast(i)) moved = ticks[i];
    paused = a.idle >= 0 && moved - ticks[i] > a.idle;
    if (paused) break;
  }
  int turn = end;  // the farthest, the last of equals
  for (int i = end; i >= limit; --i)
    if (levels[i] > levels[turn]) turn = i;
  if (receded && a.over > 0) {
    int begin = end;
    while (begin > turn && levels[begin] < levels[turn] - a.slack) --begin;
    while (begin > limit && a.signal[begin - 1] > a.signal[begin] && speed(begin - 1) > a.onset)
      --begin;
    return begin;
  }
  const int farthest = receded ? turn : limit;
  if (a.idle < 0) return farthest;
  // Movement, or the slow start of one.
  int begin = end;
  for (int i = end - 1; i >= farthest; --i)
    if (fast(i) || (!by_hand && begin == i + 1 && speed(i) > a.onset)) begin = i;
  // A hand that can pause while it trembles: where it leaves its place, and while it speeds up.
  const int pause = paused ? limit - 1 : receded ? turn : limit;
  if (!by_hand || begin == pause) return begin;
  const int noticed = begin;
  while (begin + 1 < end && std::abs(a.signal[begin + 1] - a.signal[noticed]) <= a.still) ++begin;
  while (begin > pause && speed(begin - 1) > a.onset &&
         (begin == end || speed(begin - 1) <= 1.1 * speed(begin)))
    --begin;
  return begin;
}

}  // namespace

Runs UntilSince(const Stream& until, const Anchored& since, const Ticks& ticks, Tick back,
                const Approach* approach) {
  Runs runs;
  const int frames = static_cast<int>(until.size());
  int previous = 0;
  for (int end = 0; end < frames; ++end) {
    if (!until[end]) continue;
    const Stream holds = since.at(end);
    int begin = end;
    while (begin > previous && holds[begin - 1] && ticks[end] - ticks[begin - 1] <= back) --begin;
    if (approach != nullptr) begin = ApproachBegin(*approach, ticks, begin, end);
    if (begin < end) runs.push_back({begin, end});
    previous = end;
  }
  return runs;
}

std::vector<Timed> RestOf(const std::vector<Timed>& whole, const std::vector<Stream>& outside,
                          const Ticks& ticks) {
  std::vector<Timed> rests;
  for (const auto& [run, lasts, completed] : whole) {
    bool open = false;
    for (int i = run.begin; i < run.end; ++i) {
      const bool covered =
          std::any_of(outside.begin(), outside.end(), [&](const Stream& s) { return s[i]; });
      if (!covered && !open) rests.push_back({{i, i}, {ticks[i], ticks[i]}});
      open = !covered;
      if (!open) continue;
      rests.back().run.end = i + 1;
      rests.back().ticks.end = std::min(ticks[i + 1], lasts.end);
    }
  }
  return rests;
}

std::vector<Timed> Repeat(std::vector<Timed> intervals, int at_least, Tick gap) {
  std::ranges::sort(intervals, {}, [](const Timed& one) { return one.ticks.begin; });
  std::vector<Timed> series;
  for (std::size_t i = 0; i < intervals.size();) {
    Timed whole{intervals[i].run, intervals[i].ticks};
    std::size_t next = i + 1;
    for (; next < intervals.size() && intervals[next].ticks.begin - whole.ticks.end <= gap;
         ++next) {
      whole.run.end = std::max(whole.run.end, intervals[next].run.end);
      whole.ticks.end = std::max(whole.ticks.end, intervals[next].ticks.end);
    }
    if (static_cast<int>(next - i) >= at_least) series.push_back(whole);
    i = next;
  }
  return series;
}

std::vector<Runs> OnePer(const std::vector<Runs>& candidates,
                         const std::vector<std::vector<double>>& away, const Ticks& ticks,
                         Tick within) {
  const int frames = static_cast<int>(ticks.size()) - 1;
  std::vector<Stream> hold;
  for (const Runs& runs : candidates) hold.push_back(Truth(runs, frames));
  std::vector<Stream> own(candidates.size(), Stream(frames, false));
  for (int free = 0; free < frames;) {
    const bool somebody = std::ranges::any_of(hold, [&](const Stream& h) { return h[free]; });
    std::vector<std::pair<std::size_t, int>> in_time;  // with their first frames
    for (std::size_t c = 0; somebody && c < candidates.size(); ++c) {
      int first = free;
      while (first < frames && ticks[first] - ticks[free] <= within && !hold[c][first]) ++first;
      if (first < frames && ticks[first] - ticks[free] <= within) in_time.emplace_back(c, first);
    }
    const auto is_lost = [&](const auto& one) { return std::isnan(away[one.first][one.second]); };
    if (in_time.size() > 1) std::erase_if(in_time, is_lost);
    ++free;
    if (in_time.empty()) continue;
    const auto [best, from] = *std::ranges::min_element(
        in_time, {}, [&](const auto& one) { return away[one.first][one.second]; });
    free = from + 1;
    for (int i = from; i < frames && hold[best][i]; free = ++i) own[best][i] = true;
  }
  std::vector<Runs> runs;
  for (const Stream& one : own) runs.push_back(While(one, ticks, 0));
  return runs;
}

std::vector<Timed> InTicks(const Runs& runs, const Ticks& ticks) {
  std::vector<Timed> timed;
  for (const Run& run : runs) timed.push_back({run, {ticks[run.begin], ticks[run.end]}});
  return timed;
}

Runs RunsOf(const std::vector<Timed>& timed) {
  Runs runs;
  for (const Timed& one : timed) runs.push_back(one.run);
  return runs;
}

Runs Lasting(const Runs& runs, const Ticks& ticks, Tick lasting) {
  Runs kept;
  for (const Run& run : runs) {
    if (ticks[run.end] - ticks[run.begin] >= lasting) kept.push_back(run);
  }
  return kept;
}

Runs ConfirmedBy(const Runs& runs, const Runs& by, const Stream& within) {
  Runs kept;
  const int frames = static_cast<int>(within.size());
  const Stream begins = Begins(by, frames);
  for (const Run& run : runs) {
    for (int i = run.end; i < frames && within[i]; ++i) {
      if (!begins[i]) continue;
      kept.push_back(run);
      break;
    }
  }
  return kept;
}

namespace {

// Visits each choice of one interval of each part.
void ForEachChoice(const std::vector<std::vector<Timed>>& parts,
                   const std::function<void(const std::vector<Timed>&)>& visit) {
  std::vector<Timed> chosen(parts.size());
  const std::function<void(std::size_t)> choose = [&](std::size_t part) {
    if (part == parts.size()) return visit(chosen);
    for (const Timed& one : parts[part]) {
      chosen[part] = one;
      choose(part + 1);
    }
  };
  choose(0);
}

std::vector<Interval> IntervalsOf(const std::vector<Timed>& timed) {
  std::vector<Interval> intervals;
  for (const Timed& one : timed) intervals.push_back(one.ticks);
  return intervals;
}

Tick CompletedAt(const std::vector<Timed>& chosen) {
  Tick completed = 0;
  for (const Timed& one : chosen) completed = std::max(completed, one.Complete());
  return completed;
}

// Those that come first in the order and do not overlap.
template <typename Key>
std::vector<Timed> TakeInOrder(std::vector<Timed> all, const Key& key) {
  std::ranges::sort(all, {}, key);
  std::vector<Timed> kept;
  for (const Timed& one : all) {
    if (kept.empty() || one.ticks.begin >= kept.back().ticks.end) kept.push_back(one);
  }
  return kept;
}

}  // namespace

std::vector<Timed> Compose(const std::vector<std::vector<Timed>>& parts,
                           const std::function<bool(const std::vector<Interval>&)>& fits,
                           bool takes_first) {
  std::vector<Timed> all;
  ForEachChoice(parts, [&](const std::vector<Timed>& chosen) {
    const Timed& first = chosen.front();
    const Timed& last = chosen.back();
    if (first.ticks.begin >= last.ticks.end || !fits(IntervalsOf(chosen))) return;
    all.push_back({{first.run.begin, last.run.end},
                   {first.ticks.begin, last.ticks.end},
                   CompletedAt(chosen)});
  });
  return TakeInOrder(std::move(all), [&](const Timed& one) {
    return std::tuple(one.completed, one.ticks.end,
                      takes_first ? one.ticks.begin : -one.ticks.begin);
  });
}

std::vector<Timed> AllOf(const std::vector<std::vector<Timed>>& parts,
                         const std::function<bool(const std::vector<Interval>&)>& fits,
                         Tick within) {
  std::vector<Timed> all;
  ForEachChoice(parts, [&](const std::vector<Timed>& chosen) {
    Timed whole = chosen.front();
    for (const Timed& one : chosen) {
      whole.run = {std::min(whole.run.begin, one.run.begin), std::max(whole.run.end, one.run.end)};
      whole.ticks = {std::min(whole.ticks.begin, one.ticks.begin),
                     std::max(whole.ticks.end, one.ticks.end)};
    }
    whole.completed = CompletedAt(chosen);
    if (whole.ticks.end - whole.ticks.begin <= within && fits(IntervalsOf(chosen)))
      all.push_back(whole);
  });
  return TakeInOrder(std::move(all), [](const Timed& one) {
    return std::tuple(one.completed, -one.ticks.begin, one.ticks.end);
  });
}

std::vector<Timed> RepeatWithin(std::vector<Timed> intervals, int at_least, Tick within) {
  std::ranges::sort(intervals, {}, [](const Timed& one) { return one.ticks.begin; });
  std::vector<Timed> found;
  for (const Timed& first : intervals) {
    const bool is_too_long = first.ticks.end > first.ticks.begin + within;
    if (is_too_long || (!found.empty() && first.ticks.begin < found.back().ticks.end)) continue;
    Timed whole = first;
    int count = 0;
    for (const Timed& one : intervals) {
      const bool is_inside =
          one.ticks.begin >= first.ticks.begin && one.ticks.end <= first.ticks.begin + within;
      if (!is_inside) continue;
      ++count;
      if (one.ticks.end > whole.ticks.end) {
        whole.ticks.end = one.ticks.end;
        whole.run.end = one.run.end;
      }
    }
    whole.completed = 0;
    if (count >= at_least) found.push_back(whole);
  }
  return found;
}

bool NothingBetween(const std::vector<Timed>& intervals, const Interval& left,
                    const Interval& right) {
  return std::ranges::none_of(intervals, [&](const Timed& one) {
    return std::max(one.ticks.begin, left.end) < std::min(one.ticks.end, right.begin);
  });
}

}  // namespace prehend::grammar::reference
