// SPDX-License-Identifier: Apache-2.0
// Monitor instances: one per rule and binding, each with the state of its rule for these entities.
//
// An instance is *awake* while there is something to look at in the next frame; else it rests: its
// condition is what it was, and it is not looked at until something that it is made of changes. So
// each instance knows the instances that ask about it (its watchers), and each entity the instances
// that look at it. An instance that is awake *waits* if it cannot decide its next frame before one
// that it asks about can: it is not looked at until that one tells more. If it asks about nothing
// but others, it may *follow* them: it is as it was, as far as they are known, and not looked at
// until one of them begins or ends. An instance exists from
// when its guard first held, or when another one first asked about it, until nothing about it is
// true, open, undecided or within the remembered past. Its place is used again, by a rule with the
// same kind of state, so that memory is used again too. Tested by tests/grammar/monitor_test.cc and
// tests/grammar/engine/changes_test.cc
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "grammar/base/check.h"
#include "grammar/base/three_valued.h"
#include "grammar/program/program.h"
#include "grammar/state/history.h"
#include "grammar/state/instance_index.h"

namespace prehend::grammar {

/// Intervals of its parts that may still become part of one composition; more end the run.
inline constexpr std::size_t kMostRememberedSpans = 100'000;

/// What one frame says about two entities that touch; `up` in the order of the instance's roles,
/// the normal on the first of them.
struct TouchSample {
  FrameNumber frame = 0;
  std::array<double, 2> up = {-1, -1};
  double force_n = 0;
  double vertical_speed_m_per_s = 0;
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d nhat_W = Eigen::Vector3d::Zero();
  std::uint32_t sensor_sets = 0;
  /// But for the frame: whether nobody can tell one from the other.
  bool Says(const TouchSample& other) const {
    return up == other.up && force_n == other.force_n && p_W_m == other.p_W_m &&
           nhat_W == other.nhat_W && sensor_sets == other.sensor_sets &&
           SameNumber(vertical_speed_m_per_s, other.vertical_speed_m_per_s);
  }
};

/// Which thresholds it has crossed.
struct ThresholdSample {
  FrameNumber frame = 0;
  ThresholdSet crossed = 0;
};

/// An instance that asks about another one, the watched one: all that is needed to see whether it
/// has to be looked at.
struct Watcher {
  /// What the watched one is to it.
  enum class Kind : std::uint8_t {
    kMeasured,    ///< its touch, and `measured` alone decides when its interval begins and ends
    kGuard,       ///< its guard: nothing begins while that is false
    kBeginGuard,  ///< its guard, and that must hold at the very frame in which something begins
    kCondition,   ///< anything else that it asks for
  };
  InstanceId instance;
  Kind kind = Kind::kCondition;
  bool opened = false;          ///< nothing of it begins but with a moment of the watched one
  bool swapped = false;         ///< `measured` names the two of the touch the other way round
  ThresholdSet thresholds = 0;  ///< which of them matter to it, of how the two touch
  const MeasuredPart* measured = nullptr;  ///< kMeasured only
  int hand = kNoEntity;                    ///< the hand that `measured` asks for
};

/// A finished interval that waits for its confirmation.
struct Pending {
  Span span;
  int style = kNoEntity;
  FrameNumber next = 0;  ///< first frame not yet searched for the confirmation
  std::array<double, kMaxAttributes> attributes = {};
};

// What instances of one form remember, and those of other forms do not. Reset() forgets it and
// keeps the memory.

/// An instance of `touching`.
struct TouchingState {
  FrameNumber touched = -1;               ///< the last frame that said so
  ThresholdSet crossed_thresholds = 0;    ///< of the newest sample, while it is open
  RingBuffer<ThresholdSample> crossings;  ///< where they change
  RingBuffer<TouchSample> touches;        ///< where they change, if a rule asks for them
  std::size_t place = 0;                  ///< in the list of those that touch now
  void Reset();
};

/// An instance made for an `any`.
struct AnyState {
  std::vector<InstanceId> members;  ///< the instances of which one must hold
  int owner = kNoEntity;            ///< AnyRule::one: whose turn it is, or is next
  FrameNumber owned_from = 0;
  void Reset() {
    members.clear();
    owner = kNoEntity;
  }
};

/// An instance of `until .. since`.
struct UntilSinceState {
  FrameNumber approach_from = 0;  ///< no later interval reaches back before this frame
  FrameNumber last_end = 0;       ///< frame of the previous `until`
  void Reset() { last_end = 0; }
};

/// An instance of `from .. to`.
struct FromToState {
  RingBuffer<Moment> waiting;  ///< `each`: the begins after that of the open run
  void Reset() { waiting.Clear(); }
};

/// An instance of a composition.
struct ComposeState {
  FrameNumber last_end = 0;              ///< end of the previous one
  std::vector<std::vector<Span>> parts;  ///< finished intervals of each part, by time
  std::size_t unjudged = 0;              ///< of them
  std::size_t next_look = 0;  ///< when there are so many it is seen which are of no more use
  void Reset() { last_end = unjudged = next_look = 0; }
  /// Forgets intervals of a part.
  template <typename Which>
  void Drop(std::size_t part, const Which& which) {
    std::erase_if(parts[part], [&](const Span& span) {
      if (which(span) && !span.judged) --unjudged;
      return which(span);
    });
  }
};

/// The other forms need no more than the head.
struct NoState {
  void Reset() {}
};

using FormState =
    std::variant<NoState, TouchingState, AnyState, UntilSinceState, ComposeState, FromToState>;

/// The head stands first, in the order in which a frame needs it: what every look at an instance
/// needs shares a line of the cache or two.
struct alignas(64) RuleInstance : InstanceKey {  // rule kNone: the instance is free
  InstanceId index;
  bool awake = false;
  bool open = false;                 ///< a run has begun
  bool certain = false;              ///< the open run will be an interval whatever comes
  bool in_gap = false;               ///< the run may have ended at `gap`
  bool dependents_made = false;      ///< the instances that this one guards are there
  bool idle_queued : 1 = false;      ///< waits to be freed
  bool waits : 1 = false;            ///< awake, but not stepped until one it asks about tells more
  bool follows : 1 = false;          ///< waits, and is as it was until one of those begins or ends
  bool followed : 1 = false;         ///< some instance follows this one
  bool by_itself : 1 = false;        ///< what its last step found may change with time alone
  bool rests_apart : 1 = false;      ///< poses do not wake it yet, see Watch::rests_until_m
  bool awaited = false;              ///< some instance waits for this one to tell more
  Kleene reported = Kleene::kFalse;  ///< the truth at the newest frame, as far as the watchers know
  FrameNumber known = kNever;        ///< truth is final before this frame; see KnownOf()
  Moment begin;
  FrameNumber moment =
      kNever;  ///< Rule::opened_by: nothing begins after this frame until its next change
  // The second line: what a touch is looked at for.
  std::vector<Watcher> watchers;  ///< instances to wake when the truth of this one changes
  FormState of_form;
  // The third line: what instances are stepped with.
  FrameNumber next = 0;  ///< first frame not yet looked at; nothing while at rest
  FrameNumber resting_since = 0;
  RingBuffer<Span> past;  ///< intervals, as long as they may be asked for
  std::vector<InstanceId>
      references;  ///< instances, one per Rule::references; kNone: not asked for yet
  // The rest.
  std::vector<Pending> pending;
  Moment gap;
  std::vector<double> anchors;  ///< three numbers per Rule::anchors
  int style = kNoEntity;
  int count = 0;  ///< `repeat`: intervals in the open run
  std::array<int, kMaxRoles> watch_places =
      kUnbound;  ///< by role: where in the list of the entity's watchers

