// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "drivers/clients/messages/record.hpp"
#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn::clients {

/// A part of a scan that has been located. The parts of one scan follow each other; they differ in `first` only.
struct ScanPart {
  static constexpr RecordKind kKind = RecordKind::kScan;
  static constexpr std::uint32_t kMaxPoints = 1U << 20U;  ///< in a scan

  Time stamp{};                                ///< of the scan's end
  bool lost = false;                           ///< the pose is only a prediction
  std::uint32_t epoch = 0;                     ///< see PoseMessage
  SE3 T_odom_base{};                           ///< at `stamp`
  std::uint32_t total = 0;                     ///< points of the whole scan
  std::uint32_t first = 0;                     ///< how many came before
  std::vector<Eigen::Vector3f> points_base{};  ///< deskewed, in base_link at `stamp`, in metres
};

/// Appends the body of a part of `points`, from `part.first` on, as many as fit. Returns how many these are. The body
/// is: stamp (8), flags (1; bit 0 lost), zeros (3), epoch (4), pose (7 × 8), total (4), first (4), number here (4),
/// x y z of each (3 × 4). `part.total` and `part.points_base` do not matter.
std::uint32_t encode(const ScanPart& part, std::span<const Eigen::Vector3f> points, std::vector<std::byte>& out);
/// Error kMalformed.
[[nodiscard]] Result<ScanPart> decode_scan(std::span<const std::byte> body);

}  // namespace cairn::clients
