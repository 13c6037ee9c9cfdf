// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "harness/base/base/quoting.h"
#include "harness/suite/judge/judges.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
namespace {

using grammar::Interval;
using grammar::NamedEvent;
using grammar::Tick;

// docs/robot-demonstrations.md says what each is for.
constexpr double kHalf = 0.5, kClosed = 0.9, kOpened = 0.05;  // of the way of a gripper
constexpr double kNear_m = 0.1, kFall_m = 0.03, kMoved_m = 0.02;
constexpr double kPause_s = 0.3, kSoon_s = 0.5, kAfter_s = 1;

bool Overlap(Interval a, Interval b) { return a.begin < b.end && b.begin < a.end; }

/// Reads the frames of a recording by tick and name.
class Facts {
 public:
  explicit Facts(const episode::Recording& recording) : recording_(recording) {
    const auto& entities = recording.header.entity_table.entities;
    for (std::size_t i = 0; i < entities.size(); ++i)
      index_[entities[i].name] = static_cast<int>(i);
  }

  Tick Ticks(double seconds) const {
    const auto rate = static_cast<double>(recording_.header.entity_table.ticks_per_second);
    return std::llround(seconds * rate);
  }
  int IndexOf(const std::string& name) const { return index_.at(name); }

  /// Calls `look` with every frame from `begin` to `end`; at least with the last one before.
  template <typename Look>
  void Each(Tick begin, Tick end, const Look& look) const {
    const auto& frames = recording_.frames;
    auto at = std::ranges::upper_bound(frames, begin, {}, &episode::EpisodeFrame::tick);
    if (at != frames.begin()) --at;
    for (; at != frames.end() && (at->tick <= end || at == frames.begin()); ++at) look(*at);
  }
  Eigen::Vector3d At(const std::string& name, Tick tick) const {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    Each(tick, tick, [&](const auto& frame) { p = frame.entities[IndexOf(name)].p_WB_m; });
    return p;
  }
  double Lowest(const std::string& name, Tick begin, Tick end) const {
    double lowest = At(name, begin).z();
    Each(begin, end, [&](const auto& frame) {
      lowest = std::fmin(lowest, frame.entities[IndexOf(name)].p_WB_m.z());
    });
    return lowest;
  }
  static double TriggerIn(const episode::EpisodeFrame& frame, int hand) {
    const auto at = std::ranges::find(frame.hands, hand, &grammar::HandSample::entity);
    return at == frame.hands.end() ? 0 : at->trigger;
  }
  double LeastTrigger(const std::string& hand, Tick begin, Tick end) const {
    double least = 1;
    Each(begin, end,
         [&](const auto& frame) { least = std::min(least, TriggerIn(frame, IndexOf(hand))); });
    return least;
  }

  /// The last frame before it opens; `end` if it does not before.
  Tick Opens(const std::string& hand, Tick begin, Tick end) const {
    double closed = 0;
    Tick opens = end;
    Each(begin, end, [&](const auto& frame) {
      closed = std::max(closed, TriggerIn(frame, IndexOf(hand)));
      if (TriggerIn(frame, IndexOf(hand)) >= closed - kOpened) opens = frame.tick;
    });
    return opens;
  }

  /// The thing next to a hand; "" if none is near.
  std::string NextTo(int hand, const episode::EpisodeFrame& frame) const {
    const auto& entities = recording_.header.entity_table.entities;
    std::string nearest;
    double least_m = kNear_m;
    for (const auto& [name, i] : index_) {
      if (std::ranges::count(entities[i].classes, "Movable") == 0) continue;
      const grammar::EntitySample& thing = frame.entities[i];
      const Eigen::Vector3d p =
          thing.q_WB.conjugate() * (frame.entities[hand].p_WB_m - thing.p_WB_m) -
          entities[i].p_BC_m;
      const double far_m = (p.cwiseAbs() - entities[i].half_size_m).cwiseMax(0).norm();
      if (!(far_m < least_m)) continue;
      least_m = far_m;
      nearest = name;
    }
    return nearest;
  }

