// SPDX-License-Identifier: Apache-2.0
// Programs of others that read frames and print events, as docs/recognisers.md says: those that
// keep to the protocol, and those that break it.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kGrammar = "pick_and_place_from_motion";
constexpr const char* kExamples = PREHEND_SOURCE_DIR "/examples/recognisers/";

/// The frame of a program: `frame` is done for each line, and has `line`, `tick` and `say`.
std::string Python(const std::string& frame, const std::string& first = "",
                   const std::string& facts = "") {
  return "import json, os, sys, time, subprocess\n"
         "def say(line): print(json.dumps(line), flush=True)\n" +
         first + "say({'recogniser': 1, 'events': {'grasping': ['hand', 'object']}, 'facts': [" +
         facts +
         "]})\n"
         "count = 0\n"
         "grasp = {'event': 'grasping', 'roles': {'hand': 'right_hand', 'object': 'milk'},\n"
         "         'begin_tick': 0, 'end_tick': 1}\n"
         "for line in sys.stdin:\n"
         "    line, count = json.loads(line), count + 1\n"
         "    tick = line.get('tick', -1)\n" +
         frame + "    if tick >= 0: say({'ready': tick})\n";
}

class Recognisers : public testing::Test {
 protected:
  ~Recognisers() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  std::string Program(const std::string& text) const {
    WriteFile(folder_ / "reco.py", text);
    return "python3 -B " + Path("reco.py");
  }
  std::string Take() const {
    const Said said = Prehend({"import", docs_ + "/poses.csv", "--map", docs_ + "/bodies.yaml",
                               "-o", Path("milk.jsonl")});
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return Path("milk.jsonl");
  }
  Said Score(const std::string& take, const std::string& command,
             std::vector<std::string> more = {}) const {
    std::vector<std::string> words = {
        "score",        take,   "--truth", docs_ + "/labels.csv", "--map", docs_ + "/labels.yaml",
        "--recogniser", command};
    words.insert(words.end(), more.begin(), more.end());
    return Prehend(words);
  }
  /// Nobody who was started in the folder of the test still runs.
  static std::string StillRuns(const std::string& mark) {
    for (const auto& process : fs::directory_iterator("/proc")) {
      std::ifstream words(process.path() / "cmdline");
      const std::string all{std::istreambuf_iterator<char>(words), {}};
      if (all.find(mark) != std::string::npos) return all;
    }
    return "";
  }

  const std::string docs_ = PREHEND_SOURCE_DIR "/docs/motion_capture";
  const fs::path folder_ =
      FreshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
};

std::string Has(const std::string& text, const std::string& part) {
  return text.find(part) == std::string::npos ? text : "";
}

json Figures(json score) {
  for (const char* name : {"grammar", "cpu_s_per_s", "not_covered"}) score.erase(name);
  return score;
}

/// What `watch` prints, with an answer to each frame.
std::string RepeatsWatch(const std::string& grammar, const std::string& events) {
  return "import fcntl, json, os, subprocess, sys, termios, time\n"
         "print(json.dumps({'recogniser': 1, 'events': " +
         events +
         ", 'facts': ['poses', 'touches', 'trigger', 'joints', 'gazes']}), flush=True)\n"
         "watch = subprocess.Popen(['" +
         std::string(PREHEND_BINARY_DIR "/prehend") + "', 'grammar', 'watch', '-', '--grammar', '" +
         grammar +
         "', '--json'], stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0)\n"
         "os.set_blocking(watch.stdout.fileno(), False)\n"
         "def works():  # it has not read everything, or does not wait for more\n"
         "    unread = int.from_bytes(fcntl.ioctl(watch.stdin, termios.FIONREAD, bytes(4)), "
         "'little')\n"
         "    with open(f'/proc/{watch.pid}/stat') as stat: state = "
         "stat.read().rpartition(')')[2]\n"
         "    return unread or state.split()[0] not in 'SZ'\n"
         "def show():\n"
         "    for line in (watch.stdout.read() or b'').splitlines():\n"
         "        line = json.loads(line)\n"
         "        del line['decided_tick']\n"
         "        print(json.dumps(line), flush=True)\n"
         "for line in sys.stdin:\n"
         "    watch.stdin.write(line.encode())\n"
         "    tick = json.loads(line).get('tick')\n"
         "    if tick is None: continue\n"
         "    while works(): time.sleep(0.0002)\n"
         "    show()\n"
         "    print(json.dumps({'ready': tick}), flush=True)\n"
         "watch.stdin.close()\n"
         "os.set_blocking(watch.stdout.fileno(), True)\n"
         "show()\n";
}

