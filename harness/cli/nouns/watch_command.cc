// SPDX-License-Identifier: Apache-2.0
// prehend grammar watch: events of a recording while it is written, each when it is decided.
// Tested by tests/program/watch_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "harness/cli/command/command.h"
#include "harness/episode/run/load_grammar.h"
#include "harness/episode/run/segment_recording.h"
#include "harness/episode/sense/episode_file.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::cli {
namespace {

/// The next line without its end; of one that is too long, its beginning. False at the end.
bool NextLine(std::istream& in, std::string& line, std::size_t& bytes) {
  line.clear();
  bytes = 0;
  std::streambuf& buffer = *in.rdbuf();
  constexpr int kEnd = std::char_traits<char>::eof();
  int c = buffer.sbumpc();
  if (c == kEnd) return false;
  for (; c != kEnd && c != '\n'; c = buffer.sbumpc()) {
    if (bytes++ < episode::kMaxEpisodeLineBytes) line += static_cast<char>(c);
  }
  if (line.ends_with('\r')) line.pop_back();
  return true;
}

/// Prints events as they are decided.
void Print(const grammar::Timeline& decided, bool as_json, std::ostream& out) {
  const grammar::Tick rate = decided.ticks_per_second;
  for (const grammar::NamedEvent& event : decided.events) {
    if (as_json) {
      out << truth::EventJson(event, rate).dump() << "\n";
      continue;
    }
    std::string roles;
    for (std::size_t i = 0; i < event.roles.size(); ++i) roles += "  " + truth::RoleText(event, i);
    out << fmt::format("{}  {}  {}  {}{}{}\n", truth::SecondsText(event.decided, rate), event.event,
                       truth::SecondsText(event.interval.begin, rate),
                       truth::SecondsText(event.interval.end, rate), roles,
                       event.open_end ? "  open_end" : "");
  }
  out.flush();
}

constexpr double kMostAhead_s = 10;
constexpr std::size_t kSaid = 2;  ///< faults of a kind that are said when they come

/// Lines of a recording, as they come. Faulty ones are reported and left out.
class LineWatcher {
 public:
  LineWatcher(const std::string& name, const CommandContext& context)
      : name_(name), context_(context), stream_(name) {
    stream_.DoubtFrames(kMostAhead_s);
  }

  ExitCode Watch(std::istream& in, const ParsedOptions& options) {
    while (!stream_.has_header()) {
      if (!Take(in)) return EndsTooEarly();
      if (!wrong_.empty()) return Complain(context_, wrong_);
    }
    const grammar::EntityTable& entities = stream_.header().entity_table;
    const Result<grammar::Overrides> settings = episode::ParameterSettings(options.All("--set"));
    if (!settings) return Complain(context_, settings.error());
    const grammar::CompileResult compiled = episode::LoadGrammarOf(
        stream_.header(), options.Text("--grammar"), context_.root, *settings);
    if (!compiled.program) return Complain(context_, compiled.diagnostics);
    Warn(context_, episode::Warnings(*compiled.program, entities));
    const episode::Segmentation watched = episode::Segment(
        compiled.program, entities,
        [&](const std::function<void(const episode::FrameNews&)>& take) {
          while (context_.out && Take(in)) {
            if (stream_.frame()) take(stream_.frame()->View());
          }
          return std::max<grammar::Tick>(stream_.end_tick(), 1);
        },
        [&](const grammar::Timeline& decided) {
          Print(decided, options.Has("--json"), context_.out);
        });
    if (!watched.problem.empty())
      return Refuse(context_, "the grammar cannot segment this recording: " + watched.problem);
    return End();
  }

 private:
  /// The next line. False at the end.
  bool Take(std::istream& in) {
    std::string line;
    std::size_t bytes = 0;
    if (!NextLine(in, line, bytes)) return false;
    ++line_;
    if (bytes > episode::kMaxEpisodeLineBytes)
      line = "a line of " + std::to_string(bytes) + " bytes";
    wrong_ = stream_.Take(line);
    if (wrong_.empty() || !stream_.has_header()) return true;
    ++skipped_;
    std::string kind = wrong_.front().message;
    std::erase_if(kind, [](unsigned char c) { return std::isdigit(c) || c == '.'; });
    if (++faults_[kind] <= kSaid) context_.err << grammar::Format(wrong_) << std::flush;
    return true;
  }

