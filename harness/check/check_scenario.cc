// SPDX-License-Identifier: Apache-2.0
// See harness/check/check_scenario.h. Judges are functions of values (judge_*.h); files are written
// in Store() only. Tested by tests/harness/check/check_scenario_test.cc
#include "harness/check/check_scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "grammar/base/check.h"
#include "harness/base/build_text.h"
#include "harness/base/shell_quote.h"
#include "harness/check/attribute.h"
#include "harness/check/blame.h"
#include "harness/check/draw_disputed.h"
#include "harness/check/last_pass.h"
#include "harness/check/settings.h"
#include "harness/check/state_trace.h"
#include "harness/episode/find_episodes.h"
#include "harness/episodes/load_episode.h"
#include "harness/episodes/record_episode.h"
#include "harness/golden/golden_files.h"
#include "harness/judge/accept_golden.h"
#include "harness/judge/compare_engines.h"
#include "harness/judge/judge_claims.h"
#include "harness/judge/judge_golden.h"
#include "harness/judge/judge_invariants.h"
#include "harness/judge/judge_pictures.h"
#include "harness/judge/judge_recording.h"
#include "harness/pictures/pictures.h"
#include "harness/replay/replay_data.h"
#include "harness/run/run_text.h"
#include "harness/run/segment.h"

