// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/check/run_suite.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <random>
#include <tuple>

#include "harness/base/base/content_hash.h"
#include "harness/base/base/quoting.h"
#include "harness/base/base/text_file.h"
#include "harness/base/process/worker_pool.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/scenario/read/read_scenario.h"
#include "harness/show/pictures/pictures.h"
#include "harness/suite/check/check_scenario.h"
#include "harness/suite/check/last_pass.h"

namespace prehend::suite {
namespace {

/// One run of one scenario.
struct Turn {
  std::size_t scenario = 0;  ///< index into the selection
  int repetition = 0;
};

class Suite {
 public:
  explicit Suite(const SuiteRequest& request)
      : request_(request),
        scenarios_(request.selection.scenarios),
        records_(request.root),
        program_(ProgramHash()),
        costs_(records_.ReadCosts()),
        runs_(scenarios_.size()) {
    for (const episode::ScenarioFile& file : scenarios_)  // once, however many episodes it has
      if (file.episode && !hashes_.contains(file.path)) hashes_[file.path] = FileHash(file.path);
  }

  std::vector<ScenarioVerdict> Run(const SuiteProgress& progress, Interrupt* interrupt) {
    std::vector<Turn> turns = Turns();
    const std::size_t all = turns.size();
    std::size_t done = 0;
    const auto keep = [&](std::size_t scenario, ScenarioVerdict verdict) {
      runs_[scenario].push_back(std::move(verdict));
      if (progress) progress(++done, all, Id(scenario));
    };
    turns = JudgeTogether(turns, keep, interrupt);
    ProgressCounters last_ticks(turns.size());
    if (request_.pictures) show::PrepareToDraw();
    std::vector<WorkerJob> jobs;
    for (std::size_t i = 0; i < turns.size(); ++i) jobs.push_back(Job(turns[i], last_ticks[i]));
    const auto take = [&](std::size_t job, const WorkerResult& result) {
      const std::size_t scenario = turns[job].scenario;
      cpu_s_[scenario] = std::max(cpu_s_[scenario], result.cpu_s);
      keep(scenario, VerdictOf(scenario, result, last_ticks[job]));
    };
    if (!interrupt || !interrupt->Came()) RunInWorkers(jobs, request_.limits, take, interrupt);
    return Verdicts();
  }

 private:
  using Keep = std::function<void(std::size_t scenario, ScenarioVerdict verdict)>;

  /// Episodes of a file have much in common, which is read once: several are judged in a process.
  /// Returns the others, and those of a process that did not end: each is judged alone.
  std::vector<Turn> JudgeTogether(const std::vector<Turn>& turns, const Keep& keep,
                                  Interrupt* interrupt) {
    constexpr std::size_t kMost = 32, kLeast = 4;
    const std::size_t at_once = std::min(
        kMost, turns.size() / (2 * static_cast<std::size_t>(std::max(1, request_.limits.jobs))));
    const auto is_kept = [&](const Turn& turn) {
      const episode::ScenarioFile& one = scenarios_[turn.scenario];
      return one.episode && request_.repeat == 1;
    };
    if (at_once < kLeast) return turns;
    std::vector<Turn> alone;
    std::vector<std::vector<Turn>> groups;
    for (const Turn& turn : turns) {
      if (!is_kept(turn)) {
        alone.push_back(turn);
        continue;
      }
      const auto& path = scenarios_[turn.scenario].path;
      if (groups.empty() || groups.back().size() >= at_once ||
          scenarios_[groups.back().front().scenario].path != path)
        groups.emplace_back();
      groups.back().push_back(turn);
    }
    std::vector<WorkerJob> jobs;
    for (const std::vector<Turn>& group : groups) jobs.push_back(JobOf(group));
    const auto take = [&](std::size_t job, const WorkerResult& result) {
      if (!result.finished) {
        alone.insert(alone.end(), groups[job].begin(), groups[job].end());
        return;
      }
      const auto verdicts = FromWire<nlohmann::json>(result.output);
      for (std::size_t i = 0; i < groups[job].size(); ++i) {
        const std::size_t scenario = groups[job][i].scenario;
        ScenarioVerdict verdict = UnpackedVerdict(verdicts[i]["verdict"]);
        verdict.file = scenarios_[scenario].path;
        verdict.seconds = verdicts[i]["seconds"];
        cpu_s_[scenario] = std::max(cpu_s_[scenario], verdicts[i]["cpu_s"].get<double>());
        verdict.peak_memory_kib = result.peak_memory_kib;
        keep(scenario, std::move(verdict));
      }
    };
    RunInWorkers(jobs, request_.limits, take, interrupt);
    return alone;
  }

