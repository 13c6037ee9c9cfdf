// SPDX-License-Identifier: Apache-2.0
// prehend report: recorded episodes as one web page. Tested by
// tests/program/report_command_test.cc and tests/program/report_labels_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/quoting.h"
#include "harness/cli/command/command.h"
#include "harness/cli/daily/recogniser_choice.h"
#include "harness/measure/score/score_labels.h"
#include "harness/show/explain/query.h"
#include "harness/suite/check/causes.h"
#include "harness/suite/check/last_pass.h"
#include "harness/suite/check/run_suite.h"
#include "harness/suite/report/report.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::cli {
namespace {

constexpr const char* kDefaultPage = "report.html";
constexpr double kLongest_s = 600;  ///< for one episode

namespace fs = std::filesystem;
using measure::EpisodeToScore;
using truth::LineVerdict;

/// How an event ends and what was measured in it is no matter of labels.
grammar::NamedEvent Plain(grammar::NamedEvent event) {
  event.open_end = false;
  event.values.clear();
  return event;
}

truth::Comparison Compared(const EpisodeToScore& take, const measure::LabelScores& scores,
                           double collar_s) {
  truth::Golden labels{.ticks_per_second = take.truth.ticks_per_second};
  for (const grammar::NamedEvent& event : take.truth.events) {
    truth::GoldenEvent line{.event = Plain(event)};
    if (const auto own = scores.collars_s.find(event.event); own != scores.collars_s.end())
      line.tolerance_ms = static_cast<int>(std::lround(1000 * own->second));
    labels.events.push_back(std::move(line));
  }
  grammar::Timeline found = take.found;
  std::ranges::transform(found.events, found.events.begin(), Plain);
  return truth::Compare(labels, found, truth::TickAt(collar_s, found.ticks_per_second));
}

/// What a page that lies there calls a file.
std::string UrlFrom(const std::string& page, const std::string& file) {
  const fs::path folder = fs::absolute(page).parent_path();
  std::string url;
  for (const char c : fs::absolute(file).lexically_normal().lexically_proximate(folder).string()) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) || std::strchr("/._-~", c);
    url += is_plain ? std::string(1, c)
                    : fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  return url;
}

/// Which event was found in the place of which.
suite::ReportTable ConfusionOf(const std::string& first, const std::string& side,
                               const std::vector<truth::Comparison>& comparisons) {
  constexpr const char* kNothing = "nothing";
  std::map<std::string, std::map<std::string, int>> counts;
  std::map<std::string, int> columns;
  for (const truth::Comparison& comparison : comparisons) {
    for (const truth::Pairing& pairing : comparison.pairings) {
      if (pairing.IsFurtherPiece()) continue;
      const bool has_other_roles = pairing.agreement == LineVerdict::kChanged;
      const std::string found =
          pairing.actual ? pairing.actual->event + (has_other_roles ? " of others" : "") : kNothing;
      ++counts[pairing.expected ? pairing.expected->event : kNothing][found];
      ++columns[found];
    }
  }
  suite::ReportTable table{.title =
                               fmt::format("Rows: {}; columns: what {} has there", first, side)};
  std::vector<std::string>& head = table.rows.emplace_back(1, "");
  for (const auto& [found, _] : columns) head.push_back(found);
  for (auto& [event, row] : counts) {
    std::vector<std::string>& cells = table.rows.emplace_back(1, event);
    for (const auto& [found, _] : columns)
      cells.push_back(row.contains(found) ? std::to_string(row[found]) : "");
  }
  return table;
}

suite::ReportTable AgreementOf(const std::string& first, const measure::Score& score) {
  suite::ReportTable table{
      .title = fmt::format("{}{}, against {}", score.grammar,
                           score.set.empty() ? "" : ", set " + score.set, first),
      .rows = {{"", first, "found", "F1@50, %", "begin, ms", "end, ms"}}};
  const auto add = [&](const measure::EventScore& event) {
    const auto median = [](const measure::TimeErrors& errors) {
      return errors.seconds.empty() ? "" : fmt::format("{:+.0f}", 1000 * errors.Median());
    };
    table.rows.push_back({event.event, std::to_string(event.truths), std::to_string(event.found),
                          fmt::format("{:.1f}", 100 * event.overlap_50.F1()), median(event.begin),
                          median(event.end)});
  };
  for (const measure::EventScore& event : score.events) add(event);
  add(score.total);
  return table;
}

