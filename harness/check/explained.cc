// SPDX-License-Identifier: Apache-2.0
#include "harness/check/explained.h"

#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "harness/explain/explain.h"
#include "harness/explain/replay.h"
#include "harness/sense/entity_table.h"
#include "harness/sense/sensing.h"
#include "harness/timeline/event_text.h"

namespace prehend::harness {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ExplainedEvent, event, begin, end, began, ended)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DecidingSignal, clause, how, unit, tick, golden_tick, ticks,
                                   values, limits)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ExplainedDifference, what, text, signals)

void to_json(nlohmann::json& packed, const Explained& explained) {
  packed = {{"events", explained.events}, {"differences", explained.differences}};
}

void from_json(const nlohmann::json& packed, Explained& explained) {
  packed.at("events").get_to(explained.events);
  packed.at("differences").get_to(explained.differences);
}

namespace {

/// `golden_tick` as of a signal.
void AddSignals(const explain::Reasons& reasons, grammar::Tick golden_tick,
                std::vector<DecidingSignal>& signals) {
  for (const explain::Reason& reason : reasons) {
    if (signals.size() >= kMostSignals) return;
    if (reason.reading && reason.tick && reason.reading->course.size() > 1) {
      DecidingSignal signal{.clause = reason.what,
                            .how = reason.how,
                            .unit = reason.reading->unit,
                            .tick = *reason.tick,
                            .golden_tick = golden_tick,
                            .ticks = {},
                            .values = {},
                            .limits = {}};
      for (const explain::Reading::Sample& sample : reason.reading->course) {
        signal.ticks.push_back(sample.tick);
        signal.values.push_back(sample.value);
        signal.limits.push_back(sample.limit);
      }
      signals.push_back(std::move(signal));
    }
    AddSignals(reason.because, golden_tick, signals);
  }
}

/// The same question that DifferenceText() prints.
ExplainedDifference ExplainDifference(const Pairing& pairing, grammar::ReplayMonitor& past) {
  const grammar::Tick per_second = past.entity_table().ticks_per_second;
  const grammar::NamedEvent& event = pairing.actual ? *pairing.actual : *pairing.expected;
  ExplainedDifference difference{
      .what = fmt::format("{} {}", Name(pairing.agreement), pairing.event().Label()),
      .text = {},
      .signals = {}};
  std::string question = event.event;
  for (const grammar::Role& role : event.roles)
    if (!IsAttribute(role)) question += " " + role.value;
  question += " @" + SecondsText(event.interval.begin, per_second) + "s";
  const Result<explain::Ask> ask =
      explain::ParseAsk("event", question, past.program(), past.entity_table());
  if (!ask) return difference;
  const std::vector<explain::WhyEvent> there = explain::ExplainEvents(past, *ask);
  if (there.empty()) {
    const explain::WhyMissing why = explain::ExplainMissing(past, *ask);
    difference.text = explain::Text(why, per_second);
    AddSignals(why.reasons, -1, difference.signals);
  }
  const bool has_both = pairing.expected && pairing.actual;
  const auto golden_tick = [&](grammar::Tick offset, grammar::Tick tick) {
    return std::abs(offset) > pairing.tolerance ? tick : -1;
  };
  const grammar::Tick begin = has_both ? golden_tick(pairing.begin_offset,
                                                     pairing.expected->interval.begin)
                                       : -1,
                      end = has_both
                                ? golden_tick(pairing.end_offset, pairing.expected->interval.end)
                                : -1;
  for (const explain::WhyEvent& why : there) {
    difference.text += explain::Text(why, per_second);
    AddSignals(why.began, begin, difference.signals);
    AddSignals(why.ended, end, difference.signals);
  }
  return difference;
}

}  // namespace

Explained Explain(const Scenario& scenario, const RunResult& run,
                  std::shared_ptr<const grammar::Program> program, const Comparison& comparison) {
  Explained explained;
  const explain::Watched watched =
      explain::Watch(program, MakeEntityTable(scenario),
                     [&](const std::function<void(const grammar::Frame&)>& look) {
                       Sensing sensing(scenario.scene, scenario.sensing);
                       for (const physics::Snapshot& snapshot : run.recording)
                         if (sensing.Due(snapshot.tick)) look(sensing.Sense(snapshot));
                       return Episode::End{run.ticks + 1, ""};
                     });
  if (!watched.problem.empty()) return explained;
  grammar::ReplayMonitor& past = *watched.past;
  for (const explain::WhyEvent& why : explain::ExplainAll(past))
    explained.events.push_back({why.event, why.interval.begin, why.interval.end,
                                explain::InOneLine(why.began), explain::InOneLine(why.ended)});
  for (const Pairing* pairing : comparison.Differing()) {
    if (explained.differences.size() >= kMostExplained) break;
    explained.differences.push_back(ExplainDifference(*pairing, past));
  }
  return explained;
}

}  // namespace prehend::harness
