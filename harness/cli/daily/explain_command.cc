// SPDX-License-Identifier: Apache-2.0
// prehend explain: why an event has its boundaries, or why there is none.
// Tested by tests/program/explain_command_test.cc
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/base/base/quoting.h"
#include "harness/cli/command/command.h"
#include "harness/episode/run/run_text.h"
#include "harness/show/explain/explain.h"
#include "harness/show/explain/query.h"
#include "harness/show/explain/why_event.h"
#include "harness/suite/check/last_pass.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::cli {
namespace {

using show::Ask;
using show::WhyEvent;

episode::OrderedJson ToJson(const std::string& episode, const grammar::ReplayMonitor& past) {
  return {{"episode", episode},
          {"grammar", past.program().name},
          {"ticks_per_second", past.entity_table().ticks_per_second}};
}

episode::OrderedJson ToJson(const std::vector<WhyEvent>& events, grammar::Tick ticks_per_second) {
  episode::OrderedJson list = episode::OrderedJson::array();
  for (const WhyEvent& why : events) list.push_back(show::ToJson(why, ticks_per_second));
  return list;
}

void PrintEvents(const std::vector<WhyEvent>& events, grammar::Tick ticks_per_second,
                 std::ostream& out) {
  for (const WhyEvent& why : events)
    out << (&why == &events.front() ? "" : "\n") << show::Text(why, ticks_per_second);
}

/// Reports that no such event was recognised, with the nearest ones.
ExitCode ComplainOfNoEvent(const ParsedOptions& options, grammar::ReplayMonitor& past,
                           const Ask& ask, const CommandContext& context) {
  const std::string typed = options.Text("--event");
  const std::vector<WhyEvent> nearest = show::NearestEvents(past, ask);
  std::string message = fmt::format("--event: there is no '{}'{}", typed,
                                    nearest.empty() ? " in the whole episode" : "; the nearest:");
  for (const WhyEvent& other : nearest) {
    message +=
        fmt::format("\n  {}  {}", other.event,
                    truth::IntervalText(other.interval, past.entity_table().ticks_per_second));
  }
  message += fmt::format("\n  why not: {} --expected {}",
                         suite::CommandAbout("explain", options.Text("EPISODE"),
                                             {options.Text("--grammar"), options.All("--set")}),
                         ShellQuoted(typed));
  return Complain(context, ExitCode::kNothing, message);
}

/// What is asked for; when neither is set: all events.
struct Question {
  std::optional<Ask> event;
  std::optional<Ask> expected;
};

ExitCode Answer(const ParsedOptions& options, const CommandContext& context,
                episode::Episode& played, const Question& question, grammar::ReplayMonitor& past) {
  const grammar::Tick per_second = past.entity_table().ticks_per_second;
  const bool as_json = options.Has("--json");
  episode::OrderedJson json = ToJson(played.loaded().scenario.name, past);
  const show::Recognise recognise = [&](const auto& program) -> std::optional<grammar::Timeline> {
    Result<grammar::Timeline> timeline = played.Segment(program);
    return timeline ? std::optional(std::move(*timeline)) : std::nullopt;
  };
  if (question.expected) {
    // An event that did happen is explained like any other.
    const std::vector<WhyEvent> there = show::ExplainEvents(past, *question.expected);
    if (there.empty()) {
      show::WhyMissing why = show::ExplainMissing(past, *question.expected);
      show::FindDecisive(past, *question.expected, recognise, why);
      json["missing"] = show::ToJson(why, per_second);
      if (!as_json) context.out << show::Text(why, per_second);
    } else {
      json["events"] = ToJson(there, per_second);
      if (!as_json) context.out << "it happened:\n";
      if (!as_json) PrintEvents(there, per_second, context.out);
    }
  } else if (question.event) {
    std::vector<WhyEvent> events = show::ExplainEvents(past, *question.event);
    if (events.size() == 1) show::FindDecisive(past, *question.event, recognise, events.front());
    if (events.empty()) return ComplainOfNoEvent(options, past, *question.event, context);
    json["events"] = ToJson(events, per_second);
    if (!as_json) PrintEvents(events, per_second, context.out);
  } else {
    const std::vector<WhyEvent> events = show::ExplainAll(past);
    json["events"] = ToJson(events, per_second);
    if (!as_json && events.empty())
      context.out << "no event was recognised; --expected EVENT explains why\n";
    if (!as_json && !events.empty()) context.out << show::Table(events, per_second);
  }
  if (as_json) context.out << json.dump(2) << "\n";
  return ExitCode::kAgrees;
}

ExitCode RunExplain(const ParsedOptions& options, const CommandContext& context) {
  if (options.Has("--event") && options.Has("--expected")) {
    return Refuse(context, "--event contradicts --expected; give one of them");
  }
  PREHEND_TRY(auto episode, OpenEpisodeOrComplain(options.Text("EPISODE"), options, context));

  Question question;
  for (const auto& [option, ask] :
       {std::pair{"--event", &question.event}, std::pair{"--expected", &question.expected}}) {
    if (!options.Has(option)) continue;
    const Result<Ask> read =
        show::ParseAsk(option, options.Text(option), *episode.program(), episode.entities());
    if (!read) return Complain(context, read.error());
    *ask = *read;
  }
  const show::Watched watched = show::Watch(episode);
  if (!watched.problem.empty()) return Refuse(context, watched.problem);
  const grammar::ReplayMonitor& past = *watched.past;
  const std::optional<Ask>& ask = question.event ? question.event : question.expected;
  if (ask && ask->time_s &&
      truth::TickAt(*ask->time_s, past.entity_table().ticks_per_second) >
          past.TickOf(past.frames()))
    context.err << fmt::format(
        "prehend: warning: {:g} s is after the end; this is the end of the episode\n",
        *ask->time_s);
  const ExitCode code = Answer(options, context, episode, question, *watched.past);
  if (watched.failure.empty() || code != ExitCode::kAgrees) return code;
  return Complain(context, ExitCode::kFailure, watched.failure);
}

}  // namespace

Command ExplainCommand() {
  return {.name = "explain",
          .summary = "Explain why events began and ended when they did, or why one did not happen",
          .examples = {"explain milk_carton_wrap", "explain milk_carton_wrap --event reaching@0.5s",
                       "explain milk_carton_wrap --expected 'sliding right_hand milk @2.0s'",
                       "explain milk_carton_wrap --set lift_rise=40cm --expected picking_up --json",
                       "explain milk.jsonl --event 'grasping(right_hand, milk)'"},
          .options = {EpisodeArgument(), EpisodeOption(),
                      Value("--event", "EVENT[@TIME]",
                            "an event that happened: reaching@1.24s, 'sliding right_hand milk "
                            "@2.0s'"),
                      Value("--expected", "EVENT[@TIME]",
                            "an event that did not happen: 'sliding right_hand milk @2.0s'"),
                      GrammarOption(), SettingsOption(), JsonOption()},
          .run = RunExplain};
}

}  // namespace prehend::cli
