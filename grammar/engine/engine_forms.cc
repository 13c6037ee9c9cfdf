// SPDX-License-Identifier: Apache-2.0
// How each form of rule looks at one frame. The meaning of the forms is the table in
// docs/grammar-language.md.
#include <algorithm>
#include <limits>
#include <map>

#include "grammar/engine/engine.h"

namespace prehend::grammar {

void Engine::StepInstance(RuleInstance& instance) {
  if (RuleOf(instance).form() == Form::kCompose) return StepCompose(instance);
  const bool skips = SkipAhead(instance);
  while (!skips && instance.next <= history_.now() && StepFrame(instance)) SkipUnchanged(instance);
  if (!instance.pending.empty()) ResolvePending(instance);
  UpdateKnown(instance);
}

// One frame, if it can be decided.
bool Engine::StepFrame(RuleInstance& instance) {
  bool decided = false;
  instance.by_itself = false;
  switch (RuleOf(instance).form()) {
    case Form::kTouching:
    case Form::kCompose:
      break;
    case Form::kWhile:
      decided = StepWhile(instance, instance.next);
      break;
    case Form::kAny:
      decided = StepAny(instance, instance.next);
      break;
    case Form::kFromTo: {
      const bool was_open = instance.open;
      decided = StepFromTo(instance, instance.next);
      // The begin of the next run was not asked for in this frame, so no change would wake it.
      if (was_open && !instance.open) instance.by_itself = true;
      break;
    }
    case Form::kUntilSince:
      decided = StepUntil(instance, instance.next);
      break;
    case Form::kRestOf:
      decided = StepRest(instance, instance.next);
      break;
  }
  if (decided) ++instance.next;
  return decided;
}

// Fast path: if nothing changed, the instance stays idle, with nothing to report and nothing to
// wait for. If something is new, the frame may have been stepped already; StepInstance() does the
// rest.
bool Engine::LooksTheSame(RuleInstance& instance) {
  const Rule& rule = RuleOf(instance);
  const FrameNumber now = history_.now();
  const auto settled = [&] {
    return instance.pending.empty() && (!instance.open || (instance.certain && !instance.in_gap));
  };
  const bool waits = rule.form() == Form::kCompose ||
                     (rule.form() == Form::kUntilSince && rule.referenced) ||
                     TicksOf(instance).within >= 0;
  if (instance.next != now || waits || !settled() ||
      (rule.referenced && instance.reported != Known(instance.open)))
    return false;
  if (rule.form() == Form::kWhile && RestsFarApart(instance)) return true;
  const bool was_open = instance.open;
  if (!StepFrame(instance) || instance.by_itself) return false;
  const auto* looks_back = instance.If<UntilSinceState>();
  const bool ended_here = looks_back != nullptr && looks_back->last_end == now;
  return instance.open == was_open && settled() &&
         (!instance.open || instance.begin.frame != now) && !ended_here;
}

bool Engine::StepWhile(RuleInstance& instance, FrameNumber frame) {
  const Rule& rule = RuleOf(instance);
  const Evaluator::View view{instance, frame};
  if (rule.measured.whole && frame == history_.now() && CanMeasure(instance)) {
    return StepRun(instance, frame, Known(IsMeasured(instance)));
  }
  const auto& [condition, until, bridging_s, at_least, counted] = rule.As<WhileRule>();
  if (at_least > 0) return StepRepeat(instance, frame);
  if (until == kNone) return StepRun(instance, frame, evaluator_.Truth(condition, view));
  // Two thresholds: what has begun goes on until the second says so, which may speak of the begin.
  const bool is_anchored = !rule.anchors.empty();
  const bool on = instance.open && !instance.in_gap;
  Kleene truth = on ? Kleene::kTrue : evaluator_.Truth(condition, view);
  if (truth == Kleene::kFalse) return StepRun(instance, frame, truth);
  const bool knows_begin =
      !is_anchored || instance.open || evaluator_.CaptureAnchors(instance, frame);
  const Evaluator::View since_begin{
      .instance = instance, .frame = frame, .begin_known = knows_begin};
  truth = And(truth, Not(evaluator_.Truth(until, since_begin)));
  // Where nothing changes any more it may begin anew, as it speaks of another begin then.
  if (is_anchored && instance.open && truth != Kleene::kTrue) instance.by_itself = true;
  return StepRun(instance, frame, truth);
}

// Where the last of the intervals ends that a series, or a rest, is made of: an absence may do so
// between the frame before and this one.
Span Engine::EndOfParts(const RuleInstance& instance, Moment now) const {
  const auto* holds = RuleOf(instance).If<WhileRule>();
  const auto* rest = RuleOf(instance).If<RestOfRule>();
  Span last{.end = now, .open_end = finishing_};
  bool has_any = false;
  const auto consider = [&](int slot) {
    const InstanceId part = instance.references[static_cast<std::size_t>(slot)];
    if (part == kNone) return;
    const RingBuffer<Span>& past = instances_[part].past;
    for (std::size_t i = past.size(); i-- > 0 && past[i].end.frame >= now.frame;) {
      if (past[i].end.frame != now.frame) continue;
      const Tick end = past[i].end.tick;
      const bool as_late = has_any && end == last.end.tick;
      if (has_any && end < last.end.tick) continue;
      last.open_end = past[i].open_end || (as_late && last.open_end);
      last.end.tick = end;
      has_any = true;
    }
  };
  if (rest != nullptr) consider(rest->whole);
  if (holds != nullptr) std::ranges::for_each(holds->counted, consider);
  return last;
}

// Intervals that follow each other at once are two.
bool Engine::StepRepeat(RuleInstance& instance, FrameNumber frame) {
  const Evaluator::View view{instance, frame};
  int holding = 0, begun = 0;
  for (const int slot : RuleOf(instance).As<WhileRule>().counted) {
    const Kleene holds = evaluator_.Holds(slot, view);
    if (holds == Kleene::kUnknown) return false;
    if (holds == Kleene::kTrue) ++holding;
    if (holds == Kleene::kTrue && evaluator_.Begins(slot, view) == Kleene::kTrue) ++begun;
  }
  const Kleene truth = Known(holding > 0);
  if (instance.open && !instance.in_gap && begun > 0 && begun == holding) {
    const Moment now = history_.At(frame), ended = EndOfParts(instance, now).end;
    if (now.tick - ended.tick > TicksOf(instance).bridging && !Close(instance, ended)) return false;
  }
  if (!StepRun(instance, frame, truth)) return false;
  instance.count += begun;
  return true;
}

bool Engine::StepAny(RuleInstance& instance, FrameNumber frame) {
  const AnyRule& rule = RuleOf(instance).As<AnyRule>();
  if (rule.one != kNone) return StepOwners(instance, frame);
  int hold = 0, may_hold = 0;
  for (const InstanceId member : instance.As<AnyState>().members) {
    const Kleene truth = instances_.TruthAt(member, frame);
    hold += truth == Kleene::kTrue ? 1 : 0;
    may_hold += truth == Kleene::kFalse ? 0 : 1;
    if (hold == rule.at_least) break;
  }
  return StepRun(instance, frame,
                 hold >= rule.at_least       ? Kleene::kTrue
                 : may_hold >= rule.at_least ? Kleene::kUnknown
                                             : Kleene::kFalse);
}

// `one hand per object`: who has it keeps it as long as one of its candidates holds. When it is
// free, the first candidate opens a window of time, and of those that hold at some frame in it, the
// nearest at its first one gets it from there on. So a decision takes as long as the window, and is
// never taken back. Who is not tracked is not nearer than another; where of several nobody is
// tracked it stays free, until that changes.

// True if a candidate of the owner holds.
Kleene Engine::GoesOn(const RuleInstance& owners, FrameNumber frame) const {
  const auto one = static_cast<std::size_t>(RuleOf(owners).As<AnyRule>().one);
  const auto& state = owners.As<AnyState>();
  Kleene truth = Kleene::kFalse;
  for (const InstanceId member : state.members) {
    if (instances_[member].entities[one] == state.owner)
      truth = Or(truth, instances_.TruthAt(member, frame));
  }
  return truth;
}

// From a frame on that is free. False while that cannot be decided.
bool Engine::ChooseOwner(RuleInstance& owners, FrameNumber frame) {
  auto& state = owners.As<AnyState>();
  bool some = false, unknown = false;
  for (const InstanceId member : state.members) {
    const Kleene holds = instances_.TruthAt(member, frame);
    some = some || holds == Kleene::kTrue;
    unknown = unknown || holds == Kleene::kUnknown;
  }
  if (unknown || !some) return !unknown;
  const Tick last = history_.At(frame).tick + TicksOf(owners).nearest;
  if (!finishing_ && history_.At(history_.now()).tick < last) {
    owners.by_itself = true;
    return false;
  }
  // Where each holds first, in the order of the cast.
  std::map<int, FrameNumber> begins;
  for (const InstanceId member : state.members) {
    FrameNumber first = frame;
    Kleene holds = instances_.TruthAt(member, first);
    while (holds == Kleene::kFalse && first < history_.now() &&
           history_.At(first + 1).tick <= last) {
      holds = instances_.TruthAt(member, ++first);
    }
    if (holds == Kleene::kUnknown) {
      owners.by_itself = true;
      return false;
    }
    if (holds == Kleene::kFalse) continue;
    const int who =
        instances_[member].entities[static_cast<std::size_t>(RuleOf(owners).As<AnyRule>().one)];
    const auto [begin, is_new] = begins.try_emplace(who, first);
    if (!is_new) begin->second = std::min(begin->second, first);
  }
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const auto& [who, first] : begins) {
    const double away_m =
        begins.size() == 1 ? 0 : evaluator_.AwayFrom_m(who, owners.entities[0], first);
    if (!(away_m < nearest_m)) continue;
    nearest_m = away_m;
    state.owner = who;
    state.owned_from = first;
  }
  if (state.owner == kNoEntity) owners.by_itself = true;
  return true;
}

