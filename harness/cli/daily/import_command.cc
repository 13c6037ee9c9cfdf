// SPDX-License-Identifier: Apache-2.0
// prehend import: poses of a tracker become a recording, recordings become episodes.
// Tested by tests/program/import_test.cc
#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/content_hash.h"
#include "harness/base/base/quoting.h"
#include "harness/base/base/text_file.h"
#include "harness/cli/command/command.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/episodes/record_episode.h"
#include "harness/episode/episodes/recordings.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/segment_recording.h"
#include "harness/exchange/import/import_poses.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::cli {
namespace {

/// Says what the grammar will miss. Its exit code: kNothing if it can recognise nothing.
ExitCode LookWith(const grammar::Program& program, episode::Recording& episode,
                  const CommandContext& context) {
  Warn(context, episode::Warnings(program, episode.header.entity_table));
  const episode::MissingFacts missing = episode::FindMissingFacts(episode, program);
  context.err << missing.warnings;
  return missing.nothing_left ? ExitCode::kNothing : ExitCode::kAgrees;
}

/// What is said of many demonstrations is said once: with the name of the first one.
class OnceEach {
 public:
  explicit OnceEach(std::ostream& err) : err_(err) {}
  ~OnceEach() {
    for (const auto& [key, one] : said_)
      err_ << one.first
           << (one.second > 1 ? fmt::format(" (and so of {} others)", one.second - 1) : "") << "\n";
  }
  void Say(const std::string& text) {
    std::string key = text;
    std::erase_if(key, [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-'; });
    ++said_.try_emplace(key, text, 0).first->second.second;
  }

 private:
  std::ostream& err_;
  std::map<std::string, std::pair<std::string, std::size_t>> said_;
};

/// Writes JSON Lines, or adds an episode where `output` is an episode file. `source`: what the
/// recording was read from. `grammar`: the one whose events the episode has; empty: its own. Prints
/// what is wrong. What the file has already is not added again.
ExitCode WriteRecording(episode::Recording& recording, const std::string& output,
                        const std::string& source, const std::string& grammar,
                        const CommandContext& context, OnceEach& warnings) {
  if (episode::IsEpisodeFile(output)) {
    const auto imported = episode::ImportRecording({.file = output,
                                                    .root = context.root,
                                                    .source = source,
                                                    .grammar = grammar,
                                                    .recorded_on = context.today,
                                                    .program_hash = ProgramHash(),
                                                    .once = true},
                                                   recording);
    if (!imported) return Complain(context, imported.error());
    if (imported->was_there)
      warnings.Say(output + ": it has this recording already; it is not added again");
    return imported->problem.empty() ? ExitCode::kAgrees : Refuse(context, imported->problem);
  }
  AtomicFile file(output);
  if (!file.problem().empty()) return Refuse(context, file.problem());
  episode::EpisodeWriter writer(file.stream(), recording.header);
  recording.EachFrame([&](episode::EpisodeFrame& frame) { writer.Write(frame.View()); });
  if (recording.says_its_end) writer.Finish(recording.end_tick);
  const std::string problem = file.Commit();
  return problem.empty() ? ExitCode::kAgrees : Complain(context, ExitCode::kFailure, problem);
}

/// A recording becomes an episode, without a map.
ExitCode ImportLines(const std::string& file, const ParsedOptions& options,
                     const CommandContext& context) {
  const std::string& output = options.Text("--output");
  for (const char* option : {"--map", "--propose"})
    if (options.Has(option))
      return Refuse(context,
                    fmt::format("{} is for poses; {} is a recording, which says what it means",
                                option, file));
  if (!options.Has("--check") && !episode::IsEpisodeFile(output))
    return Refuse(context,
                  file + " is a recording already; -o NAME.episodes keeps it as an episode");
  Result<episode::Recording> recording = episode::ReadRecording(file);
  if (!recording) return Complain(context, recording.error());
  const std::string grammar = options.Text("--grammar");
  const grammar::CompileResult compiled =
      episode::LoadGrammarOf(recording->header, grammar, context.root);
  if (!compiled.program) return Complain(context, compiled.diagnostics);
  const ExitCode exit_code = LookWith(*compiled.program, *recording, context);
  if (options.Has("--check")) return exit_code;
  OnceEach warnings(context.err);
  const ExitCode written = WriteRecording(*recording, output, file, grammar, context, warnings);
  if (written != ExitCode::kAgrees) return written;
  context.out << fmt::format("{}: {}, {}\n", output, recording->header.episode,
                             grammar::CountOf(recording->frames.size(), "frame"));
  return exit_code;
}

/// Several recordings of one kind: demonstrations of a file, or files of takes.
struct Batch {
  std::string noun;
  std::vector<std::string> names;  ///< groups, or files
  std::function<Result<exchange::Imported>(const std::string& name)> import;
  std::string file;  ///< of demonstrations; else each name is one

  const std::string& SourceOf(const std::string& name) const { return file.empty() ? name : file; }
};

/// Where one of several goes: the episode file, or a file of its own in the folder.
std::string OutputOf(const std::string& output, const Batch& batch, const std::string& episode) {
  if (episode::IsEpisodeFile(output) || !batch.file.empty()) return output;
  return (std::filesystem::path(output) / (FileNameOf(episode) + ".jsonl")).string();
}

double LostSeconds(const exchange::Imported& imported) {
  double lost_s = 0;
  for (const exchange::EntityReport& one : imported.entities) lost_s += one.lost_s;
  return lost_s;
}

std::vector<std::string> RowOf(const Batch& batch, const exchange::Imported& imported) {
  const auto& success = imported.episode.header.attributes.success;
  return {imported.episode.header.episode, std::to_string(imported.frames),
          fmt::format("{:.2f}", imported.duration_s),
          batch.file.empty() ? fmt::format("{:.2f}", LostSeconds(imported))
          : !success         ? "-"
          : *success         ? "yes"
                             : "no"};
}

/// Each becomes an episode. One that is damaged is left out, and named.
ExitCode ImportBatch(const Batch& batch, const ParsedOptions& options,
                     const CommandContext& context) {
  const std::string output = options.Text("--output"), grammar = options.Text("--grammar");
  const bool check = options.Has("--check");
  OnceEach warnings(context.err);
  std::vector<std::vector<std::string>> table = {
      {"episode", "frames", "seconds", batch.file.empty() ? "lost_s" : "success"}};
  std::string first, left_out, last;
  std::set<std::string> taken;
  ExitCode exit_code = ExitCode::kAgrees;
  const auto leave_out = [&](const std::string& name, const std::string& why) {
    const std::string text = "prehend: left out: " + why;
    if (batch.file.empty())
      context.err << text << "\n";
    else
      warnings.Say(text);
    if (std::exchange(last, name) != name)
      left_out += (left_out.empty() ? "; left out: " : ", ") + name;
  };
  for (const std::string& name : batch.names) {
    auto imported = batch.import(name);
    if (!imported) {
      if (batch.file.empty()) leave_out(name, name + ":\n" + grammar::Format(imported.error()));
      for (const grammar::Diagnostic& error : imported.error())
        if (!batch.file.empty()) leave_out(name, error.message);
      continue;
    }
    episode::Recording& episode = imported->episode;
    if (!taken.insert(episode.header.episode).second) {
      leave_out(name, fmt::format("{}: a second one is called '{}'", name, episode.header.episode));
      continue;
    }
    for (const std::string& warning : imported->warnings)
      warnings.Say("warning: " + episode.header.episode + ": " + warning);
    if (first.empty()) {
      const grammar::CompileResult compiled =
          episode::LoadGrammarOf(episode.header, grammar, context.root);
      if (!compiled.program) return Complain(context, compiled.diagnostics);
      if (check) exit_code = LookWith(*compiled.program, episode, context);
      first = exchange::ImportTable(*imported);
    }
    if (!check) {
      if (episode::IsEpisodeFile(output)) episode::BridgeLooks(episode);
      const ExitCode written =
          WriteRecording(episode, OutputOf(output, batch, episode.header.episode),
                         batch.SourceOf(name), grammar, context, warnings);
      if (written != ExitCode::kAgrees) return written;
    }
    table.push_back(RowOf(batch, *imported));
  }
  if (table.size() == 1 && batch.file.empty()) exit_code = ExitCode::kBadInput;
  if (exit_code == ExitCode::kAgrees && !left_out.empty()) exit_code = ExitCode::kDiffers;
  if (output == "-") return exit_code;
  if (!first.empty()) context.out << first << "\n";
  context.out << truth::AlignColumns(table);
  context.out << fmt::format("{} of {} {}{}\n", table.size() - 1, batch.names.size(), batch.noun,
                             left_out);
  return exit_code;
}

ExitCode ImportDemonstrations(const std::string& path, const ParsedOptions& options,
                              const CommandContext& context) {
  const auto import = exchange::DemonstrationImport::Open(path, options.Text("--map"));
  if (!import) return Complain(context, import.error());
  const std::size_t count = import->groups().size();
  if (!options.Has("--check") && count > 1 && !episode::IsEpisodeFile(options.Text("--output")))
    return Refuse(context, fmt::format("{} has {} demonstrations: -o NAME.episodes keeps them all",
                                       path, count));
  if (const grammar::Diagnostics wrong = import->WrongInMap(); !wrong.empty())
    return Complain(context, wrong);
  return ImportBatch({.noun = "demonstrations",
                      .names = import->groups(),
                      .import = [&](const std::string& group) { return import->Import(group); },
                      .file = path},
                     options, context);
}

/// Files of takes, one map for all; of a folder those whose names end as such files do.
ExitCode ImportTakes(const std::vector<std::string>& typed, const ParsedOptions& options,
                     const CommandContext& context) {
  const std::string output = options.Text("--output"), map = options.Text("--map");
  Batch batch{.noun = "takes",
              .import = [&](const std::string& file) { return exchange::ImportPoses(file, map); }};
  std::error_code error;
  for (const std::string& name : typed) {
    if (!std::filesystem::is_directory(name, error)) {
      batch.names.push_back(name);
      continue;
    }
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(name, error))
      if (exchange::IsNamedAsPoses(entry.path().string())) files.push_back(entry.path().string());
    if (files.empty())
      return Complain(context, ExitCode::kNothing, name + " has no files of poses");
    std::ranges::sort(files);
    batch.names.insert(batch.names.end(), files.begin(), files.end());
  }
  if (output == "-") return Refuse(context, "several takes do not go to standard output");
  if (const auto read = ReadYamlFile(map); !read) return Complain(context, read.error());
  if (!output.empty() && !episode::IsEpisodeFile(output)) {
    const bool is_file = output.ends_with(".jsonl") || exchange::IsNamedAsPoses(output);
    if (!is_file) std::filesystem::create_directories(output, error);
    if (is_file || !std::filesystem::is_directory(output, error))
      return Refuse(context,
                    fmt::format("-o {}: of several takes it is a folder or NAME.episodes", output));
  }
  return ImportBatch(batch, options, context);
}

/// Prints a first map, or writes it.
ExitCode ProposeMap(const std::string& poses, const ParsedOptions& options,
                    const CommandContext& context) {
  if (options.Has("--map")) return Refuse(context, "--propose writes a map; it takes none");
  const Result<std::string> map = exchange::ProposedMap(poses);
  if (!map) return Complain(context, map.error());
  const std::string output = options.Text("--output");
  if (output.empty() || output == "-") {
    context.out << *map;
    return ExitCode::kAgrees;
  }
  std::error_code error;
  const auto there = ReadTextFile(output);
  if (std::filesystem::exists(output, error) && !(there && *there == *map))
    return Refuse(context,
                  output + " is there, and has another content: wanted a new name, or - to print");
  AtomicFile file(output, Over::kAnything);
  if (!file.problem().empty()) return Refuse(context, file.problem());
  file.stream() << *map;
  if (const std::string problem = file.Commit(); !problem.empty())
    return Complain(context, ExitCode::kFailure, problem);
  context.out << fmt::format("{0}: fill in what it says, then: {1}\n", output,
                             CommandText({"import", poses, "--map", output, "--check"}));
  return ExitCode::kAgrees;
}

ExitCode RunImport(const ParsedOptions& options, const CommandContext& context) {
  const std::vector<std::string>& typed = options.All("poses");
  const std::string output = options.Text("--output"), poses = typed.front();
  const bool check = options.Has("--check"), propose = options.Has("--propose");
  std::error_code error;
  const bool several = typed.size() > 1 || std::filesystem::is_directory(poses, error);
  if (!propose && check == !output.empty())
    return Refuse(context,
                  "expected either -o, the recording to write, or --check, to write nothing");
  if (several && propose) return Refuse(context, "--propose looks at one file");
  if (several && options.Has("--map")) return ImportTakes(typed, options, context);
  if (const auto format = exchange::PoseFormatOf(poses);
      (options.Has("--map") || propose || several) && !format)
    return Complain(context, format.error());
  if (episode::EpisodeKindOf(poses) == episode::EpisodeKind::kJsonLines && !several &&
      !((options.Has("--map") || propose || !poses.ends_with(".jsonl")) &&
        exchange::IsJsonOfPoses(poses)))
    return ImportLines(poses, options, context);
  if (propose || (check && !options.Has("--map") && !several))
    return ProposeMap(poses, options, context);
  if (!options.Has("--map"))
    return Refuse(context, fmt::format("{} needs --map, a file that says what it means "
                                       "(docs/motion-capture.md); --propose writes a first one",
                                       poses));
  if (!check && output != "-" && !output.ends_with(".jsonl") && !episode::IsEpisodeFile(output))
    return Refuse(context, fmt::format("-o {}: of poses it is NAME.jsonl, NAME.episodes or -; of "
                                       "that, 'episode export' writes other files",
                                       output));
  if (exchange::PoseFormatOf(poses) == exchange::PoseFormat::kHdf5)
    return ImportDemonstrations(poses, options, context);
  auto imported = exchange::ImportPoses(poses, options.Text("--map"));
  if (!imported) return Complain(context, imported.error());
  episode::Recording& episode = imported->episode;
  for (const std::string& warning : imported->warnings)
    context.err << "warning: " << warning << "\n";
  const grammar::CompileResult compiled =
      episode::LoadGrammarOf(episode.header, options.Text("--grammar"), context.root);
  if (!compiled.program) return Complain(context, compiled.diagnostics);
  const ExitCode exit_code = check || options.Has("--grammar")
                                 ? LookWith(*compiled.program, episode, context)
                                 : ExitCode::kAgrees;
  if (!check) {
    if (episode::IsEpisodeFile(output)) episode::BridgeLooks(episode);
    OnceEach warnings(context.err);
    const ExitCode written =
        WriteRecording(episode, output, poses, options.Text("--grammar"), context, warnings);
    if (written != ExitCode::kAgrees) return written;
  }
  if (output != "-") context.out << exchange::ImportTable(*imported);
  return exit_code;
}

}  // namespace

Command ImportCommand() {
  return {
      .name = "import",
      .summary = "Make a recording of a tracker's poses, or an episode of a recording",
      .examples = {"import poses.csv --propose -o bodies.yaml",
                   "import poses.csv --map bodies.yaml --check",
                   "import poses.csv --map bodies.yaml -o take.jsonl",
                   "episode resegment take.jsonl", "import take.jsonl -o takes.episodes"},
      .options =
          {Repeatable(
               Required(Argument("poses",
                                 "files with poses of hands and things: CSV, BVH, MCAP, a bag, "
                                 "HDF5, JSON, .npz or C3D (docs/motion-capture.md), folders of "
                                 "them, or a recording (docs/recording-format.md)"))),
           Value("--map", "MAP.yaml",
                 "of poses, what the file means: unit, axes, times, columns, bodies"),
           OutputOption("the recording (docs/recording-format.md), -: standard output; or an "
                        "episode file, NAME.episodes, to which it is added (docs/episodes.md); of "
                        "several takes a folder; of --propose the map"),
           Flag("--propose", "write a first map for the file, in which sizes are to be filled in"),
           Flag("--check", "write nothing; show what the file has, and what a grammar will miss"),
           Value("--grammar", "GRAMMAR", "the grammar to look with; default: that of the map")},
      .run = RunImport};
}

}  // namespace prehend::cli
