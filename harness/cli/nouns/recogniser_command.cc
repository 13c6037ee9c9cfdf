// SPDX-License-Identifier: Apache-2.0
// prehend grammar recogniser: whether a program of somebody else keeps to the protocol of
// docs/recognisers.md. Tested by tests/program/recogniser_test.cc
#include <fmt/format.h>

#include "harness/cli/command/command.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/measure/score/score.h"

namespace prehend::cli {
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

}  // namespace prehend::cli
