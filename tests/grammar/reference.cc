// SPDX-License-Identifier: Apache-2.0
#include "tests/grammar/reference.h"

#include <algorithm>

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

Runs FromTo(const Stream& from, const Stream& to, const Stream& during, bool or_drop) {
  Runs runs;
  const int frames = static_cast<int>(from.size());
  for (int i = 0; i < frames; ++i) {
    if (!from[i] || !during[i] || to[i]) continue;
    int end = i + 1;
    while (end < frames && !to[end] && during[end]) ++end;
    const bool reached = end < frames && to[end];
    if (reached || !or_drop) runs.push_back({i, end});
    i = end - (end < frames ? 0 : 1);  // what ends one interval does not begin the next
  }
  return runs;
}

Stream Hold(const Stream& on, const Stream& off) {
  Stream holds(on.size());
  for (std::size_t i = 0; i < on.size(); ++i) holds[i] = !off[i] && (on[i] || (i > 0 && holds[i - 1]));
  return holds;
}

Runs FromToWithin(const Stream& from, const Stream& to, const Stream& during, bool or_drop, const Ticks& ticks, Tick within) {
  Runs runs;
  const int frames = static_cast<int>(from.size());
  for (int i = 0; i < frames; ++i) {
    if (!from[i] || !during[i] || to[i]) continue;
    const Tick latest = ticks[i] + within;
    int end = i + 1;
    while (end < frames && ticks[end] <= latest && !to[end] && during[end]) ++end;
    const bool in_time = ticks[end] <= latest;
    const bool reached = in_time && end < frames && to[end];
    if (reached || (in_time && !or_drop)) runs.push_back({i, end});
    i = end - (end < frames && in_time ? 0 : 1);  // a frame after the deadline may begin the next one
  }
  return runs;
}

std::vector<Interval> FromWithout(const Stream& from, const Stream& without, const Stream& during, const Ticks& ticks,
                                  Tick within) {
  std::vector<Interval> found;
  const int frames = static_cast<int>(from.size());
  for (int i = 0; i < frames; ++i) {
    if (!from[i] || !during[i] || without[i]) continue;
    const Tick deadline = ticks[i] + within;
    int end = i + 1;
    while (end < frames && ticks[end] < deadline && !without[end] && during[end]) ++end;
    const bool waited = ticks[end] >= deadline;
    const bool just_in_time = waited && end < frames && ticks[end] == deadline && without[end];
    if (waited && !just_in_time) found.push_back({ticks[i], deadline});
    i = end - (waited && !just_in_time ? 1 : 0);
  }
  return found;
}

Runs UntilSince(const Stream& until, const Stream& since, const Ticks& ticks, Tick back) {
  Runs runs;
  const int frames = static_cast<int>(until.size());
  int previous = 0;
  for (int end = 0; end < frames; ++end) {
    if (!until[end]) continue;
    int begin = end;
    while (begin > previous && since[begin - 1] && ticks[end] - ticks[begin - 1] <= back) --begin;
    if (begin < end) runs.push_back({begin, end});
    previous = end;
  }
  return runs;
}

Runs RestOf(const Runs& whole, const std::vector<Stream>& outside) {
  Runs runs;
  for (const Run& run : whole) {
    bool open = false;
    for (int i = run.begin; i < run.end; ++i) {
      const bool covered = std::any_of(outside.begin(), outside.end(), [&](const Stream& s) { return s[i]; });
      if (!covered && !open) runs.push_back({i, i});
      open = !covered;
      if (open) runs.back().end = i + 1;
    }
  }
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

}  // namespace prehend::grammar::reference
