// SPDX-License-Identifier: Apache-2.0
// prehend episode query: questions to recorded episodes. Tested by tests/program/query_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <tuple>

#include "harness/base/base/number_text.h"
#include "harness/base/base/quoting.h"
#include "harness/cli/command/command.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/episodes/query_events.h"
#include "harness/show/figures/moments.h"
#include "harness/show/pictures/pictures.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::cli {
namespace {

using episode::EventAnswer;
using episode::EventQuestion;
using Json = nlohmann::ordered_json;

double SecondsAt(const EventAnswer& answer, grammar::Tick tick) {
  return truth::SecondsOf(tick, answer.ticks_per_second);
}

std::string RolesText(const grammar::NamedEvent& event) {
  std::string text;
  for (const grammar::Role& role : event.roles)
    text += (text.empty() ? "" : " ") + role.name + "=" + role.value;
  for (const grammar::NamedValue& value : event.values)
    text += " " + value.name + "=" + truth::ValueText(value);
  return text;
}

Json EventJson(const EventAnswer& answer, const grammar::NamedEvent& event) {
  Json roles = Json::object();
  for (const grammar::Role& role : event.roles) roles[role.name] = role.value;
  Json one = {{"event", event.event},
              {"roles", std::move(roles)},
              {"begin_s", SecondsAt(answer, event.interval.begin)},
              {"end_s", SecondsAt(answer, event.interval.end)}};
  for (const grammar::NamedValue& value : event.values) one["attributes"][value.name] = value.value;
  return one;
}

/// `pictures`: one file per answer, or none.
void PrintQueryJson(const std::vector<EventAnswer>& answers,
                    const std::vector<std::string>& pictures, std::ostream& out) {
  Json all = Json::array();
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const EventAnswer& answer = answers[i];
    Json one = {{"file", answer.file}, {"episode", answer.episode}, {"scenario", answer.scenario}};
    one.update(EventJson(answer, answer.event));
    for (const grammar::NamedEvent& part : answer.parts) {
      one["parts"].push_back(EventJson(answer, part));
    }
    if (!pictures.empty()) one["picture"] = pictures[i];
    all.push_back(std::move(one));
  }
  out << all.dump(2) << "\n";
}

void PrintCsv(const std::vector<std::vector<std::string>>& rows, std::ostream& out) {
  for (const std::vector<std::string>& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) out << (i ? "," : "") << AsCsvCell(row[i]);
    out << "\n";
  }
}

void PrintQueryTable(const std::vector<EventAnswer>& answers,
                     const std::vector<std::string>& pictures, bool csv, std::ostream& out) {
  std::vector<std::vector<std::string>> rows = {
      {"file", "episode", "scenario", "event", "begin_s", "end_s", "roles"}};
  if (!pictures.empty()) rows[0].push_back("picture");
  const auto add = [&](std::size_t i, const grammar::NamedEvent& event, bool is_part) {
    const EventAnswer& answer = answers[i];
    rows.push_back({answer.file, std::to_string(answer.episode), answer.scenario,
                    (is_part && !csv ? "  " : "") + event.event,
                    truth::SecondsText(event.interval.begin, answer.ticks_per_second),
                    truth::SecondsText(event.interval.end, answer.ticks_per_second),
                    RolesText(event)});
    if (!pictures.empty()) rows.back().push_back(is_part ? "" : pictures[i]);
  };
  for (std::size_t i = 0; i < answers.size(); ++i) {
    add(i, answers[i].event, false);
    for (const grammar::NamedEvent& part : answers[i].parts) add(i, part, true);
  }
  if (csv) return PrintCsv(rows, out);
  out << truth::AlignColumns(rows);
  out << answers.size() << (answers.size() == 1 ? " answer\n" : " answers\n");
}

/// Of --count-by: columns that every event has, and behind a role that of its class.
constexpr std::array kColumns = {"event", "scenario", "episode", "file"};
constexpr const char* kClassColumn = "_class";

