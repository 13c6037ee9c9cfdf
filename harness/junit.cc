// SPDX-License-Identifier: Apache-2.0
// See junit.h. Tested by tests/harness/junit_test.cc
#include "harness/junit.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "harness/event_text.h"
#include "harness/timeline_svg.h"

namespace prehend::harness {
namespace {

/// For attributes and content; what XML 1.0 cannot hold is left out.
std::string EscapeXml(std::string_view text) {
  std::string allowed;
  std::ranges::copy_if(text, std::back_inserter(allowed),
                       [](unsigned char c) { return c >= 0x20 || c == '\n' || c == '\t'; });
  return EscapeHtml(allowed);
}

/// What a case came to: "failure", "error", "skipped", or "" for a pass.
std::string_view Element(const ScenarioVerdict& verdict) {
  if (verdict.verdict == Verdict::kPassed) return "";
  if (verdict.verdict == Verdict::kUnchanged) return "skipped";
  const bool broken =
      verdict.exit_code == ExitCode::kFailure || verdict.exit_code == ExitCode::kBadInput;
  return broken ? "error" : "failure";
}

/// What servers show first: the reason, and of differences the first one, with its numbers.
std::string Message(const ScenarioVerdict& verdict) {
  if (!verdict.DiffersFromGolden()) {
    const std::string first = verdict.details.substr(0, verdict.details.find('\n'));
    return first.empty() ? verdict.reason : verdict.reason + "; first: " + first;
  }
  const grammar::Tick ticks_per_second = verdict.comparison->ticks_per_second;
  const Pairing& difference = *verdict.comparison->FirstDivergence();
  const auto side = [&](const std::optional<grammar::NamedEvent>& event) {
    return event ? IntervalText(event->interval, ticks_per_second) : std::string("nothing");
  };
  std::string text = fmt::format("{}; first: {} {}: expected {}, recognised {}", verdict.reason,
                                 Name(difference.agreement), difference.event().Label(),
                                 side(difference.expected), side(difference.actual));
  if (difference.expected && difference.actual)
    text += fmt::format(", begin {:+.1f} ms, end {:+.1f} ms",
                        MillisecondsOf(difference.begin_offset, ticks_per_second),
                        MillisecondsOf(difference.end_offset, ticks_per_second));
  for (const std::string& change : difference.changes) text += ", " + change;
  return text;
}

std::string Outcome(const ScenarioVerdict& verdict) {
  const std::string_view element = Element(verdict);
  if (element.empty()) return "";
  if (element == "skipped") return "      <skipped message=\"nothing changed since it passed\"/>\n";
  return fmt::format("      <{0} type=\"{1}\" message=\"{2}\">{3}{4}: {5}\n</{0}>\n", element,
                     Name(verdict.verdict), EscapeXml(Message(verdict)), EscapeXml(verdict.details),
                     CommandLabel(verdict), EscapeXml(verdict.command));
}

std::string Case(const ScenarioVerdict& verdict) {
  const std::size_t slash = verdict.scenario.rfind('/');
  const std::string skill =
      slash == std::string::npos ? "scenarios" : verdict.scenario.substr(0, slash);
  const std::string name =
      slash == std::string::npos ? verdict.scenario : verdict.scenario.substr(slash + 1);
  std::string xml =
      fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\">\n{}",
                  EscapeXml(skill), EscapeXml(name), verdict.seconds, Outcome(verdict));
  const std::string margin = MarginText(verdict);
  if (!margin.empty()) xml += fmt::format("      <system-out>{}</system-out>\n", EscapeXml(margin));
  return xml + "    </testcase>\n";
}

}  // namespace

std::string JunitXml(const std::vector<ScenarioVerdict>& verdicts) {
  double seconds = 0;
  std::string cases;
  for (const ScenarioVerdict& verdict : verdicts) {
    seconds += verdict.seconds;
    cases += Case(verdict);
  }
  const auto count = [&](std::string_view element) {
    return std::ranges::count_if(
        verdicts, [&](const ScenarioVerdict& verdict) { return Element(verdict) == element; });
  };
  const std::string totals = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\"",
                                         verdicts.size(), count("failure"), count("error"));
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<testsuites name=\"prehend\" {0} time=\"{1:.3f}\">\n"
      "  <testsuite name=\"prehend check\" {0} skipped=\"{2}\" time=\"{1:.3f}\">\n"
      "{3}  </testsuite>\n</testsuites>\n",
      totals, seconds, count("skipped"), cases);
}

}  // namespace prehend::harness
