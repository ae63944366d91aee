// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "fusion/peers/datagram.hpp"
#include "fusion/peers/datagram_kind.hpp"
#include "fusion/peers/wire.hpp"

namespace cairn::peers {
namespace {

constexpr std::size_t kItemsHeaderBytes = kHeaderBytes + 24;

std::vector<std::byte> begin(RobotId sender, DatagramKind kind) {
  std::vector<std::byte> out;
  out.reserve(kMaxDatagram);
  append_le(out, kFormat);
  append_le(out, static_cast<std::uint8_t>(kind));
  append_le(out, sender);
  return out;
}

std::int64_t ns(Time time) { return time.time_since_epoch().count(); }

/// Ranges as the gaps before them and their lengths, both less one where they cannot be nothing.
std::vector<std::byte> encoded_ranges(const VersionSet& known, std::size_t most_bytes) {
  std::vector<std::byte> bytes, next;
  Version after = 0;  // the last version of the range before
  std::uint8_t count = 0;
  for (const VersionRange& range : known.ranges()) {
    next.clear();
    append_varint(next, range.first - after - 1);
    append_varint(next, range.last - range.first);
    if (1 + bytes.size() + next.size() > most_bytes) break;
    bytes.insert(bytes.end(), next.begin(), next.end());
    after = range.last;
    ++count;
  }
  bytes.insert(bytes.begin(), std::byte{count});
  return bytes;
}

/// The first of the updates, in order, and what they take in a datagram.
struct Packed {
  std::vector<ItemUpdate> updates;
  Version lowest = 0;
  std::size_t bytes = 0;
};

Packed pack(std::span<const ItemUpdate> updates, std::size_t before) {
  Packed packed;
  packed.bytes = before;
  packed.updates.assign(updates.begin(), updates.end());
  std::ranges::sort(packed.updates, {}, &ItemUpdate::id);
  if (!updates.empty()) packed.lowest = std::ranges::min(updates, {}, &ItemUpdate::version).version;
  std::uint64_t above = 0;
  for (const ItemUpdate& update : packed.updates) {
    packed.bytes += varint_bytes(update.id.code - above) + varint_bytes(update.version - packed.lowest) +
                    varint_bytes(update.superseded) + varint_bytes(update.payload.size()) + update.payload.size();
    above = update.id.code + 1;
  }
  return packed;
}

/// As many as a datagram holds after so many bytes.
Packed pack_most(std::span<const ItemUpdate> updates, std::size_t before) {
  std::size_t fit = 0, too_many = std::min(updates.size(), kMaxDatagram / 5) + 1;
  Packed best;
  while (fit + 1 < too_many) {
    const std::size_t count = (fit + too_many) / 2;
    Packed packed = pack(updates.first(count), before);
    if (packed.bytes > kMaxDatagram) {
      too_many = count;
      continue;
    }
    fit = count;
    best = std::move(packed);
  }
  return best;
}

}  // namespace

std::vector<std::byte> encode(RobotId sender, const Hello& hello) {
  std::vector<std::byte> out = begin(sender, DatagramKind::kHello);
  append_le(out, hello.epoch);
  append_le(out, hello.newest);
  append_le(out, ns(hello.stamp));
  append_le(out, hello.voxel_um);
  const std::size_t length = std::min(hello.name.size(), Hello::kMaxName);
  append_le(out, static_cast<std::uint8_t>(length));
  for (std::size_t i = 0; i < length; ++i) append_le(out, is_printable(hello.name[i]) ? hello.name[i] : '?');
  append_le(out, static_cast<std::uint8_t>(hello.place ? 1 : 0));
  if (hello.place) {
    for (const float coordinate : hello.place->position_m) append_le(out, coordinate);
    for (const float value : {hello.place->yaw_rad, hello.place->sigma_m, hello.place->sigma_rad})
      append_le(out, value);
  }
  const std::size_t echoes = std::min(hello.echoes.size(), Hello::kMaxEchoes);
  append_le(out, static_cast<std::uint8_t>(echoes));
  for (std::size_t i = 0; i < echoes; ++i) {
    append_le(out, hello.echoes[i].robot);
    append_le(out, ns(hello.echoes[i].stamp));
    append_le(out, hello.echoes[i].age.count());
  }
  return out;
}

std::vector<std::byte> encode(RobotId sender, const Digest& digest) {
  constexpr std::size_t kLayerHeader = 10 + 10 + 1;
  std::vector<std::byte> out = begin(sender, DatagramKind::kDigest);
  const std::size_t count_at = out.size();
  append_le(out, std::uint8_t{0});
  std::uint8_t count = 0;
  for (const Digest::Layer& layer : digest.layers) {
    if (count == Digest::kMaxLayers || out.size() + kLayerHeader + 1 > kMaxDatagram) break;
    const auto ranges = encoded_ranges(layer.known, kMaxDatagram - out.size() - kLayerHeader);
    append_varint(out, layer.robot);
    append_varint(out, layer.epoch);
    append_le(out, static_cast<std::uint8_t>(layer.direct ? 1 : 0));
    out.insert(out.end(), ranges.begin(), ranges.end());
    ++count;
  }
  out[count_at] = std::byte{count};
  return out;
}

std::vector<std::byte> encode(RobotId sender, const Items& items, std::size_t& count) {
  const auto superseded = encoded_ranges(items.superseded, kMaxSuperseded);
  const Packed packed = pack_most(items.updates, kItemsHeaderBytes + superseded.size());
  count = packed.updates.size();
  std::vector<std::byte> out = begin(sender, DatagramKind::kItems);
  append_le(out, items.robot);
  append_le(out, items.epoch);
  append_le(out, packed.lowest);
  out.insert(out.end(), superseded.begin(), superseded.end());
  std::uint64_t above = 0;
  for (const ItemUpdate& update : packed.updates) {
    append_varint(out, update.id.code - above);
    append_varint(out, update.version - packed.lowest);
    append_varint(out, update.superseded);
    append_varint(out, update.payload.size());
    out.insert(out.end(), update.payload.begin(), update.payload.end());
    above = update.id.code + 1;
  }
  return out;
}

}  // namespace cairn::peers
