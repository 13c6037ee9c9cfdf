// SPDX-License-Identifier: Apache-2.0
// Judges are functions of values; files are written in Store() only.
#include "harness/suite/check/check_scenario.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "harness/base/base/quoting.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/episodes/record_episode.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/run/segment_recording.h"
#include "harness/show/replay/replay_data.h"
#include "harness/suite/check/causes.h"
#include "harness/suite/check/last_pass.h"
#include "harness/suite/judge/judges.h"
#include "harness/suite/judge/other_view.h"
#include "harness/suite/judge/validate_golden.h"
#include "harness/truth/golden/golden.h"

namespace prehend::suite {
namespace {

namespace fs = std::filesystem;

/// An episode on its way through the judges.
struct CheckedEpisode {
  const CheckRequest& request;
  CheckedRun run;                                        ///< of a recording what stands in for it
  std::optional<episode::SegmentedRecording> recording;  ///< of what was not simulated
  ScenarioVerdict verdict;                               ///< what is known of it so far
  // For Store() and for judges that come later.
  std::optional<GoldenComparison> golden = {};  ///< empty if the golden cannot be read
  std::string engine_difference = {};
  std::vector<PictureComparison> pictures = {};
  std::optional<Heard> heard = {};  ///< whose timeline it is, if no grammar's

  bool is_good = true;  ///< nothing has been found so far