  /// The state of its form; the rule must have it. Asks for nothing, not even for the form.
  template <typename State>
  State& As() {
    PREHEND_DCHECK(std::holds_alternative<State>(of_form));
    State* const state = std::get_if<State>(&of_form);
    if (state == nullptr) __builtin_unreachable();
    return *state;
  }
  template <typename State>
  const State& As() const {
    return const_cast<RuleInstance&>(*this).As<State>();
  }
  /// Null if the rule is of another form.
  template <typename State>
  State* If() {
    return std::get_if<State>(&of_form);
  }
  template <typename State>
  const State* If() const {
    return std::get_if<State>(&of_form);
  }
};

/// An instance that looks at an entity in one of its roles.
struct Watch {
  InstanceId instance;
  int role = kNone;
  int other = kNone;  ///< in its other role, if it has two
  /// Poses do not wake it before its entities have got so far, all their ways added; below 0 they
  /// do.
  float rests_until_m = -1;
};

/// What the truth of an instance is where it is not known yet, as far as that has been seen.
enum class Beyond : std::uint8_t {
  kAsAsked,    ///< those who follow others are asked how far they are known
  kAsItWas,    ///< it goes on: nothing begins or ends
  kAsUnknown,  ///< nobody is asked
};

class RuleInstances {
 public:
  /// `known_of`: how far an instance is known that follows others.
  RuleInstances(const Program& program, const EntityTable& entity_table,
                std::function<FrameNumber(InstanceId)> known_of);

