// SPDX-License-Identifier: Apache-2.0
// The online engine behind Monitor.
//
// Needs: the same intervals as the meaning table in docs/grammar-language.md gives for the whole
// episode, each as soon as no future can change it. Algorithm: rules are stepped in the order of
// Program::schedule, each awake instance frame by frame, but only up to the first frame where its
// condition is not known yet; RuleInstance::known says up to where an instance's own truth is
// final. So an instance that waits (a gap that may be bridged, an approach that may end in a
// landing) delays only the instances that ask about just those frames. Those wait, and are stepped
// again when it tells more; the frames in between are stepped only where something changed
// (grammar/engine/engine.cc). An instance rests as soon as its newest frame is decided and
// nothing but a change can decide otherwise: what it asks about wakes it. What time alone changes
// is either an alarm (the end of a gap, the shortest duration) or, where a value moves by itself
// (RuleInstance::by_itself), keeps the instance awake. So a frame costs as much as changes in
// it. Data structures: grammar/state/instances.h (state per binding), grammar/state/history.h
// (the frames that some instance may still ask for). Tested by tests/grammar/monitor_test.cc and
// the corpus in tests/grammar/corpus/
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grammar/base/candidate_log.h"
#include "grammar/base/event.h"
#include "grammar/base/frame.h"
#include "grammar/engine/alarms.h"
#include "grammar/engine/combinations.h"
#include "grammar/state/history.h"
#include "grammar/state/idle_queue.h"
#include "grammar/state/instances.h"
#include "grammar/state/remembered_past.h"
#include "grammar/values/backward_walk.h"
#include "grammar/values/evaluate.h"

namespace prehend::grammar {

class Engine final {
 public:
  Engine(std::shared_ptr<const Program> program, EntityTable entity_table);
  Engine(const Engine&) = delete;  // the members refer to each other
  Engine& operator=(const Engine&) = delete;

  const std::string& error() const { return error_; }
  void Advance(const Frame& frame, std::vector<Event>& out);
  void AdvanceBy(const FrameChanges& changes, std::vector<Event>& out);
  void Finish(Tick end, std::vector<Event>& out);
  int instances_in_use() const { return instances_.in_use(); }

  // For grammar/replay_monitor.h. From now on nothing is forgotten, and what becomes of each run is
  // noted. Before the first frame.
  void Remember(CandidateLog& outcomes) {
    log_ = &outcomes;
    recalls_touches_ = keeps_touches_ = true;
  }
  const Program& program() const { return *program_; }
  const EntityTable& entity_table() const { return entity_table_; }
  const History& history() const { return history_; }
  RuleInstances& instances() { return instances_; }
  const Evaluator& evaluator() const { return evaluator_; }

 private:
  // What a frame says (grammar/engine/engine_frames.cc).
  void LookUp(std::span<const Touch> touches);
  void FetchLooks(std::span<const EntityChange> changes) const;
  template <typename AnyFrame>
  bool BeginFrame(const AnyFrame& frame, std::vector<Event>& out);
  bool BringsNothing(const FrameChanges& changes) const {
    return awake_count_ == 0 && ahead_count_ == 0 && changes.entities.empty() &&
           changes.hands.empty() && changes.touches.empty() && changes.contact_ends.empty() &&
           !alarms_.AnyDue(changes.tick);
  }
  void PassBy(Tick tick);
  void EndFrame();
  void Forget();
  void SortNewEvents();
  void Look(int entity, const EntitySample& look);
  void Look(const HandSample& hand);
  void ApplyContacts(std::span<const Touch> touches);
  void BeginTouch(RuleInstance& touching);
  void Part(InstanceId touching);
  void CloseTouch(RuleInstance& touching, Moment end);
  void Keep(RuleInstance& touching, const Touch& touch, bool swapped);
  void NotifyOfThresholds(const RuleInstance& touch, ThresholdSet changed);
  void Measure(RuleInstance& instance, const Watcher& as, const RuleInstance& touch) {
    if (IsMeasured(*as.measured, as.hand, touch, as.swapped) != instance.open) BeginOrEnd(instance);
  }
  void BeginOrEnd(RuleInstance& instance);

