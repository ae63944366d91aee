// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "onboard/app/door/fitted.hpp"
#include "onboard/app/profile/schedule_profile.hpp"
#include "onboard/app/tasks/drive_task.hpp"
#include "onboard/app/tasks/odometry_task.hpp"
#include "onboard/app/tasks/receive_task.hpp"
#include "onboard/app/tasks/safety_task.hpp"
#include "onboard/scheduler/execution/executive.hpp"
#include "tests/faults/campaign.hpp"

namespace cairn::faults {

/// The robot's own tasks that receive and judge, at their own rates in virtual time. Odometry's place is taken by
/// one that keeps the scans.
class TaskRig {
 public:
  /// After the start, the fault begins.
  static constexpr Duration kBegin = std::chrono::seconds(3);
  static constexpr Duration kAfterwards = std::chrono::seconds(4);

  explicit TaskRig(Duration lasts) : end_(kBegin + lasts) {}
  TaskRig(const TaskRig&) = delete;
  TaskRig& operator=(const TaskRig&) = delete;

  void add(recording::SensorKind kind, std::unique_ptr<Source> source, std::unique_ptr<ScanDecoder> decoder = nullptr) {
    app::Input& input = inputs_.emplace_back();
    input.entry.kind = kind;
    input.source = std::move(source);
    input.scans = std::move(decoder);
    receive_.add(input, static_cast<SourceId>(inputs_.size() - 1), {});
    fitted_.watched[static_cast<std::size_t>(app::watched_as(kind).value())] = true;
  }

  /// `fault`: what its beginning is known by; none: anything.
  Measured run(Time start, std::optional<safety::Fault> fault = {}) {
    app::SafetyTask safety({}, fitted_);
    scheduler::TaskGraph graph;
    connect(graph, safety);
    scheduler::Executive executive(graph);
    const auto ran = executive.run_replay({.start = start, .length = end_ + kAfterwards});
    Measured m;
    m.held = ran.has_value() && !ran->diverged && safety.lost_changes() == 0;
    for (; const app::SafetyTask::Change* c = safety.changes().front(); safety.changes().pop())
      if (c->at - start >= kBegin) note(*c, c->at - start, fault, m);
    m.held = m.held && safety.decision().mode == safety::Mode::kNormal && safety.decision().active.empty();
    return m;
  }

  [[nodiscard]] const std::vector<Scan>& scans() const { return keeper_.scans; }
  [[nodiscard]] const Monitor& monitor() const { return monitor_; }
  [[nodiscard]] Monitor& monitor() { return monitor_; }

 private:
  struct Keeper final : scheduler::Task {
    void tick(scheduler::Tick& tick) override {
      while (const app::ArrivedScan* arrived = arriving.take(tick)) scans.push_back(arrived->scan);
    }
    scheduler::InputPort<app::ArrivedScan> arriving{*this, "scans"};
    std::vector<Scan> scans;
  };

  void connect(scheduler::TaskGraph& graph, app::SafetyTask& safety) {
    graph.add(schedule_.safety, safety);
    graph.add(schedule_.drive, drive_);
    graph.add(schedule_.receive, receive_, scheduler::TaskRole::kInput);
    graph.add(schedule_.odometry, keeper_);
    graph.connect(receive_.seen, safety.sensors, {.capacity = 64, .lag = std::chrono::milliseconds(20)});
    graph.connect(drive_.status, safety.drive, {.capacity = 64, .lag = Duration{1}});
    graph.connect(safety.decisions, drive_.decisions, {.capacity = 64});
    graph.connect(receive_.scans, keeper_.arriving, {.capacity = 4});
  }

  void note(const app::SafetyTask::Change& change, Duration t, std::optional<safety::Fault> fault, Measured& m) const {
    m.worst = std::max(m.worst, change.mode);
    if (!m.detect && (fault ? change.raised.has(*fault) : !change.raised.empty())) m.detect = t - kBegin;
    m.recover.reset();
    if (m.detect && change.active.empty()) m.recover = std::max(t - end_, Duration{});
  }

  Duration end_;
  app::ScheduleProfile schedule_;
  Monitor monitor_;
  safety::Fitted fitted_;
  std::deque<app::Input> inputs_;
  app::DriveTask drive_;
  app::ReceiveTask receive_{monitor_};
  Keeper keeper_;
};

}  // namespace cairn::faults
