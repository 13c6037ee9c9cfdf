// SPDX-License-Identifier: Apache-2.0
// See harness/suite/report/report.h. Tested by tests/harness/suite/report/junit_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "harness/base/base/quoting.h"
#include "harness/suite/report/report.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
namespace {

// The element of a case that tells its outcome; a pass has none.
constexpr const char* kPassed = "";
constexpr const char* kSkipped = "skipped";
constexpr const char* kFailure = "failure";
constexpr const char* kError = "error";

const char* Element(const ScenarioVerdict& verdict) {
  if (verdict.verdict == Verdict::kPassed) return kPassed;
  if (verdict.verdict == Verdict::kUnchanged) return kSkipped;
  const bool broken =
      verdict.exit_code == ExitCode::kFailure || verdict.exit_code == ExitCode::kBadInput;
  return broken ? kError : kFailure;
}

/// What servers show first: the reason, and of differences the first one, with its numbers.
std::string Message(const ScenarioVerdict& verdict) {
  if (!verdict.DiffersFromGolden()) {
    const std::string text = DetailsText(verdict), first = text.substr(0, text.find('\n'));
    const bool says_more = !first.empty() && first != verdict.reason;  // a claim's is its reason
    return says_more ? verdict.reason + "; first: " + first : verdict.reason;
  }
  const grammar::Tick ticks_per_second = verdict.comparison->ticks_per_second;
  const truth::Pairing& difference = *verdict.comparison->FirstDivergence();
  const auto side = [&](const std::optional<grammar::NamedEvent>& event) {
    return event ? truth::IntervalText(event->interval, ticks_per_second) : std::string("nothing");
  };
  std::string text = fmt::format("{}; first: {} {}: expected {}, recognised {}", verdict.reason,
                                 Name(difference.agreement), difference.event().Label(),
                                 side(difference.expected), side(difference.actual));
  if (difference.expected && difference.actual)
    text += fmt::format(", begin {:+.1f} ms, end {:+.1f} ms",
                        truth::MillisecondsOf(difference.begin_offset, ticks_per_second),
                        truth::MillisecondsOf(difference.end_offset, ticks_per_second));
  for (const std::string& change : difference.changes) text += ", " + change;
  return text;
}

void AddOutcome(pugi::xml_node test_case, const ScenarioVerdict& verdict) {
  const char* const element = Element(verdict);
  if (element == kPassed) return;
  if (element == kSkipped) {
    AddElement(test_case, element, {{"message", "nothing changed since it passed"}});
    return;
  }
  AddElement(
      test_case, element,
      {{"type", std::string(Name(verdict.verdict))}, {"message", Message(verdict)}},
      fmt::format("{}{}: {}\n", DetailsText(verdict), CommandLabel(verdict), verdict.command));
}

void AddCase(pugi::xml_node suite, const ScenarioVerdict& verdict) {
  const std::size_t slash = verdict.scenario.rfind('/');
  const bool has_skill = slash != std::string::npos;
  const FirstPlace where = WhereToLook(verdict);
  const pugi::xml_node test_case =
      AddElement(suite, "testcase",
                 {{"classname", has_skill ? verdict.scenario.substr(0, slash) : "scenarios"},
                  {"name", has_skill ? verdict.scenario.substr(slash + 1) : verdict.scenario},
                  {"file", where.file},
                  {"line", std::to_string(where.line)},
                  {"time", fmt::format("{:.3f}", verdict.seconds)}});
  AddOutcome(test_case, verdict);
  const std::string margin = MarginText(verdict);
  if (!margin.empty()) AddElement(test_case, "system-out", {}, margin);
}

}  // namespace

std::string JunitXml(const std::vector<ScenarioVerdict>& verdicts) {
  double seconds = 0;
  for (const ScenarioVerdict& verdict : verdicts) seconds += verdict.seconds;
  const auto count = [&](const char* element) {
    return std::to_string(std::ranges::count(verdicts, element, Element));
  };
  const std::string tests = std::to_string(verdicts.size()), time = fmt::format("{:.3f}", seconds);

  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version").set_value("1.0");
  declaration.append_attribute("encoding").set_value("UTF-8");
  const pugi::xml_node suites = AddElement(document, "testsuites",
                                           {{"name", "prehend"},
                                            {"tests", tests},
                                            {"failures", count(kFailure)},
                                            {"errors", count(kError)},
                                            {"time", time}});
  const pugi::xml_node suite = AddElement(suites, "testsuite",
                                          {{"name", "prehend check"},
                                           {"tests", tests},
                                           {"failures", count(kFailure)},
                                           {"errors", count(kError)},
                                           {"skipped", count(kSkipped)},
                                           {"time", time}});
  for (const ScenarioVerdict& verdict : verdicts) AddCase(suite, verdict);
  return ToText(document, Layout::kIndented);
}

}  // namespace prehend::suite
