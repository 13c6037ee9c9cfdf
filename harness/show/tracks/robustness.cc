// SPDX-License-Identifier: Apache-2.0
#include "harness/show/tracks/robustness.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <set>

#include "harness/show/explain/phrasing.h"
#include "harness/show/explain/why_event.h"

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
    const auto* form = rule.If<grammar::WhileRule>();
    const bool is_plain = form != nullptr && form->until == kNone && form->at_least == 0 &&
                          rule.requirement == kNone && rule.confirmed_by == kNone &&
                          rule.lasting_most_s < 0;
    if (!is_plain || depth >= kMaxDepth) return std::nullopt;
    Values values = Of(form->condition, instance, true, depth);
    if (form->bridging_s > 0) values = Negated(Opened(Negated(values), form->bridging_s, false));
    return rule.lasting_s > 0 ? Opened(values, rule.lasting_s, true) : values;
  }

  const std::set<std::string>& units() const { return units_; }

 private:
  /// Of the node being so: `not` is undone. What is unknown is neither.
  Values Of(NodeId node, InstanceId instance, bool truth, int depth) {
    const grammar::Node& n = past_.program().nodes[node];
    if (n.op == Op::kNot) return Of(n.args[0], instance, !truth, depth);
    if (n.op == Op::kAnd || n.op == Op::kOr) {
      Values left = Of(n.args[0], instance, truth, depth);
      const Values right = Of(n.args[1], instance, truth, depth);
      const bool least = (n.op == Op::kAnd) == truth;
      for (std::size_t i = 0; i < left.size(); ++i)
        left[i] = least ? std::min(left[i], right[i]) : std::max(left[i], right[i]);
      return left;
    }
    if (n.op == Op::kHolds) {
      const InstanceId target = past_.Referred(instance, n.slot);
      std::optional<Values> of = target == kNone ? std::nullopt : Of(target, depth + 1);
      if (of) return truth ? *of : Negated(*of);
    }
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

  static Values Negated(Values values) {
    for (double& value : values) value = -value;
    return values;
  }

  /// The greatest, over spans around a frame that last `seconds` or more, of the least in it:
  /// once[0, t] always[0, t] of signal temporal logic. If not `exactly`, they last longer, or reach
  /// the begin or end of the episode.
  Values Opened(const Values& values, double seconds, bool exactly) {
    const grammar::Tick least = past_.AtMostTicks(seconds);
    const bool is_whole =
        static_cast<double>(least) >= seconds * past_.entity_table().ticks_per_second - 1e-6;
    const FrameNumber frames = past_.frames();
    const auto lasts = [&](FrameNumber begin, FrameNumber end) {
      const grammar::Tick ticks = past_.TickOf(end) - past_.TickOf(begin);
      if (!exactly && (begin == 0 || end == frames)) return true;
      return exactly && is_whole ? ticks >= least : ticks > least;
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
    if (exactly) return opened;
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
