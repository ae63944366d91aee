// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/datagrams/datagram.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fusion/peers/datagrams/datagram_part.hpp"
#include "fusion/peers/items/claim.hpp"
#include "fusion/peers/items/tile_codec.hpp"
#include "fusion/peers/items/wire.hpp"

namespace cairn::peers {
namespace {

constexpr std::int64_t kLongestNs = std::int64_t{1} << 60;  // differences of such times are safe

bool possible(std::int64_t nanoseconds) { return nanoseconds > -kLongestNs && nanoseconds < kLongestNs; }

Error too_short() { return {Errc::kTruncated, "the datagram ends early"}; }

/// A byte that says whether there is one. False: no such byte.
bool read_presence(ByteReader& in, bool& present) {
  const auto byte = in.read<std::uint8_t>();
  present = byte == 1;
  return byte && *byte <= 1;
}

/// False: no such place.
bool read_place(ByteReader& in, std::optional<Hello::Place>& place) {
  constexpr std::int64_t kMostCm = 100'000'000, kHalfTurnMrad = 3142, kMostMrad = 1'000'000'000;
  constexpr std::array kMost{kMostCm, kMostCm, kMostCm, kHalfTurnMrad, kMostCm, kMostMrad};
  std::array<double, 6> values{};
  bool known = false;
  if (!read_presence(in, known)) return false;
  if (!known) return true;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto read = read_varint(in);
    const std::int64_t least = i < 4 ? -kMost.at(i) : 0, value = read ? unzigzag(*read) : least - 1;
    if (value < least || value > kMost.at(i)) return false;
    values.at(i) = static_cast<double>(value) / (kMost.at(i) == kMostCm ? 100 : 1000);
  }
  place = Hello::Place{{values[0], values[1], values[2]}, values[3], values[4], values[5]};
  return true;
}

/// False: no such echo.
bool read_echo(ByteReader& in, std::optional<Hello::Echo>& echo) {
  bool known = false;
  if (!read_presence(in, known)) return false;
  if (!known) return true;
  const auto robot = read_varint(in);
  const auto stamp = robot ? in.read<std::int64_t>() : std::nullopt;
  const auto age = stamp ? read_varint(in) : std::nullopt;
  if (!age || !possible(*stamp) || *age > static_cast<std::uint64_t>(kLongestNs)) return false;
  echo = Hello::Echo{*robot, Time{Duration{*stamp}}, Duration{static_cast<std::int64_t>(*age)}};
  return true;
}

bool read_name(ByteReader& in, std::string& name) {
  const auto length = in.read<std::uint8_t>();
  const auto bytes = length && *length <= Hello::kMaxName ? in.read_bytes(*length) : std::nullopt;
  if (!bytes) return false;
  for (const std::byte c : *bytes) name += static_cast<char>(c);
  return std::ranges::all_of(name, is_printable);
}

Result<Hello> read_hello(ByteReader& in) {
  Hello hello;
  const auto epoch = read_varint(in);
  const auto newest = epoch ? read_varint(in) : std::nullopt;
  const auto stamp = newest ? in.read<std::int64_t>() : std::nullopt;
  const auto voxel_um = stamp ? read_varint(in) : std::nullopt;
  if (!voxel_um || *voxel_um > ~std::uint32_t{0}) return Error{Errc::kMalformed, "not a hello", {}, in.offset()};
  if (*epoch > kLastEpoch) return Error{Errc::kMalformed, "an epoch that cannot be"};
  if (!possible(*stamp)) return Error{Errc::kMalformed, "a clock beyond 36 years"};
  hello = {*epoch, *newest, Time{Duration{*stamp}}, {}, {}, static_cast<std::uint32_t>(*voxel_um), {}};
  if (!read_name(in, hello.name)) return Error{Errc::kMalformed, "a name that cannot be, of 24 printable characters"};
  if (!read_place(in, hello.place)) return Error{Errc::kMalformed, "a place that cannot be"};
  if (!read_echo(in, hello.echo)) return Error{Errc::kMalformed, "an echo that cannot be"};
  return hello;
}

bool read_ranges(ByteReader& in, VersionSet& known) {
  const auto count = in.read<std::uint8_t>();
  if (!count || *count > VersionSet::kMostRanges) return false;
  Version after = 0;
  for (unsigned i = 0; i < *count; ++i) {
    const auto gap = read_varint(in);
    const auto length = gap ? read_varint(in) : std::nullopt;
    const Version most = ~Version{0};
    if (!length || (i > 0 && *gap == 0)) return false;  // ranges that touch would be one
    if (*gap > most - after - 1 || *length > most - (after + 1 + *gap)) return false;
    const Version first = after + 1 + *gap;
    known.add({first, first + *length});
    after = first + *length;
    if (after == most && i + 1U < *count) return false;
  }
  return true;
}

Result<Digest> read_digest(ByteReader& in) {
  Digest digest;
  const auto count = in.read<std::uint8_t>();
  if (!count) return too_short();
  if (*count == 0) return Error{Errc::kMalformed, "a digest of no robot", {}, in.offset()};
  if (*count > Digest::kMaxLayers) return Error{Errc::kMalformed, "a digest of more than 32 robots"};
  for (unsigned i = 0; i < *count; ++i) {
    const auto robot = read_varint(in);
    const auto epoch = robot ? read_varint(in) : std::nullopt;
    const auto direct = epoch ? in.read<std::uint8_t>() : std::nullopt;
    if (!direct) return Error{Errc::kMalformed, "not a digest", {}, in.offset()};
    digest.layers.push_back({*robot, *epoch, *direct == 1, {}});
    if (*direct > 1 || *robot == 0 || *epoch > kLastEpoch || !read_ranges(in, digest.layers.back().known))
      return Error{Errc::kMalformed, "not a digest", {}, in.offset()};
  }
  return digest;
}

bool is_sound(const ItemUpdate& update) {
  switch (update.id.kind()) {
    case ItemKind::kTile:
      return is_uniform_tile(update.payload) || decode_tile(update.payload).has_value();
    case ItemKind::kSubmap:
      return decode_submap(update.payload).has_value();
    case ItemKind::kEdge:
      return decode_edge(update.payload).has_value();
    case ItemKind::kDeployment:
      break;
  }
  return decode_deployment(update.payload).has_value();
}

/// `above`: the id must be at least that, and comes as the difference to it. What is wrong, or null: a datagram of tiny
/// items would cost more in errors that did not happen than in items.
const char* read_update(ByteReader& in, std::uint64_t above, Version lowest, ItemUpdate& update) {
  const auto step = read_varint(in);
  const auto rise = step ? read_varint(in) : std::nullopt;
  const auto superseded = rise ? read_varint(in) : std::nullopt;
  const auto length = superseded ? read_varint(in) : std::nullopt;
  if (!length) return "not an item";
  const std::uint64_t most = ~std::uint64_t{0};
  if (*step > most - above || *rise > most - lowest || *length > kMaxPayload) return "an item beyond its bounds";
  const auto payload = in.read_bytes(*length);
  if (!payload) return "an item that ends early";
  update = {{above + *step}, lowest + *rise, *superseded, *payload};
  if (!update.id.valid() || update.version <= update.superseded) return "an item that cannot be";
  return is_sound(update) ? nullptr : "an item's payload that cannot be";
}

Result<Items> read_items(ByteReader& in) {
  Items items;
  const auto robot = in.read<RobotId>();
  const auto epoch = in.read<Epoch>();
  const auto lowest = in.read<Version>();
  if (!lowest) return too_short();
  if (*robot == 0 || *epoch > kLastEpoch) return Error{Errc::kMalformed, "items of no robot, or of no epoch"};
  items.robot = *robot;
  items.epoch = *epoch;
  const std::size_t ranges_at = in.offset();
  if (!read_ranges(in, items.superseded) || in.offset() - ranges_at > kMaxRangeBytes)
    return Error{Errc::kMalformed, "not a set of versions", {}, in.offset()};
  items.updates.reserve(in.remaining() / 5);
  bool lowest_met = in.remaining() == 0 && *lowest == 0;
  for (std::uint64_t above = 0; in.remaining() > 0;) {
    ItemUpdate& update = items.updates.emplace_back();
    if (const char* wrong = read_update(in, above, *lowest, update))
      return Error{Errc::kMalformed, wrong, {}, in.offset()};
    lowest_met = lowest_met || update.version == *lowest;
    above = update.id.code + 1;
  }
  if (!lowest_met) return Error{Errc::kMalformed, "no item, or none of the lowest version"};
  return items;
}

/// Reads the parts that there are.
Result<Datagram> read_parts(ByteReader& in, std::uint8_t parts, RobotId sender) {
  Datagram datagram{sender, {}, {}, {}};
  if (parts & kHelloPart) {
    auto hello = read_hello(in);
    if (!hello) return hello.error();
    datagram.hello = std::move(*hello);
  }
  if (parts & kDigestPart) {
    const std::size_t begin = in.offset();
    auto digest = read_digest(in);
    if (!digest) return digest.error();
    if ((parts & kItemsPart) && in.offset() - begin > kMaxRangeBytes)
      return Error{Errc::kMalformed, "a digest that leaves no room for items", {}, begin};
    datagram.digest = std::move(*digest);
  }
  if (parts & kItemsPart) {
    auto items = read_items(in);
    if (!items) return items.error();
    datagram.items = std::move(*items);
  }
  if (parts & kBodiesPart) {
    if (datagram.items) return Error{Errc::kMalformed, "people together with items", {}, 1};
    auto bodies = read_bodies(in);
    if (!bodies) return bodies.error();
    datagram.bodies = std::move(*bodies);
  }
  if (in.remaining() != 0) return Error{Errc::kMalformed, "bytes after the end of the datagram", {}, in.offset()};
  return datagram;
}

}  // namespace

RobotId sender_of(std::span<const std::byte> bytes) {
  return bytes.size() < kHeaderBytes ? 0 : load_le<RobotId>(bytes, 2);
}

Result<Datagram> decode_datagram(std::span<const std::byte> bytes) {
  if (bytes.size() > kMaxDatagram) return Error{Errc::kLimit, "a datagram of more than 1200 bytes"};
  ByteReader in(bytes);
  const auto format = in.read<std::uint8_t>();
  const auto parts = in.read<std::uint8_t>();
  const auto sender = in.read<RobotId>();
  if (!sender) return too_short();
  if (*format != kFormat)
    return Error{Errc::kUnsupported, "another version of the format", {}, 0, std::to_string(*format)};
  if (*sender == 0) return Error{Errc::kMalformed, "a datagram of no robot"};
  if (*parts == 0 || *parts > kAllParts) return Error{Errc::kMalformed, "no such parts of a datagram", {}, 1};
  return read_parts(in, *parts, *sender);
}

}  // namespace cairn::peers
