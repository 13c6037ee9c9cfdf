// SPDX-License-Identifier: Apache-2.0
// Lanes: one per rule and binding, each with the state of its rule for these entities.
//
// A lane is *awake* while there is something to look at in the next frame, else it rests: its
// condition is what it was, and nobody looks at it until something it is made of changes. So each
// lane knows who asks about it (its watchers), and each entity which lanes look at it. A lane
// exists from when its guard first held, or when somebody first asked, until nothing about it is
// true, open, undecided or within the remembered past. Its place is used again. Tested by
// tests/grammar/monitor_test.cc and tests/grammar/changes_test.cc
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "grammar/blocks.h"
#include "grammar/history.h"
#include "grammar/kleene.h"
#include "grammar/lane_index.h"
#include "grammar/program.h"

namespace prehend::grammar {

/// An interval with the frames of its boundaries.
struct Span {
  Moment begin;
  Moment end;
  bool open_end = false;
  Moment completed = {};  ///< of a composition: where its last part ends, if that is later

  /// From here on it is known.
  Moment Complete() const {
    return completed.tick > end.tick && completed.frame > 0 ? completed : end;
  }
};

/// Of each part of a composition only the last ones are kept.
inline constexpr std::size_t kRememberedSpans = 64;

/// What one frame says about two entities that touch; `up` in the order of the lane's roles.
struct TouchSample {
  FrameNumber frame = 0;
  std::array<double, 2> up = {-1, -1};
  double force_n = 0;
  double vertical_speed_m_per_s = 0;
  std::uint32_t sensor_sets = 0;
};

/// Which thresholds that is beyond.
struct BeyondSample {
  FrameNumber frame = 0;
  ThresholdSet beyond = 0;
};

/// A lane that asks about another one, and as what: all that is needed to see that it need not be
/// looked at.
struct Watcher {
  int lane = kNone;
  bool guarded = false;        ///< the other one is its guard
  bool guarded_begin = false;  ///< likewise, see Rule
  bool opened = false;         ///< nothing of it begins but with a moment of the other one
  bool turned = false;         ///< `instant` names the two of the touch the other way round
  ThresholdSet press = 0;      ///< what matters to it of how the two touch
  const MeasuredPart* instant =
      nullptr;         ///< of its rule, if that is instant and the other one is its touch
  int hand = kNobody;  ///< whose grip `instant` asks for
};

/// A finished interval that waits for its confirmation.
struct Pending {
  Span span;
  int style = kNobody;
  FrameNumber next = 0;  ///< first frame not yet searched for the confirmation
  std::array<double, kMaxAttributes> attributes = {};
};

/// What every look at a lane needs comes first, so that it shares a line of the cache or two.
struct alignas(64) Lane : LaneKey {  // rule kNone: the lane is free
  int index = kNone;
  bool awake = false;
  bool open = false;             ///< a run has begun
  bool certain = false;          ///< the open run will be an interval whatever comes
  bool in_gap = false;           ///< the run may have ended at `gap`
  bool dependents_made = false;  ///< the lanes that this one guards are there
  bool retiring = false;         ///< waits to be freed
  Kleene told = Kleene::kFalse;  ///< the truth at the newest frame, as far as the watchers know
  FrameNumber known = kNever;    ///< truth is final before this frame
  Moment begin;
  FrameNumber moment =
      kNever;  ///< Rule::opened_by: nothing begins after this frame until its next change
  // The second line: what a touch is looked at for.
  FrameNumber touched = -1;       ///< kTouching only: the last frame that said so
  ThresholdSet beyond = 0;        ///< kTouching only, while it is open: of the newest sample
  std::vector<Watcher> watchers;  ///< lanes to wake when the truth of this one changes
  Ring<BeyondSample> beyonds;     ///< kTouching only, where they change
  // The third line: what lanes are stepped with.
  FrameNumber next = 0;  ///< first frame not yet looked at; nothing while at rest
  FrameNumber resting_since = 0;
  Ring<Span> past;              ///< intervals, as long as somebody may ask
  std::vector<int> references;  ///< lanes, one per Rule::references; kNone: not asked for yet
  // The rest.
  std::vector<Pending> pending;
  Moment gap;
  std::vector<double> anchors;     ///< three numbers per Rule::anchors
  Ring<TouchSample> touches;       ///< kTouching only, where they change, if a rule asks for them
  std::size_t touching_place = 0;  ///< kTouching only: where among those that touch now
  int style = kNobody;
  std::array<int, kMaxRoles> watch_places =
      kUnbound;                   ///< by role: where in the list of the entity's watchers
  FrameNumber approach_from = 0;  ///< kUntilSince: no later interval reaches back before this frame
  FrameNumber last_end =
      0;  ///< kUntilSince: frame of the previous `until`; kCompose: end of the previous one
  std::vector<int> members;              ///< kAny only: the lanes of which one must hold
  std::vector<std::vector<Span>> parts;  ///< kCompose: finished intervals of each part
};

/// A lane that looks at an entity in one of its roles.
struct Watch {
  int lane = kNone;
  int role = kNone;
};

class Lanes {
 public:
  Lanes(const Program& program, const Cast& cast);

