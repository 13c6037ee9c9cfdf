// SPDX-License-Identifier: Apache-2.0
// Lists of steps, and the keys name, after and with: what is built from them, and what is refused.
#include <gtest/gtest.h>

#include "harness/scenario/resolve/resolve.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

const char* const kRight = "  right_hand: {hand: human_right, at_m: [-0.2, -0.2, 1.05]}\n";
const char* const kLeft = "  left_hand: {hand: human_left, at_m: [-0.2, 0.3, 1.05]}\n";

/// The probe with a second hand, a person and this stage first.
Result<Scenario> ReadStage(const std::string& stage) {
  std::string text = ProbeWith(
      kRight, std::string(kRight) + kLeft + "  anna: {person: body, at_m: [-0.9, 0, 0]}\n");
  const std::string script = "script:\n";
  text.insert(text.find(script) + script.size(), "  - " + stage + "\n");
  return ReadScenarioText("probe.yaml", text, {}, ProbeLibrary());
}

TEST(StepOrder, AListIsPlayedOneAfterAnother) {
  const auto read = ReadStage(
      "{right_hand: [{reach: milk, name: there}, {close_to: 1, delay_s: 0.2}], left_hand: "
      "{wait_s: 1, after: there}, anna: [{lean_deg: 10, with: there}, {lean_deg: 0, delay_s: 1}]}");
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  const physics::ScriptStage& stage = read->script.stages[0];
  ASSERT_EQ(stage.steps.size(), 3u);
  EXPECT_EQ(stage.steps[0].hand, stage.steps[1].hand);
  EXPECT_EQ(stage.steps[0].order.name, "there");
  EXPECT_EQ(stage.steps[1].delay_s, 0.2);
  EXPECT_EQ(stage.steps[2].order.after, "there");
  ASSERT_EQ(stage.person_steps.size(), 2u);
  EXPECT_EQ(stage.person_steps[0].order.with, "there");
  EXPECT_EQ(stage.person_steps[1].delay_s, 1);
}

struct BadOrder {
  const char* name;
  const char* stage;
  const char* errors;
};
void PrintTo(const BadOrder& bad, std::ostream* out) { *out << bad.name; }

class StepOrderError : public testing::TestWithParam<BadOrder> {};

TEST_P(StepOrderError, IsReportedAtItsPlace) {
  EXPECT_EQ(Brief(ErrorsOf(ReadStage(GetParam().stage))), GetParam().errors);
}

INSTANTIATE_TEST_SUITE_P(
    All, StepOrderError,
    testing::Values(
        BadOrder{"twice", "{right_hand: [{wait_s: 1, name: a}, {wait_s: 1, name: a}]}",
                 "13:59: name: two steps of this stage are called 'a'\n"},
        BadOrder{"unknown",
                 "{right_hand: {wait_s: 1, name: there}, left_hand: {wait_s: 1, after: ther}}",
                 "13:74: after: no step of this stage is called 'ther' | did you mean 'there'?\n"},
        BadOrder{"none_named", "{right_hand: {wait_s: 1}, left_hand: {wait_s: 1, with: there}}",
                 "13:60: with: no step of this stage is called 'there' | write 'name: there' in "
                 "the step that it waits for\n"},
        BadOrder{"actor", "{right_hand: {wait_s: 1}, left_hand: {wait_s: 1, after: right_hand}}",
                 "13:61: after: no step of this stage is called 'right_hand' | 'right_hand' is an "
                 "actor: give the step 'name: ..', and name that\n"},
        BadOrder{
            "earlier",
            "{right_hand: {wait_s: 1, name: there}}\n  - {left_hand: {wait_s: 1, after: there}}",
            "14:36: after: no step of this stage is called 'there' | that of an earlier stage has "
            "ended when this stage begins\n"},
        BadOrder{
            "later",
            "{left_hand: {wait_s: 1, after: there}}\n  - {right_hand: {wait_s: 1, name: there}}",
            "13:36: after: no step of this stage is called 'there' | that of a later stage begins "
            "when this stage has ended\n"},
        BadOrder{"itself", "{right_hand: {wait_s: 1, name: a, after: a}}",
                 "13:46: after: a step cannot wait for itself\n"},
        BadOrder{
            "circle",
            "{right_hand: [{wait_s: 1, after: b}, {wait_s: 1, name: a}], left_hand: [{wait_s: 1, "
            "after: a}, {wait_s: 1, name: b}], anna: {wait_s: 1, after: b}}",
            "13:96: after: this step would never begin, since 'a' waits for it\n"},
        BadOrder{"both",
                 "{right_hand: {wait_s: 1, name: a}, left_hand: {wait_s: 1, after: a, with: a}}",
                 "13:73: a wait step cannot have both 'after' and 'with'\n"},
        BadOrder{"empty", "{right_hand: []}",
                 "13:18: right_hand: expected at least 1 item, found 0\n"}),
    [](const auto& bad) { return bad.param.name; });

}  // namespace
}  // namespace prehend::scenario
