// SPDX-License-Identifier: Apache-2.0
// What commands share.
#include "harness/cli/command/command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <thread>
#include <utility>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/quoting.h"
#include "harness/base/base/text_file.h"
#include "harness/base/process/worker_pool.h"
#include "harness/episode/run/run_text.h"

namespace prehend::cli {
namespace {

constexpr std::uint64_t kMemoryLimit_mb = 4000;
// What has no end by itself, or does as much as it is told to: no limit of time unless one is
// given.
constexpr const char* kEndless[] = {"--on-save", "--trials"};

bool HasOption(const Command& command, const std::string& name) {
  return std::ranges::any_of(command.options,
                             [&](const Option& option) { return option.name == name; });
}

WorkerLimits LimitsOf(const ParsedOptions& options, const std::vector<std::string>& endless,
                      double time_limit_s) {
  if (std::ranges::any_of(endless, [&](const std::string& name) { return options.Has(name); }))
    time_limit_s = 0;
#ifdef __SANITIZE_ADDRESS__
  time_limit_s = 0;  // several times slower; shadow memory exceeds any limit
  constexpr std::uint64_t memory_limit_mb = 0;
#else
  const std::uint64_t memory_limit_mb = options.UnsignedOr("--memory-limit-mb", kMemoryLimit_mb);
#endif
  return {.jobs = 1,
          .time_limit_s = options.NumberOr("--time-limit-s", time_limit_s),
          .memory_limit_bytes = memory_limit_mb * kMegabyte};
}

}  // namespace

Command Limited(Command command, double time_limit_s) {
  std::vector<std::string> endless;
  for (const char* name : kEndless) {
    if (HasOption(command, name)) endless.emplace_back(name);
  }
  command.options =
      Joined(std::move(command.options), {TimeLimitOption(0, 86400), MemoryLimitOption()});
  command.run = [run = std::move(command.run), endless, time_limit_s](
                    const ParsedOptions& options, const CommandContext& context) {
    Interrupt interrupt;
    const LimitedEnd end = RunWithinLimits([&] { return static_cast<int>(run(options, context)); },
                                           LimitsOf(options, endless, time_limit_s), &interrupt);
    if (interrupt.Came()) RemoveLeftFolders();
    interrupt.EndProcess();
    if (end.reason.empty()) return static_cast<ExitCode>(end.status);
    const bool by_limit =
        end.reason.starts_with("no end after") || end.reason.starts_with("it needs more memory");
    return Complain(context, ExitCode::kFailure,
                    end.reason + (by_limit ? "; see --time-limit-s and --memory-limit-mb" : ""));
  };
  return command;
}

Command NamingWhatIsMissing(Command command, const std::string& argument) {
  std::vector<std::string> selecting;
  for (const char* name : {"--episode", "--filter"})
    if (HasOption(command, name)) selecting.emplace_back(name);
  command.run = [run = std::move(command.run), argument, selecting](const ParsedOptions& options,
                                                                    const CommandContext& context) {
    const ExitCode code = run(options, context);
    if (code == ExitCode::kBadInput || code == ExitCode::kFailure ||
        std::ranges::any_of(selecting, [&](const auto& name) { return options.Has(name); }))
      return code;
    const Result<std::string> missing = episode::WhatIsMissing(options.All(argument));
    if (!missing) return Complain(context, missing.error());
    if (missing->empty()) return code;
    context.out.flush();
    context.err << *missing;
    return ExitCode::kFailure;
  };
  return command;
}

int CoreCount() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

episode::RunRequest RequestOf(const ParsedOptions& options, const std::string& scenario_file) {
  return {.scenario_file = scenario_file,
          .grammar = options.Text("--grammar"),
          .settings = options.All("--set")};
}

tl::expected<episode::ScenarioFile, ExitCode> FindScenarioOrComplain(
    const std::string& typed, const CommandContext& context) {
  const auto found = episode::FindEpisodes({&typed, 1}, "", context.root);
  if (!found) return tl::unexpected(Complain(context, found.error()));
  const episode::EpisodeName& first = found->front();
  if (const std::string lack = episode::Lacks(first, episode::Need::kScenario); !lack.empty())
    return tl::unexpected(Refuse(context, lack));
  return episode::ScenarioAt(episode::ListScenarios(context.root), first.file);
}

ExitCode Complain(const CommandContext& context, const episode::NotFound& none) {
  if (!none.diagnostics.empty()) return Complain(context, none.diagnostics);
  std::vector<std::string> corrected;
  if (!none.nearest.empty()) {
    corrected = context.words;
    std::ranges::replace(corrected, none.typed, none.nearest);
  }
  return ComplainWithCorrection(context, none.exit_code, none.message, corrected);
}

ExitCode Complain(const CommandContext& context, ExitCode code, const std::string& message) {
  if (code == ExitCode::kBadInput) code = CodeOf(message);
  // What cannot have succeeded is not worth repeating; what failed may be looked into.
  return ComplainWithCorrection(
      context, code, message,
      code == ExitCode::kFailure ? context.words : std::vector<std::string>());
}

ExitCode ComplainWithCorrection(const CommandContext& context, ExitCode code,
                                const std::string& message,
                                const std::vector<std::string>& corrected) {
  const bool is_input =
      message.find(kIsRead) != std::string::npos || message.find(kIsDamaged) != std::string::npos;
  if (is_input && code == ExitCode::kFailure)
    return ComplainWithCorrection(context, ExitCode::kBadInput, message, {});
  context.err << "prehend: " << message << "\n";
  if (!corrected.empty()) context.err << "  again: " << CommandText(corrected) << "\n";
  return code;
}

ExitCode Complain(const CommandContext& context, const grammar::Diagnostics& diagnostics) {
  constexpr std::size_t kMaxPrinted = 100;  // nobody reads on
  const std::size_t printed = std::min(diagnostics.size(), kMaxPrinted);
  for (std::size_t i = 0; i < printed; ++i) context.err << Format(diagnostics[i]);
  if (printed < diagnostics.size())
    context.err << "and " << (diagnostics.size() < grammar::kMostDiagnostics ? "" : "at least ")
                << diagnostics.size() - printed << " more\n";
  const bool can_be_fixed = std::ranges::any_of(diagnostics, [](const auto& diagnostic) {
    std::error_code error;
    return std::filesystem::exists(diagnostic.file, error);
  });
  if (can_be_fixed) context.err << "  again: " << CommandText(context.words) << "\n";
  return diagnostics.empty() ? ExitCode::kBadInput : CodeOf(diagnostics.front().message);
}

ExitCode WarnOfScenariosNotRun(const CommandContext& context) {
  const std::vector<std::string> files = episode::ScenariosNotRun(context.root);
  for (const std::string& file : files)
    context.err << fmt::format(
        "{}: {}: it is not run: scenarios end in .yaml, and lie in scenarios/ or "
        "scenarios/SKILL/\n",
        ReadableName(file), context.in_ci ? "error" : "warning");
  return files.empty() || !context.in_ci ? ExitCode::kAgrees : ExitCode::kBadInput;
}

ExitCode Refuse(const CommandContext& context, const std::string& message) {
  return Complain(context, ExitCode::kBadInput, message);
}

void Warn(const CommandContext& context, const grammar::Diagnostics& warnings) {
  if (!warnings.empty()) context.err << Format(warnings);
}

tl::expected<std::vector<episode::Take>, ExitCode> FindTakesOrComplain(
    const std::string& argument, const ParsedOptions& options, const CommandContext& context) {
  return episode::FindTakes(options.All(argument), options.Text("--episode"), context.root)
      .map_error([&](const episode::NotFound& none) { return Complain(context, none); });
}

tl::expected<std::vector<episode::EpisodeName>, ExitCode> FindEpisodesOrComplain(
    const std::string& argument, const ParsedOptions& options, const CommandContext& context,
    const std::vector<episode::Need>& needs) {
  auto found =
      episode::FindEpisodes(options.All(argument), options.Text("--episode"), context.root);
  if (!found) return tl::unexpected(Complain(context, found.error()));
  for (const episode::Need need : needs) {
    if (const std::string lack = episode::Lack(*found, need); !lack.empty())
      return tl::unexpected(Refuse(context, lack));
  }
  return std::move(*found);
}

tl::expected<episode::Episode, ExitCode> OpenEpisodeOrComplain(const std::string& typed,
                                                               const ParsedOptions& options,
                                                               const CommandContext& context) {
  const auto name = episode::FindEpisode(typed, options.Text("--episode"), context.root);
  if (!name) return tl::unexpected(Complain(context, name.error()));
  auto episode =
      episode::OpenEpisode(*name, {options.Text("--grammar"), options.All("--set")}, context.root);
  if (!episode) return tl::unexpected(Complain(context, episode.error()));
  context.err << episode->moved();
  return std::move(*episode);
}

tl::expected<suite::PlayedRun, ExitCode> PlayOrComplain(episode::Episode episode,
                                                        const CommandContext& context) {
  Result<episode::RunResult> run = episode.Run(true);
  if (!run) return tl::unexpected(Complain(context, run.error()));
  if (run->recording.empty())
    return tl::unexpected(Complain(context, ExitCode::kFailure, episode::StatusText(*run)));
  return suite::PlayedRun{std::move(episode.loaded()), std::move(*run), episode.was_simulated()};
}

}  // namespace prehend::cli
