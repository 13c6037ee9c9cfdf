// SPDX-License-Identifier: Apache-2.0
#include "harness/show/tracks/tracks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "harness/base/base/quoting.h"
#include "harness/show/explain/query.h"
#include "harness/show/explain/why_event.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::show {
namespace {

using grammar::CandidateOutcome;
using grammar::FrameNumber;
using grammar::InstanceId;
using grammar::kNone;
using grammar::Node;
using grammar::Op;
using grammar::Program;
using grammar::ReplayMonitor;
using grammar::Rule;
using grammar::RuleId;

constexpr const char* kRobustness = "robustness";

/// A number of one rule that can be plotted: a side of a comparison, or how far something is from a
/// region's centre.
struct Signal {
  enum class What { kNumber, kDistance, kHeight };
  grammar::NodeId node;
  What what = What::kNumber;
};

void CollectSignals(const Program& program, grammar::NodeId node, std::vector<Signal>& signals) {
  if (node == kNone) return;
  const Node& n = program.nodes[node];
  const auto varies = [&](grammar::NodeId arg) { return program.nodes[arg].op != Op::kNumber; };
  if (IsComparison(n.op)) {
    if (varies(n.args[0])) signals.push_back({n.args[0]});
    if (varies(n.args[1])) signals.push_back({n.args[1]});
  } else if (IsRegion(n.op)) {
    signals.push_back({node, Signal::What::kDistance});
    if (n.op == Op::kInCylinder) signals.push_back({node, Signal::What::kHeight});
  } else if (n.op == Op::kAnd || n.op == Op::kOr || n.op == Op::kNot || n.op == Op::kKnown ||
             n.op == Op::kBegins || n.op == Op::kEnds) {
    CollectSignals(program, n.args[0], signals);
    CollectSignals(program, n.args[1], signals);
  }
}

std::vector<Signal> SignalsOf(const Program& program, const Rule& rule) {
  std::vector<Signal> signals;
  for (const grammar::NodeId node : ConditionsOf(rule)) CollectSignals(program, node, signals);
  CollectSignals(program, rule.requirement, signals);
  if (const grammar::Approach* approach = ApproachOf(rule)) {
    signals.push_back({approach->signal});
    if (approach->motion != kNone) signals.push_back({approach->motion});
  }
  for (const grammar::RuleAttribute& attribute : rule.attributes)
    signals.push_back({attribute.node});
  return signals;
}

/// "speed_along" of "speed_along({0}, {1})"; an expression is called by its first word.
std::string NameOf(const Program& program, const Signal& signal) {
  const std::string& text = NoteOf(program, signal.node).text;
  const std::size_t first = text.find_first_not_of("(-");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_first_of("( ", first) - first);
}

class Collector {
 public:
  Collector(ReplayMonitor& past, const std::set<std::string>& only) : past_(past), only_(only) {
    tracks_.ticks_per_second = past.entity_table().ticks_per_second;
    for (FrameNumber frame = 0; frame < past.frames(); ++frame)
      tracks_.ticks.push_back(past.TickOf(frame));
  }

  Tracks Collect() {
    const auto& rules = past_.program().rules;
    for (const RuleId rule : grammar::IdsOf(rules)) {
      if (!rules[rule].hidden && Wanted(rules[rule].name)) AddIntervals(rule);
    }
    for (const RuleId rule : grammar::IdsOf(rules)) {
      if (!rules[rule].hidden) AddSignals(rule);
    }
    for (const RuleId rule : grammar::IdsOf(rules)) {
      const bool wanted = only_.size() == 1 || only_.contains(rules[rule].name);
      if (!rules[rule].hidden && only_.contains(kRobustness) && wanted) AddRobustness(rule);
    }
    return std::move(tracks_);
  }

 private:
  void AddRobustness(RuleId rule) {
    for (const InstanceId instance : past_.InstancesOf(rule)) {
      const std::optional<Robustness> robustness = RobustnessOf(past_, instance);
      auto* values = robustness && tracks_.problem.empty()
                         ? Add(std::string(kRobustness) + " of " + Label(past_, instance),
                               Track::Kind::kSignal, robustness->unit)
                         : nullptr;
      for (std::size_t i = 0; values != nullptr && i < values->size(); ++i)
        if (std::isfinite(robustness->values[i])) (*values)[i] = robustness->values[i];
    }
  }