  // Waking and resting.
  void Wake(InstanceId instance);
  void WakeWatchers(int entity, const std::vector<Watch>& watchers, bool gets_on);
  bool MayWake(const RuleInstance& instance) const;
  NodeId NearnessOf(const Rule& rule) const;
  double Ways_m(const RuleInstance& instance) const;
  bool RestsFarApart(RuleInstance& instance);
  bool CanMeasure(const RuleInstance& instance) const;
  bool IsMeasured(const RuleInstance& instance) const;
  /// Likewise, of a grip, if there is one, and a touch, which names the two the other way round
  /// than the rule if `swapped`.
  bool IsMeasured(const MeasuredPart& part, int hand, const RuleInstance& touch,
                  bool swapped) const {
    if (hand != kNoEntity && !part.grip.Fit(grips_[hand])) return false;
    if (!touch.open) return !part.must_touch && part.press[0].Fit(thresholds_.OfNoTouch());
    return part.press[swapped ? 1 : 0].Fit(touch.As<TouchingState>().crossed_thresholds);
  }
  bool SaysTheSame(const RuleInstance& instance) const;
  /// A rule that begins with a moment begins at no other time. The moment may become known later in
  /// this frame; then this is asked again.
  bool MayBegin(const RuleInstance& instance) const {
    return instance.moment >= history_.now() && MomentMayCome(instance);
  }
  bool MomentMayCome(const RuleInstance& instance) const;
  void NotifyWatchers(RuleInstance& instance);
  void NotifyIfChanged(RuleInstance& instance);
  bool MayRest(const RuleInstance& instance);
  void Rest(RuleInstance& instance);
  /// It was not stepped, as nothing can have begun; but from now on it may be of no more use.
  void RestOn(RuleInstance& instance) {
    instance.resting_since = history_.now();
    idle_.Queue(instance);
  }
  void StepRule(RuleId rule);
  bool StepOrRest(RuleInstance& instance);
  /// The oldest frame that it may still ask for.
  FrameNumber OldestNeeded(const RuleInstance& instance) const {
    // When it is known that nothing bridges a gap, values at the frame of the gap may be asked for.
    if (instance.in_gap) return instance.gap.frame;
    return instance.open && RuleOf(instance).TriesEachBegin() ? instance.begin.frame + 1
                                                              : instance.next;
  }

  // Waiting for others (grammar/engine/engine.cc).
  bool AwaitOthers(RuleInstance& instance);
  void Tell(RuleInstance& instance);
  void StopWaiting(RuleInstance& instance);
  void HoldLooks(const RuleInstance& instance);
  FrameNumber HeldBy(const RuleInstance& instance) const {
    return instance.follows ? following_[instance.index].held : OldestNeeded(instance);
  }
  bool IsHeld(const RememberedPast::Held& held) const {
    const RuleInstance& instance = instances_[held.instance];
    return instance.awake && HeldBy(instance) == held.frame;
  }
  void Hold(const RuleInstance& instance);
  FrameNumber HeldFrom(const RememberedPast::Held& held);
  FrameNumber FirstLook(int entity) {
    return past_.FirstLook(entity, history_, [this](const auto& held) { return IsHeld(held); });
  }
  bool IsAtTheKnown(const RuleInstance& instance) const;
  void SkipUnchanged(RuleInstance& instance) const;
  FrameNumber NextChange(RuleInstance& instance, FrameNumber after) const;

