// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/frames/frame_player.h"

namespace prehend::episode {

FramePlayer::FramePlayer(FrameLayout layout)
    : layout_(std::move(layout)),
      tracks_(layout_.tracks()),
      links_(layout_.hands.size()),
      now_(BlankSnapshot(layout_)) {
  for (std::size_t i = 0; i < layout_.tracks(); ++i) widths_.push_back(WidthOf(layout_, i));
  for (const physics::HandModel& model : layout_.hands) places_.emplace_back(model);
}

Columns FramePlayer::Table(std::string_view part, std::size_t width) {
  std::vector<Columns> tables = packer_.Unpack(part);
  if (tables.size() != 1 || tables[0].width != width || tables[0].rows == 0)
    throw Damage("a part is another table");
  return std::move(tables[0]);
}

Columns FramePlayer::Track(std::size_t track, std::string_view part) {
  return Table(part, widths_[track]);
}

void FramePlayer::Open(const FetchPart& fetch, std::int64_t first_tick, std::size_t frames,
                       bool follows) {
  // What comes to rest is as in the last frame.
  if (follows && frames_ > 0) Show(frames_ - 1, false);
  first_tick_ = first_tick;
  frames_ = frames;
  for (std::size_t track = 0; track < layout_.tracks(); ++track) OpenTrack(fetch, track, follows);
  for (std::size_t hand = 0; hand < layout_.hands.size(); ++hand) {
    links_[hand].reset();
    if (const auto part = fetch(layout_.LinksOf(hand), true))
      links_[hand] = Table(*part, 7 * layout_.hands[hand].links.size());
    if (links_[hand] && links_[hand]->rows != frames_) throw Damage("a part is too short");
  }
  contacts_.clear();
  if (const auto part = fetch(layout_.Contacts(), true))
    contacts_ = PointsOfTable(layout_, Table(*part, kPointWidth), frames_);
  OpenResting(fetch, follows);
}

void FramePlayer::OpenTrack(const FetchPart& fetch, std::size_t track, bool follows) {
  tracks_[track].reset();
  if (const auto part = fetch(track, true)) {
    tracks_[track] = Track(track, *part);
    if (tracks_[track]->rows != frames_) throw Damage("a part is too short");
  } else if (!follows && widths_[track] > 0) {
    const auto before = fetch(track, false);
    if (!before) throw Damage("a part is missing");
    const Columns columns = Track(track, *before);
    ReadRow(layout_, track, columns, columns.rows - 1, now_);
  }
}

void FramePlayer::OpenResting(const FetchPart& fetch, bool follows) {
  resting_.clear();
  if (!follows) now_.resting.reset();
  auto part = fetch(layout_.Resting(), true);
  const bool is_here = part.has_value();
  if (!is_here && !follows) part = fetch(layout_.Resting(), false);
  if (!part) return;
  const std::vector<Columns> tables = packer_.Unpack(*part);
  if (tables.size() != 2 || tables[0].width != 1) throw Damage("a part is another table");
  std::vector<ContactPoints> moments = PointsOfTable(layout_, tables[1], tables[0].rows);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const std::size_t from = is_here ? tables[0].At(i, 0) : 0;
    resting_.push_back({from, {}});
    if (!moments[i].empty())
      resting_.back().points = std::make_shared<const ContactPoints>(std::move(moments[i]));
  }
}

const physics::Snapshot& FramePlayer::Show(std::size_t frame, bool links) {
  now_.tick = first_tick_ + static_cast<std::int64_t>(frame);
  for (std::size_t track = 0; track < layout_.tracks(); ++track) {
    if (!tracks_[track]) continue;
    ReadRow(layout_, track, *tracks_[track], frame, now_);
    if (track < layout_.bodies) now_.moved_tick[track] = now_.tick;
  }
  now_.contacts = contacts_.empty() ? ContactPoints() : contacts_[frame];
  for (const RestingFrom& from : resting_) {
    if (from.frame <= frame) now_.resting = from.points;
  }
  for (std::size_t hand = 0; links && hand < layout_.hands.size(); ++hand) {
    physics::HandState& state = now_.hands[hand];
    if (links_[hand])
      ReadLinks(*links_[hand], frame, state.X_WL);
    else
      places_[hand].Place(state.palm.X_WB, state.joints, state.X_WL);
  }
  return now_;
}

}  // namespace prehend::episode
