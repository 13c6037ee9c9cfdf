// SPDX-License-Identifier: Apache-2.0
#include "harness/scenario/read/read_scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "harness/base/base/project_paths.h"
#include "harness/base/yaml/value_format.h"
#include "harness/scenario/format/scenario_fields.h"
#include "harness/scenario/format/scenario_formats.h"
#include "harness/scenario/read/read_parts.h"
#include "harness/scenario/read/sample_variations.h"
#include "harness/scenario/resolve/resolve.h"
#include "harness/truth/claims/claim.h"

namespace prehend::scenario {
namespace {

using grammar::Diagnostics;
using std::filesystem::path;

/// The same with the paths of files beside the scenario.
std::string GrammarsBeside(const std::string& joined, const std::string& file) {
  std::string all;
  for (const std::string& grammar : SplitGrammars(joined)) {
    const bool is_file = grammar.ends_with(kGrammarEnding);
    if (!all.empty()) all += "+";
    all += is_file ? (path(file).parent_path() / grammar).lexically_normal().string() : grammar;
  }
  return all;
}

void CheckNames(const std::string& file, const ScenarioYaml& entry, const ScenarioLibrary& library,
                DiagnosticList& errors) {
  const std::string stem = path(file).stem().string();
  if (!entry.name.value.empty() && entry.name.value != stem) {
    errors.Add(entry.name.where,
               fmt::format("scenario: the name is '{}', but the file is called '{}'",
                           entry.name.value, path(file).filename().string()),
               "rename one of them");
  }
  for (const std::string& grammar : SplitGrammars(entry.grammar.value)) {
    if (grammar.ends_with(kGrammarEnding)) {
      if (const path beside = path(file).parent_path() / grammar; !std::filesystem::exists(beside))
        errors.Add(entry.grammar.where, fmt::format("grammar: there is no file '{}'", grammar),
                   fmt::format("it was looked for as {}", beside.lexically_normal().string()));
    } else {
      errors.Find({grammar, entry.grammar.where}, "grammar", library.grammars, "grammar");
    }
  }
  const auto check_any = [&](const auto& named) {
    if (named.name == "any")
      errors.Add(named.name_where, "'any': this name stands for everybody, in claims and queries",
                 "choose another name");
  };
  std::ranges::for_each(entry.entities, check_any);
  for (const auto& actor : entry.actors) {
    check_any(actor);
    const bool taken = std::any_of(entry.entities.begin(), entry.entities.end(),
                                   [&](const auto& entity) { return entity.name == actor.name; });
    if (taken)
      errors.Add(actor.name_where,
                 fmt::format("'{}' is already the name of an entity", actor.name));
  }
}

/// The actor's model, or an empty one after an error; errors inside a hand file go to
/// `in_hand_files`.
physics::HandModel FindHand(const std::string& file, const HandActorYaml& actor,
                            const ScenarioLibrary& library, DiagnosticList& errors,
                            Diagnostics& in_hand_files) {
  const Located<std::string>& hand = actor.hand;
  const bool is_file = hand.value.ends_with(".yaml");
  if (!is_file && !errors.Find(hand, "hand", library.hands, "hand")) return {};
  const auto beside = [&](const std::string& other) {
    return (path(file).parent_path() / other).string();
  };
  std::vector<std::string> grasps;
  std::set<path> seen;
  for (const auto& more : actor.grasps) {
    grasps.push_back(beside(more.value));
    if (!seen.insert(path(grasps.back()).lexically_normal()).second)
      errors.Add(more.where, fmt::format("grasps: '{}' is given twice", more.value));
  }
  auto model = library.read_hand(is_file ? beside(hand.value) : hand.value, grasps);
  if (model) return std::move(*model);
  // The error names the file that is wrong. Diagnostics without a place mean that it could not be
  // opened.
  const auto attribute = [&](const char* key, const Located<std::string>& named, bool is_open) {
    errors.Add(named.where, fmt::format("{}: '{}' cannot be used, see below", key, named.value),
               is_open ? "" : "the path is relative to the scenario's folder");
  };
  std::map<std::string, bool> bad;  ///< and whether they could be opened
  for (const grammar::Diagnostic& found : model.error()) bad[found.file] = found.place.line > 0;
  for (std::size_t i = 0; i < grasps.size(); ++i) {
    const auto file_of_grasps = bad.extract(grasps[i]);
    if (file_of_grasps) attribute("grasps", actor.grasps[i], file_of_grasps.mapped());
  }
  if (!bad.empty()) attribute("hand", hand, !is_file || bad.begin()->second);
  in_hand_files.insert(in_hand_files.end(), model.error().begin(), model.error().end());
  return {};
}

std::string SkillOf(const std::string& file) {
  const path folder = path(file).parent_path();
  return folder.parent_path().filename() == "scenarios" ? folder.filename().string() : "";
}

/// "Forearm" of "anna_right_forearm".
std::string ClassOfPart(const std::string& name, const std::string& person) {
  std::string part = name.substr(person.size() + 1);
  for (const char* side : {"right_", "left_"})
    if (part.starts_with(side)) part = part.substr(std::strlen(side));
  // The grammar's `Hand` has fingers, sensors and a script; the one that hangs down has none.
  if (part == "hand") return "RestingHand";
  std::string words;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (part[i] == '_') continue;
    const bool begins = i == 0 || part[i - 1] == '_';
    words +=
        begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(part[i]))) : part[i];
  }
  return words;
}

