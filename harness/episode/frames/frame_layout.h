// SPDX-License-Identifier: Apache-2.0
// What a frame of an episode consists of, and in which numbered part of a chunk each of it is kept.
// A track is what changes together: a body, the grains of a body, all joints, a hand, all gazes.
// Tested by tests/harness/episode/frames/frames_test.cc
#pragma once

#include <span>
#include <vector>

#include "harness/episode/frames/columns.h"
#include "harness/episode/sense/episode_file.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::episode {

using ContactPoints = std::vector<physics::ContactPoint>;

struct FrameLayout {
  std::size_t bodies = 0;
  std::vector<std::size_t> grains;  ///< how many, of each body that is grains
  std::size_t joints = 0;
  std::vector<physics::HandModel> hands;
  std::size_t gazes = 0;

  std::size_t Joints() const { return bodies + grains.size(); }
  std::size_t FirstHand() const { return Joints() + (joints > 0 ? 1 : 0); }
  std::size_t Gazes() const { return FirstHand() + hands.size(); }
  std::size_t tracks() const { return Gazes() + (gazes > 0 ? 1 : 0); }

  // The numbers of parts: of a track its own, then contact points of pairs that may move and of
  // pairs that rest, then links of hands where they do not follow from palm and joints.
  std::size_t Contacts() const { return tracks(); }
  std::size_t Resting() const { return tracks() + 1; }
  std::size_t LinksOf(std::size_t hand) const { return tracks() + 2 + hand; }
};

FrameLayout LayoutOf(const physics::Scene& scene);

/// Appends a track of a snapshot to a row; and back. Reading throws Damage where a number that
/// other code uses as an index is out of its range.
void AppendRow(const FrameLayout& layout, std::size_t track, const physics::Snapshot& snapshot,
               std::vector<Word>& row);
void ReadRow(const FrameLayout& layout, std::size_t track, const Columns& columns, std::size_t row,
             physics::Snapshot& snapshot);
/// How many words that are.
std::size_t WidthOf(const FrameLayout& layout, std::size_t track);

/// The same of the links of a hand.
void AppendLinks(const std::vector<physics::Pose>& X_WL, std::vector<Word>& row);
void ReadLinks(const Columns& columns, std::size_t row, std::vector<physics::Pose>& X_WL);

/// Contact points of several moments; null: none. A row is a point, with the number of its moment.
/// A point stands below the one of the same sides in the moment before.
inline constexpr std::size_t kPointWidth = 15;
Columns TableOfPoints(const std::vector<const ContactPoints*>& moments);
std::vector<ContactPoints> PointsOfTable(const FrameLayout& layout, const Columns& table,
                                         std::size_t moments);

/// A snapshot with everything that the layout has, at the origin.
physics::Snapshot BlankSnapshot(const FrameLayout& layout);

// Frames of a recording (what a grammar sees, of a tracker or of another program) as tables.
// Tested by tests/harness/episode/frames/recorded_frames_test.cc

/// How many of these frames a chunk has, at least one: fewer if much is in them.
std::size_t FramesOfChunk(std::span<const EpisodeFrame> frames);

/// `placed`: as of the episode.
std::vector<Columns> TablesOfFrames(std::span<const EpisodeFrame> frames,
                                    const std::vector<bool>& placed);

struct RecordedFrames {
  std::vector<EpisodeFrame> frames;
  std::vector<bool> placed;
};
/// Throws Damage if they are none, or name what the entities do not have; any tables are safe.
RecordedFrames FramesOfTables(const std::vector<Columns>& tables,
                              const grammar::EntityTable& entities);

}  // namespace prehend::episode
