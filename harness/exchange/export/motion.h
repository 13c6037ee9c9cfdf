// SPDX-License-Identifier: Apache-2.0
// An episode as it is exported, whatever it came from: who takes part, its frames, its events with
// their UUIDs. Tested by tests/program/exported.py
#pragma once

#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "harness/episode/episode/episode.h"

namespace prehend::exchange {

class Motion {
 public:
  /// Plays a scenario. `other_grammar`: its events count, not those that were recorded.
  static Result<Motion> Of(episode::Episode& episode, bool other_grammar);

  using Look = std::function<void(const grammar::Frame&)>;
  void EachFrame(const Look& look) const;

  const grammar::EntityTable& table() const { return header.entity_table; }
  double Seconds(grammar::Tick tick) const {
    return static_cast<double>(tick) / static_cast<double>(table().ticks_per_second);
  }
  /// Nanoseconds since the begin of the episode.
  std::uint64_t Nanoseconds(grammar::Tick tick) const;

  episode::EpisodeHeader header;
  grammar::Timeline timeline;
  std::vector<std::string> uuids;  ///< of its events
  std::size_t frames = 0;
  grammar::Tick end_tick = 0;
  bool says_its_end = true;
  std::string failure;  ///< "", or why its simulation ended early

  /// What is known of an entity from all frames.
  struct Seen {
    std::size_t looks = 0;  ///< frames in which it is tracked
    bool moves = false;
    bool has_joint = false;                  ///< it is somewhere else than at 0
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

// Motion in the formats of other programs (docs/episodes.md). Tested by
// tests/program/exported.py

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

}  // namespace prehend::exchange
