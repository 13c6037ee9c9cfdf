// SPDX-License-Identifier: Apache-2.0
// What a hand touches, as the steps of a script look at it. Tested by
// tests/physics/hand/guarded_motion_test.cc
#pragma once

#include <string>

#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// Calls `see` with the contacts of a hand, and of the body that it holds if there is one, with
/// another body.
template <typename See>
void ForEachContact(HandIndex hand, BodyIndex held, BodyIndex body, const Snapshot& now,
                    const See& see) {
  const auto is_ours = [&](const ContactSide& side) {
    return side.hand == hand || (held != kNone && side.hand == kNone && side.body == held);
  };
  for (const auto& points : now.AllContacts()) {
    for (const ContactPoint& contact : points) {
      const bool a_is_it = contact.a.hand == kNone && contact.a.body == body;
      const bool b_is_it = contact.b.hand == kNone && contact.b.body == body;
      if ((a_is_it && is_ours(contact.b)) || (b_is_it && is_ours(contact.a))) see(contact);
    }
  }
}

/// A thing that leans by more than 20 degrees is meant to: a hand that keeps it upright does not
/// turn it. The cosine.
inline constexpr double kCosMostLean = 0.94;

/// Number of hands that touch a body.
int HandsOn(BodyIndex body, const Snapshot& now);

bool Touches(HandIndex hand, BodyIndex body, const Snapshot& now);

/// "12 mm".
std::string Millimetres(double length_m);

}  // namespace prehend::physics
