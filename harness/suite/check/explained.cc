// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/check/explained.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <tuple>

#include "harness/episode/sense/episode_format.h"
#include "harness/episode/sense/sensing.h"
#include "harness/show/explain/explain.h"
#include "harness/show/explain/query.h"
#include "harness/show/tracks/tracks.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {

using grammar::Tick;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ExplainedEvent, event, begin, end, began, ended)

namespace {

// Courses are long: a value of JSON for each number costs more than all that is asked of it.

template <typename T>
nlohmann::json AsBytes(const std::vector<T>& numbers) {
  const auto* const first = reinterpret_cast<const std::uint8_t*>(numbers.data());
  return nlohmann::json::binary(
      std::vector<std::uint8_t>(first, first + sizeof(T) * numbers.size()));
}

template <typename T>
void FromBytes(const nlohmann::json& packed, std::vector<T>& numbers) {
  const auto& bytes = packed.get_binary();
  numbers.resize(bytes.size() / sizeof(T));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), sizeof(T) * numbers.size());
}

}  // namespace

void to_json(nlohmann::json& packed, const DecidingSignal& signal) {
  const auto& [clause, how, unit, tick, golden_tick, ticks, values, limits] = signal;
  packed = {clause, how, unit, tick, golden_tick, AsBytes(ticks), AsBytes(values), AsBytes(limits)};
}

void from_json(const nlohmann::json& packed, DecidingSignal& signal) {
  auto& [clause, how, unit, tick, golden_tick, ticks, values, limits] = signal;
  std::tie(clause, how, unit, tick, golden_tick) =
      packed.get<std::tuple<std::string, std::string, std::string, Tick, Tick>>();
  FromBytes(packed.at(5), ticks);
  FromBytes(packed.at(6), values);
  FromBytes(packed.at(7), limits);
}

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
void AddSignals(const show::Reasons& reasons, grammar::Tick golden_tick,
                std::vector<DecidingSignal>& signals) {
  for (const show::Reason& reason : reasons) {
    if (signals.size() >= kMostSignals) return;
    if (reason.reading && reason.tick && reason.reading->course.size() > 1) {
      DecidingSignal signal{.clause = reason.what,
                            .how = reason.how,
                            .unit = reason.reading->unit,
                            .tick = *reason.tick,
                            .golden_tick = golden_tick};
      for (const show::Reading::Sample& sample : reason.reading->course) {
        signal.ticks.push_back(sample.tick);
        signal.values.push_back(sample.value);
        signal.limits.push_back(sample.limit);
      }
      signals.push_back(std::move(signal));
    }
    AddSignals(reason.because, golden_tick, signals);
  }
}

constexpr double kRobustAround_s = 0.4;
constexpr std::size_t kMostRobustSamples = 240;

/// By how much the event holds, before, in and after the interval; 0 is the limit. Nothing of rules
/// that have no robustness.
void AddRobustness(const std::string& label, const grammar::NamedEvent& event,
                   grammar::ReplayMonitor& past, std::vector<DecidingSignal>& signals) {
  const auto& rules = past.program().rules;
  const auto around = static_cast<Tick>(kRobustAround_s *
                                        static_cast<double>(past.entity_table().ticks_per_second));
  const std::size_t first = past.FrameAt(event.interval.begin - around),
                    last = std::min(past.frames(), past.FrameAt(event.interval.end + around) + 1);
  for (const grammar::RuleId rule : grammar::IdsOf(rules)) {
    if (rules[rule].name != event.event) continue;
    for (const grammar::InstanceId instance : past.InstancesOf(rule)) {
      if (show::Label(past, instance) != label) continue;
      const std::optional<show::Robustness> robustness = show::RobustnessOf(past, instance);
      if (!robustness || first >= last) return;
      DecidingSignal signal{.clause = "robustness of " + label,
                            .how = "above 0 it holds",
                            .unit = robustness->unit,
                            .tick = event.interval.begin};
      for (std::size_t i = first; i < last; i += 1 + (last - first) / kMostRobustSamples) {
        if (!std::isfinite(robustness->values[i])) continue;
        signal.ticks.push_back(past.TickOf(i));
        signal.values.push_back(robustness->values[i]);
        signal.limits.push_back(0);
      }
      if (signal.ticks.size() > 1) signals.push_back(std::move(signal));
      return;
    }
  }
}

/// The same question that DifferenceText() prints.
ExplainedDifference ExplainDifference(const truth::Pairing& pairing, grammar::ReplayMonitor& past) {
  const grammar::Tick per_second = past.entity_table().ticks_per_second;
  const grammar::NamedEvent& event = pairing.actual ? *pairing.actual : *pairing.expected;
  ExplainedDifference difference{
      .what = fmt::format("{} {}", Name(pairing.agreement), pairing.event().Label())};
  std::string label = event.event + "(";
  for (const grammar::Role& role : event.roles)
    if (!truth::IsAttribute(role)) label += (label.ends_with('(') ? "" : ", ") + role.value;
  const std::string question =
      truth::AskedAs(event) + " @" + truth::SecondsText(event.interval.begin, per_second) + "s";
  const Result<show::Ask> ask =
      show::ParseAsk("event", question, past.program(), past.entity_table());
  if (!ask) return difference;
  const std::vector<show::WhyEvent> there = show::ExplainEvents(past, *ask);
  if (there.empty()) {
    const show::WhyMissing why = show::ExplainMissing(past, *ask);
    difference.text = show::Text(why, per_second);
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
  for (const show::WhyEvent& why : there) {
    difference.text += show::Text(why, per_second);
    AddSignals(why.began, begin, difference.signals);
    AddSignals(why.ended, end, difference.signals);
  }
  AddRobustness(label + ")", event, past, difference.signals);
  return difference;
}

}  // namespace

Explained Explain(const scenario::Scenario& scenario, const episode::RunResult& run,
                  std::shared_ptr<const grammar::Program> program,
                  const truth::Comparison& comparison) {
  Explained explained;
  const show::Watched watched =
      show::Watch(program, episode::MakeEntityTable(scenario),
                  [&](const std::function<void(const grammar::Frame&)>& look) {
                    episode::Sensing sensing(scenario.scene, scenario.sensing);
                    for (const physics::Snapshot& snapshot : run.recording)
                      if (sensing.Due(snapshot.tick)) look(sensing.Sense(snapshot));
                    return episode::Episode::End{run.ticks + 1, ""};
                  });
  if (!watched.problem.empty()) return explained;
  grammar::ReplayMonitor& past = *watched.past;
  for (const show::WhyEvent& why : show::ExplainAll(past))
    explained.events.push_back({why.event, why.interval.begin, why.interval.end,
                                show::InOneLine(why.began), show::InOneLine(why.ended)});
  for (const truth::Pairing* pairing : comparison.Differing()) {
    if (explained.differences.size() >= kMostExplained) break;
    explained.differences.push_back(ExplainDifference(*pairing, past));
  }
  return explained;
}

}  // namespace prehend::suite
