// SPDX-License-Identifier: Apache-2.0
// Commands about a scenario, one after another. prehend scenario poses: where everything is at a
// moment, as a scenario would say it. prehend scenario schema. Tested by
// tests/program/poses_test.cc and tests/program/command_line_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/project_paths.h"
#include "harness/base/base/text_file.h"
#include "harness/cli/command/command.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/exchange/poses/import_map.h"
#include "harness/scenario/format/scenario_fields.h"
#include "harness/show/pictures/pictures.h"
#include "harness/suite/judge/validate_golden.h"
#include "harness/truth/golden/golden.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Tenths of millimetres and of degrees; no "-0".
double Rounded(double value, double steps) {
  const double rounded = std::round(value * steps) / steps;
  return rounded == 0 ? 0 : rounded;
}

std::string VectorText(const Eigen::Vector3d& v, double steps) {
  return fmt::format("[{:g}, {:g}, {:g}]", Rounded(v.x(), steps), Rounded(v.y(), steps),
                     Rounded(v.z(), steps));
}

std::string PoseText(const physics::Pose& pose) {
  std::string text = "at_m: " + VectorText(pose.p_m, 1e4);
  const std::string rpy = VectorText(physics::ToRollPitchYaw(pose.q), 10);
  if (rpy != "[0, 0, 0]") text += ", rpy_deg: " + rpy;
  return text;
}

Json PoseJson(const physics::Pose& pose) {
  const Eigen::Vector3d rpy_deg = physics::ToRollPitchYaw(pose.q);
  return {{"at_m", {pose.p_m.x(), pose.p_m.y(), pose.p_m.z()}},
          {"rpy_deg", {rpy_deg.x(), rpy_deg.y(), rpy_deg.z()}}};
}

/// The far end of a link: a fingertip, if nothing is fixed to it.
Eigen::Vector3d TipOf(const physics::HandLink& link, const physics::Pose& X_WL) {
  return X_WL * Eigen::Vector3d(link.length_m / 2, 0, 0);
}

/// Links that no other link hangs on.
std::vector<std::size_t> LastLinks(const physics::HandModel& model) {
  std::vector<std::size_t> last;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const bool has_child = std::ranges::any_of(model.links, [&](const physics::HandLink& other) {
      return other.parent == physics::LinkIndex(i);
    });
    if (!has_child) last.push_back(i);
  }
  return last;
}

void PrintPoses(const scenario::Scenario& scenario, const physics::Snapshot& now, double time_s,
                std::ostream& out) {
  const physics::Scene& scene = scenario.scene;
  std::vector<std::vector<std::string>> rows;
  out << fmt::format("# {} at {:.4f} s\n", scenario.name, time_s);
  for (std::size_t h = 0; h < scene.hands.size(); ++h) {
    const physics::HandState& hand = now.hands[h];
    rows.push_back({scene.hands[h].name + ":", "{" + PoseText(hand.palm.X_WB) + "}",
                    fmt::format("# palm; grip {:g}", Rounded(hand.trigger, 1000))});
    rows.push_back({"", "{" + PoseText(hand.X_WTarget) + "}", "# its tracked target"});
    for (const std::size_t i : LastLinks(scene.hands[h].model)) {
      const physics::HandLink& link = scene.hands[h].model.links[i];
      rows.push_back({"", "{at_m: " + VectorText(TipOf(link, hand.X_WL[i]), 1e4) + "}",
                      "# end of " + link.name});
    }
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const physics::Body& body = scene.bodies[i];
    if (body.grains) continue;
    rows.push_back(
        {body.name + ":", "{" + PoseText(now.bodies[i].X_WB) + "}", body.fixed ? "# fixed" : ""});
  }
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const physics::Joint& joint = scene.joints[i];
    if (joint.kind == physics::JointKind::kFixed || joint.kind == physics::JointKind::kBall)
      continue;
    const double range = joint.upper - joint.lower;
    if (!(range > 0)) continue;
    rows.push_back({"", "",
                    fmt::format("# joint of {}: {:.1f} % of its range", scene.body(joint.body).name,
                                100 * (now.joints[i].position - joint.lower) / range)});
  }
  out << truth::AlignColumns(rows);
}

