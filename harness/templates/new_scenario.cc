// SPDX-License-Identifier: Apache-2.0
// See harness/templates/new_scenario.h
#include "harness/templates/new_scenario.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "grammar/base/diagnostic.h"
#include "harness/templates/nouns.h"
#include "harness/templates/verbs.h"

namespace prehend::harness {
namespace {

constexpr std::string_view kDefaultVerb = "carry";
constexpr std::string_view kColors =
    "white black grey silver red orange yellow green blue purple violet pink brown beige turquoise";

struct Destination {
  std::string_view word, body;
};
constexpr Destination kInto[] = {
    {"bowl", "class: Bowl, bowl: {radius_m: 0.14, height_m: 0.05}, mass_kg: 0.6"},
    {"basket", "class: Basket, tray: {size_m: [0.3, 0.3, 0.08]}, mass_kg: 0.6"},
    {"box", "class: Box, tray: {size_m: [0.3, 0.3, 0.08]}, mass_kg: 0.6"}};
constexpr Destination kOnto[] = {
    {"stand", "class: Stand, fixed: true, box: {size_m: [0.2, 0.2, 0.06]}"},
    {"tray", "class: Tray, tray: {size_m: [0.4, 0.3, 0.03]}, mass_kg: 0.8"},
    {"box", "class: Box, box: {size_m: [0.2, 0.2, 0.10]}, mass_kg: 1"},
    {"book", "class: Book, box: {size_m: [0.24, 0.18, 0.03]}, mass_kg: 0.6"},
    {"plate", "class: Plate, cylinder: {radius_m: 0.13, length_m: 0.015}, mass_kg: 0.5"}};

std::vector<std::string> WordsOf(std::string_view text, char separator) {
  std::vector<std::string> words;
  std::istringstream in{std::string(text)};
  for (std::string word; std::getline(in, word, separator);)
    if (!word.empty()) words.push_back(word);
  return words;
}

bool Has(std::string_view list, const std::string& word) {
  return std::ranges::count(WordsOf(list, ' '), word) > 0;
}

bool HasAny(std::string_view list, const std::vector<std::string>& words) {
  return std::ranges::any_of(words, [&](const std::string& word) { return Has(list, word); });
}

const Verb& VerbNamed(std::string_view name) {
  return *std::ranges::find(Verbs(), name, &Verb::name);
}

/// The verb that the words name; null if there is none.
const Verb* VerbIn(std::vector<std::string> words) {
  // A hand is who does it, but in 'hand over'.
  if (std::ranges::count(words, "over") == 0)
    std::erase_if(words, [](const std::string& word) { return word == "hand" || word == "hands"; });
  for (const Verb& verb : Verbs())
    if (HasAny(verb.words, words) && (verb.also.empty() || HasAny(verb.also, words))) return &verb;
  return nullptr;
}

/// Whether a thing at this place in a name is where something goes.
bool FollowsPreposition(const std::vector<std::string>& words, std::size_t at) {
  while (at > 0 && (Has("a an the", words[at - 1]) || Has(kColors, words[at - 1]))) --at;
  return at > 0 && Has("in into inside on onto over", words[at - 1]);
}

struct Thing {
  const Noun* noun = nullptr;
  std::string name;  ///< with its colour
};

/// What the name speaks of: the first noun that is not where something goes.
Thing ThingIn(const std::vector<std::string>& words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const Noun* noun = FindNoun(words[i]);
    if (!noun || FollowsPreposition(words, i)) continue;
    const bool colored = i > 0 && Has(kColors, words[i - 1]);
    return {noun, (colored ? words[i - 1] + "_" : "") + std::string(noun->word)};
  }
  return {};
}

template <std::size_t n>
const Destination& DestinationIn(const Destination (&known)[n],
                                 const std::vector<std::string>& words) {
  for (std::size_t i = 0; i < words.size(); ++i)
    for (const Destination& destination : known)
      if (words[i] == destination.word && FollowsPreposition(words, i)) return destination;
  return known[0];
}

/// Words that change nothing of what happens.
constexpr std::string_view kPlain =
    "a an the is are was be been it its and then with by to of from at in into inside on onto over "
    "up down away back again off out hand hands person table three times first try new test "
    "scenario my";

/// Of what the templates cannot do, the section of docs/script-cookbook.md that does.
constexpr std::pair<std::string_view, std::string_view> kSections[] = {
    {"rests rest stays waits beside near next", "Rest beside"},
    {"elbow", "With the elbow"},
    {"wall along", "Along a wall"},
    {"circles circled circle around round orbits", "Circle"},
    {"tray", "Carry a tray"},
    {"brushes brushed brush touches touched touch twin twins", "Brush one, take the other"},
    {"tilts tilted tilt shown shows", "Way-points from where the hand is"},
    {"walks walk leans", "Walk gently"},
    {"set sets twelve six", "Set a table"}};

/// What of the name the new scenario does not do: "'elbow' of the name is left out; ..". Empty if
/// all of it is understood. `verb` may be null.
std::string IgnoredWords(const std::vector<std::string>& words, const Verb* verb,
                         const Thing& thing, const Destination& destination) {
  std::vector<std::string> ignored;
  std::string_view section;
  for (const std::string& word : words) {
    const bool of_verb = verb && (Has(verb->words, word) || Has(verb->also, word) ||
                                  (!verb->destination.empty() && word == destination.word));
    const bool of_thing =
        thing.noun && (FindNoun(word) == thing.noun || thing.name.starts_with(word + "_"));
    if (of_verb || of_thing || Has(kPlain, word)) continue;
    ignored.push_back("'" + word + "'");
    for (const auto& [known, title] : kSections)
      if (section.empty() && Has(known, word)) section = title;
  }
  if (ignored.empty()) return "";
  const std::string where = section.empty()
                                ? "docs/script-cookbook.md has scripts to copy"
                                : fmt::format("docs/script-cookbook.md has it: '{}'", section);
  return fmt::format("of the name, {} {} left out; {}", fmt::join(ignored, ", "),
                     ignored.size() == 1 ? "is" : "are", where);
}

std::string WithArticle(const std::string& name) {
  return (std::string("aeiou").find(name.front()) != std::string::npos ? "an " : "a ") + name;
}

std::string Spaced(std::string text) {
  std::ranges::replace(text, '_', ' ');
  return text;
}

std::string Filled(std::string_view text, const std::map<std::string, std::string>& values) {
  std::string filled(text);
  for (const auto& [key, value] : values) {
    const std::string mark = "@" + key + "@";
    for (std::size_t at = filled.find(mark); at != std::string::npos; at = filled.find(mark, at))
      filled.replace(at, mark.size(), value), at += value.size();
  }
  return filled;
}

constexpr std::string_view kText =
    R"(# yaml-language-server: $schema=../scenario.schema.json
# Every key is explained in docs/scenario-format.md, more scripts are in docs/script-cookbook.md. Units are the last
# word of a key; z is up.
scenario: name
shows: @shows@   # what it proves, as a sentence
@grammar@   # a file of grammar/library/, without ".grammar"
tags: []

# What must be recognised if the sentence is true. Write it before the first run: afterwards it is easy to expect
# whatever came out. `any` fits everybody. `check` fails on what contradicts a line, and `accept` refuses it.
expects:
@expects@
# Things. `on` puts one onto another; then at_m gives x and y only.
entities:
@entities@
# Hands, and where they start.
actors:
@actors@
# One stage after another. Actors named in one stage act at the same time.
script:
@script@
# Pictures for the report: at an event's begin or end, or at a time in seconds.
pictures:
  - {at: @picture@}
)";

}  // namespace

