// SPDX-License-Identifier: Apache-2.0
// The loops of physics/bullet/lanes/kernels.h. Included by one file per kind of processor, which
// says at its top for which one it is compiled, so nothing here may be an inline function of
// another header: the linker keeps only one of those. Tested by
// tests/physics/bullet/single_bodies_test.cc and tests/physics/bullet/grain_contacts_test.cc
#pragma once

#include "physics/bullet/lanes/friction_circle.h"
#include "physics/bullet/lanes/kernels.h"
#include "physics/bullet/lanes/wide.h"

namespace prehend::physics::PREHEND_WIDE {

/// RigidSide::SpeedAlong()
template <std::size_t n>
PREHEND_INLINE Wide<n> SpeedAlong(const SingleRow<n>& row, const Wide<n>* v) {
  const Lanes<n>* const j = row.jacobian;
  return (Load(j[0]) * v[0] + Load(j[1]) * v[1] + Load(j[2]) * v[2]) +
         (Load(j[3]) * v[3] + Load(j[4]) * v[4] + Load(j[5]) * v[5]);
}

/// Change of the impulse that gives the wanted speed, without limits.
template <std::size_t n>
PREHEND_INLINE Wide<n> WantedChange(const SingleRow<n>& row, const Wide<n>* v) {
  return (Load(row.wanted) - Load(row.impulse) * Load(row.softness)) -
         SpeedAlong(row, v) * Load(row.inverse_mass);
}

template <std::size_t n>
PREHEND_INLINE void Push(const SingleRow<n>& row, const Wide<n>& change, Wide<n>* v) {
  const Lanes<n>* const r = row.response;
  v[0] = v[0] + Load(r[0]) * change;
  v[1] = v[1] + Load(r[1]) * change;
  v[2] = v[2] + Load(r[2]) * change;
  v[3] = v[3] + Load(r[3]) * change;
  v[4] = v[4] + Load(r[4]) * change;
  v[5] = v[5] + Load(r[5]) * change;
}

template <std::size_t n>
struct WidePair {
  Wide<n> first, second;
};

/// PrincipalResponse::ToPrincipal()
template <std::size_t n>
PREHEND_INLINE WidePair<n> ToPrincipal(const Wide<n>& cosine, const Wide<n>& sine, const Wide<n>& a,
                                       const Wide<n>& b) {
  return {cosine * a - sine * b, sine * a + cosine * b};
}

template <std::size_t n>
PREHEND_INLINE Wide<n> SquaredLength(const WidePair<n>& a) {
  return a.first * a.first + a.second * a.second;
}

template <std::size_t n>
PREHEND_INLINE Wide<n> One() {
  Lanes<n> ones;
  for (double& one : ones.values) one = 1;
  return Load(ones);
}

/// Lane by lane: few slide at a time.
template <std::size_t n>
[[gnu::noinline]] static void SlideOnTheCircle(const SingleContacts<n>& contact,
                                               const Marks<n>& slides, const Wide<n>& limit,
                                               const WidePair<n>& wanted, const WidePair<n>& before,
                                               WidePair<n>& change) {
  Lanes<n> marked, limits, first, second, lengths, first_before, second_before, by_first, by_second;
  Store(Select(slides, One<n>(), Wide<n>{}), marked), Store(limit, limits),
      Store(SquaredLength(wanted), lengths);
  Store(wanted.first, first), Store(wanted.second, second);
  Store(before.first, first_before), Store(before.second, second_before);
  Store(change.first, by_first), Store(change.second, by_second);
  for (std::size_t lane = 0; lane < n; ++lane) {
    if (marked.values[lane] == 0) continue;
    const RowPair sum =
        OnTheCircle(limits.values[lane],
                    {contact.first_response.values[lane], contact.second_response.values[lane]},
                    {first.values[lane], second.values[lane]}, lengths.values[lane]);
    by_first.values[lane] = sum.first - first_before.values[lane];
    by_second.values[lane] = sum.second - second_before.values[lane];
  }
  change = {Load(by_first), Load(by_second)};
}

/// Returns whether anything changed.
template <std::size_t n>
PREHEND_INLINE bool SolveSingleOnce(SingleContacts<n>* contacts, std::size_t count, Wide<n>* v) {
  using Values = Wide<n>;
  const Values zero{};
  Marks<n> changed{};
  for (std::size_t i = 0; i < count; ++i) {
    SingleContacts<n>& contact = contacts[i];
    SingleRow<n>& row = contact.normal;
    Values change = WantedChange(row, v);
    const Values impulse = Load(row.impulse), sum = impulse + change, least = Load(contact.least);
    const Marks<n> pulls = sum < least;
    change = Select(pulls, least - impulse, change);
    Store(Select(pulls, least, sum), row.impulse);
    Push(row, change, v);
    const Values speed = change * Load(row.mass);
    changed = changed | (speed * speed > zero);
  }
  for (std::size_t i = 0; i < count; ++i) {
    SingleContacts<n>& contact = contacts[i];
    SingleRow<n>&first = contact.first, &second = contact.second;
    const Values pressure = Load(contact.normal.impulse);
    const Marks<n> pressed = pressure > zero;
    if (!Any(pressed)) continue;
    const Values cosine = Load(contact.cosine), sine = Load(contact.sine);
    // FrictionChange() of each lane.
    const Values limit = Load(contact.friction) * pressure;
    const WidePair<n> errors = ToPrincipal(cosine, sine, WantedChange(first, v) * Load(first.mass),
                                           WantedChange(second, v) * Load(second.mass));
    WidePair<n> change{errors.first / Load(contact.first_response),
                       errors.second / Load(contact.second_response)};
    const Values first_impulse = Load(first.impulse), second_impulse = Load(second.impulse);
    const WidePair<n> before = ToPrincipal(cosine, sine, first_impulse, second_impulse);
    const WidePair<n> wanted{before.first + change.first, before.second + change.second};
    const Values squared_length = SquaredLength(wanted);
    const Marks<n> moves = Load(contact.moves) > zero;
    const Marks<n> usual = pressed & moves & (limit > zero);
    const Marks<n> slides = usual & (squared_length > limit * limit);
    if (Any(slides)) SlideOnTheCircle(contact, slides, limit, wanted, before, change);
    // Without any friction impulses end; rows that cannot move or are not pressed stay.
    const Marks<n> ends = pressed & moves;
    const Values by_first = Select(usual, cosine * change.first + sine * change.second,
                                   Select(ends, -first_impulse, zero));
    const Values by_second = Select(usual, cosine * change.second - sine * change.first,
                                    Select(ends, -second_impulse, zero));
    Store(first_impulse + by_first, first.impulse);
    Store(second_impulse + by_second, second.impulse);
    Push(first, by_first, v);
    Push(second, by_second, v);
    const Values first_speed = by_first * Load(first.mass),
                 second_speed = by_second * Load(second.mass);
    changed = changed | (first_speed * first_speed > zero) | (second_speed * second_speed > zero);
  }
  return Any(changed);
}

template <std::size_t n>
static void SolveSingle(SingleContacts<n>* contacts, std::size_t count, Lanes<n>* speeds,
                        int iterations) {
  Wide<n> v[6] = {Load(speeds[0]), Load(speeds[1]), Load(speeds[2]),
                  Load(speeds[3]), Load(speeds[4]), Load(speeds[5])};
  for (int i = 0; i < iterations; ++i)
    if (!SolveSingleOnce(contacts, count, v)) break;
  for (int i = 0; i < 6; ++i) Store(v[i], speeds[i]);
}

constexpr std::size_t kGrainLanes = GrainBlock::kLanes;

PREHEND_INLINE Wide<kGrainLanes> Gather(const btScalar* const* from, std::size_t i) {
  const Lanes<kGrainLanes> lanes{{from[0][i], from[1][i], from[2][i], from[3][i]}};
  return Load(lanes);
}

PREHEND_INLINE void Scatter(const Wide<kGrainLanes>& value, btScalar* const* to, std::size_t i) {
  Lanes<kGrainLanes> lanes;
  Store(value, lanes);
  for (std::size_t lane = 0; lane < kGrainLanes; ++lane) to[lane][i] = lanes.values[lane];
}

/// Returns the largest squared change of a speed of each lane.
PREHEND_INLINE Wide<kGrainLanes> SolveGrainBlock(GrainBlock& block) {
  using Values = Wide<kGrainLanes>;
  const Values a0 = Gather(block.a, 0), a1 = Gather(block.a, 1), a2 = Gather(block.a, 2),
               a3 = Gather(block.a, 3), a4 = Gather(block.a, 4), a5 = Gather(block.a, 5);
  const Values b0 = Gather(block.b, 0), b1 = Gather(block.b, 1), b2 = Gather(block.b, 2),
               b3 = Gather(block.b, 3), b4 = Gather(block.b, 4), b5 = Gather(block.b, 5);
  const Values nx = Load(block.n[0]), ny = Load(block.n[1]), nz = Load(block.n[2]);
  Values x = a0 - b0, y = a1 - b1, z = a2 - b2;
  // The normal.
  const Values along = nx * x + ny * y + nz * z;
  Values push = (Load(block.wanted) - along) * Load(block.normal_mass);
  const Values pressure = Larger(Load(block.impulse) + push, Values{});
  push = pressure - Load(block.impulse);
  Store(pressure, block.impulse);
  const Values pushed = along + 2 * Load(block.inverse_mass) * push;
  // Across it: the same without its part along the normal, and with the surfaces' turning.
  const Values u = a3 + b3, v = a4 + b4, w = a5 + b5;
  x = x + (Load(block.slip[0]) - along * nx - Load(block.radius) * (v * nz - w * ny));
  y = y + (Load(block.slip[1]) - along * ny - Load(block.radius) * (w * nx - u * nz));
  z = z + (Load(block.slip[2]) - along * nz - Load(block.radius) * (u * ny - v * nx));
  Values fx = Load(block.sliding[0]) - x * Load(block.sliding_mass);
  Values fy = Load(block.sliding[1]) - y * Load(block.sliding_mass);
  Values fz = Load(block.sliding[2]) - z * Load(block.sliding_mass);
  const Values limit = Load(block.friction) * pressure, squared = fx * fx + fy * fy + fz * fz;
  const Marks<kGrainLanes> slides = squared > limit * limit;
  if (Any(slides)) {
    const Values scale = limit / Root(squared);
    fx = Select(slides, fx * scale, fx);
    fy = Select(slides, fy * scale, fy);
    fz = Select(slides, fz * scale, fz);
  }
  const Values dx = fx - Load(block.sliding[0]), dy = fy - Load(block.sliding[1]),
               dz = fz - Load(block.sliding[2]);
  Store(fx, block.sliding[0]);
  Store(fy, block.sliding[1]);
  Store(fz, block.sliding[2]);
  const Values m = Load(block.inverse_mass), t = Load(block.turn);
  const Values px = m * (push * nx + dx), py = m * (push * ny + dy), pz = m * (push * nz + dz);
  // Both surfaces are turned the same way: the arm and the impulse change sign together.
  const Values tx = t * (ny * dz - nz * dy), ty = t * (nz * dx - nx * dz),
               tz = t * (nx * dy - ny * dx);
  Scatter(a0 + px, block.a, 0);
  Scatter(a1 + py, block.a, 1);
  Scatter(a2 + pz, block.a, 2);
  Scatter(a3 - tx, block.a, 3);
  Scatter(a4 - ty, block.a, 4);
  Scatter(a5 - tz, block.a, 5);
  Scatter(b0 - px, block.b, 0);
  Scatter(b1 - py, block.b, 1);
  Scatter(b2 - pz, block.b, 2);
  Scatter(b3 - tx, block.b, 3);
  Scatter(b4 - ty, block.b, 4);
  Scatter(b5 - tz, block.b, 5);
  const Values changed = pushed - along, slid = Load(block.sliding_response);
  return Larger(changed * changed, (dx * dx + dy * dy + dz * dz) * slid * slid);
}

static btScalar SolveGrains(GrainBlock* blocks, std::size_t count) {
  Wide<kGrainLanes> largest{};
  for (std::size_t i = 0; i < count; ++i) largest = Larger(largest, SolveGrainBlock(blocks[i]));
  Lanes<kGrainLanes> lanes;
  Store(largest, lanes);
  btScalar most = 0;
  for (const btScalar change : lanes.values) most = change > most ? change : most;
  return most;
}

constexpr Kernels kKernels{SolveSingle<8>, SolveSingle<4>, SolveSingle<2>, SolveGrains};

}  // namespace prehend::physics::PREHEND_WIDE
