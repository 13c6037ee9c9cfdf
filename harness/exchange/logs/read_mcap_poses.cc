// SPDX-License-Identifier: Apache-2.0
// Poses from an MCAP file or a bag of ROS 1: of topics, of named bodies, of the frames of a tree of
// transforms. Tested by tests/program/import_mcap_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <set>
#include <tuple>

#include "grammar/base/diagnostic.h"
#include "harness/base/base/input_files.h"
#include "harness/base/base/text_file.h"
#include "harness/exchange/logs/log_series.h"
#include "harness/exchange/messages/log_file.h"

namespace prehend::exchange {

namespace {

constexpr double kMostDuration_s = 1e5;
constexpr std::size_t kMostDeep = 200;  ///< frames in frames
constexpr std::ptrdiff_t kMostNamed = 4;
constexpr std::size_t kMostTopics = 20, kMostListed = 20;  ///< in an error; bodies in a line
constexpr const char* kReadTypes =
    "read are messages of ROS with a definition in which there is a pose, as CDR or ROS 1; "
    "PoseStamped, PoseArray, TransformStamped and TFMessage of ROS, and PoseInFrame, PosesInFrame, "
    "FrameTransform and FrameTransforms of Foxglove, as JSON (docs/motion-capture.md)";

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// "'a', 'b' and 3 more".
std::string Listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostListed); ++i)
    text += fmt::format("{}'{}'", i == 0 ? "" : ", ", names[i]);
  if (names.size() > kMostListed) text += fmt::format(" and {} more", names.size() - kMostListed);
  return text;
}

class McapPoseReader {
 public:
  McapPoseReader(const std::string& path, const MapFile& map)
      : map_(map.map), map_errors_(map.document) {
    poses.file = path;
    poses.bodies = BodiesOf(map_, map_errors_);
    poses.openings = OpeningsOf(map_);
  }

  void Read() {
    std::error_code error;
    const auto size = std::filesystem::file_size(poses.file, error);
    if (error || !std::filesystem::is_regular_file(poses.file))
      return Fail(std::filesystem::exists(poses.file) ? "is not a regular file" : "no such file");
    std::ifstream in = OpenInput(poses.file);
    LogSeries series(map_, size);
    series_ = &series;
    const TakesMessage take = [&](const LogMessage& message) {
      return series.TakeMessage(message);
    };
    const HearsOfChannel tell = [&](const LogChannel& channel) { series.TakeChannel(channel); };
    const std::string why = IsDb3(poses.file)   ? ReadDb3(poses.file, in, size, take, tell)
                            : IsBag(poses.file) ? ReadBag(in, size, take, tell)
                                                : ReadMcap(in, size, take, tell);
    if (!why.empty()) return Fail(why);
    poses.quaternion_order = series.quaternion_order(), poses.zeros = series.zeros;
    if (map_errors_.empty()) FindBodies();
    if (map_errors_.empty()) Compose();
    if (map_errors_.empty() && problems_.empty()) RefuseAbsentBodies(poses, map_, map_errors_);
  }

  grammar::Diagnostics Problems() const {
    grammar::Diagnostics all = map_errors_.Sorted();
    all.insert(all.end(), problems_.begin(), problems_.end());
    return all;
  }

  PoseFile poses;

 private:
  void Fail(std::string message) {
    problems_.push_back({.file = poses.file, .message = std::move(message)});
  }