 private:
  const episode::Recording& recording_;
  std::map<std::string, int> index_;
};

std::string QuestionAbout(const char* option, const std::string& event, const std::string& first,
                          const std::string& second, Tick tick, Tick ticks_per_second) {
  return fmt::format("{} {}", option,
                     ShellQuoted(fmt::format("{} {} {} @{}s", event, first, second,
                                             truth::SecondsText(tick, ticks_per_second))));
}

class Reader {
 public:
  Reader(const episode::Recording& recording, const grammar::Timeline& timeline,
         const truth::EventDrawings& drawings)
      : recording_(recording), facts_(recording) {
    for (const NamedEvent& event : timeline.events) {
      const truth::EventDrawing& drawn = drawings.Of(event.event);
      if (drawn.as == grammar::DrawnAs::kSupport)
        supports_.push_back(
            {&event, event.roles[drawn.first].value, event.roles[drawn.last].value});
      if (drawn.as != grammar::DrawnAs::kGrasp) continue;
      grasps_.push_back({&event, event.roles[drawn.hand].value, event.roles[drawn.first].value});
    }
    for (const auto& [name, drawn] : drawings.all())
      if (drawn.as == grammar::DrawnAs::kGrasp) grasp_name_ = name;
    read_.success = recording.header.attributes.success;
    read_.ticks_per_second = timeline.ticks_per_second;
    read_.end = recording.end_tick;
  }

  Demonstration Read(bool closes) {
    ReadHandlings();
    for (const Handling& handling : read_.handled)
      if (closes) LookAtEnd(handling);
    for (const Pair& support : supports_) LookAtSupport(support);
    for (const auto& entity : recording_.header.entity_table.entities) LookForMisses(entity);
    std::ranges::stable_sort(read_.mishaps, {}, &Mishap::tick);
    std::vector<Handling> last;
    for (const Handling& handling : read_.handled) {
      if (!last.empty() && last.back().object == handling.object) last.pop_back();
      last.push_back(handling);
    }
    read_.handled = std::move(last);
    return std::move(read_);
  }

 private:
  /// An event, and who is in it: hand and object, object and support.
  struct Pair {
    const NamedEvent* event = nullptr;
    std::string first, second;
  };

  Interval Around(Tick begin, Tick end, double seconds) const {
    return {begin - facts_.Ticks(seconds), end + facts_.Ticks(seconds)};
  }
  std::string Question(const char* option, const std::string& event, const std::string& first,
                       const std::string& second, Tick tick) const {
    return QuestionAbout(option, event, first, second, tick, read_.ticks_per_second);
  }

  void ReadHandlings() {
    for (const auto& [event, hand, object] : grasps_) {
      const Interval when = event->interval;
      const auto before = std::ranges::find_if(read_.handled, [&](const Handling& earlier) {
        return earlier.hand == hand && earlier.object == object &&
               when.begin <= earlier.end + facts_.Ticks(kPause_s);
      });
      if (before == read_.handled.end())
        read_.handled.push_back(
            {event->event, hand, object, "", when.begin, when.end, event->open_end});
      else
        before->end = when.end, before->open_end = event->open_end;
    }
    for (Handling& handling : read_.handled) {
      for (const auto& [event, object, support] : supports_) {
        if (object == handling.object && !handling.open_end &&
            event->interval.begin <= handling.end + facts_.Ticks(kSoon_s) &&
            event->interval.end > handling.end)
          handling.support = support;
      }
    }
  }

  bool IsHeld(const std::string& object, Interval when, const Handling* but = nullptr) const {
    return std::ranges::any_of(read_.handled, [&](const Handling& handling) {
      return &handling != but && handling.object == object &&
             Overlap({handling.begin, handling.end}, when);
    });
  }