  WorkerJob JobOf(const std::vector<Turn>& group) const {
    return [this, group] {
      episode::EpisodeOpener opener(request_.root);
      auto verdicts = nlohmann::json::array();
      for (const Turn& turn : group) {
        const auto start = std::chrono::steady_clock::now();
        const std::clock_t begun = std::clock();
        CheckRequest check = RequestOf(turn);
        check.opener = &opener;
        nlohmann::json verdict = Packed(CheckScenario(check));
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        const double cpu_s = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
        verdicts.push_back(
            {{"verdict", std::move(verdict)}, {"seconds", took.count()}, {"cpu_s", cpu_s}});
      }
      return ToWire(verdicts);
    };
  }

  std::string Id(std::size_t scenario) const { return episode::IdOf(scenarios_[scenario]); }

  /// Only these have goldens, and are remembered from one check to the next.
  bool IsRemembered(std::size_t scenario) const {
    return scenarios_[scenario].in_project && !scenarios_[scenario].episode;
  }

  bool Changed() const {
    return !request_.changes.grammar.empty() || !request_.changes.settings.empty() ||
           request_.listen;
  }

  /// The last pass, when nothing that it depended on changed since.
  std::optional<ScenarioVerdict> Unchanged(std::size_t scenario) const {
    if (!IsRemembered(scenario)) return std::nullopt;
    const auto record = records_.Read(Id(scenario));
    const bool holds = record && record->passed && record->program == program_ &&
                       record->pictures >= request_.pictures && ChangedInputs(*record).empty();
    if (!holds) return std::nullopt;
    ScenarioVerdict verdict = record->verdict;
    verdict.verdict = Verdict::kUnchanged;
    verdict.seconds = 0;
    return verdict;
  }

  /// The runs in their order: slowest first. A scenario that was never timed counts as slow.
  std::vector<Turn> Turns() {
    std::vector<Turn> turns;
    for (std::size_t i = 0; i < scenarios_.size(); ++i) {
      if (request_.only_changed) {
        if (auto unchanged = Unchanged(i)) {
          runs_[i].push_back(std::move(*unchanged));
          continue;
        }
      }
      for (int k = 0; k < request_.repeat; ++k) turns.push_back({i, k});
    }
    if (request_.shuffle_seed) {
      std::mt19937_64 random(*request_.shuffle_seed);
      std::shuffle(turns.begin(), turns.end(), random);
      return turns;
    }
    const auto cost = [&](const Turn& turn) {
      const auto known = costs_.find(Id(turn.scenario));
      return known == costs_.end() ? std::numeric_limits<double>::infinity() : known->second;
    };
    std::ranges::stable_sort(turns, std::greater{}, cost);
    return turns;
  }

  CheckRequest RequestOf(const Turn& turn) const {
    const auto hash = hashes_.find(scenarios_[turn.scenario].path);
    return {
        .episode = NameOf(scenarios_[turn.scenario]),
        .file_hash = hash == hashes_.end() ? "" : hash->second,
        .changes = request_.changes,
        .recogniser = request_.recogniser,
        .listen = request_.listen,
        .id = Id(turn.scenario),
        .root = request_.root,
        .report_folder = request_.report_folder,
        .replays = turn.repetition == 0 ? request_.replays : Replays::kNone,
        .explain = turn.repetition == 0,
        .pictures = request_.pictures && turn.repetition == 0,
        .all_pictures = request_.all_pictures,
        .leave_nothing_behind = Changed() || turn.repetition > 0 || !IsRemembered(turn.scenario),
        .in_project = scenarios_[turn.scenario].in_project,
        .record_file = turn.repetition == 0 ? request_.record_file : "",
        .record_uuid = request_.plan.UuidOfEpisode(Id(turn.scenario)),
        .is_own_record = scenarios_[turn.scenario].path == request_.record_file,
        .today = request_.today,
        .program = program_};
  }

