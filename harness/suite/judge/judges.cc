// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/judge/judges.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "grammar/check_laws.h"
#include "grammar/describe.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/suite/judge/validate_golden.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/golden/golden.h"
#include "harness/truth/timeline/event_text.h"
#include "physics/scene/run_limits.h"

namespace prehend::suite {
namespace {

// One function per invariant, and the table that names them. Tested by
// tests/harness/suite/judge/invariants_test.cc

using grammar::Interval;
using grammar::NamedEvent;
using grammar::Tick;
using grammar::Timeline;

bool Inside(Interval inner, Interval outer) {
  return inner.begin >= outer.begin && inner.end <= outer.end;
}

bool Overlaps(Interval a, Interval b) { return a.begin < b.end && b.begin < a.end; }

void CheckInsideEpisode(const Timeline& timeline, const EpisodeFacts& facts, std::string_view name,
                        Violations& out) {
  for (const NamedEvent& event : timeline.events) {
    const Interval interval = event.interval;
    if (interval.begin >= interval.end) {
      out.push_back({name, interval.begin, event.Label() + " does not end after it begins"});
    } else if (!Inside(interval, {0, facts.end})) {
      out.push_back({name, interval.begin, event.Label() + " reaches out of the episode"});
    }
  }
}

/// Intervals of one event with the same roles, whatever it is about.
void CheckApartFromItself(const Timeline& timeline, const EpisodeFacts&, std::string_view name,
                          Violations& out) {
  std::map<std::string, const NamedEvent*> last;  // by label, in the order of time
  for (const NamedEvent& event : timeline.events) {
    const NamedEvent*& before = last[event.Label()];
    if (before && Overlaps(before->interval, event.interval))
      out.push_back({name, event.interval.begin, event.Label() + " overlaps itself"});
    if (!before || before->interval.end < event.interval.end) before = &event;
  }
}

/// Whether the two are about a common entity at a common time (ends included).
bool Concern(const NamedEvent& a, const NamedEvent& b) {
  if (a.interval.begin > b.interval.end || b.interval.begin > a.interval.end) return false;
  return std::any_of(a.roles.begin(), a.roles.end(), [&](const grammar::Role& role) {
    return !truth::IsAttribute(role) &&
           std::any_of(b.roles.begin(), b.roles.end(), [&](const grammar::Role& other) {
             return !truth::IsAttribute(other) && other.value == role.value;
           });
  });
}

/// The last tick at which the event may be decided.
Tick LatestDecision(const NamedEvent& event, const Timeline& timeline, const EpisodeFacts& facts) {
  const auto found = facts.latency.find(event.event);
  const grammar::Wait wait = found == facts.latency.end() ? grammar::Wait{} : found->second;
  Tick from = event.interval.end;
  for (const NamedEvent& other : timeline.events) {
    if (wait.until_end_of.contains(other.event) && Concern(event, other))
      from = std::max(from, other.interval.end);
  }
  return from + truth::TickAt(wait.seconds, timeline.ticks_per_second) + facts.two_frames;
}

void CheckLatency(const Timeline& timeline, const EpisodeFacts& facts, std::string_view name,
                  Violations& out) {
  for (const NamedEvent& event : timeline.events) {
    const Tick latest = LatestDecision(event, timeline, facts);
    if (event.decided < event.interval.end) {
      out.push_back({name, event.decided, event.Label() + " was decided before it ended"});
    } else if (event.decided > latest) {
      out.push_back(
          {name, event.decided,
           fmt::format("{} was decided at {} s, by its rule it is certain at {} s", event.Label(),
                       truth::SecondsText(event.decided, timeline.ticks_per_second),
                       truth::SecondsText(latest, timeline.ticks_per_second))});
    }
  }
}

constexpr std::array kInvariants = {
    Invariant{"events_lie_inside_the_episode",
              "begin < end, and nothing reaches out of the episode", CheckInsideEpisode},
    Invariant{"an_event_does_not_overlap_itself",
              "intervals of one event with the same roles lie apart", CheckApartFromItself},
    Invariant{"decisions_come_in_time",
              "every event is decided at or after its end, within its rule's bound", CheckLatency},
};

std::map<std::string, grammar::Wait> LatencyByEvent(const grammar::Program& program) {
  std::map<std::string, grammar::Wait> latency;
  for (const grammar::RuleDescription& rule : Describe(program).rules)
    latency[rule.name] = rule.latency;
  return latency;
}

Findings ViolationFinding(std::string reason, std::string details) {
  if (details.empty()) return {};
  return {{.exit_code = ExitCode::kDiffers,
           .reason = std::move(reason),
           .details = std::move(details)}};
}

using Words = std::vector<std::string>;

Words WordsOf(std::string_view text) {
  Words words;
  for (std::size_t begin = 0; (begin = text.find_first_not_of(" \t\r\n", begin)) < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \t\r\n", begin), text.size());
    words.emplace_back(text.substr(begin, end - begin));
    begin = end;
  }
  return words;
}

/// A colour in quotes is none.
std::string_view WithoutComment(std::string_view line) {
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') is_quoted = !is_quoted;
    if (line[i] == '#' && !is_quoted) return line.substr(0, i);
  }
  return line;
}

std::string Joined(const Words& words) { return fmt::format("{}", fmt::join(words, " ")); }

/// A comma is a word, so that a list that goes on has the same last element.
Words PiecesOf(std::string_view text) {
  std::string spaced;
  for (const char c : text) spaced += c == ',' ? std::string(" , ") : std::string(1, c);
  return WordsOf(spaced);
}

/// Commas and connectives at its ends say nothing.
std::string Middle(const Words& words, std::size_t begin, std::size_t end) {
  std::string text = Joined({words.begin() + static_cast<std::ptrdiff_t>(begin),
                             words.begin() + static_cast<std::ptrdiff_t>(end)});
  for (std::size_t at = 0; (at = text.find(" ,")) != std::string::npos;) text.erase(at, 1);
  if (text.ends_with(",")) text.pop_back();
  for (const std::string_view word : {", ", "and ", "or "})
    if (text.starts_with(word)) text.erase(0, word.size());
  return text;
}

std::ptrdiff_t Depth(const Words& words, std::size_t end) {
  std::ptrdiff_t depth = 0;
  for (std::size_t i = 0; i < end; ++i)
    depth += std::ranges::count(words[i], '(') - std::ranges::count(words[i], ')');
  return depth;
}

}  // namespace

