// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "harness/scenario/resolve/resolve.h"
#include "physics/motion/stage_clock.h"

namespace prehend::scenario {
namespace {

using StepName = std::optional<Located<std::string>>;

std::string TextOf(const StepName& name) { return name ? name->value : std::string(); }

/// Which stages have steps of these names.
using StagesByName = std::map<std::string, std::vector<std::size_t>>;

StagesByName NamesOf(const std::vector<StageYaml>& stages, DiagnosticList& errors) {
  StagesByName names;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    for (const Named<StepYaml>& step : stages[i]) {
      const StepName& name = TimingOf(step.value).name;
      if (!name) continue;
      std::vector<std::size_t>& found = names[name->value];
      if (!found.empty() && found.back() == i)
        errors.Add(name->where,
                   fmt::format("name: two steps of this stage are called '{}'", name->value));
      else
        found.push_back(i);
    }
  }
  return names;
}

class LinkCheck {
 public:
  LinkCheck(const std::vector<std::string>& actors, const StagesByName& names,
            DiagnosticList& errors)
      : actors_(actors), names_(names), errors_(errors) {}

  /// False after an error.
  bool Check(const char* key, const StepName& name, std::size_t stage) const {
    if (!name) return true;
    const auto found = names_.find(name->value);
    if (found != names_.end() && std::ranges::count(found->second, stage) > 0) return true;
    const std::string what =
        fmt::format("{}: no step of this stage is called '{}'", key, name->value);
    if (found != names_.end()) {
      const bool before = found->second.front() < stage;
      errors_.Add(name->where, what,
                  before ? "that of an earlier stage has ended when this stage begins"
                         : "that of a later stage begins when this stage has ended");
    } else if (std::ranges::count(actors_, name->value) > 0) {
      errors_.Add(
          name->where, what,
          fmt::format("'{}' is an actor: give the step 'name: ..', and name that", name->value));
    } else {
      std::vector<std::string> known;
      for (const auto& [other, stages] : names_)
        if (std::ranges::count(stages, stage) > 0) known.push_back(other);
      if (known.empty())
        errors_.Add(name->where, what,
                    fmt::format("write 'name: {}' in the step that it waits for", name->value));
      else
        errors_.AddUnknownName(name->where, what, name->value, known);
    }
    return false;
  }

 private:
  const std::vector<std::string>& actors_;
  const StagesByName& names_;
  DiagnosticList& errors_;
};

/// The steps of a stage in the order of physics/motion/stage_clock.h.
std::vector<const StepYaml*> InPhysicsOrder(const StageYaml& stage,
                                            const std::vector<bool>& of_persons) {
  std::vector<const StepYaml*> ordered;
  for (const bool persons : {false, true})
    for (std::size_t i = 0; i < stage.size(); ++i)
      if (of_persons[i] == persons) ordered.push_back(&stage[i].value);
  return ordered;
}

/// A step that waits for itself, by way of others, and says for what it waits.
std::size_t StepOfCircle(const std::vector<std::size_t>& stuck,
                         const std::vector<physics::StepLinks>& links,
                         const std::vector<const StepYaml*>& steps) {
  const auto before = [&](std::size_t step) {
    for (const std::size_t other : links[step].after)
      if (std::ranges::count(stuck, other) > 0) return other;
    return links[step].with.value_or(step);
  };
  std::size_t step = stuck.front();
  for (std::size_t i = 0; i < steps.size(); ++i) step = before(step);  // now it is in the circle
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (TimingOf(*steps[step]).after || TimingOf(*steps[step]).with) return step;
    step = before(step);
  }
  return step;
}

void CheckCircles(const StageYaml& stage, const physics::ScriptStage& built,
                  const std::vector<bool>& of_persons, DiagnosticList& errors) {
  const std::vector<std::size_t> stuck = physics::StuckSteps(built);
  const std::vector<const StepYaml*> steps = InPhysicsOrder(stage, of_persons);
  if (stuck.empty() || steps.size() != built.steps.size() + built.person_steps.size()) return;
  const StepTimingYaml& timing =
      TimingOf(*steps[StepOfCircle(stuck, physics::LinksOf(built), steps)]);
  const bool after = timing.after.has_value();
  const Located<std::string>& other = after ? *timing.after : *timing.with;
  errors.Add(other.where,
             timing.name && timing.name->value == other.value
                 ? fmt::format("{}: a step cannot wait for itself", after ? "after" : "with")
                 : fmt::format("{}: this step would never begin, since '{}' waits for it",
                               after ? "after" : "with", other.value));
}

}  // namespace

std::optional<physics::Until> UntilOf(const StepYaml& step, const physics::Scene& scene,
                                      bool is_person, DiagnosticList& errors) {
  /// Hands look no farther for what they come near to (physics/hand/hand_clearance.h).
  constexpr double kMaxGap_m = 0.09;
  const std::optional<Located<physics::Until>>& written = TimingOf(step).until;
  if (!written) return {};
  const physics::Until& until = written->value;
  std::vector<std::string> bodies, hands;
  for (const physics::Body& body : scene.bodies) bodies.push_back(body.name);
  for (const physics::Hand& hand : scene.hands) hands.push_back(hand.name);
  const auto thing = errors.Find({until.thing, written->where}, "until", bodies);
  const std::string what = thing ? WhyNoThing(scene.bodies[*thing]) : "";
  if (!what.empty())
    errors.Add(written->where,
               fmt::format("until: '{}' is {}, not a physical object", until.thing, what),
               what == "grains" ? "name the vessel that holds them" : "hands cannot touch it");
  if (is_person && until.who.empty())
    errors.Add(written->where, "until: a person waits for somebody or something else",
               fmt::format("write who: touching({}, {})", hands.empty() ? "can" : hands.front(),
                           until.thing));
  std::vector<std::string>& known = hands;
  if (!until.gap_m) known.insert(known.end(), bodies.begin(), bodies.end());
  if (!until.who.empty())
    errors.Find({until.who, written->where}, "until", known, until.gap_m ? "hand" : "entity");
  if (until.who == until.thing)
    errors.Add(written->where, fmt::format("until: '{}' is itself", until.who));
  if (const double gap_m = until.gap_m.value_or(0); gap_m > kMaxGap_m)
    errors.Add(written->where, fmt::format("until: a gap of {:g} mm is too far, at most {:g} mm",
                                           1000 * gap_m, 1000 * kMaxGap_m));
  return until;
}

const StepTimingYaml& TimingOf(const StepYaml& step) {
  return std::visit([](const StepTimingYaml& timing) -> const StepTimingYaml& { return timing; },
                    step);
}

physics::StepOrder OrderOf(const StepYaml& step) {
  const StepTimingYaml& timing = TimingOf(step);
  return {.name = TextOf(timing.name), .after = TextOf(timing.after), .with = TextOf(timing.with)};
}

void CheckStepOrder(const std::vector<StageYaml>& stages, const std::vector<std::string>& actors,
                    const std::vector<std::string>& persons, const physics::Script& script,
                    DiagnosticList& errors) {
  const StagesByName names = NamesOf(stages, errors);
  const LinkCheck links(actors, names, errors);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    bool known = true;
    std::vector<bool> of_persons;
    for (const Named<StepYaml>& step : stages[i]) {
      const StepTimingYaml& timing = TimingOf(step.value);
      known &= links.Check("after", timing.after, i) && links.Check("with", timing.with, i);
      of_persons.push_back(std::ranges::count(persons, step.name) > 0);
    }
    if (known) CheckCircles(stages[i], script.stages[i], of_persons, errors);
  }
}

}  // namespace prehend::scenario
