// SPDX-License-Identifier: Apache-2.0
// The canonical text of a golden. Tested by tests/harness/truth/golden/golden_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <tuple>

#include "harness/base/base/number_text.h"
#include "harness/base/base/project_paths.h"
#include "harness/base/base/text_file.h"
#include "harness/truth/golden/golden.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::truth {
namespace {

namespace fs = std::filesystem;

void AppendComments(const std::vector<std::string>& comments, std::string& out) {
  for (const std::string& comment : comments)
    out += comment.empty() ? "#\n" : "# " + comment + "\n";
}

/// The lines of the table: the title first, then one per event.
std::vector<std::string> TableLines(const Golden& golden) {
  std::size_t role_columns = 1;
  for (const GoldenEvent& line : golden.events) {
    role_columns = std::max(role_columns, line.event.roles.size());
  }
  std::vector<std::vector<std::string>> rows = {{"# event", "begin_s", "end_s", "roles"}};
  for (const GoldenEvent& line : golden.events) {
    auto cells = EventCells(line.event, golden.ticks_per_second, role_columns);
    const auto add = [&](const std::string& words) {
      cells.back() += (cells.back().empty() ? "" : "  ") + words;
    };
    for (const grammar::NamedValue& value : line.event.values)
      add(fmt::format("{}~{:.4g}{}", value.name, value.value, value.unit));
    if (line.accepted > 1) add(fmt::format("accepted={}", line.accepted));
    if (line.spread != Spread{})
      add(fmt::format("spread={:.1f}/{:.1f}ms", line.spread.begin_ms, line.spread.end_ms));
    if (line.tolerance_ms)
      add(fmt::format("tolerance={}ms because {}", *line.tolerance_ms, InQuotes(line.because)));
    rows.push_back(std::move(cells));
  }
  const std::string table = AlignColumns(rows);
  std::vector<std::string> lines = SplitAt(table.substr(0, table.size() - 1), '\n');
  for (std::size_t i = 0; i < golden.events.size(); ++i) {
    if (!golden.events[i].as_written.empty()) lines[i + 1] = golden.events[i].as_written;
  }
  return lines;
}

constexpr const char* kExtension = ".timeline";
constexpr const char* kDifference = ".difference.png";

/// Ids of all timelines below a folder, sorted.
std::vector<std::string> IdsBelow(const fs::path& folder) {
  std::vector<std::string> scenarios;
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored)) {
    if (entry.path().extension() != kExtension) continue;
    scenarios.push_back(
        ReadableName(entry.path().lexically_relative(folder).replace_extension().generic_string()));
  }
  std::sort(scenarios.begin(), scenarios.end());
  return scenarios;
}

/// Its number: "cup" and "cup-2" are 1 and 2; 0 when it is no name of a picture ("cup-two",
/// "cup.difference").
int PictureNumber(const std::string& stem, std::string& name) {
  const std::size_t dash = stem.find('-');
  name = stem.substr(0, dash);
  if (stem.find('.') != std::string::npos) return 0;
  if (dash == std::string::npos) return 1;
  const int number = NumberFrom<int>(std::string_view(stem).substr(dash + 1)).value_or(0);
  return number > 1 ? number : 0;
}

/// Of one folder; ids are relative to `above`.
std::vector<KeptPicture> PicturesIn(const fs::path& folder, const fs::path& above) {
  std::vector<KeptPicture> pictures;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() != ".png") continue;
    std::string name;
    const int number = PictureNumber(entry.path().stem().string(), name);
    if (number == 0) continue;
    const std::string id = (folder / name).lexically_relative(above).generic_string();
    pictures.push_back({ReadableName(id), number, entry.path()});
  }
  std::ranges::sort(pictures, {}, [](const KeptPicture& picture) {
    return std::tuple(picture.scenario, picture.number, picture.path);
  });
  return pictures;
}

