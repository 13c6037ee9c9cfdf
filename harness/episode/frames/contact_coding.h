// SPDX-License-Identifier: Apache-2.0
// Contact points of consecutive frames as few bytes, without loss: a point continues the one of the
// same two sides in the frame before. Also numbers that are nearly always small. Tested by
// tests/harness/episode/frames/frames_test.cc
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/episode/frames/columns.h"
#include "physics/scene/snapshot.h"

namespace prehend::episode {

/// Bit by bit.
bool SamePoint(const physics::ContactPoint& a, const physics::ContactPoint& b);

/// The side with which a point is guessed to move.
const physics::ContactSide& OwnerOf(const physics::ContactPoint& point);

/// `counts`: of each frame, the number of its points. `owners`: of each point, the pose of its
/// owner in its frame; for a single frame, nothing.
void EncodeContacts(const std::vector<Word>& counts,
                    const std::vector<physics::ContactPoint>& points,
                    const std::vector<physics::Pose>& owners, std::string& bytes);

struct DecodedContacts {
  std::vector<Word> counts;
  std::vector<physics::ContactPoint> points;
};

/// What has to be known to decode them.
struct ContactWorld {
  std::function<bool(const physics::ContactSide&)> has = {};
  /// Of a side that is there, in a frame that was counted.
  std::function<physics::Pose(std::size_t frame, const physics::ContactSide&)> pose = {};
};

/// Takes them off the front of `bytes`; nothing if those are damaged.
std::optional<DecodedContacts> DecodeContacts(std::string_view& bytes, const ContactWorld& world);

/// How many representable numbers lie between a value and its guess, small for both signs; and the
/// value again.
Word OffBy(double value, double guess);
double ValueOffBy(double guess, Word off);

/// Columns that are not guessed: as many bytes per number as the column's largest needs.
void EncodeSmall(const Columns& columns, std::string& bytes);
std::optional<Columns> DecodeSmall(std::string_view& bytes, std::size_t rows, std::size_t width);

}  // namespace prehend::episode
