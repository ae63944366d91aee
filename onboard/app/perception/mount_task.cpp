// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/perception/mount_task.hpp"

#include <fmt/format.h>

#include <numbers>
#include <utility>

namespace cairn::app {

using scheduler::Regime;
using scheduler::Tick;

MountTask::MountTask(std::vector<MountParts> eyes, Duration budget, std::function<safety::Shed()> shed,
                     Monitor& monitor)
    : poses_({.age = std::chrono::seconds(2)}),
      shed_(std::move(shed)),
      monitor_(monitor),
      stage_(monitor.stage("mount", budget)) {
  for (MountParts& parts : eyes) watched_.emplace_back(std::move(parts));
}

void MountTask::tick(Tick& tick) {
  while (const ArrivedPose* pose = poses.take(tick))
    (void)poses_.add(pose->stamp, pose->T_odom_base, pose->twist, pose->epoch, {});
  if (tick.regime() == Regime::kDrain) return;
  const auto overloaded = [this] { return shed_() >= safety::Shed::kSemantics ? 1 : 0; };
  const bool sheds = tick.decide(shed_slot, overloaded, 0) != 0;
  for (Watched& eye : watched_) {
    take_newest(eye, tick, sheds);
    look_at_located(eye);
  }
}

void MountTask::take_newest(Watched& eye, Tick& tick, bool overloaded) {
  auto& port = eye.parts.eye == people::Eye::kThermal ? thermals : pictures;
  const Packet* newest = eye.pace.take_newest(port, tick, eye.figures.passed);
  if (newest == nullptr) return;
  if (overloaded) {
    ++eye.figures.shed;
    return;
  }
  if (eye.waiting.size() == kWaiting) {
    eye.waiting.pop();
    ++eye.figures.refused;
  }
  Packet packet = *newest;
  eye.waiting.add(packet);
}

/// A picture was exposed before it arrived, so a scan after its arrival is one after its exposure.
void MountTask::look_at_located(Watched& eye) {
  if (eye.waiting.empty() || poses_.size() == 0) return;
  if (poses_[poses_.size() - 1].stamp < eye.waiting.front().arrival) return;
  look(eye, eye.waiting.front());
  eye.waiting.pop();
}

void MountTask::look(Watched& eye, const Packet& packet) {
  const StageTimer timing(stage_);
  const auto picture = eye.parts.reader->read(packet);
  const bool seen = picture && *picture != nullptr;
  const auto T_odom_base = seen ? poses_.pose_at((*picture)->stamp) : std::nullopt;
  if (!T_odom_base || !eye.parts.watch.look(**picture, *T_odom_base, poses_.nearest((*picture)->stamp)->epoch)) {
    ++eye.figures.refused;
    return;
  }
  ++eye.figures.images;
  if (eye.parts.watch.moved() && !std::exchange(eye.said, true)) say_moved(eye, (*picture)->stamp);
}

void MountTask::say_moved(Watched& eye, Time stamp) {
  constexpr double kToDegrees = 180 / std::numbers::pi;
  const Eigen::Vector3d turn = kToDegrees * eye.parts.watch.estimate()->turn_rad;
  const bool thermal = eye.parts.eye == people::Eye::kThermal;
  monitor_.event(stamp, "mount",
                 fmt::format("camera_moved: the {} camera is turned by roll {:.1f}, pitch {:.1f}, yaw {:.1f} degrees "
                             "from its mount: check {}, its intrinsics, and T_base_lidar",
                             thermal ? "thermal" : "colour", turn.x(), turn.y(), turn.z(),
                             thermal ? "T_base_thermal" : "T_base_camera"));
}

}  // namespace cairn::app
