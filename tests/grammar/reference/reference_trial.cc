// SPDX-License-Identifier: Apache-2.0
#include "tests/grammar/reference/reference_trial.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <tuple>

#include "grammar/program/program.h"
#include "tests/grammar/thorough.h"

namespace prehend::grammar::testing {
namespace {

using Found = std::map<std::string, std::vector<Interval>>;

Found ByRule(const Program& program, const std::vector<Event>& events) {
  Found found;
  for (const Event& event : events) {
    const Rule& rule = program.rules[event.rule];
    std::string name = rule.name;
    for (std::size_t i = 0; i < rule.roles.size(); ++i) {
      if (rule.roles[i].class_name == "P") name += event.roles[i] == 1 ? "(p1)" : "(p2)";
    }
    found[name].push_back(event.interval);
  }
  for (auto& [name, intervals] : found) {
    std::sort(intervals.begin(), intervals.end(),
              [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
  }
  return found;
}

std::string TextOf(const Found& found) {
  std::string text;
  for (const auto& [name, intervals] : found) {
    text += name + ":";
    for (const Interval& i : intervals)
      text += " [" + std::to_string(i.begin) + "," + std::to_string(i.end) + ")";
    text += "\n";
  }
  return text;
}

// What differs, or nothing.
std::string Difference(const Found& expected, const Found& found) {
  Found only_expected, only_found;
  for (const auto& [name, intervals] : expected) {
    const auto same = found.find(name);
    if (same == found.end() || same->second != intervals) only_expected[name] = intervals;
  }
  for (const auto& [name, intervals] : found) {
    const auto same = expected.find(name);
    if (same == expected.end() || same->second != intervals) only_found[name] = intervals;
  }
  if (only_expected.empty() && only_found.empty()) return {};
  return "expected:\n" + TextOf(only_expected) + "found:\n" + TextOf(only_found);
}

class Trial {
 public:
  explicit Trial(std::uint64_t seed) : random_(seed) {}

  // Draws grammars until one is accepted: conditions that are never or always true are refused, and
  // rightly so.
  void NextGrammar() {
    for (;;) {
      grammar_.emplace(random_, 2 + static_cast<int>(random_() % 7));
      CompileResult compiled = Compile({"random", grammar_->text()}, nullptr);
      program_ = compiled.program;
      if (program_) break;
      ++result_.refused;
      const bool rightly = std::ranges::all_of(compiled.diagnostics, [](const Diagnostic& d) {
        return SaysAnyOf(d, {"never true", "always true"}) || SaysThatNothingHappens(d);
      });
      if (!rightly)
        Mismatch("a well-formed grammar is refused:\n" + Format(compiled.diagnostics), nullptr);
      CheckRefusal(compiled.diagnostics);
    }
    thorough_ = Thorough(*program_);
    ++result_.grammars;
  }

  // Two monitors at once, one fed with whole frames, one with changes or either, in chunks of any
  // size.
  void Watch(const RandomEpisode& episode) {
    static constexpr std::array kEachWay = {Shown::kWhole, Shown::kRepeated, Shown::kNew,
                                            Shown::kNew};
    Monitor plain(program_, RandomEntityTable());
    Monitor mixed(program_, RandomEntityTable());
    EpisodeFeed feed_plain(episode, plain), feed_mixed(episode, mixed);
    std::vector<Event> events_plain, events_mixed;
    while (!feed_plain.done() || !feed_mixed.done()) {
      for (auto chunk = random_() % 8; chunk > 0 && !feed_plain.done(); --chunk)
        feed_plain.Step(Shown::kWhole, events_plain);
      for (auto chunk = random_() % 8; chunk > 0 && !feed_mixed.done(); --chunk)
        feed_mixed.Step(kEachWay[random_() % kEachWay.size()], events_mixed);
    }
    result_.ticks += 2 * episode.frames();
    ++result_.episodes;
    result_.lost += std::ranges::count(episode.lost, true) > 0;
    const Found expected = grammar_->Expected(episode);
    if (!plain.error().empty()) Mismatch(plain.error(), &episode);
    if (const std::string text = Difference(expected, ByRule(*program_, events_plain));
        !text.empty())
      Mismatch(text, &episode);
    if (const std::string text = Difference(expected, ByRule(*program_, events_mixed));
        !text.empty()) {
      Mismatch("shown as changes, " + text, &episode);
    }
    WatchThoroughly(episode, events_plain, events_mixed);
    if (!Orderly(events_plain))
      Mismatch("an event is decided before its end, or events come in the wrong order", &episode);
  }

  // However frames are shown, the same is decided at the same ticks; where everybody is woken by
  // everything, the same, too, and never sooner.
  void WatchThoroughly(const RandomEpisode& episode, const std::vector<Event>& plain,
                       const std::vector<Event>& mixed) {
    Monitor thorough(thorough_, RandomEntityTable());
    EpisodeFeed feed(episode, thorough);
    std::vector<Event> events;
    while (!feed.done()) feed.Step(Shown::kWhole, events);
    Compare("as whole frames: ", plain, "as changes:      ", mixed, &episode);
    const std::vector<Event> sooner = WithTicksOf(plain, events);
    Compare("with all awake:    ", events, "as few as may be: ", sooner, &episode);
  }

  // The events with the ticks at which the others were decided, if those are no sooner.
  static std::vector<Event> WithTicksOf(std::vector<Event> events,
                                        const std::vector<Event>& thorough) {
    for (Event& event : events) {
      const auto same = std::ranges::find_if(thorough, [&](const Event& other) {
        return other.rule == event.rule && other.roles == event.roles &&
               other.interval == event.interval;
      });
      if (same != thorough.end()) event.decided = std::max(event.decided, same->decided);
    }
    std::ranges::stable_sort(events, [](const Event& a, const Event& b) {
      return std::tie(a.decided, a.interval.begin, a.rule, a.roles) <
             std::tie(b.decided, b.interval.begin, b.rule, b.roles);
    });
    return events;
  }

  void Compare(const std::string& first, const std::vector<Event>& expected,
               const std::string& second, const std::vector<Event>& found,
               const RandomEpisode* episode) {
    const std::vector<std::string> lines = Lines(expected, *program_),
                                   others = Lines(found, *program_);
    const auto [one, other] = std::ranges::mismatch(lines, others);
    if (one == lines.end() && other == others.end()) return;
    Mismatch(first + (one == lines.end() ? "nothing" : *one) + "\n" + second +
                 (other == others.end() ? "nothing" : *other) + "\n",
             episode);
  }

  std::mt19937_64& random() { return random_; }
  const TrialResult& result() const { return result_; }

 private:
  static bool SaysAnyOf(const Diagnostic& diagnostic, std::initializer_list<const char*> words) {
    return std::ranges::any_of(words, [&](const char* word) {
      return diagnostic.message.find(word) != std::string::npos;
    });
  }
  static bool SaysThatNothingHappens(const Diagnostic& diagnostic) {
    return SaysAnyOf(diagnostic, {"nothing ever begins", "nothing is ever left", "never an event",
                                  "relation is never true", "no interval lasts that long and"});
  }

  // What is refused because it never happens does not happen by the meaning of the rules either.
  void CheckRefusal(const Diagnostics& diagnostics) {
    for (int i = 0; i < 5; ++i) {
      const RandomEpisode episode =
          MakeEpisode(random_, 40, 1 + static_cast<unsigned>(random_() % 8));
      const Found expected = grammar_->Expected(episode);
      for (const Diagnostic& diagnostic : diagnostics) {
        if (!SaysThatNothingHappens(diagnostic)) continue;
        const std::string rule = "rule" + std::to_string((diagnostic.place.line - 2) /
                                                         2);  // each has two lines, after the first
        const bool happens = std::ranges::any_of(expected, [&](const auto& entry) {
          return entry.first == rule || entry.first.starts_with(rule + "(");
        });
        if (happens) Mismatch("it is refused, but it happens:\n" + Format(diagnostic), &episode);
      }
    }
  }

  static bool Orderly(const std::vector<Event>& events) {
    for (std::size_t i = 0; i < events.size(); ++i) {
      if (events[i].decided < events[i].interval.end ||
          (i > 0 && events[i].decided < events[i - 1].decided))
        return false;
    }
    return true;
  }

  void Mismatch(const std::string& what, const RandomEpisode* episode) {
    if (result_.mismatches++ == 0)
      result_.first = what + grammar_->text() + (episode ? Drawn(*episode) : "");
  }

  std::mt19937_64 random_;
  std::optional<RandomGrammar> grammar_;
  std::shared_ptr<const Program> program_;
  std::shared_ptr<const Program> thorough_;
  TrialResult result_;
};

}  // namespace

std::string TrialResult::Text() const {
  return std::to_string(ticks) + " ticks, " + std::to_string(grammars) + " grammars, " +
         std::to_string(episodes) + " episodes (" + std::to_string(lost) + " with lost poses), " +
         std::to_string(mismatches) + " mismatches";
}

TrialResult TryRandomGrammars(std::uint64_t seed, std::int64_t ticks) {
  Trial trial(seed);
  while (trial.result().ticks < ticks) {
    trial.NextGrammar();
    for (int i = 0; i < 20; ++i) {
      const int frames = 1 + static_cast<int>(trial.random()() % 80);
      trial.Watch(
          MakeEpisode(trial.random(), frames, 1 + static_cast<unsigned>(trial.random()() % 8)));
    }
  }
  return trial.result();
}

TrialResult TryAllEpisodes(std::uint64_t seed, int grammars, int frames) {
  Trial trial(seed);
  for (int g = 0; g < grammars; ++g) {
    trial.NextGrammar();
    for (int bits = 0; bits < 1 << (3 * frames); ++bits) {
      RandomEpisode episode;
      const auto bit = [&](int i, int fact) { return (bits >> (3 * i + fact) & 1) != 0; };
      for (int i = 0; i < frames; ++i) {
        episode.touches[0].push_back(bit(i, 0));
        episode.touches[1].push_back(!bit(i, 1));
        episode.touches[2].push_back(bit(i, 1));
        episode.touches[3].push_back(bit(i, 2));
        episode.height_m.push_back(bit(i, 0) + 2 * bit(i, 2));
        episode.lost.push_back(false);
        episode.grips.push_back(bit(i, 2));
        episode.ticks.push_back(i);
      }
      episode.ticks.push_back(frames);
      trial.Watch(episode);
    }
  }
  return trial.result();
}

}  // namespace prehend::grammar::testing
