// SPDX-License-Identifier: Apache-2.0
// Questions about a program that more than one room asks.
#include "grammar/program/program.h"

namespace prehend::grammar {
namespace {

// First what each table says of others, then the nodes of each rule from the roots down.

// kNone, or an index.
bool IsNoneOrBelow(int number, std::size_t size) {
  return number == kNone || (number >= 0 && static_cast<std::size_t>(number) < size);
}

// The arguments of a node were added before it, so no tree has a circle.
void CheckNode(const Program& program, NodeId id) {
  const Node& node = program.nodes[id];
  for (const NodeId arg : node.args) PREHEND_CHECK(arg == kNone || program.nodes.has(arg));
  for (const NodeId arg : node.args) PREHEND_CHECK(arg < id);
  constexpr std::size_t kAxes = 9;  // of one entity and of another
  if (node.op == Op::kSensorSet) {
    PREHEND_CHECK(IsNoneOrBelow(node.name, program.sensor_sets.size()));
  } else {
    PREHEND_CHECK(IsNoneOrBelow(node.name, kAxes));
  }
  const ByThreshold& by = node.by_threshold;
  if (by.value == kNone) return;
  PREHEND_CHECK(program.nodes.has(by.value));
  for (const int threshold : by.thresholds)
    PREHEND_CHECK(threshold != kNone && IsNoneOrBelow(threshold, program.thresholds.size()));
  PREHEND_CHECK(IsNoneOrBelow(by.known, program.thresholds.size()));
}

class RuleCheck {
 public:
  RuleCheck(const Program& program, const Rule& rule) : program_(program), rule_(rule) {}

  void Run() const {
    for (const Reference& reference : rule_.references) Refers(reference);
    for (const PartOf& part_of : rule_.part_of) {
      PREHEND_CHECK(program_.rules.has(part_of.rule));
      const auto* whole = program_.rules[part_of.rule].If<ComposeRule>();
      PREHEND_CHECK(whole != nullptr && part_of.part != kNone);
      PREHEND_CHECK(IsNoneOrBelow(part_of.part, whole->parts.size()));
    }
    for (const int slot : {rule_.guard, rule_.opened_by, rule_.confirmed_by, rule_.confirmed_within,
                           rule_.measured.touch})
      PREHEND_CHECK(IsNoneOrBelow(slot, rule_.references.size()));
    for (const int role : {rule_.style_role, rule_.measured.first, rule_.measured.hand})
      PREHEND_CHECK(IsNoneOrBelow(role, rule_.roles.size()));
    RunForm();
    RunNodes();
  }

 private:
  void Refers(const Reference& reference) const {
    PREHEND_CHECK(program_.rules.has(reference.rule));
    for (const int role : reference.roles) PREHEND_CHECK(IsNoneOrBelow(role, rule_.roles.size()));
  }

  void IsReference(int slot) const {
    PREHEND_CHECK(slot != kNone && IsNoneOrBelow(slot, rule_.references.size()));
  }

  void RunForm() const {
    if (const auto* any = rule_.If<AnyRule>()) {
      IsReference(0);
      PREHEND_CHECK(IsNoneOrBelow(any->one, program_.rules[rule_.references[0].rule].roles.size()));
    }
    if (const auto* holds = rule_.If<WhileRule>()) {
      for (const int counted : holds->counted) IsReference(counted);
    }
    if (const auto* rest = rule_.If<RestOfRule>()) {
      IsReference(rest->whole);
      for (const int slot : rest->outside) IsReference(slot);
    }
    if (const auto* composition = rule_.If<ComposeRule>()) {
      for (const int slot : composition->parts) IsReference(slot);
      for (const ComposeRule::Clause& clause : composition->clauses) {
        for (const int part : {clause.left, clause.right})
          PREHEND_CHECK(part != kNone && IsNoneOrBelow(part, composition->parts.size()));
      }
    }
  }

  void RunNodes() const {
    std::vector<NodeId> roots = ConditionsOf(rule_);
    roots.push_back(rule_.requirement);
    if (const Approach* approach = ApproachOf(rule_))
      roots.insert(roots.end(), {approach->signal, approach->motion});
    for (const RuleAttribute& attribute : rule_.attributes) roots.push_back(attribute.node);
    for (const NodeId anchor : rule_.anchors) {
      PREHEND_CHECK(anchor != kNone);
      roots.push_back(anchor);
    }
    for (const NodeId root : roots) Walk(root);
  }

  void Walk(NodeId id) const {
    if (id == kNone) return;
    PREHEND_CHECK(program_.nodes.has(id));
    const Node& node = program_.nodes[id];
    for (const int role : node.roles) PREHEND_CHECK(IsNoneOrBelow(role, rule_.roles.size()));
    PREHEND_CHECK(IsNoneOrBelow(node.slot, SlotsOf(node.op)));
    for (const NodeId arg : node.args) Walk(arg);
  }

  // How many there are of what Node::slot means.
  std::size_t SlotsOf(Op op) const {
    if (op == Op::kIsA) return program_.class_names.size();
    return op == Op::kAtBegin ? rule_.anchors.size() : rule_.references.size();
  }

  const Program& program_;
  const Rule& rule_;
};

void CheckLaw(const Program& program, const Law& law) {
  for (const std::vector<LawCall>* calls : {&law.subjects, &law.others}) {
    for (const LawCall& call : *calls) {
      PREHEND_CHECK(program.rules.has(call.rule));
      for (const LawCall::Player& player : call.players)
        PREHEND_CHECK(IsNoneOrBelow(player.role, law.roles.size()));
    }
  }
}

}  // namespace

std::vector<NodeId> ConditionsOf(const Rule& rule) {
  std::vector<NodeId> nodes;
  if (const auto* holds = rule.If<WhileRule>()) nodes = {holds->condition, holds->until};
  if (const auto* from_to = rule.If<FromToRule>())
    nodes = {from_to->from, from_to->to, from_to->during};
  if (const auto* looks_back = rule.If<UntilSinceRule>())
    nodes = {looks_back->until, looks_back->since};
  std::erase(nodes, kNone);
  return nodes;
}

const Approach* ApproachOf(const Rule& rule) {
  const auto* part = rule.If<UntilSinceRule>();
  return part != nullptr && part->approach ? &*part->approach : nullptr;
}

std::string Law::Head() const {
  std::string text = "law " + name + "(";
  for (const Role& role : roles)
    text += (&role == &roles.front() ? "" : ", ") + role.name + ": " + role.class_name;
  return text + ")";
}

void CheckIds(const Program& program) {
  PREHEND_CHECK(program.notes.size() <= program.nodes.size());
  for (const NodeId node : IdsOf(program.nodes)) CheckNode(program, node);
  for (const RuleId rule : program.schedule) PREHEND_CHECK(program.rules.has(rule));
  for (const Rule& rule : program.rules) RuleCheck(program, rule).Run();
  for (const Law& law : program.laws) CheckLaw(program, law);
}

}  // namespace prehend::grammar