  void LookAtEnd(const Handling& of) {
    if (of.open_end || IsHeld(of.object, Around(of.end, of.end, kPause_s), &of)) return;
    const Interval when = Around(of.end, of.end, kPause_s);
    const Tick half = of.begin + (of.end - of.begin) / 2;
    const bool opened = facts_.LeastTrigger(of.hand, when.begin, when.end) <
                        facts_.LeastTrigger(of.hand, half, half) - kOpened;
    const Tick opens = opened ? facts_.Opens(of.hand, when.begin, of.end) : of.end;
    const double fall_m = facts_.At(of.object, opens).z() -
                          facts_.Lowest(of.object, opens, of.end + facts_.Ticks(kAfter_s));
    const bool rests = std::ranges::any_of(supports_, [&](const Pair& support) {
      return support.first == of.object && support.event->interval.begin <= opens &&
             support.event->interval.end > of.end;
    });
    if (opened && (rests || !(fall_m >= kFall_m))) return;
    read_.mishaps.push_back(
        {of.end, of.object + (opened ? " dropped by " : " slipped out of ") + of.hand, of.object,
         Question("--event", of.event, of.hand, of.object, of.begin)});
  }

  void LookAtSupport(const Pair& of) {
    const Interval interval = of.event->interval;
    const auto& [event, object, support] = of;
    const Tick end = interval.end;
    if (event->open_end || IsHeld(object, Around(end, end, kSoon_s))) return;
    if (std::ranges::any_of(supports_, [&](const Pair& again) {
          const Tick begin = again.event->interval.begin;
          return again.first == object && again.second == support && begin >= end &&
                 begin <= end + facts_.Ticks(kSoon_s);
        }))
      return;
    const Interval when{end - facts_.Ticks(kPause_s), end + facts_.Ticks(kAfter_s)};
    const Eigen::Vector3d moved =
        facts_.At(object, when.end) - facts_.At(object, std::max(when.begin, interval.begin));
    if (!(moved.norm() > kMoved_m)) return;
    read_.mishaps.push_back({end, object + " came off " + support, object,
                             Question("--event", event->event, object, support, interval.begin)});
  }

  /// A gripper closes next to a thing, and holds nothing.
  void LookForMisses(const grammar::EntityInfo& entity) {
    if (std::ranges::count(entity.classes, "Hand") == 0) return;
    const int hand = facts_.IndexOf(entity.name);
    constexpr Tick kNever = -1;
    Tick open = kNever;
    for (const episode::EpisodeFrame& frame : recording_.frames) {
      const double trigger = Facts::TriggerIn(frame, hand);
      if (trigger < kHalf) open = frame.tick;
      if (open == kNever || trigger < kClosed) continue;
      const Interval when = Around(open, frame.tick, kSoon_s);
      open = kNever;
      const std::string object = facts_.NextTo(hand, frame);
      if (object.empty() || std::ranges::any_of(read_.handled, [&](const Handling& handling) {
            return handling.hand == entity.name && Overlap({handling.begin, handling.end}, when);
          }))
        continue;
      read_.mishaps.push_back(
          {frame.tick, fmt::format("{} missed, {} closed on nothing", object, entity.name), object,
           Question("--expected", grasp_name_, entity.name, object, frame.tick), true});
    }
  }