std::string ColumnOf(const EventAnswer& answer, const std::string& column) {
  if (column == kColumns[0]) return answer.event.event;
  if (column == kColumns[1]) return answer.scenario;
  if (column == kColumns[2]) return std::to_string(answer.episode);
  if (column == kColumns[3]) return answer.file;
  for (std::size_t i = 0; i < answer.event.roles.size(); ++i) {
    const grammar::Role& role = answer.event.roles[i];
    if (role.name == column) return role.value;
    if (role.name + kClassColumn == column) return answer.classes[i];
  }
  return "";
}

std::vector<std::string> ColumnsOf(const ParsedOptions& options) {
  std::vector<std::string> columns;
  std::istringstream text(options.Text("--count-by"));
  for (std::string column; std::getline(text, column, ',');) columns.push_back(column);
  return columns;
}

/// Why no answer can have one of the columns, or "".
std::string UnknownColumn(const std::vector<std::string>& columns,
                          const std::set<std::string>& roles) {
  std::vector<std::string> names(kColumns.begin(), kColumns.end());
  for (const std::string& role : roles) names.insert(names.end(), {role, role + kClassColumn});
  for (const std::string& column : columns) {
    if (roles.empty() || std::ranges::find(names, column) != names.end()) continue;
    const std::string near = grammar::NearestName(column, names);
    return fmt::format("--count-by: there is no column '{}'; {}there are: {}", column,
                       near.empty() ? "" : fmt::format("did you mean '{}'? ", near),
                       fmt::join(names, ", "));
  }
  return "";
}

/// How many answers have the same in these columns, the most first.
void PrintCounts(const std::vector<EventAnswer>& answers, const std::vector<std::string>& columns,
                 const ParsedOptions& options, std::ostream& out) {
  std::map<std::vector<std::string>, std::size_t> counts;
  for (const EventAnswer& answer : answers) {
    std::vector<std::string> cells;
    for (const std::string& column : columns) cells.push_back(ColumnOf(answer, column));
    ++counts[cells];
  }
  std::vector<std::pair<std::vector<std::string>, std::size_t>> sorted(counts.begin(),
                                                                       counts.end());
  std::ranges::stable_sort(sorted, std::greater(), [](const auto& row) { return row.second; });
  std::vector<std::vector<std::string>> rows = {columns};
  rows[0].push_back("count");
  Json all = Json::array();
  for (const auto& [cells, count] : sorted) {
    Json one;
    for (std::size_t i = 0; i < columns.size(); ++i) one[columns[i]] = cells[i];
    one["count"] = count;
    all.push_back(std::move(one));
    rows.push_back(cells);
    rows.back().push_back(std::to_string(count));
  }
  if (options.Has("--json")) {
    out << all.dump(2) << "\n";
  } else if (options.Has("--csv")) {
    PrintCsv(rows, out);
  } else {
    for (std::vector<std::string>& row : rows)
      std::ranges::replace(row, std::string(), std::string("-"));
    out << truth::AlignColumns(rows);
    out << answers.size() << (answers.size() == 1 ? " answer\n" : " answers\n");
  }
}

std::string RoleProblem(const std::string& text) {
  return episode::ParseRoleCondition(text)
             ? ""
             : "found '" + text + "', wanted ROLE=VALUE, like object=milk or any=milk";
}

constexpr std::string_view kHas = "has ";  ///< a part of this name

std::string RelationProblem(const std::string& text) {
  std::string problem;
  if (!text.starts_with(kHas)) (void)episode::ParseRelation(text, problem);
  return problem;
}

/// "0.5", "0.5..2" or "..2": at least, and at most; nothing of any other text.
using Bounds = std::pair<std::optional<double>, std::optional<double>>;
std::optional<Bounds> BoundsIn(const std::string& text) {
  const std::size_t dots = text.find("..");
  Bounds bounds;
  const auto read = [](const std::string& part, std::optional<double>& into) {
    into = NumberFrom<double>(part);
    return into && *into >= 0;
  };
  const std::string least = text.substr(0, dots);
  const std::string most = dots == std::string::npos ? "" : text.substr(dots + 2);
  if (least.empty() && most.empty()) return std::nullopt;
  if (!least.empty() && !read(least, bounds.first)) return std::nullopt;
  if (!most.empty() && !read(most, bounds.second)) return std::nullopt;
  return bounds;
}