  /// Binds the rules that have no guard.
  void BindUnguarded();
  /// Makes the lane, at rest, if it is not there. kNone if an entity's class does not fit, or there
  /// are TooMany().
  int Ensure(int rule, const Binding& entities) {
    const LaneKey key = Canonical(rule, entities);
    const int found = Find(key);
    return found != kNone ? found : Make(key);
  }
  /// Likewise, for everybody who can play the roles that are free, and appends them to `made`.
  void EnsureAll(int rule, Binding entities, std::vector<int>& made);
  /// Makes the lanes that this one guards and appends them to `made`, those that were there
  /// already, too.
  void MakeDependents(int lane, std::vector<int>& made);
  /// Frees a lane that nothing but kAny lanes watches. Appends the lanes that it leaves without a
  /// watcher.
  void Free(int lane, std::vector<int>& orphans);
  bool TooMany() const { return too_many_ != kNone; }
  /// Which rule needs them, and how many can play each of its roles.
  std::string WhyTooMany() const;

  Lane& operator[](int lane) { return lanes_[static_cast<std::size_t>(lane)]; }
  const Lane& operator[](int lane) const { return lanes_[static_cast<std::size_t>(lane)]; }
  /// Numbers of lanes are below this, free ones included.
  int size() const { return static_cast<int>(lanes_.size()); }
  int in_use() const { return static_cast<int>(lanes_.size() - free_.size()); }

  /// The lane that reference `slot` of `lane` means, made if need be; from now on its changes wake
  /// this one.
  int Resolve(Lane& lane, int slot);
  /// Likewise, kNone if it is not there.
  int Find(const Lane& lane, int slot) const { return Find(Referred(lane, slot)); }
  int Find(int rule, const Binding& entities) const { return Find(Canonical(rule, entities)); }
  int FindTouch(int a, int b) const { return touches_.Find(PairKey(a, b)); }
  /// It will be looked at soon: what is far away in memory is on its way meanwhile.
  void Fetch(int lane) const {
    const char* at = reinterpret_cast<const char*>(&lanes_[static_cast<std::size_t>(lane)]);
    for (int line = 0; line < 3; ++line) __builtin_prefetch(at + 64 * line);
  }

  /// The lanes that look at an entity, and those that look at nothing but its grip.
  const std::vector<Watch>& PoseWatchers(int entity) const { return pose_watchers_[entity]; }
  const std::vector<Watch>& GripWatchers(int entity) const { return grip_watchers_[entity]; }
  /// The lane's guard is false, and known to be.
  bool GuardRests(const Lane& lane) const;

  Kleene TruthAt(int index, FrameNumber frame) const {
    if (index == kNone) return Kleene::kFalse;
    const Lane& lane = lanes_[index];
    if (frame >= lane.known) return Kleene::kUnknown;
    if (lane.open && lane.certain && frame >= lane.begin.frame) return Kleene::kTrue;
    return AnyPast(lane, [frame](const Span& past) {
      return frame >= past.begin.frame && frame < past.end.frame;
    });
  }
  Kleene BeginsAt(int index, FrameNumber frame) const {
    if (index == kNone) return Kleene::kFalse;
    const Lane& lane = lanes_[index];
    if (frame >= lane.known) return Kleene::kUnknown;
    if (lane.open && lane.certain && frame == lane.begin.frame) return Kleene::kTrue;
    return AnyPast(lane, [frame](const Span& past) { return past.begin.frame == frame; });
  }
  Kleene EndsAt(int index, FrameNumber frame) const {
    if (index == kNone) return Kleene::kFalse;
    const Lane& lane = lanes_[index];
    if (frame >= lane.known) return Kleene::kUnknown;
    return AnyPast(lane, [frame](const Span& past) { return past.end.frame == frame; });
  }

  bool IsA(int entity, const std::string& class_name) const;

 private:
  LaneKey Canonical(int rule, const Binding& entities) const {
    const bool swap = symmetric_[rule] != 0 && name_rank_[entities[1]] < name_rank_[entities[0]];
    return {rule, swap ? Binding{entities[1], entities[0], entities[2], entities[3]} : entities};
  }
  int Make(const LaneKey& key);
  int Find(const LaneKey& key) const {
    return key.rule == kTouchingRule ? FindTouch(key.entities[0], key.entities[1])
                                     : index_.Find(key);
  }
  void Refer(Lane& lane, int slot, int target);
  LaneKey Referred(const Lane& lane, int slot) const;
  bool Fits(int rule, const Binding& entities) const;
  void BindRest(int rule, Binding& entities, std::size_t role, int guard, std::vector<int>* made);
  void LinkToGuard(int lane, int guard);
  void WatchEntities(Lane& lane);
  void UnwatchEntities(const Lane& lane);
  template <typename Which>
  static Kleene AnyPast(const Lane& lane, const Which& which) {
    for (std::size_t i = lane.past.size(); i-- > 0;) {
      if (which(lane.past[i])) return Kleene::kTrue;
    }
    return Kleene::kFalse;
  }
  void Unlink(int lane, int watcher, std::vector<int>& orphans);
  const Program& program_;
  const Cast& cast_;
  Blocks<Lane> lanes_;  // a lane stays where it is when others are made
  std::vector<int> free_;
  LaneIndex<LaneKey> index_;
  LaneIndex<PairKey> touches_;                        // the lanes of kTouchingRule
  std::vector<std::vector<int>> guarded_;             // by rule: the rules it guards
  std::vector<std::vector<std::vector<bool>>> fits_;  // by rule, role, entity
  std::vector<std::vector<Watch>> pose_watchers_;     // by entity
  std::vector<std::vector<Watch>> grip_watchers_;
  std::vector<int> name_rank_;   // alphabetical order of entities
  std::vector<char> symmetric_;  // by rule
  int too_many_ = kNone;         // the rule that would have had more than can be
};

}  // namespace prehend::grammar
