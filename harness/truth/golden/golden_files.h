// SPDX-License-Identifier: Apache-2.0
// Where goldens and pending goldens are kept: golden/SKILL/NAME.timeline and
// build/pending/SKILL/NAME.timeline. Tested by tests/harness/truth/golden/golden_files_test.cc
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/base/base/atomic_file.h"
#include "harness/truth/golden/golden.h"

namespace prehend::truth {

/// A picture in golden/ or in build/pending/: NAME.png is the first of its scenario, NAME-2.png the
/// second.
struct KeptPicture {
  std::string scenario;  ///< skill/name
  int number = 1;
  std::filesystem::path path;
};

/// An error if the golden's header names another scenario; else nothing.
grammar::Diagnostics OfAnotherScenario(std::string_view file, std::string_view text,
                                       const Golden& golden, const std::string& scenario);

/// The place of the name in the line "# scenario: ..".
grammar::Place ScenarioLine(std::string_view text);

/// The golden in this file, if it is there; an error if its header names another scenario.
Result<std::optional<Golden>> ReadGoldenFile(const std::filesystem::path& path,
                                             const std::string& scenario);

/// "" or what went wrong; then the file stays as it was. A golden that would not read back is not
/// written: it would lose every reason that the old one held.
std::string WriteGoldenFile(const std::filesystem::path& path, const Golden& golden);

class GoldenFiles {
 public:
  explicit GoldenFiles(std::filesystem::path project_root) : root_(std::move(project_root)) {}

  /// `scenario` is its id, skill/name, here and below.
  std::filesystem::path GoldenPath(const std::string& scenario) const;
  std::filesystem::path PendingPath(const std::string& scenario) const;

  /// nullopt: there is no golden yet, or nothing is pending.
  Result<std::optional<Golden>> ReadGoldenOf(const std::string& scenario) const;
  Result<std::optional<Golden>> ReadPendingOf(const std::string& scenario) const;

  /// All return "" or what went wrong. Accepting a golden removes what was pending.
  std::string WritePending(const Golden& golden) const;
  std::string WriteGoldenFile(const Golden& golden) const;
  std::string WriteAccepted(const Golden& golden) const;
  void RemovePending(const std::string& scenario) const;

  /// How a planar scenario differs between the engines, as the last `check` found; "" if it does
  /// not. Writing "" removes the file.
  std::filesystem::path EngineDifferencePath(const std::string& scenario) const;
  std::string ReadEngineDifference(const std::string& scenario) const;
  std::string WriteEngineDifference(const std::string& scenario, const std::string& text) const;

  /// Ids of all goldens, and of all that is pending, sorted.
  std::vector<std::string> List() const;
  std::vector<std::string> ListPending() const;

  /// Where the golden of a picture is kept; `file` is its name, as in golden/slide/NAME-2.png.
  std::filesystem::path PicturePath(const std::string& scenario, const std::string& file) const {
    return GoldenPath(scenario).parent_path() / file;
  }
  /// The goldens of a scenario's pictures, by their numbers; and of all scenarios.
  std::vector<KeptPicture> PicturesOf(const std::string& scenario) const;
  std::vector<KeptPicture> Pictures() const;

  /// Where a picture that differs from its golden waits for review, and beside it the picture that
  /// shows the differences.
  std::filesystem::path PendingPicturePath(const std::string& scenario,
                                           const std::string& file) const {
    return PendingPath(scenario).parent_path() / file;
  }
  std::filesystem::path DifferencePath(const std::string& scenario, const std::string& file) const;
  std::vector<KeptPicture> PendingPictures() const;
  void RemovePendingPicture(const std::string& scenario, const std::string& file) const;

 private:
  std::filesystem::path root_;
};

}  // namespace prehend::truth
