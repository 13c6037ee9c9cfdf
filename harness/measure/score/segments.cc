// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/measure/score/score_test.cc
#include "harness/measure/score/segments.h"

#include <map>
#include <set>

namespace prehend::measure {
namespace {

Segments SegmentsOf(const grammar::Timeline& timeline) {
  Segments segments;
  for (const grammar::NamedEvent& event : timeline.events)
    segments.push_back({event.Label(), event.interval});
  return segments;
}

}  // namespace

std::vector<grammar::Tick> InnerBoundaries(const Segments& segments, grammar::Tick ticks) {
  std::set<grammar::Tick> boundaries;
  for (const Segment& segment : segments)
    boundaries.insert({segment.interval.begin, segment.interval.end});
  boundaries.erase(0);
  boundaries.erase(ticks);
  return {boundaries.begin(), boundaries.end()};
}

LabelledEpisode Labelled(const grammar::Timeline& truth, const grammar::Timeline& found,
                         grammar::Tick ticks) {
  LabelledEpisode episode{.ticks_per_second = static_cast<double>(truth.ticks_per_second),
                          .whole = {ticks, SegmentsOf(truth), SegmentsOf(found)},
                          .by_label = {}};
  std::map<std::string, Episode> by_label;
  for (const Segment& segment : episode.whole.truth)
    by_label[segment.label].truth.push_back(segment);
  for (const Segment& segment : episode.whole.prediction)
    by_label[segment.label].prediction.push_back(segment);
  for (auto& [label, of_label] : by_label) {
    of_label.ticks = ticks;
    episode.by_label.push_back(std::move(of_label));
  }
  return episode;
}

}  // namespace prehend::measure