  bool Wanted(const std::string& name) const { return only_.empty() || only_.contains(name); }

  std::vector<std::optional<double>>* Add(std::string name, Track::Kind kind, std::string unit) {
    const std::size_t values = (tracks_.tracks.size() + 1) * tracks_.ticks.size();
    if (tracks_.tracks.size() == kMaxTracks || values > kMaxTrackValues) {
      tracks_.problem =
          fmt::format("more than {} tracks, or {} values; ask for some of them with --only",
                      kMaxTracks, kMaxTrackValues);
      return nullptr;
    }
    if (!names_.insert(name).second) return nullptr;
    tracks_.tracks.push_back({std::move(name), kind, std::move(unit), {}});
    tracks_.tracks.back().values.resize(tracks_.ticks.size());
    return &tracks_.tracks.back().values;
  }

  void AddIntervals(RuleId rule) {
    const Track::Kind kind =
        past_.program().rules[rule].printed ? Track::Kind::kEvent : Track::Kind::kCondition;
    for (const InstanceId instance : past_.InstancesOf(rule)) {
      auto* values = tracks_.problem.empty() ? Add(Label(past_, instance), kind, "") : nullptr;
      if (values == nullptr) continue;
      std::fill(values->begin(), values->end(), 0);
      for (const CandidateOutcome& outcome : past_.OutcomesOf(instance)) {
        if (!outcome.IsInterval()) continue;
        const FrameNumber end = std::min(outcome.span.end.frame, past_.frames());
        for (FrameNumber frame = outcome.span.begin.frame; frame < end; ++frame)
          (*values)[frame] = 1;
      }
    }
  }

  void AddSignals(RuleId rule) {
    const Rule& asked = past_.program().rules[rule];
    for (const Signal& signal : SignalsOf(past_.program(), asked)) {
      if (!Wanted(NameOf(past_.program(), signal)) && !Wanted(asked.name)) continue;
      for (const InstanceId instance : past_.InstancesOf(rule)) {
        if (tracks_.problem.empty()) AddSignal(instance, signal);
      }
    }
  }

  void AddSignal(InstanceId instance, const Signal& signal) {
    const Program& program = past_.program();
    const bool anchored =
        AsksFor(program, signal.node, Op::kAtBegin) || AsksFor(program, signal.node, Op::kAtEnd);
    std::string name = ClauseText(past_, instance, signal.node);
    if (name.empty()) return;
    if (signal.what == Signal::What::kDistance) name += ": from the centre";
    if (signal.what == Signal::What::kHeight) name += ": above or below the centre";
    // What is measured from an interval's boundary is another thing in each rule.
    if (anchored) name = RuleName(past_, instance) + ": " + name;
    const grammar::Dimension& dimension = signal.what == Signal::What::kNumber
                                              ? NoteOf(program, signal.node).dimension
                                              : grammar::kMetres;
    auto* values = Add(std::move(name), Track::Kind::kSignal,
                       dimension == grammar::kPlain ? "" : grammar::DimensionText(dimension));
    if (values == nullptr) return;
    if (!anchored) return Fill(signal, 0, past_.frames(), {.instance = instance}, *values);
    for (const CandidateOutcome& outcome : past_.OutcomesOf(instance)) {
      const FrameNumber begin = outcome.span.begin.frame;
      Fill(signal, begin, std::min(outcome.span.end.frame + 1, past_.frames()),
           {.instance = instance, .begin = begin, .end = outcome.span.end.frame}, *values);
    }
  }

  void Fill(const Signal& signal, FrameNumber first, FrameNumber end, ReplayMonitor::Viewpoint at,
            std::vector<std::optional<double>>& values) {
    for (at.frame = first; at.frame < end; ++at.frame) {
      if (signal.what == Signal::What::kNumber) {
        values[at.frame] = past_.Number(signal.node, at);
      } else if (const auto reach = past_.ReachOf(signal.node, at)) {
        values[at.frame] =
            signal.what == Signal::What::kDistance ? reach->distance_m : reach->height_m;
      }
      if (values[at.frame] && std::isnan(*values[at.frame])) values[at.frame].reset();  // lost
    }
  }

