// SPDX-License-Identifier: Apache-2.0
// An episode as a file of JSON Lines: first the entities, then one line per frame. It holds what a
// grammar needs to segment the episode again, and nothing more (docs/recording-format.md). It is
// written by `prehend run --record`, by trackers or by hand. Looks that are missing: for a short
// time an entity is as it was seen last, then nobody knows. Tested by
// tests/harness/episode/sense/episode_file_test.cc and tests/program/not_tracked_test.cc
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/base/base/result.h"

namespace prehend::episode {

/// How long an entity was not tracked, of an episode.
struct LookGaps {
  std::size_t gaps = 0;
  grammar::Tick bridged = 0, unknown = 0;  ///< ticks of them all
};

/// Takes the frames of an episode one after another.
class GapTolerance {
 public:
  GapTolerance() = default;
  /// `most`: for so many ticks after its last look an entity is as it was then.
  GapTolerance(std::size_t entities, grammar::Tick most) : most_(most), seen_(entities) {}

  struct Seen {
    grammar::Tick tick = 0;
    grammar::EntitySample look;
  };
  /// The last look of an entity, if it still counts at this tick.
  const Seen* LastOf(std::size_t entity, grammar::Tick tick) const;

  /// Replaces what is not tracked and still counts, by the last look with its velocity.
  void Fill(grammar::Tick tick, std::vector<grammar::EntitySample>& looks);

  /// By entity, of an episode that ends there.
  std::vector<LookGaps> Gaps(grammar::Tick end_tick) const;

 private:
  struct Entity {
    std::optional<Seen> last;
    bool tracked = true;  ///< in the last frame
    LookGaps gaps;
  };
  LookGaps GapsUntil(grammar::Tick tick, std::size_t entity) const;

  grammar::Tick most_ = 0;
  std::optional<grammar::Tick> before_;  ///< the last frame
  std::vector<Entity> seen_;
};

/// A line for each entity that was not tracked for a while; "" if there is none.
std::string GapsText(const grammar::EntityTable& table, const std::vector<LookGaps>& gaps);

inline constexpr int kEpisodeVersion = 1;
inline constexpr std::size_t kMaxEpisodeFrames = 1'000'000;
inline constexpr std::size_t kMaxEpisodeBytes = std::size_t{1} << 30;
inline constexpr std::size_t kMaxEpisodeLineBytes = 1 << 20;
inline constexpr std::size_t kMaxLanguageBytes = 1000;
inline constexpr double kBridge_s = 0.1;

/// What is known of an episode beside its frames.
struct EpisodeAttributes {
  std::optional<bool> success;
  std::string language;  ///< what was to be done, in words; "": nothing says it
};

/// The first line.
struct EpisodeHeader {
  std::string episode;  ///< its name: of the scenario that was recorded
  std::string grammar;  ///< what segments it unless another one is asked for; several with '+'
  /// Where a file names the grammar: the rest of an error about it. Without a file: nowhere.
  grammar::Diagnostic grammar_named = {};
  double bridge_s = kBridge_s;  ///< for so long a missing look is as the last one
  EpisodeAttributes attributes;
  grammar::EntityTable entity_table;
};

/// A frame that owns its data.
struct EpisodeFrame {
  grammar::Tick tick = 0;
  std::vector<grammar::EntitySample> entities;
  std::vector<grammar::HandSample> hands;  ///< their spans are empty, see `collision_spheres`
  std::vector<std::vector<grammar::CollisionSphere>> collision_spheres;  ///< per hand
  std::vector<grammar::Touch> touches;

  /// Valid as long as this frame, until it changes.
  grammar::Frame View();
};

struct Recording {
  using Look = std::function<void(EpisodeFrame& frame)>;
  EpisodeHeader header;
  std::vector<EpisodeFrame> frames;
  /// Goes through frames that are not kept in memory, and so are not in `frames`.
  std::function<void(const Look&)> play = {};
  std::uint64_t hash = 0;      ///< of these, if not 0: HashOfFrames()
  grammar::Tick end_tick = 0;  ///< the first tick after the episode
  std::vector<bool> placed;    ///< by entity: some frame says where it is
  std::vector<LookGaps> gaps;  ///< by entity: how long it is not tracked
  grammar::Tick moved = 0;     ///< by so much later than in its file, as that begins before 0
  bool says_its_end = false;   ///< it has a line with 'end_tick'; otherwise it may be cut off

  /// In their order; a frame holds until the next one.
  void EachFrame(const Look& look);
  /// From now on they are in memory, to be looked at in any order.
  void Keep();
};

/// For frames that are played, and were not read from a file: what is not tracked for a short time
/// is as it was seen last.
void BridgeLooks(Recording& episode);

/// Of labels, goldens, episode files and most formats no time lies before 0: what begins before it
/// counts from its first frame. By how many ticks it is moved, and what is said of that.
grammar::Tick MovedBy(grammar::Tick first_frame);
std::string MovedText(const EpisodeHeader& header, grammar::Tick moved);

/// Reports errors with file, line and column. The limits are those above.
Result<Recording> ReadRecording(const std::string& path);

/// Facts of frames beside the poses; without triggers there are no styles, either.
struct WrittenFacts {
  bool touches = true, trigger = true, joints = true, gazes = true;
};

/// Writes each frame as it comes.
class EpisodeWriter {
 public:
  EpisodeWriter(std::ostream& out, const EpisodeHeader& header, const WrittenFacts& facts = {});
  void Write(const grammar::Frame& frame);
  void Finish(grammar::Tick end_tick);

 private:
  std::ostream& out_;
  const WrittenFacts facts_;
  const bool bridges_;  ///< who reads it, what is not tracked for a short time
  grammar::EntityTable entity_table_;
  std::vector<std::string> shown_;  ///< per entity: its last line, as only changes are written
};

// A recording that is read while it is written: line by line. A faulty line changes nothing, so
// that the next ones can still be read. Tested by tests/program/watch_test.cc

struct FrameEntry;  // harness/episode/sense/episode_format.h

class EpisodeStream {
 public:
  /// `name` is that of the file, for messages. `keeps_all`: the frames, for Whole().
  explicit EpisodeStream(const std::string& name, bool keeps_all = false);
  ~EpisodeStream();
  EpisodeStream(const EpisodeStream&) = delete;
  EpisodeStream& operator=(const EpisodeStream&) = delete;

  /// A frame that is farther than this after the one before waits for the next one. If that agrees
  /// with it, there was a pause; else it is left out.
  void DoubtFrames(double ahead_s);
  /// Takes the next line, of at most kMaxEpisodeLineBytes. Returns what is wrong with it.
  grammar::Diagnostics Take(const std::string& line);
  /// The same of values that are within the limits of the format.
  grammar::Diagnostics Take(const FrameEntry& frame);

  bool has_header() const;
  const EpisodeHeader& header() const;
  /// The frame that the last line held, until the next line, behind one that has waited for it.
  std::span<EpisodeFrame> frames();
  EpisodeFrame* frame() { return frames().empty() ? nullptr : &frames().back(); }
  /// At the end: what is wrong with a frame that still waits.
  grammar::Diagnostics LeftOut();
  /// What was not tracked so far, and for how long: lines for people.
  std::string gaps() const;
  /// A line has said where the episode ends.
  bool says_its_end() const;
  /// The first tick after the episode, as far as it is known; 0 without any frame.
  grammar::Tick end_tick() const;
  /// All that was taken, at the end.
  Result<Recording> Whole(grammar::Tick end_tick);

 private:
  struct Reader;
  std::unique_ptr<Reader> reader_;
};

}  // namespace prehend::episode
