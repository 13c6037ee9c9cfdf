// SPDX-License-Identifier: Apache-2.0
#include "harness/show/explain/decisive.h"

#include <algorithm>
#include <cmath>

#include "grammar/compile/limits.h"
#include "harness/show/explain/phrasing.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::show {

using grammar::Limit;
using grammar::NamedEvent;
using grammar::Program;

namespace {

/// So many programs are tried at most, and so many frames are looked at.
constexpr double kMostRuns = 1500, kMostFrames = 5e5;
constexpr int kHalvings = 10;

/// Shares by which numbers are changed: by hundredths; where there are many numbers and frames, in
/// steps that grow.
std::vector<double> Shares(std::size_t changes, grammar::FrameNumber frames) {
  const double most = std::min(kMostRuns, kMostFrames / std::max<double>(1, frames));
  const int steps = static_cast<int>(std::clamp(most / std::max<double>(1, changes), 12.0, 99.0));
  std::vector<double> shares;
  for (int i = 0; i < steps; ++i)
    shares.push_back(steps == 99 ? 0.01 * (i + 1) : 0.01 * std::pow(99, i / (steps - 1.0)));
  return shares;
}

/// A limit, changed down or up.
struct Change {
  const Limit* limit;
  bool up = false;
  /// `share` of the larger of both values.
  double At(double share) const {
    const double value = limit->value.value * (up ? 1 / (1 - share) : 1 - share);
    return limit->is_count ? std::round(value) : value;
  }
};

using IsThere = std::function<bool(const grammar::Timeline&)>;

std::optional<Decisive> Search(const grammar::ReplayMonitor& past, const std::string& rule,
                               bool wanted, const Recognise& recognise, const IsThere& is_there) {
  const Program& program = past.program();
  const std::vector<Limit> limits = grammar::LimitsOf(program, rule);
  const auto does = [&](const Change& change, double share) {
    const double value = change.At(share);
    if (value == change.limit->value.value) return false;
    const auto changed = grammar::WithLimit(program, rule, *change.limit, value);
    const auto timeline = changed ? recognise(changed) : std::nullopt;
    return timeline && is_there(*timeline) == wanted;
  };
  const Change* best = nullptr;
  double least = 1;
  std::vector<Change> changes;
  for (const Limit& limit : limits) {
    changes.push_back({&limit, false});
    changes.push_back({&limit, true});
  }
  double before = 0;
  for (const double share : Shares(changes.size(), past.frames())) {
    for (const Change& change : changes) {
      if (!does(change, share)) continue;
      double low = before, high = share;
      for (int k = 0; k < kHalvings; ++k) {
        const double middle = (low + high) / 2;
        (does(change, middle) ? high : low) = middle;
      }
      if (high >= least) continue;
      least = high;
      best = &change;
    }
    if (best != nullptr) break;
    before = share;
  }
  if (best == nullptr) return std::nullopt;
  const Limit& limit = *best->limit;
  return Decisive{.clause = limit.clause,
                  .rule = limit.owner,
                  .where = Source(limit.file, limit.place),
                  .limit = limit.value.value,
                  .instead = best->At(least),
                  .dimension = limit.value.dimension,
                  .share = least};
}

}  // namespace

bool Answers(const Ask& ask, const Program& program, const grammar::EntityTable& entities,
             const NamedEvent& event) {
  const grammar::Rule& rule = program.rules[ask.rule];
  if (event.event != rule.name) return false;
  const auto plays = [&](std::size_t role, std::size_t as) {
    return ask.entities[role] == grammar::kNone ||
           event.roles[as].value == entities.entities[ask.entities[role]].name;
  };
  bool all = true;
  for (std::size_t role = 0; role < rule.roles.size(); ++role) all = all && plays(role, role);
  if (!all && rule.symmetric) all = plays(0, 1) && plays(1, 0);
  if (!all || !ask.time_s) return all;
  const grammar::Tick tick = truth::TickAt(*ask.time_s, entities.ticks_per_second);
  return event.interval.begin <= tick + 1 && tick <= event.interval.end;
}

void FindDecisive(const grammar::ReplayMonitor& past, const Ask& ask, const Recognise& recognise,
                  WhyMissing& why) {
  if (ask.rule == grammar::kTouchingRule) return;
  const Program& program = past.program();
  const IsThere is_there = [&](const grammar::Timeline& timeline) {
    return std::ranges::any_of(timeline.events, [&](const NamedEvent& event) {
      return Answers(ask, program, past.entity_table(), event);
    });
  };
  why.decisive =
      Search(past, program.rules[ask.rule].name, true, recognise, is_there).value_or(Decisive());
}

void FindDecisive(const grammar::ReplayMonitor& past, const Ask& ask, const Recognise& recognise,
                  WhyEvent& why) {
  if (ask.rule == grammar::kTouchingRule) return;
  const Program& program = past.program();
  const IsThere is_there = [&](const grammar::Timeline& timeline) {
    return std::ranges::any_of(timeline.events, [&](const NamedEvent& event) {
      return event.Label() == why.event && event.interval.begin < why.interval.end &&
             why.interval.begin < event.interval.end;
    });
  };
  why.decisive =
      Search(past, program.rules[ask.rule].name, false, recognise, is_there).value_or(Decisive());
}

}  // namespace prehend::show