  /// Of each body its topic or its frame.
  void FindBodies() {
    bool has_frames = false, has_positions = false;
    for (const Named<MappedEntity>& entity : map_.entities) {
      if (!entity.value.from) continue;
      const Located<std::string>& from = *entity.value.from;
      const FrameLink* link = nullptr;
      bool oriented = true;
      if (const auto named = series_->named.find(from.value); named != series_->named.end())
        link = &named->second;
      const auto topic = TopicOf(from.value);
      if (!link && topic != series_->topics.end()) link = LinkOf(from, *topic, oriented);
      const auto frame = series_->tree.links.find(FrameName(from.value));
      if (frame != series_->tree.links.end()) {
        const bool same = topic != series_->topics.end() && topic->second.of_frames;
        if (link && !same)
          map_errors_.Add(
              from.where,
              fmt::format("'{}' is a topic of poses and a frame of transforms", from.value));
        link = &frame->second;
        has_frames = true;
      }
      if (!link) {
        RefuseUnknown(from, topic);
        continue;
      }
      has_positions = has_positions || !oriented;
      found_.push_back(link);
      oriented_.push_back(oriented);
      if (!oriented && entity.value.upright_at_s)
        map_errors_.Add(
            entity.value.upright_at_s->where,
            fmt::format("upright_at_s: '{}' has no orientation in the file", from.value));
    }
    if (map_errors_.empty()) AddNotes(has_frames, has_positions);
  }

  using Topics = std::map<std::string, LogTopic>;

  /// The longest name that it begins with.
  Topics::const_iterator TopicOf(const std::string& from) const {
    for (std::size_t size = from.size(); size > 0; --size) {
      if (size < from.size() && from[size] != '[' && from[size] != ':') continue;
      const auto topic = series_->topics.find(from.substr(0, size));
      const bool has_names = topic != series_->topics.end() && topic->second.reader &&
                             topic->second.reader->bodies() == MessageReader::Bodies::kByName;
      if (topic != series_->topics.end() && !has_names) return topic;
    }
    return series_->topics.end();
  }

  /// Null if there is none, or after an error.
  const FrameLink* LinkOf(const Located<std::string>& from, const Topics::value_type& topic,
                          bool& oriented) {
    const auto asked = std::ranges::find(topic.second.asked, from.value, &AskedBody::from);
    if (asked == topic.second.asked.end()) return nullptr;
    const FrameLink* link = nullptr;
    std::vector<std::string> names;
    for (const auto& [field, candidate] : asked->links) {
      if (!topic.second.seen.contains({field, asked->address.keys}) && candidate.poses.empty())
        continue;
      link = &candidate;
      oriented = topic.second.reader->fields()[field].oriented;
      names.push_back(
          AddressOf(topic.first, topic.second.reader->fields(), field, asked->address.keys));
    }
    if (names.size() > 1)
      map_errors_.Add(from.where, fmt::format("'{}' can be {} bodies", from.value, names.size()),
                      "write one of " + Listed(names));
    return link;
  }

  /// What the map does not mention, and what a user may not expect.
  void AddNotes(bool has_frames, bool has_positions) {
    const auto note = [this](std::string text) { poses.notes.push_back(std::move(text)); };
    std::set<std::string> used;
    for (const PoseBody& body : poses.bodies) used.insert(FrameName(body.name));
    std::vector<std::vector<std::string>> unused(2);
    for (const auto& [name, link] : series_->named) {
      if (!used.contains(FrameName(name))) unused[0].push_back(name);
    }
    for (const auto& [name, link] : series_->tree.links) {
      if (!has_frames) unused[1].push_back(name);
    }
    for (const auto& [name, topic] : series_->topics) {
      if (topic.lacks_times && map_.mcap.clock == Clock::kHeader)
        note(
            fmt::format("the messages of '{}' have no time of their own: they count as measured "
                        "when they were logged",
                        ReadableName(name)));
      std::size_t repeats = 0;
      for (const AskedBody& body : topic.asked)
        for (const auto& [field, link] : body.links) repeats = std::max(repeats, link.repeats);
      if (repeats > 0)
        note(fmt::format("bodies of '{}' are twice in {}: the last pose counts", ReadableName(name),
                         grammar::CountOf(repeats, "message")));
      if (!topic.of_frames) unused.push_back(topic.Names(name, /*unasked_only=*/true));
    }
    for (const std::vector<std::string>& names : unused) {
      if (map_.is_draft) poses.unused.insert(poses.unused.end(), names.begin(), names.end());
      if (!names.empty())
        note(fmt::format("the file has {}, which the map does not mention", Listed(names)));
    }
    std::vector<std::string> repeating;
    std::size_t repeats = 0;
    for (const auto* series : {&series_->named, &series_->tree.links})
      for (const auto& [name, link] : *series)
        if (link.repeats > 0) {
          repeating.push_back(name);
          repeats = std::max(repeats, link.repeats);
        }
    if (repeats > 0)
      note(fmt::format("{} {} twice in {}: the last pose counts", Listed(repeating),
                       repeating.size() == 1 ? "is" : "are", grammar::CountOf(repeats, "message")));
    const bool oriented = std::ranges::find(oriented_, true) != oriented_.end();
    if (map_.quaternion_order && !oriented)
      note("'quaternion_order' of the map says nothing here: no pose has an orientation");
    else if (series_->quaternion_order() == QuaternionOrder::kWxyz)
      note("quaternion_order is wxyz: of an orientation, the field x, or the first number, is w");
    if (!has_positions) return;
    poses.has_orientations = oriented;
    for (std::size_t i = 0; i < oriented_.size() && poses.has_orientations; ++i) {
      if (!oriented_[i])
        note(fmt::format(
            "'{}' is a position without an orientation: it never turns or tilts (boxes, offset_m)",
            poses.bodies[i].name));
    }
  }

