// SPDX-License-Identifier: Apache-2.0
#include "harness/measure/recognise/recogniser.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "harness/base/process/child_process.h"

namespace prehend::measure {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr double kAnswer_s = 10;  ///< to the first line, and to the end
constexpr std::size_t kMostLine_bytes = 1 << 20, kMostOutput_bytes = std::size_t{1} << 26,
                      kMostUnsent_bytes = 1 << 20, kStderrTail_bytes = 4000;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string Near(const std::string& name, const std::vector<std::string>& known) {
  const std::string near = grammar::NearestName(name, known);
  return near.empty() ? fmt::format("wanted one of {}", fmt::join(known, ", "))
                      : "did you mean '" + near + "'?";
}

}  // namespace

/// With one process.
class Recogniser::Talk {
 public:
  explicit Talk(const RecogniserChoice& choice) : choice_(choice) {}

  /// Whether it waits for another episode.
  bool IsReady() const { return is_batch_ && !done_.broken; }

  Recognised Watch(const WatchedEpisode& episode) {
    episode_ = &episode;
    done_ = {.events = {.file = choice_.command}, .covers = std::move(done_.covers)};
    entities_.clear();
    printed_.clear();
    for (const grammar::EntityInfo& one : episode.entities.entities) entities_.push_back(one.name);
    sent_ = ready_ = -1;
    is_done_ = false;
    start_ = Clock::now();
    if (!has_header_) Start();
    if (!done_.broken) Send();
    if (!done_.broken) AwaitEnd();
    if (done_.broken) process_.Kill();
    done_.cpu_s = process_.end().cpu_s;
    done_.events.text = text_;
    if (process_.err.size() > kStderrTail_bytes)
      process_.err.erase(0, process_.err.size() - kStderrTail_bytes);
    done_.stderr_tail = std::move(process_.err);
    process_.err.clear();
    return done_;
  }

  /// There is no other episode.
  void End() {
    process_.CloseInput();
    process_.HasEnded(kAnswer_s);
  }

 private:
  void Start() {
    const std::string problem =
        process_.Start({"sh", "-c", choice_.command},
                       {.environment = {"PREHEND_EPISODE=" + episode_->name, "PREHEND_SEED=1"},
                        .is_watched = true});
    if (!problem.empty()) return Break(Rule::kHeader, problem, "");
    // To the end of a line, so that what was printed with it has come before a frame is sent.
    AwaitUntil([&] { return has_header_ && process_.out.empty(); }, kAnswer_s, Rule::kHeader,
               fmt::format("no first line within {:g} s", kAnswer_s),
               R"(print {"recogniser": 1, "events": {..}} and flush, before you read a frame)");
    if (!has_header_ && !done_.broken) EndedEarly(Rule::kHeader);
    start_ = Clock::now();
  }

  /// Until that is so, or the program says no more.
  template <class Condition>
  void AwaitUntil(const Condition& is_so, double most_s, Rule rule, const std::string& message,
                  const std::string& hint = "") {
    const Clock::time_point begin = Clock::now();
    while (!done_.broken && !is_so() && !process_.has_said_all()) {
      const double left_s = most_s - SecondsSince(begin);
      if (left_s <= 0) return Break(rule, message, hint);
      Exchange(left_s);
    }
  }

  void Exchange(double most_s) {
    process_.Exchange(most_s);
    for (std::size_t end = process_.out.find('\n'), begin = 0;; begin = end + 1) {
      end = process_.out.find('\n', begin);
      if (end == std::string::npos || end - begin > kMostLine_bytes || done_.broken) {
        process_.out.erase(0, begin);
        break;
      }
      const std::string line = process_.out.substr(begin, end - begin);
      ++line_;
      text_ += line + "\n";
      Take(line);
    }
    if (done_.broken) return;
    if (process_.out.size() > kMostLine_bytes) {
      text_ += process_.out.substr(0, 100) + "\n";
      ++line_;
      Break(Rule::kLines, "the line has more than 1 MiB", "an event a line");
    } else if (text_.size() > kMostOutput_bytes) {
      Break(Rule::kLines, "it has printed more than 64 MiB", "an event once, when it is certain");
    }
  }

  void Break(Rule rule, std::string message, std::string hint) {
    if (done_.broken) return;
    grammar::Diagnostic what =
        grammar::DiagnosticAt(choice_.command, text_, {.line = line_, .column = line_ > 0 ? 1 : 0},
                              episode_->name + ": " + std::move(message), std::move(hint));
    if (line_ == 0) what.place = {};
    done_.broken = {rule, std::move(what)};
  }

