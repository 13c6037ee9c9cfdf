// SPDX-License-Identifier: Apache-2.0
// prehend review: what is to be accepted. Reads files only: the pending ones are from `check`.
// Tested by tests/program/golden_workflow_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "harness/base/base/shell_quote.h"
#include "harness/cli/command/command.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/episode/lacks.h"
#include "harness/episode/run/project_library.h"
#include "harness/scenario/read/read_scenario.h"
#include "harness/suite/check/check_scenario.h"
#include "harness/suite/check/select_scenarios.h"
#include "harness/suite/judge/accept_golden.h"
#include "harness/suite/judge/compare_engines.h"
#include "harness/suite/judge/judge_claims.h"
#include "harness/suite/judge/judge_recording.h"
#include "harness/suite/judge/unreferenced_goldens.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/golden/golden_files.h"

namespace prehend::cli {
namespace {

namespace fs = std::filesystem;

/// One thing to review.
struct Review {
  std::string id;
  std::string kind;  ///< "new", "changed", "same", "engines", "picture", "unreadable", "orphan"
  std::string text;  ///< events of a new scenario, differences, errors; several lines or empty
  std::string fingerprint = {};  ///< of the pending golden; lets `accept` take nothing else
  std::vector<std::string> files =
      {};  ///< of a picture: golden, new, difference; of an orphan: what to remove
  std::string contradicts = {};  ///< the claims that the pending golden contradicts, or empty
  std::string grammar = {};      ///< `--grammar` of a recording, or empty
};

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
  Review review{.id = episode::ScenarioId(file.skill, file.name), .kind = "unreadable", .text = {}};
  const auto pending = files.ReadPendingOf(review.id);
  const auto golden = files.ReadGoldenOf(review.id);
  const Result<episode::LoadedRun> loaded = episode::LoadRun({.scenario_file = file.path}, root);
  review.text = Format(ErrorsOf(pending)) + Format(ErrorsOf(golden)) + Format(ErrorsOf(loaded));
  if (!pending || !*pending || !loaded || !golden) return review;
  const truth::Golden& proposed = **pending;
  review.fingerprint = suite::Fingerprint(proposed);
  review.contradicts =
      truth::TextOfContradicted(suite::JudgeClaims(*loaded, truth::ToTimeline(proposed)));
  if (!*golden) {
    review.kind = "new";
    review.text = suite::EventLines(proposed) + DerivationLines(proposed, {}) + review.contradicts;
    return review;
  }
  const truth::Comparison comparison = truth::Compare(**golden, truth::ToTimeline(proposed),
                                                      scenario::DefaultTolerance(loaded->scenario));
  const std::string derivation = DerivationLines(proposed, (*golden)->derived);
  review.kind = comparison.Agrees() && derivation.empty() ? "same" : "changed";
  review.text = truth::DifferenceText(comparison, suite::CommandAbout("explain", review.id)) +
                derivation + review.contradicts;
  return review;
}

/// A picture that differs from its golden.
Review PictureReview(const truth::KeptPicture& pending, const std::string& root) {
  const truth::GoldenFiles files(root);
  const std::string name = pending.path.filename().string();
  const fs::path golden = files.PicturePath(pending.scenario, name),
                 difference = files.DifferencePath(pending.scenario, name);
  Review review{.id = pending.scenario, .kind = "picture", .text = {}};
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
  for (const fs::path& picture : suite::UnrequestedPictures(episode::IdOf(file), asked, root))
    reviews.push_back({episode::IdOf(file),
                       "orphan",
                       suite::UnrequestedText(picture, asked) + "\n",
                       "",
                       {picture.string()}});
}

/// A recording, judged now: what it yields is not kept, since judging it again costs little.
/// Nothing if it agrees with the golden beside it.
std::optional<Review> ReviewOfRecording(const episode::RunRequest& request,
                                        const std::string& root) {
  const std::string& file = request.scenario_file;
  Review review{.id = file, .kind = "unreadable", .text = {}};
  const Result<suite::JudgedRecording> judged = suite::JudgeRecording(request, root);
  if (!judged) {
    review.text = Format(judged.error());
    return review;
  }
  if (judged->Agrees()) return std::nullopt;
  review.kind = judged->golden ? "changed" : "new";
  review.text =
      judged->segmented.missing.warnings +
      suite::ReviewText(*judged,
                        suite::CommandAbout("explain", file, {request.grammar, request.settings}));
  review.grammar = request.grammar;
  review.fingerprint = suite::Fingerprint(judged->proposed);
  return review;
}

/// The exit code when the selection is wrong, which has been reported then.
tl::expected<std::vector<Review>, ExitCode> Reviews(const ParsedOptions& options,
                                                    const CommandContext& context) {
  const std::vector<std::string> patterns = options.All("names");
  const auto selection = suite::SelectScenarios(patterns, {}, context.root);
  if (!selection && !patterns.empty()) {
    Complain(context, selection.error().exit_code, selection.error().why);
    return tl::unexpected(ExitCode::kNothing);
  }
  const bool has_others =
      !selection ||
      std::ranges::any_of(selection->scenarios, [](const episode::ScenarioFile& file) {
        return episode::EpisodeKindOf(file.path) != episode::EpisodeKind::kJsonLines;
      });
  if (options.Has("--grammar") && (patterns.empty() || has_others))
    return tl::unexpected(Complain(
        context, ExitCode::kBadInput,
        "--grammar concerns recordings; the golden of a scenario is of the grammar that it "
        "names"));
  std::vector<std::string> pending = truth::GoldenFiles(context.root).ListPending();
  const std::vector<truth::KeptPicture> pictures =
      truth::GoldenFiles(context.root).PendingPictures();
  std::vector<Review> reviews;
  for (const episode::ScenarioFile& file :
       selection ? selection->scenarios : std::vector<episode::ScenarioFile>()) {
    if (episode::EpisodeKindOf(file.path) == episode::EpisodeKind::kJsonLines) {
      const episode::RunRequest request{
          .scenario_file = file.path, .grammar = options.Text("--grammar"), .settings = {}};
      if (auto review = ReviewOfRecording(request, context.root))
        reviews.push_back(std::move(*review));
      continue;
    }
    if (file.origin == episode::Origin::kRecording)
      return tl::unexpected(Complain(context, ExitCode::kBadInput,
                                     episode::Lacks(NameOf(file), episode::Need::kGolden)));
    AddReviews(file, context.root, std::erase(pending, episode::IdOf(file)) > 0, pictures, reviews);
  }
  if (!patterns.empty()) return reviews;
  for (const std::string& id : pending) {
    const std::string file = truth::GoldenFiles(context.root).PendingPath(id).string();
    reviews.push_back({id,
                       "orphan",
                       "the scenario of this pending golden does not exist; remove " + file + "\n",
                       "",
                       {file}});
  }
  for (const suite::UnreferencedGolden& orphan :
       selection ? selection->orphans : std::vector<suite::UnreferencedGolden>()) {
    Review review{orphan.scenario, "orphan", Text(orphan)};
    for (const fs::path& file : orphan.files) review.files.push_back(file.string());
    reviews.push_back(std::move(review));
  }
  return reviews;
}

/// The next step, in one line, or "".
std::string NextStep(const Review& review, bool engines_differ) {
  if (review.kind == "engines" || (engines_differ && !review.fingerprint.empty()))
    return suite::kUntilEnginesAgree;
  if (!review.contradicts.empty()) return suite::kUntilClaimsHold;
  if (review.kind == "picture") return "if right: " + suite::AcceptPicturesCommand(review.id);
  if (review.kind != "new" && review.kind != "changed") return "";
  return "if right: " + suite::AcceptCommandLine(review.id, review.fingerprint, review.grammar);
}

void Print(const std::vector<Review>& reviews, const CommandContext& context) {
  std::set<std::string> engines_differ;
  for (const Review& review : reviews) {
    if (review.kind == "engines") engines_differ.insert(review.id);
  }
  for (const Review& review : reviews) {
    context.out << fmt::format("{}  {}\n", review.kind, review.id);
    for (std::size_t begin = 0; begin < review.text.size();) {
      const std::size_t end = review.text.find('\n', begin);
      context.out << "    " << review.text.substr(begin, end - begin) << "\n";
      begin = end + 1;
    }
    const std::string next = NextStep(review, engines_differ.contains(review.id));
    if (!next.empty()) context.out << "    " << next << "\n";
  }
  if (reviews.empty())
    context.out << "nothing is pending ('" << CommandText({"check"})
                << "' finds what differs from its golden)\n";
}

ExitCode RunReview(const ParsedOptions& options, const CommandContext& context) {
  const auto reviews = Reviews(options, context);
  if (!reviews) return reviews.error();
  if (options.Has("--json")) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Review& review : *reviews)
      list.push_back({{"scenario", review.id},
                      {"kind", review.kind},
                      {"fingerprint", review.fingerprint},
                      {"files", review.files},
                      {"text", review.text}});
    context.out << nlohmann::ordered_json{{"pending", list}}.dump(2) << "\n";
  } else {
    Print(*reviews, context);
  }
  return reviews->empty() ? ExitCode::kAgrees : ExitCode::kPending;
}

}  // namespace

Command ReviewCommand() {
  return {
      .name = "review",
      .summary = "Show what is pending, and how it differs from the goldens",
      .examples = {"review", "review milk_carton_wrap 'slide/*'"},
      .options = {{.name = "names",
                   .help =
                       "names, skill/name, globs, or files of recordings of trackers; default: all "
                       "that is pending",
                   .repeatable = true},
                  {.name = "--grammar",
                   .help =
                       "of recordings of trackers: this grammar instead of the one that they name",
                   .placeholder = "NAME|FILE"},
                  JsonOption()},
      .run = RunReview};
}

}  // namespace prehend::cli
