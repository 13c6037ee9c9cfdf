// SPDX-License-Identifier: Apache-2.0
// The online engine behind Monitor.
//
// Needs: the same intervals as the meaning table in docs/grammar-language.md gives for the whole
// episode, each as soon as no future can change it. Algorithm: rules are stepped in the order of
// Program::schedule, each awake lane frame by frame, but only up to the first frame where its
// condition is not known yet; Lane::known says up to where a lane's own truth is final. So a lane
// that waits (a gap that may be bridged, an approach that may end in a landing) delays only the
// lanes that ask about just those frames. A lane rests as soon as its newest frame is decided and
// nothing but a change can decide otherwise: what it asks about wakes it. What time alone changes
// is either an alarm (the end of a gap, the shortest duration) or, where a value moves by itself
// (Evaluator::restless), keeps the lane awake. So a frame costs as much as changes in it. Data
// structures: grammar/lanes.h (state per binding), grammar/history.h (the frames that some lane may
// still ask for). Tested by tests/grammar/monitor_test.cc and the corpus in tests/grammar/corpus/
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/evaluate.h"
#include "grammar/event.h"
#include "grammar/fate.h"
#include "grammar/history.h"
#include "grammar/lanes.h"

namespace prehend::grammar {

class Engine {
 public:
  Engine(std::shared_ptr<const Program> program, Cast cast);
  Engine(const Engine&) = delete;  // the members refer to each other
  Engine& operator=(const Engine&) = delete;

  const std::string& error() const { return error_; }
  void Advance(const Frame& frame, std::vector<Event>& out);
  void AdvanceBy(const FrameChanges& changes, std::vector<Event>& out);
  void Finish(Tick end, std::vector<Event>& out);
  int lanes_in_use() const { return lanes_.in_use(); }

  // For grammar/hindsight.h. From now on nothing is forgotten, and what becomes of each run is
  // noted. Before the first frame.
  void Remember(Fates& fates) {
    fates_ = &fates;
    recalls_touches_ = keeps_touches_ = true;
  }
  const Program& program() const { return *program_; }
  const Cast& cast() const { return cast_; }
  const History& history() const { return history_; }
  Lanes& lanes() { return lanes_; }
  const Evaluator& evaluator() const { return evaluator_; }

 private:
  struct RuleTicks {
    Tick bridging = 0;
    Tick lasting = 0;
    Tick idle = 0;
    Tick back = 0;
    Tick within = -1;  ///< the deadline
    Tick in_time = 0;  ///< what comes so late is still in time
  };
  /// A lane to look at when this tick comes, and perhaps for nothing.
  struct Alarm {
    Tick tick = 0;
    int lane = kNone;
  };
  struct Retiree {
    FrameNumber since = 0;
    int lane = kNone;
  };

  // What a frame says (grammar/engine_frames.cc).
  std::string_view WhyNoTick(Tick tick) const;
  std::string_view WhyNotWatchable(const Frame& frame);
  std::string_view WhyNotWatchable(const FrameChanges& changes);
  std::string_view WhyNoTouches(std::span<const Touch> touches);
  bool IsEntity(int entity) const { return entity >= 0 && entity < entity_count_; }
  template <typename AnyFrame>
  bool BeginFrame(const AnyFrame& frame, std::vector<Event>& out);
  void EndFrame();
  void SortNewEvents();
  void Look(int entity, const EntityLook& look);
  void Look(const HandLook& hand);
  void Press(std::span<const Touch> touches);
  void BeginTouch(Lane& touching);
  void Part(int touching);
  void CloseTouch(Lane& touching, Moment end);
  void Keep(Lane& touching, const Touch& touch, bool swapped);
  void TellPress(const Lane& touch, ThresholdSet crossed);
  void Measure(Lane& lane, const Watcher& as, const Lane& touch) {
    if (IsMeasured(*as.instant, as.hand, touch, as.turned) != lane.open) BeginOrEnd(lane);
  }
  void BeginOrEnd(Lane& lane);

  // Waking and resting.
  void Wake(int lane);
  void WakeWatchers(const std::vector<Watch>& watchers);
  bool MayStir(const Lane& lane) const;
  bool CanMeasure(const Lane& lane) const;
  bool IsMeasured(const Lane& lane) const;
  /// Likewise, of a grip, if there is one, and a touch, which names the two the other way round
  /// than the rule if `turned`.
  bool IsMeasured(const MeasuredPart& part, int hand, const Lane& touch, bool turned) const {
    if (hand != kNobody && !part.grip.Fit(grips_[hand])) return false;
    if (!touch.open) return !part.must_touch && part.press[0].Fit(thresholds_.OfNoTouch());
    return part.press[turned ? 1 : 0].Fit(touch.beyond);
  }
  bool SaysTheSame(const Lane& lane) const;
  /// What begins with a moment does not begin at others. That moment may be told of later in this
  /// frame; whoever tells of it asks again.
  bool MayBegin(const Lane& lane) const {
    return lane.moment >= history_.now() && MomentMayCome(lane);
  }
  bool MomentMayCome(const Lane& lane) const;
  void Tell(Lane& lane);
  void TellIfChanged(Lane& lane);
  void WakeAt(Tick tick, int lane);
  void RingAlarms();
  bool MayRest(const Lane& lane);
  void Rest(Lane& lane);
  /// Nothing of it has been looked at, as nothing can have begun, but now it may be of no more use.
  void RestOn(Lane& lane) {
    lane.resting_since = history_.now();
    Retire(lane);
  }
  void Retire(Lane& lane) {
    if (!lane.retiring) retirees_.PushBack() = {lane.resting_since, lane.index};
    lane.retiring = true;
  }
  void StepRule(int rule);
  void ForgetThePast();
  void FreeLanes();
  void FreeOrRetire(std::vector<int>& candidates);
  bool CanBeFreed(const Lane& lane) const;
  bool MayOverlap(const Lane& lane) const;