  void RefuseUnknown(const Located<std::string>& from, Topics::const_iterator topic) {
    if (topic != series_->topics.end()) return RefuseBody(from, *topic);
    std::vector<std::string> names, some;  // of each topic one
    for (const auto* series : {&series_->named, &series_->tree.links}) {
      for (const auto& [name, link] : *series) names.push_back(name);
    }
    some = names;
    bool is_read = !names.empty();
    for (const auto& [name, one] : series_->topics) {
      is_read = is_read || (one.reader && one.reader->bodies() != MessageReader::Bodies::kByName);
      std::vector<std::string> bodies = one.Names(name, /*unasked_only=*/false);
      if (!bodies.empty()) some.push_back(bodies.front());
      std::ranges::move(bodies, std::back_inserter(names));
    }
    if (!is_read && !series_->topics.empty()) return RefuseAllTypes(from);
    const std::string near = grammar::NearestName(from.value, names);
    std::string hint = "there is nothing that could stand here";
    if (!near.empty())
      hint = fmt::format("did you mean '{}'?", near);
    else if (!names.empty())
      hint = "there is " + Listed(names.size() > kMostListed ? some : names);
    for (const auto& [name, one] : series_->topics) {
      if (one.of_frames && !one.reader)
        hint += fmt::format("; '{}' is not read: {}", ReadableName(name), one.why_not);
    }
    map_errors_.Add(
        from.where,
        fmt::format("no topic of poses, no body and no frame is called '{}'", from.value), hint);
  }

  /// Of a topic that is there.
  void RefuseBody(const Located<std::string>& from, const Topics::value_type& entry) {
    const auto& [name, topic] = entry;
    if (!topic.reader)
      return map_errors_.Add(from.where,
                             fmt::format("the messages of '{}' are of a type that is not read: {}",
                                         ReadableName(name), topic.why_not),
                             kReadTypes);
    const std::vector<std::string> names = topic.Names(name, /*unasked_only=*/false);
    if (names.empty())
      return map_errors_.Add(from.where,
                             fmt::format("'{}' has no poses in the file", ReadableName(name)));
    const std::string near = grammar::NearestName(from.value, names);
    map_errors_.Add(
        from.where,
        from.value == name ? fmt::format("the messages of '{}' have several bodies", name)
                           : fmt::format("'{}' has no body '{}'", name, from.value),
        (near.empty() || from.value == name ? "" : fmt::format("did you mean '{}'? ", near)) +
            "there is " + Listed(names));
  }