bool Engine::StepOwners(RuleInstance& instance, FrameNumber frame) {
  auto& state = instance.As<AnyState>();
  if (instance.open) {
    const Kleene goes_on = GoesOn(instance, frame);
    if (goes_on == Kleene::kUnknown) return false;
    if (goes_on == Kleene::kTrue) return true;
    if (!Close(instance, history_.At(frame))) return false;
    state.owner = kNoEntity;
  }
  if (state.owner == kNoEntity && !ChooseOwner(instance, frame)) return false;
  if (state.owner == kNoEntity || frame < state.owned_from) return true;
  return Open(instance, frame);
}

bool Engine::StepRun(RuleInstance& instance, FrameNumber frame, Kleene truth) {
  if (truth == Kleene::kUnknown) return false;
  const Moment now = history_.At(frame);
  const Tick bridging = TicksOf(instance).bridging;
  if (truth == Kleene::kTrue) {
    if (instance.open && instance.in_gap && now.tick - instance.gap.tick > bridging &&
        !Close(instance, instance.gap))
      return false;
    if (!instance.open && !Open(instance, frame)) return false;
    instance.in_gap = false;
  } else if (instance.open) {
    if (!instance.in_gap) {
      instance.in_gap = true;
      instance.gap = EndOfParts(instance, now).end;
    }
    // Later frames are later by a tick at least, so a gap of this length cannot be bridged any
    // more.
    if (now.tick - instance.gap.tick >= bridging) return Close(instance, instance.gap);
  }
  return true;
}