/// The events that the grammar of a recording finds in it, with their roles.
std::string EventsOf(const std::string& take) {
  json events = json::object();
  std::istringstream watched(Prehend({"grammar", "watch", take, "--json"}).out);
  for (std::string line; std::getline(watched, line);) {
    const json event = json::parse(line);
    for (const auto& [role, entity] : event["roles"].items()) {
      json& roles = events[event["event"].get<std::string>()];
      if (std::find(roles.begin(), roles.end(), json(role)) == roles.end()) roles.push_back(role);
    }
  }
  return events.dump();
}

TEST_F(Recognisers, WhatRepeatsTheGrammarHasItsTable) {
  const std::string take = Take();
  const Said said = Score(take, Program(RepeatsWatch(kGrammar, EventsOf(take))),
                          {"--grammar", kGrammar, "--pace", "online", "--json"});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  const json both = json::parse(said.out)["grammars"];
  ASSERT_EQ(both.size(), 2u);
  EXPECT_GT(both[0]["total"]["latency_s"]["max"], 0);
  EXPECT_EQ(Figures(both[0]), Figures(both[1]));
}

TEST_F(Recognisers, NoFactLeaks) {
  const std::string keys =
      "    for kind in ('samples', 'hands'):\n"
      "        for name, one in (line.get(kind) or {}).items():\n"
      "            sys.stderr.write(''.join(f'[{kind}.{key}]' for key in (one or {})))\n"
      "    sys.stderr.write(''.join(f'[{key}]' for key in line))\n";
  const auto seen = [&](const std::string& facts) {
    const Said said = Prehend({"score", "furniture/drawer_is_opened_with_hook", "--recogniser",
                               Program(Python(keys, "", facts))});
    return said.err;
  };
  const std::string none = seen("");
  EXPECT_EQ(Has(none, "[samples.at_m]"), "");
  for (const char* fact :
       {"touches", "trigger", "joint_position", "joint_fraction", "gazes_at", "style",
        "collision_spheres_m", "expects", "script", "golden", "grammar"})
    EXPECT_EQ(none.find(fact), std::string::npos) << fact;
  EXPECT_EQ(Has(seen("'touches'"), "[touches]"), "");
  EXPECT_EQ(Has(seen("'trigger'"), "[hands.trigger]"), "");
  EXPECT_EQ(seen("'trigger'").find("[touches]"), std::string::npos);
}

struct BrokenOne {
  const char* name;
  std::string program;
  std::string says;
  std::vector<std::string> more = {};
};

