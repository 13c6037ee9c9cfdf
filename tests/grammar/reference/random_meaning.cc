// SPDX-License-Identifier: Apache-2.0
#include "tests/grammar/reference/random_meaning.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grammar/base/allen.h"

namespace prehend::grammar::testing {
namespace {

using reference::Anchored;
using reference::Runs;
using reference::Stream;
using Kind = Term::Kind;
using Form = RandomRule::Form;

// Says what the rules mean for one episode, for both bindings of p.
class Meaning {
 public:
  Meaning(const std::vector<RandomRule>& rules, const RandomEpisode& episode)
      : rules_(rules), e_(episode), n_(episode.frames()) {
    for (std::size_t i = 0; i < rules.size(); ++i) {
      found_.emplace_back();
      for (int p = 0; p < 2; ++p) found_.back()[p] = Find(rules[i], p);
    }
  }

  using Found = MeantIntervals;
  const std::vector<std::array<Found, 2>>& all() const { return found_; }

 private:
  Found InTicks(const Runs& runs) const { return reference::InTicks(runs, e_.ticks); }

  // The intervals that a call stands for.
  Found Intervals(const Term& term, int p) const {
    const bool own = term.kind == Kind::kRule && term.named == rules_[term.which].roles;
    if (own) return found_[term.which][p];
    return InTicks(
        While(Truth(term, p, 0)));  // of somebody: where one goes on when another ends, it is one
  }
  Runs CallRuns(const Term& term, int p) const { return reference::RunsOf(Intervals(term, p)); }
  Runs While(const Stream& stream) const { return reference::While(stream, e_.ticks, 0); }

  // Where it is true; neither unknown nor false is enough.
  // `in_known`: a rule is unknown where it is out of sight.
  Stream Truth(const Term& term, int p, int anchor, bool in_known = false) const {
    return Truths(term, p, anchor, in_known).is;
  }

  reference::Truths Truths(const Term& term, int p, int anchor, bool in_known) const {
    const auto of = [&](std::size_t arg) { return Truths(term.args[arg], p, anchor, in_known); };
    const auto compared = [&](double more, bool strictly, const auto& value) {
      const double base = term.anchor.empty() ? 0 : value(std::min(anchor, n_ - 1));
      reference::Truths truths{Stream(n_), Stream(n_)};
      for (int i = 0; i < n_; ++i) {
        const double most = base + more;
        truths.is[i] = value(i) > most || (!strictly && value(i) == most);
        truths.may[i] = truths.is[i] || std::isnan(value(i)) || std::isnan(most);
      }
      return truths;
    };
    const auto known = [](Stream stream) { return reference::Truths{stream, stream}; };
    switch (term.kind) {
      case Kind::kTouch:
        return known(e_.touches[term.which == 0 ? p : term.which + 1]);
      case Kind::kGrip:
        return known(e_.grips);
      case Kind::kHighP:
        return known(Stream(n_, p == 1));
      case Kind::kHigh:
        return compared(term.value, false, [&](int i) { return Height(i); });
      case Kind::kRising:
        return compared(250 * term.value, false, [&](int i) { return Rate(i, term.window); });
      case Kind::kOfWindow:
        return compared(term.which == kSpeed ? 250 * term.value : term.value + 0.5, true,
                        [&](int i) { return OfWindow(i, term); });
      case Kind::kRule: {
        const bool anybody = (rules_[term.which].roles & kP & ~term.named) != 0;
        const Stream own =
            reference::Truth(reference::RunsOf(found_[term.which][anybody ? 0 : p]), n_);
        const Stream other = reference::Truth(reference::RunsOf(found_[term.which][1]), n_);
        const Stream is = term.at_least > 1 ? reference::And(own, other)
                          : anybody         ? reference::Or(own, other)
                                            : own;
        return {is, in_known ? reference::Or(is, OutOfSight(term)) : is};
      }
      case Kind::kAnd:
        return reference::And(of(0), of(1));
      case Kind::kOr:
        return reference::Or(of(0), of(1));
      case Kind::kNot:
        return reference::Not(of(0));
      case Kind::kKnown:
        return known(Truth(term.args[0], p, anchor, true));
      case Kind::kEdge: {
        const Term& arg = term.args[0];
        const bool has_intervals = arg.kind == Kind::kRule || arg.kind == Kind::kTouch;
        const Runs runs = has_intervals ? CallRuns(arg, p) : While(Truth(arg, p, anchor, in_known));
        return known(term.begins ? reference::Begins(runs, n_) : reference::Ends(runs, n_));
      }
    }
    return {};
  }

