// SPDX-License-Identifier: Apache-2.0
// Episodes as files of other programs: their motion, and beside it their events and the map that
// reads it again. Tested by tests/program/exported.py
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/episode/episode/episode.h"
#include "harness/episode/episode/find_episodes.h"

namespace prehend::exchange {

struct ExportRequest {
  std::string root;    ///< the project's
  std::string ending;  ///< of the files: .mcap, .csv, .jsonl or .npz
  std::string output;  ///< a folder, or of one episode a file with this ending
  episode::GrammarChoice choice;
};

struct Exported {
  std::string file;
  std::size_t frames = 0, events = 0;
  std::string warnings;
  std::string failure;  ///< "", or why its simulation ended early
};

/// One after another; what was written before a problem stays.
tl::expected<std::vector<Exported>, episode::NotFound> ExportEpisodes(
    const std::vector<episode::EpisodeName>& episodes, const ExportRequest& request);

// An episode as it is exported, whatever it came from: who takes part, its frames, its events with
// their UUIDs. Tested by tests/program/exported.py

class Motion {
 public:
  /// Plays a scenario. The episode was opened with `choice`; if that says something, what it makes
  /// of the episode counts, not what was recorded.
  static Result<Motion> Of(episode::Episode& episode, const episode::GrammarChoice& choice);

  using Look = std::function<void(const grammar::Frame&)>;
  void EachFrame(const Look& look) const;

  const grammar::EntityTable& table() const { return header.entity_table; }
  double Seconds(grammar::Tick tick) const {
    return truth::SecondsOf(tick, table().ticks_per_second);
  }
  /// Nanoseconds since the begin of the episode.
  std::uint64_t Nanoseconds(grammar::Tick tick) const;

  episode::EpisodeHeader header;
  grammar::Timeline timeline;
  std::vector<std::string> uuids;  ///< of its events
  std::size_t frames = 0;
  grammar::Tick first_tick = 0, end_tick = 0;
  bool says_its_end = true;
  std::string judged_by;              ///< a grammar's name or file
  std::vector<std::string> settings;  ///< of its parameters
  bool was_simulated = false;
  std::string failure;  ///< "", or why its simulation ended early

  /// What is known of an entity from all frames.
  struct Seen {
    std::size_t looks = 0;  ///< frames in which it is measured
    bool moves = false;
    bool has_joint = false;                  ///< by its class, or somewhere else than at 0
    grammar::EntitySample first;             ///< look
    grammar::EntitySample shut, open;        ///< of a joint: the least and the most open look
    double most_grip = 0;                    ///< of a hand
    std::optional<Eigen::Vector3d> ahead_B;  ///< of a hand: where it reaches, in its own frame
  };
  std::vector<Seen> seen;  ///< by entity

 private:
  explicit Motion(episode::Episode& episode) : episode_(&episode) {}
  void LookAtAll();
  episode::Episode* episode_;
};

// Motion in the formats of other programs (docs/episodes.md).

void WriteLines(const Motion& motion, std::ostream& out);
void WriteCsv(const Motion& motion, std::ostream& out);
void WriteNpz(const Motion& motion, std::ostream& out);
/// Returns the metadata.yaml that rosbag2 wants beside it. `name`: of the file.
std::string WriteMcap(const Motion& motion, const std::string& name, std::ostream& out);

/// Events with their UUIDs, a row for each.
std::string EventsCsv(const Motion& motion);
/// The roles of an event, as JSON.
std::string RolesJson(const grammar::NamedEvent& event);
/// The map with which `import` reads the poses again. `ending`: .csv or .mcap.
std::string MapText(const Motion& motion, const std::string& ending);
/// The frame of coordinates that is the world's; no entity is called so.
std::string WorldName(const grammar::EntityTable& table);

// Messages of ROS 2 in CDR, and the definitions of their types. Tested by tests/mcap/mcap_test.mjs

/// Of these types: "tf2_msgs/msg/TFMessage", "visualization_msgs/msg/MarkerArray",
/// "sensor_msgs/msg/JointState", "sensor_msgs/msg/PointCloud2", "std_msgs/msg/String".
std::string RosDefinition(const std::string& type);

/// A frame of coordinates in the world.
struct FramePose {
  const std::string* name = nullptr;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};
std::string TransformsMessage(std::uint64_t ns, const std::string& world,
                              std::span<const FramePose> frames);

/// What each entity looks like, fixed to the frame that has its name.
std::string ShapesMessage(std::uint64_t ns, const grammar::EntityTable& table);

/// The same of one of them in points, for viewers without markers.
std::string OutlineMessage(std::uint64_t ns, const grammar::EntityInfo& entity);

struct JointValue {
  std::string name;
  double position = 0;
};
std::string JointsMessage(std::uint64_t ns, std::span<const JointValue> joints);

std::string StringMessage(const std::string& text);

// Numbers and texts as bytes, one after another, little-endian: what MCAP, CDR, zip and NumPy lay
// down. Tested by tests/program/exported.py

struct ByteWriter {
  std::string bytes;
  std::size_t most_alignment = 1;  ///< numbers are aligned to their size, at most to this
  std::size_t origin = 0;          ///< alignment counts from here

  template <class T>
  ByteWriter& Number(T value) {
    static_assert(std::endian::native == std::endian::little);
    const std::size_t alignment = sizeof(T) < most_alignment ? sizeof(T) : most_alignment;
    while ((bytes.size() - origin) % alignment != 0) bytes += '\0';
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
    return *this;
  }
  ByteWriter& U16(std::size_t value) { return Number(static_cast<std::uint16_t>(value)); }
  ByteWriter& U32(std::size_t value) { return Number(static_cast<std::uint32_t>(value)); }
  ByteWriter& U64(std::uint64_t value) { return Number(value); }
  ByteWriter& F64(double value) { return Number(value); }

  /// With its length before it, 32 bits.
  ByteWriter& Text(std::string_view text) {
    U32(text.size());
    bytes += text;
    return *this;
  }
};

/// A message of ROS 2 (CDR, little-endian).
struct CdrWriter : ByteWriter {
  CdrWriter() { bytes = {'\0', '\1', '\0', '\0'}, most_alignment = 8, origin = 4; }
  /// Ended by a zero.
  CdrWriter& String(std::string_view text) {
    U32(text.size() + 1);
    bytes.append(text) += '\0';
    return *this;
  }
};

}  // namespace prehend::exchange
