// SPDX-License-Identifier: Apache-2.0
// See harness/junit.h. Tested by tests/harness/junit_test.cc
#include "harness/junit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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

/// "0.0042..0.3021 s", or "nothing".
std::string SideText(const nlohmann::ordered_json& side) {
  if (side.is_null()) return "nothing";
  return fmt::format("{:.4f}..{:.4f} s", side.at("begin_s").get<double>(),
                     side.at("end_s").get<double>());
}

/// "supported_by(carton, table)"
std::string LabelOf(const nlohmann::ordered_json& difference) {
  const nlohmann::ordered_json& side =
      difference.at(difference.at("expected").is_null() ? "recognised" : "expected");
  std::vector<std::string> roles;
  for (const auto& [name, value] : side.at("roles").items())
    roles.push_back(value.get<std::string>());
  return fmt::format("{}({})", difference.at("event").get<std::string>(), fmt::join(roles, ", "));
}

/// What servers show first: the reason, and of differences the first one, with its numbers.
std::string Message(const ScenarioVerdict& verdict) {
  if (verdict.differences.empty()) {
    const std::string first = verdict.details.substr(0, verdict.details.find('\n'));
    return first.empty() ? verdict.reason : verdict.reason + "; first: " + first;
  }
  const nlohmann::ordered_json& difference = verdict.differences.front();
  std::string text =
      fmt::format("{}; first: {} {}: expected {}, recognised {}", verdict.reason,
                  difference.at("kind").get<std::string>(), LabelOf(difference),
                  SideText(difference.at("expected")), SideText(difference.at("recognised")));
  if (!difference.at("begin_ms").is_null())
    text +=
        fmt::format(", begin {:+.1f} ms, end {:+.1f} ms", difference.at("begin_ms").get<double>(),
                    difference.at("end_ms").get<double>());
  for (const auto& change : difference.at("changes")) text += ", " + change.get<std::string>();
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
  if (!verdict.headroom.empty())
    xml += fmt::format("      <system-out>{}</system-out>\n", EscapeXml(verdict.headroom));
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
