// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/frames/chunk.h"

#include <algorithm>

#include "physics/base/check.h"

namespace prehend::episode {
namespace {

/// A chunk holds at most so many words, so that a frame is quickly unpacked.
constexpr std::size_t kMostWordsOfChunk = 1 << 16;

bool SamePoints(const ContactPoints* a, const ContactPoints* b) {
  return a == b || (a && b && TableOfPoints({a}).words == TableOfPoints({b}).words);
}

}  // namespace

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

ChunkWriter::ChunkWriter(FrameLayout layout)
    : layout_(std::move(layout)), tracks_(layout_.tracks()) {
  for (const physics::HandModel& model : layout_.hands)
    links_.push_back({.places = physics::LinkPlaces(model)});
}

bool ChunkWriter::IsFull() const {
  return frames_ >= kMostFramesOfChunk || words_ >= kMostWordsOfChunk;
}

void ChunkWriter::Add(const physics::Snapshot& snapshot) {
  PREHEND_CHECK(last_tick_ < 0 || snapshot.tick == last_tick_ + 1);
  for (std::size_t i = 0; i < tracks_.size(); ++i) AddTrack(i, snapshot);
  for (std::size_t i = 0; i < links_.size(); ++i) AddLinks(snapshot.hands[i], links_[i]);
  AddResting(snapshot);
  contacts_.push_back(snapshot.contacts);
  words_ += 8 * snapshot.contacts.size();
  last_tick_ = snapshot.tick;
  ++frames_;
}

void ChunkWriter::AddTrack(std::size_t number, const physics::Snapshot& snapshot) {
  Track& track = tracks_[number];
  bool changed = false;
  if (track.last.empty() || number >= layout_.bodies || snapshot.MayHaveMoved(number, last_tick_)) {
    row_.clear();
    AppendRow(layout_, number, snapshot, row_);
    changed = row_ != track.last;
    for (std::size_t i = 0; changed && track.rows.size() < frames_ * row_.size(); ++i)
      track.rows.insert(track.rows.end(), track.last.begin(), track.last.end());
    if (changed) std::swap(track.last, row_);
  }
  if (!changed && track.rows.empty()) return;
  track.rows.insert(track.rows.end(), track.last.begin(), track.last.end());
}

void ChunkWriter::AddLinks(const physics::HandState& hand, Links& links) {
  AppendLinks(hand.X_WL, links.rows);
  if (!links.follow) return;
  links.places.Place(hand.palm.X_WB, hand.joints, placed_);
  row_.clear();
  AppendLinks(placed_, row_);
  links.follow = std::ranges::equal(row_, std::span(links.rows).last(row_.size()));
}

void ChunkWriter::AddResting(const physics::Snapshot& snapshot) {
  if (snapshot.resting == resting_) return;
  const std::shared_ptr<const ContactPoints> before = std::move(resting_);
  resting_ = snapshot.resting;
  if (SamePoints(before.get(), resting_.get())) return;
  // So that the chunk can be read alone.
  if (new_resting_.empty() && frames_ > 0) new_resting_.emplace_back(0, before);
  new_resting_.emplace_back(frames_, resting_);
}

Chunk ChunkWriter::Take() {
  Chunk chunk{.first_tick = last_tick_ + 1 - static_cast<std::int64_t>(frames_),
              .last_tick = last_tick_,
              .frames = frames_};
  const auto add = [&](std::size_t part, const std::vector<Columns>& tables) {
    chunk.parts.push_back({part, packer_.Pack(tables)});
  };
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    Track& track = tracks_[i];
    if (!track.rows.empty()) add(i, {Transposed(track.rows, track.last.size())});
    track.rows.clear();
  }
  std::vector<const ContactPoints*> moments;
  for (const ContactPoints& points : contacts_) moments.push_back(&points);
  if (Columns table = TableOfPoints(moments); table.rows > 0) add(layout_.Contacts(), {table});
  moments.clear();
  Columns begins(new_resting_.size(), 1);
  for (const auto& [frame, points] : new_resting_) {
    begins.At(moments.size(), 0) = frame;
    moments.push_back(points.get());
  }
  if (begins.rows > 0) add(layout_.Resting(), {begins, TableOfPoints(moments)});
  for (std::size_t i = 0; i < links_.size(); ++i) {
    Links& links = links_[i];
    if (!links.follow)
      add(layout_.LinksOf(i), {Transposed(links.rows, links.rows.size() / frames_)});
    links.rows.clear();
    links.follow = true;
  }
  contacts_.clear();
  new_resting_.clear();
  words_ = frames_ = 0;
  return chunk;
}

}  // namespace prehend::episode