std::vector<KeptPicture> PicturesBelow(const fs::path& above) {
  std::vector<KeptPicture> pictures = PicturesIn(above, above);
  std::error_code ignored;
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(above, ignored)) {
    if (entry.is_directory(ignored)) folders.push_back(entry.path());
  }
  std::ranges::sort(folders);
  for (const fs::path& folder : folders)
    std::ranges::move(PicturesIn(folder, above), std::back_inserter(pictures));
  return pictures;
}

}  // namespace

grammar::Place ScenarioLine(std::string_view text) {
  constexpr std::string_view kKey = "# scenario: ";
  const std::size_t found = std::min(text.find(kKey), text.size());
  const auto line = static_cast<int>(std::ranges::count(text.substr(0, found), '\n')) + 1;
  return {line, static_cast<int>(kKey.size()) + 1};
}

grammar::Diagnostics OfAnotherScenario(std::string_view file, std::string_view text,
                                       const Golden& golden, const std::string& scenario) {
  if (golden.scenario == scenario) return {};
  const std::string message =
      "this golden says it is of '" + golden.scenario + "', not of '" + scenario + "'";
  return {grammar::DiagnosticAt(file, text, ScenarioLine(text), message,
                                "if it was moved here with its scenario, write that name")};
}

Result<std::optional<Golden>> ReadGoldenFile(const fs::path& path, const std::string& scenario) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return std::nullopt;
  PREHEND_TRY(std::string text, ReadTextFile(path.string()));
  PREHEND_TRY(Golden golden, ReadGolden(path.string(), text));
  grammar::Diagnostics other = OfAnotherScenario(path.string(), text, golden, scenario);
  if (!other.empty()) return tl::unexpected(std::move(other));
  return golden;
}

std::string WriteGoldenFile(const fs::path& path, const Golden& golden) {
  const std::string text = WriteGolden(golden);
  grammar::Diagnostics wrong = CheckText(path.string(), text);
  if (!wrong.empty())
    return "the golden would not be readable, and was not written:\n" + Format(wrong);
  const Result<Golden> read = ReadGolden(path.string(), text);
  if (!read)
    return "the golden would not be readable, and was not written:\n" + Format(read.error());
  if (!(*read == golden))
    return "the golden would read back otherwise, and was not written; use plain words in reasons";
  return WriteTextFile(path, text, Over::kAnything);
}

fs::path GoldenFiles::GoldenPath(const std::string& scenario) const {
  return root_ / "golden" / (scenario + kExtension);
}

fs::path GoldenFiles::PendingPath(const std::string& scenario) const {
  return fs::path(BuildFolder(root_)) / "pending" / (scenario + kExtension);
}

Result<std::optional<Golden>> GoldenFiles::ReadGoldenOf(const std::string& scenario) const {
  return ReadGoldenFile(GoldenPath(scenario), scenario);
}

Result<std::optional<Golden>> GoldenFiles::ReadPendingOf(const std::string& scenario) const {
  return ReadGoldenFile(PendingPath(scenario), scenario);
}

std::string GoldenFiles::WritePending(const Golden& golden) const {
  return WriteTextFile(PendingPath(golden.scenario), WriteGolden(golden), Over::kAnything);
}

std::string GoldenFiles::WriteGoldenFile(const Golden& golden) const {
  return truth::WriteGoldenFile(GoldenPath(golden.scenario), golden);
}

std::string GoldenFiles::WriteAccepted(const Golden& golden) const {
  std::string problem = WriteGoldenFile(golden);
  if (problem.empty()) RemovePending(golden.scenario);
  return problem;
}

void GoldenFiles::RemovePending(const std::string& scenario) const {
  std::error_code ignored;
  fs::remove(PendingPath(scenario), ignored);
}

fs::path GoldenFiles::EngineDifferencePath(const std::string& scenario) const {
  return PendingPath(scenario).replace_extension(".engines");
}

std::string GoldenFiles::ReadEngineDifference(const std::string& scenario) const {
  return ReadTextFile(EngineDifferencePath(scenario).string()).value_or("");
}

