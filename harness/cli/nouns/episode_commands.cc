// SPDX-License-Identifier: Apache-2.0
// Commands about episodes, one after another. prehend episode list: what episode files hold.
// prehend episode verify: their frames, checked against their state hashes. prehend episode merge.
// Tested by tests/program/episodes_test.cc and tests/program/parts.py
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/cli/command/command.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/episodes/episode_file.h"
#include "harness/episode/episodes/plan.h"
#include "harness/episode/episodes/record_episode.h"
#include "harness/episode/run/run_text.h"
#include "harness/exchange/export/export_episode.h"
#include "harness/exchange/knowledge/write_knowledge.h"
#include "harness/exchange/labels/read_truths.h"
#include "harness/exchange/subtasks/label_episodes.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::cli {
namespace {

using Json = nlohmann::ordered_json;

Json RowJson(const std::string& file, const episode::EpisodeRow& row) {
  return {{"file", file},
          {"episode", row.id},
          {"uuid", row.uuid},
          {"scenario", row.scenario},
          {"status", row.status},
          {"seconds", truth::SecondsOf(row.ticks, row.ticks_per_second)},
          {"grammar", row.grammar},
          {"outcome", row.outcome},
          {"state_hash", row.state_hash},
          {"recorded_on", row.recorded_on}};
}

ExitCode RunEpisodes(const ParsedOptions& options, const CommandContext& context) {
  std::vector<std::vector<std::string>> table = {
      {"episode", "status", "seconds", "state_hash", "recorded_on", "scenario"}};
  Json json = Json::array();
  for (const std::string& path : options.All("files")) {
    if (episode::EpisodeKindOf(path) != episode::EpisodeKind::kEpisodeFile) {
      const auto other = episode::FindEpisodes({&path, 1}, "", context.root);
      return other ? Refuse(context, episode::Lack(*other, episode::Need::kEpisodeFile))
                   : Complain(context, other.error());
    }
    const auto file = episode::EpisodeFile::Open(path);
    if (!file) return Complain(context, file.error());
    for (const episode::EpisodeRow& row : file->episodes()) {
      json.push_back(RowJson(path, row));
      table.push_back(
          {std::to_string(row.id), row.status, truth::SecondsText(row.ticks, row.ticks_per_second),
           row.state_hash.empty() ? "-" : row.state_hash, row.recorded_on, row.scenario});
    }
  }
  if (options.Has("--json")) {
    context.out << json.dump(2) << "\n";
  } else {
    context.out << truth::AlignColumns(table);
  }
  return json.empty() ? ExitCode::kNothing : ExitCode::kAgrees;
}

ExitCode RunVerify(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(const auto selected,
              FindEpisodesOrComplain("files", options, context, {episode::Need::kEpisodeFile}));
  const std::vector<episode::Resegmented> results =
      episode::ResegmentAll(selected, {.root = context.root,
                                       .compare = true,
                                       .replay = true,
                                       .jobs = options.IntOr("--jobs", CoreCount())});
  ExitCode worst = ExitCode::kAgrees;
  std::size_t same = 0, unfinished = 0;
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const episode::Resegmented& result : results) {
    const std::string heading = fmt::format("episode {} of {}: {}\n", *result.episode.number,
                                            result.episode.file, result.episode.scenario);
    if (!result.problem.empty()) {
      context.err << result.problem;
      worst = std::max(worst, CodeOf(result.problem));
    } else if (!result.differences.empty()) {
      context.err << heading << result.differences;
      if (worst == ExitCode::kAgrees) worst = ExitCode::kDiffers;
    } else if (result.finished) {
      ++same;
    } else {
      ++unfinished;
    }
    json.push_back({{"file", result.episode.file},
                    {"episode", *result.episode.number},
                    {"scenario", result.episode.scenario},
                    {"finished", result.finished},
                    {"same", result.problem.empty() && result.differences.empty()}});
  }
  if (options.Has("--json")) {
    context.out << json.dump(2) << "\n";
  } else {
    context.out << fmt::format("{} of {} episodes have the frames and events that were recorded\n",
                               same, results.size());
    if (unfinished > 0)
      context.out << fmt::format(
          "{} were cut off while they were recorded: nothing to compare with\n", unfinished);
  }
  return worst;
}