/// Asks `prehend explain` about what sides say; the first one has the number 0.
class Asker {
 public:
  /// `kept`: the takes, as they are opened here.
  Asker(const measure::LabelsRequest& request, const std::vector<episode::EpisodeName>& kept)
      : request_(request), kept_(kept), opener_(request.root) {}

  /// The command about a take, without options.
  std::string Command(std::size_t take) const {
    const episode::EpisodeName& name = request_.takes[take].episode;
    const bool is_scenario = name.origin == episode::Origin::kScenario;
    return suite::CommandAbout("explain", is_scenario ? name.scenario : name.file) +
           (name.number ? fmt::format(" --episode {}", *name.number) : "");
  }

  /// The grammar of a side; labels and programs have no reasons.
  std::optional<episode::GrammarChoice> Grammar(std::size_t side, std::size_t take) const {
    const std::size_t labels = request_.first_is_truth ? 0 : 1;
    const auto& sources = request_.asking.sources;
    const measure::Source source =
        side < labels || sources.empty() ? measure::Source() : sources[side - labels];
    if (side < labels || source.kind != measure::Source::Kind::kGrammar) return std::nullopt;
    const std::string& own = request_.takes[take].episode.asked;
    return episode::GrammarChoice{source.text.empty() ? own : source.text, request_.settings};
  }

  /// A side is asked why it differs, or else the first one; "" if neither can be: not every grammar
  /// knows what others find.
  std::string Question(const truth::Pairing& pairing, std::size_t side, std::size_t take,
                       grammar::Tick ticks_per_second) {
    truth::Pairing turned = pairing;
    std::swap(turned.expected, turned.actual);
    turned.pieces.clear();
    for (const auto& [asked, what] : {std::pair(side, &pairing), {std::size_t{0}, &turned}}) {
      const auto grammar = Grammar(asked, take);
      if (!grammar || !(what->actual || Knows(*grammar, take, what->event()))) continue;
      std::string options;
      for (const std::string& option : suite::OptionsOf(*grammar)) options += option + " ";
      return options + truth::QuestionAbout(*what, ticks_per_second);
    }
    return "";
  }

 private:
  bool Knows(const episode::GrammarChoice& grammar, std::size_t take,
             const grammar::NamedEvent& event) {
    auto episode = opener_.Open(kept_[take], grammar);
    return episode &&
           show::ParseAsk("", truth::AskedAs(event), *episode->program(), episode->entities());
  }

  const measure::LabelsRequest& request_;
  const std::vector<episode::EpisodeName>& kept_;
  episode::EpisodeOpener opener_;
};

/// Adds what one side says of a take to its verdict. `question`: about a difference.
void Add(truth::Comparison comparison, const std::string& side, bool is_only,
         const std::function<std::string(const truth::Pairing&)>& question,
         suite::ScenarioVerdict& verdict) {
  const bool is_first = !verdict.has_golden;
  const std::vector<const truth::Pairing*> differing = comparison.Differing();
  std::vector<suite::Attribution> all = suite::AttributeDifferences(comparison, {}, {});
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].because = (is_only ? "" : side + ": ") + all[i].event;
    all[i].question = question(*differing[i]);
    verdict.attributions.push_back(std::move(all[i]));
  }
  if (!comparison.Agrees()) {
    verdict.verdict = suite::Verdict::kFailed;
    verdict.exit_code = ExitCode::kDiffers;
    verdict.reason +=
        fmt::format("{}{}{} of {} events differ", verdict.reason.empty() ? "" : "; ",
                    is_only ? "" : side + ": ", differing.size(), comparison.pairings.size());
    verdict.details += (is_only ? "" : side + ":\n") +
                       truth::DifferenceText(comparison, [&](const truth::Pairing& pairing) {
                         const std::string asked = question(pairing);
                         return asked.empty() ? "" : verdict.explain + " " + asked;
                       });
  }
  verdict.has_golden = true;
  if (is_first)
    verdict.comparison = std::move(comparison);
  else
    verdict.labelled.others.push_back(std::move(comparison));
}

