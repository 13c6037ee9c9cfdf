// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "harness/show/explain/phrasing.h"
#include "harness/show/explain/why_event.h"
#include "harness/show/tracks/tracks.h"

namespace prehend::show {
namespace {

using grammar::FrameNumber;
using grammar::InstanceId;
using grammar::kNone;
using grammar::NodeId;
using grammar::Op;
using Values = std::vector<double>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Measuring {
 public:
  explicit Measuring(grammar::ReplayMonitor& past) : past_(past) {}

  std::optional<Values> Of(InstanceId instance, int depth) {
    const grammar::Rule& rule = past_.RuleOf(instance);
    if (depth >= kMaxDepth || rule.requirement != kNone || rule.confirmed_by != kNone)
      return std::nullopt;
    if (const auto known = known_.find(instance); known != known_.end()) return known->second;
    std::optional<Values> values = OfForm(rule, instance, depth);
    if (values && (rule.lasting_s > 0 || rule.lasting_most_s >= 0)) {
      const Values runs = *std::move(values);
      values = Opened(runs, rule.lasting_s, Lasts::kAtLeast);
      if (rule.lasting_most_s >= 0)
        *values =
            Less(*std::move(values), Negated(Opened(runs, rule.lasting_most_s, Lasts::kLonger)));
    }
    return known_[instance] = std::move(values);
  }

  const std::set<std::string>& units() const { return units_; }

 private:
  enum class Lasts : std::uint8_t { kAtLeast, kLonger, kLongerOrCut };

  std::optional<Values> OfForm(const grammar::Rule& rule, InstanceId instance, int depth) {
    if (const auto* form = rule.If<grammar::WhileRule>(); form != nullptr && form->at_least == 0) {
      if (Asks(form->condition) || Asks(form->until)) return std::nullopt;
      Values values = Of(form->condition, instance, true, depth);
      if (form->until != kNone)
        values = Since(values, Negated(Of(form->until, instance, true, depth)));
      if (form->bridging_s <= 0) return values;
      return Negated(Opened(Negated(std::move(values)), form->bridging_s, Lasts::kLongerOrCut));
    }
    if (const auto* form = rule.If<grammar::FromToRule>()) {
      if (form->absence || form->each || form->within_s >= 0 || Asks(form->from) ||
          Asks(form->to) || Asks(form->during))
        return std::nullopt;
      const Values to = Of(form->to, instance, true, depth);
      Values holds = Negated(to);
      if (form->during != kNone)
        holds = Less(std::move(holds), Of(form->during, instance, true, depth));
      Values values = Since(Of(form->from, instance, true, depth), holds);
      return form->or_drop ? Less(std::move(values), StrictlyUntil(holds, to)) : values;
    }
    if (const auto* form = rule.If<grammar::UntilSinceRule>()) {
      if (form->approach || Asks(form->until) || Asks(form->since)) return std::nullopt;
      return Before(Of(form->since, instance, true, depth), Of(form->until, instance, true, depth),
                    past_.AtMostTicks(form->back_s));
    }
    if (const auto* form = rule.If<grammar::RestOfRule>()) {
      std::optional<Values> values = Referred(instance, form->whole, depth);
      for (const int outside : form->outside) {
        const std::optional<Values> out = Referred(instance, outside, depth);
        if (!values || !out) return std::nullopt;
        *values = Less(*std::move(values), Negated(*out));
      }
      return values;
    }
    const auto* form = rule.If<grammar::AnyRule>();
    return form != nullptr && form->one == kNone ? OfSome(instance, form->at_least, depth)
                                                 : std::nullopt;
  }

  std::optional<Values> Referred(InstanceId instance, int slot, int depth) {
    const InstanceId target = past_.Referred(instance, slot);
    return target == kNone ? std::nullopt : Of(target, depth + 1);
  }

  /// That so many of the bindings hold: frame by frame the last of the so many greatest.
  std::optional<Values> OfSome(InstanceId instance, int at_least, int depth) {
    std::vector<Values> greatest(static_cast<std::size_t>(at_least),
                                 Values(static_cast<std::size_t>(past_.frames()), -kInfinity));
    for (const InstanceId member : past_.MembersOf(instance)) {
      std::optional<Values> values = Of(member, depth + 1);
      if (!values) return std::nullopt;
      for (Values& great : greatest) {
        for (std::size_t i = 0; i < great.size(); ++i)
          if ((*values)[i] > great[i]) std::swap((*values)[i], great[i]);
      }
    }
    return greatest.back();
  }

  /// Whether it asks where an interval begins or ends, which no formula over frames can say.
  bool Asks(NodeId node) const {
    if (node == kNone) return false;
    const grammar::Node& n = past_.program().nodes[node];
    return n.op == Op::kAtBegin || n.op == Op::kAtEnd ||
           std::ranges::any_of(n.args, [&](NodeId arg) { return Asks(arg); });
  }

  /// Of the node being so: `not` is undone. What is unknown is neither.
  Values Of(NodeId node, InstanceId instance, bool truth, int depth) {
    const grammar::Node& n = past_.program().nodes[node];
    if (n.op == Op::kNot) return Of(n.args[0], instance, !truth, depth);
    if (n.op == Op::kAnd || n.op == Op::kOr) {
      Values left = Of(n.args[0], instance, truth, depth);
      const Values right = Of(n.args[1], instance, truth, depth);
      return (n.op == Op::kAnd) == truth ? Less(std::move(left), right)
                                         : Negated(Less(Negated(std::move(left)), Negated(right)));
    }
    std::optional<Values> of;
    if (n.op == Op::kHolds) of = Referred(instance, n.slot, depth);
    if (n.op == Op::kBegins || n.op == Op::kEnds) of = Edge(n, instance, depth);
    if (of) return truth ? *of : Negated(*std::move(of));
    Values values(static_cast<std::size_t>(past_.frames()));
    for (FrameNumber frame = 0; frame < past_.frames(); ++frame) {
      const Viewpoint at{.instance = instance, .frame = frame};
      const double margin = past_.Is(true, node, at)    ? Margin(node, at).value_or(kInfinity)
                            : past_.Is(false, node, at) ? Margin(node, at).value_or(-kInfinity)
                                                        : (truth ? -kInfinity : kInfinity);
      values[static_cast<std::size_t>(frame)] = truth ? margin : -margin;
    }
    return values;
  }

  /// Of a comparison or a region; nothing of what only holds or not.
  std::optional<double> Margin(NodeId node, const Viewpoint& at) {
    const grammar::Node& n = past_.program().nodes[node];
    if (IsRegion(n.op)) {
      const auto reach = past_.ReachOf(node, at);
      if (!reach) return std::nullopt;
      units_.insert("m");
      const double across = reach->radius_m - reach->distance_m;
      return n.op == Op::kInCylinder ? std::min(across, reach->most_height_m - reach->height_m)
                                     : across;
    }
    const bool is_upper = n.op == Op::kLess || n.op == Op::kLessEqual;
    if (!is_upper && n.op != Op::kGreater && n.op != Op::kGreaterEqual) return std::nullopt;
    const auto left = past_.Number(n.args[0], at), right = past_.Number(n.args[1], at);
    if (!left || !right) return std::nullopt;
    const grammar::Dimension& dimension = NoteOf(past_.program(), n.args[0]).dimension;
    units_.insert(dimension == grammar::kPlain ? "" : grammar::DimensionText(dimension));
    return is_upper ? *right - *left : *left - *right;
  }

  /// `begins`: true here and not in the frame before, `ends` the other way round. Of events that
  /// may follow each other at once there is none.
  std::optional<Values> Edge(const grammar::Node& n, InstanceId instance, int depth) {
    const grammar::Node& of = past_.program().nodes[n.args[0]];
    if (of.op == Op::kHolds && !Referred(instance, of.slot, depth)) return std::nullopt;
    Values values = Of(n.args[0], instance, true, depth);
    if (n.op == Op::kEnds) values = Negated(std::move(values));
    double before = n.op == Op::kEnds ? kInfinity : -kInfinity;
    for (double& value : values) value = std::min(-std::exchange(before, value), value);
    return values;
  }

  static Values Negated(Values values) {
    for (double& value : values) value = -value;
    return values;
  }
  static Values Less(Values a, const Values& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = std::min(a[i], b[i]);
    return a;
  }
  /// `holds since (begins and holds)`.
  static Values Since(Values begins, const Values& holds) {
    double before = -kInfinity;
    for (std::size_t i = 0; i < begins.size(); ++i)
      before = begins[i] = std::min(holds[i], std::max(before, begins[i]));
    return begins;
  }
  /// `next (holds until to)`.
  static Values StrictlyUntil(const Values& holds, const Values& to) {
    Values values(to.size(), -kInfinity);
    for (std::size_t i = to.size(); i-- > 1;)
      values[i - 1] = std::max(to[i], std::min(holds[i], values[i]));
    return values;
  }
  /// `since until(0, back] until`, as signal temporal logic says it, where the rule says
  /// `until .. since .. at most back back`.
  Values Before(const Values& since, const Values& until, grammar::Tick back) {
    Values values(until.size(), -kInfinity);
    for (FrameNumber i = 0; i < past_.frames(); ++i) {
      double low = kInfinity, &best = values[static_cast<std::size_t>(i)];
      for (FrameNumber j = i + 1; j < past_.frames() && past_.TickOf(j) - past_.TickOf(i) <= back;
           ++j) {
        low = std::min(low, since[static_cast<std::size_t>(j - 1)]);
        if (low <= best) break;
        best = std::max(best, std::min(low, until[static_cast<std::size_t>(j)]));
      }
    }
    return values;
  }

  /// The greatest, over spans around a frame that last `seconds` or more, of the least in it:
  /// once[0, t] always[0, t] of signal temporal logic. Or of those that are longer; or are, or
  /// reach the begin or end of the episode.
  Values Opened(const Values& values, double seconds, Lasts how) {
    const grammar::Tick least = past_.AtMostTicks(seconds);
    const bool is_whole =
        static_cast<double>(least) >= seconds * past_.entity_table().ticks_per_second - 1e-6;
    const FrameNumber frames = past_.frames();
    const auto lasts = [&](FrameNumber begin, FrameNumber end) {
      const grammar::Tick ticks = past_.TickOf(end) - past_.TickOf(begin);
      if (how == Lasts::kLongerOrCut && (begin == 0 || end == frames)) return true;
      return how == Lasts::kAtLeast && is_whole ? ticks >= least : ticks > least;
    };
    Values opened(values.size(), -kInfinity);
    for (FrameNumber begin = 0; begin < frames; ++begin) {
      double lowest = kInfinity;
      FrameNumber end = begin;
      do {
        lowest = std::min(lowest, values[static_cast<std::size_t>(end)]);
      } while (++end < frames && !lasts(begin, end));
      if (!lasts(begin, end)) continue;
      for (FrameNumber frame = begin; frame < end; ++frame) {
        double& here = opened[static_cast<std::size_t>(frame)];
        here = std::max(here, lowest);
      }
    }
    // Of spans that begin with the episode, only the shortest was looked at.
    if (how != Lasts::kLongerOrCut) return opened;
    double lowest = kInfinity;
    for (FrameNumber frame = 0; frame < frames; ++frame) {
      lowest = std::min(lowest, values[static_cast<std::size_t>(frame)]);
      double& here = opened[static_cast<std::size_t>(frame)];
      here = std::max(here, lowest);
    }
    return opened;
  }

  grammar::ReplayMonitor& past_;
  std::set<std::string> units_;
  std::map<InstanceId, std::optional<Values>> known_;
};

}  // namespace

std::optional<Robustness> RobustnessOf(grammar::ReplayMonitor& past, InstanceId instance) {
  Measuring measuring(past);
  std::optional<Values> values = measuring.Of(instance, 0);
  if (!values || measuring.units().empty()) return std::nullopt;
  return Robustness{std::move(*values),
                    measuring.units().size() == 1 ? *measuring.units().begin() : ""};
}

}  // namespace prehend::show
