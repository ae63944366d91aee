// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/monitor.hpp"
#include "hal/relaxed_counter.hpp"
#include "onboard/app/streams/pose_teller.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/perception/stereo/dense_stereo.hpp"
#include "onboard/scheduler/ports.hpp"

namespace cairn::app {

/// Located stereo pictures in, located scans out: the points that both eyes see. One in a tick.
class StereoTask final : public scheduler::Task {
 public:
  // Slots in schedule.log, in this order.
  scheduler::InputPort<ArrivedView> views{*this, "views"};
  scheduler::OutputPort<ArrivedMotion> motions{*this, "motions"};

  /// What became of the pictures. Any thread may read.
  struct Figures {
    RelaxedCounter clouds;  ///< that went on to the map
    RelaxedCounter points;  ///< in them
  };

  /// `monitor` must outlive the task.
  StereoTask(stereo::DenseStereo dense, const StereoSetup& setup, Monitor& monitor);

  /// Live: who is told every located scan.
  [[nodiscard]] PoseTeller& teller() { return teller_; }

  void tick(scheduler::Tick& tick) override;

  [[nodiscard]] const Figures& figures() const { return figures_; }

 private:
  void measure(ArrivedView& view, scheduler::Tick& tick);

  stereo::DenseStereo dense_;
  stereo::StereoGeometry geometry_;
  SE3 T_base_eye_;
  double max_range_m_;
  Monitor& monitor_;
  StageStats& stage_;
  PoseTeller teller_;
  std::vector<Eigen::Vector3f> points_eye_;  // reused
  Figures figures_;
};

}  // namespace cairn::app