/// The share of events that differ.
double Differing(const suite::ScenarioVerdict& verdict) {
  double differing = 0, all = 1e-9;
  const auto count = [&](const truth::Comparison& comparison) {
    differing += static_cast<double>(comparison.Differing().size());
    all += static_cast<double>(comparison.pairings.size());
  };
  if (verdict.has_golden) count(*verdict.comparison);
  std::ranges::for_each(verdict.labelled.others, count);
  return differing / all;
}

/// Before anybody is compared. `made_by`: made the page, and repeats what no grammar says.
void Empty(const Asker& asker, std::size_t take, std::size_t sides, const std::string& made_by,
           suite::ScenarioVerdict& verdict) {
  verdict.verdict = suite::Verdict::kPassed;
  verdict.exit_code = ExitCode::kAgrees;
  verdict.has_golden = false;
  verdict.reason = verdict.details = "";
  verdict.attributions.clear();
  verdict.explained = {};
  verdict.explain = asker.Command(take);
  std::set<std::string> commands;
  for (std::size_t side = 0; side <= sides; ++side) {
    const auto grammar = asker.Grammar(side, take);
    if (!grammar) continue;
    std::string command = verdict.explain;
    for (const std::string& option : suite::OptionsOf(*grammar)) command += " " + option;
    commands.insert(std::move(command));
  }
  verdict.command = commands.empty() ? made_by : fmt::format("{}", fmt::join(commands, "\n"));
}

/// Makes the verdicts, one for each take, those of a comparison with the first side ("labels"), and
/// sorts them, the worst first. The header has sides, tables and title. `page`: where it will lie.
/// `warnings`: of videos that are not there.
suite::ReportHeader CompareSides(const measure::LabelScores& scores, const std::string& first,
                                 double collar_s, const std::string& page, Asker& asker,
                                 const std::string& made_by,
                                 std::vector<suite::ScenarioVerdict>& verdicts,
                                 std::string& warnings) {
  suite::ReportHeader header{.title = "Comparison with " + first, .sides = {first}};
  for (std::size_t take = 0; take < verdicts.size(); ++take)
    if (verdicts[take].exit_code != ExitCode::kBadInput)
      Empty(asker, take, scores.opinions.size(), made_by, verdicts[take]);
  for (const measure::Score& score : scores.of_grammars)
    header.tables.push_back(AgreementOf(first, score));
  for (const measure::Opinion& opinion : scores.opinions) {
    header.sides.push_back(opinion.name);
    std::vector<truth::Comparison> comparisons;
    for (const EpisodeToScore& take : opinion.takes) {
      suite::ScenarioVerdict& verdict = verdicts[take.take];
      if (verdict.exit_code == ExitCode::kBadInput) continue;
      comparisons.push_back(Compared(take, scores, collar_s));
      if (!verdict.has_golden)
        for (const auto& [event, moments] : take.moments)
          verdict.labelled.moments.insert(verdict.labelled.moments.end(), moments.labels.begin(),
                                          moments.labels.end());
      const auto question = [&](const truth::Pairing& pairing) {
        return asker.Question(pairing, header.sides.size() - 1, take.take,
                              comparisons.back().ticks_per_second);
      };
      Add(comparisons.back(), opinion.name, scores.opinions.size() == 1, question, verdict);
      if (!take.failure.empty())
        verdict.notes.push_back(opinion.name + " has failed here: " + take.failure);
      if (take.video.empty() || !verdict.labelled.video.empty()) continue;
      std::error_code error;
      if (!fs::is_regular_file(take.video, error))
        warnings += fmt::format("warning: no video {} of {}\n", take.video, take.scenario);
      else
        verdict.labelled.video = UrlFrom(page, take.video);
      // Dates of labels say nothing of a video.
      if (std::abs(take.offset_s) < 1e8) verdict.labelled.offset_s = take.offset_s;
    }
    header.tables.push_back(ConfusionOf(first, opinion.name, comparisons));
  }
  header.scores = measure::LabelScoresText(scores, true);
  std::ranges::stable_sort(verdicts, std::greater{}, Differing);
  return header;
}

