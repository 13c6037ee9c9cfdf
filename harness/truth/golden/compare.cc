// SPDX-License-Identifier: Apache-2.0
// Names what became of each event, once the matcher has paired those of equal label. How events lie
// to each other, where that differs from the golden. Boundaries jitter by a frame or two, and with
// them relations like `meets`; so a relation has changed only if some boundary of one event went
// past one of the other by more than the tolerance.
#include "harness/truth/golden/compare.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <tuple>

#include "grammar/base/allen.h"
#include "harness/base/base/quoting.h"
#include "harness/truth/timeline/event_text.h"
#include "harness/truth/timeline/match_events.h"

namespace prehend::truth {
namespace {

using grammar::Interval;
using grammar::NamedEvent;
using grammar::Tick;

/// Events this far apart in time may still be the same one, shifted.
constexpr double kMaxGapBetweenPartners_s = 0.25;
/// Two events that differ in a role are one changed event when they share this much of their common
/// span.
constexpr double kMinSharedSpan = 0.5;

Tick Overlap(Interval a, Interval b) { return std::min(a.end, b.end) - std::max(a.begin, b.begin); }

Tick Distance(Interval a, Interval b) {
  return std::abs(a.begin - b.begin) + std::abs(a.end - b.end);
}

bool AtTheSameTime(Interval a, Interval b) {
  const Tick span = std::max(a.end, b.end) - std::min(a.begin, b.begin);
  return static_cast<double>(Overlap(a, b)) >= kMinSharedSpan * static_cast<double>(span);
}

/// Two numbers of an event agree within 5 % of the expected one, or 0.001 of its unit.
bool ValuesAgree(double expected, double actual) {
  constexpr double kRelative = 0.05, kAbsolute = 0.001;
  if (std::isinf(expected)) return actual == expected;  // the weight of what is fixed
  return std::abs(actual - expected) <= std::max(kRelative * std::abs(expected), kAbsolute);
}

/// "object: milk -> cup" for every role, attribute or ending that differs.
std::vector<std::string> Changes(const NamedEvent& expected, const NamedEvent& actual) {
  std::vector<std::string> changes;
  const auto add = [&](const std::string& name, const std::string& was, const std::string& is) {
    if (was != is)
      changes.push_back(name + ": " + (was.empty() ? "none" : was) + " -> " +
                        (is.empty() ? "none" : is));
  };
  for (const auto& role : expected.roles) add(role.name, role.value, RoleValue(actual, role.name));
  for (const auto& role : actual.roles) {
    if (RoleValue(expected, role.name).empty()) add(role.name, "", role.value);
  }
  if (expected.event != actual.event) add("event", expected.event, actual.event);
  for (const auto& value : expected.values) {
    const auto same_name = [&](const grammar::NamedValue& other) {
      return other.name == value.name;
    };
    const auto found = std::ranges::find_if(actual.values, same_name);
    if (found == actual.values.end()) {
      add(value.name, ValueText(value), "");
    } else if (found->unit != value.unit || !ValuesAgree(value.value, found->value)) {
      add(value.name, ValueText(value), ValueText(*found));
    }
  }
  const auto ending = [](const NamedEvent& event) {
    return event.open_end ? "of the episode" : "of its own";
  };
  add("end", ending(expected), ending(actual));
  return changes;
}

bool SameRoles(const NamedEvent& a, const NamedEvent& b) {
  const auto roles = [](const NamedEvent& event) {
    std::vector<grammar::Role> kept = event.roles;
    std::erase_if(kept, [](const auto& role) { return IsAttribute(role); });
    std::ranges::sort(kept);
    return kept;
  };
  return roles(a) == roles(b);
}

/// How unlike two events of the same time are: the number of roles that differ, attributes aside;
/// more than any such number if it is another event of the same roles; nothing if they have nothing
/// in common.
std::optional<int> Unlikeness(const NamedEvent& expected, const NamedEvent& actual) {
  constexpr int kOtherEvent = 1000;
  if (expected.event != actual.event)
    return SameRoles(expected, actual) ? std::optional(kOtherEvent) : std::nullopt;
  int different = 0;
  bool some_equal = false;
  for (const auto& role : expected.roles) {
    if (IsAttribute(role)) continue;
    const bool equal = RoleValue(actual, role.name) == role.value;
    if (equal) some_equal = true;
    if (!equal) ++different;
  }
  return some_equal ? std::optional(different) : std::nullopt;
}

std::vector<Margin> MarginsOf(const std::vector<Pairing>& pairings) {
  std::vector<Margin> margins;
  for (const Pairing& pairing : pairings) {
    if (pairing.agreement != LineVerdict::kMatched) continue;
    const std::string label = pairing.event().Label();
    margins.push_back({label, false, pairing.begin_offset, pairing.tolerance});
    margins.push_back({label, true, pairing.end_offset, pairing.tolerance});
  }
  return margins;
}

class Pairer {
 public:
  Pairer(const Golden& golden, const grammar::Timeline& actual, Tick default_tolerance)
      : golden_(golden),
        actual_(actual.events),
        expected_taken_(golden.events.size()),
        actual_taken_(actual.events.size()),
        default_tolerance_(default_tolerance),
        ticks_per_second_(actual.ticks_per_second) {
    for (const GoldenEvent& line : golden.events) {
      NamedEvent& event = expected_.emplace_back(line.event);
      event.interval = {Converted(event.interval.begin), Converted(event.interval.end)};
    }
  }