  bool IsComplete() const { return run.result.status.kind == physics::RunStatus::Kind::kCompleted; }
};

using Judge = Findings (*)(CheckedEpisode& checked);

/// Draws into the folder of the report, and compares with the goldens of pictures.
Findings Pictures(CheckedEpisode& checked) {
  const CheckRequest& request = checked.request;
  if (!request.pictures || !show::CanDrawPictures()) return {};
  const bool is_compared =
      request.in_project && !truth::GoldenFiles(request.root).PicturesOf(request.id).empty();
  if (!request.all_pictures && checked.is_good && !is_compared) return {};
  const scenario::Scenario& scenario = checked.run.loaded.scenario;
  const fs::path folder = fs::path(request.report_folder) / "pictures" / scenario.skill;
  std::error_code error;
  fs::create_directories(folder, error);
  const show::GoldenOf none = [](const std::string&) { return std::string(); };
  const show::PictureResult drawn =
      show::DrawAndCompare(scenario, checked.run.result, folder.string(),
                           request.in_project ? GoldensOf(request.id, request.root) : none);
  checked.pictures =
      ComparisonsOf(request.id, drawn.pictures, request.root, !request.leave_nothing_behind);
  for (const show::WrittenPicture& picture : drawn.pictures) {
    const fs::path file = fs::path(picture.file).lexically_relative(request.report_folder);
    checked.verdict.pictures.push_back({.file = file.generic_string(), .caption = picture.caption});
  }
  if (drawn.error.empty()) return {};
  return {{.exit_code = ExitCode::kFailure,
           .reason = "no picture",
           .details = "no picture: " + drawn.error + "\n"}};
}

Findings EndOfRun(CheckedEpisode& checked) {
  return {{ExitCode::kFailure, "the simulation failed",
           episode::StatusText(checked.run.result) + "\n"}};
}

Findings Invariants(CheckedEpisode& checked) { return JudgeInvariants(checked.run); }

Findings Limits(CheckedEpisode& checked) {
  return JudgeLimits(checked.run.loaded.scenario, checked.run.result.notes);
}

Findings Laws(CheckedEpisode& checked) { return JudgeLaws(checked.run); }

Findings Claims(CheckedEpisode& checked) {
  checked.verdict.claims = JudgeClaims(checked.run.loaded, checked.run.result.timeline);
  return ClaimFindings(checked.verdict.claims);
}

/// Other values have other boundaries.
Findings JudgeTrial(CheckedEpisode& checked) {
  checked.verdict.details =
      "a trial: judged by its claims and its outcome, not by the golden of what was not varied\n" +
      GroundTruthText(checked.golden->truth);
  const auto& outcomes = checked.run.loaded.scenario.outcomes;
  const std::string& outcome = checked.run.result.outcome;
  if (outcomes.empty() || outcome == outcomes.front().name) return {};
  return {{ExitCode::kDiffers,
           fmt::format("its outcome is '{}', wanted '{}'", outcome, outcomes.front().name), ""}};
}

Findings GoldenAndTruth(CheckedEpisode& checked) {
  const CheckRequest& request = checked.request;
  std::optional<truth::Golden> golden;
  const bool is_trial = checked.run.is_trial;
  if (request.in_project && !is_trial) {
    auto read = truth::GoldenFiles(request.root).ReadGoldenOf(request.id);
    if (!read) return {{ExitCode::kBadInput, "the golden cannot be read", "", read.error()}};
    golden = std::move(*read);
  }
  checked.golden = CompareWithGolden(golden, checked.run);
  ScenarioVerdict& verdict = checked.verdict;
  if (checked.golden->Differs())
    AttributeRun(request, checked.run, *golden, checked.golden->comparison, verdict);
  verdict.has_golden = checked.golden->has_golden;
  verdict.comparison = checked.golden->comparison;
  verdict.drawings = checked.run.result.drawings;
  if (is_trial) return JudgeTrial(checked);
  Findings findings = JudgeGolden(*checked.golden, checked.run, verdict.cause);
  if (!golden || !request.IsAsItsFileSays()) return findings;
  const std::string file = truth::GoldenFiles(request.root).GoldenPath(request.id).string();
  grammar::Diagnostics unfit = ValidateGolden(file, request.id, checked.run.loaded);
  if (!unfit.empty())
    findings.push_back(
        {ExitCode::kBadInput, "the golden does not fit the scenario", "", std::move(unfit)});
  return findings;
}

/// A planar scenario has the same events in both engines.
Findings OtherEngine(CheckedEpisode& checked) {
  if (!checked.request.IsPlayed() && !checked.request.is_own_record) return {};
  const CheckedRun& run = checked.run;
  const scenario::Scenario& scenario = run.loaded.scenario;
  const auto compared = CompareEngines(scenario, run.loaded.program, run.result.timeline);
  std::string& difference = checked.engine_difference;
  if (compared) difference = EngineDifferenceText(scenario, *compared, run.explain);
  if (difference.empty()) return {};
  const std::string engine = NameOf(compared->other);
  if (compared->run.status.kind != physics::RunStatus::Kind::kCompleted)
    return {{ExitCode::kFailure, "the simulation failed in " + engine, difference}};
  return {{ExitCode::kDiffers, engine + " does not lead to the same events",
           difference + kUntilEnginesAgree + "\n"}};
}

Findings UnrequestedPictures(CheckedEpisode& checked) {
  const CheckRequest& request = checked.request;
  if (!request.in_project || !request.IsAsItsFileSays()) return {};
  return JudgeUnrequestedPictures(request.id, checked.run.loaded.scenario.pictures.size(),
                                  request.root, AcceptPicturesCommand(request.id));
}

Findings GoldenBesideRecording(CheckedEpisode& checked) {
  const CheckRequest& request = checked.request;
  ScenarioVerdict& verdict = checked.verdict;
  Result<JudgedRecording> judged =
      JudgeSegmented(std::move(*checked.recording),
                     GoldenOf(request.episode, checked.run.loaded.scenario, request.root));
  if (!judged) return {{ExitCode::kBadInput, "cannot be read", "", judged.error()}};
  verdict.ticks = judged->segmented.end;
  verdict.has_golden = judged->golden.has_value();
  verdict.drawings = truth::EventDrawings(*judged->segmented.program);
  Findings findings;
  if (!judged->golden) {
    findings.push_back({ExitCode::kPending, "no golden yet", ""});
  } else if (!judged->comparison.Agrees()) {
    findings.push_back(DifferenceFinding(judged->comparison, verdict.explain));
    findings.back().details += OtherGrammarText(*judged);
  } else if (request.changes.grammar.empty() && !OtherGrammarText(*judged).empty()) {
    findings.push_back(
        {ExitCode::kBadInput, "the golden is of another grammar", OtherGrammarText(*judged)});
  }
  verdict.warnings = std::move(judged->segmented.missing.warnings);
  std::ranges::move(JudgeLaws(judged->segmented), std::back_inserter(findings));
  if (verdict.has_golden)
    verdict.attributions =
        AttributeDifferences(judged->comparison, {.other_changes = OptionsOf(request.changes)},
                             [](const auto&) { return std::optional<truth::Comparison>(); });
  verdict.comparison = std::move(judged->comparison);
  return findings;
}

/// In the events that who was heard may find.
Findings HeardAndGolden(CheckedEpisode& checked) {
  const CheckRequest& request = checked.request;
  const Heard& heard = *checked.heard;
  ScenarioVerdict& verdict = checked.verdict;
  verdict.details = heard.notes;
  if (!heard.failure.empty())
    return {{ExitCode::kBadInput, "the recogniser failed", heard.failure}};
  const scenario::Scenario& scenario = checked.run.loaded.scenario;
  Result<std::optional<truth::Golden>> golden{std::nullopt};
  if (checked.recording)
    golden = truth::ReadGoldenFile(GoldenOf(request.episode, scenario, request.root),
                                   checked.recording->name);
  else if (request.in_project && !checked.run.is_trial)
    golden = truth::GoldenFiles(request.root).ReadGoldenOf(request.id);
  if (!golden) return {{ExitCode::kBadInput, "the golden cannot be read", "", golden.error()}};
  verdict.has_golden = golden->has_value();
  verdict.drawings = truth::EventDrawings(*checked.run.loaded.program);
  truth::Golden covered =
      golden->value_or(truth::Golden{.ticks_per_second = heard.timeline.ticks_per_second});
  std::set<std::string> left_out;
  std::erase_if(covered.events, [&](truth::GoldenEvent& line) {
    const bool is_covered = heard.MayFind(line.event);
    if (!is_covered) left_out.insert(line.event.event);
    return !is_covered;
  });
  if (!left_out.empty())
    verdict.details +=
        fmt::format("not covered by the recogniser: {}\n", fmt::join(left_out, ", "));
  verdict.comparison = truth::Compare(
      covered, heard.timeline,
      checked.recording ? ToleranceOf(*checked.recording) : scenario::DefaultTolerance(scenario));
  if (!verdict.has_golden)
    return {
        {ExitCode::kPending, checked.run.is_trial ? "a trial has no golden" : "no golden yet", ""}};
  if (verdict.comparison->Agrees()) return {};
  return {DifferenceFinding(*verdict.comparison, "")};
}

/// Pictures come last, since of a suite they show what has not passed.
constexpr Judge kOfRuns[] = {
    Invariants, Limits, Laws, Claims, GoldenAndTruth, OtherEngine, UnrequestedPictures, Pictures};
constexpr Judge kOfFailedRuns[] = {EndOfRun, Pictures};
constexpr Judge kOfRecordings[] = {GoldenBesideRecording};
constexpr Judge kOfHeard[] = {HeardAndGolden};

/// Those that can judge this episode: of a recording only its golden, of a run that failed only
/// that.
std::span<const Judge> JudgesOf(const CheckedEpisode& checked) {
  if (checked.heard) return kOfHeard;
  if (checked.recording) return kOfRecordings;
  if (checked.IsComplete()) return kOfRuns;
  return kOfFailedRuns;
}

/// The goldens that decide the verdict of a scenario, whether they exist or not: one that appears
/// changes the verdict. Of pictures those that it asks for and one more, which would be too many.
std::vector<std::string> FilesOfGolden(const CheckRequest& request,
                                       const scenario::Scenario* scenario) {
  if (!request.in_project) return {};
  const truth::GoldenFiles goldens(request.root);
  std::vector<std::string> files = {goldens.GoldenPath(request.id).string()};
  for (const truth::KeptPicture& picture : goldens.PicturesOf(request.id)) {
    files.push_back(picture.path.string());
    files.push_back(show::ThingsFile(picture.path.string()));
  }
  for (std::size_t i = 1; scenario && i <= scenario->pictures.size() + 1; ++i) {
    const std::string file = scenario->name + (i == 1 ? "" : "-" + std::to_string(i)) + ".png";
    const std::string picture = goldens.PicturePath(request.id, file).string();
    files.push_back(picture);
    files.push_back(show::ThingsFile(picture));
  }
  return files;
}

/// With what decides it, as it is before it is judged. `scenario` is null if it cannot be read.
ScenarioVerdict BlankVerdict(const CheckRequest& request, const scenario::Scenario* scenario,
                             std::vector<std::string> files) {
  if (request.episode.origin == episode::Origin::kRecording)
    files = {request.episode.file,
             scenario ? GoldenOf(request.episode, *scenario, request.root) : ""};
  else
    std::ranges::move(FilesOfGolden(request, scenario), std::back_inserter(files));
  if (!request.file_hash.empty()) std::erase(files, request.episode.file);
  FileHashes inputs = HashFiles(files);
  if (!request.file_hash.empty()) inputs[request.episode.file] = request.file_hash;
  return {.scenario = request.id,
          .explain = ExplainCommand(request),
          .command = RepeatCommand(request),
          .inputs = std::move(inputs)};
}

CheckedEpisode ToBeChecked(const CheckRequest& request, episode::LoadedRun loaded,
                           const std::vector<std::string>& files) {
  ScenarioVerdict verdict = BlankVerdict(request, &loaded.scenario, files);
  CheckedRun run{.id = request.id,
                 .in_project = request.in_project,
                 .loaded = std::move(loaded),
                 .explain = verdict.explain};
  return {.request = request, .run = std::move(run), .verdict = std::move(verdict)};
}

/// Simulates and records it. Reports how far it has come while it is going on.
void Play(const std::vector<std::string>& files, CheckedEpisode& checked) {
  const CheckRequest& request = checked.request;
  const episode::LoadedRun& loaded = checked.run.loaded;
  std::optional<episode::EpisodeRecorder> recorder;
  if (!request.record_file.empty())
    recorder.emplace(episode::RecordRequest{request.record_file, request.root, request.Run(), files,
                                            request.today, request.program, request.record_uuid},
                     loaded.scenario);
  episode::ScenarioRun playing(loaded.scenario, loaded.program, {.record = true});
  while (playing.Step()) {
    if (request.last_tick) request.last_tick->store(playing.snapshot().tick);
    if (recorder) recorder->Add(playing.snapshot());
  }
  checked.run.result = playing.Finish();
  if (!recorder) return;
  recorder->Finish(checked.run.result);
  checked.verdict.not_recorded = recorder->problem();
}

/// The only place of a check that writes below build/, pictures of the report aside. Returns why
/// `review` will not see a proposal, or ""; what else cannot be written is reported by the command
/// that needs it, or costs only the cause of a difference.
std::string Store(const CheckedEpisode& checked) {
  const CheckRequest& request = checked.request;
  if (request.leave_nothing_behind) return "";
  const truth::GoldenFiles files(request.root);
  std::string problem;
  if (checked.golden && checked.golden->Holds()) files.RemovePending(request.id);
  if (checked.golden && !checked.golden->Holds())
    problem = files.WritePending(checked.golden->pending);
  (void)files.WriteEngineDifference(request.id, checked.engine_difference);
  StorePictures(request.id, checked.pictures, request.root);
  if (checked.verdict.verdict == Verdict::kPassed)
    (void)WriteTrace(LastPasses(request.root).TracePath(request.id),
                     TraceOf(checked.run.loaded.scenario.scene, checked.run.result.recording));
  return problem.empty() ? "" : "no proposal is left: " + problem + "\n";
}

/// The first finding decides; one that is wrong comes before a golden that does not exist yet.
void Conclude(const Findings& findings, ScenarioVerdict& verdict) {
  verdict.verdict = Verdict::kPassed;
  for (const Finding& finding : findings) {
    verdict.details += finding.details;
    std::ranges::copy(finding.errors, std::back_inserter(verdict.errors));
  }
  if (findings.empty()) return;
  const auto wrong = std::ranges::find_if(
      findings, [](const Finding& finding) { return finding.exit_code != ExitCode::kPending; });
  const Finding& first = wrong == findings.end() ? findings.front() : *wrong;
  verdict.verdict = wrong == findings.end() ? Verdict::kPending : Verdict::kFailed;
  verdict.exit_code = first.exit_code;
  verdict.reason = first.reason;
}

/// Paths in the project are relative to it.
void Shorten(std::string& text, const std::string& root) {
  const std::string folder = root + "/";
  for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder, at))
    text.erase(at, folder.size());
}

