// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/scan_deskewer.hpp"

#include <algorithm>

#include "onboard/odometry/estimation/deskew.hpp"

namespace cairn::odometry {
namespace {

// Points per job of the workers: a scan of a VLP-16 (28 928 points) makes eight jobs.
constexpr std::size_t kPointsPerJob = 4096;

}  // namespace

void ScanDeskewer::deskew(const PreparedScan& scan, const Vector6& twist) {
  const std::size_t n = scan.points_lidar.size();
  const Deskew moved(twist, T_base_lidar_, scan.duration_s);
  points_base_.resize(n);
  workers_.for_each((n + kPointsPerJob - 1) / kPointsPerJob, [&](std::size_t job) {
    const std::size_t end = std::min(n, (job + 1) * kPointsPerJob);
    for (std::size_t i = job * kPointsPerJob; i < end; ++i)
      points_base_[i] = moved(scan.points_lidar[i], scan.age_s[i]);
  });
}

}  // namespace cairn::odometry
