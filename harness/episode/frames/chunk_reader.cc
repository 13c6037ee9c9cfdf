// SPDX-License-Identifier: Apache-2.0
// See harness/episode/frames/chunk.h. Tested by tests/harness/episode/frames/frames_test.cc
#include <algorithm>

#include "harness/episode/frames/chunk.h"
#include "harness/episode/frames/contact_coding.h"

namespace prehend::episode {
namespace {

constexpr std::size_t kMostPartBytes = std::size_t{1} << 30;

bool IsSide(const FrameLayout& layout, const physics::ContactSide& side) {
  if (side.hand == physics::kNone) return side.body.IsBelow(layout.bodies);
  if (!side.hand.IsBelow(layout.hands.size())) return false;
  return side.link == physics::kNone || side.link.IsBelow(At(layout.hands, side.hand).links.size());
}

/// Takes the number of a chunk's frames.
std::optional<std::size_t> TakeFrames(std::string_view& bytes) {
  const std::optional<Word> frames = TakeVarint(bytes);
  if (!frames || *frames == 0 || *frames > kMostFramesOfChunk) return std::nullopt;
  return static_cast<std::size_t>(*frames);
}

}  // namespace

std::optional<ChunkHead> PartReader::Head(std::string_view packed) {
  auto bytes = compressor_.Unpack(packed, kMostPartBytes);
  if (!bytes) return std::nullopt;
  const auto frames = TakeFrames(*bytes);
  if (!frames) return std::nullopt;
  const std::optional<Columns> ticks = Decode(*bytes, *frames, 1, {});
  if (!ticks) return std::nullopt;
  ChunkHead head;
  for (const Word tick : ticks->words) {
    const auto next = static_cast<std::int64_t>(tick);
    if (next < 0 || (!head.ticks.empty() && next <= head.ticks.back())) return std::nullopt;
    head.ticks.push_back(next);
  }
  for (std::size_t i = 0; i < layout_.tracks(); ++i) {
    const auto back = TakeVarint(*bytes);
    if (!back) return std::nullopt;
    head.back.push_back(*back);
  }
  const auto contacts = TakeVarint(*bytes), resting = TakeVarint(*bytes);
  if (!contacts || !resting) return std::nullopt;
  head.has_contacts = *contacts != 0;
  if (*resting > 0) head.resting_back = *resting - 1;
  for (std::size_t i = 0; i < layout_.hands.size(); ++i) {
    const auto has = TakeVarint(*bytes);
    if (!has) return std::nullopt;
    head.has_links.push_back(*has != 0);
  }
  return head;
}

std::optional<Columns> PartReader::Track(std::size_t track, std::string_view packed) {
  auto bytes = compressor_.Unpack(packed, kMostPartBytes);
  if (!bytes) return std::nullopt;
  const auto frames = TakeFrames(*bytes);
  if (!frames) return std::nullopt;
  return Decode(*bytes, *frames, layout_.Width(track),
                {.dt_s = IsRigid(layout_, track) ? 1.0 / layout_.rate_hz : 0});
}

std::optional<PartReader::Contacts> PartReader::ContactsOf(
    std::string_view packed, std::size_t frames,
    const std::function<physics::Pose(std::size_t frame, const physics::ContactSide&)>& pose) {
  auto bytes = compressor_.Unpack(packed, kMostPartBytes);
  if (!bytes) return std::nullopt;
  auto decoded = DecodeContacts(
      *bytes, {.has = [&](const physics::ContactSide& side) { return IsSide(layout_, side); },
               .pose =
                   [&](std::size_t frame, const physics::ContactSide& side) {
                     return frame < frames ? pose(frame, side) : physics::Pose();
                   }});
  if (!decoded || decoded->counts.size() != frames) return std::nullopt;
  Contacts contacts{.begins = {0}, .points = std::move(decoded->points)};
  for (const Word count : decoded->counts)
    contacts.begins.push_back(contacts.begins.back() + static_cast<std::size_t>(count));
  return contacts;
}

std::optional<std::vector<PartReader::RestingFrom>> PartReader::Resting(std::string_view packed) {
  auto bytes = compressor_.Unpack(packed, kMostPartBytes);
  if (!bytes) return std::nullopt;
  const auto count = TakeVarint(*bytes);
  if (!count || *count == 0 || *count > kMostFramesOfChunk) return std::nullopt;
  std::vector<RestingFrom> all;
  for (Word i = 0; i < *count; ++i) {
    const auto frame = TakeVarint(*bytes), has = TakeVarint(*bytes);
    if (!frame || !has || *frame >= kMostFramesOfChunk) return std::nullopt;
    RestingFrom& from = all.emplace_back();
    from.frame = static_cast<std::size_t>(*frame);
    if (*has == 0) continue;
    auto decoded = DecodeContacts(
        *bytes, {.has = [&](const physics::ContactSide& side) { return IsSide(layout_, side); },
                 .pose = [](std::size_t, const physics::ContactSide&) { return physics::Pose(); }});
    if (!decoded) return std::nullopt;
    from.points = std::make_shared<const ContactPoints>(std::move(decoded->points));
  }
  return all;
}

std::optional<Columns> PartReader::Links(std::size_t hand, std::string_view packed) {
  auto bytes = compressor_.Unpack(packed, kMostPartBytes);
  if (!bytes) return std::nullopt;
  const auto frames = TakeFrames(*bytes);
  if (!frames) return std::nullopt;
  return DecodeSmall(*bytes, *frames, 7 * layout_.hands[hand].links.size());
}

void AddOff(const Columns& off, std::size_t frame, std::size_t link, physics::Pose& pose) {
  for (std::size_t k = 0; k < 3; ++k) {
    double& value = pose.p_m[static_cast<Eigen::Index>(k)];
    value = ValueOffBy(value, off.At(frame, 7 * link + k));
  }
  for (std::size_t k = 0; k < 4; ++k) {
    double& value = pose.q.coeffs()[static_cast<Eigen::Index>(k)];
    value = ValueOffBy(value, off.At(frame, 7 * link + 3 + k));
  }
}

}  // namespace prehend::episode
