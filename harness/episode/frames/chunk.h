// SPDX-License-Identifier: Apache-2.0
// A chunk: the frames of about a second as compressed parts, one per track that changed, so that
// one track or one frame can be read without the others. Tested by
// tests/harness/episode/frames/frames_test.cc
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/episode/frames/frame_layout.h"
#include "harness/episode/frames/rigid_motion.h"

namespace prehend::episode {

using ContactPoints = std::vector<physics::ContactPoint>;

inline constexpr std::size_t kMostFramesOfChunk = 480;

struct ChunkPart {
  std::size_t part = 0;
  std::string bytes;
};

struct Chunk {
  std::int64_t first_tick = 0, last_tick = 0;
  std::size_t frames = 0;
  std::vector<ChunkPart> parts;  ///< in the order of their numbers
};

/// What a chunk's head says.
struct ChunkHead {
  std::vector<std::int64_t> ticks;
  /// Per track: how many chunks back its state stands; 0: in this chunk, frame by frame.
  std::vector<Word> back;
  bool has_contacts = false;
  std::optional<Word> resting_back;  ///< the same of the resting contacts; nothing: there are none
  std::vector<bool> has_links;       ///< per hand: whether its links have a part
};

/// Collects frames into chunks.
class ChunkWriter {
 public:
  explicit ChunkWriter(FrameLayout layout);
  ~ChunkWriter();
  ChunkWriter(ChunkWriter&&) noexcept;

  void Add(const physics::Snapshot& snapshot);
  std::size_t frames() const { return ticks_.size(); }
  bool IsFull() const;
  /// The frames since the last chunk, of which there is at least one.
  Chunk Take();

 private:
  struct Track {
    std::vector<Word> last, rows;
    bool active = false;
    Word home = 0;  ///< the number of the chunk that has its last state
  };
  struct Links {
    LinkGuess guess;
    // Per frame:
    std::vector<physics::Pose> palms;
    std::vector<double> joints;       ///< of all links
    std::vector<physics::Pose> X_WL;  ///< of all links
  };
  void AddTrack(std::size_t number, const physics::Snapshot& snapshot, bool may_have_moved);
  void AddLinks(const physics::Snapshot& snapshot);
  void AddResting(const physics::Snapshot& snapshot);
  std::string PackedTrack(std::size_t number);
  std::string PackedContacts();
  std::string PackedResting();
  /// Of each link 7 columns: how far the guess of its pose is off, frame by frame.
  static Columns LinksOff(const Links& links);
  std::string PackedLinks(const Columns& off);
  std::string PackedHead(const std::vector<bool>& has_links);

  FrameLayout layout_;
  Compressor compressor_;
  Word number_ = 0;
  bool is_first_ = true;
  std::int64_t last_tick_ = -1;
  std::size_t words_ = 0;
  std::vector<std::int64_t> ticks_;
  std::vector<Track> tracks_;
  std::vector<Word> row_;
  std::vector<Word> contact_counts_;
  ContactPoints contacts_;
  std::vector<physics::Pose> owners_;  ///< of the contact points, see OwnerOf()

  std::shared_ptr<const ContactPoints> resting_;
  bool has_resting_ = false;
  Word resting_home_ = 0;
  std::vector<std::pair<std::size_t, std::shared_ptr<const ContactPoints>>> new_resting_;

  std::vector<Links> links_;
};

/// The parts of chunks, decoded. Nothing where bytes are damaged; any bytes are safe.
class PartReader {
 public:
  explicit PartReader(const FrameLayout& layout) : layout_(layout) {}
  std::optional<ChunkHead> Head(std::string_view packed);
  /// A row per frame of the chunk.
  std::optional<Columns> Track(std::size_t track, std::string_view packed);
  struct Contacts {
    std::vector<std::size_t> begins;  ///< per frame, and the end
    ContactPoints points;
  };
  /// `pose`: of a side in a frame of the chunk that has `frames` of them.
  std::optional<Contacts> ContactsOf(
      std::string_view packed, std::size_t frames,
      const std::function<physics::Pose(std::size_t frame, const physics::ContactSide&)>& pose);
  struct RestingFrom {
    std::size_t frame = 0;
    std::shared_ptr<const ContactPoints> points;
  };
  std::optional<std::vector<RestingFrom>> Resting(std::string_view packed);
  /// How far the guesses of all link poses are off.
  std::optional<Columns> Links(std::size_t hand, std::string_view packed);

 private:
  const FrameLayout& layout_;
  Compressor compressor_;
};

/// A link's pose from its guess, and how far that is off.
void AddOff(const Columns& off, std::size_t frame, std::size_t link, physics::Pose& pose);

}  // namespace prehend::episode
