// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/stereo_task.hpp"

#include <utility>

#include "onboard/perception/stereo/row_motion.hpp"

namespace cairn::app {

using scheduler::Tick;

StereoTask::StereoTask(stereo::DenseStereo dense, const StereoSetup& setup, Monitor& monitor)
    : dense_(std::move(dense)),
      geometry_(setup.geometry),
      T_base_eye_(setup.T_base_camera * cameras::T_camera_optical()),
      max_range_m_(setup.trust.max_range_m),
      monitor_(monitor),
      stage_(monitor.stage("stereo")) {}

void StereoTask::tick(Tick& tick) {
  while (ArrivedView* view = views.take(tick)) {
    measure(*view, tick);
    if (tick.regime() != scheduler::Regime::kDrain) break;
  }
  views.give_back(tick);
}

void StereoTask::measure(ArrivedView& view, Tick& tick) {
  ArrivedMotion* out = motions.back(tick);
  if (out == nullptr)
    return monitor_.event(view.scan.stamp, "stereo", "a picture did not get into the map: mapping is behind");
  const StageTimer timing(stage_);
  dense_.measure(view.pair, max_range_m_, points_eye_);
  std::swap(out->scan, view.scan);
  out->arrival = view.arrival;
  const Eigen::Matrix3f R = T_base_eye_.rotation().cast<float>();
  const Eigen::Vector3f t = T_base_eye_.translation().cast<float>();
  out->scan.points_base.clear();
  for (const Eigen::Vector3f& p : points_eye_) out->scan.points_base.emplace_back(R * p + t);
  stereo::hold_still(geometry_, out->scan.twist, points_eye_, out->scan.points_base);
  teller_.tell(out->scan);
  motions.push(tick);
  ++figures_.clouds;
  figures_.points += points_eye_.size();
}

}  // namespace cairn::app