  // The forms; each looks at one frame and says whether it could decide it.
  void StepLane(Lane& lane);
  bool StepFrame(Lane& lane);
  bool LooksTheSame(Lane& lane);
  bool StepWhile(Lane& lane, FrameNumber frame);
  bool StepAny(Lane& lane, FrameNumber frame);
  bool StepRun(Lane& lane, FrameNumber frame, Kleene truth);
  bool StepRest(Lane& lane, FrameNumber frame);
  bool StepFromTo(Lane& lane, FrameNumber frame);
  bool MeetDeadline(Lane& lane, Moment now);
  bool StepUntil(Lane& lane, FrameNumber frame);

  WalkBack ApproachBegin(Lane& lane, FrameNumber end) const;
  std::optional<double> ApproachSpeed(Lane& lane, FrameNumber frame, FrameNumber end,
                                      double way) const;

  // From a run to an event.
  [[nodiscard]] bool Open(Lane& lane, FrameNumber frame);
  void Begin(Lane& lane, FrameNumber frame);
  int StyleAt(const Lane& lane, FrameNumber frame) const {
    return RuleOf(lane).style_role == kNone
               ? kNobody
               : StyleOfHand(lane.entities[RuleOf(lane).style_role], frame);
  }
  int StyleOfHand(int hand, FrameNumber frame) const;
  bool Close(Lane& lane, Moment end, bool open_end = false);
  bool Conclude(Lane& lane, const Span& span);
  void ResolvePending(Lane& lane);
  void Emit(Lane& lane, const Pending& finished);
  void Keep(Lane& lane, const Span& span);
  Tick DecidedAt(const Lane& lane, const Span& span) const {
    return RuleOf(lane).absence ? DeadlineOf(span) : decided_;
  }
  Tick DeadlineOf(const Span& span) const;
  void UpdateKnown(Lane& lane);
  bool RunIsCertain(const Lane& lane) const;
  void FinishLane(Lane& lane, Moment end);
  void Note(const Lane& lane, Fate::Kind kind, const Span& span, FrameNumber cause = kNever,
            const WalkBack& walk = {}) {
    if (fates_ != nullptr)
      fates_->push_back({kind, lane.index, span, cause, DecidedAt(lane, span), walk});
  }

  // Compositions are told of each finished interval of their parts.
  void TellCompositions(const Lane& part, const Span& span);
  FrameNumber Settled(const Lane& lane) const;
  FrameNumber PartsSettled(const Lane& composition) const;
  void StepCompose(Lane& lane);

  const Rule& RuleOf(const Lane& lane) const { return program_->events[lane.rule]; }
  const RuleTicks& TicksOf(const Lane& lane) const { return rule_ticks_[lane.rule]; }

  std::shared_ptr<const Program> program_;
  Cast cast_;
  int entity_count_ = 0;
  History history_;
  Lanes lanes_;
  Evaluator evaluator_;
  std::vector<RuleTicks> rule_ticks_;
  Thresholds thresholds_;
  bool recalls_touches_ = false;     // which thresholds they were beyond
  bool keeps_touches_ = false;       // and all that they measured
  std::vector<ThresholdSet> grips_;  // by entity: what its grip is beyond now
  Tick longest_look_back_ = 0;
  std::vector<std::vector<int>> awake_;  // by rule
  std::vector<int> touching_;            // the pairs that touch now
  std::vector<int>
      pressed_;  // the lanes of the touches that a frame tells of, kNone: there is none yet
  std::vector<Alarm> alarms_;      // a heap, the next one first
  Ring<Retiree> retirees_;         // in the order in which they came to rest
  std::vector<int> scratch_;       // lanes; kept for its memory
  std::vector<int> told_;          // likewise
  FrameNumber oldest_needed_ = 0;  // of the awake lanes
  FrameNumber oldest_look_needed_ = 0;
  FrameNumber first_needed_ = 0;  // and what they can look back to
  FrameNumber first_look_needed_ = 0;
  bool finishing_ = false;
  Tick decided_ = 0;
  std::vector<Event>* out_ = nullptr;  // only during Advance and Finish
  std::size_t first_new_ = 0;          // among them, of this call
  Fates* fates_ = nullptr;             // null unless they are to be remembered
  std::string error_;
};

}  // namespace prehend::grammar
