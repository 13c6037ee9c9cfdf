// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episodes/plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "harness/base/base/content_hash.h"
#include "harness/base/base/quoting.h"
#include "harness/base/base/text_file.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/episodes/record_episode.h"

namespace prehend::episode {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostNamed = 50;
constexpr std::int64_t kMostPlans = 10'000, kMostParts = 10'000;

int PartOf(std::int64_t parts, std::int64_t part, int least = 1) {
  if (part < least || part > parts)
    throw DatabaseError(fmt::format("the file is damaged: found part {} of {}", part, parts));
  return static_cast<int>(part);
}

bool HasPlans(const Database& database) {
  return database.Number("SELECT count(*) FROM sqlite_master WHERE name = 'plan'") > 0;
}

std::vector<Plan> PlansIn(const Database& database) {
  std::vector<Plan> plans;
  if (!HasPlans(database)) return plans;
  if (const std::int64_t count = database.Number("SELECT count(*) FROM plan"); count > kMostPlans)
    throw DatabaseError(fmt::format("has {} plans, wanted at most {}", count, kMostPlans));
  Statement find = database.Prepare("SELECT id, what, uuid, part, parts FROM plan ORDER BY id");
  Statement owed =
      database.Prepare("SELECT name, part FROM plan_owed WHERE plan = ? ORDER BY position");
  while (find.Step()) {
    Plan& plan = plans.emplace_back();
    const int count = PartOf(kMostParts, find.Integer(4));
    plan = {.what = find.Text(1),
            .uuid = find.Uuid(2),
            .number = PartOf(count, find.Integer(3), 0),
            .count = count};
    for (owed.Reset(), owed.Bind(find.Integer(0)); owed.Step();)
      plan.owed.push_back({owed.Text(0), PartOf(count, owed.Integer(1))});
  }
  return plans;
}

/// An episode that was cut off has nothing but its row and its frames.
void RemoveCutOff(const Database& database, const std::string& uuid) {
  Statement find =
      database.Prepare("SELECT id FROM episode WHERE status = 'recording' AND uuid = ?");
  if (!find.Bind(uuid).Step()) return;
  const std::int64_t id = find.Integer(0);
  find.Reset();
  for (const char* of_it : {"part", "chunk"})
    database.Prepare(fmt::format("DELETE FROM {} WHERE episode = ?", of_it)).Bind(id).Run();
  database.Prepare("DELETE FROM episode WHERE id = ?").Bind(id).Run();
}

}  // namespace

std::string Plan::UuidOfEpisode(const std::string& name) const {
  return uuid.empty() ? "" : UuidOf(uuid + "\n" + name);
}

Plan MakePlan(const std::vector<std::string>& words, std::vector<std::string> files,
              const std::string& root) {
  for (const char* folder :
       {"scenarios", "hands", "grammars", "grammar/library", "physics/library"}) {
    std::error_code error;
    for (fs::recursive_directory_iterator entry(fs::path(root) / folder, error), end;
         !error && entry != end; entry.increment(error))
      // What is larger is read by nothing of a scenario.
      if (entry->is_regular_file(error) && entry->file_size(error) <= kMaxTextFileBytes)
        files.push_back(entry->path().string());
  }
  Plan plan;
  for (const std::string& word : words)
    plan.what += (plan.what.empty() ? "" : " ") + ShellQuoted(word);
  std::set<std::string> hashes;
  for (const auto& [path, hash] : HashFiles(files))
    hashes.insert(fs::absolute(path).lexically_proximate(fs::absolute(root)).string() + " " + hash);
  plan.uuid = UuidOf(fmt::format("{}\n{}\n{}", plan.what, ProgramHash(), fmt::join(hashes, "\n")));
  return plan;
}

void WritePlan(const Database& database, const Plan& plan) {
  database.Execute(kPlanTables);
  Statement insert =
      database.Prepare("INSERT INTO plan(what, uuid, part, parts) VALUES(?, ?, ?, ?)");
  insert.Bind(plan.what).Bind(plan.uuid).Bind(plan.number).Bind(plan.count).Run();
  const std::int64_t row = database.LastRow();
  Statement owe = database.Prepare("INSERT INTO plan_owed VALUES(?, ?, ?, ?, ?)");
  for (std::size_t i = 0; i < plan.owed.size(); ++i) {
    const Plan::Owed& owed = plan.owed[i];
    owe.Bind(row).Bind(static_cast<std::int64_t>(i)).Bind(owed.part).Bind(owed.name);
    owe.Bind(plan.UuidOfEpisode(owed.name)).Run();
  }
}