  WorkerJob Job(const Turn& turn, ProgressCounters::Tick& last_tick) const {
    CheckRequest check = RequestOf(turn);
    check.last_tick = &last_tick;
    return [check] { return ToWire(Packed(CheckScenario(check))); };
  }

  ScenarioVerdict VerdictOf(std::size_t scenario, const WorkerResult& result,
                            std::int64_t last_tick) const {
    ScenarioVerdict verdict;
    if (result.finished) {
      verdict = UnpackedVerdict(FromWire<nlohmann::json>(result.output));
    } else {
      verdict.scenario = Id(scenario);
      verdict.exit_code = ExitCode::kFailure;
      verdict.reason = fmt::format("its process ended: {}, {}", ReadableText(result.reason),
                                   last_tick == ProgressCounters::kNone
                                       ? std::string("before the first tick")
                                       : fmt::format("last tick {}", last_tick));
      if (!result.stderr_tail.empty())
        verdict.details = "its standard error:\n" + ReadableText(result.stderr_tail);
      verdict.ticks = std::max<std::int64_t>(0, last_tick);
      verdict.command = RepeatCommand(RequestOf({scenario})) + HowText();
    }
    verdict.file = scenarios_[scenario].path;
    verdict.seconds = result.seconds;
    verdict.peak_memory_kib = result.peak_memory_kib;
    return verdict;
  }

  /// The options that a worker's time and memory depend on.
  std::string HowText() const {
    return fmt::format("{} --time-limit-s {:g} --memory-limit-mb {}",
                       request_.pictures ? "" : " --no-pictures", request_.limits.time_limit_s,
                       request_.limits.memory_limit_bytes / kMegabyte);
  }

  std::vector<ScenarioVerdict> Verdicts() {
    std::vector<ScenarioVerdict> verdicts;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      if (runs_[i].empty()) continue;  // interrupted before it ended
      verdicts.push_back(MergeRepeats(runs_[i]));
      if (verdicts.back().verdict == Verdict::kFlaky)
        verdicts.back().command += fmt::format(" --repeat {}", request_.repeat);
      const ScenarioVerdict& merged = verdicts.back();
      if (merged.verdict == Verdict::kUnchanged || Changed() || !IsRemembered(i)) continue;
      costs_[merged.scenario] = cpu_s_[i];
      // Without its record the next check takes longer; if build/ cannot be written, the report,
      // which is in it, too, is an error.
      if (merged.verdict == Verdict::kPassed) {
        ScenarioVerdict kept = merged;
        kept.replay.clear();  // large, and quickly made again
        (void)records_.Write({.program = program_,
                              .build = BuildText(),
                              .pictures = request_.pictures,
                              .verdict = std::move(kept)});
      }
    }
    (void)records_.WriteCosts(costs_);
    for (const UnreferencedGolden& orphan : request_.selection.orphans)
      verdicts.push_back(OrphanVerdict(orphan));
    return verdicts;
  }

  static ScenarioVerdict OrphanVerdict(const UnreferencedGolden& orphan) {
    ScenarioVerdict verdict{.scenario = orphan.scenario,
                            .file = orphan.files.front().string(),
                            .verdict = Verdict::kFailed};
    verdict.exit_code = ExitCode::kDiffers;
    verdict.reason = "a golden without scenario";
    verdict.details = Text(orphan);
    verdict.command = CommandText({"check"});
    return verdict;
  }

