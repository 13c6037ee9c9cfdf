// SPDX-License-Identifier: Apache-2.0
// How long each rule waits, in the order of the schedule: what a rule refers to is known before it.
#include "grammar/describe.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "grammar/analysis/value_ranges.h"
#include "grammar/state/instances.h"

namespace prehend::grammar {
namespace {

void Include(Wait& wait, const Wait& other) {
  wait.seconds = std::max(wait.seconds, other.seconds);
  wait.until_end_of.insert(other.until_end_of.begin(), other.until_end_of.end());
}

// Whose end that is; null if it is none, or that of more.
const Reference* EndOf(const Program& program, const Rule& rule, NodeId index) {
  const Node& node = program.nodes[index];
  if (node.op != Op::kEnds || program.nodes[node.args[0]].op != Op::kHolds) return nullptr;
  return &rule.references[program.nodes[node.args[0]].slot];
}

// Follows the schedule, so what a rule refers to is known before it.
class Waits {
 public:
  explicit Waits(const Program& program)
      : program_(program),
        end_(program.rules.size()),
        truth_(program.rules.size()),
        settled_(program.rules.size()) {
    for (const RuleId rule : program.schedule) Work(rule);
  }
  const Wait& OfEnd(RuleId rule) const { return end_[rule]; }

 private:
  void Work(RuleId index) {
    const Rule& rule = program_.rules[index];
    Wait& end = end_[index];
    const std::optional<std::string> settling = SettlesWhereItEnds(rule);
    end = WaitOf(rule, settling);
    if (rule.confirmed_within != kNone) {
      end.until_end_of.insert(program_.rules[rule.references[rule.confirmed_within].rule].name);
    }
    const auto* from_to = rule.If<FromToRule>();
    const auto* looks_back = rule.If<UntilSinceRule>();
    if (looks_back != nullptr) {
      settled_[index] = Settled{Signature(program_, rule, looks_back->until), end};
    } else if (const auto* rest = rule.If<RestOfRule>()) {
      if (const Settled* whole = SettledBy(rule.references[rest->whole]))
        settled_[index] = Settled{whole->moment, WaitOf(rule, whole->moment)};
    }
    // The truth at a frame may have to wait for more than the end's decision: see
    // grammar/engine/engine_events.cc, UpdateKnown.
    Wait& truth = truth_[index];
    truth = end;
    if (settling) Include(truth, WaitOf(rule, std::nullopt));
    truth.seconds += rule.lasting_s + (looks_back != nullptr ? looks_back->back_s : 0) +
                     (from_to != nullptr ? std::max(from_to->within_s, 0.0) : 0);
    const auto* composition = rule.If<ComposeRule>();
    if (composition != nullptr) IncludeWaiting(*composition, truth);
    const bool decided_at_its_end = (from_to != nullptr && from_to->or_drop) ||
                                    (rule.requirement != kNone && looks_back == nullptr);
    const auto* holds = rule.If<WhileRule>();
    if (decided_at_its_end || rule.lasting_most_s >= 0 || (holds != nullptr && holds->at_least > 1))
      truth.until_end_of.insert(rule.name);
  }

  // Where a composition holds is not known as long as an interval that may become its first part
  // waits for the others.
  static void IncludeWaiting(const ComposeRule& composition, Wait& truth) {
    truth.seconds += composition.within_s;
    for (const ComposeRule::Clause& clause : composition.clauses) {
      double longest_s = 0;
      for (std::size_t i = 0; i < clause.within_s.size(); ++i) {
        const auto relation = static_cast<Allen>(i);
        const bool is_gap = relation == Allen::kBefore || relation == Allen::kAfter;
        if ((clause.relations & Bit(relation)) == 0) continue;
        longest_s = std::max(longest_s, clause.within_s[i]);
        if (is_gap && clause.within_s[i] < 0 && composition.within_s == 0)
          truth.until_end_of.insert("the episode");
      }
      if (composition.within_s == 0) truth.seconds += longest_s;
    }
  }

  // `until A since F` is not known before an A comes, or the time to look back is over; where an A
  // comes, all before it is.
  struct Settled {
    std::string moment;  // the A
    Wait wait;           // from there on
  };

  // Null if that is no such rule, or if its roles are not those of the rule that asks.
  const Settled* SettledBy(const Reference& reference) const {
    const std::optional<Settled>& settled = settled_[reference.rule];
    for (std::size_t i = 0; i < program_.rules[reference.rule].roles.size(); ++i) {
      if (reference.roles[i] != static_cast<int>(i)) return nullptr;
    }
    return settled ? &*settled : nullptr;
  }

  // `to R ends`, R ending at such an A: what looks back from the same A needs no time there.
  std::optional<std::string> SettlesWhereItEnds(const Rule& rule) const {
    const auto* from_to = rule.If<FromToRule>();
    if (from_to == nullptr || from_to->absence) return std::nullopt;
    const Reference* const ends = EndOf(program_, rule, from_to->to);
    const Settled* const settled = ends == nullptr ? nullptr : SettledBy(*ends);
    return settled != nullptr ? std::optional(settled->moment) : std::nullopt;
  }

  // For all that the rule asks about. A composition waits for its parts' ends to be decided, every
  // other rule for truths.
  Wait WaitOf(const Rule& rule, const std::optional<std::string>& settling) const {
    Wait wait;
    const bool composes = rule.form() == Form::kCompose;
    for (const Reference& reference : rule.references) {
      const Settled* settled = settling ? SettledBy(reference) : nullptr;
      const bool is_settled = settled != nullptr && settled->moment == *settling;
      Include(wait, is_settled ? settled->wait
                    : composes ? end_[reference.rule]
                               : truth_[reference.rule]);
      if (composes) wait.until_end_of.insert(program_.rules[reference.rule].name);
    }
    const auto* holds = rule.If<WhileRule>();
    const auto* any = rule.If<AnyRule>();
    const auto* composition = rule.If<ComposeRule>();
    if (composition != nullptr && composition->at_least > 0) wait.seconds += composition->within_s;
    wait.seconds += (holds != nullptr ? holds->bridging_s : 0) +
                    (any != nullptr ? any->within_s : 0) + rule.looks_around_s;
    return wait;
  }