  /// Binds the rules that have no guard.
  void BindUnguarded();
  /// Makes the instance, at rest, if it is not there. kNone if an entity's class does not fit, or
  /// there are TooMany().
  InstanceId Ensure(RuleId rule, const Binding& entities) {
    const InstanceKey key = Canonical(rule, entities);
    const InstanceId found = Find(key);
    return found != kNone ? found : Make(key);
  }
  /// Likewise, for all entities that can play the free roles; appends the instances to `made`.
  void EnsureAll(RuleId rule, Binding entities, std::vector<InstanceId>& made);
  /// Makes the instances that this one guards and appends them to `made`, those that were there
  /// already, too.
  void MakeDependents(InstanceId instance, std::vector<InstanceId>& made);
  /// Frees an instance at rest that nothing but kAny instances watches. Appends the instances that
  /// it leaves without a watcher.
  void Free(InstanceId instance, std::vector<InstanceId>& orphans);
  bool TooMany() const { return too_many_ != kNone; }
  /// Which rule needs them, and how many can play each of its roles.
  std::string WhyTooMany() const;

  RuleInstance& operator[](InstanceId instance) { return instances_[instance]; }
  const RuleInstance& operator[](InstanceId instance) const { return instances_[instance]; }
  /// See Watch::rests_until_m. Rounded down: it is woken a little early.
  void RestUntil_m(RuleInstance& instance, double ways_m) {
    SetRest(instance, std::nextafter(static_cast<float>(ways_m), kNoRest_m));
    instance.rests_apart = true;
  }
  void RestNoMore(RuleInstance& instance) {
    if (!instance.rests_apart) return;
    SetRest(instance, kNoRest_m);
    instance.rests_apart = false;
  }
  /// Numbers of instances are below this, free ones included.
  InstanceId end_id() const { return instances_.end_id(); }
  int in_use() const { return end_id().number() - free_count_; }

  /// The instance that reference `slot` of `instance` means, made if need be; from now on its
  /// changes wake this one.
  InstanceId Resolve(RuleInstance& instance, int slot) {
    const InstanceId referred = instance.references[static_cast<std::size_t>(slot)];
    return referred != kNone ? referred : MakeReferred(instance, slot);
  }
  /// Likewise, kNone if it is not there.
  InstanceId Find(const RuleInstance& instance, int slot) const {
    return Find(Referred(instance, slot));
  }
  InstanceId Find(RuleId rule, const Binding& entities) const {
    return Find(Canonical(rule, entities));
  }
  /// Whether the entities of a reference fit.
  bool CanRefer(const RuleInstance& instance, int slot) const {
    const InstanceKey key = Referred(instance, slot);
    return Fits(key.rule, key.entities);
  }
  InstanceId FindTouch(int a, int b) const { return touches_.Find(PairKey(a, b)); }
  /// Prefetches an instance that is about to be used.
  void Fetch(InstanceId instance) const {
    const char* at = reinterpret_cast<const char*>(&instances_[instance]);
    for (int line = 0; line < 3; ++line) __builtin_prefetch(at + 64 * line);
  }

  /// Likewise, an entity's watchers, in two steps.
  void FetchWatchers(int entity) const { __builtin_prefetch(&pose_watchers_[entity]); }
  void FetchWatching(int entity) const {
    for (const Watch& watch : pose_watchers_[entity]) Fetch(watch.instance);
  }

  /// The instances that look at an entity, and those that look at nothing but its grip.
  const std::vector<Watch>& PoseWatchers(int entity) const { return pose_watchers_[entity]; }
  const std::vector<Watch>& GripWatchers(int entity) const { return grip_watchers_[entity]; }
  /// It is not open, and something that must be true for it to begin, or to lead on, is false, and
  /// known to be, or the other way round: that one's change wakes it, if nothing else does.
  bool NeedsOneThatRests(const RuleInstance& instance) const {
    if (instance.open) return false;
    for (const Need& need : needs_[instance.rule]) {
      const InstanceId index = instance.references[static_cast<std::size_t>(need.slot)];
      if (index == kNone || instances_[index].awake) continue;
      const RuleInstance& needed = instances_[index];
      if (need.truth ? !needed.open : needed.open && needed.certain && !needed.in_gap) return true;
    }
    return false;
  }
  /// The instance's guard is false, and known to be.
  bool GuardRests(const RuleInstance& instance) const;
  /// The guard never was true, nor may have been: it is bound, and woken, when that changes first.
  bool LacksItsGuard(const RuleInstance& instance) const {
    const Rule& rule = program_.rules[instance.rule];
    return !instance.open && rule.guard != kNone && rule.form() != Form::kAny &&
           rule.form() != Form::kCompose &&
           instance.references[static_cast<std::size_t>(rule.guard)] == kNone;
  }