ScenarioVerdict Unreadable(const CheckRequest& request, ScenarioVerdict verdict,
                           const grammar::Diagnostics& why) {
  Conclude({{why.empty() ? ExitCode::kBadInput : CodeOf(why.front().message), "cannot be read", "",
             why}},
           verdict);
  AttributeUnread(request, verdict);
  if (request.IsPlayed()) verdict.command = CommandAbout("validate", request.id, request.Asked());
  return verdict;
}

/// What to do about a verdict: repeat it, or review what is pending, or look at a run that failed.
std::string NextCommand(const CheckedEpisode& checked) {
  const CheckRequest& request = checked.request;
  const std::string again = RepeatCommand(request);
  const bool is_pending = checked.verdict.verdict == Verdict::kPending;
  if (checked.heard) return again;
  if (checked.recording && is_pending) {
    // `review` and `accept` take what the golden is named after: of one of many in a file, all.
    if (request.episode.number) {
      const std::string golden =
          GoldenOf(request.episode, checked.run.loaded.scenario, request.root);
      const fs::path source = fs::path(request.root) / checked.run.loaded.scenario.file;
      if (fs::path(golden).parent_path().extension() == ".timelines")
        return CommandText({"review", request.episode.file});
      std::error_code error;
      const fs::path from_here = fs::proximate(source, error);
      const bool is_below = !from_here.empty() && *from_here.begin() != "..";
      return fs::exists(source, error)
                 ? CommandText({"review", (is_below ? from_here : source).string()})
                 : again;
    }
    return request.changes.settings.empty() ? CommandAbout("review", request.id, request.Asked())
                                            : again;
  }
  if (!checked.IsComplete() && request.IsPlayed())
    return CommandAbout("run", request.id, request.Asked());
  const bool can_review = request.in_project && request.IsAsItsFileSays();
  return is_pending && can_review ? CommandAbout("review", request.id) : again;
}