  void EndedEarly(Rule rule) {
    process_.HasEnded(kAnswer_s);
    const ChildProcess::End& end = process_.end();
    std::string words = process_.err.substr(0, process_.err.find_last_not_of('\n') + 1);
    words = words.substr(words.rfind('\n') + 1).substr(0, 200);
    Break(rule,
          fmt::format("it ended {}{}{}{}",
                      end.signal != 0 ? fmt::format("by signal {}", end.signal)
                                      : fmt::format("with exit code {}", end.exit_code),
                      end.exit_code == 0 && end.signal == 0 ? " before it had read all" : "",
                      sent_ < 0 ? "" : fmt::format("; tick {} had been sent", sent_),
                      words.empty() ? "" : "; its last words: " + words),
          "it reads to end_tick, prints its events, and ends with exit code 0");
  }

  void Send() {
    std::ostringstream lines;
    if (is_batch_) process_.Send(json{{"episode", episode_->name}}.dump() + "\n");
    episode::EpisodeWriter writer(
        lines,
        {.episode = episode_->name.substr(episode_->name.rfind('/') + 1),  // SKILL/NAME is no name
         .bridge_s = 0,  // what is not tracked for a short time is as the grammar sees it
         .entity_table = episode_->entities},
        facts_);
    const auto per_s = static_cast<double>(episode_->entities.ticks_per_second);
    const auto send = [&] {
      process_.Send(lines.str());
      lines.str("");
    };
    const auto await = [&](grammar::Tick tick) {
      const double at_s = static_cast<double>(tick) / per_s;
      while (choice_.pace == Pace::kRealTime && !done_.broken && SecondsSince(start_) < at_s &&
             !process_.has_said_all())
        Exchange(at_s - SecondsSince(start_));
    };
    const grammar::Tick end = episode_->each_frame([&](const grammar::Frame& frame) {
      if (done_.broken || process_.has_said_all()) return;
      writer.Write(frame);
      await(frame.tick);
      send();
      sent_ = frame.tick;
      if (choice_.pace == Pace::kOnline)
        AwaitUntil(
            [&] { return ready_ >= frame.tick; }, LeftOfLimit_s(), Rule::kReady,
            fmt::format("no answer to tick {} within {:g} s", frame.tick, choice_.time_limit_s),
            fmt::format(R"(print {{"ready": {}}} and flush, after its events)", frame.tick));
      else
        AwaitUntil([&] { return process_.unsent() < kMostUnsent_bytes; }, LeftOfLimit_s(),
                   Rule::kEnds, TooLong(), kTooLong);
    });
    writer.Finish(end);
    await(end);
    send();
    if (!process_.has_said_all()) sent_ = end;
    if (!is_batch_) process_.CloseInput();
  }

  void AwaitEnd() {
    AwaitUntil([&] { return is_batch_ && is_done_; }, LeftOfLimit_s(), Rule::kEnds, TooLong(),
               kTooLong);
    if (done_.broken || (is_batch_ && is_done_)) return;
    if (!process_.HasEnded(kAnswer_s))
      return Break(Rule::kEnds, fmt::format("it has not ended {:g} s after its output", kAnswer_s),
                   kTooLong);
    const ChildProcess::End& end = process_.end();
    if (end.exit_code != 0 || end.signal != 0 || is_batch_ || !process_.HasReadAll())
      return EndedEarly(Rule::kEnds);
    if (!process_.out.empty())
      Break(Rule::kLines, "its last line has no end", "a newline behind each line");
  }

  static constexpr const char* kTooLong = "--recogniser-limit-s gives it more time";
  std::string TooLong() const { return fmt::format("no end within {:g} s", choice_.time_limit_s); }
  double LeftOfLimit_s() const {
    const double played_s =
        choice_.pace == Pace::kRealTime && sent_ > 0
            ? static_cast<double>(sent_) / static_cast<double>(episode_->entities.ticks_per_second)
            : 0;
    return choice_.time_limit_s + played_s - SecondsSince(start_);
  }

  void Take(const std::string& text) {
    const json line = json::parse(text, nullptr, false);
    if (!line.is_object())
      return Break(Rule::kLines, "found no JSON object in UTF-8",
                   "what is no event goes to stderr");
    if (const auto error = line.find("error"); error != line.end())
      return Break(Rule::kNoError, "it gave up: " + error->dump(), "");
    if (!has_header_) return TakeHeader(line);
    if (line.contains("event")) return TakeEvent(line);
    if (line.contains("begin") || line.contains("drop")) return;
    if (const auto ready = line.find("ready"); ready != line.end()) {
      if (!ready->is_number_integer() || ready->get<grammar::Tick>() > sent_)
        return Break(
            Rule::kReady,
            fmt::format("found ready {}; the last tick that it got is {}", ready->dump(), sent_),
            "");
      ready_ = ready->get<grammar::Tick>();
      done_.late_frames += choice_.pace == Pace::kRealTime && ready_ < sent_ ? 1 : 0;
    } else if (is_batch_ && line.value("done", json()) == episode_->name) {
      is_done_ = true;
    } else {
      Break(Rule::kLines,
            "found none of \"event\", \"begin\", \"drop\", \"ready\", \"error\"" +
                std::string(is_batch_ ? fmt::format(" and \"done\": \"{}\"", episode_->name) : ""),
            "");
    }
  }

