// SPDX-License-Identifier: Apache-2.0
// prehend check: the regression suite. Tested by tests/program/command_line_test.cc and
// tests/program/runner_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/number_text.h"
#include "harness/base/base/project_paths.h"
#include "harness/base/base/quoting.h"
#include "harness/base/base/visible_stream.h"
#include "harness/cli/command/command.h"
#include "harness/cli/daily/recogniser_choice.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/episodes/record_episode.h"
#include "harness/suite/check/causes.h"
#include "harness/suite/check/run_suite.h"
#include "harness/suite/report/report.h"

namespace prehend::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kDefaultTimeLimit_s = 120;
constexpr std::uint64_t kDefaultMemoryLimit_mb = 1000;
constexpr int kMaxRepeats = 10'000;

/// Its limits are too large to be worth a place in the help.
ValueRule AnySeed() {
  ValueRule rule = IntegersFrom(0, std::int64_t{1} << 62);
  rule.range.clear();
  return rule;
}

std::vector<Option> SelectionOptions() {
  return InGroup("Which scenarios",
                 {
                     Repeatable(Argument("names",
                                         "names, skill/name, globs or files, also episode files "
                                         "and recordings of trackers; default: all scenarios")),
                     FilterOption(),
                     Value("--shard", "I/N[:COSTS.json]",
                           "keep part I of N: of as many scenarios, or, with the costs.json that a "
                           "check left in build/check, of as many seconds",
                           {.problem = suite::ShardProblem}),
                     Flag("--changed",
                          "skip scenarios that passed, if no file and no part of the program that "
                          "they depend on changed since"),
                 });
}

std::vector<Option> RunningOptions() {
  return InGroup(
      "How they run",
      {
          JobsOption(),
          TimeLimitOption(0.1, 86400),
          MemoryLimitOption(),
          Value("--repeat", "N",
                "run each scenario N times; a scenario whose results or state hashes differ is "
                "flaky and fails",
                IntegersFrom(1, kMaxRepeats)),
          Value("--shuffle", "SEED",
                "run in a random order with this seed; default: the slowest first", AnySeed()),
          GrammarOption(),
          SettingsOption(),
          RecogniserOption(),
      });
}

std::string RecordProblem(const std::string& file) {
  return episode::IsEpisodeFile(file) ? "" : "found '" + file + "', wanted a file NAME.episodes";
}

/// A page that cannot show replays gets none.
suite::Replays ReplaysOf(const ParsedOptions& options) {
  const std::string word = options.TextOr("--replay", "failures");
  if (word == "none" || suite::ReplayBundle().empty()) return suite::Replays::kNone;
  return word == "all" ? suite::Replays::kAll : suite::Replays::kFailures;
}

std::vector<Option> ResultOptions() {
  return InGroup(
      "What is written",
      {
          WritesFile(
              Value("--report", "DIR",
                    "folder for index.html and pictures; default: build/report of the project, or, "
                    "outside of it, of this folder; build/report/some of some scenarios")),
          WritesFile(Value("--junit", "FILE",
                           "also write the verdicts as JUnit XML; -: print it instead of text")),
          WritesFile(Value("--record", "FILE",
                           "also write each episode to FILE, NAME.episodes (docs/episodes.md)",
                           {.range = {}, .problem = RecordProblem})),
          Flag("--no-pictures", "draw no pictures"),
          Value("--replay", "WHICH",
                "of which scenarios the page has a 3D replay: failures (the default), all, none",
                OneOf({"failures", "all", "none"})),
          Flag("--verbose", "print the details of every failure, also of more than ten"),
          JsonOption(),
      });
}

std::uint64_t MemoryLimit_bytes(const ParsedOptions& options) {
#ifdef __SANITIZE_ADDRESS__
  (void)options;
  return 0;  // shadow memory exceeds any limit
#else
  return options.UnsignedOr("--memory-limit-mb", kDefaultMemoryLimit_mb) * kMegabyte;
#endif
}

/// Who is somewhere else than in the project finds the report there. A check of some scenarios
/// leaves the page of the suite alone.
std::string DefaultReport(const std::string& root, bool of_some) {
  const fs::path folder = fs::path(IsCalledIn(root) ? BuildFolder(root) : "build") / "report";
  return (of_some ? folder / "some" : folder).string();
}

