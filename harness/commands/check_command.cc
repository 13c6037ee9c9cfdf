// SPDX-License-Identifier: Apache-2.0
// prehend check: the regression suite. Tested by tests/house/command_line_test.cc
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "harness/check_scenario.h"
#include "harness/commands/command.h"
#include "harness/golden_files.h"
#include "harness/report.h"
#include "harness/select_scenarios.h"
#include "harness/worker_pool.h"

namespace prehend::harness {
namespace {

namespace fs = std::filesystem;

#ifdef __SANITIZE_ADDRESS__
constexpr std::uint64_t kWorkerMemory_bytes = 0;  // shadow memory is larger than any limit
#else
constexpr std::uint64_t kWorkerMemory_bytes = 4ull << 30;
#endif
constexpr double kDefaultTimeLimit_s = 120;
constexpr int kMaxJobs = 256;

void Declare(CLI::App& options) {
  options.add_option("names", "names, skill/name or globs; nothing: all")
      ->expected(-1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  options.add_option("--filter", "only those that match this glob, or have tag:NAME")
      ->type_name("GLOB|tag:NAME")
      ->expected(1);
  options.add_option("--jobs,-j", "processes at a time; otherwise one per core")
      ->type_name("N")
      ->expected(1)
      ->check(CLI::Range(1, kMaxJobs));
  options.add_option("--time-limit", "seconds that one scenario may take; otherwise 120")
      ->type_name("S")
      ->expected(1)
      ->check(CLI::Range(0.1, 86400.0));
  options.add_option("--report", "folder for index.html and pictures; otherwise build/report")
      ->type_name("DIR")
      ->expected(1);
  DeclareFlag(options, "--no-pictures", "do not draw");
  DeclareFlag(options, "--json", "one JSON object instead of text");
  DeclareRunOptions(options);
}

ScenarioVerdict OrphanVerdict(const std::string& id, const GoldenFiles& files) {
  return {.scenario = id,
          .shows = {},
          .verdict = Verdict::kFailed,
          .exit_code = ExitCode::kDiffers,
          .reason = "a golden without scenario",
          .details =
              fmt::format("{} belongs to no scenario: remove it, or bring scenarios/{}.yaml back\n",
                          files.GoldenPath(id).string(), id),
          .headroom = {},
          .command = "prehend check"};
}

ScenarioVerdict VerdictOf(const CLI::App& options, const std::string& id,
                          const WorkerResult& result) {
  if (result.finished) {
    ScenarioVerdict verdict = VerdictFromJson(nlohmann::ordered_json::parse(result.output));
    verdict.seconds = result.seconds;
    return verdict;
  }
  return {.scenario = id,
          .shows = {},
          .verdict = Verdict::kFailed,
          .exit_code = ExitCode::kFailure,
          .reason = "its process ended: " + result.reason,
          .details = {},
          .headroom = {},
          .command = ExplainCommand(id, RequestOf(options, {})),
          .seconds = result.seconds};
}

std::vector<ScenarioVerdict> CheckAll(const CLI::App& options, const CommandContext& context,
                                      const ScenarioSelection& selection,
                                      const std::string& report_folder) {
  const bool own_rules = IsGiven(options, "--grammar") || IsGiven(options, "--set");
  std::vector<WorkerJob> jobs;
  std::vector<std::string> ids;
  for (const ScenarioFile& file : selection.scenarios) {
    ids.push_back(ScenarioId(file.skill, file.name));
    const CheckRequest request{.run = RequestOf(options, file.path),
                               .id = ids.back(),
                               .root = context.root,
                               .report_folder = report_folder,
                               .pictures = !IsGiven(options, "--no-pictures"),
                               .write_pending = !own_rules};
    jobs.push_back([request] { return ToJson(CheckScenario(request)).dump(); });
  }
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const WorkerLimits limits{.jobs = std::stoi(ValueOf(options, "--jobs", std::to_string(cores))),
                            .time_limit_s = std::stod(ValueOf(options, "--time-limit",
                                                              std::to_string(kDefaultTimeLimit_s))),
                            .memory_limit_bytes = kWorkerMemory_bytes};
  std::size_t done = 0;
  const auto results = RunInWorkers(jobs, limits, [&](std::size_t job, const WorkerResult&) {
    if (context.progress)
      context.err << fmt::format("\r\033[K[{}/{}] {}", ++done, jobs.size(), ids[job]) << std::flush;
  });
  if (context.progress) context.err << "\r\033[K" << std::flush;

  std::vector<ScenarioVerdict> verdicts;
  for (std::size_t i = 0; i < results.size(); ++i)
    verdicts.push_back(VerdictOf(options, ids[i], results[i]));
  for (const std::string& orphan : selection.orphans)
    verdicts.push_back(OrphanVerdict(orphan, GoldenFiles(context.root)));
  return verdicts;
}

std::string Indented(const std::string& text) {
  std::string indented;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    indented += "    " + text.substr(begin, end - begin) + "\n";
    begin = end + 1;
  }
  return indented;
}

std::string Colored(Verdict verdict, bool colored) {
  const std::string name(Name(verdict));
  if (!colored) return name;
  const int color = verdict == Verdict::kPassed ? 32 : verdict == Verdict::kFailed ? 31 : 33;
  return fmt::format("\033[{}m{}\033[0m", color, name);
}

void PrintText(const std::vector<ScenarioVerdict>& verdicts, const std::string& page,
               const CommandContext& context) {
  for (const ScenarioVerdict& verdict : verdicts) {
    const std::string& note = verdict.reason.empty() ? verdict.headroom : verdict.reason;
    context.out << fmt::format("{}  {}{}{}\n", Colored(verdict.verdict, context.colored),
                               verdict.scenario, note.empty() ? "" : "  ", note);
    if (verdict.verdict == Verdict::kPassed) continue;
    context.out << Indented(verdict.details);
    context.out << "    again: " << verdict.command << "\n";
  }
  const Tally tally = Count(verdicts);
  context.out << "report: " << page << "\n";
  if (tally.pending > 0)
    context.out << fmt::format("{} pending: accept with a reason, or mend\n", tally.pending);
  context.out << fmt::format("{} passed, {} failed\n", tally.passed, tally.failed);
}

nlohmann::ordered_json SummaryJson(const std::vector<ScenarioVerdict>& verdicts,
                                   const std::string& page) {
  const Tally tally = Count(verdicts);
  nlohmann::ordered_json scenarios = nlohmann::ordered_json::array();
  for (const ScenarioVerdict& verdict : verdicts) {
    scenarios.push_back(ToJson(verdict));
    scenarios.back().erase("timeline_svg");
  }
  return {{"passed", tally.passed},
          {"failed", tally.failed},
          {"pending", tally.pending},
          {"report", page},
          {"scenarios", scenarios}};
}

ExitCode Run(const CLI::App& options, const CommandContext& context) {
  std::string problem;
  const auto selection = SelectScenarios(ValuesOf(options, "names"), ValueOf(options, "--filter"),
                                         context.root, problem);
  if (!selection) return Complain(context, ExitCode::kNothing, problem);
  const std::string folder =
      ValueOf(options, "--report", (fs::path(context.root) / "build" / "report").string());
  const std::vector<ScenarioVerdict> verdicts = CheckAll(options, context, *selection, folder);

  const std::string page = (fs::path(folder) / "index.html").string();
  problem = WriteTextFile(page, ReportHtml(verdicts));
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  if (IsGiven(options, "--json")) {
    context.out << SummaryJson(verdicts, page).dump(2) << "\n";
  } else {
    PrintText(verdicts, page, context);
  }
  return WorstOf(verdicts);
}

}  // namespace

Command CheckCommand() {
  return {.name = "check",
          .summary = "Run scenarios and compare them with their goldens: the regression suite",
          .examples =
              "prehend check\n"
              "prehend check milk_carton_wrap 'slide/*'\n"
              "prehend check --filter tag:smoke --no-pictures --jobs 1\n"
              "prehend check --grammar my/rules.grammar --json",
          .declare = Declare,
          .run = Run};
}

}  // namespace prehend::harness
