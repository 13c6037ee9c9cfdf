// SPDX-License-Identifier: Apache-2.0
// See harness/episode/frames/chunk.h. Tested by tests/harness/episode/frames/frames_test.cc
#include <algorithm>

#include "harness/episode/frames/chunk.h"
#include "physics/base/check.h"

namespace prehend::episode {
namespace {

/// A chunk holds at most so many words, so that a frame is quickly unpacked.
constexpr std::size_t kMostWordsOfChunk = 1 << 16;

bool SamePoints(const ContactPoints* a, const ContactPoints* b) {
  return a == b || (a && b && TableOfPoints({a}).words == TableOfPoints({b}).words);
}

}  // namespace

ChunkWriter::ChunkWriter(FrameLayout layout)
    : layout_(std::move(layout)), tracks_(layout_.tracks()) {
  for (const physics::HandModel& model : layout_.hands)
    links_.push_back({.places = physics::LinkPlaces(model), .rows = {}});
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
              .frames = frames_,
              .parts = {}};
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