  ExitCode EndsTooEarly() const {
    return Refuse(context_, name_ + " ended before its first frame");
  }

  ExitCode End() const {
    if (stream_.end_tick() == 0) return EndsTooEarly();
    context_.err << stream_.gaps();
    for (const auto& [kind, count] : faults_) {
      if (count > kSaid)
        context_.err << fmt::format("prehend: {}: {} lines in all: {}\n", name_, count, kind);
    }
    if (!stream_.says_its_end())
      context_.err << fmt::format(
          "prehend: {} ended after line {} without 'end_tick': what was open ends there\n", name_,
          line_);
    if (skipped_ == 0) return ExitCode::kAgrees;
    return Refuse(context_, fmt::format("{} faulty {} skipped", skipped_,
                                        skipped_ == 1 ? "line was" : "lines were"));
  }

  const std::string name_;
  const CommandContext& context_;
  episode::EpisodeStream stream_;
  grammar::Diagnostics wrong_;  ///< with the last line
  std::size_t line_ = 0, skipped_ = 0;
  std::map<std::string, std::size_t> faults_;  ///< by message, without its numbers
};

/// A run or a recording of an episode file, or a scenario while it is played.
ExitCode WatchEpisode(const ParsedOptions& options, const CommandContext& context) {
  auto episode = OpenEpisodeOrComplain(options.Text("EPISODE"), options, context);
  if (!episode) return episode.error();
  Warn(context, episode->loaded().warnings);
  episode::Episode::End end;
  const episode::Segmentation watched = episode::Segment(
      episode->program(), episode->entities(),
      [&](const std::function<void(const episode::FrameNews&)>& take) {
        end = episode->EachFrame([&](const grammar::Frame& frame) { take(frame); });
        return end.tick;
      },
      [&](const grammar::Timeline& decided) {
        Print(decided, options.Has("--json"), context.out);
      });
  if (!watched.problem.empty())
    return Refuse(context, "the grammar cannot segment this episode: " + watched.problem);
  return end.failure.empty() ? ExitCode::kAgrees
                             : Complain(context, ExitCode::kFailure, end.failure);
}

/// Otherwise lines are expected, whatever they say: of a pipe the first ones are not there yet.
bool IsNoLines(const std::string& typed) {
  std::error_code error;
  const episode::EpisodeKind kind = episode::EpisodeKindOf(typed);
  return kind == episode::EpisodeKind::kEpisodeFile ||
         (kind == episode::EpisodeKind::kScenario && typed != "-" &&
          (!std::filesystem::exists(typed, error) || typed.ends_with(".yaml")));
}

ExitCode RunWatch(const ParsedOptions& options, const CommandContext& context) {
  const std::string typed = options.Text("EPISODE");
  if (IsNoLines(typed)) return WatchEpisode(options, context);
  if (options.Has("--episode"))
    return Refuse(context, fmt::format("--episode needs episode files; {} is none", typed));
  if (typed == "-") return LineWatcher("standard input", context).Watch(std::cin, options);
  std::error_code error;
  if (std::filesystem::is_directory(typed, error))
    return Refuse(context, typed + " is a directory, not a file");
  std::ifstream file(typed, std::ios::binary);
  if (!file) return Refuse(context, typed + ": cannot be read: " + std::strerror(errno));
  return LineWatcher(typed, context).Watch(file, options);
}

}  // namespace

Command WatchCommand() {
  return {
      .name = "grammar watch",
      .summary = "Print events while a recording is written, each when it is decided",
      .examples = {"grammar watch - --grammar pick_and_place_from_motion",
                   "grammar watch tracker.fifo --json"},
      .options = {{.name = "EPISODE",
                   .help = "lines of a recording (docs/recording-format.md): -, standard input, a "
                           "pipe or a file;\nor an episode file, or a scenario",
                   .required = true},
                  EpisodeOption(),
                  GrammarOption(),
                  ParametersOption(),
                  {.name = "--json", .help = "print JSON, one object per event"}},
      .run = RunWatch};
}

}  // namespace prehend::cli
