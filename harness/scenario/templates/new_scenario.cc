// SPDX-License-Identifier: Apache-2.0
#include "harness/scenario/templates/new_scenario.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "harness/base/base/project_paths.h"
#include "harness/base/base/text_file.h"
#include "harness/base/yaml/struct_format.h"

namespace prehend::scenario {
namespace {

constexpr std::string_view kColors =
    "white black grey silver red orange yellow green blue purple violet pink brown beige turquoise";

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
bool Has(const std::vector<std::string>& list, const std::string& word) {
  return std::ranges::count(list, word) > 0;
}

bool HasAny(const std::vector<std::string>& list, const std::vector<std::string>& words) {
  return std::ranges::any_of(words, [&](const std::string& word) { return Has(list, word); });
}

const VerbTemplate& VerbNamed(const Templates& templates, std::string_view name) {
  return *std::ranges::find(templates.verbs, name, &VerbTemplate::name);
}

/// The verb that the words name; null if there is none.
const VerbTemplate* VerbIn(const Templates& templates, std::vector<std::string> words) {
  // A hand is who does it, but in 'hand over'.
  if (!Has(words, "over"))
    std::erase_if(words, [](const std::string& word) { return word == "hand" || word == "hands"; });
  for (const VerbTemplate& verb : templates.verbs)
    if (HasAny(verb.words, words) && (verb.also.empty() || HasAny(verb.also, words))) return &verb;
  return nullptr;
}

/// The thing of this word, also of its plural; null if there is none.
const ThingTemplate* FindThing(const Templates& templates, std::string_view word) {
  for (const ThingTemplate& thing : templates.things) {
    const bool plural =
        word.size() == thing.word.size() + 1 && word.ends_with('s') && word.starts_with(thing.word);
    if (word == thing.word || plural || (word == "boxes" && thing.word == "box")) return &thing;
  }
  return nullptr;
}

/// Whether a thing at this place in a name is where something goes.
bool FollowsPreposition(const std::vector<std::string>& words, std::size_t at) {
  while (at > 0 && (Has("a an the", words[at - 1]) || Has(kColors, words[at - 1]))) --at;
  return at > 0 && Has("in into inside on onto over", words[at - 1]);
}

struct NamedThing {
  const ThingTemplate* thing = nullptr;
  std::string name;  ///< with its colour
};

/// What the name speaks of: the first thing that is not where something goes.
NamedThing ThingIn(const Templates& templates, const std::vector<std::string>& words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const ThingTemplate* thing = FindThing(templates, words[i]);
    if (!thing || FollowsPreposition(words, i)) continue;
    const bool colored = i > 0 && Has(kColors, words[i - 1]);
    return {thing, (colored ? words[i - 1] + "_" : "") + thing->word};
  }
  return {};
}

const ThingTemplate& DestinationIn(const std::vector<ThingTemplate>& known,
                                   const std::vector<std::string>& words) {
  for (std::size_t i = 0; i < words.size(); ++i)
    for (const ThingTemplate& destination : known)
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
std::string IgnoredWords(const Templates& templates, const std::vector<std::string>& words,
                         const VerbTemplate* verb, const NamedThing& spoken_of,
                         const ThingTemplate& destination) {
  std::vector<std::string> ignored;
  std::string_view section;
  for (const std::string& word : words) {
    const bool of_verb = verb && (Has(verb->words, word) || Has(verb->also, word) ||
                                  (!verb->destination.empty() && word == destination.word));
    const bool of_thing = spoken_of.thing && (FindThing(templates, word) == spoken_of.thing ||
                                              spoken_of.name.starts_with(word + "_"));
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

using Values = std::map<std::string, std::string>;

/// What the marks of a template stand for.
Values ValuesOf(const NamedThing& of, const ThingTemplate& destination) {
  Values values = {{"destination", destination.word}, {"destination_body", destination.body}};
  if (of.thing) {
    values["thing"] = of.name;
    values["a_thing"] = WithArticle(Spaced(of.name));
    values["body"] = of.thing->body;
  }
  return values;
}

/// `frame` with the parts of the verb; where each line comes from is kept.
void WriteText(const std::string& frame, const VerbTemplate& verb, const Values& values,
               NewScenario& made) {
  const std::map<std::string, const Located<std::string>*> blocks = {{"@expects@", &verb.expects},
                                                                     {"@entities@", &verb.entities},
                                                                     {"@actors@", &verb.actors},
                                                                     {"@script@", &verb.script}};
  std::vector<std::string> grammars;
  for (const Located<std::string>& name : verb.grammar) grammars.push_back(name.value);
  const Values parts = {
      {"shows", Filled(verb.shows.value, values)},
      {"grammar",
       grammars.size() == 1 ? grammars[0] : fmt::format("[{}]", fmt::join(grammars, ", "))},
      {"picture", Filled(verb.picture.value, values)},
      {"camera", verb.camera}};
  const std::map<std::string, grammar::Place> of_keys = {{"shows", verb.shows.where.place},
                                                         {"grammar", verb.grammar[0].where.place},
                                                         {"  - {at", verb.picture.where.place}};
  int line_number = 1;
  std::istringstream in(frame);
  for (std::string line; std::getline(in, line); ++line_number) {
    if (const auto block = blocks.find(line); block != blocks.end()) {
      int line_of_template = block->second->where.place.line;
      std::istringstream lines(Filled(block->second->value, values));
      for (std::string part; std::getline(lines, part); ++line_number) {
        made.text += (part.empty() ? "" : "  ") + part + "\n";
        made.places[line_number] = {.line = ++line_of_template, .column = 0};
      }
      made.text += "\n";
      continue;
    }
    if (const auto of_key = of_keys.find(line.substr(0, line.find(':'))); of_key != of_keys.end())
      made.places[line_number] = of_key->second;
    made.text += Filled(line, parts) + "\n";
  }
}

constexpr const char* kFolder = "scenarios/templates";
constexpr const char* kEnding = ".yaml";
constexpr const char* kThings = "things";
constexpr std::size_t kMostWords = 100, kMostThings = 200, kMostLines_bytes = 20'000;

const std::vector<std::string>& Marks() {
  static const std::vector<std::string> marks = {"thing", "a_thing", "body", "destination",
                                                 "destination_body"};
  return marks;
}

/// The file of each name; the folder of the project comes before the shipped one. Names that no
/// template can do without are there even if their file is missing.
std::map<std::string, std::string> Files(const std::string& root) {
  std::map<std::string, std::string> files;
  for (const std::string& home : {root, ShippedRoot()}) {
    const std::filesystem::path folder = std::filesystem::path(home) / kFolder;
    for (const std::string& name : NamesIn(folder.string(), kEnding))
      files.emplace(name, (folder / (name + kEnding)).string());
  }
  for (const std::string name : {kThings, kDefaultVerb})
    files.emplace(name, (std::filesystem::path(ShippedRoot()) / kFolder / (name + kEnding)));
  return files;
}

/// The place of a character of a text; a text of several lines begins below its key, indented by 2.
Where PlaceIn(const Located<std::string>& text, std::size_t at) {
  Where where = text.where;
  if (text.value.find('\n') == std::string::npos) return where;
  const std::size_t line = text.value.rfind('\n', at) + 1;  // 0 if it is in the first one
  where.place.line +=
      1 + static_cast<int>(
              std::count(text.value.begin(), text.value.begin() + static_cast<long>(at), '\n'));
  where.place.column = static_cast<int>(at - line) + 3;
  return where;
}

/// What is between two '@' is the name of a mark.
void CheckMarks(const Located<std::string>& text, bool has_things, DiagnosticList& errors) {
  std::size_t begin = text.value.find('@');
  while (begin != std::string::npos) {
    const Where where = PlaceIn(text, begin);
    const std::size_t end = text.value.find('@', begin + 1);
    if (end == std::string::npos) return errors.Add(where, "found one '@' without a second");
    const std::string mark = text.value.substr(begin + 1, end - begin - 1);
    if (std::ranges::count(Marks(), mark) == 0)
      errors.AddUnknownName(where, fmt::format("no mark is called '@{}@'", mark), mark, Marks());
    else if (!has_things && !mark.starts_with("destination"))
      errors.Add(where, fmt::format("found '@{}@', but 'things' names none", mark));
    begin = text.value.find('@', end + 1);
  }
}

void CheckVerb(const VerbTemplate& verb, DiagnosticList& errors) {
  for (const Located<std::string>* text :
       {&verb.shows, &verb.picture, &verb.expects, &verb.entities, &verb.actors, &verb.script})
    CheckMarks(*text, !verb.things.empty(), errors);
}

ValueFormat<VerbTemplate> VerbFormat() {
  using V = VerbTemplate;
  const auto words = ListOf(Identifier(), 1, kMostWords);
  const auto names = ListOf(WithPlace(Identifier()), 1, kMostWords);
  const auto lines = Text(kMostLines_bytes);
  return StructFormat<V>("a verb")
      .Required("words", &V::words, words, "Words of a name that mean this verb.")
      .Optional("also", &V::also, words, "Words of which the name must have one, too.")
      .Optional("order", &V::order, Integer(0, 10'000), "Which verb comes first; lower is first.")
      .Optional("things", &V::things, names, "What it is done to; the default comes first.")
      .Optional("destination", &V::destination, Choice(std::vector<std::string>{"in", "on"}),
                "Whether it ends in or on something.")
      .Required("shows", &V::shows, Text(), "What the scenario shows.")
      .Required("grammar", &V::grammar, names, "The grammars.")
      .Required("picture", &V::picture, Text(), "When a picture is taken.")
      .Optional("camera", &V::camera, Identifier(), "From where.")
      .Required("expects", &V::expects, lines, "Claims.")
      .Required("entities", &V::entities, lines, "Entities.")
      .Required("actors", &V::actors, lines, "Actors.")
      .Required("script", &V::script, lines, "Stages.")
      .Check(
          [](const YamlNode&, const V& verb, DiagnosticList& errors) { CheckVerb(verb, errors); })
      .format();
}

struct ThingsYaml {
  std::vector<Named<std::string>> things, in, on;
};

ValueFormat<ThingsYaml> ThingsFormat() {
  using T = ThingsYaml;
  const auto bodies = MapOf(Identifier(), Text(), 1, kMostThings);
  return StructFormat<T>("the things")
      .Required("things", &T::things, bodies, "What fits into a hand.")
      .Required("in", &T::in, bodies, "What something can be put into.")
      .Required("on", &T::on, bodies, "What something can be put onto.")
      .format();
}

template <class T>
Result<T> ReadAs(const ValueFormat<T>& format, const YamlDocument& document) {
  T value;
  DiagnosticList errors(document);
  format.Read(document.root, errors, value);
  if (!errors.empty()) return tl::unexpected(errors.Sorted());
  return value;
}

std::vector<ThingTemplate> Bodies(const std::vector<Named<std::string>>& named) {
  std::vector<ThingTemplate> bodies;
  for (const Named<std::string>& body : named) bodies.push_back({body.name, body.value});
  return bodies;
}

/// Reads the file of a verb, whose things must be among `known`.
Result<VerbTemplate> ReadVerb(const std::string& name, const std::string& path,
                              const std::vector<std::string>& known) {
  PREHEND_TRY(const YamlDocument document, ReadYamlFile(path));
  Result<VerbTemplate> verb = ReadAs(VerbFormat(), document);
  if (!verb) return verb;
  DiagnosticList errors(document);
  for (const Located<std::string>& thing : verb->things)
    if (std::ranges::count(known, thing.value) == 0)
      errors.AddUnknownName(thing.where, fmt::format("no thing is called '{}'", thing.value),
                            thing.value, known);
  if (!errors.empty()) return tl::unexpected(errors.Sorted());
  verb->name = name;
  verb->path = path;
  return verb;
}

}  // namespace

std::string WhyNoVerb(const std::string& verb, const std::vector<std::string>& known) {
  if (verb.empty() || Has(known, verb)) return "";
  const std::string nearest = grammar::NearestName(verb, known);
  return fmt::format("no verb is called '{}'; {}known: {}", verb,
                     nearest.empty() ? "" : fmt::format("did you mean '{}'? ", nearest),
                     fmt::join(known, ", "));
}

NewScenario ComposeScenario(const Templates& templates, std::string_view name,
                            std::string_view wanted) {
  const std::vector<std::string> words = WordsOf(name, '_');
  const VerbTemplate* said =
      wanted.empty() ? VerbIn(templates, words) : &VerbNamed(templates, wanted);
  const VerbTemplate& verb = said ? *said : VerbNamed(templates, kDefaultVerb);
  NewScenario made;
  made.template_path = verb.path;
  if (!said) {
    std::vector<std::string> known;
    for (const VerbTemplate& other : templates.verbs) known.push_back(other.name);
    std::ranges::sort(known);
    made.note =
        fmt::format("the name has no verb that 'new' knows, so this is '{}'; choose by --like: {}",
                    verb.name, fmt::join(known, ", "));
  }
  std::vector<std::string> things;
  for (const Located<std::string>& thing : verb.things) things.push_back(thing.value);
  const NamedThing spoken_of = ThingIn(templates, words);
  NamedThing thing = spoken_of;
  if (!things.empty() && (!thing.thing || !Has(things, thing.thing->word))) {
    const std::string instead = things.front();
    if (said && thing.thing)
      made.note = fmt::format("'{}' is written for {} only, so this is about a {}", verb.name,
                              fmt::join(things, ", "), instead);
    else if (said)
      made.note =
          fmt::format("the name has no thing that 'new' knows, so this is about a {}; known: {}",
                      instead, fmt::join(things, ", "));
    thing = {FindThing(templates, instead), instead};
  }
  const ThingTemplate& destination =
      DestinationIn(verb.destination == "in" ? templates.in : templates.on, words);
  if (wanted.empty()) {
    const std::string ignored = IgnoredWords(templates, words, said, spoken_of, destination);
    if (!ignored.empty()) made.note += (made.note.empty() ? "" : "; ") + ignored;
  }
  const Values values = ValuesOf(thing, destination);
  made.what = Filled(verb.shows.value, values);
  WriteText(templates.frame, verb, values, made);
  return made;
}

grammar::Diagnostic InTemplate(const NewScenario& made, grammar::Diagnostic error) {
  const auto known = made.places.find(error.place.line);
  error.file = made.template_path;
  error.place.line = known == made.places.end() ? 0 : known->second.line;
  if (known != made.places.end() && known->second.column > 0)
    error.place.column = known->second.column;
  return error;
}

std::vector<std::string> VerbNames(const std::string& root) {
  std::vector<std::string> names;
  for (const auto& [name, path] : Files(root))
    if (name != kThings) names.push_back(name);
  return names;
}

Result<Templates> ReadTemplates(const std::string& root) {
  const std::map<std::string, std::string> files = Files(root);
  PREHEND_TRY(const YamlDocument document, ReadYamlFile(files.at(kThings)));
  PREHEND_TRY(const ThingsYaml things, ReadAs(ThingsFormat(), document));
  PREHEND_TRY(
      std::string frame,
      ReadTextFile((std::filesystem::path(ShippedRoot()) / kFolder / "scenario.txt").string()));
  Templates templates{.frame = std::move(frame),
                      .things = Bodies(things.things),
                      .in = Bodies(things.in),
                      .on = Bodies(things.on)};
  std::vector<std::string> known;
  for (const ThingTemplate& thing : templates.things) known.push_back(thing.word);
  for (const auto& [name, path] : files) {
    if (name == kThings) continue;
    PREHEND_TRY(VerbTemplate verb, ReadVerb(name, path, known));
    templates.verbs.push_back(std::move(verb));
  }
  std::ranges::stable_sort(templates.verbs, {}, &VerbTemplate::order);
  return templates;
}

}  // namespace prehend::scenario