  const SuiteRequest& request_;
  const std::vector<episode::ScenarioFile>& scenarios_;
  const LastPasses records_;
  const std::string program_;
  LastPasses::Costs costs_;
  std::map<std::size_t, double> cpu_s_;  ///< by scenario: another load does not change it much
  FileHashes hashes_;                    ///< of episode files
  std::vector<std::vector<ScenarioVerdict>> runs_;  ///< per scenario, in the order they ended
};

constexpr std::string_view kTag = "tag:";

bool Matches(const std::string& pattern, const episode::ScenarioFile& file) {
  return fnmatch(pattern.c_str(), file.name.c_str(), 0) == 0 ||
         fnmatch(pattern.c_str(), episode::IdOf(file).c_str(), 0) == 0;
}

/// The scenario that a golden asks for.
episode::ScenarioFile Missing(const UnreferencedGolden& orphan) {
  const std::size_t slash = orphan.scenario.rfind('/');
  const bool has_skill = slash != std::string::npos;
  return {.skill = has_skill ? orphan.scenario.substr(0, slash) : "",
          .name = has_skill ? orphan.scenario.substr(slash + 1) : orphan.scenario};
}

/// A file that cannot be read has no tags; it is still checked when it is named.
bool HasTag(const episode::ScenarioFile& file, const std::string& tag,
            const scenario::ScenarioLibrary& library) {
  const Result<scenario::Scenario> scenario = scenario::ReadScenario(file.path, {}, library);
  return scenario && std::count(scenario->tags.begin(), scenario->tags.end(), tag) > 0;
}

bool PassesFilter(const episode::ScenarioFile& file, const std::string& filter,
                  const scenario::ScenarioLibrary& library) {
  if (filter.starts_with('!')) return !PassesFilter(file, filter.substr(1), library);
  if (filter.starts_with(kTag)) return HasTag(file, filter.substr(kTag.size()), library);
  return Matches(filter, file);
}

/// Why no scenario passes this filter, with the nearest tag; "" if some do, or if it begins with
/// '!'.
std::string WhyNonePasses(const std::string& filter, const std::vector<episode::ScenarioFile>& all,
                          const scenario::ScenarioLibrary& library) {
  if (filter.starts_with('!')) return "";
  const bool some = std::ranges::any_of(
      all, [&](const auto& file) { return PassesFilter(file, filter, library); });
  if (some || !filter.starts_with(kTag))
    return some ? "" : "--filter: no scenario matches '" + filter + "'";
  std::vector<std::string> tags;
  for (const episode::ScenarioFile& file : all) {
    const Result<scenario::Scenario> scenario = scenario::ReadScenario(file.path, {}, library);
    if (scenario) tags.insert(tags.end(), scenario->tags.begin(), scenario->tags.end());
  }
  const std::string tag = filter.substr(kTag.size());
  const std::string near = grammar::NearestName(tag, tags);
  return "--filter: no scenario has the tag '" + tag + "'" +
         (near.empty() ? "" : "; did you mean '" + near + "'?");
}

bool IsFile(const std::string& typed) {
  std::error_code error;
  const bool is_there =
      std::filesystem::exists(typed, error) && !std::filesystem::is_directory(typed, error);
  const auto ends_so = [&](const char* ending) { return typed.ends_with(ending); };
  return is_there ||
         std::ranges::any_of(std::array{".yaml", ".yml", ".jsonl", ".episodes"}, ends_so);
}

/// Why a pattern matches no scenario. For the name of a folder, the pattern of its scenarios is
/// suggested.
std::string WhyNoMatch(const std::string& typed, const std::vector<episode::ScenarioFile>& all) {
  std::string folder = typed.starts_with("scenarios/") ? typed.substr(10) : typed;
  if (const std::size_t slash = folder.find('/'); slash != std::string::npos) folder.resize(slash);
  const bool is_folder = folder == typed || typed.ends_with("/" + folder) || typed.ends_with('/');
  std::vector<std::string> skills;
  for (const episode::ScenarioFile& file : all) skills.push_back(file.skill);
  std::string hint = is_folder && std::ranges::count(skills, folder) > 0
                         ? "did you mean '" + folder + "/*'?"
                         : episode::HintForScenario(all, typed);
  const std::string near = grammar::NearestName(folder, skills);
  if (hint.empty() && !near.empty()) hint = "did you mean '" + near + "/*'?";
  return "no scenario matches '" + typed + "'" + (hint.empty() ? "" : "; " + hint) +
         " ('prehend list' shows all)";
}

/// The episodes of a file, each as the scenario that it was.
std::vector<episode::ScenarioFile> KeptIn(const std::string& path,
                                          const std::vector<episode::ScenarioFile>& all,
                                          NoSelection& none) {
  std::vector<episode::ScenarioFile> found;
  const auto kept = episode::EpisodesOf(path);
  if (!kept) none = {ExitCode::kBadInput, path + ": " + kept.error().front().message};
  if (!kept) return found;
  for (const episode::EpisodeName& episode : *kept)
    found.push_back(episode::ScenarioOf(episode, all));
  return found;
}

}  // namespace

