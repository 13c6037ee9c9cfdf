// SPDX-License-Identifier: Apache-2.0
#include "harness/measure/score/evaluators.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "harness/truth/timeline/event_text.h"
#include "harness/truth/timeline/match_events.h"

namespace prehend::measure {

Confirmed& Confirmed::operator+=(const Confirmed& more) {
  of += more.of;
  confirmed += more.confirmed;
  return *this;
}

Confirmed Evaluation::Total() const {
  Confirmed total;
  for (const auto& [event, count] : by_event) total += count;
  return total;
}

Evaluation& Evaluation::operator+=(const Evaluation& more) {
  for (const auto& [event, count] : more.by_event) by_event[event] += count;
  differences.insert(differences.end(), more.differences.begin(), more.differences.end());
  return *this;
}

Evaluation ByDefinitions(const std::string& scenario, std::span<const grammar::Timeline> possible,
                         const grammar::Timeline& found, grammar::Tick tolerance) {
  Evaluation evaluation;
  const auto differs = [&](const std::string& label, const std::string& what) {
    evaluation.differences.push_back(fmt::format("{}  {}  {}", scenario, label, what));
  };
  const auto when = [&](const grammar::NamedEvent& event) {
    return truth::IntervalText(event.interval, found.ticks_per_second);
  };
  for (const truth::LabelAgreement& label : truth::AgreeWithin(possible, found, tolerance).labels) {
    for (const truth::Match& match : label.matches) {
      Confirmed& count = evaluation.by_event[match.found.event];
      ++count.of;
      if (std::max(std::abs(match.begin_offset()), std::abs(match.end_offset())) <= tolerance)
        ++count.confirmed;
      else
        differs(label.label, fmt::format("recognised {}, by the definitions {}", when(match.found),
                                         when(match.truth)));
    }
    for (const grammar::NamedEvent& event : label.extra) {
      ++evaluation.by_event[event.event].of;
      differs(label.label, fmt::format("recognised {}, not by the definitions", when(event)));
    }
    for (const grammar::NamedEvent& event : label.missing) {
      ++evaluation.by_event[event.event].of;
      differs(label.label, fmt::format("not recognised, by the definitions {}", when(event)));
    }
  }
  return evaluation;
}

Evaluation ByClaims(const std::string& scenario, std::span<const truth::ClaimVerdict> verdicts) {
  Evaluation evaluation;
  for (const truth::ClaimVerdict& verdict : verdicts) {
    if (verdict.says == truth::kNotJudged) continue;
    Confirmed& count = evaluation.by_event["claims"];
    ++count.of;
    if (verdict.says == truth::kHolds)
      ++count.confirmed;
    else
      evaluation.differences.push_back(scenario + "  " + Text(verdict));
  }
  return evaluation;
}

std::string EvaluatorTable(const std::vector<std::string>& grammars,
                           const std::vector<Evaluator>& evaluators) {
  std::string text = "| evaluator |", rule = "|---|";
  for (const std::string& grammar : grammars) {
    text += fmt::format(" {} |", grammar);
    rule += "---|";
  }
  text += " what it proves |\n" + rule + "---|\n";
  for (const Evaluator& evaluator : evaluators) {
    text += fmt::format("| {} |", evaluator.name);
    for (const Evaluation& evaluation : evaluator.of_grammars) {
      const Confirmed total = evaluation.Total();
      text += total.of == 0 ? std::string(" - |")
                            : fmt::format(" {} of {} ({:.1f} %) |", total.confirmed, total.of,
                                          100.0 * total.confirmed / total.of);
    }
    text += fmt::format(" {} |\n", evaluator.proves);
  }
  return text;
}

}  // namespace prehend::measure
