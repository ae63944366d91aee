// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "hal/monitor.hpp"
#include "hal/ports.hpp"
#include "hal/relaxed_counter.hpp"
#include "onboard/app/perception/picture_pace.hpp"
#include "onboard/app/sight/open_perception.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/safety/overload.hpp"
#include "onboard/scheduler/ports.hpp"

namespace cairn::app {

/// Pictures in, labels out: one in a tick, always of the newest picture. A network takes a tenth of a second, so the
/// task has a thread of its own, below mapping. Geometry never waits for it.
class PerceptionTask final : public scheduler::Task {
 public:
  // Slots in schedule.log, in this order.
  scheduler::InputPort<ArrivedPicture> pictures{*this, "pictures"};
  const std::size_t shed_slot = take_slots();  ///< 1: overload, the picture is left out
  scheduler::OutputPort<ArrivedLabels> labels{*this, "labels"};

  /// What became of the pictures. Any thread may read.
  struct Figures {
    RelaxedCounter images;      ///< labelled
    RelaxedCounter passed;      ///< newer ones were there, or it was not time yet
    RelaxedCounter shed;        ///< left out under overload
    RelaxedCounter refused;     ///< no picture, nothing to be seen on it, or the network failed
    RelaxedCounter unlabelled;  ///< recorded labels lack them
  };

  /// Live, `shed` is asked how much work is left out; any thread. `monitor` must outlive the task.
  /// `budget`: of one picture.
  PerceptionTask(PerceptionParts parts, Duration budget, std::function<safety::Shed()> shed, Monitor& monitor);

  /// Live: all labels are given to `tap`, on the task's thread. To be called before the run.
  void keep_labels(std::function<void(const LabelImage&)> tap) { tap_ = std::move(tap); }

  void tick(scheduler::Tick& tick) override;

  [[nodiscard]] const Figures& figures() const { return figures_; }

 private:
  void look(scheduler::Tick& tick);
  Result<const LabelImage*> segment();
  void refuse(const Error& error);

  PerceptionParts parts_;
  PicturePace pace_;
  const Packet* newest_ = nullptr;  // of the tick
  std::function<safety::Shed()> shed_;
  std::function<void(const LabelImage&)> tap_;
  Monitor& monitor_;
  StageStats& segmentation_;
  Figures figures_;
};

}  // namespace cairn::app
