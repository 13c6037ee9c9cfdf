// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "grammar/base/diagnostic.h"
#include "grammar/drawing/drawn_episode.h"

namespace prehend::grammar {
namespace {

bool IsAmong(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

char Character(int number) {
  return static_cast<char>(number < 10 ? '0' + number : 'a' + number - 10);
}

}  // namespace

std::optional<int> DrawnNumber(char cell) {
  if (cell >= '0' && cell <= '9') return cell - '0';
  if (cell >= 'a' && cell <= 'z') return cell - 'a' + 10;
  return std::nullopt;
}

bool DrawnFact::Takes(char cell) const {
  if (cell == '.' || cell == '#') return cell == '.' || marks;
  return DrawnNumber(cell).value_or(most + 1) <= most;
}

std::string DrawnFact::Characters() const {
  std::string text;
  if (most >= 0) text = most == 0 ? "0" : std::string("0..") + Character(std::min(most, 9));
  if (most == 10) text += ", a";
  if (most > 10) text += std::string(", a..") + Character(most);
  if (marks) text += std::string(text.empty() ? "" : ", ") + "'#'";
  return text + " or '.'";
}

std::vector<DrawnFact> FactsOf(const EntityInfo& entity) {
  constexpr int kMostNumber = 35;
  const int sets = static_cast<int>(entity.sensor_sets.size());
  std::vector<DrawnFact> facts = {
      {.name = "x", .most = kMostNumber, .says_all_along = true},
      {.name = "y", .most = kMostNumber, .says_all_along = true},
      {.name = "z", .most = kMostNumber, .says_all_along = true},
      {.name = "shakes", .marks = true},
      {.name = "lost", .marks = true},
      {.name = "grip", .most = 10, .marks = true, .says_all_along = true},
      {.name = "joint", .most = 20, .says_all_along = true},
      {.name = "percent", .most = kMostNumber, .says_all_along = true},
      {.name = "tilt", .most = kMostNumber, .says_all_along = true},
      {.name = "turn", .most = kMostNumber, .says_all_along = true},
      {.name = "on", .of_two = true, .marks = true},
      {.name = "beside", .of_two = true, .marks = true},
      {.name = "holds", .of_two = true, .most = std::min(sets, kMostNumber)},
      {.name = "presses", .of_two = true, .most = kMostNumber},
      {.name = "looks", .of_two = true, .marks = true},
      {.name = "circles", .of_two = true, .most = 18, .says_all_along = true},
  };
  for (const std::string& set : entity.sensor_sets)
    facts.push_back({.name = set, .of_two = true, .marks = true});
  return facts;
}

std::string WhyNever(const DrawnFact& fact, const EntityInfo& entity) {
  const std::string& is = entity.classes.front();
  const std::string and_it_is = ", and '" + entity.name + "' is " + WithArticle(is);
  if (IsAmong(fact.name, {"grip", "holds"}) && is != "Hand")
    return "only a hand has a grip and holds" + and_it_is;
  if (IsAmong(fact.name, {"joint", "percent"}) &&
      IsAmong(is, {"Hand", "Movable", "Fixed", "Attached", "Abstract", "Grains"}))
    return "only a Jointed thing is open or closed" + and_it_is;
  if (fact.name == "looks" &&
      IsAmong(is, {"Hand", "Thing", "Movable", "Fixed", "Jointed", "Attached", "Grains"}))
    return "only a person, a head or a camera looks" + and_it_is;
  return {};
}

std::vector<std::string> ValuesSetBy(const DrawnFact& fact, const std::string& who,
                                     const std::string& whom) {
  const std::string both = who < whom ? who + " " + whom : whom + " " + who;
  if (fact.name == "circles") return {who + " x", who + " y", who + " z"};
  if (fact.name == "percent") return {who + " joint"};
  if (fact.name == "looks") return {who + " looks"};
  if (IsAmong(fact.name, {"on", "beside"})) return {both + " lie"};
  if (fact.name == "presses") return {both + " presses"};
  return {who + " " + fact.name + (whom.empty() ? "" : " " + whom)};
}

}  // namespace prehend::grammar
