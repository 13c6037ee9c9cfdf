// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/check/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include "grammar/describe.h"
#include "harness/base/base/number_text.h"
#include "harness/base/base/text_file.h"
#include "harness/base/yaml/located_yaml.h"
#include "harness/suite/judge/judges.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
namespace {

constexpr std::size_t kMostValues = 5000;
constexpr std::size_t kLongestValue = 60;

using Values = std::map<std::string, std::string>;

/// "[0, 0, 0.74]" of a list of scalars; "" of anything else.
std::string ListText(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kSequence) return "";
  std::vector<std::string> texts;
  for (const YamlNode& child : node.children) {
    if (child.kind != YamlNode::Kind::kScalar) return "";
    texts.push_back(child.text);
  }
  const std::string text = fmt::format("[{}]", fmt::join(texts, ", "));
  return text.size() <= kLongestValue ? text : "";
}

void AddValues(const YamlNode& node, const std::string& path, Values& values) {
  if (values.size() >= kMostValues) return;
  const std::string list = ListText(node);
  if (node.children.empty() || !list.empty()) {
    values[path] = list.empty() ? node.text : list;
    return;
  }
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    const YamlNode& child = node.children[i];
    const std::string step = node.kind == YamlNode::Kind::kSequence ? std::to_string(i) : child.key;
    AddValues(child, path.empty() ? step : path + "." + step, values);
  }
}

/// Of files that are no grammar, and no YAML, there is nothing to say.
void AddText(const std::string& path, const Result<std::string>& text, Values& values) {
  if (!text) return;
  if (path.ends_with(".grammar")) values.merge(GrammarSettings(*text));
  if (!path.ends_with(".yaml")) return;
  if (const auto document = ParseYaml(path, *text)) AddValues(document->root, "", values);
}

void AddFile(const std::string& path, Values& values) {
  if (path.ends_with(".grammar") || path.ends_with(".yaml"))
    AddText(path, ReadTextFile(path), values);
}

/// What stands after the '=' of a declaration in these lines, or "".
std::string AsWritten(const std::string& text, const grammar::ProgramParam& param) {
  const std::string_view line = grammar::LineOf(text, param.place.line);
  const std::size_t equals = line.find('=');
  if (equals == std::string::npos || line.find(param.name) > equals) return "";
  return std::string(Trimmed(line.substr(equals + 1, line.find('#') - equals - 1)));
}

/// As people wrote it: "30 cm", which is 0.3 m.
std::string ParameterText(const grammar::ProgramParam& param, const episode::RunRequest& request,
                          std::map<std::string, std::string>& texts) {
  for (const std::string& setting : request.settings)
    if (setting.starts_with(param.name + "=")) return setting.substr(param.name.size() + 1);
  const auto [text, is_new] = texts.try_emplace(param.file);
  if (is_new) text->second = ReadTextFile(param.file).value_or("");
  const std::string written = AsWritten(text->second, param);
  return written.empty() ? grammar::QuantityText(param.value) : written;
}

/// A long text is of no use in a line.
std::string Shortened(const std::string& value) {
  return value.size() <= kLongestValue ? value : value.substr(0, kLongestValue) + "..";
}

/// What a file was called. Those of an episode are read from copies, in FOLDER/project or, of what
/// is elsewhere, in FOLDER/outside; the scenario's tells where that is.
std::string Called(const std::string& file, const episode::LoadedRun& loaded) {
  const std::string read = loaded.document.sources.empty() ? "" : loaded.document.sources[0].name;
  const std::string& called = loaded.scenario.file;
  if (read == called || !read.ends_with(called)) return file;
  const std::string folder = read.substr(0, read.rfind('/', read.size() - called.size() - 2));
  if (file.starts_with(folder + "/project/")) return file.substr(folder.size() + 9);
  return file.starts_with(folder + "/outside/") ? file.substr(folder.size() + 8) : file;
}

constexpr std::size_t kMostUndone = 8;
constexpr std::size_t kMostNamed = 4;