suite::SuiteRequest RequestFrom(const ParsedOptions& options, const CommandContext& context,
                                suite::ScenarioSelection selection) {
  const bool of_some = options.Has("names") || options.Has("--filter");
  suite::SuiteRequest request{
      .selection = std::move(selection),
      .changes = {options.Text("--grammar"), options.All("--set")},
      .root = context.root,
      .report_folder = options.TextOr("--report", DefaultReport(context.root, of_some)),
      .record_file = options.Text("--record"),
      .today = context.today,
      .pictures = !options.Has("--no-pictures"),
      .all_pictures = of_some,
      .replays = ReplaysOf(options),
      .only_changed = options.Has("--changed"),
      .repeat = options.IntOr("--repeat", 1)};
  if (options.Has("--shuffle")) request.shuffle_seed = options.UnsignedOr("--shuffle", 0);
  HearWho(options, request);
  request.limits = {.jobs = options.IntOr("--jobs", CoreCount()),
                    .time_limit_s = options.NumberOr("--time-limit-s", kDefaultTimeLimit_s),
                    .memory_limit_bytes = MemoryLimit_bytes(options)};
  return request;
}

std::string Indented(const std::string& text) {
  std::string indented;
  for (const std::string_view line : LinesOf(text)) indented += fmt::format("    {}\n", line);
  return indented;
}

void PrintVerdict(suite::Verdict verdict, const CommandContext& context) {
  const bool good = verdict == suite::Verdict::kPassed || verdict == suite::Verdict::kUnchanged;
  constexpr TerminalCode kRed{"\033[31m"}, kGreen{"\033[32m"}, kYellow{"\033[33m"};
  constexpr TerminalCode kPlain{"\033[0m"};
  if (context.colored)
    context.out << (good ? kGreen : verdict == suite::Verdict::kPending ? kYellow : kRed);
  context.out << Name(verdict);
  if (context.colored) context.out << kPlain;
}

/// With more failures their details are in the report only, unless they are asked for.
constexpr std::ptrdiff_t kMostDetailed = 10;

struct TextOptions {
  bool as_files_say = true;  ///< the command line changed no grammar and no setting, so that a
                             ///< difference can be accepted
  bool verbose = false;      ///< details of however many failures
};

/// `page`: the report; "": it could not be written.
void PrintText(const std::vector<suite::ScenarioVerdict>& verdicts, const TextOptions& options,
               const std::string& page, const CommandContext& context) {
  const auto failed = std::ranges::count_if(verdicts, [](const suite::ScenarioVerdict& verdict) {
    return verdict.exit_code != ExitCode::kAgrees && verdict.exit_code != ExitCode::kPending;
  });
  const bool brief = failed > kMostDetailed && !options.verbose;
  for (const suite::ScenarioVerdict& verdict : verdicts) {
    const std::string note = verdict.reason.empty() ? MarginText(verdict) : verdict.reason;
    PrintVerdict(verdict.verdict, context);
    context.out << fmt::format("  {}{}{}\n", verdict.scenario, note.empty() ? "" : "  ", note);
    if (brief && verdict.exit_code != ExitCode::kAgrees) continue;
    context.out << Indented(suite::NotesText(verdict));
    const bool is_good = verdict.exit_code == ExitCode::kAgrees;
    context.out << Indented(is_good ? verdict.details  // claims that were not judged
                                    : DetailsText(verdict));
    if (is_good) continue;
    context.out << "    " << suite::CommandLabel(verdict) << ": " << verdict.command << "\n";
  }
  const suite::Tally tally = suite::Count(verdicts);
  const std::string smallest = suite::SmallestMarginText(verdicts);
  if (!smallest.empty()) context.out << smallest << "\n";
  context.out << suite::NearLimitText(suite::NearLimitPasses(verdicts))
              << suite::CausesText(suite::CausesOf(verdicts));
  if (brief)
    context.out << fmt::format("{} failures: details are in the report, or printed by --verbose\n",
                               failed);
  if (!page.empty()) context.out << "report: " << page << "\n";
  if (options.as_files_say &&
      std::ranges::any_of(verdicts, &suite::ScenarioVerdict::DiffersFromGolden))
    context.out << "If the new behaviour is intended: " << CommandText({"review"}) << "\n";
  // Others are of no golden of this project.
  const auto acceptable = std::ranges::count_if(verdicts, suite::LeadsToReview);
  if (acceptable > 0) {
    context.out << fmt::format("{}: review {}, then accept {} with a reason\n",
                               acceptable == 1
                                   ? "1 new scenario has no golden"
                                   : fmt::format("{} new scenarios have no golden", acceptable),
                               acceptable == 1 ? "it" : "them", acceptable == 1 ? "it" : "each");
  }
  if (tally.pending > acceptable)
    context.out << fmt::format("{} pending: no golden\n", tally.pending - acceptable);
  if (tally.unchanged > 0)
    context.out << fmt::format("{} unchanged since the last pass: not run again\n",
                               tally.unchanged);
  context.out << fmt::format("{} passed, {} failed\n", tally.passed, tally.failed);
}

