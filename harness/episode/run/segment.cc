// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/segment.h"

#include <vector>

#include "grammar/name_events.h"
#include "harness/episode/sense/entity_table.h"

namespace prehend::episode {

Segmentation Segment(const std::shared_ptr<const grammar::Program>& program,
                     const grammar::EntityTable& entities, const FrameFeed& play,
                     const std::function<void(const grammar::Timeline&)>& decided) {
  grammar::Monitor monitor(program, entities);
  std::vector<grammar::Event> events;
  if (!monitor.error().empty())
    return {grammar::NameEvents(*program, entities, events), monitor.error()};
  const auto tell = [&] {
    if (!decided || events.empty()) return;
    decided(grammar::NameEvents(*program, entities, events));
    events.clear();
  };
  const grammar::Tick end = play([&](const FrameNews& news) {
    if (const auto* whole = std::get_if<grammar::Frame>(&news))
      monitor.Advance(*whole, events);
    else
      monitor.AdvanceBy(std::get<grammar::FrameChanges>(news), events);
    tell();
  });
  monitor.Finish(end, events);
  tell();
  return {grammar::NameEvents(*program, entities, events), monitor.error()};
}

grammar::Timeline Resegment(const scenario::Scenario& scenario,
                            std::span<const physics::Snapshot> recording,
                            std::shared_ptr<const grammar::Program> program, grammar::Tick end) {
  Sensing sensing(scenario.scene, scenario.sensing);
  const FrameFeed play = [&](const std::function<void(const FrameNews&)>& take) {
    for (const physics::Snapshot& snapshot : recording) {
      if (sensing.Due(snapshot.tick)) take(sensing.SenseChanges(snapshot));
    }
    return end;
  };
  return Segment(program, MakeEntityTable(scenario), play).timeline;
}

}  // namespace prehend::episode