  const Program& program_;
  IdVector<RuleId, Wait> end_;
  IdVector<RuleId, Wait> truth_;
  IdVector<RuleId, std::optional<Settled>> settled_;  // those that are
};

std::string Watched(const Program& program, const Rule& rule) {
  if (rule.guard == kNone) {
    std::string text;
    for (const RuleRole& role : rule.roles)
      text += (text.empty() ? "every " : " and every ") + role.class_name;
    return text;
  }
  const Rule& guard = program.rules[rule.references[rule.guard].rule];
  if (guard.name == rule.name) return "candidates";
  return guard.form() == Form::kTouching ? "pairs that touch" : "while " + guard.name;
}

/// Its places in the indexes of the engine, and in the lists of those that are told of a change.
constexpr std::size_t kIndexed_bytes = 1024;

std::size_t BytesPerBinding(const Rule& rule) {
  return sizeof(RuleInstance) + rule.references.size() * sizeof(int) +
         rule.anchors.size() * 3 * sizeof(double) + kIndexed_bytes;
}

std::string Head(const Rule& rule) {
  std::string text = rule.symmetric ? "symmetric event " : rule.printed ? "event " : "condition ";
  text += rule.name + "(";
  for (const RuleRole& role : rule.roles)
    text += (&role == &rule.roles.front() ? "" : ", ") + role.name + ": " + role.class_name;
  return text + ")";
}

// "at most 0.1 s after it and contact have ended"
std::string Text(const Wait& wait) {
  const double seconds = std::round(wait.seconds * 1e6) / 1e6;  // a sum's last digits are of no use
  const std::string when =
      seconds > 0 ? "at most " + QuantityText({seconds, kSeconds}) + " after " : "when ";
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
    value_width = std::max(value_width, ReadableQuantityText(param.value).size());
  }
  const auto padded = [](std::string text, std::size_t width) {
    return text.append(width - text.size(), ' ');
  };
  std::string text;
  for (const ProgramParam& param : params) {
    text += "param " + padded(param.name, name_width) + " = " +
            padded(ReadableQuantityText(param.value), value_width) + "  # " + param.file + ":" +
            std::to_string(param.place.line) + (param.overridden ? ", overridden" : "") + "\n";
  }
  return text;
}

}  // namespace

GrammarDescription Describe(const Program& program) {
  GrammarDescription description{.name = program.name,
                                 .params = program.params,
                                 .bytes_per_pose = sizeof(FrameNumber) + sizeof(EntitySample),
                                 .bytes_per_feeler = sizeof(CollisionSphere)};
  const Waits waits(program);
  for (const RuleId id : IdsOf(program.rules)) {
    const Rule& rule = program.rules[id];
    const auto* looks_back = rule.If<UntilSinceRule>();
    const Approach* approach = ApproachOf(rule);
    const double waits_s = rule.TriesEachBegin() ? rule.As<FromToRule>().within_s : 0;
    description.history_s =
        std::max(description.history_s, (looks_back != nullptr ? looks_back->back_s : waits_s) +
                                            (approach != nullptr ? approach->looks_around_s() : 0) +
                                            rule.looks_around_s);
    if (rule.form() == Form::kTouching || rule.hidden) continue;
    description.rules.push_back(
        {.name = rule.name,
         .head = Head(rule),
         .printed = rule.printed,
         .latency = waits.OfEnd(id),
         .watched = Watched(program, rule),
         .bytes_per_binding = BytesPerBinding(rule),
         .bytes_per_interval = rule.referenced ? sizeof(Span) : 0,
         .bytes_per_begin =
             rule.form() == Form::kFromTo && rule.As<FromToRule>().each ? sizeof(Moment) : 0,
         .bytes_per_part = rule.form() == Form::kCompose ? sizeof(Span) : 0});
  }
  for (const Law& law : program.laws) description.laws.push_back({law.Head(), law.says});
  return description;
}

std::string Text(const GrammarDescription& description) {
  std::string text = "grammar " + description.name + "\n\n";
  for (const RuleDescription& rule : description.rules) {
    text += rule.head + "\n    decided: " + Text(rule.latency) + "; evaluated: " + rule.watched +
            "\n    memory: at most " + std::to_string(rule.bytes_per_binding) +
            " bytes per binding";
    if (rule.bytes_per_interval > 0)
      text +=
          ", and " + std::to_string(rule.bytes_per_interval) + " for each of its recent intervals";
    if (rule.bytes_per_begin > 0)
      text += ", and " + std::to_string(rule.bytes_per_begin) + " for each A that waits for B";
    if (rule.bytes_per_part > 0)
      text += ", and " + std::to_string(rule.bytes_per_part) +
              " for each interval of a part that waits for others";
    text += "\n";
  }
  for (const LawDescription& law : description.laws) text += law.head + "\n    " + law.says + "\n";
  text += "\n";
  text += ParamsText(description.params);
  text += "\nmemory: poses of the last " +
          QuantityText({AsWritten(description.history_s), kSeconds}) + ", " +
          std::to_string(description.bytes_per_pose) + " bytes per frame and moving entity, " +
          std::to_string(description.bytes_per_feeler) +
          " per frame and collision sphere of a hand; intervals are recent as long as " +
          "their poses are kept\n";
  return text;
}

}  // namespace prehend::grammar
