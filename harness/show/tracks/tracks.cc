// SPDX-License-Identifier: Apache-2.0
#include "harness/show/tracks/tracks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "harness/base/base/quoting.h"
#include "harness/show/explain/phrasing.h"
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

}  // namespace prehend::show
