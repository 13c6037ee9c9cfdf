// SPDX-License-Identifier: Apache-2.0
// The suite goes on, and says what is true, whatever one of its scenarios does.
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <thread>
#include <vector>

#include "tests/program/small_project.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class Runner : public SmallProject {
 protected:
  /// What `check` says, by scenario.
  std::map<std::string, Json> Check(const std::string& options, int exit_code) const {
    const Said said = Do("check --no-pictures --json " + options);
    EXPECT_EQ(said.exit_code, exit_code) << options << "\n" << said.err << said.out;
    std::map<std::string, Json> verdicts;
    const Json summary = Json::parse(said.out);
    for (const Json& scenario : summary.at("scenarios"))
      verdicts[scenario.at("scenario")] = scenario;
    return verdicts;
  }
  std::string VerdictOfTheRest(const std::string& options) const {
    return Check(options, 0).at("rest/carton_rests").at("verdict");
  }
};

#ifndef __SANITIZE_ADDRESS__  // it has no memory limit, and is too slow to be killed in time

struct Process {
  pid_t id = 0, parent = 0;
  long cpu_ticks = 0;
};

/// Those called prehend. /proc/ID/stat is "ID (NAME) STATE PARENT ..", field 14 is the user time.
std::vector<Process> PrehendProcesses() {
  std::vector<Process> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::ifstream stat(entry.path() / "stat");
    Process process;
    std::string name, skipped;
    if (!(stat >> process.id >> name) || name != "(prehend)") continue;
    stat >> skipped >> process.parent;
    for (int field = 5; field < 14; ++field) stat >> skipped;
    stat >> process.cpu_ticks;
    found.push_back(process);
  }
  return found;
}

/// A worker of the check of this project that has already worked for two seconds; 0 when there is
/// none.
pid_t BusyWorker(const fs::path& root) {
  const std::vector<Process> all = PrehendProcesses();
  for (const Process& process : all) {
    const bool is_worker = std::any_of(all.begin(), all.end(),
                                       [&](const Process& p) { return p.id == process.parent; });
    const std::string environment = ReadFile("/proc/" + std::to_string(process.id) + "/environ");
    const bool is_ours = environment.find("PREHEND_HOME=" + root.string()) != std::string::npos;
    if (is_worker && is_ours && process.cpu_ticks >= 2 * sysconf(_SC_CLK_TCK)) return process.id;
  }
  return 0;
}

TEST_F(Runner, AKilledWorkerIsAVerdictOfItsOwn) {
  Accept();
  WriteVariant("long/takes_long", "wait_s: 0.2", "wait_s: 600");
  std::atomic<bool> over = false;
  std::thread killer([&] {
    for (pid_t worker = 0; worker == 0 && !over;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      worker = BusyWorker(root_);
      if (worker != 0) kill(worker, SIGKILL);
    }
  });
  const auto verdicts = Check("--jobs 2 --time-limit-s 500", 3);
  over = true;
  killer.join();
  EXPECT_EQ(verdicts.at("rest/carton_rests").at("verdict"), "passed");
  const std::string reason = verdicts.at("long/takes_long").at("reason");
  EXPECT_TRUE(std::regex_match(
      reason, std::regex("its process ended: was killed \\(signal 9: by a user, or "
                         "by the system because memory ran out\\) at \\d+ MB of "
                         "memory, limit 1000 MB, last tick \\d+")))
      << reason;
  EXPECT_GT(verdicts.at("long/takes_long").at("ticks"), 100);
}

TEST_F(Runner, AScenarioThatNeverEndsIsStopped) {
  Accept();
  WriteVariant("long/takes_long", "wait_s: 0.2", "wait_s: 600");
  const auto verdicts = Check("--time-limit-s 3", 3);
  EXPECT_EQ(verdicts.at("rest/carton_rests").at("verdict"), "passed");
  const std::string reason = verdicts.at("long/takes_long").at("reason");
  EXPECT_TRUE(reason.starts_with("its process ended: no end after 3 s, last tick ")) << reason;
  EXPECT_EQ(verdicts.at("long/takes_long").at("command"),
            "prehend check long/takes_long --no-pictures --time-limit-s 3 --memory-limit-mb 1000");
}

