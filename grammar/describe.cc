// SPDX-License-Identifier: Apache-2.0
#include "grammar/describe.h"

#include <algorithm>
#include <cmath>

#include "grammar/lanes.h"

namespace prehend::grammar {
namespace {

void Include(Wait& wait, const Wait& other) {
  wait.seconds = std::max(wait.seconds, other.seconds);
  wait.until_end_of.insert(other.until_end_of.begin(), other.until_end_of.end());
}

// Follows the schedule, so what a rule refers to is known before it.
class Waits {
 public:
  explicit Waits(const Program& program)
      : program_(program), end_(program.events.size()), truth_(program.events.size()) {
    for (const int rule : program.schedule) Work(rule);
  }
  const Wait& OfEnd(int rule) const { return end_[rule]; }

 private:
  void Work(int index) {
    const Rule& rule = program_.events[index];
    Wait& end = end_[index];
    // A composition waits for its parts' ends to be decided, every other rule for truths.
    const bool composes = rule.form == Form::kCompose;
    for (std::size_t i = 0; i < rule.references.size(); ++i) {
      const int target = rule.references[i].rule;
      Include(end, composes ? end_[target] : truth_[target]);
      if (composes) end.until_end_of.insert(program_.events[target].name);
    }
    end.seconds += rule.bridging_s + rule.looks_around_s;
    if (rule.confirmed_within != kNone) {
      end.until_end_of.insert(program_.events[rule.references[rule.confirmed_within].rule].name);
    }
    // The truth at a frame may have to wait for more than the end's decision: see engine_events.cc, UpdateKnown.
    Wait& truth = truth_[index];
    truth = end;
    truth.seconds += rule.lasting_s + rule.back_s + std::max(rule.within_s, 0.0);
    const bool decided_at_its_end = rule.or_drop || (rule.requirement != kNone && rule.form != Form::kUntilSince);
    if (decided_at_its_end) truth.until_end_of.insert(rule.name);
  }

  const Program& program_;
  std::vector<Wait> end_;
  std::vector<Wait> truth_;
};

std::string Watched(const Program& program, const Rule& rule) {
  if (rule.guard == kNone) {
    std::string text;
    for (const RuleRole& role : rule.roles) text += (text.empty() ? "every " : " and every ") + role.class_name;
    return text;
  }
  const Rule& guard = program.events[rule.references[rule.guard].rule];
  return guard.form == Form::kTouching ? "pairs that touch" : "while " + guard.name;
}

// A composition remembers so many intervals of each part.
std::size_t BytesPerBinding(const Rule& rule) {
  return sizeof(Lane) + rule.references.size() * sizeof(int) + rule.anchors.size() * 3 * sizeof(double) +
         rule.composition.parts.size() * kRememberedSpans * sizeof(Span);
}

std::string Head(const Rule& rule) {
  std::string text = rule.symmetric ? "symmetric event " : rule.printed ? "event " : "condition ";
  text += rule.name + "(";
  for (const RuleRole& role : rule.roles) text += (&role == &rule.roles.front() ? "" : ", ") + role.name + ": " + role.class_name;
  return text + ")";
}

// "at most 0.1 s after it and contact have ended"
std::string Text(const Wait& wait) {
  const double seconds = std::round(wait.seconds * 1e6) / 1e6;  // a sum's last digits are of no use
  const std::string when = seconds > 0 ? "at most " + QuantityText({seconds, kSeconds}) + " after " : "when ";
  std::string who = "it";
  for (const std::string& name : wait.until_end_of) {
    who += (name == *wait.until_end_of.rbegin() ? " and " : ", ") + name;
  }
  return when + who + (wait.until_end_of.empty() ? " has ended" : " have ended");
}

std::string ParamsText(const std::vector<ProgramParam>& params) {
  std::size_t name_width = 0;
  std::size_t value_width = 0;
  for (const ProgramParam& param : params) {
    name_width = std::max(name_width, param.name.size());
    value_width = std::max(value_width, QuantityText(param.value).size());
  }
  const auto padded = [](std::string text, std::size_t width) { return text.append(width - text.size(), ' '); };
  std::string text;
  for (const ProgramParam& param : params) {
    text += "param " + padded(param.name, name_width) + " = " + padded(QuantityText(param.value), value_width) + "  # " +
            param.file + ":" + std::to_string(param.place.line) + (param.overridden ? ", overridden" : "") + "\n";
  }
  return text;
}

}  // namespace

GrammarDescription Describe(const Program& program) {
  GrammarDescription description{.name = program.name,
                                 .params = program.params,
                                 .bytes_per_pose = sizeof(FrameNumber) + sizeof(EntityLook),
                                 .bytes_per_feeler = sizeof(Feeler)};
  const Waits waits(program);
  for (std::size_t i = 0; i < program.events.size(); ++i) {
    const Rule& rule = program.events[i];
    description.history_s = std::max(description.history_s, rule.back_s + rule.looks_around_s);
    if (rule.form == Form::kTouching || rule.hidden) continue;
    description.rules.push_back({.head = Head(rule),
                                 .printed = rule.printed,
                                 .latency = waits.OfEnd(static_cast<int>(i)),
                                 .watched = Watched(program, rule),
                                 .bytes_per_binding = BytesPerBinding(rule),
                                 .bytes_per_interval = rule.referenced ? sizeof(Span) : 0});
  }
  return description;
}

std::string Text(const GrammarDescription& description) {
  std::string text = "grammar " + description.name + "\n\n";
  for (const RuleDescription& rule : description.rules) {
    text += rule.head + "\n    decided: " + Text(rule.latency) + "; watched: " + rule.watched + "\n    memory: at most " +
            std::to_string(rule.bytes_per_binding) + " bytes per binding";
    if (rule.bytes_per_interval > 0) text += ", and " + std::to_string(rule.bytes_per_interval) + " for each of its recent intervals";
    text += "\n";
  }
  text += "\n";
  text += ParamsText(description.params);
  text += "\nmemory: poses of the last " + QuantityText({description.history_s, kSeconds}) + ", " +
          std::to_string(description.bytes_per_pose) + " bytes per frame and moving entity, " +
          std::to_string(description.bytes_per_feeler) + " per frame and feeler of a hand; intervals are recent as long as " +
          "their poses are kept\n";
  return text;
}

}  // namespace prehend::grammar
