// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/velodyne/packet.hpp"

namespace cairn::velodyne::test {

/// Azimuths that begin anywhere, go on by steps of up to 0.88°, and may jump once: all that a packet may have.
template <class Random>
std::array<std::uint16_t, kBlocks> random_azimuths(bool dual, Random& random) {
  std::array<std::uint16_t, kBlocks> azimuth{};
  auto at = static_cast<unsigned>(random() % kAzimuthUnits);
  const auto jump = static_cast<std::size_t>(random() % (2 * kBlocks));
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const bool second = dual && b % 2 == 1;
    const bool jumps = b == (dual ? jump / 2 * 2 : jump);
    if (!second) at += static_cast<unsigned>(random()) % (jumps ? kAzimuthUnits : 88U);
    azimuth[b] = static_cast<std::uint16_t>(at % kAzimuthUnits);
  }
  return azimuth;
}

}  // namespace cairn::velodyne::test
