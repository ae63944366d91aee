// SPDX-License-Identifier: Apache-2.0
#include "onboard/mapping/insert/footprint.hpp"

#include <algorithm>

namespace cairn::mapping {

void Footprint::reset(const BrickGrid& grid) {
  for (std::size_t slot = 1; slot < bricks_.size() && flat_; ++slot) table_[bricks_[slot]] = 0;
  if (!flat_) std::fill(table_.begin(), table_.end(), 0U);
  make_room(1024);
  std::fill_n(free_.begin(), bricks_.size() * kWords, 0U);
  std::fill_n(occupied_.begin(), bricks_.size() * kWords, 0U);
  bricks_.resize(1);
  overflown_ = false;
  grid_ = grid;
  flat_ = grid.brick_bits() <= kMaxFlatBits;
  const std::size_t places = std::size_t{1} << (flat_ ? grid.brick_bits() : 10);
  if (table_.size() < places) table_.resize(places);
}

bool Footprint::mark_occupied(std::uint64_t index) {
  const std::uint64_t brick = index >> BrickGrid::kBrickShift;
  std::uint64_t& word = occupied_[(flat_ ? words_of<true>(brick) : words_of<false>(brick)) + ((index >> 6) & 63)];
  const std::uint64_t bit = std::uint64_t{1} << (index & 63);
  const bool added = (word & bit) == 0;
  word |= bit;
  return added;
}

void Footprint::merge(const Footprint& other) {
  overflown_ = overflown_ || other.overflown_;
  for (std::uint32_t slot = 1; slot < other.bricks_.size(); ++slot) {
    const std::uint64_t brick = other.bricks_[slot];
    const std::size_t to = flat_ ? words_of<true>(brick) : words_of<false>(brick);
    for (std::size_t w = 0; w < kWords; ++w) {
      free_[to + w] |= other.free(slot)[w];
      occupied_[to + w] |= other.occupied(slot)[w];
    }
  }
}

std::span<const BrickRef> Footprint::sorted_bricks() {
  refs_.clear();
  for (std::uint32_t slot = 1; slot < bricks_.size(); ++slot)
    refs_.push_back({grid_.path_of_brick(bricks_[slot]), slot});
  std::sort(refs_.begin(), refs_.end());
  return refs_;
}

std::size_t Footprint::bytes() const {
  return (free_.capacity() + occupied_.capacity() + bricks_.capacity()) * sizeof(std::uint64_t) +
         table_.capacity() * sizeof(std::uint32_t) + refs_.capacity() * sizeof(BrickRef);
}

std::uint32_t Footprint::add_brick(std::uint64_t brick) {
  if (brick_count() == max_bricks_) {
    overflown_ = true;
    return 0;
  }
  const auto slot = static_cast<std::uint32_t>(bricks_.size());
  if ((slot + 1) * kWords > free_.size()) make_room(2 * slot);
  bricks_.push_back(brick);
  enter(brick, slot * static_cast<std::uint32_t>(kWords));
  return slot * static_cast<std::uint32_t>(kWords);
}

/// All that holds one entry per brick grows at once, and seldom: scans of a warm robot must not allocate.
void Footprint::make_room(std::size_t slots) {
  if (free_.size() >= slots * kWords) return;
  free_.resize(slots * kWords);
  occupied_.resize(slots * kWords);
  bricks_.reserve(slots);
  refs_.reserve(slots);
}

void Footprint::enter(std::uint64_t brick, std::uint32_t words) {
  if (flat_) {
    table_[brick] = words;
    return;
  }
  table_[hash_place(brick)] = words;
  if (bricks_.size() * 2 > table_.size()) rehash(table_.size() * 2);
}

/// The place of the brick, or the free one where it belongs. Linear probing; the table is never more than half full.
std::size_t Footprint::hash_place(std::uint64_t brick) const {
  const std::size_t mask = std::bit_floor(table_.size()) - 1;
  std::size_t place = (brick * 0x9E3779B97F4A7C15U >> 20U) & mask;
  while (table_[place] != 0 && bricks_[table_[place] / kWords] != brick) place = (place + 1) & mask;
  return place;
}

void Footprint::rehash(std::size_t places) {
  table_.assign(places, 0U);
  for (std::uint32_t slot = 1; slot < bricks_.size(); ++slot)
    table_[hash_place(bricks_[slot])] = slot * static_cast<std::uint32_t>(kWords);
}

}  // namespace cairn::mapping
