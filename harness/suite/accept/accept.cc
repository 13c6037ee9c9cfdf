// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/accept/accept.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/content_hash.h"
#include "harness/base/base/project_paths.h"
#include "harness/base/base/quoting.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/run_text.h"
#include "harness/scenario/read/read_scenario.h"
#include "harness/show/pictures/pictures.h"
#include "harness/suite/check/last_pass.h"
#include "harness/suite/judge/judges.h"
#include "harness/suite/judge/other_view.h"
#include "harness/suite/judge/validate_golden.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/golden/golden.h"

namespace prehend::suite {
namespace {

namespace fs = std::filesystem;

/// A run, and the golden that its scenario had before. What refuses says so in the outcome, and
/// returns true.
class Acceptance {
 public:
  Acceptance(const AcceptRequest& request, std::string id)
      : request_(request), files_(request.root), id_(std::move(id)) {}

  grammar::Diagnostics Play(const std::string& path);
  AcceptOutcome Events();
  AcceptOutcome Pictures();

 private:
  bool Refuse(ExitCode code, std::string why) {
    outcome_.code = code;
    outcome_.problem = std::move(why);
    return true;
  }
  bool RefuseIf(const std::string& problem) {
    return !problem.empty() && Refuse(ExitCode::kFailure, problem);
  }
  bool DidNotComplete();
  bool ClaimsFail();
  bool EnginesDiffer();
  bool IsUnsteady(truth::Golden& golden);
  bool IsNotWhatWasShown(const truth::Golden& pending, const OracleComparison& truth);
  truth::Comparison ComparisonWithOld() const {
    return truth::Compare(*old_, run_.timeline, scenario::DefaultTolerance(loaded_.scenario));
  }
  void AcceptEvents();
  void NothingToAccept();
  void MeasureSpreadsAnew();
  void ShowDifference(const OracleComparison& truth);
  std::string MovedWithinTolerance() const;
  void LeaveBaseline() const;
  bool IsThePictureShown(const fs::path& drawn) const;
  int RemoveUnrequestedPictures();
  std::optional<bool> KeepPicture(const fs::path& drawn);

