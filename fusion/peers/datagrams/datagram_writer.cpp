// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "fusion/peers/datagrams/datagram.hpp"
#include "fusion/peers/datagrams/datagram_part.hpp"
#include "fusion/peers/items/wire.hpp"

namespace cairn::peers {
namespace {

constexpr std::size_t kItemsHeaderBytes = 24;  // robot, epoch, lowest version

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

/// In hundredths or thousandths; what is beyond all bounds, or no number, as what is refused.
std::uint64_t whole(double value, double parts) {
  constexpr double kMost = 1e15;
  return std::abs(value) <= kMost ? zigzag(std::llround(value * parts)) : ~std::uint64_t{0};
}

void append_place(std::vector<std::byte>& out, const std::optional<Hello::Place>& place) {
  append_le(out, static_cast<std::uint8_t>(place ? 1 : 0));
  if (!place) return;
  for (const double coordinate : place->position_m) append_varint(out, whole(coordinate, 100));
  append_varint(out, whole(place->yaw_rad, 1000));
  append_varint(out, whole(place->sigma_m, 100));
  append_varint(out, whole(place->sigma_rad, 1000));
}

void append_hello(std::vector<std::byte>& out, const Hello& hello) {
  append_varint(out, hello.epoch);
  append_varint(out, hello.newest);
  append_le(out, ns(hello.stamp));
  append_varint(out, hello.voxel_um);
  const std::size_t length = std::min(hello.name.size(), Hello::kMaxName);
  append_le(out, static_cast<std::uint8_t>(length));
  for (std::size_t i = 0; i < length; ++i) append_le(out, is_printable(hello.name[i]) ? hello.name[i] : '?');
  append_place(out, hello.place);
  append_le(out, static_cast<std::uint8_t>(hello.echo ? 1 : 0));
  if (!hello.echo) return;
  append_varint(out, hello.echo->robot);
  append_le(out, ns(hello.echo->stamp));
  append_varint(out, static_cast<std::uint64_t>(hello.echo->age.count()));
}

/// Up to `most` bytes of the datagram.
void append_digest(std::vector<std::byte>& out, const Digest& digest, std::size_t most) {
  const std::size_t count_at = out.size();
  append_le(out, std::uint8_t{0});
  std::uint8_t count = 0;
  for (const Digest::Layer& layer : digest.layers) {
    const std::size_t header = varint_bytes(layer.robot) + varint_bytes(layer.epoch) + 1;
    if (count == Digest::kMaxLayers || out.size() + header + 1 > most) break;
    const auto ranges = encoded_ranges(layer.known, most - out.size() - header);
    append_varint(out, layer.robot);
    append_varint(out, layer.epoch);
    append_le(out, static_cast<std::uint8_t>(layer.direct ? 1 : 0));
    out.insert(out.end(), ranges.begin(), ranges.end());
    ++count;
  }
  out[count_at] = std::byte{count};
}

/// How many of the updates there are.
std::size_t append_items(std::vector<std::byte>& out, const Items& items) {
  const auto superseded = encoded_ranges(items.superseded, kMaxRangeBytes);
  const Packed packed = pack_most(items.updates, out.size() + kItemsHeaderBytes + superseded.size());
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
  return packed.updates.size();
}

}  // namespace

EncodedDatagram encode(const Datagram& datagram) {
  EncodedDatagram encoded;
  std::vector<std::byte>& out = encoded.bytes;
  out.reserve(kMaxDatagram);
  std::vector<std::byte> bodies;
  if (datagram.bodies && !datagram.items) append_bodies(bodies, *datagram.bodies);
  append_le(out, kFormat);
  append_le(out, static_cast<std::uint8_t>((datagram.hello ? kHelloPart : 0) |
                                           (datagram.digest.layers.empty() ? 0 : kDigestPart) |
                                           (datagram.items ? kItemsPart : 0) | (bodies.empty() ? 0 : kBodiesPart)));
  append_le(out, datagram.sender);
  if (datagram.hello) append_hello(out, *datagram.hello);
  if (!datagram.digest.layers.empty())
    append_digest(out, datagram.digest, datagram.items ? out.size() + kMaxRangeBytes : kMaxDatagram - bodies.size());
  if (datagram.items) encoded.updates = append_items(out, *datagram.items);
  out.insert(out.end(), bodies.begin(), bodies.end());
  return encoded;
}

}  // namespace cairn::peers
