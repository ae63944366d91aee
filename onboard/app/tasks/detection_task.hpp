// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "hal/monitor.hpp"
#include "hal/relaxed_counter.hpp"
#include "onboard/app/perception/detection_parts.hpp"
#include "onboard/app/perception/picture_pace.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/safety/overload.hpp"
#include "onboard/scheduler/ports.hpp"

namespace cairn::app {

/// Pictures in, boxes out: one in a tick, always of the newest picture. The colour camera has such a task, and the
/// thermal one; each has a thread of its own, below mapping.
class DetectionTask final : public scheduler::Task {
 public:
  // Slots in schedule.log, in this order.
  scheduler::InputPort<ArrivedPicture> pictures{*this, "pictures"};
  const std::size_t shed_slot = take_slots();  ///< 1: overload, the picture is left out
  scheduler::OutputPort<ArrivedBoxes> boxes{*this, "boxes"};

  /// What became of the pictures. Any thread may read.
  struct Figures {
    RelaxedCounter images;      ///< looked at
    RelaxedCounter people;      ///< boxes of people in them
    RelaxedCounter passed;      ///< newer ones were there, or it was not time yet
    RelaxedCounter shed;        ///< left out under overload
    RelaxedCounter refused;     ///< no picture, nothing to be seen on it, or the network failed
    RelaxedCounter unknown;     ///< recorded boxes lack them
    RelaxedCounter correcting;  ///< not looked at during flat-field corrections
  };

  /// Live, `shed` is asked how much work is left out; any thread. `stage`: name in the report. `budget`: of one
  /// picture. `monitor` must outlive the task.
  DetectionTask(DetectionParts parts, const std::string& stage, Duration budget, std::function<safety::Shed()> shed,
                Monitor& monitor);

  /// Live: all boxes are given to `tap`, on the task's thread. To be called before the run.
  void keep_boxes(std::function<void(const Detections&)> tap) { tap_ = std::move(tap); }

  void tick(scheduler::Tick& tick) override;

  [[nodiscard]] const Figures& figures() const { return figures_; }
  [[nodiscard]] people::Eye eye() const { return parts_.eye; }
  [[nodiscard]] const std::string& source() const { return parts_.source; }

 private:
  void look(const Packet& packet, scheduler::Tick& tick);
  Result<const Detections*> detect(const Packet& packet);
  void hand_on(const Detections& found, scheduler::Tick& tick);
  void refuse(const Error& error, Time when);

  DetectionParts parts_;
  PicturePace pace_;
  std::function<safety::Shed()> shed_;
  std::function<void(const Detections&)> tap_;
  Monitor& monitor_;
  StageStats& stage_;
  Figures figures_;
};

}  // namespace cairn::app
