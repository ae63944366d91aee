// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "drivers/camera/camera.hpp"
#include "hal/monitor.hpp"
#include "hal/relaxed_counter.hpp"
#include "onboard/app/profile/robot_profile.hpp"
#include "onboard/app/restart/map_copier.hpp"
#include "onboard/app/streams/pose_teller.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/perception/stereo/rectifier.hpp"
#include "onboard/safety/stuck.hpp"
#include "onboard/scheduler/ports.hpp"

namespace cairn::app {

/// Stereo picture in, pose out, one in a tick. At a bounded rate, pictures go on to who measures their points.
class VisualOdometryTask final : public scheduler::Task {
 public:
  // Slots in schedule.log, in this order.
  scheduler::InputPort<ArrivedPicture> pictures{*this, "pictures"};
  const std::size_t steps_slot = take_slots();  ///< iterations granted
  scheduler::OutputPort<ArrivedView> views{*this, "views"};
  scheduler::OutputPort<OdometryNews> status{*this, "status"};

  /// What became of the pictures. Any thread may read.
  struct Figures {
    RelaxedCounter frames;   ///< that were looked at
    RelaxedCounter tracked;  ///< of these, those that told the motion
    RelaxedCounter refused;  ///< not looked at: damaged, of another size, or the same again and again
  };

  using Progress = std::function<void(Time, std::size_t pictures)>;

  /// All must outlive the task. `progress` is called after every picture, on the task's thread; may be empty.
  VisualOdometryTask(const RobotProfile& profile, camera::Camera camera, stereo::Rectifier rectifier, Robot& robot,
                     Monitor& monitor, Progress progress);

  /// Live: who is told every pose. Scans are told by the task that measures points.
  [[nodiscard]] PoseTeller& teller() { return teller_; }
  /// Live: keyframes are handed there for a restart. Not waited for.
  void keep_keyframes(SpscQueue<ToSave::Keyframe>& out) { to_save_ = &out; }

  void tick(scheduler::Tick& tick) override;

  [[nodiscard]] const Figures& figures() const { return figures_; }

 private:
  void look(const Packet& packet, scheduler::Tick& tick);
  [[nodiscard]] Result<void> read(const Packet& packet);
  void hand_on(const LocatedScan& located, Time arrival, scheduler::Tick& tick);
  void keep_keyframe(const TrackPoint& located);
  void publish_status(scheduler::Tick& tick);

  Duration deadline_, map_period_;
  int max_steps_;
  camera::Camera camera_;
  stereo::Rectifier rectifier_;
  safety::StuckWatch stuck_;
  Robot& robot_;
  Monitor& monitor_;
  StageStats& latency_;
  Progress progress_;
  PoseTeller teller_;
  SpscQueue<ToSave::Keyframe>* to_save_ = nullptr;
  stereo::StereoPair pair_;
  LocatedScan located_;
  Time next_view_{};  // the first picture from then on goes on
  Figures figures_;
  bool lost_ = false, published_lost_ = false;
};

}  // namespace cairn::app
