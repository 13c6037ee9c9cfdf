// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/accept/review.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "harness/base/base/quoting.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/scenario/read/read_scenario.h"
#include "harness/suite/check/check_request.h"
#include "harness/suite/judge/accept_golden.h"
#include "harness/suite/judge/judges.h"
#include "harness/suite/judge/other_view.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/golden/golden.h"

namespace prehend::suite {
namespace {

namespace fs = std::filesystem;

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
  if (!patterns.empty()) return reviews;
  for (const std::string& id : pending) {
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