std::vector<ScenarioVerdict> RunSuite(const SuiteRequest& request, const SuiteProgress& progress,
                                      Interrupt* interrupt) {
  return Suite(request).Run(progress, interrupt);
}

tl::expected<ScenarioSelection, NoSelection> SelectScenarios(
    const std::vector<std::string>& patterns, const std::vector<std::string>& filters,
    const std::string& root) {
  const std::vector<episode::ScenarioFile> all = episode::ListScenarios(root);
  const std::vector<UnreferencedGolden> lost = FindUnreferencedGoldens(all, root);
  std::vector<episode::ScenarioFile> named =
      patterns.empty() ? all : std::vector<episode::ScenarioFile>();
  for (const std::string& pattern : patterns) {
    const std::size_t before = named.size();
    std::ranges::copy_if(all, std::back_inserter(named),
                         [&](const episode::ScenarioFile& file) { return Matches(pattern, file); });
    const bool is_of_golden = std::ranges::any_of(
        lost, [&](const UnreferencedGolden& orphan) { return Matches(pattern, Missing(orphan)); });
    if (named.size() > before || is_of_golden) continue;
    for (const episode::ScenarioFile& shipped : episode::ShippedScenarios(root))
      if (pattern == shipped.name || pattern == episode::IdOf(shipped))
        named.push_back(episode::ScenarioAt(all, shipped.path));
    if (named.size() > before) continue;
    if (!IsFile(pattern)) return tl::unexpected(NoSelection{.why = WhyNoMatch(pattern, all)});
    const episode::EpisodeKind kind = episode::EpisodeKindOf(pattern);
    if (kind == episode::EpisodeKind::kTakes) {
      const auto takes = episode::FindTakes({&pattern, 1}, "", root);
      if (!takes)
        return tl::unexpected(
            NoSelection{takes.error().exit_code, takes.error().message.empty()
                                                     ? grammar::Format(takes.error().diagnostics)
                                                     : takes.error().message});
      for (const episode::Take& take : *takes)
        named.push_back(episode::ScenarioOf(take.episode, all));
      continue;
    }
    if (kind != episode::EpisodeKind::kEpisodeFile) {
      named.push_back(episode::ScenarioAt(all, pattern));
      if (kind == episode::EpisodeKind::kJsonLines)
        named.back().origin = episode::Origin::kRecording;
      continue;
    }
    NoSelection none;
    std::ranges::move(KeptIn(pattern, all, none), std::back_inserter(named));
    if (!none.why.empty()) return tl::unexpected(std::move(none));
  }
  std::ranges::sort(named, {}, [](const episode::ScenarioFile& file) {
    return std::tuple(!file.in_project, file.skill, file.name, file.path, file.episode);
  });
  const auto same = [](const episode::ScenarioFile& a, const episode::ScenarioFile& b) {
    return a.path == b.path && a.episode == b.episode;
  };
  named.erase(std::unique(named.begin(), named.end(), same), named.end());
  const scenario::ScenarioLibrary library = episode::ProjectLibrary(root);
  ScenarioSelection selection;
  const auto passes = [&](const episode::ScenarioFile& file) {
    return std::ranges::all_of(
        filters, [&](const std::string& filter) { return PassesFilter(file, filter, library); });
  };
  std::ranges::copy_if(named, std::back_inserter(selection.scenarios), passes);
  std::ranges::copy_if(
      lost, std::back_inserter(selection.orphans), [&](const UnreferencedGolden& orphan) {
        const episode::ScenarioFile file = Missing(orphan);
        const auto names = [&](const std::string& pattern) { return Matches(pattern, file); };
        return (patterns.empty() || std::ranges::any_of(patterns, names)) && passes(file);
      });
  if (!selection.scenarios.empty() || !selection.orphans.empty()) return selection;
  std::string problem = "no scenario is selected";
  for (const std::string& filter : filters)
    if (const std::string why = WhyNonePasses(filter, all, library); !why.empty()) problem = why;
  return tl::unexpected(NoSelection{.why = problem + " ('prehend list' shows all)"});
}