bool Engine::StepRest(RuleInstance& instance, FrameNumber frame) {
  const RestOfRule& rule = RuleOf(instance).As<RestOfRule>();
  const Evaluator::View view{instance, frame};
  const Kleene whole = evaluator_.Holds(rule.whole, view);
  Kleene others = Kleene::kFalse;
  for (const int other : rule.outside) {
    if (whole != Kleene::kFalse) others = Or(others, evaluator_.Holds(other, view));
  }
  const Kleene truth = And(whole, Not(others));
  if (truth == Kleene::kUnknown) return false;
  // Two wholes that abut are two, and so are their rests.
  const bool new_whole =
      truth == Kleene::kTrue && evaluator_.Begins(rule.whole, view) == Kleene::kTrue;
  if (instance.open && (truth == Kleene::kFalse || new_whole) &&
      !Close(instance, EndOfParts(instance, history_.At(frame)).end))
    return false;
  return truth != Kleene::kTrue || instance.open || Open(instance, frame);
}

bool Engine::StepFromTo(RuleInstance& instance, FrameNumber frame) {
  const FromToRule& rule = RuleOf(instance).As<FromToRule>();
  const Evaluator::View view{instance, frame};
  if (instance.open && TicksOf(instance).within >= 0 && !MeetDeadline(instance, history_.At(frame)))
    return false;
  if (instance.open) {
    const Kleene closes = evaluator_.Truth(rule.to, view);
    if (closes == Kleene::kTrue && rule.absence) {
      Note(instance, fate::Came{}, {instance.begin, history_.At(frame)});
      return GiveUp(instance);
    }
    if (closes == Kleene::kTrue) return Close(instance, history_.At(frame));
    const Kleene holds = rule.during == kNone ? Kleene::kTrue : evaluator_.Truth(rule.during, view);
    if (holds == Kleene::kFalse && !rule.or_drop) return Close(instance, history_.At(frame));
    if (closes == Kleene::kUnknown || holds == Kleene::kUnknown) return false;
    if (holds == Kleene::kFalse) {
      Note(instance, fate::Dropped{frame}, {instance.begin, history_.At(frame)});
      return GiveUp(instance);
    }
    if (!rule.each) return true;
    const Kleene opens = evaluator_.Truth(rule.from, view);
    if (opens == Kleene::kTrue) instance.As<FromToState>().waiting.PushBack() = history_.At(frame);
    return opens != Kleene::kUnknown;
  }
  Kleene opens = evaluator_.Truth(rule.from, view);
  if (opens == Kleene::kFalse) return true;
  // What `during` and `to` say of @begin refers to this very frame. Without it, too, they may say
  // that nothing begins: a begin that is an end at once is no interval.
  const bool looks_only = opens == Kleene::kUnknown && RuleOf(instance).anchors_at_hand;
  const bool anchored = looks_only || evaluator_.CaptureAnchors(instance, frame);
  const Evaluator::View begin{.instance = instance,
                              .frame = frame,
                              .begin_known = anchored,
                              .begin_at = looks_only ? frame : -1};
  if (opens == Kleene::kUnknown) {  // but it may be known that nothing begins
    return (rule.during != kNone && evaluator_.Truth(rule.during, begin) == Kleene::kFalse) ||
           evaluator_.IsTrue(rule.to, begin);
  }
  if (rule.during != kNone) opens = And(opens, evaluator_.Truth(rule.during, begin));
  if (opens != Kleene::kFalse) opens = And(opens, Not(evaluator_.Truth(rule.to, begin)));
  if (opens == Kleene::kFalse) return true;
  if (rule.each) instance.As<FromToState>().waiting.Clear();
  return opens == Kleene::kTrue && anchored && Open(instance, frame);
}