  /// The truth of the instance is final before this frame.
  FrameNumber KnownOf(const RuleInstance& instance) const {
    return instance.follows ? known_of_(instance.index) : instance.known;
  }
  bool IsKnownAt(const RuleInstance& instance, FrameNumber frame) const {
    return frame < instance.known || (instance.follows && frame < KnownOf(instance));
  }
  bool IsKnownBeyond(const RuleInstance& instance, FrameNumber frame) const {
    return beyond_ == Beyond::kAsAsked && instance.follows && frame < KnownOf(instance);
  }
  Kleene TruthAt(InstanceId index, FrameNumber frame) const {
    if (index == kNone) return Kleene::kFalse;
    const RuleInstance& instance = instances_[index];
    if (frame >= instance.known) {
      if (beyond_ == Beyond::kAsItWas) return Known(instance.open && instance.certain);
      if (!IsKnownBeyond(instance, frame)) return Kleene::kUnknown;
    }
    if (instance.open && instance.certain && frame >= instance.begin.frame) return Kleene::kTrue;
    return AnyPast(instance, [frame](const Span& past) {
      return frame >= past.begin.frame && frame < past.end.frame;
    });
  }
  /// Of an instance with AnyRule::one that holds at this frame: whose turn it is.
  int OwnerAt(InstanceId index, FrameNumber frame) const {
    const RuleInstance& instance = instances_[index];
    if (instance.open && frame >= instance.begin.frame) return instance.As<AnyState>().owner;
    for (std::size_t i = instance.past.size(); i-- > 0;) {
      const Span& past = instance.past[i];
      if (frame >= past.begin.frame && frame < past.end.frame) return past.owner;
    }
    return kNoEntity;
  }
  Kleene BeginsAt(InstanceId index, FrameNumber frame) const {
    if (index == kNone) return Kleene::kFalse;
    const RuleInstance& instance = instances_[index];
    if (frame >= instance.known) {
      if (beyond_ == Beyond::kAsItWas) return Kleene::kFalse;
      if (!IsKnownBeyond(instance, frame)) return Kleene::kUnknown;
    }
    if (instance.open && instance.certain && frame == instance.begin.frame) return Kleene::kTrue;
    return AnyPast(instance, [frame](const Span& past) { return past.begin.frame == frame; });
  }
  Kleene EndsAt(InstanceId index, FrameNumber frame) const {
    if (index == kNone) return Kleene::kFalse;
    const RuleInstance& instance = instances_[index];
    if (frame >= instance.known) {
      if (beyond_ == Beyond::kAsItWas) return Kleene::kFalse;
      if (!IsKnownBeyond(instance, frame)) return Kleene::kUnknown;
    }
    return AnyPast(instance, [frame](const Span& past) { return past.end.frame == frame; });
  }

  void Take(Beyond beyond) { beyond_ = beyond; }

  bool IsA(int entity, const std::string& class_name) const;