std::vector<truth::ClaimVerdict> JudgeClaims(const episode::LoadedRun& loaded,
                                             const grammar::Timeline& timeline) {
  const scenario::Scenario& scenario = loaded.scenario;
  if (scenario.expects.empty()) return {};
  return JudgeClaims(scenario.expects, scenario.file,
                     episode::ClaimableIn(scenario, *loaded.program), timeline);
}

namespace {

/// "sinks_into(pot, coaster)".
std::string LimitIn(const truth::Claim& claim) {
  const truth::ClaimedEvent& limit = claim.events.front();
  return fmt::format("{}({}, {})", limit.name.text, limit.roles[0].value.text,
                     limit.roles[1].value.text);
}

}  // namespace

std::vector<truth::ClaimVerdict> JudgeLimitClaims(const scenario::Scenario& scenario,
                                                  const std::vector<physics::ScriptNote>& notes) {
  std::vector<truth::ClaimVerdict> verdicts;
  for (const truth::Claim& claim : scenario.expects) {
    if (!truth::IsAboutLimit(claim)) continue;
    const auto note = std::ranges::find(
        notes, LimitIn(claim), [](const auto& each) { return physics::LimitOf(each.text); });
    const bool holds = note != notes.end();
    verdicts.push_back({.claim = claim.text,
                        .place = fmt::format("{}:{}", scenario.file, claim.where.place.line),
                        .says = holds ? truth::kHolds : truth::kContradicted,
                        .found = holds ? "found: " + note->text : "found none"});
  }
  return verdicts;
}

Findings JudgeLimits(const scenario::Scenario& scenario,
                     const std::vector<physics::ScriptNote>& notes) {
  std::map<std::string, std::string> found;  // by what a claim says of it
  for (const physics::ScriptNote& note : notes)
    if (const std::string limit = physics::LimitOf(note.text); !limit.empty())
      found.emplace(limit, note.text);
  for (const truth::Claim& claim : scenario.expects)
    if (truth::IsAboutLimit(claim)) found.erase(LimitIn(claim));
  Findings findings = ClaimFindings(JudgeLimitClaims(scenario, notes));
  for (const auto& [limit, text] : found)
    findings.push_back(
        {.exit_code = ExitCode::kDiffers,
         .reason = text,
         .details = fmt::format("{}\n  if that may be: expects: ['{}']\n", text, limit)});
  return findings;
}

Findings ClaimFindings(const std::vector<truth::ClaimVerdict>& verdicts) {
  Findings findings;
  for (const truth::ClaimVerdict& verdict : verdicts) {
    if (!truth::IsContradicted(verdict)) continue;
    const std::string text = Text(verdict);
    findings.push_back(
        {.exit_code = ExitCode::kDiffers, .reason = text, .details = text + "\n" + verdict.times});
  }
  return findings;
}

namespace fs = std::filesystem;

