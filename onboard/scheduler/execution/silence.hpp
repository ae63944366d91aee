// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <utility>

#include "hal/time.hpp"
#include "onboard/scheduler/task_graph.hpp"

namespace cairn::scheduler {

/// Lets virtual time jump over long silence: no packet came for kSettled, and none will come for more than twice that.
/// By then every fault of a silent sensor is raised, and ticks change nothing any more. Virtual time goes on kSettled
/// before the next packet.
class Silence {
 public:
  static constexpr Duration kSettled = std::chrono::seconds(30);

  /// `next_arrival`: of all inputs; Time::max() when none will follow. `graph` must outlive it.
  Silence(TaskGraph& graph, std::function<Time()> next_arrival)
      : graph_(graph), next_arrival_(std::move(next_arrival)) {}

  /// To be called before the tick that is released at `now`. True when it moved on the next release of every task.
  bool pass(Time now);
  /// All that was left out.
  [[nodiscard]] Duration jumped() const { return jumped_; }

 private:
  static constexpr Duration kLook = std::chrono::seconds(1);

  TaskGraph& graph_;
  std::function<Time()> next_arrival_;
  Time next_look_ = Time::min(), upcoming_ = Time::min(), since_{};
  Duration jumped_{};
};

}  // namespace cairn::scheduler