std::string LastsProblem(const std::string& text) {
  return BoundsIn(text) ? "" : "found '" + text + "', wanted seconds: 0.5, 0.5..2 or ..2";
}

EventQuestion EventQuestionOf(const ParsedOptions& options) {
  EventQuestion question{.scenario = options.Text("--episode"), .event = options.Text("--event")};
  question.tells_parts = options.Has("--parts");
  for (const auto& [option, conditions] :
       {std::pair{"--role", &question.roles}, std::pair{"--part-of", &question.parts_of}}) {
    for (const std::string& text : options.All(option))
      conditions->push_back(*episode::ParseRoleCondition(text));
  }
  for (const auto& [option, bound] :
       {std::pair{"--from", &question.from_s}, std::pair{"--to", &question.until_s}}) {
    if (options.Has(option)) *bound = options.NumberOr(option, 0);
  }
  if (options.Has("--lasts-s"))
    std::tie(question.at_least_s, question.at_most_s) = *BoundsIn(options.Text("--lasts-s"));
  std::string problem;
  for (const std::string& text : options.All("--relation")) {
    if (text.starts_with(kHas))
      question.with.push_back(text.substr(kHas.size()));
    else
      question.relations.push_back(*episode::ParseRelation(text, problem));
  }
  return question;
}

/// Why no event can have one of the roles that are asked for, or "".
std::string UnknownRole(const EventQuestion& question, const std::set<std::string>& known) {
  for (const auto& [option, conditions] :
       {std::pair{"--role", &question.roles}, std::pair{"--part-of", &question.parts_of}}) {
    for (const episode::RoleCondition& condition : *conditions) {
      if (known.empty() || condition.role == "any" || known.contains(condition.role)) continue;
      const std::vector<std::string> names(known.begin(), known.end());
      return fmt::format("{}: no event has a role '{}'; {}", option, condition.role,
                         grammar::DidYouMean(condition.role, names,
                                             fmt::format("there are: {}", fmt::join(names, ", "))));
    }
  }
  return "";
}

/// Names that nothing has, of which no answer can be, and what may be meant.
std::string NearestNames(const EventQuestion& question, const episode::KnownNames& known) {
  std::string text;
  const auto tell = [&](const std::string& name, const std::set<std::string>& names,
                        const std::string& what) {
    if (name.empty() || names.contains(name) || name.find_first_of("*?") != std::string::npos)
      return;
    const std::vector<std::string> all(names.begin(), names.end());
    const std::string near = grammar::DidYouMean(name, all, "");
    text += fmt::format("prehend: {}{}{}\n", what, near.empty() ? "" : "; ", near);
  };
  tell(question.event, known.events, fmt::format("no event is called '{}'", question.event));
  for (const auto& [option, conditions] :
       {std::pair{"--role", &question.roles}, std::pair{"--part-of", &question.parts_of}}) {
    for (const episode::RoleCondition& condition : *conditions) {
      tell(condition.value, known.values,
           fmt::format("{}: nothing is called '{}', or is one", option, condition.value));
    }
  }
  return text;
}