constexpr int kMostParts = 10'000;

ExitCode RunMerge(const ParsedOptions& options, const CommandContext& context) {
  const std::vector<std::string> files = options.All("files");
  const std::string output = options.Text("--output");
  if (!episode::IsEpisodeFile(output))
    return Refuse(context, "--output: found '" + output + "', wanted a file NAME.episodes");
  const auto lock = episode::LockToRecord(output, episode::Writer::kReplaces);
  if (!lock) return Refuse(context, lock.error());
  const auto merged = episode::MergeEpisodes(files, output);
  if (!merged) return Complain(context, merged.error());
  context.out << fmt::format("{}: {} of {}", output, grammar::CountOf(merged->episodes, "episode"),
                             grammar::CountOf(files.size(), "file"));
  if (merged->twice > 0) context.out << fmt::format("; {} were there twice", merged->twice);
  context.out << "\n" << std::flush;
  context.err << merged->notes << merged->missing;
  const int wanted = options.IntOr("--expect", static_cast<int>(files.size()));
  if (wanted != static_cast<int>(files.size()))
    context.err << fmt::format("--expect: found {} files, wanted {}\n", files.size(), wanted);
  const bool whole = merged->missing.empty() && wanted == static_cast<int>(files.size());
  return whole ? ExitCode::kAgrees : ExitCode::kFailure;
}

}  // namespace

Command EpisodesCommand() {
  return {.name = "episode list",
          .summary = "List what episode files hold",
          .examples = {"episode list suite.episodes",
                       "episode list monday.episodes tuesday.episodes --json"},
          .options = {EpisodeFilesArgument(), JsonOption()},
          .run = RunEpisodes};
}

Command VerifyCommand() {
  return {.name = "episode verify",
          .summary = "Read every frame of recorded episodes again and check them by their hashes",
          .examples = {"episode verify suite.episodes",
                       "episode verify suite.episodes --episode 'slide/*'"},
          .options = {EpisodeFilesArgument(), EpisodesOption(), JobsOption(), JsonOption()},
          .run = RunVerify};
}

Command MergeCommand() {
  return {.name = "episode merge",
          .summary = "Make one file of the parts of a suite or of many trials",
          .examples = {"episode merge part-*.episodes -o all.episodes",
                       "episode merge part-*.episodes -o all.episodes --expect 16"},
          .options = {EpisodeFilesArgument(),
                      Required(OutputOption("NAME.episodes, which gets each episode once")),
                      Value("--expect", "N", "so many files must be there: exit code 3",
                            IntegersFrom(1, kMostParts))},
          .run = RunMerge,
          .note =
              "What a part owes and does not have is named, and the exit code is 3; the file is "
              "written all\nthe same, and says so, too. An episode that two files have is written "
              "once if it is the same\nin both; otherwise nothing is written."};
}