  /// Once for all bodies.
  void RefuseAllTypes(const Located<std::string>& from) {
    if (!map_errors_.empty()) return;
    std::string topics;
    std::size_t named = 0;
    for (const auto& [name, topic] : series_->topics) {
      if (named++ == kMostTopics) break;
      topics += fmt::format("{}'{}': {}", topics.empty() ? "" : ", ", ReadableName(name),
                            topic.reader ? "JSON" : topic.why_not);
    }
    if (series_->topics.size() > kMostTopics)
      topics += fmt::format(" and {} more", series_->topics.size() - kMostTopics);
    map_errors_.Add(
        from.where,
        fmt::format("the file has no topic of a type that is read, so no '{}'; it has {}",
                    from.value, topics),
        kReadTypes);
  }

  /// The frame that is the recording's, or "" after an error.
  std::optional<std::string> World() {
    std::map<std::string, std::string> roots;  // and a body of each
    for (std::size_t i = 0; i < found_.size(); ++i)
      roots.emplace(series_->tree.RootOf(found_[i]->parent), poses.bodies[i].name);
    const auto& given = map_.mcap.world;
    const std::string world = given ? FrameName(given->value) : roots.begin()->first;
    const std::string root = series_->tree.RootOf(world);
    if (given && !roots.contains(root)) {
      std::vector<std::string> names;
      for (const auto& [name, link] : series_->tree.links) names.push_back(name);
      for (const auto& [name, body] : roots) names.push_back(name);
      map_errors_.AddUnknownName(given->where,
                                 fmt::format("no body is tracked in the frame '{}'", given->value),
                                 given->value, names);
      return std::nullopt;
    }
    for (const auto& [name, body] : roots) {
      if (name == root) continue;
      map_errors_.Add(given ? given->where : map_.entities.front().name_where,
                      fmt::format("no transforms join the frames '{}' (of '{}') and '{}' (of '{}')",
                                  root, roots.at(root), name, body),
                      "is a topic of static transforms missing in the file?");
      return std::nullopt;
    }
    return world;
  }

  bool Sort(const std::string& name, FrameLink& link) {
    const auto ns = link.Sort();
    if (ns) Fail(fmt::format("'{}' has two poses at {:.6f} s", name, Seconds(*ns)));
    return !ns;
  }

