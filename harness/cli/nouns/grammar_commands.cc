// SPDX-License-Identifier: Apache-2.0
// Commands about a grammar, one after another. prehend grammar diff, prehend grammar format. Tested
// by tests/program/causes_test.cc and tests/grammar/language/format_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "grammar/contents.h"
#include "grammar/language/parser.h"
#include "grammar/watch_drawing.h"
#include "harness/base/base/atomic_file.h"
#include "harness/base/base/text_file.h"
#include "harness/cli/command/command.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/run/load_run.h"
#include "harness/measure/coverage/coverage.h"
#include "harness/measure/score/score.h"
#include "harness/measure/speed/measure.h"
#include "harness/show/explain/query.h"
#include "harness/show/tracks/tracks.h"
#include "harness/suite/check/settings.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::cli {
namespace {

ExitCode RunDiff(const ParsedOptions& options, const CommandContext& context) {
  suite::Settings sides[2];
  for (int side = 0; side < 2; ++side) {
    const std::string file =
        episode::GrammarFile(context.root, options.Text(side == 0 ? "OLD" : "NEW"));
    const Result<std::string> text = ReadTextFile(file);
    if (!text) return Complain(context, text.error());
    sides[side][".grammar"] = suite::GrammarSettings(*text);
  }
  const std::vector<suite::SettingChange> changes = suite::ChangesBetween(sides[0], sides[1]);
  for (const suite::SettingChange& change : changes) context.out << ChangeText(change) << "\n";
  if (changes.empty()) context.out << "the same rules, clauses and parameters\n";
  return changes.empty() ? ExitCode::kAgrees : ExitCode::kDiffers;
}

ExitCode RunFormat(const ParsedOptions& options, const CommandContext& context) {
  const std::string file = episode::GrammarFile(context.root, options.Text("GRAMMAR"));
  const grammar::CompileResult compiled = episode::LoadGrammar(context.root, file);
  const Result<std::string> text = ReadTextFile(file);
  if (!text) return Complain(context, text.error());
  if (!compiled.program) return Complain(context, compiled.diagnostics);
  context.out << grammar::FormatText({file, *text});
  return ExitCode::kAgrees;
}

}  // namespace

Command DiffCommand() {
  return {.name = "grammar diff",
          .summary = "Say what changed between two grammars: rules, clauses, parameters",
          .examples = {"grammar diff pick_and_place original_2020",
                       "grammar diff old.grammar new.grammar"},
          .options = {Required(Argument("OLD", "a grammar's name or file")),
                      Required(Argument("NEW", "another one"))},
          .run = RunDiff,
          .note =
              "Comments and spaces do not count, nor does the order of rules. Exit code 1: they "
              "differ."};
}

Command FormatCommand() {
  return {
      .name = "grammar format",
      .summary = "Lay out a grammar as those of the library are",
      .examples = {"grammar format pick_and_place", "grammar format my/rules.grammar"},
      .options = {Required(Argument("GRAMMAR", "a grammar's name or file"))},
      .run = RunFormat,
      .note =
          "Comments, line breaks and the columns of '=' and '#' are kept; with errors nothing is "
          "laid out."};
}

// prehend grammar coverage: what episodes show of a grammar. Tested by
// tests/program/coverage_test.cc
namespace {

std::string CoverageFileProblem(const std::string& file) {
  return file.ends_with(".info") ? "" : "found '" + file + "', wanted a file that ends with .info";
}

ExitCode RunCoverage(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(const auto episodes, FindEpisodesOrComplain("EPISODES", options, context));
  const std::string output = options.Text("--output");
  if (!output.empty()) {
    if (const std::string why = WhyNotWritable(output); !why.empty())
      return Refuse(context, "--output: " + why);
  }
  if (!options.Has("--grammar")) {
    if (const auto why = episode::WhyNotOneGrammar(episodes, context.root); !why.empty())
      return Complain(context, why);
  }
  const auto coverage = measure::CoverageOf(
      episodes, {context.root, options.Text("--grammar"), options.IntOr("--jobs", CoreCount())});
  if (!coverage) return Complain(context, coverage.error());
  if (!output.empty()) {
    if (const std::string why = WriteTextFile(output, measure::CoverageLcov(*coverage));
        !why.empty())
      return Complain(context, ExitCode::kFailure, "--output: " + why);
  }
  if (options.Has("--json"))
    context.out << measure::CoverageJson(*coverage).dump() << "\n";
  else
    context.out << measure::CoverageText(*coverage);
  const double least = 100 - options.NumberOr("--within", 100),
               found = coverage->Clauses().percent();
  if (found >= least) return ExitCode::kAgrees;
  context.err << fmt::format("prehend: {:.1f} % of the clauses decided both ways, wanted {:g} %\n",
                             found, least);
  return ExitCode::kDiffers;
}

}  // namespace