// prehend episode resegment: recorded episodes under another grammar, without physics.
// Tested by tests/program/recording_test.cc and tests/program/episodes_test.cc
namespace {

/// "episode 3 of x.episodes"; of what is in no such file its name.
std::string PlaceOf(const episode::EpisodeName& episode) {
  return episode.number ? fmt::format("episode {} of {}", *episode.number, episode.file)
                        : episode.scenario;
}

std::string HeadingOf(const episode::EpisodeName& episode) {
  return PlaceOf(episode) + (episode.number ? ": " + episode.scenario : "") + "\n";
}

/// Results of one episode as `run` prints them, of several one after another; with a comparison
/// only what differs.
void Print(const std::vector<episode::Resegmented>& results, bool compare,
           const CommandContext& context) {
  std::size_t differing = 0;
  for (const episode::Resegmented& result : results) {
    if (!result.problem.empty()) continue;
    const std::string heading = HeadingOf(result.episode);
    if (!compare) {
      if (results.size() > 1) context.out << (&result == &results.front() ? "" : "\n") << heading;
      context.out << episode::RunTable(result.run);
    } else if (!result.differences.empty()) {
      ++differing;
      context.out << heading << result.differences;
    }
  }
  if (compare)
    context.out << fmt::format("{} episode{}, {} with differences\n", results.size(),
                               results.size() == 1 ? "" : "s", differing);
}

void PrintJson(const std::vector<episode::Resegmented>& results, const CommandContext& context) {
  episode::OrderedJson all = episode::OrderedJson::array();
  for (const episode::Resegmented& result : results) {
    if (!result.problem.empty()) continue;
    episode::OrderedJson json = episode::RunJson(result.heading, result.run);
    if (result.episode.number) {
      json["file"] = result.episode.file;
      json["episode"] = *result.episode.number;
    } else if (result.episode.origin == episode::Origin::kRecording) {
      json.erase("state_hash");  // nothing was simulated
    }
    all.push_back(std::move(json));
  }
  if (results.size() == 1 && all.size() == 1) all = episode::OrderedJson(all.front());
  context.out << all.dump(2) << "\n";
}

ExitCode ResegmentEpisodes(const std::vector<episode::EpisodeName>& selected,
                           const ParsedOptions& options, const CommandContext& context) {
  const bool compare = options.Has("--against");
  const std::vector<episode::Resegmented> results =
      episode::ResegmentAll(selected, {.root = context.root,
                                       .choice = {options.Text("--grammar"), options.All("--set")},
                                       .compare = compare,
                                       .jobs = options.IntOr("--jobs", CoreCount())});
  ExitCode worst = ExitCode::kAgrees;
  std::string warned;
  for (const episode::Resegmented& result : results) {
    if (result.warnings != warned) context.err << result.warnings;
    warned = result.warnings;
    if (!result.problem.empty()) {
      context.err << result.problem;
      worst = std::max(worst, CodeOf(result.problem));
    } else if (result.run.status.kind != physics::RunStatus::Kind::kCompleted &&
               worst == ExitCode::kAgrees) {
      context.err << fmt::format("prehend: {} has no good end: {}\n", PlaceOf(result.episode),
                                 episode::StatusText(result.run));
      worst = ExitCode::kFailure;
    }
  }
  if (options.Has("--json"))
    PrintJson(results, context);
  else
    Print(results, compare, context);
  const bool differs = std::ranges::any_of(
      results, [](const episode::Resegmented& result) { return !result.differences.empty(); });
  if (worst == ExitCode::kAgrees &&
      std::ranges::any_of(results, &episode::Resegmented::nothing_left))
    return ExitCode::kNothing;
  return worst == ExitCode::kAgrees && differs ? ExitCode::kDiffers : worst;
}

std::string LabelsProblem(const std::string& file) {
  return exchange::CanWriteLabels(file)
             ? ""
             : "found '" + file + "', wanted a file .csv, .eaf or .TextGrid";
}

/// `-o`: the events of one recording for an annotation program.
ExitCode WriteLabels(const std::vector<episode::EpisodeName>& selected,
                     const ParsedOptions& options, const CommandContext& context) {
  if (selected.size() != 1)
    return Refuse(context, fmt::format("--output writes labels of one recording; {} are selected",
                                       selected.size()));
  Result<episode::Episode> episode = episode::OpenEpisode(
      selected.front(), {options.Text("--grammar"), options.All("--set")}, context.root);
  if (!episode) return Complain(context, episode.error());
  const std::string& file = options.Text("--output");
  const auto labels = exchange::WriteLabels(*episode, options.All("--event"), file, context.today);
  if (!labels) return Complain(context, labels.error());
  context.err << episode->moved();
  context.out << fmt::format("{}: {} labels\n", file, *labels);
  return ExitCode::kAgrees;
}

ExitCode RunResegment(const ParsedOptions& options, const CommandContext& context) {
  if (options.Has("--output")) {
    for (const char* other : {"--against", "--json", "--jobs"}) {
      if (options.Has(other))
        return Refuse(context,
                      fmt::format("--output writes a file of labels: {} does not apply", other));
    }
  }
  if (options.Has("--event") && !options.Has("--output"))
    return Refuse(context, "--event chooses what --output FILE writes; --output is missing");
  const std::vector<episode::Need> needs =
      options.Has("--against") ? std::vector<episode::Need>{episode::Need::kRecordedEvents}
                               : std::vector<episode::Need>{};
  PREHEND_TRY(const auto selected, FindEpisodesOrComplain("EPISODES", options, context, needs));
  return options.Has("--output") ? WriteLabels(selected, options, context)
                                 : ResegmentEpisodes(selected, options, context);
}

}  // namespace

