// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/judge/judges.h"

#include <fmt/format.h>

#include "harness/suite/judge/validate_golden.h"
#include "harness/truth/golden/golden.h"
#include "physics/scene/run_limits.h"

namespace prehend::suite {

std::vector<truth::ClaimVerdict> JudgeClaims(const episode::LoadedRun& loaded,
                                             const grammar::Timeline& timeline) {
  const scenario::Scenario& scenario = loaded.scenario;
  if (scenario.expects.empty()) return {};
  return JudgeClaims(scenario.expects, scenario.file,
                     episode::ClaimableIn(scenario, *loaded.program), timeline);
}

namespace {

/// "sinks_into(pot, coaster)".
std::string LimitIn(const truth::Claim& claim) {
  const truth::ClaimedEvent& limit = claim.events.front();
  return fmt::format("{}({}, {})", limit.name.text, limit.roles[0].value.text,
                     limit.roles[1].value.text);
}

}  // namespace

std::vector<truth::ClaimVerdict> JudgeLimitClaims(const scenario::Scenario& scenario,
                                                  const std::vector<physics::ScriptNote>& notes) {
  std::vector<truth::ClaimVerdict> verdicts;
  for (const truth::Claim& claim : scenario.expects) {
    if (!truth::IsAboutLimit(claim)) continue;
    const auto note = std::ranges::find(
        notes, LimitIn(claim), [](const auto& each) { return physics::LimitOf(each.text); });
    const bool holds = note != notes.end();
    verdicts.push_back({.claim = claim.text,
                        .place = fmt::format("{}:{}", scenario.file, claim.where.place.line),
                        .says = holds ? truth::kHolds : truth::kContradicted,
                        .found = holds ? "found: " + note->text : "found none"});
  }
  return verdicts;
}

Findings JudgeLimits(const scenario::Scenario& scenario,
                     const std::vector<physics::ScriptNote>& notes) {
  std::map<std::string, std::string> found;  // by what a claim says of it
  for (const physics::ScriptNote& note : notes)
    if (const std::string limit = physics::LimitOf(note.text); !limit.empty())
      found.emplace(limit, note.text);
  for (const truth::Claim& claim : scenario.expects)
    if (truth::IsAboutLimit(claim)) found.erase(LimitIn(claim));
  Findings findings = ClaimFindings(JudgeLimitClaims(scenario, notes));
  for (const auto& [limit, text] : found)
    findings.push_back(
        {.exit_code = ExitCode::kDiffers,
         .reason = text,
         .details = fmt::format("{}\n  if that may be: expects: ['{}']\n", text, limit)});
  return findings;
}

Findings ClaimFindings(const std::vector<truth::ClaimVerdict>& verdicts) {
  Findings findings;
  for (const truth::ClaimVerdict& verdict : verdicts) {
    if (!truth::IsContradicted(verdict)) continue;
    const std::string text = Text(verdict);
    findings.push_back(
        {.exit_code = ExitCode::kDiffers, .reason = text, .details = text + "\n" + verdict.times});
  }
  return findings;
}

namespace fs = std::filesystem;

show::GoldenOf GoldensOf(const std::string& id, const std::string& root) {
  return [files = truth::GoldenFiles(root), id](const std::string& name) {
    const fs::path golden = files.PicturePath(id, name);
    std::error_code ignored;
    return fs::exists(golden, ignored) ? golden.string() : "";
  };
}

std::vector<PictureComparison> ComparisonsOf(const std::string& id,
                                             const std::vector<show::WrittenPicture>& drawn,
                                             const std::string& root, bool shown) {
  const truth::GoldenFiles files(root);
  std::vector<PictureComparison> compared;
  for (const show::WrittenPicture& picture : drawn) {
    if (picture.golden.empty()) continue;
    const bool can_be_shown =
        shown && picture.difference.same_size && !picture.difference.told.empty();
    const std::string name = fs::path(picture.file).filename().string();
    compared.push_back({.golden = picture.golden,
                        .drawn = picture.file,
                        .told = picture.difference.told,
                        .shown_in = can_be_shown ? files.DifferencePath(id, name) : fs::path()});
  }
  return compared;
}

std::string PictureDifferencesText(const std::vector<PictureComparison>& compared,
                                   const std::string& accept) {
  std::string text;
  for (const PictureComparison& picture : compared) {
    if (picture.told.empty()) continue;
    text += fmt::format("picture {}:\n", picture.drawn.string());
    for (const std::string& told : picture.told) text += "  " + told + "\n";
    text += fmt::format("  expected {}\n", picture.golden.string());
    if (!picture.shown_in.empty())
      text += fmt::format("  difference {}\n", picture.shown_in.string());
    if (!accept.empty()) text += fmt::format("  accept it with: {}\n", accept);
  }
  return text;
}

Findings JudgeUnrequestedPictures(const std::string& id, std::size_t requested,
                                  const std::string& root, const std::string& accept) {
  Findings findings;
  for (const fs::path& picture : UnrequestedPictures(id, requested, root)) {
    findings.push_back(
        {.exit_code = ExitCode::kDiffers,
         .reason = "a golden picture that the scenario does not ask for",
         .details = UnrequestedText(picture, requested) + "\n  remove it, or: " + accept + "\n"});
  }
  return findings;
}

void StorePictures(const std::string& id, const std::vector<PictureComparison>& compared,
                   const std::string& root) {
  const truth::GoldenFiles files(root);
  for (const PictureComparison& picture : compared) {
    const std::string name = picture.drawn.filename().string();
    files.RemovePendingPicture(id, name);
    if (picture.told.empty()) continue;
    const fs::path pending = files.PendingPicturePath(id, name);
    std::error_code ignored;  // `accept` draws the picture again, and reports what it cannot write
    fs::create_directories(pending.parent_path(), ignored);
    fs::copy_file(picture.drawn, pending, ignored);
    if (!picture.shown_in.empty())
      show::WritePictureDifference(picture.golden.string(), picture.drawn.string(),
                                   picture.shown_in.string());
  }
}

}  // namespace prehend::suite