/// What the report shows of an episode that differs, or of all.
void AddPictures(CheckedEpisode& checked) {
  const CheckRequest& request = checked.request;
  ScenarioVerdict& verdict = checked.verdict;
  const scenario::Scenario& scenario = checked.run.loaded.scenario;
  const bool has_frames = !checked.recording || request.episode.number;
  const bool wants_replay =
      request.replays == Replays::kAll ||
      (request.replays == Replays::kFailures && verdict.verdict != Verdict::kPassed);
  if (has_frames && wants_replay) verdict.replay = show::ReplayData(scenario, checked.run.result);
  if (checked.recording || !verdict.comparison) return;
  verdict.steps = show::PlayedSteps(scenario, checked.run.result);
  if (checked.heard || !verdict.DiffersFromGolden()) return;
  if (request.pictures && show::CanDrawPictures())
    verdict.drawn_differences =
        DrawDifferences(scenario, checked.run.result, *verdict.comparison, request.report_folder);
  if (request.explain)
    verdict.explained =
        Explain(scenario, checked.run.result, checked.run.loaded.program, *verdict.comparison);
}

ScenarioVerdict VerdictOn(CheckedEpisode checked) {
  const CheckRequest& request = checked.request;
  const episode::RunResult& run = checked.run.result;
  ScenarioVerdict& verdict = checked.verdict;
  if (!checked.recording) {
    std::error_code error;
    // Fields are compared with those of the last pass, or kept for the next run.
    const bool with_fields = !request.leave_nothing_behind ||
                             fs::exists(LastPasses(request.root).TracePath(request.id), error);
    verdict.settings = SettingsOf(checked.run.loaded, request.Run(), verdict.inputs, request.root,
                                  checked.run.task.files, with_fields);
    verdict.shows = checked.run.loaded.scenario.shows;
    verdict.notes = episode::NoteLines(checked.run.loaded.scenario, run);
    verdict.state_hash = episode::HashText(run.state_hash);
    verdict.ticks = run.ticks;
  }
  Findings findings;
  for (const Judge judge : JudgesOf(checked)) {
    Append(findings, judge(checked));
    checked.is_good = findings.empty();
  }
  Conclude(findings, verdict);
  const bool is_run = !checked.recording && !checked.heard;
  if (is_run && checked.IsComplete())
    verdict.picture_differences = PictureDifferencesText(
        checked.pictures, request.IsAsItsFileSays() ? AcceptPicturesCommand(request.id) : "");
  const bool differs = verdict.verdict == Verdict::kFailed || !verdict.picture_differences.empty();
  if (differs && verdict.attributions.empty() && is_run)
    AttributeFailure(request, checked.run, verdict);
  if (is_run && checked.IsComplete()) verdict.details += Store(checked);
  for (std::string* text : {&verdict.reason, &verdict.details, &verdict.warnings})
    Shorten(*text, request.root);
  verdict.details += truth::TextOfUndecided(verdict.claims);
  verdict.command = NextCommand(checked);
  AddPictures(checked);
  return std::move(verdict);
}

