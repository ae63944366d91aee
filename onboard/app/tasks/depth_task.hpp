// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "drivers/depth/depth_camera.hpp"
#include "hal/monitor.hpp"
#include "hal/relaxed_counter.hpp"
#include "onboard/app/perception/picture_pace.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/perception/stereo/depth_planes.hpp"
#include "onboard/safety/stuck.hpp"
#include "onboard/scheduler/ports.hpp"

namespace cairn::app {

/// Depth pictures in, clouds out: the newest picture of a tick, at its rate. Their points join the map beside the
/// LiDAR's.
class DepthTask final : public scheduler::Task {
 public:
  // Slots in schedule.log, in this order.
  scheduler::InputPort<ArrivedPicture> pictures{*this, "pictures"};
  scheduler::OutputPort<ArrivedCloud> clouds{*this, "clouds"};

  /// What became of the pictures. Any thread may read.
  struct Figures {
    RelaxedCounter images;   ///< that became clouds
    RelaxedCounter passed;   ///< newer ones were there, or it was not time yet
    RelaxedCounter refused;  ///< no depth pictures
  };

  /// `period`: at least so long from one cloud to the next. `planes`: what takes noise out of the points; none: they
  /// stay as they were measured. `monitor` must outlive the task.
  DepthTask(depth::DepthCamera camera, std::optional<stereo::DepthPlanes> planes, const SE3& T_base_camera,
            Duration period, Monitor& monitor);

  void tick(scheduler::Tick& tick) override;

  [[nodiscard]] const Figures& figures() const { return figures_; }

 private:
  void look(const Packet& packet, scheduler::Tick& tick);

  depth::DepthCamera camera_;
  std::optional<stereo::DepthPlanes> planes_;
  SE3 T_base_camera_;
  PicturePace pace_;
  Monitor& monitor_;
  StageStats& stage_;
  safety::StuckWatch stuck_;
  Figures figures_;
};

}  // namespace cairn::app