  void Compose() {
    for (auto* series : {&series_->named, &series_->tree.links}) {
      for (auto& [name, link] : *series) {
        if (!Sort(name, link)) return;
      }
    }
    for (auto& [name, topic] : series_->topics) {
      for (AskedBody& body : topic.asked) {
        for (auto& [field, link] : body.links) {
          if (!Sort(body.from, link)) return;
        }
      }
    }
    for (std::size_t i = 0; i < found_.size(); ++i) RefuseRing(poses.bodies[i].name, *found_[i]);
    if (!problems_.empty() || found_.empty()) return;
    const std::optional<std::string> world = World();
    if (!world) return;
    if (const auto link = series_->tree.links.find(*world); link != series_->tree.links.end())
      RefuseRing(*world, link->second);
    if (!problems_.empty()) return;
    const auto bridge_ns = static_cast<std::int64_t>(map_.bridge_s * 1e9);
    std::vector<std::vector<TimedPose>> all;
    std::optional<std::int64_t> first, last;
    if (const auto& rows = series_->rows_ns; !rows.empty())
      std::tie(first, last) = std::pair(std::ranges::min(rows), std::ranges::max(rows));
    for (const FrameLink* body : found_) {
      all.push_back(series_->tree.InFrame(*body, *world, bridge_ns));
      if (all.back().size() < 2) continue;
      first = std::min(first.value_or(all.back().front().ns), all.back().front().ns);
      last = std::max(last.value_or(all.back().back().ns), all.back().back().ns);
    }
    if (!first) return;  // refused, each by its name
    for (const std::int64_t ns : series_->rows_ns) poses.rows_s.push_back(Seconds(ns - *first));
    poses.last_s = Seconds(*last - *first);
    if (poses.last_s > kMostDuration_s)
      return Fail(
          fmt::format("its poses are from {:.3f} to {:.3f} s: they are not of one clock; the "
                      "map can say mcap: {{clock: log}}",
                      Seconds(*first), Seconds(*last)));
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].size() == 1 && IsFixed(*found_[i], *world)) {  // it stands still all the time
        poses.bodies[i].stands = true;
        all[i].push_back(all[i].front());
        all[i].front().ns = *first;
        all[i].back().ns = *last;
      }
      for (const TimedPose& pose : all[i])
        poses.bodies[i].samples.push_back(
            {.t_s = Seconds(pose.ns - *first), .p = pose.p, .q = pose.q});
    }
    AddOpenings(*first, *last);
  }

  void AddOpenings(std::int64_t first, std::int64_t last) {
    for (std::size_t i = 0; i < poses.openings.size(); ++i) {
      const LogSeries::LogOpening& read = series_->openings[i];
      const Opening& said = poses.openings[i].Of(map_);
      const Located<std::string>& from = said.from.front();
      if (read.topic.empty() || !read.why_not.empty() || read.numbers.empty()) {
        std::vector<std::string> topics;
        for (const auto& [name, topic] : series_->topics) topics.push_back(name);
        if (read.topic.empty())
          map_errors_.AddUnknownName(
              from.where,
              fmt::format("no topic has '{}'{}", said.Names(),
                          said.from.size() > 1 ? ", or they are of several topics" : ""),
              from.value, topics);
        else
          map_errors_.Add(from.where,
                          fmt::format("'{}' is not read: {}", said.Names(),
                                      read.why_not.empty() ? "no message has it" : read.why_not));
        continue;
      }
      // The last value before the first pose holds there.
      auto at = read.numbers.upper_bound(first);
      if (at != read.numbers.begin()) --at;
      for (; at != read.numbers.end() && at->first <= last; ++at)
        if (const double open = said.FractionOf(at->second); std::isfinite(open))
          poses.openings[i].samples.push_back(
              {.t_s = Seconds(std::max(at->first, first) - first), .open = open});
    }
  }

  /// From a body to its root there are few frames.
  void RefuseRing(const std::string& name, const FrameLink& body) {
    std::vector<const std::string*> way = {&body.parent};
    while (problems_.empty()) {
      const auto parent = series_->tree.links.find(*way.back());
      if (parent == series_->tree.links.end()) return;
      const std::string& next = parent->second.parent;
      const auto again = std::ranges::find_if(way, [&](const auto* of) { return *of == next; });
      if (again != way.end()) {
        std::string ring = fmt::format("'{}'", **again);
        for (auto frame = again + 1; frame != way.end() && frame - again < kMostNamed; ++frame)
          ring += fmt::format(" in '{}'", **frame);
        return Fail(fmt::format("the frames are in a ring: {} in {}'{}' again", ring,
                                way.end() - again > kMostNamed ? ".. in " : "", next));
      }
      if (way.size() >= kMostDeep)
        return Fail(fmt::format("'{}' is in more than {} frames, one in another", name, kMostDeep));
      way.push_back(&next);
    }
  }

  bool IsFixed(const FrameLink& body, const std::string& world) const {
    const FrameLink* link = &body;
    for (std::size_t depth = 0; link->fixed && depth <= series_->tree.links.size(); ++depth) {
      const auto parent = series_->tree.links.find(link->parent);
      if (link->parent == world || parent == series_->tree.links.end()) return true;
      link = &parent->second;
    }
    return false;
  }

  const ImportMap& map_;
  DiagnosticList map_errors_;
  grammar::Diagnostics problems_;
  LogSeries* series_ = nullptr;
  std::vector<const FrameLink*> found_;  ///< of each body
  std::vector<bool> oriented_;           ///< of each body
};

}  // namespace

Result<PoseFile> ReadMcapPoses(const std::string& path, const MapFile& map) {
  McapPoseReader reader(path, map);
  reader.Read();
  if (grammar::Diagnostics problems = reader.Problems(); !problems.empty())
    return tl::unexpected(std::move(problems));
  return std::move(reader.poses);
}

}  // namespace prehend::exchange