/// The head stands for the person; her other bodies are parts of it.
void AddPersonClasses(Scenario& scenario) {
  for (std::size_t i = scenario.body_classes.size(); i < scenario.scene.bodies.size(); ++i) {
    const auto& persons = scenario.scene.persons;
    const auto owner =
        std::find_if(persons.rbegin(), persons.rend(),
                     [&](const physics::Person& person) { return person.head.index() <= i; });
    const std::size_t head = owner->head.index();
    const bool is_head = head == i;
    const auto& bodies = scenario.scene.bodies;
    scenario.body_classes.push_back(is_head ? "Person"
                                            : ClassOfPart(bodies[i].name, bodies[head].name));
    scenario.body_part_of.push_back(is_head ? grammar::kNoEntity : owner->head.number());
  }
}

Result<Scenario> AllOf(const DiagnosticList& errors, const Diagnostics& in_other_files) {
  Diagnostics diagnostics = errors.Sorted();
  diagnostics.insert(diagnostics.end(), in_other_files.begin(), in_other_files.end());
  return tl::unexpected(std::move(diagnostics));
}

Result<Scenario> Resolve(const std::string& file, const YamlDocument& document,
                         const ScenarioLibrary& library) {
  DiagnosticList errors(document);
  ScenarioYaml entry;
  const bool well_formed =
      ScenarioFormat().Read(WithoutRepeats(document.root, errors), errors, entry);
  SortActors(entry);
  CheckNames(file, entry, library, errors);
  Diagnostics in_other_files;
  if (!well_formed) {
    // Names can be checked even if other fields are malformed.
    for (const auto& actor : entry.hands) {
      if (!actor.value.hand.value.empty())
        FindHand(file, actor.value, library, errors, in_other_files);
    }
    return AllOf(errors, in_other_files);
  }
  ReadRecordings(file, entry, library, errors, in_other_files);
  Scenario scenario;
  physics::Scene& scene = scenario.scene;
  scene.world.rate_hz = entry.world.rate_hz;
  scene.world.seed = entry.world.seed;
  scene.world.engine = entry.world.engine;
  scene.world.planar = entry.world.planar ? entry.world.planar->value
                                          : entry.world.engine == physics::Engine::kBox2d;
  scene.bodies = PlaceBodies(entry, errors);
  scene.joints = BuildJoints(entry, errors);
  scenario.body_part_of = PartsOf(entry, errors);
  for (const auto& actor : entry.hands) {
    physics::HandModel model = FindHand(file, actor.value, library, errors, in_other_files);
    const bool known = !model.name.empty();
    scene.hands.push_back(known ? PlaceHand(actor, std::move(model), entry.world.rate_hz, errors)
                                : physics::Hand{actor.name, {}, {}});
  }
  AddPersons(entry, scene, errors);
  scenario.script = BuildScript(entry, scene, errors);
  scenario.outcomes = BuildOutcomes(entry.outcomes, scene, scenario.script, errors);
  scenario.expects = ReadClaims(entry.expects, document, errors);
  ValidateClasses(entry, errors);
  ValidateVariations(document, entry.vary, errors);
  if (scene.world.planar) ValidatePlanar(entry, scene, errors);
  if (errors.empty()) ValidateDistances(entry, scene, errors);
  if (errors.empty() && !library.were_played) {
    ValidatePlacement(entry, scene, errors);
    if (errors.empty()) ValidatePutDowns(entry, scene, errors);
  }
  if (!errors.empty()) return AllOf(errors, in_other_files);

  scenario.name = entry.name.value;
  scenario.file = file;
  scenario.skill = SkillOf(file);
  scenario.shows = entry.shows;
  scenario.grammar = GrammarsBeside(entry.grammar.value, file);
  scenario.tags = std::move(entry.tags);
  scenario.sensing = {.sensing_hz = entry.world.sensing_hz,
                      .bearing_share = entry.world.bearing_share,
                      .sensors = entry.sensors};
  for (const auto& entity : entry.entities) {
    scenario.body_classes.push_back(entity.value.class_name.value);
    if (const auto& color = entity.value.color)
      scenario.colors[entity.name] = ColorOfText(color->value).value();
  }
  AddPersonClasses(scenario);
  for (const auto& kind : entry.classes)
    scenario.base_classes.push_back({kind.name, kind.value.value});
  scenario.variations = std::move(entry.vary);
  scenario.pictures = std::move(entry.pictures);
  for (const PictureYaml& picture : scenario.pictures)
    if (WhyNoCamera(scenario, picture.camera.value))
      errors.Find(picture.camera, "camera", CamerasOf(scenario), "camera");
  if (!errors.empty()) return AllOf(errors, in_other_files);
  scenario.warnings = ImplausibleSizes(entry, scene, document);
  std::ranges::move(in_other_files, std::back_inserter(scenario.warnings));
  return scenario;
}

