// SPDX-License-Identifier: Apache-2.0
// A picture with everything in it, for tests: a table with things, a hand on its way, ghosts, path,
// markers, strip.
#pragma once

#include "render/picture.h"

namespace prehend::render {

/// A right hand of five fingers with three links each.
physics::HandModel DemoHandModel();
/// That hand at a pose, every joint bent by `curl_rad`.
physics::HandState DemoHandState(const physics::HandModel& model, const physics::Pose& X_WH,
                                 double curl_rad);

physics::Scene DemoScene();
/// `scene` outlives the picture.
Picture DemoPicture(const physics::Scene& scene);

}  // namespace prehend::render