TEST_F(Recognisers, BrokenOnesAreNamedAndNothingIsLeft) {
  const std::string take = Take(), limit = "--recogniser-limit-s";
  const std::vector<BrokenOne> broken = {
      {"no program", "", "it ended with exit code"},
      {"no header", "print('hello', flush=True)\n", ":1:1: error: milk: found no JSON object"},
      {"another version", "print('{\"recogniser\": 2}')\n", "says no \"recogniser\": 1"},
      {"unknown fact", Python("", "", "'touch'"), "did you mean 'touches'?"},
      {"silent", Python("    time.sleep(60)\n"), "no end within 1 s", {limit, "1"}},
      {"silent online",
       Python("    continue\n"),
       "no answer to tick",
       {limit, "1", "--pace", "online"}},
      {"endless",
       Python("    while True: say({'begin': 'x'})\n"),
       "no end within 1 s|it has printed more than 64 MiB",
       {limit, "1"}},
      {"goes on after the end",
       Python("", "") + "time.sleep(60)\n",
       "no end within 1 s",
       {limit, "1"}},
      {"closes and stays",
       Python("", "") + "os.close(1); os.close(2); time.sleep(60)\n",
       "no end within 1 s|it has not ended 10 s after its output",
       {limit, "1"}},
      {"crash at frame 50", Python("    if count == 51: raise KeyError('frame 50')\n"),
       "it ended with exit code 1; tick "},
      {"leaves at frame 50", Python("    if count == 51: raise SystemExit(0)\n"),
       "it ended with exit code 0 before it had read all; tick "},
      {"in the future", Python("    grasp['end_tick'] = tick + 100000; say(grasp)\n"),
       "the event lies at 0 to "},
      {"unknown entity", Python("    grasp['roles']['object'] = 'milc'; say(grasp)\n"),
       "the episode has no entity 'milc'"},
      {"unknown event", Python("    grasp['event'] = 'graspin'; say(grasp)\n"),
       "its first line has no event 'graspin'"},
      {"a hand that is none",
       Python("    if tick < 0 < count - 1: say(dict(grasp, roles={'hand': 'milk', 'object': "
              "'right_hand'}))\n"),
       "'milk' is never 'hand' of 'grasping', which takes a Hand"},
      {"printed twice", Python("    if tick < 0 < count - 1: say(grasp); say(grasp)\n"),
       "it has printed this event before"},
      {"a role is missing", Python("    del grasp['roles']['hand']; say(grasp)\n"),
       "grasping has the roles hand, object"},
      {"half a tick", Python("    grasp['end_tick'] = 0.5; say(grasp)\n"),
       "end_tick: found 0.5, wanted a whole number"},
      {"empty", Python("    grasp['end_tick'] = 0; say(grasp)\n"), "ends after it begins"},
      {"a line of 10 MB", Python("    say({'begin': 'x' * 10_000_000})\n"),
       "the line has more than 1 MiB"},
      {"writes before it reads",
       "print('{\"recogniser\": 1, \"events\": {\"grasping\": [\"hand\", \"object\"]}}\\n'\n"
       "      '{\"event\": \"grasping\", \"roles\": {\"hand\": \"right_hand\", \"object\": "
       "\"milk\"}, \"begin_tick\": 0, \"end_tick\": 9}', flush=True)\n"
       "import sys\nfor line in sys.stdin: pass\n",
       ":2:1: error: milk: the event lies at 0 to 9, and what it has got at 0 to 0"},
      {"gives up", Python("    say({'error': 'no model'})\n"), "it gave up: \"no model\""},
      {"no protocol", Python("    say({'hello': 1})\n"), "found none of \"event\""},
      {"half a line", Python("", "") + "sys.stdout.write('{')\n", "its last line has no end"},
      {"forks",
       Python("    raise SystemExit(3)\n",
              "for new in (True, False): subprocess.Popen([sys.executable, '-c', "
              "'import time; time.sleep(300)', sys.argv[0]], start_new_session=new)\n"),
       "it ended with exit code 3"}};
  for (const BrokenOne& one : broken) {
    const auto begin = std::chrono::steady_clock::now();
    const Said said =
        Score(take, one.program.empty() ? "no-such-program-here" : Program(one.program), one.more);
    const double took_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    EXPECT_EQ(said.exit_code, 2) << one.name << said.err;
    EXPECT_EQ(said.out, "") << one.name << ": a table of nothing";
    EXPECT_EQ(Has(said.err, "prehend: milk was not scored by "), "") << one.name;
    bool is_named = false;
    for (std::size_t at = 0; at <= one.says.size();) {
      const std::size_t end = std::min(one.says.find('|', at), one.says.size());
      is_named |= said.err.find(one.says.substr(at, end - at)) != std::string::npos;
      at = end + 1;
    }
    EXPECT_TRUE(is_named) << one.name << ": " << said.err;
    EXPECT_LT(said.err.size(), 6000u) << one.name;
    EXPECT_LT(took_s, 20) << one.name;
    EXPECT_EQ(StillRuns(Path("reco.py")), "") << one.name;
  }
}

TEST_F(Recognisers, AreCheckedAgainstGoldens) {
  const std::string scenario = "grasp/short_grasp_counts", run = Path("run.jsonl"), take = Take();
  const auto check = [&](const std::string& episode, const std::string& command) {
    return Prehend(
        {"check", episode, "--recogniser", command, "--no-pictures", "--report", Path("page")});
  };
  ASSERT_EQ(Prehend({"run", scenario, "--record", run}).exit_code, 0);
  const std::string repeats = RepeatsWatch("pick_and_place", EventsOf(run)),
                    distance = std::string("python3 -B ") + kExamples + "distance.py";
  const Said same = check(scenario, Program(repeats));
  EXPECT_EQ(same.exit_code, 0) << same.out;
  const Said other = check(scenario, distance);
  EXPECT_EQ(other.exit_code, 1) << other.err;
  EXPECT_EQ(Has(other.out, "not covered by the recogniser: contact, fixation, reaching, "), "");
  EXPECT_EQ(Has(other.out, "shifted grasping(right_hand, milk)\n"), "");
  EXPECT_EQ(Has(other.out, "again: prehend check " + scenario + " --recogniser 'python3"), "");
  const Said broken = check(scenario, "exit 3");
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_EQ(Has(broken.out, "the recogniser failed"), "");
  EXPECT_EQ(broken.out.find("missing"), std::string::npos) << "it found nothing, for all we know";

  EXPECT_EQ(check(take, distance).exit_code, 5) << "there is no golden";
  ASSERT_EQ(Prehend({"accept", take, "--reason", "seen"}, {"CI="}).exit_code, 0);
  const Said good = check(take, Program(RepeatsWatch(kGrammar, EventsOf(take))));
  EXPECT_EQ(good.exit_code, 0) << good.out;
  EXPECT_EQ(check(take, distance).exit_code, 1);
  EXPECT_EQ(check(take, "exit 3").exit_code, 2);
}

