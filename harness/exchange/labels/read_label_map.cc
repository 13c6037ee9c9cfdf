// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/base/yaml/yaml_scalar.h"
#include "harness/episode/episode/take.h"
#include "harness/exchange/labels/label_map.h"

namespace prehend::exchange {
namespace {

using grammar::Diagnostics;
using grammar::EventSignature;

class MapReader {
 public:
  MapReader(LabelMap& map, const std::vector<EventSignature>& events)
      : map_(map), events_(events), errors_(map.document) {}

  Diagnostics Read() {
    const YamlNode& root = map_.document.root;
    map_.csv.role_names = RolesOf(events_);
    const bool is_of_poses = root.Find("import") != nullptr;
    if (root.kind != YamlNode::Kind::kMapping || is_of_poses) {
      errors_.Add(
          root.where,
          "expected a map of labels, found " + (is_of_poses ? "one of poses" : Describe(root)),
          kExample);
      return errors_.Sorted();
    }
    for (const YamlNode& node : root.children) {
      if (node.key == "version")
        ReadVersion(node);
      else if (node.key == "offset_s" && node.kind == YamlNode::Kind::kMapping)
        for (const YamlNode& take : node.children)
          ReadNumber(take, map_.offsets_s[take.key], "seconds", false);
      else if (node.key == "offset_s")
        ReadNumber(node, map_.offset_s, "seconds", false);
      else if (node.key == "starts_at")
        ReadStart(node);
      else if (node.key == "join_s")
        ReadNumber(node, map_.join_s, "seconds", true);
      else if (node.key == "rate_hz")
        ReadNumber(node, map_.csv.rate_hz, "frames per second", true);
      else if (node.key == "time_unit")
        ReadTimeUnit(node);
      else if (node.key == "columns")
        ReadColumns(node);
      else if (node.key == "entities")
        ReadEntities(node);
      else if (node.key == "video")
        ReadVideo(node);
      else if (node.key == "tiers")
        ReadTiers(node);
      else if (node.key != "labels" && node.key != "collar_ms")
        errors_.AddUnknownName(
            node.key_where, "unknown key '" + node.key + "'", node.key,
            {"version", "labels", "tiers", "offset_s", "starts_at", "join_s", "collar_ms",
             "time_unit", "rate_hz", "columns", "entities", "video"});
    }
    if (const YamlNode* labels = root.Find("labels"))
      ReadLabelNodes(*labels);
    else
      errors_.Add(root.where, "'labels' is missing", kExample);
    if (const YamlNode* collars = root.Find("collar_ms")) ReadCollars(*collars);
    return errors_.Sorted();
  }

 private:
  static constexpr const char* kExample =
      "labels:\n    hold: {event: EVENT, object: cup}\n    idle: ignore";

  void ReadNumber(const YamlNode& node, double& into, const char* what, bool positive) {
    const std::optional<double> number = NumberOf(node);
    if (number && (!positive || *number > 0))
      into = *number;
    else
      errors_.Add(node.where, fmt::format("{}: expected {}{}, found {}", node.key, what,
                                          positive ? ", more than 0" : "", Describe(node)));
  }

  /// Of an event, or of a label that means it; of several the largest.
  void ReadCollars(const YamlNode& collars) {
    if (!IsMapping(collars)) return;
    std::vector<std::string> names;
    for (const EventSignature& one : events_) names.push_back(one.name);
    for (const YamlNode& node : collars.children) {
      double milliseconds = 0;
      ReadNumber(node, milliseconds, "milliseconds", true);
      const bool is_event = std::ranges::count(names, node.key) > 0;
      const auto label = map_.labels.find(node.key);
      const bool is_label = !is_event && label != map_.labels.end() && !label->second.ignored;
      double& collar_s = map_.collars_s[is_label ? label->second.event : node.key];
      collar_s = std::max(collar_s, milliseconds / 1000);
      if (!is_event && !is_label)
        errors_.AddUnknownName(node.key_where, "the grammar has no event '" + node.key + "'",
                               node.key, names);
    }
  }

  /// When the recording began: times of day become times in it.
  void ReadStart(const YamlNode& node) {
    if (const auto seconds = episode::SecondsOfDate(node.text))
      map_.offset_s -= *seconds;
    else
      errors_.Add(node.where, "starts_at: expected a time like 2026-10-25T01:59:57.010, found " +
                                  Describe(node));
  }

