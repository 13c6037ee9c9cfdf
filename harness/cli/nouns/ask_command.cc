// SPDX-License-Identifier: Apache-2.0
// prehend episode ask: questions in the paper's language, answered by SWI-Prolog with
// harness/exchange/knowledge/prehend.pl. Tested by tests/program/knowledge_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "harness/base/base/number_text.h"
#include "harness/base/base/project_paths.h"
#include "harness/base/process/child_process.h"
#include "harness/cli/command/command.h"
#include "harness/show/figures/moments.h"
#include "harness/show/pictures/pictures.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kDefaultMost = 100, kMostAnswers = 1'000'000;
constexpr double kDefaultAsk_s = 10, kMostAsk_s = 3600;
/// Loading the folder is not part of the query's time. SWI-Prolog looks at the clock between goals
/// only: in the midst of one it is killed a little later.
constexpr double kLoading_s = 120, kLater_s = 0.5;
constexpr double kMebibyte = 1 << 20;
constexpr int kStack_MB = 512, kMemory_MB = 4096;

struct Answered {
  std::vector<Json> answers;
  std::string problem;  ///< empty, or why it was refused or stopped; there may be answers before
  std::vector<std::string> notes;
};

/// "; did you mean 'hook'? There are: hook, wrap" of {"word": .., "known": [..]}.
std::string KnownWords(const Json& line) {
  if (!line.contains("known")) return "";
  const auto known = line["known"].get<std::vector<std::string>>();
  const std::string near = grammar::NearestName(line["word"].get<std::string>(), known);
  return (near.empty() ? "" : fmt::format("; did you mean '{}'?", near)) +
         fmt::format("{} there are: {}", near.empty() ? ";" : "", fmt::join(known, ", "));
}

Answered AskSwipl(const std::string& folder, const std::string& query, int most,
                  double time_limit_s) {
  const ToolResult said =
      RunTool({"swipl", "-q", "-f", "none", fmt::format("--stack-limit={}m", kStack_MB), "-g",
               "ask_main", "-t", "halt", Shipped("harness/exchange/knowledge/prehend.pl"), "--",
               folder, std::to_string(most), fmt::format("{}", time_limit_s)},
              query,
              {.time_s = kLoading_s,
               .answering_s = time_limit_s + kLater_s,
               .memory_bytes = static_cast<std::size_t>(kMemory_MB * kMebibyte)});
  Answered answered;
  bool is_loaded = false, ended = false;
  std::string loading;  // the file that is read
  for (const std::string_view text : LinesOf(said.out)) {
    const Json line = Json::parse(text, nullptr, false);
    if (line.is_discarded()) continue;  // cut off
    if (!line.contains("end")) {
      answered.answers.push_back(line);
      continue;
    }
    const std::string end_word = line["end"];
    if (end_word == "note") {
      const std::string name = line["word"];
      answered.notes.push_back(
          fmt::format("nothing is called '{}' in these episodes{}", name, KnownWords(line)));
    }
    if (end_word == "loading") loading = line["file"].get<std::string>() + ": ";
    is_loaded = is_loaded || end_word == "loaded";
    ended = ended || end_word == "done" || end_word == "refused";
    if (end_word == "refused") answered.problem = line["why"].get<std::string>() + KnownWords(line);
  }
  if (ended) return answered;
  answered.problem = said.problem;
  if (said.problem.starts_with("took more than"))
    answered.problem = is_loaded ? fmt::format("the query took more than {:g} s", time_limit_s)
                                 : "reading the folder " + said.problem;
  if (!is_loaded && said.problem.starts_with("was ended"))
    answered.problem = loading + "SWI-Prolog " + said.problem + " while it read this";
  if (said.problem.ends_with("is not installed"))
    answered.problem += "; Debian's package swi-prolog-nox has it";
  if (said.problem.empty()) answered.problem = "SWI-Prolog ended without an answer: " + said.err;
  return answered;
}

