// SPDX-License-Identifier: Apache-2.0
// One body per lane; speeds stay in registers for all rows of a body. Tested by
// tests/physics/bullet/lone_bodies_test.cc
#include "physics/bullet/core/lone_bodies.h"

#include <algorithm>

#include "physics/bullet/core/friction_circle.h"

namespace prehend::physics {
namespace {

std::size_t At(int index) { return static_cast<std::size_t>(index); }

/// RigidSide::SpeedAlong()
template <std::size_t n, typename Row>
[[gnu::always_inline]] inline Wide<n> SpeedAlong(const Row& row, const std::array<Wide<n>, 6>& v) {
  const std::array<Wide<n>, 6>& j = row.jacobian;
  return (j[0] * v[0] + j[1] * v[1] + j[2] * v[2]) + (j[3] * v[3] + j[4] * v[4] + j[5] * v[5]);
}

/// Change of the impulse that gives the wanted speed, without limits.
template <std::size_t n, typename Row>
[[gnu::always_inline]] inline Wide<n> WantedChange(const Row& row,
                                                   const std::array<Wide<n>, 6>& v) {
  return (row.wanted - row.impulse * row.softness) - SpeedAlong(row, v) * row.inverse_mass;
}

template <std::size_t n, typename Row>
[[gnu::always_inline]] inline void Push(const Row& row, const Wide<n>& change,
                                        std::array<Wide<n>, 6>& v) {
  const std::array<Wide<n>, 6>& r = row.response;
  v[0] = v[0] + r[0] * change;
  v[1] = v[1] + r[1] * change;
  v[2] = v[2] + r[2] * change;
  v[3] = v[3] + r[3] * change;
  v[4] = v[4] + r[4] * change;
  v[5] = v[5] + r[5] * change;
}

template <std::size_t n>
struct WidePair {
  Wide<n> first, second;
};

template <std::size_t n>
[[gnu::always_inline]] inline Wide<n> SquaredLength(const WidePair<n>& a) {
  return a.first * a.first + a.second * a.second;
}

}  // namespace

void LoneBodies::Setup(const std::vector<char>& lone,
                       const btAlignedObjectArray<btSolverBody>& bodies, std::vector<Six>& speeds,
                       const btConstraintArray& contacts, const btConstraintArray& frictions) {
  const auto body_of = [&](const btSolverConstraint& contact) {
    if (lone[At(contact.m_solverBodyIdA)]) return contact.m_solverBodyIdA;
    return lone[At(contact.m_solverBodyIdB)] ? contact.m_solverBodyIdB : -1;
  };
  place_.assign(lone.size(), 0);
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

void LoneBodies::Arrange() {
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
void LoneBodies::Blocks<lanes>::Clear() {
  blocks.clear();
  contacts.clear();
}

template <std::size_t lanes>
void LoneBodies::Blocks<lanes>::Add(const Body* bodies, std::size_t count,
                                    const std::vector<Contact>& sources) {
  Block<lanes>& block = blocks.emplace_back(Block<lanes>{{}, contacts.size(), bodies[0].count});
  contacts.resize(contacts.size() + block.count);
  for (std::size_t lane = 0; lane < count; ++lane) {
    const Body& body = bodies[lane];
    block.speeds[lane] = body.speeds;
    for (std::size_t i = 0; i < body.count; ++i)
      SetContact(contacts[block.first + i], lane, body, sources[body.first + i]);
  }
}

RigidSide LoneBodies::SideOf(const Body& body, const btSolverConstraint& source) {
  if (source.m_solverBodyIdA == body.index)
    return MakeRigidSide(*body.body, *body.speeds, source.m_contactNormal1,
                         source.m_relpos1CrossNormal, source.m_angularComponentA);
  return MakeRigidSide(*body.body, *body.speeds, source.m_contactNormal2,
                       source.m_relpos2CrossNormal, source.m_angularComponentB);
}

template <std::size_t lanes>
void LoneBodies::SetRow(Row<lanes>& row, std::size_t lane, const RigidSide& side,
                        const btSolverConstraint& source) {
  for (std::size_t i = 0; i < 6; ++i) {
    row.jacobian[i].Put(lane, side.jacobian[i]);
    row.response[i].Put(lane, side.response[i]);
  }
  row.wanted.Put(lane, source.m_rhs);
  row.softness.Put(lane, source.m_cfm);
  row.inverse_mass.Put(lane, source.m_jacDiagABInv);
  row.mass.Put(lane, 1 / source.m_jacDiagABInv);
  row.impulse.Put(lane, source.m_appliedImpulse);
}

template <std::size_t lanes>
void LoneBodies::SetContact(Contacts<lanes>& contacts, std::size_t lane, const Body& body,
                            const Contact& contact) {
  const auto side_of = [&](const btSolverConstraint& source) { return SideOf(body, source); };
  const RigidSide first = side_of(*contact.first_friction),
                  second = side_of(*contact.second_friction);
  SetRow(contacts.normal, lane, side_of(*contact.normal), *contact.normal);
  SetRow(contacts.first, lane, first, *contact.first_friction);
  SetRow(contacts.second, lane, second, *contact.second_friction);
  contacts.least.Put(lane, contact.normal->m_lowerLimit);
  contacts.friction.Put(lane, contact.first_friction->m_friction);
  const PrincipalResponse response(contacts.first.mass.At(lane), first.SpeedBy(second),
                                   contacts.second.mass.At(lane));
  contacts.cosine.Put(lane, response.cosine());
  contacts.sine.Put(lane, response.sine());
  contacts.first_response.Put(lane, response.first());
  contacts.second_response.Put(lane, response.second());
  contacts.moves.Put(lane, response.moves());
  contacts.sources[lane] = contact;
}

template <std::size_t lanes>
bool LoneBodies::SolveOnce(Contacts<lanes>* contacts, std::size_t count,
                           std::array<Wide<lanes>, 6>& v) {
  using Values = Wide<lanes>;
  const Values zero{};
  Marks<lanes> changed{};
  for (std::size_t i = 0; i < count; ++i) {
    Contacts<lanes>& contact = contacts[i];
    Row<lanes>& row = contact.normal;
    Values change = WantedChange(row, v);
    Values sum = row.impulse + change;
    const Marks<lanes> pulls = sum < contact.least;
    change = Select(pulls, contact.least - row.impulse, change);
    row.impulse = Select(pulls, contact.least, sum);
    Push(row, change, v);
    const Values speed = change * row.mass;
    changed = changed | (speed * speed > zero);
  }
  for (std::size_t i = 0; i < count; ++i) {
    Contacts<lanes>& contact = contacts[i];
    Row<lanes>&first = contact.first, &second = contact.second;
    const Marks<lanes> pressed = contact.normal.impulse > zero;
    if (!Any(pressed)) continue;
    const Values &cosine = contact.cosine, &sine = contact.sine;
    const auto to_principal = [&](const Values& a, const Values& b) {
      return WidePair<lanes>{cosine * a - sine * b, sine * a + cosine * b};
    };
    // FrictionChange() of each lane.
    const Values limit = contact.friction * contact.normal.impulse;
    const WidePair<lanes> errors =
        to_principal(WantedChange(first, v) * first.mass, WantedChange(second, v) * second.mass);
    WidePair<lanes> change{errors.first / contact.first_response,
                           errors.second / contact.second_response};
    const WidePair<lanes> before = to_principal(first.impulse, second.impulse);
    const WidePair<lanes> wanted{before.first + change.first, before.second + change.second};
    const Values squared_length = SquaredLength(wanted);
    const Marks<lanes> usual = pressed & contact.moves & (limit > zero);
    const Marks<lanes> slides = usual & (squared_length > limit * limit);
    if (Any(slides)) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        if (!slides.At(lane)) continue;
        const RowPair sum = OnTheCircle(
            limit.At(lane), {contact.first_response.At(lane), contact.second_response.At(lane)},
            {wanted.first.At(lane), wanted.second.At(lane)}, squared_length.At(lane));
        change.first.Put(lane, sum.first - before.first.At(lane));
        change.second.Put(lane, sum.second - before.second.At(lane));
      }
    }
    // Without any friction impulses end; rows that cannot move or are not pressed stay.
    const Marks<lanes> ends = pressed & contact.moves;
    const Values by_first = Select(usual, cosine * change.first + sine * change.second,
                                   Select(ends, -first.impulse, zero));
    const Values by_second = Select(usual, cosine * change.second - sine * change.first,
                                    Select(ends, -second.impulse, zero));
    first.impulse = first.impulse + by_first;
    second.impulse = second.impulse + by_second;
    Push(first, by_first, v);
    Push(second, by_second, v);
    const Values first_speed = by_first * first.mass, second_speed = by_second * second.mass;
    changed = changed | (first_speed * first_speed > zero) | (second_speed * second_speed > zero);
  }
  return Any(changed);
}

template <std::size_t lanes>
void LoneBodies::Blocks<lanes>::Solve(int iterations) {
  for (const Block<lanes>& block : blocks) {
    std::array<Wide<lanes>, 6> v{};
    for (std::size_t lane = 0; lane < lanes; ++lane)
      if (block.speeds[lane])
        for (std::size_t i = 0; i < 6; ++i) v[i].Put(lane, (*block.speeds[lane])[i]);
    for (int i = 0; i < iterations; ++i)
      if (!SolveOnce(contacts.data() + block.first, block.count, v)) break;
    for (std::size_t lane = 0; lane < lanes; ++lane)
      if (block.speeds[lane])
        for (std::size_t i = 0; i < 6; ++i) (*block.speeds[lane])[i] = v[i].At(lane);
  }
}

template <std::size_t lanes>
void LoneBodies::Blocks<lanes>::WriteBack() const {
  for (const Contacts<lanes>& contact : contacts) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const Contact& source = contact.sources[lane];
      if (!source.normal) continue;
      source.normal->m_appliedImpulse = contact.normal.impulse.At(lane);
      source.first_friction->m_appliedImpulse = contact.first.impulse.At(lane);
      source.second_friction->m_appliedImpulse = contact.second.impulse.At(lane);
    }
  }
}

void LoneBodies::Solve(int iterations) {
  eight_.Solve(iterations);
  four_.Solve(iterations);
  two_.Solve(iterations);
}

void LoneBodies::WriteBack() const {
  eight_.WriteBack();
  four_.WriteBack();
  two_.WriteBack();
}

}  // namespace prehend::physics
