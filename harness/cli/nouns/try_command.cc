// SPDX-License-Identifier: Apache-2.0
// prehend grammar try: drawn episodes as unit tests of a grammar. Tested by
// tests/program/try_command_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "grammar/contents.h"
#include "grammar/watch_drawing.h"
#include "harness/base/base/text_file.h"
#include "harness/cli/command/command.h"
#include "harness/episode/run/load_grammar.h"

namespace prehend::cli {
namespace {

using grammar::DrawnEpisode;
using grammar::DrawnRow;

struct Tried {
  std::string file;
  DrawnEpisode drawn;
  std::vector<DrawnRow> wanted;
  std::vector<DrawnRow> found;

  bool Agrees() const { return !drawn.has_expected || Text(wanted) == Text(found); }
  std::string Name() const {
    return fmt::format("{}:{}{}", file, drawn.line, drawn.title.empty() ? "" : " " + drawn.title);
  }
};

std::vector<DrawnRow> Sorted(std::vector<DrawnRow> rows) {
  std::ranges::sort(rows, {}, &DrawnRow::name);
  return rows;
}

/// The rows that the other ones do not have.
std::vector<DrawnRow> Without(const std::vector<DrawnRow>& rows,
                              const std::vector<DrawnRow>& others) {
  std::vector<DrawnRow> left;
  for (const DrawnRow& row : rows) {
    const bool there = std::ranges::any_of(others, [&](const DrawnRow& other) {
      return other.name == row.name && other.cells == row.cells;
    });
    if (!there) left.push_back(row);
  }
  return left;
}

void Print(const std::vector<DrawnRow>& rows, std::string_view before, std::ostream& out) {
  for (const DrawnRow& row : rows)
    out << fmt::format("  {} {:28}|{}|\n", before, row.name, row.cells);
}

void Print(const Tried& tried, std::ostream& out) {
  if (!tried.drawn.has_expected) {
    out << fmt::format("drawn    {}: it expects nothing; without a line -- this is all\n",
                       tried.Name());
    return Print(tried.found, "found ", out);
  }
  out << fmt::format("{}  {}\n", tried.Agrees() ? "agrees " : "differs", tried.Name());
  if (tried.Agrees()) return;
  Print(Without(tried.wanted, tried.found), "wanted", out);
  Print(Without(tried.found, tried.wanted), "found ", out);
}

nlohmann::ordered_json ToJson(const std::vector<DrawnRow>& rows) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const DrawnRow& row : rows) all.push_back({{"row", row.name}, {"cells", row.cells}});
  return all;
}

ExitCode RunTry(const ParsedOptions& options, const CommandContext& context) {
  Result<grammar::Overrides> settings = episode::ParameterSettings(options.All("--set"));
  if (!settings) return Complain(context, settings.error());
  const grammar::CompileResult compiled =
      episode::LoadGrammar(context.root, options.Text("grammar"), *settings);
  if (!compiled.program) return Complain(context, compiled.diagnostics);
  Warn(context, compiled.warnings);

  std::vector<Tried> all;
  grammar::Diagnostics wrong;
  for (const std::string& path : options.All("drawings")) {
    const Result<std::string> text = ReadTextFile(path);
    if (!text) return Complain(context, text.error());
    const grammar::GrammarText file{ReadableName(path), *text};
    for (DrawnEpisode& drawn : grammar::ReadDrawings(file, wrong)) {
      std::ranges::move(CheckExpected(*compiled.program, drawn, file), std::back_inserter(wrong));
      all.push_back({.file = file.file, .drawn = std::move(drawn)});
    }
  }
  if (!wrong.empty()) return Complain(context, wrong);
  for (Tried& tried : all) {
    const grammar::WatchedDrawing watched = WatchDrawing(compiled.program, tried.drawn);
    if (!watched.error.empty())
      return Complain(context, ExitCode::kFailure, tried.Name() + ": " + watched.error);
    tried.wanted = Sorted(tried.drawn.expected);
    // A row without events says that there are none.
    std::erase_if(tried.wanted, [](const DrawnRow& row) {
      return row.cells.find_first_not_of('.') == std::string::npos;
    });
    tried.found = Sorted(DrawWatched(*compiled.program, tried.drawn, watched.timeline));
  }
  const auto differ = std::ranges::count_if(all, [](const Tried& one) { return !one.Agrees(); });
  if (options.Has("--json")) {
    nlohmann::ordered_json drawings = nlohmann::ordered_json::array();
    for (const Tried& tried : all) {
      drawings.push_back({{"file", tried.file},
                          {"line", tried.drawn.line},
                          {"title", tried.drawn.title},
                          {"agrees", tried.Agrees()},
                          {"wanted", ToJson(tried.wanted)},
                          {"found", ToJson(tried.found)}});
    }
    context.out << nlohmann::ordered_json{{"grammar", GrammarName(*compiled.program)},
                                          {"drawings", std::move(drawings)}}
                       .dump(2)
                << "\n";
  } else {
    for (const Tried& tried : all) Print(tried, context.out);
    context.out << fmt::format("{} of {} drawings agree\n",
                               static_cast<std::ptrdiff_t>(all.size()) - differ, all.size());
  }
  return differ == 0 ? ExitCode::kAgrees : ExitCode::kDiffers;
}

}  // namespace

Command TryCommand() {
  return {.name = "grammar try",
          .summary = "Try a grammar on drawn episodes: unit tests of rules",
          .examples = {"grammar try my.grammar my_drawings.txt",
                       "grammar try pick_and_place my_drawings.txt --set slide_distance=\"3 cm\"",
                       "grammar try my.grammar my_drawings.txt --json"},
          .options = {Required(Argument("grammar", "a name of the library or a .grammar file")),
                      Repeatable(
                          Required(Argument("drawings", "files with drawings: docs/drawings.md"))),
                      ParametersOption(), JsonOption()},
          .run = RunTry};
}

}  // namespace prehend::cli
