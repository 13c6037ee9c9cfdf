// SPDX-License-Identifier: Apache-2.0
// See harness/suite/check/last_pass.h. A record that is damaged or of another version is ignored.
// Tested by tests/harness/suite/check/last_pass_test.cc
#include "harness/suite/check/last_pass.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "harness/base/base/atomic_file.h"

namespace prehend::suite {
namespace {

using RecordJson = nlohmann::json;

/// Discarded when the file does not exist, is none (a pipe would be waited for) or is not JSON.
RecordJson ReadJson(const std::filesystem::path& path) {
  std::error_code error;
  const bool is_file = std::filesystem::is_regular_file(path, error);
  std::ifstream file;
  if (is_file) file.open(path);
  if (!file.is_open()) return RecordJson(RecordJson::value_t::discarded);
  return RecordJson::parse(file, nullptr, /*allow_exceptions=*/false);
}

/// A name that is not UTF-8 is written with U+FFFD; no such file is unchanged next time.
std::string AsText(const RecordJson& json) {
  return json.dump(1, ' ', false, RecordJson::error_handler_t::replace) + "\n";
}

}  // namespace

std::vector<std::string> ChangedInputs(const LastPass& record) {
  std::vector<std::string> changed;
  for (const auto& [path, hash] : record.verdict.inputs) {
    if (FileHash(path) != hash) changed.push_back(path);
  }
  return changed;
}

std::optional<LastPass> LastPasses::Read(const std::string& scenario) const {
  const RecordJson json = ReadJson(folder_ / (scenario + ".json"));
  if (json.is_discarded()) return std::nullopt;
  try {
    LastPass record{.program = json.at("program"),
                    .build = json.value("build", ""),
                    .passed = json.at("passed"),
                    .pictures = json.at("pictures"),
                    .verdict = UnpackedVerdict(json.at("verdict"))};
    if (record.verdict.scenario != scenario || record.verdict.inputs.empty()) return std::nullopt;
    return record;
  } catch (const RecordJson::exception&) {
    return std::nullopt;
  }
}

std::string LastPasses::Write(const LastPass& record) const {
  const RecordJson json = {{"program", record.program},
                           {"build", record.build},
                           {"passed", record.passed},
                           {"pictures", record.pictures},
                           {"verdict", Packed(record.verdict)}};
  return WriteTextFile(folder_ / (record.verdict.scenario + ".json"), AsText(json));
}

LastPasses::Costs LastPasses::ReadCosts() const {
  const RecordJson json = ReadJson(folder_ / "costs.json");
  Costs costs;
  if (!json.is_object()) return costs;
  for (const auto& [scenario, seconds] : json.items()) {
    if (seconds.is_number()) costs[scenario] = seconds;
  }
  return costs;
}

std::string LastPasses::WriteCosts(const Costs& costs) const {
  return WriteTextFile(folder_ / "costs.json", AsText(costs));
}

}  // namespace prehend::suite
