// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "onboard/app/profile/schedule_profile.hpp"
#include "onboard/app/tasks/drive_task.hpp"
#include "onboard/app/tasks/odometry_task.hpp"
#include "onboard/app/tasks/receive_task.hpp"
#include "onboard/app/tasks/safety_task.hpp"
#include "onboard/scheduler/executive.hpp"
#include "tests/faults/campaign.hpp"

namespace cairn::faults {

/// The robot's own tasks that receive and judge, at their own rates in virtual time. Odometry's place is taken by
/// one that keeps the scans.
class TaskRig {
 public:
  /// After the start, the fault begins.
  static constexpr Duration kBegin = std::chrono::seconds(3);
  static constexpr Duration kAfterwards = std::chrono::seconds(4);

  explicit TaskRig(Duration lasts) : end_(kBegin + lasts) {
    const auto line = [](scheduler::Line& l, scheduler::Task& task) { l.task = &task; };
    line(drive_line_, drive_);
    line(receive_line_, receive_);
    line(odometry_line_, keeper_);
    receive_line_.input = true;
    odometry_line_.from = {&scans_};
    safety_line_.from = {&seen_, &drive_news_, &odometry_news_};
  }
  TaskRig(const TaskRig&) = delete;
  TaskRig& operator=(const TaskRig&) = delete;

  void add(std::string_view kind, std::unique_ptr<Source> source, std::unique_ptr<ScanDecoder> decoder = nullptr) {
    Input& input = inputs_.emplace_back();
    input.entry.kind = kind;
    input.source = std::move(source);
    input.scans = std::move(decoder);
    receive_.add(input, static_cast<SourceId>(inputs_.size() - 1), {});
    const auto what = kind == recording::kVelodyne ? Watched::kLidar
                      : kind == recording::kCamera ? Watched::kCamera
                      : kind == recording::kDepth  ? Watched::kDepth
                                                   : Watched::kThermal;
    fitted_.watched[static_cast<std::size_t>(what)] = true;
  }

  /// `fault`: what its beginning is known by; none: anything.
  Measured run(Time start, std::optional<Fault> fault = {}) {
    SafetyTask safety({}, fitted_, {seen_, drive_news_, decisions_, odometry_news_});
    safety_line_.task = &safety;
    scheduler::Executive::ReplayOptions options;
    options.start = start;
    options.length = end_ + kAfterwards;
    Measured m;
    m.held = executive_.run_replay(options).has_value() && !executive_.diverged() && safety.lost_changes() == 0;
    for (; const SafetyTask::Change* c = safety.changes().front(); safety.changes().pop())
      if (c->at - start >= kBegin) note(*c, c->at - start, fault, m);
    m.held = m.held && safety.decision().mode == Mode::kNormal && safety.decision().active.empty();
    return m;
  }

  [[nodiscard]] const std::vector<Scan>& scans() const { return keeper_.scans; }
  [[nodiscard]] const Monitor& monitor() const { return monitor_; }
  [[nodiscard]] Monitor& monitor() { return monitor_; }

 private:
  struct Keeper final : scheduler::Task {
    explicit Keeper(ScanChannel& channel) : channel_(channel) {}
    void tick(scheduler::Tick& tick) override {
      while (const ArrivedScan* arrived = channel_.take(tick)) scans.push_back(arrived->scan);
    }
    std::vector<Scan> scans;

   private:
    ScanChannel& channel_;
  };

  void note(const SafetyTask::Change& change, Duration t, std::optional<Fault> fault, Measured& m) const {
    m.worst = std::max(m.worst, change.mode);
    if (!m.detect && (fault ? change.raised.has(*fault) : !change.raised.empty())) m.detect = t - kBegin;
    m.recover.reset();
    if (m.detect && change.active.empty()) m.recover = std::max(t - end_, Duration{});
  }

  Duration end_;
  ScheduleProfile schedule_;
  Monitor monitor_;
  Fitted fitted_;
  std::deque<Input> inputs_;
  scheduler::Executive executive_;
  scheduler::Line &safety_line_ = executive_.add(schedule_.safety), &drive_line_ = executive_.add(schedule_.drive),
                  &receive_line_ = executive_.add(schedule_.receive),
                  &odometry_line_ = executive_.add(schedule_.odometry);
  SeenChannel seen_{{64, 0, ReceiveTask::kSeenSlot, SafetyTask::kSensorsSlot, std::chrono::milliseconds(20)},
                    receive_line_.progress,
                    safety_line_.progress};
  DriveChannel drive_news_{
      {64, 0, DriveTask::kNewsSlot, SafetyTask::kDriveSlot, Duration{1}}, drive_line_.progress, safety_line_.progress};
  DecisionChannel decisions_{
      {64, 0, SafetyTask::kDecisionSlot, DriveTask::kDecisionSlot}, safety_line_.progress, drive_line_.progress};
  OdometryChannel odometry_news_{{64, 0, OdometryTask::kNewsSlot, SafetyTask::kOdometrySlot, Duration{1}},
                                 odometry_line_.progress,
                                 safety_line_.progress};
  ScanChannel scans_{
      {4, 0, ReceiveTask::kScansSlot, OdometryTask::kScansSlot}, receive_line_.progress, odometry_line_.progress};
  DriveTask drive_{decisions_, drive_news_};
  ReceiveTask receive_{scans_, seen_, monitor_};
  Keeper keeper_{scans_};
};

}  // namespace cairn::faults