show::GoldenOf GoldensOf(const std::string& id, const std::string& root) {
  return [files = truth::GoldenFiles(root), id](const std::string& name) {
    const fs::path golden = files.PicturePath(id, name);
    std::error_code ignored;
    return fs::exists(golden, ignored) ? golden.string() : "";
  };
}

std::vector<PictureComparison> ComparisonsOf(const std::string& id,
                                             const std::vector<show::WrittenPicture>& drawn,
                                             const std::string& root, bool shown) {
  const truth::GoldenFiles files(root);
  std::vector<PictureComparison> compared;
  for (const show::WrittenPicture& picture : drawn) {
    if (picture.golden.empty()) continue;
    const bool can_be_shown =
        shown && picture.difference.same_size && !picture.difference.told.empty();
    const std::string name = fs::path(picture.file).filename().string();
    compared.push_back({.golden = picture.golden,
                        .drawn = picture.file,
                        .told = picture.difference.told,
                        .shown_in = can_be_shown ? files.DifferencePath(id, name) : fs::path()});
  }
  return compared;
}

std::string PictureDifferencesText(const std::vector<PictureComparison>& compared,
                                   const std::string& accept) {
  std::string text;
  for (const PictureComparison& picture : compared) {
    if (picture.told.empty()) continue;
    text += fmt::format("picture {}:\n", picture.drawn.string());
    for (const std::string& told : picture.told) text += "  " + told + "\n";
    text += fmt::format("  expected {}\n", picture.golden.string());
    if (!picture.shown_in.empty())
      text += fmt::format("  difference {}\n", picture.shown_in.string());
    if (!accept.empty()) text += fmt::format("  accept it with: {}\n", accept);
  }
  return text;
}

Findings JudgeUnrequestedPictures(const std::string& id, std::size_t requested,
                                  const std::string& root, const std::string& accept) {
  Findings findings;
  for (const fs::path& picture : UnrequestedPictures(id, requested, root)) {
    findings.push_back(
        {.exit_code = ExitCode::kDiffers,
         .reason = "a golden picture that the scenario does not ask for",
         .details = UnrequestedText(picture, requested) + "\n  remove it, or: " + accept + "\n"});
  }
  return findings;
}

void StorePictures(const std::string& id, const std::vector<PictureComparison>& compared,
                   const std::string& root) {
  const truth::GoldenFiles files(root);
  for (const PictureComparison& picture : compared) {
    const std::string name = picture.drawn.filename().string();
    files.RemovePendingPicture(id, name);
    if (picture.told.empty()) continue;
    const fs::path pending = files.PendingPicturePath(id, name);
    std::error_code ignored;  // `accept` draws the picture again, and reports what it cannot write
    fs::create_directories(pending.parent_path(), ignored);
    fs::copy_file(picture.drawn, pending, ignored);
    if (!picture.shown_in.empty())
      show::WritePictureDifference(picture.golden.string(), picture.drawn.string(),
                                   picture.shown_in.string());
  }
}

std::span<const Invariant> Invariants() { return kInvariants; }

Violations CheckInvariants(const Timeline& timeline, const EpisodeFacts& facts) {
  Violations violations;
  for (const Invariant& invariant : kInvariants)
    invariant.check(timeline, facts, invariant.name, violations);
  return violations;
}

std::string Text(const Violation& violation, Tick ticks_per_second) {
  return fmt::format("{} at {} s: {}", violation.invariant,
                     truth::SecondsText(violation.tick, ticks_per_second), violation.what);
}

std::string Text(const grammar::LawViolation& violation, Tick ticks_per_second) {
  const grammar::Law& law = *violation.law;
  return fmt::format("{} at {}: {}\n  {}:{}: {} {}", law.name,
                     truth::IntervalText(violation.when, ticks_per_second), violation.what,
                     law.file, law.place.line, law.Head(), law.says);
}

Findings JudgeInvariants(const CheckedRun& checked) {
  const episode::RunResult& run = checked.result;
  const scenario::Scenario& scenario = checked.loaded.scenario;
  EpisodeFacts facts{.end = run.ticks + 1};
  facts.two_frames = scenario::DefaultTolerance(scenario);
  facts.latency = LatencyByEvent(*checked.loaded.program);
  std::string details;
  for (const Violation& violation : CheckInvariants(run.timeline, facts))
    details += "violated: " + Text(violation, run.timeline.ticks_per_second) + "\n";
  return ViolationFinding("invariant violated", std::move(details));
}

namespace {

Findings LawFindings(const grammar::Program& program, const grammar::EntityTable& entities,
                     const grammar::Timeline& timeline) {
  std::string details;
  std::set<std::string> names;
  for (const grammar::LawViolation& violation : CheckLaws(program, entities, timeline)) {
    details += "violated: " + Text(violation, timeline.ticks_per_second) + "\n";
    names.insert(violation.law->name);
  }
  return ViolationFinding(
      fmt::format("a law of the grammar is violated, {}", fmt::join(names, ", ")),
      std::move(details));
}

}  // namespace

