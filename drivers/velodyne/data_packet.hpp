// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/velodyne/models.hpp"
#include "drivers/velodyne/packet.hpp"
#include "hal/bytes.hpp"
#include "hal/result.hpp"

namespace cairn::velodyne {

/// A data packet whose bytes are all checked. Later code may index it without further checks.
struct DataPacket {
  std::span<const std::byte> bytes;  ///< kDataBytes, the caller's memory
  std::uint32_t timestamp_us = 0;    ///< device time of the first firing, µs past the hour
  ReturnMode mode = ReturnMode::kStrongest;
  std::array<std::uint16_t, kBlocks> azimuth{};  ///< of each block, 0.01°, 0 … 35999

  [[nodiscard]] bool dual() const { return mode == ReturnMode::kDual; }

  /// One return of one laser.
  struct Return {
    std::uint16_t distance;     ///< in Model::distance_unit_m; 0: no return
    std::uint8_t reflectivity;  ///< 0…100 diffuse, 101…255 retro-reflector
  };
  /// 0 <= block < kBlocks, 0 <= slot < kBlockChannels.
  [[nodiscard]] Return at(int block, int slot) const {
    const std::size_t i = static_cast<std::size_t>(block) * kBlockBytes + kBlockReturnsOffset +
                          static_cast<std::size_t>(slot) * kReturnBytes;
    return {load_le<std::uint16_t>(bytes, i), load_le<std::uint8_t>(bytes, i + 2)};
  }
};

/// Why a data packet was refused.
enum class DataFault : std::uint8_t { kLength, kFlag, kAzimuth, kPair, kOrder, kReturnMode, kProduct };

/// Checks length, product byte, return mode, block flags, azimuths and their order. A packet is taken whole or not at
/// all. The result refers to `bytes`.
[[nodiscard]] tl::expected<DataPacket, DataFault> parse_data_packet(std::span<const std::byte> bytes,
                                                                    const Model& model);
/// The same as an Error with the place in the packet. Allocates nothing.
[[nodiscard]] Error to_error(DataFault fault);

/// Degrees per second, from the first and last azimuth of the packet. Null above 22 turns per second, which is faster
/// than any motor: the azimuth jumped over a blanked sector, or went back.
[[nodiscard]] std::optional<double> rotation_rate_deg_s(const DataPacket& packet, const Model& model);

}  // namespace cairn::velodyne