TEST_F(Recognisers, AreOnThePageOfEpisodesAndBesideTheGrammar) {
  const std::string kept = Path("kept.episodes"), page = Path("page.html"),
                    distance = std::string("python3 -B ") + kExamples + "distance.py";
  ASSERT_EQ(Prehend({"check", "grasp/short_grasp_counts", "--record", kept, "--no-pictures",
                     "--report", Path("report")})
                .exit_code,
            0);
  const Said said = Prehend({"report", kept, "--recogniser", distance, "-o", page, "--json"});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(json::parse(said.out)["failed"], 1);
  EXPECT_EQ(Has(ReadFile(page), "shifted grasping(right_hand, milk)"), "");
  const Said broken = Prehend({"report", kept, "--recogniser", "exit 3", "-o", page});
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_EQ(Has(broken.err, "the recogniser failed"), "");
  const auto against = [&](const std::string& command) {
    return Prehend({"render", kept, "--against", command, "-o", Path("two.svg")});
  };
  EXPECT_EQ(against(distance).exit_code, 0);
  EXPECT_EQ(Has(ReadFile(Path("two.svg")), "grasping (recogniser)"), "");
  EXPECT_EQ(against("exit 3").exit_code, 2);
}

TEST_F(Recognisers, AFailedEpisodeIsInNoFigure) {
  const std::string one = Take(), two = Path("other.jsonl");
  fs::copy_file(one, two);
  const std::string command = Program(
      Python("    if os.environ['PREHEND_EPISODE'] == 'other': sys.exit('no frames for me')\n"));
  const Said said = Prehend({"score", one, two, "--truth", docs_ + "/labels.csv", "--truth",
                             docs_ + "/labels.csv", "--map", docs_ + "/labels.yaml", "--grammar",
                             kGrammar, "--recogniser", command, "--json"});
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(Has(said.err, "other was not scored by python3"), "");
  EXPECT_EQ(Has(said.err, "its last words: no frames for me"), "");
  const json both = json::parse(said.out)["grammars"];
  EXPECT_EQ(both[0]["episodes"], 2);
  EXPECT_EQ(both[1]["episodes"], 1);
  EXPECT_EQ(both[1]["failed"], json({"other"}));
}

TEST_F(Recognisers, AnEntityOfAnotherClassFailsItAndNotTheGrammar) {
  const std::string command =
      Program(Python("    if 'end_tick' in line: say(dict(grasp, roles={'hand': 'milk', 'object': "
                     "'right_hand'}))\n"));
  const Said alone = Prehend({"score", Take(), "--truth", docs_ + "/labels.csv", "--map",
                              docs_ + "/labels.yaml", "--grammar", kGrammar, "--json"});
  const Said said = Score(Take(), command, {"--grammar", kGrammar, "--json"});
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(Has(said.err, "prehend: milk was not scored by python3"), "");
  EXPECT_EQ(Has(said.err, ":312:1: error: 'milk' is never 'hand' of 'grasping'"), "");
  EXPECT_EQ(json::parse(said.out)["grammars"][0], json::parse(alone.out)["grammars"][0]);
}

TEST_F(Recognisers, OneProcessForAllEpisodes) {
  const std::string one = Take(), two = Path("other.jsonl");
  fs::copy_file(one, two);
  const std::string program =
      "import json, os, sys\n"
      "def say(line): print(json.dumps(line), flush=True)\n"
      "say({'recogniser': 1, 'events': {'grasping': ['hand', 'object']}, 'batch': True})\n"
      "name = None\n"
      "for line in map(json.loads, sys.stdin):\n"
      "    name = line.get('episode', name) if 'recording' not in line else name\n"
      "    if 'end_tick' not in line: continue\n"
      "    say({'event': 'grasping', 'roles': {'hand': 'right_hand', 'object': 'milk'},\n"
      "         'begin_tick': 0, 'end_tick': line['end_tick']})\n"
      "    sys.stderr.write(f'{name} {os.getpid()}\\n')\n"
      "    say({'done': name})\n";
  const Said said = Prehend({"score", one, two, "--truth", docs_ + "/labels.csv", "--truth",
                             docs_ + "/labels.csv", "--map", docs_ + "/labels.yaml", "--recogniser",
                             Program(program), "--json"});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(json::parse(said.out)["grammars"][0]["total"]["found"], 2);
  // Its two lines may come at once, after the second episode has begun.
  const auto process = [&](const std::string& name) {
    std::smatch found;
    EXPECT_TRUE(std::regex_search(said.err, found, std::regex("\\b" + name + " ([0-9]+)\n")));
    return found.str(1);
  };
  EXPECT_EQ(process("milk"), process("other")) << said.err;
}