  const episode::Recording& recording_;
  const Facts facts_;
  std::vector<Pair> grasps_, supports_;
  std::string grasp_name_;
  Demonstration read_;
};

std::string StoryOf(const Demonstration& one) {
  std::string story;
  for (const Handling& handling : one.handled)
    story += fmt::format("{}>{}{};", handling.object, handling.support,
                         handling.open_end ? "(held)" : "");
  return story;
}

/// What most of them do that succeeded; where no file says so, of those in which nothing goes
/// wrong, if at least two do the same.
const Demonstration* UsualOf(const std::vector<const Demonstration*>& all) {
  std::map<std::string, std::vector<const Demonstration*>> stories, smooth;
  for (const Demonstration* one : all) {
    if (one->success.value_or(false)) stories[StoryOf(*one)].push_back(one);
    if (!one->success && one->mishaps.empty()) smooth[StoryOf(*one)].push_back(one);
  }
  const bool is_said = !stories.empty();
  if (!is_said) stories = std::move(smooth);
  const auto most =
      std::ranges::max_element(stories, {}, [](const auto& story) { return story.second.size(); });
  if (most == stories.end() || (!is_said && most->second.size() < 2)) return nullptr;
  return most->second.front();
}

/// Where it first does something else.
std::optional<Mishap> Deviation(const Demonstration& one, const Demonstration& usual) {
  const auto ask = [&](const char* option, const Handling& of, Tick tick) {
    return QuestionAbout(option, of.event, of.hand, of.object, tick, one.ticks_per_second);
  };
  for (std::size_t i = 0; i < usual.handled.size(); ++i) {
    const Handling& wanted = usual.handled[i];
    if (i >= one.handled.size())
      return Mishap{one.end - 1, wanted.object + " not grasped", wanted.object,
                    ask("--expected", wanted, one.end - 1)};
    const Handling& is = one.handled[i];
    if (is.object != wanted.object)
      return Mishap{is.begin, fmt::format("{} grasped instead of {}", is.object, wanted.object),
                    is.object, ask("--event", is, is.begin)};
    if (is.open_end == wanted.open_end && is.support == wanted.support) continue;
    const Tick tick = is.open_end ? one.end - 1 : is.end;
    const std::string what = is.open_end              ? "not released"
                             : wanted.open_end        ? "released"
                             : is.support.empty()     ? "not put on " + wanted.support
                             : wanted.support.empty() ? "put on " + is.support
                                                      : fmt::format("put on {} instead of {}",
                                                                    is.support, wanted.support);
    return Mishap{tick, is.object + " " + what, is.object, ask("--event", is, is.begin)};
  }
  return std::nullopt;
}

bool IsMadeGood(const Mishap& mishap, const Demonstration& one) {
  const auto next = std::ranges::find_if(
      one.handled, [&](const Handling& handling) { return handling.begin > mishap.tick; });
  return next != one.handled.end() && next->object == mishap.object;
}

std::optional<Mishap> FirstCause(const Demonstration& one, const Demonstration* usual) {
  if (one.success.value_or(false)) return std::nullopt;
  const std::optional<Mishap> other = usual ? Deviation(one, *usual) : std::nullopt;
  const bool is_done = usual && !other && !one.handled.empty();
  std::optional<Mishap> first = other;
  for (const Mishap& mishap : one.mishaps) {
    if (IsMadeGood(mishap, one)) continue;
    // It did what the others do: a gripper closes on its way home, or all was made good.
    const bool in_time = mishap.tick <= (is_done ? one.handled.back().end : 0);
    if (is_done && (mishap.is_miss || (!one.success && in_time))) continue;
    if (!first || mishap.tick <= first->tick) first = mishap;
    break;
  }
  if (first || one.success.value_or(true)) return first;
  if (!one.mishaps.empty()) return one.mishaps.front();
  return Mishap{one.end - 1, "no cause was seen", "", ""};
}

}  // namespace

std::optional<Demonstration> DemonstrationOf(episode::Recording& recording,
                                             const grammar::Timeline& timeline,
                                             const truth::EventDrawings& drawings) {
  bool has_gripper = false;
  recording.EachFrame([&](const auto& frame) {
    has_gripper = has_gripper || std::ranges::any_of(frame.hands, [](const auto& hand) {
                    return hand.trigger > kOpened;
                  });
  });
  if (!has_gripper && recording.header.attributes.success.value_or(true)) return std::nullopt;
  recording.Keep();
  return Reader(recording, timeline, drawings).Read(has_gripper);
}

std::vector<std::optional<Mishap>> FirstCauses(const std::vector<const Demonstration*>& all) {
  const Demonstration* usual = UsualOf(all);
  std::vector<std::optional<Mishap>> causes;
  for (const Demonstration* one : all) causes.push_back(FirstCause(*one, usual));
  return causes;
}

}  // namespace prehend::suite
