// SPDX-License-Identifier: Apache-2.0
// See harness/episode/frames/chunk.h. Tested by tests/harness/episode/frames/frames_test.cc
#include <algorithm>
#include <bit>
#include <map>

#include "harness/episode/frames/chunk.h"
#include "harness/episode/frames/contact_coding.h"

namespace prehend::episode {
namespace {

/// A chunk holds at most so many words, so that a frame of it is quickly unpacked.
constexpr std::size_t kMostWordsOfChunk = 1 << 16;

Columns Transposed(const std::vector<Word>& rows, std::size_t width) {
  Columns columns(width == 0 ? 0 : rows.size() / width, width);
  Word* to = columns.words.data();
  for (std::size_t column = 0; column < width; ++column) {
    for (std::size_t at = column; at < rows.size(); at += width) *to++ = rows[at];
  }
  return columns;
}

bool SamePoints(const ContactPoints* a, const ContactPoints* b) {
  if (a == b) return true;
  if (!a || !b || a->size() != b->size()) return false;
  for (std::size_t i = 0; i < a->size(); ++i) {
    if (!SamePoint((*a)[i], (*b)[i])) return false;
  }
  return true;
}

const physics::Pose& PoseOf(const physics::Snapshot& snapshot, const physics::ContactSide& side) {
  if (side.hand == physics::kNone) return snapshot.body(side.body).X_WB;
  const physics::HandState& hand = snapshot.hand(side.hand);
  return side.link == physics::kNone ? hand.palm.X_WB : At(hand.X_WL, side.link);
}

}  // namespace

ChunkWriter::ChunkWriter(FrameLayout layout)
    : layout_(std::move(layout)), tracks_(layout_.tracks()) {
  for (const physics::HandModel& model : layout_.hands)
    links_.push_back({LinkGuess(model), {}, {}, {}});
}
ChunkWriter::~ChunkWriter() = default;
ChunkWriter::ChunkWriter(ChunkWriter&&) noexcept = default;

bool ChunkWriter::IsFull() const {
  return ticks_.size() >= kMostFramesOfChunk || words_ >= kMostWordsOfChunk;
}

void ChunkWriter::Add(const physics::Snapshot& snapshot) {
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    AddTrack(i, snapshot, is_first_ || i >= layout_.bodies || snapshot.MayHaveMoved(i, last_tick_));
  AddLinks(snapshot);
  AddResting(snapshot);
  contact_counts_.push_back(snapshot.contacts.size());
  contacts_.insert(contacts_.end(), snapshot.contacts.begin(), snapshot.contacts.end());
  for (const physics::ContactPoint& point : snapshot.contacts)
    owners_.push_back(PoseOf(snapshot, OwnerOf(point)));
  words_ += 8 * snapshot.contacts.size();
  ticks_.push_back(snapshot.tick);
  last_tick_ = snapshot.tick;
  is_first_ = false;
}

void ChunkWriter::AddTrack(std::size_t number, const physics::Snapshot& snapshot,
                           bool may_have_moved) {
  Track& track = tracks_[number];
  if (may_have_moved) {
    row_.resize(layout_.Width(number));
    ReadRow(layout_, number, snapshot, row_);
    if (row_ != track.last || is_first_) {
      if (!track.active) {
        track.active = true;
        track.home = number_;
        for (std::size_t i = 0; i < ticks_.size(); ++i)
          track.rows.insert(track.rows.end(), track.last.begin(), track.last.end());
        words_ += track.rows.size();
      }
      std::swap(track.last, row_);
    }
  }
  if (!track.active) return;
  track.rows.insert(track.rows.end(), track.last.begin(), track.last.end());
  words_ += track.last.size();
}

void ChunkWriter::AddLinks(const physics::Snapshot& snapshot) {
  for (std::size_t h = 0; h < links_.size(); ++h) {
    Links& links = links_[h];
    const physics::HandState& hand = snapshot.hands[h];
    links.palms.push_back(hand.palm.X_WB);
    links.joints.insert(links.joints.end(), hand.joints.begin(), hand.joints.end());
    links.X_WL.insert(links.X_WL.end(), hand.X_WL.begin(), hand.X_WL.end());
  }
}

void ChunkWriter::AddResting(const physics::Snapshot& snapshot) {
  if (snapshot.resting == resting_) return;
  const bool same = SamePoints(resting_.get(), snapshot.resting.get());
  const std::shared_ptr<const ContactPoints> before = std::move(resting_);
  resting_ = snapshot.resting;
  if (same) return;
  // So that the chunk can be read alone.
  if (has_resting_ && new_resting_.empty() && !ticks_.empty()) new_resting_.emplace_back(0, before);
  new_resting_.emplace_back(ticks_.size(), resting_);
  has_resting_ = true;
  resting_home_ = number_;
}

Chunk ChunkWriter::Take() {
  Chunk chunk{.first_tick = ticks_.front(),
              .last_tick = ticks_.back(),
              .frames = ticks_.size(),
              .parts = {}};
  std::vector<bool> has_links;
  std::vector<Columns> links_off;
  for (Links& links : links_) {
    links_off.push_back(LinksOff(links));
    has_links.push_back(
        std::ranges::any_of(links_off.back().words, [](Word word) { return word != 0; }));
    links.palms.clear();
    links.joints.clear();
    links.X_WL.clear();
  }
  chunk.parts.push_back({FrameLayout::kHead, PackedHead(has_links)});
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (tracks_[i].active) chunk.parts.push_back({FrameLayout::PartOfTrack(i), PackedTrack(i)});
  }
  if (!contacts_.empty()) chunk.parts.push_back({layout_.Contacts(), PackedContacts()});
  if (!new_resting_.empty()) chunk.parts.push_back({layout_.Resting(), PackedResting()});
  for (std::size_t h = 0; h < links_.size(); ++h) {
    if (has_links[h]) chunk.parts.push_back({layout_.PartOfLinks(h), PackedLinks(links_off[h])});
  }
  for (Track& track : tracks_) {
    track.active = false;
    track.rows.clear();
  }
  ticks_.clear();
  contact_counts_.clear();
  contacts_.clear();
  owners_.clear();
  new_resting_.clear();
  words_ = 0;
  ++number_;
  return chunk;
}

