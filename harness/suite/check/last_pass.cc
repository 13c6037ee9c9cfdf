// SPDX-License-Identifier: Apache-2.0
// A record that is damaged or of another version is ignored.
#include "harness/suite/check/last_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/quoting.h"

namespace prehend::suite {

namespace {

using RecordJson = nlohmann::json;
constexpr auto kReplace = RecordJson::error_handler_t::replace;

/// "" when the file does not exist or is none (a pipe would be waited for).
std::string TextOf(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return "";
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return std::move(text).str();
}

/// Discarded when it is not JSON.
RecordJson ReadJson(const std::filesystem::path& path) {
  return RecordJson::parse(TextOf(path), nullptr, /*allow_exceptions=*/false);
}

/// A name that is not UTF-8 is written with U+FFFD; no such file is unchanged next time.
std::string AsText(const RecordJson& json) { return json.dump(1, ' ', false, kReplace) + "\n"; }

constexpr std::size_t kMaxTracedTicks = 20'000;

/// Half of the bits are enough to tell two states apart.
template <typename State>
std::uint32_t HashOf(const State& state) {
  physics::StateHash hash;
  hash.Add(state);
  return static_cast<std::uint32_t>(hash.value());
}

std::int64_t WidestGap(const StateTrace& trace) {
  std::int64_t widest = 0;
  for (std::size_t i = 1; i < trace.ticks.size(); ++i)
    widest = std::max(widest, trace.ticks[i] - trace.ticks[i - 1]);
  return widest;
}

/// Nothing when both are equally long. If they have states of different ticks, that is known to the
/// widest gap only.
std::optional<Divergence> FirstTickOfTheLonger(const StateTrace& a, const StateTrace& b) {
  const auto last = [](const StateTrace& run) { return run.ticks.empty() ? -1 : run.ticks.back(); };
  const StateTrace& longer = last(a) > last(b) ? a : b;
  const std::int64_t end = std::min(last(a), last(b));
  const std::int64_t unseen = SameTicks(a, b) ? 1 : std::max(WidestGap(a), WidestGap(b));
  if (last(longer) - end < unseen) return std::nullopt;
  return Divergence{.tick = *std::upper_bound(longer.ticks.begin(), longer.ticks.end(), end)};
}

}  // namespace

std::vector<std::string> ChangedInputs(const LastPass& record) {
  std::vector<std::string> changed;
  for (const auto& [path, hash] : record.verdict.inputs)
    if (FileHash(path) != hash) changed.push_back(path);
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
    // The project may have been elsewhere then.
    const std::string there = json.value("root", root_) + "/", here = root_ + "/";
    FileHashes inputs;
    for (const auto& [path, hash] : record.verdict.inputs)
      inputs[path.starts_with(there) ? here + path.substr(there.size()) : path] = hash;
    record.verdict.inputs = std::move(inputs);
    return record;
  } catch (const RecordJson::exception&) {
    return std::nullopt;
  }
}

std::string LastPasses::Write(const LastPass& record) const {
  const RecordJson json = {{"program", record.program},
                           {"build", record.build},
                           {"root", root_},
                           {"passed", record.passed},
                           {"pictures", record.pictures},
                           {"verdict", Packed(record.verdict)}};
  return WriteTextFile(folder_ / (record.verdict.scenario + ".json"), AsText(json));
}

LastPasses::Costs LastPasses::ReadCostsOf(const std::filesystem::path& file) {
  const RecordJson json = ReadJson(file);
  Costs costs;
  if (!json.is_object()) return costs;
  for (const auto& [scenario, seconds] : json.items())
    if (seconds.is_number()) costs[scenario] = seconds;
  return costs;
}

std::string LastPasses::WriteCosts(const Costs& costs) const {
  return WriteTextFile(folder_ / "costs.json", AsText(costs));
}

