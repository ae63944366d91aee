// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hal/monitor.hpp"
#include "onboard/app/live/sd_notify.hpp"
#include "onboard/safety/health.hpp"

namespace cairn::app {

/// Tells the service manager whether the tasks run. While every task is within its limit, the manager gets a sign of
/// life, four times within `timeout`. Otherwise it gets the name of the task that hangs, and then ends the process.
/// Stepped by the watch task, about every 100 ms.
class Watchdog {
 public:
  /// `timeout`: see watchdog_timeout(); none: only events and status. `monitor` must outlive the watchdog.
  Watchdog(std::vector<safety::Pulse> pulses, SdNotify notify, std::optional<Duration> timeout, Monitor& monitor)
      : supervisor_(std::move(pulses)), notify_(std::move(notify)), timeout_(timeout), monitor_(monitor) {}

  /// Sends "READY=1". To be called once, when all tasks run.
  void ready(Time now);
  /// `status`: one line for `systemctl status`. False while a task hangs: Fault::kTaskHung.
  bool step(Time now, std::string_view status);
  /// Which task hangs and for how long, in words; empty: none.
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