  Comparison Pair() {
    PairEqualLabels();
    PairAcrossLabels();
    for (std::size_t i = 0; i < expected_.size(); ++i) {
      if (!expected_taken_[i]) AddOnlyExpected(LineVerdict::kMissing, i);
    }
    for (std::size_t j = 0; j < actual_.size(); ++j) {
      if (!actual_taken_[j]) AddOnlyActual(LineVerdict::kExtra, j);
    }
    std::stable_sort(
        comparison_.pairings.begin(), comparison_.pairings.end(),
        [](const Pairing& a, const Pairing& b) { return ComesBefore(a.event(), b.event()); });
    comparison_.ticks_per_second = ticks_per_second_;
    comparison_.relations = ChangedRelations(comparison_.pairings);
    comparison_.margins = MarginsOf(comparison_.pairings);
    return std::move(comparison_);
  }

 private:
  /// A tick of the golden in those of the actual timeline.
  Tick Converted(Tick tick) const {
    return TickAt(SecondsOf(tick, golden_.ticks_per_second), ticks_per_second_);
  }

  void PairEqualLabels() {
    const MatchPolicy policy{.max_gap = TickAt(kMaxGapBetweenPartners_s, ticks_per_second_)};
    for (const LabelMatches& label : MatchEvents(expected_, actual_, policy)) {
      const std::size_t first_pair = comparison_.pairings.size();
      for (const auto& [i, j] : label.pairs) AddPair(i, j);
      const std::size_t end_of_pairs = comparison_.pairings.size();
      for (const std::size_t j : label.only_actual)
        AddPiece(LineVerdict::kFragmented, j, first_pair, end_of_pairs);
      for (const std::size_t i : label.only_expected)
        AddPiece(LineVerdict::kMerged, i, first_pair, end_of_pairs);
    }
  }

  /// Of a pair of its label, a recognised event that overlaps the expected one is a piece of it; an
  /// expected event that overlaps the recognised one is merged into it.
  void AddPiece(LineVerdict as, std::size_t k, std::size_t first_pair, std::size_t end_of_pairs) {
    const bool recognised = as == LineVerdict::kFragmented;
    const Interval piece = (recognised ? actual_[k] : expected_[k]).interval;
    for (std::size_t pair = first_pair; pair < end_of_pairs; ++pair) {
      const Interval expected = comparison_.pairings[pair].expected->interval,
                     actual = comparison_.pairings[pair].actual->interval;
      if (Overlap(recognised ? expected : actual, piece) <= 0) continue;
      recognised ? AddOnlyActual(as, k) : AddOnlyExpected(as, k);
      Pairing& pairing = comparison_.pairings[pair];
      if (pairing.pieces.empty()) pairing.pieces.push_back(recognised ? actual : expected);
      pairing.pieces.push_back(piece);
      std::ranges::sort(pairing.pieces, {}, &Interval::begin);
      pairing.agreement = as;
      return;
    }
  }

