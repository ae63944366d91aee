// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "hal/monitor.hpp"
#include "hal/relaxed_counter.hpp"
#include "onboard/app/door/door.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/safety/rejection.hpp"
#include "onboard/safety/stuck.hpp"
#include "onboard/scheduler/feed.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn {

/// Reads what the sensors sent, hands on every scan that became whole, and says what is wrong with a LiDAR. Slots: 0 …
/// kMaxInputs − 1 packets of its inputs in their order, then scans and news accepted.
class ReceiveTask final : public scheduler::Task {
 public:
  static constexpr std::size_t kMaxInputs = 8, kScansSlot = 8, kSeenSlot = 9;

  /// What came in; of the task's thread, or of a run that has ended. Any thread may read the counters.
  struct Figures {
    std::optional<Time> start;  ///< arrival of the first packet
    Time end{};                 ///< arrival of the last
    RelaxedCounter scans, lost_packets;
  };

  /// All must outlive the task.
  ReceiveTask(ScanChannel& scans, SeenChannel& seen, Monitor& monitor);
  /// `input` must outlive the task. False: there are kMaxInputs already.
  bool add(Input& input, SourceId id, scheduler::Feed::Tap tap);

  void tick(scheduler::Tick& tick) override;
  void finish(scheduler::Tick& tick) override;

  [[nodiscard]] const Figures& figures() const { return figures_; }
  [[nodiscard]] Time first_arrival();
  [[nodiscard]] std::uint64_t missing_packets() const;

 private:
  struct Way {
    scheduler::Feed feed;
    ScanDecoder* decoder;  // null: only counted and recorded
    std::optional<Watched> watched;
    StuckWatch stuck{};
    RejectionWatch rejection{};
    std::uint64_t accepted = 0, refused = 0;  // packets of a decoder
  };
  void receive(const Packet& packet, Way& way, scheduler::Tick& tick);
  void decode(const Packet& packet, Way& way, scheduler::Tick& tick);
  void judge(Time now);
  void hand_on(const Scan* scan, scheduler::Tick& tick, bool at_the_end);
  void note(Watched what, Time when);
  void tell(scheduler::Tick& tick);

  ScanChannel& scans_;
  SeenChannel& seen_channel_;
  Monitor& monitor_;
  StageStats& decode_stage_;
  std::deque<Way> ways_;
  Figures figures_;
  SensorsSeen seen_;
  bool news_ = false;
};

}  // namespace cairn
