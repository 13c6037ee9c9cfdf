// SPDX-License-Identifier: Apache-2.0
// Coverage of many episodes, the smallest set of them, and as text, JSON and lcov.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "grammar/base/diagnostic.h"
#include "harness/base/process/worker_pool.h"
#include "harness/episode/episode/episode.h"
#include "harness/measure/coverage/coverage.h"
#include "harness/show/explain/query.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::measure {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Sides, decided, nearest)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Clause, file, line, column, rule, part, text, unit, is_threshold,
                                   began, ended, seen, all)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CoveredRule, name, file, line, column, is_event, bound, begun,
                                   open_end, became, episodes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Coverage, grammar, episodes, smallest, rules, clauses)

namespace {

constexpr double kTimeLimit_s = 3600;
constexpr std::size_t kSlicesPerJob = 4;

/// What one process says of its episodes.
struct Slice {
  Coverage coverage;
  std::string problem;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Slice, coverage, problem)

void Add(Sides& sides, const Sides& more) {
  for (const bool truth : {false, true}) sides.Add(truth, more.nearest[truth], more.decided[truth]);
}

/// Adds what an episode, or several, show of the same grammar. The first one's number is `episode`.
void Add(Coverage& all, const Coverage& one, const std::vector<std::size_t>& numbers) {
  if (all.rules.empty()) {
    all = one;
    for (CoveredRule& rule : all.rules)
      rule = {rule.name, rule.file, rule.line, rule.column, rule.is_event};
    for (Clause& clause : all.clauses) {
      clause.began = clause.ended = 0;
      clause.seen.clear();
      clause.all = {};
    }
  }
  for (std::size_t i = 0; i < one.rules.size(); ++i) {
    CoveredRule& rule = all.rules[i];
    rule.bound += one.rules[i].bound;
    rule.begun += one.rules[i].begun;
    rule.open_end += one.rules[i].open_end;
    for (const auto& [fate, count] : one.rules[i].became) rule.became[fate] += count;
    for (const std::size_t episode : one.rules[i].episodes)
      rule.episodes.push_back(numbers[episode]);
  }
  for (std::size_t i = 0; i < one.clauses.size(); ++i) {
    Clause& clause = all.clauses[i];
    clause.began += one.clauses[i].began;
    clause.ended += one.clauses[i].ended;
    for (const auto& [episode, sides] : one.clauses[i].seen) clause.seen[numbers[episode]] = sides;
    Add(clause.all, one.clauses[i].all);
  }
}

/// What an episode shows: sides of clauses, and rules.
std::vector<std::set<std::size_t>> ShownBy(const Coverage& coverage) {
  std::vector<std::set<std::size_t>> shown(coverage.episodes.size());
  std::size_t aim = 0;
  for (const Clause& clause : coverage.clauses) {
    for (const auto& [episode, sides] : clause.seen) {
      for (const bool truth : {false, true})
        if (sides.IsSeen(truth)) shown[episode].insert(aim + truth);
    }
    aim += 2;
  }
  for (const CoveredRule& rule : coverage.rules) {
    for (const std::size_t episode : rule.episodes) shown[episode].insert(aim);
    ++aim;
  }
  return shown;
}

/// The one that adds most, again and again; then without those that the later ones made needless.
std::vector<std::size_t> Smallest(const Coverage& coverage) {
  const std::vector<std::set<std::size_t>> shown = ShownBy(coverage);
  std::map<std::size_t, int> times;
  std::vector<std::size_t> chosen;
  for (;;) {
    std::size_t best = 0, most = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const auto more = static_cast<std::size_t>(
          std::ranges::count_if(shown[i], [&](std::size_t aim) { return !times.contains(aim); }));
      if (more > most) std::tie(best, most) = std::tuple(i, more);
    }
    if (most == 0) break;
    chosen.push_back(best);
    for (const std::size_t aim : shown[best]) ++times[aim];
  }
  std::erase_if(chosen, [&](std::size_t one) {
    const bool needless =
        std::ranges::all_of(shown[one], [&](std::size_t aim) { return times[aim] > 1; });
    for (const std::size_t aim : shown[one]) times[aim] -= needless;
    return needless;
  });
  std::ranges::sort(chosen);
  return chosen;
}

