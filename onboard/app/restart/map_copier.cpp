// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/restart/map_copier.hpp"

namespace cairn::app {
namespace {

// Nodes copied at a time. One takes some 50 ns, so a slice takes a millisecond.
constexpr std::size_t kSlice = 20'000;

}  // namespace

void MapCopier::mapped(const LocatedScan& scan) {
  if (scan.lost) return;
  if (scan.epoch != newest_.epoch) {  // half a copy of another map is of no use
    copy_.reset();
    selection_ = {};
  }
  newest_ = {scan.stamp, scan.T_odom_base, Vector6::Zero(), scan.epoch};
  const SE3& T_odom_base = scan.T_odom_base.mean;
  if (!selection_.wants(T_odom_base)) return;
  ToSave::Scan* out = out_.scans.back();
  if (out == nullptr) return;  // a later one will do
  selection_.take(T_odom_base);
  out->epoch = scan.epoch;
  out->scan.stamp = scan.stamp;
  out->scan.T_odom_base = T_odom_base;
  thin_(scan.points_base, out->scan.points_base);
  out_.scans.push();
}

void MapCopier::idle(Time now, const mapping::SemanticOcTree& map) {
  if (!copy_) {
    if ((begun_ && now - *begun_ < every_) || out_.maps.back() == nullptr || newest_.stamp == Time{}) return;
    begun_ = now;
    copy_.emplace(map);
  }
  if (!copy_->step(map, kSlice)) return;
  *out_.maps.back() = {copy_->take(), newest_};
  out_.maps.push();
  copy_.reset();
}

}  // namespace cairn::app