  /// What is left over, nearest first: fewest roles changed, then closest in time.
  void PairAcrossLabels() {
    std::vector<std::tuple<int, Tick, std::size_t, std::size_t>> candidates;
    for (std::size_t i = 0; i < expected_.size(); ++i) {
      for (std::size_t j = 0; j < actual_.size(); ++j) {
        if (expected_taken_[i] || actual_taken_[j]) continue;
        const Interval a = expected_[i].interval, b = actual_[j].interval;
        const std::optional<int> unlike = Unlikeness(expected_[i], actual_[j]);
        if (unlike && AtTheSameTime(a, b)) candidates.emplace_back(*unlike, Distance(a, b), i, j);
      }
    }
    std::sort(candidates.begin(), candidates.end());
    for (const auto& [unlike, distance, i, j] : candidates) {
      if (!expected_taken_[i] && !actual_taken_[j]) AddPair(i, j);
    }
  }

  void AddPair(std::size_t i, std::size_t j) {
    const NamedEvent &expected = expected_[i], &actual = actual_[j];
    Pairing pairing{.agreement = LineVerdict::kMatched,
                    .expected = expected,
                    .actual = actual,
                    .golden_line = i,
                    .begin_offset = actual.interval.begin - expected.interval.begin,
                    .end_offset = actual.interval.end - expected.interval.end,
                    .tolerance = ToleranceOf(golden_.events[i]),
                    .changes = Changes(expected, actual)};
    const Tick off = std::max(std::abs(pairing.begin_offset), std::abs(pairing.end_offset));
    if (expected.event != actual.event) {
      pairing.agreement = LineVerdict::kRelabelled;
    } else if (!pairing.changes.empty()) {
      pairing.agreement = LineVerdict::kChanged;
    } else if (off > pairing.tolerance) {
      pairing.agreement = LineVerdict::kShifted;
    }
    expected_taken_[i] = actual_taken_[j] = true;
    comparison_.pairings.push_back(std::move(pairing));
  }

  double ToleranceOf(const GoldenEvent& line) const {
    return line.tolerance_ms ? static_cast<double>(*line.tolerance_ms * ticks_per_second_) / 1000
                             : static_cast<double>(default_tolerance_);
  }

  void AddOnlyExpected(LineVerdict agreement, std::size_t i) {
    expected_taken_[i] = true;
    comparison_.pairings.push_back(
        {.agreement = agreement, .expected = expected_[i], .golden_line = i});
  }

  void AddOnlyActual(LineVerdict agreement, std::size_t j) {
    actual_taken_[j] = true;
    comparison_.pairings.push_back({.agreement = agreement, .expected = {}, .actual = actual_[j]});
  }

