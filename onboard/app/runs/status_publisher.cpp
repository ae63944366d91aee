// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/runs/status_publisher.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "onboard/report/figures/run_report.hpp"

namespace cairn::app {
namespace {

constexpr Duration kViewPeriod = std::chrono::seconds(1);  // of the live view
constexpr std::size_t kShownEvents = 16;                   // in it
// A task that is silent for less does not hang.
constexpr Duration kShortestLimit = std::chrono::milliseconds(300);

std::string variable(const char* name) {
  const char* text = std::getenv(name);
  return text != nullptr ? text : "";
}

/// A task is late long before it hangs.
Duration limit_of(const scheduler::TaskSpec& spec) {
  return std::max({kShortestLimit, 5 * spec.period(), 3 * spec.hard(), 2 * spec.deadline()});
}

std::vector<safety::Pulse> pulses_of(const scheduler::TaskGraph& graph) {
  std::vector<safety::Pulse> pulses;
  for (const scheduler::ScheduledTask& task : graph.tasks())
    if (!task.live_only()) pulses.push_back({task.spec.name, limit_of(task.spec), &task.stats.ticks});
  return pulses;
}

LiveView::Stage stage_of(const scheduler::ScheduledTask& task) {
  const scheduler::TaskStats& s = task.stats;
  const Histogram& h = s.response;
  LiveView::Stage stage{.name = task.spec.name,
                        .p50_ms = to_milliseconds(h.percentile(0.5)),
                        .p99_ms = to_milliseconds(h.percentile(0.99)),
                        .p999_ms = to_milliseconds(h.percentile(0.999)),
                        .max_ms = to_milliseconds(h.max()),
                        .deadline_ms = to_milliseconds(task.spec.deadline()),
                        .budget_ms = task.spec.soft_ms,
                        .count = s.ticks,
                        .overruns = s.soft_overruns,
                        .slips = s.slips,
                        .misses = s.misses};
  for (const scheduler::InputPortBase* port : task.inputs) {
    const auto fill = port->channel()->fill();
    stage.queued += fill.waiting;
    stage.capacity += fill.capacity;
    stage.dropped += fill.dropped;
  }
  return stage;
}

}  // namespace

StatusPublisher::Options StatusPublisher::from_environment(std::string robot, std::filesystem::path live_socket) {
  return {.robot = std::move(robot),
          .live_socket = std::move(live_socket),
          .notify_socket = variable("NOTIFY_SOCKET"),
          .watchdog_timeout = watchdog_timeout(variable("WATCHDOG_USEC"), variable("WATCHDOG_PID"), ::getpid())};
}

StatusPublisher::StatusPublisher(const scheduler::TaskGraph& graph, Monitor& monitor, const Options& options, Time now)
    : graph_(graph), monitor_(monitor), robot_(options.robot) {
  if (!options.live_socket.empty()) {
    if (auto server = LiveServer::open(options.live_socket))
      server_.emplace(std::move(*server));
    else
      monitor.event(now, "live view", to_string(server.error()));
  }
  auto notify = SdNotify::open(options.notify_socket);
  if (!notify) monitor.event(now, "watchdog", to_string(notify.error()));
  SdNotify manager = notify ? std::move(*notify) : SdNotify::open({}).value();
  watchdog_.emplace(pulses_of(graph), std::move(manager), options.watchdog_timeout, monitor);
  watchdog_->ready(now);
}

LiveView StatusPublisher::view(Time now) const {
  LiveView v;
  v.robot = robot_;
  v.t_s = to_seconds(now);
  v.mode = to_string(decision_.mode);
  if (decision_.cause) v.cause = to_string(*decision_.cause);
  v.shed = to_string(shed_);
  v.epoch = decision_.epoch;
  v.scans = scans_;
  v.rss_mb = report::peak_rss_mb();
  for (const safety::FaultRow& row : safety::fault_table())
    if (decision_.active.has(row.fault)) v.faults.emplace_back(row.code);
  for (const scheduler::ScheduledTask& task : graph_.tasks()) v.stages.push_back(stage_of(task));
  const auto events = monitor_.events_now();
  for (std::size_t i = events.size() - std::min(events.size(), kShownEvents); i < events.size(); ++i)
    v.events.push_back({to_seconds(events[i].last), events[i].stage, events[i].what, events[i].count});
  v.peers = peers_;
  v.people = people_;
  return v;
}

bool StatusPublisher::tick(Time now) {
  const std::string status = std::string(to_string(decision_.mode)) + ", shed " + std::string(to_string(shed_));
  const bool well = watchdog_->step(now, status);
  if (server_ && (!published_ || now - *published_ >= kViewPeriod)) {
    published_ = now;
    server_->publish(to_line(view(now)));
  }
  return well;
}

}  // namespace cairn::app