std::vector<suite::ScenarioVerdict> VerdictsOf(const std::vector<episode::EpisodeName>& episodes,
                                               const std::string& grammar, bool hears_who_is_named,
                                               const ParsedOptions& options,
                                               const CommandContext& context) {
  const std::vector<episode::ScenarioFile> all = episode::ListScenarios(context.root);
  suite::ScenarioSelection selection;
  std::ranges::transform(episodes, std::back_inserter(selection.scenarios),
                         [&](const auto& episode) { return episode::ScenarioOf(episode, all); });
  suite::SuiteRequest request{
      .selection = std::move(selection),
      .changes = {grammar, options.All("--set")},
      .root = context.root,
      .today = context.today,
      .pictures = false,
      .replays = suite::Replays::kAll,
      .limits = {.jobs = options.IntOr("--jobs", CoreCount()), .time_limit_s = kLongest_s}};
  if (hears_who_is_named) HearWho(options, request);
  std::vector<suite::ScenarioVerdict> verdicts = suite::RunSuite(request, {});
  // An episode of no scenario of the project is known by its file; on the page by what it is.
  for (std::size_t i = 0; i < verdicts.size(); ++i) verdicts[i].scenario = episodes[i].scenario;
  return verdicts;
}

/// What cannot be read is not on the page; of what could not be judged it says no more than that.
ExitCode ComplainOfUnread(const std::vector<suite::ScenarioVerdict>& verdicts,
                          const CommandContext& context) {
  const auto unread = std::ranges::find_if(verdicts, [](const suite::ScenarioVerdict& verdict) {
    return verdict.exit_code == ExitCode::kBadInput || verdict.reason == "cannot be read" ||
           verdict.reason.starts_with("its process ended");
  });
  if (unread == verdicts.end()) return ExitCode::kAgrees;
  context.err << fmt::format("prehend: {}: {}\n{}", unread->scenario, unread->reason,
                             suite::DetailsText(*unread));
  return unread->exit_code;
}

/// Labels, grammars and others beside each other.
ExitCode ReportSides(std::vector<episode::Take> takes, const std::string& page,
                     const ParsedOptions& options, const CommandContext& context) {
  measure::LabelsRequest request{.root = context.root,
                                 .takes = std::move(takes),
                                 .asking = {.label_map = options.Text("--map")},
                                 .settings = options.All("--set"),
                                 .label_files = options.All("--truth")};
  for (const char* option : {"--grammar", "--recogniser"})
    for (const std::string& typed : options.All(option))
      request.asking.sources.push_back(measure::SourceOf(typed, context.root));
  const bool has_labels = options.Has("--truth") || !request.takes.front().labels.empty();
  request.first_is_truth = !has_labels;
  std::string warnings;
  const auto scores = measure::ScoreLabels(request, warnings);
  context.err << warnings;
  if (!scores) return Complain(context, scores.error());
  context.err << scores->failures;
  // A recording is replayed from an episode file.
  episode::EpisodeKeeper keeper(context.root, context.today);
  const std::string whose = request.asking.WhoseEvents();
  const auto kept = keeper.KeepAll(episode::EpisodesOf(request.takes), whose);
  if (!kept) return Complain(context, kept.error());
  std::vector<suite::ScenarioVerdict> verdicts = VerdictsOf(*kept, whose, false, options, context);
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    verdicts[i].scenario = request.takes[i].episode.scenario;
    verdicts[i].file = keeper.SourceOf(verdicts[i].file);
  }
  const double collar_s = kDefaultCollar_ms / 1000;
  const std::string first = has_labels ? "labels" : scores->first;
  warnings.clear();
  Asker asker(request, *kept);
  suite::ReportHeader header = CompareSides(*scores, first, collar_s, page, asker,
                                            CommandText(context.words), verdicts, warnings);
  context.err << warnings;
  const suite::ReportHeader made =
      suite::HeaderOf(CommandText(context.words), context.root, context.today);
  std::tie(header.command, header.date, header.commit, header.machine) =
      std::tie(made.command, made.date, made.commit, made.machine);
  const std::string problem = WriteTextFile(page, suite::ReportHtml(verdicts, header));
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  const suite::Tally tally = suite::Count(verdicts);
  if (options.Has("--json")) {
    nlohmann::ordered_json json = measure::ScoresJson(scores->of_grammars);
    json["page"] = page;
    json["takes"] = verdicts.size();
    json["agree"] = tally.passed;
    json["differ"] = tally.failed;
    context.out << json.dump(2) << "\n";
  } else {
    context.out << fmt::format("{}: {} take{}, {} as {}, {} differ\n", page, verdicts.size(),
                               verdicts.size() == 1 ? "" : "s", tally.passed,
                               has_labels ? "labelled" : first + " says", tally.failed);
  }
  return scores->failures.empty() ? ComplainOfUnread(verdicts, context) : CodeOf(scores->failures);
}