  // Following others (grammar/engine/engine_following.cc).
  struct Follows {
    bool closed = false;          // while it is not open
    bool open = false;            // while it is
    bool closed_looks = false;    // while it is not open it looks at entities, too
    bool open_looks = false;      // likewise, while it is
    bool only_others = false;     // it never looks at entities
    bool by_since = false;        // `until .. since`: only while others say that nothing leads on
    std::vector<int> slots = {};  // `until`: the references that it asks for
    std::size_t of_until = 0;     // so many of them, not for what leads on
  };
  struct Following {               // of an instance that does so
    FrameNumber held = 0;          // the first frame that is kept for it
    FrameNumber resumes = 0;       // the first one that it steps when it follows no more
    FrameNumber assumed = kNever;  // before this one nothing happens if the others stay as they are
    bool asks_only_others = false;
    bool is_ruled_out = false;  // by others alone, whatever the entities do
    bool is_listed = false;     // among those that look ahead
    FrameNumber known_in = -1;  // in this frame it was seen how far it is known
    int cost = 0;               // so many instances may have to be asked for that
  };
  struct Bound {
    bool holds = false;
    FrameNumber known = 0;
  };
  struct Edges {  // the last ones of its truth
    FrameNumber begin = kNever, last_begin = kNever, last_end = kNever;
    bool operator==(const Edges&) const = default;
  };
  static Edges EdgesOf(const RuleInstance& instance) {
    Edges edges;
    if (instance.open && instance.certain) edges.begin = instance.begin.frame;
    if (instance.past.empty()) return edges;
    edges.last_begin = instance.past.back().begin.frame;
    edges.last_end = instance.past.back().end.frame;
    return edges;
  }
  template <typename Visit>
  void ForEachFollowed(const RuleInstance& instance, std::size_t most, const Visit& visit) const;
  template <typename Visit>
  void ForEachFollowed(const RuleInstance& instance, const Visit& visit) const {
    ForEachFollowed(instance, follows_[instance.rule].slots.size(), visit);
  }
  static Bound Both(Bound a, Bound b);
  Bound BoundOf(InstanceId index) const;
  Bound BoundOf(NodeId node, RuleInstance& instance);
  FrameNumber SettledByOthers(NodeId node, RuleInstance& instance, bool holds);
  FrameNumber RuledOutUntil(RuleInstance& instance);
  bool IsSettled(Bound one) const { return !one.holds && one.known > history_.now(); }
  FrameNumber StaysUntil(RuleInstance& instance);
  FrameNumber CountStaysUntil(const RuleInstance& instance) const;
  void CatchUp(RuleInstance& instance, FrameNumber end);
  bool IsMoment(NodeId node) const;
  bool AsksOnlyOthers(NodeId node) const;
  bool AsksForTheNearest(const Rule& rule) const;
  bool IsUnknownUntilTheEnd(NodeId node) const;
  Follows WhenItFollows(const Rule& rule) const;
  NodeId SkipsBy(const Rule& rule) const;
  bool SkipAhead(RuleInstance& instance);
  bool MayFollow(RuleInstance& instance, FrameNumber resumes);
  bool Follow(RuleInstance& instance);
  FrameNumber KnownOf(InstanceId follower);
  void TellFollowers(RuleInstance& instance);
  void AskWhetherFollowersRest(RuleInstance& instance);
  void LetFollowersRest(RuleId rule);
  void StopFollowers(const RuleInstance& resting);
  void LookAhead(RuleId rule);
  Kleene StaysAt(RuleInstance& instance, FrameNumber frame);

