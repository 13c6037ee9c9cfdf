// SPDX-License-Identifier: Apache-2.0
// See harness/measure/score/score_labels.h: what two people marked. Tested by
// tests/program/label_agreement_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "grammar/contents.h"
#include "harness/episode/run/load_grammar.h"
#include "harness/measure/score/score_labels.h"

namespace prehend::measure {
namespace {

/// Without a recording there is no rate.
constexpr grammar::Tick kTicksPerSecond = 10'000;

tl::unexpected<grammar::Diagnostics> Refused(std::string message, std::string hint) {
  return tl::unexpected(grammar::Diagnostics{
      {.file = "--truth", .place = {}, .message = std::move(message), .hint = std::move(hint)}});
}

/// What labels mean where nothing says it: an event of their name, with the tier as its role.
exchange::LabelMap MapOf(const std::vector<exchange::LabelFile>& files,
                         std::vector<grammar::EventSignature>& events) {
  exchange::LabelMap map;
  for (const exchange::LabelFile& file : files) {
    for (const exchange::Label& label : file.labels) {
      const std::string text = exchange::Trimmed(label.text);
      if (map.labels.emplace(text, exchange::Meaning{.event = text}).second)
        events.push_back({.name = text, .roles = {"tier"}, .classes = {"Entity"}});
      exchange::Meaning& tier = map.tiers[label.tier];
      if (tier.roles.empty() && !label.tier.empty()) tier.roles = {{"tier", label.tier}};
    }
  }
  return map;
}

/// Truths and, behind them, what is compared with them.
Result<std::vector<exchange::LabelFile>> ReadBoth(const LabelFilesRequest& request,
                                                  const exchange::CsvReading& csv) {
  std::vector<exchange::LabelFile> files;
  for (const auto* side : {&request.truth, &request.files}) {
    for (const std::string& path : *side) {
      auto file = exchange::ReadLabels(path, csv, request.backward);
      if (!file) return tl::unexpected(std::move(file.error()));
      if (csv.take.empty() && !file->several.empty())
        return tl::unexpected(grammar::Diagnostics{exchange::SeveralTakes(*file, path)});
      files.push_back(std::move(*file));
    }
  }
  return files;
}

}  // namespace

Result<LabelScores> ScoreLabelFiles(const LabelFilesRequest& request, std::string& warnings) {
  const std::size_t count = request.files.size();
  if (request.truth.size() != count)
    return Refused(
        fmt::format("{} files of labels, and {} to compare them with", count, request.truth.size()),
        "as many, in the same order");
  std::vector<grammar::EventSignature> events;
  std::optional<exchange::LabelMap> map;
  if (!request.grammar.empty()) {
    const grammar::CompileResult compiled = episode::LoadGrammar(request.root, request.grammar);
    if (!compiled.program) return tl::unexpected(compiled.diagnostics);
    events = EventSignatures(*compiled.program);
  }
  if (!request.label_map.empty()) {
    if (events.empty())
      return Refused("no recording says which events there are", "--grammar NAME, for the map");
    Result<exchange::LabelMap> read = exchange::ReadLabelMap(request.label_map, events);
    if (!read) return tl::unexpected(std::move(read.error()));
    map = std::move(*read);
  }
  auto files = ReadBoth(request, map ? map->csv : exchange::CsvReading{});
  if (!files) return tl::unexpected(std::move(files.error()));
  if (events.empty()) map = MapOf(*files, events);
  const auto reading = exchange::LabelReading::Of(std::move(*files), map ? &*map : nullptr, events);
  if (!reading) return tl::unexpected(reading.error());
  warnings += exchange::WarningsOf(*reading);
  std::vector<EpisodeToScore> all;
  for (std::size_t i = 0; i < count; ++i) {
    const double end_s = std::max(reading->EndOf(i), reading->EndOf(count + i));
    const auto end =
        std::max<grammar::Tick>(1, std::llround(end_s * static_cast<double>(kTicksPerSecond)));
    EpisodeToScore pair{.scenario = request.files[i],
                        .ticks = end,
                        .truth = reading->Marked(i, kTicksPerSecond, end, false),
                        .found = reading->Marked(count + i, kTicksPerSecond, end, false)};
    pair.moments = reading->TakeMoments(
        i, pair.truth, std::llround(request.collar_s * static_cast<double>(kTicksPerSecond)),
        pair.found);
    all.push_back(std::move(pair));
  }
  LabelScores scores;
  AddScores(fmt::format("{}", fmt::join(request.files, ", ")), std::move(all), request.collar_s,
            request.is_collar_asked ? Collars{} : reading->collars_s(), scores);
  scores.counted = reading->counted();
  scores.counted.takes = count;
  scores.of_people = true;
  return scores;
}

}  // namespace prehend::measure
