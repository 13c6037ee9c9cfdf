// SPDX-License-Identifier: Apache-2.0
// Line by line; what is wrong with a line does not stop the reading of the others.
#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <sstream>

#include "grammar/base/diagnostic.h"
#include "grammar/drawing/drawn_episode.h"

namespace prehend::grammar {
namespace {

constexpr std::size_t kMostEpisodes = 1000, kMostColumns = 10'000, kMostEntities = 64;
constexpr std::size_t kMostSensorSets = 32;
constexpr int kNobody = -1;

std::string Trim(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t");
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

std::vector<std::string> Words(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

// "tap( hand,drum )" -> "tap(hand, drum)": one blank after a comma and between words, no other.
std::string SingleSpaced(const std::string& text) {
  const auto glues = [](char c) { return c == '(' || c == ')' || c == ','; };
  std::string single;
  bool blank = false;
  for (const char c : text) {
    if (c == ' ' || c == '\t') {
      blank = true;
      continue;
    }
    const bool between_words = blank && !single.empty() && !glues(single.back()) && !glues(c);
    if (between_words || single.ends_with(',')) single += ' ';
    single += c;
    blank = false;
  }
  return single;
}

std::optional<double> NumberBefore(std::string_view text, std::string_view unit) {
  if (!text.ends_with(unit)) return std::nullopt;
  text.remove_suffix(unit.size());
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && number >= 0 ? std::optional(number) : std::nullopt;
}

EntityInfo Member(const std::string& name, const std::string& class_name) {
  EntityInfo member{.name = name, .classes = {class_name}};
  if (class_name == "Movable" || class_name == "Fixed" || class_name == "Jointed" ||
      class_name == "Attached")
    member.classes.emplace_back("Thing");
  if (class_name == "Region" || class_name == "GazeTarget" || class_name == "Camera" ||
      class_name == "Light")
    member.classes.emplace_back("Abstract");
  if (class_name == "Hand") member.sensor_sets = {"fingers", "thumb", "palm"};
  member.classes.emplace_back("Entity");
  return member;
}

/// As the language has them: "Knife", "sharp_knife2".
bool IsClassName(const std::string& text) {
  const auto is_letter = [](char c) { return (c | 0x20) >= 'a' && (c | 0x20) <= 'z'; };
  return !text.empty() && is_letter(text.front()) && std::ranges::all_of(text, [&](char c) {
    return is_letter(c) || c == '_' || (c >= '0' && c <= '9');
  });
}

std::string Quoted(const std::string& text) { return "'" + text + "'"; }

class Reader {
 public:
  Reader(const GrammarText& file, Diagnostics& diagnostics)
      : file_(file), diagnostics_(diagnostics) {}

  std::vector<DrawnEpisode> Read() {
    const std::size_t before = diagnostics_.size();
    std::istringstream lines(file_.text);
    for (line_ = 1; std::getline(lines, text_); ++line_) {
      if (diagnostics_.size() >= before + kMostDiagnostics) break;
      if (!text_.empty() && text_.back() == '\r') text_.pop_back();
      if (Trim(text_).empty() || text_[0] == '#') continue;
      ReadLine();
    }
    FinishEpisode();
    if (episodes_.empty() && diagnostics_.size() == before)
      Complain(0, "nothing is drawn in this file", "entities hand:Hand cup:Movable, then rows");
    if (diagnostics_.size() != before) episodes_.clear();
    return std::move(episodes_);
  }

 private:
  void Complain(std::size_t column, std::string message, std::string hint = {}) {
    const Place place{line_, static_cast<int>(column) + 1};
    diagnostics_.push_back(
        DiagnosticAt(file_.file, file_.text, place, std::move(message), std::move(hint)));
  }

  DrawnEpisode& Now() { return episodes_.back(); }

  void Start(std::string title) {
    FinishEpisode();
    if (episodes_.size() == kMostEpisodes)
      Complain(0, "more than " + std::to_string(kMostEpisodes) + " drawings in one file");
    episodes_.push_back({.title = std::move(title), .line = line_});
    tried_row_ = false;
    set_.clear();
    for (const auto& [name, of_class] :
         {std::pair("hand", "Hand"), std::pair("cup", "Movable"), std::pair("table", "Fixed")})
      Now().entity_table.push_back(Member(name, of_class));
  }

  void FinishEpisode() {
    if (!episodes_.empty() && !tried_row_) {
      diagnostics_.push_back(DiagnosticAt(file_.file, file_.text, {Now().line, 1},
                                          "this drawing has no row of facts",
                                          "for example: cup on table |####....|"));
    }
  }

  void ReadLine() {
    const std::size_t bar = text_.find('|');
    if (text_.starts_with("== ")) return Start(Trim(text_.substr(3)));
    const bool is_head = bar == std::string::npos && text_ != "--";
    if (episodes_.empty() || (Now().has_expected && is_head)) Start({});
    if (text_ == "--") {
      if (Now().has_expected) Complain(0, "a second '--' in one drawing");
      Now().has_expected = true;
    } else if (text_ == "rates") {
      Now().rates = {30, 60, 90, 100, 240};
    } else if (text_ == "jittered") {
      Now().jittered = true;
    } else if (text_.starts_with("grammar ")) {
      Now().grammar = Trim(text_.substr(8));
    } else if (text_.starts_with("entities ")) {
      ReadEntities();
    } else if (bar != std::string::npos) {
      ReadRow(bar);
    } else {
      tried_row_ = true;
      Complain(0, "expected a row, found " + Quoted(Trim(text_)),
               "a row has its columns between bars: cup on table |####....|");
    }
  }

  void ReadEntities() {
    if (!Now().facts.empty()) return Complain(0, "'entities' stands above all rows");
    Now().entity_table.clear();
    for (const std::string& word : Words(text_.substr(9))) ReadEntity(word, text_.find(word, 9));
  }

  void ReadEntity(const std::string& word, std::size_t column) {
    std::istringstream parts(word);
    std::string name, class_name;
    if (!std::getline(parts, name, ':') || !std::getline(parts, class_name, ':') || name.empty() ||
        class_name.empty())
      return Complain(column, "expected NAME:CLASS, found " + Quoted(word),
                      "for example: cup:Movable");
    if (!IsClassName(class_name))
      return Complain(column + name.size() + 1, Quoted(class_name) + " is no name of a class",
                      "for example: knife:Movable, or with classes of its own knife:Movable:is=" +
                          std::string("Knife+Tool"));
    if (Find(name) != kNoEntity) return Complain(column, Quoted(name) + " is named twice");
    if (Now().entity_table.size() == kMostEntities)
      return Complain(column, "more than " + std::to_string(kMostEntities) + " entities");
    EntityInfo member = Member(name, class_name);
    for (std::string detail; std::getline(parts, detail, ':');)
      ReadDetail(member, detail, column + word.find(detail));
    Now().entity_table.push_back(std::move(member));
  }

  // "8kg", "50N", "of=drawer", "is=Knife+Tool" or "thumb+index+middle".
  void ReadDetail(EntityInfo& member, const std::string& detail, std::size_t column) {
    if (detail.starts_with("of=")) {
      member.part_of = Find(detail.substr(3));
      if (member.part_of == kNoEntity)
        Complain(column + 3, "no entity before this one is called " + Quoted(detail.substr(3)));
    } else if (detail.starts_with("is=")) {
      ReadClasses(member, detail.substr(3), column + 3);
    } else if (const auto kg = NumberBefore(detail, "kg")) {
      member.mass_kg = *kg;
    } else if (const auto newtons = NumberBefore(detail, "N")) {
      member.strength_n = *newtons;
    } else if (member.classes.front() == "Hand") {
      std::istringstream sets(detail);
      member.sensor_sets.clear();
      for (std::string set; std::getline(sets, set, '+');) member.sensor_sets.push_back(set);
      if (member.sensor_sets.size() > kMostSensorSets)
        Complain(column, "a hand has at most " + CountOf(kMostSensorSets, "sensor set"));
    } else {
      Complain(column, "what is " + Quoted(detail) + " of " + Quoted(member.name) + "?",
               "a mass (8kg), a strength (50N), what it is a part of (of=drawer), further classes "
               "(is=Knife+Tool), or the sensor sets of a hand (thumb+index)");
    }
  }

  // "Knife+Tool"
  void ReadClasses(EntityInfo& member, const std::string& names, std::size_t column) {
    std::istringstream all(names + "+");
    for (std::string name; std::getline(all, name, '+');) {
      if (!IsClassName(name))
        return Complain(column, Quoted(name) + " is no name of a class",
                        "for example: knife:Movable:is=Knife+Tool");
      if (!WrongRoot({name}, member.classes).empty())
        return Complain(column,
                        Quoted(name) + " is built in, and " + Quoted(member.name) + " is " +
                            WithArticle(member.classes.front()),
                        "write it before 'is=' instead: " + member.name + ":" + name);
      if (std::ranges::count(member.classes, name) == 0) member.classes.push_back(name);
      column += name.size() + 1;
    }
  }

  int Find(const std::string& name) const {
    const std::vector<EntityInfo>& all = episodes_.back().entity_table;
    const auto found = std::ranges::find(all, name, &EntityInfo::name);
    return found == all.end() ? kNoEntity : static_cast<int>(found - all.begin());
  }

  void ReadRow(std::size_t bar) {
    tried_row_ |= !Now().has_expected;
    const std::size_t end = text_.find('|', bar + 1);
    if (end == std::string::npos)
      return Complain(text_.size(), "expected '|' at the end of the row");
    DrawnRow row{SingleSpaced(text_.substr(0, bar)), text_.substr(bar + 1, end - bar - 1), line_};
    if (row.cells.empty()) return Complain(bar + 1, "this row has no columns");
    if (row.cells.size() > kMostColumns)
      return Complain(bar + 1, "more than " + std::to_string(kMostColumns) + " columns");
    const std::vector<DrawnRow>& facts = Now().facts;
    if (!facts.empty() && facts.front().cells.size() != row.cells.size()) {
      return Complain(bar + 1,
                      "this row has " + std::to_string(row.cells.size()) +
                          " columns, the first one has " +
                          std::to_string(facts.front().cells.size()),
                      "all rows of a drawing are equally long");
    }
    if (Now().has_expected) {
      if (facts.empty()) return Complain(0, "events are drawn below facts, and there are none");
      CheckEvents(row, bar);
      Now().expected.push_back(std::move(row));
    } else {
      CheckFact(row, bar);
      Now().facts.push_back(std::move(row));
    }
  }

  void CheckEvents(const DrawnRow& row, std::size_t bar) {
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const char cell = row.cells[i];
      const bool goes_on = cell == '=' && i > 0 && row.cells[i - 1] != '.';
      if (cell == '.' || cell == '[' || goes_on) continue;
      return Complain(bar + 1 + i,
                      cell == '=' ? "an event goes on here that has not begun"
                                  : "expected '.', '[' or '=' in a row of events",
                      "'[' begins an event, '=' goes on");
    }
  }

  void CheckFact(const DrawnRow& row, std::size_t bar) {
    const std::vector<std::string> words = Words(row.name);
    if (words.size() < 2)
      return Complain(0, "a fact is about somebody: who, what and perhaps whom",
                      "for example: cup on table |####....|, hand x |012345..|");
    const int who = CheckEntity(words[0]);
    if (who == kNoEntity) return;
    const EntityInfo& one = Now().entity_table[static_cast<std::size_t>(who)];
    const std::optional<DrawnFact> fact = CheckVerb(words, one);
    if (!fact) return;
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      if (fact->Takes(row.cells[i])) continue;
      return Complain(bar + 1 + i,
                      Quoted(fact->name) + " takes " + fact->Characters() + ", found " +
                          Quoted(row.cells.substr(i, 1)),
                      fact->name != "holds" ? ""
                                            : Quoted(one.name) + " has " +
                                                  CountOf(one.sensor_sets.size(), "sensor set"));
    }
    CheckOthers(*fact, words, row, bar);
  }

  // Two rows cannot give something two values in one column.
  void CheckOthers(const DrawnFact& fact, const std::vector<std::string>& words,
                   const DrawnRow& row, std::size_t bar) {
    const std::string whom = words.size() > 2 ? words[2] : "";
    for (const std::string& value : ValuesSetBy(fact, words[0], whom)) {
      std::vector<int>& by = set_[value];
      by.resize(row.cells.size(), kNobody);
      const int here = static_cast<int>(Now().facts.size());  // the row's index
      for (std::size_t i = 0; i < row.cells.size(); ++i) {
        if (!fact.Says(row.cells[i])) continue;
        if (by[i] != kNobody) {
          const DrawnRow& other = Now().facts[static_cast<std::size_t>(by[i])];
          return Complain(bar + 1 + i, Quoted(row.name) + " and " + Quoted(other.name) +
                                           " of line " + std::to_string(other.line) +
                                           " cannot both be so at once");
        }
        by[i] = here;
      }
    }
  }

  int CheckEntity(const std::string& name) {
    const int entity = Find(name);
    if (entity != kNoEntity) return entity;
    std::vector<std::string> names;
    for (const EntityInfo& one : Now().entity_table) names.push_back(one.name);
    Complain(text_.find(name), "nobody is called " + Quoted(name),
             DidYouMean(name, names, "the line 'entities' names all"));
    return kNoEntity;
  }

  std::optional<DrawnFact> CheckVerb(const std::vector<std::string>& words, const EntityInfo& one) {
    const std::string& what = words[1];
    const std::vector<DrawnFact> facts = FactsOf(one);
    const auto fact = std::ranges::find(facts, what, &DrawnFact::name);
    const std::size_t column = text_.find(what, text_.find(words[0]) + words[0].size());
    if (fact == facts.end()) {
      std::vector<std::string> known;
      for (const DrawnFact& other : facts) known.push_back(other.name);
      Complain(column, "unknown fact " + Quoted(what),
               DidYouMean(what, known, "docs/drawings.md lists them"));
    } else if (const std::string never = WhyNever(*fact, one); !never.empty()) {
      Complain(column, never);
    } else if (words.size() != (fact->of_two ? 3 : 2)) {
      Complain(column, Quoted(what) + (fact->of_two ? " is said of two" : " is said of one"),
               "for example: " + one.name + " " + what + (fact->of_two ? " table" : "") + " |...|");
    } else if (fact->of_two && words[2] == words[0]) {
      Complain(column, Quoted(what) + " is said of two, and both are " + Quoted(words[0]));
    } else if (!fact->of_two || CheckEntity(words[2]) != kNoEntity) {
      return *fact;
    }
    return std::nullopt;
  }

  const GrammarText& file_;
  Diagnostics& diagnostics_;
  std::vector<DrawnEpisode> episodes_;
  std::string text_;
  int line_ = 0;
  bool tried_row_ = false;                       ///< of the facts of this drawing, right or wrong
  std::map<std::string, std::vector<int>> set_;  ///< value: which row gives it, by column
};

}  // namespace

std::vector<DrawnEpisode> ReadDrawings(const GrammarText& file, Diagnostics& diagnostics) {
  return Reader(file, diagnostics).Read();
}

}  // namespace prehend::grammar
