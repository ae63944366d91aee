// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/items/tile_labels.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <optional>
#include <set>

#include "fusion/peers/items/tile_planes.hpp"

namespace cairn::peers {
namespace {

/// Small numbers one after the other, the lowest bits first.
class BitWriter {
 public:
  explicit BitWriter(std::vector<std::byte>& out) : out_(out) {}
  void write(unsigned value, unsigned bits) {
    pending_ |= value << filled_;
    for (filled_ += bits; filled_ >= 8; filled_ -= 8, pending_ >>= 8) put(out_, static_cast<std::uint8_t>(pending_));
  }
  void finish() {
    if (filled_ > 0) put(out_, static_cast<std::uint8_t>(pending_));
  }

 private:
  std::vector<std::byte>& out_;
  unsigned pending_ = 0, filled_ = 0;
};

class BitReader {
 public:
  explicit BitReader(ByteReader& in) : in_(in) {}
  std::optional<unsigned> read(unsigned bits) {
    for (; left_ < bits; left_ += 8) {
      const auto next = in_.read<std::uint8_t>();
      if (!next) return std::nullopt;
      pending_ |= unsigned{*next} << left_;
    }
    const unsigned value = pending_ & ((1U << bits) - 1);
    pending_ >>= bits;
    left_ -= bits;
    return value;
  }
  /// Whether what is left over of the last byte is zeros.
  [[nodiscard]] bool finished() const { return pending_ == 0; }

 private:
  ByteReader& in_;
  unsigned pending_ = 0, left_ = 0;
};

unsigned bits_for(std::size_t labels) { return static_cast<unsigned>(std::bit_width(labels - 1)); }

std::optional<std::vector<mapping::VoxelLabel>> read_palette(ByteReader& in) {
  const auto count = in.read<std::uint8_t>();
  if (!count || *count == 0 || *count > mapping::TileState::kMostLabels) return std::nullopt;
  std::vector<mapping::VoxelLabel> palette;
  for (unsigned i = 0; i < *count; ++i) {
    const auto code = in.read<std::uint8_t>();
    if (!code || *code == 0 || *code > mapping::VoxelLabel::kCodes) return std::nullopt;
    if (!palette.empty() && *code <= palette.back().code) return std::nullopt;
    palette.push_back({*code});
  }
  return palette;
}

}  // namespace

void put_labels(std::vector<std::byte>& out, const mapping::TileState& state) {
  std::set<mapping::VoxelLabel> palette;
  Plane labelled{};
  for (std::size_t i = 0; i < state.labels.size(); ++i) {
    if (!state.labels[i].any()) continue;
    labelled[i / 64] |= std::uint64_t{1} << (i % 64);
    palette.insert(state.labels[i]);
  }
  put_plane(out, row_changes(labelled));
  put(out, static_cast<std::uint8_t>(palette.size()));
  for (const mapping::VoxelLabel label : palette) put(out, label.code);
  BitWriter indices(out);
  for (const mapping::VoxelLabel label : state.labels)
    if (label.any())
      indices.write(static_cast<unsigned>(std::distance(palette.begin(), palette.find(label))),
                    bits_for(palette.size()));
  indices.finish();
}

bool read_labels(ByteReader& in, mapping::TileState& state) {
  const auto changes = read_plane(in);
  const auto palette = changes ? read_palette(in) : std::nullopt;
  if (!palette) return false;
  const Plane labelled = from_row_changes(*changes);
  std::vector<bool> used(palette->size());
  BitReader indices(in);
  state.labels.assign(512, {});
  for (std::size_t i = 0; i < state.labels.size(); ++i) {
    if ((labelled[i / 64] >> (i % 64) & 1U) == 0) continue;
    const auto index = indices.read(bits_for(palette->size()));
    if (!index || *index >= palette->size()) return false;
    state.labels[i] = (*palette)[*index];
    used[*index] = true;
  }
  return indices.finished() && std::ranges::count(used, false) == 0;
}

}  // namespace cairn::peers