std::string GoldenFiles::WriteEngineDifference(const std::string& scenario,
                                               const std::string& text) const {
  const fs::path file = EngineDifferencePath(scenario);
  if (!text.empty()) return WriteTextFile(file, text, Over::kAnything);
  std::error_code ignored;
  fs::remove(file, ignored);
  return "";
}

std::vector<KeptPicture> GoldenFiles::PicturesOf(const std::string& scenario) const {
  std::vector<KeptPicture> pictures =
      PicturesIn(GoldenPath(scenario).parent_path(), root_ / "golden");
  std::erase_if(pictures, [&](const KeptPicture& picture) { return picture.scenario != scenario; });
  return pictures;
}

std::vector<KeptPicture> GoldenFiles::Pictures() const { return PicturesBelow(root_ / "golden"); }

std::vector<KeptPicture> GoldenFiles::PendingPictures() const {
  return PicturesBelow(fs::path(BuildFolder(root_)) / "pending");
}

fs::path GoldenFiles::DifferencePath(const std::string& scenario, const std::string& file) const {
  return PendingPicturePath(scenario, file).replace_extension(kDifference);
}

void GoldenFiles::RemovePendingPicture(const std::string& scenario, const std::string& file) const {
  std::error_code ignored;
  fs::remove(PendingPicturePath(scenario, file), ignored);
  fs::remove(DifferencePath(scenario, file), ignored);
}

std::vector<std::string> GoldenFiles::List() const { return IdsBelow(root_ / "golden"); }

std::vector<std::string> GoldenFiles::ListPending() const {
  return IdsBelow(fs::path(BuildFolder(root_)) / "pending");
}

bool operator==(const GoldenEvent& a, const GoldenEvent& b) {
  return a.event.event == b.event.event && a.event.roles == b.event.roles &&
         a.event.interval == b.event.interval && a.event.values == b.event.values &&
         a.event.open_end == b.event.open_end && a.tolerance_ms == b.tolerance_ms &&
         a.because == b.because && a.comments == b.comments && a.accepted == b.accepted;
}

bool operator==(const Golden& a, const Golden& b) {
  return a.scenario == b.scenario && a.grammar == b.grammar && a.derived == b.derived &&
         a.accepted == b.accepted && a.pictures == b.pictures && a.unsteady == b.unsteady &&
         a.ticks_per_second == b.ticks_per_second && a.comments == b.comments &&
         a.events == b.events && a.closing_comments == b.closing_comments;
}

std::string WriteGolden(const Golden& golden) {
  std::string out = fmt::format("# scenario: {}\n# grammar: {}\n", golden.scenario, golden.grammar);
  for (const std::string& line : golden.derived) out += fmt::format("# derived: {}\n", line);
  for (const Acceptance& acceptance : golden.accepted)
    out += fmt::format("# accepted: {} {}\n", acceptance.date, InQuotes(acceptance.reason));
  for (const Acceptance& acceptance : golden.pictures)
    out += fmt::format("# pictures: {} {}\n", acceptance.date, InQuotes(acceptance.reason));
  if (golden.ensemble_plays > 0)
    out += fmt::format("# ensemble: {} plays\n", golden.ensemble_plays);
  if (!golden.unsteady.empty()) out += fmt::format("# unsteady: {}\n", InQuotes(golden.unsteady));
  out += fmt::format("# ticks_per_second: {}\n", golden.ticks_per_second);
  AppendComments(golden.comments, out);

  const std::vector<std::string> lines = TableLines(golden);
  out += lines.front() + "\n";
  for (std::size_t i = 0; i < golden.events.size(); ++i) {
    AppendComments(golden.events[i].comments, out);
    out += lines[i + 1] + "\n";
  }
  AppendComments(golden.closing_comments, out);
  return out;
}

grammar::Timeline ToTimeline(const Golden& golden) {
  grammar::Timeline timeline{.ticks_per_second = golden.ticks_per_second};
  for (const GoldenEvent& line : golden.events) timeline.events.push_back(line.event);
  return timeline;
}

}  // namespace prehend::truth