Findings JudgeLaws(const CheckedRun& checked) {
  return LawFindings(*checked.loaded.program, episode::MakeEntityTable(checked.loaded.scenario),
                     checked.result.timeline);
}

Findings JudgeLaws(const episode::SegmentedRecording& recording) {
  return LawFindings(*recording.program, recording.entity_table, recording.timeline);
}

std::vector<Clause> ClausesOf(std::string_view grammar) {
  std::vector<Clause> clauses;
  std::map<std::string, int> twins;  // by name, without their numbers
  std::string rule;
  bool is_law = false;
  std::size_t indent = 0;  // of the rule's clauses; 0: none yet
  for (std::size_t begin = 0; begin < grammar.size();) {
    const std::size_t line_end = std::min(grammar.find('\n', begin), grammar.size());
    const std::string_view line = grammar.substr(begin, line_end - begin);
    const std::size_t start = begin;
    begin = line_end + 1;
    const std::string_view said = WithoutComment(line);
    const Words words = WordsOf(said);
    if (words.empty()) continue;
    const std::size_t depth = said.find_first_not_of(" \t");
    const std::size_t end = start + said.find_last_not_of(" \t\r") + 1;
    if (depth == 0) {
      rule.clear();
      if (words.size() > 3 && words[0] == "param")
        clauses.push_back({words[1], Joined({words.begin() + 3, words.end()}), start, end});
      if (words.size() < 2 || words[0] == "param" || words[0] == "use" || words[0] == "grammar")
        continue;
      // "symmetric event contact(..)"
      const auto kind = static_cast<std::ptrdiff_t>(words[0] == "symmetric" && words.size() > 2);
      const std::string& head = words[static_cast<std::size_t>(kind) + 1];
      rule = head.substr(0, head.find('('));
      is_law = words[0] == "law";
      indent = 0;
      ++twins[rule + " roles"];
      clauses.push_back({rule + " roles", Joined({words.begin() + kind + 1, words.end()}),
                         static_cast<std::size_t>(grammar.find(head, start)), end});
    } else if (!rule.empty() && (indent == 0 || (depth <= indent && !is_law))) {
      indent = depth;
      std::string name = rule + " " + (is_law ? "law" : words[0]);
      if (const int twin = ++twins[name]; twin > 1) name += fmt::format(" {}", twin);
      clauses.push_back({std::move(name), Joined(words), start + depth, end});
    } else if (!rule.empty()) {
      clauses.back().text += " " + Joined(words);
      clauses.back().end = end;
    }
  }
  return clauses;
}

std::string WithClause(std::string_view grammar, const std::string& name, const std::string& text) {
  const std::string rule = name.substr(0, name.find(' ') + 1);
  std::size_t begin = std::string::npos, end = 0;
  std::string put = text;
  for (const Clause& clause : ClausesOf(grammar)) {
    if (clause.name == name) {
      begin = clause.begin;
      end = clause.end;
      put = text;
      break;
    }
    // One that is not there any more stands behind the others.
    if (!clause.name.starts_with(rule) || clause.name == rule + "drawn") continue;
    begin = end = clause.end;
    put = "\n  " + text;
  }
  if (begin == std::string::npos) return "";
  return fmt::format("{}{}{}", grammar.substr(0, begin), put, grammar.substr(end));
}

std::string ClauseChangeText(std::string_view before, std::string_view after) {
  const Words old = PiecesOf(before), now = PiecesOf(after);
  const std::size_t most = std::min(old.size(), now.size());
  std::size_t first = 0, last = 0;
  while (first < most && old[first] == now[first]) ++first;
  while (last < most - first && old[old.size() - 1 - last] == now[now.size() - 1 - last]) ++last;
  // What is negated, not only that it is.
  const auto negates = [&](const Words& words) {
    return words.size() == first + last + 1 && words[first] == "not";
  };
  if (last > 0 && (negates(old) || negates(now))) --last;
  // Never from the midst of a call.
  while (first > 0 && (Depth(old, first) > 0 || Depth(now, first) > 0)) --first;
  while (last > 0 && (Depth(old, old.size() - last) > 0 || Depth(now, now.size() - last) > 0))
    --last;
  const std::string was = Middle(old, first, old.size() - last),
                    is = Middle(now, first, now.size() - last);
  if (is.empty()) return fmt::format("lost `{}`", was);
  if (was.empty()) return fmt::format("gained `{}`", is);
  return fmt::format("`{}` -> `{}`", was, is);
}

}  // namespace prehend::suite
