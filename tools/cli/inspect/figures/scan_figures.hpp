// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/histogram.hpp"
#include "hal/point_cloud.hpp"
#include "onboard/report/json/report_json.hpp"

namespace cairn::cli {

/// Counts, sizes and times of one source's scans.
class ScanFigures {
 public:
  void add(const Scan& scan);
  [[nodiscard]] report::Json to_json() const;
  [[nodiscard]] std::uint64_t scans() const { return scans_; }

 private:
  std::uint64_t scans_ = 0, incomplete_ = 0, deskewed_ = 0, pps_locked_ = 0, lost_packets_ = 0;
  std::uint64_t points_ = 0, least_points_ = 0, most_points_ = 0;
  float nearest_m_ = 0, farthest_m_ = 0;
  unsigned rings_ = 0;
  Histogram periods_;  // from one scan's end to the next one's
  Time first_{}, last_{};
};

}  // namespace cairn::cli