  const Golden& golden_;
  std::vector<NamedEvent> expected_;  ///< of the golden, in the ticks of the actual timeline
  const std::vector<NamedEvent>& actual_;
  std::vector<bool> expected_taken_, actual_taken_;
  Tick default_tolerance_;
  Tick ticks_per_second_;
  Comparison comparison_;
};

/// Values of the roles, sorted; attributes are left out.
std::vector<std::string> Entities(const NamedEvent& event) {
  std::vector<std::string> entities;
  for (const auto& role : event.roles) {
    if (!IsAttribute(role)) entities.push_back(role.value);
  }
  std::ranges::sort(entities);
  return entities;
}

/// Both sides exist, each in one piece.
bool IsWholePair(const Pairing& pairing) {
  return pairing.expected && pairing.actual && pairing.pieces.empty();
}

/// Whether two boundaries changed their order, and lie clearly apart in one of the timelines.
bool Swapped(Tick expected_gap, Tick actual_gap, double tolerance) {
  const auto sign = [](Tick gap) { return (gap > 0) - (gap < 0); };
  return sign(expected_gap) != sign(actual_gap) &&
         std::max(std::abs(expected_gap), std::abs(actual_gap)) > tolerance;
}

bool ClearlyChanged(const Pairing& p, const Pairing& q) {
  const double tolerance = std::max(p.tolerance, q.tolerance);
  for (const auto of_p : {&Interval::begin, &Interval::end}) {
    for (const auto of_q : {&Interval::begin, &Interval::end}) {
      if (Swapped(p.expected->interval.*of_p - q.expected->interval.*of_q,
                  p.actual->interval.*of_p - q.actual->interval.*of_q, tolerance))
        return true;
    }
  }
  return false;
}

std::string Relation(const NamedEvent& a, const NamedEvent& b) {
  return std::string(
      grammar::kAllenNames[static_cast<std::size_t>(grammar::Relate(a.interval, b.interval))]);
}

// A comparison in words. A comparison for programs.

/// "begin +50.0 ms, end -2.1 ms (tolerance 8.3 ms)"
std::string OffsetText(const Pairing& pairing, Tick ticks_per_second) {
  return fmt::format("begin {:+.1f} ms, end {:+.1f} ms (tolerance {:.1f} ms)",
                     MillisecondsOf(pairing.begin_offset, ticks_per_second),
                     MillisecondsOf(pairing.end_offset, ticks_per_second),
                     MillisecondsOf(pairing.tolerance, ticks_per_second));
}

/// "3 pieces: 1.0000..1.2000 s, .."
std::string PiecesText(const std::vector<grammar::Interval>& pieces, Tick ticks_per_second) {
  std::vector<std::string> texts;
  for (const grammar::Interval& piece : pieces)
    texts.push_back(IntervalText(piece, ticks_per_second));
  return fmt::format("{} pieces: {}", pieces.size(), fmt::join(texts, ", "));
}

/// "" without a command.
std::string WhyText(std::string_view command, const Pairing& pairing, Tick ticks_per_second) {
  return command.empty() ? ""
                         : std::string(command) + " " + QuestionAbout(pairing, ticks_per_second);
}

std::string PairingText(const Pairing& pairing, Tick ticks_per_second, const std::string& why,
                        std::string_view facts) {
  const auto side = [&](const std::optional<grammar::NamedEvent>& event) {
    const bool is_actual = &event == &pairing.actual;
    const bool in_pieces =
        !pairing.pieces.empty() && is_actual == (pairing.agreement == LineVerdict::kFragmented);
    if (in_pieces) return PiecesText(pairing.pieces, ticks_per_second);
    return event ? IntervalText(event->interval, ticks_per_second) : std::string("nothing");
  };
  std::string text = fmt::format("{} {}\n", Name(pairing.agreement), pairing.event().Label());
  text +=
      fmt::format("  expected {}, recognised {}\n", side(pairing.expected), side(pairing.actual));
  if (pairing.expected && pairing.actual && pairing.pieces.empty())
    text += fmt::format("  {}\n", OffsetText(pairing, ticks_per_second));
  if (!pairing.changes.empty()) text += fmt::format("  {}\n", fmt::join(pairing.changes, ", "));
  text += facts;
  if (!why.empty()) text += fmt::format("  why: {}\n", why);
  return text;
}

using Json = nlohmann::ordered_json;

Json SideJson(const std::optional<grammar::NamedEvent>& event, Tick ticks_per_second) {
  if (!event) return nullptr;
  Json json = EventJson(*event, ticks_per_second);
  json.erase("decided_tick");  // a golden does not say it
  return json;
}

Json PairingJson(const Pairing& pairing, Tick ticks_per_second, std::string_view command) {
  const auto offset_ms = [&](double ticks) {
    return pairing.expected && pairing.actual ? Json(MillisecondsOf(ticks, ticks_per_second))
                                              : Json(nullptr);
  };
  const auto seconds = [&](Tick tick) { return MillisecondsOf(tick, ticks_per_second) / 1000; };
  Json pieces = Json::array();
  for (const grammar::Interval& piece : pairing.pieces)
    pieces.push_back({{"begin_s", seconds(piece.begin)}, {"end_s", seconds(piece.end)}});
  return {{"kind", Name(pairing.agreement)},
          {"event", pairing.event().event},
          {"expected", SideJson(pairing.expected, ticks_per_second)},
          {"recognised", SideJson(pairing.actual, ticks_per_second)},
          {"begin_ms", offset_ms(pairing.begin_offset)},
          {"end_ms", offset_ms(pairing.end_offset)},
          {"tolerance_ms", offset_ms(pairing.tolerance)},
          {"changes", pairing.changes},
          {"pieces", std::move(pieces)},
          {"why", WhyText(command, pairing, ticks_per_second)}};
}

}  // namespace

Comparison::Comparison() = default;
Comparison::Comparison(const Comparison& other) = default;
Comparison::Comparison(Comparison&& other) noexcept = default;
Comparison& Comparison::operator=(const Comparison& other) = default;
Comparison& Comparison::operator=(Comparison&& other) noexcept = default;
Comparison::~Comparison() = default;

bool Pairing::IsFurtherPiece() const {
  return pieces.empty() &&
         (agreement == LineVerdict::kFragmented || agreement == LineVerdict::kMerged);
}

Tick Pairing::DivergenceTick() const {
  if (!expected || !actual) return event().interval.begin;
  const Interval was = expected->interval, is = actual->interval;
  if (agreement == LineVerdict::kFragmented || agreement == LineVerdict::kMerged)
    return pieces.front().end;
  const bool only_the_end = expected->Label() == actual->Label() &&
                            std::abs(begin_offset) <= tolerance && std::abs(end_offset) > tolerance;
  return only_the_end ? std::min(was.end, is.end) : std::min(was.begin, is.begin);
}

const Margin* Comparison::Smallest() const {
  const Margin* smallest = nullptr;
  for (const Margin& margin : margins) {
    if (margin.offset != 0 && (!smallest || margin.Left() < smallest->Left())) smallest = &margin;
  }
  return smallest;
}

std::vector<const Pairing*> Comparison::Differing() const {
  std::vector<const Pairing*> differing;
  for (const Pairing& pairing : pairings) {
    if (pairing.agreement != LineVerdict::kMatched && !pairing.IsFurtherPiece())
      differing.push_back(&pairing);
  }
  std::ranges::stable_sort(differing, {}, &Pairing::DivergenceTick);
  return differing;
}

const Pairing* Comparison::FirstDivergence() const {
  const std::vector<const Pairing*> differing = Differing();
  return differing.empty() ? nullptr : differing.front();
}

bool Comparison::Agrees() const {
  return Count(LineVerdict::kMatched) == static_cast<int>(pairings.size());
}

int Comparison::Count(LineVerdict agreement) const {
  return static_cast<int>(
      std::count_if(pairings.begin(), pairings.end(),
                    [&](const Pairing& pairing) { return pairing.agreement == agreement; }));
}

Comparison Compare(const Golden& expected, const grammar::Timeline& actual,
                   Tick default_tolerance) {
  return Pairer(expected, actual, default_tolerance).Pair();
}

std::vector<RelationChange> ChangedRelations(const std::vector<Pairing>& pairings) {
  std::vector<RelationChange> changes;
  for (std::size_t i = 0; i < pairings.size(); ++i) {
    for (std::size_t j = i + 1; j < pairings.size(); ++j) {
      const Pairing &p = pairings[i], &q = pairings[j];
      if (!IsWholePair(p) || !IsWholePair(q)) continue;
      if (p.agreement == LineVerdict::kMatched && q.agreement == LineVerdict::kMatched) continue;
      if (Entities(*p.expected) != Entities(*q.expected) || !ClearlyChanged(p, q)) continue;
      changes.push_back({p.expected->Label(), q.expected->Label(),
                         Relation(*p.expected, *q.expected), Relation(*p.actual, *q.actual)});
    }
  }
  return changes;
}

std::string_view Name(LineVerdict agreement) {
  constexpr std::array<std::string_view, 8> kNames = {
      "matched", "shifted", "changed", "relabelled", "fragmented", "merged", "missing", "extra"};
  return kNames.at(static_cast<std::size_t>(agreement));
}

// Asks why an event is as it is, or why it is missing; of a fragmented event about the first
// fragment, which ends where the event broke.
std::string QuestionAbout(const Pairing& pairing, Tick ticks_per_second) {
  const grammar::NamedEvent& event = pairing.actual ? *pairing.actual : *pairing.expected;
  const bool in_pieces = pairing.agreement == LineVerdict::kFragmented && !pairing.pieces.empty();
  const Tick begin = in_pieces ? pairing.pieces.front().begin : event.interval.begin;
  return (pairing.actual ? "--event " : "--expected ") +
         ShellQuoted(AskedAs(event) + " @" + SecondsText(begin, ticks_per_second) + "s");
}

std::string AskedAs(const grammar::NamedEvent& event) {
  std::string text = event.event;
  for (const grammar::Role& role : event.roles)
    if (!IsAttribute(role)) text += " " + role.value;
  return text;
}

std::string DifferenceText(const Comparison& comparison, std::string_view command,
                           std::string_view facts) {
  return DifferenceText(
      comparison,
      [&](const Pairing& of) { return WhyText(command, of, comparison.ticks_per_second); }, facts);
}

std::string DifferenceText(const Comparison& comparison,
                           const std::function<std::string(const Pairing&)>& why,
                           std::string_view facts) {
  const std::vector<const Pairing*> differing = comparison.Differing();
  std::string text;
  for (const Pairing* pairing : differing) {
    text += PairingText(*pairing, comparison.ticks_per_second, why(*pairing),
                        pairing == differing.front() ? facts : std::string_view());
  }
  for (const RelationChange& change : comparison.relations) {
    text += fmt::format("relation {} {} {}: now {}\n", change.first, change.expected, change.second,
                        change.actual);
  }
  return text;
}

std::string MarginText(const Comparison& comparison) {
  if (comparison.margins.empty()) return "";
  const Margin* smallest = comparison.Smallest();
  if (!smallest) return "margin: all boundaries match exactly";
  const auto ms = [&](double ticks) { return MillisecondsOf(ticks, comparison.ticks_per_second); };
  if (smallest->Left() == 0)
    return fmt::format("passed at the limit: {} {} {:.1f} ms off (tolerance {:.1f} ms)",
                       smallest->label, smallest->at_end ? "ends" : "begins",
                       ms(std::abs(smallest->offset)), ms(smallest->tolerance));
  return fmt::format("margin: {:.1f} of {:.1f} ms left at {}", ms(smallest->Left()),
                     ms(smallest->tolerance), smallest->Boundary());
}

Json DifferencesJson(const Comparison& comparison, std::string_view command) {
  Json differences = Json::array();
  for (const Pairing* pairing : comparison.Differing())
    differences.push_back(PairingJson(*pairing, comparison.ticks_per_second, command));
  return differences;
}

Json RelationsJson(const Comparison& comparison) {
  Json relations = Json::array();
  for (const RelationChange& change : comparison.relations) {
    relations.push_back({{"first", change.first},
                         {"second", change.second},
                         {"expected", change.expected},
                         {"recognised", change.actual}});
  }
  return relations;
}

}  // namespace prehend::truth
