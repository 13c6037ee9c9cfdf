// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/judge/validate_golden.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <regex>
#include <set>

#include "grammar/base/frame.h"
#include "grammar/contents.h"
#include "harness/base/base/content_hash.h"
#include "harness/base/base/quoting.h"
#include "harness/base/base/text_file.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/golden/golden.h"
#include "harness/truth/oracle/oracle.h"
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
    CheckOrder(line, *signature);
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
    const auto own = std::ranges::find(event.roles, role.name);
    if (own == event.roles.end())
      return Unknown(line, role.name + "=",
                     fmt::format("'{}' has no role '{}'", event.name, role.name), role.name,
                     event.roles);
    const auto entity =
        std::ranges::find(entity_table_.entities, role.value, &grammar::EntityInfo::name);
    if (entity == entity_table_.entities.end())
      return Unknown(line, role.name + "=", "the scenario has no '" + role.value + "'", role.value,
                     entities_);
    const std::string& wanted = event.classes[static_cast<std::size_t>(own - event.roles.begin())];
    if (std::ranges::count(entity->classes, wanted) == 0)
      Complain(line, role.name + "=",
               fmt::format("'{}' is never '{}' of '{}', which takes {}", role.value, role.name,
                           event.name, grammar::WithArticle(wanted)),
               "");
  }

  /// Recognised in one order only, however a person thinks of it.
  void CheckOrder(const truth::GoldenEvent& line, const grammar::EventSignature& event) {
    if (!event.symmetric) return;
    const std::string& first = truth::RoleValue(line.event, event.roles[0]);
    const std::string& second = truth::RoleValue(line.event, event.roles[1]);
    if (first.empty() || first <= second) return;
    Complain(line, event.roles[0] + "=",
             fmt::format("the two of '{}' stand in the order of the alphabet", event.name),
             fmt::format("{}={} {}={}", event.roles[0], second, event.roles[1], first));
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

using Lines = std::vector<std::string>;

/// The event as a golden stores it: no decision tick, values with four significant digits.
grammar::NamedEvent AsWritten(grammar::NamedEvent event) {
  event.decided = 0;
  for (grammar::NamedValue& value : event.values)
    value.value = std::stod(fmt::format("{:.4g}", value.value));
  return event;
}

void Append(Lines& to, const Lines& lines) { to.insert(to.end(), lines.begin(), lines.end()); }

/// Comments of a removed event, below a line that names it.
Lines CommentsOfRemoved(const truth::GoldenEvent& removed, grammar::Tick ticks_per_second) {
  if (removed.comments.empty()) return {};
  Lines lines = {fmt::format("was above {} {}, which is gone:", removed.event.Label(),
                             truth::IntervalText(removed.event.interval, ticks_per_second))};
  Append(lines, removed.comments);
  return lines;
}

/// Merges what a run recognised into the lines of the old golden.
class MergeIntoGolden {
 public:
  MergeIntoGolden(const truth::Golden& old, const grammar::Timeline& recognised,
                  const Proposal& proposal)
      : old_(old),
        proposal_(proposal),
        same_ticks_(old.ticks_per_second == recognised.ticks_per_second),
        next_(static_cast<int>(old.accepted.size()) + 1) {}

  void Add(const truth::Pairing& pairing, truth::Golden& golden) {
    const truth::GoldenEvent* partner =
        pairing.expected ? &old_.events[pairing.golden_line] : nullptr;
    if (pairing.actual) {
      golden.events.push_back(LineOf(pairing, partner));
    } else if (partner) {
      removed_.push_back(partner);
    }
  }

  /// Of removed lines.
  void KeepComments(truth::Golden& golden) const {
    for (const truth::GoldenEvent* removed : removed_) {
      const auto successor =
          std::ranges::find_if(golden.events, [&](const truth::GoldenEvent& line) {
            return line.comments.empty() && same_ticks_ && BeginsAs(line.event, removed->event);
          });
      if (successor != golden.events.end()) {
        successor->comments = removed->comments;
      } else {
        Append(golden.closing_comments, CommentsOfRemoved(*removed, old_.ticks_per_second));
      }
    }
  }

 private:
  /// A line whose boundaries moved within the tolerance stays, unless somebody asks for them:
  /// nobody was shown that they did.
  truth::GoldenEvent LineOf(const truth::Pairing& pairing,
                            const truth::GoldenEvent* partner) const {
    const bool agrees = pairing.agreement == truth::LineVerdict::kMatched;
    const bool moved = pairing.begin_offset != 0 || pairing.end_offset != 0;
    if (partner && agrees && same_ticks_ && !(proposal_.exact && moved)) return *partner;
    truth::GoldenEvent line = partner ? *partner : truth::GoldenEvent();
    line.as_written.clear();
    line.spread = {};
    line.event = AsWritten(*pairing.actual);
    if (!agrees || (proposal_.exact && moved)) line.accepted = next_;
    return line;
  }

  bool BeginsAs(const grammar::NamedEvent& a, const grammar::NamedEvent& b) const {
    return a.Label() == b.Label() &&
           std::abs(a.interval.begin - b.interval.begin) <= proposal_.tolerance;
  }

  const truth::Golden& old_;
  const Proposal& proposal_;
  const bool same_ticks_;
  const int next_;  ///< number of this acceptance
  std::vector<const truth::GoldenEvent*>
      removed_;  ///< lines of the old golden without one in the new
};

bool IsWithin(const truth::Match& match, grammar::Tick tolerance) {
  return std::max(std::abs(match.begin_offset()), std::abs(match.end_offset())) <= tolerance;
}

/// "begins 29.2 ms earlier than recognised": a recognised boundary that is late is earlier in
/// truth.
std::string BoundaryText(const char* verb, double late_ms) {
  return fmt::format("{} {:.1f} ms {} than recognised", verb, std::abs(late_ms),
                     late_ms > 0 ? "earlier" : "later");
}

std::string OffsetText(const truth::Match& match, grammar::Tick ticks_per_second) {
  const double begin_ms = truth::MillisecondsOf(match.begin_offset(), ticks_per_second),
               end_ms = truth::MillisecondsOf(match.end_offset(), ticks_per_second);
  if (end_ms == 0) return BoundaryText("begins", begin_ms) + "; its end agrees";
  if (begin_ms == 0) return BoundaryText("ends", end_ms) + "; its begin agrees";
  return BoundaryText("begins", begin_ms) + " and " + BoundaryText("ends", end_ms);
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

truth::Golden ProposeGolden(const std::optional<truth::Golden>& old,
                            const grammar::Timeline& recognised, const Proposal& proposal) {
  truth::Golden golden{.scenario = proposal.scenario, .grammar = proposal.grammar};
  golden.ticks_per_second = recognised.ticks_per_second;
  if (old) {
    golden.derived = old->derived;
    golden.accepted = old->accepted;
    golden.pictures = old->pictures;
    golden.unsteady = old->unsteady;
    golden.ensemble_plays = old->ensemble_plays;
    golden.comments = old->comments;
    golden.closing_comments = old->closing_comments;
  }
  if (!proposal.derived.empty()) golden.derived = proposal.derived;
  if (proposal.acceptance) golden.accepted.push_back(*proposal.acceptance);
  const truth::Golden before =
      old.value_or(truth::Golden{.ticks_per_second = recognised.ticks_per_second});
  MergeIntoGolden merge(before, recognised, proposal);
  for (const truth::Pairing& pairing :
       truth::Compare(before, recognised, proposal.tolerance).pairings)
    merge.Add(pairing, golden);
  merge.KeepComments(golden);
  std::stable_sort(golden.events.begin(), golden.events.end(),
                   [](const truth::GoldenEvent& a, const truth::GoldenEvent& b) {
                     return ComesBefore(a.event, b.event);
                   });
  return golden;
}

truth::Golden PendingGolden(const std::optional<truth::Golden>& old,
                            const grammar::Timeline& recognised, const std::string& scenario,
                            const std::string& grammar, const OracleComparison& truth) {
  const Lines derived = old ? old->derived : Lines();
  const bool holds = old && AcceptedDiffering(derived) == truth.Differing();
  return ProposeGolden(old, recognised,
                       {.scenario = scenario,
                        .grammar = grammar,
                        .derived = holds ? derived : RenewedDerivation(derived, OracleLine(truth)),
                        .tolerance = truth.tolerance});
}

std::string EventLines(const truth::Golden& golden) {
  std::vector<std::vector<std::string>> rows;
  std::size_t role_columns = 1;
  for (const truth::GoldenEvent& line : golden.events)
    role_columns = std::max(role_columns, line.event.roles.size());
  for (const truth::GoldenEvent& line : golden.events) {
    rows.push_back(truth::EventCells(line.event, golden.ticks_per_second, role_columns));
    for (const grammar::NamedValue& value : line.event.values)
      rows.back().push_back(value.name + "=" + truth::ValueText(value));
  }
  return truth::AlignColumns(rows);
}

std::string Fingerprint(const truth::Golden& pending) {
  return ContentHash(truth::WriteGolden(pending));
}

std::string AcceptCommandLine(const std::string& scenario, const std::string& fingerprint,
                              const std::string& grammar) {
  std::vector<std::string> words = {"accept", scenario, "--reviewed", fingerprint};
  if (!grammar.empty()) words.insert(words.end(), {"--grammar", grammar});
  return CommandText(words) + " --reason \"...\"";
}

std::string AcceptPicturesCommand(const std::string& scenario) {
  return CommandText({"accept", scenario, "--pictures"}) + " --reason \"...\"";
}

int OracleComparison::Following() const {
  int following = 0;
  for (const truth::LabelAgreement& label : agreement.labels)
    following += static_cast<int>(std::ranges::count_if(
        label.matches, [&](const truth::Match& match) { return IsWithin(match, tolerance); }));
  return following;
}

int OracleComparison::Differing() const { return judged - Following() + agreement.missing(); }

OracleComparison CompareWithOracle(const scenario::Scenario& scenario,
                                   const grammar::Program& program, const episode::RunResult& run) {
  std::vector<grammar::Timeline> possible =
      truth::PossibleTimelines(scenario.scene, run.recording, run.ticks + 1);
  grammar::Timeline found = run.timeline;
  // A grammar is not judged by events that it has no rules for.
  std::set<std::string> judged;
  for (const grammar::EventSignature& event : EventSignatures(program))
    if (truth::OracleDefines(event.name, event.roles.empty() ? "" : event.roles.front()))
      judged.insert(event.name);
  const auto is_other = [&](const auto& event) { return !judged.contains(event.event); };
  std::erase_if(found.events, is_other);
  for (grammar::Timeline& truth : possible) std::erase_if(truth.events, is_other);
  const grammar::Tick tolerance = scenario::DefaultTolerance(scenario);
  const std::size_t others = run.timeline.events.size() - found.events.size();
  return {.agreement = truth::AgreeWithin(possible, found, tolerance),
          .tolerance = tolerance,
          .judged = static_cast<int>(found.events.size()),
          .not_judged = static_cast<int>(others)};
}

std::string OracleLine(const OracleComparison& compared) {
  const truth::Agreement& agreement = compared.agreement;
  const int elsewhere = agreement.matched() - compared.Following();
  const double off_ms =
      truth::MillisecondsOf(agreement.largest_offset(), agreement.ticks_per_second);
  const std::string boundaries =
      elsewhere == 0
          ? ""
          : fmt::format("; {} more begin{} or end{} up to {:.1f} ms elsewhere", elsewhere,
                        elsewhere == 1 ? "s" : "", elsewhere == 1 ? "s" : "", off_ms);
  std::string not_recognised;
  if (agreement.missing() > 0)
    not_recognised = fmt::format("; {} that follow are not recognised", agreement.missing());
  const std::string not_judged =
      compared.not_judged == 0
          ? ""
          : fmt::format(" ({} event{} of other kinds not judged)", compared.not_judged,
                        compared.not_judged == 1 ? "" : "s");
  return fmt::format("{}{} of {} events follow from the definitions of docs/events.md{}{}{}",
                     kOracleLine, compared.Following(), compared.judged, boundaries, not_recognised,
                     not_judged);
}

std::string GroundTruthText(const OracleComparison& compared) {
  const grammar::Tick ticks_per_second = compared.agreement.ticks_per_second;
  const auto when = [&](const grammar::NamedEvent& event) {
    return truth::IntervalText(event.interval, ticks_per_second);
  };
  std::string text;
  for (const truth::LabelAgreement& label : compared.agreement.labels) {
    for (const truth::Match& match : label.matches) {
      if (IsWithin(match, compared.tolerance)) continue;
      text += fmt::format("ground truth: {} {} (recognised {})\n", label.label,
                          OffsetText(match, ticks_per_second), when(match.found));
    }
    for (const grammar::NamedEvent& event : label.extra)
      text += fmt::format("ground truth: no {}, recognised {}\n", label.label, when(event));
    for (const grammar::NamedEvent& event : label.missing)
      text += fmt::format("ground truth: {} {}, not recognised\n", label.label, when(event));
  }
  return text;
}

std::string DifferingText(int differing) {
  return fmt::format("{} event{} from the ground truth",
                     differing == 0 ? "no" : std::to_string(differing),
                     differing > 1 ? "s differ" : " differs");
}

int AcceptedDiffering(const std::vector<std::string>& derived) {
  const auto line = std::ranges::find_if(
      derived, [](const std::string& text) { return text.starts_with(kOracleLine); });
  if (line == derived.end()) return 0;
  static const std::regex kCounts(
      "oracle: (\\d{1,9}) of (\\d{1,9}) events follow"
      "(?:.*; (\\d{1,9}) that follow are not recognised)?.*");
  std::smatch counts;
  if (!std::regex_match(*line, counts, kCounts)) return 0;
  const int not_recognised = counts[3].matched ? std::stoi(counts[3]) : 0;
  return std::stoi(counts[2]) - std::stoi(counts[1]) + not_recognised;
}

std::vector<std::string> RenewedDerivation(const std::vector<std::string>& lines,
                                           const std::string& oracle_line) {
  std::vector<std::string> renewed;
  std::ranges::copy_if(lines, std::back_inserter(renewed),
                       [](const auto& line) { return !line.starts_with(kOracleLine); });
  renewed.push_back(oracle_line);
  return renewed;
}

}  // namespace prehend::suite