TEST_F(Runner, AScenarioThatWantsMoreAndMoreMemoryIsStopped) {
  Accept();
  WriteVariant("long/takes_much", "wait_s: 0.2", "wait_s: 600");
  const auto verdicts = Check("--memory-limit-mb 20", 3);
  EXPECT_EQ(verdicts.at("rest/carton_rests").at("verdict"), "passed");
  const std::string reason = verdicts.at("long/takes_much").at("reason");
  EXPECT_TRUE(reason.starts_with("its process ended: it needs more memory than 20 MB, last tick "))
      << reason;
}

TEST_F(Runner, TooLittleMemoryIsSaidHoweverLittleItIs) {
  Accept();
  const std::regex reason(
      "its process ended: (it needs more memory than \\d+ MB|\\d+ MB of memory are too little for "
      "it to start, which takes \\d+ MB|(crashed \\(segmentation fault, signal 11\\)|aborted "
      "\\(signal 6\\)) at \\d+ MB of memory, limit \\d+ MB), (before the first tick|last tick "
      "\\d+)");
  bool some_passed = false;
  for (const int limit_mb : {1, 3, 5, 8, 11, 15, 400}) {
    const Said said = Do("check --json --memory-limit-mb " + std::to_string(limit_mb));
    const Json verdict = Json::parse(said.out).at("scenarios")[0];
    EXPECT_EQ(said.err, "");
    if (verdict.at("verdict") == "passed") {
      some_passed = true;
    } else {
      EXPECT_EQ(said.exit_code, 3);
      EXPECT_TRUE(std::regex_match(std::string(verdict.at("reason")), reason))
          << verdict.at("reason");
      const std::string details = verdict.at("details");
      EXPECT_TRUE(details.empty() || details.starts_with("its standard error:\n")) << details;
    }
  }
  EXPECT_TRUE(some_passed);
}

#endif

TEST_F(Runner, WhatCannotBeWrittenIsSaidBeforeAnythingRuns) {
  WriteFile(root_ / "a_file", "");
  for (const std::string& options :
       {"--junit " + (root_ / "a_file/x.xml").string(), "--report " + (root_ / "a_file").string(),
        "--junit " + root_.string()}) {
    const Said said = Do("check --no-pictures " + options);
    EXPECT_EQ(said.exit_code, 2) << options;
    EXPECT_EQ(said.out, "");
    EXPECT_FALSE(fs::exists(Pending())) << options;
  }
}

TEST_F(Runner, AProposalThatIsNotLeftIsSaid) {
  WriteFile(root_ / "build/pending", "no folder");
  const Said said = Do("check --no-pictures");
  EXPECT_EQ(said.exit_code, 5);
  EXPECT_NE(said.out.find("    no proposal is left: "), std::string::npos) << said.out;
  EXPECT_NE(said.out.find("build/pending"), std::string::npos) << said.out;
}

TEST_F(Runner, VerdictsAreNotLostWithTheFileTheyWereToBeWrittenTo) {
  Accept();
  const std::string page = (root_ / "build/report/index.html").string();
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{2048, before.rlim_max};  // the page is larger
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const Said said = Do("check --no-pictures");
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(said.exit_code, 3);
  EXPECT_NE(said.out.find("1 passed, 0 failed"), std::string::npos) << said.out;
  EXPECT_EQ(said.err, "prehend: cannot write " + page +
                          ": not all of it could be written; is the disk full?\n  again: prehend "
                          "check --no-pictures\n");
}

TEST_F(Runner, FilesAreCheckedToo) {
  Accept();
  const fs::path loose = root_ / "my own/carton_waits.yaml";
  WriteFile(loose, std::regex_replace(std::string(kCartonRests), std::regex("carton_rests"),
                                      "carton_waits"));
  const std::vector<std::string> environment = {"PREHEND_HOME=" + root_.string()};
  const Said said = Prehend(
      {"check", "--no-pictures", "--json", loose.string(), Scenario().string(), "carton_rests"},
      environment);
  EXPECT_EQ(said.exit_code, 5) << said.err;
  const Json scenarios = Json::parse(said.out).at("scenarios");
  ASSERT_EQ(scenarios.size(), 2u) << "by name and by file it is the same";
  EXPECT_EQ(scenarios[0].at("scenario"), "rest/carton_rests");
  EXPECT_EQ(scenarios[0].at("verdict"), "passed");
  EXPECT_EQ(scenarios[1].at("scenario"), loose.string());
  EXPECT_EQ(scenarios[1].at("verdict"), "pending");
  EXPECT_EQ(scenarios[1].at("reason"),
            "no golden: only scenarios in scenarios/ of this project have one");
  EXPECT_EQ(scenarios[1].at("command"), "prehend check '" + loose.string() + "'");
  EXPECT_FALSE(fs::exists(root_ / "build/pending"));
  EXPECT_EQ(Prehend({"score", loose.string()}, environment).exit_code, 0);
  EXPECT_EQ(Prehend({"check", "missing.yaml"}, environment).exit_code, 2);
}

