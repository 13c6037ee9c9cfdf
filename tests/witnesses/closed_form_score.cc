// SPDX-License-Identifier: Apache-2.0
#include "tests/witnesses/closed_form_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "harness/episode/run/run_scenario.h"
#include "harness/episode/run/segment_recording.h"
#include "harness/truth/oracle/oracle.h"

namespace prehend::witnesses {
namespace {

using Json = nlohmann::ordered_json;

/// Of each evaluator; a grammar of other definitions has hundreds.
constexpr std::size_t kMaxWrongLines = 25;

std::string NameOf(const JudgedEvent& event) {
  return event.label.substr(0, event.label.find('('));
}

bool Counts(const JudgedEvent& event, const std::string& name) {
  return name.empty() || NameOf(event) == name;
}

std::string Share(int right, int all) {
  return fmt::format("{} of {} ({:.1f} %)", right, all, all == 0 ? 100.0 : 100.0 * right / all);
}

/// One event of one story, over its samplings.
struct WrongInSamplings {
  std::set<std::string> samplings;
  int missing = 0, extra = 0;
  double begin_s = 0, end_s = 0;  ///< the largest offsets of wrong boundaries

  void Add(const std::string& sampling, const JudgedEvent& event) {
    samplings.insert(sampling);
    missing += !event.begin.recognised_s;
    extra += !event.begin.expected_s;
    const auto keep = [](const JudgedBoundary& boundary, double& largest_s) {
      if (!boundary.right && std::abs(boundary.OffsetS()) > std::abs(largest_s))
        largest_s = boundary.OffsetS();
    };
    keep(event.begin, begin_s);
    keep(event.end, end_s);
  }

  std::string Text() const {
    std::string text;
    const auto add = [&](const std::string& more) { text += (text.empty() ? "" : ", ") + more; };
    if (begin_s != 0) add(fmt::format("begin {:+.1f} ms", 1000 * begin_s));
    if (end_s != 0) add(fmt::format("end {:+.1f} ms", 1000 * end_s));
    if (missing > 0) add(fmt::format("{} not recognised", missing));
    if (extra > 0) add(fmt::format("{} where there is none", extra));
    return text;
  }
};

std::string WrongText(const ClosedFormScore& score) {
  std::map<std::pair<std::string, std::string>, WrongInSamplings> wrong;
  std::map<std::string, int> samplings;
  for (const ClosedFormRow& row : score.rows) {
    ++samplings[row.form];
    for (const JudgedEvent& event : row.events)
      if (!event.begin.right || !event.end.right)
        wrong[{row.form, event.label}].Add(row.sampling, event);
  }
  std::string text;
  std::size_t lines = 0;
  for (const auto& [what, found] : wrong) {
    if (lines++ == kMaxWrongLines) break;
    text += fmt::format("  {}: {}: in {} of {} samplings: {}\n", what.first, what.second,
                        found.samplings.size(), samplings[what.first], found.Text());
  }
  if (wrong.size() > kMaxWrongLines)
    text += fmt::format("  and {} more; --json has all\n", wrong.size() - kMaxWrongLines);
  return text.empty() ? "" : "\nwrong in " + score.evaluator + "\n" + text;
}

Json BoundaryJson(const JudgedBoundary& boundary) {
  const auto number = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json();
  };
  return {{"expected_s", number(boundary.expected_s)},
          {"recognised_s", number(boundary.recognised_s)},
          {"right", boundary.right}};
}

}  // namespace

ClosedFormEvaluator EvaluatedGrammar(const std::string& name,
                                     std::shared_ptr<const grammar::Program> program) {
  return {name, [program](const ClosedFormRecording& recording) {
            grammar::Timeline found =
                episode::Resegment(recording.scenario, recording.frames, program, recording.end);
            std::erase_if(found.events,
                          [](const auto& event) { return !truth::OracleDefines(event); });
            return found;
          }};
}

ClosedFormEvaluator EvaluatedOracle(const truth::OracleSettings& settings) {
  return {"oracle", [settings](const ClosedFormRecording& recording) {
            return truth::TrueTimeline(recording.scenario.scene, recording.frames, recording.end,
                                       settings);
          }};
}

int ClosedFormScore::Boundaries(const std::string& event) const {
  int boundaries = 0;
  for (const ClosedFormRow& row : rows)
    for (const JudgedEvent& judged : row.events) boundaries += Counts(judged, event) ? 2 : 0;
  return boundaries;
}