ExitCode RunReport(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(auto takes, FindTakesOrComplain("EPISODES", options, context));
  const std::string page = options.TextOr("--output", kDefaultPage);
  std::string problem = WhyNotWritable(page);
  if (!problem.empty()) return Refuse(context, "--output: " + problem);
  const bool has_sides =
      options.Has("--truth") || options.All("--grammar").size() > 1 ||
      std::ranges::any_of(takes, [](const episode::Take& take) { return !take.labels.empty(); });
  if (has_sides) return ReportSides(std::move(takes), page, options, context);
  if (options.Has("--map")) return Refuse(context, "--map needs --truth: where are the labels?");
  std::vector<suite::ScenarioVerdict> verdicts =
      VerdictsOf(episode::EpisodesOf(takes), options.Text("--grammar"), true, options, context);
  for (const suite::ScenarioVerdict& verdict : verdicts) context.err << verdict.warnings;
  // A grammar or parameter that no episode can be judged with: there is nothing to show.
  const auto is_unread = [](auto& verdict) { return verdict.exit_code == ExitCode::kBadInput; };
  if (std::ranges::all_of(verdicts, is_unread)) return ComplainOfUnread(verdicts, context);
  suite::ReportHeader header =
      suite::HeaderOf(CommandText(context.words), context.root, context.today);
  header.title = "Recorded episodes";
  problem = WriteTextFile(page, suite::ReportHtml(verdicts, header));
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  const suite::Tally tally = suite::Count(verdicts);
  const suite::Failures failures = suite::FailuresOf(verdicts);
  if (options.Has("--json")) {
    nlohmann::ordered_json json = {{"page", page},
                                   {"episodes", verdicts.size()},
                                   {"passed", tally.passed},
                                   {"failed", tally.failed},
                                   {"pending", tally.pending}};
    json["demonstrations"] = suite::FailuresJson(failures);
    context.out << json.dump(2) << "\n";
  } else {
    context.out << fmt::format("{}: {} episode{}, {} passed, {} failed, {} without golden\n", page,
                               verdicts.size(), verdicts.size() == 1 ? "" : "s", tally.passed,
                               tally.failed, tally.pending)
                << suite::FailuresText(failures);
  }
  // What differs or ended badly is on the page.
  return ComplainOfUnread(verdicts, context);
}

}  // namespace

Command ReportCommand() {
  Option grammar = GrammarOption();
  grammar.help +=
      "; several, also of files:FOLDER and programs as in 'score --recogniser', are compared with "
      "the labels, or with the first";
  grammar.repeatable = true;
  return {.name = "report",
          .summary = "Write recorded episodes as one web page: events, differences, 3D replay",
          .examples = {"report milk.episodes", "report suite.episodes more.episodes -o page.html",
                       "report suite.episodes --episode 'slide/*' --grammar my/rules.grammar",
                       "report take1.jsonl take2.jsonl --truth labels --map labels.yaml",
                       "report takes.yaml --grammar old.grammar --grammar files:predictions"},
          .options = {EpisodesArgument(), EpisodesOption(),
                      OutputOption(fmt::format("the page; default: {}", kDefaultPage)),
                      JobsOption(), grammar, SettingsOption(), RecogniserOption(),
                      Repeatable(
                          Value("--truth", "FILE|FOLDER",
                                "compare with labels by people: one file for each recording, one "
                                "table of all, or a folder (docs/labels.md); may be repeated")),
                      MapOption(), JsonOption()},
          .run = RunReport};
}

}  // namespace prehend::cli
