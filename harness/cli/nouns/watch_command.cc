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
#include <optional>
#include <set>
#include <sstream>

#include "harness/cli/command/command.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/segment_recording.h"
#include "harness/episode/sense/episode_file.h"
#include "harness/exchange/live/live_poses.h"
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

/// Prints what has begun to hold, or holds no more, and is not certain.
episode::OpenEvents PrintOpen(bool as_json, grammar::Tick rate, std::ostream& out) {
  const auto describe = [=](const grammar::Timeline& open) {
    std::string lines;
    for (const grammar::NamedEvent& event : open.events) {
      nlohmann::ordered_json json = {{"event", event.event}, {"begin_tick", event.interval.begin}};
      std::string text = event.event + "  " + truth::SecondsText(event.interval.begin, rate);
      for (std::size_t i = 0; i < event.roles.size(); ++i) {
        if (truth::IsAttribute(event.roles[i])) continue;
        json["roles"][event.roles[i].name] = event.roles[i].value;
        text += "  " + truth::RoleText(event, i);
      }
      if (as_json) text = json.dump(), text.pop_back();  // more follows
      lines += text + "\n";
    }
    return lines;
  };
  const auto take = [=, &out, before = std::set<std::string>()](grammar::Tick now,
                                                                const std::string& open) mutable {
    std::set<std::string> holds;
    std::istringstream lines(open);
    for (std::string line; std::getline(lines, line);) holds.insert(line);
    const auto print = [&](const std::string& line, bool is_open) {
      out << (as_json ? fmt::format("{},\"at_tick\":{},\"open\":{},\"certain\":false}}\n", line,
                                    now, is_open)
                      : fmt::format("{}  {}  {}, not certain\n", truth::SecondsText(now, rate),
                                    line, is_open ? "holds" : "no more"));
    };
    for (const std::string& line : before)
      if (!holds.contains(line)) print(line, false);
    for (const std::string& line : holds)
      if (!before.contains(line)) print(line, true);
    out.flush();
    before = std::move(holds);
  };
  return {.describe = describe, .take = take};
}

constexpr double kMostAhead_s = 10;
constexpr std::size_t kMostKinds = 100;  ///< of faults that are counted apart

/// Lines of a recording, or with a map those of a table of poses, as they come. Faulty ones are
/// reported and left out.
class LineWatcher {
 public:
  LineWatcher(const std::string& name, const std::string& map, const CommandContext& context)
      : name_(name), context_(context), stream_(name) {
    stream_.DoubtFrames(kMostAhead_s);
    if (!map.empty()) live_.emplace(name, map);
  }

  ExitCode Watch(std::istream& in, const ParsedOptions& options) {
    while (!stream_.has_header()) {
      if (!Take(in)) return EndsTooEarly();
      if (!wrong_.empty() && !wrong_.front().is_warning) return Complain(context_, wrong_);
    }
    const grammar::EntityTable& entities = stream_.header().entity_table;
    const Result<grammar::Overrides> settings = episode::ParameterSettings(options.All("--set"));
    if (!settings) return Complain(context_, settings.error());
    const grammar::CompileResult compiled = episode::LoadGrammarOf(
        stream_.header(), options.Text("--grammar"), context_.root, *settings);
    if (!compiled.program) return Complain(context_, compiled.diagnostics);
    Warn(context_, episode::Warnings(*compiled.program, entities));
    for (const std::string& note : live_ ? live_->notes() : std::vector<std::string>())
      context_.err << "warning: " << note << "\n";
    const episode::Segmentation watched = episode::Segment(
        compiled.program, entities,
        [&](const std::function<void(const episode::FrameNews&)>& take) {
          do {
            if (!live_ || live_->has_frame())
              for (episode::EpisodeFrame& frame : stream_.frames()) take(Moved(frame));
          } while (context_.out && Take(in));
          return std::max<grammar::Tick>(stream_.end_tick() + moved_.value_or(0), 1);
        },
        [&](const grammar::Timeline& decided) {
          Print(decided, options.Has("--json"), context_.out);
        },
        options.Has("--open")
            ? PrintOpen(options.Has("--json"), entities.ticks_per_second, context_.out)
            : episode::OpenEvents{});
    if (!watched.problem.empty())
      return Refuse(context_, "the grammar cannot segment this recording: " + watched.problem);
    return End();
  }