nlohmann::ordered_json SummaryJson(const std::vector<suite::ScenarioVerdict>& verdicts,
                                   const std::string& page) {
  const suite::Tally tally = suite::Count(verdicts);
  nlohmann::ordered_json scenarios = nlohmann::ordered_json::array();
  for (const suite::ScenarioVerdict& verdict : verdicts) {
    scenarios.push_back(suite::VerdictJson(verdict));
  }
  return {{"passed", tally.passed},
          {"failed", tally.failed},
          {"pending", tally.pending},
          {"unchanged", tally.unchanged},
          {"report", page},
          {"scenarios", scenarios},
          {"causes", suite::CausesJson(suite::CausesOf(verdicts))},
          {"brittle", suite::NearLimitJson(suite::NearLimitPasses(verdicts))}};
}

/// "" if every episode that should be recorded was.
std::string NotRecordedText(const std::vector<suite::ScenarioVerdict>& verdicts) {
  const auto count = std::ranges::count_if(verdicts, [](const suite::ScenarioVerdict& verdict) {
    return !verdict.not_recorded.empty();
  });
  if (count == 0) return "";
  const auto first = std::ranges::find_if(verdicts, [](const suite::ScenarioVerdict& verdict) {
    return !verdict.not_recorded.empty();
  });
  return fmt::format("--record: {} of {} episodes were not recorded; the first, {}: {}", count,
                     verdicts.size(), first->scenario, first->not_recorded);
}

/// ": stopped by SIGINT; 12 of 232 scenarios were not checked", or "".
std::string StoppedText(const suite::SuiteRequest& request,
                        const std::vector<suite::ScenarioVerdict>& verdicts, Interrupt& interrupt) {
  if (!interrupt.Came()) return "";
  const auto all = request.selection.scenarios.size();
  const auto checked = verdicts.size() - request.selection.orphans.size();
  return fmt::format(": stopped by {}; {} of {} scenarios were not checked", interrupt.Name(),
                     all - checked, all);
}

/// What cannot be written, or "". Found out before the scenarios run, which takes long.
std::string WhyNotWritten(const ParsedOptions& options, const std::string& page) {
  std::string problem = WhyNotWritable(page);
  if (!problem.empty()) return "--report: " + problem;
  if (options.Has("--junit")) problem = WhyNotWritable(options.Text("--junit"));
  return problem.empty() ? "" : "--junit: " + problem;
}

suite::SuiteProgress ProgressOn(const CommandContext& context) {
  if (!context.progress) return {};
  return [&](std::size_t done, std::size_t all, const std::string& id) {
    context.err << kEraseLine << fmt::format("[{}/{}] {}", done, all, id) << std::flush;
    if (done == all) context.err << kEraseLine << std::flush;
  };
}