  // Where x is lost, or was or will be in a window of time that it looks at.
  Stream OutOfSight(const Term& term) const {
    Stream unseen(n_, false);
    const auto value = [&](int i) {
      return term.kind == Kind::kHigh     ? Height(i)
             : term.kind == Kind::kRising ? Rate(i, term.window)
                                          : OfWindow(i, term);
    };
    const bool by_pose =
        term.kind == Kind::kHigh || term.kind == Kind::kRising || term.kind == Kind::kOfWindow;
    for (int i = 0; by_pose && i < n_; ++i) unseen[i] = std::isnan(value(i));
    if (term.kind == Kind::kRule) unseen = OutOfSight(rules_[term.which]);
    for (const Term& arg : term.args) unseen = reference::Or(unseen, OutOfSight(arg));
    return unseen;
  }
  Stream OutOfSight(const RandomRule& rule) const {
    std::vector<const Term*> asked;
    const bool is_form = rule.calls.empty();
    if (is_form) asked.push_back(&rule.first);
    if (is_form && HasSecond(rule)) asked.push_back(&rule.second);
    if (rule.has_during || rule.has_absence) asked.push_back(&rule.during);
    if (rule.has_requirement) asked.push_back(&rule.requirement);
    if (rule.is_confirmed) asked.insert(asked.end(), {&rule.by, &rule.episode});
    for (const Term& call : rule.calls) asked.push_back(&call);
    for (const auto& [part, call] : rule.choices) asked.push_back(&call);
    Stream unseen = rule.approaches || rule.one_per ? e_.lost : Stream(n_, false);
    for (const Term* const term : asked) unseen = reference::Or(unseen, OutOfSight(*term));
    return unseen;
  }
  static bool HasSecond(const RandomRule& rule) {
    return rule.has_second || rule.form != Form::kWhile;
  }

  double Height(int frame) const {
    return e_.lost[frame] ? std::numeric_limits<double>::quiet_NaN() : e_.height_m[frame];
  }

  // From the last frame at least half the window earlier to the first one so much later, in m/s; no
  // number where it is lost in between.
  double Rate(int frame, Tick window) const {
    const Tick half = (window + 1) / 2;
    int early = frame, late = frame;
    while (early > 0 && e_.ticks[early] > e_.ticks[frame] - half) --early;
    while (late + 1 < n_ && e_.ticks[late] < e_.ticks[frame] + half) ++late;
    if (early == late) return Height(late) - Height(early);
    for (int i = early; i <= late; ++i)
      if (e_.lost[i]) return Height(i);
    return (Height(late) - Height(early)) /
           (static_cast<double>(e_.ticks[late] - e_.ticks[early]) / 1000);
  }

  // The mean, the smallest, the largest, the median of the frames at most half the window away; or
  // a speed.
  double OfWindow(int frame, const Term& term) const {
    if (term.which == kSpeed) return std::abs(Rate(frame, term.window));
    std::vector<double> heights;
    for (int i = 0; i < n_; ++i) {
      if (2 * std::abs(e_.ticks[i] - e_.ticks[frame]) <= term.window) heights.push_back(Height(i));
    }
    double sum = 0;
    for (const double height : heights) sum += height;
    if (std::isnan(sum)) return sum;
    std::sort(heights.begin(), heights.end());
    if (term.which == 0) return sum / static_cast<double>(heights.size());
    return term.which == 1   ? heights.front()
           : term.which == 2 ? heights.back()
                             : heights[heights.size() / 2];
  }

  Anchored AnchoredTruth(const Term& term, int p) const {
    return Anchored(
        std::function<Stream(int)>([this, &term, p](int frame) { return Truth(term, p, frame); }));
  }

  // Of p1 and p2, the one whose turn it is.
  Found FindForm(const RandomRule& rule, int p) const {
    if (!rule.one_per) return FindAnyForm(rule, p);
    std::vector<Runs> candidates;
    std::vector<std::vector<double>> away(2);
    for (int candidate = 0; candidate < 2; ++candidate) {
      candidates.push_back(reference::RunsOf(FindAnyForm(rule, candidate)));
      for (int i = 0; i < n_; ++i)
        away[candidate].push_back(std::abs(Height(i) - candidate * kHeightOfP2_m));
    }
    return InTicks(reference::OnePer(candidates, away, e_.ticks, rule.nearest_within)[p]);
  }

