// SPDX-License-Identifier: Apache-2.0
// See harness/episode/frames/frame_player.h. Tested by tests/harness/episode/frames/frames_test.cc
#include "harness/episode/frames/frame_player.h"

#include <algorithm>

namespace prehend::episode {

FramePlayer::FramePlayer(FrameLayout layout)
    : layout_(std::move(layout)),
      parts_(layout_),
      tracks_(layout_.tracks()),
      links_(layout_.hands.size()),
      hand_poses_(layout_.hands.size()),
      now_(BlankSnapshot(layout_)) {
  for (const physics::HandModel& model : layout_.hands) guesses_.emplace_back(model);
}

bool FramePlayer::Open(const FetchPart& fetch, bool follows) {
  if (follows) {  // what comes to rest is as in the last frame
    for (const std::size_t track : moving_)
      WriteRow(layout_, track, *tracks_[track], head_.ticks.size() - 1, now_);
    for (const std::size_t track : moving_) {
      if (track < layout_.bodies) now_.moved_tick[track] = head_.ticks.back();
    }
    if (!resting_.empty()) now_.resting = resting_.back().points;
  }
  const auto head = fetch(0, FrameLayout::kHead);
  if (!head) return false;
  auto read = parts_.Head(*head);
  if (!read) return false;
  head_ = std::move(*read);
  moving_.clear();
  for (std::size_t track = 0; track < layout_.tracks(); ++track) {
    if (!OpenTrack(fetch, track, follows)) return false;
  }
  for (std::size_t hand = 0; hand < layout_.hands.size(); ++hand) {
    links_[hand].reset();
    if (!head_.has_links[hand]) continue;
    const auto bytes = fetch(0, layout_.PartOfLinks(hand));
    if (!bytes) return false;
    links_[hand] = parts_.Links(hand, *bytes);
    if (!links_[hand] || links_[hand]->rows != head_.ticks.size()) return false;
  }
  for (std::size_t hand = 0; hand < layout_.hands.size(); ++hand) {
    const std::size_t blocks = (head_.ticks.size() + kLanes - 1) / kLanes;
    const std::size_t count = (1 + guesses_[hand].size()) * blocks;
    hand_poses_[hand].known.assign(count, false);
    hand_poses_[hand].placed.resize(count);
  }
  return OpenContacts(fetch) && OpenResting(fetch, follows);
}

bool FramePlayer::OpenTrack(const FetchPart& fetch, std::size_t track, bool follows) {
  tracks_[track].reset();
  const Word back = head_.back[track];
  if (back > 0 && follows) return true;
  const auto bytes = fetch(back, FrameLayout::PartOfTrack(track));
  if (!bytes) return false;
  std::optional<Columns> columns = parts_.Track(track, *bytes);
  if (!columns) return false;
  if (back > 0) {
    WriteRow(layout_, track, *columns, columns->rows - 1, now_);
    return true;
  }
  if (columns->rows != head_.ticks.size()) return false;
  tracks_[track] = std::move(columns);
  moving_.push_back(track);
  return true;
}

bool FramePlayer::OpenContacts(const FetchPart& fetch) {
  contacts_.reset();
  if (!head_.has_contacts) return true;
  const auto bytes = fetch(0, layout_.Contacts());
  if (!bytes) return false;
  contacts_ = parts_.ContactsOf(
      *bytes, head_.ticks.size(),
      [&](std::size_t frame, const physics::ContactSide& side) { return PoseOf(frame, side); });
  return contacts_.has_value();
}

physics::Pose FramePlayer::PoseOf(std::size_t frame, const physics::ContactSide& side) {
  if (side.hand != physics::kNone)
    return PlaceOf(side.hand.index(), side.link == physics::kNone ? 0 : side.link.index() + 1,
                   frame);
  const std::size_t body = side.body.index();
  return tracks_[body] ? PoseInRow(*tracks_[body], frame) : now_.bodies[body].X_WB;
}

bool FramePlayer::OpenResting(const FetchPart& fetch, bool follows) {
  resting_.clear();
  if (!head_.resting_back) {
    now_.resting.reset();
    return true;
  }
  const Word back = *head_.resting_back;
  if (back > 0 && follows) return true;
  const auto bytes = fetch(back, layout_.Resting());
  if (!bytes) return false;
  auto all = parts_.Resting(*bytes);
  if (!all) return false;
  if (back > 0) {
    now_.resting = all->back().points;
    return true;
  }
  if (!follows) now_.resting.reset();
  resting_ = std::move(*all);
  return true;
}

const physics::Snapshot* FramePlayer::Show(std::size_t frame, bool links) {
  if (frame >= head_.ticks.size()) return nullptr;
  now_.tick = head_.ticks[frame];
  for (const std::size_t track : moving_) {
    WriteRow(layout_, track, *tracks_[track], frame, now_);
    if (track < layout_.bodies) now_.moved_tick[track] = now_.tick;
  }
  if (!HasValidIndices(layout_, now_)) return nullptr;
  now_.contacts.clear();
  if (contacts_) {
    const auto begin = contacts_->points.begin();
    now_.contacts.assign(begin + static_cast<std::ptrdiff_t>(contacts_->begins[frame]),
                         begin + static_cast<std::ptrdiff_t>(contacts_->begins[frame + 1]));
  }
  for (const PartReader::RestingFrom& from : resting_) {
    if (from.frame <= frame) now_.resting = from.points;
  }
  for (std::size_t hand = 0; links && hand < layout_.hands.size(); ++hand) {
    for (std::size_t link = 0; link < guesses_[hand].size(); ++link)
      now_.hands[hand].X_WL[link] = PlaceOf(hand, link + 1, frame);
  }
  return &now_;
}

const PlacedLinks& FramePlayer::Placed(std::size_t hand, std::size_t place, std::size_t block) {
  HandPoses& kept = hand_poses_[hand];
  const std::size_t at = block * (1 + guesses_[hand].size()) + place;
  PlacedLinks& placed = kept.placed[at];
  if (kept.known[at]) return placed;
  kept.known[at] = true;
  const std::optional<Columns>& track = tracks_[layout_.FirstHand() + hand];
  const physics::HandState& state = now_.hands[hand];  // where the track does not change
  const std::size_t first = block * kLanes, last = head_.ticks.size() - 1;
  const auto frame = [&](std::size_t lane) { return std::min(first + lane, last); };
  if (place == 0) {
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      placed.PutPalm(lane, track ? PoseInRow(*track, frame(lane)) : state.palm.X_WB);
    return placed;
  }
  const std::size_t link = place - 1;
  const auto parent = static_cast<std::size_t>(guesses_[hand].ParentOf(link) + 1);
  Lanes joints{};
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    joints[lane] = track ? JointInRow(*track, frame(lane), link) : state.joints[link];
  guesses_[hand].Guess(link, Placed(hand, parent, block), joints, placed);
  if (!links_[hand]) return placed;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    physics::Pose found = placed.X_WL[lane];
    AddOff(*links_[hand], frame(lane), link, found);
    placed.Correct(lane, found);
  }
  return placed;
}

}  // namespace prehend::episode