Json PosesJson(const scenario::Scenario& scenario, const physics::Snapshot& now, double time_s) {
  const physics::Scene& scene = scenario.scene;
  Json hands = Json::object(), bodies = Json::object();
  for (std::size_t h = 0; h < scene.hands.size(); ++h) {
    const physics::HandState& hand = now.hands[h];
    Json one = PoseJson(hand.palm.X_WB);
    one["trigger"] = hand.trigger;
    one["target"] = PoseJson(hand.X_WTarget);
    for (const std::size_t i : LastLinks(scene.hands[h].model)) {
      const Eigen::Vector3d tip = TipOf(scene.hands[h].model.links[i], hand.X_WL[i]);
      one["tips"][scene.hands[h].model.links[i].name] = {tip.x(), tip.y(), tip.z()};
    }
    hands[scene.hands[h].name] = std::move(one);
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    bodies[scene.bodies[i].name] = PoseJson(now.bodies[i].X_WB);
  return {{"scenario", scenario.name}, {"time_s", time_s}, {"hands", hands}, {"entities", bodies}};
}

ExitCode RunPoses(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(auto episode, OpenEpisodeOrComplain(options.Text("EPISODE"), options, context));
  const std::string at = options.TextOr("--at", "0");
  if (const auto problem = episode::WhyNoEventTime(at, *episode.program()))
    return Refuse(context, "--at: " + problem->message + "; " + problem->hint);
  PREHEND_TRY(const auto played, PlayOrComplain(std::move(episode), context));
  const episode::RunResult& run = played.run;
  const scenario::Scenario& scenario = played.loaded.scenario;
  const episode::FoundTime moment = episode::FindEventTime(at, run);
  if (!moment.missed.empty())
    context.err << "prehend: warning: " << moment.missed << "; this is the end of the run\n";
  const auto found =
      std::ranges::lower_bound(run.recording, moment.tick, {}, &physics::Snapshot::tick);
  const physics::Snapshot& now = found == run.recording.end() ? run.recording.back() : *found;
  const double time_s = truth::SecondsOf(now.tick, run.timeline.ticks_per_second);
  if (options.Has("--json"))
    context.out << PosesJson(scenario, now, time_s).dump(2) << "\n";
  else
    PrintPoses(scenario, now, time_s, context.out);
  return ExitCode::kAgrees;
}

ExitCode RunSchema(const ParsedOptions& options, const CommandContext& context) {
  context.out << (options.Has("import-map") ? exchange::ImportMapSchema()
                                            : scenario::ScenarioSchema());
  return ExitCode::kAgrees;
}

}  // namespace

Command PosesCommand() {
  return {
      .name = "scenario poses",
      .summary = "Print where hands and things are at a moment, ready to paste",
      .examples =
          {"scenario poses milk_carton_wrap", "scenario poses milk_carton_wrap --at grasping.begin",
           "scenario poses suite.episodes --episode slide/hop_divides_a_slide --at 1.5 --json"},
      .options = {EpisodeArgument(), EpisodeOption(),
                  Value("--at", "TIME", "when: EVENT.begin, EVENT.end, or seconds; default: 0"),
                  GrammarOption(), SettingsOption(), JsonOption()},
      .run = RunPoses};
}

Command SchemaCommand() {
  return {.name = "scenario schema",
          .summary = "Print the JSON Schema of scenario files",
          .examples = {"scenario schema > scenarios/scenario.schema.json",
                       "scenario schema import-map"},
          .options = {Argument("import-map",
                               "that word: the schema of the maps of 'prehend import' "
                               "(docs/motion-capture.md)",
                               OneOf({"import-map"}))},
          .run = RunSchema};
}

