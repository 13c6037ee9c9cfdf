// SPDX-License-Identifier: Apache-2.0
// Contact points of consecutive frames as few bytes, without loss: a point continues the one of the
// same two sides in the frame before. Also numbers that are nearly always small. Tested by
// tests/harness/frames/frames_test.cc
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/frames/columns.h"
#include "physics/scene/snapshot.h"

namespace prehend::harness::episodes {

/// Bit by bit.
bool SamePoint(const physics::ContactPoint& a, const physics::ContactPoint& b);

/// `counts`: of each frame, the number of its points.
void EncodeContacts(const std::vector<Word>& counts,
                    const std::vector<physics::ContactPoint>& points, std::string& bytes);

struct DecodedContacts {
  std::vector<Word> counts;
  std::vector<physics::ContactPoint> points;
};
/// Takes them off the front of `bytes`; nothing if those are damaged. Indices are not checked.
std::optional<DecodedContacts> DecodeContacts(std::string_view& bytes);

/// How many representable numbers lie between a value and its guess, small for both signs; and the
/// value again.
Word OffBy(double value, double guess);
double ValueOffBy(double guess, Word off);

/// Columns that are not guessed: as many bytes per number as the column's largest needs.
void EncodeSmall(const Columns& columns, std::string& bytes);
std::optional<Columns> DecodeSmall(std::string_view& bytes, std::size_t rows, std::size_t width);

}  // namespace prehend::harness::episodes
