// SPDX-License-Identifier: Apache-2.0
// What a frame of an episode consists of, and in which numbered part of a chunk each of it is kept.
// A track is what changes together: a body, the grains of a body, all joints, a hand, all gazes.
// Tested by tests/harness/episode/frames/frames_test.cc
#pragma once

#include <span>
#include <vector>

#include "harness/episode/frames/columns.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::episode {

struct FrameLayout {
  int rate_hz = 480;
  std::size_t bodies = 0;
  std::vector<std::size_t> grains;  ///< how many, of each body that is grains
  std::size_t joints = 0;
  std::vector<physics::HandModel> hands;
  std::size_t gazes = 0;

  std::size_t FirstGrains() const { return bodies; }
  std::size_t Joints() const { return FirstGrains() + grains.size(); }
  std::size_t FirstHand() const { return Joints() + (joints > 0 ? 1 : 0); }
  std::size_t Gazes() const { return FirstHand() + hands.size(); }
  std::size_t tracks() const { return Gazes() + (gazes > 0 ? 1 : 0); }
  std::size_t Width(std::size_t track) const;

  // Part numbers: the head, the tracks, contacts, and links that their joints do not explain.
  static constexpr std::size_t kHead = 0;
  static std::size_t PartOfTrack(std::size_t track) { return 1 + track; }
  std::size_t Contacts() const { return 1 + tracks(); }
  std::size_t Resting() const { return 2 + tracks(); }
  std::size_t PartOfLinks(std::size_t hand) const { return 3 + tracks() + hand; }
  std::size_t parts() const { return 3 + tracks() + hands.size(); }
};

FrameLayout LayoutOf(const physics::Scene& scene);

/// How often a track holds the motion of a rigid body in its first columns.
bool IsRigid(const FrameLayout& layout, std::size_t track);

/// A track in a snapshot as words, and back. `row` has the track's width.
void ReadRow(const FrameLayout& layout, std::size_t track, const physics::Snapshot& snapshot,
             std::span<Word> row);
void WriteRow(const FrameLayout& layout, std::size_t track, const Columns& columns, std::size_t row,
              physics::Snapshot& snapshot);

/// Of the track of a body or a hand: where that is in a row, and how far a hand's joint has gone.
physics::Pose PoseInRow(const Columns& columns, std::size_t row);
double JointInRow(const Columns& columns, std::size_t row, std::size_t link);

/// Whether the numbers of a snapshot that other code uses as indices are in their ranges.
bool HasValidIndices(const FrameLayout& layout, const physics::Snapshot& snapshot);

/// A snapshot with everything that the layout has, at the origin.
physics::Snapshot BlankSnapshot(const FrameLayout& layout);

}  // namespace prehend::episode