/// The same difference is not there any more.
bool IsGone(const truth::Pairing& difference, const truth::Comparison& without) {
  if (difference.expected) {
    return std::ranges::any_of(without.pairings, [&](const truth::Pairing& pairing) {
      return pairing.agreement == truth::LineVerdict::kMatched &&
             pairing.golden_line == difference.golden_line;
    });
  }
  return std::ranges::none_of(without.pairings, [&](const truth::Pairing& pairing) {
    return pairing.agreement != truth::LineVerdict::kMatched && pairing.actual &&
           pairing.actual->event == difference.actual->event &&
           pairing.actual->interval.begin == difference.actual->interval.begin;
  });
}

bool BeginMovedMost(const truth::Pairing& pairing) {
  return std::abs(pairing.begin_offset) >= std::abs(pairing.end_offset);
}

/// "begins later", "begins and ends earlier", "ends earlier (and begins later)", "missing",
/// "object: milk -> cup". What moved most comes first: its shift is told.
std::string WhatDiffers(const truth::Pairing& pairing) {
  if (pairing.agreement == truth::LineVerdict::kChanged && !pairing.changes.empty())
    return fmt::format("{}", fmt::join(pairing.changes, ", "));
  if (pairing.agreement == truth::LineVerdict::kRelabelled && pairing.actual)
    return "recognised as " + pairing.actual->event;
  if (pairing.agreement != truth::LineVerdict::kShifted)
    return std::string(Name(pairing.agreement));
  const auto moved = [&](grammar::Tick offset) { return std::abs(offset) > pairing.tolerance; };
  const auto direction = [](grammar::Tick offset) { return offset > 0 ? "later" : "earlier"; };
  const bool begin = moved(pairing.begin_offset), end = moved(pairing.end_offset);
  if (begin && end && (pairing.begin_offset > 0) == (pairing.end_offset > 0))
    return fmt::format("begins and ends {}", direction(pairing.begin_offset));
  const std::string begins = fmt::format("begins {}", direction(pairing.begin_offset)),
                    ends = fmt::format("ends {}", direction(pairing.end_offset));
  if (begin && end)
    return BeginMovedMost(pairing) ? begins + " (and " + ends + ")"
                                   : ends + " (and " + begins + ")";
  return begin ? begins : ends;
}

Attribution Described(const truth::Pairing& pairing, grammar::Tick ticks_per_second) {
  const bool is_shift = pairing.agreement == truth::LineVerdict::kShifted;
  const grammar::Tick most = BeginMovedMost(pairing) ? pairing.begin_offset : pairing.end_offset;
  return {.event = pairing.event().event,
          .what = WhatDiffers(pairing),
          .shift_ms = is_shift ? truth::MillisecondsOf(most, ticks_per_second) : 0,
          .question = truth::QuestionAbout(pairing, ticks_per_second)};
}

/// "`milk.mass_kg` 0.4 -> 8 in slide/x.yaml", of at most so many.
std::string ListOf(const std::vector<const SettingChange*>& changes) {
  std::string text;
  for (std::size_t i = 0; i < changes.size() && i < kMostNamed; ++i) {
    const bool last_of_file =
        i + 1 >= std::min(changes.size(), kMostNamed) || changes[i + 1]->file != changes[i]->file;
    text += (i == 0 ? "" : ", ") + ChangeText(*changes[i]) +
            (last_of_file ? " in " + changes[i]->file : "");
  }
  if (changes.size() > kMostNamed) text += fmt::format(" and {} more", changes.size() - kMostNamed);
  return text;
}

/// What nothing explains that could be undone.
std::string OtherCause(const PossibleCauses& possible) {
  std::vector<const SettingChange*> fields, clauses;
  for (const SettingChange& change : possible.changes) {
    if (change.of == SettingChange::Of::kField) fields.push_back(&change);
    if (change.of == SettingChange::Of::kClause) clauses.push_back(&change);
  }
  if (possible.motion_differs && !fields.empty()) return ListOf(fields);
  fields.insert(fields.begin(), clauses.begin(), clauses.end());
  return possible.other_changes.empty()
             ? ListOf(fields)
             : fmt::format("{}", fmt::join(possible.other_changes, ", "));
}