/// What is said of it by who is heard instead of the grammar, if somebody is.
grammar::Diagnostics Hear(episode::Episode& episode, grammar::Timeline& timeline,
                          CheckedEpisode& checked) {
  if (!checked.request.listen) return {};
  PREHEND_TRY(Heard heard, checked.request.listen(episode));
  timeline = heard.timeline;
  checked.heard = std::move(heard);
  return {};
}

grammar::Diagnostics Segment(episode::Episode& episode, CheckedEpisode& checked) {
  const CheckRequest& request = checked.request;
  PREHEND_TRY(auto segmented, episode.SegmentRecorded());
  const grammar::Diagnostics unheard = Hear(episode, segmented.timeline, checked);
  if (!unheard.empty()) return unheard;
  if (!checked.heard || checked.heard->failure.empty())
    checked.verdict.demonstration = DemonstrationOf(*episode.recording(), segmented.timeline,
                                                    truth::EventDrawings(*segmented.program));
  if (request.episode.number && request.replays != Replays::kNone)
    checked.run.result = episode.RunOf(segmented, /*frames=*/true);
  checked.recording = std::move(segmented);
  if (episode.row()) checked.verdict.state_hash = episode.row()->state_hash;
  return {};
}

/// Of a run that is kept, or of a scenario whose frames somebody wants to see.
grammar::Diagnostics Replay(episode::Episode& episode, CheckedEpisode& checked) {
  if (checked.request.IsPlayed()) (void)episode.Played();
  PREHEND_TRY(checked.run.result, episode.Run(/*frames=*/true));
  return checked.IsComplete() ? Hear(episode, checked.run.result.timeline, checked)
                              : grammar::Diagnostics();
}

}  // namespace

