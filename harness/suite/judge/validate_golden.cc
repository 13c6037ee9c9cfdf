// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/judge/validate_golden.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "grammar/base/frame.h"
#include "grammar/contents.h"
#include "harness/base/base/text_file.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/truth/golden/golden.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
namespace {

namespace fs = std::filesystem;

using Names = std::vector<std::string>;

class GoldenValidator {
 public:
  GoldenValidator(std::string_view file, std::string_view text, const episode::LoadedRun& loaded)
      : file_(file),
        text_(text),
        signatures_(EventSignatures(*loaded.program)),
        events_(EventNames(*loaded.program)),
        entity_table_(episode::MakeEntityTable(loaded.scenario)) {
    for (const grammar::EntityInfo& member : entity_table_.entities)
      entities_.push_back(member.name);
  }

  void CheckLine(const truth::GoldenEvent& line) {
    const std::string& event = line.event.event;
    const auto signature = std::ranges::find(signatures_, event, &grammar::EventSignature::name);
    if (signature == signatures_.end())
      return Unknown(line, event, "the grammar has no event '" + event + "'", event, events_);
    for (const grammar::Role& role : line.event.roles) CheckRole(line, *signature, role);
    for (const std::string& role : signature->roles) {
      if (truth::RoleValue(line.event, role).empty())
        Complain(line, event,
                 fmt::format("'{}' has a role '{}', which is missing here", event, role), "");
    }
    const Names& values = signature->attributes;
    for (const grammar::NamedValue& value : line.event.values) {
      if (std::ranges::count(values, value.name) == 0)
        Unknown(line, value.name + "~", fmt::format("'{}' has no value '{}'", event, value.name),
                value.name, values);
    }
  }

  void CheckGrammar(const std::string& grammar, const std::string& watching) {
    if (grammar == watching) return;
    const std::size_t found = text_.find("# grammar: ");
    const auto line = static_cast<int>(std::ranges::count(text_.substr(0, found), '\n')) + 1;
    diagnostics_.push_back(grammar::DiagnosticAt(
        file_, text_, {line, 12},
        fmt::format("this golden is of the grammar '{}', but the scenario uses '{}'", grammar,
                    watching),
        "play it with that grammar and accept the result: prehend accept"));
  }

  grammar::Diagnostics Take() { return std::move(diagnostics_); }

 private:
  void CheckRole(const truth::GoldenEvent& line, const grammar::EventSignature& event,
                 const grammar::Role& role) {
    if (truth::IsAttribute(role)) {
      if (!event.has_style)
        return Complain(line, role.name + "=", fmt::format("'{}' has no style", event.name), "");
      if (std::ranges::count(entity_table_.styles, role.value) == 0)
        Unknown(line, role.name + "=", "no hand of the scenario has the style '" + role.value + "'",
                role.value, entity_table_.styles);
      return;
    }
    if (std::ranges::count(event.roles, role.name) == 0)
      return Unknown(line, role.name + "=",
                     fmt::format("'{}' has no role '{}'", event.name, role.name), role.name,
                     event.roles);
    if (std::ranges::count(entities_, role.value) == 0)
      Unknown(line, role.name + "=", "the scenario has no '" + role.value + "'", role.value,
              entities_);
  }

  void Unknown(const truth::GoldenEvent& line, const std::string& word, std::string message,
               const std::string& name, const Names& known) {
    const std::string near = grammar::NearestName(name, known);
    std::string hint = near.empty() ? "" : "did you mean '" + near + "'?";
    if (near.empty() && !known.empty() && known.size() <= 8) {
      hint = "known:";
      for (const std::string& candidate : known) hint += " " + candidate;
    }
    Complain(line, word, std::move(message), std::move(hint));
  }

  /// At the first place where the word stands by itself.
  void Complain(const truth::GoldenEvent& line, const std::string& word, std::string message,
                std::string hint) {
    std::size_t at = line.as_written.find(word);
    while (at != std::string::npos && at > 0 && line.as_written[at - 1] != ' ' &&
           line.as_written[at - 1] != '\t')
      at = line.as_written.find(word, at + 1);
    const int column = at == std::string::npos ? 1 : static_cast<int>(at) + 1;
    diagnostics_.push_back(grammar::DiagnosticAt(file_, text_, {line.line, column},
                                                 std::move(message), std::move(hint)));
  }

