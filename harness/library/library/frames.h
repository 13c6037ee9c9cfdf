// SPDX-License-Identifier: Apache-2.0
// Frames that come from elsewhere: arrays, a tracker, another simulator. They mean what the lines
// of docs/recording-format.md mean: velocities follow from positions, what is not tracked for a
// short time is as it was seen last. Tested by tests/python/test_events.py
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "harness/library/library/episode.h"

namespace prehend {

/// Where an entity is. A position of NaN: it is not tracked.
struct PoseSeen {
  int entity = 0;  ///< index into EntityTable::entities, as below
  Eigen::Vector3d p_WB_m = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector4d> q_wxyz = std::nullopt;  ///< of length 1; absent: as before
};
struct GripSeen {
  int hand = 0;
  double trigger = 0;  ///< 0 open .. 1 closed
};
struct TouchSeen {
  int a = 0, b = 0;
  double up_on_a = 0;  ///< upward part of the contact normal on a: 1: b holds it from below
};

/// Makes an episode of frames.
class PREHEND_API FrameBuilder {
 public:
  /// The first line of a recording, as JSON: the entities.
  explicit FrameBuilder(const std::string& first_line);
  ~FrameBuilder();

  const grammar::EntityTable& entities() const;
  /// After an error the frame is as if it had not been given. Ticks increase.
  void Take(grammar::Tick tick, std::span<const PoseSeen> poses, std::span<const GripSeen> grips,
            std::span<const TouchSeen> touches);
  /// `end`: the first tick after it. To be called once.
  Episode Finish(grammar::Tick end);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Watches lines of a recording as they come.
class PREHEND_API Monitor {
 public:
  Monitor(const Grammar& grammar, const std::string& first_line);
  ~Monitor();

  const grammar::EntityTable& entities() const;
  /// Lines for people: names in the grammar that nothing in the entities has; and behind them,
  /// after a first frame before 0, that times count from it.
  const std::string& warnings() const;
  /// So many ticks later than in the lines are the events, as the first frame is before 0.
  grammar::Tick moved() const;
  /// A line; returns the events that became certain with it. After an error, it is as if the line
  /// had not been given.
  grammar::Timeline Take(const std::string& line);
  /// `end`: the first tick after the episode. What is open ends there.
  grammar::Timeline Finish(grammar::Tick end);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace prehend
