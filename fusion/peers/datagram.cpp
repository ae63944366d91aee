// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/datagram.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fusion/peers/claim.hpp"
#include "fusion/peers/datagram_kind.hpp"
#include "fusion/peers/tile_codec.hpp"
#include "fusion/peers/wire.hpp"

namespace cairn::peers {
namespace {

/// Whether differences of such times are safe.
bool possible(std::int64_t nanoseconds) {
  constexpr std::int64_t kLongest = std::int64_t{1} << 60;
  return nanoseconds > -kLongest && nanoseconds < kLongest;
}

Error too_short() { return {Errc::kTruncated, "the datagram ends early"}; }

/// A byte that says whether there is one, then six floats. False: no such place.
bool read_place(ByteReader& in, std::optional<Hello::Place>& place) {
  constexpr float kMost = 1e6F, kHalfTurn = 3.1416F;
  const auto known = in.read<std::uint8_t>();
  if (!known || *known > 1) return false;
  if (*known == 0) return true;
  std::array<float, 6> values{};
  for (float& value : values) value = in.read<float>().value_or(NAN);
  const auto within = [](float value, float least, float most) { return value >= least && value <= most; };
  for (const std::size_t i : {0U, 1U, 2U})
    if (!within(values[i], -kMost, kMost)) return false;
  if (!within(values[3], -kHalfTurn, kHalfTurn)) return false;
  if (!within(values[4], 0, kMost) || !within(values[5], 0, kMost)) return false;
  place = Hello::Place{{values[0], values[1], values[2]}, values[3], values[4], values[5]};
  return true;
}

Result<Hello> read_hello(ByteReader& in) {
  Hello hello;
  const auto epoch = in.read<Epoch>();
  const auto newest = in.read<Version>();
  const auto stamp = in.read<std::int64_t>();
  const auto voxel_um = stamp ? in.read<std::uint32_t>() : std::nullopt;
  const auto length = voxel_um ? in.read<std::uint8_t>() : std::nullopt;
  if (!length) return too_short();
  if (*epoch > kLastEpoch) return Error{Errc::kMalformed, "an epoch that cannot be"};
  if (!possible(*stamp)) return Error{Errc::kMalformed, "a clock beyond 36 years"};
  if (*length > Hello::kMaxName) return Error{Errc::kMalformed, "a robot's name of more than 24 bytes"};
  const auto name = in.read_bytes(*length);
  std::optional<Hello::Place> place;
  if (!name) return too_short();
  if (!read_place(in, place)) return Error{Errc::kMalformed, "a place that cannot be"};
  const auto echoes = in.read<std::uint8_t>();
  if (!echoes) return too_short();
  if (*echoes > Hello::kMaxEchoes) return Error{Errc::kMalformed, "more than 32 echoes"};
  hello = {*epoch, *newest, Time{Duration{*stamp}}, {}, {}, *voxel_um, place};
  for (const std::byte c : *name) hello.name += static_cast<char>(c);
  if (!std::ranges::all_of(hello.name, is_printable))
    return Error{Errc::kMalformed, "a robot's name that cannot be printed"};
  for (unsigned i = 0; i < *echoes; ++i) {
    const auto robot = in.read<RobotId>();
    const auto heard = in.read<std::int64_t>();
    const auto age = in.read<std::int64_t>();
    if (!age) return too_short();
    if (*age < 0 || !possible(*age) || !possible(*heard)) return Error{Errc::kMalformed, "an echo that cannot be"};
    hello.echoes.push_back({*robot, Time{Duration{*heard}}, Duration{*age}});
  }
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
  if (!read_ranges(in, items.superseded) || in.offset() - ranges_at > kMaxSuperseded)
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

template <class T>
Result<Datagram> sealed(RobotId sender, const ByteReader& in, Result<T> content) {
  if (!content) return content.error();
  if (in.remaining() != 0) return Error{Errc::kMalformed, "bytes after the end of the datagram", {}, in.offset()};
  return Datagram{sender, std::move(*content)};
}

}  // namespace

RobotId sender_of(std::span<const std::byte> bytes) {
  return bytes.size() < kHeaderBytes ? 0 : load_le<RobotId>(bytes, 2);
}

Result<Datagram> decode_datagram(std::span<const std::byte> bytes) {
  if (bytes.size() > kMaxDatagram) return Error{Errc::kLimit, "a datagram of more than 1200 bytes"};
  ByteReader in(bytes);
  const auto format = in.read<std::uint8_t>();
  const auto kind = in.read<std::uint8_t>();
  const auto sender = in.read<RobotId>();
  if (!sender) return too_short();
  if (*format != kFormat)
    return Error{Errc::kUnsupported, "another version of the format", {}, 0, std::to_string(*format)};
  if (*sender == 0) return Error{Errc::kMalformed, "a datagram of no robot"};
  switch (static_cast<DatagramKind>(*kind)) {
    case DatagramKind::kHello:
      return sealed(*sender, in, read_hello(in));
    case DatagramKind::kDigest:
      return sealed(*sender, in, read_digest(in));
    case DatagramKind::kItems:
      return sealed(*sender, in, read_items(in));
  }
  return Error{Errc::kMalformed, "no such kind of datagram", {}, 1};
}

}  // namespace cairn::peers