  std::string_view file_, text_;
  const std::vector<grammar::EventSignature> signatures_;
  const Names events_;
  const grammar::EntityTable entity_table_;
  Names entities_;
  grammar::Diagnostics diagnostics_;
};

/// skill/name of the scenario whose golden or proposal is at this path; "" when it is elsewhere.
std::string ScenarioOfGoldenAt(const std::string& path, const std::string& root) {
  std::error_code error;
  const fs::path file = fs::weakly_canonical(path, error);
  for (const char* folder : {"golden", "build/pending"}) {
    const fs::path inside =
        file.lexically_relative(fs::weakly_canonical(fs::path(root) / folder, error));
    if (!inside.empty() && *inside.begin() != "..")
      return fs::path(inside).replace_extension().generic_string();
  }
  return "";
}

}  // namespace

grammar::Diagnostics ValidateGolden(const std::string& path, const std::string& id,
                                    const episode::LoadedRun& loaded) {
  PREHEND_TRY(std::string text, ReadTextFile(path));
  PREHEND_TRY(truth::Golden golden, truth::ReadGolden(path, text));
  grammar::Diagnostics other = truth::OfAnotherScenario(path, text, golden, id);
  if (!other.empty()) return other;
  GoldenValidator checker(path, text, loaded);
  checker.CheckGrammar(golden.grammar, loaded.scenario.grammar);
  for (const truth::GoldenEvent& line : golden.events) checker.CheckLine(line);
  return checker.Take();
}

grammar::Diagnostics ValidateGoldenFile(const std::string& path, const std::string& root,
                                        std::vector<std::string>& inputs) {
  inputs.push_back(path);
  PREHEND_TRY(std::string text, ReadTextFile(path));
  PREHEND_TRY(truth::Golden golden, truth::ReadGolden(path, text));
  const std::string of = ScenarioOfGoldenAt(path, root);
  const std::string& id = of.empty() ? golden.scenario : of;
  const std::vector<episode::ScenarioFile> all = episode::ListScenarios(root);
  const auto scenario = std::ranges::find(all, id, episode::IdOf);
  if (scenario == all.end()) {
    return {grammar::DiagnosticAt(path, text, truth::ScenarioLine(text),
                                  "there is no scenario '" + id + "'",
                                  episode::HintForScenario(all, id))};
  }
  const Result<episode::LoadedRun> loaded =
      episode::LoadRun({.scenario_file = scenario->path}, root, &inputs);
  return loaded ? ValidateGolden(path, id, *loaded) : loaded.error();
}

namespace fs = std::filesystem;

std::vector<UnreferencedGolden> FindUnreferencedGoldens(
    const std::vector<episode::ScenarioFile>& all, const std::string& root) {
  std::set<std::string> known;
  for (const episode::ScenarioFile& file : all) known.insert(episode::IdOf(file));
  const truth::GoldenFiles goldens(root);
  std::map<std::string, std::vector<fs::path>> files;
  for (const std::string& id : goldens.List()) {
    if (!known.contains(id)) files[id].push_back(goldens.GoldenPath(id));
  }
  for (const truth::KeptPicture& picture : goldens.Pictures()) {
    if (!known.contains(picture.scenario)) files[picture.scenario].push_back(picture.path);
  }
  std::vector<UnreferencedGolden> orphans;
  for (auto& [id, paths] : files) orphans.push_back({id, std::move(paths)});
  return orphans;
}

std::string Text(const UnreferencedGolden& orphan) {
  std::string text;
  for (const fs::path& file : orphan.files) {
    text += fmt::format("{} belongs to no scenario: remove it, or bring scenarios/{}.yaml back\n",
                        ReadableName(file.string()), orphan.scenario);
  }
  return text;
}

std::vector<fs::path> UnrequestedPictures(const std::string& scenario, std::size_t asked,
                                          const std::string& root) {
  std::vector<fs::path> unrequested;
  for (const truth::KeptPicture& picture : truth::GoldenFiles(root).PicturesOf(scenario)) {
    if (static_cast<std::size_t>(picture.number) > asked) unrequested.push_back(picture.path);
  }
  return unrequested;
}

std::string UnrequestedText(const fs::path& picture, std::size_t asked) {
  return fmt::format("{} belongs to no picture: the scenario asks for {}",
                     ReadableName(picture.string()),
                     asked == 0 ? std::string("none") : std::to_string(asked));
}

}  // namespace prehend::suite
