// SPDX-License-Identifier: Apache-2.0
// prehend check: the regression suite. Tested by tests/program/command_line_test.cc and
// tests/program/runner_test.cc
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "harness/base/atomic_file.h"
#include "harness/check/run_suite.h"
#include "harness/cli/command.h"
#include "harness/cli/number_in.h"
#include "harness/report/junit.h"
#include "harness/report/report.h"

namespace prehend::harness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDefaultTimeLimit_s = "120";
constexpr const char* kDefaultMemoryLimit_mb = "1000";
constexpr int kMaxJobs = 256;
constexpr int kMaxRepeats = 10'000;

void DeclareSelection(CLI::App& options) {
  options.add_option("names", "names, skill/name, globs or files; nothing: all")
      ->expected(-1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  const auto is_filter = [](const std::string& text) {
    const std::size_t word = text.starts_with("!") ? 1 : 0;
    const bool of_tag = text.compare(word, 4, "tag:") == 0;
    if (text.empty() || text.size() > word + (of_tag ? 4 : 0)) return std::string();
    return "'" + text + "' is followed by " +
           (of_tag ? "a tag, like " : "what must not match, like ") + text +
           (of_tag ? "smoke" : "reach/*");
  };
  options
      .add_option("--filter",
                  "only those that match this glob, or have tag:NAME; with a leading ! only the "
                  "others; may be given again, then all must hold")
      ->type_name("[!]GLOB|[!]tag:NAME")
      ->expected(1)
      ->check(CLI::Validator(is_filter, "", "filter"))
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  const auto is_shard = [](const std::string& text) {
    return ParseShard(text) ? std::string()
                            : "'" + text + "' is no shard; the second of three is 2/3";
  };
  options.add_option("--shard", "only the I-th of N parts of the selection")
      ->type_name("I/N")
      ->expected(1)
      ->check(CLI::Validator(is_shard, "", "shard"));
  DeclareFlag(options, "--changed",
              "skip what passed before and depends on no file, and no part of the program, that "
              "changed since");
}

void DeclareRunning(CLI::App& options) {
  options.add_option("--jobs,-j", "processes at a time; otherwise one per core")
      ->type_name("N")
      ->expected(1)
      ->check(CLI::Range(1, kMaxJobs));
  options
      .add_option("--time-limit-s,--time-limit",
                  "seconds that one scenario may take; otherwise 120")
      ->type_name("S")
      ->expected(1)
      ->check(NumberIn(0.1, 86400));
  options
      .add_option("--memory-limit-mb",
                  "private memory that one scenario may take; otherwise 1000, 0 is no limit")
      ->type_name("MB")
      ->expected(1)
      ->check(CLI::Range(0, 1'000'000));
  options
      .add_option(
          "--repeat",
          "run each scenario N times; different results, or state hashes, are flaky and fail")
      ->type_name("N")
      ->expected(1)
      ->check(CLI::Range(1, kMaxRepeats));
  options
      .add_option("--shuffle", "run in an order drawn with this seed; otherwise the slowest first")
      ->type_name("SEED")
      ->expected(1)
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 62));
}

void Declare(CLI::App& options) {
  DeclareSelection(options);
  DeclareRunning(options);
  options.add_option("--report", "folder for index.html and pictures; otherwise build/report")
      ->type_name("DIR")
      ->expected(1);
  options
      .add_option("--junit", "also write the verdicts as JUnit XML; -: print that instead of text")
      ->type_name("FILE")
      ->expected(1);
  DeclareFlag(options, "--no-pictures", "do not draw");
  DeclareFlag(options, "--json", "one JSON object instead of text");
  DeclareRunOptions(options);
}

std::uint64_t MemoryLimit_bytes(const CLI::App& options) {
#ifdef __SANITIZE_ADDRESS__
  (void)options;
  return 0;  // shadow memory is larger than any limit
#else
  return std::stoull(ValueOf(options, "--memory-limit-mb", kDefaultMemoryLimit_mb)) * kMegabyte;
#endif
}

SuiteRequest RequestFrom(const CLI::App& options, const CommandContext& context,
                         ScenarioSelection selection) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  SuiteRequest request{.selection = std::move(selection),
                       .changes = RequestOf(options, {}),
                       .root = context.root,
                       .report_folder = ValueOf(options, "--report",
                                                (fs::path(context.root) / "build/report").string()),
                       .pictures = !IsGiven(options, "--no-pictures"),
                       .only_changed = IsGiven(options, "--changed"),
                       .repeat = std::stoi(ValueOf(options, "--repeat", "1")),
                       .shuffle_seed = {},
                       .limits = {}};
  if (IsGiven(options, "--shuffle"))
    request.shuffle_seed = std::stoull(ValueOf(options, "--shuffle"));
  request.limits = {
      .jobs = std::stoi(ValueOf(options, "--jobs", std::to_string(cores))),
      .time_limit_s = std::stod(ValueOf(options, "--time-limit-s", kDefaultTimeLimit_s)),
      .memory_limit_bytes = MemoryLimit_bytes(options)};
  return request;
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
  const bool good = verdict == Verdict::kPassed || verdict == Verdict::kUnchanged;
  const int color = good ? 32 : verdict == Verdict::kPending ? 33 : 31;
  return fmt::format("\033[{}m{}\033[0m", color, name);
}

std::string PendingText(int pending) {
  return pending == 1
             ? std::string("1 new scenario has no golden: review it, then accept it with a reason")
             : fmt::format(
                   "{} new scenarios have no golden: review each, then accept it with a "
                   "reason",
                   pending);
}

