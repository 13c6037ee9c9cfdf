// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include "harness/base/base/project_paths.h"
#include "harness/base/base/text_file.h"
#include "harness/base/yaml/struct_format.h"
#include "harness/scenario/templates/new_scenario.h"

namespace prehend::scenario {
namespace {

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
  const Result<YamlDocument> document = ReadYamlFile(path);
  if (!document) return tl::unexpected(document.error());
  Result<VerbTemplate> verb = ReadAs(VerbFormat(), *document);
  if (!verb) return verb;
  DiagnosticList errors(*document);
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

std::vector<std::string> VerbNames(const std::string& root) {
  std::vector<std::string> names;
  for (const auto& [name, path] : Files(root))
    if (name != kThings) names.push_back(name);
  return names;
}

Result<Templates> ReadTemplates(const std::string& root) {
  const std::map<std::string, std::string> files = Files(root);
  const Result<YamlDocument> document = ReadYamlFile(files.at(kThings));
  if (!document) return tl::unexpected(document.error());
  const Result<ThingsYaml> things = ReadAs(ThingsFormat(), *document);
  if (!things) return tl::unexpected(things.error());
  Result<std::string> frame =
      ReadTextFile((std::filesystem::path(ShippedRoot()) / kFolder / "scenario.txt").string());
  if (!frame) return tl::unexpected(frame.error());
  Templates templates{.frame = std::move(*frame),
                      .verbs = {},
                      .things = Bodies(things->things),
                      .in = Bodies(things->in),
                      .on = Bodies(things->on)};
  std::vector<std::string> known;
  for (const ThingTemplate& thing : templates.things) known.push_back(thing.word);
  for (const auto& [name, path] : files) {
    if (name == kThings) continue;
    Result<VerbTemplate> verb = ReadVerb(name, path, known);
    if (!verb) return tl::unexpected(verb.error());
    templates.verbs.push_back(std::move(*verb));
  }
  std::ranges::stable_sort(templates.verbs, {}, &VerbTemplate::order);
  return templates;
}

}  // namespace prehend::scenario
