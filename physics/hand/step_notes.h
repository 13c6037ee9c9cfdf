// SPDX-License-Identifier: Apache-2.0
// Remarks on steps that are played although they cannot do what they say: each with what was
// measured and with a remedy. Tested by tests/physics/hand/script_player_test.cc
#pragma once

#include <string>

#include "physics/hand/reach_planner.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// About a reach that was planned like this: the thing is too wide there, the grip is beside the
/// point, the hand comes half closed, or it will push against something. "" if there is nothing to
/// say.
std::string NoteAboutReach(const Scene& scene, const Snapshot& now, const ReachQuery& query,
                           const ReachPlan& plan);

/// Whether two sides of the hand touch `object`, an index into Scene::bodies: it holds it.
bool IsHeldBySides(const Scene& scene, const Snapshot& now, HandIndex hand, BodyIndex object);

/// About a hand that has closed, its trigger at `closes_to`, at the end of the step: that it
/// touches `object`, an index into Scene::bodies, with one side only or not at all.
std::string NoteAboutGrip(const Scene& scene, const Snapshot& now, HandIndex hand, BodyIndex object,
                          double closes_to);

/// About a hand that ends a move `off_m` away from where it was to go: what it pushes against.
std::string NoteAboutWay(const Scene& scene, const Snapshot& now, HandIndex hand, double off_m);

}  // namespace prehend::physics
