// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "drivers/velodyne/data_packet.hpp"
#include "drivers/velodyne/models.hpp"
#include "drivers/velodyne/packet.hpp"
#include "hal/packet.hpp"

/// The decoder's inverse, for tests: what a sensor would send.
namespace cairn::velodyne::test {

using Bytes = std::vector<std::byte>;

template <class T>
void store_le(Bytes& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

/// A data packet before it is bytes.
struct DataFields {
  std::array<std::uint16_t, kBlocks> azimuth{};
  std::array<std::array<DataPacket::Return, kBlockChannels>, kBlocks> returns{};
  std::uint32_t timestamp_us = 0;
  std::uint8_t mode = static_cast<std::uint8_t>(ReturnMode::kStrongest);
  std::uint8_t product = 0x22;
};

inline Bytes encode(const DataFields& f) {
  Bytes out(kDataBytes);
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const std::size_t block = b * kBlockBytes;
    store_le(out, block + kBlockFlagOffset, kBlockFlag);
    store_le(out, block + kBlockAzimuthOffset, f.azimuth[b]);
    for (std::size_t slot = 0; slot < kBlockChannels; ++slot) {
      const std::size_t at = block + kBlockReturnsOffset + slot * kReturnBytes;
      store_le(out, at, f.returns[b][slot].distance);
      store_le(out, at + 2, f.returns[b][slot].reflectivity);
    }
  }
  store_le(out, kTimestampOffset, f.timestamp_us);
  store_le(out, kReturnModeOffset, f.mode);
  store_le(out, kProductOffset, f.product);
  return out;
}

/// "$body*hh"
inline std::string nmea(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  char end[4];
  std::snprintf(end, sizeof end, "*%02X", sum & 0xFFU);
  return "$" + body + end;
}

inline Bytes encode_position(std::uint32_t timestamp_us, std::uint8_t pps, const std::string& sentence) {
  Bytes out(kPositionBytes);
  store_le(out, kPositionTimestampOffset, timestamp_us);
  store_le(out, kPpsStateOffset, pps);
  std::memcpy(out.data() + kNmeaOffset, sentence.data(), std::min(sentence.size(), kNmeaBytes));
  return out;
}

/// A sensor that turns evenly. Time and azimuth advance from packet to packet as on the real thing.
struct Sensor {
  const Model* model = find_model("VLP-16");
  ReturnMode mode = ReturnMode::kStrongest;
  double rate_deg_s = 3600;
  double azimuth_deg = 0;                  ///< of the next packet's first firing
  std::int64_t device_ns = 0;              ///< of the next packet's first firing; any origin
  Time start{std::chrono::seconds(1000)};  ///< robot time at device_ns = 0
  std::uint16_t data_port = kDefaultDataPort;
  /// Raw distance and reflectivity at (azimuth in degrees, channel).
  std::function<DataPacket::Return(double, int)> scene = [](double, int) { return DataPacket::Return{2500, 50}; };
  std::uint64_t sequence = 0;

  [[nodiscard]] bool dual() const { return mode == ReturnMode::kDual; }
  [[nodiscard]] Duration span() const { return model->packet_span(dual()); }
  [[nodiscard]] double azimuth_at(Duration since_packet) const {
    const double a = azimuth_deg + rate_deg_s * to_seconds(since_packet);
    return a - 360.0 * std::floor(a / 360.0);
  }

  [[nodiscard]] DataFields fields() const {
    DataFields f;
    f.mode = static_cast<std::uint8_t>(mode);
    f.product = model->product;
    f.timestamp_us = static_cast<std::uint32_t>(device_ns / 1000 % kMicrosecondsPerHour);
    for (int b = 0; b < kBlocks; ++b) {
      const auto block = static_cast<std::size_t>(b);
      const double azimuth = azimuth_at(model->firing_offset(b, 0, dual()));
      f.azimuth[block] = static_cast<std::uint16_t>(std::lround(azimuth * 100) % kAzimuthUnits);
      for (int slot = 0; slot < kBlockChannels; ++slot)
        f.returns[block][static_cast<std::size_t>(slot)] =
            scene(azimuth_at(model->firing_offset(b, slot, dual())), slot % model->channel_count);
    }
    return f;
  }
  /// Fills `packet` (arrival: when its last firing was over) and moves on to the next.
  void next(Packet& packet) {
    const Bytes bytes = encode(fields());
    packet.bytes.assign(bytes.begin(), bytes.end());
    packet.channel = data_port;
    packet.arrival = start + Duration{device_ns} + span();
    packet.sequence = sequence++;
    packet.truncated = false;
    skip();
  }
  Packet next() {
    Packet packet;
    next(packet);
    return packet;
  }
  /// The next packet is never sent.
  void skip() {
    azimuth_deg = azimuth_at(span());
    device_ns += span().count();
  }
};

}  // namespace cairn::velodyne::test