namespace prehend::harness {
namespace {

namespace fs = std::filesystem;

/// The options of the command line that ask for these changes.
std::vector<std::string> OptionsOf(const RunRequest& changes) {
  std::vector<std::string> options;
  if (!changes.grammar.empty()) options.push_back("--grammar " + ShellQuoted(changes.grammar));
  for (const std::string& setting : changes.settings)
    options.push_back("--set " + ShellQuoted(setting));
  return options;
}

std::string Command(const char* name, const std::string& id, const RunRequest& changes) {
  std::string command = CommandText({name, id});
  for (const std::string& option : OptionsOf(changes)) command += " " + option;
  return command;
}

/// Of the recording that an episode was imported from; nothing if it is gone.
std::optional<std::string> ReviewCommandOf(const fs::path& recording) {
  std::error_code error;
  if (!fs::exists(recording, error)) return std::nullopt;
  const fs::path from_here = fs::proximate(recording, error);
  const bool is_below = !from_here.empty() && *from_here.begin() != "..";
  return CommandText({"review", (is_below ? from_here : recording).string()});
}

/// Whether nothing is changed by the command line, so that what differs can be accepted.
bool AsItsFileSays(const CheckRequest& request) { return OptionsOf(request.run).empty(); }

/// The goldens that decide the verdict of a scenario, whether they exist or not: one that appears
/// changes the verdict. Of pictures those that it asks for and one more, which would be too many.
std::vector<std::string> FilesOfGolden(const CheckRequest& request, const Scenario* scenario) {
  if (!request.in_project) return {};
  const GoldenFiles goldens(request.root);
  std::vector<std::string> files = {goldens.GoldenPath(request.id).string()};
  for (const KeptPicture& picture : goldens.PicturesOf(request.id)) {
    files.push_back(picture.path.string());
    files.push_back(ThingsFile(picture.path.string()));
  }
  for (std::size_t i = 1; scenario && i <= scenario->pictures.size() + 1; ++i) {
    const std::string file = scenario->name + (i == 1 ? "" : "-" + std::to_string(i)) + ".png";
    const std::string picture = goldens.PicturePath(request.id, file).string();
    files.push_back(picture);
    files.push_back(ThingsFile(picture));
  }
  return files;
}

/// Reports how far the run has come while it is going on. `recorder` may be null.
RunResult Play(const CheckRequest& request, const LoadedRun& loaded,
               episodes::EpisodeRecorder* recorder) {
  ScenarioRun playing(loaded.scenario, loaded.program, {.record = true});
  while (playing.Step()) {
    if (request.last_tick) request.last_tick->store(playing.snapshot().tick);
    if (recorder) recorder->Add(playing.snapshot());
  }
  RunResult run = playing.Finish();
  if (recorder) recorder->Finish(run);
  return run;
}

/// The run that was recorded, with its scenario and the grammar that is asked for.
Result<std::pair<LoadedRun, RunResult>> ReadPlayed(const CheckRequest& request) {
  const auto file = episodes::EpisodeFile::Open(request.run.scenario_file);
  if (!file) return tl::unexpected(file.error());
  const auto row = std::ranges::find(file->episodes(), request.episode, &episodes::EpisodeRow::id);
  PREHEND_CHECK(row != file->episodes().end());
  Result<LoadedRun> loaded = episodes::EpisodeLoader(request.root)
                                 .Load(*file, *row, {request.run.grammar, request.run.settings});
  if (!loaded) return tl::unexpected(std::move(loaded.error()));
  Result<RunResult> run = episodes::Replay(*file, *row, *loaded);
  if (!run) return tl::unexpected(std::move(run.error()));
  return std::pair(std::move(*loaded), std::move(*run));
}

/// Draws into the folder of the report, and compares with the goldens of pictures.
Findings Draw(const CheckRequest& request, const CheckedRun& checked,
              std::vector<ReportedPicture>& pictures, std::vector<PictureComparison>& compared) {
  if (!request.pictures || !CanDrawPictures()) return {};
  const Scenario& scenario = checked.loaded.scenario;
  const fs::path folder = fs::path(request.report_folder) / "pictures" / scenario.skill;
  std::error_code error;
  fs::create_directories(folder, error);
  const GoldenOf none = [](const std::string&) { return std::string(); };
  const PictureResult drawn =
      DrawAndCompare(scenario, checked.result, folder.string(),
                     request.in_project ? GoldensOf(request.id, request.root) : none);
  compared = ComparisonsOf(request.id, drawn.pictures, request.root, !request.leave_nothing_behind);
  for (const WrittenPicture& picture : drawn.pictures) {
    const fs::path file = fs::path(picture.file).lexically_relative(request.report_folder);
    pictures.push_back({.file = file.generic_string(), .caption = picture.caption});
  }
  if (drawn.error.empty()) return {};
  return {{.exit_code = ExitCode::kFailure,
           .reason = "no picture",
           .details = "no picture: " + drawn.error + "\n"}};
}

/// A run that differs, beside the last one that passed.
struct Blame {
  std::string text;  ///< CauseText() and what changed
  std::vector<Attribution> attributions;
};

/// The same motion, with some parameters as they were.
std::optional<Comparison> CompareWithSettings(const CheckRequest& request,
                                              const CheckedRun& checked, const Golden& golden,
                                              const std::vector<std::string>& settings) {
  RunRequest changed = request.run;
  for (const std::string& setting : settings) {
    const std::string name = setting.substr(0, setting.find('=') + 1);
    std::erase_if(changed.settings, [&](const auto& other) { return other.starts_with(name); });
    changed.settings.push_back(setting);
  }
  const Result<LoadedRun> loaded = LoadRun(changed, request.root);
  if (!loaded) return std::nullopt;
  const Scenario& scenario = checked.loaded.scenario;
  return Compare(
      golden,
      Resegment(scenario, checked.result.recording, loaded->program, checked.result.ticks + 1),
      DefaultTolerance(scenario));
}

/// Attributes what differs to physics, sensing or grammar, and to single values.
Blame BlameFor(const CheckRequest& request, const CheckedRun& checked, const Golden& golden,
               const Comparison& comparison, const ScenarioVerdict& verdict) {
  const LastPasses records(request.root);
  const RunResult& run = checked.result;
  const auto last_pass = records.Read(request.id);
  const auto trace = ReadTrace(records.TracePath(request.id));
  const DifferingRun now{.program = request.program,
                         .build = BuildText(),
                         .inputs = verdict.inputs,
                         .settings = verdict.settings,
                         .options = OptionsOf(request.run),
                         .other_grammar = !request.run.grammar.empty(),
                         .trace = TraceOf(checked.loaded.scenario.scene, run.recording),
                         .ticks_per_second = static_cast<double>(run.timeline.ticks_per_second)};
  Blame blame{.text = CauseText(last_pass, trace, now, request.root), .attributions = {}};
  const auto suspects = SuspectsOf(last_pass, trace, now, request.root);
  if (suspects) blame.text += ChangesText(suspects->changes);
  const bool can_undo = request.episode == 0 && !run.recording.empty();
  blame.attributions = AttributeDifferences(
      comparison, suspects.value_or(Suspects{}),
      [&](const std::vector<std::string>& settings) -> std::optional<Comparison> {
        if (!can_undo) return std::nullopt;
        return CompareWithSettings(request, checked, golden, settings);
      });
  return blame;
}

/// A planar scenario has the same events in both engines; `difference` is how they differ.
Findings JudgeOtherEngine(const CheckedRun& checked, std::string& difference) {
  const Scenario& scenario = checked.loaded.scenario;
  const auto compared = CompareEngines(scenario, checked.loaded.program, checked.result.timeline);
  if (compared) difference = EngineDifferenceText(scenario, *compared, checked.explain);
  if (difference.empty()) return {};
  const std::string engine = NameOf(compared->other);
  if (compared->run.status.kind != physics::RunStatus::Kind::kCompleted)
    return {{ExitCode::kFailure, "the simulation failed in " + engine, difference}};
  return {{ExitCode::kDiffers, engine + " does not lead to the same events",
           difference + kUntilEnginesAgree + "\n"}};
}

/// Everything that the judges say about a run.
struct Judgement {
  Findings findings;
  std::optional<GoldenComparison> golden;  ///< empty if the golden cannot be read
  Blame blame;                             ///< of differences from the golden
  std::string engine_difference;
  std::vector<PictureComparison> pictures;
};

void JudgeAgainstGolden(const CheckRequest& request, const CheckedRun& checked,
                        const ScenarioVerdict& verdict, Judgement& judgement) {
  std::optional<Golden> golden;
  if (request.in_project) {
    auto read = GoldenFiles(request.root).ReadGoldenOf(request.id);
    if (!read) {
      return judgement.findings.push_back(
          {ExitCode::kBadInput, "the golden cannot be read", Format(read.error())});
    }
    golden = std::move(*read);
  }
  judgement.golden = CompareWithGolden(golden, checked);
  if (judgement.golden->Differs())
    judgement.blame = BlameFor(request, checked, *golden, judgement.golden->comparison, verdict);
  Append(judgement.findings, JudgeGolden(*judgement.golden, checked, judgement.blame.text));
}

void JudgePictures(const CheckRequest& request, const CheckedRun& checked, Judgement& judgement) {
  if (!request.in_project || !AsItsFileSays(request)) return;
  Append(judgement.findings,
         JudgeUnrequestedPictures(request.id, checked.loaded.scenario.pictures.size(), request.root,
                                  AcceptPicturesCommand(request.id)));
}

/// The only place of a check that writes below build/, pictures of the report aside. What cannot be
/// written is reported by the command that needs it, or costs only the cause of a difference.
void Store(const CheckRequest& request, const CheckedRun& checked, const Judgement& judgement,
           bool passed) {
  if (request.leave_nothing_behind) return;
  const GoldenFiles files(request.root);
  if (judgement.golden && judgement.golden->Holds()) files.RemovePending(request.id);
  if (judgement.golden && !judgement.golden->Holds())
    (void)files.WritePending(judgement.golden->pending);
  (void)files.WriteEngineDifference(request.id, judgement.engine_difference);
  StorePictures(request.id, judgement.pictures, request.root);
  if (passed)
    (void)WriteTrace(LastPasses(request.root).TracePath(request.id),
                     TraceOf(checked.loaded.scenario.scene, checked.result.recording));
}

/// The first finding decides; one that is wrong comes before a golden that does not exist yet.
void Conclude(const Findings& findings, ScenarioVerdict& verdict) {
  verdict.verdict = Verdict::kPassed;
  for (const Finding& finding : findings) verdict.details += finding.details;
  if (findings.empty()) return;
  const auto wrong = std::ranges::find_if(
      findings, [](const Finding& finding) { return finding.exit_code != ExitCode::kPending; });
  const Finding& first = wrong == findings.end() ? findings.front() : *wrong;
  verdict.verdict = wrong == findings.end() ? Verdict::kPending : Verdict::kFailed;
  verdict.exit_code = first.exit_code;
  verdict.reason = first.reason;
}

std::vector<DisputedMoment> DisputedMoments(const CheckRequest& request, const CheckedRun& checked,
                                            const Comparison& comparison) {
  if (!request.pictures || !CanDrawPictures()) return {};
  return DrawDisputed(checked.loaded.scenario, checked.result, comparison, request.report_folder);
}

bool WantsReplay(const CheckRequest& request, const ScenarioVerdict& verdict) {
  return request.replays == Replays::kAll ||
         (request.replays == Replays::kFailures && verdict.verdict != Verdict::kPassed);
}

void AddReplay(const CheckRequest& request, const CheckedRun& checked, ScenarioVerdict& verdict) {
  if (WantsReplay(request, verdict))
    verdict.replay = ReplayData(checked.loaded.scenario, checked.result);
}

ScenarioVerdict BlankVerdict(const CheckRequest& request) {
  ScenarioVerdict verdict{.scenario = request.id, .shows = {}};
  verdict.command = RepeatCommand(request);
  verdict.explain = ExplainCommand(request.id, request.run);
  if (request.episode != 0)
    verdict.explain = ExplainCommand(request.run.scenario_file, request.run) +
                      fmt::format(" --episode {}", request.episode);
  return verdict;
}

/// Everything that is judged of a run that was played.
ScenarioVerdict VerdictOn(const CheckRequest& request, const CheckedRun& checked,
                          ScenarioVerdict verdict) {
  verdict.settings = SettingsOf(checked.loaded, request.run, verdict.inputs, request.root);
  verdict.shows = checked.loaded.scenario.shows;
  verdict.notes = NoteLines(checked.loaded.scenario, checked.result);
  verdict.state_hash = HashText(checked.result.state_hash);
  verdict.ticks = checked.result.ticks;
  Judgement judgement;
  judgement.findings = Draw(request, checked, verdict.pictures, judgement.pictures);
  if (checked.result.status.kind != physics::RunStatus::Kind::kCompleted) {
    Append(judgement.findings,
           {{ExitCode::kFailure, "the simulation failed", StatusText(checked.result) + "\n"}});
    Conclude(judgement.findings, verdict);
    if (request.episode == 0) verdict.command = Command("run", request.id, request.run);
    AddReplay(request, checked, verdict);
    return verdict;
  }

  Append(judgement.findings, JudgeInvariants(checked));
  Append(judgement.findings, JudgeLaws(checked));
  verdict.claims = JudgeClaims(checked.loaded, checked.result.timeline);
  Append(judgement.findings, ClaimFindings(verdict.claims));
  JudgeAgainstGolden(request, checked, verdict, judgement);
  if (request.episode == 0)
    Append(judgement.findings, JudgeOtherEngine(checked, judgement.engine_difference));
  JudgePictures(request, checked, judgement);

  Conclude(judgement.findings, verdict);
  verdict.details += TextOfUndecided(verdict.claims);
  Store(request, checked, judgement, verdict.verdict == Verdict::kPassed);
  if (judgement.golden) {
    verdict.comparison = std::move(judgement.golden->comparison);
    verdict.has_golden = judgement.golden->has_golden;
    verdict.drawings = checked.result.drawings;
  }
  verdict.cause = std::move(judgement.blame.text);
  verdict.attributions = std::move(judgement.blame.attributions);
  verdict.picture_differences = PictureDifferencesText(
      judgement.pictures, AsItsFileSays(request) ? AcceptPicturesCommand(request.id) : "");
  AddReplay(request, checked, verdict);
  if (verdict.DiffersFromGolden())
    verdict.disputed = DisputedMoments(request, checked, *verdict.comparison);
  if (request.explain && verdict.DiffersFromGolden())
    verdict.explained = Explain(checked.loaded.scenario, checked.result, checked.loaded.program,
                                *verdict.comparison);
  if (verdict.verdict == Verdict::kPending && request.in_project && AsItsFileSays(request))
    verdict.command = Command("review", request.id, {});
  return verdict;
}

/// A recording against its golden.
ScenarioVerdict CheckRecording(const CheckRequest& request, const std::string& golden_file,
                               Result<JudgedRecording> judged) {
  ScenarioVerdict verdict = BlankVerdict(request);
  verdict.inputs = HashFiles({request.run.scenario_file, golden_file});
  if (!judged) {
    Conclude({{ExitCode::kBadInput, "cannot be read", Format(judged.error())}}, verdict);
    return verdict;
  }
  verdict.ticks = judged->segmented.end;
  verdict.has_golden = judged->golden.has_value();
  verdict.drawings = EventDrawings(*judged->segmented.program);
  Findings findings;
  if (!judged->golden) {
    findings.push_back({ExitCode::kPending, "no golden yet", ""});
    if (request.run.settings.empty()) verdict.command = Command("review", request.id, request.run);
  } else if (!judged->comparison.Agrees()) {
    findings.push_back(DifferenceFinding(judged->comparison, verdict.explain));
    findings.back().details += OtherGrammarText(*judged);
  }
  if (!findings.empty()) findings.back().details += judged->segmented.missing.warnings;
  if (verdict.has_golden) {
    const Suspects suspects{.other_changes = OptionsOf(request.run)};
    verdict.attributions = AttributeDifferences(
        judged->comparison, suspects, [](const auto&) { return std::optional<Comparison>(); });
  }
  verdict.comparison = std::move(judged->comparison);
  Conclude(findings, verdict);
  return verdict;
}

/// An episode that was imported from a recording, against the golden beside that; nothing if the
/// episode was simulated.
std::optional<ScenarioVerdict> CheckImported(const CheckRequest& request) {
  if (request.episode == 0) return std::nullopt;
  const auto file = episodes::EpisodeFile::Open(request.run.scenario_file);
  if (!file) return std::nullopt;  // ReadPlayed() says why
  const auto row = std::ranges::find(file->episodes(), request.episode, &episodes::EpisodeRow::id);
  if (row == file->episodes().end() || row->simulated) return std::nullopt;
  const auto unread = [&](const grammar::Diagnostics& why) {
    return CheckRecording(request, "", tl::unexpected(why));
  };
  const Result<LoadedRun> loaded =
      episodes::EpisodeLoader(request.root)
          .Load(*file, *row, {request.run.grammar, request.run.settings});
  if (!loaded) return unread(loaded.error());
  const Result<RunResult> run = episodes::Replay(*file, *row, *loaded);
  if (!run) return unread(run.error());
  Result<SegmentedRecording> segmented = episodes::SegmentRecorded(*file, *row, *loaded);
  if (!segmented) return unread(segmented.error());
  const std::string golden =
      (fs::path(request.root) / GoldenBeside(loaded->scenario.file)).string();
  ScenarioVerdict verdict =
      CheckRecording(request, golden, JudgeSegmented(std::move(*segmented), golden));
  verdict.state_hash = row->state_hash;
  // `review` and `accept` take the recording itself, beside which its golden lies.
  if (verdict.verdict == Verdict::kPending)
    verdict.command = ReviewCommandOf(fs::path(request.root) / loaded->scenario.file)
                          .value_or(RepeatCommand(request));
  if (WantsReplay(request, verdict)) verdict.replay = ReplayData(loaded->scenario, *run);
  return verdict;
}

}  // namespace

ScenarioVerdict CheckScenario(const CheckRequest& request) {
  if (EpisodeKindOf(request.run.scenario_file) == EpisodeKind::kJsonLines)
    return CheckRecording(request, GoldenBeside(request.run.scenario_file),
                          JudgeRecording(request.run, request.root));
  if (auto verdict = CheckImported(request)) return std::move(*verdict);
  ScenarioVerdict verdict = BlankVerdict(request);
  std::vector<std::string> files;
  std::optional<RunResult> played;
  Result<LoadedRun> loaded;
  if (request.episode == 0) {
    loaded = LoadRun(request.run, request.root, &files);
  } else if (auto recorded = ReadPlayed(request)) {
    loaded = std::move(recorded->first);
    played = std::move(recorded->second);
  } else {
    loaded = tl::unexpected(std::move(recorded.error()));
  }
  const std::vector<std::string> read = files;
  std::ranges::move(FilesOfGolden(request, loaded ? &loaded->scenario : nullptr),
                    std::back_inserter(files));
  verdict.inputs = HashFiles(files);
  if (!loaded) {
    Conclude({{ExitCode::kBadInput, "cannot be read", Format(loaded.error())}}, verdict);
    if (request.episode == 0) verdict.command = Command("validate", request.id, request.run);
    return verdict;
  }

  CheckedRun checked{.id = request.id,
                     .in_project = request.in_project,
                     .loaded = std::move(*loaded),
                     .result = {},
                     .explain = verdict.explain};
  std::optional<episodes::EpisodeRecorder> recorder;
  if (!request.record_file.empty())
    recorder.emplace(episodes::RecordRequest{request.record_file, request.root, request.run, read,
                                             request.today, request.program},
                     checked.loaded.scenario);
  checked.result =
      played ? std::move(*played) : Play(request, checked.loaded, recorder ? &*recorder : nullptr);
  if (recorder) verdict.not_recorded = recorder->problem();
  return VerdictOn(request, checked, std::move(verdict));
}

ScenarioVerdict JudgeRun(const CheckRequest& request, LoadedRun loaded, RunResult run,
                         const std::vector<std::string>& files) {
  ScenarioVerdict verdict = BlankVerdict(request);
  std::vector<std::string> inputs = files;
  std::ranges::move(FilesOfGolden(request, &loaded.scenario), std::back_inserter(inputs));
  verdict.inputs = HashFiles(inputs);
  const CheckedRun checked{.id = request.id,
                           .in_project = request.in_project,
                           .loaded = std::move(loaded),
                           .result = std::move(run),
                           .explain = verdict.explain};
  return VerdictOn(request, checked, std::move(verdict));
}

std::string ExplainCommand(const std::string& id, const RunRequest& changes) {
  return Command("explain", id, changes);
}

std::string RepeatCommand(const CheckRequest& request) {
  return Command("check", request.episode == 0 ? request.id : request.run.scenario_file,
                 request.run);
}

}  // namespace prehend::harness
