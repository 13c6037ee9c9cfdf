// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/format/scenario_fields_test.cc,
// tests/harness/scenario/read/sample_variations_test.cc and
// tests/harness/episode/run/outcome_test.cc
#include "harness/scenario/format/scenario_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "harness/base/base/number_text.h"
#include "harness/base/yaml/located_yaml.h"
#include "harness/base/yaml/struct_format.h"
#include "harness/base/yaml/yaml_scalar.h"
#include "harness/scenario/format/scenario_formats.h"

namespace prehend::scenario {
namespace {

ValueFormat<WorldYaml> WorldFormat() {
  using W = WorldYaml;
  using physics::Engine;
  return StructFormat<W>("the world")
      .Optional("engine", &W::engine,
                Choice<Engine>({{"bullet", Engine::kBullet},
                                {"box2d", Engine::kBox2d},
                                {"bullet_stock", Engine::kBulletStock}}),
                "The physics engine. box2d is planar; bullet_stock is Bullet without this "
                "project's changes, to compare.")
      .Optional(
          "planar", &W::planar, Flag(),
          "Everything stays in the plane y = 0; always true with box2d, default false otherwise.")
      .Optional("rate_hz", &W::rate_hz, Integer<int>(60, 4800),
                "Ticks (updates of the physics) per second.")
      .Optional("sensing_hz", &W::sensing_hz, Integer<int>(1, 4800),
                "Frames per second that the grammar sees, at most rate_hz.")
      .Optional("bearing_share", &W::bearing_share, Number(0, 0.5),
                "A contact point with a smaller share of the load between two bodies is not "
                "counted as support.")
      .Optional("seed", &W::seed, Integer<std::uint64_t>(0, std::uint64_t{1} << 53),
                "Seed of all randomness.")
      .Check([](const YamlNode&, const W& world, DiagnosticList& errors) {
        if (world.engine != Engine::kBox2d || !world.planar || world.planar->value) return;
        errors.Add(world.planar->where, "planar: engine box2d is always planar",
                   "planar: true, or engine: bullet");
      })
      .Check([](const YamlNode& node, const W& world, DiagnosticList& errors) {
        if (world.sensing_hz <= world.rate_hz) return;
        const std::string sensing = std::to_string(world.sensing_hz),
                          rate = std::to_string(world.rate_hz);
        if (const YamlNode* written = node.Find("sensing_hz")) {
          errors.Add(written->where, "sensing_hz " + sensing + " is above rate_hz " + rate);
        } else {
          errors.Add(
              node.Find("rate_hz")->where,
              "rate_hz " + rate + " is below sensing_hz, which is " + sensing + " unless given",
              "add sensing_hz: " + rate);
        }
      })
      .format();
}

ValueFormat<SensorSettings> SensorsFormat() {
  using S = SensorSettings;
  return StructFormat<S>("the sensors")
      .Optional("position_noise_m", &S::position_noise_m, Number(0, 0.1),
                "Standard deviation of each coordinate of a sensed pose.")
      .Optional("rotation_noise_deg", &S::rotation_noise_deg, Number(0, 45),
                "Standard deviation of each component of a sensed pose's rotation vector.")
      .Optional("contact_dropout_share", &S::contact_dropout_share, Number(0, 0.95),
                "Share of the touches in each frame that are not sensed.")
      .Optional("lost_frames_share", &S::lost_frames_share, Number(0, 0.95),
                "Share of the frames that are lost.")
      .Optional("seed", &S::seed, Integer<std::uint64_t>(0, std::uint64_t{1} << 53),
                "Seed of the sensors' randomness.")
      .format();
}

constexpr std::size_t kMaxClasses = 100;

ValueFormat<std::string> ClassName() {
  return Word("[A-Z][A-Za-z0-9]*", "a class name like 'MilkCarton'");
}

/// An event's boundary or a time; PictureYaml keeps both as text.
ValueFormat<std::string> MomentFormat() {
  const auto seconds = Number(0, kMaxDuration_s);
  const auto boundary =
      Word("[a-z][a-z0-9_]*\\.(begin|end)", "a time in seconds, or an event like 'reaching.begin'");
  return ValueFormat<std::string>(
      AnyOf({seconds.schema(), boundary.schema()}),
      [=](const YamlNode& node, DiagnosticList& errors, std::string& moment) {
        double time_s = 0;
        const bool is_time = node.kind == YamlNode::Kind::kScalar && MeaningOf(node).number;
        if (!is_time) return boundary.Read(node, errors, moment);
        moment = node.text;
        return seconds.Read(node, errors, time_s);
      });
}

ValueFormat<PictureYaml> PictureFormat() {
  return StructFormat<PictureYaml>("a picture")
      .Required("at", &PictureYaml::at, MomentFormat(),
                "When: an event's 'begin' or 'end', or seconds.")
      .Optional("camera", &PictureYaml::camera, Identifier(),
                "From where: front, left, right, top, three_quarter; hand, action or body, which "
                "are nearer to what they name; or an entity that is a camera.")
      .format();
}

/// Names, or files beside the scenario.
ValueFormat<std::string> GrammarsFormat() {
  return OneOrJoined(Word("[a-z][a-z0-9_]*|\\./[A-Za-z0-9_./-]*[a-z][a-z0-9_]*\\.grammar",
                          "a name like 'pick_and_place', or a file like './kitchen.grammar'", 255))
      .ShownAs(Identifier());
}

/// In the schema steps and stages are defined once, and a stage may also be a block that is
/// repeated; see harness/scenario/read/read_parts.h.
void DefineScript(Json& schema) {
  Json& items = schema["properties"]["script"]["items"];
  Json stage = items;
  Json& one_or_several = stage["additionalProperties"]["anyOf"];
  const Json step = one_or_several[0];
  one_or_several[0] = one_or_several[1]["items"] = {{"$ref", "#/$defs/step"}};
  const Json block = {
      {"type", "object"},
      {"description", "The stages of 'steps', so often."},
      {"additionalProperties", false},
      {"required", {"repeat", "steps"}},
      {"properties",
       {{"repeat", {{"type", "integer"}, {"minimum", 1}, {"maximum", kMaxRepeats}}},
        {"steps", {{"type", "array"}, {"minItems", 1}, {"items", {{"$ref", "#/$defs/stage"}}}}}}}};
  items = {{"$ref", "#/$defs/stage"}};
  schema["$defs"] = {{"step", step}, {"stage", {{"anyOf", {stage, block}}}}};
}

ValueFormat<ScenarioYaml> BuildScenarioFormat() {
  using S = ScenarioYaml;
  return StructFormat<S>("the scenario")
      .Required("scenario", &S::name, Identifier(), "Its name: that of the file without '.yaml'.")
      .Required("shows", &S::shows, Text(), "One sentence: what happens and what it proves.")
      .Optional("expects", &S::expects, ListOf(WithPlace(Text(kMaxClaimLength)), 0, kMaxClaims),
                "What must be recognised, as claims: 'no sliding', 'one grasping(hand, milk)'.")
      .Optional("grammar", &S::grammar, GrammarsFormat(),
                "The grammar that segments the episode, from grammar/library, or a file beside the "
                "scenario; or a list of them.")
      .Optional("tags", &S::tags, ListOf(Identifier(), 0, 32), "Words to select scenarios by.")
      .Optional("world", &S::world, WorldFormat(), "Engine, rates and seed.")
      .Optional("sensors", &S::sensors, SensorsFormat(),
                "Errors of what the grammar sees; the physics has none.")
      .Required("entities", &S::entities, MapOf(Identifier(), EntityFormat(), 1, kMaxEntities),
                "The entities, by name.")
      .Optional("classes", &S::classes, MapOf(ClassName(), WithPlace(ClassName()), 0, kMaxClasses),
                "Classes and their base classes: {Cup: Container}.")
      .Optional("actors", &S::actors, MapOf(Identifier(), ActorFormat(), 0, kMaxActors),
                "The hands and persons, by name.")
      .Optional("script", &S::script, ListOf(StageFormat(), 0, kMaxBeats),
                "What the actors do: stages, one after another; in a stage one step per named "
                "actor, or a list of steps.")
      .Optional("settle_s", &S::settle_s, Number(0, 60), "Time simulated after the last stage.")
      .Optional("vary", &S::vary, ListOf(VariationFormat(), 0, kMaxVariations),
                "What differs from trial to trial of 'prehend run --trials'.")
      .Optional("outcomes", &S::outcomes, MapOf(Identifier(), OutcomeFormat(), 0, kMaxOutcomes),
                "How a trial can end, by name; the first is the desired one.")
      .Optional("pictures", &S::pictures, ListOf(PictureFormat(), 0, kMaxPictures),
                "Which pictures are drawn.")
      .format();
}

/// A text, or a number or flag as written: a value that a field can be set to.
ValueFormat<std::string> Value() {
  const ValueFormat<std::string> text = Text();
  return ValueFormat<std::string>(
      []() -> Json {
        return {{"type", {"string", "number", "boolean"}}};
      },
      [text](const YamlNode& node, DiagnosticList& errors, std::string& value) {
        const bool plain = node.kind == YamlNode::Kind::kScalar &&
                           (NumberOf(node) || node.text == "true" || node.text == "false");
        if (!plain) return text.Read(node, errors, value);
        value = node.text;
        return true;
      });
}

/// Reports conditions that can never hold, or always do.
void CheckCondition(const YamlNode& node, const ConditionYaml& wanted, DiagnosticList& errors) {
  const auto report = [&](const char* key, const std::string& message) {
    errors.Add(node.Find(key)->where, std::string(key) + ": " + message);
  };
  const auto nothing_between = [&](const char* above, const std::optional<double>& least,
                                   const char* below, const std::optional<double>& most) {
    if (least && most && *least >= *most)
      report(below, fmt::format("no value lies between '{}' and '{}'", above, below));
  };
  nothing_between("above_m", wanted.above_m, "below_m", wanted.below_m);
  nothing_between("tilt_above_deg", wanted.tilt_above_deg, "tilt_below_deg", wanted.tilt_below_deg);
  nothing_between("joint_above", wanted.joint_above, "joint_below", wanted.joint_below);
  if (node.Find("within_m") && !wanted.near_m) report("within_m", "there is no 'near_m'");
  if (node.Find("share") && !wanted.inside) report("share", "there is no 'inside'");
  const auto says_nothing = [](const YamlNode& field) {
    return field.key == "entity" || field.key == "at_s";
  };
  if (std::ranges::all_of(node.children, says_nothing))
    errors.Add(node.where, "this condition always holds",
               "add a requirement, for example above_m: 0.9");
}

ValueFormat<ConditionYaml> ConditionFormat() {
  using C = ConditionYaml;
  const auto height = Number(-kMaxDistance_m, kMaxDistance_m);
  const auto angle = Number(0, 180);
  const auto fraction = Number(0, 1);
  return StructFormat<C>("a condition")
      .Required("entity", &C::entity, Identifier(), "The entity that it is about.")
      .Optional("at_s", &C::at_s, Number(0, kMaxDuration_s), "When; default: when the run ends.")
      .Optional("near_m", &C::near_m, ListOf(height, 2, 3),
                "Its centre is near [x, y] or [x, y, z] ...")
      .Optional("within_m", &C::within_m, Number(0, kMaxDistance_m), "... as near as this.")
      .Optional("above_m", &C::above_m, height, "Its centre is higher than this.")
      .Optional("below_m", &C::below_m, height, "Its centre is lower than this.")
      .Optional("tilt_below_deg", &C::tilt_below_deg, angle,
                "It is tilted less than this since it was placed.")
      .Optional("tilt_above_deg", &C::tilt_above_deg, angle,
                "It is tilted more than this since it was placed.")
      .Optional("slower_than_m_per_s", &C::slower_than_m_per_s, Number(0, 100),
                "It moves slower than this.")
      .Optional("joint_above", &C::joint_above, fraction,
                "Its joint is above this fraction of its range.")
      .Optional("joint_below", &C::joint_below, fraction,
                "Its joint is below this fraction of its range.")
      .Optional("inside", &C::inside, Identifier(),
                "Its centre is in the bounding box of this entity.")
      .Optional("share", &C::share, fraction, "Of grains: at least this share of them is inside.")
      .Check(CheckCondition)
      .format();
}

// Only the values that change are written anew, at the places where they stand.

namespace fs = std::filesystem;

/// Quoted if some YAML reader would not read a string: `on`, `no`, `null`.
std::string YamlWord(const std::string& value) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-";
  YamlNode plain;
  plain.kind = YamlNode::Kind::kScalar;
  plain.text = value;
  if (value.find_first_not_of(kPlain) == std::string::npos && value != "null" &&
      MeaningOf(plain).string)
    return value;
  return InQuotes(value);
}

/// Where a place begins in the text.
std::size_t OffsetOf(grammar::Place place, const std::string& text) {
  std::size_t offset = 0;
  for (int line = 1; line < place.line; ++line) offset = text.find('\n', offset) + 1;
  return offset + static_cast<std::size_t>(place.column) - 1;
}

/// How long a scalar is in the text, quotes and all.
std::size_t LengthAt(std::size_t offset, const YamlNode& node, const std::string& text) {
  if (!node.quoted) return node.text.size();
  const char quote = text[offset];
  std::size_t end = offset + 1;
  while (end < text.size() && text[end] != quote) end += quote == '"' && text[end] == '\\' ? 2 : 1;
  return end + 1 - offset;
}

/// Calls `visit` for every file beside the scenario that is named, in the order of the text.
void ForEachFile(const YamlNode& node, const std::function<void(const YamlNode&)>& visit) {
  const bool is_hand_file = node.key == "hand" && node.text.ends_with(".hand.yaml");
  const bool is_grasp_file = node.text.ends_with(".grasps.yaml");
  if (node.kind == YamlNode::Kind::kScalar &&
      (node.key == "recording" || is_hand_file || is_grasp_file))
    visit(node);
  for (const YamlNode& child : node.children) ForEachFile(child, visit);
}

struct Edit {
  const YamlNode* node;
  std::string value;
};

}  // namespace