  Found FindAnyForm(const RandomRule& rule, int p) const {
    const Anchored during =
        rule.has_during ? AnchoredTruth(rule.during, p) : Anchored(Stream(n_, true));
    switch (rule.form) {
      case Form::kWhile: {
        const Stream on = Truth(rule.first, p, 0);
        return InTicks(rule.has_second ? reference::Hold(on, AnchoredTruth(rule.second, p),
                                                         e_.ticks, rule.bridging)
                                       : reference::While(on, e_.ticks, rule.bridging));
      }
      case Form::kFromTo:
        if (rule.from_each)
          return InTicks(reference::FromEachTo(Truth(rule.first, p, 0), Truth(rule.second, p, 0),
                                               during.at(0), rule.or_drop, e_.ticks, rule.within));
        return InTicks(reference::FromTo(Truth(rule.first, p, 0), AnchoredTruth(rule.second, p),
                                         during, rule.or_drop, e_.ticks, rule.within));
      case Form::kWithout:
        return reference::FromWithout(
            Truth(rule.first, p, 0), AnchoredTruth(rule.second, p),
            Anchored(std::function<Stream(int)>([&](int frame) {
              return reference::And(during.at(frame), reference::Not(OutOfSight(rule.second)));
            })),
            e_.ticks, static_cast<double>(rule.within) - (rule.halves ? 0.5 : 0));
      case Form::kUntil: {
        std::vector<double> heights;
        for (int i = 0; i < n_; ++i) heights.push_back(Height(i));
        reference::Approach approach{.signal = heights,
                                     .slack = rule.slack_m + 0.5,
                                     .over = static_cast<double>(rule.over),
                                     .still = rule.still_over > 0 ? 1.5 : -1,
                                     .still_over = static_cast<double>(rule.still_over),
                                     .speed = rule.speed_m_per_s,
                                     .onset = rule.onset_m_per_s,
                                     .idle = rule.idles ? rule.idle : -1};
        return InTicks(reference::UntilSince(Truth(rule.first, p, 0), AnchoredTruth(rule.second, p),
                                             e_.ticks, rule.back,
                                             rule.approaches ? &approach : nullptr));
      }
      case Form::kRest: {
        std::vector<Stream> outside;
        for (std::size_t i = 1; i < rule.calls.size(); ++i)
          outside.push_back(Truth(rule.calls[i], p, 0));
        return reference::RestOf(Intervals(rule.calls[0], p), outside, e_.ticks);
      }
      case Form::kRepeat: {
        Found intervals;
        for (const Term& call : rule.calls) {
          for (const reference::Timed& one : Intervals(call, p)) intervals.push_back(one);
        }
        return rule.within < 0 ? reference::Repeat(intervals, rule.at_least, rule.bridging)
                               : reference::RepeatWithin(intervals, rule.at_least, rule.within);
      }
      case Form::kCompose:
      case Form::kAllOf:
        return FindComposed(rule, p);
    }
    return {};
  }

  Found FindComposed(const RandomRule& rule, int p) const {
    std::vector<Found> parts;
    for (const Term& call : rule.calls) parts.push_back(Intervals(call, p));
    for (const auto& [part, call] : rule.choices) {
      for (const reference::Timed& one : Intervals(call, p)) parts[part].push_back(one);
    }
    const bool all_of = rule.form == Form::kAllOf;
    const Found absent = rule.has_absence ? Intervals(rule.during, p) : Found();
    const Found unseen = rule.has_absence ? InTicks(While(OutOfSight(rule.during))) : Found();
    const auto fits = [&](const std::vector<Interval>& chosen) {
      for (std::size_t i = 0; all_of && i < chosen.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
          if (Share(rule, i, k) && chosen[i] == chosen[k]) return false;
        }
      }
      return std::ranges::all_of(rule.clauses,
                                 [&](const RandomRule::Clause& clause) {
                                   return clause.relations.Fit(chosen[clause.left],
                                                               chosen[clause.right]);
                                 }) &&
             reference::NothingBetween(absent, chosen[rule.left], chosen[rule.right]) &&
             reference::NothingBetween(unseen, chosen[rule.left], chosen[rule.right]);
    };
    return all_of ? reference::AllOf(parts, fits, rule.within)
                  : reference::Compose(parts, fits, rule.takes_first);
  }

  // Two parts may be about one event: `any` may be whom the other one names.
  static bool Share(const RandomRule& rule, std::size_t i, std::size_t k) {
    const auto calls = [&](std::size_t part) {
      std::vector<Term> all = {rule.calls[part]};
      for (const auto& [of, call] : rule.choices)
        if (of == part) all.push_back(call);
      return all;
    };
    for (const Term& one : calls(i)) {
      for (const Term& other : calls(k))
        if (one.which == other.which) return true;
    }
    return false;
  }

  Found Find(const RandomRule& rule, int p) const {
    Found kept;
    for (const reference::Timed& one : FindForm(rule, p)) {
      const Tick lasted = one.ticks.end - one.ticks.begin;
      if (lasted < rule.lasting || (rule.lasting_most > 0 && lasted > rule.lasting_most)) continue;
      if (Meets(rule, one.run, p) && IsConfirmed(rule, one.run, p)) kept.push_back(one);
    }
    return kept;
  }

  bool Meets(const RandomRule& rule, const reference::Run& run, int p) const {
    if (!rule.has_requirement) return true;
    return Truth(rule.requirement, p,
                 rule.requires_at_end ? run.end : run.begin)[std::min(run.end, n_ - 1)];
  }

  bool IsConfirmed(const RandomRule& rule, const reference::Run& run, int p) const {
    if (!rule.is_confirmed) return true;
    return !reference::ConfirmedBy({run}, CallRuns(rule.by, p), Truth(rule.episode, p, 0)).empty();
  }

  const std::vector<RandomRule>& rules_;
  const RandomEpisode& e_;
  int n_;
  std::vector<std::array<Found, 2>> found_;
};

}  // namespace

std::vector<std::array<MeantIntervals, 2>> MeaningOf(const std::vector<RandomRule>& rules,
                                                     const RandomEpisode& episode) {
  return Meaning(rules, episode).all();
}

}  // namespace prehend::grammar::testing