 private:
  /// The next line; after the last one, what it has not finished. False at the end.
  bool Take(std::istream& in) {
    std::string line;
    std::size_t bytes = 0;
    if (ended_) return false;
    ended_ = !NextLine(in, line, bytes);
    if (ended_ && !live_) return false;
    ++line_;
    if (bytes > episode::kMaxEpisodeLineBytes)
      line = "a line of " + std::to_string(bytes) + " bytes";
    wrong_ = !live_   ? stream_.Take(line)
             : ended_ ? live_->Finish(stream_)
                      : live_->Take(line, stream_);
    if (!stream_.has_header()) return !ended_;
    Count(wrong_);
    return true;
  }

  grammar::Frame Moved(episode::EpisodeFrame& frame) {
    if (!moved_) {
      moved_ = episode::MovedBy(frame.tick);
      context_.err << episode::MovedText(stream_.header(), *moved_) << std::flush;
    }
    grammar::Frame moved = frame.View();
    moved.tick += *moved_;
    return moved;
  }

  void Count(const grammar::Diagnostics& wrong) {
    if (wrong.empty()) return;
    if (!wrong.front().is_warning) ++skipped_;
    std::string kind = wrong.front().message;
    std::erase_if(kind, [](unsigned char c) { return std::isdigit(c) || c == '.'; });
    if (faults_.size() >= kMostKinds && !faults_.contains(kind)) kind = "others";
    auto& [count, first] = faults_[kind];
    if (++count > 1) return;
    first = wrong.front().message;
    context_.err << grammar::Format(wrong) << std::flush;
  }

  ExitCode EndsTooEarly() const {
    return Refuse(context_, name_ + " ended before its first frame");
  }

  ExitCode End() {
    if (!moved_ && stream_.end_tick() == 0) return EndsTooEarly();
    Count(stream_.LeftOut());
    context_.err << stream_.gaps();
    for (const auto& [kind, fault] : faults_) {
      if (const auto& [count, first] = fault; count > 1)
        context_.err << fmt::format("prehend: {}: {} lines in all, the first: {}\n", name_, count,
                                    first);
    }
    if (!stream_.says_its_end() && !live_ && context_.out)  // else it was not read to its end
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
  std::optional<exchange::LivePoses> live_;  ///< with a map
  std::optional<grammar::Tick> moved_;       ///< since the first frame
  bool ended_ = false;
  grammar::Diagnostics wrong_;  ///< with the last line
  std::size_t line_ = 0, skipped_ = 0;
  /// By message, without its numbers: how many, and the first of them.
  std::map<std::string, std::pair<std::size_t, std::string>> faults_;
};

/// A run or a recording of an episode file, or a scenario while it is played.
ExitCode WatchEpisode(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(auto episode, OpenEpisodeOrComplain(options.Text("EPISODE"), options, context));
  if (options.Has("--map"))
    return Refuse(context, "--map is for tables of poses; an episode says what it means");
  Warn(context, episode.loaded().warnings);
  episode::Episode::End end;
  const episode::Segmentation watched = episode::Segment(
      episode.program(), episode.entities(),
      [&](const std::function<void(const episode::FrameNews&)>& take) {
        end = episode.EachFrame([&](const grammar::Frame& frame) { take(frame); });
        return end.tick;
      },
      [&](const grammar::Timeline& decided) { Print(decided, options.Has("--json"), context.out); },
      options.Has("--open")
          ? PrintOpen(options.Has("--json"), episode.entities().ticks_per_second, context.out)
          : episode::OpenEvents{});
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
  const std::string map = options.Text("--map");
  if (typed == "-") return LineWatcher("standard input", map, context).Watch(std::cin, options);
  std::error_code error;
  if (std::filesystem::is_directory(typed, error))
    return Refuse(context, typed + " is a directory, not a file");
  std::ifstream file(typed, std::ios::binary);
  if (!file) return Refuse(context, typed + ": cannot be read: " + std::strerror(errno));
  return LineWatcher(typed, map, context).Watch(file, options);
}

}  // namespace

Command WatchCommand() {
  return {
      .name = "grammar watch",
      .summary = "Print events while a recording is written, each when it is decided",
      .examples = {"grammar watch - --grammar pick_and_place_from_motion",
                   "grammar watch - --map map.yaml --open", "grammar watch tracker.fifo --json"},
      .options = {Required(Argument("EPISODE",
                                    "lines of a recording (docs/recording-format.md), or with "
                                    "--map of a table of poses or of\nJSON: -, standard input, a "
                                    "pipe or a file; or an episode file, or a scenario")),
                  Value("--map", "MAP.yaml",
                        "what the lines of a table of poses or of JSON mean, as in 'import'"),
                  Flag("--open", "also print what holds now and is not certain"), EpisodeOption(),
                  GrammarOption(), ParametersOption(),
                  Flag("--json", "print JSON, one object per event")},
      .run = RunWatch};
}

}  // namespace prehend::cli