/// Each change of the grammar by itself, then all of a rule, then all.
std::vector<std::vector<const SettingChange*>> ToUndo(const PossibleCauses& possible) {
  std::vector<const SettingChange*> of_grammar;
  for (const SettingChange& change : possible.changes) {
    const bool is_whole = change.before.empty() || change.after.empty();
    if (change.of == SettingChange::Of::kField || of_grammar.size() >= kMostUndone) continue;
    if (change.of == SettingChange::Of::kClause || !is_whole) of_grammar.push_back(&change);
  }
  std::vector<std::vector<const SettingChange*>> sets;
  std::map<std::string, std::vector<const SettingChange*>> rules;
  for (const SettingChange* change : of_grammar) {
    sets.push_back({change});
    if (change->of == SettingChange::Of::kClause)
      rules[change->file + change->name.substr(0, change->name.find(' '))].push_back(change);
  }
  for (auto& [rule, changes] : rules)
    if (changes.size() > 1 && changes.size() < of_grammar.size()) sets.push_back(changes);
  if (of_grammar.size() > 1) sets.push_back(std::move(of_grammar));
  return sets;
}

}  // namespace

std::string RelativeTo(const std::string& root, const std::string& path) {
  const auto relative = std::filesystem::path(path).lexically_relative(root).generic_string();
  return relative.empty() || relative.starts_with("..") ? path : relative;
}

std::map<std::string, std::string> GrammarSettings(std::string_view text) {
  Values values;
  for (const Clause& clause : ClausesOf(text)) values[clause.name] = clause.text;
  return values;
}

Settings SettingsOf(const episode::LoadedRun& loaded, const episode::RunRequest& request,
                    const FileHashes& inputs, const std::string& root,
                    const std::map<std::string, std::string>& kept, bool with_fields) {
  Settings settings;
  std::map<std::string, std::string> texts;
  for (const grammar::ProgramParam& param : grammar::Describe(*loaded.program).params)
    settings[RelativeTo(root, Called(param.file, loaded))][param.name] =
        ParameterText(param, request, texts);
  const auto is_wanted = [&](const std::string& path) {
    return with_fields || path.ends_with(".grammar");
  };
  for (const auto& [path, hash] : inputs) {
    if (!is_wanted(path)) continue;
    if (path == loaded.scenario.file)
      AddValues(loaded.document.root, "", settings[RelativeTo(root, path)]);
    else if (hash != kNoFile)
      AddFile(path, settings[RelativeTo(root, path)]);
  }
  for (const auto& [path, text] : kept)
    if (is_wanted(path)) AddText(path, text, settings[path]);
  std::erase_if(settings, [](const auto& file) { return file.second.empty(); });
  for (const std::string& setting : request.settings) {
    const std::size_t equals = setting.find('=');
    const std::string name = setting.substr(0, equals);
    if (equals != std::string::npos && episode::IsFieldOfScenario(name))
      settings[RelativeTo(root, request.scenario_file)][name] = setting.substr(equals + 1);
  }
  return settings;
}

Settings SettingsOfFiles(const std::vector<std::string>& files, const std::string& root) {
  Settings settings;
  for (const std::string& file : files) AddFile(file, settings[RelativeTo(root, file)]);
  return settings;
}