  void TakeHeader(const json& line) {
    const auto wrong = [&](const std::string& message) {
      Break(Rule::kHeader, message,
            R"({"recogniser": 1, "events": {"grasping": ["hand", "object"]}, "facts": ["poses"]})");
    };
    if (line.value("recogniser", json()) != 1)
      return wrong("the first line says no \"recogniser\": 1, the version of the protocol");
    const json events = line.value("events", json());
    if (!events.is_object() || events.empty())
      return wrong("\"events\": wanted {\"EVENT\": [\"ROLE\", ..], ..}");
    for (const auto& [event, roles] : events.items()) {
      std::vector<std::string>& declared = declared_[event];
      done_.covers.push_back(event);
      if (!roles.is_array()) return wrong("\"events\": " + event + ": wanted a list of roles");
      for (const json& role : roles) {
        if (!role.is_string()) return wrong("\"events\": " + event + ": wanted names of roles");
        declared.push_back(role.get<std::string>());
      }
    }
    std::map<std::string, bool> asked;
    for (const json& fact : line.value("facts", json::array()))
      asked[fact.is_string() ? fact.get<std::string>() : fact.dump()] = true;
    static const std::vector<std::string> known = {"poses", "touches", "trigger", "joints",
                                                   "gazes"};
    for (const auto& [fact, _] : asked)
      if (std::ranges::count(known, fact) == 0)
        return wrong(fmt::format("\"facts\": there are no '{}'; {}", fact, Near(fact, known)));
    facts_ = {asked.contains("touches"), asked.contains("trigger"), asked.contains("joints"),
              asked.contains("gazes")};
    is_batch_ = line.value("batch", json(false)) == true;
    has_header_ = true;
  }

  bool Knows(const std::vector<std::string>& known, const std::string& name,
             const std::string& otherwise) {
    const bool is_known = std::ranges::count(known, name) > 0;
    if (!is_known) Break(Rule::kEvents, fmt::format("{} '{}'", otherwise, name), Near(name, known));
    return is_known;
  }

  void TakeEvent(const json& line) {
    exchange::Label label{.place = {line_, 1}, .roles = {}};
    const auto per_s = static_cast<double>(episode_->entities.ticks_per_second);
    const std::string problem = exchange::ReadEventLine(line, per_s, label);
    if (!problem.empty()) return Break(Rule::kTicks, problem, "");
    if (!Knows(done_.covers, label.text, "its first line has no event")) return;
    const std::vector<std::string>& roles = declared_[label.text];
    for (const grammar::Role& role : label.roles)
      if (!Knows(roles, role.name, "its first line has for " + label.text + " no role") ||
          !Knows(entities_, role.value, "the episode has no entity"))
        return;
    if (label.roles.size() != roles.size())
      return Break(Rule::kEvents,
                   fmt::format("{} has the roles {}", label.text, fmt::join(roles, ", ")), "");
    if (!line.contains("begin_tick") || !line.contains("end_tick"))
      return Break(Rule::kTicks, "an event has a begin_tick and an end_tick", "");
    if (!printed_.insert(line).second)
      return Break(Rule::kEvents, "it has printed this event before", "an event is printed once");
    if (label.begin_s < 0 || label.end_s > static_cast<double>(sent_) / per_s)
      return Break(Rule::kTicks,
                   fmt::format("the event lies at {} to {}, and what it has got at 0 to {}",
                               line["begin_tick"].dump(), line["end_tick"].dump(),
                               std::max<grammar::Tick>(sent_, 0)),
                   "an event is printed when it is over");
    label.decided_s.reset();
    if (choice_.pace != Pace::kOffline) label.decided_s = static_cast<double>(sent_) / per_s;
    done_.events.labels.push_back(std::move(label));
  }

  const RecogniserChoice& choice_;
  const WatchedEpisode* episode_ = nullptr;
  ChildProcess process_;
  std::map<std::string, std::vector<std::string>> declared_;  ///< events and their roles
  std::vector<std::string> entities_;
  std::set<json> printed_;
  episode::WrittenFacts facts_;
  bool has_header_ = false, is_batch_ = false, is_done_ = false;
  int line_ = 0;
  std::string text_;  ///< all lines
  grammar::Tick sent_ = -1, ready_ = -1;
  Clock::time_point start_;
  Recognised done_;
};

Recogniser::Recogniser(RecogniserChoice choice) : choice_(std::move(choice)) {}
Recogniser::~Recogniser() {
  if (talk_ && talk_->IsReady()) talk_->End();
}

Recognised Recogniser::Recognise(const WatchedEpisode& episode) {
  if (!talk_ || !talk_->IsReady()) talk_ = std::make_unique<Talk>(choice_);
  return talk_->Watch(episode);
}

}  // namespace prehend::measure