/// What the source has at this place, up to the end of the line.
std::string_view LineFrom(const Where& where, const YamlDocument& document) {
  std::string_view rest = grammar::LineOf(
      document.sources[static_cast<std::size_t>(where.source)].text, where.place.line);
  rest.remove_prefix(std::min(static_cast<std::size_t>(where.place.column - 1), rest.size()));
  return rest;
}

/// Finds out where the letters of a claim stand in the file; returns what stands behind them in the
/// line, if that is known.
std::string_view Locate(truth::Claim& claim, const YamlDocument& document) {
  std::string_view line = LineFrom(claim.where, document);
  const bool quoted = line.starts_with('"') || line.starts_with('\'');
  if (quoted) ++claim.where.place.column;
  line.remove_prefix(quoted ? 1 : 0);
  claim.on_one_line = line.starts_with(claim.text);
  return claim.on_one_line ? line.substr(claim.text.size()) : "";
}

bool HasOpenBracket(std::string_view claim) {
  return std::ranges::count(claim, '(') > std::ranges::count(claim, ')');
}

bool IsBlock(const YamlNode& stage) {
  return stage.kind == YamlNode::Kind::kMapping &&
         (stage.Find("repeat") != nullptr || stage.Find("steps") != nullptr);
}

class Writer {
 public:
  Writer(DiagnosticList& errors, std::vector<YamlNode>& stages)
      : errors_(errors), stages_(stages) {}

  /// False after an error, so that a block inside of a block is reported once.
  bool Add(const std::vector<YamlNode>& stages) {
    for (const YamlNode& stage : stages) {
      if (stages_.size() > kMaxBeats) return true;  // its format reports it
      if (!IsBlock(stage))
        stages_.push_back(stage);
      else if (!AddBlock(stage))
        return false;
    }
    return true;
  }

 private:
  static std::string Remedy(const YamlNode& unknown) {
    if (unknown.kind == YamlNode::Kind::kScalar)
      return "known: repeat, steps; 'repeat: 3' says how often";
    return "what is repeated is a list below 'steps:', like '- repeat: 3' and below it "
           "'steps: [{right_hand: {close_to: 1}}]'";
  }