Command ResegmentCommand() {
  return {
      .name = "episode resegment",
      .summary = "Segment recorded episodes again, with any grammar",
      .examples = {"run milk_carton_wrap --record milk.episodes", "episode resegment milk.episodes",
                   "episode resegment milk.episodes --grammar my/rules.grammar --json",
                   "episode resegment milk.jsonl --set lift_rise=10cm",
                   "episode resegment monday.episodes tuesday.episodes --against recorded",
                   "episode resegment suite.episodes --episode 'slide/*' --set slide_speed=3cm/s"},
      .options = {EpisodesArgument(), EpisodesOption(),
                  Value("--against", "recorded",
                        "print only how the events differ from those that were recognised when "
                        "the episode was recorded",
                        OneOf({"recorded"})),
                  JobsOption(), GrammarOption(), ParametersOption(),
                  OutputOption("write the events of one recording for an annotation program "
                               "(docs/labels.md): ELAN (.eaf), Praat (.TextGrid) or .csv",
                               "FILE", {.problem = LabelsProblem}),
                  Repeatable(
                      Value("--event", "NAME",
                            "with --output: write this event instead of all; may be repeated")),
                  JsonOption()},
      .run = RunResegment};
}

// prehend episode export: motion and events for other programs. prehend episode label: sub-tasks of
// demonstrations, written back. prehend episode knowledge: recorded episodes for knowledge bases.
// Tested by tests/program/exported.py, tests/program/labels_back.py and
// tests/program/knowledge_test.cc
namespace {

ExitCode RunExport(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(const auto episodes, FindEpisodesOrComplain("EPISODES", options, context));
  const auto files = exchange::ExportEpisodes(
      episodes, {.root = context.root,
                 .ending = "." + options.Text("--to"),
                 .output = options.Text("--output"),
                 .choice = {options.Text("--grammar"), options.All("--set")}});
  if (!files) return Complain(context, files.error());
  ExitCode worst = ExitCode::kAgrees;
  for (const exchange::Exported& file : *files) {
    context.err << file.warnings;
    context.out << fmt::format("{}: {}, {}\n", file.file, grammar::CountOf(file.frames, "frame"),
                               grammar::CountOf(file.events, "event"));
    if (!file.failure.empty()) worst = Complain(context, ExitCode::kFailure, file.failure);
  }
  return worst;
}

ExitCode RunLabel(const ParsedOptions& options, const CommandContext& context) {
  const std::string output = options.Text("--output");
  const bool is_copy = output.ends_with(".hdf5") || output.ends_with(".h5");
  if (is_copy == options.Has("--to"))
    return Refuse(context, "expected either -o OUT.hdf5, or --to csv|frames with -o FILE");
  PREHEND_TRY(const auto episodes, FindEpisodesOrComplain("EPISODES", options, context));
  const auto labelled = exchange::LabelEpisodes(
      episodes, {.root = context.root,
                 .choice = {options.Text("--grammar"), options.All("--set")},
                 .map = options.Text("--map"),
                 .hdf5 = is_copy ? output : "",
                 .table = output,
                 .frames = options.Text("--to") == "frames"});
  if (!labelled) return Complain(context, labelled.error());
  for (const exchange::Subtasks& one : *labelled) {
    if (!one.missing.empty())
      context.err << "prehend: " << one.episode << " is left without labels: " << one.missing
                  << "\n";
  }
  const auto whole = std::ranges::count(*labelled, "", &exchange::Subtasks::missing);
  context.out << fmt::format("{}: {} of {} episodes are labelled\n", output, whole,
                             labelled->size());
  return whole == std::ssize(*labelled) ? ExitCode::kAgrees : ExitCode::kDiffers;
}

ExitCode RunKnowledge(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(auto episodes, FindEpisodesOrComplain("EPISODES", options, context, {}));
  const std::vector<std::string> forms = options.All("--also");
  const auto asked = [&](const char* form) {
    return std::ranges::find(forms, form) != forms.end();
  };
  const std::string folder = options.TextOr("--output", "kb");
  const TemporaryFolder unfinished;
  if (!unfinished.problem().empty())
    return Complain(context, ExitCode::kFailure, unfinished.problem());
  const std::string made = unfinished.path().string();
  episode::EpisodeKeeper keeper(context.root, context.today, made);
  const auto kept = keeper.KeepAll(episodes);
  if (!kept) return Complain(context, kept.error());
  context.err << keeper.warnings();
  const Result<exchange::KnowledgeWritten> written =
      exchange::WriteKnowledge(*kept, {.root = context.root,
                                       .folder = folder,
                                       .unfinished = made,
                                       .owl = asked("owl"),
                                       .neem = asked("neem")});
  if (!written) return Complain(context, written.error());
  context.out << fmt::format(
      "{}: {} of {}, {}, {}\n", folder, grammar::CountOf(written->episodes, "episode"),
      grammar::CountOf(written->tasks, "task"), grammar::CountOf(written->events, "event"),
      grammar::CountOf(written->statements, "statement"));
  return ExitCode::kAgrees;
}

}  // namespace

