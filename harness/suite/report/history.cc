// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/quoting.h"
#include "harness/base/process/child_process.h"
#include "harness/suite/report/report.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
namespace {

using PastJson = nlohmann::json;

/// Of a scenario: [VERDICT, SECONDS, MARGIN or null].
PastJson AsJson(const PastVerdict& past) {
  return {past.verdict, std::round(1000 * past.seconds) / 1000,
          past.margin_ms ? PastJson(std::round(100 * *past.margin_ms) / 100) : PastJson()};
}

// What stands above a report: see HeaderOf() in harness/suite/report/report.h. Tested by
// tests/program/report_command_test.cc

/// Of a tool's answer, or "" if it failed.
std::string FirstLine(const std::vector<std::string>& words) {
  const ToolResult said = RunTool(words, "", {.time_s = 5});
  return said.Succeeded() ? said.out.substr(0, said.out.find('\n')) : "";
}

std::string CommitOf(const std::string& root) {
  const std::string commit = FirstLine({"git", "-C", root, "rev-parse", "--short=10", "HEAD"});
  if (commit.empty()) return "";
  const bool is_changed =
      !FirstLine({"git", "-C", root, "status", "--porcelain", "--untracked-files=no"}).empty();
  return commit + (is_changed ? ", with changes" : "");
}

/// "Linux 6.1.0 x86_64, 2 processors (AMD EPYC 7B13)"
std::string MachineText() {
  utsname system{};
  if (uname(&system) != 0) return "";
  std::string processor;
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; processor.empty() && std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos)
      processor = " (" + line.substr(colon + 2) + ")";
  }
  const long count = sysconf(_SC_NPROCESSORS_ONLN);
  return fmt::format("{} {} {}, {} processor{}{}", system.sysname, system.release, system.machine,
                     count, count == 1 ? "" : "s", processor);
}

// See harness/suite/report/report.h. Tested by tests/harness/suite/report/junit_test.cc

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

PastRun RunOf(const std::vector<ScenarioVerdict>& verdicts, const std::string& date,
              const std::string& commit) {
  PastRun run{.date = date, .commit = commit, .scenarios = {}};
  for (const ScenarioVerdict& verdict : verdicts) {
    if (verdict.verdict == Verdict::kUnchanged) continue;  // it was not run
    PastVerdict& past = run.scenarios[verdict.scenario];
    past = {.verdict = std::string(Name(verdict.verdict)), .seconds = verdict.seconds};
    const truth::Margin* smallest =
        verdict.has_golden && verdict.comparison ? verdict.comparison->Smallest() : nullptr;
    if (smallest)
      past.margin_ms =
          truth::MillisecondsOf(smallest->Left(), verdict.comparison->ticks_per_second);
  }
  return run;
}

std::vector<PastRun> ReadHistory(const std::string& file) {
  std::vector<PastRun> runs;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return runs;
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    try {
      const auto json = PastJson::parse(line);
      PastRun run{.date = json.at("date"), .commit = json.at("commit"), .scenarios = {}};
      for (const auto& [scenario, past] : json.at("scenarios").items()) {
        PastVerdict& one = run.scenarios[scenario];
        one = {.verdict = past.at(0), .seconds = past.at(1)};
        if (!past.at(2).is_null()) one.margin_ms = past.at(2).get<double>();
      }
      runs.push_back(std::move(run));
    } catch (const PastJson::exception&) {
    }
  }
  if (runs.size() > kMostPastRuns)
    runs.erase(runs.begin(), runs.end() - static_cast<std::ptrdiff_t>(kMostPastRuns));
  return runs;
}

std::string WriteHistory(const std::string& file, const std::vector<PastRun>& runs) {
  std::string text;
  for (std::size_t i = runs.size() - std::min(runs.size(), kMostPastRuns); i < runs.size(); ++i) {
    PastJson scenarios = PastJson::object();
    for (const auto& [scenario, past] : runs[i].scenarios) scenarios[scenario] = AsJson(past);
    const PastJson line = {
        {"date", runs[i].date}, {"commit", runs[i].commit}, {"scenarios", std::move(scenarios)}};
    text += line.dump(-1, ' ', false, PastJson::error_handler_t::replace) + "\n";
  }
  return WriteTextFile(file, text);
}

nlohmann::json HistoryJson(const std::vector<PastRun>& runs) {
  PastJson names = PastJson::array(), of = PastJson::object();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    names.push_back(runs[i].date + (runs[i].commit.empty() ? "" : ", " + runs[i].commit));
    for (const auto& [scenario, past] : runs[i].scenarios) {
      PastJson one = AsJson(past);
      one.insert(one.begin(), i);
      of[scenario].push_back(std::move(one));
    }
  }
  return {{"runs", std::move(names)}, {"of", std::move(of)}};
}

ReportHeader HeaderOf(const std::string& command, const std::string& root,
                      const std::string& date) {
  return {.command = command, .date = date, .commit = CommitOf(root), .machine = MachineText()};
}

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