  const AcceptRequest& request_;
  const truth::GoldenFiles files_;
  const std::string id_;
  std::optional<truth::Golden> old_;
  episode::LoadedRun loaded_;
  std::vector<std::string> inputs_;  ///< all files that the run depends on
  episode::RunResult run_;
  AcceptOutcome outcome_;
};

grammar::Diagnostics Acceptance::Play(const std::string& path) {
  inputs_ = {files_.GoldenPath(id_).string()};
  PREHEND_TRY(loaded_, episode::LoadRun({.scenario_file = path}, request_.root, &inputs_));
  PREHEND_TRY(old_, files_.ReadGoldenOf(id_));
  if (!request_.pictures || old_)
    run_ = episode::RunScenario(loaded_.scenario, loaded_.program, {.record = true});
  return {};
}

bool Acceptance::DidNotComplete() {
  return run_.status.kind != physics::RunStatus::Kind::kCompleted &&
         Refuse(ExitCode::kFailure,
                "a run that did not complete cannot be accepted: " + episode::StatusText(run_));
}

/// Says what will change, and where it differs from the ground truth.
void Acceptance::ShowDifference(const OracleComparison& truth) {
  outcome_.text += old_ ? truth::DifferenceText(ComparisonWithOld(), CommandAbout("explain", id_))
                        : "new golden:\n" + episode::RunTable(run_);
  outcome_.text += GroundTruthText(truth);
}

/// A line for each event whose boundaries moved within their tolerance, or "".
std::string Acceptance::MovedWithinTolerance() const {
  const double ms = 1000.0 / static_cast<double>(old_->ticks_per_second);
  std::string text;
  for (const truth::Pairing& pairing : ComparisonWithOld().pairings) {
    if (pairing.agreement != truth::LineVerdict::kMatched) continue;
    if (pairing.begin_offset == 0 && pairing.end_offset == 0) continue;
    text += fmt::format("moved {}: begin {:+.1f} ms, end {:+.1f} ms, within the tolerance\n",
                        pairing.event().Label(), static_cast<double>(pairing.begin_offset) * ms,
                        static_cast<double>(pairing.end_offset) * ms);
  }
  return text;
}

/// The next difference is traced back to the run that is accepted now.
void Acceptance::LeaveBaseline() const {
  const LastPasses records(request_.root);
  LastPass record{
      .program = ProgramHash(), .build = BuildText(), .passed = false, .pictures = false};
  record.verdict.scenario = id_;
  record.verdict.inputs = HashFiles(inputs_);
  record.verdict.settings = SettingsOf(loaded_, {}, record.verdict.inputs, request_.root);
  // Without it, only the cause of the next difference stays unknown.
  (void)records.Write(record);
  (void)WriteTrace(records.TracePath(id_), TraceOf(loaded_.scenario.scene, run_.recording));
}

/// A person was shown something by its fingerprint, or by the pending file.
bool Acceptance::IsNotWhatWasShown(const truth::Golden& pending, const OracleComparison& truth) {
  const std::string now = Fingerprint(pending);
  const auto waiting = files_.ReadPendingOf(pending.scenario);
  const std::string shown = waiting && *waiting ? Fingerprint(**waiting) : now;
  const std::string reviewed = request_.reviewed.value_or(shown);
  if (reviewed == now) return false;
  std::string why = "the reviewed golden was " + reviewed + ", but the scenario now yields " + now;
  if (reviewed == shown)
    why = "the pending golden is " + shown + ", but the scenario now yields " + now;
  else if (shown == now)
    why = "the pending golden is " + now + ", not " + reviewed;
  ShowDifference(truth);
  return RefuseIf(files_.WritePending(pending)) ||
         Refuse(ExitCode::kDiffers,
                why + " (printed above); nothing was accepted\n  if that is right: " +
                    AcceptCommandLine(id_, now));
}

/// Events that are others a millimetre away prove nothing, unless a person says why they may be.
/// Otherwise keeps how far the boundaries of `golden` moved.
bool Acceptance::IsUnsteady(truth::Golden& golden) {
  const Ensemble ensemble = PlayEnsemble(loaded_, run_.timeline, golden);
  for (const Finding& broken : ensemble.broken) outcome_.text += broken.details;
  if (!ensemble.broken.empty())
    return Refuse(ExitCode::kDiffers,
                  fmt::format("what the scenario expects does not hold after {} of {} transforms "
                              "(printed above); nothing was accepted\n  {}",
                              ensemble.plays_broken, ensemble.plays - 1, kUntilClaimsHold));
  KeepSpreads(ensemble, golden);
  if (ensemble.differences.empty() && !golden.unsteady.empty()) {
    outcome_.text += fmt::format("steady in {} plays: 'unsteady' is left out\n", ensemble.plays);
    golden.unsteady.clear();
  }
  if (ensemble.differences.empty() || !golden.unsteady.empty()) return false;
  for (const Finding& difference : ensemble.differences) outcome_.text += difference.details;
  return Refuse(
      ExitCode::kDiffers,
      fmt::format("the events are others after {} of {} transforms (printed above); nothing was "
                  "accepted\n  give the scenario a margin{}, or say why that may be: --unsteady "
                  "\"...\"",
                  ensemble.differences.size(), ensemble.plays - 1,
                  old_ ? ", or its line in the golden a tolerance with a reason" : ""));
}

/// The golden stays as it is, but for how far transforms move its boundaries.
void Acceptance::NothingToAccept() {
  files_.RemovePending(id_);
  truth::Golden golden = *old_;
  if (IsUnsteady(golden)) return;
  if (truth::WriteGolden(golden) != truth::WriteGolden(*old_)) {
    if (RefuseIf(files_.WriteAccepted(golden))) return;
    outcome_.text += "how far transforms move boundaries was measured anew\n";
  }
  LeaveBaseline();
  const std::string margin = MarginText(ComparisonWithOld());
  outcome_.text += "nothing to accept: the scenario agrees with " +
                   files_.GoldenPath(id_).string() + (margin.empty() ? "" : "; " + margin) + "\n";
}

/// What a scenario shows is decided before its events are.
bool Acceptance::ClaimsFail() {
  std::string text = truth::TextOfContradicted(JudgeClaims(loaded_, run_.timeline));
  for (const Finding& limit : JudgeLimits(loaded_.scenario, run_.notes)) text += limit.details;
  outcome_.text += text;
  return !text.empty() &&
         Refuse(ExitCode::kDiffers, std::string("the events contradict what the scenario expects "
                                                "(printed above); nothing was accepted\n  ") +
                                        kUntilClaimsHold);
}

/// A planar scenario must have the same events in both engines: `check` would fail whatever were
/// accepted.
bool Acceptance::EnginesDiffer() {
  const auto compared = CompareEngines(loaded_.scenario, loaded_.program, run_.timeline);
  const std::string text =
      compared ? EngineDifferenceText(loaded_.scenario, *compared, CommandAbout("explain", id_))
               : "";
  (void)files_.WriteEngineDifference(id_, text);
  outcome_.text += text;
  if (text.empty()) return false;
  const bool ended = compared->run.status.kind == physics::RunStatus::Kind::kCompleted;
  return Refuse(ended ? ExitCode::kDiffers : ExitCode::kFailure,
                std::string(NameOf(compared->other)) +
                    " yields other events (printed above); nothing was accepted\n  " +
                    kUntilEnginesAgree);
}

void Acceptance::AcceptEvents() {
  const OracleComparison truth = CompareWithOracle(loaded_.scenario, *loaded_.program, run_);
  Proposal proposal{.scenario = id_,
                    .grammar = loaded_.scenario.grammar,
                    .derived = request_.derived,
                    .acceptance = truth::Acceptance{request_.today, request_.reason},
                    .tolerance = truth.tolerance,
                    .exact = request_.exact};
  const bool from_people = !proposal.derived.empty();
  if (!from_people && old_) proposal.derived = old_->derived;
  proposal.derived = RenewedDerivation(proposal.derived, OracleLine(truth));
  const bool has_new_derivation = from_people && (!old_ || old_->derived != proposal.derived);
  const truth::Golden pending =
      PendingGolden(old_, run_.timeline, id_, loaded_.scenario.grammar, truth);
  const std::string moved = proposal.exact && old_ ? MovedWithinTolerance() : "";
  if (old_ && *old_ == pending && !has_new_derivation && !request_.unsteady && moved.empty()) {
    if (request_.reviewed && *request_.reviewed != Fingerprint(pending))
      outcome_.notes += "--reviewed " + *request_.reviewed +
                        " is not what the scenario yields now, which agrees with its golden\n";
    return NothingToAccept();
  }
  if (IsNotWhatWasShown(pending, truth)) return;
  truth::Golden golden = ProposeGolden(old_, run_.timeline, proposal);
  if (request_.unsteady) golden.unsteady = *request_.unsteady;
  if (IsUnsteady(golden)) return;
  ShowDifference(truth);
  outcome_.text += moved + OracleLine(truth) + "\n";
  if (RefuseIf(files_.WriteAccepted(golden))) return;
  LeaveBaseline();
  outcome_.text += "accepted: " + files_.GoldenPath(id_).string() + "\n";
}

AcceptOutcome Acceptance::Events() {
  if (DidNotComplete()) return outcome_;
  for (const std::string& note : episode::NoteLines(loaded_.scenario, run_))
    outcome_.notes += note + "\n";
  if (!ClaimsFail() && !EnginesDiffer()) AcceptEvents();
  return outcome_;
}

/// Whether `drawn` is the picture that `check` left for review, if it left one.
bool Acceptance::IsThePictureShown(const fs::path& drawn) const {
  const fs::path shown = files_.PendingPicturePath(id_, drawn.filename().string());
  std::error_code error;
  return !fs::exists(shown, error) || FileHash(shown.string()) == FileHash(drawn.string());
}

/// Those that the scenario no longer defines; returns how many.
int Acceptance::RemoveUnrequestedPictures() {
  int removed = 0;
  for (const fs::path& picture :
       UnrequestedPictures(id_, loaded_.scenario.pictures.size(), request_.root)) {
    std::error_code error;
    if (!fs::remove(picture, error)) continue;
    fs::remove(show::ThingsFile(picture.string()), error);
    outcome_.text += "removed: " + picture.string() + "\n";
    ++removed;
  }
  return removed;
}

/// Makes `drawn`, with what it shows, the golden picture. Returns whether that changes a byte;
/// nothing when it cannot be moved.
std::optional<bool> Acceptance::KeepPicture(const fs::path& drawn) {
  const fs::path golden = files_.PicturePath(id_, drawn.filename().string());
  files_.RemovePendingPicture(id_, golden.filename().string());
  const std::string things = show::ThingsFile(golden.string()),
                    shown = show::ThingsFile(drawn.string());
  if (FileHash(golden.string()) == FileHash(drawn.string()) && FileHash(things) == FileHash(shown))
    return false;
  std::error_code error;
  fs::create_directories(golden.parent_path(), error);
  fs::rename(shown, things, error);
  if (!error) fs::rename(drawn, golden, error);
  if (error) return std::nullopt;
  outcome_.text += "accepted: " + golden.string() + "\n";
  return true;
}

AcceptOutcome Acceptance::Pictures() {
  if (!old_)
    Refuse(ExitCode::kPending,
           "the events of this scenario have no golden yet; accept them first, without --pictures");
  if (!old_ || DidNotComplete()) return outcome_;
  const fs::path folder =
      fs::path(BuildFolder(request_.root)) / "pending-pictures" / loaded_.scenario.skill;
  std::error_code error;
  fs::create_directories(folder, error);
  const show::PictureResult drawn = show::DrawGoldens(loaded_.scenario, run_, folder.string());
  if (!drawn.error.empty() && RefuseIf("no picture: " + drawn.error)) return outcome_;
  for (const show::WrittenPicture& picture : drawn.pictures) {
    if (IsThePictureShown(picture.file)) continue;
    Refuse(ExitCode::kDiffers,
           "the pending picture differs from what the scenario looks like now, " + picture.file +
               "; nothing was accepted\n  look at the new one: " + CommandText({"check", id_}) +
               ", then " + CommandText({"review", id_}));
    return outcome_;
  }
  int changed = RemoveUnrequestedPictures();
  for (const show::WrittenPicture& picture : drawn.pictures) {
    const std::optional<bool> kept = KeepPicture(picture.file);
    if (!kept && RefuseIf("cannot move " + picture.file + " to golden/")) return outcome_;
    changed += *kept;
  }
  if (changed == 0) {
    outcome_.text +=
        "nothing to accept: " +
        (drawn.pictures.empty() ? id_ + " defines no pictures ('pictures:' in its file)"
                                : "the pictures of " + id_ + " equal their goldens") +
        "\n";
    return outcome_;
  }
  old_->pictures.push_back({request_.today, request_.reason});
  RefuseIf(files_.WriteGoldenFile(*old_));
  return outcome_;
}

/// How it follows from the definitions, where the golden says something else.
std::string DerivationLines(const truth::Golden& pending, const std::vector<std::string>& before) {
  std::string text;
  for (const std::string& line : pending.derived) {
    if (std::ranges::count(before, line) == 0) text += line + "\n";
  }
  return text;
}

Review ReviewOf(const episode::ScenarioFile& file, const std::string& root) {
  const truth::GoldenFiles files(root);
  Review review{.id = episode::IdOf(file), .kind = "unreadable"};
  const auto pending = files.ReadPendingOf(review.id);
  const auto golden = files.ReadGoldenOf(review.id);
  const Result<episode::LoadedRun> loaded = episode::LoadRun({.scenario_file = file.path}, root);
  review.text = Format(ErrorsOf(pending)) + Format(ErrorsOf(golden)) + Format(ErrorsOf(loaded));
  if (!pending || !*pending || !loaded || !golden) return review;
  const truth::Golden& proposed = **pending;
  review.fingerprint = Fingerprint(proposed);
  review.contradicts = truth::TextOfContradicted(JudgeClaims(*loaded, truth::ToTimeline(proposed)));
  if (!*golden) {
    review.kind = "new";
    review.text = EventLines(proposed) + DerivationLines(proposed, {}) + review.contradicts;
    return review;
  }
  const truth::Comparison comparison = truth::Compare(**golden, truth::ToTimeline(proposed),
                                                      scenario::DefaultTolerance(loaded->scenario));
  const std::string derivation = DerivationLines(proposed, (*golden)->derived);
  review.kind = comparison.Agrees() && derivation.empty() ? "same" : "changed";
  review.text = truth::DifferenceText(comparison, CommandAbout("explain", review.id)) + derivation +
                review.contradicts;
  return review;
}

/// A picture that differs from its golden.
Review PictureReview(const truth::KeptPicture& pending, const std::string& root) {
  const truth::GoldenFiles files(root);
  const std::string name = pending.path.filename().string();
  const fs::path golden = files.PicturePath(pending.scenario, name),
                 difference = files.DifferencePath(pending.scenario, name);
  Review review{.id = pending.scenario, .kind = "picture"};
  std::error_code error;
  for (const auto& [what, file] : {std::pair("golden", golden), std::pair("new", pending.path),
                                   std::pair("difference", difference)}) {
    if (!fs::exists(file, error)) continue;
    review.text += fmt::format("{:<10}  {}\n", what, file.string());
    review.files.push_back(file.string());
  }
  return review;
}

/// Reviews of one scenario: its events, then its pictures.
void AddReviews(const episode::ScenarioFile& file, const std::string& root, bool is_pending,
                const std::vector<truth::KeptPicture>& pending_pictures,
                std::vector<Review>& reviews) {
  if (!file.in_project) return;
  if (is_pending) reviews.push_back(ReviewOf(file, root));
  if (const std::string engines =
          truth::GoldenFiles(root).ReadEngineDifference(episode::IdOf(file));
      !engines.empty())
    reviews.push_back({.id = episode::IdOf(file), .kind = "engines", .text = engines});
  for (const truth::KeptPicture& picture : pending_pictures) {
    if (picture.scenario == episode::IdOf(file)) reviews.push_back(PictureReview(picture, root));
  }
  if (truth::GoldenFiles(root).PicturesOf(episode::IdOf(file)).empty()) return;
  const Result<scenario::Scenario> scenario =
      scenario::ReadScenario(file.path, {}, episode::ProjectLibrary(root));
  if (!scenario) return;
  const std::size_t asked = scenario->pictures.size();
  for (const fs::path& picture : UnrequestedPictures(episode::IdOf(file), asked, root))
    reviews.push_back({.id = episode::IdOf(file),
                       .kind = "orphan",
                       .text = UnrequestedText(picture, asked) + "\n",
                       .files = {picture.string()}});
}

/// A recording, judged now: what it yields is not kept, since judging it again costs little.
/// Nothing if it agrees with the golden beside it.
std::optional<Review> ReviewOfRecording(const episode::EpisodeName& name,
                                        const std::string& grammar, const std::string& root) {
  const CheckRequest about{.episode = name, .changes = {grammar, {}}, .id = name.file};
  Review review{.id = name.file, .kind = "unreadable"};
  const Result<JudgedRecording> judged = JudgeRecording(name, grammar, root);
  review.text = Format(ErrorsOf(judged));
  if (!judged) return review;
  if (judged->Agrees()) return std::nullopt;
  review.kind = judged->golden ? "changed" : "new";
  review.text = (name.number ? "demonstration " + judged->segmented.name + "\n" : "") +
                judged->segmented.missing.warnings + ReviewText(*judged, ExplainCommand(about));
  review.grammar = grammar;
  review.fingerprint = Fingerprint(judged->proposed);
  return review;
}

/// The next step, in one line, or "".
std::string NextStep(const Review& review, bool engines_differ) {
  if (review.kind == "engines" || (engines_differ && !review.fingerprint.empty()))
    return kUntilEnginesAgree;
  if (!review.contradicts.empty()) return kUntilClaimsHold;
  if (review.kind == "picture") return "if right: " + AcceptPicturesCommand(review.id);
  if (review.kind != "new" && review.kind != "changed") return "";
  return "if right: " + AcceptCommandLine(review.id, review.fingerprint, review.grammar);
}

}  // namespace

Result<AcceptOutcome> AcceptScenario(const episode::ScenarioFile& file,
                                     const AcceptRequest& request) {
  // Another one must not lose the reason that this one adds.
  const FolderLock one_at_a_time(request.root);
  Acceptance acceptance(request, episode::IdOf(file));
  grammar::Diagnostics errors = acceptance.Play(file.path);
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  return request.pictures ? acceptance.Pictures() : acceptance.Events();
}

Result<AcceptOutcome> AcceptRecording(const episode::EpisodeName& name,
                                      const AcceptRequest& request) {
  const FolderLock one_at_a_time(request.root);
  PREHEND_TRY(const JudgedRecording judged, JudgeRecording(name, request.grammar, request.root));
  const std::string &file = name.file, &golden_file = judged.golden_file;
  const std::string now = Fingerprint(judged.proposed);
  AcceptOutcome outcome{.notes = judged.segmented.missing.warnings};
  const auto refuse = [&](ExitCode code, std::string why) {
    outcome.code = code;
    outcome.problem = std::move(why);
    return outcome;
  };
  if (judged.segmented.missing.nothing_left)
    return refuse(ExitCode::kNothing,
                  "no event of the grammar can be recognised; nothing was accepted");
  if (request.reviewed.value_or(now) != now)
    return refuse(
        ExitCode::kDiffers,
        fmt::format("the reviewed golden was {}, but the recording now yields {}; "
                    "nothing was accepted\n  if that is right: {}",
                    *request.reviewed, now, AcceptCommandLine(file, now, request.grammar)));
  if (judged.Agrees() && request.derived.empty()) {
    outcome.text = "nothing to accept: the recording agrees with " + golden_file + "\n";
    return outcome;
  }
  const truth::Golden golden =
      AcceptedRecording(judged, request.derived, {request.today, request.reason});
  std::error_code error;
  if (name.number) fs::create_directories(fs::path(golden_file).parent_path(), error);
  const std::string problem = truth::WriteGoldenFile(golden_file, golden);
  if (!problem.empty()) return refuse(ExitCode::kFailure, problem);
  const CheckRequest about{.episode = name, .changes = {request.grammar, {}}, .id = file};
  outcome.text = ReviewText(judged, ExplainCommand(about)) + "accepted: " + golden_file + "\n";
  return outcome;
}

tl::expected<std::vector<Review>, NoSelection> Reviews(const std::vector<std::string>& patterns,
                                                       const std::string& grammar,
                                                       const std::string& root) {
  const auto refused = [](std::string why) {
    return tl::unexpected(NoSelection{ExitCode::kBadInput, std::move(why)});
  };
  auto selected = SelectScenarios(patterns, {}, root);
  if (!selected && !patterns.empty()) return tl::unexpected(selected.error());
  const ScenarioSelection selection = selected ? std::move(*selected) : ScenarioSelection{};
  const auto is_recording = [](const episode::ScenarioFile& file) {
    return episode::EpisodeKindOf(file.path) == episode::EpisodeKind::kJsonLines;
  };
  const auto no_scenario = [&](const episode::ScenarioFile& file) {
    return is_recording(file) || file.origin == episode::Origin::kRecording;
  };
  if (!grammar.empty() &&
      (patterns.empty() || !std::ranges::all_of(selection.scenarios, no_scenario)))
    return refused(
        "--grammar concerns recordings; the golden of a scenario is of the grammar that it names");
  std::vector<std::string> pending = truth::GoldenFiles(root).ListPending();
  const std::vector<truth::KeptPicture> pictures = truth::GoldenFiles(root).PendingPictures();
  std::vector<Review> reviews;
  for (const episode::ScenarioFile& file : selection.scenarios) {
    const bool is_kept = file.origin == episode::Origin::kRecording && !is_recording(file);
    if (is_recording(file) || is_kept) {
      auto review = ReviewOfRecording(NameOf(file), grammar, root);
      if (is_kept && review && review->kind == "unreadable") return refused(review->text);
      if (review) reviews.push_back(std::move(*review));
    } else {
      AddReviews(file, root, std::erase(pending, episode::IdOf(file)) > 0, pictures, reviews);
    }
  }
  for (const std::string& id : patterns.empty() ? pending : std::vector<std::string>()) {
    const std::string file = truth::GoldenFiles(root).PendingPath(id).string();
    reviews.push_back(
        {.id = id,
         .kind = "orphan",
         .text = "the scenario of this pending golden does not exist; remove " + file + "\n",
         .files = {file}});
  }
  for (const UnreferencedGolden& orphan : selection.orphans) {
    Review review{.id = orphan.scenario, .kind = "orphan", .text = Text(orphan)};
    for (const fs::path& file : orphan.files) review.files.push_back(file.string());
    reviews.push_back(std::move(review));
  }
  return reviews;
}

std::string ReviewsText(const std::vector<Review>& reviews) {
  if (reviews.empty())
    return "nothing is pending ('" + CommandText({"check"}) +
           "' finds what differs from its golden)\n";
  std::set<std::string> engines_differ;
  for (const Review& review : reviews) {
    if (review.kind == "engines") engines_differ.insert(review.id);
  }
  std::string text;
  for (const Review& review : reviews) {
    text += review.kind + "  " + review.id + "\n";
    std::istringstream lines(review.text);
    for (std::string line; std::getline(lines, line);) text += "    " + line + "\n";
    const std::string next = NextStep(review, engines_differ.contains(review.id));
    if (!next.empty()) text += "    " + next + "\n";
  }
  return text;
}

nlohmann::ordered_json ReviewsJson(const std::vector<Review>& reviews) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Review& review : reviews)
    list.push_back({{"scenario", review.id},
                    {"kind", review.kind},
                    {"fingerprint", review.fingerprint},
                    {"files", review.files},
                    {"text", review.text}});
  return {{"pending", list}};
}

}  // namespace prehend::suite
