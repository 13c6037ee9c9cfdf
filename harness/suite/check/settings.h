// SPDX-License-Identifier: Apache-2.0
// What the files of a run say, value by value, and which values are others than they were: "in
// slide/x.yaml `entities.milk.mass_kg` 0.4 -> 8". Tested by
// tests/harness/suite/check/settings_test.cc
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/base/base/content_hash.h"
#include "harness/episode/run/load_run.h"
#include "harness/truth/golden/compare.h"

namespace prehend::suite {

/// File -> name -> value. A name is that of a parameter ("reach_radius" -> "30 cm"), a clause of a
/// rule ("transporting outside" -> "outside supported_by(object, any)"), or the path of a field
/// ("entities.milk.mass_kg" -> "0.4"); short lists are one value ("[0, 0, 0.74]").
using Settings = std::map<std::string, std::map<std::string, std::string>>;

/// Of the parameters of the grammar and of all YAML files among `inputs`, with the changes of the
/// command line. At most 5,000 values of each file. Files are relative to `root`; `kept`: texts of
/// those that are read from copies. Without `with_fields`: of grammars only.
Settings SettingsOf(const episode::LoadedRun& loaded, const episode::RunRequest& request,
                    const FileHashes& inputs, const std::string& root,
                    const std::map<std::string, std::string>& kept = {}, bool with_fields = true);

/// Of these files as they are written, although nothing can be made of them.
Settings SettingsOfFiles(const std::vector<std::string>& files, const std::string& root);

/// Of a grammar's text: its parameters as written, and the clauses of its rules.
std::map<std::string, std::string> GrammarSettings(std::string_view text);

struct SettingChange {
  std::string file, name, before, after;                          ///< without a value: ""
  enum class Of { kField, kParameter, kClause } of = Of::kField;  ///< the last two: of a grammar
  friend bool operator==(const SettingChange&, const SettingChange&) = default;
};

/// Of files that both have, sorted by file and name.
std::vector<SettingChange> ChangesBetween(const Settings& before, const Settings& now);

/// "`reach_radius` 30 cm -> 20 cm"; "`entities.milk.color` added: red"; "rule `transporting`:
/// `outside ..` lost `putting_down(hand, object)`".
std::string ChangeText(const SettingChange& change);

/// A path as people know it: relative to the project if it is in there.
std::string RelativeTo(const std::string& root, const std::string& path);

// Why each single difference from the golden is there. Each changed parameter and each changed
// clause of a rule is undone by itself, then all of a rule, and the recorded motion is segmented
// once more: what then agrees with the golden was its effect. What differs even with all of them
// undone is attributed to what else changed. So two causes in one scenario are told apart. Tested
// by tests/harness/suite/check/attribute_test.cc

/// A difference of a scenario, and what it is attributed to.
struct Attribution {
  std::string event;     ///< its name; "" of a failure that is no difference, as of a law
  std::string what;      ///< "begins later", "missing", "object: milk -> cup"
  double shift_ms = 0;   ///< of the boundary that moved most, recognised - expected; else 0
  std::string because;   ///< "`reach_radius` 30 cm -> 20 cm in x.grammar"; "" is unknown
  std::string question;  ///< to `prehend explain`
};

/// What is known about a run that differs.
struct PossibleCauses {
  std::vector<SettingChange> changes;      ///< of values since the last pass
  std::vector<std::string> other_changes;  ///< changed files without a changed value, the program
  bool motion_differs = false;             ///< it moves differently from the last pass
};

/// The comparison of the same recorded motion, with these parameters and clauses set back. Nothing
/// if that cannot be done.
using CompareWith = std::function<std::optional<truth::Comparison>(
    const std::vector<const SettingChange*>& undone)>;

/// One for each of comparison.Differing(), in its order. Undoes at most 8 changes.
std::vector<Attribution> AttributeDifferences(const truth::Comparison& comparison,
                                              const PossibleCauses& possible,
                                              const CompareWith& compare_with);

/// Why a scenario fails that agrees with its golden, or cannot be read: the first changes without
/// which it holds, else what else changed. Without `holds_without`, all that changed.
std::string CauseOfFailure(
    const PossibleCauses& possible,
    const std::function<bool(const std::vector<const SettingChange*>& undone)>& holds_without);

}  // namespace prehend::suite