Command CoverageCommand() {
  return {.name = "grammar coverage",
          .summary = "What episodes show of a grammar: rules, clauses, both sides of thresholds",
          .examples = {"grammar coverage suite.episodes --grammar my/rules.grammar",
                       "grammar coverage take1.jsonl take2.jsonl --within 10 -o coverage.info"},
          .options = {EpisodesArgument(), GrammarOption(), EpisodesOption(), JobsOption(),
                      Value("--within", "PERCENT",
                            "exit code 1 if more than so many percent of the clauses never "
                            "decided both ways",
                            NumbersFrom(0, 100)),
                      OutputOption("also write a file of lcov for editors and CI, NAME.info",
                                   "FILE", {.problem = CoverageFileProblem}),
                      JsonOption()},
          .run = RunCoverage};
}

// prehend grammar bench. Tested by tests/program/command_line_test.cc
namespace {

/// 1234567 -> "1.23 M"
std::string Large(double value) {
  for (const auto& [unit, size] : {std::pair{" G", 1e9}, {" M", 1e6}, {" k", 1e3}}) {
    if (value >= size) return fmt::format("{:.3g}{}", value / size, unit);
  }
  return fmt::format("{:.3g}", value);
}

std::vector<std::string> Cells(const measure::SpeedFigure& f) {
  return {f.what,
          fmt::format("{:.3g} ns", f.seconds / f.operations * 1e9),
          f.unit,
          Large(f.operations / f.seconds),
          Large(f.events / f.seconds),
          Large(f.simulated_s / f.seconds),
          f.physics_s > 0 ? fmt::format("{:.2f} %", 100 * f.seconds / f.physics_s) : "-"};
}

nlohmann::ordered_json FigureJson(const measure::SpeedFigure& f) {
  nlohmann::ordered_json json = {{"what", f.what},
                                 {"unit", f.unit},
                                 {"operations", f.operations},
                                 {"seconds", f.seconds},
                                 {"ns_per_operation", f.seconds / f.operations * 1e9},
                                 {"operations_per_s", f.operations / f.seconds},
                                 {"events_per_s", f.events / f.seconds},
                                 {"times_real_time", f.simulated_s / f.seconds}};
  if (f.physics_s > 0) json["share_of_physics"] = f.seconds / f.physics_s;
  return json;
}

ExitCode RunBench(const ParsedOptions& options, const CommandContext& context) {
  const auto name = episode::FindEpisode(
      options.TextOr("EPISODE", "pick_and_place/milk_carton_wrap"), "", context.root);
  if (!name) return Complain(context, name.error());
  auto episode = episode::OpenEpisode(*name, {options.Text("--grammar"), {}}, context.root);
  if (!episode) return Complain(context, episode.error());
  std::vector<std::vector<std::string>> rows = {
      {"what", "takes", "per", "per_second", "events/s", "times_real_time", "of_physics"}};
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const measure::SpeedFigure& figure :
       measure::MeasureSpeed(*episode, options.Has("--quick"))) {
    rows.push_back(Cells(figure));
    list.push_back(FigureJson(figure));
  }
  if (options.Has("--json")) {
    context.out << nlohmann::ordered_json{{"figures", list}}.dump(2) << "\n";
  } else {
    context.out << truth::AlignColumns(rows);
    context.out << "On one core, in processor time, the best of several runs.\n";
  }
  return ExitCode::kAgrees;
}

}  // namespace

Command BenchCommand() {
  return {.name = "grammar bench",
          .summary = "Measure how fast a grammar is evaluated on this machine",
          .examples = {"grammar bench", "grammar bench take.jsonl --grammar my/rules.grammar",
                       "grammar bench --json"},
          .options = {Argument("EPISODE",
                               "a scenario, an episode file or a recording whose frames are "
                               "watched; default: milk_carton_wrap"),
                      GrammarOption(),
                      Flag("--quick", "one run instead of five: shows that it runs, not how fast"),
                      JsonOption()},
          .run = RunBench};
}

