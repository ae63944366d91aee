// SPDX-License-Identifier: Apache-2.0
#include "drivers/clients/messages/tiles.hpp"

#include <algorithm>

#include "drivers/clients/messages/field_reader.hpp"

namespace cairn::clients {
namespace {

constexpr std::size_t kCaughtUpAt = Record::kHeaderBytes + 1, kCountAt = Record::kHeaderBytes + 2;
constexpr std::size_t kTileHead = 8 + 8 + 8 + 1 + 2, kContributorBytes = 8;
constexpr std::uint64_t kKeys = std::uint64_t{1} << 39U;

TilesMessage::Tile read_tile(FieldReader& in) {
  TilesMessage::Tile tile;
  tile.key = in.up_to(kKeys - 1);
  tile.version = in.number<std::uint64_t>();
  tile.changed = in.time();
  const std::size_t contributors = in.up_to(static_cast<std::uint8_t>(TilesMessage::kMaxContributors));
  const std::size_t size = in.up_to(static_cast<std::uint16_t>(TilesMessage::kMaxTileBytes));
  for (std::size_t i = 0; i < contributors; ++i) tile.contributors.push_back(in.number<std::uint64_t>());
  in.require(std::ranges::adjacent_find(tile.contributors, std::ranges::greater_equal{}) == tile.contributors.end());
  const auto bytes = in.bytes(size);
  tile.bytes.assign(bytes.begin(), bytes.end());
  return tile;
}

}  // namespace

TilesWriter::TilesWriter(const TilesMessage& head, std::uint32_t sequence, std::vector<std::byte>& out) : out_(out) {
  begin_record(RecordKind::kTiles, sequence, out_);
  append_le(out_, static_cast<std::uint8_t>(head.map));
  append_le(out_, std::uint8_t{0});
  append_le(out_, std::uint16_t{0});
  append_le(out_, head.epoch);
  append_le(out_, head.session);
}

bool TilesWriter::add(const TilesMessage::Tile& tile) {
  const std::size_t contributors = std::min(tile.contributors.size(), TilesMessage::kMaxContributors);
  const std::size_t size = kTileHead + kContributorBytes * contributors + tile.bytes.size();
  if (out_.size() + size > Record::kHeaderBytes + Record::kMaxBody) return false;
  append_le(out_, tile.key);
  append_le(out_, tile.version);
  append_time(out_, tile.changed);
  append_le(out_, static_cast<std::uint8_t>(contributors));
  append_le(out_, static_cast<std::uint16_t>(tile.bytes.size()));
  for (std::size_t i = 0; i < contributors; ++i) append_le(out_, tile.contributors[i]);
  out_.insert(out_.end(), tile.bytes.begin(), tile.bytes.end());
  ++tiles_;
  return true;
}

void TilesWriter::finish(bool caught_up) {
  out_[kCaughtUpAt] = static_cast<std::byte>(caught_up);
  std::memcpy(out_.data() + kCountAt, &tiles_, sizeof tiles_);
  end_record(out_);
}

Result<TilesMessage> decode_tiles(std::span<const std::byte> body) {
  FieldReader in(body);
  TilesMessage message;
  message.map = static_cast<TileMap>(in.up_to(static_cast<std::uint8_t>(TileMap::kTeam)));
  message.caught_up = in.up_to(std::uint8_t{1}) != 0;
  const auto tiles = in.number<std::uint16_t>();
  message.epoch = in.number<std::uint32_t>();
  message.session = in.number<std::uint64_t>();
  for (unsigned i = 0; i < tiles && in.good(); ++i) {
    message.tiles.push_back(read_tile(in));
    in.require(i == 0 || message.tiles[i - 1].version < message.tiles[i].version);
  }
  if (!in.complete()) return in.error("not a record of tiles");
  return message;
}

}  // namespace cairn::clients