int ClosedFormScore::Right(const std::string& event) const {
  int right = 0;
  for (const ClosedFormRow& row : rows)
    for (const JudgedEvent& judged : row.events)
      if (Counts(judged, event)) right += judged.begin.right + judged.end.right;
  return right;
}

Result<std::vector<ClosedFormScore>> ScoreOnClosedForms(
    const std::vector<std::string>& files, const std::vector<ClosedFormEvaluator>& evaluators) {
  std::vector<ClosedFormScore> scores;
  for (const ClosedFormEvaluator& evaluator : evaluators) scores.push_back({evaluator.name, {}});
  for (const std::string& file : files) {
    const Result<ClosedForm> form = ReadClosedForm(file);
    if (!form) return tl::unexpected(form.error());
    for (const ClosedFormRecording& recording : form->recordings)
      for (std::size_t i = 0; i < evaluators.size(); ++i)
        scores[i].rows.push_back(
            {form->name, recording.sampling,
             ClosedFormAgreement(form->truth, recording, evaluators[i].recognise(recording))});
  }
  return scores;
}

std::string ClosedFormText(const std::vector<ClosedFormScore>& scores) {
  if (scores.empty()) return "";
  std::vector<std::string> names = {""};
  for (const std::string_view name : truth::OracleEvents()) names.emplace_back(name);
  std::string text = fmt::format("{:<16}", "boundaries");
  for (const ClosedFormScore& score : scores) text += fmt::format("  {:>22}", score.evaluator);
  text += "\n";
  for (const std::string& name : names) {
    text += fmt::format("{:<16}", name.empty() ? "all" : name);
    for (const ClosedFormScore& score : scores)
      text += fmt::format("  {:>22}", Share(score.Right(name), score.Boundaries(name)));
    text += "\n";
  }
  for (const ClosedFormScore& score : scores) text += WrongText(score);
  return text + fmt::format(
                    "\nRight is within one frame of what docs/events.md gives on paper, in "
                    "{} recordings (tests/witnesses/README.md).\n",
                    scores.front().rows.size());
}

Json ClosedFormJson(const std::vector<ClosedFormScore>& scores) {
  Json all = Json::array();
  for (const ClosedFormScore& score : scores) {
    Json wrong = Json::array();
    for (const ClosedFormRow& row : score.rows)
      for (const JudgedEvent& event : row.events)
        if (!event.begin.right || !event.end.right)
          wrong.push_back({{"closed_form", row.form},
                           {"sampling", row.sampling},
                           {"event", event.label},
                           {"begin", BoundaryJson(event.begin)},
                           {"end", BoundaryJson(event.end)}});
    all.push_back({{"name", score.evaluator},
                   {"recordings", score.rows.size()},
                   {"boundaries", score.Boundaries()},
                   {"right", score.Right()},
                   {"wrong", std::move(wrong)}});
  }
  return {{"closed_forms", std::move(all)}};
}

measure::Evaluation ByClosedForms(const ClosedFormScore& score) {
  measure::Evaluation evaluation;
  for (const ClosedFormRow& row : score.rows)
    for (const JudgedEvent& event : row.events)
      evaluation.by_event[NameOf(event)] +=
          {.of = 2, .confirmed = event.begin.right + event.end.right};
  return evaluation;
}

std::string EvaluatorTableWith(const nlohmann::json& score,
                               const std::vector<ClosedFormScore>& closed_forms) {
  std::vector<std::string> grammars;
  std::vector<measure::Evaluator> evaluators;
  for (const auto& row : score.at("witnesses")) {
    measure::Evaluator& evaluator = evaluators.emplace_back(row.at("witness"), row.at("proves"));
    grammars.clear();
    for (const auto& column : row.at("grammars")) {
      grammars.push_back(column.at("grammar"));
      evaluator.of_grammars.emplace_back().by_event["all"] = {.of = column.at("of"),
                                                              .confirmed = column.at("confirmed")};
    }
  }
  measure::Evaluator& paper =
      evaluators.emplace_back("closed forms", "boundaries known on paper are found to the frame");
  for (const std::string& grammar : grammars)
    paper.of_grammars.push_back(
        ByClosedForms(*std::ranges::find(closed_forms, grammar, &ClosedFormScore::evaluator)));
  return measure::EvaluatorTable(grammars, evaluators);
}

}  // namespace prehend::witnesses
