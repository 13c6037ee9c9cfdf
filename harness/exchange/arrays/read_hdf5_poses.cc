// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/arrays/read_hdf5_poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "harness/base/base/text_file.h"
#include "harness/exchange/arrays/row_poses.h"

namespace prehend::exchange {
namespace {

/// Words, or JSON with words in it, as in LIBERO's problem_info and RoboCasa's ep_meta.
std::string LanguageOf(const std::string& text) {
  std::string words = text;
  const auto json = nlohmann::json::parse(text, nullptr, false);
  for (const char* key : {"language_instruction", "lang"})
    if (json.is_object() && json.contains(key) && json[key].is_string()) words = json[key];
  return ReadableName(words.substr(0, episode::kMaxLanguageBytes / 3));
}

class GroupRows : public RowSource {
 public:
  GroupRows(const Hdf5File& file, std::string group) : file_(file), group_(std::move(group)) {
    knows_angles = true;
  }

  std::optional<Rows> Read(const Located<std::string>& name, DiagnosticList& errors) override {
    const Hdf5Part part = *Hdf5PartOf(name.value);
    const std::string path = group_ + "/" + part.dataset;
    const auto described = file_.Describe(path);
    const auto values = file_.Read(path, part);
    if (!described || !values) {
      const grammar::Diagnostic why = (described ? values.error() : described.error()).front();
      errors.Add(name.where, why.message, why.hint);
      return std::nullopt;
    }
    Rows rows{.count = described->Rows(), .shape = described->Text(), .values = *values};
    if (rows.count > 0) rows.width = rows.values.size() / rows.count;
    if (rows.width == 0 || (part.count != UINT64_MAX && rows.width != part.count)) {
      errors.Add(name.where, fmt::format("'{}' has nothing there: the dataset is {}", name.value,
                                         described->Text()));
      return std::nullopt;
    }
    rows.is_matrix = described->shape.size() == 3 && described->shape[1] == 4 && rows.width == 16;
    return rows;
  }

 private:
  const Hdf5File& file_;
  const std::string group_;
};

/// "@success" is an attribute of the group, "success" a dataset, whose last value counts.
std::optional<Hdf5Value> ValueOf(const Hdf5File& file, const std::string& group,
                                 const std::optional<Located<std::string>>& key, PoseFile& poses) {
  if (!key) return std::nullopt;
  std::optional<Hdf5Value> value;
  if (key->value.starts_with('@')) {
    value = file.Attribute(group, key->value.substr(1));
  } else if (const auto read = file.Read(group + "/" + key->value); read && !read->empty()) {
    value = read->back();
  }
  if (!value) poses.notes.push_back(fmt::format("it has no '{}'", key->value));
  return value;
}

}  // namespace

Result<std::vector<std::string>> GroupsLike(const Hdf5File& file, const std::string& pattern) {
  const std::size_t slash = pattern.rfind('/'), star = pattern.find('*');
  const std::string parent = slash == std::string::npos ? "" : pattern.substr(0, slash);
  const std::string before =
      pattern.substr(parent.empty() ? 0 : slash + 1, star - (parent.empty() ? 0 : slash + 1));
  const std::string after = star == std::string::npos ? "" : pattern.substr(star + 1);
  if (star == std::string::npos) return std::vector<std::string>{pattern};
  PREHEND_TRY(const auto names, file.NamesIn(parent));
  std::vector<std::string> groups;
  for (const std::string& name : names) {
    if (name.size() < before.size() + after.size() || !name.starts_with(before) ||
        !name.ends_with(after))
      continue;
    const std::string path = parent.empty() ? name : parent + "/" + name;
    if (const auto member = file.Describe(path); !member || member->kind == Hdf5Kind::kGroup)
      groups.push_back(path);
  }
  if (groups.empty())
    return tl::unexpected(file.Error(
        fmt::format("no group is like '{}': '{}' has {}", pattern, parent.empty() ? "/" : parent,
                    names.empty() ? "nothing" : names.front() + (names.size() > 1 ? " .." : ""))));
  return groups;
}

std::optional<double> ControlRateOf(const Hdf5File& file, const std::string& group) {
  const std::size_t slash = group.rfind('/');
  const auto text =
      file.Attribute(slash == std::string::npos ? "" : group.substr(0, slash), "env_args");
  if (!text || !std::holds_alternative<std::string>(*text)) return std::nullopt;
  const auto json = nlohmann::json::parse(std::get<std::string>(*text), nullptr, false);
  if (!json.is_object() || !json.contains("env_kwargs") || !json["env_kwargs"].is_object())
    return std::nullopt;
  const auto rate = json["env_kwargs"].find("control_freq");
  if (rate == json["env_kwargs"].end() || !rate->is_number()) return std::nullopt;
  return rate->get<double>() > 0 ? std::optional(rate->get<double>()) : std::nullopt;
}

Result<Demonstrations> Demonstrations::Open(const std::string& path, const MapFile& map) {
  PREHEND_TRY(auto file, Hdf5File::Open(path));
  Demonstrations all(std::move(file), map);
  PREHEND_TRY(all.groups_, GroupsLike(all.file_, map.map.hdf5.episodes.value));
  const auto& said = map.map.rate_hz;
  const std::optional<double> rate_hz = ControlRateOf(all.file_, all.groups_.front());
  DiagnosticList errors(map.document);
  if (!said && !rate_hz)
    errors.Add(map.document.root.where, "'rate_hz' is missing: the file does not say it",
               "the rate at which actions are given, often rate_hz: 20");
  if (said && rate_hz && std::abs(said->value / *rate_hz - 1) > 0.05 &&
      !map.map.IsSure(Warning::kTime))
    errors.Add(said->where,
               fmt::format("rate_hz: {:g}, but env_args of the file has control_freq {:g}",
                           said->value, *rate_hz),
               "leave out rate_hz; or, if it is right, sure: [time]");
  if (!errors.empty()) return tl::unexpected(errors.Sorted());
  all.rate_hz_ = said ? said->value : *rate_hz;
  return all;
}

Result<PoseFile> Demonstrations::Read(const std::string& group) const {
  GroupRows rows(file_, group);
  Result<PoseFile> poses = ReadRowPoses(rows, *map_, file_.path() + "/" + group, rate_hz_);
  if (!poses) return poses;
  if (const auto value = ValueOf(file_, group, map_->map.hdf5.success, *poses);
      value && std::holds_alternative<double>(*value))
    poses->attributes.success = std::get<double>(*value) != 0;
  if (const auto value = ValueOf(file_, group, map_->map.hdf5.language, *poses);
      value && std::holds_alternative<std::string>(*value))
    poses->attributes.language = LanguageOf(std::get<std::string>(*value));
  return poses;
}

}  // namespace prehend::exchange
