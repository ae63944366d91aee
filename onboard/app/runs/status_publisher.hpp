// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "hal/monitor.hpp"
#include "onboard/app/live/live_server.hpp"
#include "onboard/app/live/live_view.hpp"
#include "onboard/app/live/watchdog.hpp"
#include "onboard/safety/failsafe.hpp"
#include "onboard/safety/overload.hpp"
#include "onboard/scheduler/task_graph.hpp"

namespace cairn::app {

/// Publishes how a live run goes: signs of life to the service manager, and the live view to its clients. Part of the
/// watch task. It reads figures that other tasks write without a lock.
class StatusPublisher {
 public:
  /// Where the state of the run is published.
  struct Options {
    std::string robot;
    std::filesystem::path live_socket;         ///< empty: no live view
    std::string notify_socket;                 ///< $NOTIFY_SOCKET
    std::optional<Duration> watchdog_timeout;  ///< watchdog_timeout() of $WATCHDOG_USEC and $WATCHDOG_PID
  };
  /// The sockets of the service manager are those that the environment of this process names.
  [[nodiscard]] static Options from_environment(std::string robot, std::filesystem::path live_socket);

  /// After all tasks are added; both must outlive it. A socket that cannot be opened is an event, and left out.
  StatusPublisher(const scheduler::TaskGraph& graph, Monitor& monitor, const Options& options, Time now);

  /// The newest values, on the thread of tick().
  void set_decision(const safety::FailsafeDecision& decision) { decision_ = decision; }
  void set_shed(safety::Shed level) { shed_ = level; }
  void set_scans(std::uint64_t scans) { scans_ = scans; }
  void set_peers(const std::vector<LiveView::Peer>& peers) { peers_ = peers; }
  void set_people(const LiveView::People& people) { people_ = people; }
  /// Publishes what is due. False while a task hangs: Fault::kTaskHung.
  bool tick(Time now);

  [[nodiscard]] LiveView view(Time now) const;

 private:
  const scheduler::TaskGraph& graph_;
  Monitor& monitor_;
  std::string robot_;
  safety::FailsafeDecision decision_;
  safety::Shed shed_ = safety::Shed::kNothing;
  std::uint64_t scans_ = 0;
  std::vector<LiveView::Peer> peers_;
  std::optional<LiveView::People> people_;
  std::optional<LiveServer> server_;
  std::optional<Watchdog> watchdog_;
  std::optional<Time> published_;
};

}  // namespace cairn::app