std::string ChunkWriter::PackedHead(const std::vector<bool>& has_links) {
  std::string bytes;
  AppendVarint(ticks_.size(), bytes);
  Columns ticks(ticks_.size(), 1);
  for (std::size_t i = 0; i < ticks_.size(); ++i) ticks.At(i, 0) = static_cast<Word>(ticks_[i]);
  Encode(ticks, {}, bytes);
  for (const Track& track : tracks_) AppendVarint(number_ - track.home, bytes);
  AppendVarint(contacts_.empty() ? 0 : 1, bytes);
  AppendVarint(has_resting_ ? 1 + number_ - resting_home_ : 0, bytes);
  for (const bool has : has_links) AppendVarint(has ? 1 : 0, bytes);
  return std::string(compressor_.Pack(bytes));
}

std::string ChunkWriter::PackedTrack(std::size_t number) {
  const Columns columns = Transposed(tracks_[number].rows, layout_.Width(number));
  std::string bytes;
  AppendVarint(columns.rows, bytes);
  Encode(columns, {.dt_s = IsRigid(layout_, number) ? 1.0 / layout_.rate_hz : 0}, bytes);
  return std::string(compressor_.Pack(bytes));
}

std::string ChunkWriter::PackedContacts() {
  std::string bytes;
  EncodeContacts(contact_counts_, contacts_, owners_, bytes);
  return std::string(compressor_.Pack(bytes));
}

std::string ChunkWriter::PackedResting() {
  std::string bytes;
  AppendVarint(new_resting_.size(), bytes);
  for (const auto& [frame, points] : new_resting_) {
    AppendVarint(frame, bytes);
    AppendVarint(points ? 1 : 0, bytes);
    if (points) EncodeContacts({points->size()}, *points, {}, bytes);
  }
  return std::string(compressor_.Pack(bytes));
}

Columns ChunkWriter::LinksOff(const Links& links) {
  const std::size_t frames = links.palms.size(), count = links.guess.size();
  Columns off(frames, 7 * count);
  std::vector<PlacedLinks> placed(1 + count);  // the palm, and each link
  for (std::size_t first = 0; first < frames; first += kLanes) {
    const auto frame = [&](std::size_t lane) { return std::min(first + lane, frames - 1); };
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      placed.front().PutPalm(lane, links.palms[frame(lane)]);
    for (std::size_t i = 0; i < count; ++i) {
      Lanes joints{};
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        joints[lane] = links.joints[frame(lane) * count + i];
      PlacedLinks& now = placed[i + 1];
      links.guess.Guess(i, placed[static_cast<std::size_t>(links.guess.ParentOf(i) + 1)], joints,
                        now);
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const physics::Pose &guessed = now.X_WL[lane], &found = links.X_WL[frame(lane) * count + i];
        Word* to = &off.At(frame(lane), 7 * i);
        for (int k = 0; k < 3; ++k, to += frames) *to = OffBy(found.p_m[k], guessed.p_m[k]);
        for (int k = 0; k < 4; ++k, to += frames)
          *to = OffBy(found.q.coeffs()[k], guessed.q.coeffs()[k]);
        now.Correct(lane, found);
      }
    }
  }
  return off;
}

std::string ChunkWriter::PackedLinks(const Columns& off) {
  // Small numbers: a byte each is nearly always enough.
  std::string bytes;
  AppendVarint(off.rows, bytes);
  EncodeSmall(off, bytes);
  return std::string(compressor_.Pack(bytes));
}

}  // namespace prehend::episode
