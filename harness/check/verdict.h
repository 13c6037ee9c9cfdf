// SPDX-License-Identifier: Apache-2.0
// What `prehend check` found out about one scenario, as a value that travels from the worker to the
// report. Tested by tests/harness/check/verdict_test.cc
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/base/content_hash.h"
#include "harness/base/exit_code.h"

namespace prehend::harness {

enum class Verdict {
  kPassed,
  kFailed,
  kPending,    ///< there is no golden yet
  kFlaky,      ///< repeated runs did not agree
  kUnchanged,  ///< passed before, and nothing that it depends on changed since: not run again
};

/// "passed", "failed", ...
std::string_view Name(Verdict verdict);

struct ReportedPicture {
  std::string file;  ///< relative to the report
  std::string caption;
};

/// How near a boundary comes to its tolerance.
struct BoundaryRoom {
  std::string boundary;  ///< "begin of reaching(right_hand, milk)"
  double offset_ms = 0;  ///< recognised - expected
  double tolerance_ms = 0;
};

struct ScenarioVerdict {
  std::string scenario;  ///< skill/name
  std::string shows;
  Verdict verdict = Verdict::kFailed;
  ExitCode exit_code = ExitCode::kAgrees;  ///< what a check of this scenario alone ends with
  std::string reason;                      ///< one line; empty when passed
  std::string details;  ///< differences, violations, diagnostics; several lines or empty
  nlohmann::ordered_json differences = nlohmann::ordered_json::array();  ///< DifferencesJson()
  nlohmann::ordered_json relations = nlohmann::ordered_json::array();    ///< RelationsJson()
  std::string blame;                     ///< BlameText(): whose doing the differences are; or empty
  std::string headroom;                  ///< HeadroomText()
  std::vector<BoundaryRoom> boundaries;  ///< of all matched events
  std::string command;                   ///< shows it again; of what is pending, what to accept
  std::string state_hash;
  std::int64_t ticks = 0;
  double seconds = 0;                ///< wall time in its worker
  std::int64_t peak_memory_kib = 0;  ///< of its worker
  FileHashes inputs;  ///< every file that decides what the verdict is, as it was before the run
  std::vector<ReportedPicture> pictures;
  std::string picture_differences;  ///< several lines; only one of several repetitions draws
  std::string timeline_svg;
};

/// What stands before its command: "again", or "next" of one that leads on.
std::string_view CommandLabel(const ScenarioVerdict& verdict);

/// Both directions; the JSON of a verdict from a worker has all fields.
nlohmann::ordered_json ToJson(const ScenarioVerdict& verdict);
ScenarioVerdict VerdictFromJson(const nlohmann::ordered_json& json);

/// What runs of one scenario, or a single one, come to: their common verdict, or kFlaky when they
/// differ in anything but time, memory and pictures. Of these the largest is kept. What passed in
/// all fails when a picture differs. Needs at least one.
ScenarioVerdict MergeRepeats(const std::vector<ScenarioVerdict>& runs);

struct Tally {
  int passed = 0, failed = 0, pending = 0, unchanged = 0;  ///< `failed` has the flaky ones, too
};
Tally Count(const std::vector<ScenarioVerdict>& verdicts);

/// The boundary that is nearest to its tolerance, of those that are off at all:
/// "least headroom: 4.2 of 8.3 ms are left at .. of SCENARIO"; "" when none is.
std::string LeastHeadroomText(const std::vector<ScenarioVerdict>& verdicts);

/// How the whole check ends: the worst of its scenarios.
ExitCode WorstOf(const std::vector<ScenarioVerdict>& verdicts);

}  // namespace prehend::harness
