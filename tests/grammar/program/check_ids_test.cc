// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <string>

#include "grammar/program/program.h"
#include "tests/grammar/scene.h"

namespace prehend::grammar {
namespace {

constexpr const char* kGrammar = R"(
grammar t
condition held(hand: Hand, cup: Cup) while touching(hand, cup) and trigger(hand) > 0.2
event raised(hand: Hand, cup: Cup) while held(hand, cup) and height(cup) > 1 cm
event left(hand: Hand, cup: Cup) rest of held(hand, cup) outside raised(hand, cup)
event taken(hand: Hand, cup: Cup) compose a: held(hand, cup), b: raised(hand, cup) where a before b
)";

TEST(CheckIds, CompiledGrammarsPass) { EXPECT_NO_THROW(CheckIds(*testing::CompileText(kGrammar))); }

TEST(CheckIds, EveryNumberThatNamesNothingIsFound) {
  const auto compiled = testing::CompileText(kGrammar);
  ASSERT_TRUE(compiled);
  const auto find = [&](const std::string& name) {
    for (const RuleId rule : IdsOf(compiled->rules)) {
      if (compiled->rules[rule].name == name) return rule;
    }
    return RuleId();
  };
  const RuleId held = find("held"), left = find("left"), taken = find("taken");
  struct Damage {
    const char* condition;  ///< that is not true any more
    std::function<void(Program&)> damage;
  };
  const Damage damages[] = {
      {"arg == kNone || program.nodes.has(arg)",
       [](Program& p) { p.nodes[NodeId(0)].args[0] = p.nodes.end_id(); }},
      {"arg < id", [](Program& p) { p.nodes[NodeId(0)].args[0] = NodeId(0); }},
      {"IsNoneOrBelow(node.name, kAxes)", [](Program& p) { p.nodes[NodeId(0)].name = 9; }},
      {"IsNoneOrBelow(node.name, program.sensor_sets.size())",
       [](Program& p) {
         p.nodes[NodeId(0)].op = Op::kSensorSet;
         p.nodes[NodeId(0)].name = 7;
       }},
      {"IsNoneOrBelow(node.slot, SlotsOf(node.op))",
       [&](Program& p) { p.nodes[p.rules[held].As<WhileRule>().condition].slot = 7; }},
      {"IsNoneOrBelow(role, rule_.roles.size())",
       [&](Program& p) { p.nodes[p.rules[held].As<WhileRule>().condition].roles[0] = 2; }},
      {"program_.nodes.has(id)",
       [&](Program& p) { p.rules[held].As<WhileRule>().condition = p.nodes.end_id(); }},
      {"program.rules.has(rule)", [](Program& p) { p.schedule.push_back(p.rules.end_id()); }},
      {"program_.rules.has(reference.rule)",
       [&](Program& p) { p.rules[left].references[0].rule = kNone; }},
      {"IsNoneOrBelow(slot, rule_.references.size())",
       [&](Program& p) { p.rules[left].guard = 7; }},
      {"slot != kNone && IsNoneOrBelow(slot, rule_.references.size())",
       [&](Program& p) { p.rules[left].As<RestOfRule>().whole = kNone; }},
      {"part != kNone && IsNoneOrBelow(part, composition->parts.size())",
       [&](Program& p) { p.rules[taken].As<ComposeRule>().clauses[0].right = 2; }},
      {"IsNoneOrBelow(part_of.part, whole->parts.size())",
       [&](Program& p) { p.rules[held].part_of[0].part = 2; }},
      {"IsNoneOrBelow(role, rule_.roles.size())",
       [&](Program& p) { p.rules[left].style_role = 2; }},
      {"program.notes.size() <= program.nodes.size()",
       [](Program& p) { p.notes.resize(p.nodes.size() + 1); }},
  };
  for (const Damage& damage : damages) {
    Program program = *compiled;
    damage.damage(program);
    try {
      CheckIds(program);
      ADD_FAILURE() << "not found: " << damage.condition;
    } catch (const std::logic_error& error) {
      const std::string text = error.what();
      EXPECT_TRUE(text.ends_with(std::string(": not true: ") + damage.condition)) << text;
    }
  }
}

}  // namespace
}  // namespace prehend::grammar