  bool AddBlock(const YamlNode& block) {
    const YamlNode *count = block.Find("repeat"), *steps = block.Find("steps");
    for (const YamlNode& child : block.children) {
      if (&child == count || &child == steps) continue;
      errors_.Add(child.key_where, fmt::format("unknown key '{}' in a repeated block", child.key),
                  Remedy(child));
      return false;
    }
    if (!count || !steps) {
      errors_.Add(block.where,
                  fmt::format("a repeated block needs '{}'", count ? "steps" : "repeat"),
                  "like {repeat: 3, steps: [..]}");
      return false;
    }
    int times = 0;
    if (!Integer<int>(1, kMaxRepeats).Read(*count, errors_, times)) return false;
    if (steps->kind != YamlNode::Kind::kSequence || steps->children.empty()) {
      errors_.Add(steps->where, "steps: expected a list of stages");
      return false;
    }
    for (int i = 0; i < times; ++i)
      if (!Add(steps->children)) return false;
    return true;
  }

  DiagnosticList& errors_;
  std::vector<YamlNode>& stages_;
};

}  // namespace

Result<Scenario> ReadScenario(const std::string& file, YamlDocument document,
                              const std::vector<std::string>& overrides,
                              const ScenarioLibrary& library) {
  for (const std::string& assignment : overrides) {
    if (auto bad = ApplyOverride(assignment, ScenarioFormat().schema().json(), document);
        !bad.empty())
      return tl::unexpected(std::move(bad));
  }
  Result<Scenario> scenario = Resolve(file, document, library);
  if (!scenario || library.were_played) return scenario;
  Diagnostics unreadable = CheckDraws(
      document, scenario->variations,
      [&](const YamlDocument& varied) { return ErrorsOf(Resolve(file, varied, library)); });
  if (!unreadable.empty()) return tl::unexpected(std::move(unreadable));
  return scenario;
}

Result<Scenario> ReadScenario(const std::string& file, const std::vector<std::string>& overrides,
                              const ScenarioLibrary& library) {
  PREHEND_TRY(YamlDocument document, ReadYamlFile(file));
  return ReadScenario(file, std::move(document), overrides, library);
}

Result<Scenario> ReadScenarioText(const std::string& file, std::string text,
                                  const std::vector<std::string>& overrides,
                                  const ScenarioLibrary& library) {
  PREHEND_TRY(YamlDocument document, ParseYaml(file, std::move(text)));
  return ReadScenario(file, std::move(document), overrides, library);
}

std::vector<truth::Claim> ReadClaims(const std::vector<Located<std::string>>& written,
                                     const YamlDocument& document, DiagnosticList& errors) {
  std::vector<truth::Claim> claims;
  for (auto text = written.begin(); text != written.end(); ++text) {
    auto parsed = truth::ParseClaim(text->value);
    truth::Claim claim = parsed ? std::move(*parsed) : truth::Claim{.text = text->value};
    claim.where = text->where;
    const std::string_view behind = Locate(claim, document);
    if (parsed) {
      claims.push_back(std::move(claim));
    } else if (HasOpenBracket(claim.text) && behind.starts_with(',')) {
      // In a list in brackets YAML ends a claim at its comma.
      std::string whole = claim.text;
      while (HasOpenBracket(whole) && text + 1 != written.end()) whole += ", " + (++text)->value;
      errors.Add(claim.where, "expects: the comma of a claim ends it in '[..]'",
                 "with quotes: \"" + whole + "\", or one claim per line, each after '- '");
    } else {
      errors.Add(truth::PlaceIn(claim, parsed.error().offset), "expects: " + parsed.error().message,
                 parsed.error().hint);
    }
  }
  return claims;
}

YamlNode WithoutRepeats(const YamlNode& scenario, DiagnosticList& errors) {
  YamlNode written = scenario;
  for (YamlNode& child : written.children) {
    if (child.key != "script" || child.kind != YamlNode::Kind::kSequence) continue;
    if (std::ranges::none_of(child.children, IsBlock)) continue;
    const std::vector<YamlNode> stages = std::move(child.children);
    child.children.clear();
    Writer(errors, child.children).Add(stages);
  }
  return written;
}

}  // namespace prehend::scenario