std::string CellOf(const Json& value) {
  if (value.is_object()) {
    std::string text = value["text"].get<std::string>();
    for (const Json& part : value.value("parts", Json::array())) text += " " + CellOf(part);
    return text;
  }
  if (value.is_array()) {
    std::vector<std::string> cells;
    for (const Json& one : value) cells.push_back(CellOf(one));
    return fmt::format("[{}]", fmt::join(cells, ", "));
  }
  if (value.is_number_float()) return fmt::format("{:.4f}", value.get<double>());
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// All that an answer shows, in one picture per world that it shows; or of nothing.
std::vector<show::Moment> MomentsOf(const Json& answer) {
  std::vector<show::Moment> moments;
  for (const Json& shown : answer["show"]) {
    const std::string what = shown["what"];
    const double from_s = shown["from"], to_s = shown["to"];
    if (what == "world" || moments.empty()) {
      show::Moment& moment = moments.emplace_back();
      moment.file = shown["file"];
      moment.episode = shown["number"];
      moment.scenario = "answer";
      moment.at_s = moment.from_s = moment.to_s = from_s;
    }
    show::Moment& moment = moments.back();
    if (what == "marker") moment.marked.push_back(shown["of"]);
    if (what != "trajectory") continue;
    moment.of.push_back(shown["of"]);
    moment.from_s = from_s;
    moment.to_s = to_s;
  }
  for (show::Moment& moment : moments) {
    moment.name = moment.of.empty() ? "world" : moment.of.front();
    // A strip of no length cannot be drawn.
    if (moment.from_s == moment.to_s) moment.to_s = moment.from_s + 1;
  }
  return moments;
}

void PrintTable(const std::vector<Json>& answers, std::ostream& out) {
  if (!answers.empty()) {
    std::vector<std::vector<std::string>> rows(1);
    for (const auto& [name, value] : answers[0]["bindings"].items()) rows[0].push_back(name);
    for (const Json& answer : answers) {
      std::vector<std::string>& row = rows.emplace_back();
      for (const auto& [name, value] : answer["bindings"].items()) row.push_back(CellOf(value));
    }
    out << truth::AlignColumns(rows);
  }
  out << answers.size() << (answers.size() == 1 ? " answer\n" : " answers\n");
}

ExitCode RunAsk(const ParsedOptions& options, const CommandContext& context) {
  const std::string folder = options.Text("folder");
  const bool shows = options.Has("--show");
  if (shows && !show::CanDrawPictures())
    return Refuse(context, "--show: this build draws no pictures");
  Answered answered = AskSwipl(folder, options.Text("query"), options.IntOr("--most", kDefaultMost),
                               options.NumberOr("--time-limit-s", kDefaultAsk_s));
  for (const std::string& note : answered.notes) context.err << "prehend: " << note << "\n";
  show::MomentPictures drawn;
  if (shows) {
    std::vector<show::Moment> moments;
    std::vector<std::size_t> answer_of;
    for (std::size_t i = 0; i < answered.answers.size(); ++i) {
      for (show::Moment& moment : MomentsOf(answered.answers[i])) {
        moments.push_back(std::move(moment));
        answer_of.push_back(i);
      }
      answered.answers[i]["pictures"] = Json::array();
    }
    drawn = show::DrawMoments(moments, options.Text("--show"), context.root);
    for (std::size_t i = 0; i < drawn.files.size(); ++i) {
      if (!drawn.files[i].empty())
        answered.answers[answer_of[i]]["pictures"].push_back(drawn.files[i]);
    }
  }
  const bool is_refused = !answered.problem.empty() && answered.answers.empty();
  if (is_refused) return Refuse(context, answered.problem);
  if (options.Has("--json"))
    context.out << Json(answered.answers).dump(2) << "\n";
  else
    PrintTable(answered.answers, context.out);
  if (!options.Has("--json")) {
    for (const std::string& file : drawn.files)
      if (!file.empty()) context.out << file << "\n";
  }
  if (!answered.problem.empty()) return Refuse(context, answered.problem);
  if (!drawn.error.empty()) return Complain(context, ExitCode::kFailure, "--show: " + drawn.error);
  return answered.answers.empty() ? ExitCode::kNothing : ExitCode::kAgrees;
}

}  // namespace

Command AskCommand() {
  return {
      .name = "episode ask",
      .summary = "Ask recorded episodes in the language of KnowRob (Prolog)",
      .examples =
          {"episode ask kb \"entity(Act, [an, action, [type, 'Sliding']]), occurs(Act, [S, E])\"",
           "episode ask kb \"entity(Obj, [an, object, [type, 'Handle']]), holds(part_of(Obj, "
           "Door))\"",
           "episode ask kb --show shown \"entity(A, [an, action]), occurs(A, [S, E]), "
           "show(world(S))\""},
      .options = {Required(Argument("folder", "what 'prehend episode knowledge' wrote")),
                  Required(Argument("query", "docs/knowledge.md explains it")),
                  WritesFile(
                      Value("--show", "FOLDER", "draw what the query shows into this folder")),
                  Value("--most", "N", "stop after so many answers; default: 100",
                        IntegersFrom(1, kMostAnswers)),
                  TimeLimitOption(0.1, kMostAsk_s), JsonOption()},
      .run = RunAsk};
}

}  // namespace prehend::cli