TEST_F(Recognisers, ATrySaysRuleByRule) {
  const std::string take = Take();
  const auto tried = [&](const std::string& command, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"grammar", "recogniser", command, take});
    return Prehend(more);
  };
  const std::string distance = std::string("python3 -B ") + kExamples + "distance.py";
  const Said good = tried(distance, {"--pace", "online"});
  EXPECT_EQ(good.exit_code, 0) << good.out << good.err;
  EXPECT_EQ(Has(good.out, "met        again: "), "");
  EXPECT_EQ(good.out.find("not "), good.out.find("not give up")) << good.out;
  EXPECT_EQ(Has(tried(distance).out, "not tried  ready: "), "");
  const Said bad = tried(Program(Python("    grasp['end_tick'] = 10**9; say(grasp)\n")));
  EXPECT_EQ(bad.exit_code, 1) << bad.err;
  EXPECT_EQ(Has(bad.out, "met        header: "), "");
  EXPECT_EQ(Has(bad.out, "not met    ticks: "), "");
  EXPECT_EQ(Has(bad.out, "reco.py:2:1: error: milk: the event lies at 0 to 1000000000"), "");
  const Said random = tried(Program(Python("    say({'begin': str(time.time_ns())})\n")));
  EXPECT_EQ(random.exit_code, 1);
  EXPECT_EQ(Has(random.out, "not met    again: "), "");
}

TEST_F(Recognisers, RealTimeKeepsThePaceOfTheRecording) {
  const std::string take = Take();
  const auto begin = std::chrono::steady_clock::now();
  const Said said = Score(take, Program(Python("    if count == 20: time.sleep(0.3)\n")),
                          {"--pace", "real_time", "--json"});
  const double took_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_GT(took_s, 5);
  EXPECT_EQ(Has(said.err, " answers came after the next frame"), "");
}

// Half a second lies between its last frame and its end.
TEST_F(Recognisers, InRealTimeTheEndComesAtItsTimeAndNothingIsLate) {
  std::string take =
      "{\"recording\": 1, \"episode\": \"e\", \"ticks_per_second\": 10, \"entities\": {\"cup\": "
      "{\"class\": \"Cup\", \"size_m\": [0.1, 0.1, 0.1]}, \"hand\": {\"hand\": true, \"size_m\": "
      "[0, 0, 0]}}}\n";
  for (int i = 0; i < 3; ++i)
    take += "{\"tick\": " + std::to_string(i) +
            ", \"samples\": {\"cup\": {\"at_m\": [1, 0, 0.8]}, \"hand\": {\"at_m\": [0, 0, 1]}}}\n";
  WriteFile(folder_ / "late_end.jsonl", take + "{\"end_tick\": 7}\n");
  const auto begin = std::chrono::steady_clock::now();
  const Said said = Prehend({"grammar", "recogniser", Program(Python("")),
                             (folder_ / "late_end.jsonl").string(), "--pace", "real_time"});
  EXPECT_GT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 0.65);
  EXPECT_EQ(said.err.find("came after the next frame"), std::string::npos) << said.err;
}

TEST_F(Recognisers, ManyScenariosTakeLittleTime) {
  const std::string distance = std::string("python3 -B ") + kExamples + "distance.py";
  const Said without = Prehend({"score", "grasp/*", "--json"});
  const Said with = Prehend({"score", "grasp/*", "--recogniser", distance, "--json"});
  ASSERT_EQ(with.exit_code, 0) << with.err;
  const json scores = json::parse(with.out)["grammars"];
  EXPECT_EQ(scores[0]["episodes"], json::parse(without.out)["grammars"][0]["episodes"]);
  EXPECT_GT(scores[0]["total"]["found"], 10);
  EXPECT_LT(scores[0]["cpu_s_per_s"], 1);
}

}  // namespace
}  // namespace prehend::house