/// Why options that are about playing contradict a selection with recordings, or "".
std::string WhyNotPlayed(const suite::ScenarioSelection& selection, const ParsedOptions& options) {
  const auto played =
      std::ranges::find_if(selection.scenarios, [](const episode::ScenarioFile& file) {
        return episode::EpisodeKindOf(file.path) != episode::EpisodeKind::kScenario;
      });
  for (const char* of_play : {"--record", "--repeat"}) {
    if (played != selection.scenarios.end() && options.Has(of_play))
      return fmt::format("{} plays scenarios; {} is a recording", of_play, played->path);
  }
  if (options.Has("--record") && options.Has("--recogniser"))
    return "--record keeps what a grammar recognises: check --record alone, then check or report "
           "the episodes with --recogniser";
  return "";
}

/// The part of the selection that is to be checked, and what it owes if it is recorded.
Result<episode::Plan> KeepPart(const ParsedOptions& options, const CommandContext& context,
                               suite::ScenarioSelection& selection) {
  const suite::Shard shard = *suite::ParseShard(options.TextOr("--shard", "1/1"));
  std::vector<std::string> names, files;
  for (const episode::ScenarioFile& file : selection.scenarios) {
    names.push_back(episode::IdOf(file));
    files.push_back(file.path);
  }
  std::string note;
  Result<std::vector<int>> wanted = suite::PartsOf(shard, names, &note);
  context.err << note;
  PREHEND_TRY(const std::vector<int> parts, std::move(wanted));
  episode::Plan plan;
  if (options.Has("--record") && !options.Has("--repeat") && !options.Has("--changed")) {
    std::vector<std::string> words = {"check"};
    std::ranges::copy(options.All("names"), std::back_inserter(words));
    for (const std::string& filter : options.All("--filter"))
      words.insert(words.end(), {"--filter", filter});
    std::ranges::copy(suite::OptionsOf({options.Text("--grammar"), options.All("--set")}),
                      std::back_inserter(words));
    plan = episode::MakePlan(words, files, context.root);
    plan.number = shard.number;
    plan.count = shard.count;
    for (std::size_t i = 0; i < names.size(); ++i) plan.owed.push_back({names[i], parts[i]});
  }
  suite::KeepShard(shard, parts, selection);
  return plan;
}

/// What the file has already of this part is judged as it is there, and not played again.
Result<void> GoOn(const episode::Plan& plan, suite::SuiteRequest& request,
                  const CommandContext& context) {
  request.plan = plan;
  if (plan.uuid.empty()) return {};
  PREHEND_TRY(const auto complete, episode::BeginPart(request.record_file, plan));
  std::size_t kept = 0;
  for (episode::ScenarioFile& file : request.selection.scenarios) {
    const auto row = complete.find(episode::IdOf(file));
    if (row == complete.end()) continue;
    file.path = request.record_file;
    file.episode = row->second.id;
    file.origin = episode::Origin::kRecordedRun;
    ++kept;
  }
  if (kept > 0)
    context.err << fmt::format("{}: it has {} of {} episodes already; these are not played again\n",
                               request.record_file, kept, request.selection.scenarios.size());
  return {};
}

/// Of what the files say. Beside a page that has its own place, so that CI can keep it; else with
/// what is remembered.
void AddToHistory(const std::vector<suite::ScenarioVerdict>& verdicts, const ParsedOptions& options,
                  const CommandContext& context, suite::ReportHeader& header) {
  if (options.Has("--grammar") || options.Has("--set")) return;
  const std::string folder =
      options.Has("--report") ? header.folder : BuildFolder(context.root) + "/check";
  const std::string file = (fs::path(folder) / "history.jsonl").string();
  header.history = suite::ReadHistory(file);
  header.history.push_back(suite::RunOf(verdicts, header.date, header.commit));
  (void)suite::WriteHistory(file, header.history);  // as what passed last
}

/// `page`: "" if it could not be written.
void PrintResults(const std::vector<suite::ScenarioVerdict>& verdicts, const ParsedOptions& options,
                  const std::string& page, Interrupt& interrupt, const CommandContext& context) {
  if (options.Has("--json")) {
    nlohmann::ordered_json summary = SummaryJson(verdicts, page);
    if (interrupt.Came()) summary["stopped_by"] = interrupt.Name();
    context.out << summary.dump(2) << "\n";
    return;
  }
  const bool as_files_say =
      !options.Has("--grammar") && !options.Has("--set") && !options.Has("--recogniser");
  PrintText(verdicts, {.as_files_say = as_files_say, .verbose = options.Has("--verbose")}, page,
            context);
}