// prehend grammar recogniser: whether a program of somebody else keeps to the protocol of
// docs/recognisers.md. Tested by tests/program/recogniser_test.cc
namespace {

using measure::Recognised;
using measure::Rule;

/// In the order of `Rule`, and one more.
constexpr const char* kRules[] = {
    "header: the first line comes within 10 s and says \"recogniser\": 1, events, facts",
    "lines: each is a JSON object in UTF-8 of at most 1 MiB that the protocol has",
    "events: each is one of the first line, with its roles and entities of the episode",
    "ticks: they are whole numbers, and no event ends after what it has got",
    "ready: with --pace online it answers each frame",
    "error: it does not give up",
    "end: it ends in time, with exit code 0",
    "again: it prints the same lines for the same episode"};

ExitCode RunRecogniser(const ParsedOptions& options, const CommandContext& context) {
  const auto name = episode::FindEpisode(options.Text("EPISODE"), "", context.root);
  if (!name) return Complain(context, name.error());
  auto episode = episode::OpenEpisode(*name, {}, context.root);
  if (!episode) return Complain(context, episode.error());
  const measure::RecogniserChoice choice{
      .command = options.Text("COMMAND"),
      .pace = options.Text("--pace") == "online"      ? measure::Pace::kOnline
              : options.Text("--pace") == "real_time" ? measure::Pace::kRealTime
                                                      : measure::Pace::kOffline,
      .time_limit_s = kRecogniserLimit_s};
  const measure::WatchedEpisode watched = measure::Watched(*episode);
  const Recognised once = measure::Recogniser(choice).Recognise(watched);
  Recognised twice = once;
  if (!once.broken) twice = measure::Recogniser(choice).Recognise(watched);
  const bool is_same = !twice.broken && twice.events.text == once.events.text;
  int number = 0;
  for (const char* rule : kRules) {
    const bool is_last = number == std::ssize(kRules) - 1;
    const auto one = static_cast<Rule>(number++);
    const bool is_broken =
        is_last ? !once.broken && !is_same : once.broken && once.broken->rule == one;
    // What comes after the line at which it was ended was not seen.
    const bool is_tried = once.broken
                              ? one == Rule::kHeader
                              : one != Rule::kReady || choice.pace == measure::Pace::kOnline;
    context.out << fmt::format("{:9}  {}\n",
                               is_broken  ? "not met"
                               : is_tried ? "met"
                                          : "not tried",
                               rule);
    if (is_broken)
      context.out << (twice.broken ? grammar::Format(twice.broken->what)
                                   : "a seed of its own? PREHEND_SEED is the same for both\n");
  }
  context.out << fmt::format("events: {}\n", once.events.labels.size());
  return is_same ? ExitCode::kAgrees : ExitCode::kDiffers;
}

}  // namespace

Command RecogniserCommand() {
  return {.name = "grammar recogniser",
          .summary = "Try whether a program of yours can be scored",
          .examples = {"grammar recogniser 'python3 reco.py' take1.jsonl",
                       "grammar recogniser ./reco take1.jsonl --pace online"},
          .options = {Required(Argument("COMMAND",
                                        "a program that reads frames and prints events, for the "
                                        "shell (docs/recognisers.md)")),
                      Required(
                          Argument("EPISODE", "a recording, an episode file of one or a scenario")),
                      PaceOption()},
          .run = RunRecogniser};
}

// prehend grammar try: drawn episodes as unit tests of a grammar. Tested by
// tests/program/try_command_test.cc
namespace {

using grammar::DrawnEpisode;
using grammar::DrawnRow;

struct Tried {
  std::string file;
  DrawnEpisode drawn;
  std::vector<DrawnRow> wanted;
  std::vector<DrawnRow> found;

