// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/sense/gap_tolerance.h"

#include <fmt/format.h>

#include "grammar/base/frame.h"

namespace prehend::episode {

const GapTolerance::Seen* GapTolerance::LastOf(std::size_t entity, grammar::Tick tick) const {
  const std::optional<Seen>& last = seen_[entity].last;
  return last && tick - last->tick <= most_ ? &*last : nullptr;
}

void GapTolerance::Fill(grammar::Tick tick, std::vector<grammar::EntitySample>& looks) {
  for (std::size_t i = 0; i < looks.size(); ++i) {
    Entity& entity = seen_[i];
    if (grammar::IsTracked(looks[i])) {
      entity.last = {tick, looks[i]};
      entity.tracked = true;
      continue;
    }
    if (entity.tracked) ++entity.gaps.gaps;
    entity.tracked = false;
    const Seen* last = LastOf(i, tick);
    (last ? entity.gaps.bridged : entity.gaps.unknown) += before_ ? tick - *before_ : 0;
    if (last) looks[i] = last->look;
  }
  before_ = tick;
}

std::vector<LookGaps> GapTolerance::Gaps() const {
  std::vector<LookGaps> all;
  for (const Entity& entity : seen_) all.push_back(entity.gaps);
  return all;
}

std::string GapsText(const grammar::EntityTable& table, const std::vector<LookGaps>& gaps) {
  std::string text;
  const auto rate = static_cast<double>(table.ticks_per_second);
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (gaps[i].gaps == 0) continue;
    text += fmt::format(
        "warning: '{}' is not tracked in {} gap{}: {:.3f} s are bridged, in {:.3f} s it is "
        "unknown\n",
        table.entities[i].name, gaps[i].gaps, gaps[i].gaps == 1 ? "" : "s",
        static_cast<double>(gaps[i].bridged) / rate, static_cast<double>(gaps[i].unknown) / rate);
  }
  return text;
}

}  // namespace prehend::episode