ValueFormat<std::string> OneOrJoined(const ValueFormat<std::string>& one) {
  constexpr std::size_t kMaxGrammars = 16;
  const auto several = ListOf(one, 1, kMaxGrammars);
  const auto read = [one, several](const YamlNode& node, DiagnosticList& errors,
                                   std::string& value) {
    if (node.kind != YamlNode::Kind::kSequence) return one.Read(node, errors, value);
    std::vector<std::string> names;
    if (!several.Read(node, errors, names)) return false;
    value = fmt::format("{}", fmt::join(names, "+"));
    return true;
  };
  return ValueFormat<std::string>(AnyOf({one.schema(), several.schema()}), read);
}

const ValueFormat<ScenarioYaml>& ScenarioFormat() {
  static const ValueFormat<ScenarioYaml> format = BuildScenarioFormat();
  return format;
}

std::string ScenarioSchema() {
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", "prehend scenario, version 1"},
                 {"description",
                  "Generated by 'prehend scenario schema'. The reader checks more: see "
                  "docs/scenario-format.md."}};
  schema.update(ScenarioFormat().schema().json());
  DefineScript(schema);
  return schema.dump(1) + "\n";
}

ValueFormat<VariationYaml> VariationFormat() {
  using V = VariationYaml;
  const auto range = Vector<2>(-kMaxNumber, kMaxNumber);
  return StructFormat<V>("a variation")
      .Required(
          "fields", &V::fields,
          ListOf(Word("[a-z0-9_]+(\\.[a-z0-9_]+)*", "a field like 'entities.milk.mass_kg'", 255), 1,
                 64),
          "The fields that get the same draw, written as for --set.")
      .Optional("uniform", &V::uniform, range, "Uniform in [min, max].")
      .Optional("normal", &V::normal, range, "Normal with [mean, standard deviation].")
      .Optional("plus", &V::plus, range, "The written value plus a uniform draw from [min, max].")
      .Optional("times", &V::times, range,
                "The written value times a uniform draw from [min, max].")
      .Optional("choose", &V::choose, ListOf(Value(), 1, 64), "One of these values.")
      .ExactlyOneOf({"uniform", "normal", "plus", "times", "choose"})
      .Check([](const YamlNode& node, const V& variation, DiagnosticList& errors) {
        for (const char* key : {"uniform", "plus", "times"}) {
          const YamlNode* written = node.Find(key);
          if (!written) continue;
          const auto& given = variation.uniform ? variation.uniform
                              : variation.plus  ? variation.plus
                                                : variation.times;
          if ((*given)[0] != (*given)[1]) CheckLeastMost(key, *given, written->where, errors);
        }
        if (variation.normal && (*variation.normal)[1] < 0)
          errors.Add(node.Find("normal")->where,
                     fmt::format("normal: expected [mean, deviation] with a deviation of at least "
                                 "0, found [{}, {}]",
                                 (*variation.normal)[0], (*variation.normal)[1]));
      })
      .format();
}

ValueFormat<std::vector<ConditionYaml>> OutcomeFormat() { return ListOf(ConditionFormat(), 1, 32); }

Result<std::string> CopyOfScenario(const fs::path& from, const std::string& text,
                                   const fs::path& to) {
  PREHEND_TRY(const YamlDocument document, ParseYaml(from.string(), text));
  std::vector<Edit> edits;
  if (const YamlNode* name = document.root.Find("scenario");
      name && name->kind == YamlNode::Kind::kScalar)
    edits.push_back({name, to.stem().string()});
  const fs::path old_folder = fs::absolute(from).lexically_normal().parent_path();
  const fs::path new_folder = fs::absolute(to).lexically_normal().parent_path();
  ForEachFile(document.root, [&](const YamlNode& node) {
    const fs::path file = node.text;
    if (old_folder == new_folder || file.is_absolute()) return;
    edits.push_back({&node, (old_folder / file).lexically_relative(new_folder).generic_string()});
  });
  std::string copy = text;
  for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit) {
    const std::size_t offset = OffsetOf(edit->node->where.place, copy);
    copy.replace(offset, LengthAt(offset, *edit->node, copy), YamlWord(edit->value));
  }
  return copy;
}

}  // namespace prehend::scenario