  bool Agrees() const { return !drawn.has_expected || Text(wanted) == Text(found); }
  std::string Name() const {
    return fmt::format("{}:{}{}", file, drawn.line, drawn.title.empty() ? "" : " " + drawn.title);
  }
};

std::vector<DrawnRow> Sorted(std::vector<DrawnRow> rows) {
  std::ranges::sort(rows, {}, &DrawnRow::name);
  return rows;
}

/// The rows that the other ones do not have.
std::vector<DrawnRow> Without(const std::vector<DrawnRow>& rows,
                              const std::vector<DrawnRow>& others) {
  std::vector<DrawnRow> left;
  for (const DrawnRow& row : rows) {
    const bool there = std::ranges::any_of(others, [&](const DrawnRow& other) {
      return other.name == row.name && other.cells == row.cells;
    });
    if (!there) left.push_back(row);
  }
  return left;
}

void Print(const std::vector<DrawnRow>& rows, std::string_view before, std::ostream& out) {
  for (const DrawnRow& row : rows)
    out << fmt::format("  {} {:28}|{}|\n", before, row.name, row.cells);
}

void Print(const Tried& tried, std::ostream& out) {
  if (!tried.drawn.has_expected) {
    out << fmt::format("drawn    {}: it expects nothing; without a line -- this is all\n",
                       tried.Name());
    return Print(tried.found, "found ", out);
  }
  out << fmt::format("{}  {}\n", tried.Agrees() ? "agrees " : "differs", tried.Name());
  if (tried.Agrees()) return;
  Print(Without(tried.wanted, tried.found), "wanted", out);
  Print(Without(tried.found, tried.wanted), "found ", out);
}

nlohmann::ordered_json ToJson(const std::vector<DrawnRow>& rows) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const DrawnRow& row : rows) all.push_back({{"row", row.name}, {"cells", row.cells}});
  return all;
}

ExitCode RunTry(const ParsedOptions& options, const CommandContext& context) {
  Result<grammar::Overrides> settings = episode::ParameterSettings(options.All("--set"));
  if (!settings) return Complain(context, settings.error());
  const grammar::CompileResult compiled =
      episode::LoadGrammar(context.root, options.Text("grammar"), *settings);
  if (!compiled.program) return Complain(context, compiled.diagnostics);
  Warn(context, compiled.warnings);

  std::vector<Tried> all;
  grammar::Diagnostics wrong;
  for (const std::string& path : options.All("drawings")) {
    const Result<std::string> text = ReadTextFile(path);
    if (!text) return Complain(context, text.error());
    const grammar::GrammarText file{ReadableName(path), *text};
    for (DrawnEpisode& drawn : grammar::ReadDrawings(file, wrong)) {
      std::ranges::move(CheckExpected(*compiled.program, drawn, file), std::back_inserter(wrong));
      all.push_back({.file = file.file, .drawn = std::move(drawn)});
    }
  }
  if (!wrong.empty()) return Complain(context, wrong);
  for (Tried& tried : all) {
    const grammar::WatchedDrawing watched = WatchDrawing(compiled.program, tried.drawn);
    if (!watched.error.empty())
      return Complain(context, ExitCode::kFailure, tried.Name() + ": " + watched.error);
    tried.wanted = Sorted(tried.drawn.expected);
    // A row without events says that there are none.
    std::erase_if(tried.wanted, [](const DrawnRow& row) {
      return row.cells.find_first_not_of('.') == std::string::npos;
    });
    tried.found = Sorted(DrawWatched(*compiled.program, tried.drawn, watched.timeline));
  }
  const auto differ = std::ranges::count_if(all, [](const Tried& one) { return !one.Agrees(); });
  const auto expect =
      std::ranges::count_if(all, [](const Tried& one) { return one.drawn.has_expected; });
  if (options.Has("--json")) {
    nlohmann::ordered_json drawings = nlohmann::ordered_json::array();
    for (const Tried& tried : all) {
      drawings.push_back({{"file", tried.file},
                          {"line", tried.drawn.line},
                          {"title", tried.drawn.title},
                          {"agrees", tried.Agrees()},
                          {"expects_nothing", !tried.drawn.has_expected},
                          {"wanted", ToJson(tried.wanted)},
                          {"found", ToJson(tried.found)}});
    }
    context.out << nlohmann::ordered_json{{"grammar", GrammarName(*compiled.program)},
                                          {"drawings", std::move(drawings)}}
                       .dump(2)
                << "\n";
  } else {
    for (const Tried& tried : all) Print(tried, context.out);
    context.out << fmt::format("{} of {} drawings agree\n", expect - differ, expect);
  }
  return differ == 0 ? ExitCode::kAgrees : ExitCode::kDiffers;
}

}  // namespace