/// `as_files_say`: nothing was changed by the command line, so that what differs can be accepted.
void PrintText(const std::vector<ScenarioVerdict>& verdicts, bool as_files_say,
               const std::string& page, const CommandContext& context) {
  for (const ScenarioVerdict& verdict : verdicts) {
    const std::string note = verdict.reason.empty() ? MarginText(verdict) : verdict.reason;
    context.out << fmt::format("{}  {}{}{}\n", Colored(verdict.verdict, context.colored),
                               verdict.scenario, note.empty() ? "" : "  ", note);
    if (verdict.exit_code == ExitCode::kAgrees) continue;
    context.out << Indented(verdict.details);
    context.out << "    " << CommandLabel(verdict) << ": " << verdict.command << "\n";
  }
  const Tally tally = Count(verdicts);
  const std::string smallest = SmallestMarginText(verdicts);
  if (!smallest.empty()) context.out << smallest << "\n";
  context.out << "report: " << page << "\n";
  if (as_files_say && std::ranges::any_of(verdicts, &ScenarioVerdict::DiffersFromGolden))
    context.out << "If the new behaviour is intended: prehend review\n";
  if (tally.pending > 0) context.out << PendingText(tally.pending) << "\n";
  if (tally.unchanged > 0)
    context.out << fmt::format("{} unchanged since they passed, not run again\n", tally.unchanged);
  context.out << fmt::format("{} passed, {} failed\n", tally.passed, tally.failed);
}

nlohmann::ordered_json SummaryJson(const std::vector<ScenarioVerdict>& verdicts,
                                   const std::string& page) {
  const Tally tally = Count(verdicts);
  nlohmann::ordered_json scenarios = nlohmann::ordered_json::array();
  for (const ScenarioVerdict& verdict : verdicts) {
    scenarios.push_back(VerdictJson(verdict));
  }
  return {{"passed", tally.passed},       {"failed", tally.failed}, {"pending", tally.pending},
          {"unchanged", tally.unchanged}, {"report", page},         {"scenarios", scenarios}};
}

ExitCode Run(const CLI::App& options, const CommandContext& context) {
  if (IsGiven(options, "--changed") &&
      (IsGiven(options, "--grammar") || IsGiven(options, "--set"))) {
    return Complain(context, ExitCode::kBadInput,
                    "--changed is about scenarios as their files say: not with --grammar or --set");
  }
  const std::string junit = ValueOf(options, "--junit");
  if (junit == "-" && IsGiven(options, "--json")) {
    return Complain(context, ExitCode::kBadInput,
                    "--junit - and --json contradict each other: both are printed");
  }
  std::string problem;
  auto selection = SelectScenarios(ValuesOf(options, "names"), ValuesOf(options, "--filter"),
                                   context.root, problem);
  if (!selection) return Complain(context, ExitCode::kNothing, problem);
  if (IsGiven(options, "--shard")) {
    KeepShard(*ParseShard(ValueOf(options, "--shard")), *selection);
    if (selection->scenarios.empty() && selection->orphans.empty())
      return Complain(context, ExitCode::kNothing,
                      "this shard is empty: there are fewer scenarios");
  }
  const SuiteRequest request = RequestFrom(options, context, std::move(*selection));
  const std::string page = (fs::path(request.report_folder) / "index.html").string();
  // Verdicts take long; what cannot be written is found before.
  problem = WhyNotWritable(page);
  if (!problem.empty()) return Complain(context, ExitCode::kBadInput, "--report: " + problem);
  if (IsGiven(options, "--junit")) problem = WhyNotWritable(junit);
  if (!problem.empty()) return Complain(context, ExitCode::kBadInput, "--junit: " + problem);
  SuiteProgress progress;
  if (context.progress) {
    progress = [&](std::size_t done, std::size_t all, const std::string& id) {
      context.err << fmt::format("\r\033[K[{}/{}] {}", done, all, id) << std::flush;
      if (done == all) context.err << "\r\033[K" << std::flush;
    };
  }
  const std::vector<ScenarioVerdict> verdicts = RunSuite(request, progress);

  if (IsGiven(options, "--json")) {
    context.out << SummaryJson(verdicts, page).dump(2) << "\n";
  } else if (junit != "-") {
    const bool as_files_say = !IsGiven(options, "--grammar") && !IsGiven(options, "--set");
    PrintText(verdicts, as_files_say, page, context);
  }
  problem = WriteTextFile(page, ReportHtml(verdicts));
  if (problem.empty() && IsGiven(options, "--junit"))
    problem = WriteTextFile(junit, JunitXml(verdicts));
  return problem.empty() ? WorstOf(verdicts) : Complain(context, ExitCode::kFailure, problem);
}

}  // namespace

Command CheckCommand() {
  return {.name = "check",
          .summary = "Run scenarios and compare them with their goldens: the regression suite",
          .examples =
              "prehend check\n"
              "prehend check milk_carton_wrap 'slide/*' my/scenario.yaml\n"
              "prehend check --filter tag:smoke --filter '!reach/*' --no-pictures --jobs 1\n"
              "prehend check --changed\n"
              "prehend check --shard 2/3 --junit verdicts.xml\n"
              "prehend check 'slide/*' --repeat 10\n"
              "prehend check --grammar my/rules.grammar --json",
          .declare = Declare,
          .run = Run};
}

}  // namespace prehend::harness
