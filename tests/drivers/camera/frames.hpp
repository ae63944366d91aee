// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <random>
#include <span>
#include <vector>

#include "drivers/camera/frame.hpp"
#include "hal/packet.hpp"

namespace cairn::camera::test {

using Bytes = std::vector<std::byte>;

inline Bytes random_bytes(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  Bytes bytes(n);
  for (auto& b : bytes) b = static_cast<std::byte>(random());
  return bytes;
}

inline FrameHeader header_of(FrameFormat format, std::uint32_t width, std::uint32_t height, std::uint32_t stride) {
  return {static_cast<std::uint32_t>(format), width, height, stride, false};
}

/// A packet as a device or a replay makes it.
inline Packet packet_of(const FrameHeader& header, std::span<const std::byte> payload, std::uint64_t sequence = 0) {
  Packet packet;
  packet.sequence = sequence;
  append_header(packet.bytes, header);
  packet.bytes.insert(packet.bytes.end(), payload.begin(), payload.end());
  return packet;
}

}  // namespace cairn::camera::test
