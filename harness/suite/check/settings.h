// SPDX-License-Identifier: Apache-2.0
// What the files of a run say, value by value, and which values are others than they were: "in
// slide/x.yaml `entities.milk.mass_kg` 0.4 -> 8". Tested by
// tests/harness/suite/check/settings_test.cc
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "harness/base/base/content_hash.h"
#include "harness/episode/run/load_run.h"

namespace prehend::suite {

/// File -> name -> value. A name is that of a parameter ("reach_radius" -> "30 cm"), a clause of a
/// rule ("transporting outside" -> "outside supported_by(object, any)"), or the path of a field
/// ("entities.milk.mass_kg" -> "0.4"); short lists are one value ("[0, 0, 0.74]").
using Settings = std::map<std::string, std::map<std::string, std::string>>;

/// Of the parameters of the grammar and of all YAML files among `inputs`, with the changes of the
/// command line. At most 5,000 values of each file. Files are relative to `root`.
Settings SettingsOf(const episode::LoadedRun& loaded, const episode::RunRequest& request,
                    const FileHashes& inputs, const std::string& root);

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

}  // namespace prehend::suite
