// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/witnesses/closed_form/closed_form.h"

namespace prehend::witnesses {
namespace {

/// A box that is pushed along x from 0.5 s on, at 0.1 m/s.
constexpr const char* kPush = R"(closed_form: push
shows: A push.
lasts_s: 1
numbers:
  v: 0.1
  t_go: t_end / 2
curves:
  x: v * max(0, t - t_go)
entities:
  table: {box: {size_m: [1, 1, 0.04]}, fixed: true, at_m: [0, 0, -0.02]}
  box: {box: {size_m: [0.1, 0.1, 0.1]}, mass_kg: 0.5, at_m: [0, 0, 0.05]}
motions:
  box: {by_m: [x, 0, 0], rpy_deg: [0, 0, 90 * t]}
hands:
  hand: {at_m: [x - 0.051, 0, 0.05], trigger: t >= t_go}
contacts:
  - {between: [box, table], while: 1}
  - {between: [hand.palm, box], while: t >= t_go, normal: [-1, 0, 0], force_n: 2}
sampled:
  - {hz: 120}
  - {hz: 60, lost: "mod(n, 3) == 1"}
truth:
  - contact(box, table): [0, t_end]
  - contact(box, hand): [t_go, t_end]
)";

std::string With(const std::string& from, const std::string& to) {
  std::string text = kPush;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string ErrorOf(const std::string& from, const std::string& to) {
  const auto form = ReadClosedFormText("push.yaml", With(from, to));
  return form ? "no error" : grammar::Format(form.error());
}

TEST(ReadClosedForm, ComputesNumbersAndEvents) {
  const auto form = ReadClosedFormText("push.yaml", kPush);
  ASSERT_TRUE(form.has_value()) << grammar::Format(form.error());
  ASSERT_EQ(form->truth.size(), 2u);
  EXPECT_EQ(form->truth[1].label, "contact(box, hand)");
  EXPECT_EQ(form->truth[1].begin_s, 0.5);
  EXPECT_EQ(form->truth[1].end_s, 1);
}

TEST(ReadClosedForm, ComputesPosesVelocitiesAndContacts) {
  const auto form = ReadClosedFormText("push.yaml", kPush);
  ASSERT_TRUE(form.has_value());
  const ClosedFormRecording& recording = form->recordings[0];
  EXPECT_EQ(recording.sampling, "120 Hz");
  EXPECT_EQ(recording.end, 481);
  ASSERT_EQ(recording.frames.size(), 120u);
  const physics::Snapshot& early = recording.frames[29];
  EXPECT_EQ(early.tick, 120);
  EXPECT_EQ(early.contacts.size(), 1u);
  EXPECT_EQ(early.hands[0].trigger, 0);
  const physics::Snapshot& late = recording.frames[89];
  EXPECT_EQ(late.tick, 360);
  EXPECT_EQ(late.hands[0].trigger, 1);
  EXPECT_TRUE(late.bodies[1].X_WB.p_m.isApprox(Eigen::Vector3d(0.025, 0, 0.05)));
  EXPECT_NEAR(late.bodies[1].v_WB_m_per_s.x(), 0.1, 1e-6);
  EXPECT_NEAR(late.bodies[1].w_WB_rad_per_s.z(), 90 * physics::kRadPerDeg, 1e-6);
  EXPECT_NEAR(late.hands[0].palm.v_WB_m_per_s.x(), 0.1, 1e-6);
  ASSERT_EQ(late.contacts.size(), 2u);
  EXPECT_EQ(late.contacts[0].a, (physics::ContactSide{.hand = physics::HandIndex(0)}));
  EXPECT_EQ(late.contacts[0].b, (physics::ContactSide{.body = physics::BodyIndex(1)}));
  EXPECT_EQ(late.contacts[0].nhat_BA_W.x(), -1) << "on the hand";
  EXPECT_NEAR(late.contacts[0].normal_impulse_n_s, 2.0 / 480, 1e-12);
  EXPECT_EQ(late.contacts[1].a, (physics::ContactSide{.body = physics::BodyIndex(0)}));
  EXPECT_EQ(late.contacts[1].nhat_BA_W.z(), -1) << "on the table, which is the first body";
  EXPECT_NEAR(late.contacts[1].normal_impulse_n_s, 0.5 * 9.81 / 480, 1e-12) << "the box's weight";
}

TEST(ReadClosedForm, LosesFramesByFormula) {
  const auto form = ReadClosedFormText("push.yaml", kPush);
  ASSERT_TRUE(form.has_value());
  const ClosedFormRecording& recording = form->recordings[1];
  EXPECT_EQ(recording.sampling, "60 Hz, frames lost");
  ASSERT_EQ(recording.frames.size(), 40u);
  EXPECT_EQ(recording.frames[0].tick, 8);
  EXPECT_EQ(recording.frames[1].tick, 24);
  EXPECT_EQ(recording.frames[2].tick, 32);
}

TEST(ReadClosedForm, IsSampledInSixWaysUnlessItSaysHow) {
  const auto form = ReadClosedFormText(
      "push.yaml", With("sampled:\n  - {hz: 120}\n  - {hz: 60, lost: \"mod(n, 3) == 1\"}\n", ""));
  ASSERT_TRUE(form.has_value());
  std::vector<std::string> samplings;
  for (const ClosedFormRecording& recording : form->recordings)
    samplings.push_back(recording.sampling);
  EXPECT_EQ(samplings, (std::vector<std::string>{"30 Hz", "60 Hz", "120 Hz", "240 Hz", "480 Hz",
                                                 "120 Hz, frames lost"}));
}

TEST(ReadClosedForm, PointsAtWhatIsWrongInAFormula) {
  EXPECT_EQ(ErrorOf("t - t_go)", "t - t_goo)"),
            "push.yaml:8:21: error: unknown name 't_goo'\n"
            "    x: v * max(0, t - t_goo)\n"
            "                      ^\n"
            "  hint: did you mean 't_go'?\n");
  EXPECT_EQ(ErrorOf("\"mod(n, 3) == 1\"", "\"mod(n, 3) = 1\""),
            "push.yaml:21:31: error: unexpected '='; to compare, write '=='\n"
            "    - {hz: 60, lost: \"mod(n, 3) = 1\"}\n"
            "                                ^\n");
}

TEST(ReadClosedForm, TruthDoesNotChangeWithTime) {
  EXPECT_EQ(ErrorOf("hand): [t_go,", "hand): [t,"),
            "push.yaml:24:26: error: unknown name 't'\n"
            "    - contact(box, hand): [t, t_end]\n"
            "                           ^\n"
            "  hint: known: t_end, v, t_go\n");
}

TEST(ReadClosedForm, NamesHaveOneMeaning) {
  EXPECT_EQ(ErrorOf("  v: 0.1", "  sqrt: 0.1\n  v: 0.1"),
            "push.yaml:5:3: error: 'sqrt' has a meaning already\n"
            "    sqrt: 0.1\n"
            "    ^\n"
            "  hint: choose another name\n");
  EXPECT_EQ(ErrorOf("  x: v", "  v: 1\n  x: v"),
            "push.yaml:8:3: error: 'v' has a meaning already\n"
            "    v: 1\n"
            "    ^\n"
            "  hint: choose another name\n");
}

TEST(ReadClosedForm, KnowsItsEntitiesAndSides) {
  EXPECT_EQ(ErrorOf("motions:\n  box", "motions:\n  bax"),
            "push.yaml:13:3: error: no entity is called 'bax'\n"
            "    bax: {by_m: [x, 0, 0], rpy_deg: [0, 0, 90 * t]}\n"
            "    ^\n"
            "  hint: did you mean 'box'?\n");
  EXPECT_EQ(ErrorOf("hand.palm", "hand.plam"),
            "push.yaml:18:16: error: expected a side of 'hand' like 'hand.thumb', found "
            "'hand.plam'\n"
            "    - {between: [hand.plam, box], while: t >= t_go, normal: [-1, 0, 0], force_n: 2}\n"
            "                 ^\n"
            "  hint: did you mean 'palm'?\n");
  EXPECT_EQ(ErrorOf("contact(box, hand)", "contact(box, hant)"),
            "push.yaml:24:5: error: unknown name 'hant'\n"
            "    - contact(box, hant): [t_go, t_end]\n"
            "      ^\n"
            "  hint: did you mean 'hand'?\n");
}

TEST(ReadClosedForm, EventsLieInTheRecording) {
  EXPECT_EQ(ErrorOf("[t_go, t_end]", "[t_go, 2]"),
            "push.yaml:24:26: error: expected begin and end within 0 and 1 s, found 0.5000 and "
            "2.0000\n"
            "    - contact(box, hand): [t_go, 2]\n"
            "                           ^\n");
}

TEST(ReadClosedForm, EveryFormulaIsANumberAtEveryMoment) {
  EXPECT_EQ(ErrorOf("[x - 0.051, 0, 0.05]", "[x - 0.051, sqrt(0.5 - t), 0.05]"),
            "push.yaml:15:28: error: this is no number at t = 0.5083 s\n"
            "    hand: {at_m: [x - 0.051, sqrt(0.5 - t), 0.05], trigger: t >= t_go}\n"
            "                             ^\n");
}

TEST(ReadClosedForm, IsCalledAsItsFile) {
  const auto form = ReadClosedFormText("pull.yaml", kPush);
  ASSERT_FALSE(form.has_value());
  EXPECT_EQ(grammar::Format(form.error()),
            "pull.yaml:1:14: error: closed_form: the name is 'push', but the file is called "
            "'pull.yaml'\n"
            "  closed_form: push\n"
            "               ^\n"
            "  hint: rename one of them\n");
}

}  // namespace
}  // namespace prehend::witnesses
