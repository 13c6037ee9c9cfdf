// SPDX-License-Identifier: Apache-2.0
// prehend watch: events of a recording while it is written, each when it is decided.
// Tested by tests/program/watch_test.cc
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "grammar/name_events.h"
#include "harness/command/command.h"
#include "harness/run/load_grammar.h"
#include "harness/run/run_text.h"
#include "harness/sense/episode_stream.h"
#include "harness/timeline/event_text.h"
#include "harness/timeline/timeline_json.h"

namespace prehend::harness {
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
    if (bytes++ < kMaxEpisodeLineBytes) line += static_cast<char>(c);
  }
  if (line.ends_with('\r')) line.pop_back();
  return true;
}

class Watcher {
 public:
  Watcher(const ParsedOptions& options, const CommandContext& context)
      : options_(options), context_(context), stream_(NameOf(options)) {}

  ExitCode Watch(std::istream& in) {
    std::string line;
    for (std::size_t bytes = 0; context_.out && NextLine(in, line, bytes);) {
      ++line_;
      if (bytes > kMaxEpisodeLineBytes) line = "a line of " + std::to_string(bytes) + " bytes";
      const grammar::Diagnostics found = stream_.Take(line);
      if (!found.empty()) {
        if (!stream_.has_header()) return Complain(context_, found);
        context_.err << grammar::Format(found) << std::flush;
        ++skipped_;
        continue;
      }
      if (stream_.has_header() && !monitor_) {
        if (const auto refused = Begin()) return *refused;
      }
      if (!stream_.frame()) continue;
      monitor_->Advance(stream_.frame()->View(), events_);
      Print();
    }
    return End();
  }

  static std::string NameOf(const ParsedOptions& options) {
    const std::string typed = options.Text("recording");
    return typed == "-" ? "standard input" : typed;
  }

 private:
  /// The first line is there. An exit code if it cannot be watched.
  std::optional<ExitCode> Begin() {
    Result<grammar::Overrides> settings = ParameterSettings(options_.All("--set"));
    if (!settings) return Complain(context_, settings.error());
    grammar::CompileResult compiled =
        LoadGrammarOf(stream_.header(), options_.Text("--grammar"), context_.root, *settings);
    if (!compiled.program) return Complain(context_, compiled.diagnostics);
    program_ = std::move(compiled.program);
    Warn(context_, Warnings(*program_, stream_.header().entity_table));
    monitor_.emplace(program_, stream_.header().entity_table);
    if (monitor_->error().empty()) return std::nullopt;
    return Complain(context_, ExitCode::kBadInput,
                    "the grammar cannot segment this recording: " + monitor_->error());
  }

  void Print() {
    if (events_.empty()) return;
    const grammar::EntityTable& table = stream_.header().entity_table;
    const grammar::Tick rate = table.ticks_per_second;
    for (const grammar::NamedEvent& event : grammar::NameEvents(*program_, table, events_).events) {
      if (options_.Has("--json")) {
        context_.out << harness::EventJson(event, rate).dump() << "\n";
        continue;
      }
      std::string roles;
      for (std::size_t i = 0; i < event.roles.size(); ++i) roles += "  " + RoleText(event, i);
      context_.out << fmt::format("{}  {}  {}  {}{}{}\n", SecondsText(event.decided, rate),
                                  event.event, SecondsText(event.interval.begin, rate),
                                  SecondsText(event.interval.end, rate), roles,
                                  event.open_end ? "  open_end" : "");
    }
    context_.out.flush();
    events_.clear();
  }

  ExitCode End() {
    if (!monitor_ || stream_.end_tick() == 0)
      return Complain(context_, ExitCode::kBadInput,
                      NameOf(options_) + " ended before its first frame");
    monitor_->Finish(stream_.end_tick(), events_);
    Print();
    context_.err << stream_.gaps();
    if (!stream_.says_its_end())
      context_.err << fmt::format(
          "prehend: {} ended after line {} without 'end_tick': what was open ends there\n",
          NameOf(options_), line_);
    if (skipped_ == 0) return ExitCode::kAgrees;
    return Complain(
        context_, ExitCode::kBadInput,
        fmt::format("{} faulty {} skipped", skipped_, skipped_ == 1 ? "line was" : "lines were"));
  }

  const ParsedOptions& options_;
  const CommandContext& context_;
  EpisodeStream stream_;
  std::shared_ptr<const grammar::Program> program_;
  std::optional<grammar::Monitor> monitor_;
  std::vector<grammar::Event> events_;
  std::size_t line_ = 0, skipped_ = 0;
};

ExitCode RunWatch(const ParsedOptions& options, const CommandContext& context) {
  const std::string typed = options.Text("recording");
  Watcher watcher(options, context);
  if (typed == "-") return watcher.Watch(std::cin);
  std::error_code error;
  if (std::filesystem::is_directory(typed, error))
    return Complain(context, ExitCode::kBadInput, typed + " is a directory, not a file");
  std::ifstream file(typed, std::ios::binary);
  if (!file)
    return Complain(context, ExitCode::kBadInput,
                    typed + ": cannot be read: " + std::strerror(errno));
  return watcher.Watch(file);
}

}  // namespace

Command WatchCommand() {
  return {
      .name = "watch",
      .summary = "Print events while a recording is written, each when it is decided",
      .examples = {"watch - --grammar pick_and_place_from_motion", "watch tracker.fifo --json"},
      .options = {{.name = "recording",
                   .help = "lines of a recording (docs/recording-format.md): -, standard input, "
                           "a pipe or a file",
                   .required = true},
                  GrammarOption(),
                  {.name = "--set",
                   .help = "set a parameter of the grammar (reach_radius=25cm); may be repeated",
                   .placeholder = "NAME=VALUE",
                   .repeatable = true},
                  {.name = "--json", .help = "one JSON object per event"}},
      .run = RunWatch};
}

}  // namespace prehend::harness
