// SPDX-License-Identifier: Apache-2.0
// The inner loops of SingleBodies and GrainRows, compiled for several processors: the widest that
// runs here is chosen. All give the same bits. Only for physics/bullet/core. Tested by
// tests/physics/bullet/single_bodies_test.cc and tests/physics/bullet/grain_contacts_test.cc
#pragma once

#include <LinearMath/btScalar.h>

#include <cstddef>

namespace prehend::physics {

// Several doubles side by side in memory, as physics/bullet/lanes/wide.h loads them. Only for
// physics/bullet/core. Tested by tests/physics/bullet/single_bodies_test.cc

/// Without a constructor: one would be an inline function, compiled for several processors.
template <std::size_t n>
struct alignas(n * sizeof(double)) Lanes {
  double values[n];

  double& operator[](std::size_t lane) { return values[lane]; }
  double operator[](std::size_t lane) const { return values[lane]; }
};

/// A row of one body in each lane (physics/bullet/core/rigid_rows.h).
template <std::size_t n>
struct SingleRow {
  Lanes<n> jacobian[6], response[6];
  Lanes<n> wanted, softness, inverse_mass, mass, impulse;
};

/// A contact of one body in each lane, and its friction. A lane that has fewer contacts than the
/// others has rows that change nothing.
template <std::size_t n>
struct SingleContacts {
  SingleRow<n> normal, first, second;
  Lanes<n> least, friction;
  Lanes<n> cosine, sine, first_response, second_response;  ///< of PrincipalResponse
  Lanes<n> moves;                                          ///< 1, or 0 if a row cannot move
};

/// Contacts of two grains in each lane (physics/bullet/core/grain_rows.h); none has a grain of
/// another. A lane without a contact changes nothing.
struct GrainBlock {
  static constexpr std::size_t kLanes = 4;
  using Values = Lanes<kLanes>;

  btScalar *a[kLanes], *b[kLanes];  ///< the solver's change of their six speeds
  Values n[3];                      ///< from b to a
  Values slip[3];                   ///< before the solver: speed of a against b, across the normal
  Values sliding[3];                ///< impulse on a, across the normal
  Values wanted, impulse;           ///< along the normal: speed, impulse
  Values normal_mass;               ///< impulse by unit speed
  Values sliding_mass, sliding_response;        ///< the latter: speed by unit impulse
  Values inverse_mass, turn, radius, friction;  ///< turn: of speed by a unit impulse
};

struct Kernels {
  template <std::size_t n>
  using SolveSingle = void (*)(SingleContacts<n>* contacts, std::size_t count, Lanes<n>* six_speeds,
                               int iterations);

  /// Solve each row `iterations` times, or until nothing changes any more.
  SolveSingle<8> solve_eight;
  SolveSingle<4> solve_four;
  SolveSingle<2> solve_two;
  /// Solves each contact once. Returns the largest squared change of a speed.
  btScalar (*solve_grains)(GrainBlock* blocks, std::size_t count);
};

/// For any processor; for one with AVX2 (null where there is none).
extern const Kernels kPlainKernels;
extern const Kernels* const kAvx2Kernels;

/// The widest that this processor runs.
const Kernels& BestKernels();

}  // namespace prehend::physics
