// SPDX-License-Identifier: Apache-2.0
#include "harness/show/explain/clauses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/show/explain/query.h"

namespace prehend::show {

using grammar::CandidateOutcome;
using grammar::FrameNumber;
using grammar::InstanceId;
using grammar::kNone;
using grammar::Node;
using grammar::Op;
using grammar::Tick;
using Mark = Reason::Mark;

namespace {

constexpr double kCourse_s = 0.4;  ///< on both sides of the frame that decided

}  // namespace

std::string Clauses::Time(FrameNumber frame) {
  return At(past_.TickOf(frame), past_.entity_table().ticks_per_second);
}

bool Clauses::IsChoice(grammar::NodeId node, bool truth) const {
  const Op op = NodeAt(node).op;
  if (op == Op::kNot) return IsChoice(NodeAt(node).args[0], !truth);
  return truth ? op == Op::kOr : op == Op::kAnd;
}

// Of a choice that is fulfilled, nothing is missing: what fulfils it is all there is to say.
void Clauses::Split(grammar::NodeId node, const Viewpoint& at, bool truth,
                    std::vector<Clause>& out) {
  const Node& n = NodeAt(node);
  if (n.op == Op::kNot) return Split(n.args[0], at, !truth, out);
  if (n.op != Op::kAnd && n.op != Op::kOr) return out.push_back({node, truth});
  const bool is_fulfilled_choice = IsChoice(node, truth) && past_.Is(truth, node, at);
  for (const grammar::NodeId arg : {n.args[0], n.args[1]}) {
    if (!is_fulfilled_choice || past_.Is(truth, arg, at)) Split(arg, at, truth, out);
  }
}

std::vector<Clauses::Clause> Clauses::Split(grammar::NodeId node, const Viewpoint& at, bool truth) {
  std::vector<Clause> clauses;
  Split(node, at, truth, clauses);
  return clauses;
}

std::optional<Clauses::Measured> Clauses::Measure(grammar::NodeId node, const Viewpoint& at) {
  const Node& n = NodeAt(node);
  if (IsComparison(n.op)) {
    const auto value = past_.Number(n.args[0], at);
    const auto limit = past_.Number(n.args[1], at);
    if (!value || !limit || std::isnan(*value) || std::isnan(*limit)) return std::nullopt;
    return Measured{*value, *limit, NoteOf(past_.program(), n.args[0]).dimension, ""};
  }
  if (!IsRegion(n.op)) return std::nullopt;
  const auto reach = past_.ReachOf(node, at);
  if (!reach || std::isnan(reach->distance_m + reach->radius_m)) return std::nullopt;
  const Measured across{reach->distance_m, reach->radius_m, grammar::kMetres, " from the centre"};
  const Measured upright{reach->height_m, reach->most_height_m, grammar::kMetres,
                         " above or below the centre"};
  if (n.op != Op::kInCylinder) return across;
  // The side of the cylinder that is nearest to being crossed, or is crossed most.
  return reach->distance_m - reach->radius_m >= reach->height_m - reach->most_height_m ? across
                                                                                       : upright;
}

bool Clauses::IsNotTracked(grammar::NodeId node, const Viewpoint& at) {
  return !past_.Is(true, node, at) && !past_.Is(false, node, at);
}

Reason Clauses::Measurement(const Clause& clause, const Viewpoint& at,
                            const std::optional<Measured>& before) {
  Reason reason{.mark = Mark::kHeld,
                .what = ClauseText(past_, at.instance, clause.node),
                .tick = past_.TickOf(at.frame)};
  const std::optional<Measured> now = Measure(clause.node, at);
  if (IsNotTracked(clause.node, at)) reason.how = "is unknown: what it measures is not tracked";
  if (!now) return reason;
  const std::string unit =
      now->dimension == grammar::kPlain ? "" : grammar::DimensionText(now->dimension);
  reason.reading = Reading{now->value, now->limit, unit, {}};
  const ValueTexts texts = Compared(now->value, now->limit, now->dimension);
  const bool is_region = !now->of.empty();
  const std::string verb = !before || before->of != now->of ? "is"
                           : now->value > before->value     ? "rose to"
                           : now->value < before->value     ? "fell to"
                                                            : "stayed at";
  std::string relation = now->value > now->limit   ? (is_region ? "beyond " : "above ")
                         : now->value < now->limit ? (is_region ? "within " : "below ")
                                                   : "equal to ";
  reason.how = fmt::format("{} {}{}, ", verb, texts.value, now->of);
  const double by = std::abs(now->value - now->limit);
  const bool tell_by = verb == "is" && by > 0 && std::isfinite(by);
  if (tell_by) relation = QuantityText(by, now->dimension) + " " + relation;
  reason.how += relation + texts.limit;
  return reason;
}

std::vector<Reading::Sample> Clauses::Course(grammar::NodeId node, const Viewpoint& at) {
  const Tick around = past_.AtMostTicks(kCourse_s);
  const FrameNumber floor =
      AsksFor(past_.program(), node, Op::kAtBegin) && at.begin ? *at.begin : 0;
  const Tick now = past_.TickOf(at.frame);
  const FrameNumber first = std::max(floor, past_.FrameAt(std::max<Tick>(0, now - around)));
  const FrameNumber last = std::min(past_.frames() - 1, past_.FrameAt(now + around));
  std::vector<Reading::Sample> course;
  Viewpoint then = at;
  for (then.frame = first; then.frame <= last; ++then.frame) {
    if (const auto measured = Measure(node, then))
      course.push_back({past_.TickOf(then.frame), measured->value, measured->limit});
  }
  return course;
}

std::string Clauses::Since(grammar::NodeId node, const Viewpoint& at, bool truth) {
  const FrameNumber floor =
      AsksFor(past_.program(), node, Op::kAtBegin) && at.begin ? *at.begin : 0;
  FrameNumber first = at.frame;
  Viewpoint earlier = at;
  for (earlier.frame = at.frame - 1; earlier.frame >= floor && past_.Is(truth, node, earlier);
       --earlier.frame) {
    first = earlier.frame;
  }
  return first == 0 ? "from the first frame on" : "since " + Time(first);
}

Reason Clauses::Leaf(grammar::NodeId node, const Viewpoint& at, bool truth, bool brief) {
  Viewpoint earlier = at;
  --earlier.frame;
  const bool turned = at.frame > 0 && !past_.Is(truth, node, earlier);
  Reason reason = Measurement({node, truth}, at, turned ? Measure(node, earlier) : std::nullopt);
  reason.mark = turned || at.frame == 0 ? Mark::kTurned : Mark::kHeld;
  if (reason.how.empty())
    reason.how = std::string(turned ? "became " : "") + (truth ? "true" : "false");
  if (turned && !brief && reason.reading) reason.reading->course = Course(node, at);
  if (!turned && !brief) reason.how += ", " + Since(node, at, truth);
  return reason;
}

Reason Clauses::Boundary(InstanceId instance, const CandidateOutcome& outcome, bool end,
                         const Follow& follow) {
  const grammar::Rule& rule = past_.RuleOf(instance);
  const FrameNumber frame = end ? outcome.span.end.frame : outcome.span.begin.frame;
  return {.mark = Mark::kTurned,
          .what = Label(past_, instance),
          .how = end          ? "ended"
                 : frame == 0 ? "held from the first frame on"
                              : "began",
          .where = rule.form() == grammar::Form::kTouching ? "" : Source(rule.file, rule.place),
          .tick = past_.TickOf(frame),
          .because = follow ? follow(instance, outcome, end) : Reasons{}};
}

// Somebody's class does not fit, or somebody would play two roles.
Reason Clauses::Impossible(InstanceId instance, int slot) {
  const grammar::Reference& reference = past_.RuleOf(instance).references[slot];
  const grammar::Rule& rule = past_.program().rules[reference.rule];
  std::string names;
  std::string why = "an entity would play two roles";
  for (std::size_t role = 0; role < rule.roles.size(); ++role) {
    if (reference.roles[role] == kNone) continue;
    const grammar::EntityInfo& member =
        past_.entity_table().entities[past_.EntitiesOf(instance)[reference.roles[role]]];
    const std::string& wanted = rule.roles[role].class_name;
    names += (names.empty() ? "" : ", ") + member.name;
    if (std::ranges::count(member.classes, wanted) == 0)
      why = fmt::format("{} is no {}", member.name, wanted);
  }
  return {.mark = Mark::kHeld,
          .what = fmt::format("{}({})", rule.name, names),
          .how = "impossible: " + why,
          .impossible = true};
}

Reason Clauses::Reference(InstanceId instance, int slot, FrameNumber frame, bool truth,
                          const Follow& follow) {
  const InstanceId target = past_.Referred(instance, slot);
  if (target == kNone) return Impossible(instance, slot);
  const CandidateOutcome* begun = past_.LastBegun(target, frame);
  Reason reason{.mark = Mark::kHeld, .what = Label(past_, target)};
  if (truth && begun != nullptr) {
    if (begun->span.begin.frame == frame) return Boundary(target, *begun, false, follow);
    reason.how = begun->span.begin.frame == 0 ? "held from the first frame on"
                                              : "held since " + Time(begun->span.begin.frame);
    reason.tick = begun->span.begin.tick;
  } else {
    if (begun != nullptr && begun->span.end.frame == frame)
      return Boundary(target, *begun, true, follow);
    reason.how =
        begun == nullptr ? "never held so far" : "had ended at " + Time(begun->span.end.frame);
    if (begun != nullptr) reason.tick = begun->span.end.tick;
    for (const CandidateOutcome& next : past_.OutcomesOf(target)) {
      if (!next.IsInterval() || next.span.begin.frame <= frame) continue;
      reason.how += ", begins at " + Time(next.span.begin.frame);
      break;
    }
  }
  return reason;
}

// Of a reference, a boundary of its interval; of any other condition, its clauses.
void Clauses::Edge(grammar::NodeId node, const Viewpoint& at, bool truth, const Follow& follow,
                   bool brief, Reasons& out) {
  const Node& n = NodeAt(node);
  const bool end = n.op == Op::kEnds;
  const Node& arg = NodeAt(n.args[0]);
  if (!truth) {
    out.push_back({.mark = Mark::kHeld,
                   .what = ClauseText(past_, at.instance, node),
                   .how = "not at this moment"});
  } else if (arg.op != Op::kHolds) {
    Collect(n.args[0], at, !end, follow, brief, out);
  } else {
    const InstanceId target = past_.Referred(at.instance, arg.slot);
    for (const CandidateOutcome& outcome : past_.OutcomesOf(target)) {
      const FrameNumber boundary = end ? outcome.span.end.frame : outcome.span.begin.frame;
      if (!outcome.IsInterval() || boundary != at.frame) continue;
      return out.push_back(Boundary(target, outcome, end, follow));
    }
  }
}

// A conjunction is true because all its parts are, and false because of those that are not.
void Clauses::Collect(grammar::NodeId node, const Viewpoint& at, bool truth, const Follow& follow,
                      bool brief, Reasons& out) {
  const Node& n = NodeAt(node);
  if (n.op == Op::kNot) return Collect(n.args[0], at, !truth, follow, brief, out);
  if (n.op == Op::kBegins || n.op == Op::kEnds) return Edge(node, at, truth, follow, brief, out);
  if (n.op == Op::kHolds)
    return out.push_back(Reference(at.instance, n.slot, at.frame, truth, follow));
  if (n.op != Op::kAnd && n.op != Op::kOr) return out.push_back(Leaf(node, at, truth, brief));
  for (const grammar::NodeId arg : {n.args[0], n.args[1]}) {
    if (past_.Is(truth, arg, at)) Collect(arg, at, truth, follow, brief, out);
  }
}

Reasons Clauses::Change(grammar::NodeId node, const Viewpoint& at, bool truth, const Follow& follow,
                        bool brief) {
  Reasons reasons;
  Collect(node, at, truth, follow, brief, reasons);
  if (brief)
    std::erase_if(reasons, [](const Reason& reason) { return reason.mark != Mark::kTurned; });
  return reasons;
}

// Of a moment that is not now: when it is, the next one first.
std::string Clauses::WhenInstead(const Node& edge, const Viewpoint& at) {
  const bool begins = edge.op == Op::kBegins;
  if ((!begins && edge.op != Op::kEnds) || NodeAt(edge.args[0]).op != Op::kHolds) return {};
  const InstanceId target = past_.Referred(at.instance, NodeAt(edge.args[0]).slot);
  std::optional<FrameNumber> last;
  if (target == kNone) return {};
  for (const CandidateOutcome& outcome : past_.OutcomesOf(target)) {
    const FrameNumber frame = begins ? outcome.span.begin.frame : outcome.span.end.frame;
    const bool is_one = outcome.IsInterval() && (begins || frame < past_.frames());
    if (is_one && frame > at.frame) return "; it is next at " + Time(frame);
    if (is_one) last = frame;
  }
  return last ? "; it was last at " + Time(*last) : "; it never is";
}

Reason Clauses::Told(const Clause& clause, const Viewpoint& at) {
  const Node& n = NodeAt(clause.node);
  const bool now = past_.Truth(clause.node, at);
  Reason reason;
  if (n.op == Op::kHolds) {
    reason = Reference(at.instance, n.slot, at.frame, now, nullptr);
    if (reason.mark == Mark::kTurned && at.frame > 0) reason.how += " at " + Time(at.frame);
  } else {
    reason = Measurement(clause, at, std::nullopt);
    if (reason.how.empty()) reason.how = now ? "true" : "false" + WhenInstead(n, at);
  }
  reason.mark = past_.Is(clause.truth, clause.node, at) ? Mark::kHeld : Mark::kFailed;
  if (reason.mark == Mark::kFailed && reason.reading)
    reason.reading->course = Course(clause.node, at);
  return reason;
}

Reasons Clauses::State(grammar::NodeId node, const Viewpoint& at, bool truth) {
  Reasons reasons;
  for (const Clause& clause : Split(node, at, truth)) reasons.push_back(Told(clause, at));
  return reasons;
}

double Clauses::NearestMember(InstanceId any_instance, FrameNumber frame, int depth) {
  double nearest = 0;
  for (const InstanceId member : past_.MembersOf(any_instance)) {
    const auto* holds = past_.RuleOf(member).If<grammar::WhileRule>();
    if (holds == nullptr) continue;
    nearest = std::max(nearest, 0.9 * Nearness(holds->condition,
                                               {.instance = member, .frame = frame}, true, depth));
  }
  return nearest;
}

double Clauses::Nearness(grammar::NodeId node, const Viewpoint& at, bool truth, int depth) {
  constexpr int kMaxDepth = 6;
  const Node& n = NodeAt(node);
  if (past_.Is(truth, node, at)) return 1;
  if (n.op == Op::kNot) return Nearness(n.args[0], at, !truth, depth);
  if (n.op == Op::kAnd || n.op == Op::kOr) {
    const double left = Nearness(n.args[0], at, truth, depth);
    const double right = Nearness(n.args[1], at, truth, depth);
    return (n.op == Op::kAnd) == truth ? (left + right) / 2 : std::max(left, right);
  }
  if (n.op == Op::kHolds) {
    const InstanceId target = past_.Referred(at.instance, n.slot);
    if (!truth || target == kNone || depth == kMaxDepth) return 0;
    const grammar::Rule& rule = past_.RuleOf(target);
    if (const auto* holds = rule.If<grammar::WhileRule>()) {
      return 0.9 *
             Nearness(holds->condition, {.instance = target, .frame = at.frame}, true, depth + 1);
    }
    return rule.form() == grammar::Form::kAny ? NearestMember(target, at.frame, depth + 1) : 0;
  }
  const std::optional<Measured> measured = Measure(node, at);
  return measured ? 0.9 * (1 - Missed(measured->value, measured->limit)) : 0;
}

double Missed(double value, double limit) {
  const double off = std::abs(value - limit);
  const double scale = std::max(std::abs(value), std::abs(limit));
  if (off == 0) return 0;
  return std::isfinite(scale) ? 0.99 * std::min(1.0, off / scale) + 0.01 * off / (1 + off) : 1;
}

}  // namespace prehend::show