TEST_F(Runner, APhysicalCalamityIsAVerdict) {
  Accept();
  // A fly under an anvil: their masses differ by more than the solver can bear.
  WriteVariant(
      "crush/anvil_on_a_fly", "\nactors:",
      "\n  anvil: {box: {size_m: [0.3, 0.3, 0.3]}, mass_kg: 1000, on: carton, at_m: [0.15, 0.15]}"
      "\nactors:");
  const auto verdicts = Check("--set entities.carton.mass_kg=0.001", 3);
  EXPECT_EQ(verdicts.at("rest/carton_rests").at("verdict"), "passed");
  EXPECT_EQ(verdicts.at("crush/anvil_on_a_fly").at("reason"), "the simulation failed");
  EXPECT_EQ(verdicts.at("crush/anvil_on_a_fly").at("exit_code"), 3);
}

TEST_F(Runner, WhatNothingChangedForIsNotRunAgain) {
  EXPECT_EQ(Check("--changed", 5).at("rest/carton_rests").at("verdict"), "pending");
  Accept();
  EXPECT_EQ(VerdictOfTheRest("--changed"), "passed") << "a pending one is not kept";
  EXPECT_EQ(VerdictOfTheRest("--changed"), "unchanged");
  EXPECT_EQ(VerdictOfTheRest(""), "passed") << "only when asked for";

  for (const char* file :
       {"scenarios/rest/carton_rests.yaml", "grammar/library/contact.grammar",
        "physics/library/human_right.hand.yaml", "physics/library/human.grasps.yaml",
        "golden/rest/carton_rests.timeline"}) {
    WriteFile(root_ / file, ReadFile(root_ / file) + "# more\n");
    EXPECT_EQ(VerdictOfTheRest("--changed"), "passed") << file;
    EXPECT_EQ(VerdictOfTheRest("--changed"), "unchanged") << file;
  }
  WriteFile(root_ / "physics/library/human_left.hand.yaml", "nobody here has a left hand\n");
  EXPECT_EQ(VerdictOfTheRest("--changed"), "unchanged");
  WriteFile(root_ / "build/check/rest/carton_rests.json", "{damaged");
  EXPECT_EQ(VerdictOfTheRest("--changed"), "passed");
}

TEST_F(Runner, EveryScenarioIsInOneShard) {
  WriteVariant("rest/b", "wait_s: 0.2", "wait_s: 0.1");
  WriteVariant("other/c", "wait_s: 0.2", "wait_s: 0.1");
  std::multiset<std::string> seen;
  for (const char* shard : {"1/2", "2/2"}) {
    for (const auto& [id, verdict] : Check(std::string("--shard ") + shard, 5)) seen.insert(id);
  }
  EXPECT_EQ(seen, (std::multiset<std::string>{"other/c", "rest/b", "rest/carton_rests"}));
}

TEST_F(Runner, RepeatedRunsInAnyOrderAgree) {
  Accept();
  WriteVariant("rest/b", "wait_s: 0.2", "wait_s: 0.1");
  Accept("rest/b");
  for (const auto& [id, verdict] : Check("--repeat 5 --shuffle 7", 0))
    EXPECT_EQ(verdict.at("verdict"), "passed");
}

TEST_F(Runner, JunitXmlIsWrittenForTheServer) {
  Accept();
  const fs::path file = root_ / "verdicts.xml";
  Check("--junit " + file.string(), 0);
  const std::string xml = ReadFile(file);
  EXPECT_TRUE(xml.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites ")) << xml;
  EXPECT_NE(xml.find("<testcase classname=\"rest\" name=\"carton_rests\" file=\""),
            std::string::npos);
  EXPECT_NE(xml.find("scenarios/rest/carton_rests.yaml\" line=\"1\" time="), std::string::npos);
}

TEST_F(Runner, AnEmptyShardPassesWithAnEmptyFileForTheServer) {
  Accept();
  const fs::path file = root_ / "verdicts.xml";
  EXPECT_TRUE(Check("--shard 2/2 --junit " + file.string(), 0).empty());
  EXPECT_NE(ReadFile(file).find("<testsuites name=\"prehend\" tests=\"0\""), std::string::npos);
}

}  // namespace
}  // namespace prehend::house
