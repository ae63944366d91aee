// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "drivers/velodyne/packet.hpp"
#include "hal/time.hpp"

namespace cairn::velodyne {

/// One laser, in the order of the channels in a packet.
struct Channel {
  double elevation_deg = 0;            ///< above the sensor's horizontal plane
  double vertical_offset_m = 0;        ///< added to z
  double rotation_correction_deg = 0;  ///< subtracted from the block's azimuth (clockwise)
  std::uint8_t ring = 0;               ///< row, 0 = lowest
};

/// A sensor model is a table. Times are whole nanoseconds, so they add without rounding.
struct Model {
  std::string_view name;
  std::string_view alias;         ///< another accepted name, or empty
  std::uint8_t product = 0;       ///< byte kProductOffset of its data packets
  double distance_unit_m = 0;     ///< of a raw distance
  int channel_count = 0;          ///< 16 or 32
  Duration sequence{};            ///< from one firing sequence to the next: all channels once, and the recharge
  Duration slot{};                ///< from one laser slot to the next within a sequence
  int lasers_per_slot = 1;        ///< lasers that fire together
  bool return_mode_valid = true;  ///< false: old firmware leaves that byte undefined (HDL-32E before 2.2.20.0)
  std::array<Channel, kBlockChannels> channels{};  ///< the first channel_count are used

  /// Firing sequences in one block of a packet.
  [[nodiscard]] constexpr int sequences_per_block() const { return kBlockChannels / channel_count; }
  /// Time from the packet's first firing to the firing of `slot_in_block` (0 … 31) in `block` (0 … 11). In dual mode
  /// two blocks share one firing.
  [[nodiscard]] constexpr Duration firing_offset(int block, int slot_in_block, bool dual) const {
    const int sequences = (dual ? block / 2 : block) * sequences_per_block() + slot_in_block / channel_count;
    return sequences * sequence + (slot_in_block % channel_count) / lasers_per_slot * slot;
  }
  /// Time from the first firing of one packet to the first firing of the next.
  [[nodiscard]] constexpr Duration packet_span(bool dual) const {
    return (dual ? kBlocks / 2 : kBlocks) * sequences_per_block() * sequence;
  }
};

/// The table of all models: VLP-16, VLP-16-HiRes, HDL-32E, VLP-32C. Sources: the manuals named in packet.hpp.
[[nodiscard]] std::span<const Model> models();
/// By name or alias ("Puck Hi-Res"), exactly as written; null when unknown.
[[nodiscard]] const Model* find_model(std::string_view name);
/// By the product byte of a data packet; null when unknown.
[[nodiscard]] const Model* find_model(std::uint8_t product);
/// "VLP-16, VLP-16-HiRes, …", for messages.
[[nodiscard]] std::string model_names();

}  // namespace cairn::velodyne
