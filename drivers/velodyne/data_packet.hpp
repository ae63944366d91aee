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

/// A data packet that has been checked whole: what follows may index it freely.
struct DataPacket {
  std::span<const std::byte> bytes;  ///< kDataBytes, the caller's memory
  std::uint32_t timestamp_us = 0;    ///< device time of the first firing, µs past the hour
  ReturnMode mode = ReturnMode::kStrongest;
  std::array<std::uint16_t, kBlocks> azimuth{};  ///< of each block, 0.01°, 0 … 35999

  [[nodiscard]] bool dual() const { return mode == ReturnMode::kDual; }

  struct Return {
    std::uint16_t distance;     ///< in Model::distance_unit_m; 0: nothing came back
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
enum class DataFault : std::uint8_t { kLength, kFlag, kAzimuth, kPair, kReturnMode, kProduct };

/// Checks length, product byte, return mode, block flags and azimuths; a packet is taken whole or not at all.
[[nodiscard]] tl::expected<DataPacket, DataFault> parse_data_packet(std::span<const std::byte> bytes,
                                                                    const Model& model);
/// Names the fault and where in the packet it is. Allocates nothing.
[[nodiscard]] Error to_error(DataFault fault);

/// Degrees per second from the packet's first and last azimuth; none above 22 turns per second, faster than any motor
/// (a jump over a blanked sector, or a step back).
[[nodiscard]] std::optional<double> rotation_rate_deg_s(const DataPacket& packet, const Model& model);

}  // namespace cairn::velodyne