ScenarioVerdict CheckScenario(const CheckRequest& request) {
  std::vector<std::string> files;
  episode::EpisodeOpener own(request.root);  // what it unpacks is read until the end
  episode::EpisodeOpener& opener = request.opener ? *request.opener : own;
  Result<episode::Episode> episode = opener.Open(request.episode, request.changes, &files);
  if (!episode) return Unreadable(request, BlankVerdict(request, nullptr, files), episode.error());
  CheckedEpisode checked = ToBeChecked(request, episode->loaded(), files);
  Result<episode::TaskFiles> task = episode->Task();
  if (!task) return Unreadable(request, std::move(checked.verdict), task.error());
  checked.run.task = std::move(*task);
  checked.run.is_trial = episode->IsTrial();
  grammar::Diagnostics unread;
  if (request.IsPlayed() && !request.listen)
    Play(files, checked);
  else
    unread = episode->recording() ? Segment(*episode, checked) : Replay(*episode, checked);
  if (!unread.empty()) return Unreadable(request, std::move(checked.verdict), unread);
  return VerdictOn(std::move(checked));
}

ScenarioVerdict JudgeRun(const CheckRequest& request, episode::LoadedRun loaded,
                         episode::RunResult run, const std::vector<std::string>& files) {
  CheckedEpisode checked = ToBeChecked(request, std::move(loaded), files);
  checked.run.result = std::move(run);
  return VerdictOn(std::move(checked));
}

}  // namespace prehend::suite