// prehend scenario rename. Tested by tests/program/suite_edge_test.cc
namespace {

namespace fs = std::filesystem;

/// The scenario under its new name, and where it is to lie.
struct Renamed {
  episode::ScenarioFile from;
  std::string id, skill, name;
  fs::path path;
};

/// "" or why it cannot have this name.
std::string WhyNotRenamed(const std::string& typed, const std::string& root, Renamed& renamed) {
  const std::size_t slash = typed.find('/');
  renamed.skill = slash == typed.npos ? renamed.from.skill : typed.substr(0, slash);
  renamed.name = slash == typed.npos ? typed : typed.substr(slash + 1);
  renamed.id = episode::ScenarioId(renamed.skill, renamed.name);
  if (!episode::IsScenarioName(renamed.name) ||
      (slash != typed.npos && !episode::IsScenarioName(renamed.skill)))
    return fmt::format(
        "found '{}', wanted NAME or SKILL/NAME of small letters, digits and '_', a letter first",
        typed);
  if (!renamed.from.in_project) return renamed.from.path + " is no scenario of this project";
  if (IsInstalled(root)) return kStaysInstalled;
  renamed.path = fs::path(root) / "scenarios" / renamed.skill / (renamed.name + ".yaml");
  std::error_code error;
  if (fs::exists(renamed.path, error)) return renamed.path.string() + " is there already";
  const truth::GoldenFiles goldens(root);
  if (fs::exists(goldens.GoldenPath(renamed.id), error) || !goldens.PicturesOf(renamed.id).empty())
    return "there is a golden of '" + renamed.id + "' already";
  return "";
}

/// A file whose text names the scenario: a line that begins with `key`.
Result<std::string> WithName(const fs::path& file, const std::string& key, const std::string& from,
                             const std::string& to) {
  Result<std::string> text = ReadTextFile(file.string());
  if (!text) return text;
  for (const std::string quote : {"", "\"", "'"}) {
    const std::string line = key + quote + from + quote;
    const std::size_t at = text->starts_with(line) ? 0 : text->find("\n" + line);
    if (at == std::string::npos) continue;
    text->replace(at + (at == 0 ? 0 : 1), line.size(), key + to);
    return text;
  }
  return tl::unexpected(
      grammar::Diagnostics{{.file = file.string(), .message = "no line '" + key + from + "'"}});
}

/// Moves a file, its new text instead of the old. "" or what went wrong.
std::string Move(const fs::path& from, const fs::path& to, const std::string& text,
                 const CommandContext& context) {
  std::string problem = WriteTextFile(to, text);
  std::error_code error;
  if (problem.empty() && !fs::remove(from, error)) problem = from.string() + ": cannot be removed";
  if (problem.empty()) context.out << from.string() << " -> " << to.string() << "\n";
  return problem;
}

ExitCode RunRename(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(const auto found, FindScenarioOrComplain(options.Text("OLD"), context));
  Renamed renamed{.from = found, .skill = {}, .name = {}};
  std::string problem = WhyNotRenamed(options.Text("NEW"), context.root, renamed);
  if (!problem.empty()) return Refuse(context, problem);
  const std::string id = episode::IdOf(found);
  const auto text = WithName(found.path, "scenario: ", found.name, renamed.name);
  if (!text) return Complain(context, text.error());
  const truth::GoldenFiles goldens(context.root);
  const fs::path golden = goldens.GoldenPath(id);
  std::error_code error;
  const bool has_golden = fs::exists(golden, error);
  const auto golden_text =
      has_golden ? WithName(golden, "# scenario: ", id, renamed.id) : Result<std::string>("");
  if (!golden_text) return Complain(context, golden_text.error());
  // What it names beside itself may not be beside its new place.
  problem = WriteTextFile(renamed.path, *text);
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  const auto loaded = episode::LoadRun({renamed.path.string(), "", {}}, context.root);
  fs::remove(renamed.path, error);
  if (!loaded && episode::LoadRun({found.path, "", {}}, context.root))
    return Complain(context, loaded.error());
  problem = Move(found.path, renamed.path, *text, context);
  if (problem.empty() && has_golden)
    problem = Move(golden, goldens.GoldenPath(renamed.id), *golden_text, context);
  bool has_pictures = false;
  for (const truth::KeptPicture& picture : goldens.PicturesOf(id)) {
    const std::string name =
        renamed.name + picture.path.filename().string().substr(found.name.size());
    const fs::path to = goldens.PicturePath(renamed.id, name);
    fs::create_directories(to.parent_path(), error);
    const std::string things = show::ThingsFile(picture.path.string());
    for (const auto& [file, place] :
         {std::pair(picture.path, to),
          std::pair(fs::path(things), fs::path(show::ThingsFile(to.string())))}) {
      if (file == things && !fs::exists(file, error)) continue;
      fs::rename(file, place, error);
      if (error && problem.empty()) problem = place.string() + ": " + error.message();
      if (!error) context.out << file.string() << " -> " << place.string() << "\n";
    }
    has_pictures = true;
  }
  if (has_pictures)
    context.out << "a picture without a caption of its own shows the name: if check finds that it "
                   "differs, "
                << suite::AcceptPicturesCommand(renamed.id) << "\n";
  goldens.RemovePending(id);
  return problem.empty() ? ExitCode::kAgrees : Complain(context, ExitCode::kFailure, problem);
}

}  // namespace

Command RenameCommand() {
  return {.name = "scenario rename",
          .summary = "Give a scenario another name: its file, golden, pictures and reasons move",
          .examples = {"scenario rename milk_carton_wrap milk_is_carried",
                       "scenario rename milk_carton_wrap carry/milk"},
          .options = {Required(Argument("OLD", "a name or skill/name")),
                      Required(Argument("NEW", "a name, in the same folder, or skill/name"))},
          .run = RunRename};
}

}  // namespace prehend::cli
