// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "drivers/recording/faulty_source.hpp"
#include "drivers/velodyne/lidar.hpp"
#include "onboard/scheduler/failsafe.hpp"
#include "onboard/scheduler/rejection.hpp"
#include "tests/faults/campaign.hpp"
#include "tests/support/velodyne_encoder.hpp"

namespace cairn::faults {

/// A VLP-16 at 10 Hz → injector → the real decoder → the real failsafe, stepped every 5 ms of virtual time. The fault
/// lasts from kBegin to `end`; before and after nothing is wrong.
class LidarRig {
 public:
  static constexpr Duration kBegin = std::chrono::seconds(3), kStep = std::chrono::milliseconds(5);

  LidarRig(const recording::Faults& faults, Duration lasts) : end_(kBegin + lasts), sick_(stream_, faults) {
    Fitted fitted;
    fitted.watched[0] = true;
    failsafe_ = std::make_unique<Failsafe>(FailsafeConfig{}, fitted);
  }

  /// Something done to the sensor itself when the fault begins.
  std::function<void(velodyne::test::Sensor&)> strike;

  Measured run() {
    const Time begin = stream_.now();
    in_.now = begin;
    Packet packet;
    while (stream_.now() - begin < end_ + std::chrono::seconds(4)) {
      const Duration t = stream_.now() - begin;
      if (strike && t >= kBegin) std::exchange(strike, {})(stream_.sensor);
      Source& source = t >= kBegin && t < end_ ? static_cast<Source&>(sick_) : stream_;
      const auto poll = source.next(packet, {});
      if (!poll || *poll != Poll::kPacket) continue;
      while (in_.now + kStep <= packet.arrival) step(in_.now - begin);
      decode(packet);
    }
    measured_.held = measured_.held && failsafe_->decision().mode == Mode::kNormal;
    return measured_;
  }

  [[nodiscard]] const std::vector<Scan>& scans() const { return scans_; }
  [[nodiscard]] const velodyne::Counters& counters() const { return lidar_->counters(); }
  [[nodiscard]] const Monitor& monitor() const { return monitor_; }

 private:
  /// The sensor as a transport delivers it, without an end.
  class Stream final : public Source {
   public:
    velodyne::test::Sensor sensor;
    Stream() { sensor.device_ns = Duration(std::chrono::minutes(20)).count(); }
    [[nodiscard]] Time now() const { return sensor.start + Duration{sensor.device_ns}; }
    /// A packet and a time-out in turn: in a spell of silence the injector gives the word back all the same.
    Result<Poll> next(Packet& packet, Duration) override {
      if (std::exchange(waits_, !waits_)) return Poll::kTimeout;
      sensor.next(packet);
      return Poll::kPacket;
    }

   private:
    bool waits_ = false;
  };

  void decode(const Packet& packet) {
    const auto scan = lidar_->decode(packet);
    if (scan && *scan != nullptr) take(**scan);
  }
  void take(const Scan& scan) {
    constexpr std::size_t kHalfATurn = 16 * 900;
    scans_.push_back(scan);
    if (scan.cloud.size() < kHalfATurn) return;
    in_.seen[0] = {in_.now, in_.seen[0].count + 1};
  }
  void step(Duration t) {
    in_.now += kStep;
    if (const Scan* scan = lidar_->expire(in_.now)) take(*scan);
    const auto& c = lidar_->counters();
    in_.faults.set(Fault::kLidarRejected, rejection_.step(in_.now, c.data_packets, c.packets - c.data_packets));
    const Mode mode = failsafe_->step(in_).mode;
    if (t < kBegin) return;
    if (mode > measured_.worst) measured_.worst = mode;
    if (mode != Mode::kNormal && !measured_.detect) measured_.detect = t - kBegin;
    if (mode != Mode::kNormal) well_since_.reset();
    if (mode == Mode::kNormal && t >= end_ && !well_since_) well_since_ = t;
    if (measured_.detect && well_since_) measured_.recover = *well_since_ - end_;
  }

  Duration end_;
  Stream stream_;
  recording::FaultySource sick_;
  Monitor monitor_;
  std::unique_ptr<velodyne::Lidar> lidar_ = velodyne::Lidar::create({}, SourceId{0}, monitor_).value();
  std::unique_ptr<Failsafe> failsafe_;
  RejectionWatch rejection_;
  FailsafeInputs in_;
  std::vector<Scan> scans_;
  std::optional<Duration> well_since_;
  Measured measured_;
};

}  // namespace cairn::faults