Command TryCommand() {
  return {.name = "grammar try",
          .summary = "Try a grammar on drawn episodes: unit tests of rules",
          .examples = {"grammar try my.grammar my_drawings.txt",
                       "grammar try pick_and_place my_drawings.txt --set slide_distance=\"3 cm\"",
                       "grammar try my.grammar my_drawings.txt --json"},
          .options = {Required(Argument("grammar", "a name of the library or a .grammar file")),
                      Repeatable(
                          Required(Argument("drawings", "files with drawings: docs/drawings.md"))),
                      ParametersOption(), JsonOption()},
          .run = RunTry};
}

// prehend grammar tracks: conditions and signals over time, as CSV or JSON.
// Tested by tests/program/explain_command_test.cc
namespace {

/// Which of the names the grammar does not know; "" when it knows all.
std::string UnknownTrack(const std::vector<std::string>& only, const grammar::Program& program) {
  const std::vector<std::string> known = show::TrackNames(program);
  for (const std::string& name : only) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    return fmt::format(
        "--only: found '{}', wanted an event, condition or signal of grammar '{}'; {}", name,
        GrammarName(program),
        grammar::DidYouMean(name, known, fmt::format("known: {}", fmt::join(known, ", "))));
  }
  return "";
}

ExitCode RunTracks(const ParsedOptions& options, const CommandContext& context) {
  std::string output = options.Text("--output");
  if (output == "-") output.clear();
  const bool as_json = options.Has("--json") || output.ends_with(".json");
  if (!output.empty() && !output.ends_with(".json") && !output.ends_with(".csv")) {
    return Refuse(
        context,
        fmt::format("--output: found '{}', wanted a file that ends with .csv or .json", output));
  }
  if (options.Has("--json") && output.ends_with(".csv")) {
    return Refuse(context, "--json contradicts an --output that ends with .csv");
  }
  PREHEND_TRY(auto episode, OpenEpisodeOrComplain(options.Text("EPISODE"), options, context));
  const std::vector<std::string> only = options.All("--only");
  const std::string unknown = UnknownTrack(only, *episode.program());
  if (!unknown.empty()) return Refuse(context, unknown);

  // Found out before the episode is played.
  std::optional<AtomicFile> file;
  if (!output.empty()) file.emplace(output);
  if (file && !file->problem().empty()) return Refuse(context, "--output: " + file->problem());

  const show::Watched watched = show::Watch(episode);
  if (!watched.problem.empty()) return Refuse(context, watched.problem);
  const show::Tracks tracks = show::CollectTracks(*watched.past, {only.begin(), only.end()});
  if (!tracks.problem.empty()) return Refuse(context, tracks.problem);
  if (tracks.tracks.empty())
    return Complain(context, ExitCode::kNothing,
                    only.empty() ? "no track: nothing that the grammar looks at is in this "
                                   "episode; 'prehend episode resegment' says what it lacks"
                                 : "no track: '--only' leaves none");
  std::ostream& out = file ? file->stream() : context.out;
  if (as_json) {
    show::WriteJson(tracks, episode.loaded().scenario.name, GrammarName(*episode.program()), out);
  } else {
    show::WriteCsv(tracks, out);
  }
  if (file) {
    const std::string problem = file->Commit();
    if (!problem.empty()) return Complain(context, ExitCode::kFailure, "--output: " + problem);
    context.out << fmt::format("{}: {}, {}\n", output,
                               grammar::CountOf(tracks.tracks.size(), "track"),
                               grammar::CountOf(tracks.ticks.size(), "frame"));
  }
  return watched.failure.empty() ? ExitCode::kAgrees
                                 : Complain(context, ExitCode::kFailure, watched.failure);
}

}  // namespace

Command TracksCommand() {
  return {
      .name = "grammar tracks",
      .summary = "Write conditions and signals over time, for plots",
      .examples = {"grammar tracks milk_carton_wrap -o milk.csv",
                   "grammar tracks milk_carton_wrap --only grasping --only speed_along",
                   "grammar tracks milk.jsonl -o milk.json"},
      .options = {EpisodeArgument(), EpisodeOption(),
                  OutputOption("the file to write, .csv or .json; - or nothing: print CSV"),
                  Repeatable(Value("--only", "NAME",
                                   "an event, condition or signal (speed_along); may be repeated; "
                                   "default: all")),
                  GrammarOption(), SettingsOption(), JsonOption()},
      .run = RunTracks};
}

}  // namespace prehend::cli
