// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/data_packet.hpp"

namespace cairn::velodyne {
namespace {

std::optional<ReturnMode> return_mode(std::uint8_t byte, const Model& model) {
  const auto mode = static_cast<ReturnMode>(byte);
  if (mode == ReturnMode::kStrongest || mode == ReturnMode::kLast || mode == ReturnMode::kDual) return mode;
  if (!model.return_mode_valid) return ReturnMode::kStrongest;
  return std::nullopt;
}

/// Whether the mirror turns on from block to block, by less than the fastest motor allows. It may jump once, over a
/// sector that the sensor was told to leave out. Noise does not.
bool in_order(const DataPacket& packet) {
  constexpr int kMostStep = 150, kMostBack = 50;  // 0.01°: 22 turns a second make 88; encoders jitter by some
  int jumps = 0;
  for (std::size_t b = 1; b < kBlocks; ++b) {
    const int step = (packet.azimuth[b] - packet.azimuth[b - 1] + kAzimuthUnits) % kAzimuthUnits;
    if (step > kMostStep && step < kAzimuthUnits - kMostBack) ++jumps;
  }
  return jumps <= 1;
}

}  // namespace

tl::expected<DataPacket, DataFault> parse_data_packet(std::span<const std::byte> bytes, const Model& model) {
  if (bytes.size() != kDataBytes) return tl::unexpected(DataFault::kLength);
  if (load_le<std::uint8_t>(bytes, kProductOffset) != model.product) return tl::unexpected(DataFault::kProduct);
  const auto mode = return_mode(load_le<std::uint8_t>(bytes, kReturnModeOffset), model);
  if (!mode) return tl::unexpected(DataFault::kReturnMode);

  DataPacket packet{bytes, load_le<std::uint32_t>(bytes, kTimestampOffset), *mode, {}};
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const std::size_t block = b * kBlockBytes;
    if (load_le<std::uint16_t>(bytes, block + kBlockFlagOffset) != kBlockFlag) return tl::unexpected(DataFault::kFlag);
    packet.azimuth[b] = load_le<std::uint16_t>(bytes, block + kBlockAzimuthOffset);
    if (packet.azimuth[b] >= kAzimuthUnits) return tl::unexpected(DataFault::kAzimuth);
    const bool second_of_pair = packet.dual() && b % 2 == 1;
    if (second_of_pair && packet.azimuth[b] != packet.azimuth[b - 1]) return tl::unexpected(DataFault::kPair);
  }
  if (!in_order(packet)) return tl::unexpected(DataFault::kOrder);
  return packet;
}

Error to_error(DataFault fault) {
  switch (fault) {
    case DataFault::kLength:
      return {Errc::kMalformed, "data packet is not 1206 bytes long"};
    case DataFault::kFlag:
      return {Errc::kMalformed, "block flag of a data packet is not FF EE"};
    case DataFault::kAzimuth:
      return {Errc::kMalformed, "azimuth of a data packet is 360 degrees or more"};
    case DataFault::kPair:
      return {Errc::kMalformed, "two blocks of one dual-return firing have different azimuths"};
    case DataFault::kOrder:
      return {Errc::kMalformed, "azimuths of a data packet are in no order that a turning sensor gives"};
    case DataFault::kReturnMode:
      return {Errc::kMalformed, "return mode is not strongest, last or dual", {}, kReturnModeOffset, {}};
    case DataFault::kProduct:
      break;
  }
  return {Errc::kInvalidConfig, "data packet is of another sensor model than configured", {}, kProductOffset, {}};
}

std::optional<double> rotation_rate_deg_s(const DataPacket& packet, const Model& model) {
  constexpr double kFastest = 22 * 360.0;
  const int turned = (packet.azimuth[kBlocks - 1] - packet.azimuth[0] + kAzimuthUnits) % kAzimuthUnits;
  const double seconds = to_seconds(model.firing_offset(kBlocks - 1, 0, packet.dual()));
  const double rate = turned * kAzimuthUnitDeg / seconds;
  if (rate > kFastest) return std::nullopt;
  return rate;
}

}  // namespace cairn::velodyne
