// SPDX-License-Identifier: Apache-2.0
// In this order: thresholds, references between rules, guards, moments that open a rule, what is
// asked of entities at every frame, and how far a rule looks around.
#include "grammar/analysis/analyze_dependencies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "grammar/analysis/contradictions.h"

namespace prehend::grammar {
namespace {

// `sensor_sets(hand, object) >= 2` and `up(a, b) >= 0.5` are false unless the two touch.
bool ImpliesTouch(const Program& program, const Node& node) {
  const Node& left = program.nodes[node.args[0]];
  const Node& right = program.nodes[node.args[1]];
  if (right.op != Op::kNumber) return false;
  const bool sets = left.op == Op::kSensorSets || left.op == Op::kForceBetween;
  if (!sets && left.op != Op::kUp) return false;
  const double when_apart = sets ? 0 : -1;
  return (node.op == Op::kGreaterEqual && right.number > when_apart) ||
         (node.op == Op::kGreater && right.number >= when_apart);
}

// References that must be true whenever the node is; at a moment they may have been so up to there,
// if `at_moments`.
void CollectNecessary(const Program& program, NodeId index, std::vector<int>& references,
                      bool at_moments = true) {
  if (index == kNone) return;
  const Node& node = program.nodes[index];
  if (node.op == Op::kHolds || node.op == Op::kSensorSet) {
    references.push_back(node.slot);
  } else if (node.op == Op::kAnd || node.op == Op::kKnown) {
    CollectNecessary(program, node.args[0], references, at_moments);
    CollectNecessary(program, node.args[1], references, at_moments);
  } else if (node.op == Op::kBegins || node.op == Op::kEnds) {
    if (at_moments) CollectNecessary(program, node.args[0], references);
  } else if (IsComparison(node.op) && ImpliesTouch(program, node)) {
    references.push_back(program.nodes[node.args[0]].slot);
  }
}

// How many bindings one binding of the reference wakes, roughly: a free Hand costs less than any
// other free role.
int Fanout(const Rule& rule, const Reference& reference) {
  int fanout = 0;
  for (std::size_t role = 0; role < rule.roles.size(); ++role) {
    const bool named =
        std::count(reference.roles.begin(), reference.roles.end(), static_cast<int>(role)) > 0;
    if (!named) fanout += rule.roles[role].class_name == "Hand" ? 1 : 10;
  }
  return fanout;
}

// The last of equals: conditions that are built on others stand later and hold more rarely.
int MostSpecific(const Rule& rule, const std::vector<int>& candidates) {
  int best = kNone;
  for (const int candidate : candidates) {
    if (best == kNone ||
        Fanout(rule, rule.references[candidate]) <= Fanout(rule, rule.references[best]))
      best = candidate;
  }
  return best;
}

int ChooseGuard(const Program& program, const Rule& rule) {
  std::vector<int> candidates;
  switch (rule.form()) {
    case Form::kTouching:
      return kNone;
    case Form::kAny:
      return 0;
    case Form::kWhile:
      CollectNecessary(program, rule.As<WhileRule>().condition, candidates);
      break;
    case Form::kFromTo:
      CollectNecessary(program, rule.As<FromToRule>().during, candidates);
      CollectNecessary(program, rule.As<FromToRule>().from, candidates);
      break;
    case Form::kUntilSince:
      // If no rule asks where it does not hold, it is enough to wake at its end; else its truth
      // must be known at all times. It ends a frame later than that what leads to it holds.
      CollectNecessary(program, rule.As<UntilSinceRule>().since, candidates, false);
      if (!rule.referenced) CollectNecessary(program, rule.As<UntilSinceRule>().until, candidates);
      break;
    case Form::kRestOf:
      candidates.push_back(rule.As<RestOfRule>().whole);
      break;
    case Form::kCompose:
      return rule.As<ComposeRule>().parts.front();  // and woken by each interval of a part
  }
  return MostSpecific(rule, candidates);
}

// Whether the guard must be true in the very frame in which something begins.
bool GuardsBegin(const Program& program, const Rule& rule) {
  std::vector<int> needed;
  if (const auto* from_to = rule.If<FromToRule>()) {
    CollectNecessary(program, from_to->during, needed, false);
    CollectNecessary(program, from_to->from, needed, false);
  }
  if (const auto* looks_back = rule.If<UntilSinceRule>())
    CollectNecessary(program, looks_back->until, needed, false);
  return std::find(needed.begin(), needed.end(), rule.guard) != needed.end();
}

// A moment that must be there when something begins, if it is the begin or the end of an event.
void FindOpening(const Program& program, Rule& rule, NodeId index) {
  const Node& node = program.nodes[index];
  if (node.op == Op::kAnd) {
    FindOpening(program, rule, node.args[0]);
    FindOpening(program, rule, node.args[1]);
  } else if ((node.op == Op::kBegins || node.op == Op::kEnds) &&
             program.nodes[node.args[0]].op == Op::kHolds) {
    rule.opened_by = program.nodes[node.args[0]].slot;
    rule.opened_by_end = node.op == Op::kEnds;
  }
}

bool UsesLooks(const Program& program, NodeId index) {
  if (index == kNone) return false;
  const Node& node = program.nodes[index];
  return RowOf(node.op).IsLook() ||
         std::ranges::any_of(node.args, [&](NodeId arg) { return UsesLooks(program, arg); });
}

// For values of a touch, not only for thresholds that it has crossed.
bool AsksTouches(const Program& program, NodeId index) {
  if (index == kNone) return false;
  const Node& node = program.nodes[index];
  if (node.by_threshold.value != kNone) return false;
  return RowOf(node.op).AsksTouchValues() ||
         std::any_of(node.args.begin(), node.args.end(),
                     [&](NodeId arg) { return AsksTouches(program, arg); });
}

// Whether it compares what a touch measures with thresholds.
bool ComparesTouches(const Program& program, NodeId index) {
  if (index == kNone) return false;
  const Node& node = program.nodes[index];
  if (node.by_threshold.value != kNone)
    return program.nodes[node.by_threshold.value].op != Op::kTrigger;
  return std::any_of(node.args.begin(), node.args.end(),
                     [&](NodeId arg) { return ComparesTouches(program, arg); });
}

double LooksAround(const Program& program, NodeId index) {
  if (index == kNone) return 0;
  const Node& node = program.nodes[index];
  double seconds = 0;
  for (const NodeId arg : node.args) seconds = std::max(seconds, LooksAround(program, arg));
  return node.window != kNone ? seconds + node.number / 2 : seconds;
}

// Windows, one in another; a value that asks for the frame before counts as one, too.
int Windows(const Program& program, NodeId index) {
  if (index == kNone) return 0;
  const Node& node = program.nodes[index];
  int windows = 0;
  for (const NodeId arg : node.args) windows = std::max(windows, Windows(program, arg));
  return RowOf(node.op).ChangesByItself() && node.op != Op::kNearest ? windows + 1 : windows;
}

// The number of a threshold, entered if it is new; kNone if there are too many.
int Enter(Program& program, const Threshold& threshold) {
  const auto found = std::find(program.thresholds.begin(), program.thresholds.end(), threshold);
  const auto place = static_cast<int>(found - program.thresholds.begin());
  if (place == kMaxThresholds) return kNone;
  if (found == program.thresholds.end()) program.thresholds.push_back(threshold);
  return place;
}

// Nothing is larger than what is endless, nor at least what is no number.
double NextLarger(double number) {
  using Limits = std::numeric_limits<double>;
  return number < Limits::infinity() ? std::nextafter(number, Limits::infinity())
                                     : Limits::quiet_NaN();
}

// `value >= number`, or another order or the other way round, is answered when the value is
// measured.
void FindThreshold(Program& program, Node& node) {
  if (node.op < Op::kLess || node.op > Op::kGreaterEqual) return;
  const bool mirrored = program.nodes[node.args[0]].op == Op::kNumber;
  const Op op = mirrored ? Mirrored(node.op) : node.op;
  const NodeId value = node.args[mirrored ? 1 : 0];
  const Node& number = program.nodes[node.args[mirrored ? 0 : 1]];
  const std::optional<Measured>& measured = RowOf(program.nodes[value].op).measured_as;
  if (number.op != Op::kNumber || !measured) return;
  const bool strict = op == Op::kGreater || op == Op::kLessEqual;
  const bool when_crossed = op == Op::kGreater || op == Op::kGreaterEqual;
  const double at_least = strict ? NextLarger(number.number) : number.number;
  const int as_named = Enter(program, {(*measured)[0], at_least});
  const int swapped = Enter(program, {(*measured)[1], at_least});
  // A speed is at least 0, if it is a number.
  const bool may_be_unknown = program.nodes[value].op == Op::kTouchSpeed;
  const int known = may_be_unknown ? Enter(program, {(*measured)[0], 0}) : kNone;
  if (as_named != kNone && swapped != kNone && may_be_unknown == (known != kNone))
    node.by_threshold = {value, {as_named, swapped}, when_crossed, known};
}

ThresholdSet BitOf(int threshold) { return threshold == kNone ? 0 : ThresholdSet{1} << threshold; }

// Only these thresholds matter of what is measured.
void WatchThresholds(const Program& program, Rule& rule, const ByThreshold& by) {
  const ThresholdSet all = BitOf(by.thresholds[0]) | BitOf(by.thresholds[1]) | BitOf(by.known);
  const Node& value = program.nodes[by.value];
  if (value.op == Op::kTrigger) rule.watches_grip[value.roles[0]] = true;
  (value.op == Op::kTrigger ? rule.watches_grips : rule.watches_press) |= all;
}

// Adds a comparison to what must be measured, if it is of the same touch or hand as the others.
bool AddMeasured(const Program& program, MeasuredPart& part, const ByThreshold& by) {
  const Node& value = program.nodes[by.value];
  const auto add = [&](Limits& limits, int threshold) {
    (by.when_crossed ? limits.crossed : limits.not_crossed) |= BitOf(threshold);
    limits.crossed |= BitOf(by.known);
  };
  if (value.op == Op::kTrigger) {
    if (part.hand != kNone && part.hand != value.roles[0]) return false;
    part.hand = value.roles[0];
    add(part.grip, by.thresholds[0]);
    return true;
  }
  if (part.touch != kNone && part.touch != value.slot) return false;
  part.touch = value.slot;
  if (part.first == kNone) part.first = value.roles[0];
  const std::size_t swapped = part.first == value.roles[0] ? 0 : 1;
  add(part.press[swapped], by.thresholds[0]);
  add(part.press[1 - swapped], by.thresholds[1]);
  return true;
}

void FindMeasured(const Program& program, const Rule& rule, MeasuredPart& part, NodeId index) {
  const Node& node = program.nodes[index];
  const bool touching = node.op == Op::kHolds && rule.references[node.slot].rule == kTouchingRule;
  if (node.op == Op::kAnd) {
    FindMeasured(program, rule, part, node.args[0]);
    FindMeasured(program, rule, part, node.args[1]);
  } else if (node.by_threshold.value != kNone) {
    part.whole = AddMeasured(program, part, node.by_threshold) && part.whole;
  } else if (touching && (part.touch == kNone || part.touch == node.slot)) {
    part.touch = node.slot;
    part.must_touch = true;
  } else {
    part.whole = false;
  }
}

// All that it asks is measured: each frame is decided when it is there, and none is looked at
// later.
bool IsKnownAtOnce(const Rule& rule) {
  return rule.measured.whole && !rule.measured.is_empty() && rule.requirement == kNone &&
         rule.confirmed_by == kNone && rule.attributes.empty() && rule.anchors.empty();
}

// And nothing else has a say in when its intervals begin and end, and whether they are any.
bool IsInstant(const Rule& rule) {
  const auto* part = rule.If<WhileRule>();
  return IsKnownAtOnce(rule) && rule.measured.touch != kNone && part != nullptr &&
         part->bridging_s == 0 &&
         ((rule.lasting_s == 0 && rule.lasting_most_s < 0) || !rule.referenced);
}

// A value where the interval begins or ends is not asked for at every frame.
void WatchEntities(const Program& program, Rule& rule, NodeId index) {
  if (index == kNone) return;
  const Node& node = program.nodes[index];
  if (node.by_threshold.value != kNone) return WatchThresholds(program, rule, node.by_threshold);
  if (node.op == Op::kAtEnd) return;
  const Operator& row = RowOf(node.op);
  if (row.AsksTouchValues()) rule.watches_press |= kAnyChange;
  if (row.asks == Asks::kGrip) rule.watches_grips |= kAnyChange;
  for (const int role : node.roles) {
    if (role != kNone && row.asks == Asks::kGrip) rule.watches_grip[role] = true;
    if (role != kNone && row.AsksPoses()) rule.watches_pose[role] = true;
  }
  for (const NodeId arg : node.args) WatchEntities(program, rule, arg);
}

// A composition gets finished intervals; every other rule asks for the truth at a frame.
void MarkReferenced(Program& program, RuleId index) {
  const Rule& rule = program.rules[index];
  const auto* composition = rule.If<ComposeRule>();
  if (composition == nullptr) {
    for (const Reference& reference : rule.references)
      program.rules[reference.rule].referenced = true;
    return;
  }
  for (std::size_t part = 0; part < composition->parts.size(); ++part) {
    const RuleId target = rule.references[composition->parts[part]].rule;
    program.rules[target].part_of.push_back({index, static_cast<int>(part)});
  }
}

// Where a composition holds, for those who ask, is known when it is known where its first part
// does.
void MarkFirstParts(Program& program, RuleId index) {
  const auto* composition = program.rules[index].If<ComposeRule>();
  if (composition == nullptr || !program.rules[index].referenced) return;
  for (std::size_t part = 0; part < composition->parts.size(); ++part) {
    if (!composition->MayBegin(part)) continue;
    const auto slot = static_cast<std::size_t>(composition->parts[part]);
    program.rules[program.rules[index].references[slot].rule].referenced = true;
  }
}

// Where something of the rule begins, if that can be the moment of an event.
void FindOpening(const Program& program, Rule& rule) {
  if (const auto* from_to = rule.If<FromToRule>()) FindOpening(program, rule, from_to->from);
  // An `until` that others ask about must know at all times how far back a later one can reach.
  if (const auto* looks_back = rule.If<UntilSinceRule>(); looks_back != nullptr && !rule.referenced)
    FindOpening(program, rule, looks_back->until);
}

void FindMeasured(const Program& program, Rule& rule) {
  const auto* holds = rule.If<WhileRule>();
  const auto* from_to = rule.If<FromToRule>();
  if (holds == nullptr && from_to == nullptr) return;
  FindMeasured(program, rule, rule.measured, holds != nullptr ? holds->condition : from_to->from);
  rule.measured.whole =
      rule.measured.whole && holds != nullptr && holds->until == kNone && holds->at_least == 0;
  rule.measured.instant = IsInstant(rule);
}

// What it asks of entities at every frame. `since` is asked for when the end is there, unless
// others must know at all times.
void WatchEntities(const Program& program, Rule& rule) {
  const auto* looks_back = rule.If<UntilSinceRule>();
  for (const NodeId node : ConditionsOf(rule)) {
    const bool later = looks_back != nullptr && node == looks_back->since && !rule.referenced;
    if (!later) WatchEntities(program, rule, node);
  }
}

}  // namespace

void ChooseGuards(Program& program) {
  ShareValues(program);
  for (Node& node : program.nodes) FindThreshold(program, node);
  for (const RuleId rule : IdsOf(program.rules)) MarkReferenced(program, rule);
  for (auto rule = program.schedule.rbegin(); rule != program.schedule.rend(); ++rule)
    MarkFirstParts(program, *rule);
  for (Rule& rule : program.rules) {
    rule.guard = ChooseGuard(program, rule);
    rule.guarded_begin = GuardsBegin(program, rule);
    FindOpening(program, rule);
    WatchEntities(program, rule);
    FindMeasured(program, rule);

    rule.anchors_at_hand =
        !rule.anchors.empty() && std::ranges::all_of(rule.anchors, [&](NodeId anchor) {
          return Windows(program, anchor) == 0 || rule.anchors.size() == 1;
        });
    const Approach* const approach = ApproachOf(rule);
    std::vector<NodeId> nodes = ConditionsOf(rule);
    nodes.push_back(rule.requirement);
    const auto* any = rule.If<AnyRule>();
    rule.uses_looks =
        (any != nullptr && any->one != kNone) || rule.style_role != kNone || approach != nullptr ||
        !rule.anchors.empty() || !rule.attributes.empty() ||
        std::ranges::any_of(nodes, [&](NodeId node) { return UsesLooks(program, node); });
    nodes.insert(nodes.end(), rule.anchors.begin(), rule.anchors.end());
    for (const RuleAttribute& attribute : rule.attributes) nodes.push_back(attribute.node);
    if (approach != nullptr) nodes.insert(nodes.end(), {approach->signal, approach->motion});
    for (const NodeId node : nodes) {
      rule.looks_around_s = std::max(rule.looks_around_s, LooksAround(program, node));
      if (rule.looks_around_s > 0) rule.windows = std::max(rule.windows, Windows(program, node));
      program.asks_touches = program.asks_touches || AsksTouches(program, node);
      program.recalls_touches =
          program.recalls_touches || (!IsKnownAtOnce(rule) && ComparesTouches(program, node));
    }
  }
}

}  // namespace prehend::grammar
