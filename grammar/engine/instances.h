// SPDX-License-Identifier: Apache-2.0
// RuleInstances: one per rule and binding, each with the state of its rule for these entities.
//
// An instance is *awake* while there is something to look at in the next frame, else it rests: its
// condition is what it was, and nobody looks at it until something it is made of changes. So each
// instance knows who asks about it (its watchers), and each entity which instances look at it. An
// instance exists from when its guard first held, or when somebody first asked, until nothing about
// it is true, open, undecided or within the remembered past. Its place is used again. Tested by
// tests/grammar/monitor_test.cc and tests/grammar/engine/changes_test.cc
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "grammar/engine/history.h"
#include "grammar/engine/instance_index.h"
#include "grammar/engine/stable_blocks.h"
#include "grammar/engine/three_valued.h"
#include "grammar/program/program.h"

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

/// What one frame says about two entities that touch; `up` in the order of the instance's roles.
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

/// An instance that asks about another one, and as what: all that is needed to see that it need not
/// be looked at.
struct Watcher {
  int instance = kNone;
  bool guarded = false;        ///< the other one is its guard
  bool guarded_begin = false;  ///< likewise, see Rule
  bool opened = false;         ///< nothing of it begins but with a moment of the other one
  bool swapped = false;        ///< `instant` names the two of the touch the other way round
  ThresholdSet press = 0;      ///< what matters to it of how the two touch
  const MeasuredPart* instant =
      nullptr;           ///< of its rule, if that is instant and the other one is its touch
  int hand = kNoEntity;  ///< whose grip `instant` asks for
};

/// A finished interval that waits for its confirmation.
struct Pending {
  Span span;
  int style = kNoEntity;
  FrameNumber next = 0;  ///< first frame not yet searched for the confirmation
  std::array<double, kMaxAttributes> attributes = {};
};

/// What every look at an instance needs comes first, so that it shares a line of the cache or two.
struct alignas(64) RuleInstance : InstanceKey {  // rule kNone: the instance is free
  int index = kNone;
  bool awake = false;
  bool open = false;                 ///< a run has begun
  bool certain = false;              ///< the open run will be an interval whatever comes
  bool in_gap = false;               ///< the run may have ended at `gap`
  bool dependents_made = false;      ///< the instances that this one guards are there
  bool idle_queued = false;          ///< waits to be freed
  Kleene reported = Kleene::kFalse;  ///< the truth at the newest frame, as far as the watchers know
  FrameNumber known = kNever;        ///< truth is final before this frame
  Moment begin;
  FrameNumber moment =
      kNever;  ///< Rule::opened_by: nothing begins after this frame until its next change
  // The second line: what a touch is looked at for.
  FrameNumber touched = -1;          ///< kTouching only: the last frame that said so
  ThresholdSet beyond = 0;           ///< kTouching only, while it is open: of the newest sample
  std::vector<Watcher> watchers;     ///< instances to wake when the truth of this one changes
  RingBuffer<BeyondSample> beyonds;  ///< kTouching only, where they change
  // The third line: what instances are stepped with.
  FrameNumber next = 0;  ///< first frame not yet looked at; nothing while at rest
  FrameNumber resting_since = 0;
  RingBuffer<Span> past;        ///< intervals, as long as somebody may ask
  std::vector<int> references;  ///< instances, one per Rule::references; kNone: not asked for yet
  // The rest.
  std::vector<Pending> pending;
  Moment gap;
  std::vector<double> anchors;      ///< three numbers per Rule::anchors
  RingBuffer<TouchSample> touches;  ///< kTouching only, where they change, if a rule asks for them
  std::size_t touching_place = 0;   ///< kTouching only: where among those that touch now
  int style = kNoEntity;
  std::array<int, kMaxRoles> watch_places =
      kUnbound;                   ///< by role: where in the list of the entity's watchers
  FrameNumber approach_from = 0;  ///< kUntilSince: no later interval reaches back before this frame
  FrameNumber last_end =
      0;  ///< kUntilSince: frame of the previous `until`; kCompose: end of the previous one
  std::vector<int> members;              ///< kAny only: the instances of which one must hold
  std::vector<std::vector<Span>> parts;  ///< kCompose: finished intervals of each part
};

/// An instance that looks at an entity in one of its roles.
struct Watch {
  int instance = kNone;
  int role = kNone;
};

class RuleInstances {
 public:
  RuleInstances(const Program& program, const EntityTable& entity_table);

  /// Binds the rules that have no guard.
  void BindUnguarded();
  /// Makes the instance, at rest, if it is not there. kNone if an entity's class does not fit, or
  /// there are TooMany().
  int Ensure(int rule, const Binding& entities) {
    const InstanceKey key = Canonical(rule, entities);
    const int found = Find(key);
    return found != kNone ? found : Make(key);
  }
  /// Likewise, for everybody who can play the roles that are free, and appends them to `made`.
  void EnsureAll(int rule, Binding entities, std::vector<int>& made);
  /// Makes the instances that this one guards and appends them to `made`, those that were there
  /// already, too.
  void MakeDependents(int instance, std::vector<int>& made);
  /// Frees an instance that nothing but kAny instances watches. Appends the instances that it
  /// leaves without a watcher.
  void Free(int instance, std::vector<int>& orphans);
  bool TooMany() const { return too_many_ != kNone; }
  /// Which rule needs them, and how many can play each of its roles.
  std::string WhyTooMany() const;

