// SPDX-License-Identifier: Apache-2.0
// What a hand touches, as the steps of a script look at it. Tested by
// tests/physics/hand/guarded_motion_test.cc
#pragma once

#include <string>

#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// Calls `see` with the contacts of a hand, and of the body that it holds if that is not -1, with
/// another body.
template <typename See>
void ForEachContact(int hand, int held, int body, const Snapshot& now, const See& see) {
  const auto is_ours = [&](const ContactSide& side) {
    return side.hand == hand || (held >= 0 && side.hand < 0 && side.body == held);
  };
  for (const auto& points : now.AllContacts()) {
    for (const ContactPoint& contact : points) {
      const bool a_is_it = contact.a.hand < 0 && contact.a.body == body;
      const bool b_is_it = contact.b.hand < 0 && contact.b.body == body;
      if ((a_is_it && is_ours(contact.b)) || (b_is_it && is_ours(contact.a))) see(contact);
    }
  }
}

bool Touches(int hand, int body, const Snapshot& now);

/// "12 mm".
std::string Millimetres(double length_m);

}  // namespace prehend::physics