// The open run is none. If it can be another one that began while it waited, the frames after its
// begin are stepped again.
bool Engine::GiveUp(RuleInstance& instance) {
  instance.open = false;
  if (RuleOf(instance).TriesEachBegin()) instance.next = instance.begin.frame;
  return true;
}

// An open run whose deadline has passed: without the end that it waited for it is dropped, and with
// `each` the next one that waits takes its place; of a `without` it is an interval.
bool Engine::MeetDeadline(RuleInstance& instance, Moment now) {
  const FromToRule& rule = RuleOf(instance).As<FromToRule>();
  const Tick deadline = instance.begin.tick + TicksOf(instance).within;
  if (now.tick < deadline || (now.tick == deadline && !rule.absence)) return true;
  if (!rule.absence) {
    RingBuffer<Moment>& waiting = instance.As<FromToState>().waiting;
    do {
      const Tick too_late = instance.begin.tick + TicksOf(instance).within;
      Note(instance, fate::TooLate{}, {instance.begin, {now.frame, too_late}});
      instance.open = rule.each && !waiting.empty();
      if (!instance.open) return true;
      instance.begin = waiting.front();
      waiting.PopFront();
    } while (now.tick > instance.begin.tick + TicksOf(instance).within);
    return true;
  }
  const bool just_in_time = now.tick - instance.begin.tick <= TicksOf(instance).in_time;
  if (just_in_time && now.frame <= history_.now()) {
    const Kleene comes = evaluator_.Truth(rule.to, {instance, now.frame});
    if (comes != Kleene::kFalse) return comes == Kleene::kTrue;
  }
  return Close(instance, {now.frame, deadline});
}

