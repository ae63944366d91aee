// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/depth_task.hpp"

#include <utility>

namespace cairn::app {

using scheduler::Tick;

DepthTask::DepthTask(depth::DepthCamera camera, std::optional<stereo::DepthPlanes> planes, const SE3& T_base_camera,
                     Duration period, Monitor& monitor)
    : camera_(std::move(camera)),
      planes_(std::move(planes)),
      T_base_camera_(T_base_camera),
      pace_(period),
      monitor_(monitor),
      stage_(monitor.stage("depth")) {}

void DepthTask::tick(Tick& tick) {
  const Packet* newest = pace_.take_newest(pictures, tick, figures_.passed);
  if (newest != nullptr && tick.regime() != scheduler::Regime::kDrain) look(*newest, tick);
}

void DepthTask::look(const Packet& packet, Tick& tick) {
  const StageTimer timing(stage_);
  stuck_.step(0, packet.payload());
  if (stuck_.repeats()) {
    ++figures_.refused;
    return monitor_.event(packet.arrival, "depth", "the camera is stuck: the same picture again and again");
  }
  const auto scan = camera_.decode(packet);
  if (!scan) {
    ++figures_.refused;
    return monitor_.event(packet.arrival, "depth", to_string(scan.error()));
  }
  ArrivedCloud* out = clouds.back(tick);
  if (out == nullptr) return monitor_.event(packet.arrival, "depth", "a cloud was dropped: mapping is behind");
  const Eigen::Matrix3f R = T_base_camera_.rotation().cast<float>();
  const Eigen::Vector3f t = T_base_camera_.translation().cast<float>();
  out->cloud.stamp = (*scan)->valid.end;
  out->cloud.origin_base = t;
  std::vector<Eigen::Vector3f>& points = out->cloud.points_base;
  points.assign((*scan)->cloud.xyz.begin(), (*scan)->cloud.xyz.end());
  if (planes_) planes_->smooth(points);
  for (Eigen::Vector3f& p : points) p = R * p + t;
  clouds.push(tick);
  ++figures_.images;
}

}  // namespace cairn::app