  /// 1 where no line says it.
  void ReadVersion(const YamlNode& node) {
    if (NumberOf(node) != 1)
      errors_.Add(node.where,
                  "version: expected 1, the version of this format, found " + Describe(node));
  }

  void ReadTimeUnit(const YamlNode& node) {
    static const std::map<std::string, double> units = {
        {"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}, {"frame", 0}};
    const auto unit = node.kind == YamlNode::Kind::kScalar ? units.find(node.text) : units.end();
    if (unit == units.end())
      return errors_.Add(node.where,
                         "time_unit: expected s, ms, us, ns or frame, found " + Describe(node));
    map_.csv.unit_s = unit->second;
    map_.csv.in_frames = node.text == "frame";
  }

  void ReadColumns(const YamlNode& columns) {
    if (!IsMapping(columns)) return;
    std::set<std::string> known = RolesOf(events_);
    for (const YamlNode& node : columns.children) {
      if (node.kind != YamlNode::Kind::kScalar || node.text.empty()) {
        errors_.Add(node.where,
                    node.key + ": expected the name of a column, found " + Describe(node));
      } else if (const auto column = columns_.find(node.key); column != columns_.end()) {
        map_.csv.*column->second = node.text;
      } else if (known.contains(node.key)) {
        map_.csv.role_names.erase(node.key);
        if (!SaysIgnore(node)) map_.csv.roles.push_back({node.key, node.text});
      } else {
        for (const auto& [name, _] : columns_) known.insert(name);
        errors_.AddUnknownName(node.key_where,
                               "'" + node.key +
                                   "' is no column of labels: begin, end, duration, time, kind, "
                                   "frame, label, tier, take or a role",
                               node.key, {known.begin(), known.end()});
      }
    }
  }

  void ReadEntities(const YamlNode& entities) {
    if (!IsMapping(entities)) return;
    for (const YamlNode& node : entities.children) {
      if (node.kind != YamlNode::Kind::kScalar || node.text.empty())
        errors_.Add(node.where, node.key + ": expected the name of an entity, or 'ignore', found " +
                                    Describe(node));
      else
        map_.entities[node.key] = {SaysIgnore(node) ? "" : node.text, node.where};
    }
  }

  /// A path for all takes, or one for each.
  void ReadVideo(const YamlNode& node) {
    const std::filesystem::path folder =
        std::filesystem::path(map_.document.sources.front().name).parent_path();
    const auto read = [&](const YamlNode& path, const std::string& take) {
      std::string ending = path.text.substr(std::min(path.text.rfind('.'), path.text.size()));
      if (path.kind == YamlNode::Kind::kScalar && (ending == ".mp4" || ending == ".webm"))
        map_.videos[take] = (folder / path.text).lexically_normal().string();
      else
        errors_.Add(path.where, "video: expected a file .mp4 or .webm, found " + Describe(path),
                    "video: videos/{take}.mp4, or {take1: one.mp4}");
    };
    if (node.kind != YamlNode::Kind::kMapping) return read(node, "");
    for (const YamlNode& path : node.children) read(path, path.key);
  }

  bool IsMapping(const YamlNode& node) {
    if (node.kind == YamlNode::Kind::kMapping && !node.children.empty()) return true;
    errors_.Add(
        node.where,
        fmt::format("{}: expected a mapping, found {}", node.key,
                    node.kind == YamlNode::Kind::kMapping ? "an empty one" : Describe(node)),
        kExample);
    return false;
  }

  static bool SaysIgnore(const YamlNode& node) {
    return node.kind == YamlNode::Kind::kScalar && node.text == "ignore";
  }

  void ReadTiers(const YamlNode& tiers) {
    if (!IsMapping(tiers)) return;
    const std::set<std::string> known = RolesOf(events_);
    for (const YamlNode& node : tiers.children) {
      Meaning& tier = map_.tiers[node.key];
      tier.where = node.key_where;
      tier.ignored = SaysIgnore(node);
      if (tier.ignored || !IsMapping(node)) continue;
      if (node.Find("role") || node.Find("of")) {
        ReadChild(node, known, tier);
        continue;
      }
      for (const YamlNode& role : node.children) {
        if (!known.contains(role.key))
          errors_.AddUnknownName(role.key_where, "no event has a role '" + role.key + "'", role.key,
                                 {known.begin(), known.end()});
        ReadRole(role, tier);
      }
    }
  }

  /// {role: object, of: right}: what stands there is a role of the labels of another tier.
  void ReadChild(const YamlNode& node, const std::set<std::string>& known, Meaning& tier) {
    for (const YamlNode& field : node.children) {
      if (field.key == "role")
        tier.role = field.text;
      else if (field.key == "of")
        tier.of = field.text;
      else
        errors_.AddUnknownName(field.key_where, "unknown key '" + field.key + "'", field.key,
                               {"role", "of"});
    }
    if (!known.contains(tier.role))
      errors_.AddUnknownName(node.where, "no event has a role '" + tier.role + "'", tier.role,
                             {known.begin(), known.end()});
    if (tier.of.empty())
      errors_.Add(node.where, "'of' is missing: of the labels of which tier?",
                  "{role: object, of: right}");
  }

  void ReadRole(const YamlNode& node, Meaning& meaning) {
    if (node.kind != YamlNode::Kind::kScalar || node.text.empty())
      errors_.Add(node.where,
                  node.key + ": expected the name of an entity, found " + Describe(node));
    else
      meaning.roles.push_back({node.key, node.text}), meaning.entities[node.text] = node.where;
  }

  void ReadLabelNodes(const YamlNode& labels) {
    if (!IsMapping(labels)) return;
    for (const YamlNode& node : labels.children) {
      Meaning& label = map_.labels[node.key];
      label.where = node.key_where;
      label.ignored = SaysIgnore(node);
      if (label.ignored) continue;
      const YamlNode* name = node.kind == YamlNode::Kind::kMapping ? node.Find("event") : nullptr;
      if (!name) {
        errors_.Add(
            node.where,
            fmt::format("'{}': expected an event or 'ignore', found {}", node.key, Describe(node)),
            kExample);
        continue;
      }
      label.event = name->text;
      const auto event = std::ranges::find(events_, label.event, &EventSignature::name);
      if (event == events_.end()) {
        std::vector<std::string> names;
        for (const EventSignature& one : events_) names.push_back(one.name);
        errors_.AddUnknownName(name->where, "the grammar has no event '" + label.event + "'",
                               label.event, names);
        continue;
      }
      for (const YamlNode& role : node.children) {
        if (role.key == "event") continue;
        if (std::ranges::find(event->roles, role.key) == event->roles.end())
          errors_.AddUnknownName(role.key_where,
                                 fmt::format("'{}' has no role '{}'", event->name, role.key),
                                 role.key, event->roles);
        ReadRole(role, label);
      }
    }
  }

  const std::map<std::string, std::string CsvReading::*> columns_ = {
      {"begin", &CsvReading::begin},       {"end", &CsvReading::end},
      {"duration", &CsvReading::duration}, {"time", &CsvReading::time},
      {"kind", &CsvReading::kind},         {"frame", &CsvReading::frame},
      {"label", &CsvReading::label},       {"tier", &CsvReading::tier},
      {"take", &CsvReading::take}};
  LabelMap& map_;
  const std::vector<EventSignature>& events_;
  DiagnosticList errors_;
};

}  // namespace

std::set<std::string> RolesOf(const std::vector<EventSignature>& events) {
  std::set<std::string> known;
  for (const EventSignature& event : events) known.insert(event.roles.begin(), event.roles.end());
  return known;
}

Result<LabelMap> ReadLabelMap(const std::string& path, const std::vector<EventSignature>& events) {
  PREHEND_TRY(YamlDocument document, ReadYamlFile(path));
  LabelMap map{.document = std::move(document)};
  Diagnostics problems = MapReader(map, events).Read();
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return map;
}

std::string VideoOf(const LabelMap& map, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (const auto own = map.videos.find(name); own != map.videos.end()) return own->second;
  constexpr std::string_view kTake = "{take}";
  const auto all = map.videos.find("");
  std::string path = all == map.videos.end() ? "" : all->second;
  if (const std::size_t at = path.find(kTake); at != std::string::npos)
    path.replace(at, kTake.size(), names.back());
  return path;
}

std::optional<double> OffsetOf(const LabelMap& map, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (const auto own = map.offsets_s.find(name); own != map.offsets_s.end()) return own->second;
  if (!map.offsets_s.empty()) return std::nullopt;
  return map.offset_s;
}

}  // namespace prehend::exchange
