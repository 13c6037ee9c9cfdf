// SPDX-License-Identifier: Apache-2.0
// One body per lane; the loops are in physics/bullet/lanes/kernel_loops.h.
#include "physics/bullet/core/single_bodies.h"

#include <algorithm>

#include "physics/bullet/lanes/friction_circle.h"

namespace prehend::physics {
namespace {

std::size_t At(int index) { return static_cast<std::size_t>(index); }

}  // namespace

void SingleBodies::Setup(const std::vector<char>& single,
                         const btAlignedObjectArray<btSolverBody>& bodies, std::vector<Six>& speeds,
                         const btConstraintArray& contacts, const btConstraintArray& frictions) {
  const auto body_of = [&](const btSolverConstraint& contact) {
    if (single[At(contact.m_solverBodyIdA)]) return contact.m_solverBodyIdA;
    return single[At(contact.m_solverBodyIdB)] ? contact.m_solverBodyIdB : -1;
  };
  place_.assign(single.size(), 0);
  for (int i = 0; i < contacts.size(); ++i)
    if (const int body = body_of(contacts[i]); body >= 0) ++place_[At(body)];
  bodies_.clear();
  std::size_t count = 0;
  for (std::size_t i = 0; i < place_.size(); ++i) {
    const std::size_t first = count;
    count += place_[i];
    if (place_[i] > 0)
      bodies_.push_back(
          {static_cast<int>(i), &bodies[static_cast<int>(i)], &speeds[i], first, place_[i]});
    place_[i] = first;
  }
  contacts_.resize(count);
  for (int i = 0; i < contacts.size(); ++i) {
    const int body = body_of(contacts[i]);
    if (body < 0) continue;
    const int friction = contacts[i].m_frictionIndex;
    contacts_[place_[At(body)]++] = {&contacts[i], &frictions[friction], &frictions[friction + 1]};
  }
  Arrange();
}

void SingleBodies::Arrange() {
  eight_.Clear();
  four_.Clear();
  two_.Clear();
  std::ranges::stable_sort(bodies_, std::greater<>(), &Body::count);
  for (std::size_t first = 0; first < bodies_.size();) {
    const Body* const bodies = bodies_.data() + first;
    const std::size_t left = bodies_.size() - first;
    const std::size_t taken = std::min<std::size_t>(left, left > 4 ? 8 : left > 2 ? 4 : 2);
    if (left > 4)
      eight_.Add(bodies, taken, contacts_);
    else if (left > 2)
      four_.Add(bodies, taken, contacts_);
    else
      two_.Add(bodies, taken, contacts_);
    first += taken;
  }
}

template <std::size_t lanes>
void SingleBodies::Blocks<lanes>::Clear() {
  blocks.clear();
  contacts.clear();
  sources.clear();
}

template <std::size_t lanes>
void SingleBodies::Blocks<lanes>::Add(const Body* bodies, std::size_t count,
                                      const std::vector<Contact>& all) {
  Block<lanes>& block = blocks.emplace_back(Block<lanes>{{}, contacts.size(), bodies[0].count});
  contacts.resize(block.first + block.count);
  sources.resize(contacts.size());
  for (std::size_t lane = 0; lane < count; ++lane) {
    const Body& body = bodies[lane];
    block.speeds[lane] = body.speeds;
    for (std::size_t i = 0; i < body.count; ++i) {
      const Contact& contact = all[body.first + i];
      SetContact(contacts[block.first + i], lane, body, contact);
      sources[block.first + i][lane] = contact;
    }
  }
}

RigidSide SingleBodies::SideOf(const Body& body, const btSolverConstraint& source) {
  if (source.m_solverBodyIdA == body.index)
    return MakeRigidSide(*body.body, *body.speeds, source.m_contactNormal1,
                         source.m_relpos1CrossNormal, source.m_angularComponentA);
  return MakeRigidSide(*body.body, *body.speeds, source.m_contactNormal2,
                       source.m_relpos2CrossNormal, source.m_angularComponentB);
}

template <std::size_t lanes>
void SingleBodies::SetRow(SingleRow<lanes>& row, std::size_t lane, const RigidSide& side,
                          const btSolverConstraint& source) {
  for (std::size_t i = 0; i < 6; ++i) {
    row.jacobian[i][lane] = side.jacobian[i];
    row.response[i][lane] = side.response[i];
  }
  row.wanted[lane] = source.m_rhs;
  row.softness[lane] = source.m_cfm;
  row.inverse_mass[lane] = source.m_jacDiagABInv;
  row.mass[lane] = 1 / source.m_jacDiagABInv;
  row.impulse[lane] = source.m_appliedImpulse;
}

template <std::size_t lanes>
void SingleBodies::SetContact(SingleContacts<lanes>& contacts, std::size_t lane, const Body& body,
                              const Contact& contact) {
  const auto side_of = [&](const btSolverConstraint& source) { return SideOf(body, source); };
  const RigidSide first = side_of(*contact.first_friction),
                  second = side_of(*contact.second_friction);
  SetRow(contacts.normal, lane, side_of(*contact.normal), *contact.normal);
  SetRow(contacts.first, lane, first, *contact.first_friction);
  SetRow(contacts.second, lane, second, *contact.second_friction);
  contacts.least[lane] = contact.normal->m_lowerLimit;
  contacts.friction[lane] = contact.first_friction->m_friction;
  const PrincipalResponse response(contacts.first.mass[lane], first.SpeedBy(second),
                                   contacts.second.mass[lane]);
  contacts.cosine[lane] = response.cosine();
  contacts.sine[lane] = response.sine();
  contacts.first_response[lane] = response.first();
  contacts.second_response[lane] = response.second();
  contacts.moves[lane] = response.moves() ? 1 : 0;
}

template <std::size_t lanes>
void SingleBodies::Blocks<lanes>::Solve(Kernels::SolveSingle<lanes> kernel, int iterations) {
  for (const Block<lanes>& block : blocks) {
    std::array<Lanes<lanes>, 6> speeds{};
    for (std::size_t lane = 0; lane < lanes; ++lane)
      if (block.speeds[lane])
        for (std::size_t i = 0; i < 6; ++i) speeds[i][lane] = (*block.speeds[lane])[i];
    kernel(contacts.data() + block.first, block.count, speeds.data(), iterations);
    for (std::size_t lane = 0; lane < lanes; ++lane)
      if (block.speeds[lane])
        for (std::size_t i = 0; i < 6; ++i) (*block.speeds[lane])[i] = speeds[i][lane];
  }
}

template <std::size_t lanes>
void SingleBodies::Blocks<lanes>::WriteBack() const {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const Contact& source = sources[i][lane];
      if (!source.normal) continue;
      source.normal->m_appliedImpulse = contacts[i].normal.impulse[lane];
      source.first_friction->m_appliedImpulse = contacts[i].first.impulse[lane];
      source.second_friction->m_appliedImpulse = contacts[i].second.impulse[lane];
    }
  }
}

void SingleBodies::Solve(int iterations, const Kernels& kernels) {
  eight_.Solve(kernels.solve_eight, iterations);
  four_.Solve(kernels.solve_four, iterations);
  two_.Solve(kernels.solve_two, iterations);
}

void SingleBodies::WriteBack() const {
  eight_.WriteBack();
  four_.WriteBack();
  two_.WriteBack();
}

}  // namespace prehend::physics
