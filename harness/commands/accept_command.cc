// SPDX-License-Identifier: Apache-2.0
// prehend accept: the only thing that writes goldens. It runs the scenario itself, so that what is
// accepted is what this build recognises now, and refuses when that is not what was shown.
// Tested by tests/house/golden_workflow_test.cc
#include <algorithm>

#include "harness/accept_golden.h"
#include "harness/check_records.h"
#include "harness/check_scenario.h"
#include "harness/commands/accept_pictures.h"
#include "harness/commands/command.h"
#include "harness/compare.h"
#include "harness/content_hash.h"
#include "harness/cross_engine.h"
#include "harness/derivation.h"
#include "harness/golden_files.h"
#include "harness/oracle_notes.h"
#include "harness/physics_trace.h"
#include "harness/run_output.h"
#include "harness/shell_word.h"

namespace prehend::harness {
namespace {

constexpr std::size_t kFingerprintDigits = 8;

/// What is wrong with a fingerprint, or "".
std::string FingerprintProblem(const std::string& typed) {
  if (typed.size() == kFingerprintDigits &&
      typed.find_first_not_of("0123456789abcdef") == std::string::npos)
    return "";
  return "found '" + typed + "', wanted the 8 digits from 0-9 and a-f that '" +
         CommandText({"review"}) + "' prints, like 3fa90c11";
}

/// Why the command line alone is enough to refuse, or "".
std::string Refusal(const ParsedOptions& options, const CommandContext& context) {
  if (context.in_ci) return "accept is disabled where CI is set: a golden is a person's decision";
  if (options.Text("--reason").find_first_not_of(" \t") == std::string::npos) {
    return "accept needs a reason: --reason \"why this is right\"";
  }
  for (const char* name : {"--derived", "--reviewed", "--against-the-oracle"}) {
    if (options.Has("--pictures") && options.Has(name))
      return std::string(name) + " concerns events; --pictures accepts pictures only";
  }
  for (const char* name : {"--reason", "--derived", "--against-the-oracle"}) {
    for (const std::string& text : options.All(name)) {
      if (text.find_first_of("\n\r") != std::string::npos)
        return std::string(name) + " must be a single line";
    }
  }
  return "";
}

/// A finished run, and the golden that the scenario had before.
struct Played {
  std::string id;
  std::optional<Golden> old;
  PreparedRun prepared;
  std::vector<std::string> files;  ///< all that the run depends on
  RunResult run;
};

/// Prints what will change, and the objections of the oracle.
void ShowDifference(const Played& played, const Golden& pending, const CommandContext& context) {
  if (!played.old) {
    context.out << "new golden:\n" << RunTable(played.run);
  } else {
    const WorldEntry& world = played.prepared.scenario.world;
    context.out << DifferenceText(Compare(*played.old, played.run.timeline,
                                          DefaultTolerance(world.rate_hz, world.sensing_hz)),
                                  ExplainCommand(played.id, {}));
  }
  context.out << Text(Objections(played.old, pending));
}

/// The next difference is traced back to the run that is accepted now.
void LeaveBaseline(const CommandContext& context, const Played& played) {
  const CheckRecords records(context.root);
  CheckRecord record{.program = ProgramHash(), .passed = false, .pictures = false, .verdict = {}};
  record.verdict.scenario = played.id;
  record.verdict.inputs = HashFiles(played.files);
  // Without it, only the cause of the next difference stays unknown.
  (void)records.Write(record);
  (void)WriteTrace(records.TracePath(played.id),
                   TraceOf(played.prepared.scenario.scene, played.run.recording));
}

/// Why `pending` is not what a person was shown (by the fingerprint, or by the pending file), or
/// "".
std::string NotWhatWasShown(const ParsedOptions& options, const CommandContext& context,
                            const Golden& pending) {
  const std::string now = Fingerprint(pending);
  const ReadResult<Golden> waiting = GoldenFiles(context.root).ReadPendingOf(pending.scenario);
  const std::string shown = waiting.value ? Fingerprint(*waiting.value) : now;
  const std::string reviewed = options.Has("--reviewed") ? options.Text("--reviewed") : shown;
  if (reviewed == now) return "";
  if (reviewed == shown)
    return "the pending golden is " + shown + ", but the scenario now yields " + now;
  if (shown == now) return "the pending golden is " + now + ", not " + reviewed;
  return "the reviewed golden was " + reviewed + ", but the scenario now yields " + now;
}

/// Prints the difference and leaves it as the pending golden.
ExitCode Refuse(const CommandContext& context, const Played& played, const Golden& pending,
                ExitCode code, const std::string& why) {
  ShowDifference(played, pending, context);
  const std::string problem = GoldenFiles(context.root).WritePending(pending);
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  return Complain(context, code,
                  why + " (printed above); nothing was accepted\n  if that is right: " +
                      AcceptCommandLine(played.id, Fingerprint(pending),
                                        WantsReason(Objections(played.old, pending))));
}

ExitCode NothingToAccept(const CommandContext& context, const Played& played) {
  GoldenFiles(context.root).RemovePending(played.id);
  LeaveBaseline(context, played);
  const WorldEntry& world = played.prepared.scenario.world;
  const std::string headroom = HeadroomText(
      Compare(*played.old, played.run.timeline, DefaultTolerance(world.rate_hz, world.sensing_hz)));
  context.out << "nothing to accept: the scenario agrees with "
              << GoldenFiles(context.root).GoldenPath(played.id).string()
              << (headroom.empty() ? "" : "; " + headroom) << "\n";
  return ExitCode::kAgrees;
}

/// A planar scenario must have the same events in both engines: `check` would fail whatever were
/// accepted.
std::optional<ExitCode> RefuseUnlessEnginesAgree(const CommandContext& context,
                                                 const Played& played) {
  const auto compared =
      CompareEngines(played.prepared.scenario, played.prepared.program, played.run.timeline);
  const std::string text = compared ? EngineDifferenceText(played.prepared.scenario, *compared,
                                                           ExplainCommand(played.id, {}))
                                    : "";
  (void)GoldenFiles(context.root).WriteEngineDifference(played.id, text);
  if (text.empty()) return std::nullopt;
  context.out << text;
  const bool ended = compared->run.status.kind == physics::RunStatus::Kind::kCompleted;
  return Complain(context, ended ? ExitCode::kDiffers : ExitCode::kFailure,
                  std::string(NameOf(compared->other)) +
                      " yields other events (printed above); nothing was accepted\n  " +
                      kUntilEnginesAgree);
}

ExitCode AcceptEvents(const ParsedOptions& options, const CommandContext& context,
                      const Played& played) {
  const auto& [id, old, prepared, inputs, run] = played;
  const GoldenFiles files(context.root);
  const Derivation derivation = Derive(prepared.scenario, *prepared.program, run);
  Proposal proposal{.scenario = id,
                    .grammar = prepared.scenario.grammar,
                    .derived = options.All("--derived"),
                    .acceptance = Acceptance{context.today, options.Text("--reason")},
                    .notes = derivation.notes,
                    .tolerance = derivation.tolerance};
  const bool from_people = !proposal.derived.empty();
  if (!from_people && old) proposal.derived = old->derived;
  proposal.derived = RenewedDerivation(proposal.derived, derivation);
  const bool has_new_derivation = from_people && (!old || old->derived != proposal.derived);
  const Golden pending =
      PendingGolden(old, run.timeline, id, prepared.scenario.grammar, derivation);
  if (old && *old == pending && !has_new_derivation) return NothingToAccept(context, played);
  const std::string why_not = NotWhatWasShown(options, context, pending);
  if (!why_not.empty()) return Refuse(context, played, pending, ExitCode::kDiffers, why_not);
  Golden golden = ProposeGolden(old, run.timeline, proposal);
  const std::string objection = GiveReasons(options.All("--against-the-oracle"), golden);
  if (!objection.empty()) return Refuse(context, played, pending, ExitCode::kBadInput, objection);
  ShowDifference(played, pending, context);
  for (const std::string& line : derivation.lines) context.out << line << "\n";
  const std::string problem = files.WriteAccepted(golden);
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  LeaveBaseline(context, played);
  context.out << "accepted: " << files.GoldenPath(id).string() << "\n";
  return ExitCode::kAgrees;
}

ExitCode RunAccept(const ParsedOptions& options, const CommandContext& context) {
  const std::string refusal = Refusal(options, context);
  if (!refusal.empty()) return Complain(context, ExitCode::kBadInput, refusal);
  const std::string typed = options.Text("scenario");
  if (typed.find_first_of("*?[") != std::string::npos)
    return Complain(
        context, ExitCode::kBadInput,
        "'" + typed +
            "' may match several scenarios; accept takes one scenario at a time, by name");
  const auto [file, not_found] = FindScenarioOrComplain(typed, context);
  if (!file) return not_found;
  if (!file->in_project) {
    return Complain(context, ExitCode::kBadInput,
                    "only scenarios in scenarios/ have goldens; move the file there and accept it "
                    "by name");
  }
  Played played;
  played.id = ScenarioId(file->skill, file->name);
  played.files = {GoldenFiles(context.root).GoldenPath(played.id).string()};
  ReadResult<PreparedRun> prepared =
      PrepareRun({.scenario_file = file->path}, context.root, &played.files);
  if (!prepared.value) return Complain(context, prepared.diagnostics);
  played.prepared = std::move(*prepared.value);
  ReadResult<Golden> old = GoldenFiles(context.root).ReadGoldenOf(played.id);
  if (!old.diagnostics.empty()) return Complain(context, old.diagnostics);
  played.old = std::move(old.value);
  if (options.Has("--pictures") && !played.old) {
    return Complain(
        context, ExitCode::kPending,
        "the events of this scenario have no golden yet; accept them first, without --pictures");
  }

  played.run = RunScenario(played.prepared.scenario, played.prepared.program, {.record = true});
  if (played.run.status.kind != physics::RunStatus::Kind::kCompleted) {
    return Complain(context, ExitCode::kFailure,
                    "a run that did not complete cannot be accepted: " + StatusText(played.run));
  }
  if (!options.Has("--pictures")) {
    if (const auto refused = RefuseUnlessEnginesAgree(context, played)) return *refused;
    return AcceptEvents(options, context, played);
  }
  return AcceptPictures(context, options.Text("--reason"), *played.old, played.prepared.scenario,
                        played.run);
}

}  // namespace

Command AcceptCommand() {
  return {
      .name = "accept",
      .summary = "Make what a scenario yields now its golden, with a reason",
      .examples =
          {"accept milk_carton_wrap --reason \"first golden, checked against the picture\"",
           "accept milk_carton_wrap --reviewed 3fa90c11 --reason \"the grasp ends earlier\"",
           "accept milk_carton_wrap --reason \"...\" --derived \"the reach begins with the hand's "
           "first motion\"",
           "accept milk_carton_wrap --pictures --reason \"the carton is seen in the hand\""},
      .options = {{.name = "scenario", .help = "a name or skill/name", .required = true},
                  {.name = "--reason",
                   .help = "why this is right; is written into the golden",
                   .placeholder = "TEXT"},
                  {.name = "--derived",
                   .help = "how the events follow from the definitions, one line each; the\n"
                           "physical oracle's derivation is added; may be repeated",
                   .placeholder = "TEXT",
                   .repeatable = true},
                  {.name = "--against-the-oracle",
                   .help = "why an event is right although the physical oracle objects to it:\n"
                           "\"sliding(right_hand, cup): it jerks\"; without EVENT: all of them;\n"
                           "may be repeated",
                   .placeholder = "[EVENT(ROLES): ]TEXT",
                   .repeatable = true},
                  {.name = "--reviewed",
                   .help = "accept only what 'review' printed with this fingerprint",
                   .placeholder = "FINGERPRINT",
                   .rule = {.problem = FingerprintProblem}},
                  {.name = "--pictures",
                   .help =
                       "accept the pictures, not the events; they are kept beside the timeline"}},
      .run = RunAccept};
}

}  // namespace prehend::harness