  ReplayMonitor& past_;
  const std::set<std::string>& only_;
  Tracks tracks_;
  std::set<std::string> names_;
};

const char* Name(Track::Kind kind) {
  switch (kind) {
    case Track::Kind::kEvent:
      return "event";
    case Track::Kind::kCondition:
      return "condition";
    case Track::Kind::kSignal:
      return "signal";
  }
  return "";
}

using grammar::NodeId;
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
      // What has a margin is known.
      const std::optional<double> measured = Margin(node, at);
      const double margin = measured && std::isfinite(*measured) ? *measured
                            : past_.Is(true, node, at)           ? measured.value_or(kInfinity)
                            : past_.Is(false, node, at)          ? measured.value_or(-kInfinity)
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
    // Where frames are irregular, a longer one may be the only one that ends here.
    for (FrameNumber last = 0; last < frames; ++last) {
      double lowest = values[static_cast<std::size_t>(last)];
      FrameNumber begin = last;
      while (begin > 0 && !lasts(begin, last + 1))
        lowest = std::min(lowest, values[static_cast<std::size_t>(--begin)]);
      double& here = opened[static_cast<std::size_t>(last)];
      if (lasts(begin, last + 1)) here = std::max(here, lowest);
    }
    return opened;
  }

  grammar::ReplayMonitor& past_;
  std::set<std::string> units_;
  std::map<InstanceId, std::optional<Values>> known_;
};

}  // namespace

std::vector<std::string> TrackNames(const Program& program) {
  std::set<std::string> names;
  for (const Rule& rule : program.rules) {
    if (rule.hidden) continue;
    names.insert(rule.name);
    for (const Signal& signal : SignalsOf(program, rule)) names.insert(NameOf(program, signal));
  }
  names.insert(kRobustness);
  names.erase("");
  return {names.begin(), names.end()};
}

Tracks CollectTracks(ReplayMonitor& past, const std::set<std::string>& only) {
  return Collector(past, only).Collect();
}

void WriteCsv(const Tracks& tracks, std::ostream& out) {
  std::string row = "time_s,tick";
  for (const Track& track : tracks.tracks)
    row += "," + AsCsvCell(track.name + (track.unit.empty() ? "" : " [" + track.unit + "]"));
  out << row << "\n";
  for (std::size_t frame = 0; frame < tracks.ticks.size(); ++frame) {
    row = fmt::format("{},{}", truth::SecondsText(tracks.ticks[frame], tracks.ticks_per_second),
                      tracks.ticks[frame]);
    for (const Track& track : tracks.tracks) {
      row += ",";
      if (track.values[frame]) row += fmt::format("{}", *track.values[frame]);
    }
    out << row << "\n";
  }
}

void WriteJson(const Tracks& tracks, const std::string& episode, const std::string& grammar,
               std::ostream& out) {
  nlohmann::ordered_json json = {{"episode", episode},
                                 {"grammar", grammar},
                                 {"ticks_per_second", tracks.ticks_per_second},
                                 {"tick", tracks.ticks},
                                 {"tracks", nlohmann::ordered_json::array()}};
  for (const Track& track : tracks.tracks) {
    nlohmann::ordered_json values = nlohmann::ordered_json::array();
    for (const std::optional<double>& value : track.values) {
      values.push_back(value && std::isfinite(*value) ? nlohmann::ordered_json(*value)
                                                      : nlohmann::ordered_json(nullptr));
    }
    json["tracks"].push_back({{"name", track.name},
                              {"kind", Name(track.kind)},
                              {"unit", track.unit},
                              {"values", std::move(values)}});
  }
  out << json.dump() << "\n";
}

std::optional<Robustness> RobustnessOf(grammar::ReplayMonitor& past, InstanceId instance) {
  Measuring measuring(past);
  std::optional<Values> values = measuring.Of(instance, 0);
  if (!values || measuring.units().empty()) return std::nullopt;
  return Robustness{std::move(*values),
                    measuring.units().size() == 1 ? *measuring.units().begin() : ""};
}

}  // namespace prehend::show
