// SPDX-License-Identifier: Apache-2.0
// Explanations for programs. Explanations for people: a tree of clauses, aligned; one line per
// event for all of them.
#include "harness/show/explain/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <tuple>

#include "grammar/other_numbers.h"
#include "harness/show/explain/query.h"
#include "harness/show/explain/why_event.h"
#include "harness/show/explain/why_missing.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::show {
namespace {

using grammar::CandidateOutcome;
using grammar::InstanceId;
using grammar::ReplayMonitor;
using grammar::RuleId;
using grammar::Tick;

std::vector<const CandidateOutcome*> IntervalsOf(ReplayMonitor& past, const Ask& ask) {
  std::vector<const CandidateOutcome*> intervals;
  for (const InstanceId instance : BindingsThatFit(past, ask.rule, ask.entities)) {
    for (const CandidateOutcome& outcome : past.OutcomesOf(instance)) {
      if (outcome.IsInterval()) intervals.push_back(&outcome);
    }
  }
  std::stable_sort(intervals.begin(), intervals.end(),
                   [](const CandidateOutcome* a, const CandidateOutcome* b) {
                     return std::tie(a->span.begin.tick, a->span.end.tick) <
                            std::tie(b->span.begin.tick, b->span.end.tick);
                   });
  return intervals;
}

Tick TickOf(const Ask& ask, const ReplayMonitor& past) {
  return truth::TickAt(*ask.time_s, past.entity_table().ticks_per_second);
}

// A time that was read off a table has four decimals.
bool Contains(const CandidateOutcome& outcome, double time_s, Tick ticks_per_second) {
  constexpr double kRounded_s = 1e-4;
  return truth::SecondsOf(outcome.span.begin.tick, ticks_per_second) <= time_s + kRounded_s &&
         time_s - kRounded_s <= truth::SecondsOf(outcome.span.end.tick, ticks_per_second);
}

using Json = nlohmann::ordered_json;

const char* Name(Reason::Mark mark) {
  switch (mark) {
    case Reason::Mark::kTurned:
      return "turned";
    case Reason::Mark::kHeld:
      return "held";
    case Reason::Mark::kFailed:
      return "failed";
    case Reason::Mark::kNote:
      return "note";
  }
  return "";
}

// JSON has no infinity.
Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json ToJson(const Reasons& reasons, Tick ticks_per_second) {
  Json list = Json::array();
  for (const Reason& reason : reasons) {
    Json json = {{"is", Name(reason.mark)}, {"clause", reason.what}, {"text", reason.how}};
    if (!reason.where.empty()) json["rule"] = reason.where;
    if (reason.tick) json["tick"] = *reason.tick;
    if (reason.tick) json["time_s"] = truth::SecondsOf(*reason.tick, ticks_per_second);
    if (reason.reading) {
      json["value"] = Number(reason.reading->value);
      json["limit"] = Number(reason.reading->limit);
      json["unit"] = reason.reading->unit;
    }
    if (!reason.because.empty()) json["because"] = ToJson(reason.because, ticks_per_second);
    list.push_back(std::move(json));
  }
  return list;
}

using Mark = Reason::Mark;

constexpr std::size_t kMaxWidth = 70;  // what stands beyond starts a column of its own

char Sign(Mark mark) {
  switch (mark) {
    case Mark::kTurned:
      return '>';
    case Mark::kHeld:
      return '=';
    case Mark::kFailed:
      return '-';
    case Mark::kNote:
      return ' ';
  }
  return ' ';
}

struct Line {
  std::string left;
  std::string right;
};

void AddLines(const Reasons& reasons, std::size_t indent, std::vector<Line>& lines) {
  for (const Reason& reason : reasons) {
    std::string right = reason.how;
    if (!reason.where.empty() && !reason.because.empty()) right += "  (" + reason.where + ")";
    lines.push_back({fmt::format("{:{}}{} {}", "", indent, Sign(reason.mark), reason.what), right});
    AddLines(reason.because, indent + 2, lines);
  }
}

std::string Tree(const std::string& title, const Reasons& reasons) {
  if (reasons.empty()) return "";
  std::vector<Line> lines;
  AddLines(reasons, 2, lines);
  std::size_t width = 0;
  for (const Line& line : lines) {
    if (line.left.size() <= kMaxWidth) width = std::max(width, line.left.size());
  }
  std::string text = title + "\n";
  for (const Line& line : lines) {
    std::string row = fmt::format("{:<{}}  {}", line.left, width, line.right);
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

const Reason* FirstTurned(const Reasons& reasons) {
  for (const Reason& reason : reasons) {
    if (reason.mark != Mark::kTurned) continue;
    const Reason* inner = FirstTurned(reason.because);
    return inner != nullptr ? inner : &reason;
  }
  return reasons.empty() ? nullptr : &reasons.front();
}

// "in_cylinder(..)": the whole clause is in the event's own explanation.
std::string Short(const std::string& clause) {
  constexpr std::size_t kLong = 32;
  const std::size_t open = clause.find('(');
  if (clause.size() <= kLong || open == std::string::npos) return clause;
  std::size_t close = open;
  for (int depth = 0; close < clause.size(); ++close) {
    depth += clause[close] == '(' ? 1 : clause[close] == ')' ? -1 : 0;
    if (depth == 0) break;
  }
  return clause.substr(0, open) + "(..)" + clause.substr(std::min(close + 1, clause.size()));
}

std::string Late(const WhyEvent& why, Tick ticks_per_second) {
  if (why.open_end) return "at the end of the episode";
  if (why.decided == why.interval.end) return "at its end";
  return Duration(why.decided - why.interval.end, ticks_per_second) + " after its end";
}

void AddTo(Json& json, const std::optional<Decisive>& decisive) {
  if (!decisive) return;
  json["decisive"] =
      decisive->clause.empty()
          ? Json(nullptr)
          : Json{{"clause", decisive->clause},
                 {"rule", decisive->rule},
                 {"at", decisive->where},
                 {"limit", decisive->limit},
                 {"instead", decisive->instead},
                 {"unit", decisive->dimension == grammar::kPlain
                              ? ""
                              : grammar::DimensionText(decisive->dimension)},
                 {"share", std::abs(decisive->instead - decisive->limit) /
                               std::max(std::abs(decisive->instead), std::abs(decisive->limit))}};
  if (!decisive->elsewhere.empty()) json["decisive"]["elsewhere"] = decisive->elsewhere;
}

std::string Sentence(const std::optional<Decisive>& decisive, const char* what) {
  if (!decisive) return "";
  if (decisive->clause.empty())
    return fmt::format("  decisive: no clause alone; with no other single number would it {}\n",
                       what);
  const auto text = [&](double value) { return QuantityText(value, decisive->dimension, 12); };
  const std::string elsewhere =
      decisive->elsewhere.empty() ? ""
                                  : fmt::format(", if '{}' stayed as it is in {}", decisive->param,
                                                fmt::join(decisive->elsewhere, ", "));
  return fmt::format("  decisive: {} of {}  ({})\n    with {} instead of {} it would {}{}\n",
                     decisive->clause, decisive->rule, decisive->where, text(decisive->instead),
                     text(decisive->limit), what, elsewhere);
}

}  // namespace

std::vector<WhyEvent> ExplainAll(ReplayMonitor& past) {
  std::vector<WhyEvent> events;
  EventReasons reasons(past);
  for (const RuleId rule : grammar::IdsOf(past.program().rules)) {
    if (!past.program().rules[rule].printed) continue;
    for (const InstanceId instance : past.InstancesOf(rule)) {
      for (const CandidateOutcome& outcome : past.OutcomesOf(instance)) {
        if (outcome.IsInterval()) events.push_back(reasons.Explain(instance, outcome, true));
      }
    }
  }
  std::stable_sort(events.begin(), events.end(), [](const WhyEvent& a, const WhyEvent& b) {
    return std::tie(a.interval.begin, a.interval.end, a.event) <
           std::tie(b.interval.begin, b.interval.end, b.event);
  });
  return events;
}

std::vector<WhyEvent> ExplainEvents(ReplayMonitor& past, const Ask& ask) {
  std::vector<WhyEvent> events;
  EventReasons reasons(past);
  for (const CandidateOutcome* outcome : IntervalsOf(past, ask)) {
    if (!ask.time_s || Contains(*outcome, *ask.time_s, past.entity_table().ticks_per_second))
      events.push_back(reasons.Explain(outcome->instance, *outcome));
  }
  return events;
}

std::vector<WhyEvent> NearestEvents(ReplayMonitor& past, const Ask& ask) {
  constexpr std::size_t kMaxListed = 3;
  std::vector<const CandidateOutcome*> intervals = IntervalsOf(past, ask);
  const auto away = [&](const CandidateOutcome* outcome) {
    if (!ask.time_s) return Tick{0};
    const Tick tick = TickOf(ask, past);
    return std::max({Tick{0}, outcome->span.begin.tick - tick, tick - outcome->span.end.tick});
  };
  std::stable_sort(
      intervals.begin(), intervals.end(),
      [&](const CandidateOutcome* a, const CandidateOutcome* b) { return away(a) < away(b); });
  if (intervals.size() > kMaxListed) intervals.resize(kMaxListed);
  std::vector<WhyEvent> events;
  EventReasons reasons(past);
  for (const CandidateOutcome* outcome : intervals)
    events.push_back(reasons.Explain(outcome->instance, *outcome, true));
  return events;
}

WhyMissing ExplainMissing(ReplayMonitor& past, const Ask& ask) {
  std::optional<grammar::FrameNumber> at;
  if (ask.time_s) at = past.FrameAt(TickOf(ask, past));
  const std::vector<InstanceId> instances = BindingsThatFit(past, ask.rule, ask.entities);
  if (!instances.empty()) return MissingReasons(past).Explain(instances, at);
  WhyMissing why;
  why.event = past.program().rules[ask.rule].name;
  why.because = "no entities of the episode fit its roles";
  return why;
}

Json ToJson(const WhyEvent& why, Tick ticks_per_second) {
  Json json = {{"event", why.event},
               {"rule", why.where},
               {"begin_tick", why.interval.begin},
               {"end_tick", why.interval.end},
               {"begin_s", truth::SecondsOf(why.interval.begin, ticks_per_second)},
               {"end_s", truth::SecondsOf(why.interval.end, ticks_per_second)},
               {"decided_tick", why.decided},
               {"open_end", why.open_end},
               {"began", ToJson(why.began, ticks_per_second)},
               {"ended", ToJson(why.ended, ticks_per_second)},
               {"counts", ToJson(why.counted, ticks_per_second)},
               {"waited", ToJson(why.waited, ticks_per_second)}};
  AddTo(json, why.decisive);
  return json;
}

Json ToJson(const WhyMissing& why, Tick ticks_per_second) {
  Json json = {{"event", why.event}, {"rule", why.where}, {"happened", false}};
  if (why.expected_at) json["expected_s"] = truth::SecondsOf(*why.expected_at, ticks_per_second);
  json["because"] = why.because;
  AddTo(json, why.decisive);
  json["reasons"] = ToJson(why.reasons, ticks_per_second);
  Json nearest = Json::array();
  for (const WhyEvent& other : why.nearest) {
    nearest.push_back({{"begin_s", truth::SecondsOf(other.interval.begin, ticks_per_second)},
                       {"end_s", truth::SecondsOf(other.interval.end, ticks_per_second)}});
  }
  json["happened_at"] = std::move(nearest);
  return json;
}

std::string InOneLine(const Reasons& reasons) {
  const Reason* first = FirstTurned(reasons);
  if (first == nullptr) return "";
  return first->how.empty() ? first->what : Short(first->what) + " " + first->how;
}

std::string Text(const WhyEvent& why, Tick ticks_per_second) {
  std::string text = fmt::format("{}  {}{}  ({})\n", why.event,
                                 truth::IntervalText(why.interval, ticks_per_second),
                                 why.open_end ? ", open end" : "", why.where);
  text += Tree("  began at " + At(why.interval.begin, ticks_per_second), why.began);
  text += Tree("  ended at " + At(why.interval.end, ticks_per_second), why.ended);
  text += Tree("  counts", why.counted);
  const std::string decided =
      "  decided at " + At(why.decided, ticks_per_second) + ", " + Late(why, ticks_per_second);
  return text + (why.waited.empty() ? decided + "\n" : Tree(decided, why.waited)) +
         Sentence(why.decisive, "not have happened");
}

std::string Text(const WhyMissing& why, Tick ticks_per_second) {
  std::string text = why.event + " did not happen";
  if (why.expected_at) text += " at " + At(*why.expected_at, ticks_per_second);
  text += why.because.empty() ? "\n" : "\n  because " + why.because + "\n";
  text += Sentence(why.decisive, "have happened");
  text += Tree("", why.reasons);
  for (const WhyEvent& other : why.nearest) {
    text +=
        fmt::format("  it happened {}\n", truth::IntervalText(other.interval, ticks_per_second));
  }
  return text;
}

std::string Table(const std::vector<WhyEvent>& events, Tick ticks_per_second) {
  std::vector<std::vector<std::string>> rows = {
      {"event", "begin_s", "end_s", "began", "ended", "decided"}};
  for (const WhyEvent& why : events) {
    rows.push_back({why.event, truth::SecondsText(why.interval.begin, ticks_per_second),
                    truth::SecondsText(why.interval.end, ticks_per_second), InOneLine(why.began),
                    InOneLine(why.ended), Late(why, ticks_per_second)});
  }
  return truth::AlignColumns(rows);
}

using grammar::Limit;
using grammar::NamedEvent;
using grammar::OtherNumbers;
using grammar::Program;

namespace {

/// So many programs are tried at most, and so many frames are looked at.
constexpr double kMostRuns = 1500, kMostFrames = 5e5;
constexpr int kHalvings = 10;

/// Shares by which numbers are changed: by hundredths; where there are many numbers and frames, in
/// steps that grow.
std::vector<double> Shares(std::size_t changes, grammar::FrameNumber frames) {
  const double most = std::min(kMostRuns, kMostFrames / std::max<double>(1, frames));
  const int steps = static_cast<int>(std::clamp(most / std::max<double>(1, changes), 12.0, 99.0));
  std::vector<double> shares;
  for (int i = 0; i < steps; ++i)
    shares.push_back(steps == 99 ? 0.01 * (i + 1) : 0.01 * std::pow(99, i / (steps - 1.0)));
  return shares;
}

/// A limit, changed down or up.
struct Change {
  std::size_t number = 0;
  const Limit* limit;
  bool up = false;
  /// `share` of the larger of both values.
  double At(double share) const {
    const double value = limit->value.value * (up ? 1 / (1 - share) : 1 - share);
    return limit->is_count ? std::round(value) : value;
  }
};

/// With so many digits in the unit that is shown, no nearer to the limit.
double RoundedAway(double value, const grammar::Quantity& limit, int digits) {
  const double unit = limit.dimension.angle == 1 ? std::numbers::pi / 180 : 1;
  const double step = unit * std::pow(10, std::floor(std::log10(value / unit)) - digits + 1);
  return grammar::AsWritten(
      (value > limit.value ? std::ceil(value / step) : std::floor(value / step)) * step);
}

using IsThere = std::function<bool(const NamedEvent&)>;

/// What is known of numbers without trying each. A rule has the same intervals or others, and only
/// by them does it matter to what is made of it: so what a number brings, another one brings with
/// which the rules that have it in their text find the same. Many of those are watched at once.
class Sides {
 public:
  Sides(OtherNumbers& numbers, const Recognise& recognise)
      : numbers_(numbers), recognise_(recognise), in_vain_(numbers.limits().size()) {
    std::vector<OtherNumbers::Trial> as_they_are;
    for (std::size_t i = 0; i < numbers.limits().size(); ++i)
      as_they_are.push_back({i, numbers.limits()[i].value.value});
    Watch(as_they_are);
    for (const OtherNumbers::Trial& trial : as_they_are) InVain(trial);
  }

  /// Looks at these, all at once.
  void Watch(std::span<const OtherNumbers::Trial> trials) {
    if (trials.empty()) return;
    const auto program = numbers_.Side(trials);
    const auto timeline = program ? recognise_(program) : std::nullopt;
    if (!timeline) {  // one that does not compile, or too many
      const std::size_t half = trials.size() / 2;
      if (half == 0) return;
      Watch(trials.first(half));
      return Watch(trials.subspan(half));
    }
    std::vector<std::string> found(trials.size());
    for (const NamedEvent& event : timeline->events) {
      const std::size_t ending = event.event.find('~');
      if (ending == std::string::npos) continue;
      found[std::stoul(event.event.substr(ending + 1))] += fmt::format(
          "{}{} {} {} {};", event.event.substr(0, ending), event.Label().substr(event.event.size()),
          event.interval.begin, event.interval.end, event.open_end);
    }
    for (std::size_t i = 0; i < trials.size(); ++i)
      found_[{trials[i].limit, trials[i].value}] = std::move(found[i]);
  }

  /// It makes no difference, and nor does what finds the same.
  void InVain(const OtherNumbers::Trial& trial) {
    const auto found = found_.find({trial.limit, trial.value});
    if (found != found_.end()) in_vain_[trial.limit].insert(found->second);
  }
  bool IsInVain(const OtherNumbers::Trial& trial) const {
    const auto found = found_.find({trial.limit, trial.value});
    return found != found_.end() && in_vain_[trial.limit].contains(found->second);
  }

 private:
  OtherNumbers& numbers_;
  const Recognise& recognise_;
  std::map<std::pair<std::size_t, double>, std::string> found_;
  std::vector<std::set<std::string>> in_vain_;  ///< by limit
};

/// `came`: the event that the decisive change brings.
std::optional<Decisive> Search(const grammar::ReplayMonitor& past, const std::string& rule,
                               bool wanted, const Recognise& recognise, const IsThere& is_there,
                               std::optional<NamedEvent>& came) {
  OtherNumbers numbers(past.program(), rule);
  const std::vector<Limit>& limits = numbers.limits();
  std::optional<NamedEvent> last;
  const auto works = [&](const Change& change, double value) {
    if (value == change.limit->value.value) return false;
    const auto changed = numbers.With(change.number, value);
    const auto timeline = changed ? recognise(changed) : std::nullopt;
    if (!timeline) return false;
    const auto there = std::ranges::find_if(timeline->events, is_there);
    if ((there != timeline->events.end()) != wanted) return false;
    if (wanted) last = *there;
    return true;
  };
  const Change* best = nullptr;
  double least = 1;
  std::vector<Change> changes;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    changes.push_back({i, &limits[i], false});
    changes.push_back({i, &limits[i], true});
  }
  Sides sides(numbers, recognise);
  double before = 0;
  for (const double share : Shares(changes.size(), past.frames())) {
    std::vector<OtherNumbers::Trial> trials;
    for (const Change& change : changes) trials.push_back({change.number, change.At(share)});
    sides.Watch(trials);
    for (std::size_t i = 0; i < changes.size(); ++i) {
      const Change& change = changes[i];
      if (sides.IsInVain(trials[i])) continue;
      if (!works(change, trials[i].value)) {
        sides.InVain(trials[i]);
        continue;
      }
      double low = before, high = share;
      for (int k = 0; k < kHalvings; ++k) {
        const double middle = (low + high) / 2;
        (works(change, change.At(middle)) ? high : low) = middle;
      }
      if (high >= least) continue;
      least = high;
      best = &change;
      came = last;
    }
    if (best != nullptr) break;
    before = share;
  }
  if (best == nullptr) return std::nullopt;
  const Limit& limit = *best->limit;
  double instead = best->At(least);
  for (int digits = 12; digits > 0; digits -= 3) {
    const double rounded = RoundedAway(best->At(least), limit.value, digits);
    if (works(*best, rounded)) instead = rounded, came = last;
  }
  Decisive decisive{.clause = limit.clause,
                    .rule = limit.owner,
                    .where = Source(limit.file, limit.place),
                    .limit = limit.value.value,
                    .instead = instead,
                    .dimension = limit.value.dimension,
                    .share = least,
                    .param = limit.param};
  for (const Limit& other : limits) {
    if (&other != &limit && !limit.param.empty() && other.param == limit.param)
      decisive.elsewhere.push_back(Source(other.file, other.place));
  }
  return decisive;
}

}  // namespace

bool Answers(const Ask& ask, const Program& program, const grammar::EntityTable& entities,
             const NamedEvent& event) {
  const grammar::Rule& rule = program.rules[ask.rule];
  if (event.event != rule.name) return false;
  const auto plays = [&](std::size_t role, std::size_t as) {
    return ask.entities[role] == grammar::kNone ||
           event.roles[as].value == entities.entities[ask.entities[role]].name;
  };
  bool all = true;
  for (std::size_t role = 0; role < rule.roles.size(); ++role) all = all && plays(role, role);
  if (!all && rule.symmetric) all = plays(0, 1) && plays(1, 0);
  if (!all || !ask.time_s) return all;
  const grammar::Tick tick = truth::TickAt(*ask.time_s, entities.ticks_per_second);
  return event.interval.begin <= tick + 1 && tick <= event.interval.end;
}

void FindDecisive(grammar::ReplayMonitor& past, const Ask& ask, const Recognise& recognise,
                  WhyMissing& why) {
  if (ask.rule == grammar::kTouchingRule) return;
  const Program& program = past.program();
  std::optional<NamedEvent> came;
  Decisive decisive = Search(
                          past, program.rules[ask.rule].name, true, recognise,
                          [&](const NamedEvent& event) {
                            return Answers(ask, program, past.entity_table(), event);
                          },
                          came)
                          .value_or(Decisive());
  if (came && came->Label() != why.event) {
    // What nearly happened, happened to others than those that were taken for the nearest.
    Ask nearer = ask;
    const auto& entities = past.entity_table().entities;
    for (std::size_t role = 0; role < program.rules[ask.rule].roles.size(); ++role) {
      const auto plays =
          std::ranges::find(entities, came->roles[role].value, &grammar::EntityInfo::name);
      if (plays != entities.end())
        nearer.entities[role] = static_cast<int>(plays - entities.begin());
    }
    why = ExplainMissing(past, nearer);
  }
  why.decisive = std::move(decisive);
}

void FindDecisive(const grammar::ReplayMonitor& past, const Ask& ask, const Recognise& recognise,
                  WhyEvent& why) {
  if (ask.rule == grammar::kTouchingRule) return;
  std::optional<NamedEvent> came;
  why.decisive = Search(
                     past, past.program().rules[ask.rule].name, false, recognise,
                     [&](const NamedEvent& event) {
                       return event.Label() == why.event &&
                              event.interval.begin < why.interval.end &&
                              why.interval.begin < event.interval.end;
                     },
                     came)
                     .value_or(Decisive());
}

}  // namespace prehend::show
