// SPDX-License-Identifier: Apache-2.0
// See harness/cli/daily/accept_pictures.h. Tested by tests/program/golden_workflow_test.cc
#include "harness/cli/daily/accept_pictures.h"

#include <algorithm>
#include <filesystem>

#include "harness/base/base/content_hash.h"
#include "harness/base/base/project_paths.h"
#include "harness/base/base/shell_quote.h"
#include "harness/show/pictures/pictures.h"
#include "harness/suite/judge/unreferenced_goldens.h"
#include "harness/truth/golden/golden_files.h"

namespace prehend::cli {
namespace {

namespace fs = std::filesystem;

/// Whether `drawn` is the picture that `check` left for review, if it left one.
bool IsThePictureShown(const truth::GoldenFiles& files, const std::string& id,
                       const fs::path& drawn) {
  const fs::path shown = files.PendingPicturePath(id, drawn.filename().string());
  std::error_code error;
  return !fs::exists(shown, error) || FileHash(shown.string()) == FileHash(drawn.string());
}

/// Removes the golden pictures that the scenario no longer defines; returns how many.
int RemoveUnrequested(const CommandContext& context, const std::string& id,
                      const scenario::Scenario& scenario) {
  int removed = 0;
  for (const fs::path& picture :
       suite::UnrequestedPictures(id, scenario.pictures.size(), context.root)) {
    std::error_code error;
    if (!fs::remove(picture, error)) continue;
    fs::remove(show::ThingsFile(picture.string()), error);
    context.out << "removed: " << picture.string() << "\n";
    ++removed;
  }
  return removed;
}

/// Makes `drawn`, with what it shows, the golden picture. Returns whether that changes a byte;
/// nothing when it cannot be moved.
std::optional<bool> Keep(const CommandContext& context, const std::string& id,
                         const fs::path& drawn) {
  const truth::GoldenFiles files(context.root);
  const fs::path golden = files.PicturePath(id, drawn.filename().string());
  files.RemovePendingPicture(id, golden.filename().string());
  const std::string things = show::ThingsFile(golden.string()),
                    shown = show::ThingsFile(drawn.string());
  if (FileHash(golden.string()) == FileHash(drawn.string()) && FileHash(things) == FileHash(shown))
    return false;
  std::error_code error;
  fs::create_directories(golden.parent_path(), error);
  fs::rename(shown, things, error);
  if (!error) fs::rename(drawn, golden, error);
  if (error) return std::nullopt;
  context.out << "accepted: " << golden.string() << "\n";
  return true;
}

}  // namespace

ExitCode AcceptPictures(const CommandContext& context, const std::string& reason,
                        truth::Golden golden, const scenario::Scenario& scenario,
                        const episode::RunResult& run) {
  const truth::GoldenFiles files(context.root);
  const std::string& id = golden.scenario;
  const fs::path folder = fs::path(BuildFolder(context.root)) / "pending-pictures" / scenario.skill;
  std::error_code error;
  fs::create_directories(folder, error);
  const show::PictureResult drawn = show::DrawGoldens(scenario, run, folder.string());
  if (!drawn.error.empty())
    return Complain(context, ExitCode::kFailure, "no picture: " + drawn.error);
  for (const show::WrittenPicture& picture : drawn.pictures) {
    if (IsThePictureShown(files, id, picture.file)) continue;
    return Complain(context, ExitCode::kDiffers,
                    "the pending picture differs from what the scenario looks like now, " +
                        picture.file + "; nothing was accepted\n  look at the new one: " +
                        CommandText({"check", id}) + ", then " + CommandText({"review", id}));
  }
  int changed = RemoveUnrequested(context, id, scenario);
  for (const show::WrittenPicture& picture : drawn.pictures) {
    const std::optional<bool> kept = Keep(context, id, picture.file);
    if (!kept)
      return Complain(context, ExitCode::kFailure, "cannot move " + picture.file + " to golden/");
    changed += *kept;
  }
  if (changed == 0) {
    context.out << "nothing to accept: "
                << (drawn.pictures.empty() ? id + " defines no pictures ('pictures:' in its file)"
                                           : "the pictures of " + id + " equal their goldens")
                << "\n";
    return ExitCode::kAgrees;
  }
  golden.pictures.push_back({context.today, reason});
  const std::string problem = files.WriteGoldenFile(golden);
  return problem.empty() ? ExitCode::kAgrees : Complain(context, ExitCode::kFailure, problem);
}

}  // namespace prehend::cli