  // The forms; each looks at one frame and says whether it could decide it.
  void StepInstance(RuleInstance& instance);
  bool StepFrame(RuleInstance& instance);
  bool LooksTheSame(RuleInstance& instance);
  bool StepWhile(RuleInstance& instance, FrameNumber frame);
  Span EndOfParts(const RuleInstance& instance, Moment now) const;
  bool StepRepeat(RuleInstance& instance, FrameNumber frame);
  bool StepAny(RuleInstance& instance, FrameNumber frame);
  bool StepOwners(RuleInstance& instance, FrameNumber frame);
  Kleene GoesOn(const RuleInstance& owners, FrameNumber frame) const;
  bool ChooseOwner(RuleInstance& owners, FrameNumber frame);
  bool StepRun(RuleInstance& instance, FrameNumber frame, Kleene truth);
  bool StepRest(RuleInstance& instance, FrameNumber frame);
  bool StepFromTo(RuleInstance& instance, FrameNumber frame);
  bool GiveUp(RuleInstance& instance);
  bool MeetDeadline(RuleInstance& instance, Moment now);
  bool StepUntil(RuleInstance& instance, FrameNumber frame);

  bool EndIsQuiet(RuleInstance& instance, FrameNumber frame);
  bool LeadsHere(RuleInstance& instance, FrameNumber frame);
  WalkBack BeginOfWalk(RuleInstance& instance, FrameNumber end);

  // From a run to an event.
  [[nodiscard]] bool Open(RuleInstance& instance, FrameNumber frame);
  void Begin(RuleInstance& instance, FrameNumber frame);
  int StyleAt(const RuleInstance& instance, FrameNumber frame) const {
    return RuleOf(instance).style_role == kNone
               ? kNoEntity
               : StyleOfHand(instance.entities[RuleOf(instance).style_role], frame);
  }
  int StyleOfHand(int hand, FrameNumber frame) const;
  bool Close(RuleInstance& instance, Moment end, bool open_end = false);
  bool Conclude(RuleInstance& instance, const Span& span);
  void ResolvePending(RuleInstance& instance);
  void Emit(RuleInstance& instance, const Pending& finished);
  void Keep(RuleInstance& instance, const Span& span);
  Tick DecidedAt(const RuleInstance& instance, const Span& span) const {
    const auto* from_to = RuleOf(instance).If<FromToRule>();
    return from_to != nullptr && from_to->absence ? DeadlineOf(span) : decided_;
  }
  Tick DeadlineOf(const Span& span) const;
  void UpdateKnown(RuleInstance& instance);
  bool RunIsCertain(const RuleInstance& instance) const;
  bool MayComeToNothing(const RuleInstance& instance) const;
  Tick AtLeastLasts(const RuleInstance& instance) const;
  void NoteUndecidedEnds();
  void FinishInstance(RuleInstance& instance, Moment end);
  void Note(const RuleInstance& instance, const Fate& fate, const Span& span,
            const WalkBack& walk = {}) {
    if (log_ != nullptr)
      log_->push_back({fate, instance.index, span, DecidedAt(instance, span), walk});
  }

  // Compositions get each finished interval of their parts.
  void NotifyCompositions(const RuleInstance& part, const Span& span);
  FrameNumber Settled(const RuleInstance& instance) const;
  FrameNumber PartsSettled(const RuleInstance& composition) const;
  FrameNumber SettledOfNone(const Reference& reference, const Binding& whole) const;
  bool LacksAPart(const RuleInstance& composition) const;
  static std::string WhyTooMany(const Rule& composition);
  static Moment Earlier(Moment a, Moment b) { return b.tick < a.tick ? b : a; }
  Moment NextFrame() const { return {history_.now() + 1, history_.At(history_.now()).tick + 1}; }
  Moment BeginsFrom(const RuleInstance& instance) const;
  Moment BeginsFrom(const Reference& reference, const Binding& whole) const;
  Moment PartsBeginFrom(RuleId rule, const Binding& entities) const;
  Moment BackFrom(RuleId rule, Tick end) const;
  void NoteWhatIsToCome(const RuleInstance& composition, FrameNumber settled);
  void StepCompose(RuleInstance& instance);
  std::optional<Span> NextComposed(RuleInstance& instance, FrameNumber settled);
  std::optional<Span> NextRepeated(RuleInstance& instance, FrameNumber settled);
  void ForgetHopeless(RuleInstance& instance, FrameNumber settled);