std::vector<SettingChange> ChangesBetween(const Settings& before, const Settings& now) {
  std::vector<SettingChange> changes;
  for (const auto& [file, values] : now) {
    const auto old = before.find(file);
    if (old == before.end()) continue;
    std::set<std::string> names;
    for (const auto& [name, value] : values) names.insert(name);
    for (const auto& [name, value] : old->second) names.insert(name);
    const auto value_in = [](const Values& all, const std::string& name) {
      const auto found = all.find(name);
      return found == all.end() ? std::string() : found->second;
    };
    // Of one that was noted without clauses, none is new.
    const auto is_clause = [](const std::string& name) {
      return name.find(' ') != std::string::npos;
    };
    const bool has_clauses =
        std::ranges::any_of(old->second, [&](const auto& value) { return is_clause(value.first); });
    for (const std::string& name : names) {
      if (is_clause(name) && file.ends_with(".grammar") && !has_clauses) continue;
      SettingChange change{.file = file,
                           .name = name,
                           .before = value_in(old->second, name),
                           .after = value_in(values, name),
                           .of = !file.ends_with(".grammar") ? SettingChange::Of::kField
                                 : is_clause(name)           ? SettingChange::Of::kClause
                                                             : SettingChange::Of::kParameter};
      if (change.before != change.after) changes.push_back(std::move(change));
    }
  }
  return changes;
}

std::string ChangeText(const SettingChange& change) {
  if (change.of == SettingChange::Of::kClause) {
    const std::size_t space = change.name.find(' ');
    const std::string clause = change.name.substr(space + 1);
    const bool is_law = clause == "law";
    const bool is_named =
        !change.before.empty() && !change.after.empty() && clause != "roles" && !is_law;
    return fmt::format("{} `{}`:{} {}", is_law ? "law" : "rule", change.name.substr(0, space),
                       is_named ? fmt::format(" `{} ..`", clause) : "",
                       ClauseChangeText(change.before, change.after));
  }
  const std::string before = Shortened(change.before), after = Shortened(change.after);
  if (before.empty()) return fmt::format("`{}` added: {}", change.name, after);
  if (after.empty()) return fmt::format("`{}` removed: {}", change.name, before);
  return fmt::format("`{}` {} -> {}", change.name, before, after);
}

std::vector<Attribution> AttributeDifferences(const truth::Comparison& comparison,
                                              const PossibleCauses& possible,
                                              const CompareWith& compare_with) {
  const std::vector<const truth::Pairing*> differing = comparison.Differing();
  std::vector<Attribution> attributions;
  for (const truth::Pairing* pairing : differing)
    attributions.push_back(Described(*pairing, comparison.ticks_per_second));
  const auto is_open = [](const Attribution& attribution) { return attribution.because.empty(); };
  const auto gone_without = [&](const std::vector<const SettingChange*>& undone) {
    std::vector<std::size_t> gone;
    const auto without = compare_with(undone);
    for (std::size_t i = 0; without && i < differing.size(); ++i)
      if (is_open(attributions[i]) && IsGone(*differing[i], *without)) gone.push_back(i);
    return gone;
  };
  for (std::vector<const SettingChange*> undone : ToUndo(possible)) {
    if (undone.size() > 1 && std::ranges::none_of(attributions, is_open)) break;
    const std::vector<std::size_t> gone = gone_without(undone);
    // Of several together those that are needed.
    for (std::size_t k = undone.size(); !gone.empty() && undone.size() > 1 && k-- > 0;) {
      std::vector<const SettingChange*> fewer = undone;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
      if (gone_without(fewer) == gone) undone = std::move(fewer);
    }
    for (const std::size_t i : gone) attributions[i].because = ListOf(undone);
  }
  for (Attribution& attribution : attributions)
    if (is_open(attribution)) attribution.because = OtherCause(possible);
  return attributions;
}

std::string CauseOfFailure(
    const PossibleCauses& possible,
    const std::function<bool(const std::vector<const SettingChange*>& undone)>& holds_without) {
  if (holds_without) {
    for (const auto& undone : ToUndo(possible))
      if (holds_without(undone)) return ListOf(undone);
    const std::string other = possible.motion_differs ? OtherCause(possible) : "";
    if (!other.empty()) return other;
  }
  std::vector<const SettingChange*> all;
  for (const SettingChange& change : possible.changes) all.push_back(&change);
  return all.empty() ? OtherCause(possible) : ListOf(all);
}

}  // namespace prehend::suite
