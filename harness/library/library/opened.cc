// SPDX-License-Identifier: Apache-2.0
#include "harness/library/library/opened.h"

#include <algorithm>
#include <ctime>
#include <filesystem>

#include "grammar/contents.h"
#include "harness/base/base/atomic_file.h"
#include "harness/base/base/project_paths.h"
#include "harness/base/base/quoting.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_text.h"
#include "harness/exchange/labels/read_truths.h"

namespace prehend {

Error::Error(grammar::Diagnostics diagnostics)
    : std::runtime_error(grammar::Format(diagnostics)), diagnostics_(std::move(diagnostics)) {
  if (diagnostics_.empty()) diagnostics_.emplace_back();
}
Error::Error(const Error&) = default;
Error::~Error() = default;

void Refuse(std::string file, std::string message, std::string hint) {
  throw Error(grammar::Diagnostics{
      {.file = std::move(file), .message = std::move(message), .hint = std::move(hint)}});
}

std::string ProjectRoot() {
  if (const std::optional<std::string> root = FindProjectRoot()) return *root;
  Refuse("", "the project's folder was not found",
         "set PREHEND_HOME to the folder with grammar/library, or with a prehend.yaml");
}

Grammar::Grammar(std::string name_or_path, grammar::Overrides parameters,
                 const std::map<std::string, std::string>& instead)
    : name_or_path_(std::move(name_or_path)), parameters_(std::move(parameters)) {
  grammar::CompileResult compiled =
      episode::LoadGrammar(ProjectRoot(), name_or_path_, parameters_, &files_, instead);
  if (!compiled.program) throw Error(std::move(compiled.diagnostics));
  program_ = std::move(compiled.program);
}
Grammar::Grammar(const Grammar&) = default;
Grammar::~Grammar() = default;
const std::string& Grammar::name() const { return grammar::GrammarName(*program_); }

episode::Episode Episode::Impl::Open() {
  // What a recording names for itself may be nowhere, when somebody asks for its frames only.
  return Unwrap(shared->opener.Open(name, {.grammar = name.number ? "" : kDefaultGrammar}));
}

episode::Episode& Episode::Impl::Known(episode::Episode& episode) {
  if (table) return episode;
  table = episode.entities();
  end = episode.recording() ? episode.recording()->end_tick : episode.row()->ticks + 1;
  return episode;
}

void Episode::Impl::Choose(episode::Episode& episode, const Grammar* grammar) {
  if (!grammar && name.number) return;
  if (!grammar && !own) {
    grammar::CompileResult compiled =
        episode::LoadGrammarOf(episode.recording()->header, "", ProjectRoot());
    if (!compiled.program) throw Error(std::move(compiled.diagnostics));
    own = std::move(compiled.program);
  }
  episode.loaded().program = grammar ? grammar->program() : own;
  episode.loaded().warnings = episode::Warnings(*episode.program(), episode.entities());
}

const std::string& Episode::name() const { return impl_->name.scenario; }
const std::string& Episode::file() const { return impl_->file; }
std::optional<std::int64_t> Episode::number() const { return impl_->name.number; }
bool Episode::was_simulated() const { return impl_->name.origin != episode::Origin::kRecording; }
const std::string& Episode::grammar_name() const { return impl_->name.grammar; }

grammar::EntityTable Episode::entities() const {
  const std::lock_guard lock(impl_->shared->mutex);
  if (!impl_->table) impl_->WithFrames([](const episode::Episode&) {});
  return *impl_->table;
}

grammar::Tick Episode::end() const {
  const std::lock_guard lock(impl_->shared->mutex);
  if (!impl_->table) impl_->WithFrames([](const episode::Episode&) {});
  return impl_->end;
}

std::string Episode::EachFrame(const std::function<void(const grammar::Frame&)>& look) const {
  return impl_->WithFrames(
      [&](episode::Episode& episode) { return episode.EachFrame(look).failure; });
}

std::optional<grammar::Timeline> Episode::Recorded() const {
  if (!impl_->name.number) return std::nullopt;
  return impl_->WithFrames(
      [](episode::Episode& episode) { return std::optional(Unwrap(episode.Recorded())); });
}

Segmented Episode::Segment(const Grammar* grammar) const {
  return impl_->With(grammar, [](episode::Episode& episode) {
    episode::RunResult run = Unwrap(episode.Run(false));
    const bool is_complete = run.status.kind == physics::RunStatus::Kind::kCompleted;
    return Segmented{
        .timeline = std::move(run.timeline),
        .end = run.ticks + 1,
        .warnings = grammar::Format(episode.loaded().warnings) + episode.missing().warnings,
        .failure = is_complete ? "" : episode::StatusText(run)};
  });
}

void Episode::WriteFrames(const std::string& file) const {
  impl_->WithFrames([&](episode::Episode& episode) {
    AtomicFile out(file, Over::kAnything);  // what is replaced, a program decides
    if (!out.problem().empty()) Refuse(file, out.problem());
    episode::EpisodeWriter writer(out.stream(), episode.Header());
    const auto end = episode.EachFrame([&](const grammar::Frame& frame) { writer.Write(frame); });
    writer.Finish(end.tick);
    if (const std::string problem = out.Commit(); !problem.empty()) Refuse(file, problem);
  });
}

void Episode::WriteLabels(const grammar::Timeline& timeline, const std::string& file,
                          const Grammar* grammar) const {
  const std::size_t dot = file.rfind('.');
  const std::string ending = dot == std::string::npos ? "" : file.substr(dot);
  if (!exchange::CanWriteLabels(file))
    Refuse(file, "found the ending '" + ending + "', wanted .csv, .eaf or .TextGrid");
  char date[sizeof "YYYY-MM-DD"];
  const std::time_t now = std::time(nullptr);
  std::tm parts;
  std::strftime(date, sizeof date, "%Y-%m-%d", localtime_r(&now, &parts));
  truth::HandRoles hands;
  if (grammar) hands = truth::HandRolesOf(EventSignatures(*grammar->program()));
  const std::string problem = WriteTextFile(
      file, exchange::LabelsText(ending, timeline, hands, end(), date), Over::kAnything);
  if (!problem.empty()) Refuse(file, problem);
}

std::vector<Episode> OpenEpisodes(const std::vector<std::string>& files, const std::string& which) {
  if (files.empty()) Refuse("", "no file is named");
  const auto shared = std::make_shared<Opener>();
  auto found = episode::FindEpisodes(files, which, ProjectRoot());
  if (!found && !found.error().diagnostics.empty()) throw Error(found.error().diagnostics);
  if (!found) Refuse("", found.error().message);
  std::vector<Episode> episodes;
  for (episode::EpisodeName& name : *found) {
    std::error_code error;
    if (!std::filesystem::exists(name.file, error)) Refuse(name.file, "no such file");
    if (name.origin == episode::Origin::kScenario)
      Refuse(name.file, "it is a scenario, and this library plays none",
             "record it: " + CommandText({"run", name.scenario, "--record", "NAME.episodes"}));
    episodes.emplace_back(std::make_shared<Episode::Impl>(
        Episode::Impl{.name = name, .file = name.file, .shared = shared}));
  }
  return episodes;
}

}  // namespace prehend
