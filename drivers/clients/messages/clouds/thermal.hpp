// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/clients/messages/record.hpp"
#include "hal/se3.hpp"
#include "hal/thermal_point.hpp"
#include "hal/time.hpp"

namespace cairn::clients {

/// A part of a thermal cloud: what one picture of the thermal camera measured at the points of a scan that it sees. The
/// parts of one cloud follow each other; they differ in `first` only.
struct ThermalPart {
  static constexpr RecordKind kKind = RecordKind::kThermal;
  static constexpr std::uint32_t kMaxPoints = 1U << 20U;  ///< in a cloud

  Time stamp{};                        ///< when the picture was taken
  bool celsius = false;                ///< false: values are raw counts
  std::uint32_t epoch = 0;             ///< see PoseMessage
  SE3 T_odom_base{};                   ///< at `stamp`
  std::uint32_t total = 0;             ///< points of the whole cloud
  std::uint32_t first = 0;             ///< how many came before
  std::vector<ThermalPoint> points{};  ///< in base_link at `stamp`
};

/// Appends the body of a part of `points`, from `part.first` on, as many as fit. Returns how many these are. The body
/// is: stamp (8), flags (1; bit 0 °C), zeros (3), epoch (4), pose (7 × 8), total (4), first (4), number here (4),
/// x y z value of each (4 × 4). `part.total` and `part.points` do not matter.
std::uint32_t encode(const ThermalPart& part, std::span<const ThermalPoint> points, std::vector<std::byte>& out);
/// Error kMalformed.
[[nodiscard]] Result<ThermalPart> decode_thermal(std::span<const std::byte> body);

}  // namespace cairn::clients