bool Engine::StepUntil(RuleInstance& instance, FrameNumber frame) {
  const auto& [until, since, approach, back_s] = RuleOf(instance).As<UntilSinceRule>();
  auto& state = instance.As<UntilSinceState>();
  // Where nothing leads to, it does not matter whether an end is not known, or known to be none.
  const bool is_quiet = EndIsQuiet(instance, frame) && !LeadsHere(instance, frame);
  const Kleene ends = is_quiet ? Kleene::kUnknown : evaluator_.Truth(until, {instance, frame});
  if (ends == Kleene::kUnknown) {
    if (!is_quiet && LeadsHere(instance, frame)) return false;
    // It does not matter whether an end is here; but at the next frame it may.
    instance.by_itself = true;
    if (log_ != nullptr) undecided_ends_.push_back({instance.index, frame});
  }
  if (ends == Kleene::kTrue) {
    const WalkBack walk = BeginOfWalk(instance, frame);
    const FrameNumber begin = walk.begin;
    if (begin == kNever) return false;
    Note(instance, begin < frame ? Fate(fate::WalkedBack{}) : fate::NothingBack{},
         {history_.At(begin), history_.At(frame)}, walk);
    if (begin < frame) {
      if (!evaluator_.CaptureAnchors(instance, begin)) return false;
      instance.style = StyleAt(instance, begin);
      if (!Conclude(instance, {history_.At(begin), history_.At(frame)})) return false;
    }
    state.last_end = state.approach_from = frame;
  }
  if (!RuleOf(instance).referenced) return true;
  if (!leads_always_[instance.rule] && evaluator_.Truth(since, {instance, frame}) == Kleene::kFalse)
    state.approach_from = frame + 1;
  while (state.approach_from < frame &&
         evaluator_.TooFarApart(since, instance, state.approach_from, frame)) {
    ++state.approach_from;
  }
  return true;
}

// It ends where something begins or ends that follows others: as long as that does, there is no
// end.
bool Engine::EndIsQuiet(RuleInstance& instance, FrameNumber frame) {
  const NodeId until = RuleOf(instance).As<UntilSinceRule>().until;
  if (log_ != nullptr || !IsMoment(until)) return false;
  const Node& of = program_->nodes[program_->nodes[until].args[0]];
  const InstanceId index = instance.references[static_cast<std::size_t>(of.slot)];
  return index != kNone && instances_[index].follows && frame >= instances_[index].known;
}

// Whether an interval of any end could hold in the frame before this one. If not, none ends here,
// and none of a later end reaches back beyond this frame.
bool Engine::LeadsHere(RuleInstance& instance, FrameNumber frame) {
  const NodeId since = RuleOf(instance).As<UntilSinceRule>().since;
  if (frame <= history_.first() || leads_always_[instance.rule]) return frame > 0;
  return evaluator_.Truth(since, {instance, frame - 1}) != Kleene::kFalse;
}

// Where the interval that ends here begins.
WalkBack Engine::BeginOfWalk(RuleInstance& instance, FrameNumber end) {
  using Stop = WalkBack::Stop;
  const FrameNumber last_end = instance.As<UntilSinceState>().last_end;
  const FrameNumber back = history_.FirstNotBefore(history_.At(end).tick - TicksOf(instance).back);
  const FrameNumber first = std::max({back, last_end, history_.first()});
  const WalkLimits limits{.first = first,
                          .at_first = first == last_end && first > 0 ? Stop::kPreviousEnd
                                      : first == 0                   ? Stop::kFirstFrame
                                                                     : Stop::kTooFarBack,
                          .idle = TicksOf(instance).idle,
                          .over = TicksOf(instance).over,
                          .still = TicksOf(instance).still};
  return WalkBackFrom(end, RuleOf(instance).As<UntilSinceRule>(), instance, limits, evaluator_,
                      history_, walk_memory_);
}

}  // namespace prehend::grammar
