// SPDX-License-Identifier: Apache-2.0
// The inventory of a drawn picture. Tested by tests/render/inventory_test.cc
#pragma once

#include "render/draw_list.h"
#include "render/inventory.h"
#include "render/overlay.h"

namespace prehend::render {

/// `listed` has the image and, in `things`, indices into list.objects. The overlay's things are
/// added to them.
void ListThings(const DrawList& list, const Overlay& overlay, ListedPicture* listed);

}  // namespace prehend::render
