// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "drivers/thermal/telemetry.hpp"
#include "tests/drivers/camera/frames.hpp"

namespace cairn::thermal::test {

/// Rows A to C as a Lepton writes them.
class Telemetry {
 public:
  Telemetry& put16(std::size_t word, std::uint16_t value) {
    std::memcpy(&bytes_[2 * word], &value, 2);
    return *this;
  }
  Telemetry& put32(std::size_t word, std::uint32_t value) {
    std::memcpy(&bytes_[2 * word], &value, 4);
    return *this;
  }
  Telemetry& tlinear(bool on, bool centikelvin) { return put16(208, on ? 1 : 0).put16(209, centikelvin ? 1 : 0); }
  Telemetry& counter(std::uint32_t frame) { return put32(20, frame); }
  [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_ = std::vector<std::byte>(kTelemetryBytes);
};

/// A Lepton 3's frame: all pixels hold `count`, and the telemetry follows in two lines of 160 words.
inline Packet lepton3(const Telemetry& telemetry, std::uint16_t count, std::uint64_t sequence, Time arrival = Time{}) {
  std::vector<std::byte> payload(std::size_t{160} * 122 * 2);
  for (std::size_t i = 0; i < std::size_t{160} * 120; ++i) std::memcpy(&payload[2 * i], &count, 2);
  std::copy(telemetry.bytes().begin(), telemetry.bytes().end(), payload.begin() + 160 * 120 * 2);
  Packet packet =
      camera::test::packet_of(camera::test::header_of(camera::FrameFormat::kY16, 160, 122, 320), payload, sequence);
  packet.arrival = arrival;
  return packet;
}

}  // namespace cairn::thermal::test
