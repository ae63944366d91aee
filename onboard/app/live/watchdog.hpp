// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hal/monitor.hpp"
#include "onboard/app/live/sd_notify.hpp"
#include "onboard/safety/health.hpp"

namespace cairn::app {

/// The chain from the tasks to the service manager: it hears a sign of life only while every task is within its limit,
/// and otherwise the name of the one that is not, before it ends the process. Stepped by the watch task, every 100 ms
/// or so; it says something four times within `timeout`.
class Watchdog {
 public:
  /// `timeout`: as of watchdog_timeout(); none: only events and status. `monitor` must outlive the watchdog.
  Watchdog(std::vector<safety::Pulse> pulses, SdNotify notify, std::optional<Duration> timeout, Monitor& monitor)
      : supervisor_(std::move(pulses)), notify_(std::move(notify)), timeout_(timeout), monitor_(monitor) {}

  /// Once, when all tasks run: "READY=1".
  void ready(Time now);
  /// `status` is one line for `systemctl status`. False while a task hangs: Fault::kTaskHung.
  bool step(Time now, std::string_view status);
  /// The task that hangs, and for how long, as the event says; empty: none.
  [[nodiscard]] const std::string& hung() const { return hung_; }

 private:
  void accuse(Time now, const safety::Supervisor::Finding& finding);
  void tell(Time now, const std::string& lines);

  safety::Supervisor supervisor_;
  SdNotify notify_;
  std::optional<Duration> timeout_;
  Monitor& monitor_;
  std::string hung_;
  std::size_t accused_ = 0;
  std::optional<Time> told_;
};

}  // namespace cairn::app