std::optional<Shard> ParseShard(std::string_view text) {
  constexpr int kMaxShards = 10'000;
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto [slash, bad_number] = std::from_chars(text.data(), end, shard.number);
  if (bad_number != std::errc() || slash == end || *slash != '/') return std::nullopt;
  const auto [rest, bad_count] = std::from_chars(slash + 1, end, shard.count);
  if (bad_count != std::errc() || (rest != end && (*rest != ':' || rest + 1 == end)))
    return std::nullopt;
  if (rest != end) shard.costs.assign(rest + 1, end);
  if (shard.count > kMaxShards || shard.number < 1 || shard.number > shard.count)
    return std::nullopt;
  return shard;
}

std::string ShardProblem(const std::string& text) {
  return ParseShard(text) ? ""
                          : "found '" + text + "', wanted I/N, like 2/3 for the second of three";
}

Result<std::vector<int>> PartsOf(const Shard& shard, const std::vector<std::string>& names,
                                 std::string* note) {
  std::vector<int> parts(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) parts[i] = static_cast<int>(i) % shard.count + 1;
  if (shard.costs.empty()) return parts;
  const LastPasses::Costs known = LastPasses::ReadCostsOf(shard.costs);
  double sum = 0;
  for (const auto& [name, cost] : known) sum += cost;
  if (!(sum > 0))
    return tl::unexpected(grammar::Diagnostics{
        {.file = shard.costs,
         .message = "no file of costs: wanted a JSON object, {\"SKILL/NAME\": SECONDS, ..}",
         .hint = "'prehend check' writes build/check/costs.json; copy that"}});
  std::vector<std::pair<double, std::size_t>> costs;  // of them the dearest first, then by place
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto cost = known.find(names[i]);
    costs.emplace_back(
        -(cost == known.end() ? sum / static_cast<double>(known.size()) : cost->second), i);
  }
  std::ranges::sort(costs);
  std::vector<double> loads(static_cast<std::size_t>(shard.count));
  double all = 0;
  for (const auto& [cost, i] : costs) {
    const auto least = std::ranges::min_element(loads);
    parts[i] = static_cast<int>(least - loads.begin()) + 1;
    *least -= cost;
    all -= cost;
  }
  const double share = costs.empty() ? 0 : -costs.front().first / all;
  if (note && share > 0 && shard.count > std::ceil(1 / share))
    *note = fmt::format(
        "--shard: {} alone is {:.1f} % of all costs: more than {:.0f} parts end no sooner\n",
        names[costs.front().second], 100 * share, std::ceil(1 / share));
  return parts;
}

void KeepShard(const Shard& shard, const std::vector<int>& parts, ScenarioSelection& selection) {
  std::vector<episode::ScenarioFile> kept;
  for (std::size_t i = 0; i < selection.scenarios.size(); ++i)
    if (parts[i] == shard.number) kept.push_back(selection.scenarios[i]);
  selection.scenarios = std::move(kept);
  if (shard.number != 1) selection.orphans.clear();
}

}  // namespace prehend::suite