  RuleInstance& operator[](int instance) { return instances_[static_cast<std::size_t>(instance)]; }
  const RuleInstance& operator[](int instance) const {
    return instances_[static_cast<std::size_t>(instance)];
  }
  /// Numbers of instances are below this, free ones included.
  int size() const { return static_cast<int>(instances_.size()); }
  int in_use() const { return static_cast<int>(instances_.size() - free_.size()); }

  /// The instance that reference `slot` of `instance` means, made if need be; from now on its
  /// changes wake this one.
  int Resolve(RuleInstance& instance, int slot);
  /// Likewise, kNone if it is not there.
  int Find(const RuleInstance& instance, int slot) const { return Find(Referred(instance, slot)); }
  int Find(int rule, const Binding& entities) const { return Find(Canonical(rule, entities)); }
  int FindTouch(int a, int b) const { return touches_.Find(PairKey(a, b)); }
  /// It will be looked at soon: what is far away in memory is on its way meanwhile.
  void Fetch(int instance) const {
    const char* at = reinterpret_cast<const char*>(&instances_[static_cast<std::size_t>(instance)]);
    for (int line = 0; line < 3; ++line) __builtin_prefetch(at + 64 * line);
  }

  /// The instances that look at an entity, and those that look at nothing but its grip.
  const std::vector<Watch>& PoseWatchers(int entity) const { return pose_watchers_[entity]; }
  const std::vector<Watch>& GripWatchers(int entity) const { return grip_watchers_[entity]; }
  /// The instance's guard is false, and known to be.
  bool GuardRests(const RuleInstance& instance) const;

  Kleene TruthAt(int index, FrameNumber frame) const {
    if (index == kNone) return Kleene::kFalse;
    const RuleInstance& instance = instances_[index];
    if (frame >= instance.known) return Kleene::kUnknown;
    if (instance.open && instance.certain && frame >= instance.begin.frame) return Kleene::kTrue;
    return AnyPast(instance, [frame](const Span& past) {
      return frame >= past.begin.frame && frame < past.end.frame;
    });
  }
  Kleene BeginsAt(int index, FrameNumber frame) const {
    if (index == kNone) return Kleene::kFalse;
    const RuleInstance& instance = instances_[index];
    if (frame >= instance.known) return Kleene::kUnknown;
    if (instance.open && instance.certain && frame == instance.begin.frame) return Kleene::kTrue;
    return AnyPast(instance, [frame](const Span& past) { return past.begin.frame == frame; });
  }
  Kleene EndsAt(int index, FrameNumber frame) const {
    if (index == kNone) return Kleene::kFalse;
    const RuleInstance& instance = instances_[index];
    if (frame >= instance.known) return Kleene::kUnknown;
    return AnyPast(instance, [frame](const Span& past) { return past.end.frame == frame; });
  }

  bool IsA(int entity, const std::string& class_name) const;

 private:
  InstanceKey Canonical(int rule, const Binding& entities) const {
    const bool swap = symmetric_[rule] != 0 && name_rank_[entities[1]] < name_rank_[entities[0]];
    return {rule, swap ? Binding{entities[1], entities[0], entities[2], entities[3]} : entities};
  }
  int Make(const InstanceKey& key);
  int Find(const InstanceKey& key) const {
    return key.rule == kTouchingRule ? FindTouch(key.entities[0], key.entities[1])
                                     : index_.Find(key);
  }
  void Refer(RuleInstance& instance, int slot, int target);
  InstanceKey Referred(const RuleInstance& instance, int slot) const;
  bool Fits(int rule, const Binding& entities) const;
  void BindRest(int rule, Binding& entities, std::size_t role, int guard, std::vector<int>* made);
  void LinkToGuard(int instance, int guard);
  void WatchEntities(RuleInstance& instance);
  void UnwatchEntities(const RuleInstance& instance);
  template <typename Which>
  static Kleene AnyPast(const RuleInstance& instance, const Which& which) {
    for (std::size_t i = instance.past.size(); i-- > 0;) {
      if (which(instance.past[i])) return Kleene::kTrue;
    }
    return Kleene::kFalse;
  }
  void Unlink(int instance, int watcher, std::vector<int>& orphans);
  const Program& program_;
  const EntityTable& entity_table_;
  StableBlocks<RuleInstance> instances_;  // an instance stays where it is when others are made
  std::vector<int> free_;
  InstanceIndex<InstanceKey> index_;
  InstanceIndex<PairKey> touches_;                    // the instances of kTouchingRule
  std::vector<std::vector<int>> guarded_;             // by rule: the rules it guards
  std::vector<std::vector<std::vector<bool>>> fits_;  // by rule, role, entity
  std::vector<std::vector<Watch>> pose_watchers_;     // by entity
  std::vector<std::vector<Watch>> grip_watchers_;
  std::vector<int> name_rank_;   // alphabetical order of entities
  std::vector<char> symmetric_;  // by rule
  int too_many_ = kNone;         // the rule that would have had more than can be
};

}  // namespace prehend::grammar