 private:
  static constexpr float kNoRest_m = -1;
  InstanceKey Canonical(RuleId rule, const Binding& entities) const {
    const bool swap = symmetric_[rule] != 0 && name_rank_[entities[1]] < name_rank_[entities[0]];
    return {rule, swap ? Binding{entities[1], entities[0], entities[2], entities[3]} : entities};
  }
  InstanceId Make(const InstanceKey& key);
  RuleInstance& UnusedFor(Form form);
  InstanceId Find(const InstanceKey& key) const {
    return key.rule == kTouchingRule ? FindTouch(key.entities[0], key.entities[1])
                                     : index_.Find(key);
  }
  void Refer(RuleInstance& instance, int slot, InstanceId target);
  InstanceId MakeReferred(RuleInstance& instance, int slot);
  InstanceKey Referred(const RuleInstance& instance, int slot) const;
  bool Fits(RuleId rule, const Binding& entities) const;
  struct Guard {
    InstanceId instance = kNone;
    int slot = kNone;  // the reference that means it
  };
  void BindRest(RuleId rule, Binding& entities, std::size_t role, Guard guard,
                std::vector<InstanceId>* made);
  void LinkToGuard(InstanceId instance, Guard guard);
  void WatchEntities(RuleInstance& instance);
  void UnwatchEntities(const RuleInstance& instance);
  void SetRest(const RuleInstance& instance, float rests_until_m);
  template <typename Which>
  static Kleene AnyPast(const RuleInstance& instance, const Which& which) {
    for (std::size_t i = instance.past.size(); i-- > 0;) {
      if (which(instance.past[i])) return Kleene::kTrue;
    }
    return Kleene::kFalse;
  }
  void Unlink(InstanceId instance, InstanceId watcher, std::vector<InstanceId>& orphans);
  const Program& program_;
  const EntityTable& entity_table_;
  std::function<FrameNumber(InstanceId)> known_of_;
  StableBlocks<InstanceId, RuleInstance>
      instances_;  // an instance stays where it is when others are made
  std::array<std::vector<InstanceId>, std::variant_size_v<FormState>> free_;  // by kind of state
  int free_count_ = 0;
  InstanceIndex<InstanceKey> index_;
  InstanceIndex<PairKey> touches_;  // the instances of kTouchingRule
  IdVector<RuleId, std::vector<std::pair<RuleId, int>>>
      guarded_;  // the rules that a rule guards, and by which of their references
  struct Need {
    int slot = kNone;
    bool truth = true;
  };
  static void CollectNeeds(const Program& program, NodeId index, bool truth,
                           std::vector<Need>& needs);
  IdVector<RuleId, std::vector<Need>>
      needs_;  // what references must be for it to begin, or to lead on
  IdVector<RuleId, std::vector<std::vector<bool>>> fits_;  // by role and entity
  std::vector<std::vector<Watch>> pose_watchers_;          // by entity
  std::vector<std::vector<Watch>> grip_watchers_;
  std::vector<int> name_rank_;  // alphabetical order of entities
  IdVector<RuleId, char> symmetric_;
  Beyond beyond_ = Beyond::kAsAsked;
  RuleId too_many_;  // the rule that would have had more than can be
};

/// Where the truth of an instance changes, after this frame.
inline FrameNumber NextEdge(const RuleInstance& instance, FrameNumber after) {
  FrameNumber next = kNever;
  const auto consider = [&](FrameNumber frame) {
    if (frame > after) next = std::min(next, frame);
  };
  if (instance.open) consider(instance.begin.frame);
  for (std::size_t i = instance.past.size(); i-- > 0 && instance.past[i].end.frame > after;) {
    consider(instance.past[i].begin.frame);
    consider(instance.past[i].end.frame);
  }
  if (const auto* touching = instance.If<TouchingState>()) {
    consider(FirstAfter(touching->crossings, after));
    consider(FirstAfter(touching->touches, after));
  }
  return next;
}

/// Visits each instance that it has asked about.
template <typename Visit>
void ForEachReference(const RuleInstance& instance, const Visit& visit) {
  if (const auto* any = instance.If<AnyState>()) {
    for (const InstanceId member : any->members) visit(member);
  }
  for (const InstanceId reference : instance.references) {
    if (reference != kNone) visit(reference);
  }
}

// The times of a rule in ticks of the episode. Tested by tests/grammar/engine/forms_test.cc

struct RuleTicks {
  Tick bridging = 0;
  Tick lasting = 0;
  Tick lasting_most = -1;  ///< negative: as long as it likes
  Tick idle = 0;
  Tick over = 0;   ///< half of Approach::over_s
  Tick still = 0;  ///< half of Approach::still_s
  Tick back = 0;
  Tick within = -1;                ///< the deadline; negative: there is none
  Tick nearest = 0;                ///< AnyRule::within_s
  Tick in_time = 0;                ///< what comes at most so late is still in time
  std::vector<Relations> clauses;  ///< of a composition

  bool IsTooLong(Tick ticks) const { return lasting_most >= 0 && ticks > lasting_most; }
};

RuleTicks TicksOf(const Rule& rule, const History& history);

/// How far before the newest frame the rule may ask for values, apart from windows around frames.
double LooksBack_s(const Rule& rule);

}  // namespace prehend::grammar
