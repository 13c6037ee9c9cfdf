// SPDX-License-Identifier: Apache-2.0
// The fields of every shape that an entity or a part of a compound can have.
// Tested by tests/harness/scenario_fields_test.cc
#pragma once

#include "harness/scenario_entries.h"

namespace prehend::harness {

Format<physics::Box> BoxFormat();
Format<physics::Sphere> SphereFormat();
Format<physics::Cylinder> CylinderFormat();
Format<physics::Capsule> CapsuleFormat();
Format<physics::Tray> TrayFormat();
Format<physics::Mug> MugFormat();
Format<physics::Bowl> BowlFormat();
Format<physics::Shelf> ShelfFormat();
Format<physics::Hull> HullFormat();
Format<GrainsEntry> GrainsFormat();
Format<PartEntry> PartFormat();

}  // namespace prehend::harness
