// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/inspect/figures/scan_figures.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace cairn::cli {

void ScanFigures::add(const Scan& scan) {
  const std::uint64_t n = scan.cloud.size();
  least_points_ = scans_ == 0 ? n : std::min(least_points_, n);
  most_points_ = std::max(most_points_, n);
  if (scans_ == 0)
    first_ = scan.valid.start;
  else
    periods_.record(std::max(scan.valid.end - last_, Duration::zero()));
  last_ = scan.valid.end;
  ++scans_;
  points_ += n;
  incomplete_ += scan.incomplete ? 1 : 0;
  deskewed_ += scan.deskewed ? 1 : 0;
  pps_locked_ += scan.time_quality == TimeQuality::kPpsLocked ? 1 : 0;
  lost_packets_ += scan.lost_packets;
  for (const Eigen::Vector3f& p : scan.cloud.xyz) {
    const float range = p.norm();
    nearest_m_ = farthest_m_ == 0 ? range : std::min(nearest_m_, range);
    farthest_m_ = std::max(farthest_m_, range);
  }
  for (const std::uint8_t ring : scan.cloud.ring) rings_ = std::max(rings_, ring + 1U);
}

report::Json ScanFigures::to_json() const {
  report::Json json{{"count", scans_}, {"incomplete", incomplete_}, {"lost_packets", lost_packets_}};
  json["deskewed"] = deskewed_;
  json["pps_locked"] = pps_locked_;
  if (scans_ == 0) return json;
  json["first_s"] = to_seconds(first_);
  json["last_s"] = to_seconds(last_);
  json["period_ms"] = {{"median", to_milliseconds(periods_.percentile(0.5))}, {"max", to_milliseconds(periods_.max())}};
  json["points"] = {{"total", points_},
                    {"least", least_points_},
                    {"mean", static_cast<double>(points_) / static_cast<double>(scans_)},
                    {"most", most_points_}};
  json["rings"] = rings_;
  json["range_m"] = {{"nearest", nearest_m_}, {"farthest", farthest_m_}};
  return json;
}

}  // namespace cairn::cli