Slice CoverageOfSlice(const std::vector<episode::EpisodeName>& episodes, std::size_t first,
                      std::size_t step, const CoverageRequest& request) {
  Slice slice;
  episode::EpisodeOpener opener(request.root);
  for (std::size_t i = first, k = 0; i < episodes.size(); i += step, ++k) {
    Result<episode::Episode> episode = opener.Open(episodes[i], {request.grammar, {}});
    if (!episode) return {.coverage = {}, .problem = grammar::Format(episode.error())};
    const show::Watched watched = show::Watch(*episode);
    if (!watched.problem.empty())
      return {.coverage = {}, .problem = episodes[i].scenario + ": " + watched.problem + "\n"};
    Add(slice.coverage, CoverageOf(*watched.past), {k});
  }
  return slice;
}

template <typename All, typename Wanted>
Coverage::Share ShareOf(const All& all, const Wanted& is_covered) {
  return {static_cast<std::size_t>(std::ranges::count_if(all, is_covered)), all.size()};
}

std::string Count(const char* what, const Coverage::Share& share) {
  return fmt::format("{:<34} {:>4} of {:>4}  {:5.1f} %\n", what, share.covered, share.all,
                     share.percent());
}

std::string Near(const Clause& clause, bool truth) {
  if (!clause.all.IsSeen(truth)) return "-";
  const double near = clause.all.nearest[truth];
  if (near == Sides::kFar) return std::to_string(clause.all.decided[truth]);
  return fmt::format("{} ({:.3g}{}{})", clause.all.decided[truth], near,
                     clause.unit.empty() ? "" : " ", clause.unit);
}

std::string NameOf(const std::string& file) { return file.substr(file.rfind('/') + 1); }

}  // namespace

Coverage::Share Coverage::Rules() const {
  return ShareOf(rules, [](const CoveredRule& rule) { return !rule.episodes.empty(); });
}
Coverage::Share Coverage::Decided() const {
  return ShareOf(clauses, [](const Clause& one) { return one.all.IsSeen(0) || one.all.IsSeen(1); });
}
Coverage::Share Coverage::Clauses() const { return ShareOf(clauses, &Clause::HasBothSides); }
Coverage::Share Coverage::Thresholds() const {
  std::vector<Clause> thresholds;
  std::ranges::copy_if(clauses, std::back_inserter(thresholds), &Clause::is_threshold);
  return ShareOf(thresholds, &Clause::HasBothSides);
}

Result<Coverage> CoverageOf(const std::vector<episode::EpisodeName>& episodes,
                            const CoverageRequest& request) {
  const grammar::CompileResult compiled =
      episode::EpisodeOpener(request.root).Compile(episodes.front(), request.grammar, {});
  if (!compiled.program) return tl::unexpected(compiled.diagnostics);
  const std::size_t slices =
      std::min(episodes.size(), kSlicesPerJob * static_cast<std::size_t>(request.jobs));
  std::vector<WorkerJob> jobs;
  for (std::size_t first = 0; first < slices; ++first)
    jobs.push_back(
        [&, first] { return ToWire(CoverageOfSlice(episodes, first, slices, request)); });
  const std::vector<WorkerResult> said =
      RunInWorkers(jobs, {.jobs = request.jobs, .time_limit_s = kTimeLimit_s});
  Coverage all;
  for (std::size_t first = 0; first < slices; ++first) {
    const Slice slice =
        said[first].finished ? FromWire<Slice>(said[first].output) : Slice{{}, said[first].reason};
    if (!slice.problem.empty())
      return tl::unexpected(grammar::Diagnostics{{.message = slice.problem}});
    std::vector<std::size_t> numbers;
    for (std::size_t i = first; i < episodes.size(); i += slices) numbers.push_back(i);
    Add(all, slice.coverage, numbers);
  }
  for (const episode::EpisodeName& name : episodes) all.episodes.push_back(name.scenario);
  for (CoveredRule& rule : all.rules) std::ranges::sort(rule.episodes);
  all.smallest = Smallest(all);
  return all;
}

