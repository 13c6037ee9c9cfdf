// SPDX-License-Identifier: Apache-2.0
// Well-formed grammars made at random, and what they mean according to
// tests/grammar/reference/reference.h: every form, with rules that use rules, `any`, values at the
// begin and at the end, confirmations and compositions. Tested by
// tests/grammar/reference/reference_test.cc
#pragma once

#include <array>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "grammar/base/allen.h"
#include "grammar/monitor.h"
#include "tests/grammar/reference/reference.h"

namespace prehend::grammar::testing {

/// What happens to x: whom it touches (p1, p2, q, r), how high it is, where nobody knows that, and
/// whether it grips. One tick is 1 ms.
struct RandomEpisode {
  std::array<reference::Stream, 4> touches;
  reference::Stream grips;
  std::vector<int> height_m;
  reference::Stream lost;
  reference::Ticks ticks;  ///< and the end

  int frames() const { return static_cast<int>(height_m.size()); }
};

/// `calm`: about how many frames a fact stays as it is.
RandomEpisode MakeEpisode(std::mt19937_64& random, int frames, unsigned calm);
/// The facts as rows of characters, for messages.
std::string Drawn(const RandomEpisode& episode);

EntityTable RandomEntityTable();

/// How a frame is shown: all of it, as a change of everything, or only what is new in it, which may
/// be nothing.
enum class Shown { kWhole, kRepeated, kNew };

/// Shows an episode to a monitor, frame by frame.
class EpisodeFeed {
 public:
  EpisodeFeed(const RandomEpisode& episode, Monitor& monitor)
      : episode_(episode), monitor_(monitor), looks_(5) {}
  bool done() const { return next_ > episode_.frames(); }
  /// The next frame, or after the last one the end.
  void Step(Shown shown, std::vector<Event>& events);

 private:
  const RandomEpisode& episode_;
  Monitor& monitor_;
  std::vector<EntitySample> looks_;
  std::vector<Touch> touches_;
  int next_ = 0;
};

/// Values over a window. A speed is in units of 250 m/s, like a rate.
inline constexpr std::array<const char*, 5> kOverWindow = {"mean", "min", "max", "median", "speed"};
inline constexpr int kSpeed = 4;

/// How high the second p is; all others but x are on the floor.
inline constexpr int kHeightOfP2_m = 3;

/// A role that two entities can play.
inline constexpr unsigned kP = 1;

/// A truth value made of facts and rules.
struct Term {
  /// kHighP: of p, which stays where it is.
  enum class Kind {
    kTouch,
    kGrip,
    kHigh,
    kHighP,
    kRising,
    kOfWindow,
    kRule,
    kAnd,
    kOr,
    kNot,
    kKnown,
    kEdge
  };
  Kind kind = Kind::kHigh;
  int which = 0;       ///< kTouch: role; kRule: rule
  unsigned named = 0;  ///< kRule: roles that are named; the others are `any`
  int at_least = 1;    ///< kRule: of both p
  int value = 0;       ///< kHigh: height(x) >= value metres, from `anchor` on if there is one
  std::string anchor;  ///< kHigh, kRising: "begin", "end" or nothing
  Tick window = 0;     ///< kRising: rate(height(x), window) >= value * 250 m/s, likewise
  bool begins = true;  ///< kEdge
  std::vector<Term> args;
};

/// One rule; which members count depends on the form.
struct RandomRule {
  enum class Form { kWhile, kFromTo, kWithout, kUntil, kRest, kCompose, kRepeat, kAllOf };
  struct Clause {
    std::size_t left = 0, right = 0;
    Relations relations;  ///< half a tick more in the text, where there is a time
  };
  Form form = Form::kWhile;
  unsigned roles = 0;  ///< of p, q, r; x has a part in all
  Term first, second, during;
  bool has_second = false, has_during = false, or_drop = false, approaches = false, idles = false;
  int slack_m = 0;
  Tick over = 0;        ///< of the median that must not recede; 0: no median
  Tick still_over = 0;  ///< for how long x stays within 1.5 m; 0: that does not count
  double speed_m_per_s = 0;
  double onset_m_per_s = 0;  ///< 120 where the text says it, a tenth of the speed where it does not
  int at_least = 0;          ///< kRepeat, whose gap is `bridging`, or where it is said `within`
  bool one_per = false;  ///< kWhile: one p per x, of which p1 is on the floor and p2 is 3 m high
  Tick nearest_within = 0;
  Tick bridging = 0, lasting = 0, lasting_most = 0, within = -1, back = 0, idle = 0;
  bool halves = false;  ///< its durations are half a tick off what they are in whole ticks
  std::vector<Term>
      calls;  ///< kRest: the whole and the others; kCompose, kAllOf: the parts; kRepeat: whom
  std::vector<std::pair<std::size_t, Term>> choices;  ///< likewise: `or` this for the part
  bool takes_first = false;                           ///< kCompose
  bool from_each = false;                             ///< kFromTo
  std::vector<Clause> clauses;
  bool has_absence = false;  ///< kCompose, kAllOf: nothing of `during` between two of the parts
  std::size_t left = 0, right = 0;
  bool has_requirement = false, requires_at_end = false, is_confirmed = false;
  Term requirement, by, episode;
};

class RandomGrammar {
 public:
  RandomGrammar(std::mt19937_64& random, int rules);

  const std::string& text() const { return text_; }
  /// Intervals by "rule(roles)", those with intervals only, sorted.
  std::map<std::string, std::vector<Interval>> Expected(const RandomEpisode& episode) const;

 private:
  std::vector<RandomRule> rules_;
  std::string text_;
};

}  // namespace prehend::grammar::testing