Result<std::map<std::string, EpisodeRow>> BeginPart(const std::string& file, const Plan& plan) {
  const auto begin = [&] {
    const Database database = OpenToWrite(file);
    Transaction transaction(database);
    bool is_there = false;
    for (const Plan& begun : PlansIn(database)) {
      const bool same_part = begun.number == plan.number && begun.count == plan.count;
      is_there |= same_part && begun.uuid == plan.uuid;
      if (same_part && plan.count > 1 && begun.what == plan.what && begun.uuid != plan.uuid)
        throw DatabaseError(fmt::format(
            "was begun as part {} of {} by another program, or of scenarios, hands or grammars "
            "that have changed since; record all parts into new files",
            plan.number, plan.count));
    }
    if (!is_there) WritePlan(database, plan);
    for (const Plan::Owed& owed : plan.owed)
      if (owed.part == plan.number) RemoveCutOff(database, plan.UuidOfEpisode(owed.name));
    transaction.Commit();
  };
  if (const Result<void> begun = Guarded(file, begin); !begun) return tl::unexpected(begun.error());
  PREHEND_TRY(const EpisodeFile opened, EpisodeFile::Open(file));
  std::map<std::string, const EpisodeRow*> by_uuid;
  for (const EpisodeRow& row : opened.episodes())
    if (row.status == kCompleted || row.status == kFailed) by_uuid[row.uuid] = &row;
  std::map<std::string, EpisodeRow> complete;
  for (const Plan::Owed& owed : plan.owed) {
    const auto row = by_uuid.find(plan.UuidOfEpisode(owed.name));
    if (row != by_uuid.end()) complete.emplace(owed.name, *row->second);
  }
  return complete;
}

std::string EndPart(const std::string& file, const Plan& plan) {
  if (plan.count == 1) return "";
  const auto complete = BeginPart(file, plan);
  if (!complete) return grammar::Format(complete.error());
  const auto owed = std::ranges::count(plan.owed, plan.number, &Plan::Owed::part);
  if (static_cast<std::ptrdiff_t>(complete->size()) < owed) return "";
  const Result<Merged> again = MergeEpisodes({&file, 1}, file);
  return again ? "" : grammar::Format(again.error());
}

void StandingFinder::Add(const Database& database) {
  Statement complete =
      database.Prepare("SELECT uuid FROM episode WHERE status IN ('completed', 'failed')");
  while (complete.Step()) complete_.insert(complete.Uuid(0));
  for (Plan& plan : PlansIn(database)) {
    const auto known = std::ranges::find(plans_, plan.uuid, &Plan::uuid);
    if (known == plans_.end())
      plans_.push_back(std::move(plan));
    else if (known->number != plan.number || known->count != plan.count)
      known->number = 0;
  }
}

std::vector<Standing> StandingFinder::Standings() const {
  std::vector<Standing> standings;
  for (const Plan& plan : plans_) {
    standings.push_back({.plan = plan, .missing = {}});
    std::ranges::copy_if(
        plan.owed, std::back_inserter(standings.back().missing),
        [&](const Plan::Owed& owed) { return !complete_.contains(plan.UuidOfEpisode(owed.name)); });
  }
  std::ranges::sort(standings, {},
                    [](const Standing& one) { return std::pair(one.plan.what, one.plan.uuid); });
  return standings;
}

std::string TextOf(const std::vector<Standing>& standings) {
  std::string text;
  std::size_t lines = 0, untold = 0;
  for (const Standing& standing : standings) {
    if (lines >= kMostNamed && !standing.missing.empty()) ++untold;
    if (lines >= kMostNamed) continue;
    const Plan& plan = standing.plan;
    std::map<int, std::vector<std::string>> missing;
    for (const Plan::Owed& owed : standing.missing) missing[owed.part].push_back(owed.name);
    std::map<int, std::size_t> owed_by;
    for (const Plan::Owed& owed : plan.owed) ++owed_by[owed.part];
    std::size_t told = 0;
    for (auto& [part, names] : missing) {
      if (lines == kMostNamed) {
        text += fmt::format("{}: and {} parts more\n", plan.what, missing.size() - told);
        break;
      }
      ++lines, ++told;
      const std::size_t owed = owed_by[part];
      const std::size_t count = names.size(), more = count - std::min(count, kMostNamed);
      names.resize(count - more);
      if (more > 0) names.push_back(fmt::format("and {} more", more));
      text += plan.what + ": ";
      text += plan.count == 1 ? fmt::format("{} of {} episodes are missing: ", count, owed)
              : owed == count ? fmt::format("part {} of {} is missing, with {} episodes: ", part,
                                            plan.count, count)
                              : fmt::format("part {} of {} lacks {} of {} episodes: ", part,
                                            plan.count, count, owed);
      text += fmt::format("{}\n", fmt::join(names, ", "));
    }
  }
  if (untold > 0) text += fmt::format("and so of {} more\n", untold);
  return text;
}

}  // namespace prehend::episode