  const Rule& RuleOf(const RuleInstance& instance) const { return program_->rules[instance.rule]; }
  const RuleTicks& TicksOf(const RuleInstance& instance) const {
    return rule_ticks_[instance.rule];
  }

  std::shared_ptr<const Program> program_;
  EntityTable entity_table_;
  int entity_count_ = 0;
  History history_;
  RuleInstances instances_;
  Evaluator evaluator_;
  WalkMemory walk_memory_;
  IdVector<RuleId, RuleTicks> rule_ticks_;
  IdVector<RuleId, NodeId>
      nearness_;  // a condition that entities far apart do not fulfil, or kNone
  IdVector<RuleId, NodeId> skips_by_;  // see SkipAhead()
  IdVector<RuleId, Follows> follows_;
  IdVector<RuleId, char> begins_by_others_;    // `from ..` that asks for no entities
  IdVector<RuleId, char> leads_always_;        // `since ..` that is not known before the end
  IdVector<RuleId, int> turns_;                // when a rule is stepped in a frame
  IdVector<InstanceId, Following> following_;  // up to the last one that ever did
  bool some_may_rest_ = false;
  bool seen_only_ = false;      // nobody is asked how far it is known
  bool asks_followers_ = true;  // how far they are known; else that is guessed, at most too far
  IdVector<RuleId, std::vector<InstanceId>> may_rest_;  // followers to be looked at in that turn
  IdVector<RuleId, std::vector<InstanceId>> ahead_;     // followers that look at entities, too
  std::size_t ahead_count_ = 0;                         // of all rules
  int turn_ = -1;  // twice that of the rule that is stepped now; one more: of its followers
  Thresholds thresholds_;
  bool recalls_touches_ = false;     // which thresholds they had crossed
  bool keeps_touches_ = false;       // and all that they measured
  bool looks_at_all_ = false;        // a rule asks for entities that play none of its roles
  std::vector<ThresholdSet> grips_;  // by entity: what its grip has crossed
  IdVector<RuleId, std::vector<InstanceId>> awake_;  // those to be stepped in this frame
  std::size_t awake_count_ = 0;       // of all rules; those that wait are not among them
  std::vector<InstanceId> touching_;  // the pairs that touch now
  std::vector<InstanceId> contacts_;  // the instances of the touches of this frame, kNone: none yet
  Alarms alarms_;
  IdleQueue idle_;
  RememberedPast past_;
  Combinations combinations_;
  std::vector<Combinations::ToCome> to_come_;          // of the parts of a composition
  std::vector<std::pair<std::size_t, Span*>> newest_;  // likewise, with the numbers of the parts
  std::vector<InstanceId> scratch_;                    // instances; kept for its memory
  std::vector<InstanceId> notified_;                   // likewise
  bool finishing_ = false;
  Tick decided_ = 0;
  std::vector<Event>* out_ = nullptr;  // only during Advance and Finish
  std::size_t first_new_ = 0;          // among them, of this call
  CandidateLog* log_ = nullptr;        // null unless they are to be remembered
  struct UndecidedEnd {
    InstanceId instance;
    FrameNumber frame = 0;
  };
  std::vector<UndecidedEnd> undecided_ends_;  // only if they are
  std::string error_;
};

// Why a frame cannot be watched; empty when it can. Bodies of messages, no places: the caller knows
// what the frame is from. Tested by tests/grammar/monitor_test.cc

/// Far enough from the limits of a Tick that times can be added and subtracted.
inline constexpr Tick kLatestTick = 1'000'000'000'000'000;

std::string_view WhyNoTick(Tick tick, const History& history);
/// `entities`: how many there are in the episode.
std::string_view WhyNotWatchable(const Frame& frame, int entities);
std::string_view WhyNotWatchable(const FrameChanges& changes, int entities);

}  // namespace prehend::grammar
