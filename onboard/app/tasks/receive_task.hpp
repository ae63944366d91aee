// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "drivers/gpio/pulses.hpp"
#include "hal/monitor.hpp"
#include "hal/relaxed_counter.hpp"
#include "onboard/app/door/door.hpp"
#include "onboard/app/streams/outlets/picture_outlet.hpp"
#include "onboard/app/tasks/messages.hpp"
#include "onboard/safety/rejection.hpp"
#include "onboard/safety/stuck.hpp"
#include "onboard/scheduler/feed.hpp"
#include "onboard/scheduler/ports.hpp"
#include "onboard/scheduler/tick.hpp"

namespace cairn::app {

/// Reads what the sensors sent, hands on every whole scan, and finds the faults of a LiDAR. A camera that sends the
/// same picture again and again counts as silent.
class ReceiveTask final : public scheduler::Task {
 public:
  static constexpr std::size_t kMaxInputs = 8;  ///< sensors; the slots in schedule.log are reserved for them

  // Slots in schedule.log, in this order.
  const std::size_t packets_slot = take_slots(kMaxInputs);  ///< packets taken, one slot for each input
  scheduler::OutputPort<ArrivedScan> scans{*this, "scans"};
  scheduler::OutputPort<SensorsSeen> seen{*this, "seen"};
  scheduler::OutputPort<ArrivedPicture> pictures{*this, "pictures"};  ///< of the colour camera
  scheduler::OutputPort<ArrivedPicture> depths{*this, "depths"};      ///< of the depth camera
  scheduler::OutputPort<ArrivedPicture> watched{*this, "watched"};  ///< of the colour camera, for who looks for people
  scheduler::OutputPort<ArrivedPicture> thermals{*this, "thermals"};  ///< of the thermal camera, for the same
  scheduler::OutputPort<ArrivedPicture> eyes{*this, "eyes"};          ///< of the colour camera, for visual odometry
  scheduler::OutputPort<GeoFix> fixes{*this, "fixes"};                ///< of a satellite receiver at the LiDAR
  scheduler::InputPort<LineEdge> lines{*this, "lines"};
  scheduler::OutputPort<ArrivedPicture> mounted{*this, "mounted"};  ///< of the colour camera, for who watches its mount
  scheduler::OutputPort<ArrivedPicture> mounted_thermals{*this, "mounted_thermals"};  ///< of the thermal one, the same

  /// What came in. Of the task's thread, or after the run. Any thread may read the counters.
  struct Figures {
    std::optional<Time> start;  ///< arrival of the first packet
    Time end{};                 ///< arrival of the last
    RelaxedCounter scans, lost_packets;
  };

  /// `monitor` must outlive the task.
  explicit ReceiveTask(Monitor& monitor);
  /// `input` must outlive the task. False: there are kMaxInputs already.
  bool add(Input& input, SourceId id, scheduler::Feed::Tap tap);

  /// Pictures of this kind are exposed by the trigger line. They are handed on as if they had come `latency` after
  /// their pulse, so that it is the time of their exposure. To be called before add().
  void expose_by_trigger(recording::SensorKind kind, Duration latency) { triggered_.push_back({kind, latency}); }

  /// Live: pictures of the first camera of this kind go to `outlet`, too, while they are wanted. To be called before
  /// the run; `outlet` must outlive the task. False: there is none.
  bool show(recording::SensorKind kind, PictureOutlet& outlet);

  void tick(scheduler::Tick& tick) override;
  void finish(scheduler::Tick& tick) override;

  [[nodiscard]] const Figures& figures() const { return figures_; }
  [[nodiscard]] Time first_arrival();
  [[nodiscard]] std::uint64_t missing_packets() const;

 private:
  using PicturePorts = std::array<scheduler::OutputPort<ArrivedPicture>*, 4>;  // null: nowhere
  struct Sensor {
    scheduler::Feed feed;
    ScanDecoder* decoder;                    // null: its packets are only counted and recorded
    std::optional<safety::Watched> watched;  // without a decoder: every packet is good data of this kind
    PicturePorts pictures;                   // where its packets go
    recording::SensorKind kind;
    std::optional<Duration> triggered{};  // from the pulse to what counts as arrival
    std::vector<PictureOutlet*> shown{};  // to clients
    safety::StuckWatch stuck{};
    safety::PictureSample sample{};
    safety::RejectionWatch rejection{};
    std::uint64_t accepted = 0, refused = 0;  // packets of a decoder
  };
  void receive(const Packet& packet, Sensor& sensor, scheduler::Tick& tick);
  void read_lines(scheduler::Tick& tick);
  [[nodiscard]] std::optional<Time> pulse_of(Time arrival, Duration latency) const;
  void take_undecoded(const Packet& packet, Sensor& sensor, scheduler::Tick& tick);
  void decode(const Packet& packet, Sensor& sensor, scheduler::Tick& tick);
  void judge(Time now);
  void hand_on(const Scan* scan, scheduler::Tick& tick, bool at_the_end);
  void hand_on(const GeoFix& fix, scheduler::Tick& tick);
  static void show(const Packet& picture, PictureOutlet& outlet);
  static void hand_on(const Packet& picture, scheduler::OutputPort<ArrivedPicture>& to, scheduler::Tick& tick);
  [[nodiscard]] PicturePorts ports_of(recording::SensorKind kind);
  void note(safety::Watched what, Time when);
  void publish(scheduler::Tick& tick);

  Monitor& monitor_;
  StageStats& decode_stage_;
  struct Triggered {
    recording::SensorKind kind;
    Duration latency;
  };
  std::vector<Triggered> triggered_;
  std::deque<Time> pulses_;  // of the trigger, the newest
  gpio::PpsMonitor seconds_;
  Packet exposed_;  // a picture with the time of its pulse
  std::deque<Sensor> sensors_;
  Figures figures_;
  SensorsSeen seen_;
  bool unpublished_ = false;  // seen_ has changed
};

}  // namespace cairn::app
