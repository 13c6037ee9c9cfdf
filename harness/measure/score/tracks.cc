// SPDX-License-Identifier: Apache-2.0
#include "harness/measure/score/tracks.h"

#include <algorithm>
#include <map>
#include <string>

#include "harness/truth/timeline/event_text.h"

namespace prehend::measure {
namespace {

/// Both sides of one label.
struct TwoSides {
  Segments truth, found;
};

/// Both in the order of time, and without overlaps within a side.
bool AnyOverlaps(const Segments& a, const Segments& b) {
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    if (Overlap(i->interval, j->interval) > 0) return true;
    if (i->interval.end <= j->interval.end)
      ++i;
    else
      ++j;
  }
  return false;
}

void MergeInto(Segments& track, const Segments& more) {
  track.insert(track.end(), more.begin(), more.end());
  std::ranges::stable_sort(track, {}, [](const Segment& one) { return one.interval.begin; });
}

std::string WhoseOf(const grammar::NamedEvent& event) {
  const std::string& hand = truth::RoleValue(event, "hand");
  if (!hand.empty()) return hand;
  std::string roles;
  for (const grammar::Role& role : event.roles) roles += role.value + ",";
  return roles;
}

}  // namespace

std::vector<Episode> TracksOf(const grammar::Timeline& truth, const grammar::Timeline& found,
                              grammar::Tick ticks) {
  std::map<std::string, std::map<std::string, TwoSides>> by_hand;
  for (const grammar::NamedEvent& event : truth.events)
    by_hand[WhoseOf(event)][event.Label()].truth.push_back({event.Label(), event.interval});
  for (const grammar::NamedEvent& event : found.events)
    by_hand[WhoseOf(event)][event.Label()].found.push_back({event.Label(), event.interval});
  std::vector<Episode> all;
  for (const auto& [hand, labels] : by_hand) {
    const std::size_t first = all.size();
    for (const auto& [label, sides] : labels) {
      auto track = std::find_if(all.begin() + static_cast<std::ptrdiff_t>(first), all.end(),
                                [&sides = sides](const Episode& one) {
                                  return !AnyOverlaps(one.truth, sides.truth) &&
                                         !AnyOverlaps(one.prediction, sides.found);
                                });
      if (track == all.end()) track = all.insert(track, Episode{.ticks = ticks});
      MergeInto(track->truth, sides.truth);
      MergeInto(track->prediction, sides.found);
    }
  }
  return all;
}

void EditOfTracks::Add(const std::vector<Episode>& tracks) {
  for (const Episode& track : tracks) sum_ += EditScore(track.truth, track.prediction);
  tracks_ += static_cast<int>(tracks.size());
}

}  // namespace prehend::measure