ExitCode RunCheck(const ParsedOptions& options, const CommandContext& context) {
  for (const char* other : {"--grammar", "--set", "--recogniser"}) {
    if (options.Has("--changed") && options.Has(other))
      return Refuse(context,
                    std::string("--changed compares files; it cannot be combined with ") + other);
  }
  const std::string junit = options.Text("--junit");
  if (junit == "-" && options.Has("--json")) {
    return Refuse(context, "--junit - contradicts --json: both would be printed");
  }
  const ExitCode strays = options.Has("names") ? ExitCode::kAgrees : WarnOfScenariosNotRun(context);
  if (strays != ExitCode::kAgrees) return strays;
  auto selection =
      suite::SelectScenarios(options.All("names"), options.All("--filter"), context.root);
  if (!selection) return Complain(context, selection.error().exit_code, selection.error().why);
  const std::string cannot = WhyNotPlayed(*selection, options);
  if (!cannot.empty()) return Refuse(context, cannot);
  const Result<episode::Plan> plan = KeepPart(options, context, *selection);
  if (!plan) return Complain(context, plan.error());
  suite::SuiteRequest request = RequestFrom(options, context, std::move(*selection));
  const std::string page = (fs::path(request.report_folder) / "index.html").string();
  std::string problem = WhyNotWritten(options, page);
  if (!problem.empty()) return Refuse(context, problem);
  tl::expected<episode::WriteLock, std::string> lock;
  if (options.Has("--record"))
    lock = episode::LockToRecord(
        request.record_file, plan->uuid.empty() ? episode::Writer::kAdds : episode::Writer::kAlone);
  if (!lock) return Refuse(context, "--record: " + lock.error());
  if (const Result<void> begun = GoOn(*plan, request, context); !begun)
    return Complain(context, begun.error());
  Interrupt interrupt;
  const std::vector<suite::ScenarioVerdict> verdicts =
      suite::RunSuite(request, ProgressOn(context), &interrupt);
  const std::string stopped = StoppedText(request, verdicts, interrupt);
  if (context.progress && !stopped.empty()) context.err << kEraseLine;

  suite::ReportHeader header =
      suite::HeaderOf(CommandText(context.words) + stopped, context.root, context.today);
  header.folder = request.report_folder;
  if (stopped.empty()) AddToHistory(verdicts, options, context, header);
  problem = WriteTextFile(page, suite::ReportHtml(verdicts, header));
  if (problem.empty() && options.Has("--junit"))
    problem = WriteTextFile(junit, suite::JunitXml(verdicts));
  if (junit != "-" || options.Has("--json"))
    PrintResults(verdicts, options, problem.empty() ? page : "", interrupt, context);
  if (!stopped.empty()) {
    context.out.flush();
    context.err << "prehend" << stopped << std::endl;
    RemoveLeftFolders();
    interrupt.EndProcess();
  }
  if (problem.empty()) problem = NotRecordedText(verdicts);
  if (problem.empty()) problem = episode::EndPart(request.record_file, request.plan);
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  // An empty shard has agreed with all that it had.
  return verdicts.empty() && options.Has("--shard") ? ExitCode::kAgrees : suite::WorstOf(verdicts);
}

}  // namespace

Command CheckCommand() {
  return {.name = "check",
          .summary = "Run scenarios and compare them with their goldens: the regression suite",
          .examples = {"check", "check milk_carton_wrap 'slide/*' my/scenario.yaml",
                       "check --filter tag:smoke --filter '!reach/*' --no-pictures -j 1",
                       "check --changed", "check --record suite.episodes --no-pictures",
                       "check --shard 2/3 --junit verdicts.xml",
                       "check --shard 3/16:costs.json --record part-3.episodes",
                       "check 'slide/*' --repeat 10", "check --grammar my/rules.grammar --json",
                       "check 'slide/*' --recogniser 'python3 reco.py'"},
          .options = Joined(SelectionOptions(), Joined(RunningOptions(), ResultOptions())),
          .run = RunCheck};
}

}  // namespace prehend::cli
