// SPDX-License-Identifier: Apache-2.0
#include "physics/motion/stage_clock.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace prehend::physics {
namespace {

/// A step as its stage's order sees it.
struct Item {
  std::pair<bool, int> actor;  ///< whether it is a person, and its index
  const StepOrder* order;
  double delay_s = 0, duration_s = 0;
};

std::vector<Item> ItemsOf(const ScriptStage& stage) {
  std::vector<Item> items;
  for (const Step& step : stage.steps)
    items.push_back({{false, step.hand.number()}, &step.order, step.delay_s, DurationOf(step)});
  for (const PersonStep& step : stage.person_steps)
    items.push_back({{true, step.person}, &step.order, step.delay_s, DurationOf(step)});
  return items;
}

/// By step the planned time of its begin and its end, seconds; none if its turn never comes.
struct Span {
  double begin_s = 0, end_s = 0;
};

std::vector<std::optional<Span>> PlanOf(const ScriptStage& stage) {
  const std::vector<Item> items = ItemsOf(stage);
  const std::vector<StepLinks> links = LinksOf(stage);
  std::vector<std::optional<Span>> plan(items.size());
  const auto turn_of = [&](const StepLinks& link) -> std::optional<double> {
    double turn_s = 0;
    for (const std::size_t before : link.after) {
      if (!plan[before]) return {};
      turn_s = std::max(turn_s, plan[before]->end_s);
    }
    if (link.is_broken || (link.with && !plan[*link.with])) return {};
    return link.with ? std::max(turn_s, plan[*link.with]->begin_s) : turn_s;
  };
  // Every round finds at least one step, or none can be found any more.
  for (bool found = true; found;) {
    found = false;
    for (std::size_t i = 0; i < items.size(); ++i) {
      const auto turn_s = plan[i] ? std::nullopt : turn_of(links[i]);
      if (!turn_s) continue;
      plan[i] = Span{*turn_s + items[i].delay_s, *turn_s + items[i].duration_s};
      found = true;
    }
  }
  return plan;
}

}  // namespace

std::vector<StepLinks> LinksOf(const ScriptStage& stage) {
  const std::vector<Item> items = ItemsOf(stage);
  std::map<std::string, std::size_t> named;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (!items[i].order->name.empty()) named.emplace(items[i].order->name, i);
  std::vector<StepLinks> links;
  std::map<std::pair<bool, int>, std::size_t> last;
  for (std::size_t i = 0; i < items.size(); ++i) {
    StepLinks& link = links.emplace_back();
    const auto find = [&](const std::string& name) -> std::optional<std::size_t> {
      const auto found = named.find(name);
      if (found != named.end()) return found->second;
      link.is_broken |= !name.empty();
      return {};
    };
    if (const auto before = last.find(items[i].actor); before != last.end())
      link.after.push_back(before->second);
    if (const auto before = find(items[i].order->after)) link.after.push_back(*before);
    link.with = find(items[i].order->with);
    last[items[i].actor] = i;
  }
  return links;
}

bool IsOrdered(const ScriptStage& stage) {
  return std::ranges::any_of(LinksOf(stage), [](const StepLinks& link) {
    return !link.after.empty() || link.with || link.is_broken;
  });
}

std::vector<std::size_t> StuckSteps(const ScriptStage& stage) {
  const auto plan = PlanOf(stage);
  std::vector<std::size_t> stuck;
  for (std::size_t i = 0; i < plan.size(); ++i)
    if (!plan[i]) stuck.push_back(i);
  return stuck;
}

double DurationOf(const Step& step) {
  const auto* poses = std::get_if<PosesStep>(&step.action);
  return step.delay_s + (poses && !poses->poses.empty() ? poses->poses.back().t_s : step.over_s);
}

double DurationOf(const PersonStep& step) {
  const auto* head = std::get_if<HeadPosesStep>(&step.action);
  return step.delay_s + (head && !head->poses.empty() ? head->poses.back().t_s : step.over_s);
}

double DurationOf(const ScriptStage& stage) {
  double longest_s = 0;
  for (const auto& span : PlanOf(stage))
    if (span) longest_s = std::max(longest_s, span->end_s);
  return longest_s;
}

double DurationOf(const Script& script) {
  double sum_s = script.settle_s;
  for (const ScriptStage& stage : script.stages) sum_s += DurationOf(stage);
  return sum_s;
}

StageClock::StageClock(const ScriptStage& stage, double rate_hz) : is_ordered_(IsOrdered(stage)) {
  const std::vector<Item> items = ItemsOf(stage);
  std::vector<StepLinks> links = LinksOf(stage);
  for (std::size_t i = 0; i < items.size(); ++i)
    steps_.push_back({.links = std::move(links[i]),
                      .delay_ticks = std::llround(items[i].delay_s * rate_hz),
                      .duration_ticks = std::llround(items[i].duration_s * rate_hz)});
}

bool StageClock::HasItsTurn(const StepTime& step) const {
  const StepLinks& links = step.links;
  if (step.phase != Phase::kWaits || links.is_broken) return false;
  if (links.with && steps_[*links.with].phase < Phase::kPlays) return false;
  return std::ranges::all_of(
      links.after, [&](std::size_t before) { return steps_[before].phase == Phase::kEnded; });
}

std::vector<std::size_t> StageClock::TakeTurns(std::int64_t tick) {
  std::vector<std::size_t> turns;
  for (std::size_t i = 0; i < steps_.size(); ++i)
    if (HasItsTurn(steps_[i])) turns.push_back(i);
  for (const std::size_t i : turns) {
    StepTime& step = steps_[i];
    step.phase = Phase::kDelayed;
    step.begin_tick = tick + step.delay_ticks;
    step.end_tick = tick + step.duration_ticks;
  }
  return turns;
}

std::vector<std::size_t> StageClock::TakeBegun(std::int64_t tick) {
  std::vector<std::size_t> begun;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    if (steps_[i].phase != Phase::kDelayed || tick < steps_[i].begin_tick) continue;
    steps_[i].phase = Phase::kPlays;
    begun.push_back(i);
  }
  return begun;
}

std::optional<std::int64_t> StageClock::End() const {
  std::int64_t end = 0;
  for (const StepTime& step : steps_) {
    if (step.phase == Phase::kWaits) return {};
    end = std::max(end, step.end_tick);
  }
  return end;
}

bool StageClock::IsStuck() const {
  bool waits = false;
  for (const StepTime& step : steps_) {
    if (step.phase == Phase::kDelayed || step.phase == Phase::kPlays) return false;
    waits |= step.phase == Phase::kWaits;
  }
  return waits;
}

}  // namespace prehend::physics