std::string CoverageText(const Coverage& coverage) {
  std::vector<std::vector<std::string>> rows = {
      {"rule", "bound", "begun", "intervals", "open end", "without interval"}};
  for (const CoveredRule& rule : coverage.rules) {
    std::string became;
    std::int64_t intervals = 0;
    for (const auto& [fate, count] : rule.became) {
      if (fate == "interval")
        intervals = count;
      else
        became += fmt::format("{}{} {}", became.empty() ? "" : ", ", count, fate);
    }
    rows.push_back({rule.name, std::to_string(rule.bound), std::to_string(rule.begun),
                    std::to_string(intervals), std::to_string(rule.open_end), became});
  }
  std::string text = fmt::format("{}, {}\n", coverage.grammar,
                                 grammar::CountOf(coverage.episodes.size(), "episode"));
  text += truth::AlignColumns(rows);
  rows = {{"", "clause", "of", "false", "true", "began", "ended"}};
  for (const Clause& clause : coverage.clauses) {
    std::string says = clause.part + " " + clause.text;
    if (constexpr std::size_t kMost = 70; says.size() > kMost) says = says.substr(0, kMost) + "..";
    rows.push_back({clause.HasBothSides() ? " " : "!", std::move(says),
                    fmt::format("{}:{}:{}", NameOf(clause.file), clause.line, clause.column),
                    Near(clause, false), Near(clause, true), std::to_string(clause.began),
                    std::to_string(clause.ended)});
  }
  text += "\n";
  text += truth::AlignColumns(rows);
  text += "\n" + Count("rules with an interval", coverage.Rules()) +
          Count("clauses that decided", coverage.Decided()) +
          Count("clauses that decided both ways", coverage.Clauses()) +
          Count("thresholds seen from both sides", coverage.Thresholds());
  text += fmt::format("\n{} of {} show as much as all:\n", coverage.smallest.size(),
                      grammar::CountOf(coverage.episodes.size(), "episode"));
  for (const std::size_t one : coverage.smallest) text += "  " + coverage.episodes[one] + "\n";
  return text;
}

nlohmann::json CoverageJson(const Coverage& coverage) {
  const auto share = [](const Coverage::Share& one) {
    return nlohmann::json{{"covered", one.covered}, {"all", one.all}};
  };
  nlohmann::json json = coverage;
  json["shares"] = {{"rules", share(coverage.Rules())},
                    {"decided", share(coverage.Decided())},
                    {"clauses", share(coverage.Clauses())},
                    {"thresholds", share(coverage.Thresholds())}};
  return json;
}

std::string CoverageLcov(const Coverage& coverage) {
  std::set<std::string> files;
  for (const CoveredRule& rule : coverage.rules) files.insert(rule.file);
  for (const Clause& clause : coverage.clauses) files.insert(clause.file);
  std::string text;
  for (const std::string& file : files) {
    std::map<int, std::int64_t> lines;
    text += "TN:\nSF:" + file + "\n";
    for (const CoveredRule& rule : coverage.rules) {
      if (rule.file != file) continue;
      const auto found = rule.became.find("interval");
      const std::int64_t intervals = found == rule.became.end() ? 0 : found->second;
      text += fmt::format("FN:{0},{1}\nFNDA:{2},{1}\n", rule.line, rule.name, intervals);
      lines[rule.line] += intervals;
    }
    int block = 0, branches = 0, taken = 0;
    for (const Clause& clause : coverage.clauses) {
      if (clause.file != file) continue;
      for (const bool truth : {false, true}) {
        const std::int64_t times = clause.all.decided[truth];
        text += fmt::format("BRDA:{},{},{:d},{}\n", clause.line, block, truth, times);
        lines[clause.line] += times;
        ++branches;
        taken += times > 0;
      }
      ++block;
    }
    text += fmt::format("BRF:{}\nBRH:{}\n", branches, taken);
    for (const auto& [line, times] : lines) text += fmt::format("DA:{},{}\n", line, times);
    const auto hit = std::ranges::count_if(lines, [](const auto& one) { return one.second > 0; });
    text += fmt::format("LF:{}\nLH:{}\nend_of_record\n", lines.size(), hit);
  }
  return text;
}

}  // namespace prehend::measure
