// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/tasks/telling.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "onboard/report/figures/run_report.hpp"

namespace cairn {
namespace {

constexpr Duration kEvery = std::chrono::seconds(1), kLeastLimit = std::chrono::milliseconds(300);
constexpr std::size_t kEvents = 16;

std::string variable(const char* name) {
  const char* text = std::getenv(name);
  return text != nullptr ? text : "";
}

/// A task is late long before it hangs.
Duration limit_of(const scheduler::TaskSpec& spec) {
  return std::max({kLeastLimit, 5 * spec.period(), 3 * spec.hard(), 2 * spec.deadline()});
}

std::vector<Pulse> pulses_of(const scheduler::Executive& executive) {
  std::vector<Pulse> pulses;
  for (const scheduler::Line& line : executive.lines())
    if (!line.live_only) pulses.push_back({line.spec.name, limit_of(line.spec), &line.stats.ticks});
  return pulses;
}

LiveView::Stage stage_of(const scheduler::Line& line) {
  const scheduler::TaskStats& s = line.stats;
  const Histogram& h = s.response;
  LiveView::Stage stage{line.spec.name,
                        to_milliseconds(h.percentile(0.5)),
                        to_milliseconds(h.percentile(0.99)),
                        to_milliseconds(h.percentile(0.999)),
                        to_milliseconds(h.max()),
                        to_milliseconds(line.spec.deadline()),
                        line.spec.soft_ms,
                        s.ticks,
                        s.soft_overruns,
                        s.slips,
                        s.misses};
  for (const scheduler::ChannelBase* channel : line.from) {
    const auto fill = channel->fill();
    stage.queued += fill.waiting;
    stage.capacity += fill.capacity;
    stage.dropped += fill.dropped;
  }
  return stage;
}

}  // namespace

Telling::Options Telling::from_environment(std::string robot, std::filesystem::path live_socket) {
  return {std::move(robot), std::move(live_socket), variable("NOTIFY_SOCKET"),
          watchdog_timeout(variable("WATCHDOG_USEC"), variable("WATCHDOG_PID"), ::getpid())};
}

Telling::Telling(const scheduler::Executive& executive, Monitor& monitor, const Options& options, Time now)
    : executive_(executive), monitor_(monitor), robot_(options.robot) {
  if (!options.live_socket.empty()) {
    if (auto server = LiveServer::open(options.live_socket))
      server_.emplace(std::move(*server));
    else
      monitor.event(now, "live view", to_string(server.error()));
  }
  auto notify = SdNotify::open(options.notify_socket);
  if (!notify) monitor.event(now, "watchdog", to_string(notify.error()));
  SdNotify manager = notify ? std::move(*notify) : SdNotify::open({}).value();
  watchdog_.emplace(pulses_of(executive), std::move(manager), options.watchdog_timeout, monitor);
  watchdog_->ready(now);
}

LiveView Telling::view(Time now) const {
  LiveView v;
  v.robot = robot_;
  v.t_s = to_seconds(now);
  v.mode = to_string(decision_.mode);
  if (decision_.cause) v.cause = to_string(*decision_.cause);
  v.shed = to_string(shed_);
  v.epoch = decision_.epoch;
  v.scans = scans_;
  v.rss_mb = peak_rss_mb();
  for (const FaultRow& row : fault_table())
    if (decision_.active.has(row.fault)) v.faults.emplace_back(row.code);
  for (const scheduler::Line& line : executive_.lines()) v.stages.push_back(stage_of(line));
  const auto events = monitor_.events_now();
  for (std::size_t i = events.size() - std::min(events.size(), kEvents); i < events.size(); ++i)
    v.events.push_back({to_seconds(events[i].last), events[i].stage, events[i].what, events[i].count});
  v.peers = peers_;
  return v;
}

bool Telling::tick(Time now) {
  const std::string status = std::string(to_string(decision_.mode)) + ", shed " + std::string(to_string(shed_));
  const bool well = watchdog_->step(now, status);
  if (server_ && (!published_ || now - *published_ >= kEvery)) {
    published_ = now;
    server_->publish(to_line(view(now)));
  }
  return well;
}

}  // namespace cairn
