// SPDX-License-Identifier: Apache-2.0
#include "fusion/peers/items/tile_codec.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>

#include "fusion/peers/items/tile_labels.hpp"
#include "fusion/peers/items/tile_planes.hpp"
#include "hal/bytes.hpp"

namespace cairn::peers {
namespace {

constexpr std::uint64_t kAll = ~std::uint64_t{0};
constexpr std::uint8_t kUniform = 0x80, kUniformOccupied = 4, kUniformBits = 0x87;
constexpr std::uint8_t kSomeUnknown = 1, kSomeOccupied = 2, kSomeWeak = 4, kSomeLabels = 8, kBits = 15;

bool is(const Plane& plane, std::uint64_t value) {
  return std::all_of(plane.begin(), plane.end(), [value](std::uint64_t slice) { return slice == value; });
}
bool uniform(const Plane& plane) { return (plane[0] == 0 || plane[0] == kAll) && is(plane, plane[0]); }
bool uniform(const mapping::TileState& s) {
  return s.labels.empty() && is(s.known, kAll) && uniform(s.occupied) && uniform(s.low) && uniform(s.high);
}

Plane weak(const mapping::TileState& s) {
  Plane plane{};
  for (unsigned z = 0; z < kEdge; ++z) plane[z] = s.low[z] & ~s.occupied[z];
  return plane;
}

Plane slice_changes(Plane plane) {
  for (unsigned z = kEdge; --z > 0;) plane[z] ^= plane[z - 1];
  return plane;
}
Plane from_slice_changes(Plane changes) {
  for (unsigned z = 1; z < kEdge; ++z) changes[z] ^= changes[z - 1];
  return changes;
}

void put_grades(std::vector<std::byte>& out, const mapping::TileState& s) {
  unsigned bits = 0, filled = 0;
  for (unsigned z = 0; z < kEdge; ++z)
    for (std::uint64_t left = s.occupied[z]; left != 0; left &= left - 1) {
      const int at = std::countr_zero(left);
      bits |= static_cast<unsigned>((s.low[z] >> at & 1U) | (s.high[z] >> at & 1U) << 1) << filled;
      filled += 2;
      if (filled == 8) {
        put(out, static_cast<std::uint8_t>(bits));
        bits = filled = 0;
      }
    }
  if (filled != 0) put(out, static_cast<std::uint8_t>(bits));
}

bool read_grades(ByteReader& in, mapping::TileState& s) {
  unsigned bits = 0, left_over = 0;
  for (unsigned z = 0; z < kEdge; ++z)
    for (std::uint64_t left = s.occupied[z]; left != 0; left &= left - 1) {
      if (left_over == 0) {
        const auto next = in.read<std::uint8_t>();
        if (!next) return false;
        bits = *next;
        left_over = 8;
      }
      const int at = std::countr_zero(left);
      s.low[z] |= std::uint64_t{bits & 1U} << at;
      s.high[z] |= std::uint64_t{bits >> 1 & 1U} << at;
      bits >>= 2;
      left_over -= 2;
    }
  return bits == 0;
}

mapping::TileState uniform_tile(std::uint8_t byte) {
  mapping::TileState s;
  s.known.fill(kAll);
  if ((byte & kUniformOccupied) != 0) s.occupied.fill(kAll);
  if ((byte & 1U) != 0) s.low.fill(kAll);
  if ((byte & 2U) != 0) s.high.fill(kAll);
  return s;
}

std::uint8_t uniform_byte(const mapping::TileState& s) {
  return static_cast<std::uint8_t>(kUniform | (s.occupied[0] & kUniformOccupied) | (s.high[0] & 2U) | (s.low[0] & 1U));
}

std::uint8_t what_follows(const mapping::TileState& s) {
  return static_cast<std::uint8_t>((is(s.known, kAll) ? 0U : kSomeUnknown) | (s.any_occupied() ? kSomeOccupied : 0U) |
                                   (is(weak(s), 0) ? 0U : kSomeWeak) | (s.labels.empty() ? 0U : kSomeLabels));
}

/// The planes and grades that `flags` announce.
bool read_mixed(ByteReader& in, std::uint8_t flags, mapping::TileState& s) {
  s.known.fill(kAll);
  if ((flags & kSomeUnknown) != 0) {
    const auto plane = read_plane(in);
    if (!plane) return false;
    s.known = from_row_changes(from_slice_changes(*plane));
  }
  if ((flags & kSomeOccupied) != 0) {
    const auto plane = read_plane(in);
    if (!plane) return false;
    s.occupied = from_row_changes(*plane);
  }
  if ((flags & kSomeWeak) != 0) {
    const auto plane = read_plane(in);
    if (!plane || !mapping::TileState{s.known, *plane, {}, {}, {}}.valid()) return false;
    for (unsigned z = 0; z < kEdge; ++z)
      if (((*plane)[z] & s.occupied[z]) != 0) return false;
    s.low = *plane;
  }
  if (!read_grades(in, s)) return false;
  if ((flags & kSomeLabels) != 0 && !read_labels(in, s)) return false;
  return s.valid() && !s.empty();
}

}  // namespace

void encode_tile(const mapping::TileState& state, std::vector<std::byte>& out) {
  if (uniform(state)) return put(out, uniform_byte(state));
  const std::uint8_t flags = what_follows(state);
  put(out, flags);
  if ((flags & kSomeUnknown) != 0) put_plane(out, slice_changes(row_changes(state.known)));
  if ((flags & kSomeOccupied) != 0) put_plane(out, row_changes(state.occupied));
  if ((flags & kSomeWeak) != 0) put_plane(out, weak(state));
  put_grades(out, state);
  if ((flags & kSomeLabels) != 0) put_labels(out, state);
}

bool is_uniform_tile(std::span<const std::byte> bytes) {
  if (bytes.size() != 1) return false;
  const auto byte = std::to_integer<unsigned>(bytes[0]);
  const bool occupied = (byte & kUniformOccupied) != 0, high = (byte & 2U) != 0;
  return (byte & ~unsigned{kUniformBits}) == 0 && (byte & kUniform) != 0 && (occupied || !high);
}

bool has_occupied(std::span<const std::byte> bytes) {
  const auto flags = bytes.empty() ? 0U : std::to_integer<unsigned>(bytes[0]);
  return (flags & ((flags & kUniform) != 0 ? kUniformOccupied : kSomeOccupied)) != 0;
}

Result<mapping::TileState> decode_tile(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  const auto flags = in.read<std::uint8_t>();
  if (!flags) return Error{Errc::kTruncated, "a tile of no bytes"};
  if ((*flags & kUniform) != 0) {
    if (!is_uniform_tile(bytes)) return Error{Errc::kMalformed, "no such uniform tile"};
    return uniform_tile(*flags);
  }
  mapping::TileState state;
  if ((*flags & ~kBits) != 0 || !read_mixed(in, *flags, state) || in.remaining() != 0 || uniform(state) ||
      what_follows(state) != *flags)
    return Error{Errc::kMalformed, "not an encoded tile", {}, in.offset()};
  return state;
}

}  // namespace cairn::peers