ExitCode RunQuery(const ParsedOptions& options, const CommandContext& context) {
  if (options.Has("--json") && options.Has("--csv"))
    return Refuse(context, "--json contradicts --csv; give one of them");
  const std::vector<std::string> columns = ColumnsOf(options);
  if (!columns.empty() && (options.Has("--show") || options.Has("--parts")))
    return Refuse(context, "--count-by contradicts --show and --parts; give one of them");
  if (options.Has("--show") && !show::CanDrawPictures())
    return Refuse(context, "--show: this build draws no pictures");
  const EventQuestion question = EventQuestionOf(options);
  std::vector<EventAnswer> answers;
  episode::KnownNames known;
  episode::EpisodeKeeper keeper(context.root, context.today);
  for (std::string path : options.All("EPISODES")) {
    if (episode::EpisodeKindOf(path) != episode::EpisodeKind::kEpisodeFile) {
      const auto name = episode::FindEpisode(path, "", context.root);
      if (!name) return Complain(context, name.error());
      const Result<episode::EpisodeName> kept = keeper.Keep(*name);
      if (!kept) return Complain(context, kept.error());
      path = kept->file;
    }
    auto found = episode::Ask(path, question, known);
    if (!found) return Complain(context, found.error());
    answers.insert(answers.end(), found->begin(), found->end());
  }
  context.err << keeper.warnings();
  if (const std::string why = UnknownRole(question, known.roles); !why.empty())
    return Refuse(context, why);
  if (const std::string why = UnknownColumn(columns, known.roles); !why.empty())
    return Refuse(context, why);
  if (answers.empty()) context.err << NearestNames(question, known);
  show::MomentPictures drawn;
  if (options.Has("--show")) {
    std::vector<show::Moment> moments;
    for (const EventAnswer& answer : answers) moments.push_back(show::MomentOf(answer));
    drawn = show::DrawMoments(moments, options.Text("--show"), context.root);
  }
  for (EventAnswer& answer : answers) answer.file = keeper.SourceOf(answer.file);
  if (!columns.empty())
    PrintCounts(answers, columns, options, context.out);
  else if (options.Has("--json"))
    PrintQueryJson(answers, drawn.files, context.out);
  else
    PrintQueryTable(answers, drawn.files, options.Has("--csv"), context.out);
  if (!drawn.error.empty()) return Complain(context, ExitCode::kFailure, "--show: " + drawn.error);
  return answers.empty() ? ExitCode::kNothing : ExitCode::kAgrees;
}

Option RoleOption(const std::string& name, const std::string& help,
                  const std::string& placeholder) {
  return Repeatable(Value(name, placeholder, help + "; may be repeated", {.problem = RoleProblem}));
}

Option SecondsOption(const std::string& name, const std::string& help) {
  return Value(name, "S", help, NumbersFrom(0, 1e6));
}

}  // namespace

Command QueryCommand() {
  return {
      .name = "episode query",
      .summary = "Find events in recorded episodes",
      .examples =
          {"episode query suite.episodes --event sliding --role object=CerealBox",
           "episode query suite.episodes --event grasping --role object=Handle --part-of "
           "object=Door",
           "episode query suite.episodes --event pick_and_place --parts --json",
           "episode query *.episodes --event sliding --relation 'meets transporting' --csv",
           "episode query suite.episodes --event grasping --count-by style,object_class",
           "episode query suite.episodes --event grasping --role object=Handle --show shown"},
      .options =
          {EpisodesArgument(), Value("--event", "NAME", "its name, or a glob"),
           RoleOption("--role",
                      "who or what has a role: an entity, or what is of this class, directly or "
                      "not (of any role: any=NAME)",
                      "ROLE=NAME"),
           RoleOption("--part-of", "of what it is a part, directly or not: an entity or a class",
                      "ROLE=NAME"),
           Value("--lasts-s", "S[..S]",
                 "the event lasts at least so long, or so long: 0.5, 0.5..2 or ..2",
                 {.problem = LastsProblem}),
           SecondsOption("--from", "it begins at this time of its episode or later"),
           SecondsOption("--to", "it ends at this time of its episode or earlier"),
           Repeatable(
               Value("--relation", "'RELATION EVENT'",
                     "how it lies to another event of its episode, in Allen's words (before, "
                     "meets, overlaps, starts, inside, finishes, equals, ..), or 'has EVENT': it "
                     "has a part of this name (see --parts); may be repeated",
                     {.problem = RelationProblem})),
           EpisodesOption(),
           Flag("--parts",
                "below each event also its parts: those that begin within it and have no other "
                "participants"),
           Value("--count-by", "COLUMN,..",
                 "instead of the answers how many have the same in these columns: event, scenario, "
                 "episode, file, a role (style, object), a role's class (object_class)"),
           WritesFile(Value("--show", "FOLDER",
                            "draw each answer into this folder: the world when the event begins, "
                            "with the paths of its hand and its thing until it ends")),
           JsonOption(), Flag("--csv", "print CSV instead of a table")},
      .run = RunQuery};
}

}  // namespace prehend::cli