std::vector<std::string> VerbNames() {
  std::vector<std::string> names;
  for (const Verb& verb : Verbs()) names.emplace_back(verb.name);
  std::ranges::sort(names);
  return names;
}

std::string WhyNoVerb(const std::string& verb) {
  const std::vector<std::string> known = VerbNames();
  if (verb.empty() || std::ranges::count(known, verb) > 0) return "";
  const std::string nearest = grammar::NearestName(verb, known);
  return fmt::format("no verb is called '{}'; {}known: {}", verb,
                     nearest.empty() ? "" : fmt::format("did you mean '{}'? ", nearest),
                     fmt::join(known, ", "));
}

NewScenario ComposeScenario(std::string_view name, std::string_view wanted) {
  const std::vector<std::string> words = WordsOf(name, '_');
  const Verb* said = wanted.empty() ? VerbIn(words) : &VerbNamed(wanted);
  const Verb& verb = said ? *said : VerbNamed(kDefaultVerb);
  NewScenario made;
  if (!said)
    made.note =
        fmt::format("the name has no verb that 'new' knows, so this is '{}'; choose by --verb: {}",
                    verb.name, fmt::join(VerbNames(), ", "));
  const std::vector<std::string> nouns = WordsOf(verb.nouns, ' ');
  const Thing spoken_of = ThingIn(words);
  Thing thing = spoken_of;
  if (!nouns.empty() && (!thing.noun || !Has(verb.nouns, std::string(thing.noun->word)))) {
    const std::string instead = nouns.front();
    if (said && thing.noun)
      made.note = fmt::format("'{}' is written for {} only, so this is about a {}", verb.name,
                              fmt::join(nouns, ", "), instead);
    else if (said)
      made.note =
          fmt::format("the name has no thing that 'new' knows, so this is about a {}; known: {}",
                      instead, fmt::join(nouns, ", "));
    thing = {FindNoun(instead), instead};
  }
  const bool into = verb.destination == "in";
  const Destination& destination = into ? DestinationIn(kInto, words) : DestinationIn(kOnto, words);
  std::map<std::string, std::string> values = {{"d", std::string(destination.word)},
                                               {"destination", std::string(destination.body)}};
  if (thing.noun) {
    values["o"] = thing.name;
    values["a"] = WithArticle(Spaced(thing.name));
    values["body"] = thing.noun->body;
  }
  std::map<std::string, std::string> parts;
  for (const auto& [key, text] : {std::pair("shows", verb.shows),
                                  {"grammar", verb.grammar},
                                  {"expects", verb.expects},
                                  {"entities", verb.entities},
                                  {"actors", verb.actors},
                                  {"script", verb.script},
                                  {"picture", verb.picture}})
    parts[key] = Filled(text, values);
  if (parts["picture"].find(',') == std::string::npos)
    parts["picture"] += ", camera: three_quarter";
  if (wanted.empty()) {
    const std::string ignored = IgnoredWords(words, said, spoken_of, destination);
    if (!ignored.empty()) made.note += (made.note.empty() ? "" : "; ") + ignored;
  }
  made.what = Filled(verb.shows, values);
  made.text = Filled(kText, parts);
  return made;
}

}  // namespace prehend::harness