StateTrace TraceOf(const physics::Scene& scene, std::span<const physics::Snapshot> recording) {
  StateTrace trace;
  for (const physics::Body& body : scene.bodies) trace.entities.push_back(body.name);
  for (const physics::Hand& hand : scene.hands) trace.entities.push_back(hand.name);
  const std::size_t step = recording.size() / kMaxTracedTicks + 1;
  for (std::size_t i = 0; i < recording.size(); i += step) {
    // What has not moved since the tick before has the hash that it had.
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      trace.hashes.push_back(i > 0 && !recording[i].MayHaveMoved(b, trace.ticks.back())
                                 ? trace.hashes[trace.hashes.size() - trace.entities.size()]
                                 : HashOf(recording[i].bodies[b]));
    for (const physics::HandState& hand : recording[i].hands) trace.hashes.push_back(HashOf(hand));
    trace.ticks.push_back(recording[i].tick);
  }
  return trace;
}

bool SameTicks(const StateTrace& a, const StateTrace& b) {
  const auto both = static_cast<std::ptrdiff_t>(std::min(a.ticks.size(), b.ticks.size()));
  return std::equal(a.ticks.begin(), a.ticks.begin() + both, b.ticks.begin());
}

std::optional<Divergence> FirstDivergence(const StateTrace& a, const StateTrace& b) {
  const std::size_t entities = a.entities.size();
  if (a.entities != b.entities) return Divergence{};
  std::size_t i = 0, j = 0;
  while (i < a.ticks.size() && j < b.ticks.size()) {
    if (a.ticks[i] != b.ticks[j]) {
      ++(a.ticks[i] < b.ticks[j] ? i : j);
      continue;
    }
    for (std::size_t k = 0; k < entities; ++k) {
      if (a.hashes[i * entities + k] != b.hashes[j * entities + k])
        return Divergence{.tick = a.ticks[i], .entity = a.entities[k]};
    }
    ++i, ++j;
  }
  return FirstTickOfTheLonger(a, b);
}

// A line of JSON, the names; then the bytes of all ticks and of all hashes.
std::string WriteTrace(const std::filesystem::path& path, const StateTrace& trace) {
  std::string text = RecordJson(trace.entities).dump(-1, ' ', false, kReplace) + "\n";
  const auto add = [&](const auto& list) {
    text.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(list[0]));
  };
  add(trace.ticks);
  add(trace.hashes);
  return WriteTextFile(path, text);
}

std::optional<StateTrace> ReadTrace(const std::filesystem::path& path) {
  const std::string text = TextOf(path);
  const std::size_t head = text.find('\n') + 1, rest = text.size() - head;
  StateTrace trace;
  try {
    RecordJson::parse(text.substr(0, head)).get_to(trace.entities);
  } catch (const RecordJson::exception&) {
    return std::nullopt;
  }
  const std::size_t of_tick = 8 + 4 * trace.entities.size(), ticks = rest / of_tick;
  if (trace.entities.empty() || rest == 0 || rest % of_tick != 0) return std::nullopt;
  trace.ticks.resize(ticks);
  trace.hashes.resize(ticks * trace.entities.size());
  std::memcpy(trace.ticks.data(), text.data() + head, 8 * ticks);
  std::memcpy(trace.hashes.data(), text.data() + head + 8 * ticks, rest - 8 * ticks);
  return trace;
}

std::vector<std::string> OptionsOf(const episode::GrammarChoice& changes) {
  std::vector<std::string> options;
  if (!changes.grammar.empty()) options.push_back("--grammar " + ShellQuoted(changes.grammar));
  for (const std::string& setting : changes.settings)
    options.push_back("--set " + ShellQuoted(setting));
  return options;
}

std::string CommandAbout(const char* name, const std::string& id,
                         const episode::GrammarChoice& changes) {
  std::string command = CommandText({name, id});
  for (const std::string& option : OptionsOf(changes)) command += " " + option;
  return command;
}

std::string ExplainCommand(const CheckRequest& request) {
  const episode::EpisodeName& episode = request.episode;
  if (request.listen) return "";
  return CommandAbout("explain", episode.number ? episode.file : request.id, request.Asked()) +
         (episode.number ? fmt::format(" --episode {}", *episode.number) : "");
}

std::string RepeatCommand(const CheckRequest& request) {
  return CommandAbout("check", request.episode.number ? request.episode.file : request.id,
                      request.Asked()) +
         (request.listen ? " --recogniser " + ShellQuoted(request.recogniser) : "");
}

}  // namespace prehend::suite
