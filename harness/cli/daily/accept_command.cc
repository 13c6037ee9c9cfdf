// SPDX-License-Identifier: Apache-2.0
// prehend accept: what a person decides. prehend review: what is to be accepted. Tested by
// tests/program/golden_workflow_test.cc
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "harness/base/base/project_paths.h"
#include "harness/base/base/quoting.h"
#include "harness/cli/command/command.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/suite/accept/accept.h"
#include "harness/suite/judge/judges.h"

namespace prehend::cli {
namespace {

constexpr std::size_t kFingerprintDigits = 16;

/// What is wrong with a fingerprint, or "".
std::string FingerprintProblem(const std::string& typed) {
  if (typed.size() == kFingerprintDigits &&
      typed.find_first_not_of("0123456789abcdef") == std::string::npos)
    return "";
  return "found '" + typed + "', wanted the 16 digits from 0-9 and a-f that '" +
         CommandText({"review"}) + "' prints, like 3fa90c11d27e5b60";
}

/// Why the options are enough to refuse, or "".
std::string Refusal(const ParsedOptions& options, bool is_recording) {
  for (const char* of_play : {"--pictures", "--unsteady", "--exact"}) {
    if (is_recording && options.Has(of_play))
      return fmt::format("{} concerns scenarios; {} is a recording", of_play,
                         options.Text("scenario"));
  }
  if (!is_recording && options.Has("--grammar"))
    return "--grammar concerns recordings; the golden of a scenario is of the grammar that it "
           "names";
  if (options.Text("--reason").find_first_not_of(" \t") == std::string::npos)
    return "accept needs a reason: --reason \"why this is right\"";
  for (const char* name : {"--derived", "--reviewed", "--unsteady", "--exact"}) {
    if (options.Has("--pictures") && options.Has(name))
      return std::string(name) + " concerns events; --pictures accepts pictures only";
  }
  for (const char* name : {"--reason", "--derived", "--unsteady"}) {
    for (const std::string& text : options.All(name)) {
      if (text.find_first_of("\n\r") != std::string::npos)
        return std::string(name) + " must be a single line";
    }
  }
  return "";
}

/// One of the project, or the exit code when what was typed can have no golden.
tl::expected<episode::ScenarioFile, ExitCode> ScenarioWithGolden(const std::string& typed,
                                                                 const CommandContext& context) {
  const auto refuse = [&](const std::string& why) { return tl::unexpected(Refuse(context, why)); };
  if (typed.find_first_of("*?[") != std::string::npos)
    return refuse("'" + typed +
                  "' may match several scenarios; accept takes one scenario at a time, by name");
  auto file = FindScenarioOrComplain(typed, context);
  if (file && !file->in_project)
    return refuse("only scenarios in scenarios/ of this project have goldens; accept a copy there");
  return file;
}

/// Recordings: one, or all demonstrations of an episode file; with `reviewed` those that yield it.
ExitCode AcceptRecordings(const std::string& typed, const suite::AcceptRequest& request,
                          const CommandContext& context) {
  const auto names = episode::FindEpisodes({&typed, 1}, "", context.root);
  if (!names) return Complain(context, names.error());
  std::string problem;
  ExitCode worst = ExitCode::kAgrees;
  std::size_t others = 0;
  for (const episode::EpisodeName& name : *names) {
    const Result<suite::AcceptOutcome> outcome = suite::AcceptRecording(name, request);
    if (!outcome) return Complain(context, outcome.error());
    const bool is_other = outcome->code == ExitCode::kDiffers && ++others < names->size();
    if (is_other) continue;
    context.err << outcome->notes;
    context.out << outcome->text;
    if (outcome->problem.empty()) continue;
    problem = outcome->problem;
    worst = outcome->code;
  }
  return problem.empty() ? worst : Complain(context, worst, problem);
}

ExitCode RunAccept(const ParsedOptions& options, const CommandContext& context) {
  if (context.in_ci)
    return Refuse(context, "accept is disabled where CI is set: a golden is a person's decision");
  if (IsInstalled(context.root)) return Refuse(context, kStaysInstalled);
  const std::string typed = options.Text("scenario");
  std::error_code error;
  const episode::EpisodeKind kind = episode::EpisodeKindOf(typed);
  const bool is_recording =
      (kind == episode::EpisodeKind::kJsonLines || kind == episode::EpisodeKind::kEpisodeFile) &&
      std::filesystem::exists(typed, error);
  tl::expected<episode::ScenarioFile, ExitCode> scenario;
  if (!is_recording) scenario = ScenarioWithGolden(typed, context);
  if (!scenario) return scenario.error();
  if (kind == episode::EpisodeKind::kEpisodeFile && is_recording) {
    const auto kept = episode::FindEpisodes({&typed, 1}, "", context.root);
    if (!kept) return Complain(context, kept.error());
    const std::string lack = suite::LacksGolden(kept->front(), context.root);
    if (!lack.empty()) return Complain(context, ExitCode::kBadInput, lack);
  }
  const std::string refusal = Refusal(options, is_recording);
  if (!refusal.empty()) return Refuse(context, refusal);
  const auto text_of = [&](const char* name) {
    return options.Has(name) ? std::optional(options.Text(name)) : std::nullopt;
  };
  const suite::AcceptRequest request{.root = context.root,
                                     .today = context.today,
                                     .reason = options.Text("--reason"),
                                     .grammar = options.Text("--grammar"),
                                     .derived = options.All("--derived"),
                                     .reviewed = text_of("--reviewed"),
                                     .unsteady = text_of("--unsteady"),
                                     .exact = options.Has("--exact"),
                                     .pictures = options.Has("--pictures")};
  if (is_recording) return AcceptRecordings(typed, request, context);
  const Result<suite::AcceptOutcome> outcome = suite::AcceptScenario(*scenario, request);
  if (!outcome) return Complain(context, outcome.error());
  context.err << outcome->notes;
  context.out << outcome->text;
  return outcome->problem.empty() ? outcome->code
                                  : Complain(context, outcome->code, outcome->problem);
}

ExitCode RunReview(const ParsedOptions& options, const CommandContext& context) {
  const auto reviews =
      suite::Reviews(options.All("names"), options.Text("--grammar"), context.root);
  if (!reviews) return Complain(context, reviews.error().exit_code, reviews.error().why);
  if (options.Has("--json"))
    context.out << suite::ReviewsJson(*reviews).dump(2) << "\n";
  else
    context.out << suite::ReviewsText(*reviews);
  return reviews->empty() ? ExitCode::kAgrees : ExitCode::kPending;
}

}  // namespace

Command AcceptCommand() {
  return {
      .name = "accept",
      .summary = "Make what a scenario yields now its golden, with a reason",
      .examples =
          {"accept milk_carton_wrap --reason \"first golden, checked against the picture\"",
           "accept milk_carton_wrap --reviewed 3fa90c11d27e5b60 --reason \"the grasp ends "
           "earlier\"",
           "accept milk_carton_wrap --reason \"...\" --derived \"the reach begins with the hand's "
           "motion\"",
           "accept milk_carton_wrap --pictures --reason \"the carton is seen in the hand\"",
           "accept takes/take1.jsonl --reason \"compared with the video\"",
           "accept takes/take1.jsonl --grammar my.grammar --reason \"compared with the video\""},
      .options = {Required(Argument("scenario",
                                    "a name, skill/name, or the file of a recording of a tracker, "
                                    "of episodes all demonstrations")),
                  Value("--reason", "TEXT", "why this is right; is written into the golden"),
                  Repeatable(Value("--derived", "TEXT",
                                   "how the events follow from the definitions, one line each; the "
                                   "physical oracle's derivation is added; may be repeated")),
                  Value("--reviewed", "FINGERPRINT",
                        "accept only what 'review' printed with this fingerprint",
                        {.problem = FingerprintProblem}),
                  Value(
                      "--grammar", "NAME|FILE",
                      "of a recording of a tracker: this grammar instead of the one that it names"),
                  Flag("--exact",
                       "take over boundaries that moved within their tolerance, too: after a "
                       "change that moved many, or the next small one fails"),
                  Value("--unsteady", "TEXT",
                        "why the events may differ after a metamorphic transform, which accept "
                        "does; is written into the golden; without it they may not"),
                  Flag("--pictures",
                       "accept the pictures, not the events; they are kept beside the timeline")},
      .run = RunAccept};
}

Command ReviewCommand() {
  return {
      .name = "review",
      .summary = "Show what is pending, and how it differs from the goldens",
      .examples = {"review", "review milk_carton_wrap 'slide/*'"},
      .options = {Repeatable(Argument("names",
                                      "names, skill/name, globs, or files of recordings of "
                                      "trackers; default: all that is pending")),
                  Value(
                      "--grammar", "NAME|FILE",
                      "of recordings of trackers: this grammar instead of the one that they name"),
                  JsonOption()},
      .run = RunReview};
}

}  // namespace prehend::cli