Command ExportCommand() {
  return {.name = "episode export",
          .summary = "Write motion and events for other programs: MCAP (ROS 2), CSV, NumPy",
          .examples = {"episode export milk_carton_wrap --to mcap -o bags",
                       "episode export suite.episodes --episode 'slide/*' --to csv -o poses",
                       "episode export take.jsonl --to npz -o take.npz"},
          .options = {EpisodesArgument(), EpisodesOption(),
                      Required(Value("--to", "mcap|csv|jsonl|npz",
                                     "mcap, csv (poses and events), jsonl (a recording) or npz",
                                     OneOf({"mcap", "csv", "jsonl", "npz"}))),
                      Required(OutputOption("the folder, which gets a file per episode; of one "
                                            "episode a file with the format's ending",
                                            "PATH")),
                      GrammarOption(), SettingsOption()},
          .run = RunExport};
}

Command LabelCommand() {
  return {.name = "episode label",
          .summary = "Write the sub-tasks of robot demonstrations back, or as a table",
          .examples = {"episode label demos.episodes --map stack.yaml -o labelled.hdf5",
                       "episode label demos.episodes --map stack.yaml --to frames -o frames.csv"},
          .options = {EpisodesArgument(), EpisodesOption(),
                      Required(Value("--map", "MAP.yaml",
                                     "the map that they were imported with, with its labels")),
                      Value("--to", "csv|frames",
                            "a table instead; csv: a row per sub-task; frames: a row per frame",
                            OneOf({"csv", "frames"})),
                      Required(OutputOption(
                          "NAME.hdf5, a copy of their HDF5 file with signals of sub-tasks, as "
                          "Isaac Lab and MimicGen read them; or the table of --to")),
                      GrammarOption(), ParametersOption()},
          .run = RunLabel};
}

Command KnowledgeCommand() {
  return {
      .name = "episode knowledge",
      .summary = "Write recorded episodes for knowledge bases (RDF, OWL, NEEM)",
      .examples =
          {"episode knowledge suite.episodes -o kb",
           "episode knowledge suite.episodes --episode 'slide/*' --also owl --also neem -o kb"},
      .options = {EpisodesArgument(),
                  OutputOption("the folder; default: kb. It gets prehend.ttl, maps/ and episodes/",
                               "FOLDER"),
                  Repeatable(Value("--also", "owl|neem",
                                   "also as owl (RDF/XML beside each Turtle file) or neem (BSON "
                                   "collections as mongodump writes them); may be repeated",
                                   OneOf({"owl", "neem"}))),
                  EpisodesOption()},
      .run = RunKnowledge};
}

}  // namespace prehend::cli
